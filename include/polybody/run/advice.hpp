#pragma once
/// \file
/// Advice after a run: distribution of its processor time over the operations of a step, and explicit integrators that
/// are stable and need less time.
/// Theory: Eqs. 6.37, 11.37.

#include <array>
#include <chrono>

#include <polybody/integrators/step_tangent.hpp>
#include <polybody/run/diagnose.hpp>
#include <polybody/run/simulation.hpp>

namespace polybody {

/// Estimate of the cost of a run, from its report and from times of single operations at the present state.
struct Advice {
  double step_time = 0.0;       ///< processor time of a step [s]
  double forces = 0.0;          ///< fraction of force elements and contacts in this time [1]
  double equations = 0.0;       ///< fraction of bodies and joints in this time [1]
  double factorisations = 0.0;  ///< fraction of the tangents and their factorisations in this time [1]
  double solutions = 0.0;       ///< fraction of the solutions of linear equations in this time [1]
  double iterations = 0.0;      ///< Newton iterations per step [1]
  double failed = 0.0;          ///< rejected and halved steps per step [1]
  Index islands = 1;            ///< number of islands, which contacts and joints do not connect

  /// An explicit integrator that is stable at the present state and needs less time for the same duration.
  struct Explicit {
    std::string integrator;  ///< name of the integrator
    double step;             ///< stable step, at most the step of the run [s]
    double time;             ///< processor time, relative to that of the run [1]
  };
  std::vector<Explicit> faster = {};  ///< in the order of time; empty for a run with an explicit integrator
};

namespace detail {

/// Least processor time of a few calls [s].
template <class F>
double time_of(F const& call) {
  using Clock = std::chrono::steady_clock;
  double least = std::numeric_limits<double>::infinity();
  auto const begin = Clock::now();
  for (int k = 0; k < 5 || (k < 1000 && Clock::now() - begin < std::chrono::milliseconds(2)); ++k) {
    auto const before = Clock::now();
    call();
    least = std::min(least, std::chrono::duration<double>(Clock::now() - before).count());
  }
  return least;
}

/// Times of the operations of a step [s].
struct OperationTimes {
  double evaluation, forces, factorisation, solution;
};
/// Times of the operations of an implicit step with the length h [s] at x.
template <class Solver>
OperationTimes times_of_implicit_step(System& system, State const& x, double h) {
  StepTangent<Solver> tangent;
  tangent.analyse(system, SecondOrder::omitted, x.lambda);
  At<double> const at{x.q, x.v, x.t};
  VecX r = VecX::Zero(system.velocities()), rhs = VecX::Zero(system.velocities() + multipliers_of(system)), y = rhs;
  OperationTimes out{};
  out.evaluation = time_of([&] {
    tangent.evaluate(system, at);
    tangent.balance(system, {at, x.a, x.lambda}, r);
  });
  system.evaluate(x.q, x.v, x.t);
  out.forces = time_of([&] { system.push_forces(x.lambda); });
  TangentCoefficients const k{.mass = 1.0, .damping = 0.5 * h, .stiffness = 0.25 * h * h};
  out.factorisation = time_of([&] { (void)tangent.factor(system, {at, x.a, x.lambda}, k); });
  out.solution = time_of([&] { tangent.correct(rhs, y); });
  return out;
}
/// Times of the operations of an explicit step at x.
template <class Solver>
OperationTimes times_of_explicit_step(System& system, State const& x) {
  ForwardDynamics<Solver> forward(system);
  VecX a = x.a, lambda = x.lambda, w = VecX::Zero(system.velocities()), mu = VecX::Zero(system.rows());
  OperationTimes out{};
  out.evaluation = time_of([&] { system.evaluate(x.q, x.v, x.t); });
  out.forces = time_of([&] { system.push_forces(lambda); });
  double const all = time_of([&] { forward.accelerations(system, {x.q, x.v, x.t}, a, lambda); });
  out.solution = time_of([&] { forward.response(system, w, a, mu); });
  out.evaluation += out.forces;
  out.factorisation = std::max(0.0, all - out.evaluation - out.solution);
  return out;
}

/// Adds explicit integrator I to `out` if it is stable for undamped motions of frequency ω [rad/s] and decay rates d
/// [1/s], and needs at most 0.7 of the time `step_time`/h. \param stage processor time of an evaluation of the
/// accelerations [s] \param evaluations number of these evaluations in a step
template <HasStabilityLimit I>
void add_if_faster(Advice& out, double h, std::array<double, 2> const& omega_and_rate, double stage, int evaluations) {
  auto const [omega, rate] = omega_and_rate;
  double const limit = omega > 0.0 || rate > 0.0 ? I::stable_step(omega, rate) : h;
  double const step = std::min(h, 0.8 * limit);
  double const time = stage * evaluations / step / (out.step_time / h);
  if (time <= 0.7) out.faster.push_back({I::name, step, time});
}

/// System and state of a run: reduced ones of its steps, and full ones of the model.
struct RunPlace {
  System& system;
  State const& x;
  System& full;
  State const& full_x;
};
/// Advice for a run that `report` describes. \param is_explicit true if the integrator solves no equations for the end
/// of a step
template <class Solver>
Advice advice_of(RunPlace const& at, RunReport const& report, bool is_explicit) {
  auto const& [system, x, full, full_x] = at;
  Advice out;
  if (report.steps == 0) return out;
  double const steps = double(report.steps), h = report.last.taken;
  OperationTimes const times =
      is_explicit ? times_of_explicit_step<Solver>(system, x) : times_of_implicit_step<Solver>(system, x, h);
  double const solutions = double(is_explicit ? report.evaluations : report.iterations);
  out.forces = double(report.evaluations) * times.forces / steps;
  out.equations = double(report.evaluations) * std::max(0.0, times.evaluation - times.forces) / steps;
  out.factorisations = double(report.factorisations) * times.factorisation / steps;
  out.solutions = solutions * times.solution / steps;
  out.step_time = out.forces + out.equations + out.factorisations + out.solutions;
  for (double* const part : {&out.forces, &out.equations, &out.factorisations, &out.solutions}) *part /= out.step_time;
  out.iterations = double(report.iterations) / steps;
  out.failed = double(report.rejected) / steps;
  if (!system.step_coordinates()) out.islands = std::max<Index>(1, Index(system.operations().islands().size()));
  if (is_explicit) return out;
  try {
    ForwardDynamics<DefaultSolver> forward(system), of_full(full);
    VecX a = x.a, lambda = x.lambda;
    double const stage = time_of([&] { forward.accelerations(system, {x.q, x.v, x.t}, a, lambda); });
    of_full.hold(full, full_x.q, full_x.v, full_x.t);
    double const omega = StiffestMotion(full, of_full).frequency();
    double const rate = std::pow(StiffestMotion(full, of_full, {.damping = 1.0}).frequency(), 2);
    int const projections = system.rows() > 0 ? 2 : 0;
    add_if_faster<RungeKutta4<>>(out, h, {omega, rate}, stage, 4 + projections);
    if (projections == 0) add_if_faster<SymplecticEuler>(out, h, {omega, rate}, stage, 1);
  } catch (Error const&) {  // no accelerations without mass: no explicit integrator
    out.faster.clear();
  }
  std::sort(out.faster.begin(), out.faster.end(), [](auto const& a, auto const& b) { return a.time < b.time; });
  return out;
}

}  // namespace detail

/// Advice for the rest of a run, or for its repetition. The times are measured at the present state, in about 20 ms for
/// a small model; the run continues unchanged. Stability limits hold for the contacts and stiffnesses of the present
/// state only.
template <Integrator I, class Solver>
Advice advise(Simulation<I, Solver>& run) {
  State x = reduce(run.system(), run.state());
  append_multipliers(run.system(), x);
  bool const is_explicit = HasStabilityLimit<I> || run.report().iterations == 0;
  return detail::advice_of<Solver>({run.system(), x, run.full(), run.state()}, run.report(), is_explicit);
}

/// Writes the advice as text, with one line for each finding. Numbers have two digits.
template <class = void>
std::ostream& operator<<(std::ostream& out, Advice const& a) {
  if (a.step_time == 0.0) return out << "The run has no step yet.\n";
  auto const percent = [](double fraction) { return std::lround(100.0 * fraction); };
  auto const rounded = [](double value) {
    double const unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
    return std::floor(value / unit + 0.01) * unit;
  };
  out << sentence_of({"A step takes about ", rounded(1e6 * a.step_time), " µs: force elements ", percent(a.forces),
                      " %, bodies and joints ", percent(a.equations), " %, factorisations ", percent(a.factorisations),
                      " %, solutions ", percent(a.solutions), " %.\n"});
  if (a.iterations > 5.0)
    out << sentence_of({"Newton's method needs ", rounded(a.iterations),
                        " iterations per step. Contacts that begin, end or change between stick and slip are a usual "
                        "cause. A shorter step needs fewer iterations.\n"});
  if (a.failed > 0.01)
    out << sentence_of({percent(a.failed), " % of the steps failed or were rejected at first. Try a shorter step.\n"});
  if (a.islands > 1) out << sentence_of({"The model has ", std::to_string(a.islands), " independent parts.\n"});
  for (Advice::Explicit const& e : a.faster)
    out << sentence_of({e.integrator, " is stable at this state with steps of ", rounded(e.step),
                        " s, and needs about ", percent(e.time), " % of the time.\n"});
  return out;
}

}  // namespace polybody
