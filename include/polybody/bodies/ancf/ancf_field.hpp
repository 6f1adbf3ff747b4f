#pragma once
/// \file
/// Position field of the fully parameterised ANCF beam [Shabana & Yakoub 2001; Yakoub & Shabana 2001; thesis Eq. 3.16].
/// In an element of length l, r₀(x) is cubic, and r_y and r_z are linear in x:
///   r(x, y, z) = r₀ + y r_y + z r_z = Σ N_v(x, y, z) e_v,
///   e = (r, r_x, r_y, r_z) of the first node, then of the second.
/// The reference is a field of the same kind. Strains are relative to the reference, in the axes of its sections
/// (`SectionFrame` of r_y, r_z).
/// Theory: Eqs. 2.33, 2.41.

#include <polybody/bodies/ancf/section_frame.hpp>
#include <polybody/bodies/shared/bar.hpp>
#include <polybody/math/element_functions.hpp>

namespace polybody::ancf {

inline constexpr int vectors = 8;  ///< number of nodal vectors e_v of an element; entry i of e_v is coordinate 3v + i
inline constexpr int columns = 3 * vectors;  ///< number of coordinates of an element
using Coordinates = Vec<double, columns>;    ///< coordinates of an element (24)

/// Shape functions N_v and their derivatives with respect to x, y, z at (ξ, y, z), as columns.
template <class = void>  // compiled only if used
Mat<double, vectors, 4> shape(double xi, double y, double z, double l) {
  ShapeValues<4> const h = hermite_shape(xi, l);
  Mat<double, vectors, 4> n = Mat<double, vectors, 4>::Zero();
  for (int node = 0; node < 2; ++node) {
    double const s = node == 0 ? 1.0 - xi : xi, ds = (node == 0 ? -1.0 : 1.0) / l;
    int const v = 4 * node;
    std::size_t const first = std::size_t(2 * node);
    n(v, 0) = h.s[first];
    n(v, 1) = h.ds[first];
    n(v + 1, 0) = h.s[first + 1];
    n(v + 1, 1) = h.ds[first + 1];
    n(v + 2, 0) = y * s;
    n(v + 2, 1) = y * ds;
    n(v + 2, 2) = s;
    n(v + 3, 0) = z * s;
    n(v + 3, 1) = z * ds;
    n(v + 3, 3) = s;
  }
  return n;
}

/// Reference configuration of an element.
class Reference {
 public:
  double l = 0.0;                       ///< length of the axis [m]
  double start = 0.0;                   ///< arc length of the first node [m]
  Coordinates x = Coordinates::Zero();  ///< nodal coordinates e
  bool straight = true;                 ///< true if the reference is neither bent nor twisted

  /// Determinant det [r_x r_y r_z] of the reference, linear in y and z. It is negative if the section is turned inside
  /// out.
  template <class T = double>  // compiled only if used
  double determinant(double xi, double y, double z) const {
    return straight ? 1.0 : jacobian<T>(xi, y, z).determinant();
  }

  /// Gradients ∂N/∂X with respect to the position X in the axes of the section, so that F = Σ e_v (∂N_v/∂X)ᵀ is the
  /// rotation of the section in the reference. The volume dV/(dx dy dz) is divided by its value on the axis, because
  /// between the nodes of a curved element the interpolated section is smaller than the section of the bar.
  struct Gradients {
    Mat<double, vectors, 3> g;  ///< 8×3, a row for each nodal vector
    double volume;              ///< dV/(dx dy dz), divided by its value on the axis [1]
  };
  /// Gradients ∂N/∂X = [N_x N_y N_z] J₀⁻¹ at (ξ, y, z) [m], with J₀ = Rᵀ [r_x r_y r_z] of the reference and R its
  /// section frame.
  template <class T = double>  // compiled only if used
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
  template <class T>  // compiled only if used
  Mat<T, 3, 3> jacobian(double xi, double y, double z) const {
    Vec<T, columns> const e = x;
    Mat<T, vectors, 4> const n = shape(xi, y, z, l);
    return e.reshaped(3, vectors) * n.template rightCols<3>();
  }
};

/// Element in the deformed configuration with the coordinates e.
struct Deformation {
  Reference const& reference;  ///< must outlive this object
  Coordinates e;               ///< coordinates of both nodes (24)

