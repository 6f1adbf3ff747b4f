// CASES S9c: a right-angle frame of two flat strips, pulled in its plane, buckles sideways (Argyris).

#include <polybody/bodies/lrvf.hpp>

#include <gtest/gtest.h>

#include <polybody/analysis/equilibrium.hpp>
#include <polybody/analysis/modes.hpp>
#include <polybody/analysis/observe.hpp>
#include <polybody/forces/point_load.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/weld.hpp>

#include "support/solver_instances.hpp"

using namespace polybody;

namespace right_angle_frame_test {

/// Two legs of 240 mm, 30 mm high in the plane and 0.6 mm thick (N, mm, and any mass: it decides no stability). The numbers are
/// those of a frame without shear: GA is ten times EA.
struct FlatFrame {
  using Clamp = Joint<Weld, Constraint>;
  Model<Bodies<Lrvf<>>, Joints<Clamp>, Forces<PointForce<>>> model;
  BodyHandle<Lrvf<>> first, second;
  State x;

  FlatFrame(Index n, double J, double force)
      : first(model.add(Lrvf<>::from(leg({}, J), n), "first leg")),
        second(model.add(Lrvf<>::from(leg(Placement::planar(240.0, 0.0, -0.5 * std::numbers::pi), J), n), "second leg")) {
    model.connect(Clamp{}, model.ground().at({0, 0, 0}), first.at(0.0), "clamp");
    model.connect(Clamp{}, first.at(240.0), second.at(0.0), "corner");
    model.apply(PointForce<>{.force = {force, 0, 0}}, second.at(240.0), "pull");
    x = model.reference_state();
    equilibrium(model, x);
  }
  static Bar leg(Placement const& placement, double J) {
    double const e = 71240, g = e / 2.62, b = 30, t = 0.6;
    return {.length = 240.0,
            .constants = BarConstants{.EA = e * b * t, .EI = e * t * b * b * b / 12, .mass_per_length = 1.0, .GA = 10 * e * b * t,
                                      .GJ = g * J, .rotary_inertia = 75.0,
                                      .EI_y = e * b * t * t * t / 12, .rotary_inertia_y = 0.03},
            .placement = placement};
  }
  /// The lowest squared frequency about the state in the plane.
  double lowest() const {
    double const w = modes(model, x, 1).frequency[0];
    return w * std::abs(w);
  }
};

/// Where it passes through zero, by false position between 1 and 1.2 N.
double critical_force(Index n, double J) {
  double a = 1.0, b = 1.2, fa = FlatFrame(n, J, a).lowest(), fb = FlatFrame(n, J, b).lowest();
  EXPECT_GT(fa, 0.0);
  EXPECT_LT(fb, 0.0);
  for (int i = 0; i < 30 && std::abs(b - a) > 1e-8; ++i) {
    double const c = b - fb * (b - a) / (fb - fa), fc = FlatFrame(n, J, c).lowest();
    a = b;
    fa = fb;
    b = c;
    fb = fc;
  }
  return b;
}
double const thin = 30 * 0.6 * 0.6 * 0.6 / 3;                          ///< b t³/3
double const finite = thin * (1.0 - 0.63 * 0.6 / 30);                  ///< of a strip that is not infinitely thin

// 1.08751842 N and 1.08408817 N [C]; published 1.088 [P]. Elements are of order 2: eight a leg come to 0.25 %, sixteen to a
// quarter of that; both together to the exact frame.
TEST(RightAngleFrame, BucklesAtTheExactForce) {
  struct Case {
    double J, force;
  };
  for (auto const& [J, force] : {Case{thin, 1.08751842}, Case{finite, 1.08408817}}) {
    double const coarse = critical_force(8, J), fine = critical_force(16, J);
    EXPECT_NEAR(coarse, force, 2.5e-3 * force);
    EXPECT_NEAR(fine, force, 2.5e-3 / 4 * force);
    EXPECT_NEAR((coarse - force) / (fine - force), 4.0, 0.05);
    EXPECT_NEAR((4.0 * fine - coarse) / 3.0, force, 3e-6 * force);
  }
}

// Below that force the frame is stable everywhere, and it never leaves its plane unasked.
TEST(RightAngleFrame, IsStableBelowAndUnstableAbove) {
  for (double const part : {0.0, 0.2, 0.4, 0.6, 0.8, 0.99}) {
    EXPECT_GT(FlatFrame(8, thin, 1.08751842 * part).lowest(), 0.0) << part;
  }
  FlatFrame const beyond(8, thin, 1.1);
  EXPECT_LT(beyond.lowest(), 0.0);
  EXPECT_EQ(position(beyond.model, beyond.x, beyond.second.at(240.0))[2], 0.0);
}

}  // namespace right_angle_frame_test
