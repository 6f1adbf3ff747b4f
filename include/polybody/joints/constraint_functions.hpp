#pragma once
/// \file
/// Constraint functions of joint geometries, each with its Jacobians and its γ. With d = r_b − r_a:
///   coincident points   g = d
///   perpendicular axes  g = u·w, u fixed in a, w fixed in b
///   no slide along u    g = u·d, u fixed in a
///   distance            g = |d| − L
/// γ is the part of g̈ that does not depend on the accelerations of the frames. [Haug 1989, §2.4 and §9.4; thesis Eq.
/// 3.8–3.10 and §3.5.1]

#include <polybody/joints/constraint_terms.hpp>

namespace polybody::constraint_functions {

/// Writes g = r_b − r_a into rows [row, row + 3).
template <int m, StateScalar T>
void coincident(Frame<T> const& a, Frame<T> const& b, ConstraintTerms<m, T>& terms, int row = 0) {
  for (int i = 0; i < 3; ++i) {
    terms.g[row + i] = b.r[i] - a.r[i];
    terms.Ga(row + i, i) = T(-1.0);
    terms.Gb(row + i, i) = T(1.0);
  }
}

/// Writes g = u·w to `row`: ġ = (u × w)·(ω_a − ω_b).
template <int m, StateScalar T>
[[gnu::always_inline]] inline void perpendicular(Vec<T, 3> const& u, Vec<T, 3> const& w, ConstraintTerms<m, T>& terms,
                                                 int row) {
  Vec<T, 3> const c = cross(u, w);
  terms.g[row] = dot(u, w);
  for (int i = 0; i < 3; ++i) {
    terms.Ga(row, 3 + i) = c[i];
    terms.Gb(row, 3 + i) = -c[i];
  }
}

/// γ of `perpendicular`: 2 (ω_a × u)·(ω_b × w) + (ω_a × (ω_a × u))·w + u·(ω_b × (ω_b × w)).
template <StateScalar T>
inline T perpendicular_gamma(Vec<T, 3> const& u, Vec<T, 3> const& w, Frame<T> const& a, Frame<T> const& b) {
  Vec<T, 3> const ud = cross(a.w, u), wd = cross(b.w, w), udd = cross(a.w, ud), wdd = cross(b.w, wd);
  return 2.0 * dot(ud, wd) + dot(udd, w) + dot(u, wdd);
}

/// Writes g = u·d to `row`: ġ = u·(v_b − v_a) + (u × d)·ω_a.
template <int m, StateScalar T>
void no_slide(Vec<T, 3> const& u, Frame<T> const& a, Frame<T> const& b, ConstraintTerms<m, T>& terms, int row) {
  Vec<T, 3> const d = difference(b.r, a.r), c = cross(u, d);
  terms.g[row] = dot(u, d);
  for (int i = 0; i < 3; ++i) {
    terms.Ga(row, i) = -u[i];
    terms.Ga(row, 3 + i) = c[i];
    terms.Gb(row, i) = u[i];
  }
}

/// γ of `no_slide`: 2 (ω_a × u)·(v_b − v_a) + (ω_a × (ω_a × u))·d.
template <StateScalar T>
inline T no_slide_gamma(Vec<T, 3> const& u, Frame<T> const& a, Frame<T> const& b) {
  Vec<T, 3> const ud = cross(a.w, u), udd = cross(a.w, ud), d = difference(b.r, a.r), rate = difference(b.v, a.v);
  return 2.0 * dot(ud, rate) + dot(udd, d);
}

/// Writes a₁·b₂, a₂·b₃, a₃·b₁ to three rows from `row` on: the axes of b are parallel to the axes of a.
template <int m, StateScalar T>
void parallel(Frame<T> const& a, Frame<T> const& b, ConstraintTerms<m, T>& terms, int row) {
  for (int i = 0; i < 3; ++i) perpendicular(axis_of(a, i), axis_of(b, (i + 1) % 3), terms, row + i);
}

/// γ of `parallel`.
template <StateScalar T>
Vec<T, 3> parallel_gamma(Frame<T> const& a, Frame<T> const& b) {
  Vec<T, 3> gamma;
  for (int i = 0; i < 3; ++i) gamma[i] = perpendicular_gamma(axis_of(a, i), axis_of(b, (i + 1) % 3), a, b);
  return gamma;
}

/// Writes a₁·b₃ and a₂·b₃ to two rows from `row` on: the third axes are parallel.
template <int m, StateScalar T>
void same_direction(Frame<T> const& a, Frame<T> const& b, ConstraintTerms<m, T>& terms, int row) {
  for (int i = 0; i < 2; ++i) perpendicular(axis_of(a, i), axis_of(b, 2), terms, row + i);
}

/// γ of `same_direction`.
template <StateScalar T>
Vec<T, 2> same_direction_gamma(Frame<T> const& a, Frame<T> const& b) {
  Vec<T, 3> const axis = axis_of(b, 2);
  return {perpendicular_gamma(axis_of(a, 0), axis, a, b), perpendicular_gamma(axis_of(a, 1), axis, a, b)};
}

/// Writes a₁·d and a₂·d to two rows from `row` on: the point of b is on the third axis of a.
template <int m, StateScalar T>
void on_axis(Frame<T> const& a, Frame<T> const& b, ConstraintTerms<m, T>& terms, int row) {
  for (int i = 0; i < 2; ++i) no_slide(axis_of(a, i), a, b, terms, row + i);
}

/// γ of `on_axis`.
template <StateScalar T>
Vec<T, 2> on_axis_gamma(Frame<T> const& a, Frame<T> const& b) {
  return {no_slide_gamma(axis_of(a, 0), a, b), no_slide_gamma(axis_of(a, 1), a, b)};
}

/// Writes g = |d| − length to `row`: ġ = e·(v_b − v_a), e = d/|d|. If the points coincide, e is the x axis, so that
/// `assemble` can separate them.
template <int m, StateScalar T>
void distance(Frame<T> const& a, Frame<T> const& b, double length, ConstraintTerms<m, T>& terms, int row = 0) {
  using std::sqrt;
  Vec<T, 3> const line = difference(b.r, a.r);
  T const d = sqrt(squared_norm(line));
  terms.g[row] = d - length;
  for (int i = 0; i < 3; ++i) {
    T const e = value_of(d) > 0.0 ? T(line[i] / d) : T(i == 0 ? 1.0 : 0.0);
    terms.Ga(row, i) = -e;
    terms.Gb(row, i) = e;
  }
}

/// γ of `distance`: (|ḋ|² − (e·ḋ)²)/|d|.
template <StateScalar T>
T distance_gamma(Frame<T> const& a, Frame<T> const& b) {
  using std::sqrt;
  Vec<T, 3> const d = difference(b.r, a.r), rate = difference(b.v, a.v);
  T const d2 = squared_norm(d), along = dot(d, rate);
  return (squared_norm(rate) - along * along / d2) / sqrt(d2);
}

/// ∂[wa; wb]/∂(δr_a, δφ_a, δr_b, δφ_b), 12×12: derivative of the wrenches Gaᵀλ and Gbᵀλ, rotations in world axes.
using WrenchGradient = Mat<double, 12, 12>;

/// Adds λ times the gradient of `perpendicular`: c = u × w, δc = (u wᵀ − (u·w) 1) δφ_a + ((u·w) 1 − w uᵀ) δφ_b.
template <class = void>  // compiled only if used
void perpendicular_gradient(Vec3 const& u, Vec3 const& w, double lambda, WrenchGradient& k) {
  double const uw = dot(u, w);
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      double const one = i == j ? uw : 0.0, a = lambda * (u[i] * w[j] - one), b = lambda * (one - w[i] * u[j]);
      k(3 + i, 3 + j) += a;
      k(3 + i, 9 + j) += b;
      k(9 + i, 3 + j) -= a;
      k(9 + i, 9 + j) -= b;
    }
}

