#include <polybody/bodies/lrvf/planar_lrvf.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/flexible_body_laws.hpp>

#include "support/refusal.hpp"

namespace polybody {
using namespace laws;
namespace planar_lrvf_test {

struct LrvfCase {
  static Bar bar() {
    return {.length = 1.3,
            .constants = BarConstants{.EA = 900, .EI = 40, .mass_per_length = 2.0, .GA = 300, .rotary_inertia = 0.05},
            .placement = Placement::planar(0.4, -0.3, 0.7),
            .damping = {.axial = 0.01, .shear = 0.02, .bending = 0.03}};
  }
  static planar::Lrvf body(Bar const& bar) { return planar::Lrvf::from(bar, 3); }
};
bool const planar_lrvf_obeys = obeys<LrvfCase, BodyLaws, FlexibleBodyLaws>("Lrvf");

int const elements = 4;
planar::Lrvf straight() {
  Bar bar = LrvfCase::bar();
  bar.placement = {};
  return planar::Lrvf::from(bar, elements);
}
double const l = 1.3 / elements;

/// Coordinates q of a deformation, given as (x, y, θ) of the node's number.
template <class F>
VecX nodes(F&& node) {
  VecX q(3 * (elements + 1));
  for (Index i = 0; i <= elements; ++i) q.segment<3>(3 * i) = Vec3(node(double(i)));
  return q;
}

/// Strains and section forces, which are those of the middle (the Gauss point) at each point of an element.
void expect_strains(VecX const& q, Vec3 const& expected) {
  planar::Lrvf const beam = straight();
  for (int e = 0; e < elements; ++e)
    for (double const xi : {0.1, 0.5, 0.9}) {
      auto const p = beam.at((e + xi) * l);
      EXPECT_LT((beam.strains<0>(p, view(q)) - expected).norm(), 1e-14) << e;
      EXPECT_LT((beam.resultants<0>(p, view(q)) - expected.cwiseProduct(Vec3(900, 300, 40))).norm(), 1e-11) << e;
    }
}

double energy(VecX const& q) {
  double sum = 0.0;
  for (Index e = 0; e < elements; ++e) sum += straight().strain_energy(e, view(q));
  return sum;
}

TEST(Lrvf, PureStretchIsAxialStrainAlone) {
  VecX const q = nodes([](double i) { return Vec3(1.02 * l * i, 0, 0); });
  expect_strains(q, Vec3(0.02, 0, 0));
  EXPECT_NEAR(energy(q), 0.5 * 900 * 0.02 * 0.02 * 1.3, 1e-14);
}

TEST(Lrvf, CompressionIsNegative) {
  expect_strains(nodes([](double i) { return Vec3(0.9 * l * i, 0, 0); }), Vec3(-0.1, 0, 0));
}

TEST(Lrvf, PureShearIsShearStrainAlone) {
  VecX const q = nodes([](double i) { return Vec3(l * i, 0.1 * l * i, 0); });
  expect_strains(q, Vec3(0, 0.1, 0));
  EXPECT_NEAR(energy(q), 0.5 * 300 * 0.1 * 0.1 * 1.3, 1e-14);
}

// Sections rotated by α on a straight axis: ε = cos α − 1, γ = −sin α.
TEST(Lrvf, TurnedSectionsShear) {
  expect_strains(nodes([](double i) { return Vec3(l * i, 0, 0.3); }), Vec3(std::cos(0.3) - 1, -std::sin(0.3), 0));
}

// Polygon with sides of length l in the direction θ of their middle, θ = κ s. The only strain is the curvature, also
// beyond a full revolution.
TEST(Lrvf, PureBendIsCurvatureAlone) {
  double const turn = 2.5;  // from node to node [rad]
  Vec2 end = Vec2::Zero();
  VecX const q = nodes([&](double i) {
    Vec3 const node(end[0], end[1], turn * i);
    end += l * Vec2(std::cos(turn * (i + 0.5)), std::sin(turn * (i + 0.5)));
    return node;
  });
  expect_strains(q, Vec3(0, 0, turn / l));
  EXPECT_NEAR(energy(q), 0.5 * 40 * turn * turn / (l * l) * 1.3, 1e-10);
}

// Strains are independent of position and rotation of the beam.
TEST(Lrvf, StrainsAreObjective) {
  double const c = std::cos(2.1), s = std::sin(2.1);
  expect_strains(nodes([&](double i) {
                   double const x = 1.02 * l * i, y = 0.1 * l * i;
                   return Vec3(5 + c * x - s * y, -3 + s * x + c * y, 2.1);
                 }),
                 Vec3(0.02, 0.1, 0));
}

// Consistent mass matrix of linear shapes: Aρ l/6 [2 1; 1 2] for x and y, Iρ l/6 [2 1; 1 2] for θ.
TEST(Lrvf, MassIsTheConsistentOneOfLinearShapes) {
  Mat<double, 6, 6> m, expected = Mat<double, 6, 6>::Zero();
  std::vector<double> const q(15);
  straight().mass(0, q, m);
  Vec3 const per_length(2.0, 2.0, 0.05);
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b)
      expected.block<3, 3>(3 * a, 3 * b) = Mat3((per_length * l / (a == b ? 3.0 : 6.0)).asDiagonal());
  EXPECT_LT((m - expected).norm(), 1e-15);
}

// A point off the axis moves with its section: r = r₀ + y (−sin θ, cos θ).
TEST(Lrvf, PointsOffTheAxisTurnWithTheSection) {
  planar::Lrvf const beam = straight();
  VecX const q = nodes([](double i) { return Vec3(l * i, 0.2 * i, 0.3 * i); }), v = VecX::Zero(q.size());
  std::array<double, 36> memory;
  MarkerKinematics<double> out;
  out.jacobian = memory.data();
  beam.evaluate_marker<double>(beam.at(2.5 * l, 0.1), Mat3::Identity(), view(q), view(v), out);
  double const angle = 0.75;
  EXPECT_LT((out.frame.r - Vec3(2.5 * l - 0.1 * std::sin(angle), 0.5 + 0.1 * std::cos(angle), 0)).norm(), 1e-15);
  EXPECT_LT((out.frame.A - exp_so3<double>(Vec3(0, 0, angle))).norm(), 1e-15);
}

TEST(Lrvf, NeedsAShearStiffness) {
  Bar bar = LrvfCase::bar();
  bar.constants->GA = 0.0;
  EXPECT_TRUE(has(refusal([&] { (void)planar::Lrvf::from(bar, 3); }), "planar::Lrvf: the shear stiffness GA"));
}

}  // namespace planar_lrvf_test
}  // namespace polybody
