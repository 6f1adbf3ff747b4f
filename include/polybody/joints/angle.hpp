#pragma once
/// \file
/// Constraint functions of angles. A vector with the components x and y along the first two axes of frame a has the
/// angle θ = atan2(y, x), where x and y are constraint functions of constraint_functions.hpp. The rate of the angle is
///   θ̇ = (x ẏ − y ẋ)/n²,   n² = x² + y².
/// Angles are compared modulo a full turn, so that no data are stored between steps.
/// Theory: Eqs. 4.14 to 4.16, 4.22.

#include <numbers>

#include <polybody/joints/constraint_functions.hpp>

namespace polybody::constraint_functions {

/// `angle` minus the nearest multiple of a full turn [rad].
template <StateScalar T>
T wrapped(T const& angle) {
  double const turn = 2.0 * std::numbers::pi;
  return angle - turn * std::nearbyint(value_of(angle) / turn);
}

/// θ in (−π, π] with its Jacobians, from x and y with their Jacobians. θ is undefined for x = y = 0.
template <StateScalar T>
ConstraintTerms<1, T> angle(ConstraintTerms<2, T> const& xy) {
  using std::atan2;
  T const x = xy.g[0], y = xy.g[1], n2 = x * x + y * y;
  T const p = x / n2, q = y / n2;
  ConstraintTerms<1, T> terms;
  terms.g[0] = atan2(y, x);
  for (int j = 0; j < 6; ++j) {
    terms.Ga(0, j) = p * xy.Ga(1, j) - q * xy.Ga(0, j);
    terms.Gb(0, j) = p * xy.Gb(1, j) - q * xy.Gb(0, j);
  }
  return terms;
}

/// γ of θ from γ of x and y: (x γ_y − y γ_x − 2 θ̇ (x ẋ + y ẏ))/n².
template <StateScalar T>
T angle_gamma(ConstraintTerms<2, T> const& xy, Vec<T, 2> const& gamma, Frame<T> const& a, Frame<T> const& b) {
  T rate[2] = {T(0.0), T(0.0)};
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 3; ++j)
      rate[i] += xy.Ga(i, j) * a.v[j] + xy.Ga(i, 3 + j) * a.w[j] + xy.Gb(i, j) * b.v[j] + xy.Gb(i, 3 + j) * b.w[j];
  T const x = xy.g[0], y = xy.g[1], n2 = x * x + y * y;
  T const turning = (x * rate[1] - y * rate[0]) / n2;
  return (x * gamma[1] - y * gamma[0] - 2.0 * turning * (x * rate[0] + y * rate[1])) / n2;
}

/// Adds −λ (G_θᵀ G_r + G_rᵀ G_θ) to k, with the Jacobians G_θ, G_x, G_y and G_r = (x G_x + y G_y)/n². This term is the
/// change of the wrench G_θᵀ λ due to the factors x/n² and y/n² in G_θ. Returns the multipliers λ (−y, x)/n² of x and
/// y. The caller adds the wrench gradients of x and y for these multipliers.
template <class = void>  // compiled only if used
Vec2 angle_gradient(ConstraintTerms<2> const& xy, double lambda, WrenchGradient& k) {
  double const x = xy.g[0], y = xy.g[1], n2 = x * x + y * y;
  double turning[12], growing[12];
  for (int j = 0; j < 12; ++j) {
    Mat<double, 2, 6> const& g = j < 6 ? xy.Ga : xy.Gb;
    turning[j] = (x * g(1, j % 6) - y * g(0, j % 6)) / n2;
    growing[j] = (x * g(0, j % 6) + y * g(1, j % 6)) * (lambda / n2);
  }
  for (int j = 0; j < 12; ++j)
    for (int i = 0; i < 12; ++i) k(i, j) -= turning[i] * growing[j] + growing[i] * turning[j];
  return {-y * (lambda / n2), x * (lambda / n2)};
}

/// x = a₁·b₁ and y = a₂·b₁. The rotation of b relative to a about a₃ is θ = atan2(y, x). If b₁ is in the plane of a₁,
/// a₂ (as with a Revolute), θ̇ = a₃·(ω_b − ω_a). If b₁ is perpendicular to this plane, the angle is undefined.
template <StateScalar T>
ConstraintTerms<2, T> turned(Frame<T> const& a, Frame<T> const& b) {
  ConstraintTerms<2, T> xy;
  for (int i = 0; i < 2; ++i) perpendicular(axis_of(a, i), axis_of(b, 0), xy, i);
  return xy;
}

