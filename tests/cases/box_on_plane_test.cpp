// A box on a plane: sliding, tipping, settling, small oscillations, rocking about an edge and the energy audit.
#include <gtest/gtest.h>

#include <algorithm>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/contact_group.hpp>
#include <polybody/forces/shapes/compound.hpp>
#include <polybody/forces/shapes/shapes_on_plane.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/run/energy_audit.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/held.hpp"

using namespace polybody;

namespace box_on_plane_test {

constexpr double g = 9.81, mass = 1.0, side = 0.1, foot = 0.045, k = 1e5;
constexpr DormandPrince<> precise{.relative_tolerance = 1e-11, .absolute_tolerance = 1e-13};

Mat3 inertia_of_box(double m, Vec3 const& s) {
  return Vec3(m / 12.0 * (s[1] * s[1] + s[2] * s[2]), m / 12.0 * (s[0] * s[0] + s[2] * s[2]),
              m / 12.0 * (s[0] * s[0] + s[1] * s[1]))
      .asDiagonal();
}

/// A body on the plane z = 0 of the ground.
template <class Law>
struct OnFloor {
  Model<Bodies<Rigid<>>, Joints<>, Forces<Law>> model{Gravity{0, 0, -g}};
  BodyHandle<Rigid<>> body;
  ElementHandle<Law> floor;

  OnFloor(Law const& law, Mat3 const& inertia, Placement const& at, double m = mass)
      : body(model.add(Rigid<>(m, inertia, at), "body")),
        floor(model.apply(law, body.at(Vec3(0, 0, 0)), model.ground().at({0, 0, 0}), "floor")) {}
  State start(Vec3 const& v, Vec3 const& w = Vec3::Zero()) const {
    State x = model.reference_state();
    model.set_velocity(x, body, v, w);
    return x;
  }
  Frame<double> frame_in(State const& x) const { return frame(model, x, body.at(Vec3(0, 0, 0))); }
};
using Box = Contact<BoxOnPlane>;
using Round = Contact<BoxOnPlane, HuntCrossleyContact>;

Box cube(double friction, double damping = 30.0) {
  return {.geometry = {.size = {side, side, side}, .rounding = 0.5 * side - foot},
          .normal = {.stiffness = k, .damping = damping},
          .friction = {.coefficient = friction, .slip_speed = 1e-3}};
}
double const at_rest = 0.5 * side - mass * g / (4.0 * k);
OnFloor<Box> launched(double friction) {
  return {cube(friction), inertia_of_box(mass, {side, side, side}), Placement::at({0, 0, at_rest})};
}
Claim closed_form(char const* what, char const* source, char const* formulation) {
  return {"closed forms", what, By::closed_form, source, formulation};
}

// Distance v²/(2 μ g) and time v/(μ g). During sliding the moment μ m g h about the centre, h = side/2, is balanced by
// a difference of the loads: front foot m g/4 (1 + μ h/b), rear foot m g/4 (1 − μ h/b), with b = `foot`.
TEST(BoxOnPlaneCase, SlidesStopsAndKeepsItsFourFeetOnTheFloor) {
  double const friction = 0.5, v = 6.0, distance = v * v / (2.0 * friction * g), time = v / (friction * g);
  auto const box = launched(friction);
  State x = box.start({v, 0, 0});
  Probe probe(box.model);
  double front = 0.0, rear = 0.0, stopped = 0.0, tilt = 0.0;
  int fewest = 4;
  for (State const& now : simulate(box.model, x, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = 1.4, .step = 5e-4})) {
    ObservedState const seen(now, probe);
    Frame<double> const f = box.frame_in(now);
    if (stopped == 0.0 && f.v[0] < 2e-3) stopped = now.t;
    tilt = std::max(tilt, 1.0 - f.A(2, 2));
    if (now.t < 0.5 || now.t > 1.0) continue;
    int points = 0;
    front = rear = 0.0;
    seen.for_each_contact(box.floor, [&](TouchingPoint const& p) {
      ++points;
      (p.place[0] > f.r[0] ? front : rear) += 0.5 * p.force[2];
    });
    fewest = std::min(fewest, points);
  }
  auto const claim = [](char const* what, char const* source) {
    return closed_form(what, source, "BoxOnPlane, rounding 5 mm, generalised-alpha, h = 0.5 ms");
  };
  held(claim("distance of the sliding cube [m]", "v²/(2 μ g)"), box.frame_in(x).r[0], distance, 0.003 * distance);
  held(claim("time to the stop of the cube [s]", "v/(μ g)"), stopped, time, 0.003 * time);
  double const share = friction * 0.5 * side / foot;
  held(claim("load of a front foot [N]", "m g/4 (1 + μ h/b)"), front, 0.25 * mass * g * (1.0 + share), 0.01 * front);
  held(claim("load of a rear foot [N]", "m g/4 (1 − μ h/b)"), rear, 0.25 * mass * g * (1.0 - share), 0.01 * rear);
  EXPECT_EQ(fewest, 4);
  EXPECT_LT(tilt, 1e-6);
}

