// Runs of the arm and the cantilever of Chapter 2 under each combination of body, policy and integrator that exists,
// with low stiffness, from rest to 0.5 s. The time is that of all steps of a run, without the construction of the
// model: steps of 4 ms, 0.5 ms with Runge–Kutta, and a relative tolerance of 1e-5 with Adams. The counter `error` is
// the largest difference of the tip's position y [m] from the reference of the physical model. An `EqualErrorStudy`
// extrapolates this reference over meshes and steps of one formulation of the model.
#include <map>

#include "../examples/chapter2_formulations.hpp"
#include "registered.hpp"

namespace {

using namespace chapter2;

Problem const& problem_of(Mechanism mechanism) {
  static auto const problem = [](Mechanism which) {
    return Problem{.mechanism = which,
                   .motion = "from rest",
                   .setup = {.stiffness = low, .ramp = 1.0},
                   .end_time = 0.5,
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

/// Policy that belongs to the physical model of a body on a policy: all exact policies have one model.
std::string model_policy(std::string const& policy) {
  return policy == "penalty" || policy == "bushing" ? policy : "constraint";
}

constexpr std::size_t radau = 3;  // its number in `integrators`
static_assert(std::is_same_v<std::tuple_element_t<radau, decltype(integrators)>, NamedIntegrator<Radau> const>);

/// Reference of the physical model of `of`, computed at the first call for this model.
OutputHistory const& reference(Mechanism mechanism, BodyOnPolicy const& of) {
  static std::map<std::string, OutputHistory> known;
  Problem const& problem = problem_of(mechanism);
  std::string const policy = model_policy(of.policy);
  std::string const key = std::to_string(int(mechanism)) + of.body.model + policy;
  if (auto const found = known.find(key); found != known.end()) return found->second;
  EqualErrorStudy study(
      {.elements = {8, 16, 32}, .steps = {4e-3, 2e-3, 1e-3}, .errors = {1.0}, .repeats = 1, .samples = 50});
  auto const& all = bodies(mechanism);
  auto const first = std::find_if(all.begin(), all.end(), [&](BodyOnPolicy const& one) {
    return one.body.model == of.body.model && one.policy == policy;
  });
  first->by[radau].add(study, problem, "reference", {.elements = 8});
  EqualErrorReport const r = study.run();
  if (r.references.empty())
    throw InvalidInput{"\"", ErrorObject{of.body.model}, "\" has no reference: ", r.formulations[0].remarks.back()};
  return known[key] = {.times = r.times, .values = r.reference(0)};
}

/// Measures runs of a body on a policy, with integrator number `by`.
void measure(benchmark::State& state, Mechanism mechanism, BodyOnPolicy const& of, std::size_t by,
             FormulationMesh const& mesh) {
  Scenario<AnyModel> const scenario = scenario_of(problem_of(mechanism), of.make, mesh);
  OutputHistory const& exact = reference(mechanism, of);
  with_integrator(by, [&](auto integrator) {
    RunOptions options = scenario.options;
    using I = decltype(integrator);
    bool constexpr controlled = requires { I::adaptive_step; };
    detail::set_accuracy(integrator, options,
                         controlled                                   ? 1e-5
                         : std::is_same_v<I, RungeKutta4<Projection>> ? 5e-4
                                                                      : 4e-3);
    State x = scenario.start;
    auto recorded = simulate(scenario.model, x, integrator, options);
    double error = 0.0;
    for (State const& now : recorded)
      error = std::max(error, std::abs(scenario.outputs[0].value(scenario.model, now) - exact(now.t)));
    ProblemSize const size = problem_size(scenario.model);
    registered::time_runs(state, size.velocities + size.rows, [&] {
      x = scenario.start;
      return simulate(scenario.model, x, integrator, options);
    });
    state.counters["error"] = error;
  });
}

void add(Mechanism mechanism, BodyOnPolicy const& of, std::size_t by) {
  std::string name = mechanism == Mechanism::arm ? "step/robot_arm/" : "step/cantilever/";
  name += registered::type_name(of.body.name) + '/' + registered::type_name(of.policy) + '/';
  with_integrator(by, [&](auto const& integrator) { name += integrator.name; });
  auto const with_mesh = [&](std::string const& suffix, FormulationMesh const& mesh) {
    registered::add(name + suffix, [=, &of](benchmark::State& state) { measure(state, mechanism, of, by, mesh); });
  };
  if (of.body.mesh == MeshKind::none) with_mesh("", {});
  if (of.body.mesh == MeshKind::elements)
    for (Index const n : {8, 32}) with_mesh("/elements:" + std::to_string(n), {.elements = n});
  if (of.body.mesh == MeshKind::modes)
    for (Index const n : {2, 8}) with_mesh("/modes:" + std::to_string(n), {.elements = 32, .modes = n});
}

}  // namespace

int main(int argc, char** argv) {
  for (Mechanism const mechanism : {Mechanism::arm, Mechanism::cantilever})
    for (BodyOnPolicy const& of : bodies(mechanism))
      for (std::size_t by = 0; by < of.by.size(); ++by)
        if (of.by[by].refusal.empty()) add(mechanism, of, by);
  return registered::run(argc, argv);
}
