#include <polybody/bodies/ancf/ancf_beam.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/flexible_body_laws.hpp>

namespace polybody {
using namespace laws;
namespace ancf_beam_continuum_test {

/// Bar with different damping times for stretch and shear and with a section that is not square.
template <Locking locking>
struct ContinuumCase {
  static Bar bar() {
    return {.length = 1.3,
            .section = Rectangle{.height = 0.25, .width = 0.18},
            .material = Material{.density = 45, .young = 2e4, .poisson = 0.3},
            .placement = Placement::at({0.4, -0.3, 0.2}, {0.7, -0.2, 0.5}),
            .damping = {.axial = 0.01, .shear = 0.02, .bending = 0.03}};
  }
  static AncfBeam<Continuum<locking>> body(Bar const& bar) { return AncfBeam<Continuum<locking>>::from(bar, 3); }
};
using LockingCase = ContinuumCase<Locking::present>;
using CuredCase = ContinuumCase<Locking::cured>;
bool const ancf_beam_continuum_obey[] = {obeys<LockingCase, BodyLaws, FlexibleBodyLaws>("AncfContinuum"),
                                         obeys<CuredCase, BodyLaws, FlexibleBodyLaws>("AncfCuredContinuum")};

// Homogeneous deformation r = F X in the axes of the bar: E = ½ (FᵀF − 1) everywhere. S and the energy follow from
// Hooke's law.
struct Homogeneous {
  Mat3 f, e;
  double volume = 1.3 * 0.25 * 0.18, mu = 2e4 / 2.6, lambda = 0.3 * 2e4 / (1.3 * 0.4);
  double k;  // Cowper's shear correction

  Homogeneous() : k(10 * 1.3 / (12 + 11 * 0.3)) {
    f << 1.1, 0.05, -0.02, 0.1, 0.92, 0.07, -0.03, 0.04, 1.06;
    e = 0.5 * (f.transpose() * f - Mat3::Identity());
  }
  /// Full Hooke's law, with the stresses S₁₂ and S₁₃ multiplied by `shear`.
  Mat3 stress(double shear) const {
    Mat3 s = lambda * e.trace() * Mat3::Identity() + 2 * mu * e;
    for (int j = 1; j < 3; ++j) s(0, j) = s(j, 0) = shear * s(0, j);
    return s;
  }
  template <class B>
  void check(B const& body, Mat3 const& expected) const {
    VecX q(body.coordinates());
    body.reference(mutable_view(q));
    for (Index i = 0; i < q.size(); i += 3) q.segment<3>(i) = (f * q.segment<3>(i)).eval();
    double energy = 0.0;
    for (Index n = 0; n < body.elements(); ++n) energy += body.strain_energy(n, view(q));
    EXPECT_NEAR(energy, 0.5 * volume * expected.cwiseProduct(e).sum(), 1e-11 * energy);
    for (auto const& p : {body.at(0.4), body.at(1.2, 0.1, -0.05)}) {
      EXPECT_LT((body.deformation_gradient(p, view(q)) - f).norm(), 1e-13);
      EXPECT_LT((body.strain(p, view(q)) - e).norm(), 1e-13);
      Stress const s = body.stress(p, view(q));
      EXPECT_LT((s.second_piola - expected).norm(), 1e-13 * expected.norm());
      EXPECT_LT((s.cauchy - f * expected * f.transpose() / f.determinant()).norm(), 1e-13 * expected.norm());
    }
  }
};
Bar along_x() {
  Bar bar = CuredCase::bar();
  bar.placement = {};
  return bar;
}

TEST(AncfContinuum, HomogeneousDeformationObeysHookesLaw) {
  Homogeneous const h;
  h.check(LockingCase::body(along_x()), h.stress(1.0));
}

// The continuum element without locking keeps Hooke's law, except for the shear correction.
TEST(AncfCuredContinuum, HomogeneousDeformationObeysHookesLawWithCorrectedShear) {
  Homogeneous const h;
  h.check(CuredCase::body(along_x()), h.stress(h.k));
}

// Curvature κ and twist τ to first order: r_y = e₂ − κ s e₁ + τ s e₃, r_z = e₃ − τ s e₂ at the nodes, r_x along the
// normal. Stretch, shear and E₂₂ are of second order in δ, so the energy is ½ L (EI κ² + GJ τ²) to fourth order.
template <class B>
double energy_of(B const& body, double kappa, double tau) {
  VecX q(body.coordinates());
  for (Index i = 0; i <= body.elements(); ++i) {
    double const s = double(i) * body.element_length(), a = kappa * s, t = tau * s;
    q.segment<3>(12 * i) = Vec3(s, 0.5 * kappa * s * s, 0);
    q.segment<3>(12 * i + 3) = Vec3(1, a, 0);
    q.segment<3>(12 * i + 6) = Vec3(-a, 1, t);
    q.segment<3>(12 * i + 9) = Vec3(0, -t, 1);
  }
  double sum = 0.0;
  for (Index e = 0; e < body.elements(); ++e) sum += body.strain_energy(e, view(q));
  return sum;
}

// The element without locking has the bending stiffness EI and the torsional stiffness GJ of the bar.
TEST(AncfCuredContinuum, BendsAndTwistsWithTheBarsStiffnesses) {
  BarConstants const c = constants(along_x());
  auto const body = CuredCase::body(along_x());
  double const d = 1e-4;
  EXPECT_NEAR(energy_of(body, d, 0), 0.5 * 1.3 * c.EI * d * d, 1e-5 * c.EI * d * d);
  EXPECT_NEAR(energy_of(body, 0, d), 0.5 * 1.3 * c.GJ * d * d, 1e-5 * c.GJ * d * d);
}

// The locking element bends with the constrained modulus, EI (1 − ν)/((1 + ν)(1 − 2ν)) (S10, derived in closed form).
// It twists with the polar moment, G (I_y + I_z), because it has no warping.
TEST(AncfContinuum, BendsWithTheConstrainedModulusAndTwistsWithThePolarMoment) {
  BarConstants const c = constants(along_x());
  auto const body = LockingCase::body(along_x());
  double const d = 1e-4, polar = (c.EI + *c.EI_y) / 2.6;
  EXPECT_NEAR(energy_of(body, d, 0), 0.5 * 1.3 * c.EI * 0.7 / (1.3 * 0.4) * d * d, 1e-5 * c.EI * d * d);
  EXPECT_NEAR(energy_of(body, 0, d), 0.5 * 1.3 * polar * d * d, 1e-5 * polar * d * d);
}

}  // namespace ancf_beam_continuum_test
}  // namespace polybody
