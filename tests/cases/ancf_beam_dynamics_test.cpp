// CASES D5 and D2 with the fully parameterised ANCF beam on its elastic line, against the exact rod [C]. Its sections
// may stretch: one that spins at ω does so by Iρ ω²/EA, in D5 1e-5 ω² s², in D2 1e-9. That apart it is the rod, and of
// order 2 as the Lrvf is.

#include <polybody/bodies/ancf/ancf_beam.hpp>

#include <polybody/joints/revolute.hpp>

#include "support/right_angle_cantilever.hpp"
#include "support/solver_instances.hpp"
#include "support/spin_up.hpp"

using namespace polybody;

namespace ancf_beam_dynamics_test {

using namespace right_angle_cantilever;
using Pin = Joint<Revolute, Constraint>;
/// One type of model for both cases: it is compiled once.
using Beams = RightAngle<AncfBeam<>, Pin, spin_up::Drive>;

TEST(AncfRightAngleCantilever, TenElementsPerLegStayWithinOnePercent) {
  follows<Beams>(10, 0.05, 0.01, "AncfBeam, 10 elements a leg, h = 0.05 s");
}

// (4 fine − coarse)/3 has no error of second order left; what remains grows with the time. The corner is a weld: of
// both sections' frames.
TEST(AncfRightAngleCantilever, TwoMeshesExtrapolateToTheExactFrame) {
  Beams coarse(12, 0.02), fine(24, 0.01);
  for (Row const& row : table) {
    if (row.t > 10.0) break;
    coarse.run_until(row.t).run();
    fine.run_until(row.t).run();
    Vec6 const limit = (4.0 * fine.displacements() - coarse.displacements()) / 3.0;
    char const* const meshes = "AncfBeam, 12 and 24 elements a leg extrapolated, up to 10 s";
    held_displacements(limit, row, row.t > 6.5 ? 3e-4 : 5e-5, meshes);
    if (row.t >= 2.0) held_energy((4.0 * fine.total_energy() - coarse.total_energy()) / 3.0, 1e-6, row.t, meshes);
  }
}

// D2's tolerance of the lag for elements of order 2; the error of a frequency moves the swing that is left by its
// phase.
TEST(AncfSpinUp, SixteenElements) {
  Beams::ModelType model;
  auto const arm = model.add(AncfBeam<>::from(spin_up::arm(), 16), "arm");
  model.connect(Pin{{.axis = Vec3::UnitZ()}, {}}, model.ground().at({0, 0, 0}), arm.at(0.0), "axle");
  model.connect(spin_up::drive(), model.ground().at({0, 0, 0}), arm.at(0.0), "drive");
  spin_up::follows(model, arm.at(10.0), {1e-2, 0.1}, "AncfBeam, 16 elements");
}

}  // namespace ancf_beam_dynamics_test
