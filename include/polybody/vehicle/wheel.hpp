#pragma once
/// \file
/// Wheel with a tyre on a terrain: contact point of a disc or torus, normal force, and tyre forces with relaxation.
/// Theory: Eqs. 9.61 to 9.63, 9.65 to 9.68.

#include <polybody/forces/force_states.hpp>
#include <polybody/forces/normal_force.hpp>
#include <polybody/forces/tyre.hpp>
#include <polybody/vehicle/terrain.hpp>

namespace polybody {

/// Relaxation of a tyre: the deflection u of its contact patch follows the slip velocity V_s over a relaxation length
/// σ,
///   u̇ = −V_s − V_t u/σ,
/// and the tyre law applies at the slip u/σ [Pacejka 2012, §7.2]. With V² = V_x² + V_s², V_t is |V_x| for V ≥ 2V₀, so
/// that u/σ is the slip −V_s/|V_x| in steady motion. For V ≤ V₀, V_t is the rolling speed |V_x − V_sx|, which is zero
/// for a locked wheel. A parked wheel is then a spring with the stiffness C/σ and does not creep, also under
/// oscillating loads. Between both, a smooth weight p(V²) gives V_t = p |V_x| + (1 − p) |V_x − V_sx|. Near a bound S of
/// the slip |u/σ|, V_t also contains |V_s| gate/S, and the gate increases from 0 at 0.9 S to 1 at S. The bound S = 2 p
/// + (1 − p) S₀ avoids deflections that no tyre has. It is S₀ at low speed and 2 at high speed.
struct TyreRelaxation {
  Required<double> longitudinal;  ///< relaxation length σ_x [m]
  Required<double> lateral;       ///< relaxation length σ_y [m]
  /// Time τ [s] of the material damping: the tyre law applies at the slip (u + τ u̇)/σ. This damps the oscillations of a
  /// parked vehicle and does not change the steady forces.
  double damping_time = 0.0;
  double parked_slip = 0.2;  ///< S₀ [1], in (0, 2]; 0.9 S₀ exceeds the slip at which the force of the tyre is largest
  double low_speed = 1.0;    ///< V₀ [m/s]

  void check(std::string const& name) const {
    require_positive(longitudinal, name, ": the longitudinal relaxation length", "m");
    require_positive(lateral, name, ": the lateral relaxation length", "m");
    require_not_negative(damping_time, name, ": the damping time of the tyre", "s");
    if (!(parked_slip > 0.0 && parked_slip <= 2.0))
      throw InvalidInput("tyre.parked_slip", {ErrorObject{name}, ": the parked slip must lie in (0, 2], but is ",
                                              ErrorValue{parked_slip}, "."});
    require_positive(low_speed, name, ": the low speed of the tyre", "m/s");
  }
  /// Rates u̇ [m/s] of the deflections `u` [m] along x and y, at the velocity `vx` of the wheel centre along x and the
  /// slip velocity (sx, sy) [m/s].
  template <StateScalar T>
  std::array<T, 2> rates(std::array<T, 2> const& u, T const& vx, T const& sx, T const& sy) const {
    using std::sqrt;
    T const along = u[0] / longitudinal.value, across = u[1] / lateral.value;
    T const slipping = sx * sx + sy * sy, speed = vx * vx + slipping, slip = along * along + across * across;
    T const part = (speed / low_speed / low_speed - 1.0) / 3.0;
    T const fast = value_of(part) > 0.0 ? rise<T>(part) : T(0.0);
    T const bound = fast * (2.0 - parked_slip) + parked_slip, rolling = magnitude<T>(vx - sx);
    T transport = rolling + fast * (magnitude<T>(vx) - rolling);
    if (value_of(slip) > 0.81 * value_of(bound) * value_of(bound) && value_of(slipping) > 0.0)
      transport += rise<T>(sqrt(slip) / bound * 10.0 - 9.0) * sqrt(slipping) / bound;
    return {-sx - transport * along, -sy - transport * across};
  }

