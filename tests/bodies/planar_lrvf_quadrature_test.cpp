// The planar Lrvf with all strains in both Gauss points: its laws, and by how much it locks.

#include <polybody/bodies/lrvf/planar_lrvf.hpp>

#include <polybody/testing/flexible_body_laws.hpp>

#include <Eigen/LU>

namespace polybody {
using namespace laws;
namespace planar_lrvf_quadrature_test {

struct FullCase {
  static Bar bar() {
    return {.length = 1.3,
            .constants = BarConstants{.EA = 900, .EI = 40, .mass_per_length = 2.0, .GA = 300, .rotary_inertia = 0.05},
            .placement = Placement::planar(0.4, -0.3, 0.7),
            .damping = {.axial = 0.01, .shear = 0.02, .bending = 0.03}};
  }
  static planar::FullLrvf body(Bar const& bar) { return planar::FullLrvf::from(bar, 3); }
};
bool const planar_full_lrvf_obeys = obeys<FullCase, BodyLaws, FlexibleBodyLaws>("PlanarFullLrvf");

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

// The formulas are derived in lrvf_quadrature_test.cpp: L³/(3 EI) (1 − 1/(4n²))/(1 + GA l²/(12 EI)) + L/GA, and the
// same without the last factor.
TEST(PlanarLrvfQuadrature, FullLocksByTheKnownFactor) {
  for (Index const n : {1, 2, 8, 64}) {
    double const l = length / double(n), bending = length * length * length / (3.0 * EI) * (1.0 - 0.25 / double(n * n)),
                 locking = 1.0 + GA * l * l / (12.0 * EI);
    EXPECT_NEAR(flexibility<planar::FullLrvf>(n) / (bending / locking + length / GA), 1.0, 1e-8) << n;
    EXPECT_NEAR(flexibility<planar::Lrvf>(n) / (bending + length / GA), 1.0, 1e-8) << n;
  }
}

}  // namespace planar_lrvf_quadrature_test
}  // namespace polybody
