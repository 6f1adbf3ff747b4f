#include <polybody/bodies/ancf/ancf_beam.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/flexible_body_laws.hpp>

namespace polybody {
using namespace laws;
namespace ancf_beam_test {

struct ElasticLineCase {
  static Bar bar() {
    return {.length = 1.3,
            .constants = BarConstants{.EA = 900,
                                      .EI = 40,
                                      .mass_per_length = 2.0,
                                      .GA = 300,
                                      .GJ = 25,
                                      .rotary_inertia = 0.05,
                                      .EI_y = 60,
                                      .GA_z = 200,
                                      .rotary_inertia_y = 0.08},
            .placement = Placement::at({0.4, -0.3, 0.2}, {0.7, -0.2, 0.5}),
            .damping = {.axial = 0.01, .shear = 0.02, .bending = 0.03}};
  }
  static AncfBeam<> body(Bar const& bar) { return AncfBeam<>::from(bar, 3); }
};
bool const ancf_beam_obeys = obeys<ElasticLineCase, BodyLaws, FlexibleBodyLaws>("AncfElasticLine");

int const elements = 4;
double const l = 1.3 / elements;
AncfBeam<> straight() {
  Bar bar = ElasticLineCase::bar();
  bar.placement = {};
  return AncfBeam<>::from(bar, elements);
}

/// Coordinates q of a deformation, given at each node as the 3×4 matrix [r r_x r_y r_z] of the node's arc length.
template <class F>
VecX nodes(F&& node) {
  VecX q(12 * (elements + 1));
  for (Index i = 0; i <= elements; ++i) q.segment<12>(12 * i) = Mat<double, 3, 4>(node(double(i) * l)).reshaped();
  return q;
}
Mat<double, 3, 4> node(Vec3 const& r, Mat3 const& gradients) {
  Mat<double, 3, 4> n;
  n << r, gradients;
  return n;
}

double energy(VecX const& q) {
  double sum = 0.0;
  for (Index e = 0; e < elements; ++e) sum += straight().strain_energy(e, view(q));
  return sum;
}

/// Γ, K and the strains of the section in the middle of each element, their resultants, and the energy.
void expect_strains(VecX const& q, Vec3 const& gamma, Vec3 const& kappa, Vec3 const& section) {
  AncfBeam<> const beam = straight();
  Vec3 const ga(900, 300, 200), ei(25, 60, 40), s(900, 900, 300);
  for (int e = 0; e < elements; ++e) {
    auto const p = beam.at((e + 0.5) * l);
    Vec6 const strains = beam.section_strains(p, view(q)), forces = beam.section_forces(p, view(q));
    EXPECT_LT((strains.head<3>() - gamma).norm(), 1e-14) << e;
    EXPECT_LT((strains.tail<3>() - kappa).norm(), 1e-14) << e;
    EXPECT_LT((beam.section_deformation(p, view(q)) - section).norm(), 1e-14) << e;
    EXPECT_LT((forces.head<3>() - gamma.cwiseProduct(ga)).norm(), 1e-11) << e;
    EXPECT_LT((forces.tail<3>() - kappa.cwiseProduct(ei)).norm(), 1e-11) << e;
  }
  double const expected =
      gamma.cwiseProduct(ga).dot(gamma) + kappa.cwiseProduct(ei).dot(kappa) + section.cwiseProduct(s).dot(section);
  EXPECT_NEAR(energy(q), 0.5 * 1.3 * expected, 1e-12);
}

TEST(AncfElasticLine, PureStretchIsGammaOneAlone) {
  expect_strains(nodes([](double s) { return node({1.02 * s, 0, 0}, Vec3(1.02, 1, 1).asDiagonal()); }), {0.02, 0, 0},
                 Vec3::Zero(), Vec3::Zero());
}

TEST(AncfElasticLine, ShearsAreGammaTwoAndThree) {
  Mat3 gradients = Mat3::Identity();
  gradients.col(0) = Vec3(1, 0.1, -0.2);
  expect_strains(nodes([&](double s) { return node(s * gradients.col(0), gradients); }), {0, 0.1, -0.2}, Vec3::Zero(),
                 Vec3::Zero());
}

// Stretch and shear within a section have no effect on the strains of its frame.
TEST(AncfElasticLine, SectionStrainsAreOfTheSectionAlone) {
  Mat3 gradients = Mat3::Identity();
  gradients.col(1) = Vec3(0, 1.1, 0);
  gradients.col(2) = Vec3(0, 0.2, 0.9);
  expect_strains(nodes([&](double s) { return node({s, 0, 0}, gradients); }), Vec3::Zero(), Vec3::Zero(),
                 {0.5 * (1.21 - 1), 0.5 * (0.85 - 1), 0.22});
}

// r_y and r_z rotate by θ per element and are linear in between. They point along atan((2ξ − 1) T), T = tan(θ/2),
// from the middle. Their rotation per length is 2T/l/(1 + (2ξ − 1)² T²). With (2ξ − 1)² = 1/3 at the two Gauss
// points: θ/l (1 − θ⁴/180 + …).
TEST(AncfElasticLine, TurningSectionsAreCurvatureAndTwist) {
  double const theta = 0.3, t = std::tan(0.5 * theta), middle = 2.0 * t / l, gauss = middle / (1.0 + t * t / 3.0);
  EXPECT_NEAR(gauss * l / theta, 1.0 - std::pow(theta, 4) / 180, std::pow(theta, 6) / 100);
  Vec3 const stiffness(25, 60, 40);
  AncfBeam<> const beam = straight();
  for (int axis = 0; axis < 3; ++axis) {
    VecX const q = nodes([&](double s) {
      Mat3 turn = exp_so3<double>(Vec3::Unit(axis) * (theta * s / l));
      return node(Vec3::Zero(), turn);
    });
    for (int e = 0; e < elements; ++e) {
      EXPECT_LT((beam.section_strains(beam.at((e + 0.5) * l), view(q)).tail<3>() - Vec3::Unit(axis) * middle).norm(),
                1e-13);
      auto p = beam.at((e + 0.5) * l);
      p.xi = 0.5 - 0.5 / std::sqrt(3.0);
      EXPECT_LT((beam.section_forces(p, view(q)).tail<3>() - Vec3::Unit(axis) * (stiffness[axis] * gauss)).norm(),
                1e-11);
    }
  }
}

// Nodes of a circle in pure bending: r_x along the tangent, sections normal to it. The difference between the cubic
// and the circle is a stretch of order θ³. Its energy compared with that of bending is EA l² θ⁴/EI times a small
// number.
TEST(AncfElasticLine, ArcHasTheEnergyOfPureBending) {
  double const theta = 0.1, radius = l / theta;
  VecX const q = nodes([&](double s) {
    double const a = s / radius;
    return node(radius * Vec3(std::sin(a), 1 - std::cos(a), 0), exp_so3<double>(Vec3(0, 0, a)));
  });
  EXPECT_NEAR(energy(q), 0.5 * 40 / (radius * radius) * 1.3, 1e-5 * energy(q));
}

// Aρ times the Hermite mass matrix [Wallin 2016, Eq. 3.18] for r and r_x, Iρ l/6 [2 1; 1 2] for r_y (about z) and r_z
// (about y).
TEST(AncfElasticLine, MassIsTheConsistentOne) {
  Mat<double, 24, 24> m, expected = Mat<double, 24, 24>::Zero();
  std::vector<double> const q(60);
  straight().mass(0, q, m);
  Mat<double, 4, 4> hermite;
  hermite << 156, 22 * l, 54, -13 * l, 22 * l, 4 * l * l, 13 * l, -3 * l * l, 54, 13 * l, 156, -22 * l, -13 * l,
      -3 * l * l, -22 * l, 4 * l * l;
  std::array<int, 4> const at = {0, 3, 12, 15};
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = 0; b < 4; ++b)
      expected.block<3, 3>(at[a], at[b]) = 2.0 * l / 420 * hermite(Index(a), Index(b)) * Mat3::Identity();
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b) {
      double const share = l / (a == b ? 3 : 6);
      expected.block<3, 3>(12 * a + 6, 12 * b + 6) = 0.05 * share * Mat3::Identity();
      expected.block<3, 3>(12 * a + 9, 12 * b + 9) = 0.08 * share * Mat3::Identity();
    }
  EXPECT_LT((m - expected).norm(), 1e-14);
}

