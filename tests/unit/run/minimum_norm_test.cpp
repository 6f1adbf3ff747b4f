// Load sharing of redundant joints, computed by hand.

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/held.hpp"

namespace polybody {
namespace minimum_norm_test {

constexpr double g = 9.81;

/// Plate of 2 kg on four legs at (±1, ±1), with the mass centre at (x, y).
struct Platform {
  using Leg = Joint<PointInPlane, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Leg>> model{Gravity{0, 0, -g}};
  std::vector<ElementHandle<Leg>> legs;
  State x;
  static constexpr double breakpoints[4][2] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};

  Platform(double cx, double cy) {
    Mat3 const inertia = Vec3(0.7, 0.8, 1.5).asDiagonal();
    auto const plate = model.add(Rigid<>(2.0, inertia, Placement::at({cx, cy, 0})), "plate");
    for (auto const& c : breakpoints)
      legs.push_back(model.connect(Leg{PointInPlane{.normal = Vec3::UnitZ()}, {}}, model.ground().at({0, 0, 0}),
                                   plate.at(Vec3(c[0] - cx, c[1] - cy, 0))));
    x = model.reference_state();
  }
  double force(State const& s, std::size_t i) const { return reaction(model, s, legs[i]).f[2]; }
};

// The minimum of Σ λ² with Σ λ = m g, Σ λ x_i = m g x, Σ λ y_i = m g y is affine in the position of the leg: λ_i = ¼
// m g (1 + x x_i + y y_i).
TEST(MinimumNorm, OfAPlatformOnFourLegsIsAffine) {
  for (auto const& [cx, cy] : {std::pair{0.0, 0.0}, std::pair{0.2, -0.5}}) {
    Platform p(cx, cy);
    auto run = simulate(p.model, p.x, GeneralisedAlpha{}, {.end_time = 0.1, .step = 0.01});
    ASSERT_EQ(run.report().redundant.size(), 1u);
    double least = 1.0;
    for (std::size_t i = 0; i < 4; ++i) least = std::min(least, std::abs(p.force(p.x, i)));
    EXPECT_NEAR(least, 0.0, 1e-12);  // a dropped equation has no force in one leg
    State shared = p.x;
    shared.lambda = minimum_norm_multipliers(p.model, p.x);
    for (std::size_t i = 0; i < 4; ++i)
      held({"closed forms", "forces in four legs of a platform [N]", By::closed_form, "¼ m g (1 + x xᵢ + y yᵢ)",
            "Rigid, minimum norm"},
           p.force(shared, i), 0.5 * g * (1.0 + cx * p.breakpoints[i][0] + cy * p.breakpoints[i][1]), 1e-12,
           {equals("leg", double(i + 1))});
    System system(p.model);
    VecX r = VecX::Zero(p.model.velocities());
    system.evaluate(shared.q, shared.v, shared.t);
    system.residual(shared.a, shared.lambda, r);
    EXPECT_LT(r.norm(), 1e-12);  // M a + Gᵀλ = f also holds
  }
}

// Two pins constrain a beam four times. They share its weight and a force along it equally.
TEST(MinimumNorm, OfABeamOnTwoPinsIsHalf) {
  using Pin = Joint<planar::Revolute, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Pin>, Forces<PointForce<>>> model{Gravity{0, -g, 0}};
  auto const beam = model.add(planar::Rigid(3.0, 0.5), "beam");
  auto const left = model.connect(Pin{}, model.ground().at({-2, 0, 0}), beam.at(Vec2(-2, 0)), "left");
  auto const right = model.connect(Pin{}, model.ground().at({2, 0, 0}), beam.at(Vec2(2, 0)), "right");
  model.apply(PointForce<>{.force = {7, 0, 0}}, beam.at(Vec2(0, 0)), "push");
  State x = model.reference_state();
  for (State const& now :
       simulate(model, x, GeneralisedAlpha{}, {.end_time = 0.02, .step = 0.01, .minimum_norm = true}))
    for (auto const& pin : {left, right})
      held_within({"closed forms", "forces in two pins of a beam [N]", By::closed_form, "half of the load each",
                   "planar Rigid, minimum norm"},
                  (reaction(model, now, pin).f - Vec3(-3.5, 1.5 * g, 0)).norm(), 1e-12, {equals("t", now.t), 1.5 * g});
}

/// Door of mass m on two pins at z = ±h, with the mass centre at the distance d from them, rotating at ω.
template <class I>
void expect_door(char const* formulation, I const& integrator, double unit, double tolerance) {
  using Pin = Joint<Revolute, Constraint>;
  double const m = 4.0, h = 0.8 * unit, d = 0.5 * unit, omega = 3.0;
  Model<Bodies<Rigid<>>, Joints<Pin>> model{Gravity{0, 0, -g * unit}};
  Mat3 const inertia = (unit * unit * Vec3(0.3, 0.4, 0.5)).asDiagonal();
  auto const door = model.add(Rigid<>(m, inertia, Placement::at({d, 0, 0})), "door");
  auto const top =
      model.connect(Pin{{.axis = Vec3::UnitZ()}, {}}, model.ground().at({0, 0, h}), door.at(Vec3(-d, 0, h)), "top");
  auto const bottom = model.connect(Pin{{.axis = Vec3::UnitZ()}, {}}, model.ground().at({0, 0, -h}),
                                    door.at(Vec3(-d, 0, -h)), "bottom");
  State x = model.reference_state();
  model.set_velocity(x, door, Vec3::Zero(), {0, 0, omega});
  // The pins carry the moment −M = −m g d about the tangent by forces ∓F along the radius, 2 h F, and moments N each,
  // 2 N. The minimum of 2 F² + 2 N²/ℓ² has F = N h/ℓ². With ℓ = h, the distance of both pins from their mean: F =
  // M/4h, N = M/4.
  double const moment = m * g * unit * d, weight = m * g * unit, scale = std::max(weight, m * omega * omega * d);
  int states = 0;
  double off_f = 0.0, off_m = 0.0;
  for (State const& now : simulate(model, x, integrator, {.end_time = 0.5, .step = 0.01, .minimum_norm = true})) {
    Vec3 const out(std::cos(omega * now.t), std::sin(omega * now.t), 0.0), along(-out[1], out[0], 0.0);
    for (bool const upper : {true, false}) {
      Wrench<> const w = reaction(model, now, upper ? top : bottom);
      Vec3 const force =
          Vec3(0, 0, 0.5 * weight) + (-0.5 * m * omega * omega * d - (upper ? 1 : -1) * moment / (4.0 * h)) * out;
      off_f = std::max(off_f, (w.f - force).norm() / scale);
      off_m = std::max(off_m, (w.m + 0.25 * moment * along).norm() / (scale * unit));
    }
    ++states;
  }
  auto const claim = [&](char const* what) {
    return Claim{"closed forms", what, By::closed_form, "least 2 F² + 2 N²/ℓ²", formulation};
  };
  held_within(claim("forces in two hinges of a door that turns, of its weight or m ω² d"), off_f, tolerance,
              {.scale = 1.0});
  held_within(claim("moments in two hinges of a door that turns, of the same times 1 m"), off_m, tolerance,
              {.scale = 1.0});
  EXPECT_GE(states, 51);
}

TEST(MinimumNorm, OfADoorOnTwoPinsIsSharedInEveryStateOfARun) {
  expect_door("Rigid, Runge–Kutta 4", RungeKutta4<Projection>{}, 1.0, 1e-7);
  expect_door("Rigid, generalised-α", GeneralisedAlpha{}, 1.0, 1e-3);
}
// Body on a screw of pitch p parallel to a weld, with the force F along their axis. The constraint force of the
// screw, a force with the moment p, is s. The weld carries F − s and the moment p s. The weights are 1, 1 + p²/ℓ² and
// 1/ℓ², with ℓ = 1 for joints at one position. The minimum of (F − s)² + (1 + p²) s² + p² s² has s = F/(2 + 2 p²).
TEST(MinimumNorm, WeighsForcesAndMomentsOfARow) {
  using Thread = Joint<Screw, Constraint>;
  using Clamp = Joint<Weld, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Thread, Clamp>, Forces<PointForce<>>> model;
  auto const nut = model.add(Rigid<>(1.0, Mat3::Identity()), "nut");
  double const pitch = 0.7, push = 8.0;
  auto const thread = model.connect(Thread{{.pitch = pitch, .axis = Vec3::UnitZ()}, {}}, model.ground().at({0, 0, 0}),
                                    nut.at(Vec3(0, 0, 0)));
  auto const clamp = model.connect(Clamp{}, model.ground().at({0, 0, 0}), nut.at(Vec3(0, 0, 0)));
  model.apply(PointForce<>{.force = {0, 0, push}}, nut.at(Vec3(0, 0, 0)));
  State x = model.reference_state();
  simulate(model, x, GeneralisedAlpha{}, {.end_time = 0.02, .step = 0.01, .minimum_norm = true}).run();
  double const s = push / (2.0 + 2.0 * pitch * pitch);
  auto const share = [](char const* what, double value, double exact) {
    held({"closed forms", what, By::closed_form, "s = F/(2 + 2 p²)", "Rigid, minimum norm"}, value, exact, 1e-11);
  };
  share("force of a screw beside a weld [N]", reaction(model, x, thread).f[2], -s);
  share("moment of a screw beside a weld [N m]", std::abs(reaction(model, x, thread).m[2]), pitch * s);
  share("force of a weld beside a screw [N]", reaction(model, x, clamp).f[2], s - push);
}

// ℓ scales with the model, so the load sharing is independent of the unit of length.
TEST(MinimumNorm, OfADoorDoesNotDependOnTheUnits) {
  expect_door("Rigid, Runge–Kutta 4, in millimetres", RungeKutta4<Projection>{}, 1e3, 1e-7);
}

// Without redundant constraints the multipliers are bitwise unchanged.
TEST(MinimumNorm, LeavesUniqueMultipliersAlone) {
  using Pin = Joint<planar::Revolute, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Pin>> model{Gravity{0, -g, 0}};
  auto const rod = model.add(planar::Rigid(1.0, 0.1), "rod");
  model.connect(Pin{}, model.ground().at({-0.5, 0, 0}), rod.at(Vec2(-0.5, 0)), "pin");
  State x = model.reference_state(), y = x;
  simulate(model, x, GeneralisedAlpha{}, {.end_time = 0.3, .step = 0.01}).run();
  simulate(model, y, GeneralisedAlpha{}, {.end_time = 0.3, .step = 0.01, .minimum_norm = true}).run();
  EXPECT_EQ(x.lambda, y.lambda);
  EXPECT_EQ(x.lambda, minimum_norm_multipliers(model, x));
}

}  // namespace minimum_norm_test
}  // namespace polybody
