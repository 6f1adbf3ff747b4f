#pragma once
/// \file Reference numbers in a text file: one row per line, # begins a comment.

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace polybody {

inline std::vector<std::vector<double>> number_rows(std::string const& file) {
  std::ifstream in(file);
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream words(line);
    rows.emplace_back();
    for (double x; words >> x;) rows.back().push_back(x);
  }
  return rows;
}

/// All numbers, one row after the other.
inline std::vector<double> numbers_of(std::string const& file) {
  std::vector<double> numbers;
  for (auto const& row : number_rows(file)) numbers.insert(numbers.end(), row.begin(), row.end());
  return numbers;
}

}  // namespace polybody
