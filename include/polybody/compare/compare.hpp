#pragma once
/// \file
/// Runs of one case under several formulations: `Formulation`, `Scenario`, `compare` and `join`. The results are in
/// comparison.hpp.

#include <ctime>
#include <optional>
#include <string>
#include <utility>

#include <polybody/bodies/shared/body.hpp>
#include <polybody/bodies/shared/family.hpp>
#include <polybody/compare/comparison.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/run/sampling.hpp>
#include <polybody/run/simulate.hpp>

namespace polybody {

/// Body formulation with a mesh that is fixed at compile time, for use as the body of a `Formulation`. `count` is the
/// number of elements of the body.
template <Body B, int count>
  requires(count > 0)
struct Meshed {
  using BodyType = B;                     ///< body without mesh
  static constexpr int elements = count;  ///< number of elements, the second argument of `from`
};

/// Body in a floating frame from a bar with `count` elements. The nodal coordinates are reduced to the static shapes of
/// both ends and `inner` modes with fixed ends (the option `modes` of `Ffr`).
template <class B, int count, int inner>
  requires(count > 0 && inner >= 0)
struct Modal {
  using BodyType = B;                     ///< body without mesh
  static constexpr int elements = count;  ///< number of elements, the second argument of `from`
  static constexpr int modes = inner;     ///< number of modes with fixed ends
};

namespace detail {
/// Body type and mesh of a formulation's body. A body type without `Meshed` or `Modal` has no mesh.
template <class B>
struct MeshOf {
  using BodyType = B;
};
template <class B, int count>
struct MeshOf<Meshed<B, count>> : Meshed<B, count> {};
template <class B, int count, int inner>
struct MeshOf<Modal<B, count, inner>> : Modal<B, count, inner> {};
}  // namespace detail

/// Mesh of the body of a `Formulation`, set at run time. It is used if the body is neither `Meshed` nor `Modal`.
struct FormulationMesh {
  std::optional<Index> elements = {};  ///< number of elements; empty: the default of the body
  std::optional<Index> modes = {};     ///< number of modes of a floating frame; empty: the default of its options
};

/// Formulation of a mechanism: a body formulation, a constraint policy and an integrator. `compare` runs one case under
/// several formulations, each defined in one line:
///
///     using Ideal = Formulation<planar::Rigid, Constraint, GeneralisedAlpha>;
///     using Cable = Formulation<Meshed<planar::AncfCable<>, 8>, Constraint, GeneralisedAlpha>;
///     compare<Ideal, Cable>([](auto const& choice) { … model.add(choice.body(bar), "rod") … });
template <class B, Policy P, class I>
  requires Body<typename detail::MeshOf<B>::BodyType>
struct Formulation {
  using BodyType = typename detail::MeshOf<B>::BodyType;  ///< body formulation without mesh
  using PolicyType = P;                                   ///< policy that enforces the constraint equations of joints
  using IntegratorType = I;                               ///< numerical method for the equations of motion

  /// True if the body has a number of elements that can be set at run time.
  static constexpr bool has_mesh = requires { BodyType::default_elements; };
  /// True if the body has a number of modes that can be set at run time.
  static constexpr bool has_modes = requires(typename BodyType::Options o) { o.modes = 1; };

  std::string name = {};      ///< name in the report
  P policy = {};              ///< policy of the case's joints
  I integrator = {};          ///< integrator with its options
  FormulationMesh mesh = {};  ///< mesh of the body, if its type has none

