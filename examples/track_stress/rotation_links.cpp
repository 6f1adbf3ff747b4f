#include "stress_case.hpp"

chapter4::Links chapter4::rotation_links() {
  return links_of<Formulation<Lrvf<>, Constraint, GeneralizedAlpha>>("lrvf");
}
