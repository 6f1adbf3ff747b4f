#include "links_of.hpp"

std::vector<chapter4::Combination> chapter4::continuum_links() {
  return links_of<AncfBeam<Continuum<>>, AncfLinear>("continuum");
}
