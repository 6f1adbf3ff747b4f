// refused: polybody needs C.*20: add -std=c.*20
// options: -std=c++17
#include <polybody/math/sequence.hpp>
