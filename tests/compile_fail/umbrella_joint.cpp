// refused: This geometry is nonholonomic
#include <polybody/polybody.hpp>

polybody::Joint<polybody::KnifeEdge, polybody::Penalty> const joint{{}, {.stiffness = 1e7, .damping = 1e3}};
