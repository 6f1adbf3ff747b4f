#pragma once
/// \file
/// Axial strain measures of cables as functions of p = r′ in the plane (d = 2) or in space (d = 3). Each measure also
/// defines the power k of |r′| in the corresponding bending measure |r′ × r″|/|r′|ᵏ.

#include <polybody/math/simd_vector.hpp>
#include <polybody/math/types.hpp>

namespace polybody {

namespace detail {
template <class T, int d>
T dot(Vec<T, d> const& a, Vec<T, d> const& b) {
  T sum = a[0] * b[0];
  for (int i = 1; i < d; ++i) sum += a[i] * b[i];
  return sum;
}
}  // namespace detail

/// Green strain ε = ½ (r′·r′ − 1) and the exact geometric curvature κ = |r′ × r″|/|r′|³, as in the thesis.
struct GreenStrain {
  static constexpr int curvature_power = 3;  ///< power k of |r′| in the bending measure

  /// Strain ε and its derivative b = ∂ε/∂p at p = r′.
  template <KernelScalar T, int d>
  static void axial(Vec<T, d> const& p, Vec<T, 1>& strain, Mat<T, 1, d>& b) {
    strain[0] = detail::dot(p, p) * 0.5 - 0.5;
    for (int i = 0; i < d; ++i) b(0, i) = p[i];
  }
  /// Adds the second derivative, h += n ∂²ε/∂p².
  template <KernelScalar T, int d>
  static void add_axial_hessian(Vec<T, d> const&, T const& n, Mat<T, d, d>& h) {
    for (int i = 0; i < d; ++i) h(i, i) += n;
  }
};

/// Engineering strain ε = |r′| − 1 and material bending measure κ = |r′ × r″|/|r′|². Both are linear in the stress
/// resultants of the exact rod [Gerstmayr & Irschik 2008].
struct EngineeringStrain {
  static constexpr int curvature_power = 2;  ///< power k of |r′| in the bending measure

  /// Strain ε and its derivative b = ∂ε/∂p at p = r′.
  template <KernelScalar T, int d>
  static void axial(Vec<T, d> const& p, Vec<T, 1>& strain, Mat<T, 1, d>& b) {
    using std::sqrt;
    T const n = sqrt(detail::dot(p, p));
    strain[0] = n - 1.0;
    for (int i = 0; i < d; ++i) b(0, i) = p[i] / n;
  }
  /// Adds the second derivative, h += n (1 − p pᵀ/|p|²)/|p|, which acts normal to p.
  template <KernelScalar T, int d>
  static void add_axial_hessian(Vec<T, d> const& p, T const& n, Mat<T, d, d>& h) {
    using std::sqrt;
    T const l2 = detail::dot(p, p), each = n / (l2 * sqrt(l2));
    for (int i = 0; i < d; ++i) {
      h(i, i) += each * l2;
      for (int j = 0; j < d; ++j) h(i, j) -= each * p[i] * p[j];
    }
  }
};

}  // namespace polybody