// The limit is μ = b/h = 0.9.
TEST(BoxOnPlaneCase, TipsOverOnlyAboveItsCoefficientOfFriction) {
  for (double const friction : {0.85, 0.95}) {
    auto const box = launched(friction);
    State x = box.start({6.0, 0, 0});
    double upright = 1.0;
    for (State const& now : simulate(box.model, x, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = 0.7, .step = 5e-4}))
      upright = std::min(upright, box.frame_in(now).A(2, 2));
    if (friction < 0.9)
      EXPECT_GT(upright, 0.999);
    else
      EXPECT_LT(upright, 0.5);
  }
}

/// Falls with the face normal to `up` (in body axes) below, a little inclined, and comes to rest on it.
void expect_to_settle(Vec3 const& size, Mat3 const& axes, double height, double incline = 0.1) {
  Box law{.geometry = {.size = size, .rounding = 0.004},
          .normal = {.stiffness = k, .damping = 60.0},
          .friction = {.coefficient = 0.5, .slip_speed = 1e-3}};
  Mat3 const leaning = exp_so3<double>(Vec3(incline, -0.7 * incline, 0.3)) * axes;
  OnFloor<Box> const box(law, inertia_of_box(mass, size), {{0, 0, 0.5 * height + 0.03}, leaning});
  State x = box.start(Vec3::Zero());
  simulate(box.model, x, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = 1.5, .step = 5e-4}).run();
  Frame<double> const f = box.frame_in(x);
  EXPECT_NEAR(f.r[2], 0.5 * height - mass * g / (4.0 * k), 1e-8) << height;
  EXPECT_NEAR((axes.transpose() * Vec3::UnitZ()).dot(f.A.transpose() * Vec3::UnitZ()), 1.0, 1e-9) << height;
  EXPECT_LT(f.w.norm() + f.v.norm(), 1e-4) << height;
}
TEST(BoxOnPlaneCase, SettlesOnEachFace) {
  Vec3 const size(0.08, 0.12, 0.16);
  for (int axis = 0; axis < 3; ++axis)
    for (double const side_up : {1.0, -1.0}) {
      Mat3 axes;  // row 2, the direction of z in body axes, is ± the axis
      axes.row(2) = side_up * Vec3::Unit(axis).transpose();
      axes.row(0) = Vec3::Unit((axis + 1) % 3).transpose();
      axes.row(1) = axes.row(2).cross(axes.row(0));
      expect_to_settle(size, axes, size[axis]);
    }
}

// A planar body has the eight corners of a box. The plane is vertical to y: its marker is rotated about x.
TEST(BoxOnPlaneCase, SettlesInAPlanarModel) {
  Model<Bodies<planar::Rigid>, Joints<>, Forces<Box>> model{Gravity{0, -g, 0}};
  auto const body = model.add(planar::Rigid(mass, 0.002, Placement::planar(0, 0.08, 0.2)), "box");
  model.apply(
      Box{{.size = {side, side, side}}, {.stiffness = k, .damping = 60.0}, {.coefficient = 0.5, .slip_speed = 1e-3}},
      body.at(Vec2(0, 0)), model.ground().at(Placement::at({0, 0, 0}, {-0.5 * EIGEN_PI, 0, 0})), "floor");
  State x = model.reference_state();
  simulate(model, x, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = 1.0, .step = 5e-4}).run();
  EXPECT_NEAR(x.q[1], 0.5 * side - mass * g / (4.0 * k), 1e-8);
  EXPECT_NEAR(x.q[2], 0.0, 1e-7);
}

