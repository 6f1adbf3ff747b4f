#pragma once
/// \file
/// Contact of a rounded segment with a rounded box: two contact points whose depths and positions are continuous
/// functions of the poses.
/// Theory: Eqs. 9.49 to 9.53.

#include <polybody/forces/contact.hpp>

namespace polybody::detail {

/// Column j of A, copied entry by entry: expressions of Eigen would be compiled again for dual numbers.
template <StateScalar T>
Vec<T, 3> axis_of(Mat<T, 3, 3> const& A, int j) {
  return {A(0, j), A(1, j), A(2, j)};
}
/// Components of the vector x along the axes of A, Aᵀx.
template <StateScalar T>
Vec<T, 3> in_axes(Mat<T, 3, 3> const& A, Vec<T, 3> const& x) {
  return {axis_of<T>(A, 0).dot(x), axis_of<T>(A, 1).dot(x), axis_of<T>(A, 2).dot(x)};
}
/// Axes B in the axes A, AᵀB (3×3).
template <StateScalar T>
Mat<T, 3, 3> axes_in(Mat<T, 3, 3> const& A, Mat<T, 3, 3> const& B) {
  Mat<T, 3, 3> axes;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) axes(i, k) = A(0, i) * B(0, k) + A(1, i) * B(1, k) + A(2, i) * B(2, k);
  return axes;
}
/// Point r + A p, with p (3) in the axes A [m].
template <StateScalar T>
Vec<T, 3> point_of(Vec<T, 3> const& r, Mat<T, 3, 3> const& A, Vec3 const& p) {
  Vec<T, 3> at = r;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) at[i] += A(i, k) * p[k];
  return at;
}
/// Corner number `corner`, from 0 to 7, of a box with half sizes h (3) [m] about r, with its edges along the axes A.
template <StateScalar T>
Vec<T, 3> corner_of(Vec<T, 3> const& r, Mat<T, 3, 3> const& A, Vec3 const& h, int corner) {
  return point_of<T>(r, A, {(corner & 1) ? h[0] : -h[0], (corner & 2) ? h[1] : -h[1], (corner & 4) ? h[2] : -h[2]});
}
/// Right-handed axes (3×3) with the unit vector x as their first column.
template <StateScalar T>
Mat<T, 3, 3> axes_about(Vec<T, 3> const& x) {
  using std::sqrt;
  int i = 0;
  for (int k = 1; k < 3; ++k)
    if (std::abs(value_of(x[k])) < std::abs(value_of(x[i]))) i = k;
  int const j = (i + 1) % 3, k = (i + 2) % 3;
  T const length = sqrt(T(x[j] * x[j] + x[k] * x[k]));
  Vec<T, 3> y;  // x × unit vector i
  y[i] = T(0.0);
  y[j] = x[k] / length;
  y[k] = -x[j] / length;
  Vec<T, 3> const z = x.cross(y);
  Mat<T, 3, 3> axes;
  for (int row = 0; row < 3; ++row) {
    axes(row, 0) = x[row];
    axes(row, 1) = y[row];
    axes(row, 2) = z[row];
  }
  return axes;
}

/// Signed distance of a point from a box, negative inside [m], and its gradient, a unit vector.
template <StateScalar T>
struct BoxDistance {
  T distance;
  Vec<T, 3> normal;
};
/// Distance of the point c (3) from the box |x_i| ≤ h_i about the origin, with the half sizes h (3) [m]. Outside,
/// the distance has a continuous gradient. Inside, the nearest face determines the distance.
template <StateScalar T>
BoxDistance<T> distance_from(Vec3 const& h, Vec<T, 3> const& c) {
  using std::sqrt;
  Vec<T, 3> out(T(0.0), T(0.0), T(0.0));
  int nearest = 0;
  double most = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    double const x = value_of(c[i]), beyond = std::abs(x) - h[i];
    if (beyond > most) {
      most = beyond;
      nearest = i;
    }
    if (beyond > 0.0) out[i] = x < 0.0 ? c[i] + h[i] : c[i] - h[i];
  }
  if (most > 0.0) {
    T const distance = sqrt(out.dot(out));
    return {distance, {out[0] / distance, out[1] / distance, out[2] / distance}};
  }
  double const side = value_of(c[nearest]) < 0.0 ? -1.0 : 1.0;
  out[nearest] = T(side);
  return {c[nearest] * side - h[nearest], out};
}
/// Second derivative of `distance_from` along the unit vector u (3) at c (3) [1/m]: (|P u|² − (u·n)²)/distance, with
/// the components P u along the axes in which c lies beyond the box. It is zero inside.
inline double distance_curvature(Vec3 const& h, Vec3 const& c, Vec3 const& u, BoxDistance<double> const& at) {
  if (!(at.distance > 0.0)) return 0.0;
  double beyond = 0.0;
  for (int i = 0; i < 3; ++i)
    if (std::abs(c[i]) > h[i]) beyond += u[i] * u[i];
  double const along = u.dot(at.normal);
  return std::max(0.0, beyond - along * along) / at.distance;
}

