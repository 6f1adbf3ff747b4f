#pragma once
/// \file
/// Mass, centre of mass and inertia tensor of rigid parts: simple solids, other axes, sums of parts.
/// Theory: Eqs. 10.1 to 10.5, 10.10.

#include <polybody/bodies/rigid/rigid.hpp>

namespace polybody {

namespace detail {
/// m (|d|² 1 − d dᵀ): inertia tensor (3×3) of a point with mass `mass` [kg] at d (3) [m] about the origin [kg m²].
inline Mat3 point_inertia(double mass, Vec3 const& d) {
  Mat3 out;
  double const square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) out(i, j) = mass * ((i == j ? square : 0.0) - d[i] * d[j]);
  return out;
}
/// A M Aᵀ for a rotation matrix A (3×3) and a symmetric matrix M (3×3). The result is exactly symmetric.
inline Mat3 turned(Mat3 const& a, Mat3 const& m) {
  Mat3 out;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j <= i; ++j) {
      double sum = 0.0;
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l) sum += a(i, k) * m(k, l) * a(j, l);
      out(i, j) = out(j, i) = sum;
    }
  return out;
}
}  // namespace detail

/// Axes (3×3) after rotations by `roll` about x, then `pitch` about y, then `yaw` about z [rad], all about fixed axes:
///   R = R_z(yaw) R_y(pitch) R_x(roll).
/// A column is an axis of the rotated frame in the axes of the fixed frame.
inline Mat3 roll_pitch_yaw(double roll, double pitch, double yaw) {
  double const cr = std::cos(roll), sr = std::sin(roll), cp = std::cos(pitch), sp = std::sin(pitch);
  double const cy = std::cos(yaw), sy = std::sin(yaw);
  Mat3 out;
  double const rows[3][3] = {{cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr},
                             {sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr},
                             {-sp, cp * sr, cp * cr}};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) out(i, j) = rows[i][j];
  return out;
}

/// Mass, centre of mass and inertia tensor of a rigid part, in the axes of the part:
///   Inertia const arm = Inertia::cylinder(2.0, 0.03, 0.5) + Inertia::sphere(1.0, 0.1).placed(Placement::at({0, 0,
///   0.3})); auto const link = model.add(Rigid<>(arm.body()), "arm");
/// Every operation refuses a mass that is not positive and a tensor that no distribution of mass has.
struct Inertia {
  Required<double> mass;       ///< m [kg]
  Vec3 centre = Vec3::Zero();  ///< c (3) centre of mass, axes of the part [m]
  Mat3 tensor = Mat3::Zero();  ///< J (3×3) about the centre of mass, axes of the part [kg m²]

  /// \throws InvalidInput, with a message that begins with `what`, for a mass that is not positive, a centre of mass
  /// that is not finite, a tensor that is not symmetric, and principal moments that violate the triangle inequality.
  template <class = void>  // compiled only if used
  void check(std::string const& what) const {
    require_positive(mass, what, ": the mass");
    require_finite(centre, what, ": the centre of mass");
    require_inertia(tensor, what);
  }

  /// Inertia tensor (3×3) about `point` (3) [m] in the axes `axes` (3×3), whose columns are unit vectors in the axes of
  /// the part:  Rᵀ (J + m (|d|² 1 − d dᵀ)) R,  d = point − c   [parallel-axis theorem, Shabana 2020, §3.3].
  template <class = void>  // compiled only if used
  Mat3 about(Vec3 const& point, Mat3 const& axes = identity()) const {
    check("Inertia");
    Placement{point, axes}.check("Inertia::about");
    return detail::turned(axes.transpose(), Mat3(tensor + detail::point_inertia(mass, point - centre)));
  }

  /// Inertia of this part in outer axes. `placement` is the frame of the part in these axes:
  ///   c' = r + R c,  J' = R J Rᵀ.
  template <class = void>  // compiled only if used
  Inertia placed(Placement const& placement) const {
    check("Inertia");
    placement.check("Inertia::placed");
    return {mass, placement.origin + placement.axes * centre, detail::turned(placement.axes, tensor)};
  }

