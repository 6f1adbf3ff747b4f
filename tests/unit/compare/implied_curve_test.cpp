#include <polybody/compare/mesh_diagnostics.hpp>

#include <gtest/gtest.h>

#include <numbers>

#include "support/refusal.hpp"

namespace implied_curve_test {

using namespace polybody;

/// Helix of radius a and pitch 2πb with arc-length parametrisation, c = √(a² + b²): r = (a cos u, a sin u, b u), u =
/// s/c. Its tangent is t = (−a/c sin u, a/c cos u, b/c). In Eq. 2.1 ψ = u + π/2 and sin θ = b/c; φ rotates the
/// sections about t and is arbitrary. κ = a/c², τ = b/c².
struct Helix {
  double a = 0.8, b = 0.5, c = std::hypot(a, b);
  double (*roll)(double) = [](double) { return 0.0; };
  double (*roll_slope)(double) = roll;
  double (*roll_second)(double) = roll;

  SectionTurn operator()(double s) const {
    return section_turn({s / c + std::numbers::pi / 2, 1 / c, 0}, {std::asin(b / c), 0, 0},
                        {roll(s), roll_slope(s), roll_second(s)});
  }
  Vec3 point(double s) const { return {a * std::cos(s / c), a * std::sin(s / c), b * s / c}; }
};

Helix const plain;
Helix const rolling{.roll = [](double s) { return 0.3 + std::sin(2 * s); },
                    .roll_slope = [](double s) { return 2 * std::cos(2 * s); },
                    .roll_second = [](double s) { return -4 * std::sin(2 * s); }};

// Eq. 2.1 of Wallin 2016 as printed, entry by entry.
TEST(ImpliedCurve, AnglesGiveTheMatrixOfTheThesis) {
  using std::cos, std::sin;
  double const p = 0.7, t = -0.4, f = 1.9;
  Mat3 expected;
  expected << cos(p) * cos(t), -sin(p) * cos(f) + cos(p) * sin(t) * sin(f), -sin(p) * sin(f) - cos(p) * sin(t) * cos(f),
      sin(p) * cos(t), cos(p) * cos(f) + sin(p) * sin(t) * sin(f), cos(p) * sin(f) - sin(p) * sin(t) * cos(f), sin(t),
      -cos(t) * sin(f), cos(t) * cos(f);
  EXPECT_LT((section_turn({p}, {t}, {f}).R - expected).norm(), 1e-15);
}

// R′ = R K̃ and K′, by dual numbers with varying angles: ψ = 0.7 + 2s + s², θ = −0.4 + 3s − s², φ = 1.9 − s + 2s².
TEST(ImpliedCurve, AnglesGiveTheCurvatureAndItsSlope) {
  using D = Dual<1>;
  auto const field = [](double h) {
    return section_turn({0.7 + 2 * h + h * h, 2 + 2 * h, 2}, {-0.4 + 3 * h - h * h, 3 - 2 * h, -2},
                        {1.9 - h + 2 * h * h, -1 + 4 * h, 4});
  };
  auto const about = [](double slope, double value, int axis) {
    Vec<D, 3> v = Vec<D, 3>::Zero();
    v[axis].v = value;
    v[axis].d[0] = slope;
    return exp_so3<D>(v);
  };
  Mat<D, 3, 3> const r = about(2, 0.7, 2) * about(-3, 0.4, 1) * about(1, -1.9, 0);
  Mat3 const slope = r.unaryExpr([](D const& x) { return x.d[0]; });
  SectionTurn const s = field(0.0);
  EXPECT_LT((slope - s.R * skew<double>(s.K)).norm(), 1e-14);
  double const h = 1e-4;  // error of the central difference of K: h² K‴/6
  EXPECT_LT(((field(h).K - field(-h).K) / (2 * h) - s.dK).norm(), 1e-6);
}

// Eq. 2.4 of Wallin 2016: κ² = (ψ′ cos θ)² + θ′².
TEST(ImpliedCurve, CurvatureIsThatOfTheThesis) {
  EXPECT_NEAR(implied_curvature(section_turn({0.7, 2.0}, {-0.4, 3.0}, {1.9, -1.0})),
              std::hypot(2.0 * std::cos(0.4), 3.0), 1e-14);
}

TEST(ImpliedCurve, AHelixHasItsCurvatureAndTorsionHoweverItsSectionsRoll) {
  for (Helix const& helix : {plain, rolling})
    for (double const s : {0.0, 0.4, 1.7}) {
      EXPECT_NEAR(implied_curvature(helix(s)), helix.a / (helix.a * helix.a + helix.b * helix.b), 1e-14);
      EXPECT_NEAR(implied_torsion(helix(s)), helix.b / (helix.a * helix.a + helix.b * helix.b), 1e-14);
    }
}

TEST(ImpliedCurve, AHelixIsRecoveredFromItsRotations) {
  Index const pieces = 40;
  double const length = 6.0;
  std::vector<Vec3> const curve =
      implied_curve([](double s) { return rolling(s).R; }, length, pieces, rolling.point(0.0));
  ASSERT_EQ(curve.size(), 41u);
  for (Index i = 0; i <= pieces; ++i) {
    Vec3 const expected = rolling.point(double(i) * length / double(pieces));
    EXPECT_LT((curve[std::size_t(i)] - expected).norm(), 1e-14 * (1.0 + double(i))) << i;
  }
}

template <class I>
Lrvf<I> beam(Index n) {
  return Lrvf<I>::from(
      {.length = 2.0, .constants = BarConstants{.EA = 1, .EI = 1, .mass_per_length = 1, .GA = 1, .GJ = 1}}, n);
}

/// q with every node rotated by s φ at unchanged positions.
template <class I>
std::vector<double> turned(Lrvf<I> const& b, Vec3 const& phi) {
  std::vector<double> q(std::size_t(b.coordinates()));
  b.reference(q);
  for (Index i = 0; i <= b.elements(); ++i)
    part<4>(std::span<double>(q), 7 * i + 3) = quaternion_exp<double>(phi * (double(i) * b.element_length()));
  return q;
}

// R = exp(s φ) is the Frenet frame of a helix of curvature √(φ₂² + φ₃²) and torsion φ₁, r = s Jl(s φ) e₁.
// `RelativeRotation` interpolates this helix between two nodes. Positions have no influence, and the curve does not
// stretch [§2.5.3].
TEST(ImpliedCurve, ABeamInterpolatesAHelixBetweenItsNodes) {
  Vec3 const phi(0.6, -0.5, 1.2);
  Lrvf<> const b = beam<RelativeRotation>(3);
  std::vector<double> const q = turned(b, phi);
  std::vector<Vec3> const curve = implied_curve(b, q, 4);
  for (int i = 0; i <= 12; ++i) {
    double const s = 2.0 * i / 12.0;
    EXPECT_LT((curve[std::size_t(i)] - s * left_jacobian<double>(s * phi).col(0)).norm(), 1e-13) << i;
    SectionTurn const turn = b.rotation_field(b.at(s), q);
    EXPECT_NEAR(implied_curvature(turn), 1.3, 1e-14);
    EXPECT_NEAR(implied_torsion(turn), 0.6, 1e-14);
  }
}

// `Direct` gives the same helix from the placement. If the helix is rotated, its curvature varies: R′ = R K̃ and K′
// by finite differences.
TEST(ImpliedCurve, TheFieldOfRotationVectorsIsItsOwnDerivative) {
  Lrvf<Direct> const b = beam<Direct>(1);
  EXPECT_NEAR(implied_torsion(b.rotation_field(b.at(0.7), turned(b, Vec3(0.6, -0.5, 1.2)))), 0.6, 1e-14);
  std::vector<double> q = turned(b, Vec3(0.6, -0.5, 1.2));
  for (int i = 0; i < 2; ++i) {
    Quaternion<double> const node = part<4>(std::span<double const>(q), 7 * i + 3);
    part<4>(std::span<double>(q), 7 * i + 3) =
        quaternion_product<double>(quaternion_exp<double>(Vec3(1, -0.5, 0)), node);
  }
  auto const at = [&](double s) { return b.rotation_field(b.at(s), q); };
  double const h = 1e-4;
  SectionTurn const s = at(0.7);
  EXPECT_GT(s.dK.norm(), 0.05);
  EXPECT_LT(((at(0.7 + h).R - at(0.7 - h).R) / (2 * h) - s.R * skew<double>(s.K)).norm(), 1e-7);
  EXPECT_LT(((at(0.7 + h).K - at(0.7 - h).K) / (2 * h) - s.dK).norm(), 1e-7);
}

TEST(ImpliedCurve, RefusesNothingToIntegrate) {
  auto const field = [](double) { return Mat3(Mat3::Identity()); };
  EXPECT_TRUE(has(refusal([&] { (void)implied_curve(field, 0.0, 3); }), "the length"));
  EXPECT_TRUE(has(refusal([&] { (void)implied_curve(field, 1.0, 0); }), "at least one piece"));
}

}  // namespace implied_curve_test