 private:
  template <StateScalar T>
  static T magnitude(T const& x) {
    return value_of(x) < 0.0 ? T(-x) : x;
  }
  /// Smooth step from 0 at x = 0 to 1 at x = 1 for x ≥ 0.
  template <StateScalar T>
  static T rise(T const& x) {
    return value_of(x) < 1.0 ? T(x * x * (x * -2.0 + 3.0)) : T(1.0);
  }
};

/// Rolling resistance: moment −f N R v/√(v² + v₀²) about the axle, at the rolling speed v = Ω R.
struct RollingResistance {
  double coefficient = 0.0;  ///< f [1]
  double speed = 0.0;        ///< v₀ [m/s]; must be positive if f is positive

  void check(std::string const& name) const {
    require_not_negative(coefficient, name, ": the coefficient of the rolling resistance");
    if (coefficient > 0.0) require_positive(speed, name, ": the speed of the rolling resistance", "m/s");
  }
};

/// Contact of a wheel with the ground. All vectors are in the axes of the ground's marker.
template <StateScalar T>
struct WheelContact {
  Vec<T, 3> normal;   ///< (3) unit vector normal to the ground, upwards
  Vec<T, 3> forward;  ///< (3) unit vector x in the ground, perpendicular to the axle; zero for a wheel that lies flat
  Vec<T, 3> left;     ///< (3) unit vector y = normal × forward
  Vec<T, 3> arm;      ///< (3) from the wheel centre to the contact point on the ground [m]
  Vec<T, 3> place;    ///< (3) contact point on the ground, from the origin of the ground's marker [m]
  T depth;            ///< radial deflection d of the tyre along the normal [m]; negative in the air
  T camber;           ///< sin γ, the component of the axle along the normal
  T depth_rate = {};  ///< ḋ [m/s]
  T forward_speed = {};  ///< velocity V_x of the wheel centre along `forward` [m/s]
  T slip_x = {};         ///< slip velocity V_sx of the wheel at the contact point [m/s]
  T slip_y = {};         ///< slip velocity V_sy of the wheel at the contact point [m/s]
};

/// Wheel with a tyre on the ground. Marker a is the wheel centre. Its third axis is the axle and points to the left of
/// the direction of travel, so that a wheel that rolls forwards rotates about it with positive angular velocity. `axle`
/// selects another direction. Marker b is the ground: z is up, and the height of the terrain is a function of x and y.
/// The tread is a torus with the outer radius R and the radius c of the cross-section; c = 0 is a disc. With the normal
/// n and the axle a, the lowest point of the undeformed tread is at ρ = −(R − c) e − c n from the wheel centre, e =
/// m/|m| with m = n − (n·a) a. The plane is tangent to the terrain at the contact point, which lies below this point
/// along n at the loaded radius. All forces act there, and the slip velocity is that of the wheel's material point
/// there. A wheel without longitudinal force therefore rolls with v = Ω r at the loaded radius r. A valley whose radius
/// of curvature is less than R has two contact points; the element finds one of them.
template <TyreLaw L, Terrain G = FlatGround, NormalForce N = SpringDamperContact>
struct Wheel {
  static constexpr int markers = 2, states = 2;  ///< two markers; two states, the deflections u_x and u_y [m]
  static constexpr bool is_load = false;
  static constexpr MarkerKind needs = MarkerKind::frame;

  Required<double> radius;         ///< R, radius of the undeformed wheel [m]
  double crown = 0.0;              ///< c, radius of the cross-section [m]; less than R
  Vec3 axle = Vec3::UnitZ();       ///< (3) unit vector to the left, in the axes of marker a
  N normal;                        ///< law of the normal force, with the radial stiffness of the tyre
  L tyre;                          ///< tyre law
  TyreRelaxation relaxation;       ///< relaxation of the tyre
  RollingResistance rolling = {};  ///< rolling resistance
  G terrain = {};                  ///< height as a function of x and y of marker b

  void check(std::string const& name) const {
    require_positive(radius, name, ": the radius of the wheel", "m");
    if (!(crown >= 0.0 && crown < radius))
      throw InvalidInput("wheel.crown",
                         {ErrorObject{name}, ": the crown must be at least zero and less than the radius ",
                          radius.value, " m, but is ", ErrorValue{crown}, " m."});
    require_unit(axle, name, ": the axle");
    normal.check(name);
    tyre.check(name);
    relaxation.check(name);
    rolling.check(name);
    terrain.check(name);
  }

