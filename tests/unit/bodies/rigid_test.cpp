#include <polybody/bodies/rigid/rigid.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/body_laws.hpp>

#include "support/refusal.hpp"

namespace polybody {
using namespace laws;
namespace rigid_test {

struct RigidCase {
  static Bar bar() {
    return {
        .length = 1.3,
        .constants =
            BarConstants{.EA = 900, .EI = 40, .mass_per_length = 2.0, .rotary_inertia = 0.05, .rotary_inertia_y = 0.02},
        .placement = Placement::at({0.4, -0.3, 0.8}, {0.5, -1.0, 0.7})};
  }
  static Rigid<> body(Bar const& bar) { return Rigid<>::from(bar); }
};
bool const rigid_obeys = obeys<RigidCase, BodyLaws>("Rigid");

double const nan_ = std::numeric_limits<double>::quiet_NaN();

std::array<double, 6> force_of(Rigid<> const& body, std::array<double, 6> const& v) {
  std::array<double, 7> q;
  body.reference(q);
  Vec6 f;
  body.force<double>(0, q, v, f);
  std::array<double, 6> out;
  std::copy_n(f.data(), 6, out.begin());
  return out;
}

Mat3 const tilted = [] {
  Mat3 const turn = exp_so3<double>(Vec3(0.4, -0.8, 0.3));
  return Mat3(turn * Vec3(0.3, 0.5, 0.7).asDiagonal() * turn.transpose());
}();

// Thin rod of length l: m l²/12 about its middle. A cylinder has in addition its rotary inertia ρ I l, and ρ (I_y +
// I_z) l about its own axis  [Goldstein, Poole & Safko 2002, ch. 5].
TEST(Rigid, BarHasTheInertiaOfACylinder) {
  double const l = 1.3, r = 0.04, rho = 7800, m = rho * std::numbers::pi * r * r * l;
  Bar const bar{.length = l, .section = Circle{.radius = r}, .material = Material{.density = rho, .young = 2e11}};
  Rigid<> const rod = Rigid<>::from(bar);
  Vec3 const expected(m * r * r / 2.0, m * (3 * r * r + l * l) / 12.0, m * (3 * r * r + l * l) / 12.0);
  EXPECT_NEAR(rod.mass(), m, 1e-13 * m);
  EXPECT_LT((rod.inertia() - Mat3(expected.asDiagonal())).norm(), 1e-13 * expected.norm());
}

// Cuboid: m (b² + c²)/12 about each axis; height along y, width along z.
TEST(Rigid, BarHasTheInertiaOfACuboid) {
  double const l = 1.3, h = 0.2, w = 0.1, m = 500 * l * h * w;
  Bar const bar{
      .length = l, .section = Rectangle{.height = h, .width = w}, .material = Material{.density = 500, .young = 1e9}};
  Vec3 const expected = m / 12.0 * Vec3(h * h + w * w, l * l + w * w, l * l + h * h);
  EXPECT_LT((Rigid<>::from(bar).inertia() - Mat3(expected.asDiagonal())).norm(), 1e-13);
}

// The default of Iρ about y is Iρ about z.
TEST(Rigid, BarOfOneRotaryInertiaIsRound) {
  Bar bar = RigidCase::bar();
  bar.constants->rotary_inertia_y.reset();
  double const l = 1.3, lateral = 2.0 * l * l * l / 12.0 + 0.05 * l;
  Mat3 const expected = Vec3(2 * 0.05 * l, lateral, lateral).asDiagonal();
  EXPECT_LT((Rigid<>::from(bar).inertia() - expected).norm(), 1e-15);
}

TEST(Rigid, SpinningBarHasItsKineticEnergy) {
  Bar const bar{.length = 3.0, .constants = BarConstants{.EA = 1, .EI = 1, .mass_per_length = 2.0}};
  Rigid<> const rod = Rigid<>::from(bar);
  std::array<double, 7> q;
  rod.reference(q);
  double const omega = 4.0;
  // about its middle ½ (m l²/12) ω², about its first end ½ (m l²/3) ω², about its own axis zero
  EXPECT_DOUBLE_EQ(rod.kinetic_energy(0, q, std::array{0.0, 0.0, 0.0, 0.0, 0.0, omega}), 0.5 * 6.0 * 9.0 / 12.0 * 16.0);
  std::array<double, 6> v;
  rod.rigid_velocity(q, Vec3::Zero(), Vec3(0, omega, 0), v);
  EXPECT_DOUBLE_EQ(rod.kinetic_energy(0, q, v), 0.5 * 6.0 * 9.0 / 3.0 * 16.0);
  EXPECT_EQ(rod.kinetic_energy(0, q, std::array{0.0, 0.0, 0.0, omega, 0.0, 0.0}), 0.0);
}

// Euler's equations J₁ Ω₁˙ = (J₂ − J₃) Ω₂ Ω₃, with cyclic permutations.
TEST(Rigid, GyroscopicForceIsEulers) {
  Rigid<> const body(2.0, Vec3(0.3, 0.5, 0.7).asDiagonal());
  auto const f = force_of(body, {9.0, 8.0, 7.0, 1.0, 2.0, 3.0});
  EXPECT_EQ(f[0] + f[1] + f[2], 0.0);
  EXPECT_NEAR(f[3], (0.5 - 0.7) * 2.0 * 3.0, 1e-15);
  EXPECT_NEAR(f[4], (0.7 - 0.3) * 3.0 * 1.0, 1e-15);
  EXPECT_NEAR(f[5], (0.3 - 0.5) * 1.0 * 2.0, 1e-15);
}

// The combined contribution of the body to its equations equals the sum of its separate functions.
TEST(Rigid, AddsInertiaLessForceAndWeight) {
  Mat3 inertia;
  inertia << 2.0, 0.3, -0.2, 0.3, 2.5, 0.4, -0.2, 0.4, 3.0;
  Rigid<> const body(1.7, inertia);
  std::array<double, 7> const q{0.1, 0.2, 0.3, 1.0, 0.0, 0.0, 0.0};
  std::array<double, 6> const v{1.0, -2.0, 3.0, 0.7, -1.1, 0.4}, a{0.3, 0.6, -0.9, 2.0, -3.0, 5.0};
  Vec3 const g(0.5, -1.5, -9.81);
  Vec<double, 6> of_inertia, force, weight, rows = Vec<double, 6>::Constant(0.25);
  body.inertia<double>(0, q, a, of_inertia);
  body.force<double>(0, q, v, force);
  body.gravity<double>(0, q, g, weight);
  Vec<double, 6> const expected = rows + of_inertia - force - weight;
  body.add_residual<double>({q, v, a}, g, rows.data());
  EXPECT_LT((rows - expected).norm(), 1e-14 * expected.norm());
}

// Full inertia tensor: mass matrix, gyroscopic force without work, tangent compared with finite differences.
TEST(Rigid, FullInertiaTensorIsKept) {
  Rigid<> const body(2.0, tilted);
  std::array<double, 7> q;
  body.reference(q);
  std::array<double, 6> const v{0.1, 0.2, 0.3, 1.0, -2.0, 3.0};
  Mat<double, 6, 6> m, k;
  body.mass(0, q, m);
  EXPECT_EQ((m.bottomRightCorner<3, 3>()), tilted);
  auto const f = force_of(body, v);
  EXPECT_NEAR(f[3] * v[3] + f[4] * v[4] + f[5] * v[5], 0.0, 1e-15);
  body.tangent(0, q, v, 0.0, 1.0, k);
  for (std::size_t j = 0; j < 6; ++j)
    for (std::size_t i = 0; i < 6; ++i) {
      double const slope = slope_at_zero([&](double h) {
        auto moved = v;
        moved[j] += h;
        return force_of(body, moved)[i];
      });
      EXPECT_NEAR(k(Index(i), Index(j)), -slope, 1e-11);
    }
}

TEST(Rigid, StandsWhereItIsPlaced) {
  Placement const place = Placement::at({1, 2, 3}, {0.3, -2.0, 0.9});
  Rigid<> const body(2.0, tilted, place);
  std::array<double, 7> q;
  body.reference(q);
  EXPECT_EQ(Vec3(q[0], q[1], q[2]), place.origin);
  EXPECT_LT((rotation_matrix<double>(Vec4(q[3], q[4], q[5], q[6])) - place.axes).norm(), 2e-15);
}

TEST(Rigid, PointsCountFromTheCentreOfMass) {
  Rigid<> const rod = Rigid<>::from(RigidCase::bar());
  EXPECT_EQ(rod.at(0.0).u, Vec3(-0.65, 0, 0));
  EXPECT_EQ(rod.at(1.3, 0.1, -0.2).u, Vec3(0.65, 0.1, -0.2));
  EXPECT_EQ(rod.at(Vec3(1, 2, 3)).u, Vec3(1, 2, 3));
}

TEST(Rigid, RefusesAMassThatIsNone) {
  for (double const m : {0.0, -1.0, nan_})
    EXPECT_TRUE(has(refusal([&] { Rigid<>(m, Mat3::Identity()); }), "Rigid: the mass")) << m;
}

TEST(Rigid, RefusesAnInertiaThatNoBodyHas) {
  auto const said = [](Mat3 const& inertia) { return refusal([&] { Rigid<>(1.0, inertia); }); };
  Mat3 asymmetric = Mat3::Identity(), broken = Mat3::Identity();
  asymmetric(0, 1) = 1e-3;
  broken(2, 1) = nan_;
  EXPECT_TRUE(has(said(asymmetric), "symmetric"));
  EXPECT_TRUE(has(said(broken), "the inertia"));
  EXPECT_TRUE(has(said(Vec3(1, 1, -0.1).asDiagonal()), "negative"));
  EXPECT_TRUE(has(said(Vec3(1, 1, 2.01).asDiagonal()), "triangle inequality"));
  // the triangle inequality applies to principal moments, here in rotated axes
  Mat3 const turn = exp_so3<double>(Vec3(0.4, -0.8, 0.3));
  EXPECT_TRUE(has(said(turn * Vec3(1, 1, 2.01).asDiagonal() * turn.transpose()), "triangle inequality"));
  Mat3 const negative = turn * Vec3(2, 1.5, -0.25).asDiagonal() * turn.transpose();
  EXPECT_TRUE(has(said(0.5 * (negative + negative.transpose())), "negative (-0.25 kg m²)"));
}

TEST(Rigid, AllowsThinRodsPlatesAndPoints) {
  EXPECT_NO_THROW(Rigid<>(1.0, Vec3(0, 1, 1).asDiagonal()));  // rod: zero about its axis
  EXPECT_NO_THROW(Rigid<>(1.0, Vec3(1, 1, 2).asDiagonal()));  // plate: equality in the triangle inequality
  EXPECT_NO_THROW(Rigid<>(1.0, Mat3::Zero()));
  Mat3 const turn = exp_so3<double>(Vec3(0.4, -0.8, 0.3));
  EXPECT_NO_THROW(Rigid<>(1.0, turn * Vec3(0, 1, 1).asDiagonal() * turn.transpose()));  // up to round-off
}

TEST(Rigid, RefusesAPlacementThatIsNone) {
  EXPECT_TRUE(has(refusal([] { Rigid<>(1.0, Mat3::Zero(), Placement::at({0, nan_, 0})); }), "Rigid: the placement"));
}

TEST(Rigid, RefusesPointsThatAreNone) {
  Rigid<> const lump(2.0, tilted), rod = Rigid<>::from(RigidCase::bar());
  EXPECT_TRUE(has(refusal([&] { (void)lump.at(0.0); }), "needs a body made from a Bar"));
  EXPECT_TRUE(has(refusal([&] { (void)rod.at(1.4); }), "outside"));
  EXPECT_TRUE(has(refusal([&] { (void)rod.at(0.5, 0.0, nan_); }), "the point"));
  EXPECT_TRUE(has(refusal([&] { (void)rod.at(Vec3(0, nan_, 0)); }), "the point"));
}

TEST(Rigid, NamesThePrincipalMomentsOfAnInertiaInTurnedAxes) {
  Mat3 const turned = Placement::at({0, 0, 0}, {0.4, -0.7, 1.1}).axes;
  Vec3 const given(5.0, 3.0, 0.5);
  auto const found = detail::principal_values(turned * given.asDiagonal() * turned.transpose());
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[std::size_t(i)], given[i], 1e-7);
}

/// Rotation of 90° about z. The marker's axes are rotated by 90° about x relative to the body. All expected numbers
/// are computed by hand.
template <class T>
void publishes_by_hand() {
  double const half = std::sqrt(0.5);
  std::array<T, 7> const q{T(10.0), T(20.0), T(30.0), T(half), T(0.0), T(0.0), T(half)};
  std::array<T, 6> const v{T(1.0), T(0.0), T(-1.0), T(0.5), T(0.0), T(2.0)};
  MarkerKinematics<T> out;
  out.bias.setConstant(T(9.0));
  Rigid<>(2.0, tilted)
      .evaluate_marker<T>({Vec3(1, 2, 3)}, (Mat3() << 1, 0, 0, 0, 0, -1, 0, 1, 0).finished(), q, v, out);
  auto const near = [](auto const& x, auto const& expected) {
    for (Index i = 0; i < expected.size(); ++i) EXPECT_NEAR(value_of(x.data()[i]), expected.data()[i], 4e-14);
  };
  near(out.arm, Vec3(-2, 1, 3));
  near(out.body_axes, (Mat3() << 0, -1, 0, 1, 0, 0, 0, 0, 1).finished());
  near(out.frame.r, Vec3(8, 21, 33));
  near(out.frame.A, (Mat3() << 0, 0, 1, 1, 0, 0, 0, 1, 0).finished());
  near(out.frame.w, Vec3(0, 0.5, 2));
  near(out.frame.v, Vec3(0.5, -4, 0));
  near(out.bias, (Vec6() << 8.5, -1, 0.25, 0, 0, 0).finished());
}

TEST(Rigid, PublishesByHand) {
  publishes_by_hand<double>();
  publishes_by_hand<Dual<2>>();
}

}  // namespace rigid_test
}  // namespace polybody