/// γ of the rotation θ of b relative to a about a₃; xy is `turned(a, b)`.
template <StateScalar T>
T turn_gamma(ConstraintTerms<2, T> const& xy, Frame<T> const& a, Frame<T> const& b) {
  Vec<T, 3> const axis = axis_of(b, 0);
  return angle_gamma<T>(
      xy, {perpendicular_gamma(axis_of(a, 0), axis, a, b), perpendicular_gamma(axis_of(a, 1), axis, a, b)}, a, b);
}

/// Adds the wrench gradient of the rotation θ for the multiplier λ to k.
template <class = void>  // compiled only if used
void turn_gradient(Frame<double> const& a, Frame<double> const& b, double lambda, WrenchGradient& k) {
  Vec2 const each = angle_gradient(turned(a, b), lambda, k);
  for (int i = 0; i < 2; ++i) perpendicular_gradient(axis_of(a, i), axis_of(b, 0), each[i], k);
}

/// Writes g = u·d − p θ to `row`: a coupled translation and rotation. u (3) is fixed in a, θ is the rotation of b about
/// a₃, and p has the unit [m/rad]. The translation determines the number of full turns, g = −p wrapped(θ − u·d/p), so
/// that |g| ≤ π |p|.
template <int m, StateScalar T>
void slide_and_turn(Vec<T, 3> const& u, double p, Frame<T> const& a, Frame<T> const& b, ConstraintTerms<m, T>& terms,
                    int row) {
  no_slide<m, T>(u, a, b, terms, row);
  ConstraintTerms<1, T> const turn = angle(turned(a, b));
  terms.g[row] = -p * wrapped<T>(turn.g[0] - terms.g[row] / p);
  for (int j = 0; j < 6; ++j) {
    terms.Ga(row, j) -= turn.Ga(0, j) * p;
    terms.Gb(row, j) -= turn.Gb(0, j) * p;
  }
}

/// γ of `slide_and_turn` along u (3) with p [m/rad].
template <StateScalar T>
T slide_and_turn_gamma(Vec<T, 3> const& u, double p, Frame<T> const& a, Frame<T> const& b) {
  return no_slide_gamma<T>(u, a, b) - p * turn_gamma<T>(turned(a, b), a, b);
}

/// Adds the wrench gradient of `slide_and_turn` along u (3) with p [m/rad] for the multiplier λ to k.
template <class = void>  // compiled only if used
void slide_and_turn_gradient(Vec3 const& u, double p, Frame<double> const& a, Frame<double> const& b, double lambda,
                             WrenchGradient& k) {
  no_slide_gradient(u, a, b, lambda, k);
  turn_gradient(a, b, -p * lambda, k);
}

}  // namespace polybody::constraint_functions

namespace polybody {

/// b translates along axis i of a, counted from 0, by p times its rotation θ about a₃: for i = 2, a₃·(r_b − r_a) − p θ
/// = 0. The member `ratio` of the geometry contains p [m/rad].
template <int i, auto ratio>
struct TranslationPerRotation {
  static constexpr int rows = 1;
  static constexpr bool opposite_ends = false;
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr MarkerKind needs_of_second = MarkerKind::frame;
  [[gnu::always_inline]] static void write(auto const& geometry, auto const& a, auto const& b, auto& terms, int row) {
    constraint_functions::slide_and_turn(axis_of(a, i), geometry.*ratio, a, b, terms, row);
  }
  static void gamma(auto const& geometry, auto const& a, auto const& b, auto* out) {
    *out = constraint_functions::slide_and_turn_gamma(axis_of(a, i), geometry.*ratio, a, b);
  }
  static void add_gradient(auto const& geometry, Frame<double> const& a, Frame<double> const& b, double const* lambda,
                           WrenchGradient& out) {
    constraint_functions::slide_and_turn_gradient(axis_of(a, i), geometry.*ratio, a, b, *lambda, out);
  }
};

}  // namespace polybody
