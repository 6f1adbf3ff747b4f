#include "../chapter2_body.hpp"

std::vector<chapter2::BodyOnPolicy> chapter2::green_cables(Mechanism m) {
  return on_policies<planar::AncfCable<GreenStrain>>(m, "ancf", "cable, Green strain");
}
