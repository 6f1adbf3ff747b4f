// Error of objectivity of the spatial Lrvf with direct interpolation of rotation vectors.

#include <polybody/bodies/lrvf/lrvf.hpp>

#include <polybody/testing/differences.hpp>

#include <numbers>

#include "support/spatial_lrvf.hpp"

namespace polybody {
using namespace laws;
namespace lrvf_direct_test {

double const pi = std::numbers::pi;

/// One element of length 1.3 with equal EI about y and z. Its axis is x, so Ψ is measured from the world's axes.
template <class I>
Lrvf<I> element() {
  Bar bar = spatial_lrvf_bar();
  bar.placement = {};
  bar.damping = {};
  bar.constants->EI_y = 40;
  return Lrvf<I>::from(bar, 1);
}
double const l = 1.3, EI = 40;

/// Bent by φ about z symmetrically to its middle, then rotated by the angle a about x.
VecX bent(double phi, double a) {
  VecX const q =
      nodes_of(1, [&](double i) { return Placement::at(Vec3((i - 0.5) * l, 0, 0), Vec3(0, 0, (i - 0.5) * phi)); });
  return carried(Placement::at(Vec3::Zero(), Vec3(a, 0, 0)), q);
}

/// Strain of `Direct`. By the product of quaternions Ψ₂,₁ = A/sin(A/2) [cos(φ/4) sin(a/2) x ± sin(φ/4) p], with p =
/// cos(a/2) z − sin(a/2) y and cos(A/2) = cos(a/2) cos(φ/4). Hence Ψ = a′ x in the middle, a′ = A cos(φ/4)
/// sin(a/2)/sin(A/2). Across x, Jr(Ψ) rotates by −a′/2 and scales by 2 sin(a′/2)/a′. It maps Ψ₂ − Ψ₁ to the rotation
/// l K. Its size is 4 tan(φ/4) sin(a′/2)/sin(a/2), and its axis is z inclined by β = (a − a′)/2 towards −y. Here |a|
/// < π.
struct Turn {
  double size, beta;
  Vec3 curvature() const { return size / l * Vec3(0, -std::sin(beta), std::cos(beta)); }
  double energy() const { return 0.5 * EI * size * size / l; }
};
Turn turn(double phi, double a) {
  double const big = 2.0 * std::acos(std::cos(0.5 * a) * std::cos(0.25 * phi));
  double const lesser = big * std::cos(0.25 * phi) * std::sin(0.5 * a) / std::sin(0.5 * big);
  return {4.0 * std::tan(0.25 * phi) * std::sin(0.5 * lesser) / std::sin(0.5 * a), 0.5 * (a - lesser)};
}

template <class I>
Vec6 strain(VecX const& q) {
  Lrvf<I> const beam = element<I>();
  return beam.section_strains(beam.at(0.5), numbers(q));
}

// If every node rotates about one common axis from the placement, Ψ is that angle and both interpolations agree.
TEST(DirectLrvf, TurnsAboutOneAxisAreMeasuredExactly) {
  for (double const turned : {0.0, 0.7, 2.0})
    for (double const phi : {0.1, 1.0}) {
      VecX const q = carried(Placement::at(Vec3(1, 2, 3), Vec3(0, 0, turned)), bent(phi, 0.0));
      Vec6 const direct = strain<Direct>(q);
      EXPECT_NEAR(direct[5], phi / l, 1e-14);
      EXPECT_LT((direct - strain<RelativeRotation>(q)).norm(), 1e-14);
    }
}

// Error of objectivity [Wallin 2016, §2.5]: a rigid rotation changes the curvature by exactly this amount.
// `RelativeRotation` has no change.
TEST(DirectLrvf, ARigidTurnAfterABendStrainsByTheDerivedAmount) {
  for (double const phi : {0.1, 1.0, 2.0}) {
    double const energy = 0.5 * EI * phi * phi / l;
    EXPECT_NEAR(strain_energy_of(element<Direct>(), bent(phi, 0.0)), energy, 1e-14 * energy);
    for (double const a : {-3.0, -1.0, 0.5, 2.0, 3.1}) {
      VecX const q = bent(phi, a);
      Turn const expected = turn(phi, a);
      EXPECT_LT((strain<Direct>(q).tail<3>() - expected.curvature()).norm(), 1e-13) << phi << ' ' << a;
      EXPECT_LT(strain<Direct>(q).head<3>().norm(), 1e-14);
      EXPECT_NEAR(strain_energy_of(element<Direct>(), q), expected.energy(), 1e-13 * energy);
      EXPECT_NEAR(strain_energy_of(element<RelativeRotation>(), q), energy, 1e-14 * energy);
    }
  }
}

// Small φ: U/U₀ − 1 = φ² [1/24 + a cot(a/2)/32 (2 cot(a/2)/a − 1/sin²(a/2))] + O(φ⁴), which is 1 % of φ² at a = 2.
TEST(DirectLrvf, SpuriousEnergyFallsWithTheSquareOfTheTurnOfAnElement) {
  double const a = 2.0, c = 1.0 / std::tan(0.5 * a), s = std::sin(0.5 * a);
  double const series = 1.0 / 24.0 + a * c / 32.0 * (2.0 * c / a - 1.0 / (s * s));
  EXPECT_NEAR(series, 0.010758, 1e-6);
  for (double const phi : {0.1, 0.2, 0.4}) {
    double const energy = 0.5 * EI * phi * phi / l,
                 gained = strain_energy_of(element<Direct>(), bent(phi, a)) / energy - 1.0;
    EXPECT_NEAR(gained / (phi * phi), series, 3e-4 * phi * phi);
  }
}

// A rigid rotation meets a resistance: the power of the forces is −dU/da.
TEST(DirectLrvf, ItsForcesDoWorkInARigidTurn) {
  double const phi = 1.0, a = 2.0;
  VecX const q = bent(phi, a), rest = VecX::Zero(12);
  VecX v(12);
  element<Direct>().rigid_velocity(numbers(q), Vec3::Zero(), Vec3::UnitX(), std::span<double>(v.data(), 12));
  Vec<double, 12> direct, objective;
  element<Direct>().force<double>(0, numbers(q), numbers(rest), direct);
  element<RelativeRotation>().force<double>(0, numbers(q), numbers(rest), objective);
  double const slope = slope_at_zero([&](double h) { return turn(phi, a + h).energy(); });
  EXPECT_GT(std::abs(slope), 0.1);
  EXPECT_NEAR(direct.dot(v), -slope, 1e-9);
  EXPECT_NEAR(objective.dot(v), 0.0, 1e-13);
}

// At a = π the rotation vectors of the nodes change to their complements: β changes sign, and the curvature about y
// jumps by 2 K sin β.
TEST(DirectLrvf, CurvatureJumpsWhereTheNodesPassAHalfTurn) {
  double const phi = 1.0, step = 1e-9;
  Vec3 const before = strain<Direct>(bent(phi, pi - step)).tail<3>(),
             after = strain<Direct>(bent(phi, pi + step)).tail<3>();
  Turn const expected = turn(phi, pi);
  double const jump = 2.0 * expected.size / l * std::sin(expected.beta);
  EXPECT_GT(jump, 0.07);
  EXPECT_LT((after - before - Vec3(0, jump, 0)).norm(), 1e-8);
  // beyond π, a is measured from the other side
  EXPECT_LT((strain<Direct>(bent(phi, 4.0)).tail<3>() - turn(phi, 4.0 - 2 * pi).curvature()).norm(), 1e-13);
  // the other interpolation has no jump
  Vec6 const jumpless = strain<RelativeRotation>(bent(phi, pi + step)) - strain<RelativeRotation>(bent(phi, pi - step));
  EXPECT_LT(jumpless.norm(), 1e-14);
}

// If only one node is beyond π, its vector is continued on the sheet of the other, |Ψ₂| > π. The interpolation
// follows the shorter rotation.
TEST(DirectLrvf, AnElementAcrossAHalfTurnTakesTheShortWay) {
  VecX const q = nodes_of(1, [&](double i) { return Placement::at(Vec3(i * l, 0, 0), Vec3(3.0 + 0.4 * i, 0, 0)); });
  EXPECT_NEAR(strain<Direct>(q)[3], 0.4 / l, 1e-13);
}

}  // namespace lrvf_direct_test
}  // namespace polybody
