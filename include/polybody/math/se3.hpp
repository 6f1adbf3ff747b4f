#pragma once
/// \file
/// Rigid motions in space, the group SE(3): exponential map, logarithm, tangent operators and their derivatives,
/// accurate near zero.
///
/// Convention: a motion H = (A, r) carries the point u to r + A u. Vectors of its Lie algebra are screws (p, φ) with
/// the translation first. Increments act on the right, H exp(δ), so that Ḣ = H V has the twist V = (Aᵀ ṙ, Ω) in body
/// axes. All operators on screws are matrices [X, Y; 0, X] of 6×6, where X is the operator on rotations, and Y its
/// derivative for φ in the direction p: SE(3) follows from SO(3) by dual numbers φ + ε p [Brodsky & Shoham 1999;
/// Sonneville, Cardona & Brüls 2014, App. A].
/// Theory: Eqs. 2.101 to 2.105.

#include <array>

#include <polybody/math/quaternion.hpp>

namespace polybody {

/// Element (p, φ) of se(3): a motion [m], [rad], its rate, or a twist (U, Ω) in body axes [m/s], [rad/s].
template <class T>
struct ScrewVector {
  Vec<T, 3> translation;  ///< (3) p, or the velocity U
  Vec<T, 3> rotation;     ///< (3) φ, or the angular velocity Ω
};

/// Screw −x.
template <class T>
ScrewVector<T> opposite(ScrewVector<T> const& x) {
  return {scaled<T>(x.translation, -1.0), scaled<T>(x.rotation, -1.0)};
}
/// Screw s x for the number `s`.
template <class T>
ScrewVector<T> scaled(ScrewVector<T> const& x, double s) {
  return {scaled<T>(x.translation, s), scaled<T>(x.rotation, s)};
}
/// Difference x − y of screws.
template <class T>
ScrewVector<T> difference(ScrewVector<T> const& x, ScrewVector<T> const& y) {
  return {difference<T>(x.translation, y.translation), difference<T>(x.rotation, y.rotation)};
}
/// Sum x + y of screws.
template <class T>
ScrewVector<T> sum(ScrewVector<T> const& x, ScrewVector<T> const& y) {
  ScrewVector<T> out = x;
  for (int i = 0; i < 3; ++i) {
    out.translation[i] += y.translation[i];
    out.rotation[i] += y.rotation[i];
  }
  return out;
}
/// Lie bracket [x, y] = (φ × y_p + p × y_φ, φ × y_φ) of screws x = (p, φ) and y.
template <class T>
ScrewVector<T> bracket(ScrewVector<T> const& x, ScrewVector<T> const& y) {
  Vec<T, 3> const a = cross(x.rotation, y.translation), b = cross(x.translation, y.rotation);
  return {{a[0] + b[0], a[1] + b[1], a[2] + b[2]}, cross(x.rotation, y.rotation)};
}

/// Linear map [X, Y; 0, X] of screws (6×6).
template <class T>
struct ScrewMap {
  Mat<T, 3, 3> diagonal;  ///< X
  Mat<T, 3, 3> coupling;  ///< Y

  /// Screw (X p + Y φ, X φ).
  ScrewVector<T> operator()(ScrewVector<T> const& x) const {
    Vec<T, 3> p = product(diagonal, x.translation);
    Vec<T, 3> const more = product(coupling, x.rotation);
    for (int i = 0; i < 3; ++i) p[i] += more[i];
    return {p, product(diagonal, x.rotation)};
  }
  /// Transposed map of a wrench w = (f; m), with the force in `translation`: (Xᵀ f, Yᵀ f + Xᵀ m).
  ScrewVector<T> pull(ScrewVector<T> const& w) const {
    Vec<T, 3> m = transposed_product(diagonal, w.rotation);
    Vec<T, 3> const more = transposed_product(coupling, w.translation);
    for (int i = 0; i < 3; ++i) m[i] += more[i];
    return {transposed_product(diagonal, w.translation), m};
  }
  /// Full matrix, 6×6.
  Mat<T, 6, 6> full() const {
    Mat<T, 6, 6> m;
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) {
        m(i, j) = m(3 + i, 3 + j) = diagonal(i, j);
        m(i, 3 + j) = coupling(i, j);
        m(3 + i, j) = T(0.0);
      }
    return m;
  }
};

