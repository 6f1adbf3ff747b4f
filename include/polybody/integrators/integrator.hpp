#pragma once
/// \file
/// Concept of an integrator, the report and the checks of a step, and the next state of an explicit method.
/// Theory: Eq. 6.37.

#include <polybody/integrators/forward_dynamics.hpp>
#include <polybody/system/plausibility_check.hpp>

namespace polybody {

/// Cost of failed attempts at a step.
struct AttemptCost {
  int iterations = 0, factorisations = 0, evaluations = 0;  ///< as in `StepReport`
};

/// Cost of one accepted step. If a step solves islands apart, each number is the largest one of an island.
struct StepReport {
  double taken = 0.0;        ///< length of the step [s]
  double next = 0.0;         ///< suggested length of the next step [s]
  int iterations = 0;        ///< Newton iterations, or corrections of positions in `Rattle`; otherwise 0
  int factorisations = 0;    ///< factorisations of the tangent or the mass matrix
  int evaluations = 0;       ///< evaluations of the forces
  int rejected = 0;          ///< trial steps that the step control rejected, and halved steps
  int halved = 0;            ///< failed steps that were repeated as two halves (`RunOptions::max_step_halvings`)
  int order = 0;             ///< order of the step, if the method has variable order; otherwise 0
  double contraction = 0.0;  ///< last contraction rate of Newton's method [1]
  long choices = 0;          ///< selections of independent coordinates in `RungeKutta4` and `AdamsBashforthMoulton`
  double left = 0.0;         ///< last correction, a multiple of its tolerance, if the budget ended the step; else 0 [1]

  /// Adds the cost `of` failed attempts.
  void add(AttemptCost const& of) {
    iterations += of.iterations;
    factorisations += of.factorisations;
    evaluations += of.evaluations;
  }
  /// Adds the `second` half of a halved step.
  void append(StepReport const& second) {
    taken += second.taken;
    next = second.next;
    add({second.iterations, second.factorisations, second.evaluations});
    rejected += second.rejected;
    halved += second.halved;
    order = second.order;
    contraction = second.contraction;
    choices = second.choices;
    left = std::max(left, second.left);
  }
};

namespace detail {
/// Calls `rest`, the remaining part of an attempt at a step. If `rest` throws, the cost of the attempt so far is added
/// to `failed`.
template <class Rest>
auto count_if_failed(AttemptCost& failed, StepReport const& cost, Rest&& rest) {
  try {
    return rest();
  } catch (...) {
    failed.iterations += cost.iterations;
    failed.factorisations += cost.factorisations;
    failed.evaluations += cost.evaluations;
    throw;
  }
}
/// Checks the end of a step. \throws NonFiniteValue naming body and time if a coordinate or velocity is NaN, infinite
/// or above `largest_number`.
template <class = void>
void require_finite_end(System const& s, VecX const& q, VecX const& v, double t) {
  Index const in_v = first_not_finite(v), in_q = in_v < 0 ? first_not_finite(q) : -1;
  if (in_v < 0 && in_q < 0) return;
  throw NonFiniteValue("motion.not_finite",
                       {"The motion of ", ErrorObject{in_v < 0 ? name_of_coordinate(s, in_q) : s.name_of(in_v)},
                        non_finite_suffix(in_v < 0 ? q[in_q] : v[in_v]), " at t = ", ErrorTime{t},
                        " s. Check its velocity and the forces on it before this time.", and_whose_force(s)});
}
}  // namespace detail

/// Checks of the steps of a run, and the cost of steps that failed. The run sets the limits and resets the cost.
struct StepCheck {
  PlausibilityCheck bounds;  ///< plausibility limits of the run; inactive until the run begins
  AttemptCost failed;        ///< cost of failed attempts since the run reset this sum

  /// Checks the end of a step before the step is accepted. \throws NonFiniteValue, Diverged.
  template <class = void>  // compiled only if used
  void require_end(System& system, StepResult const& end) {
    double const of_velocities = squares(end.v);
    if (!(of_velocities + squares(end.q) <= largest_number * largest_number))
      detail::require_finite_end(system, end.q, end.v, end.t);  // checks each number
    bounds.require(system, end, of_velocities);
  }
};

/// Trial of a step with a workspace. Without `keep`, the destructor restores the energy account of `StepCheck::bounds`
/// and the elimination order of `forward`, so that a repeated step is bitwise identical.
template <class Workspace>
class StepTrial {
 public:
  /// Stores the energy account and the elimination order, and resets the cost of failed attempts.
  explicit StepTrial(Workspace& w) : w_(w), bounds_(w.check.bounds), reorderings_(w.forward.reorderings()) {
    w.check.failed = {};
  }
  StepTrial(StepTrial const&) = delete;
  ~StepTrial() {
    if (!kept_) w_.forward.limit_reorderings(reorderings_);
  }
  /// Accepts the trial: the destructor restores nothing.
  void keep() {
    bounds_.keep();
    kept_ = true;
  }

