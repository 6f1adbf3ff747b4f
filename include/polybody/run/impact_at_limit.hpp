#pragma once
/// \file
/// Impact at the limit of a joint, or of a distance of two points, as an event: the rate of the coordinate jumps by a
/// coefficient of restitution.
/// Theory: Eqs. 9.24 to 9.26.

#include <functional>
#include <memory>
#include <numbers>
#include <string_view>

#include <polybody/forces/scalar_force.hpp>
#include <polybody/integrators/forward_dynamics.hpp>
#include <polybody/run/joint_position.hpp>
#include <polybody/run/run_options.hpp>

namespace polybody {

/// Limits of an angle [rad], or of a translation or distance [m], and the restitution of an impact at them.
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

/// Coordinate of two markers in an evaluated system: value and rate, and the wrenches (6) of a unit force along it.
struct LimitedCoordinate {
  Index a, b;                                     ///< indices of the markers
  JointValue at = {};                             ///< value [m] or [rad], and rate
  Vec6 on_a = Vec6::Zero(), on_b = Vec6::Zero();  ///< (6) force and moment on the markers, world axes
};
using CoordinateIn = std::function<LimitedCoordinate(System const&)>;  ///< coordinate in an evaluated system

/// Distance of a coordinate from its limits, and the jump of its rate.
template <class = void>  // compiled only if used
class ImpactOfCoordinate {
 public:
  ImpactOfCoordinate(System system, CoordinateIn coordinate, std::string name, LimitImpact const& limit)
      : system_(std::move(system)),
        forward_(system_),
        coordinate_(std::move(coordinate)),
        name_(std::move(name)),
        limit_(limit) {}

  /// Distance to the nearest limit [m] or [rad]; negative beyond it.
  double gap(State const& x) {
    double const at = coordinate(x).at.value;
    return std::min(at - limit_.lower, limit_.upper - at);
  }
  /// Impulse I on the coordinate for which its rate ẋ becomes −e ẋ: v⁺ = v⁻ + M⁻¹(Gᵀμ + I ∂ẋ/∂v), G (v⁺ − v⁻) = 0. A
  /// rate away from the limit does not change.
  void strike(State& x) {
    LimitedCoordinate const now = coordinate(x);
    double const side = limit_.upper - now.at.value < now.at.value - limit_.lower ? 1.0 : -1.0;
    if (!(side * now.at.rate > 0.0)) return;
    VecX along = VecX::Zero(system_.velocities()), move = along, reactions;
    add(now.a, now.on_a, along);
    add(now.b, now.on_b, along);
    forward_.hold(system_, x.q, x.v, x.t);
    forward_.response(system_, along, move, reactions);
    double const mobility = along.dot(move);
    if (!(mobility > 1e-12 * along.norm() * move.norm()))
      throw InvalidInput("limit.immobile", {ErrorObject{name_}, " cannot rebound from its limit at t = ",
                                            ErrorTime{x.t}, " s: other joints prescribe or prevent its motion."});
    x.v -= (1.0 + limit_.restitution) * now.at.rate / mobility * move;
  }

 private:
  LimitedCoordinate coordinate(State const& x) {
    system_.evaluate(x.q, x.v, x.t);
    return coordinate_(system_);
  }
  /// Adds the generalised force of a wrench on a marker.
  void add(Index marker, Vec6 const& wrench, VecX& to) const {
    MarkerKinematics<double> const& m = system_.data().markers[std::size_t(marker)];
    MatX out = MatX::Zero(m.columns, 1);
    m.pull(wrench, out);
    to.segment(m.first, m.columns) += out.col(0);
  }