/// Product a b of maps of screws.
template <class T>
ScrewMap<T> product(ScrewMap<T> const& a, ScrewMap<T> const& b) {
  ScrewMap<T> out{product(a.diagonal, b.diagonal), product(a.diagonal, b.coupling)};
  Mat<T, 3, 3> const more = product(a.coupling, b.diagonal);
  for (int i = 0; i < 9; ++i) out.coupling.data()[i] += more.data()[i];
  return out;
}
/// Map [Xᵀ, Yᵀ; 0, Xᵀ]. For an operator of this header at d, this is the operator at −d.
template <class T>
ScrewMap<T> blockwise_transposed(ScrewMap<T> const& a) {
  return {transposed(a.diagonal), transposed(a.coupling)};
}
/// Sum a + b of maps of screws.
template <class T>
ScrewMap<T> sum(ScrewMap<T> a, ScrewMap<T> const& b) {
  for (int i = 0; i < 9; ++i) {
    a.diagonal.data()[i] += b.diagonal.data()[i];
    a.coupling.data()[i] += b.coupling.data()[i];
  }
  return a;
}
/// Map s a for the number `s`.
template <class T>
ScrewMap<T> scaled(ScrewMap<T> a, double s) {
  for (int i = 0; i < 9; ++i) {
    a.diagonal.data()[i] *= s;
    a.coupling.data()[i] *= s;
  }
  return a;
}
/// Map y → [x, y] of the screw x.
template <class T>
ScrewMap<T> bracket_map(ScrewVector<T> const& x) {
  return {skew<T>(x.rotation), skew<T>(x.translation)};
}

/// Coefficients f, g of the operator 1 + f φ̃ + g φ̃² on rotations, and their derivatives with respect to x = |φ|².
template <class T>
struct OperatorSeries {
  T f, g;      ///< coefficients, without unit
  T df, dg;    ///< first derivatives
  T ddf, ddg;  ///< second derivatives
};

namespace detail {

/// Functions s_n(x) = Σ (−x)ᵏ/(n + 2k)!, n = 1 … 7, of x = θ²: s₁ = sin θ/θ, s₂ = (1 − cos θ)/θ². They satisfy
/// s_n = 1/n! − x s_{n+2} and s_n′ = ½ (n s_{n+2} − s_{n+1}).
template <class T>
class SineSeries {
 public:
  explicit SineSeries(T const& x) {
    if (value_of(x) < 4.0) {
      bool const small = value_of(x) < 0.04;
      s_[6] = small ? sum<5>(x, 6) : sum<12>(x, 6);
      s_[7] = small ? sum<5>(x, 7) : sum<12>(x, 7);
      for (int n = 5; n > 0; --n) s_[n] = inverse(n) - x * s_[n + 2];
    } else {
      ExpSeries<T> const s(x);
      s_[1] = s.a;
      s_[2] = s.b;
      for (int n = 1; n < 6; ++n) s_[n + 2] = (inverse(n) - s_[n]) / x;
    }
  }
  T const& operator[](int n) const { return s_[n]; }                                 ///< s_n
  T slope(int n) const { return 0.5 * (double(n) * s_[n + 2] - s_[n + 1]); }         ///< s_n′
  T second(int n) const { return 0.5 * (double(n) * slope(n + 2) - slope(n + 1)); }  ///< s_n″

