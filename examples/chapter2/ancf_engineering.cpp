#include "../chapter2_body.hpp"

std::vector<chapter2::BodyOnPolicy> chapter2::engineering_cables(Mechanism m) {
  return on_policies<planar::AncfCable<EngineeringStrain>>(m, "ancf-engineering", "cable, engineering strain");
}
