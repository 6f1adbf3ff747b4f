// CASES S9c, S9d, S9e with the fully parameterised ANCF beam on its elastic line: what is pulled in its stiff plane
// leaves it.

#include <polybody/bodies/ancf/ancf_beam.hpp>

#include "support/columns.hpp"
#include "support/held.hpp"
#include "support/solver_instances.hpp"

using namespace polybody;

namespace ancf_beam_buckling_test {

using namespace buckling;
using Beam = AncfBeam<>;

// 1.08751842 N and 1.08408817 N [C]; published 1.088 [P]. Elements are of order 2: three a leg come to 2.2 %, six to a
// quarter of that, both together to the exact frame.
TEST(AncfRightAngleFrame, BucklesAtTheExactForce) {
  struct Case {
    double J, force;
  };
  for (auto const& [J, force] : {Case{thin_strip, 1.08751842}, Case{thick_strip, 1.08408817}}) {
    double const a = critical_force_of_the_frame<Beam>(3, J), b = critical_force_of_the_frame<Beam>(6, J);
    double const limit = (4.0 * b - a) / 3.0;
    auto const buckles = [&](char const* mesh) {
      return Claim{"S9c", "force at which the frame buckles [N]", By::independent,
                   "rod linearised about its exact bent state", mesh};
    };
    Instance const at{J == thin_strip ? "J = bt³/3" : "J = bt³/3 (1 − 0.63 t/b)"};
    held(buckles("AncfBeam, 3 elements a leg"), a, force, 0.025 * force, at);
    EXPECT_NEAR((a - force) / (b - force), 4.0, 0.1);
    held(buckles("AncfBeam, 3 and 6 elements a leg extrapolated"), limit, force, 1e-4 * force, at);
  }
}

// 8554.9932 N [C], with the deflection before buckling.
TEST(AncfStrip, BucklesSidewaysAtTheExactForce) {
  held({"S9d", "tip force at which the strip buckles [N]", By::independent, "rod linearised about its exact bent state",
        "AncfBeam, 8 to 32 elements extrapolated"},
       columns::limit_of_meshes(columns::critical_tip_force<Beam>, 8), 8554.9932, 3e-3);
}

TEST(AncfColumns, BuckleAtEulersLoads) {
  columns::buckles_at_eulers_loads<Beam>(8, "AncfBeam, 8 to 32 elements extrapolated");
}
TEST(AncfColumns, StandBentBeyond) {
  columns::stands_bent_beyond<Beam>(16, "AncfBeam, 16 to 64 elements extrapolated");
}

}  // namespace ancf_beam_buckling_test
