#include "../chapter2_body.hpp"

std::vector<chapter2::BodyOnPolicy> chapter2::elastic_line_beams(Mechanism m) {
  return on_policies<AncfBeam<ElasticLine>>(m, "ancf-beam", "deformable sections, elastic line");
}