// Small rotation about y on four springs without friction: J θ̈ = −4 k b² θ + m g h θ. The reaction m g of the
// tilted box acts at the distance h θ from its centre.
TEST(BoxOnPlaneCase, RocksOnItsFourCornersAtTheFrequencyOfTheClosedForm) {
  Vec3 const size(0.1, 0.1, 0.4);
  double const stiffness = 2e3, h = 0.2, b = 0.05;
  Mat3 const inertia = inertia_of_box(mass, size);
  Box const law{.geometry = {.size = size}, .normal = {.stiffness = stiffness}};
  double const omega = std::sqrt((4.0 * stiffness * b * b - mass * g * h) / inertia(1, 1)), tilt = 1e-4;
  OnFloor<Box> const box(law, inertia, Placement::at({0, 0, h - mass * g / (4.0 * stiffness)}, {0, tilt, 0}));
  State x = box.start(Vec3::Zero());
  std::vector<double> zeros;
  double before = tilt, t = 0.0;
  for (State const& now : simulate(box.model, x, precise, {.end_time = 3.0, .step = 1e-3})) {
    double const angle = box.frame_in(now).A(0, 2);
    if (before * angle < 0.0) zeros.push_back(t + (now.t - t) * before / (before - angle));
    before = angle;
    t = now.t;
  }
  ASSERT_GT(zeros.size(), 5u);
  double const period = 2.0 * (zeros.back() - zeros.front()) / double(zeros.size() - 1);
  held(closed_form("period of a box on four springs [s]", "2π/√((4 k b² − m g h)/J)", "BoxOnPlane, Dormand–Prince"),
       period, 2.0 * EIGEN_PI / omega, 2e-5 * period);
}

// A block with the half width b and the half height h, with its centre at the distance R from the edge on the floor,
// is inclined by θ₀ and falls back [Housner 1963]: θ̈ = −p² sin(α − θ) with p² = m g R/(J + m R²) and tan α = b/h. The
// time from θ₀ to θ₀/10 for b = 0.05 m, h = 0.2 m, θ₀ = α/2 is 0.21080178 s, by quadrature of the energy integral with
// the rule of Simpson in 400 and 2000 intervals. The floor is stiff, and the friction holds the edge.
TEST(BoxOnPlaneCase, RocksAboutAnEdgeLikeARigidBlock) {
  double const b = 0.05, h = 0.2, alpha = std::atan2(b, h), start = 0.5 * alpha, reach = std::hypot(b, h);
  Vec3 const size(2.0 * b, 0.1, 2.0 * h);
  Box const law{.geometry = {.size = size},
                .normal = {.stiffness = 1e7, .damping = 500.0},
                .friction = {.coefficient = 2.0, .slip_speed = 1e-4}};
  Vec3 const centre(-reach * std::sin(alpha - start), 0.0, reach * std::cos(alpha - start) - mass * g / 2e7);
  OnFloor<Box> const box(law, inertia_of_box(mass, size), Placement::at(centre, {0, start, 0}));
  State x = box.start(Vec3::Zero());
  double before = start, t = 0.0, met = 0.0;
  for (State const& now : simulate(box.model, x, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = 0.22, .step = 2e-4})) {
    double const angle = std::atan2(box.frame_in(now).A(0, 2), box.frame_in(now).A(2, 2));
    if (met == 0.0 && angle < 0.1 * start) met = t + (now.t - t) * (before - 0.1 * start) / (before - angle);
    before = angle;
    t = now.t;
  }
  held({"closed forms", "time of a rocking block from α/2 to α/20 [s]", By::independent,
        "quadrature of the energy integral", "BoxOnPlane, k = 1e7 N/m"},
       met, 0.21080178, 2e-3 * met);
}

// --- energy -------------------------------------------------------------------------------------------------------