// The axial force of a bar with the strain rate ε̇ is EA (ε + τ ε̇). The torque of a twisting bar has the viscous
// part GJ τ κ̇.
TEST(AncfElasticLine, DampingIsKelvinVoigt) {
  AncfBeam<> const beam = straight();
  VecX const q = nodes([](double s) { return node({1.02 * s, 0, 0}, Vec3(1.02, 1, 1).asDiagonal()); });
  VecX const stretching = nodes([](double s) { return node({0.5 * s, 0, 0}, Vec3(0.5, 0, 0).asDiagonal()); });
  VecX const twisting = nodes([](double s) {
    Mat3 rate = Mat3::Zero();
    rate(2, 1) = 0.5 * s;
    rate(1, 2) = -0.5 * s;
    return node({0, 0, 0}, rate);
  });
  auto const power = [&](VecX const& v) {
    double sum = 0.0;
    for (Index e = 0; e < elements; ++e) {
      Vec<double, 24> f;
      beam.force<double>(e, view(q), view(v), f);
      sum += f.dot(v.segment<24>(12 * e));
    }
    return sum;
  };
  EXPECT_NEAR(power(stretching), -1.3 * 900 * (0.02 + 0.01 * 0.5) * 0.5, 1e-10);
  EXPECT_NEAR(power(twisting), -1.3 * 25 * 0.02 * 0.5 * 0.5, 1e-10);
}

