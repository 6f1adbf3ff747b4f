// Cantilevers in space with Se3Beam, compared with closed forms and with an independent computation of the exact rod
// with the same constants: end moments (S5), Princeton beam (S6), 45° bend (S7), pre-twisted cantilever (S8), quarter
// circle (S8b), helix of five turns (S9f). Elements are of order 2.

#include <polybody/bodies/se3/se3_beam.hpp>

#include <gtest/gtest.h>

#include <polybody/run/energy.hpp>

#include "support/spatial_rods.hpp"

using namespace polybody;

namespace se3_beam_statics_test {

using namespace spatial_rods;
using Rod = SpatialCantilever<Se3Beam>;

// ---- S1: roll-up. One element is exact up to half a circle.
TEST(Se3RollUp, FewElementsBecomeTheCircle) {
  struct {
    Index elements;
    double theta;
    char const* name;
  } const arcs[] = {{1, 0.5 * pi, "Se3Beam, 1 element"}, {3, 2 * pi, "Se3Beam, 3 elements"}};
  for (auto const& [n, theta, name] : arcs)
    for (double const axis : {0.0, 1.3}) {
      Vec3 const about(0, -std::sin(axis), std::cos(axis)), across(0, std::cos(axis), std::sin(axis));
      Rod const rod(Se3Beam::from(rolled_bar(), n), {.moment = theta * about}, {.load_steps = 10});
      Claim const arc{"S1", "tip of the bar rolled up about any axis, and its turn", By::closed_form,
                      "arc of curvature M/EI", name};
      Vec3 const exact = std::sin(theta) / theta * Vec3::UnitX() + (1 - std::cos(theta)) / theta * across;
      Instance const at{equals("θ", theta) + equals(", axis", axis), 1.0};
      held_within(arc, (rod.tip() - exact).norm(), 1e-10, at);
      held_within(arc, (rod.tip_turn() - exp_so3<double>(theta * about)).norm(), 1e-9, at);
    }
}

// ---- S5: end moments of Nachbagauer, Gruber & Gerstmayr 2013

TEST(Se3EndMoments, MeetTheExactRod) {
  meets_the_exact_dead_moments<Se3Beam>("Se3Beam");
  meets_the_exact_following_moments<Se3Beam>("Se3Beam");
}

// ---- S6: the Princeton beam of Dowell & Traybar 1975

TEST(Se3PrincetonBeam, MeetsTheExactRod) { meets_the_exact_princeton_beam<Se3Beam>("Se3Beam"); }

// ---- S7: the 45° bend of Bathe & Bolourchi

// S7 gives its tolerances for 8 and 32 straight elements. Helices need 10 and 40. With 8 elements the largest errors
// are 0.41 % at 3000 N and 0.31 % at 300 N; those of Lrvf are 0.24 % and 0.29 %. The error of z at 3000 N is −20 m/n²
// with n elements, that of Lrvf −9 m/n². The chords of Lrvf have the length of the arcs. They lengthen the beam and
// compensate a part of the stiffness of constant strains.
TEST(Se3FortyFiveDegreeBend, MeetsTheExactRod) { meets_the_exact_bend<Se3Beam>("Se3Beam", 10); }

// Piecewise helices are motions of the exact rod, with its strain energy. The potential energy of each mesh therefore
// lies above that of the exact rod, and decreases if elements are halved: the beam is too stiff.
TEST(Se3FortyFiveDegreeBend, PotentialEnergyDecreasesToThatOfTheRod) {
  auto const potential = [](Index n) {
    auto const rod = bend<Se3Beam>(n, bends[2]);
    return energy(rod.model, rod.x).strain - bends[2].force * rod.tip()[2];
  };
  double const a = potential(8), b = potential(16), c = potential(32), limit = (4.0 * c - b) / 3.0;
  EXPECT_GT(a, b);
  EXPECT_GT(b, c);
  EXPECT_NEAR((a - limit) / (b - limit), 4.0, 0.05);
}

// ---- S8: the pre-twisted cantilever of MacNeal & Harder 1985, linear

TEST(Se3PreTwistedCantilever, MeetsTheExactRod) { meets_the_exact_twisted_rod<Se3Beam>("Se3Beam"); }

// ---- S8b: a quarter circle under unit forces, linear, by Castigliano's theorem

TEST(Se3CurvedCantilever, BendsAsCastiglianoSays) { bends_as_castigliano_says<Se3Beam>("Se3Beam"); }

// ---- S9f: cantilever of Ibrahimbegović 1997, wound into a helix

TEST(Se3CantileverToHelix, MeetsTheExactRodThroughFiveTurns) {
  struct {
    double lambda;
    Vec3 tip;
  } const windings[] = {{0.1, {0.410203353, 0.053770903, -1.091729019}},
                        {0.5, {0.019106995, 0.000573980, -0.226637441}}};
  Bar const bar{.length = 10.0,
                .constants = BarConstants{.EA = 1e4, .EI = 100, .mass_per_length = 1, .GA = 1e4, .GJ = 100}};
  for (auto const& [lambda, exact] : windings) {
    auto const tip = [&](Index n) {
      return Rod(Se3Beam::from(bar, n), {.force = {0, 0, 50 * lambda}, .moment = {0, 0, 200 * pi * lambda}},
                 {.load_steps = int(100 * lambda)})
          .tip();
    };
    Vec3 const coarse = tip(50), fine = tip(100);
    Instance const at{equals("λ", lambda), exact.norm()};
    held_within(exact_rod("S9f", "tip of the helix [m]", "Se3Beam, 100 elements"), (fine - exact).norm(), 5e-3, at);
    held_within(exact_rod("S9f", "tip of the helix [m]", "Se3Beam, 50 and 100 elements extrapolated"),
                ((4.0 * fine - coarse) / 3.0 - exact).norm(), 1e-4, at);
  }
}

}  // namespace se3_beam_statics_test
