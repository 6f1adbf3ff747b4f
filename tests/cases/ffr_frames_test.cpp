// Static equilibrium of floating frames made of several bars: the beams of MacNeal & Harder 1985 (S8, S8b) and
// several frames welded in a row (S7). Buckling of a cantilever under its tip force (S9e).
#include <gtest/gtest.h>

#include <numbers>
#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/marker_frames.hpp>
#include <polybody/statics/equilibrium.hpp>

#include "support/held.hpp"

namespace ffr_frames_test {

using namespace polybody;
using std::numbers::pi;

using Clamp = Joint<Weld, Constraint>;
/// Model type for all tests, which is compiled once.
using Frames = Model<Bodies<Ffr>, Joints<Clamp>, Forces<PointForce<>>>;

/// Displacement of the last node of a structure under a force at this node. Node 0 is welded to the ground.
Vec3 tip_displacement(Structure const& s, Vec3 const& force) {
  Frames model;
  auto const body = model.add(Ffr(s, nodal_coordinates(s)), "frame");
  model.connect(Clamp{}, model.ground().at({0, 0, 0}), body.at(body.body().node(0)), "clamp");
  auto const tip = body.at(body.body().node(Index(s.nodes.size()) - 1));
  model.apply(PointForce<>{.force = force}, tip);
  State x = model.reference_state();
  Vec3 const start = position(model, x, tip);
  equilibrium(model, x);
  return position(model, x, tip) - start;
}

// S8: beam of MacNeal & Harder 1985, twisted by 90 degrees, as 32 straight bars with rotated sections, without shear.
TEST(FloatingFrame, PreTwistedCantilever) {
  Index const n = 32;
  double const length = 12.0, young = 29e6, shear = young / (2 * 1.22), b = 1.1, h = 0.32;
  std::vector<Bar> bars;
  for (Index i = 0; i < n; ++i)
    bars.push_back({.length = length / double(n),
                    .constants = BarConstants{.EA = young * b * h,
                                              .EI = young * b * h * h * h / 12,
                                              .mass_per_length = 1.0,
                                              .GJ = shear * 0.00981214,
                                              .rotary_inertia = 0.1,
                                              .EI_y = young * h * b * b * b / 12},
                    .placement = Placement::at({length * double(i) / double(n), 0, 0},
                                               {0.5 * pi * (double(i) + 0.5) / double(n), 0, 0})});
  Structure const s = structure_of(bars, std::vector<Index>(std::size_t(n), 1));
  Claim const tip{"S8", "tip of the pre-twisted beam along its unit force, without shear", By::independent,
                  "shooting on the rod's equations", "Ffr of 32 straight bars"};
  held(tip, tip_displacement(s, {0, 1, 0})[1], 5.4258784e-3, 1e-3 * 5.4258784e-3, {"F along y"});
  held(tip, tip_displacement(s, {0, 0, 1})[2], 1.7461814e-3, 1e-3 * 1.7461814e-3, {"F along z"});
}

// S8b: quarter circle with inner radius 4.12 and depth 0.2, axis at R = 4.22. Castigliano's theorem with M = R sin θ,
// N = sin θ in the plane, M = R sin θ, T = R (1 − cos θ) out of it:
//   u = π R³/4EI + π R/4EA = 0.0886 (published, with the curved beam's correction: 0.08734),
//   u = π R³/4EI + (3π/4 − 2) R³/GJ = 0.5002 (published: 0.5022).
TEST(FloatingFrame, CurvedCantilever) {
  Index const n = 24;
  double const radius = 4.22, young = 1e7, step = 0.5 * pi / double(n);
  std::vector<Bar> bars;
  for (Index i = 0; i < n; ++i) {
    auto const at = [&](double a) { return Vec3(radius * std::sin(a), radius * (1 - std::cos(a)), 0.0); };
    Vec3 const from = at(step * double(i)), along = at(step * double(i + 1)) - from;
    bars.push_back({.length = along.norm(),
                    .section = Rectangle{.height = 0.2, .width = 0.1},
                    .material = Material{.density = 1.0, .young = young, .poisson = 0.25},
                    .placement = {from, exp_so3<double>(Vec3(0, 0, std::atan2(along[1], along[0])))}});
  }
  Structure const s = structure_of(bars, std::vector<Index>(std::size_t(n), 1));
  BarConstants const c = constants(bars[0]);
  double const r3 = radius * radius * radius;
  double const in_plane = pi * r3 / (4 * c.EI) + pi * radius / (4 * c.EA);
  double const out_of_plane = pi * r3 / (4 * *c.EI_y) + (0.75 * pi - 2) * r3 / c.GJ;
  double const u = tip_displacement(s, {1, 0, 0})[0], w = tip_displacement(s, {0, 0, 1})[2];
  auto const tip = [&](By by, char const* source) {
    return Claim{"S8b", "tip of the quarter circle along its unit force", by, source, "Ffr of 24 straight bars"};
  };
  Claim const castigliano = tip(By::closed_form, "Castigliano, without shear"),
              published = tip(By::published, "MacNeal & Harder 1985");
  held(castigliano, u, in_plane, 2e-3 * in_plane, {"in the plane"});
  held(castigliano, w, out_of_plane, 2e-3 * out_of_plane, {"out of the plane"});
  held(published, u, 0.08734, 0.02 * 0.08734, {"in the plane"});
  held(published, w, 0.5022, 0.01 * 0.5022, {"out of the plane"});
}

// ---- S7: the 45° bend of Bathe & Bolourchi in substructures

/// Tip of the arc of radius 100 under a force along z. The arc consists of `pieces` equal substructures, each of
/// `bars_of_each` bars along chords. Each has its own floating frame, fixed to its first node or to its mean motion.
/// Its shapes are those of Craig & Bampton with two modes.
Vec3 bend_tip(Index pieces, Index bars_of_each, BarConstants const& constants, double force, bool mean_axes) {
  auto const on_arc = [](double a) { return Placement::at(100.0 * Vec3(std::sin(a), 1 - std::cos(a), 0), {0, 0, a}); };
  double const chord = 0.25 * pi / double(pieces * bars_of_each), length = 200.0 * std::sin(0.5 * chord);
  std::vector<Bar> bars;
  for (Index i = 0; i < bars_of_each; ++i)
    bars.push_back({.length = length,
                    .constants = constants,
                    .placement = Placement::at(on_arc(chord * double(i)).origin, {0, 0, chord * (double(i) + 0.5)})});
  Structure const s = structure_of(bars, std::vector<Index>(std::size_t(bars_of_each), 1));
  MatX const shapes = craig_bampton(s, {0, bars_of_each}, 2, mean_axes);
  Frames model;
  std::vector<Marker<Ffr>> tips;
  for (Index i = 0; i < pieces; ++i) {
    auto const piece = model.add(Ffr(s, shapes, {.placement = on_arc(chord * double(i * bars_of_each))}));
    auto const root = piece.at(piece.body().node(0));
    if (i == 0)
      model.connect(Clamp{}, model.ground().at({0, 0, 0}), root, "clamp");
    else
      model.connect(Clamp{}, tips.back(), root);
    tips.push_back(piece.at(piece.body().node(bars_of_each)));
  }
  model.apply(PointForce<>{.force = {0, 0, force}}, tips.back());
  State x = model.reference_state();
  equilibrium(model, x, {.load_steps = 4});
  return position(model, x, tips.back());
}

// The rotations within a substructure are small. The neglected terms fall with the square of its length. They are a
// quarter if the frame is in the middle of the substructure. The beams have no shear here, and the stretch of so
// stiff a bar is negligible.
TEST(FloatingFrames, SubStructuresConvergeToTheExactRod) {
  BarConstants const c{.EA = 1e10, .EI = 1e7 / 12, .mass_per_length = 1.0, .GJ = 1e7 / 12, .rotary_inertia = 1.0 / 12};
  Vec3 const exact(47.1512944003, 15.6850781622, 53.4685984423), straight(70.7106781187, 29.2893218813, 0);
  double const u = (exact - straight).norm();
  for (bool const mean_axes : {false, true}) {
    auto const error = [&](Index pieces) {
      return (bend_tip(pieces, 96 / pieces, c, 600, mean_axes) - exact).norm() / u;
    };
    double const eight = error(8), sixteen = error(16);
    char const* const frame_is = mean_axes ? "mean axes" : "tied to the first node";
    Claim const of_tip{"S7", "tip of the 45° bend, of its displacement", By::independent,
                       "shooting on the rod's equations",
                       std::string("Ffr, welded pieces, 96 bars in all, ") + frame_is};
    held_within(of_tip, error(4), 0.03, {"4 pieces", 1.0});
    held_within(of_tip, eight, mean_axes ? 0.002 : 0.01, {"8 pieces", 1.0});
    EXPECT_NEAR(eight / sixteen, 4.0, 0.1) << mean_axes;
  }
}

// Chrono's utest_MOD_curved_beam: 40 elements in five sub-assemblies, tolerance 5 %.
TEST(FloatingFrames, FiveSubStructuresMeetThePublishedTolerance) {
  BarConstants const c{
      .EA = 1e7, .EI = 1e7 / 12, .mass_per_length = 1.0, .GJ = 0.1405770150 * 5e6, .rotary_inertia = 1.0 / 12};
  struct {
    double force;
    Vec3 tip;
  } const rows[] = {{300, {58.5357092368, 22.1125138053, 40.4807573768}},
                    {450, {51.9694245784, 18.3691630429, 48.7053489407}},
                    {600, {46.8915863910, 15.5576762394, 53.6079863172}}};
  for (auto const& row : rows)
    for (bool const mean_axes : {false, true}) {
      Vec3 const tip = bend_tip(5, 8, c, row.force, mean_axes);
      double const way = (row.tip - Vec3(70.7106781187, 29.2893218813, 0)).norm();
      held_within(
          {"S7", "tip of the 45° bend", By::independent, "shooting on the rod's equations",
           std::string("Ffr, 5 welded pieces of 8 bars, ") + (mean_axes ? "mean axes" : "tied to the first node")},
          (tip - row.tip).norm(), 0.05 * way, {equals("P", row.force), way});
    }
}

/// L = EI = 1, practically inextensible.
Bar column() {
  return {.length = 1.0,
          .constants = BarConstants{.EA = 1e6, .EI = 1.0, .mass_per_length = 1.0, .GJ = 1.0, .rotary_inertia = 1e-3}};
}
/// Cantilever in equilibrium under the axial tip force p (compression) and the transverse tip force `lateral`.
struct Pressed {
  Frames model;
  BodyHandle<Ffr> body;
  State x;
  Pressed(double p, double lateral, FfrOptions const& options = {})
      : body(model.add(Ffr::from(column(), 6, options), "column")) {
    model.connect(Clamp{}, model.ground().at({0, 0, 0}), body.at(0.0), "clamp");
    model.apply(PointForce<>{.force = {-p, lateral, 0}}, body.at(1.0));
    x = model.reference_state();
    equilibrium(model, x);
  }
  double deflection() const { return position(model, x, body.at(1.0))[1]; }
};

// Geometric stiffening includes every axial force. A cantilever under the compressive tip force P loses its lateral
// stiffness at Euler's load π²EI/4L² (S9e, clamped–free). Under P it is P/(tan(κL)/κ − L), κ² = P/EI.
TEST(FloatingFrame, StiffeningKnowsForcesAtItsMarkers) {
  for (double const part : {0.0, 0.17, 0.5, 0.9}) {
    double const p = part * pi * pi / 4, kappa = std::sqrt(p), lateral = 1e-5;
    double const expected = part == 0.0 ? lateral / 3 : lateral * (std::tan(kappa) / kappa - 1.0) / p;
    Pressed const stiff(p, lateral, {.frame = FfrFrame::clamped});
    char const* const column_is = "Ffr with stiffening, 6 elements";
    held({"S9e", "deflection of the pressed cantilever, of L", By::closed_form, "F (tan κL/κ − L)/P, κ² = P/EI",
          column_is},
         stiff.deflection(), expected, 5e-3 * expected, {equals("P/P_cr", part)});
    auto const forces = [&](double s) { return section_forces(stiff.model, stiff.x, stiff.body.at(s)); };
    held({"S9e", "axial force in the pressed cantilever", By::closed_form, "−P", column_is}, forces(0.5)[0], -p, 1e-3,
         {equals("P/P_cr", part), 1.0});
    held({"S9e", "moment at the clamp of the pressed cantilever", By::closed_form, "F L + P u", column_is},
         forces(0.0)[5], lateral * 1.0 + p * expected, 0.02 * (lateral + p * expected), {equals("P/P_cr", part)});
  }
}

// The deflection does not depend on the frame: mean axes and the chord of `simply_supported` turn with the column.
TEST(FloatingFrame, StiffeningIsTheSameInAllFrames) {
  for (double const part : {0.0, 0.5, 0.9}) {
    double const p = part * pi * pi / 4, clamped = Pressed(p, 1e-5, {.frame = FfrFrame::clamped}).deflection();
    EXPECT_NEAR(Pressed(p, 1e-5).deflection(), clamped, 1e-3 * clamped) << part;
    EXPECT_NEAR(Pressed(p, 1e-5, {.frame = FfrFrame::simply_supported}).deflection(), clamped, 1e-3 * clamped) << part;
  }
}

// Without geometric stiffening the deflection is P L³/3EI for every axial force, 17 % too small at 0.17 of Euler's
// load.
TEST(FloatingFrame, WithoutStiffeningNoForceBuckles) {
  double const p = 0.17 * 0.25 * std::numbers::pi * std::numbers::pi, kappa = std::sqrt(p);
  double const unpressed = 1e-5 / 3, pressed = 1e-5 * (std::tan(kappa) / kappa - 1.0) / p;
  held({"S9e", "deflection of the pressed cantilever, of L, which ignores P", By::closed_form, "F L³/3EI",
        "Ffr without stiffening, 6 elements"},
       Pressed(p, 1e-5, {.frame = FfrFrame::clamped, .stiffening = false}).deflection(), unpressed, 1e-3 * unpressed);
  EXPECT_NEAR(1.0 - unpressed / pressed, 0.17, 0.005);
}

}  // namespace ffr_frames_test
