// refused: polybody refuses -ffast-math.*checks for NaN
// options: -std=c++20 -O1 -ffinite-math-only
#include <polybody/forces/springs.hpp>
