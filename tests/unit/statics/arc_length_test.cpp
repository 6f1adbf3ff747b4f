// Equilibrium paths past limit points: a toggle of two springs in closed form, and Lee's frame (S9a, independent
// computation).
#include <polybody/statics/arc_length.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/run/probe.hpp>

#include "support/held.hpp"
#include "support/refusal.hpp"

namespace arc_length_test {

using namespace polybody;

// Slider between two springs (k, free length l₀) at height y, anchors at ±w: P = −2 k (l − l₀) y/l downwards, l² = w²
// + y². The path snaps through. Every point of it must be on the curve, past both limit points.
struct Toggle {
  using Guide = Joint<planar::Prismatic, Constraint>;
  static constexpr double k = 100.0, w = 1.0, height = 0.5;
  double const l0 = std::hypot(w, height);
  Model<Bodies<planar::Rigid>, Joints<Guide>, Forces<SpringDamper, PointForce<>>> model;
  BodyHandle<planar::Rigid> slider;
  Toggle() : slider(model.add(planar::Rigid(1.0, 1.0, Placement::planar(0, height)), "slider")) {
    model.connect(Guide{planar::Prismatic{.axis = {0, 1, 0}}, Constraint{}}, model.ground().at({0, height, 0}),
                  slider.at(Vec2(0, 0)), "guide");
    for (double const side : {-1.0, 1.0})
      model.apply(SpringDamper{.stiffness = k, .free_length = l0}, model.ground().at({side * w, 0, 0}),
                  slider.at(Vec2(0, 0)));
    model.apply(PointForce<>{.force = {0, -10, 0}}, slider.at(Vec2(0, 0)));
  }
  /// Load factor at the equilibrium of height y.
  double exact(double y) const {
    double const l = std::hypot(w, y);
    return -2.0 * k * (l - l0) * y / l / 10.0;
  }
};

TEST(EquilibriumPath, FollowsAToggleThroughBothLimitPoints) {
  Toggle toggle;
  auto const path =
      equilibrium_path(toggle.model, toggle.model.reference_state(), {.step = 0.01, .max_step = 0.01, .points = 600},
                       [](PathPoint const& p) { return p.x.q[1] < -0.45; });
  ASSERT_GT(path.size(), 20u);
  EXPECT_LT(path.back().x.q[1], -0.45);
  double highest = 0.0, lowest = 0.0, worst = 0.0;
  for (PathPoint const& p : path) {
    worst = std::max(worst, std::abs(p.load_factor - toggle.exact(p.x.q[1])));
    highest = std::max(highest, p.load_factor);
    lowest = std::min(lowest, p.load_factor);
  }
  held_within({"closed forms", "load factor of a toggle of two springs, through both limit points", By::closed_form,
               "−2 k (l − l₀) y/l, l² = w² + y²", "rigid slider, arc length"},
              worst, 1e-7, {.scale = highest});
  // the curve is odd in y, so the limit points are symmetric
  EXPECT_GT(highest, 0.3);
  EXPECT_NEAR(highest, -lowest, 0.02 * highest);
}

/// Lee's frame: column and beam of length 120, hinged at their far ends, with the load at a fifth of the beam.
template <class B>
struct LeeFrame {
  using Corner = Joint<planar::Weld, Constraint>;
  using Hinge = Joint<planar::Revolute, Constraint>;
  Model<Bodies<B>, Joints<Corner, Hinge>, Forces<PointForce<>>> model;
  BodyHandle<B> column, beam;
  Marker<B> loaded;
  LeeFrame(Index n, double shear)
      : column(model.add(B::from(bar(Placement::planar(0, 0, std::numbers::pi / 2), shear), n), "column")),
        beam(model.add(B::from(bar(Placement::planar(0, 120), shear), n), "beam")),
        loaded(beam.at(24.0)) {
    model.connect(Corner{}, column.at(120.0), beam.at(0.0), "corner");
    model.connect(Hinge{}, model.ground().at({0, 0, 0}), column.at(0.0), "foot");
    model.connect(Hinge{}, model.ground().at({120, 120, 0}), beam.at(120.0), "end");
    model.apply(PointForce<>{.force = {0, -1e4, 0}}, loaded);
  }
  static Bar bar(Placement const& place, double shear) {
    return {.length = 120.0,
            .constants = BarConstants{.EA = 7.2e6 * 6, .EI = 7.2e6 * 2, .mass_per_length = 1.0, .GA = shear},
            .placement = place};
  }
  /// Largest and smallest load on the path past both limit points, each by the parabola through three points.
  std::pair<double, double> limits() {
    std::vector<PathPoint> const path = equilibrium_path(
        model, model.reference_state(), {.step = 0.02, .max_step = 0.02, .points = 2000},
        [&](PathPoint const& p) { return p.load_factor > 0.0 && position(model, p.x, loaded)[1] < 120 - 75.0; });
    std::pair<double, double> found{0.0, 0.0};
    for (std::size_t i = 1; i + 1 < path.size(); ++i) {
      double const a = path[i - 1].load_factor, b = path[i].load_factor, c = path[i + 1].load_factor;
      double const top = b - (c - a) * (c - a) / (8.0 * (a - 2.0 * b + c));
      if (b > a && b >= c) found.first = std::max(found.first, top);
      if (b < a && b <= c) found.second = std::min(found.second, top);
    }
    return {1e4 * found.first, 1e4 * found.second};
  }
};

// Limit loads of S9a without shear: 18556.7275 and −9414.4316. With shear (GA = 1.3846154e7): 18544.5271 and
// −9392.4896. Tolerance 0.3 %. Lrvf is of order 2. With 20 elements per leg its errors are 0.33 % at the upper limit
// and 1.2 % at the lower one, with 60 a ninth of them.
TEST(LeesFrame, HasItsLimitLoads) {
  auto const [high, low] = LeeFrame<planar::AncfCable<planar::EngineeringStrain>>(20, 0.0).limits();
  auto const limit = [](char const* what, char const* formulation, double value, double exact) {
    held({"S9a", what, By::independent, "shooting on Reissner's beam, arc length", formulation}, value, exact,
         3e-3 * std::abs(exact));
  };
  char const *const upper = "upper limit load, by arc length", *const lower = "lower limit load, by arc length";
  limit(upper, "planar AncfCable, 20 elements a leg", high, 18556.7275);
  limit(lower, "planar AncfCable, 20 elements a leg", low, -9414.4316);
  auto const [sheared_high, sheared_low] = LeeFrame<planar::Lrvf>(60, 1.3846154e7).limits();
  limit(upper, "planar Lrvf, 60 elements a leg, with shear", sheared_high, 18544.5271);
  limit(lower, "planar Lrvf, 60 elements a leg, with shear", sheared_low, -9392.4896);
}

TEST(EquilibriumPath, RefusesAModelWithoutLoads) {
  Model<Bodies<planar::Rigid>, Joints<Joint<planar::Weld, Constraint>>> model;
  auto const b = model.add(planar::Rigid(1.0, 1.0), "block");
  model.connect(Joint<planar::Weld, Constraint>{}, model.ground().at({0, 0, 0}), b.at(Vec2(0, 0)), "weld");
  EXPECT_TRUE(
      has(message_of<SingularMatrix>([&] { equilibrium_path(model, model.reference_state()); }), "no load acts"));
}

}  // namespace arc_length_test
