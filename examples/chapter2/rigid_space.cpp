#include "../chapter2_body.hpp"

std::vector<chapter2::BodyOnPolicy> chapter2::spatial_rigid_bodies(Mechanism m) {
  return on_policies<Rigid<>, MeshKind::none>(m, "rigid-space", "rigid bar");
}
