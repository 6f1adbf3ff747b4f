// refused: Required
#include <polybody/joints/screw.hpp>

polybody::Screw screw{};
