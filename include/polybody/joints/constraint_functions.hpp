#pragma once
/// \file
/// Constraint functions of joint geometries, each with its Jacobians and its γ. With d = r_b − r_a:
///   coincident points   g = d
///   perpendicular axes  g = u·w, u fixed in a, w fixed in b
///   no slide along u    g = u·d, u fixed in a
///   distance            g = |d| − L
/// γ is the part of g̈ that does not depend on the accelerations of the frames. [Haug 1989, §2.4 and §9.4; thesis Eq.
/// 3.8–3.10 and §3.5.1]
/// Most joint geometries are an `EquationList` of these equations.
/// Theory: Eqs. 4.6 to 4.12, 4.19 to 4.21.

#include <algorithm>

#include <polybody/joints/constraint_terms.hpp>

namespace polybody::constraint_functions {

/// Writes the first n entries of g = r_b − r_a into rows [row, row + n): n = 3 in space, 2 in the plane.
template <int n = 3, int m, StateScalar T>
void coincident(Frame<T> const& a, Frame<T> const& b, ConstraintTerms<m, T>& terms, int row = 0) {
  for (int i = 0; i < n; ++i) {
    terms.g[row + i] = b.r[i] - a.r[i];
    terms.Ga(row + i, i) = T(-1.0);
    terms.Gb(row + i, i) = T(1.0);
  }
}

/// Writes g = u·w, with u fixed in a and w fixed in b, to `row`: ġ = (u × w)·(ω_a − ω_b).
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

/// Writes g = u·d, with u fixed in a and d = r_b − r_a, to `row`: ġ = u·(v_b − v_a) + (u × d)·ω_a.
template <int m, StateScalar T>
[[gnu::always_inline]] inline void no_slide(Vec<T, 3> const& u, Frame<T> const& a, Frame<T> const& b,
                                            ConstraintTerms<m, T>& terms, int row) {
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

/// ∂[wa; wb]/∂(δr_a, δφ_a, δr_b, δφ_b), 12×12: derivative of the wrenches wa = Gaᵀλ and wb = Gbᵀλ, with the rotations
/// δφ in world axes.
using WrenchGradient = Mat<double, 12, 12>;

/// Adds λ times the wrench gradient of `perpendicular` to k: c = u × w, δc = (u wᵀ − (u·w) 1) δφ_a + ((u·w) 1 − w uᵀ)
/// δφ_b.
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

/// Adds λ times the wrench gradient of `no_slide` to k: δu = −ũ δφ_a and δ(u × d) = (u dᵀ − (u·d) 1) δφ_a + ũ (δr_b −
/// δr_a).
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

/// Adds λ times the wrench gradient of `distance` to k: δe = (1 − e eᵀ)(δr_b − δr_a)/|d|.
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
/// \throws InvalidInput unless `first` and `third` are perpendicular unit vectors (to 1e-9).
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

namespace polybody {

using constraint_functions::WrenchGradient;

/// Constraint equation for an `EquationList`. `docs/extending.md` lists its members.
template <class E>
concept ConstraintEquation = requires {
  { E::rows } -> std::convertible_to<int>;
  { E::opposite_ends } -> std::convertible_to<bool>;
  { E::needs } -> std::convertible_to<MarkerKind>;
  { E::needs_of_second } -> std::convertible_to<MarkerKind>;
};

/// Two points coincide: the first n entries of r_b − r_a are zero.
template <int n>
struct CoincidentIn {
  static constexpr int rows = n;
  static constexpr bool opposite_ends = true;
  static constexpr MarkerKind needs = MarkerKind::point;
  static constexpr MarkerKind needs_of_second = MarkerKind::point;
  static constexpr FreeDirections prevented = {true, true, n == 3};
  [[gnu::always_inline]] static void write(auto const&, auto const& a, auto const& b, auto& terms, int row) {
    constraint_functions::coincident<n>(a, b, terms, row);
  }
  static void gamma(auto const&, auto const&, auto const&, auto* out) {
    for (int i = 0; i < n; ++i) out[i] = 0.0;
  }
  static void add_gradient(auto const&, Frame<double> const&, Frame<double> const&, double const*, WrenchGradient&) {}
};

/// Two points coincide in space: r_b − r_a = 0.
using Coincident = CoincidentIn<3>;
namespace planar {
/// Two points coincide in the plane.
using Coincident = CoincidentIn<2>;
}  // namespace planar

/// Axis i of a is perpendicular to axis k of b, axes counted from 0: `Perpendicular<0, 2>` is a₁·b₃ = 0.
template <int i, int k>
struct Perpendicular {
  static_assert(0 <= i && i < 3 && 0 <= k && k < 3 && i != k,
                "Perpendicular needs two different axes from 0 to 2, since the axes of both markers coincide at the "
                "reference configuration.");
  static constexpr int rows = 1;
  static constexpr bool opposite_ends = true;
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr MarkerKind needs_of_second = k == 2 ? MarkerKind::axis : MarkerKind::frame;
  static constexpr FreeDirections prevented = {false, false, false, i + k == 3, i + k == 2, i + k == 1};
  [[gnu::always_inline]] static void write(auto const&, auto const& a, auto const& b, auto& terms, int row) {
    constraint_functions::perpendicular(axis_of(a, i), axis_of(b, k), terms, row);
  }
  static void gamma(auto const&, auto const& a, auto const& b, auto* out) {
    *out = constraint_functions::perpendicular_gamma(axis_of(a, i), axis_of(b, k), a, b);
  }
  static void add_gradient(auto const&, Frame<double> const& a, Frame<double> const& b, double const* lambda,
                           WrenchGradient& out) {
    constraint_functions::perpendicular_gradient(axis_of(a, i), axis_of(b, k), *lambda, out);
  }
};

/// The point of b does not translate along axis i of a, counted from 0: `NoTranslation<0>` is a₁·(r_b − r_a) = 0.
template <int i>
struct NoTranslation {
  static_assert(0 <= i && i < 3, "NoTranslation needs an axis from 0 to 2.");
  static constexpr int rows = 1;
  static constexpr bool opposite_ends = false;
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr MarkerKind needs_of_second = MarkerKind::point;
  static constexpr FreeDirections prevented = {i == 0, i == 1, i == 2};
  [[gnu::always_inline]] static void write(auto const&, auto const& a, auto const& b, auto& terms, int row) {
    constraint_functions::no_slide(axis_of(a, i), a, b, terms, row);
  }
  static void gamma(auto const&, auto const& a, auto const& b, auto* out) {
    *out = constraint_functions::no_slide_gamma(axis_of(a, i), a, b);
  }
  static void add_gradient(auto const&, Frame<double> const& a, Frame<double> const& b, double const* lambda,
                           WrenchGradient& out) {
    constraint_functions::no_slide_gradient(axis_of(a, i), a, b, *lambda, out);
  }
};

/// Two points have the distance that the member `length` of the geometry contains [m]: |r_b − r_a| − L = 0.
template <auto length>
struct FixedDistance {
  static constexpr int rows = 1;
  static constexpr bool opposite_ends = false;
  static constexpr MarkerKind needs = MarkerKind::point;
  static constexpr MarkerKind needs_of_second = MarkerKind::point;
  [[gnu::always_inline]] static void write(auto const& geometry, auto const& a, auto const& b, auto& terms, int row) {
    constraint_functions::distance(a, b, geometry.*length, terms, row);
  }
  static void gamma(auto const&, auto const& a, auto const& b, auto* out) {
    *out = constraint_functions::distance_gamma(a, b);
  }
  static void add_gradient(auto const&, Frame<double> const& a, Frame<double> const& b, double const* lambda,
                           WrenchGradient& out) {
    constraint_functions::distance_gradient(a, b, *lambda, out);
  }
};

/// Constraint equations Es of a joint geometry, in the order of their rows. A geometry names its list,
///   using Equations = EquationList<Coincident, Perpendicular<0, 2>, Perpendicular<1, 2>>;
/// The constraint function of the geometry with Jacobians, γ, the wrench gradient, the required marker kinds and the
/// free directions follow from the list.
template <class... Es>
struct EquationList {
  static_assert((ConstraintEquation<Es> && ...),
                "An EquationList contains constraint equations, such as Coincident or Perpendicular<0, 2>. "
                "docs/extending.md lists their members.");
  static constexpr int rows = (Es::rows + ...);
  static constexpr bool opposite_ends = (Es::opposite_ends && ...);
  static constexpr MarkerKind needs = std::max({Es::needs...});
  static constexpr MarkerKind needs_of_second = std::max({Es::needs_of_second...});
  /// Motions that no equation prevents: translations along the axes of the joint, then rotations about these axes.
  static constexpr FreeDirections free = [] {
    FreeDirections out = {true, true, true, true, true, true};
    auto const remove = [&]<class E>(E const*) {
      if constexpr (requires { E::prevented; })
        for (std::size_t i = 0; i < 6; ++i) out[i] = out[i] && !E::prevented[i];
    };
    (remove(static_cast<Es const*>(nullptr)), ...);
    return out;
  }();
  /// True if each equation prevents motions along or about axes of the joint.
  static constexpr bool along_axes = (requires { Es::prevented; } && ...);

  /// Constraint terms of `geometry` at the frames a and b.
  template <StateScalar T, class G>
  [[gnu::always_inline]] static ConstraintTerms<rows, T> constraint_function(G const& geometry, Frame<T> const& a,
                                                                             Frame<T> const& b) {
    ConstraintTerms<rows, T> terms;
    int row = 0;
    ((Es::write(geometry, a, b, terms, row), row += Es::rows), ...);
    return terms;
  }
  /// γ (rows) of `geometry` at the frames a and b.
  template <StateScalar T, class G>
  static Vec<T, rows> gamma(G const& geometry, Frame<T> const& a, Frame<T> const& b) {
    Vec<T, rows> gamma;
    T* out = gamma.data();
    ((Es::gamma(geometry, a, b, out), out += Es::rows), ...);
    return gamma;
  }
  /// Wrench gradient of `geometry` at the frames a and b for multipliers lambda (rows).
  template <class G>
  static WrenchGradient wrench_gradient(G const& geometry, Frame<double> const& a, Frame<double> const& b,
                                        Vec<double, rows> const& lambda) {
    auto k = detail::zeros<WrenchGradient>();
    double const* l = lambda.data();
    ((Es::add_gradient(geometry, a, b, l, k), l += Es::rows), ...);
    return k;
  }
};

}  // namespace polybody
