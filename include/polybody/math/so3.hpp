#pragma once
/// \file
/// Rotations in space: exponential map, its Jacobians and their inverse, accurate near zero rotation. The logarithm is
/// in quaternion.hpp.
///
/// Convention: A = exp(φ̃) transforms components of vectors from body axes to world axes; φ̃ is `skew(φ)`. Increments act
/// on the right (body axes), A ⊞ δ = A exp(δ̃). [Solà, Deray & Atchuthan 2018, eqs. 132–146; Brüls, Cardona & Arnold
/// 2012, App. A]
/// Theory: Eqs. 1.6 to 1.14.

#include <array>

#include <polybody/math/dual.hpp>
#include <polybody/math/vector_algebra.hpp>

namespace polybody {

/// Matrix 1 + b ã + c ã² (3×3) for the vector a, with ã = `skew(a)`. Explicit entries compile faster than matrix
/// products of Eigen.
template <class T>
Mat<T, 3, 3> one_and_skew(Vec<T, 3> const& a, T const& b, T const& c) {
  Mat<T, 3, 3> m;
  for (int i = 0; i < 3; ++i) {
    int const j = (i + 1) % 3, k = (i + 2) % 3;
    T const odd = a[k] * b, even = a[i] * a[j] * c;
    m(i, i) = 1.0 - (a[j] * a[j] + a[k] * a[k]) * c;
    m(j, i) = even + odd;
    m(i, j) = even - odd;
  }
  return m;
}

namespace detail {
/// Inverse factorials 1/k!, k = 0 … 19.
inline constexpr auto inverse_factorials = [] {
  std::array<double, 20> f{1.0};
  for (std::size_t k = 1; k < f.size(); ++k) f[k] = f[k - 1] / double(k);
  return f;
}();
}  // namespace detail

/// Coefficients of the exponential map as functions of x = |φ|²: a = sin θ/θ, b = (1 − cos θ)/θ², θ = √x. Near zero
/// they are evaluated by series.
template <class T>
struct ExpSeries {
  T a, b;  ///< coefficients a and b, without unit; φ in [rad]
  /// Evaluates the coefficients at x = |φ|² [rad²].
  explicit ExpSeries(T const& x) {
    using std::cos, std::sin, std::sqrt;
    if (value_of(x) < 0.25) {
      a = series(x, 1);
      b = series(x, 2);
    } else {
      T const angle = sqrt(x);
      T const half = sin(0.5 * angle);
      a = sin(angle) / angle;
      b = 2.0 * half * half / x;
    }
  }

  /// Sum Σ (−x)ᵏ/(n + 2k)! by Horner's rule. Five terms are sufficient for x < 1e-3 (typical of the rotation in one
  /// step), eight for x < 1/4. The first neglected term is below 1e-19.
  static T series(T const& x, int n) { return value_of(x) < 1e-3 ? series_of<5>(x, n) : series_of<8>(x, n); }

