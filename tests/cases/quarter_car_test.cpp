// Quarter car: natural frequencies, static deflection, and a bump of a height field against an independent integration.

#include <gtest/gtest.h>

#include <polybody/gradients.hpp>
#include <polybody/parts.hpp>
#include <polybody/polybody.hpp>
#include <polybody/vibration.hpp>

#include "support/differences_of_runs.hpp"
#include "support/held.hpp"

using namespace polybody;

namespace quarter_car_test {

constexpr double g = 9.81, radius = 0.3, speed = 5.0;
using Tyre = Wheel<LinearTyre, HeightField>;
using Slide = Joint<planar::Prismatic, Constraint>;
using Pin = Joint<planar::Revolute, Constraint>;
using Drive = Joint<PrescribedTranslation<IntegralOf<Constant>>, Constraint>;
using Model2 = Model<Bodies<planar::Rigid>, Joints<Slide, Pin, Drive>, Forces<SpringDamper, Tyre>>;

/// Bump of 5 cm on a grid of 25 cm, the same as in wheels.py.
HeightField road() {
  MatX heights = MatX::Zero(49, 2);
  for (int i = 0; i < 3; ++i) heights.row(13 + i).setConstant(i == 1 ? 0.05 : 0.025);  // x = 1.25, 1.5, 1.75
  return HeightField({.x0 = -2.0, .y0 = -1.0, .dx = 0.25, .dy = 2.0, .heights = heights});
}

struct Numbers {
  double body_stiffness = 2e4, body_damping = 1.5e3, tyre_stiffness = 2e5, tyre_damping = 100.0, speed = 5.0;
};

/// A carriage with prescribed speed, a body and a hub on vertical slides of the carriage, and a wheel on the hub.
struct QuarterCar {
  Model2 model{Gravity{0, -g, 0}};
  BodyHandle<planar::Rigid> body, hub, wheel;
  ElementHandle<Tyre> tyre;
  State x;

  explicit QuarterCar(Numbers const& given = {}) {
    double const low = radius - 340.0 * g / 2e5;  // static for the given stiffnesses
    auto const carriage = model.add(planar::Rigid(1.0, 1.0, Placement::planar(0, low)), "carriage");
    body = model.add(planar::Rigid(300.0, 1.0, Placement::planar(0, low + 0.5)), "body");
    hub = model.add(planar::Rigid(25.0, 1.0, Placement::planar(0, low)), "hub");
    wheel = model.add(planar::Rigid(15.0, 1.0, Placement::planar(0, low)), "wheel");
    auto const at = [](auto const& part) { return part.at(Vec2(0, 0)); };
    auto const ground = model.ground().at({0, low, 0});
    model.connect(Slide{{.axis = Vec3::UnitX()}, {}}, ground, at(carriage), "rail");
    model.connect(Drive{{.law = {{.value = given.speed}}, .axis = Vec3::UnitX()}, {}}, ground, at(carriage), "drive");
    model.connect(Slide{{.axis = Vec3::UnitY()}, {}}, at(carriage), at(body), "strut of the body");
    model.connect(Slide{{.axis = Vec3::UnitY()}, {}}, at(carriage), at(hub), "strut of the hub");
    model.connect(Pin{}, at(hub), at(wheel), "axle");
    model.apply(
        SpringDamper{
            .stiffness = given.body_stiffness, .damping = given.body_damping, .free_length = 0.5 + 300.0 * g / 2e4},
        at(hub), at(body), "spring");
    Mat3 const upright{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}};  // z of the ground is the world's y
    tyre = model.apply(Tyre{.radius = radius,
                            .axle = -Vec3::UnitZ(),  // to the left of the direction of travel
                            .normal = {.stiffness = given.tyre_stiffness, .damping = given.tyre_damping},
                            .tyre = {.longitudinal_stiffness = 5e4,
                                     .cornering_stiffness = 5e4,
                                     .longitudinal_friction = 1.0,
                                     .lateral_friction = 1.0},
                            .relaxation = {.longitudinal = 0.2, .lateral = 0.2, .damping_time = 2e-3},
                            .terrain = road()},
                       at(wheel), model.ground().at(Placement{Vec3::Zero(), upright}), "tyre");
    x = model.reference_state();
    double const v = given.speed;
    for (auto const& part : {carriage, body, hub}) model.set_velocity(x, part, {v, 0, 0}, Vec3::Zero());
    Vec3 const turn(0, 0, -v / low);
    model.set_velocity(x, wheel, Vec3(v, 0, 0) - turn.cross(Vec3(0, low, 0)), turn);
    make_consistent(model, x);
  }
  double height(State const& s, BodyHandle<planar::Rigid> const& of) const {
    return frame(model, s, of.at(Vec2(0, 0))).r[1];
  }
};

