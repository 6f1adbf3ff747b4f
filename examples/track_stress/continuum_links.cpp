#include "stress_case.hpp"

chapter4::Links chapter4::continuum_links() {
  return links_of<Formulation<AncfBeam<Continuum<>>, AncfLinear, GeneralizedAlpha>>("continuum");
}