 private:
  static constexpr double inverse(int n) {
    double f = 1.0;
    for (int k = 2; k <= n; ++k) f /= k;
    return f;
  }
  template <int terms>
  static T sum(T const& x, int n) {
    static constexpr auto inverses = [] {
      std::array<double, 2 * terms + 6> f{};
      for (std::size_t k = 0; k < f.size(); ++k) f[k] = inverse(int(k));
      return f;
    }();
    T out(inverses[std::size_t(n + 2 * terms - 2)]);
    for (int k = n + 2 * terms - 4; k >= n; k -= 2) out = inverses[std::size_t(k)] - x * out;
    return out;
  }
  T s_[8];
};

/// Series c_k of e = (1 − (θ/2) cot(θ/2))/θ² = Σ c_k xᵏ. From x e′ = 1/8 − 3/2 e + ½ x e² follow c₀ = 1/12 and
/// (2k + 3) c_k = Σ c_i c_{k−1−i}.
inline constexpr auto cotangent_series = [] {
  std::array<double, 20> c{1.0 / 12.0};
  for (std::size_t k = 1; k < c.size(); ++k) {
    for (std::size_t i = 0; i < k; ++i) c[k] += c[i] * c[k - 1 - i];
    c[k] /= 2.0 * double(k) + 3.0;
  }
  return c;
}();

/// Series c_k of g = (θ/2)/sin(θ/2) = Σ c_k xᵏ, the inverse of Σ s_k xᵏ, s_k = (−¼)ᵏ/(2k + 1)!.
inline constexpr auto inverse_sine_series = [] {
  std::array<double, 20> c{1.0}, s{1.0};
  for (std::size_t k = 1; k < c.size(); ++k) {
    s[k] = -s[k - 1] / (8.0 * double(k) * (2.0 * double(k) + 1.0));
    for (std::size_t i = 1; i <= k; ++i) c[k] -= s[i] * c[k - i];
  }
  return c;
}();

/// Polynomial p of the first `terms` coefficients of `series` with its derivatives, as (p, p′, p″/2).
template <int terms, class T>
std::array<T, 3> polynomial(std::array<double, 20> const& series, T const& x) {
  std::array<T, 3> p{T(series[terms - 1]), T(0.0), T(0.0)};
#pragma GCC unroll 8
  for (int k = terms - 2; k >= 0; --k) {
    p[2] = p[1] + x * p[2];
    p[1] = p[0] + x * p[1];
    p[0] = series[std::size_t(k)] + x * p[0];
  }
  return p;
}
/// As `polynomial`, with as many terms as round-off requires for 0 ≤ x < 4.
template <class T>
std::array<T, 3> polynomial_below_4(std::array<double, 20> const& series, T const& x) {
  return value_of(x) < 0.04 ? polynomial<8, T>(series, x) : polynomial<20, T>(series, x);
}

}  // namespace detail

/// Coefficients of exp(φ̃) at x = |φ|² [rad²].
template <class T>
OperatorSeries<T> exp_series(T const& x) {
  detail::SineSeries<T> const s(x);
  return {s[1], s[2], s.slope(1), s.slope(2), s.second(1), s.second(2)};
}
/// Coefficients of the right Jacobian Jr(φ) at x = |φ|² [rad²].
template <class T>
OperatorSeries<T> tangent_series(T const& x) {
  detail::SineSeries<T> const s(x);
  return {-s[2], s[3], -s.slope(2), s.slope(3), -s.second(2), s.second(3)};
}
/// Coefficients of Jr⁻¹(φ) at x = |φ|² [rad²], |φ| < 2π. With e of `right_jacobian_inverse`:
///   x e′ = 1/8 − 3/2 e + ½ x e²,  x e″ = ½ e² − 5/2 e′ + x e e′.
template <class T>
OperatorSeries<T> tangent_inverse_series(T const& x) {
  T e, de, dde;
  if (value_of(x) < 4.0) {
    auto const p = detail::polynomial_below_4<T>(detail::cotangent_series, x);
    e = p[0];
    de = p[1];
    dde = 2.0 * p[2];
  } else {
    ExpSeries<T> const s(x);
    e = (1.0 - s.a / (2.0 * s.b)) / x;
    de = (0.125 - 1.5 * e) / x + 0.5 * e * e;
    dde = (0.5 * e * e - 2.5 * de) / x + e * de;
  }
  return {T(0.5), e, T(0.0), de, T(0.0), dde};
}

