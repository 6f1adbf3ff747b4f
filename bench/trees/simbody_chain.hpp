#pragma once
// The chain of bench/trees.cpp in Simbody. A separate file compiles it, because the headers of Simbody do not compile
// as C++20.
#include "falling_chain.hpp"

namespace falling_chain {

Call simbody_call(int links);
/// One second of motion with the Runge–Kutta–Merson method.
Second simbody_second(int links);

}  // namespace falling_chain