  /// Contact at the frames `f` of wheel and ground, also for a wheel in the air.
  template <StateScalar T>
  WheelContact<T> contact(std::array<Frame<T>, 2> const& f) const {
    Vec<T, 3> axis = Vec<T, 3>::Zero();  // axle, world axes
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) axis[i] += f[0].A(i, k) * axle[k];
    Vec<T, 3> const d = f[0].r - f[1].r, spin = f[1].A.transpose() * axis, centre = f[1].A.transpose() * d;
    WheelContact<T> c = touch<T>(spin, centre);
    Vec<T, 3> const arm = f[1].A * c.arm, turn = f[0].w.cross(arm), place = f[1].A * c.place;
    Vec<T, 3> const ground = f[1].v + f[1].w.cross(place);
    Vec<T, 3> const of_centre = f[1].A.transpose() * Vec<T, 3>(f[0].v - ground);
    Vec<T, 3> const slip = of_centre + f[1].A.transpose() * turn;
    c.depth_rate = -slip.dot(c.normal);
    c.forward_speed = of_centre.dot(c.forward);
    c.slip_x = slip.dot(c.forward);
    c.slip_y = slip.dot(c.left);
    return c;
  }
  /// Slip, camber and load of the tyre at the contact `c` with the deflections `u` [m].
  template <StateScalar T>
  TyreSlip<T> slip(WheelContact<T> const& c, std::array<T, 2> const& u) const {
    auto const rate = relaxation.template rates<T>(u, c.forward_speed, c.slip_x, c.slip_y);
    return {(u[0] + rate[0] * relaxation.damping_time) / relaxation.longitudinal.value,
            (u[1] + rate[1] * relaxation.damping_time) / relaxation.lateral.value, c.camber,
            value_of(c.depth) > 0.0 ? T(normal.template force<T>(c.depth, c.depth_rate)) : T(0.0)};
  }

  /// Wrenches on wheel and ground at their frames `f`, for the deflections `u` [m].
  template <StateScalar T>
  std::array<Wrench<T>, 2> wrenches(std::array<Frame<T>, 2> const& f, std::array<T, 2> const& u, double) const {
    using std::sqrt;
    std::array<Wrench<T>, 2> w;
    WheelContact<T> const c = contact<T>(f);
    TyreSlip<T> const s = slip<T>(c, u);
    if (!(value_of(s.load) > 0.0)) return w;
    TyreForce<T> const t = tyre.template force<T>(s);
    T resistance = T(0.0);
    if (rolling.coefficient > 0.0) {
      T const v = c.forward_speed - c.slip_x;
      resistance = s.load * v / sqrt(v * v + rolling.speed * rolling.speed) * (-rolling.coefficient * radius);
    }
    Vec<T, 3> force, moment;
    for (int i = 0; i < 3; ++i) {
      force[i] = c.normal[i] * s.load + c.forward[i] * t.x + c.left[i] * t.y;
      moment[i] = c.normal[i] * t.aligning + c.left[i] * resistance;
    }
    Vec<T, 3> const of_a = moment + c.arm.cross(force), of_b = moment + c.place.cross(force);
    w[0].f = f[1].A * force;
    w[0].m = f[1].A * of_a;
    w[1].f = -w[0].f;
    w[1].m = -(f[1].A * of_b);
    return w;
  }
  /// Rates u̇ [m/s] of the deflections `u` [m] at the frames `f` of wheel and ground.
  template <StateScalar T>
  std::array<T, 2> rates(std::array<Frame<T>, 2> const& f, std::array<T, 2> const& u, double) const {
    WheelContact<T> const c = contact<T>(f);
    return relaxation.template rates<T>(u, c.forward_speed, c.slip_x, c.slip_y);
  }
  /// Energy of the radial deflection at the frames `f` of wheel and ground [J].
  double potential(std::array<Frame<double>, 2> const& f, std::array<double, 2> const&, double) const {
    double const d = contact<double>(f).depth;
    return d > 0.0 ? normal.template potential<double>(d) : 0.0;
  }
  /// Power that the tyre forces of the deflections `u` [m] take out at the frames `f` of wheel and ground [W]. While
  /// the deflections decrease, the power may be negative.
  double dissipation(std::array<Frame<double>, 2> const& f, std::array<double, 2> const& u, double t) const {
    auto at_rest = f;
    for (Frame<double>& x : at_rest) x.v = x.w = Vec3::Zero();
    auto const w = wrenches<double>(at_rest, u, t);
    WheelContact<double> const c = contact<double>(f);
    double power = c.depth > 0.0 ? normal.template force<double>(c.depth, 0.0) * c.depth_rate : 0.0;
    for (std::size_t k = 0; k < 2; ++k) power += w[k].f.dot(f[k].v) + w[k].m.dot(f[k].w);
    return -power;
  }

