#include <polybody/se3_beam.hpp>

#include "links_of.hpp"

std::vector<chapter3::LinksOnPins> chapter3::helicoidal_links() {
  return links_of<Se3Beam, Constraint>({"se3", "rigid sections"});
}
