#include "m113/modal_links.hpp"
#include "links_of.hpp"

std::vector<chapter4::Combination> chapter4::modal_links() {
  return links_of<Ffr, Constraint>(
      "ffr", [](Options const& o) { return m113::LinkOf<Ffr>{.terms = o.terms, .height = section_height(o)}; });
}

std::vector<chapter4::Combination> chapter4::finite_element_links() {
  return links_of<Ffr, Constraint>("fe", [](Options const& o) {
    if (o.section != 1.0)
      throw InvalidInput(
          "--section applies to links of beams: the finite element link has the section of its files. Omit --section, "
          "or use --links ancf, ffr, lrvf, beam or continuum.");
    return m113::LinkOf<Ffr>{.model = finite_element_link(o), .terms = o.terms};
  });
}
