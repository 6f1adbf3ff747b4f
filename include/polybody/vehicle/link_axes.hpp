#pragma once
/// \file
/// Axes of a track link for the evaluation of contacts.
/// Theory: Eq. 8.30.

#include <polybody/kinematics/frame.hpp>

namespace polybody {

namespace detail {
/// Column j of A. The column is copied entry by entry, because expressions of Eigen would be compiled again for dual
/// numbers.
template <StateScalar T>
Vec<T, 3> column(Mat<T, 3, 3> const& A, int j) {
  return {A(0, j), A(1, j), A(2, j)};
}
template <StateScalar T>
Vec<T, 3> sum(Vec<T, 3> const& a, Vec<T, 3> const& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
template <StateScalar T>
Vec<T, 3> scaled(Vec<T, 3> const& a, T const& x) {
  return {a[0] * x, a[1] * x, a[2] * x};
}
/// Point r + A p.
template <StateScalar T>
Vec<T, 3> point_in(Vec<T, 3> const& r, Mat<T, 3, 3> const& A, Vec<T, 3> const& p) {
  Vec<T, 3> const arm = A * p;
  return sum<T>(r, arm);
}
/// Component of the vector a that is perpendicular to the unit vector n.
template <StateScalar T>
Vec<T, 3> across(Vec<T, 3> const& a, Vec<T, 3> const& n) {
  T const along = n.dot(a);
  return {a[0] - n[0] * along, a[1] - n[1] * along, a[2] - n[2] * along};
}
}  // namespace detail

/// Axes of a link (3×3): x from its rear pin to its front pin, y along its pins, z towards the wheels. If the marker
/// has a full frame, these are the axes of the frame. A cable has only a tangent, x. In this case y is perpendicular to
/// the tangent and as close as possible to `lateral`, the axle of the touching body.
template <MarkerKind observed, StateScalar T>
Mat<T, 3, 3> link_axes(Frame<T> const& link, Vec<T, 3> const& lateral) {
  if constexpr (observed == MarkerKind::frame) {
    return link.A;
  } else {
    using std::sqrt;
    Mat<T, 3, 3> axes;
    Vec<T, 3> const x = detail::column<T>(link.A, 0), y = detail::across<T>(lateral, x);
    T const length = sqrt(y.squaredNorm());
    Vec<T, 3> const unit(y[0] / length, y[1] / length, y[2] / length), z = cross<T>(x, unit);
    for (int i = 0; i < 3; ++i) {
      axes(i, 0) = x[i];
      axes(i, 1) = unit[i];
      axes(i, 2) = z[i];
    }
    return axes;
  }
}

}  // namespace polybody
