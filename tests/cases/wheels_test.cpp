// Wheels with tyres: rolling, braking, parking on a slope, and the single-track model of a car.

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include <polybody/parts.hpp>
#include <polybody/polybody.hpp>

#include "support/held.hpp"

using namespace polybody;

namespace wheels_test {

constexpr double g = 9.81;
using Tyre = Wheel<LinearTyre>;

Tyre tyre(double radius, double stiffness, double friction) {
  return {.radius = radius,
          .axle = Vec3::UnitY(),
          .normal = {.stiffness = 2e5},
          .tyre = {.longitudinal_stiffness = stiffness,
                   .cornering_stiffness = stiffness,
                   .longitudinal_friction = friction,
                   .lateral_friction = friction},
          .relaxation = {.longitudinal = 0.2, .lateral = 0.2}};
}

// A wheel in the plane slides at first and rolls at last. J ω + m r v is constant, so that v = m r² v₀/(m r² + J) = ω
// r.
TEST(Tyre, FreeWheelRollsWithoutSlipAtLast) {
  double const m = 20.0, j = 0.8, r0 = 0.3, r = r0 - m * g / 2e5, v0 = 8.0;
  Model<Bodies<planar::Rigid>, Joints<>, Forces<Tyre>> model{Gravity{0, -g, 0}};
  auto const wheel = model.add(planar::Rigid(m, j, Placement::planar(0, r)), "wheel");
  Mat3 axes;
  axes << 1, 0, 0, 0, 0, 1, 0, -1, 0;  // z of the ground is the world's y
  Tyre law = tyre(r0, 2e3, 0.6);
  law.axle = -Vec3::UnitZ();
  model.apply(law, wheel.at(Vec2(0, 0)), model.ground().at(Placement{Vec3::Zero(), axes}), "tyre");
  State x = model.reference_state();
  model.set_velocity(x, wheel, Vec3(v0, 0, 0), Vec3::Zero());
  EnergyAudit audit(model);
  for (State const& now : simulate(model, x, GeneralisedAlpha{.rho_inf = 0.9}, {.end_time = 3.0, .step = 2.5e-4}))
    audit.record(now);
  Frame<double> const f = frame(model, x, wheel.at(Vec2(0, 0)));
  double const v = m * r * r * v0 / (m * r * r + j);
  char const* const how = "J ω + m r v is constant, v = ω r";
  held({"Wheel", "speed of a wheel that slid at first [m/s]", By::closed_form, how, "planar Rigid, h = 2.5e-4 s"},
       f.v[0], v, 1e-9);
  held({"Wheel", "angular velocity of a wheel that slid at first [rad/s]", By::closed_form, how,
        "planar Rigid, h = 2.5e-4 s"},
       -f.w[2], v / r, 1e-9);
  // The tyre saturates within 2 ms. This corner of the power adds h²/8 times the jump of its slope to the audit.
  EXPECT_NEAR(audit.dissipated(), 0.5 * m * v0 * v0 - 0.5 * (m + j / (r * r)) * v * v, 0.02);
  EXPECT_LT(audit.relative(), 1e-5);
}

using Locked = Joint<ConstantOrientation, Constraint>;
using OnBrake = Model<Bodies<Rigid<>>, Joints<Locked>, Forces<Tyre>>;

/// Wheel that carries the mass m and does not rotate.
struct LockedWheel {
  OnBrake model;
  BodyHandle<Rigid<>> wheel;
  State x;
  LockedWheel(Vec3 const& gravity, Tyre const& law, double m) : model(Gravity{gravity}) {
    double const low = law.radius + m * gravity[2] / law.normal.stiffness;
    wheel = model.add(Rigid<>(m, Mat3::Identity(), Placement::at({0, 0, low})), "wheel");
    model.connect(Locked{}, model.ground().at({0, 0, low}), wheel.at({0, 0, 0}), "brake");
    model.apply(law, wheel.at({0, 0, 0}), model.ground().at({0, 0, 0}), "tyre");
    x = model.reference_state();
  }
  Vec3 position(State const& s) const { return frame(model, s, wheel.at({0, 0, 0})).r; }
};

// The force grows as C (1 − e^{−x/σ}) up to μ m g, at x₁ = −σ ln(1 − μ m g/C), and is μ m g until the wheel stops:
//   ½ m v₀² = C (x₁ − σ (1 − e^{−x₁/σ})) + μ m g (x − x₁).
TEST(Tyre, BrakingDistanceOfALockedWheel) {
  double const m = 300.0, v0 = 10.0, c = 5e4, friction = 0.8, most = friction * m * g, sigma = 0.2;
  LockedWheel car({0, 0, -g}, tyre(0.3, c, friction), m);
  car.model.set_velocity(car.x, car.wheel, Vec3(v0, 0, 0), Vec3::Zero());
  double farthest = 0.0;
  for (State const& now : simulate(car.model, car.x, GeneralisedAlpha{.rho_inf = 0.9}, {.end_time = 1.5, .step = 1e-4}))
    farthest = std::max(farthest, car.position(now)[0]);
  double const x1 = -sigma * std::log(1.0 - most / c), first = c * (x1 - sigma * (1.0 - std::exp(-x1 / sigma)));
  held({"Wheel", "braking distance of a locked wheel [m]", By::closed_form,
        "½ m v² = C (x₁ − σ (1 − e^{−x₁/σ})) + μ m g (x − x₁)", "Rigid, h = 1e-4 s"},
       farthest, x1 + (0.5 * m * v0 * v0 - first) / most, 2e-5);
}

// A locked wheel on a slope of 0.2 rad, diagonal to the wheel. After 10 s the tyre's deflection carries the pull, and
// the wheel rests for a minute. The deflection is F σ/C.
TEST(Tyre, ParkedWheelRestsOnASlope) {
  double const m = 300.0, alpha = 0.2, c = 5e4, pull = g * std::sin(alpha);
  Tyre law = tyre(0.3, c, 0.8);
  law.normal.damping = 2e3;
  law.relaxation.damping_time = 0.02;
  LockedWheel car({0.8 * pull, -0.6 * pull, -g * std::cos(alpha)}, law, m);
  Vec3 settled = Vec3::Zero();
  double moved = 0.0;
  for (State const& now :
       simulate(car.model, car.x, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = 70.0, .step = 5e-3})) {
    if (now.t < 10.0)
      settled = car.position(now);
    else
      moved = std::max(moved, (car.position(now) - settled).norm());
  }
  EXPECT_LT(moved, 1e-9);
  EXPECT_GT(settled[0], 0.0);
  held({"Wheel", "deflection of a parked tyre on a slope [m]", By::closed_form, "m g sin α σ/C", "Rigid"},
       std::hypot(settled[0], settled[1]), m * pull * 0.2 / c, 1e-6);
}