/// Derivative of the operator 1 + f φ̃ + g φ̃² in the direction p: f p̃ + g (φ̃ p̃ + p̃ φ̃) + 2 φ·p (f′ φ̃ + g′ φ̃²), 3×3.
template <class T>
Mat<T, 3, 3> map_slope(OperatorSeries<T> const& c, Vec<T, 3> const& phi, Vec<T, 3> const& p) {
  T const along = dot(phi, p), x = squared_norm(phi);
  T const odd = 2.0 * along * c.df, even = 2.0 * along * c.dg;
  Mat<T, 3, 3> m;
  for (int i = 0; i < 3; ++i) {
    int const j = (i + 1) % 3, k = (i + 2) % 3;
    T const skewed = c.f * p[k] + odd * phi[k];
    T const symmetric = c.g * (phi[i] * p[j] + p[i] * phi[j]) + even * phi[i] * phi[j];
    m(i, i) = 2.0 * c.g * (phi[i] * p[i] - along) + even * (phi[i] * phi[i] - x);
    m(j, i) = symmetric + skewed;
    m(i, j) = symmetric - skewed;
  }
  return m;
}
/// Operator on screws whose diagonal blocks are 1 + f φ̃ + g φ̃², at d = (p, φ).
template <class T>
ScrewMap<T> screw_map(OperatorSeries<T> const& c, ScrewVector<T> const& d) {
  return {one_and_skew<T>(d.rotation, c.f, c.g), map_slope(c, d.rotation, d.translation)};
}

/// Derivative D₀(φ, y) = ∂((1 + f φ̃ + g φ̃²) y)/∂φ at constant y, 3×3:
///   u φᵀ + g (φ yᵀ + φ·y 1) − f ỹ,  u = 2 (f′ φ × y + g′ φ × (φ × y) − g y).
template <class T>
Mat<T, 3, 3> map_derivative(OperatorSeries<T> const& c, Vec<T, 3> const& phi, Vec<T, 3> const& y) {
  Vec<T, 3> const once = cross(phi, y), twice = cross(phi, once);
  T const along = c.g * dot(phi, y);
  Vec<T, 3> u, scaled_phi;
  for (int i = 0; i < 3; ++i) {
    u[i] = 2.0 * (c.df * once[i] + c.dg * twice[i] - c.g * y[i]);
    scaled_phi[i] = c.g * phi[i];
  }
  Mat<T, 3, 3> d;
  for (int i = 0; i < 3; ++i) {
    int const j = (i + 1) % 3, k = (i + 2) % 3;
    T const skewed = c.f * y[k];
    d(i, i) = u[i] * phi[i] + scaled_phi[i] * y[i] + along;
    d(j, i) = u[j] * phi[i] + scaled_phi[j] * y[i] - skewed;
    d(i, j) = u[i] * phi[j] + scaled_phi[i] * y[j] + skewed;
  }
  return d;
}
/// Derivative of D₀(φ, y) for φ in the direction p, at constant y (3×3). With the derivatives u˙ of u and g˙ = 2 φ·p g′
/// of g:
///   u˙ φᵀ + u pᵀ + (g˙ φ + g p) yᵀ + (g˙ φ·y + g p·y) 1 − 2 φ·p f′ ỹ.
template <class T>
Mat<T, 3, 3> map_second_derivative(OperatorSeries<T> const& c, ScrewVector<T> const& d, Vec<T, 3> const& y) {
  Vec<T, 3> const &p = d.translation, &phi = d.rotation;
  T const twofold = 2.0 * dot(phi, p), odd = twofold * c.df, even = twofold * c.dg;
  T const along = even * dot(phi, y) + c.g * dot(p, y);
  Vec<T, 3> const once = cross(phi, y), twice = cross(phi, once), by_p = cross(p, y);
  Vec<T, 3> const mixed1 = cross(p, once), mixed2 = cross(phi, by_p);
  Vec<T, 3> u, slope, w;  // u, u˙ and g˙ φ + g p
  for (int i = 0; i < 3; ++i) {
    u[i] = 2.0 * (c.df * once[i] + c.dg * twice[i] - c.g * y[i]);
    slope[i] = 2.0 * (c.df * by_p[i] + c.dg * (mixed1[i] + mixed2[i]) - even * y[i] +
                      twofold * (c.ddf * once[i] + c.ddg * twice[i]));
    w[i] = even * phi[i] + c.g * p[i];
  }
  Mat<T, 3, 3> m;
  for (int i = 0; i < 3; ++i) {
    int const j = (i + 1) % 3, k = (i + 2) % 3;
    T const skewed = odd * y[k];
    m(i, i) = slope[i] * phi[i] + u[i] * p[i] + w[i] * y[i] + along;
    m(j, i) = slope[j] * phi[i] + u[j] * p[i] + w[j] * y[i] - skewed;
    m(i, j) = slope[i] * phi[j] + u[i] * p[j] + w[i] * y[j] + skewed;
  }
  return m;
}
/// Derivative with respect to d of the product of an operator on screws at d with the constant screw y.
template <class T>
ScrewMap<T> screw_map_derivative(OperatorSeries<T> const& c, ScrewVector<T> const& d, ScrewVector<T> const& y) {
  ScrewMap<T> out{map_derivative(c, d.rotation, y.rotation), map_derivative(c, d.rotation, y.translation)};
  Mat<T, 3, 3> const more = map_second_derivative(c, d, y.rotation);
  for (int i = 0; i < 9; ++i) out.coupling.data()[i] += more.data()[i];
  return out;
}

