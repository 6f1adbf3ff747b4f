#pragma once
/// \file
/// Accelerations of points, and computation of a state's accelerations by forward dynamics.
/// Theory: Eq. 5.2.

#include <polybody/integrators/forward_dynamics.hpp>
#include <polybody/run/marker_frames.hpp>
#include <polybody/run/state_checks.hpp>
#include <polybody/system/make_operations.hpp>

namespace polybody {

/// Sets the accelerations and multipliers of x by forward dynamics,
///   M v̇ + Gᵀλ = f,  G v̇ = −γ   [Haug 1989, §11.2],
/// from the coordinates, velocities and time of x. The velocities should satisfy the constraint equations (`assemble`).
/// The multipliers of redundant constraints are zero. Coordinates, velocities and first-order states do not change.
/// \throws InvalidInput for a state of another model; SingularMatrix; NonFiniteValue. After an exception x is
/// unchanged.
template <LinearSolver Solver = DefaultSolver>
void compute_accelerations(System& system, State& x) {
  require_usable(system, x);
  ForwardDynamics<Solver> forward(system);
  VecX a = x.a, lambda = x.lambda;
  forward.accelerations(system, {x.q, x.v, x.t}, a, lambda);
  x.a.swap(a);
  x.lambda.swap(lambda);
}
/// Sets the accelerations and multipliers of state x of `model` by forward dynamics, with the conditions and exceptions
/// of the overload for `System`.
template <class M>
  requires(!std::same_as<M, System>)
void compute_accelerations(M const& model, State& x) {
  System system(model, with<Capabilities::motion>);
  compute_accelerations(system, x);
}

namespace detail {

/// Requires equilibrium of the forces in a state x whose accelerations are all zero, such as a state from
/// `reference_state` or `assemble`. The limit of the unbalanced force is 1e-6 times the largest load, weight, applied
/// force or reaction.
/// \throws InvalidInput otherwise.
template <class = void>
[[gnu::cold]] void require_accelerations(System system, State const& x) {
  require_usable(system, x);
  system.evaluate(x.q, x.v, x.t);
  VecX const none = VecX::Zero(x.lambda.size());
  VecX r = VecX::Zero(x.v.size()), free = r, unloaded = r;
  system.residual(x.a, none, free);
  system.residual(x.a, x.lambda, r);
  system.load_factor = 0.0;
  system.residual(x.a, none, unloaded);
  double scale = std::max(largest_size(VecX(r - free)), largest_size(VecX(free - unloaded)));
  for (AppliedWrench<double> const& action : system.data().actions)
    for (double const w : action.w) scale = std::max(scale, std::abs(w));
  Index const bodies = system.layout().body_velocities();
  if (!(largest_size(VecX(r.head(bodies))) > 1e-6 * scale) || scale == 0.0) return;
  throw InvalidInput("state.accelerations",
                     {"The state at t = ", ErrorTime{x.t},
                      " s has no accelerations: all are zero, but its forces are not in equilibrium. Call "
                      "compute_accelerations(model, x), or use a state from simulate."});
}

/// Twist rate J v̇ + bias of a point (6), world axes.
template <class B>
Vec6 twist_rate(BodyInState<B> const& body, typename B::Point const& point, State const& x) {
  Index const first = Index(body.v.data() - x.v.data()) + body.body.first_column(point);
  if (x.a.size() != x.v.size()) refuse_unfitting_state();
  Sequence<double> jacobian;
  MarkerKinematics<double> const p = evaluate_marker(body, point, jacobian);
  return p.push(x.a.data() + first) + p.bias;
}

/// True if all accelerations of x are zero.
inline bool lacks_accelerations(State const& x) { return largest_size(x.a) == 0.0; }

}  // namespace detail

/// Rate of the twist of a material point: acceleration [m/s²] and angular acceleration [rad/s²] (6), world axes,
///   J v̇ + bias, with v̇ = x.a.
/// x.a contains the accelerations of the state after `compute_accelerations` and `equilibrium`, and in the states of
/// `simulate`. The integrators `EnergyMomentum` and `EnergyDecaying` are an exception: they store the mean
/// accelerations of the last step. Call `compute_accelerations` for their states, for those of `reference_state()` and
/// `assemble`, and for states that were changed by hand. Accelerations of implicit integrators and of `Rattle` satisfy
/// G v̇ = −γ only up to the error of the method. Accelerations of forward dynamics satisfy this equation exactly.
/// \throws InvalidInput for a marker or state of another model, and for a state without accelerations: all are zero,
/// but the forces are not in equilibrium.
template <class M, class B>
Vec6 twist_rate(M const& model, State const& x, Marker<B> const& marker) {
  BodyInState<B> const body = body_in_state(model, x, marker, "acceleration");
  if (detail::lacks_accelerations(x)) detail::require_accelerations(System(model, with<Capabilities::motion>), x);
  return detail::twist_rate(body, marker.point, x);
}
/// Rate of the twist of a marker on the ground: zero.
template <class M>
Vec6 twist_rate(M const& model, State const&, Marker<Ground> const& marker) {
  model.require_own(marker, "acceleration");
  return Vec6::Zero();
}

/// Acceleration of a material point (3), world axes [m/s²]; see `twist_rate`. An accelerometer at the point measures
/// this acceleration minus the gravity vector, in the axes of the marker.
template <class M, class B>
Vec3 acceleration(M const& model, State const& x, Marker<B> const& marker) {
  return twist_rate(model, x, marker).template head<3>();
}
/// Angular acceleration of a marker (3), world axes [rad/s²]; see `twist_rate`.
template <class M, class B>
Vec3 angular_acceleration(M const& model, State const& x, Marker<B> const& marker) {
  return twist_rate(model, x, marker).template tail<3>();
}

/// Generalised accelerations of one body in state x: time derivatives of `velocities_of`. \throws InvalidInput under
/// the conditions of `twist_rate`.
template <class M, class B>
std::span<double const> accelerations_of(M const& model, State const& x, BodyHandle<B> const& handle) {
  std::span<double const> const v = body_in_state(model, x, handle).v;
  if (detail::lacks_accelerations(x)) detail::require_accelerations(System(model, with<Capabilities::motion>), x);
  return std::span(x.a.data() + (v.data() - x.v.data()), v.size());
}
/// Deleted: the result would refer to a temporary state.
template <class M, class B>
std::span<double const> accelerations_of(M const&, State&&, BodyHandle<B> const&) = delete;

}  // namespace polybody
