#include "links_of.hpp"

std::vector<chapter3::LinksOnPins> chapter3::continuum_links() {
  return links_of<AncfBeam<Continuum<>>, AncfLinear>({"continuum", "deformable sections, continuum"});
}
