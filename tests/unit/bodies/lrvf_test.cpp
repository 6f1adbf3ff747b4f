#include <polybody/bodies/lrvf/lrvf.hpp>

#include <gtest/gtest.h>

#include <numbers>

#include "support/refusal.hpp"
#include "support/spatial_lrvf.hpp"

namespace polybody {
namespace lrvf_test {

using std::numbers::pi;

int const elements = 4;
double const l = 1.3 / elements;
Vec6 const stiffness = (Vec6() << 900, 300, 350, 25, 60, 40).finished();

Bar straight_bar() {
  Bar bar = spatial_lrvf_bar();
  bar.placement = {};
  return bar;
}
Lrvf<> straight() { return Lrvf<>::from(straight_bar(), elements); }

/// Checks strains, section forces and energy for a uniform strain.
void expect_strains(VecX const& q, Vec6 const& expected, double tolerance = 1e-14) {
  Lrvf<> const beam = straight();
  for (int e = 0; e < elements; ++e) {
    auto const p = beam.at((e + 0.3) * l);
    EXPECT_LT((beam.section_strains(p, numbers(q)) - expected).norm(), tolerance) << e;
    EXPECT_LT((beam.section_forces(p, numbers(q)) - expected.cwiseProduct(stiffness)).norm(), 1e3 * tolerance) << e;
  }
  EXPECT_NEAR(strain_energy_of(beam, q), 0.65 * expected.cwiseAbs2().dot(stiffness), 1e3 * tolerance);
}

/// Sections with the relative rotation φ in their own axes. The chords of length l are along the x axes of the
/// sections between them.
VecX stepped(Vec3 const& phi) {
  Placement at;
  Mat3 const half = exp_so3<double>(phi * 0.5);
  return nodes_of(elements, [&](double) {
    Placement const node = at;
    Mat3 const middle = node.axes * half;
    at = {node.origin + l * middle.col(0), middle * half};
    return node;
  });
}

TEST(SpatialLrvf, StretchAndShearAreMeasuredOneByOne) {
  Vec3 const gamma(0.02, 0.1, -0.07);
  VecX const q = nodes_of(elements, [&](double i) { return Placement{.origin = l * i * (Vec3::UnitX() + gamma)}; });
  Vec6 expected = Vec6::Zero();
  expected.head<3>() = gamma;
  expect_strains(q, expected);
}

// Sections rotated by α about z on a straight axis: Γ = Rᵀe₁ − e₁ = (cos α − 1, −sin α, 0); about y with the opposite
// sign.
TEST(SpatialLrvf, TurnedSectionsShear) {
  auto const turned = [](Vec3 const& rotation) {
    return nodes_of(elements, [&](double i) { return Placement::at(Vec3(l * i, 0, 0), rotation); });
  };
  Vec6 expected;
  expected << std::cos(0.3) - 1, -std::sin(0.3), 0, 0, 0, 0;
  expect_strains(turned(Vec3(0, 0, 0.3)), expected);
  expected << std::cos(0.3) - 1, 0, std::sin(0.3), 0, 0, 0;
  expect_strains(turned(Vec3(0, 0.3, 0)), expected);
}

// K = φ/l for twist, both bending directions and any combination, up to nearly half a revolution between nodes.
// Stretch and shear are zero.
TEST(SpatialLrvf, CurvatureIsTheTurnFromNodeToNode) {
  for (Vec3 const& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0.6, -0.48, 0.64)})
    for (double const angle : {1e-9, 0.3, 1.0, 1.3, 2.5, 3.1}) {  // the series of atan ends at 1.22
      Vec6 expected = Vec6::Zero();
      expected.tail<3>() = angle / l * axis;
      expect_strains(stepped(angle * axis), expected, 1e-13);
    }
}

// R = R₁ exp(ξ φ) of `section` (markers) compared with the algebraic middle section (strains): two formulas for one
// field.
TEST(SpatialLrvf, StrainSectionLiesOnTheRotationField) {
  Quaternion<double> const a = quaternion_exp<double>(Vec3(0.4, -2.0, 1.1));
  for (double const angle : {1e-9, 0.3, 1.3, 3.1}) {
    Vec3 const phi = angle * Vec3(0.6, -0.48, 0.64);
    Quaternion<double> const b = quaternion_plus<double>(a, phi);
    StrainSection<double> middle;
    RelativeRotation::Section<double> section;
    RelativeRotation const field{Placement{}};
    field.middle<double>(a, -b, middle);  // q and −q are the same rotation
    field.section<double>(0.5, a, b, section);
    EXPECT_LT((middle.R - section.R).norm(), 1e-14) << angle;
    EXPECT_LT((middle.R - rotation_matrix<double>(a) * exp_so3<double>(0.5 * phi)).norm(), 1e-14) << angle;
    EXPECT_LT((middle.spin - section.spin).norm(), 1e-14) << angle;
    EXPECT_LT((middle.turn - phi).norm(), 1e-14) << angle;
    // δφ = Jr⁻¹(φ) δθ₂ − Jr⁻¹(−φ) δθ₁
    EXPECT_LT((middle.bend.rightCols<3>() - right_jacobian_inverse<double>(phi)).norm(), 1e-13) << angle;
    EXPECT_LT((middle.bend.leftCols<3>() + right_jacobian_inverse<double>(-phi)).norm(), 1e-13) << angle;
  }
}

