#pragma once
/// \file
/// Kinematics of a marker on a rigid body. They are computed in SIMD registers, because every evaluation of a model
/// computes them for every marker. Eigen loads, multiplies and stores each entry of a vector of three numbers
/// separately.
/// Theory: Eqs. 1.1, 1.27.

#include <cstring>

#include <polybody/kinematics/marker_kinematics.hpp>
#include <polybody/math/simd_vector.hpp>
#include <polybody/math/types.hpp>

namespace polybody {

/// Vector of three numbers. With `simd_size` 4 it occupies one SIMD register; with 2, one register and a double. Each
/// function is one expression. The compiler therefore contracts products and sums in the same way as those of doubles.
template <int lanes = simd_size>
class Vec3Storage;

/// Three numbers in a register of four, with an unused last entry.
template <>
class Vec3Storage<4> {
 public:
  /// Loads the three numbers at `from`.
  static Vec3Storage load(double const* from) {
    Half first;
    std::memcpy(&first, from, sizeof first);
    return {__builtin_shufflevector(first, Half{from[2]}, 0, 1, 2, 3)};
  }
  /// Column `i` of `m`.
  static Vec3Storage column(Mat3 const& m, int i) {
    Lanes x;
    std::memcpy(&x, m.data() + (i < 2 ? 3 * i : 5), sizeof x);  // the last register ends at the end of the matrix
    return {i < 2 ? x : __builtin_shufflevector(x, x, 1, 2, 3, 3)};
  }
  /// Linear combination x c₀ + y c₁ + z c₂; `c` points to the three factors.
  static Vec3Storage combination(Vec3Storage const& x, Vec3Storage const& y, Vec3Storage const& z, double const* c) {
    return {x.x_ * c[0] + y.x_ * c[1] + z.x_ * c[2]};
  }
  friend Vec3Storage operator+(Vec3Storage const& a, Vec3Storage const& b) { return {a.x_ + b.x_}; }
  /// a × b.
  friend Vec3Storage cross(Vec3Storage const& a, Vec3Storage const& b) {
    return {a.next().x_ * b.last().x_ - a.last().x_ * b.next().x_};
  }

  /// Stores the three numbers at `to`.
  void store(double* to) const {
    Half const first = __builtin_shufflevector(x_, x_, 0, 1);
    std::memcpy(to, &first, sizeof first);
    to[2] = x_[2];
  }
  /// Stores three columns in `m`.
  static void store_columns(Vec3Storage const& x, Vec3Storage const& y, Vec3Storage const& z, Mat3& m) {
    std::memcpy(m.data(), &x.x_, sizeof x.x_);  // also writes one entry of the next column, which is overwritten below
    std::memcpy(m.data() + 3, &y.x_, sizeof y.x_);
    z.store(m.data() + 6);
  }

 private:
  using Lanes = detail::SimdLanes<4>::Type;
  using Half = detail::SimdLanes<2>::Type;
  Vec3Storage(Lanes const& x) : x_(x) {}  // result of an expression

  Vec3Storage next() const { return {__builtin_shufflevector(x_, x_, 1, 2, 0, 3)}; }
  Vec3Storage last() const { return {__builtin_shufflevector(x_, x_, 2, 0, 1, 3)}; }

  Lanes x_;
};

/// Three numbers in a register of two and a separate double.
template <>
class Vec3Storage<2> {
 public:
  /// Loads the three numbers at `from`.
  static Vec3Storage load(double const* from) {
    Lanes first;
    std::memcpy(&first, from, sizeof first);
    return {first, from[2]};
  }
  /// Column `i` of `m`.
  static Vec3Storage column(Mat3 const& m, int i) { return load(m.data() + 3 * i); }
  /// Linear combination x c₀ + y c₁ + z c₂ with three factors c.
  static Vec3Storage combination(Vec3Storage const& x, Vec3Storage const& y, Vec3Storage const& z, double const* c) {
    return {x.x_ * c[0] + y.x_ * c[1] + z.x_ * c[2], x.z_ * c[0] + y.z_ * c[1] + z.z_ * c[2]};
  }
  friend Vec3Storage operator+(Vec3Storage const& a, Vec3Storage const& b) { return {a.x_ + b.x_, a.z_ + b.z_}; }
  /// a × b.
  friend Vec3Storage cross(Vec3Storage const& a, Vec3Storage const& b) {
    return {Lanes{a.x_[1], a.z_} * Lanes{b.z_, b.x_[0]} - Lanes{a.z_, a.x_[0]} * Lanes{b.x_[1], b.z_},
            a.x_[0] * b.x_[1] - a.x_[1] * b.x_[0]};
  }

  /// Stores the three numbers at `to`.
  void store(double* to) const {
    std::memcpy(to, &x_, sizeof x_);
    to[2] = z_;
  }
  /// Stores three columns in `m`.
  static void store_columns(Vec3Storage const& x, Vec3Storage const& y, Vec3Storage const& z, Mat3& m) {
    x.store(m.data());
    y.store(m.data() + 3);
    z.store(m.data() + 6);
  }

 private:
  using Lanes = detail::SimdLanes<2>::Type;
  Vec3Storage(Lanes const& x, double z) : x_(x), z_(z) {}

  Lanes x_;
  double z_;
};

namespace detail {

/// Writes the marker kinematics of the point u with the axes `axes`, both in body axes, to `out`; `at` is the pose of
/// the body. The result is bitwise identical to that of the scalar loops in `Rigid::evaluate_marker`.
template <class Pose, class V = Vec3Storage<>>  // compiled only if used
void write_rigid_marker(Vec3 const& u, Mat3 const& axes, Pose const& at, MarkerKinematics<double>& out) {
  V const x = V::column(at.A, 0), y = V::column(at.A, 1), z = V::column(at.A, 2), w = V::load(at.w.data());
  auto const turned = [&](double const* by_body) { return V::combination(x, y, z, by_body); };
  V const arm = turned(u.data()), rate = cross(w, arm);
  (V::load(at.r.data()) + arm).store(out.frame.r.data());
  V::store_columns(turned(axes.data()), turned(axes.data() + 3), turned(axes.data() + 6), out.frame.A);
  (V::load(at.v.data()) + rate).store(out.frame.v.data());
  w.store(out.frame.w.data());
  cross(w, rate).store(out.bias.data());
  for (int i = 3; i < 6; ++i) out.bias[i] = 0.0;
  V::store_columns(x, y, z, out.body_axes);
  arm.store(out.arm.data());
}

}  // namespace detail

}  // namespace polybody