// Below the limit of friction, an oscillating force of 0.3 m g does not move the parked wheel in the mean: positions
// after whole periods are equal.
TEST(Tyre, ParkedWheelDoesNotCreepUnderAnOscillatingForce) {
  double const m = 300.0;
  auto const shake = user_force<1>([](auto const& frames, double t) {
    using T = typename std::decay_t<decltype(frames[0].r)>::Scalar;
    Wrench<T> w;
    w.f[0] = T(0.3 * 300.0 * g * std::sin(4.0 * std::numbers::pi * t));
    w.f[1] = T(0.1 * 300.0 * g);
    return std::array{w};
  });
  Model<Bodies<Rigid<>>, Joints<Locked>, Forces<Tyre, std::decay_t<decltype(shake)>>> model{Gravity{0, 0, -g}};
  Tyre law = tyre(0.3, 5e4, 0.8);
  law.normal.damping = 2e3;
  law.relaxation.damping_time = 0.02;
  double const low = 0.3 - m * g / 2e5;
  auto const wheel = model.add(Rigid<>(m, Mat3::Identity(), Placement::at({0, 0, low})), "wheel");
  model.connect(Locked{}, model.ground().at({0, 0, low}), wheel.at({0, 0, 0}), "brake");
  model.apply(law, wheel.at({0, 0, 0}), model.ground().at({0, 0, 0}), "tyre");
  model.apply(shake, wheel.at({0, 0, 0}), "shake");
  State x = model.reference_state();
  Vec3 early = Vec3::Zero();
  double widest = 0.0;
  for (State const& now : simulate(model, x, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = 20.0, .step = 5e-3})) {
    Vec3 const r = frame(model, now, wheel.at({0, 0, 0})).r;
    if (std::abs(now.t - 5.0) < 1e-6) early = r;
    widest = std::max(widest, std::abs(r[0]));
  }
  EXPECT_LT((frame(model, x, wheel.at({0, 0, 0})).r - early).norm(), 1e-9);
  EXPECT_GT(widest, 2e-3);
}

