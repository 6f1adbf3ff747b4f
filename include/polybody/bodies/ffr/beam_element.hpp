#pragma once
/// \file
/// Space beam element of thesis App. A [Przemieniecki 1968, §5.6, §11.4]: shape functions, stiffness and mass points,
/// in the axes of the body.
///
/// Not in polybody.hpp: Eigen's sparse module takes seconds to compile.

#include <polybody/bodies/ffr/structure.hpp>
#include <polybody/math/quadrature.hpp>

namespace polybody {

/// Shape functions of Eq. A.1 in the axes of the element, with nodal coordinates (u, v, w, θx, θy, θz) at both ends.
/// The displacement at (ξ l, y, z) is (axis + y · by_y + z · by_z) e, and the rotation of the section is `rotation` e.
struct BeamShapes {
  Mat<double, 3, 12> axis = Mat<double, 3, 12>::Zero();  ///< displacement of the axis
  Mat<double, 3, 12> by_y = Mat<double, 3, 12>::Zero(), by_z = Mat<double, 3, 12>::Zero();  ///< derivatives by y and z
  Mat<double, 3, 12> rotation = Mat<double, 3, 12>::Zero();                                 ///< (θx, −w′, v′)
  Mat<double, 4, 12> strain =
      Mat<double, 4, 12>::Zero();  ///< rows: axial strain, torsion, curvature about y, about z [1/m]

  /// Shape functions at ξ of an element of length l [m].
  template <class = void>  // compiled only if used
  BeamShapes(double xi, double l) {
    double const x = xi, h[4] = {1 - 3 * x * x + 2 * x * x * x, (x - 2 * x * x + x * x * x) * l,
                                 3 * x * x - 2 * x * x * x, (x * x * x - x * x) * l};
    double const d[4] = {6 * (x * x - x) / l, 1 - 4 * x + 3 * x * x, 6 * (x - x * x) / l, 3 * x * x - 2 * x};
    double const c[4] = {(12 * x - 6) / (l * l), (6 * x - 4) / l, (6 - 12 * x) / (l * l), (6 * x - 2) / l};
    for (int end = 0; end < 2; ++end) {
      int const u = 6 * end, v = u + 1, w = u + 2, tx = u + 3, ty = u + 4, tz = u + 5, i = 2 * end;
      double const linear = end == 0 ? 1 - x : x, slope = end == 0 ? -1 / l : 1 / l;
      axis(0, u) = linear;
      axis(1, v) = axis(2, w) = h[i];
      axis(1, tz) = h[i + 1];
      axis(2, ty) = -h[i + 1];
      rotation(0, tx) = linear;  // (θx, −w′, v′)
      rotation(1, w) = -d[i];
      rotation(1, ty) = d[i + 1];
      rotation(2, v) = d[i];
      rotation(2, tz) = d[i + 1];
      strain(0, u) = strain(1, tx) = slope;  // (u′, θx′, −w″, v″)
      strain(2, w) = -c[i];
      strain(2, ty) = c[i + 1];
      strain(3, v) = c[i];
      strain(3, tz) = c[i + 1];
    }
    by_y.row(0) = -rotation.row(2);  // θ × (0, y, z)
    by_y.row(2) = rotation.row(0);
    by_z.row(0) = rotation.row(1);
    by_z.row(1) = -rotation.row(0);
  }
};

// The following functions run once, when a body is made. They use plain loops, which compile fast.

/// Matrix with respect to the nodal coordinates of both ends of a beam, in the axes of the body.
using BeamMatrix = Mat<double, 12, 12>;

/// Transforms the columns of m from the axes of the element to those of the body: m diag(Cᵀ, Cᵀ, Cᵀ, Cᵀ).
template <int rows>
Mat<double, rows, 12> by_body_axes(Mat<double, rows, 12> const& m, Mat3 const& axes) {
  Mat<double, rows, 12> out;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < 12; ++j) {
      int const block = 3 * (j / 3);
      out(i, j) = m(i, block) * axes(j % 3, 0) + m(i, block + 1) * axes(j % 3, 1) + m(i, block + 2) * axes(j % 3, 2);
    }
  return out;
}
/// Transforms the rows and columns of m from the axes of the element to those of the body: C m diag(Cᵀ, Cᵀ, Cᵀ, Cᵀ).
template <class = void>
Mat<double, 3, 12> in_body_axes(Mat<double, 3, 12> const& m, Mat3 const& axes) {
  Mat<double, 3, 12> const t = by_body_axes<3>(m, axes);
  Mat<double, 3, 12> out;
  for (int j = 0; j < 12; ++j)
    for (int i = 0; i < 3; ++i) out(i, j) = axes(i, 0) * t(0, j) + axes(i, 1) * t(1, j) + axes(i, 2) * t(2, j);
  return out;
}
/// Adds the matrix `m` of one beam to the entries of the matrix of the structure.
template <class = void>
void add_entries(Structure::Beam const& beam, BeamMatrix const& m, std::vector<Eigen::Triplet<double>>& entries) {
  auto const dof = [&](int i) { return int(6 * (i < 6 ? beam.a : beam.b) + i % 6); };
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 12; ++j)
      if (m(i, j) != 0.0) entries.emplace_back(dof(i), dof(j), m(i, j));
}
/// Adds the nodal values x of one beam to those of the structure, `sum` (N).
template <class = void>
void add_entries(Structure::Beam const& beam, Vec<double, 12> const& x, VecX& sum) {
  for (int i = 0; i < 12; ++i) sum[6 * (i < 6 ? beam.a : beam.b) + i % 6] += x[i];
}

