#include "links.hpp"

namespace chapter3 {

LinkSettings::LinkSettings() {
  selection.meshes = {2, 4, 8};
  selection.modes = {};
  selection.steps = selection.tolerances = selection.errors = {};
  files = POLYBODY_TRACK_LINK_FILES;
}

LinkSettings LinkSettings::with(FormulationMesh const& mesh) const {
  LinkSettings o = *this;
  if (mesh.elements) o.elements = int(*mesh.elements);
  if (mesh.modes) o.modes = mesh.modes;
  return o;
}

Built built_of(LinkSettings const& o, LinksOnPins const& links) {
  return build(o, [&](VehicleParts const& parts) { return links.make(o, parts).vehicle; });
}

std::vector<LinksOnPins> const& all_links() {
  static std::vector<LinksOnPins> const all = [] {
    std::vector<LinksOnPins> found;
    for (auto const of_body : {rigid_links, cable_links, floating_links, rotation_links, helicoidal_links, beam_links,
                               continuum_links, rigid_links_by_euler_parameters, engineering_cable_links})
      for (LinksOnPins& one : of_body()) found.push_back(std::move(one));
    return found;
  }();
  return all;
}

std::vector<std::string> const& body_names() {
  static std::vector<std::string> const names = [] {
    std::vector<std::string> found;
    for (LinksOnPins const& one : all_links())
      if (one.usual) found.push_back(one.body.name);
    return found;
  }();
  return names;
}

LinksOnPins const& links_on_pins(std::string const& body, std::string const& policy) {
  auto const& all = all_links();
  return *std::find_if(all.begin(), all.end(), [&](LinksOnPins const& one) {
    return one.body.name == body && (policy.empty() ? one.usual : one.policy == policy);
  });
}

}  // namespace chapter3
