#include <polybody/vehicle/modal_links.hpp>

#include "stress_case.hpp"

chapter4::Links chapter4::modal_links() { return links_of<Formulation<Ffr, Constraint, GeneralizedAlpha>>("ffr"); }
