#include "links_of.hpp"

std::vector<chapter3::LinksOnPins> chapter3::engineering_cable_links() {
  return links_of<AncfCable<EngineeringStrain>, AncfLinear>({"ancf-engineering", "cables, engineering strain"});
}