/// Gauss point of a beam in the axes of the body, with its contributions to ∫ρ, ∫ρy², ∫ρz².
struct MassPoint {
  Vec3 at;                        ///< position of the axis from the origin of the body axes [m]
  Mat<double, 3, 12> axis, y, z;  ///< (3×12) displacement of the axis and its derivatives with respect to y and z
  double m, my, mz;               ///< contributions to ∫ρ [kg], ∫ρy² and ∫ρz² [kg m²]
};
/// Four Gauss points of a beam, exact for products of cubics.
template <class = void>
std::array<MassPoint, 4> mass_points(Structure const& s, Structure::Beam const& beam) {
  std::array<MassPoint, 4> points;
  double const about_z = beam.constants.rotary_inertia, about_y = beam.constants.rotary_inertia_y.value_or(about_z);
  for (std::size_t i = 0; i < 4; ++i) {
    auto const& g = gauss<4>[i];
    BeamShapes const shapes(g.xi, beam.length);
    double const w = g.weight * beam.length;
    points[i] = {s.nodes[std::size_t(beam.a)] + beam.axes.col(0) * (g.xi * beam.length),
                 in_body_axes(shapes.axis, beam.axes),
                 in_body_axes(shapes.by_y, beam.axes),
                 in_body_axes(shapes.by_z, beam.axes),
                 w * beam.constants.mass_per_length,
                 w * about_z,
                 w * about_y};
  }
  return points;
}

namespace detail {
/// Adds sum += w aᵀ b for row `row_a` of a and row `row_b` of b.
template <class A, class B>
void add_product(double w, A const& a, int row_a, B const& b, int row_b, BeamMatrix& sum) {
  for (int j = 0; j < 12; ++j)
    for (int i = 0; i < 12; ++i) sum(i, j) += w * a(row_a, i) * b(row_b, j);
}
}  // namespace detail

/// Stiffness ∫ Bᵀ diag(c) B of a beam with the section stiffness c. Two Gauss points give the closed form of Eq. A.5
/// [Przemieniecki 1968, Eq. 5.116 without shear].
template <class = void>
BeamMatrix beam_stiffness(Structure::Beam const& beam, Vec4 const& c) {
  BeamMatrix k = BeamMatrix::Zero();
  for (auto const& g : gauss<2>) {
    Mat<double, 4, 12> const b = by_body_axes<4>(BeamShapes(g.xi, beam.length).strain, beam.axes);
    for (int i = 0; i < 4; ++i) detail::add_product(g.weight * beam.length * c[i], b, i, b, i, k);
  }
  return k;
}
/// Stiffness (EA, GJ, EI_y, EI_z) of a section: axial strain, torsion, and bending about y and z.
template <class = void>
Vec4 section_stiffness(BarConstants const& c) {
  return {c.EA, c.GJ, c.EI_y.value_or(c.EI), c.EI};
}

/// Geometric stiffness ∫ N (v′ᵀv′ + w′ᵀw′) dx of a beam with the axial force N(ξ) = n₀ + n₁ ξ + n₂ ξ² [N].
template <class = void>
BeamMatrix axial_force_stiffness(Structure::Beam const& beam, double n0, double n1 = 0.0, double n2 = 0.0) {
  BeamMatrix k = BeamMatrix::Zero();
  for (auto const& g : gauss<4>) {
    Mat<double, 3, 12> const slopes = by_body_axes<3>(BeamShapes(g.xi, beam.length).rotation, beam.axes);
    double const n = n0 + g.xi * (n1 + g.xi * n2);
    for (int i = 1; i < 3; ++i) detail::add_product(g.weight * beam.length * n, slopes, i, slopes, i, k);
  }
  return k;
}

}  // namespace polybody
