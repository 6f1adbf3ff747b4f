#pragma once
/// \file
/// Common parts of the targets for Matrix Market and node files: an independent word count, and numbers as text.

#include <sstream>

#include "fuzz/target.hpp"

namespace polybody::fuzz {

/// Number of words before the comment character for each line with at least one word.
inline std::vector<std::size_t> words_of_lines(std::string_view text, char comment) {
  std::vector<std::size_t> counts;
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line.substr(0, line.find(comment)));
    std::size_t count = 0;
    for (std::string word; words >> word;) ++count;
    if (count > 0) counts.push_back(count);
  }
  return counts;
}

inline std::string digits(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

}  // namespace polybody::fuzz
