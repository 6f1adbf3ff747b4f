// Spin-up of Kane, Ryan & Banerjee 1987 (D2) by spatial bodies.

#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/rigid/rigid.hpp>

#include <polybody/joints/standard_joints.hpp>

#include "support/solver_instances.hpp"
#include "support/spin_up.hpp"

using namespace polybody;

namespace spatial_spin_up_test {

using Cable = AncfCable<EngineeringStrain>;
using Pin = Joint<Revolute, Constraint>;
using Fixed = Joint<Weld, Constraint>;

/// Arm on a driven hub of zero radius, whose mass has no effect. A pin along the tangent clamps a cable.
template <class B>
void spins_up(Index n, spin_up::Share const& share, char const* formulation) {
  Model<Bodies<Rigid<>, Cable, Lrvf<>>, Joints<Pin, Fixed, spin_up::Drive>> model;  // one type for both bodies
  auto const arm = model.add(B::from(spin_up::arm(), n), "arm");
  auto const hub = model.add(Rigid<>(1.0, Mat3::Identity()), "hub").at(Vec3(0, 0, 0));
  model.connect(Pin{{.axis = Vec3::UnitZ()}, {}}, model.ground().at({0, 0, 0}), hub, "axle");
  model.connect(spin_up::drive(), model.ground().at({0, 0, 0}), hub, "drive");
  if constexpr (B::observes == MarkerKind::frame) {
    model.connect(Fixed{}, hub, arm.at(0.0), "clamp");
  } else {
    model.connect(Pin{Revolute{.axis = Vec3::UnitX()}, {}}, hub, arm.at(0.0), "clamp");
  }
  spin_up::follows(model, arm.at(10.0), share, formulation);
}

// Tolerances of the lag in D2. The error of a frequency appears as a phase error of the remaining vibration.
TEST(SpinUpInSpace, CableOfEightElements) { spins_up<Cable>(8, {1e-3, 0.02}, "AncfCable, 8 elements"); }
TEST(SpinUpInSpace, LrvfOfTenElements) { spins_up<Lrvf<>>(10, {1e-2, 0.03}, "Lrvf, 10 elements"); }

}  // namespace spatial_spin_up_test