/// Box that tumbles over the floor, with changing sets of contact points.
OnFloor<Round> tumbling(double damping, double friction) {
  Vec3 const size(0.08, 0.12, 0.16);
  return {{.geometry = {.size = size, .rounding = 0.004},
           .normal = {.stiffness = 2e6, .damping = damping},
           .friction = {.coefficient = friction, .slip_speed = 0.1}},
          inertia_of_box(mass, size),
          Placement::at({0, 0, 0.15}, {0.4, 0.7, 0.2})};
}
TEST(BoxOnPlaneCase, ConservesEnergyThroughItsImpacts) {
  auto const box = tumbling(0.0, 0.0);
  State x = box.start({0.5, 0.2, 0}, {1, 8, 2});
  Probe probe(box.model);
  double const before = energy(box.model, x).total();
  int touched = 0;
  double lowest = 1.0, drift = 0.0;
  for (State const& now : simulate(box.model, x, precise, {.end_time = 1.0, .step = 1e-3})) {
    ObservedState const seen(now, probe);
    int points = 0;
    seen.for_each_contact(box.floor, [&](TouchingPoint const&) { ++points; });
    touched += points > 0;
    drift = std::max(drift, std::abs(energy(box.model, now).total() - before));
    lowest = std::min(lowest, box.frame_in(now).r[2]);
  }
  EXPECT_GT(touched, 10);
  EXPECT_LT(drift, 1e-8 * before);
}
TEST(BoxOnPlaneCase, EnergyAuditCloses) {
  auto const box = tumbling(0.5, 0.3);
  State x = box.start({0.5, 0.2, 0}, {1, 8, 2});
  EnergyAudit audit(box.model);
  for (State const& now : simulate(box.model, x, RungeKutta4{}, {.end_time = 0.5, .step = 1e-5})) audit.record(now);
  EXPECT_GT(audit.dissipated(), 0.3);
  EXPECT_LT(audit.relative(), 1e-6) << audit;
}

// --- several shapes -----------------------------------------------------------------------------------------------

// A sledge of two boxes and a capsule, given by one compound or by three contacts.
TEST(BoxOnPlaneCase, CompoundIsTheSumOfItsShapes) {
  BoxOnPlane const runner{.size = {0.4, 0.05, 0.05}};
  CapsuleOnPlane const bar{.radius = 0.03, .length = 0.3};
  Placement const left = Placement::at({0, 0.15, 0}), right = Placement::at({0, -0.15, 0}),
                  front = Placement::at({0.25, 0, 0.02}, {0, 0, 0.5 * EIGEN_PI});
  SpringDamperContact const normal{.stiffness = 1e4, .damping = 50.0};
  Friction const friction{.coefficient = 0.3, .slip_speed = 0.01};
  using Sledge = Compound<BoxOnPlane, BoxOnPlane, CapsuleOnPlane>;
  Contact<Sledge> const whole{Sledge(Placed{runner, left}, Placed{runner, right}, Placed{bar, front}), normal,
                              friction};
  Mat3 const inertia = inertia_of_box(2.0, {0.5, 0.3, 0.1});
  Placement const at = Placement::at({0, 0, 0.1}, {0.1, 0.3, 0});
  OnFloor<Contact<Sledge>> const one(whole, inertia, at, 2.0);

  using Each = Contact<BoxOnPlane>;
  using Bar = Contact<Compound<CapsuleOnPlane>>;
  Model<Bodies<Rigid<>>, Joints<>, Forces<Each, Bar>> model{Gravity{0, 0, -g}};
  auto const body = model.add(Rigid<>(2.0, inertia, at), "sledge");
  auto const ground = model.ground().at({0, 0, 0});
  model.apply(Each{runner, normal, friction}, body.at(left.origin), ground, "left runner");
  model.apply(Each{runner, normal, friction}, body.at(right.origin), ground, "right runner");
  model.apply(Bar{Compound(Placed{bar, front}), normal, friction}, body.at(Vec3(0, 0, 0)), ground, "bar");

  State x = one.start({1, 0, 0}), y = model.reference_state();
  model.set_velocity(y, body, {1, 0, 0}, {0, 0, 0});
  simulate(one.model, x, RungeKutta4{}, {.end_time = 0.5, .step = 1e-4}).run();
  simulate(model, y, RungeKutta4{}, {.end_time = 0.5, .step = 1e-4}).run();
  EXPECT_LT((x.q - y.q).norm() + (x.v - y.v).norm(), 1e-9);
  EXPECT_LT(frame(model, y, body.at(Vec3(0, 0, 0))).r[2], 0.06);
}

}  // namespace box_on_plane_test