 private:
  template <int terms>
  static T series_of(T const& x, int n) {
    T sum(detail::inverse_factorials[std::size_t(n + 2 * terms - 2)]);
    for (int k = n + 2 * terms - 4; k >= n; k -= 2) sum = detail::inverse_factorials[std::size_t(k)] - x * sum;
    return sum;
  }
};

/// Coefficients a and b of the exponential map, and the coefficient c = (θ − sin θ)/θ³ of its Jacobian, θ = |φ|.
template <class T>
struct RotationSeries : ExpSeries<T> {
  T c;  ///< coefficient c, without unit
  /// Evaluates the coefficients at x = |φ|² [rad²].
  explicit RotationSeries(T const& x)
      : ExpSeries<T>(x), c(value_of(x) < 0.25 ? this->series(x, 3) : T((1.0 - this->a) / x)) {}
};

/// Derivatives of the coefficients b and c of `RotationSeries` with respect to x = |φ|²: db/dx = d − c/2 and dc/dx =
/// (3e − d)/2 with d = (½ − b)/x, e = (1/6 − c)/x.
template <class T>
struct RotationDerivatives {
  T b, c;  ///< db/dx and dc/dx [1/rad²]
  /// Evaluates the derivatives at x = |φ|² [rad²].
  explicit RotationDerivatives(T const& x) {
    RotationSeries<T> const s(x);
    bool const small = value_of(x) < 0.25;
    T const d = small ? s.series(x, 4) : T((0.5 - s.b) / x);
    T const e = small ? s.series(x, 5) : T((1.0 / 6.0 - s.c) / x);
    b = d - 0.5 * s.c;
    c = 1.5 * e - 0.5 * d;
  }
};

/// Functions a = atan t/t and m = (1 − a)/t² of z = t² with their derivatives da/dz, dm/dz. Near zero they are
/// evaluated by series. A rotation by θ about the unit vector n with c = t n, t = tan(θ/4), has the rotation vector
/// 4 a c.
template <class T>
struct ArctanSeries {
  T a, m, da, dm;  ///< functions and derivatives with respect to z, without unit
  /// Evaluates the functions at z = t².
  explicit ArctanSeries(T const& z) {
    using std::atan, std::sqrt;
    if (value_of(z) < 0.1) {  // m = Σ (−z)ᵏ/(2k + 3); the error of sixteen terms is 1e-17
      m = dm = T(0.0);
      for (int k = 15; k >= 0; --k) {
        dm = m - z * dm;
        m = 1.0 / (2 * k + 3) - z * m;
      }
      dm = -dm;
      a = 1.0 - z * m;
      da = -m - z * dm;
    } else {
      T const t = sqrt(z);
      a = atan(t) / t;
      m = (1.0 - a) / z;
      da = (1.0 / (1.0 + z) - a) / (2.0 * z);
      dm = -(da + m) / z;
    }
  }
};

/// Rotation matrix exp(φ̃) = 1 + a φ̃ + b φ̃² (Rodrigues), 3×3, with a, b of `RotationSeries`; φ in [rad].
template <class T>
Mat<T, 3, 3> exp_so3(Vec<T, 3> const& phi) {
  RotationSeries<T> const s(squared_norm(phi));
  return one_and_skew<T>(phi, s.a, s.b);
}

/// Right Jacobian Jr(φ) = 1 − b φ̃ + c φ̃², 3×3, with b, c of `RotationSeries`: exp(φ + δ) ≈ exp(φ) exp(Jr δ), and
/// ω_body = Jr φ̇.
template <class T>
Mat<T, 3, 3> right_jacobian(Vec<T, 3> const& phi) {
  RotationSeries<T> const s(squared_norm(phi));
  return one_and_skew<T>(phi, -s.b, s.c);
}

/// Left Jacobian Jl(φ) = Jr(−φ), 3×3: ω_world = Jl φ̇.
template <class T>
Mat<T, 3, 3> left_jacobian(Vec<T, 3> const& phi) {
  return right_jacobian<T>({-phi[0], -phi[1], -phi[2]});
}

/// Inverse right Jacobian Jr(φ)⁻¹ = 1 + ½ φ̃ + e φ̃², e = (1 − a/(2b))/|φ|², for |φ| < 2π, with a, b of
/// `RotationSeries`.
template <class T>
Mat<T, 3, 3> right_jacobian_inverse(Vec<T, 3> const& phi) {
  T const x = squared_norm(phi);
  RotationSeries<T> const s(x);
  T e;
  if (value_of(x) < 0.25) {
    // (θ/2) cot(θ/2) = 1 − Σ |B₂ₖ| θ²ᵏ/(2k)!, B the Bernoulli numbers
    e = 1.0 / 12.0 +
        x * (1.0 / 720.0 +
             x * (1.0 / 30240.0 + x * (1.0 / 1209600.0 + x * (1.0 / 47900160.0 + x * (691.0 / 1307674368000.0 +
                                                                                      x * (1.0 / 74724249600.0))))));
  } else {
    e = (1.0 - s.a / (2.0 * s.b)) / x;
  }
  return one_and_skew<T>(phi, T(0.5), e);
}

/// Derivative ∂(Jr(φ) x)/∂φ at constant x, 3×3:
///   2 (c′ φ × (φ × x) − b′ φ × x) φᵀ + b x̃ − c ((φ × x)~ + φ̃ x̃), with the derivatives b′, c′ of b, c
///   (`RotationDerivatives`).
template <class T>
Mat<T, 3, 3> right_jacobian_derivative(Vec<T, 3> const& phi, Vec<T, 3> const& x) {
  T const angle2 = squared_norm(phi), along_x = dot(phi, x);
  RotationSeries<T> const s(angle2);
  RotationDerivatives<T> const slope(angle2);
  Vec<T, 3> const once = cross(phi, x), twice = cross(phi, once);
  Mat<T, 3, 3> const of_x = skew(x), of_once = skew(once);
  Mat<T, 3, 3> d;
  for (int i = 0; i < 3; ++i) {
    T const along = (twice[i] * slope.c - once[i] * slope.b) * 2.0;
    for (int j = 0; j < 3; ++j) {
      T const both = i == j ? T(x[i] * phi[j] - along_x) : T(x[i] * phi[j]);  // φ̃ x̃ = x φᵀ − (φ·x) 1
      d(i, j) = along * phi[j] + of_x(i, j) * s.b - (of_once(i, j) + both) * s.c;
    }
  }
  return d;
}

}  // namespace polybody
