// refused: Required
// Physical parameters have no default.
#include <polybody/joints/policies/bushing.hpp>

polybody::Bushing const mount{.stiffness = polybody::Bushing::diagonal({1, 1, 1}, {1, 1, 1})};
