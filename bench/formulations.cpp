// Runs of the arm and the cantilever of Chapter 2 under each combination of body, policy and integrator that exists,
// with low stiffness, from rest to 2 s: the arm turns by 1.5 rad in 30 s, or 300 N m act at the tip. The time is that
// of all steps of a run, without the construction of the model. Implicit steps are 10 ms. Steps of Runge–Kutta are 2
// ms, and 0.2 ms on compliant clamps. Adams has a relative tolerance of 1e-5. Explicit integrators have the coarse mesh
// only. The counter `error` is the largest difference of the tip's position y [m] from the reference of the physical
// model. An `EqualErrorStudy` extrapolates this reference over meshes and steps of one formulation of the model.
#include <map>

#include "../examples/chapter2_formulations.hpp"
#include "registered.hpp"

namespace {

using namespace chapter2;
using combinations::with_integrator;

Problem const& problem_of(Mechanism mechanism) {
  static auto const problem = [](Mechanism which) {
    return Problem{.mechanism = which,
                   .motion = "from rest",
                   .setup = {.stiffness = low, .ramp = 30.0, .moment = 300.0},
                   .end_time = 2.0,
                   .output = "tip y [m]",
                   .output_value = [](double, Vec3 const& tip) { return tip[1]; }};
  };
  static Problem const arm = problem(Mechanism::arm), cantilever = problem(Mechanism::cantilever);
  return mechanism == Mechanism::arm ? arm : cantilever;
}

std::vector<BodyOnPolicy> const& bodies(Mechanism mechanism) {
  static auto const arm = bodies_on_policies(Mechanism::arm), cantilever = bodies_on_policies(Mechanism::cantilever);
  return mechanism == Mechanism::arm ? arm : cantilever;
}

bool is_compliant(std::string const& policy) { return policy == "penalty" || policy == "bushing"; }

/// Reference of the physical model of `of`, computed at the first call for this model. All exact policies have one
/// model.
OutputHistory const& reference(Mechanism mechanism, BodyOnPolicy const& of) {
  static std::map<std::string, OutputHistory> known;
  std::string const policy = is_compliant(of.policy) ? of.policy : "constraint";
  std::string const key = std::to_string(int(mechanism)) + of.body.model + policy;
  if (auto const found = known.find(key); found != known.end()) return found->second;
  bool const is_rigid = of.body.mesh == MeshKind::none;
  if (is_rigid && mechanism == Mechanism::cantilever && policy == "constraint")  // stays at rest
    return known[key] = {.times = {0.0, 1.0, 2.0}, .values = {0.0, 0.0, 0.0}};
  combinations::Selection selection;
  selection.meshes = {8, 16, 32};
  selection.modes = {2, 4, 8};
  selection.steps = {5e-3, 2.5e-3, 1.25e-3};
  selection.errors = {1.0};
  combinations::CombinationStudy study(selection);
  auto const& all = bodies(mechanism);
  auto const first = std::find_if(all.begin(), all.end(), [&](BodyOnPolicy const& one) {
    return one.body.model == of.body.model && one.policy == policy;
  });
  std::size_t const by =
      is_rigid ? 3 : 0;  // Radau, since a rigid bar on a compliant pin is stiff; or generalised-alpha
  with_integrator(integrators, by, [&](auto const& integrator) {
    study.add(*first, "reference", integrator,
              [&](FormulationMesh const& mesh) { return scenario_of(problem_of(mechanism), first->make, mesh); });
  });
  EqualErrorReport const r = study.run();
  if (r.references.empty())
    throw InvalidInput{"\"", ErrorObject{of.body.model}, "\" has no reference: ", r.formulations[0].remarks.back()};
  return known[key] = {.times = r.times, .values = r.reference(0)};
}

template <class I>
constexpr bool has_controlled_steps = requires { I::adaptive_step; };
template <class I>
constexpr bool is_explicit = std::is_same_v<I, RungeKutta4<Projection>> || has_controlled_steps<I>;

/// Measures runs of a body on a policy, with integrator number `by`.
void measure(benchmark::State& state, Mechanism mechanism, BodyOnPolicy const& of, std::size_t by,
             FormulationMesh const& mesh) {
  Scenario<AnyModel> const scenario = scenario_of(problem_of(mechanism), of.make, mesh);
  OutputHistory const& exact = reference(mechanism, of);
  with_integrator(integrators, by, [&](auto integrator) {
    RunOptions options = scenario.options;
    using I = decltype(integrator);
    bool const stiff = mechanism == Mechanism::cantilever && is_compliant(of.policy);
    double const step = !is_explicit<I> ? 1e-2 : stiff ? 2e-4 : 2e-3;
    detail::set_accuracy(integrator, options, has_controlled_steps<I> ? 1e-5 : step);
    State x = scenario.start;
    auto recorded = simulate(scenario.model, x, integrator, options);
    OutputHistory y;
    for (State const& now : recorded) {
      y.times.push_back(now.t);
      y.values.push_back(scenario.outputs[0].value(scenario.model, now));
    }
    ProblemSize const size = problem_size(scenario.model);
    registered::time_runs(state, size.velocities + size.rows, [&] {
      x = scenario.start;
      return simulate(scenario.model, x, integrator, options);
    });
    double error = 0.0;
    for (std::size_t i = 0; i < exact.times.size(); ++i)
      error = std::max(error, std::abs(y(exact.times[i]) - exact.values[i]));
    state.counters["error"] = error;
  });
}

void add(Mechanism mechanism, BodyOnPolicy const& of, std::size_t by) {
  std::string name = mechanism == Mechanism::arm ? "step/robot_arm/" : "step/cantilever/";
  name += registered::type_name(of.body.name) + '/' + registered::type_name(of.policy) + '/';
  bool coarse_only = false;
  with_integrator(integrators, by, [&](auto integrator) {
    name += integrator.name;
    coarse_only = is_explicit<decltype(integrator)>;
  });
  auto const with_mesh = [&](std::string const& suffix, FormulationMesh const& mesh) {
    registered::add(name + suffix, [=, &of](benchmark::State& state) { measure(state, mechanism, of, by, mesh); });
  };
  if (of.body.mesh == MeshKind::none) with_mesh("", {});
  bool const is_modal = of.body.mesh == MeshKind::modes;
  for (Index const n : {is_modal ? 2 : 8, is_modal ? 8 : 32}) {
    if (is_modal) with_mesh("/modes:" + std::to_string(n), {.elements = 32, .modes = n});
    if (of.body.mesh == MeshKind::elements) with_mesh("/elements:" + std::to_string(n), {.elements = n});
    if (coarse_only) break;
  }
}

}  // namespace

int main(int argc, char** argv) {
  for (Mechanism const mechanism : {Mechanism::arm, Mechanism::cantilever})
    for (BodyOnPolicy const& of : bodies(mechanism))
      for (std::size_t by = 0; by < of.refusals.size(); ++by)
        if (of.refusals[by].empty()) add(mechanism, of, by);
  return registered::run(argc, argv);
}
