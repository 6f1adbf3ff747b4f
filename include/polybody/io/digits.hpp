#pragma once
/// \file
/// Shortest decimal text of a double that reads back to the same double.

#include <charconv>
#include <string>

#include <polybody/math/compiler.hpp>

namespace polybody::detail {

/// Appends the number x to `text`, in the shortest form that reads back to the same double.
inline void append_digits(std::string& text, double x) {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, x).ptr);
}
/// Number x as text, in the shortest form that reads back to the same double.
inline std::string all_digits(double x) {
  std::string text;
  append_digits(text, x);
  return text;
}

}  // namespace polybody::detail
