#include "links_of.hpp"

std::vector<chapter3::LinksOnPins> chapter3::beam_links() {
  return links_of<AncfBeam<ElasticLine>, AncfLinear>({"beam", "deformable sections, elastic line"});
}
