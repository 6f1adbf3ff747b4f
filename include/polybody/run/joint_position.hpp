#pragma once
/// \file
/// Position of a joint in a state: angle, translation and their rates. Full turns are counted over the states of a run.
/// Theory: Eqs. 4.10, 4.14, 11.4.

#include <cmath>
#include <numbers>

#include <polybody/joints/joint_coordinate.hpp>
#include <polybody/run/state_checks.hpp>
#include <polybody/system/lookup.hpp>
#include <polybody/system/make_operations.hpp>
#include <polybody/system/system.hpp>

namespace polybody {

namespace detail {

/// Value and rate of a joint angle [rad], [rad/s] or of a joint translation [m], [m/s].
struct JointValue {
  double value = 0.0, rate = 0.0;
};

/// Index of the axis along or about which a joint of type J moves. \throws InvalidInput if the joint has no such axis,
/// or several.
template <class J>
[[gnu::cold]] int axis_of_joint(JointLayout const& place, JointMotion::Kind kind) {
  int const axis = axis_of_motion(static_cast<J const*>(place.joint)->geometry, kind);
  if (axis >= 0) return axis;
  throw InvalidInput("joint.no_angle", {"\"", ErrorObject{place.name}, "\" does not permit exactly one ",
                                        kind == JointMotion::Kind::turn
                                            ? "rotation. Read the rotation matrices by frame(model, x, marker)."
                                            : "translation. Read the points by position(model, x, marker)."});
}

/// Angle of marker b relative to marker a about axis k of a: θ = atan2(a_{k+2}·b_{k+1}, a_{k+1}·b_{k+1}) in (−π, π], θ̇
/// = a_k·(ω_b − ω_a).
/// \throws InvalidInput for a marker without axes.
template <class = void>
JointValue turn_of(System const& system, Index joint, int k) {
  JointLayout const& place = system.layout().joints[std::size_t(joint)];
  for (Index const marker : {place.a, place.b})
    if (system.layout().observes[std::size_t(marker)] != MarkerKind::frame)
      throw InvalidInput("joint.no_angle",
                         {"\"", ErrorObject{place.name},
                          "\" has no angle: one of its markers provides no axes perpendicular to the joint's axis (a "
                          "cable, or a point that slides along a body). Read a direction from frame(model, x, "
                          "marker)."});
  Frame<double> const &a = system.data().markers[std::size_t(place.a)].frame,
                      &b = system.data().markers[std::size_t(place.b)].frame;
  Vec3 const first = b.A.col((k + 1) % 3);
  return {std::atan2(first.dot(a.A.col((k + 2) % 3)), first.dot(a.A.col((k + 1) % 3))), a.A.col(k).dot(b.w - a.w)};
}

/// Relative translation along axis u = a_k of marker a: s = u·d, ṡ = u·(v_b − v_a) + (u × d)·ω_a, d = r_b − r_a.
template <class = void>
JointValue slide_of(System const& system, Index joint, int k) {
  JointLayout const& place = system.layout().joints[std::size_t(joint)];
  Frame<double> const &a = system.data().markers[std::size_t(place.a)].frame,
                      &b = system.data().markers[std::size_t(place.b)].frame;
  Vec3 const u = a.A.col(k), d = b.r - a.r;
  return {u.dot(d), u.dot(b.v - a.v) + u.cross(d).dot(a.w)};
}

template <class J>
JointValue angle_of(System const& system, ElementHandle<J> const& joint) {
  static_assert(HasJointAngle<typename J::Geometry>,
                "A joint angle needs a joint that permits or prescribes exactly one rotation, such as Revolute or "
                "Cylindrical. Read the rotation matrices of other joints by frame(model, x, marker).");
  Index const i = index_of_joint(system.layout(), joint);
  return turn_of(system, i, axis_of_joint<J>(system.layout().joints[std::size_t(i)], JointMotion::Kind::turn));
}
template <class J>
JointValue translation_of(System const& system, ElementHandle<J> const& joint) {
  static_assert(HasJointTranslation<typename J::Geometry>,
                "A joint translation needs a joint that permits or prescribes exactly one translation, such as "
                "Prismatic or Cylindrical. Read the points of other joints by position(model, x, marker).");
  Index const i = index_of_joint(system.layout(), joint);
  return slide_of(system, i, axis_of_joint<J>(system.layout().joints[std::size_t(i)], JointMotion::Kind::slide));
}

}  // namespace detail

/// Angle of a joint in (−π, π] [rad]: rotation of the second marker relative to the first about the axis of the joint,
/// zero in the reference configuration. One state does not contain the number of full turns; `TurnCounter` counts them
/// over a run. The joint permits one rotation (`Revolute`, `Cylindrical`, `Screw`, `PlanarJoint`, `planar::Revolute` …)
/// or prescribes one (`PrescribedAngle`, `PrescribedRate`). In a compliant joint the axis is that of the first marker.
/// `system` must have been evaluated at the state.
/// \throws InvalidInput for a handle of another model, and for a marker without axes (cables, sliders).
template <class J>
double joint_angle(System const& system, ElementHandle<J> const& joint) {
  return detail::angle_of(system, joint).value;
}

/// Rate of a joint angle [rad/s]: a·(ω_b − ω_a), with the axis a of the joint in the first marker. `system` must have
/// been evaluated at the state. \throws InvalidInput like `joint_angle`.
template <class J>
double joint_angle_rate(System const& system, ElementHandle<J> const& joint) {
  return detail::angle_of(system, joint).rate;
}

/// Translation in a joint [m]: position of the second marker relative to the first along the axis of the joint, which
/// is fixed in the first marker. The translation is zero if the markers coincide. The joint permits one translation
/// (`Prismatic`, `Cylindrical`, `Screw`, `PointOnLine`, `planar::Prismatic` …) or prescribes one
/// (`PrescribedTranslation`). `system` must have been evaluated at the state. \throws InvalidInput for a handle of
/// another model.
template <class J>
double joint_translation(System const& system, ElementHandle<J> const& joint) {
  return detail::translation_of(system, joint).value;
}

/// Rate of a joint translation [m/s], relative to the axis in the first marker. `system` must have been evaluated at
/// the state. \throws InvalidInput like `joint_translation`.
template <class J>
double joint_translation_rate(System const& system, ElementHandle<J> const& joint) {
  return detail::translation_of(system, joint).rate;
}

/// Angle of a joint with its full turns, over the states of a run:
///   TurnCounter turns(model, crank);
///   for (State const& now : simulate(…)) angle = turns.record(now);
/// The angle of the first state lies in (−π, π]. From state to state, θ₁ = θ₀ + Δ. Of all increments Δ that agree with
/// the angles of the two states up to full turns, the one nearest to ½ (θ̇₀ + θ̇₁)(t₁ − t₀) is taken. The count is
/// correct if the error of this estimate is below half a turn. Steps that resolve the rotation satisfy this condition.
/// At constant rate, the interval between two states can have any length. `record` does not allocate memory. The model
/// must outlive the counter and must not change after its construction.
template <class = void>  // compiled only if used
class TurnCounterOf {
 public:
  /// Counter without states for a joint of `model`. \throws InvalidInput for a handle of another model.
  template <class M, class J>
  TurnCounterOf(M const& model, ElementHandle<J> const& joint)
      : TurnCounterOf(System(model, with<Capabilities::motion>), joint) {}
  /// Deleted: a temporary model would not outlive the counter.
  template <class M, class J>
    requires(!std::same_as<M, System>)
  TurnCounterOf(M const&& model, ElementHandle<J> const& joint) = delete;
  /// Counter for a joint of `system`, a system of the full model.
  template <class J>
  TurnCounterOf(System system, ElementHandle<J> const& joint)
      : system_(std::move(system)), joint_(index_of_joint(system_.layout(), joint)) {
    static_assert(HasJointAngle<typename J::Geometry>,
                  "TurnCounter needs a joint that permits or prescribes exactly one rotation, such as Revolute.");
    axis_ = detail::axis_of_joint<J>(system_.layout().joints[std::size_t(joint_)], JointMotion::Kind::turn);
  }

