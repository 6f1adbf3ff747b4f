#include "../chapter2_body.hpp"

std::vector<chapter2::BodyOnPolicy> chapter2::spatial_lrvf_beams(Mechanism m) {
  return on_policies<Lrvf<>>(m, "lrvf-space", "rigid sections");
}
