#include "combinations.hpp"

#include <iostream>

#include "integrators.hpp"

namespace chapter3 {

using namespace combinations;

namespace {

CombinationTable const& table() {
  static CombinationTable const all{names_of(integrators(LinkSettings())), {all_links().begin(), all_links().end()}};
  return all;
}

template <class F>
void by_integrator(LinkSettings const& o, Combination const& c, F const& f) {
  with_integrator(integrators(o), c.integrator, f);
}

// The case of `compare` and its formulation: the scenario does not depend on the type of the integrator.
template <class I>
struct Integrated {
  std::string name;
  I integrator;
};
struct ScenarioCase {
  std::function<Scenario<AnyModel>()> const& make;
  template <class I>
  Scenario<AnyModel> operator()(Integrated<I> const&) const {
    return make();
  }
};

Steps ten_steps(LinkSettings const& settings, Combination const& c) {
  Steps out;
  try {
    LinkSettings const o = with_steps(settings.with(c.links.mesh_of(0, 1)), c);
    Built const built = built_of(o, c.links);
    State x = built.vehicle.model.reference_state();
    by_integrator(o, c, [&](auto const& integrator) {
      double const step = o.first_step > 0.0 ? o.first_step : o.step;
      auto run = simulate(built.vehicle.model, x, integrator, {.end_time = 1.0, .step = step, .max_step_halvings = 6});
      for (int k = 0; k < 10; ++k) run.advance();
      out.count = run.report().steps;
    });
    if (!x.q.allFinite() || !x.v.allFinite()) out.failure = "The state is not finite.";
  } catch (Error const& e) {
    out.failure = e.what();
  }
  return out;
}

// The comparison at equal error of the selected combinations. Errors of Newton's method must be small beside those of
// mesh and step. Returns false if every run fails.
bool compare_selected(LinkSettings o) {
  if (o.tolerance == 0.0) o.tolerance = 1e-9;
  auto const names = output_names();
  std::size_t const output = std::size_t(std::find(names.begin(), names.end(), o.output) - names.begin());
  Selection selection = o.selection;
  if (selection.modes.empty()) selection.modes = {1, 2, 4};
  complete(selection,
           {.steps = {1e-3, 5e-4, 2.5e-4}, .tolerances = {1e-4, 1e-5, 1e-6, 1e-7}, .errors = {1e-1, 1e-2, 1e-3}});
  CombinationStudy study(selection, output);
  auto const outcomes = std::make_shared<std::vector<Outcome>>();
  for (Choice const& choice : choices(table(), selection, {"rigid"})) {
    Combination const c{all_links()[choice.row], choice.integrator};
    require_turning(o, c.links);
    by_integrator(o, c, [&](auto const& integrator) {
      study.add(c.links, short_name(table(), choice, selection), integrator, [=](FormulationMesh const& mesh) {
        LinkSettings const with_mesh = with_steps(o.with(mesh), c);
        Scenario<AnyModel> scenario = TrackCase{with_mesh, outcomes.get()}.scenario("", built_of(with_mesh, c.links));
        scenario.observer = {};
        return scenario;
      });
    });
  }
  std::cout << "The vehicle at " << number(o.speed) << " rad/s, 0 to " << number(o.end_time) << " s.\n";
  return print_report(study.run());
}

}  // namespace

void add_combination_options(CommandLine& line, LinkSettings& o, SelectionHelp help) {
  help.integrator = "integrator, or a list such as hht,radau (default: generalised-alpha)";
  help.modes = " of ffr and fe, ascending; a single run takes the last one (default: 3)";
  help.steps = " (default: 1e-3,5e-4,2.5e-4)" + help.steps;
  help.tolerances = " (default: 1e-4,1e-5,1e-6,1e-7)" + help.tolerances;
  help.errors = " (default: 1e-1,1e-2,1e-3)" + help.errors;
  add_selection(line, o.selection, body_names(), table().integrators, help);
  line.not_negative("--elements", &o.elements,
                    "elements of a flexible link except fe; 0: one, or two in a floating frame");
  line.positive("--tolerance", &o.tolerance,
                "tolerance of Newton's method (if omitted, 1e-5, or at equal error 1e-9); for adams and "
                "dormand-prince, of the error of a step "
                "(if omitted, 1e-6)");
  line.one_of("--output", &o.output, output_names(), "output of the comparison at equal error");
}

void complete(Selection& s, StudyLists const& usual) {
  if (s.steps.empty()) s.steps = usual.steps;
  if (s.tolerances.empty()) s.tolerances = usual.tolerances;
  if (s.errors.empty()) s.errors = usual.errors;
}

void complete(LinkSettings& o, double step) {
  if (step > 0.0) o.step = step;
  o.default_step = step == 0.0;
  if (!o.selection.modes.empty()) o.modes = o.selection.modes.back();
}

void require_turning(LinkSettings const& o, LinksOnPins const& links) {
  if (o.left != o.right && !links.turns)
    throw InvalidInput(
        "Tracks of ANCF cables cannot turn: at their pins, neighbouring links share a slope vector across the track, "
        "which is constant in world axes. Use --body rigid, ffr, fe, lrvf, se3, beam or continuum.");
}

std::vector<Combination> selected(LinkSettings const& o, std::string const& usual) {
  std::vector<Combination> found;
  for (Choice const& choice : choices(table(), o.selection, {usual})) {
    found.push_back({all_links()[choice.row], choice.integrator});
    require_turning(o, found.back().links);
  }
  return found;
}

Combination combination(LinkSettings const& o, std::string const& body, std::string const& policy) {
  Selection one = o.selection;
  one.bodies = {body};
  one.policies = policy.empty() ? std::vector<std::string>{} : std::vector{policy};
  if (one.integrators.size() > 1)
    throw InvalidInput{"This run has one integrator, but ", ErrorValue{one.integrators.size()},
                       " are selected. Only runs of --body and --compare combinations accept a list."};
  Choice const choice = choices(table(), one, {}).front();
  return {all_links()[choice.row], choice.integrator};
}

std::vector<Combination> candidates(Selection const& s) {
  std::vector<Combination> found;
  for (LinksOnPins const& links : all_links())
    for (std::size_t k = 0; k < table().integrators.size(); ++k)
      if (is_among(links.body.name, s.bodies) && is_among(links.policy, s.policies) &&
          is_among(table().integrators[k], s.integrators))
        found.push_back({links, k});
  return found;
}

std::string integrator_name(Combination const& c) { return table().integrators[c.integrator]; }

bool has_step_control(Combination const& c) {
  bool controlled = false;
  by_integrator({}, c,
                [&](auto const& i) { controlled = requires { std::remove_cvref_t<decltype(i)>::adaptive_step; }; });
  return controlled;
}

LinkSettings with_steps(LinkSettings o, Combination const& c) {
  if (o.default_step && integrator_name(c) == "runge-kutta") o.step = c.links.stable_step;
  if (has_step_control(c)) o.first_step = std::min(1e-5, o.step);
  if (o.sampling == 0.0 && (o.first_step > 0.0 || o.step < o.sampled_below)) o.sampling = std::max(o.step, o.sampled);
  return o;
}

Comparison run_scenario(LinkSettings const& o, Combination const& c, std::string const& name,
                        std::function<Scenario<AnyModel>()> const& make) {
  Comparison made;
  by_integrator(o, c, [&](auto const& integrator) {
    made = compare(ScenarioCase{make}, Integrated<std::remove_cvref_t<decltype(integrator)>>{name, integrator});
  });
  made.runs.front().family = c.links.family;
  made.runs.front().policy = c.links.enforcement;
  return require_complete(std::move(made));
}

bool run_combinations(LinkSettings const& settings, std::string const& comparison) {
  if (settings.selection.list) {
    print_list(table());
    return true;
  }
  LinkSettings o = settings;
  o.start = std::make_shared<m113::TrackStart const>(settled(o));
  if (comparison == "steps")
    return run_ten_steps(
        table(), [&](Choice const& choice) { return ten_steps(o, {all_links()[choice.row], choice.integrator}); });
  return compare_selected(o);
}

}  // namespace chapter3