  /// Parameters of a rigid body `Rigid<>`. `placement` gives the origin and the axes of the part in world axes. The
  /// body has the axes of the part, and its points are given from the centre of mass: `body.at(point -
  /// inertia.centre)`.
  template <class = void>  // compiled only if used
  RigidShape::Parameters body(Placement const& placement = {}) const {
    check("Inertia");
    placement.check("Inertia::body");
    return {mass, tensor, {placement.origin + placement.axes * centre, placement.axes}};
  }

  /// Inertia of two parts a and b in the same axes that move as one body.
  friend Inertia operator+(Inertia const& a, Inertia const& b) {
    a.check("Inertia");
    b.check("Inertia");
    double const total = a.mass + b.mass;
    return {total, Vec3(a.centre * (a.mass / total) + b.centre * (b.mass / total)),
            Mat3(a.tensor + b.tensor + detail::point_inertia(a.mass * (b.mass / total), b.centre - a.centre))};
  }

  /// Solid cuboid of `mass` [kg] with the `edges` (3) along x, y and z [m]; the origin is its centre.
  ///   J_x = m (b² + c²)/12 …
  template <class = void>  // compiled only if used
  static Inertia box(double mass, Vec3 const& edges) {
    for (int i = 0; i < 3; ++i)
      require_positive(edges[i], "Inertia::box: the edge along ", i == 0 ? "x" : i == 1 ? "y" : "z");
    Vec3 const square = edges.cwiseProduct(edges) * (mass / 12.0);
    return of_principal("Inertia::box", mass, {square[1] + square[2], square[2] + square[0], square[0] + square[1]});
  }
  /// Solid cylinder of `mass` [kg] with `radius` [m] and `length` along z [m]; the origin is its centre.
  ///   J_z = m r²/2,  J_x = J_y = m (3 r² + l²)/12.
  template <class = void>  // compiled only if used
  static Inertia cylinder(double mass, double radius, double length) {
    require_positive(radius, "Inertia::cylinder: the radius");
    require_positive(length, "Inertia::cylinder: the length");
    double const across = mass * (3.0 * radius * radius + length * length) / 12.0;
    return of_principal("Inertia::cylinder", mass, {across, across, 0.5 * mass * radius * radius});
  }
  /// Solid sphere of `mass` [kg] with `radius` [m]; the origin is its centre.  J = 2 m r²/5.
  template <class = void>  // compiled only if used
  static Inertia sphere(double mass, double radius) {
    require_positive(radius, "Inertia::sphere: the radius");
    double const all = 0.4 * mass * radius * radius;
    return of_principal("Inertia::sphere", mass, {all, all, all});
  }
  /// Tube of `mass` [kg] with the radii `outer` and `inner` [m] and `length` along z [m]; the origin is its centre. For
  /// `inner` = `outer` it is a thin shell.  J_z = m (r² + s²)/2,  J_x = J_y = m (3 (r² + s²) + l²)/12.
  template <class = void>  // compiled only if used
  static Inertia tube(double mass, double outer, double inner, double length) {
    require_positive(outer, "Inertia::tube: the outer radius");
    require_positive(length, "Inertia::tube: the length");
    if (!(inner >= 0.0 && inner <= outer))
      throw InvalidInput("inertia.tube", {ErrorObject{"Inertia::tube"}, ": the inner radius must lie in [0, ", outer,
                                          "] m, but is ", ErrorValue{inner}, " m."});
    double const squares = outer * outer + inner * inner, across = mass * (3.0 * squares + length * length) / 12.0;
    return of_principal("Inertia::tube", mass, {across, across, 0.5 * mass * squares});
  }

 private:
  template <class = void>  // compiled only if used
  static Inertia of_principal(std::string const& what, double mass, Vec3 const& moments) {
    Inertia const out{.mass = mass, .tensor = Mat3(moments.asDiagonal())};
    out.check(what);
    return out;
  }
};

}  // namespace polybody
