#include "stress_case.hpp"

chapter4::Links chapter4::beam_links() {
  return links_of<Formulation<AncfBeam<ElasticLine>, AncfLinear, GeneralizedAlpha>>("beam");
}
