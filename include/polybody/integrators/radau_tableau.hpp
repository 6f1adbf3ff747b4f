#pragma once
#include <polybody/math/block_sink.hpp>

namespace polybody::detail {

/// Coefficients a_ij and c_i of the Radau IIA method with three stages [Hairer & Wanner 1996, Table IV.5.6].
struct RadauTableau {
  static constexpr double r6 = 2.449489742783178;
  static constexpr double c[3] = {(4.0 - r6) / 10.0, (4.0 + r6) / 10.0, 1.0};
  static constexpr double a[3][3] = {
      {(88.0 - 7.0 * r6) / 360.0, (296.0 - 169.0 * r6) / 1800.0, (-2.0 + 3.0 * r6) / 225.0},
      {(296.0 + 169.0 * r6) / 1800.0, (88.0 + 7.0 * r6) / 360.0, (-2.0 - 3.0 * r6) / 225.0},
      {(16.0 - r6) / 36.0, (16.0 + r6) / 36.0, 1.0 / 9.0}};
  /// (A²)_ij.
  static constexpr double squared(int i, int j) { return a[i][0] * a[0][j] + a[i][1] * a[1][j] + a[i][2] * a[2][j]; }

  /// Lagrange polynomial of node j at s, and its integral from 0 to s.
  struct Inside {
    double value, integral;
  };
  static constexpr Inside inside(std::size_t j, double s) {
    double const k = c[(j + 1) % 3], l = c[(j + 2) % 3], scale = (c[j] - k) * (c[j] - l);
    return {(s - k) * (s - l) / scale, s * (s * (s / 3.0 - 0.5 * (k + l)) + k * l) / scale};
  }
};

/// Shifts the blocks of one stage to their position in the matrix of all stages. Off-diagonal stage blocks omit G and
/// Gᵀ.
struct StageBlockSink {
  BlockSink& sink;
  Index row0, col0, velocities;
  void add(Index row, Index col, BlockView const& b) {
    if (row0 == col0 || (row < velocities && col < velocities)) sink.add(row0 + row, col0 + col, b);
  }
};

}  // namespace polybody::detail
