#include "links_of.hpp"

std::vector<chapter3::LinksOnPins> chapter3::rigid_links() {
  return links_of<Rigid<>, Constraint>({"rigid", "rigid links", MeshKind::none});
}
