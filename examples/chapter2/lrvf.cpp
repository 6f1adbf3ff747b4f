#include "../chapter2_body.hpp"

std::vector<chapter2::BodyOnPolicy> chapter2::lrvf_beams(Mechanism m) {
  return on_policies<planar::Lrvf>(m, "lrvf", "rigid sections");
}
