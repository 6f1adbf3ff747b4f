#include <polybody/vehicle/modal_links.hpp>

#include "stress_case.hpp"

std::vector<chapter4::Combination> chapter4::modal_links() { return links_of<Ffr, Constraint>("ffr"); }
