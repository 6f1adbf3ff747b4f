#pragma once
/// \file
/// Questions about the joints in a single state: gaps, reactions, violations.

#include <polybody/run/marker_frames.hpp>
#include <polybody/run/problem_size.hpp>
#include <polybody/run/state_checks.hpp>
#include <polybody/system/make_operations.hpp>
#include <polybody/system/system.hpp>

namespace polybody {

namespace detail {

/// The rows of a joint, by its place in the layout.
template <class = void>  // compiled where it is used
ConstraintBlock<double> const& rows_of(System const& system, Index joint) {
  for (ConstraintBlock<double> const& block : system.data().rows)
    if (block.source != ConstraintSource::body && block.owner == joint) return block;
  throw InvalidInput("joint.no_equations", {"\"", ErrorObject{system.layout().joints[std::size_t(joint)].name},
                                            "\" has no constraint equations."});
}

/// Gbᵀλ of linear rows as a wrench about the joint point: those of the position give the force, a gradient r_α with its
/// λ_α the moment r_α × λ_α. (What stretches r_α is no wrench.) The ground takes what its body gives: r_α is the
/// body's.
template <class T>  // compiled where it is used
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

/// Violation of a joint's rows; `system` must have been evaluated at the state. \throws InvalidInput for a handle of
/// another model.
template <class J>
  requires(!LinearPolicy<typename J::PolicyType>)
Vec<double, J::rows> constraint_violation(System const& system, ElementHandle<J> const& joint) {
  return Vec<double, J::rows>(detail::rows_of(system, index_of_joint(system.layout(), joint)).g);
}
/// Violation of the equations of an `AncfLinear` joint, first those of the position, then those of gradients. Their
/// number depends on the bodies. \throws InvalidInput as above.
template <class J>
  requires LinearPolicy<typename J::PolicyType>
VecX constraint_violation(System const& system, ElementHandle<J> const& joint) {
  ConstraintBlock<double> const& block = detail::rows_of(system, index_of_joint(system.layout(), joint));
  return Eigen::Map<VecX const>(block.g, block.rows);
}
/// Violation of a joint's rows in state x. \throws InvalidInput as above.
template <class M, class J>
auto constraint_violation(M const& model, State const& x, ElementHandle<J> const& joint) {
  System system(model, with<Capabilities::motion>);
  require_usable(system, x);
  system.evaluate(x.q, x.v, x.t);
  return constraint_violation(system, joint);
}

/// Axes for the components of a reaction.
enum class ReactionAxes { world, joint };

/// Force and moment that a joint exerts on its second body, about the joint point there:
/// −Gbᵀλ [thesis Eq. 3.3 and the rule of equipollent forces]; "joint" are the axes of the second marker. `system` must
/// have been evaluated at x. \param joint its place in the layout, as `index_of_joint` finds it
template <class T>  // compiled where it is used
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
/// The same of the joint that a handle names. \throws InvalidInput for a handle of another model.
template <class J>
Wrench<double> reaction(System const& system, State const& x, ElementHandle<J> const& joint,
                        ReactionAxes axes = ReactionAxes::world) {
  return reaction_of(system, x, index_of_joint(system.layout(), joint), axes);
}
/// The same in state x of a model. \throws InvalidInput as above.
template <class M, class J>
Wrench<double> reaction(M const& model, State const& x, ElementHandle<J> const& joint,
                        ReactionAxes axes = ReactionAxes::world) {
  System system(model, with<Capabilities::motion>);
  require_usable(system, x);
  system.evaluate(x.q, x.v, x.t);
  return reaction(system, x, joint, axes);
}

/// The largest force of any joint on its second body [N], whatever its policy; `system` must have been evaluated at x.
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
  double position = 0.0;      ///< [m], [rad]
  double velocity = 0.0;      ///< [m/s], [rad/s]
  double acceleration = 0.0;  ///< [m/s²], [rad/s²]
};

/// The violation of state x; `system` is evaluated there.
template <class = void>
Violation largest_violation(System& system, State const& x) {
  system.evaluate(x.q, x.v, x.t);
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
/// \throws InvalidInput for a state of another model.
template <class M>
  requires(!std::same_as<M, System>)
Violation largest_violation(M const& model, State const& x) {
  System system(model, with<Capabilities::motion>);
  require_usable(system, x);
  return largest_violation(system, x);
}

}  // namespace polybody
