#pragma once
/// \file
/// Strain laws of a cable: axial strain in the plane or in space, and bending in space, for the cubic Hermite element
/// with coordinates (r, r′) at both ends.
/// Theory: Eqs. 2.17, 2.18, 2.24 to 2.28.

#include <polybody/bodies/shared/strain_group.hpp>
#include <polybody/math/element_functions.hpp>
#include <polybody/math/simd_vector.hpp>
#include <polybody/math/types.hpp>

namespace polybody {

// Axial strain measures of cables as functions of p = r′ in the plane (d = 2) or in space (d = 3). Each measure also
// defines the power k of |r′| in the corresponding bending measure |r′ × r″|/|r′|ᵏ.

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

/// Engineering strain ε = |r′| − 1 and material bending measure κ = |r′ × r″|/|r′|². In the geometrically exact beam,
/// axial force and bending moment are linear in ε and κ [Gerstmayr & Irschik 2008].
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

namespace detail {

/// Factors of the nodal vectors in p = (r′, r″) for an element of length l, without those of the first nodal vector.
template <class T>
Mat<T, 2, 3> cable_curvature_map(double xi, double l) {
  ShapeValues<4> const s = hermite_shape(xi, l);
  Mat<T, 2, 3> n;
  for (int j = 0; j < 3; ++j) {
    n(0, j) = s.ds[std::size_t(j + 1)];
    n(1, j) = s.dds[std::size_t(j + 1)];
  }
  return n;
}
/// Inverse power 1/nᵏ from 1/n², for k = 2 or 3.
template <int k, class T>
T inverse_power(T const& inverse2) {
  using std::sqrt;
  if constexpr (k == 2)
    return inverse2;
  else
    return inverse2 * sqrt(inverse2);
}

}  // namespace detail

/// Axial strain, with p = r′. Five Gauss points integrate ε² of the Green strain exactly.
template <class Strain, int axial_points, int dimension = 3>
struct CableAxial {
  static constexpr int points = axial_points;
  static constexpr int components = dimension;
  static constexpr int parameters = dimension;
  static constexpr int strains = 1;
  static constexpr int reach = 3;
  static constexpr int difference = 2;

  template <class T = double>  // compiled only if used
  static Vec<T, 1> stiffness(BarConstants const& c) {
    return Vec<T, 1>(double(c.EA));
  }
  template <class T = double>
  static Vec<T, 1> damping(Damping const& d) {
    return Vec<T, 1>(d.axial);
  }
  static constexpr int vector(int, int j) { return j + 1; }
  template <class T = double>
  static Mat<T, 1, 3> map(double xi, double l) {
    ShapeValues<4> const s = hermite_shape(xi, l);
    return {s.ds[1], s.ds[2], s.ds[3]};
  }
  template <KernelScalar T>
  static void evaluate(Vec<T, dimension> const& p, Vec<T, 1>& strain, Mat<T, 1, dimension>& b) {
    Strain::template axial<T, dimension>(p, strain, b);
  }
  template <KernelScalar T>
  static void add_hessian(Vec<T, dimension> const& p, Vec<T, 1> const& n, Mat<T, dimension, dimension>& h) {
    Strain::template add_axial_hessian<T, dimension>(p, n[0], h);
  }
};

/// Bending in space as the vector κ = s × u/|s|ᵏ, with s = r′, u = r″ and p = (s, u). The vector κ is smooth at κ = 0,
/// its length is not.
template <class Strain, int bending_points>
struct CableBending {
  static constexpr int points = bending_points;
  static constexpr int components = 3;
  static constexpr int parameters = 6;
  static constexpr int strains = 3;
  static constexpr int reach = 3;
  static constexpr int difference = 2;
  static constexpr int k = Strain::curvature_power;  ///< power of |r′| in κ

  static Vec3 stiffness(BarConstants const& c) { return {c.EI, c.EI, c.EI}; }
  static Vec3 damping(Damping const& d) { return {d.bending, d.bending, d.bending}; }
  static constexpr int vector(int, int j) { return j + 1; }
  template <class T = double>
  static Mat<T, 2, 3> map(double xi, double l) {
    return detail::cable_curvature_map<T>(xi, l);
  }

  /// Derivatives, with n = |s|: ∂κ/∂s = −ũ/nᵏ − k κ sᵀ/n², ∂κ/∂u = s̃/nᵏ.
  template <KernelScalar T>
  static void evaluate(Vec<T, 6> const& p, Vec<T, 3>& strain, Mat<T, 3, 6>& b) {
    T const inverse2 = T(1.0) / (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]), inverse = detail::inverse_power<k>(inverse2);
    for (int i = 0; i < 3; ++i) {
      int const j = (i + 1) % 3, l = (i + 2) % 3;
      strain[i] = (p[j] * p[3 + l] - p[l] * p[3 + j]) * inverse;
      T const pull = strain[i] * inverse2 * double(k);
      b(i, i) = -(pull * p[i]);
      b(i, j) = p[3 + l] * inverse - pull * p[j];
      b(i, l) = -(p[3 + j] * inverse) - pull * p[l];
      b(i, 3 + i) = T(0.0);
      b(i, 3 + j) = -(p[l] * inverse);
      b(i, 3 + l) = p[j] * inverse;
    }
  }

