// The loops over dumbbells, compiled once for all programs of a project.
#include "dumbbell.hpp"

template struct polybody::BodyKernels<own::Dumbbell, double>;
