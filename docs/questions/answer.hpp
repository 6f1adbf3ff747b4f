#pragma once
// Output of the programs of docs/twenty_questions.md: one line for each number that is compared with its right value.
#include <cmath>
#include <cstdio>

inline int& wrong_answers() {
  static int count = 0;
  return count;
}

/// Prints a quantity with its right value, the value of polybody and the tolerance, separated by tabs.
inline void answer(char const* quantity, double right, double ours, double tolerance) {
  std::printf("%s\t%.12g\t%.12g\t%.6g\n", quantity, right, ours, tolerance);
  if (!(std::abs(ours - right) <= tolerance)) ++wrong_answers();
}
