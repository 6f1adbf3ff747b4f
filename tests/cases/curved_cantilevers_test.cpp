// Beams in space: roll-up by a tip moment (S1), inclined cantilever (S4b), and the twisted (S8) and curved (S8b)
// beams of MacNeal & Harder 1985.

#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>

#include <gtest/gtest.h>

#include "support/solver_instances.hpp"
#include "support/spatial_rods.hpp"

using namespace polybody;

namespace curved_cantilevers_test {

using namespace spatial_rods;

// ---- S1: roll-up by a moment about any axis across the bar, θ = M L/EI

/// L = EI = 1. \return the tip along the bar, across it and out of the plane of bending, and the error of its
/// rotation θ
template <class B>
Vec4 rolled(Index n, double theta, double axis) {
  Vec3 const about(0, -std::sin(axis), std::cos(axis)), across(0, std::cos(axis), std::sin(axis));
  SpatialCantilever<B> const c(B::from(rolled_bar(), n), {.moment = theta * about}, {.load_steps = 10});
  Mat3 const beyond = c.tip_turn() * exp_so3<double>(-theta * about);
  return {c.tip()[0], c.tip().dot(across), c.tip().dot(about), log_so3(beyond).norm()};
}

// The nodes of n elements form a regular polygon with sides of length 1/n. The angle between adjacent sides is θ/n. A
// half circle ends at 1/(n sin(π/2n)) above the root, a full one at the root.
TEST(RollUpInSpace, LrvfBecomesAPolygon) {
  for (double const axis : {0.0, 1.3}) {
    Claim const polygon{"S1", "tip of the bar rolled up about any axis, and its turn", By::closed_form,
                        "regular polygon of chords", "Lrvf, 10 elements"};
    std::string const about = equals("axis", axis);
    held_within(polygon, (rolled<Lrvf<>>(10, pi, axis) - Vec4(0, 0.1 / std::sin(0.05 * pi), 0, 0)).norm(), 1e-9,
                {"half a circle, " + about, 1.0});
    held_within(polygon, rolled<Lrvf<>>(10, 2 * pi, axis).norm(), 1e-9, {"full circle, " + about, 1.0});
  }
}

// Convergence to the exact half circle, which ends at (0, 2/π). Sections follow r_y. An element that bends about an
// axis other than y or z also leaves the plane slightly.
TEST(RollUpInSpace, AncfBeamConvergesToTheCircle) {
  Vec4 const exact(0, 2 / pi, 0, 0), coarse = rolled<AncfBeam<>>(16, pi, 0.7), fine = rolled<AncfBeam<>>(32, pi, 0.7);
  EXPECT_NEAR((coarse - exact).norm() / (fine - exact).norm(), 4.0, 0.2);
  held_within({"S1", "tip of the bar rolled up about any axis, and its turn", By::closed_form,
               "half a circle, κ = M/EI", "AncfBeam, 16 and 32 elements extrapolated"},
              ((4 * fine - coarse) / 3 - exact).norm(), 5e-5, {.scale = 1.0});
}

// ---- S4b: at 45° under force and moment at the tip

Vec3 inclined(Index n, Mat3& turn) {
  double const force = 6.25e7 * std::sqrt(0.5);
  Bar const bar{.length = 2.0,
                .section = Rectangle{.height = 0.5, .width = 0.1},
                .material = Material{.density = 7850, .young = 2.07e11, .poisson = 0.3},
                .placement = Placement::planar(0, 0, 0.25 * pi)};
  TipLoad const load{.force = {force, -force, 0}, .moment = {0, 0, -5e8}};
  SpatialCantilever<Lrvf<>> const c(Lrvf<>::from(bar, n), load, {.load_steps = 10});
  turn = c.tip_turn();
  return c.tip_displacement();
}

// The reference is an independent computation of the exact rod. Sixteen elements have a published error of 0.1 %.
TEST(InclinedBeamInSpace, LrvfConvergesToTheExactRod) {
  Mat3 turn;
  Vec3 const exact(-1.197374069, -2.209408446, 0);
  auto const claim = [](char const* what, char const* mesh) {
    return Claim{"S4b", what, By::independent, "shooting on the rod's equations", mesh};
  };
  held_within(claim("tip of the inclined beam in space [m]", "Lrvf, 16 elements"), (inclined(16, turn) - exact).norm(),
              2e-3 * exact.norm(), {.scale = exact.norm()});
  Vec3 const limit = (4 * inclined(128, turn) - inclined(64, turn)) / 3;
  held_within(claim("tip of the inclined beam in space [m]", "Lrvf, 64 and 128 elements extrapolated"),
              (limit - exact).cwiseAbs().maxCoeff(), 1e-7, {.scale = exact.norm()});
  inclined(128, turn);
  held_within(claim("turn of the inclined beam's tip", "Lrvf, 128 elements"),
              (turn - exp_so3<double>(Vec3(0, 0, -4.306675415))).norm(), 1e-3, {.scale = 1.0});
}

// ---- S8: twisted by 90°

// The tolerance is the digits of the table: eight, along x three. Three meshes remove the errors in h² and h⁴ by
// extrapolation.
TEST(AncfPreTwistedCantilever, MeetsTheExactRod) {
  auto const limit = [](Vec3 const& force) {
    auto const tip = [&](Index n) { return twisted_tip<AncfBeam<>>(n, force, 0.01); };
    return Vec3((64 * tip(64) - 20 * tip(32) + tip(16)) / 45);
  };
  Vec3 const y = limit({0, 1, 0}), z = limit({0, 0, 1});
  auto const claim = [](char const* what) {
    return Claim{"S8", what, By::independent, "shooting on the rod's equations",
                 "AncfBeam, 16, 32 and 64 elements extrapolated"};
  };
  Claim const along = claim("shortening of the pre-twisted beam under a unit force"),
              across = claim("tip of the pre-twisted beam across, under a unit force");
  held(along, y[0], twisted_by_y[0], 5e-9, {"F along y"});
  held(along, z[0], twisted_by_z[0], 5e-9, {"F along z"});
  held_within(across, (y - twisted_by_y).tail<2>().norm(), 3e-10, {"F along y", 5.4e-3});
  held_within(across, (z - twisted_by_z).tail<2>().norm(), 3e-10, {"F along z", 1.7e-3});
}

// ---- S8b: a quarter circle

// The published 0.08734 and 0.5022 are reproduced to 1.5 % and 0.4 %.
template <class B>
void bends_as_published(std::string const& body) {
  Vec2 const tip = bends_as_castigliano_says<B>(body);
  Claim const published{"S8b", "tip of the quarter circle along its unit force", By::published, "MacNeal & Harder 1985",
                        body + ", 32 and 64 elements extrapolated"};
  held(published, tip[0], 0.08734, 0.015 * 0.08734, {"in the plane"});
  held(published, tip[1], 0.5022, 0.004 * 0.5022, {"out of the plane"});
}
TEST(CurvedCantilever, LrvfBendsAsCastiglianoSays) { bends_as_published<Lrvf<>>("Lrvf"); }
TEST(CurvedCantilever, AncfBeamBendsAsCastiglianoSays) { bends_as_published<AncfBeam<>>("AncfBeam"); }

}  // namespace curved_cantilevers_test
