// refused: An EquationList contains constraint equations
#include <polybody/joints/joint.hpp>
#include <polybody/joints/standard_joints.hpp>

using namespace polybody;

struct Slot {
  static constexpr char const* name = "Slot";
  static constexpr World world = World::space;
  using Equations = EquationList<NoTranslation<0>, Spherical>;
  Mat3 triad() const { return identity(); }
};

Joint<Slot, Constraint> const joint{};
