#pragma once
/// \file
/// Numerical derivatives for tests, and random frames with a fixed seed.

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <polybody/kinematics/frame.hpp>
#include <polybody/math/compiler.hpp>

namespace polybody::laws {

/// Derivative f′(0) of a function of one number; f returns a double or an Eigen vector. Central differences with the
/// steps h, h/2, …, h/16 are extrapolated to zero, and the value with the least estimated error is returned [Ridders
/// 1982]. The smallest step h/16 must be small compared with the length over which f changes.
template <class F>
auto slope_at_zero(F&& f, double h = 1e-3) {
  using Value = decltype(f(h));
  auto const size = [](Value const& x) {
    if constexpr (requires { x.norm(); })
      return double(x.norm());
    else
      return std::abs(double(x));
  };
  constexpr int steps = 5;
  Value row[steps], last[steps];  // extrapolations of order 0, 1, … with the current step, and without it
  Value best = Value((f(h) - f(-h)) / (2.0 * h));
  double least = std::numeric_limits<double>::infinity();
  last[0] = best;
  for (int i = 1; i < steps; ++i) {
    h /= 2.0;
    row[0] = Value((f(h) - f(-h)) / (2.0 * h));
    for (int j = 1; j <= i; ++j) {
      row[j] = Value(row[j - 1] + (row[j - 1] - last[j - 1]) / (std::ldexp(1.0, 2 * j) - 1.0));
      double const error = std::max(size(Value(row[j] - row[j - 1])), size(Value(row[j] - last[j - 1])));
      if (error < least) {
        least = error;
        best = row[j];
      }
    }
    std::copy(row, row + i + 1, last);
  }
  return best;
}

/// Random numbers in [−size, size] with a fixed seed.
class Numbers {
 public:
  explicit Numbers(unsigned seed = 20240607)
      : generator_(seed) {}  ///< generator; an equal `seed` generates equal numbers

  /// Next number in [−size, size].
  double operator()(double size = 1.0) { return size * (double(generator_()) / 2147483648.0 - 1.0); }
  /// Column (n) of the next n numbers, in [−size, size].
  template <int n>
  Vec<double, n> vec(double size = 1.0) {
    return Vec<double, n>::NullaryExpr([&](Index) { return (*this)(size); });
  }
  /// Column (n) of the next n numbers, in [−size, size].
  VecX vector(Index n, double size = 1.0) {
    return VecX::NullaryExpr(n, [&](Index) { return (*this)(size); });
  }
  /// Random motion [δr; δφ] or twist [ṙ; ω] with entries in [−size, size]. If `planar`, only the components along x and
  /// y and about z are nonzero.
  Vec6 motion(bool planar, double size = 1.0) {
    Vec6 x = vec<6>(size);
    if (planar) x[2] = x[3] = x[4] = 0.0;
    return x;
  }
  /// Frame with random position, orientation and twist. If `planar`, its motion remains in the plane z = 0.
  Frame<double> frame(bool planar = false) {
    Vec6 const place = motion(planar, 2.0), twist = motion(planar);
    return {.r = place.head<3>(), .A = exp_so3<double>(place.tail<3>()), .v = twist.head<3>(), .w = twist.tail<3>()};
  }

 private:
  std::mt19937 generator_;
};

/// Frame with the position r + δr and the axes exp(φ̃) A, after a motion [δr; φ] in world axes. The twist is not
/// changed.
template <StateScalar T>
Frame<T> moved(Frame<double> const& f, Vec<T, 6> const& motion) {
  Vec<T, 3> const phi = motion.template tail<3>();
  return {.r = f.r.cast<T>() + motion.template head<3>(),
          .A = exp_so3<T>(phi) * f.A.cast<T>(),
          .v = f.v.cast<T>(),
          .w = f.w.cast<T>()};
}

/// Frame after a motion with constant twist for `time` [s].
template <StateScalar T>
Frame<T> later(Frame<double> const& f, T const& time) {
  Vec6 twist;
  twist << f.v, f.w;
  return moved<T>(f, twist.cast<T>() * time);
}

/// Frame after a rigid motion of the world: a rotation by `turn` about the origin, then a displacement by `shift` (3)
/// [m].
inline Frame<double> carried(Frame<double> const& f, Mat3 const& turn, Vec3 const& shift) {
  return {.r = turn * f.r + shift, .A = turn * f.A, .v = turn * f.v, .w = turn * f.w};
}

}  // namespace polybody::laws