// Bent and twisted beam in a rigid rotation through five full revolutions. The strains are constant, without jumps at
// π, 2π, ...
TEST(SpatialLrvf, StrainsDoNotFeelARigidMotionThroughManyTurns) {
  VecX const q = stepped(Vec3(0.2, -0.3, 0.5));
  Vec6 expected = Vec6::Zero();
  expected.tail<3>() = Vec3(0.2, -0.3, 0.5) / l;
  Vec3 const axis = Vec3(2, -1, 2) / 3.0;
  for (int k = 0; k <= 400; ++k)
    expect_strains(carried(Placement::at(Vec3(0.1 * k, -3, 2), k * pi / 40.0 * axis), q), expected, 2e-13);
}

// The rotation of the tip in the beam's own coordinates, step by step with ⊞, so quaternions change sign. Only the
// last node rotates.
TEST(SpatialLrvf, ATurningTipTwistsTheLastElementWithoutAJumpOfTheOthers) {
  Lrvf<> const beam = straight();
  VecX q(beam.coordinates()), delta = VecX::Zero(beam.velocities()), next = q;
  beam.reference(std::span<double>(q.data(), std::size_t(q.size())));
  for (Index i = 0; i <= elements; ++i) delta[6 * i + 3] = 0.05 * double(i);  // about x, proportional to s
  for (int k = 1; k <= 240;
       ++k) {  // until the tip has rotated by 48 rad, each element by 12: past half a revolution and back
    beam.plus<double>(numbers(q), numbers(delta), std::span<double>(next.data(), std::size_t(next.size())));
    q = next;
    double const turn = 0.05 * k, shortest = std::remainder(turn, 2 * pi);
    EXPECT_NEAR(beam.section_strains(beam.at(0.0), numbers(q))[3], shortest / l, 1e-11) << k;
  }
}

TEST(SpatialLrvf, MassIsConsistentInTranslationAndLumpedInRotation) {
  Mat<double, 12, 12> m, expected = Mat<double, 12, 12>::Zero();
  std::vector<double> const q(35);
  straight().mass(0, q, m);
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b)
      expected.block<3, 3>(6 * a, 6 * b).diagonal().setConstant(2.0 * l * (a == b ? 1 / 3.0 : 1 / 6.0));
  for (int a = 0; a < 2; ++a) expected.block<3, 3>(6 * a + 3, 6 * a + 3).diagonal() = 0.5 * l * Vec3(0.08, 0.03, 0.05);
  EXPECT_LT((m - expected).norm(), 1e-15);
}

// The contribution of each element to either node is −Ω × JΩ of half of its length.
TEST(SpatialLrvf, SpinningSectionsFeelGyroscopicMoments) {
  VecX const q = nodes_of(1, [](double i) { return Placement{.origin = Vec3(1.3 * i, 0, 0)}; });
  Bar bar = straight_bar();
  bar.damping = {};
  Vec3 const w1(1, 2, 3), w2(-2, 1, 0.5), j = 0.65 * Vec3(0.08, 0.03, 0.05);
  VecX v = VecX::Zero(12);
  v.segment<3>(3) = w1;
  v.segment<3>(9) = w2;
  Vec<double, 12> f, expected = Vec<double, 12>::Zero();
  Lrvf<>::from(bar, 1).force<double>(0, numbers(q), numbers(v), f);
  expected.segment<3>(3) = -w1.cross(j.cwiseProduct(w1).eval());
  expected.segment<3>(9) = -w2.cross(j.cwiseProduct(w2).eval());
  EXPECT_LT((f - expected).norm(), 1e-14);
}

