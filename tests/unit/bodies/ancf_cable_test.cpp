#include <polybody/bodies/ancf/ancf_cable.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/shared/element_batches.hpp>
#include <polybody/testing/flexible_body_laws.hpp>

#include "support/refusal.hpp"

namespace polybody {
using namespace laws;
namespace ancf_cable_test {

template <class Strain>
struct SpatialCableCase {
  static Bar bar() {
    return {.length = 1.3,
            .constants = BarConstants{.EA = 900, .EI = 40, .mass_per_length = 2.0},
            .placement = Placement::at({0.4, -0.3, 0.2}, {0.3, -0.5, 0.9}),
            .damping = {.axial = 0.01, .bending = 0.03}};
  }
  static AncfCable<Strain> body(Bar const& bar) { return AncfCable<Strain>::from(bar, 2); }
};
bool const ancf_cable_obey[] = {
    obeys<SpatialCableCase<GreenStrain>, BodyLaws, FlexibleBodyLaws>("SpatialGreenCable"),
    obeys<SpatialCableCase<EngineeringStrain>, BodyLaws, FlexibleBodyLaws>("SpatialEngineeringCable")};

static_assert(IdenticalElements<AncfCable<>>);

// A bar in the plane z = 0 agrees with the planar cable in mass, force and tangent.
template <class Strain>
void expect_planar_numbers() {
  Bar bar = SpatialCableCase<Strain>::bar();
  bar.placement = Placement::planar(0.4, -0.3, 0.7);
  bar.pretension = 12.0;
  auto const space = AncfCable<Strain>::from(bar, 3);
  auto const plane = planar::AncfCable<Strain>::from(bar, 3);
  VecX q(plane.coordinates()), v = q, r = VecX::Zero(space.coordinates()), w = r;
  plane.reference(mutable_view(q));
  for (Index i = 0; i < q.size(); ++i) {
    q[i] += 0.2 * std::sin(3.0 * double(i));
    v[i] = std::cos(2.0 * double(i));
  }
  auto const lifted = [](Index i) { return i / 2 * 3 + i % 2; };  // (x, y) of a node's vector
  for (Index i = 0; i < q.size(); ++i) {
    r[lifted(i)] = q[i];
    w[lifted(i)] = v[i];
  }
  for (Index e = 0; e < 3; ++e) {
    Vec<double, 8> f;
    Vec<double, 12> g;
    Mat<double, 8, 8> k, m;
    Mat<double, 12, 12> l, n;
    plane.template force<double>(e, view(q), view(v), f);
    space.template force<double>(e, view(r), view(w), g);
    plane.tangent(e, view(q), view(v), 0.7, 0.1, k);
    space.tangent(e, view(r), view(w), 0.7, 0.1, l);
    plane.mass(e, view(q), m);
    space.mass(e, view(r), n);
    EXPECT_NEAR(plane.strain_energy(e, view(q)), space.strain_energy(e, view(r)), 1e-12);
    for (Index i = 0; i < 8; ++i) {
      EXPECT_NEAR(g[lifted(i)], f[i], 1e-12 * f.norm());
      for (Index j = 0; j < 8; ++j) {
        EXPECT_NEAR(l(lifted(i), lifted(j)), k(i, j), 1e-12 * k.norm());
        EXPECT_NEAR(n(lifted(i), lifted(j)), m(i, j), 1e-15 * m.norm());
      }
    }
    for (Index i = 0; i < 4; ++i) EXPECT_NEAR(g[3 * i + 2], 0.0, 1e-12 * f.norm());  // no component out of the plane
  }
}
TEST(SpatialCable, InAPlaneEqualsThePlanarCable) {
  expect_planar_numbers<GreenStrain>();
  expect_planar_numbers<EngineeringStrain>();
}

VecX of(AncfCable<> const& cable) {
  VecX q(cable.coordinates());
  cable.reference(mutable_view(q));
  return q;
}

// Mass matrix of Wallin 2016, Eq. 3.18, (ρA l/420) [156, 22l, 54, −13l; …] for each component.
TEST(SpatialCable, MassIsThatOfTheThesis) {
  AncfCable<> const cable =
      AncfCable<>::from({.length = 1.4, .constants = BarConstants{.EA = 900, .EI = 40, .mass_per_length = 3.0}}, 2);
  double const l = 0.7;
  Mat<double, 4, 4> expected;
  expected << 156, 22 * l, 54, -13 * l, 22 * l, 4 * l * l, 13 * l, -3 * l * l, 54, 13 * l, 156, -22 * l, -13 * l,
      -3 * l * l, -22 * l, 4 * l * l;
  expected *= 3.0 * l / 420.0;
  Mat<double, 12, 12> m;
  cable.mass(0, view(of(cable)), m);
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 12; ++j) EXPECT_NEAR(m(i, j), i % 3 == j % 3 ? expected(i / 3, j / 3) : 0.0, 1e-15);
}

// A helix of radius a and rise 2πb per revolution has the curvature a/(a² + b²). Its derivative by arc length is a
// unit tangent.
TEST(SpatialCable, KnowsTheCurvatureOfAHelix) {
  double const a = 2.0, b = 0.5, c = std::hypot(a, b), length = 4.0;
  auto const helix = [&](double s) {
    double const u = s / c;
    Placement p;
    p.origin = Vec3(a * std::cos(u), a * std::sin(u), b * u);
    p.axes.col(0) = Vec3(-a * std::sin(u), a * std::cos(u), b) / c;
    p.axes.col(1) = Vec3(-std::cos(u), -std::sin(u), 0.0);
    p.axes.col(2) = p.axes.col(0).cross(p.axes.col(1));
    return p;
  };
  AncfCable<> const cable = AncfCable<>::from(
      {.length = length, .constants = BarConstants{.EA = 900, .EI = 40, .mass_per_length = 1.0}}, 16, helix);
  VecX const q = of(cable);
  double const bound =
      std::pow(length / 16, 2) / 12.0 * a / std::pow(c, 4);  // error of r″ of a cubic Hermite interpolant: l²/12 |r⁗|
  for (double const s : {0.3, 1.1, 2.7, 3.9}) {
    Vec6 const strains = cable.section_strains(cable.at(s), view(q)),
               forces = cable.section_forces(cable.at(s), view(q));
    MarkerKinematics<double> marker;
    std::array<double, 72> jacobian;
    VecX const rest = VecX::Zero(q.size());
    marker.jacobian = jacobian.data();
    cable.evaluate_marker<double>(cable.at(s), Mat3::Identity(), view(q), view(rest), marker);
    Vec3 const kappa = marker.frame.A * strains.tail<3>();
    EXPECT_NEAR(kappa.norm(), a / (a * a + b * b), bound) << s;
    EXPECT_NEAR(kappa.dot(helix(s).axes.col(2)), kappa.norm(), 1e-5) << s;  // about the binormal
    EXPECT_LT(strains.head<4>().norm(), 1e-6) << s;
    EXPECT_LT((forces - Vec6{{900, 0, 0, 0, 40, 40}}.cwiseProduct(strains)).norm(), 1e-12);
  }
}

TEST(SpatialCable, PretensionPullsAtTheEnds) {
  Bar bar{.length = 2.0, .constants = BarConstants{.EA = 900, .EI = 40, .mass_per_length = 1.0}, .pretension = 30.0};
  AncfCable<> const cable = AncfCable<>::from(bar, 2);
  VecX const q = of(cable), rest = VecX::Zero(q.size());
  Vec<double, 12> f;
  cable.force<double>(0, view(q), view(rest), f);
  EXPECT_NEAR(f[0], 30.0, 1e-12);  // the pretension shortens the cable
  EXPECT_NEAR(f[6], -30.0, 1e-12);
  EXPECT_NEAR(cable.section_forces(cable.at(0.7), view(q))[0], 30.0, 1e-12);
}

// A bent cable that spins about its own axis has no damping, although it has no coordinate of roll. A straight cable
// with κ = 0 has none either.
TEST(SpatialCable, SpinAboutItselfIsNotDamped) {
  Bar const bar{.length = 2.0,
                .constants = BarConstants{.EA = 900, .EI = 40, .mass_per_length = 1.0},
                .damping = {.axial = 0.1, .bending = 0.1}};
  AncfCable<> const cable = AncfCable<>::from(bar, 3);
  VecX q = of(cable), v(q.size());
  for (double const bend : {0.0, 0.3}) {
    for (Index i = 0; i <= 3; ++i) {
      q[6 * i + 1] = bend * std::sin(double(i));
      q[6 * i + 4] = bend * std::cos(double(i));
    }
    cable.rigid_velocity(view(q), Vec3::Zero(), Vec3(7.0, 0.0, 0.0), mutable_view(v));
    for (Index e = 0; e < 3; ++e) {
      Vec<double, 12> moving, still;
      VecX const rest = VecX::Zero(q.size());
      cable.force<double>(e, view(q), view(v), moving);
      cable.force<double>(e, view(q), view(rest), still);
      EXPECT_LT((moving - still).norm(), 1e-13 * (1.0 + still.norm())) << bend;
    }
  }
}

TEST(SpatialCable, RefusesWhatCannotBeMeant) {
  Bar bar{.length = 2.0, .constants = BarConstants{.EA = 900, .EI = 40, .mass_per_length = 1.0}};
  EXPECT_TRUE(has(refusal([&] { AncfCable<>::from(bar, 0); }), "AncfCable: at least one element"));
  auto const too_fast = [](double s) { return Placement::at({1.5 * s, 0, 0}); };
  EXPECT_TRUE(
      has(refusal([&] { AncfCable<>::from(bar, 4, too_fast); }), "element 1, counted from 1, has a strain of "));
  bar.pretension = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(has(refusal([&] { AncfCable<>::from(bar, 1); }), "the pretension must be finite"));
  bar.pretension = 0.0;
  bar.constants->EA = -1.0;
  EXPECT_TRUE(has(refusal([&] { AncfCable<>::from(bar, 1); }), "EA must be positive"));
}

}  // namespace ancf_cable_test
}  // namespace polybody