// Undamped: ω² of [m_b, 0; 0, m_w] and [k_b, −k_b; −k_b, k_b + k_t] with m_b = 300 kg, m_w = 25 kg + 15 kg:
// m_b m_w ω⁴ − (m_b (k_b + k_t) + m_w k_b) ω² + k_b k_t = 0.
TEST(QuarterCar, NaturalFrequencies) {
  QuarterCar const car({.body_damping = 0.0, .tyre_damping = 0.0, .speed = 0.0});
  double const a = 300.0 * 40.0, b = 300.0 * (2e4 + 2e5) + 40.0 * 2e4, c = 2e4 * 2e5;
  DampedModes const found = damped_modes(car.model, car.x, 12);
  for (double const sign : {-1.0, 1.0}) {
    double const expected = std::sqrt((b + sign * std::sqrt(b * b - 4.0 * a * c)) / (2.0 * a));
    double nearest = 0.0;
    for (Index i = 0; i < found.eigenvalue.size(); ++i)
      if (std::abs(found.eigenvalue[i].imag() - expected) < std::abs(nearest - expected))
        nearest = found.eigenvalue[i].imag();
    held({"Quarter car", "natural frequency [rad/s]", By::closed_form, "two masses on two springs",
          "planar Rigid, Wheel"},
         nearest, expected, 1e-9 * expected, {sign < 0.0 ? "body" : "wheel"});
  }
}

// Reference: tests/cases/wheels.py (scipy, DOP853).
TEST(QuarterCar, CrossesABumpOfAHeightField) {
  struct Row {
    double t, body, wheel, spin;
  };
  std::vector<Row> const rows{
      {0.2, 0.783141805, 0.281455291, 17.69344050}, {0.25, 0.784745542, 0.304460165, 18.24654311},
      {0.3, 0.795624840, 0.333003660, 17.77328669}, {0.35, 0.811125366, 0.318039578, 17.37432179},
      {0.4, 0.817527685, 0.288846733, 17.32493109}, {0.5, 0.808763406, 0.284937381, 17.55341021},
      {0.7, 0.775626988, 0.281847144, 17.74046415}, {1.0, 0.779158399, 0.283426884, 17.64166625}};
  QuarterCar car;
  EnergyAudit audit(car.model);
  std::size_t next = 0;
  double const h = 2.5e-4;
  char const* const how = "scipy DOP853, foot of the perpendicular by Newton's method";
  for (State const& now : simulate(car.model, car.x, GeneralisedAlpha{.rho_inf = 0.9}, {.end_time = 1.0, .step = h})) {
    audit.record(now);
    if (next == rows.size() || std::abs(now.t - rows[next].t) > 0.1 * h) continue;
    Row const& row = rows[next++];
    std::string const at = equals("t", row.t);
    held({"Quarter car", "height of the body on a bump [m]", By::independent, how, "planar Rigid, h = 2.5e-4 s"},
         car.height(now, car.body), row.body, 3e-7, {at});
    held({"Quarter car", "height of the wheel on a bump [m]", By::independent, how, "planar Rigid, h = 2.5e-4 s"},
         car.height(now, car.wheel), row.wheel, 1e-6, {at});
    held({"Quarter car", "angular velocity of the wheel on a bump [rad/s]", By::independent, how,
          "planar Rigid, h = 2.5e-4 s"},
         -frame(car.model, now, car.wheel.at(Vec2(0, 0))).w[2], row.spin, 3e-4, {at});
  }
  EXPECT_EQ(next, rows.size());
  EXPECT_LT(audit.relative(), 1e-6);
  EXPECT_GT(audit.dissipated(), 1.0);
}

// Derivatives of height and angular velocity with respect to stiffnesses and speed. The body starts 2 cm too high.
auto const on_bump = [](std::span<double const> p) {
  QuarterCar car({.body_stiffness = p[0], .tyre_stiffness = p[1], .speed = p[2]});
  car.x.q[4] += 0.02;
  auto const height = [at = car.body.at(Vec2(0, 0))](auto const& m, auto const& x) { return position(m, x, at)[1]; };
  auto const spin = [at = car.wheel.at(Vec2(0, 0))](auto const& m, auto const& x) { return frame(m, x, at).w[2]; };
  std::vector<Output<Model2>> outputs{{"height [m]", height}, {"spin [rad/s]", spin}};
  return with_objective(
      Scenario<Model2>{std::move(car.model), car.x, {.end_time = 0.3, .step = 1e-3}, std::move(outputs)}, height);
};
TEST(QuarterCar, DerivativesAgreeWithDifferences) {
  std::vector<Parameter> const parameters{{"body stiffness", 2e4}, {"tyre stiffness", 2e5}, {"speed", 5.0}};
  GeneralisedAlpha const integrator{.rho_inf = 0.8, .tolerance = 1e-12};
  MatX const found = sensitivities(on_bump, parameters, integrator).derivatives.back();
  MatX const expected = by_differences(on_bump, parameters, integrator);
  GradientResult const backward = gradient(on_bump, parameters, integrator);
  for (Index j = 0; j < 3; ++j) {
    for (Index i = 0; i < 2; ++i)
      EXPECT_NEAR(found(i, j), expected(i, j), 1e-4 * std::abs(expected(i, j))) << i << ' ' << j;
    EXPECT_NEAR(backward.derivatives[j], found(0, j), 1e-9 * std::abs(found(0, j))) << j;
  }
}

}  // namespace quarter_car_test
