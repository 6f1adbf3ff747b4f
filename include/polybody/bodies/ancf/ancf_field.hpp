#pragma once
/// \file
/// The field of the fully parameterised ANCF beam. In an element of length l, with r₀(x) cubic and r_y, r_z linear in
/// x,
///   r(x, y, z) = r₀ + y r_y + z r_z = Σ N_v(x, y, z) e_v,  e = (r, r_x, r_y, r_z) of the first node, then of the
///   second
/// [Shabana & Yakoub 2001; Yakoub & Shabana 2001; thesis Eq. 3.16]. The reference is such a field, too; strains are
/// measured against it, in the axes of its sections (`SectionFrame` of r_y, r_z).

#include <polybody/bodies/ancf/section_frame.hpp>
#include <polybody/bodies/shared/bar.hpp>
#include <polybody/math/shape_functions.hpp>

namespace polybody::ancf {

inline constexpr int vectors = 8;  ///< nodal vectors of an element, numbered v; component i is coordinate 3 v + i
inline constexpr int columns = 3 * vectors;  ///< coordinates of an element
using Coordinates = Vec<double, columns>;    ///< coordinates of an element (24)

/// N_v and its derivatives by x, y, z at (ξ, y, z), as columns.
template <class = void>  // compiled where it is used
Mat<double, vectors, 4> shape(double xi, double y, double z, double l) {
  ShapeValues<4> const h = hermite_shape(xi, l);
  Mat<double, vectors, 4> n = Mat<double, vectors, 4>::Zero();
  for (int node = 0; node < 2; ++node) {
    double const s = node == 0 ? 1.0 - xi : xi, ds = (node == 0 ? -1.0 : 1.0) / l;
    int const v = 4 * node;
    n(v, 0) = h.s[2 * node];
    n(v, 1) = h.ds[2 * node];
    n(v + 1, 0) = h.s[2 * node + 1];
    n(v + 1, 1) = h.ds[2 * node + 1];
    n(v + 2, 0) = y * s;
    n(v + 2, 1) = y * ds;
    n(v + 2, 2) = s;
    n(v + 3, 0) = z * s;
    n(v + 3, 1) = z * ds;
    n(v + 3, 3) = s;
  }
  return n;
}

/// The reference of an element.
class Reference {
 public:
  double l = 0.0;                       ///< of the axis [m]
  Coordinates x = Coordinates::Zero();  ///< e
  bool straight = true;                 ///< neither bent nor twisted

  /// det [r_x r_y r_z], linear in y and z: negative where the section is turned inside out.
  template <class T = double>  // compiled where it is used
  double determinant(double xi, double y, double z) const {
    return straight ? 1.0 : jacobian<T>(xi, y, z).determinant();
  }

  /// ∂N/∂X of the place X in the section's axes there, so that F = Σ e_v (∂N_v/∂X)ᵀ is one in the reference; and the
  /// reference volume dV/(dx dy dz) by that on the axis. (Between nodes the interpolated section is smaller by the
  /// chord than the bar's.)
  struct Gradients {
    Mat<double, vectors, 3> g;  ///< (8×3) a row for each nodal vector
    double volume;              ///< relative to that on the axis
  };
  /// ∂N/∂X = [N_x N_y N_z] J₀⁻¹ at (ξ, y, z) [m],  J₀ = Rᵀ [r_x r_y r_z] of the reference, R its section frame.
  template <class T = double>  // compiled where it is used
  Gradients gradients(double xi, double y, double z) const {
    Mat<T, vectors, 4> const n = shape(xi, y, z, l);
    Mat<T, vectors, 3> const natural = n.template rightCols<3>();
    if (straight) return {natural, 1.0};
    Mat<T, 3, 3> const j = jacobian<T>(xi, y, z);
    SectionFrame<T> const frame(j.col(1), j.col(2));
    Mat<T, 3, 3> const j0 = frame.R.transpose() * j;
    return {natural * j0.inverse(), j.determinant() / determinant(xi, 0.0, 0.0)};
  }

 private:
  template <class T>  // compiled where it is used
  Mat<T, 3, 3> jacobian(double xi, double y, double z) const {
    Vec<T, columns> const e = x;
    Mat<T, vectors, 4> const n = shape(xi, y, z, l);
    return e.reshaped(3, vectors) * n.template rightCols<3>();
  }
};

/// An element deformed to the coordinates e.
struct Deformation {
  Reference const& reference;  ///< must outlive this
  Coordinates e;               ///< (24) of both nodes

  /// F at (ξ, y, z) [m]: from the axes of the reference section to world axes.
  template <class T = double>  // compiled where it is used
  Mat3 gradient(double xi, double y, double z) const {
    Vec<T, columns> const x = e;
    return x.reshaped(3, vectors) * reference.gradients(xi, y, z).g;
  }
  /// Green–Lagrange strain E at (ξ, y, z) [m], in the axes of the reference section.
  template <class T = double>  // compiled where it is used
  Mat3 strain(double xi, double y, double z) const {
    Mat<T, 3, 3> const f = gradient(xi, y, z);
    return 0.5 * (f.transpose() * f - Mat<T, 3, 3>::Identity());
  }
};

/// A bar's section as four points, each with a quarter of its area, that give its area and both its second moments:
/// y = ±√(I_z/A), z = ±√(I_y/A). For a rectangle they are the Gauss points (2 × 2).
struct SectionPoints {
  double y, z;  ///< √(I_z/A) and √(I_y/A) [m]
  /// Calls f(y, z) at each of the four points [m].
  template <class F>
  void for_each(F&& f) const {
    for (double const a : {-y, y})
      for (double const b : {-z, z}) f(a, b);
  }
};

}  // namespace polybody::ancf
