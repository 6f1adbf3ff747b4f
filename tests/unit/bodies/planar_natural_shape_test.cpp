// Planar bars and cables with a curved natural shape: quarter circles.

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/run/marker_frames.hpp>
#include <polybody/run/probe.hpp>

#include "support/cantilever.hpp"
#include "support/held.hpp"
#include "support/refusal.hpp"

namespace polybody {
namespace planar_natural_shape_test {

constexpr double radius = 0.8, quarter = 0.5 * std::numbers::pi, EA = 4e5, GA = 3e5, EI = 90.0;

/// Bar with an arbitrary position in the plane. Its axes are rotated by 0.7 rad.
Bar bar() {
  return {.length = radius * quarter,
          .constants = BarConstants{.EA = EA, .EI = EI, .mass_per_length = 2.0, .GA = GA},
          .placement = Placement::planar(0.4, -0.3, 0.7)};
}
/// Arc to the left, or to the right if `sign` is −1.
ReferenceCurve arc(double sign = 1.0) {
  return [sign](double s) {
    double const a = s / radius;
    return Placement::planar(radius * std::sin(a), sign * radius * (1.0 - std::cos(a)), sign * a);
  };
}

template <class B>
using Arc = Cantilever<B>;
template <class B>
Arc<B> arc_under(Index n, CantileverLoad const& load) {
  return {B::naturally_curved(bar(), n, arc()), load, {.load_steps = 4, .tolerance = 1e-12}};
}

Claim exact(char const* what, char const* source, char const* formulation) {
  return {"natural shape", what, By::closed_form, source, formulation};
}

template <class B>
struct NaturalShape : testing::Test {
  static constexpr bool rod = std::is_same_v<B, planar::Lrvf>;
  static constexpr char const* name = rod ? "planar Lrvf, 16 elements"
                                      : std::is_same_v<B, planar::AncfCable<>>
                                          ? "planar AncfCable, Green strain, 16 elements"
                                          : "planar AncfCable, engineering strain, 16 elements";
};
using Beams = testing::Types<planar::Lrvf, planar::AncfCable<>, planar::AncfCable<planar::EngineeringStrain>>;
TYPED_TEST_SUITE(NaturalShape, Beams);

TYPED_TEST(NaturalShape, IsFreeOfStress) {
  TypeParam const body = TypeParam::naturally_curved(bar(), 5, arc(-1.0));
  Cantilever<TypeParam> const c(body, {}, {});
  EXPECT_LT(c.tip_displacement().norm(), 1e-13);
  EXPECT_EQ(energy(c.model, c.x).strain, 0.0);
  for (double const s : {0.0, 0.3, radius * quarter}) {
    EXPECT_LT(section_forces(c.model, c.x, c.bar.at(s)).norm(), 1e-10 * EI);
    Placement const there = arc(-1.0)(s);
    Vec3 const place = Vec3(0.4, -0.3, 0) + bar().placement.axes * there.origin;
    EXPECT_LT((position(c.model, c.x, c.bar.at(s)) - place).norm(), s == 0.3 ? 1e-2 : 1e-14);  // a chord between nodes
  }
}

// One and a half revolutions: angles are continuous through π.
TYPED_TEST(NaturalShape, CountsTurns) {
  Bar round = bar();
  round.length = 3.0 * std::numbers::pi * radius;
  Cantilever<TypeParam> const c(TypeParam::naturally_curved(round, 48, arc()), {}, {});
  EXPECT_LT(c.tip_displacement().norm(), 1e-13);
  EXPECT_EQ(energy(c.model, c.x).strain, 0.0);
}

// M = −EI/R along the bar straightens it, N = Q = 0.
TYPED_TEST(NaturalShape, IsStraightUnderTheMomentOfItsCurvature) {
  auto const c = arc_under<TypeParam>(16, {.moment = -EI / radius});
  char const* const name = TestFixture::name;
  double const off = this->rod ? 1e-11 : 2e-6, angle = c.tip()[2];
  held(exact("angle of the tip that EI/R straightens [rad]", "0.7, as the clamp", name), angle, 0.7, off);
  held(exact("length of the chord that EI/R straightens [m]", "R π/2", name),
       (c.tip() - Vec3(0.4, -0.3, 0.7)).template head<2>().norm(), radius * quarter, this->rod ? 5.1e-4 : 1e-6);
  held(exact("energy of the arc that EI/R straightens [J]", "EI L/(2R²)", name), energy(c.model, c.x).strain,
       0.5 * EI * quarter / radius, 1e-6 * EI);
  held(exact("bending moment of the straight arc [N m]", "−EI/R", name),
       section_forces(c.model, c.x, c.bar.at(0.4 * radius))[5], -EI / radius, 1e-3 * EI);
}

// Tip of the quarter circle under P, towards the centre or away from it. Castigliano's theorem with M = P R sin φ, N
// = −P sin φ, Q = P cos φ at φ from the tip: u = (π/4) P R (R²/EI + 1/EA + 1/GA)  [Timoshenko, Strength of
// Materials]. The curvature of Green strain is per deformed length, θ′/(1 + ε). EA then resists N + M/R, which is
// zero here. The chords of Lrvf have an error of (l/R)²/4.
TYPED_TEST(NaturalShape, YieldsToARadialForceAsCastiglianoSays) {
  double const force = 1e-3;
  Vec3 const along = bar().placement.axes * Vec3(1, 0, 0);
  auto const yields = [&](Index n) {
    return arc_under<TypeParam>(n, {.force = {force * along[0], force * along[1]}}).tip_displacement().dot(along);
  };
  bool const green = std::is_same_v<TypeParam, planar::AncfCable<>>;
  double const exactly =
      0.5 * quarter * force * radius * (radius * radius / EI + (green ? 0.0 : 1.0 / EA) + (this->rod ? 1.0 / GA : 0.0));
  double const coarse = yields(16), fine = yields(32);
  held(exact("tip of a quarter circle under a radial force [m]",
             green ? "Castigliano, (π/4) P R³/EI" : "Castigliano, (π/4) P R (R²/EI + 1/EA + 1/GA)", TestFixture::name),
       coarse, exactly, (this->rod ? 1.02 * std::pow(quarter / 16.0, 2) / 4.0 : 1e-5) * exactly);
  if (this->rod) {
    EXPECT_NEAR((4.0 * fine - coarse) / 3.0, exactly, 1e-5 * exactly);
  }
}

TYPED_TEST(NaturalShape, IsRefusedWhereItIsNoCurve) {
  EXPECT_TRUE(has(refusal([] { TypeParam::naturally_curved(bar(), 4, {}); }), "curve is an empty function"));
  auto const twice = [](double s) { return arc()(2.0 * s); };  // not a function of its arc length
  EXPECT_TRUE(has(refusal([&] { TypeParam::naturally_curved(bar(), 4, twice); }),
                  "Parametrise the reference curve by its arc length"));
  auto const rising = [](double s) { return Placement::at({s, 0, 0.1 * s}); };
  EXPECT_TRUE(has(refusal([&] { TypeParam::naturally_curved(bar(), 4, rising); }), "plane"));
}

}  // namespace planar_natural_shape_test
}  // namespace polybody
