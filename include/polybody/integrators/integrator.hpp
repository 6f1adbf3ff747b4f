#pragma once
/// \file
/// Concept of an integrator, and the report of a step.

#include <polybody/integrators/forward_dynamics.hpp>

namespace polybody {

/// Cost of one accepted step.
struct StepReport {
  double taken = 0.0;        ///< length of the step [s]
  double next = 0.0;         ///< suggested length of the next step [s]
  int iterations = 0;        ///< Newton iterations; 0 for an explicit step
  int factorisations = 0;    ///< factorisations of the tangent or the mass matrix
  int evaluations = 0;       ///< evaluations of the forces
  int rejected = 0;          ///< trial steps that the step control rejected, and halved steps
  int halved = 0;            ///< failed steps that were repeated as two halves (`RunOptions::max_step_halvings`)
  int order = 0;             ///< order of the step, if the method has variable order; otherwise 0
  double contraction = 0.0;  ///< last contraction rate of Newton's method [1]
  long choices = 0;          ///< selections of independent coordinates since the start, by coordinate partitioning
  double left = 0.0;         ///< last correction over its tolerance, if the iteration budget ended the step; or 0

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
    contraction = second.contraction;
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
}  // namespace detail

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
/// The workspace has a member `forward`, a `ForwardDynamics<Solver>`.
template <class Method, class Solver = DefaultSolver>
concept StepMethod = requires(Method const m, System& system, State& x, double h,
                              decltype(m.template workspace<Solver>(system))& workspace) {
  m.start(system, x, h, workspace);
  { m.step(system, x, h, workspace) } -> std::same_as<StepReport>;
  { workspace.forward } -> std::same_as<ForwardDynamics<Solver>&>;
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

}  // namespace polybody
