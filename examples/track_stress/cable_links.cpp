#include "stress_case.hpp"

chapter4::Links chapter4::cable_links() {
  return links_of<Formulation<AncfCable<>, AncfLinear, GeneralizedAlpha>>("ancf");
}
