// Frequencies of a thick beam and of a slender one in space with shear and rotary inertia (E2). References are an
// independent computation and, for some meshes, published values. In a square section every bending mode occurs twice
// and other modes occur once. This distinguishes bending from torsion and stretch.

#include <polybody/vibration/modes.hpp>

#include <gtest/gtest.h>

#include <numbers>

#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/se3/se3_beam.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/standard_joints.hpp>

#include "support/held.hpp"

using namespace polybody;

namespace timoshenko_spatial_test {

using Clamp = Joint<Weld, Constraint>;
using Ball = Joint<Spherical, Constraint>;
using Line = AncfBeam<ElasticLine>;
using Cured = AncfBeam<Continuum<>>;
/// Model type for all bodies, which is compiled once.
using Beams = Model<Bodies<Lrvf<>, Se3Beam, Line, Cured>, Joints<Clamp, Ball>>;

enum class Ends { pinned_pinned, clamped_free, free_free };
char const* name_of(Ends ends) {
  return ends == Ends::pinned_pinned ? "pinned–pinned" : ends == Ends::clamped_free ? "clamped–free" : "free–free";
}
template <class B>
std::string name_of(Index n) {
  char const* const body = std::is_same_v<B, Lrvf<>>    ? "Lrvf, "
                           : std::is_same_v<B, Se3Beam> ? "Se3Beam, "
                           : std::is_same_v<B, Line>    ? "AncfBeam, "
                                                        : "AncfBeam<Continuum>, ";
  return body + std::to_string(n);
}
char const* const timoshenko = "roots of Timoshenko's characteristic equation";

/// Cowper's shear factor for ν = 0.3 is the k of E2, and J is Saint-Venant's.
Bar thick() {
  return {.length = 2.0,
          .section = Rectangle{.height = 0.4, .width = 0.4},
          .material = Material{.density = 7850, .young = 1e9, .poisson = 0.3},
          .placement = Placement::at({1, 2, 3}, {0.4, -0.9, 1.7})};
}

/// E2 (b) with its own k = 5/6 and the same J.
Bar slender() {
  double const e = 2.1e11, rho = 7850, h = 0.05, a = h * h, i = a * a / 12.0;
  return {.length = 1.0,
          .constants = BarConstants{.EA = e * a,
                                    .EI = e * i,
                                    .mass_per_length = rho * a,
                                    .GA = e / 2.6 * a * 5.0 / 6.0,
                                    .GJ = e / 2.6 * 0.1405770150 * a * a,
                                    .rotary_inertia = rho * i},
          .placement = thick().placement};
}

struct Frequencies {
  std::vector<double> bending;  ///< each listed once
  std::vector<double> single;   ///< torsion and stretch
};

/// Frequencies in ascending order [rad/s] without rigid motions: all six, or the rotation about the axis between
/// balls.
template <class B>
Frequencies frequencies(Index n, Ends ends, Bar const& bar = thick()) {
  Beams model;
  auto const beam = model.add(B::from(bar, n), "beam");
  Placement const& place = bar.placement;
  double const length = bar.length;
  if (ends == Ends::clamped_free) model.connect(Clamp{}, model.ground().at(place), beam.at(0.0));
  if (ends == Ends::pinned_pinned) {
    model.connect(Ball{}, model.ground().at(place.origin), beam.at(0.0));
    model.connect(Ball{}, model.ground().at(place.origin + length * place.axes.col(0)), beam.at(length));
  }
  VecX const w = modes(model, model.reference_state(), 16).frequency;
  Index i = ends == Ends::free_free ? 6 : ends == Ends::pinned_pinned ? 1 : 0;
  EXPECT_LT(w.head(i).cwiseAbs().sum(), 1e-4 * w[i]);
  Frequencies out;
  while (i + 1 < w.size()) {
    bool const twins = w[i + 1] - w[i] < 1e-6 * w[i];
    (twins ? out.bending : out.single).push_back(w[i]);
    i += twins ? 2 : 1;
  }
  return out;
}

struct Row {
  Ends ends;
  double bending[2];
};
Row const rows[] = {{Ends::pinned_pinned, {95.6339808811, 332.234513637}},
                    {Ends::clamped_free, {35.1471170634, 189.630725571}},
                    {Ends::free_free, {204.165814718, 477.907465926}}};

/// Richardson extrapolation of n and 2n elements of order 2.
double limit(double coarse, double fine) { return (4.0 * fine - coarse) / 3.0; }

template <class B>
void bends(Index n) {
  for (Row const& row : rows) {
    Frequencies const coarse = frequencies<B>(n, row.ends), fine = frequencies<B>(2 * n, row.ends);
    for (std::size_t i = 0; i < 2; ++i) {
      double const exact = row.bending[i], c = coarse.bending[i], f = fine.bending[i];
      auto const claim = [&](std::string const& formulation) {
        return Claim{"E2", std::string("frequencies of the thick beam in space, ") + name_of(row.ends) + " [rad/s]",
                     By::independent, timoshenko, formulation};
      };
      Instance const mode{equals("mode", double(i + 1))};
      held(claim(name_of<B>(n) + " elements"), c, exact, 0.02 * exact, mode);
      EXPECT_NEAR((c - exact) / (f - exact), 4.0, 0.1) << int(row.ends) << ' ' << i;
      held(claim(name_of<B>(n) + " and " + std::to_string(2 * n) + " elements extrapolated"), limit(c, f), exact,
           5e-5 * exact, mode);
    }
  }
}
TEST(ThickBeamInSpace, LrvfConvergesToTimoshenkosFrequencies) { bends<Lrvf<>>(16); }
TEST(ThickBeamInSpace, Se3BeamConvergesToTimoshenkosFrequencies) { bends<Se3Beam>(16); }
TEST(ThickBeamInSpace, AncfElasticLineConvergesToTimoshenkosFrequencies) { bends<Line>(12); }
TEST(ThickBeamInSpace, AncfContinuumConvergesToTimoshenkosFrequencies) { bends<Cured>(12); }

// E2 (b), three modes each.
template <class B>
void bends_slender(Index n) {
  struct {
    Ends ends;
    double bending[3];
  } const cases[] = {{Ends::pinned_pinned, {733.710892927, 2898.81548367, 6395.02032507}},
                     {Ends::clamped_free, {261.963564513, 1622.57753153, 4461.35343888}},
                     {Ends::free_free, {1655.24217476, 4488.59199519, 8600.30960638}}};
  for (auto const& row : cases) {
    Frequencies const coarse = frequencies<B>(n, row.ends, slender()),
                      fine = frequencies<B>(2 * n, row.ends, slender());
    for (std::size_t i = 0; i < 3; ++i) {
      double const exact = row.bending[i], c = coarse.bending[i], f = fine.bending[i];
      EXPECT_NEAR((c - exact) / (f - exact), 4.0, 0.1) << int(row.ends) << ' ' << i;
      held({"E2", std::string("frequencies of the slender beam in space, ") + name_of(row.ends) + " [rad/s]",
            By::independent, timoshenko, name_of<B>(n) + " and " + std::to_string(2 * n) + " elements extrapolated"},
           limit(c, f), exact, 1e-4 * exact, {equals("mode", double(i + 1))});
    }
  }
}
TEST(SlenderBeamInSpace, LrvfConvergesToTimoshenkosFrequencies) { bends_slender<Lrvf<>>(24); }
TEST(SlenderBeamInSpace, Se3BeamConvergesToTimoshenkosFrequencies) { bends_slender<Se3Beam>(24); }
TEST(SlenderBeamInSpace, AncfElasticLineConvergesToTimoshenkosFrequencies) { bends_slender<Line>(16); }

// Published values of Exudyn's ANCFBeam for each mesh. Its rotary inertia is distributed over the element, here it is
// lumped at the nodes. For a wave of k h = iπ/n the distributed rotary energy is (2 + cos kh)/3 of the lumped one.
// The ratio of rotary to translational kinetic energy is s = (I/A) k²/(1 + k² EI/GA)². So ω is lower here by s/(1 +
// s) (1 − cos kh)/6, to leading order.
TEST(ThickBeamInSpace, LrvfHasThePublishedFrequenciesOfEveryMesh) {
  BarConstants const c = constants(thick());
  struct {
    Index n;
    double bending[2];
  } const published[] = {{8, {97.361214, 353.279185}}, {32, {95.740589, 333.500724}}};
  for (auto const& mesh : published) {
    Frequencies const f = frequencies<Lrvf<>>(mesh.n, Ends::pinned_pinned);
    for (std::size_t i = 0; i < 2; ++i) {
      double const k = double(i + 1) * std::numbers::pi / 2.0, slope = 1.0 / (1.0 + k * k * c.EI / c.GA);
      double const s = c.EI / c.EA * k * k * slope * slope;
      double const lower = s / (1.0 + s) * (1.0 - std::cos(2.0 * k / double(mesh.n))) / 6.0;
      held({"E2", "frequencies of the thick beam, pinned–pinned, less what lumped rotary inertia takes [rad/s]",
            By::published, "Exudyn's ANCFBeam, mesh by mesh", name_of<Lrvf<>>(mesh.n) + " elements"},
           f.bending[i], mesh.bending[i] * (1.0 - lower), 0.25 * lower * mesh.bending[i],
           {equals("mode", double(i + 1))});
    }
  }
}

// By symmetry the torsion of a clamped beam is half of that of a free beam.
double const axial = 280.320625133;  ///< clamped–free
/// Free–free: E2 rounds J to 0.8436·2I. The exact J of the square is 0.1405770150 h⁴ (S7).
double const torsion = 319.349808602 * std::sqrt(6 * 0.1405770150 / 0.8436);

char const* const rod = "rod of constant section, J of Saint-Venant";

/// Frequency of the free beam with n and 2n elements.
template <class B>
double free_torsion(Index n) {
  return limit(frequencies<B>(n, Ends::free_free).single[0], frequencies<B>(2 * n, Ends::free_free).single[0]);
}

template <class B>
void twists_and_stretches() {
  Frequencies const c = frequencies<B>(16, Ends::clamped_free), f = frequencies<B>(32, Ends::clamped_free);
  std::string const meshes = name_of<B>(16) + " and 32 elements extrapolated";
  held({"E2", "torsion of the thick beam, clamped–free [rad/s]", By::closed_form, rod, meshes},
       limit(c.single[0], f.single[0]), 0.5 * torsion, 1e-6 * torsion);
  held({"E2", "stretch of the thick beam, clamped–free [rad/s]", By::closed_form, rod, meshes},
       limit(c.single[1], f.single[1]), axial, 1e-6 * axial);
  held({"E2", "torsion of the thick beam, free–free [rad/s]", By::closed_form, rod, meshes}, free_torsion<B>(16),
       torsion, 1e-6 * torsion);
}
TEST(ThickBeamInSpace, LrvfTwistsAndStretches) { twists_and_stretches<Lrvf<>>(); }
TEST(ThickBeamInSpace, Se3BeamTwistsAndStretches) { twists_and_stretches<Se3Beam>(); }

/// The frame of a section follows r_y, which carries Iρ. The vector r_z with its own Iρ is coupled to it by the
/// section's shear stiffness GA. With the rod's frequency ω₀: ½ ω² (1 + 1/(1 − Iρ ω²/GA)) = ω₀². With a = Iρ ω₀²/GA
/// it follows ω²/ω₀² = (1 + a − √(1 + a²))/a, less than 1 by a/2.
double twisting(double omega0) {
  BarConstants const c = constants(thick());
  double const a = c.rotary_inertia * omega0 * omega0 / c.GA;
  return omega0 * std::sqrt((1.0 + a - std::sqrt(1.0 + a * a)) / a);
}
TEST(ThickBeamInSpace, AncfElasticLineTwistsAndStretches) {
  Frequencies const c = frequencies<Line>(12, Ends::clamped_free), f = frequencies<Line>(24, Ends::clamped_free);
  char const *const meshes = "AncfBeam, 12 and 24 elements extrapolated", *const hung =
                                                                              "rod whose r_z hangs on r_y by GA";
  held({"E2", "torsion of the thick beam, clamped–free [rad/s]", By::closed_form, hung, meshes},
       limit(c.single[0], f.single[0]), twisting(0.5 * torsion), 1e-5 * torsion);
  held({"E2", "stretch of the thick beam, clamped–free [rad/s]", By::closed_form, rod, "AncfBeam, 12 elements"},
       c.single[1], axial, 1e-8 * axial);
  held({"E2", "torsion of the thick beam, free–free [rad/s]", By::closed_form, hung, meshes}, free_torsion<Line>(12),
       twisting(torsion), 1e-5 * torsion);
}

// The sections of a solid contract when it stretches, and their inertia lowers the frequency. The factor is (1 + ν²
// r² k²)^(−1/2), r² = 2I/A, k = π/2L, if no stiffness resists a contraction that varies along the beam [Rayleigh &
// Love]. Shear resists it [Bishop 1952].
TEST(ThickBeamInSpace, AncfContinuumTwistsAndStretches) {
  BarConstants const c = constants(thick());
  double const k = 0.25 * std::numbers::pi, love = axial / std::sqrt(1.0 + 0.09 * 2.0 * c.EI / c.EA * k * k);
  Frequencies const coarse = frequencies<Cured>(12, Ends::clamped_free),
                    fine = frequencies<Cured>(24, Ends::clamped_free);
  double const stretch = coarse.single[1];
  EXPECT_GT(stretch, love);
  EXPECT_LT(stretch, axial);
  char const* const meshes = "AncfBeam<Continuum>, 12 and 24 elements extrapolated";
  held({"E2", "torsion of the thick beam, clamped–free [rad/s]", By::closed_form, rod, meshes},
       limit(coarse.single[0], fine.single[0]), 0.5 * torsion, 1e-5 * torsion);
  held({"E2", "torsion of the thick beam, free–free [rad/s]", By::closed_form, rod, meshes}, free_torsion<Cured>(12),
       torsion, 1e-5 * torsion);
}

}  // namespace timoshenko_spatial_test
