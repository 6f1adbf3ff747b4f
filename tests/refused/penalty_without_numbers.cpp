// refused: Required
// Physical parameters have no default.
#include <polybody/joints/joint.hpp>
#include <polybody/joints/spherical.hpp>

polybody::Joint<polybody::Spherical, polybody::Penalty> joint{};