// A bar under tension pulls its ends together. Its stretch stores T Γ₁ l in addition to the elastic energy.
TEST(SpatialLrvf, PretensionPullsTheEndsAndStoresItsWork) {
  Bar bar = straight_bar();
  bar.pretension = 70.0;
  Lrvf<> const beam = Lrvf<>::from(bar, 1);
  VecX q(14), rest = VecX::Zero(12);
  beam.reference(std::span<double>(q.data(), 14));
  Vec<double, 12> f, expected = Vec<double, 12>::Zero();
  expected[0] = 70.0;
  expected[6] = -70.0;
  beam.force<double>(0, numbers(q), numbers(rest), f);
  EXPECT_LT((f - expected).norm(), 1e-12);
  EXPECT_NEAR(beam.section_forces(beam.at(0.5), numbers(q))[0], 70.0, 1e-12);
  q[7] *= 1.02;
  EXPECT_NEAR(strain_energy_of(beam, q), 1.3 * (0.5 * 900 * 0.02 * 0.02 + 70.0 * 0.02), 1e-12);
}

// Points off the axis move with their section, in the middle of an element and at a node.
TEST(SpatialLrvf, PointsOffTheAxisTurnWithTheSection) {
  Lrvf<> const beam = straight();
  VecX const q = stepped(Vec3(0.2, -0.3, 0.5)), v = VecX::Zero(30);
  std::array<double, 72> memory;
  MarkerKinematics<double> out;
  out.jacobian = memory.data();
  for (double const i : {2.5, 3.0}) {
    beam.evaluate_marker<double>(beam.at(i * l, 0.1, -0.2), Mat3::Identity(), numbers(q), numbers(v), out);
    Mat3 const axes = exp_so3<double>(i * Vec3(0.2, -0.3, 0.5));
    Vec3 const r1 = q.segment<3>(14), r2 = q.segment<3>(21), centre = i == 3.0 ? r2 : Vec3(0.5 * (r1 + r2));
    EXPECT_LT((out.frame.A - axes).norm(), 1e-14);
    EXPECT_LT((out.frame.r - centre - axes * Vec3(0, 0.1, -0.2)).norm(), 1e-14);
  }
}

TEST(SpatialLrvf, RefusesWhatItCannotMean) {
  Bar bar = spatial_lrvf_bar();
  bar.constants->GA = 0.0;
  EXPECT_TRUE(has(refusal([&] { (void)Lrvf<>::from(bar, 3); }), "Lrvf: the stiffness GA of the bar"));
  bar = spatial_lrvf_bar();
  bar.constants->GJ = 0.0;
  EXPECT_TRUE(has(refusal([&] { (void)Lrvf<Direct>::from(bar, 3); }), "Lrvf: the stiffness GJ of the bar"));
  bar = spatial_lrvf_bar();
  EXPECT_TRUE(has(refusal([&] { (void)Lrvf<>::from(bar, 0); }), "at least one element"));
  EXPECT_TRUE(has(refusal([&] { (void)Lrvf<>::from(bar, 3, ReferenceCurve{}); }), "curve is an empty function"));
  auto const fast = [](double s) { return Placement{.origin = Vec3(2 * s, 0, 0)}; };
  auto const still = [](double) { return Placement{}; };
  EXPECT_TRUE(has(refusal([&] { (void)Lrvf<>::from(bar, 3, fast); }), "must be its arc length"));
  EXPECT_TRUE(has(refusal([&] { (void)Lrvf<>::from(bar, 3, still); }), "has a chord of 0 m"));
}

// With Ω in section axes as velocities, the mass matrix is constant: nodes have ½ Ωᵀ J Ω. With the rates of a rotation
// vector ψ it is Tᵀ J T, Ω = T ψ̇, which depends on ψ [thesis §2.4.2]: at |ψ| = 2 rad, the entry of a rotation across ψ
// is smaller by the factor (sin 1)².
TEST(SpatialLrvf, MassIsConstantWithAngularVelocities) {
  Lrvf<> const beam = straight();
  Lrvf<>::ElementMatrix at_rest, moved;
  VecX const bent =
      carried({.origin = {1, 2, 3}, .axes = exp_so3<double>(Vec3(1, -2, 0.5))}, stepped(Vec3(0.3, 0.7, -1)));
  beam.mass(1, numbers(stepped(Vec3::Zero())), at_rest);
  beam.mass(1, numbers(bent), moved);
  EXPECT_EQ(at_rest, moved);
  Mat3 const t = right_jacobian<double>(Vec3(2, 0, 0));
  EXPECT_NEAR((t.transpose() * t)(1, 1), std::pow(std::sin(1.0), 2), 1e-14);
}

}  // namespace lrvf_test
}  // namespace polybody