  /// Deformation gradient F at (ξ, y, z) [m], from the axes of the reference section to world axes.
  template <class T = double>  // compiled only if used
  Mat3 gradient(double xi, double y, double z) const {
    Vec<T, columns> const x = e;
    return x.reshaped(3, vectors) * reference.gradients(xi, y, z).g;
  }
  /// Green–Lagrange strain E at (ξ, y, z) [m], in the axes of the reference section.
  template <class T = double>  // compiled only if used
  Mat3 strain(double xi, double y, double z) const {
    Mat<T, 3, 3> const f = gradient(xi, y, z);
    return 0.5 * (f.transpose() * f - Mat<T, 3, 3>::Identity());
  }
};

/// Four points of a section, each with a quarter of its area or mass: the centre ± a ± b with the vectors a = (`y`,
/// `yz`) and b = (0, `z`). For a symmetric section, y = √(I_z/A) and z = √(I_y/A) reproduce the area and both second
/// moments of area. For a rectangle the points are the Gauss points (2 × 2).
struct SectionPoints {
  double mass = 0.0;                      ///< mass per length of the four points [kg/m]
  double centre_y = 0.0, centre_z = 0.0;  ///< centre of the points [m]
  double y = 0.0, yz = 0.0, z = 0.0;      ///< components of a and b [m]
  /// Calls f(y, z) at each of the four points [m].
  template <class F>
  void for_each(F&& f) const {
    for (double const a : {-1.0, 1.0})
      for (double const b : {-1.0, 1.0}) f(centre_y + a * y, centre_z + a * yz + b * z);
  }
};

/// Elastic force whose mass comes from matrices of the section (`CoupledLine`).
template <class E>
concept BySectionMatrices = requires(Bar const& bar) {
  { E::section_points(bar, 0.0) } -> std::same_as<SectionPoints>;
};

/// Mass integrals of an element: M = ∫ρ NᵀN dV, equal for the three components, and ∫ρ N dV.
struct Inertia {
  Mat<double, columns, columns> mass = Mat<double, columns, columns>::Zero();  ///< M (24×24)
  Vec<double, vectors> first_moment = Vec<double, vectors>::Zero();            ///< ∫ρ N dV (8)
};
/// Mass integrals of the reference `ref`, for an element with the elastic force E. Quadrature points: Gauss points
/// along x, exact for the straight bar, and four points of the section that reproduce its mass, centre and inertia.
template <class E>
Inertia inertia_of(Bar const& bar, BarConstants const& c, Reference const& ref) {
  double const rho = c.mass_per_length, iz = c.rotary_inertia;
  SectionPoints section{.mass = rho, .y = std::sqrt(iz / rho), .z = std::sqrt(c.rotary_inertia_y.value_or(iz) / rho)};
  Inertia out;
  for (GaussPoint const& g : gauss<4>) {
    if constexpr (BySectionMatrices<E>) section = E::section_points(bar, ref.start + g.xi * ref.l);
    section.for_each([&](double y, double z) {
      double const volume = BySectionMatrices<E> ? 1.0 : ref.gradients(g.xi, y, z).volume;
      double const mass = 0.25 * section.mass * g.weight * ref.l * volume;
      Mat<double, vectors, 4> const n = shape(g.xi, y, z, ref.l);
      for (int a = 0; a < vectors; ++a) out.first_moment[a] += mass * n(a, 0);
      for (int a = 0; a < vectors; ++a)
        for (int b = 0; b < vectors; ++b)
          for (int i = 0; i < 3; ++i) out.mass(3 * a + i, 3 * b + i) += mass * n(a, 0) * n(b, 0);
    });
  }
  return out;
}

}  // namespace polybody::ancf
