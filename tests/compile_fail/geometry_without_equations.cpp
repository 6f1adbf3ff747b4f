// refused: A joint geometry needs a list of 1 to 6 constraint equations
#include <polybody/joints/joint.hpp>

using namespace polybody;

struct Wire {
  static constexpr char const* name = "Wire";
  static constexpr World world = World::space;
  Mat3 triad() const { return identity(); }
};

Joint<Wire, Constraint> const joint{};
