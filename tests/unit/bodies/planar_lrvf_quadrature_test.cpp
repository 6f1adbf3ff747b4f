// Quadratures of the planar Lrvf: law tests and the amount of locking.

#include <polybody/bodies/lrvf/planar_lrvf.hpp>

#include <polybody/testing/flexible_body_laws.hpp>

#include <Eigen/LU>

namespace polybody {
using namespace laws;
namespace planar_lrvf_quadrature_test {

/// Quadrature with ε at both Gauss points and γ in the middle. `Selective` evaluates ε in the middle. The strains
/// form three groups.
struct AxialInBoth {
  static constexpr std::array<StrainPoint, 3> points = {
      {{gauss<2>[0].xi, 0.5, 0.0, 0.5}, {0.5, 0.0, 1.0, 0.0}, {gauss<2>[1].xi, 0.5, 0.0, 0.5}}};
};
static_assert(std::same_as<planar::Lrvf, planar::LrvfBy<ReducedQuadrature>>);

template <class Quadrature>
struct Case {
  static Bar bar() {
    return {.length = 1.3,
            .constants = BarConstants{.EA = 900, .EI = 40, .mass_per_length = 2.0, .GA = 300, .rotary_inertia = 0.05},
            .placement = Placement::planar(0.4, -0.3, 0.7),
            .damping = {.axial = 0.01, .shear = 0.02, .bending = 0.03}};
  }
  static planar::LrvfBy<Quadrature> body(Bar const& bar) { return planar::LrvfBy<Quadrature>::from(bar, 3); }
};
bool const full_obeys = obeys<Case<FullQuadrature>, BodyLaws, FlexibleBodyLaws>("PlanarFullLrvf");
bool const selective_obeys = obeys<Case<SelectiveQuadrature>, BodyLaws, FlexibleBodyLaws>("PlanarSelectiveLrvf");
bool const axial_obeys = obeys<Case<AxialInBoth>, BodyLaws, FlexibleBodyLaws>("PlanarAxialInBothLrvf");

double const length = 1.0, EI = 20.0, GA = 4e6;

/// Tip deflection per tip force of a cantilever along x, in linear theory.
template <class B>
double flexibility(Index n) {
  Bar const bar{.length = length, .constants = BarConstants{.EA = 1e7, .EI = EI, .mass_per_length = 1.0, .GA = GA}};
  B const beam = B::from(bar, n);
  VecX q(3 * (n + 1)), v = VecX::Zero(3 * (n + 1));
  beam.reference({q.data(), std::size_t(q.size())});
  MatX k = MatX::Zero(q.size(), q.size());
  for (Index e = 0; e < n; ++e) {
    Mat<double, 6, 6> part;
    beam.tangent(e, view(q), view(v), 1.0, 0.0, part);
    k.block<6, 6>(3 * e, 3 * e) += part;
  }
  MatX const held = k.bottomRightCorner(3 * n, 3 * n);
  return held.lu().solve(VecX::Unit(3 * n, 3 * n - 2))[3 * n - 2];
}

// The formulas are derived in lrvf_quadrature_test.cpp: L³/(3 EI) (1 − 1/(4n²))/(1 + GA l²/(12 EI)) + L/GA with full
// integration, and without the divisor otherwise.
TEST(PlanarLrvfQuadrature, FullLocksByTheKnownFactor) {
  for (Index const n : {1, 2, 8, 64}) {
    double const l = length / double(n), bending = length * length * length / (3.0 * EI) * (1.0 - 0.25 / double(n * n)),
                 locking = 1.0 + GA * l * l / (12.0 * EI);
    EXPECT_NEAR(flexibility<planar::FullLrvf>(n) / (bending / locking + length / GA), 1.0, 1e-8) << n;
    EXPECT_NEAR(flexibility<planar::Lrvf>(n) / (bending + length / GA), 1.0, 1e-8) << n;
    EXPECT_NEAR(flexibility<planar::SelectiveLrvf>(n) / (bending + length / GA), 1.0, 1e-8) << n;
  }
}

/// Energy of a beam in the state q.
template <class B>
double energy_of(B const& beam, VecX const& q) {
  double sum = 0.0;
  for (Index e = 0; e < beam.elements(); ++e) sum += beam.strain_energy(e, view(q));
  return sum;
}
/// State far from the reference.
VecX bent() {
  return VecX::NullaryExpr(12, [](Index i) { return 0.5 * double(i / 3) + 0.4 * std::sin(1.0 + 3.0 * double(i)); });
}

// θ is linear, so κ is constant in the element and one point is sufficient. Compared are energy, tangent and section
// forces.
TEST(PlanarLrvfQuadrature, SelectiveIsReduced) {
  auto const one = Case<ReducedQuadrature>::body(Case<ReducedQuadrature>::bar());
  auto const selective = Case<SelectiveQuadrature>::body(Case<ReducedQuadrature>::bar());
  VecX const q = bent(), v = VecX::Constant(12, 0.3);
  double const energy = energy_of(one, q);
  EXPECT_NEAR(energy_of(selective, q), energy, 1e-14 * energy);
  for (Index e = 0; e < 3; ++e) {
    Mat<double, 6, 6> a, b;
    one.tangent(e, view(q), view(v), 1.0, 0.3, a);
    selective.tangent(e, view(q), view(v), 1.0, 0.3, b);
    EXPECT_LT((a - b).norm(), 1e-13 * a.norm());
  }
  auto const at = one.at(0.6);
  EXPECT_LT((one.section_forces(at, view(q)) - selective.section_forces({at.element, at.xi, at.y}, view(q))).norm(),
            1e-13 * energy);
  EXPECT_GT(std::abs(energy_of(Case<AxialInBoth>::body(Case<ReducedQuadrature>::bar()), q) - energy), 1e-3 * energy);
}

// Reason for ε in the middle, derived in lrvf_quadrature_test.cpp. An element bent by φ has ε = c/l cos(φ/√12) − 1 at
// two points with its chord c. The energy is that of bending alone at c = l/cos(φ/√12), not at c = l.
TEST(PlanarLrvfQuadrature, AxialStrainInBothPointsStretchesTheChordOfABentElement) {
  double const phi = 0.3, bending = 0.5 * EI * phi * phi / length;
  Bar const bar{.length = length, .constants = BarConstants{.EA = 1e7, .EI = EI, .mass_per_length = 1.0, .GA = GA}};
  auto const state = [&](double chord) {
    VecX q(6);
    q << 0.0, 0.0, -0.5 * phi, chord, 0.0, 0.5 * phi;
    return q;
  };
  auto const both = planar::LrvfBy<AxialInBoth>::from(bar, 1);
  auto const middle = planar::SelectiveLrvf::from(bar, 1);
  EXPECT_NEAR(energy_of(both, state(1.0 / std::cos(phi / std::sqrt(12.0)))), bending, 1e-9 * bending);
  EXPECT_GT(energy_of(both, state(1.0)), 10.0 * bending);
  EXPECT_NEAR(energy_of(middle, state(1.0)), bending, 1e-9 * bending);
}

}  // namespace planar_lrvf_quadrature_test
}  // namespace polybody
