#include "links_of.hpp"

std::vector<chapter3::LinksOnPins> chapter3::rotation_links() {
  return links_of<Lrvf<>, Constraint>({"lrvf", "rigid sections"});
}
