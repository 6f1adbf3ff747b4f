#include "stress_case.hpp"

chapter4::Links chapter4::rigid_links() {
  return links_of<Formulation<Rigid<>, Constraint, GeneralizedAlpha>>("rigid");
}
