#pragma once
/// \file
/// Shape functions of the space beam element of a structure, in the axes of the element and of the body.
/// Theory: Eqs. 2.96, 2.129, 2.130.

#include <Eigen/Cholesky>

#include <polybody/bodies/ffr/structure.hpp>
#include <polybody/bodies/shared/bar_sections.hpp>
#include <polybody/math/element_functions.hpp>

namespace polybody {

/// Shape functions of thesis Eq. A.1 in the axes of the element, with nodal coordinates (u, v, w, θx, θy, θz) at both
/// ends. The displacement at (ξ l, y, z) is (axis + y · by_y + z · by_z) e, and the rotation of the section is
/// `rotation` e.
///
/// For a section by matrices, the shapes are the static deformation of the element under loads at its ends. The section
/// forces σ are f at the second end, moved to x, the strains ε are S σ with the compliance S, and the screws q = (u, θ)
/// integrate ε:
///   σ = T(l − x) f,  q(x) = T(x)ᵀ q₁ + G(x) f,  G(x) = ∫₀ˣ T(x − t)ᵀ S T(l − t) dt,  f = G(l)⁻¹ (q₂ − T(l)ᵀ q₁),
/// with T(a) = [1, 0; a ẽ₁, 1].
struct BeamShapes {
  Mat<double, 3, 12> axis = Mat<double, 3, 12>::Zero();  ///< displacement of the axis
  Mat<double, 3, 12> by_x = Mat<double, 3, 12>::Zero();  ///< θ × e₁, for the inertia of sections
  Mat<double, 3, 12> by_y = Mat<double, 3, 12>::Zero(), by_z = Mat<double, 3, 12>::Zero();  ///< ∂/∂y, ∂/∂z of (u, v, w)
  Mat<double, 3, 12> rotation = Mat<double, 3, 12>::Zero();  ///< (θx, θy, θz); (θx, −w′, v′) without shear
  Mat<double, 6, 12> strain = Mat<double, 6, 12>::Zero();    ///< rows: strain, two shears [1], twist, curvatures [1/m]

  /// Shape functions at ξ of a beam.
  template <class = void>  // compiled only if used
  BeamShapes(double xi, Structure::Beam const& beam) {
    if (beam.section)
      set_static(xi, beam.length, *beam.section);
    else
      set_cubic(xi, beam.length);
    for (int j = 0; j < 12; ++j) {
      Vec3 const theta = rotation.col(j);
      by_x.col(j) = Vec3(0.0, theta[2], -theta[1]);  // θ × e₁, θ × e₂, θ × e₃
      by_y.col(j) = Vec3(-theta[2], 0.0, theta[0]);
      by_z.col(j) = Vec3(theta[1], -theta[0], 0.0);
    }
  }

  /// Slopes (0, −w′, v′) of the axis: the rotation of the sections plus the shear.
  template <class = void>  // compiled only if used
  Mat<double, 3, 12> slopes() const {
    Mat<double, 3, 12> out = rotation;
    for (int j = 0; j < 12; ++j) {
      out(0, j) = 0.0;
      out(1, j) -= strain(2, j);
      out(2, j) += strain(1, j);
    }
    return out;
  }

 private:
  template <class = void>  // compiled only if used
  void set_cubic(double xi, double l) {
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
      strain(0, u) = strain(3, tx) = slope;  // (u′, 0, 0, θx′, −w″, v″)
      strain(4, w) = -c[i];
      strain(4, ty) = c[i + 1];
      strain(5, v) = c[i];
      strain(5, tz) = c[i + 1];
    }
  }

  using Matrix = Mat<double, 6, 6>;
  /// T(a) = [1, 0; a ẽ₁, 1].
  template <class T = Matrix>  // compiled only if used
  static T carried(double a) {
    T t = T::Identity();
    t(4, 2) = -a;
    t(5, 1) = a;
    return t;
  }
  template <class T = Matrix>  // compiled only if used
  void set_static(double xi, double l, detail::CentredSection const& section) {
    T const s = detail::about_axis(section.stiffness, section).llt().solve(T::Identity());
    auto const g = [&](double x) {
      T sum = T::Zero();
      for (auto const& p : gauss<2>) {
        T const to = carried<T>(x - p.xi * x), from = carried<T>(l - p.xi * x);
        T strains;
        for (int j = 0; j < 6; ++j)
          for (int i = 0; i < 6; ++i) strains(i, j) = s.row(i).dot(from.col(j));
        for (int j = 0; j < 6; ++j)
          for (int i = 0; i < 6; ++i) sum(i, j) += p.weight * x * to.col(i).dot(strains.col(j));
      }
      return sum;
    };
    double const x = xi * l;
    Mat<double, 6, 12> ends, screws = Mat<double, 6, 12>::Zero();  // q₂ − T(l)ᵀ q₁
    ends << -carried<T>(l).transpose(), T::Identity();
    Mat<double, 6, 12> const f = g(l).llt().solve(ends);
    screws.template leftCols<6>() = carried<T>(x).transpose();
    screws += g(x) * f;
    axis = screws.template topRows<3>();
    rotation = screws.template bottomRows<3>();
    strain = s * carried<T>(l - x) * f;
  }
};

// The following functions run once, when a body is made. They use plain loops, which compile fast.

/// Matrix with respect to the nodal coordinates of both ends of a beam, in the axes of the body.
using BeamMatrix = Mat<double, 12, 12>;

/// Transforms the columns of m from the axes of the element to those of the body: m diag(Cᵀ, Cᵀ, Cᵀ, Cᵀ), C = `axes`.
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
/// Transforms the rows and columns of m from the axes of the element to those of the body: C m diag(Cᵀ, Cᵀ, Cᵀ, Cᵀ),
/// C = `axes`.
template <class = void>
Mat<double, 3, 12> in_body_axes(Mat<double, 3, 12> const& m, Mat3 const& axes) {
  Mat<double, 3, 12> const t = by_body_axes<3>(m, axes);
  Mat<double, 3, 12> out;
  for (int j = 0; j < 12; ++j)
    for (int i = 0; i < 3; ++i) out(i, j) = axes(i, 0) * t(0, j) + axes(i, 1) * t(1, j) + axes(i, 2) * t(2, j);
  return out;
}

}  // namespace polybody