 private:
  /// Contact with the plane that is tangent to the terrain at (x, y), for the axle `a` and the wheel centre (3).
  template <StateScalar T>
  WheelContact<T> touch_plane(Vec<T, 3> const& a, Vec<T, 3> const& centre, T const& x, T const& y) const {
    using std::sqrt;
    Height<T> const h = terrain.template height<T>(x, y);
    T const up = T(1.0) / sqrt(h.slope_x * h.slope_x + h.slope_y * h.slope_y + 1.0);
    WheelContact<T> c;
    c.normal = Vec<T, 3>(-(h.slope_x * up), -(h.slope_y * up), up);
    c.camber = c.normal.dot(a);
    Vec<T, 3> m;
    for (int i = 0; i < 3; ++i) m[i] = c.normal[i] - a[i] * c.camber;
    T const steep = sqrt(m.dot(m) + 1e-18);  // the sine of the angle between axle and normal
    T const across = T(radius - crown) * m.dot(c.normal) / steep;
    T const height = (centre[0] - x) * c.normal[0] + (centre[1] - y) * c.normal[1] + (centre[2] - h.z) * c.normal[2];
    c.depth = across + crown - height;
    Vec<T, 3> const forward = a.cross(c.normal);
    for (int i = 0; i < 3; ++i) {
      c.forward[i] = forward[i] / steep;
      c.arm[i] = m[i] / steep * -(radius - crown) + c.normal[i] * (c.depth - crown);
      c.place[i] = centre[i] + c.arm[i];
    }
    c.left = c.normal.cross(c.forward);
    return c;
  }
  /// Contact with the terrain. The position p of the tangent plane satisfies p = c(p) with the contact point c of the
  /// plane. Newton's method on values finds p; one more step with the scalar T adds the derivatives of p.
  template <StateScalar T>
  WheelContact<T> touch(Vec<T, 3> const& a, Vec<T, 3> const& centre) const {
    if constexpr (std::is_same_v<G, FlatGround>) {
      return touch_plane<T>(a, centre, centre[0], centre[1]);
    } else {
      using Two = Dual<2>;
      Vec<Two, 3> axis, middle;
      for (int i = 0; i < 3; ++i) {
        axis[i] = Two(value_of(a[i]));
        middle[i] = Two(value_of(centre[i]));
      }
      double x = middle[0].v, y = middle[1].v, jacobian[4] = {1.0, 0.0, 0.0, 1.0}, change = radius;
      for (int k = 0; k < 20 && change > 1e-13 * (radius + std::abs(x) + std::abs(y)); ++k) {
        WheelContact<Two> const c = touch_plane<Two>(axis, middle, Two::variable(x, 0), Two::variable(y, 1));
        double const j[4] = {1.0 - c.place[0].d[0], -c.place[0].d[1], -c.place[1].d[0], 1.0 - c.place[1].d[1]};
        double const determinant = j[0] * j[3] - j[1] * j[2];
        bool const regular = determinant > 1e-3;  // else the valley is narrower than the wheel
        jacobian[0] = regular ? j[3] / determinant : 0.5;
        jacobian[1] = regular ? -j[1] / determinant : 0.0;
        jacobian[2] = regular ? -j[2] / determinant : 0.0;
        jacobian[3] = regular ? j[0] / determinant : 0.5;
        double const dx = x - c.place[0].v, dy = y - c.place[1].v;
        double const step_x = jacobian[0] * dx + jacobian[1] * dy, step_y = jacobian[2] * dx + jacobian[3] * dy;
        change = std::hypot(step_x, step_y);
        double const share = change > radius ? radius / change : 1.0;
        x -= share * step_x;
        y -= share * step_y;
      }
      WheelContact<T> const near = touch_plane<T>(a, centre, T(x), T(y));
      T const dx = near.place[0] - x, dy = near.place[1] - y;
      return touch_plane<T>(a, centre, dx * jacobian[0] + dy * jacobian[1] + x,
                            dx * jacobian[2] + dy * jacobian[3] + y);
    }
  }
};

}  // namespace polybody