  /// Creates the body by its function `from`, from `shape`, such as a bar, the mesh of the body, and `others`. If
  /// the body has no number of elements in its type or in `mesh`, it gets its default. With `others`, `mesh.modes` is
  /// ignored.
  template <class Shape, class... Others>
  BodyType body(Shape const& shape, Others&&... others) const {
    using Mesh = detail::MeshOf<B>;
    constexpr bool is_modal = requires { Mesh::modes; }, is_meshed = requires { Mesh::elements; };
    if constexpr (is_modal)
      return BodyType::from(shape, Mesh::elements, typename BodyType::Options{.modes = Mesh::modes},
                            std::forward<Others>(others)...);
    else if constexpr (is_meshed)
      return BodyType::from(shape, Mesh::elements, std::forward<Others>(others)...);
    else if constexpr (has_modes && sizeof...(Others) == 0) {
      typename BodyType::Options options;
      if (mesh.modes) options.modes = int(*mesh.modes);
      return BodyType::from(shape, BarMesh{.elements = mesh.elements}, options);
    } else if constexpr (has_mesh && sizeof...(Others) == 0)
      return BodyType::from(shape, BarMesh{.elements = mesh.elements});
    else if constexpr (has_mesh)
      return BodyType::from(shape, mesh.elements.value_or(BodyType::default_elements), std::forward<Others>(others)...);
    else
      return BodyType::from(shape, std::forward<Others>(others)...);
  }
};

/// Output of a case: a scalar function of the state that every formulation of the case provides.
template <class M>
struct Output {
  std::string name;                                     ///< name with unit
  std::function<double(M const&, State const&)> value;  ///< value in a state, in the unit of the name
};

/// Scenario of a case for one formulation: model, initial state, options of the run and outputs.
template <class M>
struct Scenario {
  M model;                                                    ///< model in one formulation
  State start;                                                ///< initial state of the run
  RunOptions options;                                         ///< options of the run
  std::vector<Output<M>> outputs = {};                        ///< outputs to compare
  std::function<void(M const&, State const&)> observer = {};  ///< called at every sample; not part of the CPU time
  /// Sampling interval T [s]: the first state at or after each time `start.t` + k T is sampled. If zero, every state is
  /// sampled. Set the interval if steps are much shorter than the time scale of the outputs.
  double sampling = 0.0;
};

/// Function object that returns the Scenario of a formulation. The type of the model may depend on the formulation.
template <class C, class F>
concept ComparisonCase = requires(C const c, F const f) {
  { c(f).model };
  { c(f).start } -> std::convertible_to<State>;
  { c(f).sampling } -> std::convertible_to<double>;
};

namespace detail {

/// Name of a formulation, or the name of its integrator if the formulation has no name.
template <class F>
std::string name_of(F const& formulation) {
  return formulation.name.empty() ? decltype(formulation.integrator)::name : formulation.name;
}
/// Family of the body of a formulation. `modal` is true if a study varies the number of modes.
template <class F>
std::string_view family_of(F const& formulation, bool modal) {
  if constexpr (requires { F::has_modes; }) modal = modal || (F::has_modes && formulation.mesh.modes.has_value());
  return modal ? families::ffr_modal : formulation_family<typename F::BodyType>;
}
/// Name `own`, with a number appended if an `earlier` run has the same name.
template <class = void>
std::string unique_name(std::vector<ComparedRun> const& earlier, std::string const& own) {
  std::string name = own;
  auto const taken = [&](ComparedRun const& run) { return run.name == name; };
  for (int i = 2; std::any_of(earlier.begin(), earlier.end(), taken); ++i) name = own + " (" + std::to_string(i) + ")";
  return name;
}

/// Checks that the outputs of a run have distinct, nonempty names, and that these names are the names in the `earlier`
/// runs.
/// \throws InvalidInput otherwise.
template <class = void>
void check_outputs(ComparedRun const& run, std::vector<ComparedRun> const& earlier) {
  std::vector<std::string> names = run.output_names;
  std::sort(names.begin(), names.end());
  bool const named = names.empty() || !names.front().empty();
  if (!named || std::adjacent_find(names.begin(), names.end()) != names.end())
    throw InvalidInput("compare.outputs",
                       {ErrorObject{"compare"}, ": the outputs of \"", run.name, "\" need distinct, nonempty names."});
  if (!earlier.empty() && run.output_names != earlier.front().output_names)
    throw InvalidInput(
        "compare.outputs",
        {ErrorObject{"compare"}, ": the outputs of \"", run.name, "\" differ from those of \"", earlier.front().name,
         "\". The case must return the same outputs in the same order for every formulation."});
}

/// Evaluations at each sampled state of a run, independent of the type of the case's model.
struct CaseQuestions {
  System system;
  std::vector<std::function<double(State const&)>> outputs = {};
  std::function<void(State const&)> observer = {};

