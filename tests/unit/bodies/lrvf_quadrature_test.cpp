// Locking of the spatial Lrvf with each quadrature.

#include <polybody/bodies/lrvf/lrvf.hpp>

#include "support/spatial_lrvf.hpp"

namespace polybody {
namespace lrvf_quadrature_test {

/// Quadrature with Γ₁ at both Gauss points and Γ₂, Γ₃ in the middle. `Selective` evaluates Γ₁ in the middle.
struct AxialInBoth {
  static constexpr std::array<StrainPoint, 3> points = {
      {{gauss<2>[0].xi, 0.5, 0.0, 0.5}, {0.5, 0.0, 1.0, 0.0}, {gauss<2>[1].xi, 0.5, 0.0, 0.5}}};
};
/// Invalid rules: the weights of the shear sum to more than one, or a section is at a node.
struct TooMuch {
  static constexpr std::array<StrainPoint, 1> points = {{{0.5, 1.0, 1.1, 1.0}}};
};
struct AtNode {
  static constexpr std::array<StrainPoint, 1> points = {{{0.0, 1.0, 1.0, 1.0}}};
};
static_assert(StrainQuadrature<FullQuadrature> && StrainQuadrature<AxialInBoth>);
static_assert(!StrainQuadrature<TooMuch> && !StrainQuadrature<AtNode> && !StrainQuadrature<double>);

double const length = 1.0, EA = 1e7, EI = 20.0, GA = 4e6;  // slender: GA L²/(12 EI) = 16667
Bar slender() {
  return {.length = length,
          .constants = BarConstants{.EA = EA, .EI = EI, .mass_per_length = 1.0, .GA = GA, .GJ = 15.0, .EI_y = 30.0}};
}

/// −∂f/∂δ of the complete beam at q.
template <class B>
MatX stiffness(B const& beam, VecX const& q) {
  MatX k = MatX::Zero(beam.velocities(), beam.velocities());
  VecX const rest = VecX::Zero(beam.velocities());
  for (Index e = 0; e < beam.elements(); ++e) {
    Mat<double, 12, 12> part;
    beam.tangent(e, numbers(q), numbers(rest), 1.0, 0.0, part);
    k.block<12, 12>(6 * e, 6 * e) += part;
  }
  return k;
}
template <class B>
VecX standing(B const& beam) {
  VecX q(beam.coordinates());
  beam.reference({q.data(), std::size_t(q.size())});
  return q;
}
/// Deflection per force at the tip of the cantilever in linear theory. Both are along `axis`.
template <class Quadrature>
double flexibility(Bar const& bar, Index n, int axis) {
  auto const beam = Lrvf<RelativeRotation, Quadrature>::from(bar, n);
  MatX const k = stiffness(beam, standing(beam)).bottomRightCorner(6 * n, 6 * n);
  return k.lu().solve(VecX::Unit(6 * n, 6 * (n - 1) + axis))[6 * (n - 1) + axis];
}
/// Flexibility of n elements with one point. The bending moment is a step function, so L³/(3EI) (1 − 1/(4n²)) + L/GA.
/// In element i from the tip, κ = P (i − ½) l/EI, and its contribution to the deflection is κ l (i − ½) l: Σ (i − ½)²
/// = n³/3 − n/12.
double one_point(Index n, double ei, bool locks = false) {
  double const l = length / double(n);
  return length * length * length / (3.0 * ei) * (1.0 - 0.25 / double(n * n)) /
             (1.0 + GA * l * l / (12.0 * ei) * (locks ? 1.0 : 0.0)) +
         length / GA;
}

// Linear theory of the fully integrated element. With u_y′ = Δ/l and θ = θ_m + (ξ − ½) φ the two points add ½ GA φ² l
// (ξ_g − ½)² 2/2 = ½ (GA l/12) φ² to ½ (EI/l) φ². EI becomes EI (1 + GA l²/(12 EI)), and nothing else changes
// [Hughes, Taylor & Kanoknukulchai 1977]. The bending deflection falls by that factor.
TEST(LrvfQuadrature, FullLocksByTheKnownFactor) {
  for (Index const n : {1, 2, 8, 64}) {
    EXPECT_NEAR(flexibility<FullQuadrature>(slender(), n, 1) / one_point(n, EI, true), 1.0, 1e-8) << n;
    EXPECT_NEAR(flexibility<FullQuadrature>(slender(), n, 2) / one_point(n, 30.0, true), 1.0, 1e-8) << n;
  }
  double const exact = length * length * length / (3.0 * EI) + length / GA;
  EXPECT_NEAR(flexibility<FullQuadrature>(slender(), 1, 1) / exact, 0.75 / (1.0 + GA / (12.0 * EI)), 2e-5);  // 4.5e-5
  EXPECT_LT(flexibility<FullQuadrature>(slender(), 64, 1) / exact, 0.2);
}

TEST(LrvfQuadrature, ReducedAndSelectiveDoNotLock) {
  double const exact = length * length * length / (3.0 * EI) + length / GA;
  for (Index const n : {1, 2, 8, 64})
    for (double const found :
         {flexibility<ReducedQuadrature>(slender(), n, 1), flexibility<SelectiveQuadrature>(slender(), n, 1)}) {
      EXPECT_NEAR(found / one_point(n, EI), 1.0, 1e-8) << n;
      EXPECT_NEAR(found / exact, 1.0 - 0.25 / double(n * n), 1e-5) << n;
    }
}

/// State far from the reference.
template <class B>
VecX bent(B const& beam) {
  VecX q(beam.coordinates());
  VecX const delta =
      VecX::NullaryExpr(beam.velocities(), [](Index i) { return 0.4 * std::sin(1.0 + 3.0 * double(i)); });
  VecX const from = standing(beam);
  beam.template plus<double>(numbers(from), numbers(delta), {q.data(), std::size_t(q.size())});
  return q;
}

// `RelativeRotation` has a constant curvature in an element, so one point is sufficient for its energy. The curvature
// of `Direct` varies.
TEST(LrvfQuadrature, SelectiveIsReducedWhereTheCurvatureIsConstant) {
  Bar const bar = spatial_lrvf_bar();
  auto const one = Lrvf<>::from(bar, 3);
  VecX const q = bent(one);
  double const energy = strain_energy_of(one, q);
  EXPECT_NEAR(strain_energy_of(Lrvf<RelativeRotation, SelectiveQuadrature>::from(bar, 3), q), energy, 1e-14 * energy);
  MatX const k = stiffness(one, q);
  EXPECT_LT((stiffness(Lrvf<RelativeRotation, SelectiveQuadrature>::from(bar, 3), q) - k).norm(), 1e-12 * k.norm());
  double const direct = strain_energy_of(Lrvf<Direct>::from(bar, 3), q);
  EXPECT_GT(std::abs(strain_energy_of(Lrvf<Direct, SelectiveQuadrature>::from(bar, 3), q) - direct), 1e-6 * direct);
}

// The reported strains are those of the middle for every quadrature.
TEST(LrvfQuadrature, StrainsAreToldInTheMiddle) {
  Bar const bar = spatial_lrvf_bar();
  auto const one = Lrvf<>::from(bar, 3);
  auto const two = Lrvf<RelativeRotation, FullQuadrature>::from(bar, 3);
  VecX const q = bent(one);
  EXPECT_LT((one.section_strains(one.at(0.5), numbers(q)) - two.section_strains(two.at(0.5), numbers(q))).norm(),
            1e-14);
}

// Reason for Γ₁ in the middle in `Selective`. An element is bent by φ. Its ends are rotated by ±φ/2 relative to a
// chord of length c. At two points Γ₁ = c/l cos(φ/√12) − 1, so the minimum energy of Γ₁ is at c = l/cos(φ/√12) = l (1
// + φ²/24). The chord of an arc is l sin(φ/2)/(φ/2) = l (1 − φ²/24). With Γ₁ in the middle c = l, which halves the
// error.
TEST(LrvfQuadrature, AxialStrainInBothPointsStretchesTheChordOfABentElement) {
  double const phi = 0.3;
  auto const state = [&](double chord) {
    return nodes_of(1, [&](double i) { return Placement::at(Vec3(i * chord, 0, 0), Vec3(0, 0, (i - 0.5) * phi)); });
  };
  auto const both = Lrvf<RelativeRotation, AxialInBoth>::from(slender(), 1);
  auto const middle = Lrvf<RelativeRotation, SelectiveQuadrature>::from(slender(), 1);
  double const bending = 0.5 * EI * phi * phi / length;
  EXPECT_NEAR(strain_energy_of(both, state(1.0 / std::cos(phi / std::sqrt(12.0)))), bending, 1e-9 * bending);
  EXPECT_GT(strain_energy_of(both, state(1.0)), 10.0 * bending);
  EXPECT_NEAR(strain_energy_of(middle, state(1.0)), bending, 1e-9 * bending);
}

// Curved reference of φ₀ per element in linear theory. A shear ψ rotates the chord against both sections and strains
// the two points by Γ₁ = ± sin(φ₀/√12) ψ. The term EA sin²(φ₀/√12) is therefore added to GA.
TEST(LrvfQuadrature, AxialStrainInBothPointsOfAnArcStiffensItsShear) {
  double const phi = 0.5, c = 2.0 / phi * std::sin(0.5 * phi), lean = phi / std::sqrt(12.0);
  ReferenceCurve const arc = [&](double s) {
    double const a = phi * (s - 0.5);
    return Placement::at(Vec3(std::sin(a) / phi, -std::cos(a) / phi, 0), Vec3(0, 0, a));
  };
  auto const shear = [&](auto const& beam) {  // both sections rotated by ψ = 1 against the chord, along which r′ = 1
    VecX turned = VecX::Zero(12);
    turned[5] = turned[11] = 1.0;
    return turned.dot(stiffness(beam, standing(beam)) * turned);
  };
  EXPECT_NEAR(shear(Lrvf<RelativeRotation, SelectiveQuadrature>::from(slender(), 1, arc)), GA, 1e-9 * GA);
  EXPECT_NEAR(shear(Lrvf<RelativeRotation, AxialInBoth>::from(slender(), 1, arc)),
              GA + EA * std::pow(std::sin(lean), 2), 1e-9 * EA);
  EXPECT_LT(c, length);
}

}  // namespace lrvf_quadrature_test
}  // namespace polybody
