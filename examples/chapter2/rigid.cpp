#include "../chapter2_body.hpp"

std::vector<chapter2::BodyOnPolicy> chapter2::rigid_bodies(Mechanism m) {
  return on_policies<planar::Rigid, MeshKind::none>(m, "rigid", "rigid bar");
}