/// Sizes of a rounded segment in contact with a rounded box.
struct SegmentOnBox {
  double half;         ///< ℓ, half length of the segment [m]
  double radius;       ///< ρ_a, radius about the segment [m]
  double rounding;     ///< ρ_b, radius about the box [m]
  double taper;        ///< τ, loss of depth from one end of the segment to the other [m]
  double share = 1.0;  ///< weight of each point [1]

  /// κ = τ/(2ℓ²) [1/m]
  double bend() const { return half > 0.0 ? taper / (2.0 * half * half) : 0.0; }
};

/// Coordinate s in [−ℓ, ℓ] at which f(s) = distance(m + s u) + ½ κ (s − s_k)² is least, with the middle m (3) and
/// the direction u (3) of the segment in the axes of the box. f is strictly convex for κ > 0. Newton's method, with
/// bisection as safeguard, computes the zero of f′.
template <class = void>
double nearest_on_segment(Vec3 const& h, Vec3 const& m, Vec3 const& u, double half, double s_k, double kappa) {
  if (!(half > 0.0)) return 0.0;
  double bend = 0.0;
  auto const slope = [&](double s) {
    Vec3 const c = shifted<double>(m, u, s);
    BoxDistance<double> const at = distance_from<double>(h, c);
    bend = kappa + distance_curvature(h, c, u, at);
    return u.dot(at.normal) + kappa * (s - s_k);
  };
  double const at_end = slope(s_k);
  if (s_k > 0.0 ? at_end <= 0.0 : at_end >= 0.0) return s_k;
  if (s_k > 0.0 ? slope(-half) >= 0.0 : slope(half) <= 0.0) return -s_k;
  double low = -half, high = half, s = 0.0, step = half, before = 2.0 * half;
  for (int k = 0; k < 200; ++k) {
    double const g = slope(s);
    if (g == 0.0) return s;
    (g > 0.0 ? high : low) = s;
    double next = s - g / bend;
    bool const slow = !(std::abs(2.0 * g) < std::abs(before * bend));  // also true if the curvature is zero
    before = step;
    if (slow || !(next > low && next < high)) next = 0.5 * (low + high);
    step = next - s;
    s = next;
    if (std::abs(step) <= 4e-16 * half || high - low <= 4e-16 * half) break;
  }
  return s;
}

/// Contact points of the rounded segment m + s u, |s| ≤ ℓ, with the rounded box of half sizes h (3). Middle m (3) and
/// direction u (3) are in axes of the box. Calls visit(point, k) with place and normal in these axes, for k = 0 and 1.
///
/// Point k has the depth
///   d_k = ρ_a + ρ_b − min over s of f_k(s),   f_k(s) = distance(m + s u) + ½ κ (s − s_k)²,   s_k = ∓ℓ.
/// f_k is strictly convex. Its minimum, at s*, is therefore unique and a continuous function of the pose, also if the
/// segment is parallel to a face or an edge. With κ = 0, point k would jump from end to end in this position. By the
/// envelope theorem the terms with δs* cancel, so that δd_k = −n·δ(m + s u) at fixed s = s*. The force N(d_k) n at
/// this point is thus the exact derivative of the potential U(d_k). The loss ½ κ (s − s_k)² is at most τ.
template <StateScalar T, class Visit>
void touch_box(Vec3 const& h, Vec<T, 3> const& m, Vec<T, 3> const& u, SegmentOnBox const& shape, Visit&& visit) {
  Vec3 const middle = polybody::values_of(m), along = polybody::values_of(u);
  double const reach = shape.radius + shape.rounding, kappa = shape.bend();
  for (int i = 0; i < 3; ++i)
    if (std::abs(middle[i]) - std::abs(along[i]) * shape.half >= h[i] + reach) return;
  for (int k = 0; k < 2; ++k) {
    double const s_k = k == 0 ? -shape.half : shape.half;
    double const s0 = nearest_on_segment(h, middle, along, shape.half, s_k, kappa);
    Vec3 const c0 = shifted<double>(middle, along, s0);
    BoxDistance<double> const near = distance_from<double>(h, c0);
    if (!(near.distance + 0.5 * kappa * (s0 - s_k) * (s0 - s_k) < reach)) continue;
    T s(s0);
    if constexpr (!std::is_same_v<T, double>)
      if (std::abs(s0) < shape.half) {  // derivative of s*: one step of Newton's method with dual numbers
        BoxDistance<T> const at = distance_from<T>(h, shifted<T>(m, u, T(s0)));
        double const bend = kappa + distance_curvature(h, c0, along, near);
        s = T(s0) - (u.dot(at.normal) + kappa * (s0 - s_k)) * (1.0 / bend);
      }
    Vec<T, 3> const c = shifted<T>(m, u, s);
    BoxDistance<T> const at = distance_from<T>(h, c);
    T const depth = T(reach) - at.distance - (s - s_k) * (s - s_k) * (0.5 * kappa);
    ContactPoint<T> point{shifted<T>(c, at.normal, T(shape.rounding) - depth * 0.5 - at.distance), at.normal, depth};
    point.handover.share = T(shape.share);
    point.slot = k;
    visit(point);
  }
}