// Single-track model: mass m, moment of inertia I, distances a and b of the axles from the centre of mass, L = a + b.
struct SingleTrack {
  using Level = Joint<PlanarJoint, Constraint>;
  using Axle = Joint<Revolute, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Level, Axle>, Forces<Tyre>> model;
  double a, b, front, rear, m = 1500.0, inertia = 2500.0, r = 0.29;
  BodyHandle<Rigid<>> car;
  State x;

  /// \param of distances of the front and the rear axle [m], \param stiffness cornering stiffness of both axles [N/rad]
  SingleTrack(Vec2 const& of, Vec2 const& stiffness, double steer, double speed)
      : a(of[0]), b(of[1]), front(stiffness[0]), rear(stiffness[1]) {
    car = model.add(Rigid<>(m, inertia * Mat3::Identity(), Placement::at({0, 0, 0.5})), "car");
    auto const ground = model.ground().at({0, 0, 0.5});
    model.connect(Level{{.normal = Vec3::UnitZ()}, {}}, ground, car.at({0, 0, 0}), "level");
    x = model.reference_state();
    std::vector<std::pair<BodyHandle<Rigid<>>, Vec3>> wheels;
    for (int i = 0; i < 2; ++i) {
      double const place = i == 0 ? a : -b, angle = i == 0 ? steer : 0.0, load = m * g * (i == 0 ? b : a) / (a + b);
      Vec3 const axle(-std::sin(angle), std::cos(angle), 0.0), centre(place, 0.0, r);
      auto const wheel =
          model.add(Rigid<>(1e-3, 1e-3 * Mat3::Identity(), Placement::at(centre)), i == 0 ? "front" : "rear");
      model.connect(Axle{{.axis = axle}, {}}, car.at(Vec3(place, 0.0, r - 0.5)), wheel.at({0, 0, 0}));
      Tyre law = tyre(r + load / 2e5, stiffness[i], 1.0);  // the depth gives the static load
      law.axle = axle;
      model.apply(law, wheel.at({0, 0, 0}), model.ground().at({0, 0, 0}), i == 0 ? "front tyre" : "rear tyre");
      wheels.push_back({wheel, speed * std::cos(angle) / r * axle});
    }
    x = model.reference_state();
    model.set_velocity(x, car, Vec3(speed, 0, 0), Vec3::Zero());
    for (auto const& [wheel, spin] : wheels)
      model.set_velocity(x, wheel, Vec3(speed, 0, 0) - spin.cross(Vec3(wheel.index == 1 ? a : -b, 0, r)), spin);
  }
  /// K of the formula r = V δ/(L + K V²) [s²/m]: m (b C_r − a C_f)/(L C_f C_r).
  double understeer() const { return m * (b * rear - a * front) / ((a + b) * front * rear); }
};