// A marker off the axis is the material point r + y r_y + z r_z. Its axes are the normalised r_y, the normal of the
// section, and the vector that completes the right-handed frame.
TEST(AncfElasticLine, MarkerIsTheMaterialPointAndTheSectionsFrame) {
  AncfBeam<> const beam = straight();
  Mat3 gradients;
  gradients << 1.1, -0.3, 0.1, 0.4, 0.9, 0.2, 0, 0.1, 1.2;
  Vec3 const origin(0.2, -0.5, 0.7);
  VecX const q = nodes([&](double s) { return node(origin + s * gradients.col(0), gradients); }),
             v = VecX::Zero(q.size());
  auto const p = beam.at(0.7, 0.05, -0.03);
  std::array<double, 144> memory;
  MarkerKinematics<double> out;
  out.jacobian = memory.data();
  beam.evaluate_marker<double>(p, Mat3::Identity(), view(q), view(v), out);
  EXPECT_LT((out.frame.r - origin - gradients * Vec3(0.7, 0.05, -0.03)).norm(), 1e-14);
  Vec3 const y = gradients.col(1), z = gradients.col(2), t2 = y / y.norm(), t1 = y.cross(z) / y.cross(z).norm();
  EXPECT_LT((out.frame.A.col(0) - t1).norm() + (out.frame.A.col(1) - t2).norm(), 1e-14);
  Vec<double, 24> const e = q.segment<24>(beam.first_column(p));
  EXPECT_LT((beam.position_map(p) * e - out.frame.r).norm(), 1e-14);
  EXPECT_LT((beam.position_map(p) - out.dense().topRows<3>()).norm(), 1e-15);
  for (int alpha = 0; alpha < 3; ++alpha)
    EXPECT_LT((beam.gradient_map(p, alpha) * e - gradients.col(alpha)).norm(), 1e-14) << alpha;
  EXPECT_THROW((void)beam.gradient_map(p, 3), InvalidInput);
}

}  // namespace ancf_beam_test
}  // namespace polybody
