// refused: This geometry is nonholonomic
// A penalty on a velocity would be a damper.
#include <polybody/joints/joint.hpp>
#include <polybody/joints/nonholonomic.hpp>
#include <polybody/joints/policies/penalty.hpp>

polybody::Joint<polybody::KnifeEdge, polybody::Penalty> const joint{{}, {.stiffness = 1e7, .damping = 1e3}};