/// Tangent operator T(d) of SE(3), the right Jacobian: exp(d)⁻¹ d/dt exp(d) = T(d) ḋ.
template <class T>
ScrewMap<T> se3_tangent(ScrewVector<T> const& d) {
  return screw_map<T>(tangent_series<T>(squared_norm(d.rotation)), d);
}
/// Inverse tangent operator T⁻¹(d), for |φ| < 2π.
template <class T>
ScrewMap<T> se3_tangent_inverse(ScrewVector<T> const& d) {
  return screw_map<T>(tangent_inverse_series<T>(squared_norm(d.rotation)), d);
}
/// Derivative ∂(T(d) y)/∂d at constant y.
template <class T>
ScrewMap<T> se3_tangent_derivative(ScrewVector<T> const& d, ScrewVector<T> const& y) {
  return screw_map_derivative<T>(tangent_series<T>(squared_norm(d.rotation)), d, y);
}
/// Derivative ∂(T⁻¹(d) y)/∂d at constant y.
template <class T>
ScrewMap<T> se3_tangent_inverse_derivative(ScrewVector<T> const& d, ScrewVector<T> const& y) {
  return screw_map_derivative<T>(tangent_inverse_series<T>(squared_norm(d.rotation)), d, y);
}
/// Adjoint map Ad(exp(d)) = [A, r̃ A; 0, A] of screws, for the motion (A, r) = exp(d).
template <class T>
ScrewMap<T> se3_adjoint(ScrewVector<T> const& d) {
  return screw_map<T>(exp_series<T>(squared_norm(d.rotation)), d);
}

/// Rigid motion H = (A, r).
template <class T = double>
struct RigidMotion {
  Vec<T, 3> r;     ///< (3) displacement [m]
  Mat<T, 3, 3> A;  ///< (3×3) rotation matrix
};
/// Exponential map exp(d) = (exp(φ̃), Jl(φ) p), Jl(φ) = Jr(−φ).
template <class T>
RigidMotion<T> exp_se3(ScrewVector<T> const& d) {
  detail::SineSeries<T> const s(squared_norm(d.rotation));
  return {product(one_and_skew<T>(d.rotation, s[2], s[3]), d.translation), one_and_skew<T>(d.rotation, s[1], s[2])};
}
/// Logarithm of the motion with displacement `r` (3) [m] and rotation `a`, a unit quaternion: d = (Jl⁻¹(φ) r, φ), with
/// |φ| ≤ π.
template <class T>
ScrewVector<T> log_se3(Vec<T, 3> const& r, Quaternion<T> const& a) {
  Vec<T, 3> const phi = quaternion_log<T>(a);
  OperatorSeries<T> const c = tangent_inverse_series<T>(squared_norm(phi));
  return {product(one_and_skew<T>(phi, -c.f, c.g), r), phi};
}

}  // namespace polybody
