#include <polybody/bodies/ancf/planar_ancf_cable.hpp>

#include <gtest/gtest.h>

#include <numbers>

#include <polybody/system/model.hpp>
#include <polybody/testing/flexible_body_laws.hpp>
#include <polybody/vibration/modes.hpp>

namespace polybody {
using namespace laws;
namespace planar_ancf_cable_test {

using planar::AncfCable, planar::EngineeringStrain, planar::GreenStrain;

template <class Strain>
struct CableCase {
  static Bar bar() {
    return {.length = 1.3,
            .constants = BarConstants{.EA = 900, .EI = 40, .mass_per_length = 2.0},
            .placement = Placement::planar(0.4, -0.3, 0.7),
            .damping = {.axial = 0.01, .bending = 0.03}};
  }
  static AncfCable<Strain> body(Bar const& bar) { return AncfCable<Strain>::from(bar, 2); }
};
bool const planar_ancf_cable_obey[] = {
    obeys<CableCase<GreenStrain>, BodyLaws, FlexibleBodyLaws>("GreenCable"),
    obeys<CableCase<EngineeringStrain>, BodyLaws, FlexibleBodyLaws>("EngineeringCable")};

int const elements = 3;
double const l = 1.3 / elements;

template <class Strain>
AncfCable<Strain> straight() {
  Bar bar = CableCase<Strain>::bar();
  bar.placement = {};
  return AncfCable<Strain>::from(bar, elements);
}

/// Coordinates q of a curve r(s) with derivative r′(s), each a Vec2.
template <class R, class Slope>
VecX curve(R&& r, Slope&& slope) {
  VecX q(4 * (elements + 1));
  for (Index i = 0; i <= elements; ++i) q.segment<4>(4 * i) << r(double(i) * l), slope(double(i) * l);
  return q;
}

template <class Strain>
double axial(VecX const& q, double s) {
  auto const cable = straight<Strain>();
  return cable.template strains<0>(cable.at(s), view(q))[0];
}
template <class Strain>
double bending(VecX const& q, double s) {
  auto const cable = straight<Strain>();
  return cable.template strains<1>(cable.at(s), view(q))[0];
}

double const places[] = {0.0, 0.1, 0.5, 0.9, 1.3};

TEST(AncfCable, PureStretchIsAxialStrainAlone) {
  VecX const q = curve([](double s) { return Vec2(1.2 * s, 0); }, [](double) { return Vec2(1.2, 0); });
  for (double const s : places) {
    EXPECT_NEAR(axial<GreenStrain>(q, s), 0.5 * (1.2 * 1.2 - 1.0), 1e-14);
    EXPECT_NEAR(axial<EngineeringStrain>(q, s), 0.2, 1e-14);
    EXPECT_NEAR(bending<GreenStrain>(q, s), 0.0, 1e-13);
    EXPECT_NEAR(bending<EngineeringStrain>(q, s), 0.0, 1e-13);
  }
}

// The parabola r = (s, k s²/2) is a polynomial of at most third degree, so the element represents it exactly: r′ =
// (1, k s), r″ = (0, k).
TEST(AncfCable, ParabolaHasItsExactStrains) {
  double const k = 0.8;
  VecX const q = curve([](double s) { return Vec2(s, 0.4 * s * s); }, [](double s) { return Vec2(1, 0.8 * s); });
  for (double const s : places) {
    double const n = std::hypot(1.0, k * s);
    EXPECT_NEAR(axial<GreenStrain>(q, s), 0.5 * k * k * s * s, 1e-14);
    EXPECT_NEAR(axial<EngineeringStrain>(q, s), n - 1.0, 1e-14);
    EXPECT_NEAR(bending<GreenStrain>(q, s), k / (n * n * n), 1e-13);
    EXPECT_NEAR(bending<EngineeringStrain>(q, s), k / (n * n), 1e-13);
  }
}

// Bending to the opposite side changes the sign.
TEST(AncfCable, CurvatureIsPositiveTowardsTheLeft) {
  VecX const q = curve([](double s) { return Vec2(s, -0.4 * s * s); }, [](double s) { return Vec2(1, -0.8 * s); });
  EXPECT_NEAR(bending<GreenStrain>(q, 0.0), -0.8, 1e-13);
  EXPECT_NEAR(bending<EngineeringStrain>(q, 0.0), -0.8, 1e-13);
}

// Strain energy of the stretched cable: EA/2 ∫ ε² only.
TEST(AncfCable, EnergyIsTheIntegralOfItsStrains) {
  VecX const q = curve([](double s) { return Vec2(1.2 * s, 0); }, [](double) { return Vec2(1.2, 0); });
  double green = 0.0, engineering = 0.0;
  for (Index e = 0; e < elements; ++e) {
    green += straight<GreenStrain>().strain_energy(e, view(q));
    engineering += straight<EngineeringStrain>().strain_energy(e, view(q));
  }
  EXPECT_NEAR(green, 0.5 * 900 * 0.22 * 0.22 * 1.3, 1e-12);
  EXPECT_NEAR(engineering, 0.5 * 900 * 0.2 * 0.2 * 1.3, 1e-12);
}

// Five points integrate the squared Green strain, of degree eight, exactly. A finer Gauss rule gives the same value.
// EI is negligibly small.
TEST(AncfCable, GreenEnergyIsIntegratedExactly) {
  Bar bar = CableCase<GreenStrain>::bar();
  bar.placement = {};
  bar.constants->EI = 1e-12;
  auto const cable = AncfCable<>::from(bar, 1);
  VecX const q = (VecX(8) << 0.1, -0.2, 1.3, 0.4, 0.9, 0.7, 0.5, -0.8).finished();
  double expected = 0.0;
  for (GaussPoint const& g : gauss<9>) {
    double const strain = cable.strains<0>(cable.at(g.xi * 1.3), view(q))[0];
    expected += g.weight * 1.3 * 0.5 * 900 * strain * strain;
  }
  EXPECT_GT(expected, 1.0);
  EXPECT_NEAR(cable.strain_energy(0, view(q)), expected, 1e-9);
}

// Consistent mass matrix of cubic shapes, Aρ l/420 [156 22l 54 −13l; … 4l² 13l −3l²; …]  [Przemieniecki 1968, §11.4].
TEST(AncfCable, MassIsTheConsistentOneOfCubicShapes) {
  Mat<double, 4, 4> shape;
  shape << 156, 22 * l, 54, -13 * l,          //
      22 * l, 4 * l * l, 13 * l, -3 * l * l,  //
      54, 13 * l, 156, -22 * l,               //
      -13 * l, -3 * l * l, -22 * l, 4 * l * l;
  shape *= 2.0 * l / 420.0;
  Mat<double, 8, 8> m, expected = Mat<double, 8, 8>::Zero();
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) expected(2 * i, 2 * j) = expected(2 * i + 1, 2 * j + 1) = shape(i, j);
  std::vector<double> const q(16);
  straight<GreenStrain>().mass(0, q, m);
  EXPECT_LT((m - expected).norm(), 1e-15);
}

// Small deflections of one clamped element are those of the classical beam for both strain measures: stiffness 12
// EI/l³ for a transverse displacement, 4 EI/l for a rotation.
template <class Strain>
void expect_classical_stiffness() {
  auto const cable = straight<Strain>();
  std::vector<double> q(16), v(16);
  cable.reference(q);
  Mat<double, 8, 8> k;
  cable.tangent(0, q, v, 1.0, 0.0, k);
  EXPECT_NEAR(k(5, 5), 12 * 40 / (l * l * l), 1e-9);
  EXPECT_NEAR(k(7, 7), 4 * 40 / l, 1e-9);
  EXPECT_NEAR(k(5, 7), -6 * 40 / (l * l), 1e-9);
  EXPECT_NEAR(k(0, 0) + k(0, 4), 0.0, 1e-9);  // equal displacements of both ends cost no energy
}
TEST(AncfCable, SmallBendingIsThatOfTheClassicalBeam) {
  expect_classical_stiffness<GreenStrain>();
  expect_classical_stiffness<EngineeringStrain>();
}

// Normal to the centre line: r = r₀ + y (−sin θ, cos θ) with the angle θ of r′, independent of the length of r′.
TEST(AncfCable, PointsOffTheAxisStandOnTheNormal) {
  auto const cable = straight<GreenStrain>();
  VecX const q = curve([](double s) { return Vec2(s, 0.4 * s * s); }, [](double s) { return Vec2(1, 0.8 * s); });
  VecX const v = VecX::Zero(q.size());
  std::array<double, 48> memory;
  MarkerKinematics<double> out;
  out.jacobian = memory.data();
  cable.evaluate_marker<double>(cable.at(0.9, -0.1), Mat3::Identity(), view(q), view(v), out);
  double const angle = std::atan(0.72);
  EXPECT_LT((out.frame.r - Vec3(0.9 + 0.1 * std::sin(angle), 0.324 - 0.1 * std::cos(angle), 0)).norm(), 1e-14);
  EXPECT_LT((out.frame.A - exp_so3<double>(Vec3(0, 0, angle))).norm(), 1e-14);
}

// A cable has neither shear nor torsional stiffness and requires no such constant.
TEST(AncfCable, NeedsNoShearStiffness) { EXPECT_NO_THROW((void)AncfCable<>::from(CableCase<GreenStrain>::bar(), 1)); }

/// Error of the k-th bending frequency of a beam of length 1 on two pins with n elements, relative to (k π)². With
/// `smooth`, linear constraint equations also make r″ continuous at the nodes between two elements [thesis §4.4].
/// \param unknowns number of unknown deflections and slopes
double frequency_error(Index n, int k, bool smooth, Index& unknowns) {
  Model<Bodies<AncfCable<>>, Joints<>> model;
  model.add(AncfCable<>::from(
      Bar{.length = 1.0, .constants = BarConstants{.EA = 1e3, .EI = 1.0, .mass_per_length = 1.0}}, n));
  Linearisation const all = linearise(model, model.reference_state());
  std::vector<Index> across;  // slopes and deflections, without those of the pins
  for (Index i = 0; i <= n; ++i) {
    if (i > 0 && i < n) across.push_back(4 * i + 1);
    across.push_back(4 * i + 3);
  }
  auto const place = [&](Index column) { return std::find(across.begin(), across.end(), column) - across.begin(); };
  // r″ at node i from the left minus r″ from the right, times l²: entries of the deflections and slopes l r′.
  double const h = 1.0 / double(n);
  MatX jump = MatX::Zero(smooth ? n - 1 : 0, Index(across.size()));
  for (Index i = 1; i <= jump.rows(); ++i)
    for (auto const& [node, deflection, slope] : {std::tuple{i - 1, 6.0, 2.0}, {i, 0.0, 8.0}, {i + 1, -6.0, 2.0}}) {
      if (node > 0 && node < n) jump(i - 1, place(4 * node + 1)) = deflection;
      jump(i - 1, place(4 * node + 3)) = slope * h;
    }
  MatX const t = smooth ? MatX(jump.fullPivLu().kernel()) : MatX::Identity(jump.cols(), jump.cols());
  unknowns = t.cols();
  MatX const stiffness = t.transpose() * all.K(across, across) * t, mass = t.transpose() * all.M(across, across) * t;
  Eigen::GeneralizedSelfAdjointEigenSolver<MatX> const modes(stiffness, mass, Eigen::EigenvaluesOnly);
  double const exact = std::pow(k * std::numbers::pi, 2);
  return std::sqrt(modes.eigenvalues()[k - 1]) / exact - 1.0;
}

// The error with continuous r′ is (k π/n)⁴/1440. Continuity of r″ removes one unknown per inner node and direction. The
// error of the same mesh increases by a third, and the error with the same number of unknowns is a tenth.
TEST(AncfCable, ContinuousCurvatureNeedsFewerUnknowns) {
  Index hermite = 0, spline = 0, finer = 0;
  double const c1 = frequency_error(8, 3, false, hermite), c2 = frequency_error(8, 3, true, spline),
               equal = frequency_error(15, 3, true, finer);
  EXPECT_EQ(hermite, 16);
  EXPECT_EQ(spline, 9);
  EXPECT_EQ(finer, 16);
  EXPECT_NEAR(c1, std::pow(3.0 * std::numbers::pi / 8.0, 4) / 1440.0, 0.05 * c1);
  EXPECT_NEAR(c2 / c1, 1.35, 0.02);
  EXPECT_NEAR(c1 / equal, 10.9, 0.2);
}

}  // namespace planar_ancf_cable_test
}  // namespace polybody
