#pragma once
/// \file
/// The axes of a track's link as contacts see them. Not in polybody.hpp: of use to vehicles only.

#include <polybody/kinematics/frame.hpp>

namespace polybody {

/// (3×3) x from the link's rear pin to its front pin, y along its pins, z towards the wheels. A marker with a full
/// frame has these axes itself. A cable has its tangent only: its y is the direction across the tangent that is nearest
/// to `lateral`, the axle of the body that it touches.
template <Observes observed, StateScalar T>
Mat<T, 3, 3> link_axes(Frame<T> const& link, Vec<T, 3> const& lateral) {
  if constexpr (observed == Observes::frame) {
    return link.A;
  } else {
    using std::sqrt;
    Mat<T, 3, 3> axes;
    Vec<T, 3> const x = link.A.col(0);
    Vec<T, 3> y = lateral - x * x.dot(lateral);
    y = y / sqrt(y.squaredNorm());
    axes.col(0) = x;
    axes.col(1) = y;
    axes.col(2) = x.cross(y);
    return axes;
  }
}

}  // namespace polybody
