#include "links_of.hpp"
#include "m113/modal_links.hpp"

namespace chapter3 {

namespace {

m113::LinkOf<Ffr> with_modes(LinkSettings const& o) {
  return {.terms = o.terms, .height = section_height(o), .modes = o.modes.value_or(3)};
}
m113::LinkOf<Ffr> with_nodes(LinkSettings const& o) {
  return {.terms = o.terms, .height = section_height(o), .modes = {}};
}
m113::LinkOf<Ffr> of_finite_elements(LinkSettings const& o) {
  if (o.section != 1.0)
    throw InvalidInput(
        "--section applies to links of beams: the finite element link has the section of its files. Omit --section, "
        "or use --body ancf, ffr, lrvf, se3, beam or continuum.");
  return {.model = finite_element_link(o), .terms = o.terms};
}

}  // namespace

std::vector<LinksOnPins> floating_links() {
  std::string const model = "small deformation in a floating frame";
  std::vector<LinksOnPins> all;
  auto const add = [&](BodyName const& body, LinksMade<Ffr> const& made) {
    for (LinksOnPins& one : links_of<Ffr, Constraint>(body, made)) all.push_back(std::move(one));
  };
  add({"ffr", model, MeshKind::modes}, with_modes);
  add({"ffr-nodal", model}, with_nodes);
  add({"fe", "finite elements in a floating frame", MeshKind::modes}, of_finite_elements);
  return all;
}

}  // namespace chapter3