/// Adds λ times the gradient of `no_slide`: δu = −ũ δφ_a and δ(u × d) = (u dᵀ − (u·d) 1) δφ_a + ũ (δr_b − δr_a).
template <class = void>  // compiled only if used
void no_slide_gradient(Vec3 const& u, Frame<double> const& a, Frame<double> const& b, double lambda,
                       WrenchGradient& k) {
  Vec3 const d = difference(b.r, a.r);
  double const ud = dot(u, d);
  Mat3 const across = skew<double>(u);
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      double const turn = lambda * across(i, j);
      k(i, 3 + j) += turn;
      k(3 + i, j) -= turn;
      k(3 + i, 3 + j) += lambda * (u[i] * d[j] - (i == j ? ud : 0.0));
      k(3 + i, 6 + j) += turn;
      k(6 + i, 3 + j) -= turn;
    }
}

/// Adds the gradient of `parallel` for three multipliers.
template <class = void>  // compiled only if used
void parallel_gradient(Frame<double> const& a, Frame<double> const& b, Vec3 const& lambda, WrenchGradient& k) {
  for (int i = 0; i < 3; ++i) perpendicular_gradient(axis_of(a, i), axis_of(b, (i + 1) % 3), lambda[i], k);
}

/// Adds the gradient of `same_direction` for two multipliers.
template <class = void>  // compiled only if used
void same_direction_gradient(Frame<double> const& a, Frame<double> const& b, Vec2 const& lambda, WrenchGradient& k) {
  for (int i = 0; i < 2; ++i) perpendicular_gradient(axis_of(a, i), axis_of(b, 2), lambda[i], k);
}

