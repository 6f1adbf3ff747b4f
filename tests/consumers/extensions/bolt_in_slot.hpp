#pragma once
// User-defined joint geometry: a list of constraint equations of the library.
#include <polybody/polybody.hpp>

namespace own {

using namespace polybody;

/// A bolt on b in a slot of a: it translates along the slot and rotates about its own axis. 4 constraint equations
///   g = [a₂·d; a₃·d; a₁·b₃; a₂·b₃],  d = r_b − r_a.
struct BoltInSlot {
  static constexpr char const* name = "BoltInSlot";
  static constexpr World world = World::space;
  using Equations = EquationList<NoTranslation<1>, NoTranslation<2>, Perpendicular<0, 2>, Perpendicular<1, 2>>;

  JointAxis slot = {};  ///< (3) unit vector a₁ along the slot, world axes at the reference configuration
  JointAxis axis = {};  ///< (3) unit vector b₃ of the bolt's axis, perpendicular to it

  Mat3 triad() const { return polybody::constraint_functions::triad_of(slot, axis, "BoltInSlot"); }
};

static_assert(JointGeometry<BoltInSlot> && HasFreeDirections<BoltInSlot>);

}  // namespace own
