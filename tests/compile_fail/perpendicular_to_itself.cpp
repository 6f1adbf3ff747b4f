// refused: Perpendicular needs two different axes
#include <polybody/joints/joint.hpp>
#include <polybody/joints/joint_axis.hpp>

using namespace polybody;

struct Elbow {
  static constexpr char const* name = "Elbow";
  static constexpr World world = World::space;
  using Equations = EquationList<Coincident, Perpendicular<2, 2>>;
  Mat3 triad() const { return identity(); }
};

Joint<Elbow, Constraint> const joint{};
