#pragma once
/// \file
/// What an integrator offers, and what it reports of a step.

#include <polybody/integrators/forward_dynamics.hpp>

namespace polybody {

/// What one accepted step cost.
struct StepReport {
  double taken = 0.0;        ///< length of the step [s]
  double next = 0.0;         ///< length suggested for the next one [s]
  int iterations = 0;        ///< Newton iterations; 0 for an explicit step
  int factorisations = 0;    ///< of the tangent or the mass matrix
  int evaluations = 0;       ///< of the forces
  int rejected = 0;          ///< trial steps thrown away by the step control, and steps that were halved
  int halved = 0;            ///< steps that failed and were repeated by halves (`RunOptions::max_step_halvings`)
  int order = 0;             ///< at which the step was taken, of a method that chooses it; else 0
  double contraction = 0.0;  ///< last contraction rate of Newton's method, a ratio
  long choices = 0;          ///< of independent coordinates since the start, by coordinate partitioning
  double left = 0.0;  ///< correction that it ended with relative to the tolerated one, at Newton's budget; else 0

  /// Adds the costs `of` failed attempts.
  void add(AttemptCost const& of) {
    iterations += of.iterations;
    factorisations += of.factorisations;
    evaluations += of.evaluations;
  }
  /// Adds the second half of a step that was halved.
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
/// Calls `rest` of an attempt at a step. If it throws, `failed` counts the attempt's cost so far.
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

/// The largest stable step of velocity Verlet, x₁ = x₀ + h v₀ + ½h² a₀, a₁ = −ω² x₁ − d (v₀ + h a₀), v₁ = v₀ + ½h (a₀ +
/// a₁): beyond ω²h² + 4dh = 4 it has a multiplier below −1. \param omega ω [1/s]  \param rate d [1/s]
template <class = void>
double verlet_stability_limit(double omega, double rate) {
  return 2.0 / (rate + std::sqrt(rate * rate + omega * omega));
}

/// An explicit integrator of fixed step tells when x¨ + d x˙ + ω² x = 0 grows without bound: `stability_limit`, the
/// largest ωh for d = 0, and `stable_step(ω, d)`, the largest h.
template <class I>
concept HasStabilityLimit = requires(double omega, double rate) {
  { I::stability_limit } -> std::convertible_to<double>;
  { I::stable_step(omega, rate) } -> std::convertible_to<double>;
};

/// A method takes steps of a `System`, of whatever origin. Its workspace is allocated once:
///   auto w = method.template workspace<Solver>(system);
///   method.start(system, x, h, w);      after a start, a jump or an event
///   method.step(system, x, h, w);       x is untouched when it throws; takes at most h
/// The workspace has a member `forward`, a `ForwardDynamics<Solver>`.
template <class Method, class Solver = DefaultSolver>
concept StepMethod = requires(Method const m, System& system, State& x, double h,
                              decltype(m.template workspace<Solver>(system))& workspace) {
  m.start(system, x, h, workspace);
  { m.step(system, x, h, workspace) } -> std::same_as<StepReport>;
  { workspace.forward } -> std::same_as<ForwardDynamics<Solver>&>;
};

/// What takes an integrator's steps: the method that its `method()` makes of its options, or the integrator itself.
/// \throws InvalidInput for options that its `check` refuses.
template <class I>
auto method_of(I const& integrator) {
  integrator.check();
  if constexpr (requires { integrator.method(); })
    return integrator.method();
  else
    return integrator;
}
/// The type of what takes the steps of integrator I.
template <class I>
using MethodOf = decltype(method_of(std::declval<I const&>()));

/// An integrator is a value with options, `check()`, and a method: `method()` makes it, or the integrator is one
/// itself. Static members say what it is and what it asks:
///   name, order, accepts_constraints
///   entries                   the groups of entries that a step calls (`Capabilities::motion` where it is not there)
///   adaptive_step             it chooses its step                             } true, or not there
///   needs_constant_mass       it asks for bodies of constant mass             }
///   coupled_stages    one linear system holds the model several times }
template <class I, class Solver = DefaultSolver>
concept Integrator = requires(I const i) {
  { I::name } -> std::convertible_to<char const*>;
  { I::order } -> std::convertible_to<int>;
  { I::accepts_constraints } -> std::convertible_to<bool>;
  i.check();
  requires StepMethod<MethodOf<I>, Solver>;
};

/// The groups of entries that integrator I asks of a model.
template <class I>
constexpr Capabilities entries_of() {
  if constexpr (requires { I::capabilities; })
    return I::capabilities;
  else
    return Capabilities::motion;
}

}  // namespace polybody