  template <class = void>  // compiled where it is used
  void note(State const& x, ComparedRun& out) {
    Violation const& v = out.violations.emplace_back(largest_violation(system, x));  // evaluates the system
    out.violation.position = std::max(out.violation.position, v.position);
    out.violation.velocity = std::max(out.violation.velocity, v.velocity);
    out.violation.acceleration = std::max(out.violation.acceleration, v.acceleration);
    out.energies.push_back(energy(system, x));
    out.joint_forces.push_back(peak_joint_force(system, x));
    out.peak_joint_force = std::max(out.peak_joint_force, out.joint_forces.back());
    out.times.push_back(x.t);
    for (std::size_t i = 0; i < outputs.size(); ++i) out.outputs[i].push_back(outputs[i](x));
    if (observer) observer(x);
  }
};

/// Creates the evaluations of a scenario. The scenario must outlive the result.
template <class S>
CaseQuestions questions_of(S& scenario) {
  auto const& model = scenario.model;
  CaseQuestions questions{observation_system(model)};
  for (auto& o : scenario.outputs) questions.outputs.push_back([&](State const& x) { return o.value(model, x); });
  if (scenario.observer) questions.observer = [&](State const& x) { scenario.observer(model, x); };
  return questions;
}

/// Removes the values of the last recorded state if one of its evaluations failed.
template <class = void>
void drop_incomplete_state(ComparedRun& run) {
  std::size_t n = std::min({run.times.size(), run.violations.size(), run.energies.size(), run.joint_forces.size()});
  for (auto const& history : run.outputs) n = std::min(n, history.size());
  run.times.resize(n);
  run.violations.resize(n);
  run.energies.resize(n);
  run.joint_forces.resize(n);
  for (auto& history : run.outputs) history.resize(n);
}

/// Completes a run and records its first and last state, and the states between them that `sampling` selects. An
/// `Error` ends the run; its message is stored in `failure`. The CPU time contains the steps only.
template <class Run>
void record_run(Run& run, CaseQuestions& questions, double sampling, ComparedRun& out) {
  RunSampling samples(run.state().t, sampling);
  try {
    questions.note(run.state(), out);
    while (!run.done()) {
      std::clock_t const begin = std::clock();
      run.advance();
      out.cpu += double(std::clock() - begin) / CLOCKS_PER_SEC;
      if (samples.takes(run.state().t) || run.done()) questions.note(run.state(), out);
    }
  } catch (Error const& failed) {
    out.failure = failed.what();
  }
  drop_incomplete_state(out);
  if (!out.energies.empty()) {
    out.energy_start = out.energies.front().total();
    out.energy_end = out.energies.back().total();
  }
  out.run = run.report();
}

/// Runs the case of a formulation and adds the result to c.
template <class F, class C>
void add_run(C const& make_case, F const& formulation, Comparison& c) {
  auto scenario = make_case(formulation);
  ComparedRun out;
  out.name = unique_name(c.runs, name_of(formulation));
  if constexpr (requires { typename F::BodyType; }) out.family = family_of(formulation, false);
  if constexpr (requires { F::PolicyType::name; }) out.policy = F::PolicyType::name;
  out.problem_size = problem_size(scenario.model);
  for (auto const& o : scenario.outputs) out.output_names.push_back(o.name);
  check_outputs(out, c.runs);
  out.outputs.resize(scenario.outputs.size());
  require_not_negative(scenario.sampling, "compare: the sampling of ", "\"" + out.name + "\"");
  State x = scenario.start;
  try {
    auto run = simulate(scenario.model, x, formulation.integrator, scenario.options);
    CaseQuestions questions = questions_of(scenario);
    record_run(run, questions, scenario.sampling, out);
  } catch (Error const& failed) {
    out.failure = failed.what();
  }
  c.runs.push_back(std::move(out));
}

/// Computes the largest differences between the outputs of each run and the outputs of the first complete run.
template <class = void>
void compare_with_first(Comparison& c) {
  if (c.runs.empty()) return;
  ComparedRun const& first = c.reference();
  for (ComparedRun& run : c.runs)
    for (std::size_t i = 0; i < run.outputs.size(); ++i) {
      bool const known = first.failure.empty() && !run.times.empty();
      double most = known ? 0.0 : std::numeric_limits<double>::quiet_NaN();
      if (!known) {
        run.difference.push_back(most);
        continue;
      }
      for (std::size_t k = 0; k < run.times.size(); ++k)
        most = std::max(most, std::abs(run.outputs[i][k] - interpolate(first.times, first.outputs[i], run.times[k])));
      run.difference.push_back(most);
    }
}

}  // namespace detail

/// Runs the case that `make_case(formulation)` returns for each of the `formulations`. Formulations are passed as
/// objects, because some policies have parameters without defaults. If `simulate` or an output throws an `Error`, the
/// run stores the message in `failure` and keeps its results so far; the other runs continue.
/// `require_complete(compare(…))` throws if a run failed.
/// \throws InvalidInput if the names of the outputs are empty, repeated, or different between formulations, or if a
/// sampling interval is negative; exceptions of `make_case`.
template <class C, class... Fs>
  requires(ComparisonCase<C, Fs> && ...)
Comparison compare(C const& make_case, Fs const&... formulations) {
  Comparison c;
  (detail::add_run(make_case, formulations, c), ...);
  detail::compare_with_first(c);
  return c;
}

/// Overload for formulations whose parameters all have defaults: compare<F1, F2, …>(make_case).
template <class... Fs, class C>
  requires(sizeof...(Fs) > 0 && (ComparisonCase<C, Fs> && ...))
Comparison compare(C const& make_case) {
  return compare(make_case, Fs{}...);
}

/// Joins the runs of all `parts` in their order, and compares each with the first complete run. A number is appended to
/// repeated names.
/// \throws InvalidInput if the names of the outputs differ between runs.
template <class = void>  // compiled where it is used
Comparison join(std::vector<Comparison> const& parts) {
  Comparison all;
  for (Comparison const& part : parts)
    for (ComparedRun run : part.runs) {
      run.name = detail::unique_name(all.runs, run.name);
      detail::check_outputs(run, all.runs);
      run.difference.clear();
      all.runs.push_back(std::move(run));
    }
  detail::compare_with_first(all);
  return all;
}

}  // namespace polybody
