#pragma once
/// \file
/// The rows from which joint geometries are put together, each with its maps and its γ. With d = r_b − r_a:
///   coincident points   g = d
///   perpendicular axes  g = u·w, u fixed in a, w fixed in b
///   no slide along u    g = u·d, u fixed in a
///   distance            g = |d| − L
/// γ is the part of g̈ that the accelerations of the frames do not explain.
/// [Haug 1989, §2.4 and §9.4; thesis Eq. 3.8–3.10 and §3.5.1]

#include <polybody/joints/gap.hpp>

namespace polybody::rows {

/// Writes g = r_b − r_a into rows [row, row + 3).
template <int m, StateScalar T>
void coincident(Frame<T> const& a, Frame<T> const& b, Gap<m, T>& gap, int row = 0) {
  gap.g.template segment<3>(row) = b.r - a.r;
  for (int i = 0; i < 3; ++i) {
    gap.Ga(row + i, i) = T(-1.0);
    gap.Gb(row + i, i) = T(1.0);
  }
}

/// Writes g = u·w: ġ = (u × w)·(ω_a − ω_b).
template <int m, StateScalar T>
void perpendicular(Vec<T, 3> const& u, Vec<T, 3> const& w, Gap<m, T>& gap, int row) {
  Vec<T, 3> const c = u.cross(w);
  gap.g[row] = u.dot(w);
  gap.Ga.row(row).template tail<3>() = c.transpose();
  gap.Gb.row(row).template tail<3>() = -c.transpose();
}

/// γ of `perpendicular`: 2 (ω_a × u)·(ω_b × w) + (ω_a × (ω_a × u))·w + u·(ω_b × (ω_b × w)).
template <StateScalar T>
T perpendicular_gamma(Vec<T, 3> const& u, Vec<T, 3> const& w, Frame<T> const& a, Frame<T> const& b) {
  Vec<T, 3> const ud = a.w.cross(u), wd = b.w.cross(w);
  return 2.0 * ud.dot(wd) + a.w.cross(ud).dot(w) + u.dot(b.w.cross(wd));
}

/// Writes g = u·d: ġ = u·(v_b − v_a) + (u × d)·ω_a.
template <int m, StateScalar T>
void no_slide(Vec<T, 3> const& u, Frame<T> const& a, Frame<T> const& b, Gap<m, T>& gap, int row) {
  Vec<T, 3> const d = b.r - a.r;
  gap.g[row] = u.dot(d);
  gap.Ga.row(row).template head<3>() = -u.transpose();
  gap.Ga.row(row).template tail<3>() = u.cross(d).transpose();
  gap.Gb.row(row).template head<3>() = u.transpose();
}

/// γ of `no_slide`: 2 (ω_a × u)·(v_b − v_a) + (ω_a × (ω_a × u))·d.
template <StateScalar T>
T no_slide_gamma(Vec<T, 3> const& u, Frame<T> const& a, Frame<T> const& b) {
  Vec<T, 3> const ud = a.w.cross(u);
  return 2.0 * ud.dot(b.v - a.v) + a.w.cross(ud).dot(b.r - a.r);
}

/// Writes the three rows a₁·b₂, a₂·b₃, a₃·b₁ that hold the axes of b parallel to those of a.
template <int m, StateScalar T>
void parallel(Frame<T> const& a, Frame<T> const& b, Gap<m, T>& gap, int row) {
  for (int i = 0; i < 3; ++i) perpendicular<m, T>(a.A.col(i), b.A.col((i + 1) % 3), gap, row + i);
}

template <StateScalar T>
Vec<T, 3> parallel_gamma(Frame<T> const& a, Frame<T> const& b) {
  Vec<T, 3> gamma;
  for (int i = 0; i < 3; ++i) gamma[i] = perpendicular_gamma<T>(a.A.col(i), b.A.col((i + 1) % 3), a, b);
  return gamma;
}

/// Writes a₁·b₃ and a₂·b₃, which hold the third axes parallel.
template <int m, StateScalar T>
void same_direction(Frame<T> const& a, Frame<T> const& b, Gap<m, T>& gap, int row) {
  for (int i = 0; i < 2; ++i) perpendicular<m, T>(a.A.col(i), b.A.col(2), gap, row + i);
}

template <StateScalar T>
Vec<T, 2> same_direction_gamma(Frame<T> const& a, Frame<T> const& b) {
  return {perpendicular_gamma<T>(a.A.col(0), b.A.col(2), a, b), perpendicular_gamma<T>(a.A.col(1), b.A.col(2), a, b)};
}

/// Writes a₁·d and a₂·d, which hold the point of b on the third axis of a.
template <int m, StateScalar T>
void on_axis(Frame<T> const& a, Frame<T> const& b, Gap<m, T>& gap, int row) {
  for (int i = 0; i < 2; ++i) no_slide<m, T>(a.A.col(i), a, b, gap, row + i);
}

template <StateScalar T>
Vec<T, 2> on_axis_gamma(Frame<T> const& a, Frame<T> const& b) {
  return {no_slide_gamma<T>(a.A.col(0), a, b), no_slide_gamma<T>(a.A.col(1), a, b)};
}

/// Writes g = |d| − length: ġ = e·(v_b − v_a), e = d/|d|. Points that coincide have no direction; x stands in for it,
/// so that `assemble` can part them.
template <int m, StateScalar T>
void distance(Frame<T> const& a, Frame<T> const& b, double length, Gap<m, T>& gap, int row = 0) {
  using std::sqrt;
  Vec<T, 3> e = b.r - a.r;
  T const d = sqrt(e.squaredNorm());
  if (value_of(d) > 0.0)
    e /= d;
  else
    e = Vec<T, 3>::UnitX();
  gap.g[row] = d - length;
  gap.Ga.row(row).template head<3>() = -e.transpose();
  gap.Gb.row(row).template head<3>() = e.transpose();
}

/// γ of `distance`: (|ḋ|² − (e·ḋ)²)/|d|.
template <StateScalar T>
T distance_gamma(Frame<T> const& a, Frame<T> const& b) {
  using std::sqrt;
  Vec<T, 3> const d = b.r - a.r, rate = b.v - a.v;
  T const d2 = d.squaredNorm(), along = d.dot(rate);
  return (rate.squaredNorm() - along * along / d2) / sqrt(d2);
}

/// ∂[wa; wb]/∂(δr_a, δφ_a, δr_b, δφ_b), 12×12: the wrenches of rows with multipliers, rotations in world axes.
using WrenchGradient = Mat<double, 12, 12>;

/// Adds λ times that of `perpendicular`: c = u × w, δc = (u wᵀ − (u·w) 1) δφ_a + ((u·w) 1 − w uᵀ) δφ_b.
inline void perpendicular_gradient(Vec3 const& u, Vec3 const& w, double lambda, WrenchGradient& k) {
  Mat3 const a = lambda * (u * w.transpose() - u.dot(w) * Mat3::Identity());
  Mat3 const b = lambda * (u.dot(w) * Mat3::Identity() - w * u.transpose());
  k.block<3, 3>(3, 3) += a;
  k.block<3, 3>(3, 9) += b;
  k.block<3, 3>(9, 3) -= a;
  k.block<3, 3>(9, 9) -= b;
}

/// Adds λ times that of `no_slide`: δu = −ũ δφ_a and δ(u × d) = (u dᵀ − (u·d) 1) δφ_a + ũ (δr_b − δr_a).
inline void no_slide_gradient(Vec3 const& u, Frame<double> const& a, Frame<double> const& b, double lambda,
                              WrenchGradient& k) {
  Vec3 const d = b.r - a.r;
  Mat3 const turn = lambda * skew<double>(u);
  k.block<3, 3>(0, 3) += turn;
  k.block<3, 3>(3, 0) -= turn;
  k.block<3, 3>(3, 3) += lambda * (u * d.transpose() - u.dot(d) * Mat3::Identity());
  k.block<3, 3>(3, 6) += turn;
  k.block<3, 3>(6, 3) -= turn;
}

/// Adds that of `parallel` for three multipliers.
inline void parallel_gradient(Frame<double> const& a, Frame<double> const& b, Vec3 const& lambda, WrenchGradient& k) {
  for (int i = 0; i < 3; ++i) perpendicular_gradient(a.A.col(i), b.A.col((i + 1) % 3), lambda[i], k);
}

/// Adds that of `same_direction` for two multipliers.
inline void same_direction_gradient(Frame<double> const& a, Frame<double> const& b, Vec2 const& lambda,
                                    WrenchGradient& k) {
  for (int i = 0; i < 2; ++i) perpendicular_gradient(a.A.col(i), b.A.col(2), lambda[i], k);
}

/// Adds that of `on_axis` for two multipliers.
inline void on_axis_gradient(Frame<double> const& a, Frame<double> const& b, Vec2 const& lambda, WrenchGradient& k) {
  for (int i = 0; i < 2; ++i) no_slide_gradient(a.A.col(i), a, b, lambda[i], k);
}

/// Adds λ times that of `distance`: δe = (1 − e eᵀ)(δr_b − δr_a)/|d|.
inline void distance_gradient(Frame<double> const& a, Frame<double> const& b, double lambda, WrenchGradient& k) {
  Vec3 const d = b.r - a.r;
  double const d2 = d.squaredNorm();
  Mat3 const turn = (lambda / std::sqrt(d2)) * (Mat3::Identity() - d * d.transpose() / d2);
  k.block<3, 3>(0, 0) += turn;
  k.block<3, 3>(0, 6) -= turn;
  k.block<3, 3>(6, 0) -= turn;
  k.block<3, 3>(6, 6) += turn;
}

/// A right-handed triad with both axes in it: \p first its first, \p third its third; `what` names the joint.
/// \throws InvalidInput unless they are unit vectors at right angles (to 1e-9).
inline Mat3 triad_of(Vec3 const& first, Vec3 const& third, std::string const& what) {
  require_unit(first, what + ": the first axis");
  require_unit(third, what + ": the second axis");
  if (std::abs(first.dot(third)) > 1e-9)
    throw InvalidInput(what +
                       ": the two axes must be perpendicular at the reference configuration, but their scalar product "
                       "is " +
                       number(first.dot(third)) + ".");
  Mat3 e;
  e << first, third.cross(first), third;
  return e;
}

/// A right-handed triad whose third axis is `axis`. \throws InvalidInput unless it is a unit vector.
inline Mat3 triad_about(Vec3 const& axis, std::string const& what) {
  require_unit(axis, what);
  int smallest = 0;
  axis.cwiseAbs().minCoeff(&smallest);
  Mat3 e;
  e.col(2) = axis;
  e.col(0) = (Vec3::Unit(smallest) - axis[smallest] * axis).normalized();
  e.col(1) = e.col(2).cross(e.col(0));
  return e;
}

}  // namespace polybody::rows
