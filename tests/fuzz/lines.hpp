#pragma once
/// \file
/// What the targets of Matrix Market and node files share: an independent count of words, and numbers written out.

#include <sstream>

#include "fuzz/target.hpp"

namespace polybody::fuzz {

/// The number of words in each line that has any before the comment character.
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
