#pragma once
/// \file
/// Vectors of three numbers in the machine's registers. One by one each number is loaded, multiplied and stored by
/// itself; Eigen leaves vectors of three to that.

#include <cstring>

#include <polybody/math/pack.hpp>
#include <polybody/math/types.hpp>

namespace polybody {

/// Three numbers, as `pack_size` of the machine allows: in one register of four, or in one of two and a number. Each
/// function is one expression, so that products and sums are contracted as those of numbers are.
template <int lanes = pack_size>
class Triple;

/// In a register of four, whose last number means nothing.
template <>
class Triple<4> {
 public:
  /// The three numbers at `from`.
  static Triple load(double const* from) {
    Half first;
    std::memcpy(&first, from, sizeof first);
    return {__builtin_shufflevector(first, Half{from[2]}, 0, 1, 2, 3)};
  }
  /// Column `i` of `m`.
  static Triple column(Mat3 const& m, int i) {
    Lanes x;
    std::memcpy(&x, m.data() + (i < 2 ? 3 * i : 5), sizeof x);  // a register ends with the matrix
    return {i < 2 ? x : __builtin_shufflevector(x, x, 1, 2, 3, 3)};
  }
  /// x c₀ + y c₁ + z c₂ for three factors c.
  static Triple combination(Triple const& x, Triple const& y, Triple const& z, double const* c) {
    return {x.x_ * c[0] + y.x_ * c[1] + z.x_ * c[2]};
  }
  friend Triple operator+(Triple const& a, Triple const& b) { return {a.x_ + b.x_}; }
  /// a × b.
  friend Triple cross(Triple const& a, Triple const& b) {
    return {a.next().x_ * b.last().x_ - a.last().x_ * b.next().x_};
  }

  /// Writes the three numbers to `to`.
  void store(double* to) const {
    Half const first = __builtin_shufflevector(x_, x_, 0, 1);
    std::memcpy(to, &first, sizeof first);
    to[2] = x_[2];
  }
  /// Writes columns to `m`.
  static void store_columns(Triple const& x, Triple const& y, Triple const& z, Mat3& m) {
    std::memcpy(m.data(), &x.x_, sizeof x.x_);  // one number too many, which the next column overwrites
    std::memcpy(m.data() + 3, &y.x_, sizeof y.x_);
    z.store(m.data() + 6);
  }

 private:
  using Lanes = detail::LanesOf<4>::Type;
  using Half = detail::LanesOf<2>::Type;
  Triple(Lanes const& x) : x_(x) {}  // NOLINT(google-explicit-constructor): what an expression makes

  Triple next() const { return {__builtin_shufflevector(x_, x_, 1, 2, 0, 3)}; }
  Triple last() const { return {__builtin_shufflevector(x_, x_, 2, 0, 1, 3)}; }

  Lanes x_;
};

/// In a register of two, and a number.
template <>
class Triple<2> {
 public:
  /// The three numbers at `from`.
  static Triple load(double const* from) {
    Lanes first;
    std::memcpy(&first, from, sizeof first);
    return {first, from[2]};
  }
  /// Column `i` of `m`.
  static Triple column(Mat3 const& m, int i) { return load(m.data() + 3 * i); }
  /// x c₀ + y c₁ + z c₂ for three factors c.
  static Triple combination(Triple const& x, Triple const& y, Triple const& z, double const* c) {
    return {x.x_ * c[0] + y.x_ * c[1] + z.x_ * c[2], x.z_ * c[0] + y.z_ * c[1] + z.z_ * c[2]};
  }
  friend Triple operator+(Triple const& a, Triple const& b) { return {a.x_ + b.x_, a.z_ + b.z_}; }
  /// a × b.
  friend Triple cross(Triple const& a, Triple const& b) {
    return {Lanes{a.x_[1], a.z_} * Lanes{b.z_, b.x_[0]} - Lanes{a.z_, a.x_[0]} * Lanes{b.x_[1], b.z_},
            a.x_[0] * b.x_[1] - a.x_[1] * b.x_[0]};
  }

  /// Writes the three numbers to `to`.
  void store(double* to) const {
    std::memcpy(to, &x_, sizeof x_);
    to[2] = z_;
  }
  /// Writes columns to `m`.
  static void store_columns(Triple const& x, Triple const& y, Triple const& z, Mat3& m) {
    x.store(m.data());
    y.store(m.data() + 3);
    z.store(m.data() + 6);
  }

 private:
  using Lanes = detail::LanesOf<2>::Type;
  Triple(Lanes const& x, double z) : x_(x), z_(z) {}

  Lanes x_;
  double z_;
};

}  // namespace polybody
