// Right-angle frame of two flat strips (S9c, Argyris). Under a load in its plane it buckles sideways. The elements
// are Lrvf.

#include <polybody/bodies/lrvf/lrvf.hpp>

#include "support/buckling.hpp"
#include "support/held.hpp"
#include "support/solver_instances.hpp"

using namespace polybody;

namespace right_angle_frame_test {

using namespace buckling;

// The independent computation gives 1.08751842 N and 1.08408817 N. The published value is 1.088 N. Elements are of
// order 2: eight per leg have an error of 0.25 %, sixteen a quarter of it. Their extrapolation agrees with the exact
// frame.
TEST(RightAngleFrame, BucklesAtTheExactForce) {
  struct Case {
    double J, force;
  };
  for (auto const& [J, force] : {Case{thin_strip, 1.08751842}, Case{thick_strip, 1.08408817}}) {
    double const coarse = critical_force_of_the_frame<Lrvf<>>(8, J), fine = critical_force_of_the_frame<Lrvf<>>(16, J);
    auto const buckles = [&](char const* mesh) {
      return Claim{"S9c", "force at which the frame buckles [N]", By::independent,
                   "rod linearised about its exact bent state", mesh};
    };
    Instance const at{J == thin_strip ? "J = bt³/3" : "J = bt³/3 (1 − 0.63 t/b)"};
    held(buckles("Lrvf, 8 elements a leg"), coarse, force, 2.5e-3 * force, at);
    held(buckles("Lrvf, 16 elements a leg"), fine, force, 2.5e-3 / 4 * force, at);
    EXPECT_NEAR((coarse - force) / (fine - force), 4.0, 0.05);
    double const limit = (4.0 * fine - coarse) / 3.0;
    held(buckles("Lrvf, 8 and 16 elements a leg extrapolated"), limit, force, 3e-6 * force, at);
    if (J == thin_strip)
      held({"S9c", "force at which the frame buckles [N]", By::published, "Exudyn's rightAngleFrame.py",
            "Lrvf, 8 and 16 elements a leg extrapolated"},
           limit, 1.088, 5e-4, at);
  }
}

// Below that force the frame is stable, and it stays in its plane without a disturbance.
TEST(RightAngleFrame, IsStableBelowAndUnstableAbove) {
  for (double const part : {0.0, 0.2, 0.4, 0.6, 0.8, 0.99}) {
    FlatFrame<Lrvf<>> const frame(8, thin_strip, 1.08751842 * part);
    EXPECT_GT(lowest(frame.model, frame.x), 0.0) << part;
  }
  FlatFrame<Lrvf<>> const beyond(8, thin_strip, 1.1);
  EXPECT_LT(lowest(beyond.model, beyond.x), 0.0);
  EXPECT_EQ(position(beyond.model, beyond.x, beyond.second.at(240.0))[2], 0.0);
}

}  // namespace right_angle_frame_test
