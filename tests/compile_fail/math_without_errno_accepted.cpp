// accepted
// options: -std=c++20 -O3 -fno-math-errno -fno-trapping-math
#include <polybody/math/types.hpp>
