// Floating frames made of several bars, in static equilibrium: CASES S8, S8b; and a cantilever whose tip force buckles it (S9e).
#include <gtest/gtest.h>

#include <numbers>
#include <polybody/analysis/equilibrium.hpp>
#include <polybody/analysis/section.hpp>
#include <polybody/bodies/ffr.hpp>
#include <polybody/forces/point_load.hpp>
#include <polybody/joints/policies/constraint.hpp>
#include <polybody/joints/weld.hpp>

namespace ffr_frames_test {

using namespace polybody;
using std::numbers::pi;

/// Displacement of the last node of a structure welded to the ground at node 0, under a force there.
Vec3 tip_displacement(Structure const& s, Vec3 const& force) {
  using Clamp = Joint<Weld, Constraint>;
  Model<Bodies<Ffr>, Joints<Clamp>, Forces<PointForce<>>> model;
  auto const body = model.add(Ffr(s, nodal_coordinates(s)), "frame");
  model.connect(Clamp{}, model.ground().at({0, 0, 0}), body.at(body.body.node(0)), "clamp");
  auto const tip = body.at(body.body.node(Index(s.nodes.size()) - 1));
  model.apply(PointForce<>{.force = force}, tip);
  State x = model.reference_state();
  Vec3 const start = position(model, x, tip);
  equilibrium(model, x);
  return position(model, x, tip) - start;
}

// S8: MacNeal & Harder's beam, twisted by 90 degrees, as 32 straight bars with turned sections; without shear.
TEST(FloatingFrame, PreTwistedCantilever) {
  Index const n = 32;
  double const length = 12.0, young = 29e6, shear = young / (2 * 1.22), b = 1.1, h = 0.32;
  std::vector<Bar> bars;
  for (Index i = 0; i < n; ++i)
    bars.push_back({.length = length / double(n),
                    .constants = BarConstants{.EA = young * b * h, .EI = young * b * h * h * h / 12, .mass_per_length = 1.0,
                                              .GJ = shear * 0.00981214, .rotary_inertia = 0.1, .EI_y = young * h * b * b * b / 12},
                    .placement = Placement::at({length * double(i) / double(n), 0, 0}, {0.5 * pi * (double(i) + 0.5) / double(n), 0, 0})});
  Structure const s = structure_of(bars, std::vector<Index>(std::size_t(n), 1));
  EXPECT_NEAR(tip_displacement(s, {0, 1, 0})[1], 5.4258784e-3, 1e-3 * 5.4258784e-3);
  EXPECT_NEAR(tip_displacement(s, {0, 0, 1})[2], 1.7461814e-3, 1e-3 * 1.7461814e-3);
}

// S8b: a quarter circle with inner radius 4.12 and depth 0.2, axis at R = 4.22. Castigliano with M = R sin θ, N = sin θ in the plane,
// M = R sin θ, T = R (1 − cos θ) out of it:
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
  EXPECT_NEAR(u, in_plane, 2e-3 * in_plane);
  EXPECT_NEAR(w, out_of_plane, 2e-3 * out_of_plane);
  EXPECT_NEAR(u, 0.08734, 0.02 * 0.08734);
  EXPECT_NEAR(w, 0.5022, 0.01 * 0.5022);
}

// Geometric stiffening knows every axial force: the lateral stiffness of a cantilever pressed at its tip with P is lost at Euler's load
// π²EI/4L² (S9e, clamped–free). Under P it is P/(tan(κL)/κ − L), κ² = P/EI.
TEST(FloatingFrame, StiffeningKnowsForcesAtItsMarkers) {
  using Clamp = Joint<Weld, Constraint>;
  Bar const bar{.length = 1.0,
                .constants = BarConstants{.EA = 1e6, .EI = 1.0, .mass_per_length = 1.0, .GJ = 1.0, .rotary_inertia = 1e-3}};
  for (double const part : {0.0, 0.5, 0.9}) {
    double const p = part * pi * pi / 4, kappa = std::sqrt(p), lateral = 1e-5;
    double const expected = part == 0.0 ? lateral / 3 : lateral * (std::tan(kappa) / kappa - 1.0) / p;
    Model<Bodies<Ffr>, Joints<Clamp>, Forces<PointForce<>>> model;
    auto const body = model.add(Ffr::from(bar, 6, {.stiffening = true}), "column");
    model.connect(Clamp{}, model.ground().at({0, 0, 0}), body.at(0.0), "clamp");
    model.apply(PointForce<>{.force = {-p, lateral, 0}}, body.at(1.0));
    State x = model.reference_state();
    equilibrium(model, x);
    EXPECT_NEAR(position(model, x, body.at(1.0))[1], expected, 5e-3 * expected) << part;
    EXPECT_NEAR(section_forces(model, x, body.at(0.5))[0], -p, 1e-3) << part;
    EXPECT_NEAR(section_forces(model, x, body.at(0.0))[5],
                lateral * 1.0 + p * expected, 0.02 * (lateral + p * expected))
        << part;
  }
}

}  // namespace ffr_frames_test