  /// Square κ·κ = ((s·s)(u·u) − (s·u)²)/n²ᵏ, with n = |s|.
  template <KernelScalar T>
  static T square(Vec<T, 6> const& p) {
    T const ss = p[0] * p[0] + p[1] * p[1] + p[2] * p[2], uu = p[3] * p[3] + p[4] * p[4] + p[5] * p[5];
    T const su = p[0] * p[3] + p[1] * p[4] + p[2] * p[5], inverse = detail::inverse_power<k>(T(1.0) / ss);
    return (ss * uu - su * su) * (inverse * inverse);
  }

  /// Second derivatives of w·κ = c/nᵏ, with n = |s|, c = w·(s × u), ∂c/∂s = a = u × w, ∂c/∂u = d = w × s and
  /// ∂²c/∂s∂u = −w̃:
  ///   ∂²/∂s² = (−k (a sᵀ + s aᵀ + c 1) + k (k + 2) c s sᵀ/n²)/nᵏ⁺²,  ∂²/∂s∂u = −w̃/nᵏ − k s dᵀ/nᵏ⁺².
  template <KernelScalar T>
  static void add_hessian(Vec<T, 6> const& p, Vec<T, 3> const& w, Mat<T, 6, 6>& h) {
    T const inverse2 = T(1.0) / (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]), inverse = detail::inverse_power<k>(inverse2);
    T const pull = inverse * inverse2 * double(k);
    T a[3], d[3];
    for (int i = 0; i < 3; ++i) {
      int const j = (i + 1) % 3, l = (i + 2) % 3;
      a[i] = p[3 + j] * w[l] - p[3 + l] * w[j];
      d[i] = w[j] * p[l] - w[l] * p[j];
    }
    T const c = a[0] * p[0] + a[1] * p[1] + a[2] * p[2], along = c * inverse2 * double(k + 2);
    for (int i = 0; i < 3; ++i) {
      int const j = (i + 1) % 3, l = (i + 2) % 3;
      for (int q = 0; q < 3; ++q) {
        h(i, q) += pull * (along * p[i] * p[q] - a[i] * p[q] - p[i] * a[q]);
        T const mixed = -(pull * p[i] * d[q]);
        h(i, 3 + q) += mixed;
        h(3 + q, i) += mixed;
      }
      h(i, i) -= pull * c;
      T const turn = w[l] * inverse, back = w[j] * inverse;  // −w̃ has w_l at (i, j) and −w_j at (i, l)
      h(i, 3 + j) += turn;
      h(3 + j, i) += turn;
      h(i, 3 + l) -= back;
      h(3 + l, i) -= back;
    }
  }

  /// Objective part p of the rate κ̇. The rate is the sum of a rotation of κ and a change of its length. The rotation
  /// of a cable about its own axis is undetermined, so that only the change of length is damped:
  ///   p = w κ̇ + G κ (κ·κ̇),  w = (1 + x)⁻⁴,  G = (1 − w)/κ²,  x = κ²/κ₀².
  /// Below κ₀ = 1e-3 1/m the direction of κ is not significant, and all of κ̇ is damped. G is a polynomial in x divided
  /// by (1 + x)⁴.
  template <KernelScalar T>
  static void objective_rate(Vec<T, 3> const& strain, Vec<T, 3>& rate) {
    Blend<T> const f(strain);
    T const along = detail::dot(strain, rate);
    for (int i = 0; i < 3; ++i) rate[i] = rate[i] * f.w + strain[i] * (f.g * along);
  }
  /// Derivatives ∂p/∂κ̇ = w 1 + G κ κᵀ;  ∂p/∂κ = κ̇ w′ᵀ + G ((κ·κ̇) 1 + κ κ̇ᵀ) + κ (κ·κ̇) G′ᵀ.
  template <KernelScalar T>
  static void objective_rate_gradients(Vec<T, 3> const& strain, Vec<T, 3> const& rate, Mat<T, 3, 3>& by_rate,
                                       Mat<T, 3, 3>& by_strain) {
    Blend<T> const f(strain);
    T const along = detail::dot(strain, rate);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        by_rate(i, j) = f.g * strain[i] * strain[j];
        by_strain(i, j) = (rate[i] * f.dw + strain[i] * along * f.dg) * strain[j] + f.g * strain[i] * rate[j];
      }
    for (int i = 0; i < 3; ++i) {
      by_rate(i, i) += f.w;
      by_strain(i, i) += f.g * along;
    }
  }

 private:
  /// Weights w and G; dw κ and dg κ are their gradients with respect to κ.
  template <class T>
  struct Blend {
    T w, g, dw, dg;
    explicit Blend(Vec<T, 3> const& strain) {
      constexpr double each = 1e6;  // 1/κ₀²
      T const x = detail::dot(strain, strain) * each, over = T(1.0) / (x + 1.0);
      T const over2 = over * over, n = x * (x * (x + 4.0) + 6.0) + 4.0;
      w = over2 * over2;
      g = n * w * each;
      dw = w * over * (-8.0 * each);
      dg = ((x * (x * 3.0 + 8.0) + 6.0) - n * over * 4.0) * w * (2.0 * each * each);
    }
  };
};

}  // namespace polybody