  System system_;
  ForwardDynamics<> forward_;
  CoordinateIn coordinate_;
  std::string name_;
  LimitImpact limit_;
};

/// Event of an impact of the coordinate at a limit. `of` names the object in messages.
template <class = void>
[[gnu::cold]] Event impact_event(System system, CoordinateIn coordinate, std::string const& name, std::string const& of,
                                 LimitImpact const& limit) {
  auto const impact = std::make_shared<ImpactOfCoordinate<>>(std::move(system), std::move(coordinate), of, limit);
  return {.name = "impact at a limit of \"" + name + "\"",
          .value = [impact](State const& x) { return impact->gap(x); },
          .action = [impact](State& x) { impact->strike(x); },
          .rests = true};
}

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
  std::string const name = place.name;
  int const axis = axis_of_joint<J>(place, kind);
  auto const coordinate = [index, axis](System const& at) {
    JointLayout const& of = at.layout().joints[std::size_t(index)];
    Frame<double> const &a = at.data().markers[std::size_t(of.a)].frame,
                        &b = at.data().markers[std::size_t(of.b)].frame;
    Vec3 const u = a.A.col(axis);
    LimitedCoordinate c{.a = of.a, .b = of.b};
    if constexpr (kind == JointMotion::Kind::turn) {
      c.at = turn_of(at, index, axis);
      c.on_a.template tail<3>() = -u;
      c.on_b.template tail<3>() = u;
    } else {
      c.at = slide_of(at, index, axis);
      c.on_a << -u, u.cross(b.r - a.r);
      c.on_b.template head<3>() = u;
    }
    return c;
  };
  return impact_event(std::move(system), coordinate, name, "joint \"" + name + "\"", limit);
}

/// Event of an impact at a limit of the coordinate of the force element `force` in the model of `system`.
template <class C, class L>
[[gnu::cold]] Event impact_in(System system, ElementHandle<ScalarForce<C, L>> const& force, LimitImpact const& limit) {
  static_assert(!C::counts_turns, "impact_at_limit needs a coordinate without full turns: OnAngle instead of OnTurns.");
  Index const index = index_of_force(system.layout(), force);
  std::string const name = system.layout().forces[std::size_t(index)].name;
  limit.check(name, C::units.x);
  auto const coordinate = [index](System const& at) {
    auto const& markers = at.layout().forces[std::size_t(index)].markers;
    LimitedCoordinate c{.a = markers[0], .b = markers[1]};
    Frame<double> const &a = at.data().markers[std::size_t(c.a)].frame, &b = at.data().markers[std::size_t(c.b)].frame;
    ConstraintTerms<1, double> const terms = C::terms(a, b);
    for (int i = 0; i < 6; ++i) {
      c.on_a[i] = terms.Ga(0, i);
      c.on_b[i] = terms.Gb(0, i);
    }
    c.at = {terms.g[0], c.on_a.head<3>().dot(a.v) + c.on_a.tail<3>().dot(a.w) + c.on_b.head<3>().dot(b.v) +
                            c.on_b.tail<3>().dot(b.w)};
    return c;
  };
  return impact_event(std::move(system), coordinate, name, "\"" + name + "\"", limit);
}

}  // namespace detail

/// Event of a run: impact at a limit of a coordinate. The coordinate is the angle or translation of a joint, or that of
/// a force element `OnDistance`, `OnAngle` or `OnTranslation` with any law. The rate of the coordinate jumps from ẋ to
/// −e ẋ. The jump of all velocities is due to an impulse between the two bodies. It satisfies the constraint equations
/// and conserves the momentum of free bodies. If impacts accumulate, the coordinate rests at the limit until the motion
/// leaves it. An angle must stay within (−π, π), and a distance must not be zero. The model must outlive the event and
/// must not change afterwards.
/// \throws InvalidInput for invalid limits and for a handle of another model.
template <class M, class J>
Event impact_at_limit(M const& model, ElementHandle<J> const& coordinate, LimitImpact const& limit) {
  return detail::impact_in(System(model, with<Capabilities::motion>), coordinate, limit);
}
/// Deleted: a temporary model would not outlive the event.
template <class M, class J>
Event impact_at_limit(M const&& model, ElementHandle<J> const& coordinate, LimitImpact const& limit) = delete;

}  // namespace polybody
