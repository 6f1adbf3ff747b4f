#include "links_of.hpp"

std::vector<chapter4::Combination> chapter4::beam_links() {
  return links_of<AncfBeam<ElasticLine>, AncfLinear>("beam");
}