/// Contact point of a sphere of radius `radius` about c (3) with the rounded box of half sizes h (3), in axes of the
/// box [m].
template <StateScalar T, class Visit>
void touch_box(Vec3 const& h, Vec<T, 3> const& c, double radius, double rounding, Visit&& visit) {
  Vec3 const at = polybody::values_of(c);
  for (int i = 0; i < 3; ++i)
    if (std::abs(at[i]) >= h[i] + radius + rounding) return;
  BoxDistance<T> const from = distance_from<T>(h, c);
  T const depth = T(radius + rounding) - from.distance;
  if (value_of(depth) > 0.0)
    visit(ContactPoint<T>{shifted<T>(c, from.normal, T(rounding) - depth * 0.5 - from.distance), from.normal, depth});
}

/// Moves a point from the axes A at r to world axes, with the normal multiplied by `sign`.
template <StateScalar T>
ContactPoint<T> in_world(ContactPoint<T> p, Vec<T, 3> const& r, Mat<T, 3, 3> const& A, double sign) {
  Vec<T, 3> const place = A * p.place, normal = A * p.normal;
  for (int i = 0; i < 3; ++i) {
    p.place[i] = r[i] + place[i];
    p.normal[i] = normal[i] * sign;
  }
  return p;
}

/// True if a point that moves from x to y (3) [m] passes through a rounded box: the distance from the box exceeds the
/// radius `rounding` [m] at both ends, and is less than 95 % of it between them.
template <class = void>
bool passes_through_box(Vec3 const& h, Vec3 const& x, Vec3 const& y, double rounding) {
  Vec3 const way = y - x;
  double const length = std::sqrt(way.dot(way));
  if (length < 0.3 * rounding || !(distance_from<double>(h, x).distance > rounding) ||
      !(distance_from<double>(h, y).distance > rounding))
    return false;
  Vec3 const u = way / length, m = x + 0.5 * way;
  double const s = nearest_on_segment(h, m, u, 0.5 * length, 0.5 * length, 1e-9 / length);
  return distance_from<double>(h, shifted<double>(m, u, s)).distance < 0.95 * rounding;
}

/// \throws InvalidInput unless the three sizes [m] are positive and the rounding [m] lies between zero and half of the
/// smallest size.
template <class = void>
void require_box(Vec3 const& size, double rounding, std::string const& name, char const* of_size,
                 char const* of_rounding) {
  for (int i = 0; i < 3; ++i) require_positive(size[i], name, of_size, "m");
  double const most = 0.5 * std::min({size[0], size[1], size[2]});
  if (!(rounding >= 0.0 && rounding <= most))
    throw InvalidInput("contact.rounding",
                       {ErrorObject{name}, of_rounding, " must lie between 0 and half of the smallest size, ", most,
                        " m, but is ", ErrorValue{rounding}, " m."});
}
/// Half sizes (3) of the core of a rounded box [m].
template <class = void>
Vec3 core_of(Vec3 const& size, double rounding) {
  return {0.5 * size[0] - rounding, 0.5 * size[1] - rounding, 0.5 * size[2] - rounding};
}

}  // namespace polybody::detail