// r = V δ/(L + K V²), K = m (b C_r − a C_f)/(L C_f C_r): understeering, neutral and oversteering car. Terms of the
// order δ² are neglected.
TEST(SingleTrack, SteadyCircle) {
  double const steer = 0.004;
  struct Case {
    char const* name;
    Vec2 of, stiffness;
  };
  for (Case const& c :
       {Case{"an understeering car", {1.2, 1.6}, {8e4, 8e4}}, Case{"a neutral car", {1.4, 1.4}, {8e4, 8e4}},
        Case{"an oversteering car", {1.5, 1.3}, {8e4, 8e4}}})
    for (double const speed : {10.0, 20.0}) {
      SingleTrack car(c.of, c.stiffness, steer, speed);
      simulate(car.model, car.x, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = 6.0, .step = 2e-3}).run();
      Frame<double> const f = frame(car.model, car.x, car.car.at({0, 0, 0}));
      double const v = f.v.dot(f.A.col(0)), expected = v * steer / (car.a + car.b + car.understeer() * v * v);
      held({"Single track", std::string("yaw rate of ") + c.name + " [rad/s]", By::closed_form,
            "V δ/(L + K V²), K = m (b C_r − a C_f)/(L C_f C_r)", "Rigid, Wheel<LinearTyre>, h = 2e-3 s"},
           f.w[2], expected, 3e-4 * expected, {equals("V", speed)});
      EXPECT_NEAR(v, speed, 0.02 * speed);
    }
}

/// Largest real part of the eigenvalues of the linear single-track model with relaxation: v, r, u_f, u_r with
///   m (v̇ + V r) = F_f + F_r,  I ṙ = a F_f − b F_r,  F = C u/σ,  u̇_f = −(v + a r) − V u_f/σ,  u̇_r = −(v − b r) − V
///   u_r/σ.
double growth(SingleTrack const& car, double v) {
  double const sigma = 0.2, f = car.front / sigma, r = car.rear / sigma;
  Mat<double, 4, 4> const s{{0.0, -v, f / car.m, r / car.m},
                            {0.0, 0.0, car.a * f / car.inertia, -car.b * r / car.inertia},
                            {-1.0, -car.a, -v / sigma, 0.0},
                            {-1.0, car.b, 0.0, -v / sigma}};
  return s.eigenvalues().real().maxCoeff();
}

// An oversteering car is unstable above V² = −L/K: a small yaw rate decays below this speed and grows above it.
TEST(SingleTrack, CriticalSpeedOfAnOversteeringCar) {
  Vec2 const of(1.6, 1.2), stiffness(8e4, 8e4);
  SingleTrack const first(of, stiffness, 0.0, 1.0);
  double const critical = std::sqrt(-2.8 / first.understeer());
  EXPECT_NEAR(growth(first, critical), 0.0, 1e-9);
  for (double const part : {0.9, 1.0, 1.1}) {
    double const speed = part * critical;
    SingleTrack car(of, stiffness, 0.0, speed);
    car.x.v += [&] {  // a yaw rate of the whole car
      State turned = car.model.reference_state();
      for (auto const& body : {car.car}) car.model.set_velocity(turned, body, Vec3::Zero(), Vec3(0, 0, 1e-4));
      return turned.v;
    }();
    make_consistent(car.model, car.x);
    double early = 0.0, late = 0.0;
    for (State const& now :
         simulate(car.model, car.x, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = 4.0, .step = 2e-3})) {
      double const rate = frame(car.model, now, car.car.at({0, 0, 0})).w[2];
      if (std::abs(now.t - 2.0) < 1e-6) early = rate;
      late = rate;
    }
    held({"Single track", "growth of the yaw rate [1/s]", By::closed_form,
          "eigenvalue of the linear single-track model", "Rigid, Wheel<LinearTyre>, h = 2e-3 s"},
         0.5 * std::log(late / early), growth(car, speed), 1e-5, {equals("V/V_c", part), 0.3});
  }
}

}  // namespace wheels_test
