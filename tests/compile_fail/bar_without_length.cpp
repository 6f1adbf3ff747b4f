// refused: Required
#include <polybody/bodies/shared/bar.hpp>

polybody::Bar bar{.section = polybody::Circle{.radius = 0.1}};
