// refused: Required
#include <polybody/joints/standard_joints.hpp>

polybody::Screw screw{};
