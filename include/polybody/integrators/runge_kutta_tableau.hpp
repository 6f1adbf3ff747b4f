#pragma once
#include <array>

#include <polybody/math/compiler.hpp>

namespace polybody::detail {

/// Coefficients c_i, a_ij and b_j of the classical method of order four.
struct ClassicalTableau {
  static constexpr int stages = 4;
  using Row = std::array<double, 4>;
  static constexpr Row c{0.0, 0.5, 0.5, 1.0};
  static constexpr std::array<Row, 4> a{Row{}, Row{0.5}, Row{0.0, 0.5}, Row{0.0, 0.0, 1.0}};
  static constexpr Row b{1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
};

/// Coefficients c_i, a_ij and b_j of order five, with the weights of the error [Dormand & Prince 1980]. The seventh
/// stage is evaluated at the result and contributes to the error only.
struct DormandPrinceTableau {
  static constexpr int stages = 6;  ///< number of stages in the result
  using Row = std::array<double, 7>;
  static constexpr Row c{0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0};
  static constexpr std::array<Row, 7> a{Row{},
                                        Row{1.0 / 5},
                                        Row{3.0 / 40, 9.0 / 40},
                                        Row{44.0 / 45, -56.0 / 15, 32.0 / 9},
                                        Row{19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
                                        Row{9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
                                        Row{35.0 / 384, 0.0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}};
  static constexpr Row b = a[6];
  static constexpr Row error{71.0 / 57600, 0.0, -71.0 / 16695, 71.0 / 1920, -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
};

}  // namespace polybody::detail