  /// Restarts the count at state x. Returns the angle in (−π, π] [rad]. \throws InvalidInput for a state of another
  /// model.
  double start(State const& x) {
    started_ = false;
    return record(x);
  }
  /// Adds state x. Returns the angle with its full turns [rad]. \throws InvalidInput for a state of another model, for
  /// a state earlier than the last one, and for a marker without axes.
  double record(State const& x) {
    require_usable(system_, x);
    if (started_ && !(x.t >= t_))
      throw InvalidInput("turn_counter.time_order",
                         {ErrorObject{"TurnCounter"}, ": the state at t = ", ErrorTime{x.t},
                          " s is earlier than the last one at t = ", t_, " s. Call start() for another run."});
    system_.evaluate(x.q, x.v, x.t);
    detail::JointValue const now = detail::turn_of(system_, joint_, axis_);
    double const turn = 2.0 * std::numbers::pi;
    double const expected = angle_ + 0.5 * (rate_ + now.rate) * (x.t - t_);
    angle_ = started_ ? now.value + turn * std::nearbyint((expected - now.value) / turn) : now.value;
    rate_ = now.rate;
    t_ = x.t;
    started_ = true;
    return angle_;
  }

  double angle() const { return angle_; }  ///< angle of the last state with its full turns [rad]
  double rate() const { return rate_; }    ///< rate of the angle in the last state [rad/s]

 private:
  System system_;
  Index joint_;
  int axis_ = 2;
  double angle_ = 0.0, rate_ = 0.0, t_ = 0.0;
  bool started_ = false;
};

using TurnCounter = TurnCounterOf<>;  ///< angle of a joint with its full turns

}  // namespace polybody
