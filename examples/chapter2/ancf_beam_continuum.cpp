#include "../chapter2_body.hpp"

std::vector<chapter2::BodyOnPolicy> chapter2::continuum_beams(Mechanism m) {
  return on_policies<AncfBeam<Continuum<>>>(m, "ancf-beam-continuum", "deformable sections, continuum");
}
