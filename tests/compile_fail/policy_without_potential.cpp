// refused: A compliant policy needs potential
#include <polybody/joints/joint.hpp>
#include <polybody/joints/standard_joints.hpp>

using namespace polybody;

struct Mount : Penalty {
  void potential() const {}  // hides the overload with an argument
};

Joint<Spherical, Mount> const joint{{}, {{.stiffness = 1.0, .damping = 0.0}}};
