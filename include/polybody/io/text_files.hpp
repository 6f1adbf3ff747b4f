#pragma once
/// \file
/// Text of a double that reads back to the same double, and the content of a file as a string.

#include <charconv>
#include <filesystem>
#include <fstream>
#include <optional>
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

// Content of a file as a string.

/// Returns the content of a file, or nothing if it cannot be read, for example because it is a folder.
template <class = void>  // compiled where it is used
std::optional<std::string> content_of(std::filesystem::path const& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string text;
  for (char block[4096]; stream.read(block, sizeof block), stream.gcount() > 0;)
    text.append(block, static_cast<std::size_t>(stream.gcount()));
  if (!stream.is_open() || stream.bad()) return std::nullopt;
  return text;
}

}  // namespace polybody::detail
