#pragma once
// The chain by Simbody, whose headers do not compile as C++20.
#include "falling_chain.hpp"

namespace falling_chain {

Call simbody_call(int links);
/// By Runge–Kutta–Merson at this accuracy.
Second simbody_second(int links, double accuracy);

}  // namespace falling_chain
