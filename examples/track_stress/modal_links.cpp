#include <polybody/vehicle/modal_links.hpp>

#include "stress_case.hpp"

std::vector<chapter4::Combination> chapter4::modal_links() {
  return links_of<Ffr, Constraint>("ffr", [](Options const& o) { return m113::LinkOf<Ffr>{.terms = o.terms}; });
}

std::vector<chapter4::Combination> chapter4::finite_element_links() {
  return links_of<Ffr, Constraint>(
      "fe", [](Options const& o) { return m113::LinkOf<Ffr>{.model = finite_element_link(o), .terms = o.terms}; });
}
