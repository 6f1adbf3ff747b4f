#include "pins.hpp"

#include <regex>

namespace chapter3 {

namespace {

Pins named(Combination const& c, double stiffness, bool with_integrator = false) {
  std::string name = c.links.body.name;
  bool const rigid = name == "rigid";
  if (rigid)
    name = c.links.policy;
  else if (!c.links.usual)
    name += ", " + c.links.policy;
  if (rigid && name == "penalty" && stiffness != m113::pin_stiffness) name += " " + compact(stiffness);
  if (with_integrator) name += ", " + integrator_name(c);
  return {name, c, stiffness};
}

}  // namespace

std::string compact(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", x);
  return std::regex_replace(text, std::regex("e\\+?(-?)0*"), "e$1");
}

Pins ideal_pins(Options const& o) { return named(combination(o, "rigid"), o.spring_pins); }
Pins penalty_pins(Options const& o, double k) { return named(combination(o, "rigid", "penalty"), k); }
Pins bushing_pins(Options const& o) { return named(combination(o, "rigid", "bushing"), o.spring_pins); }
Pins joint_coordinate_pins(Options const& o) {
  return named(combination(o, "rigid", "joint-coordinates"), o.spring_pins);
}
Pins cable_pins(Options const& o) { return named(combination(o, "ancf"), o.spring_pins); }

std::vector<Pins> selected_pins(Options const& o) {
  std::vector<Pins> found;
  for (Combination const& c : selected(o, "rigid"))
    found.push_back(named(c, o.spring_pins, o.selection.integrators.size() > 1));
  return found;
}

Runs Pins::run(Options const& o) const {
  LinkSettings settings = with_steps(o, combination);
  settings.spring_pins = stiffness;
  Built const built = built_of(settings, combination.links);
  Runs runs;
  runs.sampling = settings.sampling;
  runs.comparison = run_scenario(settings, combination, name,
                                 [&] { return TrackCase{settings, &runs.outcomes}.scenario(name, built); });
  return runs;
}

ProblemSize Pins::count(Options const& o) const {
  Ramp const drive = m113::drive(o.speed);
  return problem_size(combination.links.make(o, {course(false), {drive, drive}, {.ground_body = true}}).vehicle.model);
}

}  // namespace chapter3
