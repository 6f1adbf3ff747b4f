// refused: polybody needs (clang 16|g.. 12).*is too old
// options: -std=c++20 -Wno-builtin-macro-redefined
// A compiler of another version, as far as headers read it.
#ifdef __clang__
#undef __clang_major__
#define __clang_major__ 15
#else
#undef __GNUC__
#define __GNUC__ 11
#endif
#include <polybody/polybody.hpp>
