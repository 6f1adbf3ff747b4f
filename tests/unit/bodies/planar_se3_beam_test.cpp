#include <polybody/bodies/se3/planar_se3_beam.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/se3/se3_beam.hpp>
#include <polybody/testing/flexible_body_laws.hpp>

#include "support/refusal.hpp"

namespace polybody {
using namespace laws;
namespace planar_se3_beam_test {

struct Case {
  static Bar bar() {
    return {.length = 1.3,
            .constants =
                BarConstants{.EA = 900, .EI = 40, .mass_per_length = 2.0, .GA = 300, .GJ = 25, .rotary_inertia = 0.05},
            .placement = Placement::planar(0.4, -0.3, 0.7),
            .damping = {.axial = 0.01, .shear = 0.02, .bending = 0.03}};
  }
  static planar::Se3Beam body(Bar const& bar) { return planar::Se3Beam::from(bar, 3); }
};
bool const obeyed = obeys<Case, BodyLaws, FlexibleBodyLaws>("planar::Se3Beam");

/// Nodes of n elements with the strains (ε, γ, κ) along a bar of length 1.3 m.
VecX arc(Index n, Vec3 const& strains) {
  VecX q(3 * (n + 1));
  for (Index i = 0; i <= n; ++i) {
    double const s = 1.3 * double(i) / double(n);
    auto const h = exp_se3<double>({s * Vec3(1.0 + strains[0], strains[1], 0), s * Vec3(0, 0, strains[2])});
    q.segment<3>(3 * i) = Vec3(h.r[0], h.r[1], s * strains[2]);
  }
  return q;
}
Bar straight_bar() {
  Bar bar = Case::bar();
  bar.placement = {};
  return bar;
}

// Each mesh measures the strains of an arc exactly, up to nearly a full turn of one element.
TEST(PlanarSe3Beam, ConstantStrainsAreExactWithAnyMesh) {
  for (Vec3 const& strains : {Vec3(0.02, 0.1, 0), Vec3(0, 0, 4.6), Vec3(0.03, -0.05, -2.1), Vec3(1e-9, 0, 1e-9)})
    for (Index const n : {1, 2, 5}) {
      planar::Se3Beam const beam = planar::Se3Beam::from(straight_bar(), n);
      VecX const q = arc(n, strains);
      for (double const s : {0.0, 0.5, 1.3})
        EXPECT_LT((beam.strains<0>(beam.at(s), view(q)) - strains).norm(), 2e-14 * double(n));
    }
}

// Sections lie on the arc between the nodes.
TEST(PlanarSe3Beam, SectionsOfOneElementLieOnTheArc) {
  Vec3 const strains(0.03, -0.05, -2.1);
  planar::Se3Beam const beam = planar::Se3Beam::from(straight_bar(), 1);
  VecX const q = arc(1, strains), rest = VecX::Zero(6);
  for (double const s : {0.0, 0.2, 0.65, 1.3}) {
    auto const line = beam.centre_line<double>(beam.at(s), view(q), view(rest));
    auto const h = exp_se3<double>({s * Vec3(1.0 + strains[0], strains[1], 0), s * Vec3(0, 0, strains[2])});
    EXPECT_LT((line.r - h.r.head<2>()).norm(), 1e-14) << s;
    EXPECT_NEAR(line.angle, s * strains[2], 1e-14) << s;
  }
}

// Forces of the beam in space, in a plane motion. Mass matrices differ in the rotary inertia, which the planar beam
// distributes along the element.
TEST(PlanarSe3Beam, ForceIsThatOfTheBeamInSpace) {
  planar::Se3Beam const flat = planar::Se3Beam::from(straight_bar(), 1);
  Se3Beam const beam = Se3Beam::from(straight_bar(), 1);
  VecX const q = (VecX(6) << 0.1, -0.2, 0.3, 1.2, 0.5, 1.4).finished();
  VecX const v = (VecX(6) << 0.3, 0.1, -0.8, 1.1, -0.4, 0.9).finished();
  VecX in_space(14), v_space = VecX::Zero(12);
  for (Index i = 0; i < 2; ++i) {
    in_space.segment<3>(7 * i) = Vec3(q[3 * i], q[3 * i + 1], 0);
    in_space.segment<4>(7 * i + 3) = quaternion_exp<double>(Vec3(0, 0, q[3 * i + 2]));
    v_space.segment<2>(6 * i) = v.segment<2>(3 * i);
    v_space[6 * i + 5] = v[3 * i + 2];
  }
  Vec<double, 6> f;
  Vec<double, 12> expected;
  flat.force<double>(0, view(q), view(v), f);
  beam.force<double>(0, view(in_space), view(v_space), expected);
  for (Index i = 0; i < 2; ++i)
    EXPECT_LT((f.segment<3>(3 * i) - Vec3(expected[6 * i], expected[6 * i + 1], expected[6 * i + 5])).norm(), 1e-11);
  EXPECT_GT(f.norm(), 10.0);
  EXPECT_NEAR(flat.strain_energy(0, view(q)), beam.strain_energy(0, view(in_space)), 1e-12);
}

// g = (φ/2)/sin(φ/2), differentiated twice, on both sides of the angles at which `Growth` changes its formula.
TEST(PlanarSe3Beam, FactorOfTheChordHasItsDerivatives) {
  for (double const phi : {0.1, 0.199, 0.201, 1.0, 1.99, 2.01, 3.0, -3.0, 5.0}) {
    planar::CircularArc::Growth<double> const by(phi);
    double const s = std::sin(0.5 * phi), c = std::cos(0.5 * phi) / s;
    EXPECT_NEAR(by.g, 0.5 * phi / s, 1e-13) << phi;
    EXPECT_NEAR(by.dg, (0.5 - 0.25 * phi * c) / s, 1e-13) << phi;
    EXPECT_NEAR(by.ddg, (0.125 * phi + (0.25 * phi * c - 0.5) * c) / s, 1e-11) << phi;
    SimdVector<> lanes(0.1);
    lanes.set(1, phi);
    planar::CircularArc::Growth<SimdVector<>> const two(lanes);
    EXPECT_NEAR(two.g[1], by.g, 1e-15) << phi;
    EXPECT_NEAR(two.ddg[1], by.ddg, 1e-13) << phi;
    EXPECT_NEAR(two.dg[0], planar::CircularArc::Growth<double>(0.1).dg, 1e-16) << phi;
  }
}

TEST(PlanarSe3Beam, NaturallyCurvedArcIsFreeOfStress) {
  auto const curve = [](double s) {
    return Placement::planar(std::sin(2.0 * s) / 2.0, (1.0 - std::cos(2.0 * s)) / 2.0, 2.0 * s);
  };
  planar::Se3Beam const beam = planar::Se3Beam::naturally_curved(straight_bar(), 2, curve);
  VecX q(9), rest = VecX::Zero(9);
  beam.reference(mutable_view(q));
  Vec<double, 6> f;
  beam.force<double>(1, view(q), view(rest), f);
  EXPECT_LT(f.norm(), 1e-12);
  EXPECT_LT((beam.strains<0>(beam.at(0.7), view(arc(2, Vec3(0.01, 0, 2.5)))) - Vec3(0.01, 0, 0.5)).norm(), 1e-13);
}

TEST(PlanarSe3Beam, RefusesWhatItCannotMean) {
  Bar bar = Case::bar();
  bar.constants->GA = 0.0;
  EXPECT_TRUE(has(refusal([&] { (void)planar::Se3Beam::from(bar, 3); }), "planar::Se3Beam: the shear stiffness GA"));
  EXPECT_TRUE(has(refusal([&] { (void)planar::Se3Beam::from(Case::bar(), 0); }), "at least one element"));
  EXPECT_TRUE(has(refusal([&] { (void)planar::Se3Beam::from(Case::bar(), 3).at(2.0); }), "lies outside the body"));
  auto const still = [](double) { return Placement{}; };  // elements of length zero
  EXPECT_TRUE(has(refusal([&] { (void)planar::Se3Beam::from(Case::bar(), 3, still); }),
                  "planar::Se3Beam: element 1, counted from 1, has a strain of -1, but the limit is 0.1"));
  EXPECT_TRUE(has(refusal([&] { (void)planar::Se3Beam::naturally_curved(Case::bar(), 3, still); }),
                  "Parametrise the reference curve by its arc length"));
}

}  // namespace planar_se3_beam_test
}  // namespace polybody
