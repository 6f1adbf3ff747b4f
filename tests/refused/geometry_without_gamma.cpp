// refused: A joint geometry needs gamma
#include <polybody/joints/joint.hpp>
#include <polybody/joints/point_on_line.hpp>

using namespace polybody;

struct Wire : PointOnLine {
  void gamma() const {}  // hides the overload with arguments
};

Joint<Wire, Constraint> const joint{};
