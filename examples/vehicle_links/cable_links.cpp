#include "links_of.hpp"

std::vector<chapter3::LinksOnPins> chapter3::cable_links() {
  return links_of<AncfCable<>, AncfLinear>({"ancf", "cables, Green strain"});
}
