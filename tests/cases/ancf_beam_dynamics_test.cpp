// Right-angle cantilever of Simo & Vu-Quoc 1988 (D5) and spin-up of Kane, Ryan & Banerjee 1987 (D2) with the fully
// parameterised ANCF beam on its elastic line. The reference is an independent computation of the exact rod. The
// sections of the ANCF beam can stretch. A section with angular velocity ω stretches by Iρ ω²/EA: 1e-5 ω² s² in D5,
// 1e-9 ω² s² in D2. Apart from this stretch the beam agrees with the rod. Its order is 2, equal to the order of the
// Lrvf.

#include <polybody/bodies/ancf/ancf_beam.hpp>

#include <polybody/joints/standard_joints.hpp>

#include "support/right_angle_cantilever.hpp"
#include "support/solver_instances.hpp"
#include "support/spin_up.hpp"

using namespace polybody;

namespace ancf_beam_dynamics_test {

using namespace right_angle_cantilever;
using Pin = Joint<Revolute, Constraint>;
/// Model type for both cases, which is compiled once.
using Beams = RightAngle<AncfBeam<>, Pin, spin_up::Drive>;

TEST(AncfRightAngleCantilever, TenElementsPerLegStayWithinOnePercent) {
  follows<Beams>(10, 0.05, 0.01, "AncfBeam, 10 elements a leg, h = 0.05 s");
}

// (4 fine − coarse)/3 has no error of second order. The remaining error grows with time. The right angle is a weld
// between the frames of both sections.
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

// Tolerance of the lag in D2 for elements of order 2. The error of a frequency shifts the phase of the remaining
// vibration.
TEST(AncfSpinUp, SixteenElements) {
  Beams::ModelType model;
  auto const arm = model.add(AncfBeam<>::from(spin_up::arm(), 16), "arm");
  model.connect(Pin{{.axis = Vec3::UnitZ()}, {}}, model.ground().at({0, 0, 0}), arm.at(0.0), "axle");
  model.connect(spin_up::drive(), model.ground().at({0, 0, 0}), arm.at(0.0), "drive");
  spin_up::follows(model, arm.at(10.0), {1e-2, 0.1}, "AncfBeam, 16 elements");
}

}  // namespace ancf_beam_dynamics_test
