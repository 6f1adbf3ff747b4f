#include "links_of.hpp"

std::vector<chapter3::LinksOnPins> chapter3::rigid_links_by_euler_parameters() {
  return links_of<Rigid<EulerParameters>, Constraint>({"rigid-euler-parameters", "rigid links", MeshKind::none});
}
