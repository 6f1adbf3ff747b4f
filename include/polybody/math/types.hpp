#pragma once
/// \file
/// Vectors, matrices and checks of numbers for all layers.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

#include <polybody/math/errors.hpp>

namespace polybody {

using Index = Eigen::Index;  ///< type of counts and indices

/// Column of n scalars.
template <class T, int n>
using Vec = Eigen::Matrix<T, n, 1>;
/// Matrix of m rows and n columns.
template <class T, int m, int n>
using Mat = Eigen::Matrix<T, m, n>;

using Vec2 = Vec<double, 2>;     ///< column of two doubles
using Vec3 = Vec<double, 3>;     ///< column of three doubles
using Vec4 = Vec<double, 4>;     ///< column of four doubles
using Vec6 = Vec<double, 6>;     ///< column of six doubles
using Mat3 = Mat<double, 3, 3>;  ///< 3×3 matrix of doubles
using VecX = Eigen::VectorXd;    ///< column of doubles of run-time length
using MatX = Eigen::MatrixXd;    ///< matrix of doubles of run-time size

/// Column of scalars T of run-time length.
template <class T>
using VecXOf = Eigen::Matrix<T, Eigen::Dynamic, 1>;
/// Matrix of scalars T of run-time size.
template <class T>
using MatXOf = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;

/// The type double, written as a type that depends on T. An expression of this type is compiled where the template is
/// instantiated, not where it is defined.
template <class T>
using RealFor = std::conditional_t<true, double, T>;

namespace detail {
/// `M::Zero()` without a separate expression type for each M.
template <class M>
M zeros() {
  M m;
  for (int i = 0; i < int(M::SizeAtCompileTime); ++i) m.data()[i] = typename M::Scalar(0.0);
  return m;
}
}  // namespace detail

/// Identity matrix, 3×3, as a matrix and not as an expression of Eigen.
template <class T = double>
Mat<T, 3, 3> identity() {
  auto m = detail::zeros<Mat<T, 3, 3>>();
  for (int i = 0; i < 3; ++i) m(i, i) = T(1.0);
  return m;
}

/// Number without a default value, for physical data. A program that omits it does not compile.
template <class T>
struct Required {
  T value;  ///< given value
  /// Converts the value `v` of type T: `.mass = 2.0` sets a `Required<double>`.
  constexpr Required(T v) : value(v) {}  // NOLINT(google-explicit-constructor): reads as a T
  /// Converts an expression `x` that is convertible to T.
  template <class X>
    requires std::is_class_v<X> && (!std::is_same_v<X, Required>) && std::is_convertible_v<X const&, T>
  constexpr Required(X const& x) : value(x) {}  // NOLINT(google-explicit-constructor)
  /// Returns the given value.
  constexpr operator T() const { return value; }  // NOLINT(google-explicit-constructor)
};

/// \throws InvalidInput unless `x` is finite and positive. The message begins with `what`, which names the object and
/// the quantity, and with `part`; `unit` is the unit of x, empty for a pure number.
inline void require_positive(double x, std::string_view what, std::string_view part = {}, std::string_view unit = {}) {
  if (!(x > 0.0) || !std::isfinite(x))
    throw InvalidInput("value.not_positive", {ErrorObject{what}, part, " must be positive and finite, but is ",
                                              ErrorValue{x}, unit.empty() ? "" : " ", unit, "."});
}

/// \throws InvalidInput unless `x` is finite and not negative; `unit` is its unit.
inline void require_not_negative(double x, std::string_view what, std::string_view part = {},
                                 std::string_view unit = {}) {
  if (!(x >= 0.0) || !std::isfinite(x))
    throw InvalidInput("value.negative", {ErrorObject{what}, part, " must be zero or positive, and finite, but is ",
                                          ErrorValue{x}, unit.empty() ? "" : " ", unit, "."});
}

/// \throws InvalidInput unless 1 ≤ n ≤ 10⁶, the allowed range of counts.
inline void require_count(int n, std::string_view what, std::string_view part = {}) {
  if (n < 1 || n > 1'000'000)
    throw InvalidInput("value.count",
                       {ErrorObject{what}, part, " must lie in [1, 1000000], but is ", ErrorValue{n}, "."});
}

/// \throws InvalidInput unless every entry of `x` is finite; `unit` is their unit.
template <class Derived>
void require_finite(Eigen::MatrixBase<Derived> const& x, std::string_view what, std::string_view part = {},
                    std::string_view unit = {}) {
  typename Derived::PlainObject const& m = x.derived();  // evaluates an expression; loops compile fast
  for (Index j = 0; j < m.cols(); ++j)
    for (Index i = 0; i < m.rows(); ++i)
      if (!std::isfinite(m(i, j)))
        throw InvalidInput("value.not_finite", {ErrorObject{what}, part, " must be finite, but has an entry ",
                                                ErrorValue{m(i, j)}, unit.empty() ? "" : " ", unit, "."});
}

/// \throws InvalidInput unless `x` is finite; `unit` is its unit.
inline void require_finite(double x, std::string_view what, std::string_view part = {}, std::string_view unit = {}) {
  if (!std::isfinite(x))
    throw InvalidInput("value.not_finite", {ErrorObject{what}, part, " must be finite, but is ", ErrorValue{x},
                                            unit.empty() ? "" : " ", unit, "."});
}

/// Largest allowed magnitude of a number. Its square is finite, with a margin for energies and norms.
inline constexpr double largest_number = 1e150;

/// Index of the first entry of `x` that is NaN, infinite or beyond `largest_number`; −1 if there is none.
inline Index first_not_finite(VecX const& x) {
  for (Index i = 0; i < x.size(); ++i)
    if (!(std::abs(x[i]) <= largest_number)) return i;
  return -1;
}
/// \throws InvalidInput unless `x` is zero or |x| lies in [1e-150, 1e150]. The square of `x` then neither overflows nor
/// underflows.
inline void require_size(double x, std::string_view what, std::string_view part = {}) {
  if (x != 0.0 && !(std::abs(x) >= 1.0 / largest_number && std::abs(x) <= largest_number))
    throw InvalidInput("value.magnitude",
                       {ErrorObject{what}, part, " must be zero or have a magnitude in [1e-150, 1e+150], but is ",
                        ErrorValue{x}, ". The square of a number outside this range overflows or underflows."});
}
/// Text for messages: " is not finite", or a finite x with the limit `largest_number` that it exceeds.
template <class = void>  // compiled where it is used
std::string non_finite_suffix(double x) {
  return std::isfinite(x)
             ? " is " + number(x) + ", beyond " + number(largest_number) + ", the largest allowed magnitude,"
             : " is not finite";
}

/// Maximum norm max |xᵢ|: zero for an empty vector, NaN if an entry is NaN.
inline double largest_size(VecX const& x) {
  double largest = 0.0;
  for (Index i = 0; i < x.size(); ++i) {
    if (std::abs(x[i]) <= largest) continue;
    largest = std::abs(x[i]);
    if (std::isnan(largest)) break;
  }
  return largest;
}

/// \throws InvalidInput unless `axis` has length one (to 1e-9).
inline void require_unit(Vec3 const& axis, std::string_view what, std::string_view part = {}) {
  require_finite(axis, what, part);
  double const length = std::sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
  if (std::abs(length - 1.0) > 1e-9)

    throw InvalidInput("value.not_unit", {ErrorObject{what}, part, " must be a unit vector, but has length ",
                                          ErrorValue{length}, ". Normalise it."});
}

}  // namespace polybody
