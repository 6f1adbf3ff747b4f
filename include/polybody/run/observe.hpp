#pragma once
/// \file
/// Evaluation of joints in a single state: constraint violations and reactions.
/// Theory: Eq. 4.5.

#include <polybody/system/lookup.hpp>
#include <polybody/system/make_operations.hpp>
#include <polybody/system/system.hpp>

namespace polybody {

namespace detail {

/// Constraint equations of a joint with the index `joint` in the layout.
template <class = void>  // compiled only if used
ConstraintBlock<double> const& rows_of(System const& system, Index joint) {
  for (ConstraintBlock<double> const& block : system.data().rows)
    if (block.source != ConstraintSource::body && block.owner == joint) return block;
  throw InvalidInput("joint.no_equations", {"\"", ErrorObject{system.layout().joints[std::size_t(joint)].name},
                                            "\" has no constraint equations."});
}

/// Gbᵀλ of linear equations as a wrench about the joint point, with the columns Gb of the second body. Position
/// equations give the force, and a gradient r_α with its λ_α gives the moment r_α × λ_α. (The component of λ_α along
/// r_α stretches the gradient and exerts no wrench.) If the second body is the ground, r_α is the gradient of the first
/// body.
template <class T>  // compiled only if used
Vec<T, 6> linear_wrench(LinearConstraints const& rows, StateOf<T> const& x) {
  Vec<T, 6> w = Vec<T, 6>::Zero();
  Index const size = rows.positions;
  w.head(size) = x.lambda.segment(rows.row, size);
  LinearSide const& side = rows.b.map.cols() > 0 ? rows.b : rows.a;
  Index row = size;
  for (LinearConstraints::Gradient const& g : rows.gradients) {
    Vec<T, 3> now = Vec<T, 3>::Zero(), force = g.axis * x.lambda[rows.row + row];
    now.head(size) = g.map * x.q.segment(side.q0, g.map.cols());
    if (g.rows > 1) force.head(size) = x.lambda.segment(rows.row + row, size);
    w.template tail<3>() += now.cross(force);
    row += g.rows;
  }
  return w;
}

}  // namespace detail

/// Constraint violation of a joint (rows) [m], [rad] or [1]; `system` must have been evaluated at the state. \throws
/// InvalidInput for a handle of another model.
template <class J>
  requires(!LinearPolicy<typename J::PolicyType>)
Vec<double, J::rows> constraint_violation(System const& system, ElementHandle<J> const& joint) {
  return Vec<double, J::rows>(detail::rows_of(system, index_of_joint(system.layout(), joint)).g);
}
/// Constraint violation of an `AncfLinear` joint: first the position equations, then the gradient equations. The number
/// of equations depends on the bodies. \throws InvalidInput for a handle of another model.
template <class J>
  requires LinearPolicy<typename J::PolicyType>
VecX constraint_violation(System const& system, ElementHandle<J> const& joint) {
  ConstraintBlock<double> const& block = detail::rows_of(system, index_of_joint(system.layout(), joint));
  return Eigen::Map<VecX const>(block.g, block.rows);
}

/// Axes for the components of a reaction.
enum class ReactionAxes { world, joint };

/// Force and moment that a joint exerts on its second body, about the joint point on this body: −Gbᵀλ, with the columns
/// Gb of this body [thesis Eq. 3.3 and the rule of equipollent forces]. `ReactionAxes::joint` are the axes of the
/// second marker. `system` must have been evaluated at x.
/// \param joint index in the layout, from `index_of_joint`
template <class T>  // compiled only if used
Wrench<T> reaction_of(BasicSystem<T> const& system, StateOf<T> const& x, Index joint,
                      ReactionAxes axes = ReactionAxes::world) {
  JointLayout const& place = system.layout().joints[std::size_t(joint)];
  ConstraintBlock<double> const& block = detail::rows_of(system, joint);
  Vec<T, 6> w;
  if (block.source == ConstraintSource::linear)
    w = detail::linear_wrench(*place.linear, x);
  else
    wrench_at(block, block.b, block.multiplier(x.lambda), w.data());
  w = -w;
  Wrench<T> wrench{w.template head<3>(), w.template tail<3>()};
  if (axes == ReactionAxes::joint) {
    Mat<T, 3, 3> const& axes_of_b = system.data().markers[std::size_t(place.b)].frame.A;
    wrench = {axes_of_b.transpose() * wrench.f, axes_of_b.transpose() * wrench.m};
  }
  return wrench;
}
/// Force and moment that a joint exerts on its second body, about the joint point on this body (`reaction_of`).
/// `system` must have been evaluated at x. \throws InvalidInput for a handle of another model or a joint without
/// constraint equations.
template <class J>
Wrench<double> reaction(System const& system, State const& x, ElementHandle<J> const& joint,
                        ReactionAxes axes = ReactionAxes::world) {
  return reaction_of(system, x, index_of_joint(system.layout(), joint), axes);
}

/// Largest force of any joint on its second body [N], for all policies; `system` must have been evaluated at x.
template <class = void>
double peak_joint_force(System const& system, State const& x) {
  double peak = 0.0;
  for (ConstraintBlock<double> const& block : system.data().rows) {
    double w[6];
    if (block.source == ConstraintSource::linear) {
      for (int i = 0; i < 3; ++i) w[i] = i < block.positions ? x.lambda[block.row + i] : 0.0;
    } else {
      wrench_at(block, block.b, block.multiplier(x.lambda), w);
    }
    peak = std::max(peak, std::sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]));
  }
  return peak;
}

/// Largest |Φ|, |Φ̇| and |Φ̈| of a state.
struct Violation {
  double position = 0.0;      ///< largest |Φ| [m], [rad]
  double velocity = 0.0;      ///< largest |Φ̇| [m/s], [rad/s]
  double acceleration = 0.0;  ///< largest |Φ̈| [m/s²], [rad/s²]
};

namespace detail {
/// Largest constraint violations in state x. `system` must have been evaluated at x.
template <class = void>
Violation violation_of(System& system, State const& x) {
  if (system.rows() == 0) return {};
  VecX phi = VecX::Zero(system.rows()), rate = phi, second = phi;
  system.violation(phi);
  system.violation_rate(rate);
  system.acceleration_bias(second);
  VecX of_accelerations = phi;
  system.rows_times(x.a, of_accelerations);
  second += of_accelerations;
  return {largest_size(phi), largest_size(rate), largest_size(second)};
}
}  // namespace detail

/// Largest constraint violations in state x. Evaluates `system` at x.
template <class = void>
Violation largest_violation(System& system, State const& x) {
  system.evaluate(x.q, x.v, x.t);
  return detail::violation_of(system, x);
}

}  // namespace polybody
