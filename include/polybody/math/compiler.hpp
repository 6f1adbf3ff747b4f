#pragma once
/// \file
/// Requirements on the compiler and its options. Every header of the library except version.hpp includes this file,
/// directly or through other headers, before its first declaration.

// After each #error, a missing file is included. This fatal error ends the compilation, so that no other messages
// follow.
#if (defined(_MSVC_LANG) ? _MSVC_LANG : __cplusplus) < 202002L
#error polybody needs C++20: add -std=c++20 (g++ 12 or newer, clang 16 or newer), or link polybody::polybody in CMake.
#include <the compilation ends here, see the error above>
#elif defined(__apple_build_version__) ? __clang_major__ < 15 : defined(__clang__) && __clang_major__ < 16
#error polybody needs clang 16 (Apple clang 15) or g++ 12, or newer: this clang is too old.
#include <the compilation ends here, see the error above>
#elif defined(__GNUC__) && !defined(__clang__) && __GNUC__ < 12
#error polybody needs g++ 12 or clang 16, or newer: this g++ is too old.
#include <the compilation ends here, see the error above>
#elif defined(__FAST_MATH__) || defined(_M_FP_FAST) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ > 0)
#error polybody refuses -ffast-math, -Ofast and -ffinite-math-only: they remove its checks for NaN. Use -O2 or -O3.
#include <the compilation ends here, see the error above>
#endif
