#pragma once
/// \file
/// Impact at the limit of a joint as an event: the rate of the joint's angle or translation jumps by a coefficient of
/// restitution.
/// Theory: Eqs. 9.24 to 9.26.

#include <memory>
#include <numbers>
#include <string_view>

#include <polybody/integrators/forward_dynamics.hpp>
#include <polybody/run/joint_position.hpp>
#include <polybody/run/run_options.hpp>

namespace polybody {

/// Limits of a joint's angle [rad] or translation [m], and the restitution of an impact at them.
struct LimitImpact {
  double lower = -std::numeric_limits<double>::infinity();  ///< lower limit [m] or [rad]; −∞: none
  double upper = std::numeric_limits<double>::infinity();   ///< upper limit [m] or [rad]; ∞: none
  Required<double> restitution;                             ///< coefficient of restitution e in [0, 1]

  /// \throws InvalidInput unless lower < upper, one of them is finite, and e lies in [0, 1]. `unit` is "m" or "rad".
  template <class = void>  // compiled where it is used
  [[gnu::cold]] void check(std::string const& name, char const* unit) const {
    if (!(lower < upper) || (std::isinf(lower) && std::isinf(upper)))
      throw InvalidInput("limit.order", {"\"", ErrorObject{name},
                                         "\": the lower limit must be less than the upper limit, and one of them "
                                         "finite, but they are ",
                                         ErrorValue{lower}, " and ", upper, " ", unit, "."});
    for (double const limit : {lower, upper})
      if (std::string_view(unit) == "rad" && std::isfinite(limit) && !(std::abs(limit) < std::numbers::pi))
        throw InvalidInput("limit.beyond_half_a_turn",
                           {"\"", ErrorObject{name}, "\": a limit of an angle must lie between -pi and pi, but is ",
                            ErrorValue{limit}, " rad."});
    if (!(restitution >= 0.0 && restitution <= 1.0))
      throw InvalidInput("limit.restitution",
                         {"\"", ErrorObject{name}, "\": the coefficient of restitution must lie in [0, 1], but is ",
                          ErrorValue{restitution.value}, "."});
  }
};

namespace detail {

/// Distance of a joint from its limits, and the jump of its rate.
template <class = void>  // compiled only if used
class ImpactOfJoint {
 public:
  ImpactOfJoint(System system, Index joint, JointMotion::Kind kind, int axis, LimitImpact const& limit)
      : system_(std::move(system)), forward_(system_), joint_(joint), kind_(kind), axis_(axis), limit_(limit) {}

  /// Distance to the nearest limit [m] or [rad]; negative beyond it.
  double gap(State const& x) {
    double const at = coordinate(x).value;
    return std::min(at - limit_.lower, limit_.upper - at);
  }
  /// Impulse I on the joint's coordinate for which its rate ẋ becomes −e ẋ: v⁺ = v⁻ + M⁻¹(Gᵀμ + I ∂ẋ/∂v), G (v⁺ − v⁻) =
  /// 0. A rate away from the limit does not change.
  void strike(State& x) {
    JointValue const at = coordinate(x);
    double const side = limit_.upper - at.value < at.value - limit_.lower ? 1.0 : -1.0;
    if (!(side * at.rate > 0.0)) return;
    VecX along = VecX::Zero(system_.velocities()), move = along, reactions;
    JointLayout const& place = system_.layout().joints[std::size_t(joint_)];
    Frame<double> const &a = frame(place.a), &b = frame(place.b);
    Vec3 const axis = a.A.col(axis_);
    if (kind_ == JointMotion::Kind::turn) {
      add(place.a, Vec3::Zero(), -axis, along);
      add(place.b, Vec3::Zero(), axis, along);
    } else {
      add(place.a, -axis, axis.cross(b.r - a.r), along);
      add(place.b, axis, Vec3::Zero(), along);
    }
    forward_.hold(system_, x.q, x.v, x.t);
    forward_.response(system_, along, move, reactions);
    double const mobility = along.dot(move);
    if (!(mobility > 1e-12 * along.norm() * move.norm()))
      throw InvalidInput("limit.immobile", {"joint \"", ErrorObject{place.name},
                                            "\" cannot rebound from its limit at t = ", ErrorTime{x.t},
                                            " s: other joints prescribe or prevent its motion."});
    x.v -= (1.0 + limit_.restitution) * at.rate / mobility * move;
  }

 private:
  JointValue coordinate(State const& x) {
    system_.evaluate(x.q, x.v, x.t);
    return kind_ == JointMotion::Kind::turn ? turn_of(system_, joint_, axis_) : slide_of(system_, joint_, axis_);
  }
  Frame<double> const& frame(Index marker) const { return system_.data().markers[std::size_t(marker)].frame; }
  /// Adds the generalised force of a force and a moment on a marker.
  void add(Index marker, Vec3 const& force, Vec3 const& moment, VecX& to) const {
    MarkerKinematics<double> const& m = system_.data().markers[std::size_t(marker)];
    Mat<double, 6, 1> wrench;
    wrench << force, moment;
    MatX out = MatX::Zero(m.columns, 1);
    m.pull(wrench, out);
    to.segment(m.first, m.columns) += out.col(0);
  }

  System system_;
  ForwardDynamics<> forward_;
  Index joint_;
  JointMotion::Kind kind_;
  int axis_;
  LimitImpact limit_;
};

/// Event of an impact at a limit of `joint` in the model of `system`.
template <class J>
[[gnu::cold]] Event impact_in(System system, ElementHandle<J> const& joint, LimitImpact const& limit) {
  using G = typename J::Geometry;
  static_assert(HasJointAngle<G> || HasJointTranslation<G>,
                "impact_at_limit needs a joint that permits one rotation or one translation, such as Revolute or "
                "Prismatic.");
  static_assert(!HasFreeDirections<G> || !HasJointAngle<G> || !HasJointTranslation<G>,
                "impact_at_limit needs a joint with one free motion. A Cylindrical has a rotation and a translation.");
  constexpr auto kind = HasJointAngle<G> ? JointMotion::Kind::turn : JointMotion::Kind::slide;
  Index const index = index_of_joint(system.layout(), joint);
  JointLayout const& place = system.layout().joints[std::size_t(index)];
  limit.check(place.name, kind == JointMotion::Kind::turn ? "rad" : "m");
  std::string const name = "impact at a limit of \"" + place.name + "\"";
  int const axis = axis_of_joint<J>(place, kind);
  auto const impact = std::make_shared<ImpactOfJoint<>>(std::move(system), index, kind, axis, limit);
  return {.name = name,
          .value = [impact](State const& x) { return impact->gap(x); },
          .action = [impact](State& x) { impact->strike(x); },
          .rests = true};
}

}  // namespace detail

/// Event of a run: impact at a limit of a joint's angle or translation. The rate of the coordinate jumps from ẋ to −e
/// ẋ. The jump of all velocities is due to an impulse between the two bodies of the joint. It satisfies the constraint
/// equations and conserves the momentum of free bodies. If impacts accumulate, the joint rests at the limit until the
/// motion leaves it. The angle must stay within (−π, π). The model must outlive the event and must not change
/// afterwards.
/// \throws InvalidInput for invalid limits and for a handle of another model.
template <class M, class J>
Event impact_at_limit(M const& model, ElementHandle<J> const& joint, LimitImpact const& limit) {
  return detail::impact_in(System(model, with<Capabilities::motion>), joint, limit);
}
/// Deleted: a temporary model would not outlive the event.
template <class M, class J>
Event impact_at_limit(M const&& model, ElementHandle<J> const& joint, LimitImpact const& limit) = delete;

}  // namespace polybody
