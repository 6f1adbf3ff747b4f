// Inertia in other axes and about other points, of solids and of sums of parts. Case 6 of the threads of users.
#include <polybody/bodies/rigid/inertia.hpp>

#include <gtest/gtest.h>

#include <numbers>

#include <polybody/forces/loads.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/accelerations.hpp>
#include <polybody/system/model.hpp>

#include "support/held.hpp"
#include "support/refusal.hpp"

namespace polybody::inertia_test {

using std::numbers::pi;

Mat3 diagonal(double x, double y, double z) { return Mat3(Vec3(x, y, z).asDiagonal()); }

/// Part of case 6 (b): tensor in axes turned by (0.3, −0.4, 0.5) rad about the fixed axes of the link.
Inertia const turned_part = [] {
  Mat3 tensor;
  tensor << 0.10, 0.01, -0.02, 0.01, 0.16, 0.015, -0.02, 0.015, 0.21;
  return Inertia{.mass = 2.5, .tensor = tensor}.placed({Vec3(0.05, -0.12, 0.20), roll_pitch_yaw(0.3, -0.4, 0.5)});
}();

// A rotation about a fixed axis leaves this axis in place, and the yaw is the last rotation.
TEST(Inertia, RollPitchYawRotateAboutFixedAxes) {
  Mat3 const turned =
      exp_so3<double>(Vec3(0, 0, 0.5)) * exp_so3<double>(Vec3(0, -0.4, 0)) * exp_so3<double>(Vec3(0.3, 0, 0));
  EXPECT_LT((roll_pitch_yaw(0.3, -0.4, 0.5) - turned).norm(), 1e-15);
}

// R diag(1, 2, 2.5) Rᵀ with 90° about z exchanges the first two moments: 2 N m for 1 rad/s² about x  [case 6 (a)].
TEST(Inertia, TurnedAxesOfAFreeBody) {
  Inertia const part =
      Inertia{.mass = 1.0, .tensor = diagonal(1, 2, 2.5)}.placed({Vec3::Zero(), roll_pitch_yaw(0, 0, pi / 2)});
  Model<Bodies<Rigid<>>, Joints<>, Forces<PointMoment<>>> model;
  auto const body = model.add(Rigid<>(part.body()), "body");
  model.apply(PointMoment<>{.moment = {2.0, 0.0, 0.0}}, body.centre(), "torque");
  State x = model.reference_state();
  compute_accelerations(model, x);
  Claim const about_x{"X6", "angular acceleration under 2 N m about x [rad/s²]", By::closed_form, "R J Rᵀ", "Rigid"};
  held(about_x, angular_acceleration(model, x, body.centre())[0], 1.0, 1e-14);
}

// I = R I_u Rᵀ and the parallel axes; numbers of case 6 (b).
TEST(Inertia, TensorAndParallelAxesOfALink) {
  Mat3 expected;
  expected << 0.12254332, -0.00330207, -0.04791194, -0.00330207, 0.16224339, -0.02113456, -0.04791194, -0.02113456,
      0.18521329;
  EXPECT_LT((turned_part.tensor - expected).cwiseAbs().maxCoeff(), 1e-8);
  Mat3 const about_origin = turned_part.about({0, 0, 0});
  EXPECT_NEAR(about_origin(0, 0), 0.25854332, 1e-8);
  EXPECT_NEAR(about_origin(1, 1), 0.26849339, 1e-8);
  EXPECT_NEAR(about_origin(2, 2), 0.22746329, 1e-8);
}

// Pendulum about the link's x: θ¨ = −ω² sin θ at any angle, so that one state gives ω  [case 6 (b)].
TEST(Inertia, SmallSwingsOfALink) {
  using Hinge = Joint<Revolute>;
  double const hanging = -0.5 * pi - std::atan2(0.20, -0.12), angle = 0.3;
  Model<Bodies<Rigid<>>, Joints<Hinge>> model{Gravity{0, 0, -9.81}};
  auto const body = model.add(Rigid<>(turned_part.body({Vec3::Zero(), roll_pitch_yaw(hanging + angle, 0, 0)})), "link");
  model.connect(Hinge{Revolute{.axis = {1, 0, 0}}}, model.ground().at({0, 0, 0}), body.at(Vec3(-turned_part.centre)),
                "hinge");
  State x = model.reference_state();
  compute_accelerations(model, x);
  double const rate = angular_acceleration(model, x, body.centre())[0];
  Claim const swing{"X6", "frequency of small swings [rad/s]", By::closed_form, "√(m g d/I_xx)", "Rigid, Revolute"};
  held(swing, std::sqrt(std::abs(rate / std::sin(angle))), 4.703678, 1e-6);
  // hanging: the acceleration opposes the angle
  EXPECT_LT(rate * std::sin(angle), 0.0);
}

// [Goldstein, Poole & Safko 2002, ch. 5]
TEST(Inertia, SolidsHaveTheirClosedForms) {
  EXPECT_LT((Inertia::box(12.0, {1, 2, 3}).tensor - diagonal(13, 10, 5)).norm(), 1e-14);
  EXPECT_LT((Inertia::cylinder(12.0, 2.0, 3.0).tensor - diagonal(21, 21, 24)).norm(), 1e-14);
  EXPECT_LT((Inertia::sphere(5.0, 2.0).tensor - diagonal(8, 8, 8)).norm(), 1e-14);
  // thin shell: m r² about the axis
  EXPECT_NEAR(Inertia::tube(3.0, 2.0, 2.0, 1.0).tensor(2, 2), 12.0, 1e-14);
}

// A tube and the cylinder that fits in it are a cylinder, with masses by volume.
TEST(Inertia, PartsAddUp) {
  double const inner = 0.3, outer = 0.5, length = 1.7, rho = 900.0 * pi * length;
  Inertia const core = Inertia::cylinder(rho * inner * inner, inner, length);
  Inertia const both = core + Inertia::tube(rho * (outer * outer - inner * inner), outer, inner, length);
  Inertia const whole = Inertia::cylinder(rho * outer * outer, outer, length);
  EXPECT_NEAR(both.mass, whole.mass, 1e-12 * whole.mass);
  EXPECT_LT((both.tensor - whole.tensor).norm(), 1e-13 * whole.tensor.norm());
  // two halves of a box, placed in turned axes
  Placement const half{Vec3(0.5, 0, 0), roll_pitch_yaw(0, 0, pi / 2)};
  Inertia const first = Inertia::box(2.0, {2, 1, 3}).placed(half),
                second = Inertia::box(2.0, {1, 2, 3}).placed(Placement::at({-0.5, 0, 0}));
  EXPECT_LT(((first + second).tensor - Inertia::box(4.0, {2, 2, 3}).tensor).norm(), 1e-14);
  EXPECT_LT((first + second).centre.norm(), 1e-15);
}

// `about` another point and other axes agrees with `placed` in these axes: both state R J Rᵀ and the parallel axes.
TEST(Inertia, AboutAPointInOtherAxes) {
  Mat3 const axes = roll_pitch_yaw(-1.1, 0.7, 2.0);
  Vec3 const point(0.3, -0.2, 0.9);
  Inertia const seen = turned_part.placed({Vec3(-(axes.transpose() * point)), Mat3(axes.transpose())});
  EXPECT_LT((turned_part.about(point, axes) - seen.about({0, 0, 0})).norm(), 1e-14);
  // the kinetic energy of a rotation about the point does not depend on the axes
  Vec3 const omega(0.4, -1.0, 0.2), turned = axes.transpose() * omega;
  EXPECT_NEAR(turned.dot(turned_part.about(point, axes) * turned), omega.dot(turned_part.about(point) * omega), 1e-14);
}

TEST(Inertia, RefusesWhatNoMassHas) {
  Inertia const long_rod{.mass = 1.0, .tensor = diagonal(1, 2, 4)};
  EXPECT_TRUE(has(refusal([&] { (void)long_rod.body(); }),
                  "Inertia: the principal moments of inertia 4, 2, 1 kg m² violate the triangle inequality"));
  EXPECT_TRUE(has(refusal([&] { (void)long_rod.about({0, 0, 0}); }), "violate the triangle inequality"));
  EXPECT_TRUE(has(refusal([&] { (void)long_rod.placed({}); }), "violate the triangle inequality"));
  EXPECT_TRUE(has(refusal([&] { (void)(long_rod + turned_part); }), "violate the triangle inequality"));
  EXPECT_TRUE(has(refusal([&] { (void)turned_part.about({0, 0, 0}, 2.0 * identity()); }),
                  "Inertia::about: the placement's axes"));
  EXPECT_TRUE(
      has(refusal([] { (void)Inertia::box(1.0, {1, -2, 3}); }), "Inertia::box: the edge along y must be positive"));
  EXPECT_TRUE(has(refusal([] { (void)Inertia::sphere(-1.0, 1.0); }), "Inertia::sphere: the mass must be positive"));
  EXPECT_TRUE(has(refusal([] { (void)Inertia::tube(1.0, 1.0, 1.5, 1.0); }),
                  "the inner radius must lie in [0, 1] m, but is 1.5 m"));
}

}  // namespace polybody::inertia_test
