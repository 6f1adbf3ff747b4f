// Spatial Lrvf with a curved and twisted reference configuration.

#include <polybody/bodies/lrvf/lrvf.hpp>

#include <polybody/testing/body_laws.hpp>

#include "support/spatial_lrvf.hpp"

namespace polybody {
using namespace laws;
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(BodyLaws);
namespace lrvf_curved_test {

/// Helix of curvature κ and torsion τ in its Frenet axes: R = exp(s (τ, 0, κ)), r = ∫ R e₁ ds = s Jl(s k) e₁.
ReferenceCurve helix(double curvature, double torsion) {
  return [=](double s) {
    Vec3 const k = s * Vec3(torsion, 0, curvature);
    return Placement{s * left_jacobian<double>(k).col(0), exp_so3<double>(k)};
  };
}

struct CurvedCase {
  static Bar bar() {
    Bar bar = spatial_lrvf_bar();
    bar.pretension = 20.0;
    return bar;
  }
  static Lrvf<> body(Bar const& bar) { return Lrvf<>::from(bar, 3, helix(1.5, 0.8)); }
};
/// Functions of the law tests for a body other than their straight bar.
struct CurvedLrvf : testing::Test, BodyLaws<CurvedCase> {};

TEST_F(CurvedLrvf, NodesStandOnTheCurveWithoutStrain) {
  VecX const q = reference(), rest = VecX::Zero(nv);
  Placement const place = CurvedCase::bar().placement;
  for (int i = 0; i <= 3; ++i) {
    double const s = i * 1.3 / 3.0;
    Placement const expected = helix(1.5, 0.8)(s);
    auto const f = see<double>(body.at(s, 0.05, -0.02), Mat3::Identity(), q, rest).marker.frame;
    EXPECT_LT((f.A - place.axes * expected.axes).norm(), 1e-14);
    EXPECT_LT((f.r - place.origin - place.axes * (expected.origin + expected.axes * Vec3(0, 0.05, -0.02))).norm(),
              1e-14);
    EXPECT_EQ(body.section_strains(body.at(s), view(q)).norm(), 0.0);
  }
}

// The chord differs from the arc. The laws of force, tangent and weight hold as on the straight bar.
TEST_F(CurvedLrvf, ForceIsTheGradientOfTheEnergyAndTheTangentThatOfTheForce) {
  VecX const q = configuration(), v = velocities();
  VecX const slope = gradient([&](VecX const& at) { return strain_energy(at); }, q);
  EXPECT_LT(mismatch(force_at_rest(q), -slope), 1e-8);
  MatX by_position(nv, nv), by_speed(nv, nv);
  for (Index j = 0; j < nv; ++j) {
    VecX const unit = VecX::Unit(nv, j);
    by_position.col(j) = epsilon_of(force<Dual<1>>(carried(q, unit), v.cast<Dual<1>>()));
    by_speed.col(j) = epsilon_of(force<Dual<1>>(q.cast<Dual<1>>(), along(v, unit)));
  }
  EXPECT_LT(mismatch(tangent(q, v, 1.0, 0.0), -by_position), 1e-12);
  EXPECT_LT(mismatch(tangent(q, v, 0.0, 1.0), -by_speed), 1e-12);
  EXPECT_NEAR(kinetic_energy(q, rigid_velocity(q, Vec3(1, 2, 3), Vec3::Zero())), 0.5 * 2.6 * 14.0, 1e-12);
}

// An arc with a radial stretch ε about its centre, and an arc with uniform bending. The only strain is ε, or the
// change of curvature.
TEST_F(CurvedLrvf, UniformStretchAndBendOfAnArcAreMeasuredExactly) {
  Bar arc = spatial_lrvf_bar();
  arc.placement = {};
  double const kappa = 1.5, l = 1.3 / 3.0;
  Lrvf<> const beam = Lrvf<>::from(arc, 3, helix(kappa, 0.0));
  VecX q(beam.coordinates());
  beam.reference(mutable_view(q));
  double const chord = 2.0 / kappa * std::sin(0.5 * kappa * l);
  VecX stretched = q;
  for (int i = 0; i <= 3; ++i) stretched.segment<3>(7 * i) *= 1.02;
  Vec6 expected = Vec6::Zero();
  expected[0] = 0.02;
  EXPECT_LT((beam.section_strains(beam.at(0.7), view(stretched)) - expected).norm(), 1e-14);
  Placement at;
  Mat3 const half = exp_so3<double>(Vec3(0, 0, 0.5 * 2.1 * l));
  VecX const bent = nodes_of(3, [&](double) {
    Placement const node = at;
    at = {node.origin + chord * (node.axes * half).col(0), node.axes * half * half};
    return node;
  });
  expected << 0, 0, 0, 0, 0, 0.6;
  EXPECT_LT((beam.section_strains(beam.at(0.7), view(bent)) - expected).norm(), 1e-14);
}

}  // namespace lrvf_curved_test
}  // namespace polybody