 private:
  Workspace& w_;
  PlausibilityCheck::Trial bounds_;
  std::size_t reorderings_;
  bool kept_ = false;
};

/// Largest stable step of velocity Verlet, x₁ = x₀ + h v₀ + ½h² a₀, a₁ = −ω² x₁ − d (v₀ + h a₀), v₁ = v₀ + ½h (a₀ +
/// a₁): beyond ω²h² + 4dh = 4 an amplification factor lies below −1. \param omega ω [1/s] \param rate d [1/s]
template <class = void>
double verlet_stability_limit(double omega, double rate) {
  return 2.0 / (rate + std::sqrt(rate * rate + omega * omega));
}

/// Explicit integrator of fixed step with a known stability limit for x¨ + d x˙ + ω² x = 0: `stability_limit` is the
/// largest ωh for d = 0, and `stable_step(ω, d)` is the largest h.
template <class I>
concept HasStabilityLimit = requires(double omega, double rate) {
  { I::stability_limit } -> std::convertible_to<double>;
  { I::stable_step(omega, rate) } -> std::convertible_to<double>;
};

/// Method that performs steps of any `System`. Its workspace is allocated once:
///   auto w = method.template workspace<Solver>(system);
///   method.start(system, x, h, w);      after a start, a jump or an event
///   method.step(system, x, h, w);       advances by at most h; x is unchanged after an exception
/// The workspace has members `forward`, a `ForwardDynamics<Solver>`, and `check`, a `StepCheck`.
template <class Method, class Solver = DefaultSolver>
concept StepMethod = requires(Method const m, System& system, State& x, double h,
                              decltype(m.template workspace<Solver>(system))& workspace) {
  m.start(system, x, h, workspace);
  { m.step(system, x, h, workspace) } -> std::same_as<StepReport>;
  { workspace.forward } -> std::same_as<ForwardDynamics<Solver>&>;
  { workspace.check } -> std::same_as<StepCheck&>;
};

/// Method of an integrator: the result of its `method()`, or the integrator itself. \throws InvalidInput for options
/// that its `check` refuses.
template <class I>
auto method_of(I const& integrator) {
  integrator.check();
  if constexpr (requires { integrator.method(); })
    return integrator.method();
  else
    return integrator;
}
/// Type of the method of integrator I.
template <class I>
using MethodOf = decltype(method_of(std::declval<I const&>()));

/// An integrator is a value with options, `check()`, and a method: `method()` returns it, or the integrator is itself
/// the method. Its static members are
///   name, order, accepts_constraints
///   capabilities          groups of evaluations that a step calls (default: `Capabilities::motion`)
///   adaptive_step         selects the length of its steps                } true, or absent
///   needs_constant_mass   requires bodies with a constant mass matrix    }
///   coupled_stages        one linear system contains the model several times }
///   Derivatives           class with the templates LinearisedStep and StepAdjoint, for `sensitivities` and `gradient`
template <class I, class Solver = DefaultSolver>
concept Integrator = requires(I const i) {
  { I::name } -> std::convertible_to<char const*>;
  { I::order } -> std::convertible_to<int>;
  { I::accepts_constraints } -> std::convertible_to<bool>;
  i.check();
  requires StepMethod<MethodOf<I>, Solver>;
};

/// Groups of evaluations that integrator I requires of a model.
template <class I>
constexpr Capabilities entries_of() {
  if constexpr (requires { I::capabilities; })
    return I::capabilities;
  else
    return Capabilities::motion;
}

namespace detail {

/// Next state of an explicit one-step method, with the memory for its computation.
template <class Solver>
struct ExplicitStep {
  VecX q, v, a, dq, lambda;
  ForwardDynamics<Solver> forward;
  StepCheck check;

  explicit ExplicitStep(System& s)
      : q(VecX::Zero(s.coordinates())),
        v(VecX::Zero(s.velocities())),
        a(v),
        dq(v),
        lambda(VecX::Zero(s.rows())),
        forward(s) {}

  /// Stores the next state in x, as the state at x.t + h. \param cost cost of the step, added to `check.failed` if
  /// the check of the state fails \throws NonFiniteValue, Diverged.
  void accept(System& system, State& x, double h, StepReport const& cost = {}) {
    count_if_failed(check.failed, cost, [&] { check.require_end(system, {q, v, lambda, x.t + h, h}); });
    x.q.swap(q);
    x.v.swap(v);
    x.a.swap(a);
    x.lambda.swap(lambda);
    x.t += h;
  }
};

}  // namespace detail

}  // namespace polybody
