// refused: polybody refuses -ffast-math.*checks for NaN
// options: -std=c++20 -O1 -ffast-math
#include <polybody/polybody.hpp>