/// Adds the gradient of `on_axis` for two multipliers.
template <class = void>  // compiled only if used
void on_axis_gradient(Frame<double> const& a, Frame<double> const& b, Vec2 const& lambda, WrenchGradient& k) {
  for (int i = 0; i < 2; ++i) no_slide_gradient(axis_of(a, i), a, b, lambda[i], k);
}

/// Adds λ times the gradient of `distance`: δe = (1 − e eᵀ)(δr_b − δr_a)/|d|.
template <class = void>  // compiled only if used
void distance_gradient(Frame<double> const& a, Frame<double> const& b, double lambda, WrenchGradient& k) {
  Vec3 const d = difference(b.r, a.r);
  double const d2 = squared_norm(d), tension = lambda / std::sqrt(d2);
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      double const turn = tension * ((i == j ? 1.0 : 0.0) - d[i] * d[j] / d2);
      k(i, j) += turn;
      k(i, 6 + j) -= turn;
      k(6 + i, j) -= turn;
      k(6 + i, 6 + j) += turn;
    }
}

/// Matrix with the columns x, y, z (3).
template <class = void>  // compiled only if used
Mat3 columns(Vec3 const& x, Vec3 const& y, Vec3 const& z) {
  Mat3 m;
  for (int i = 0; i < 3; ++i) {
    m(i, 0) = x[i];
    m(i, 1) = y[i];
    m(i, 2) = z[i];
  }
  return m;
}

/// Right-handed triad with \p first as its first and \p third as its third axis; `what` names the joint.
/// \throws InvalidInput unless both are unit vectors at right angles (to 1e-9).
template <class = void>  // compiled only if used
Mat3 triad_of(Vec3 const& first, Vec3 const& third, std::string const& what) {
  require_unit(first, what, ": the first axis");
  require_unit(third, what, ": the second axis");
  if (std::abs(dot(first, third)) > 1e-9)
    throw InvalidInput(
        "joint.axes_not_perpendicular",
        {ErrorObject{what},
         ": the two axes must be perpendicular at the reference configuration, but their scalar product is ",
         ErrorValue{dot(first, third)}, "."});
  return columns(first, cross(third, first), third);
}

/// Right-handed triad with the third axis `axis`. \throws InvalidInput unless `axis` is a unit vector.
template <class = void>  // compiled only if used
Mat3 triad_about(Vec3 const& axis, std::string const& what) {
  require_unit(axis, what);
  int smallest = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(axis[i]) < std::abs(axis[smallest])) smallest = i;
  Vec3 first;
  for (int i = 0; i < 3; ++i) first[i] = (i == smallest ? 1.0 : 0.0) - axis[smallest] * axis[i];
  double const length = std::sqrt(squared_norm(first));
  for (int i = 0; i < 3; ++i) first[i] /= length;
  return columns(first, cross(axis, first), axis);
}

}  // namespace polybody::constraint_functions
