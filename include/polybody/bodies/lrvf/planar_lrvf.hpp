#pragma once
/// \file
/// Large rotation vector formulation in the plane, a planar geometrically exact beam.
/// Theory: Eqs. 2.49 to 2.53.

#include <polybody/bodies/lrvf/strain_quadrature.hpp>
#include <polybody/bodies/shared/planar_beam.hpp>
#include <polybody/math/element_functions.hpp>

namespace polybody::planar {

/// Theory of the planar `Lrvf` [Simo & Vu-Quoc 1986; thesis Eq. 2.7–2.10]. Position and rotation fields are
/// interpolated linearly and independently, with node coordinates (x, y, θ). The strains are evaluated at one point
/// (strain_quadrature.hpp has other quadratures):
///   ε = t₁ᵀ r′ − 1,  γ = t₂ᵀ r′,  κ = θ′,  t₁ = (cos θ, sin θ), t₂ = (−sin θ, cos θ).
struct SimoVuQuoc {
  static constexpr char const* name = "planar::Lrvf";  ///< name of the body type in messages
  static constexpr int node_columns = 3;               ///< (x, y, θ)
  static constexpr bool vectorised_kernels = true;
  static constexpr std::array<int, 3> section_rows = {0, 1, 5};  ///< rows of ε, γ and κ
  static constexpr int gradients = 0;  ///< number of position gradients that are linear in the coordinates

  /// Checks the constants of the bar.
  /// \throws InvalidInput unless GA is positive.
  static void check(BarConstants const& c) {
    require_positive(c.GA, "planar::Lrvf: the shear stiffness GA of the bar");
  }
  /// Node at distance s [m] along a straight axis from `origin` [m], rotated from world x by `angle` [rad].
  static Vec3 reference_node(Vec2 const& origin, double angle, double s) {
    return {origin[0] + s * std::cos(angle), origin[1] + s * std::sin(angle), angle};
  }
  /// Generalised velocities of the node in a rigid motion: velocity v0 of the body-fixed point at the origin of the
  /// world [m/s], angular velocity omega [rad/s].
  static Vec3 rigid_velocity(Vec3 const& node, Vec2 const& v0, double omega) {
    return {v0[0] - omega * node[1], v0[1] + omega * node[0], omega};
  }
  /// Matrix S (2×6) of r = S e at ξ.
  template <class T = double>  // compiled only if used
  static Mat<T, 2, 6> position(double xi, double) {
    Mat<T, 2, 6> n = Mat<T, 2, 6>::Zero();
    for (int i = 0; i < 2; ++i) {
      n(i, i) = T(1.0 - xi);
      n(i, 3 + i) = T(xi);
    }
    return n;
  }
  /// Row of θ̇ = row · ė in the kinetic energy ½ ∫ Iρ θ̇² dx.
  template <class T = double>  // compiled only if used
  static Vec<T, 6> rotary(double xi, double) {
    Vec<T, 6> row = Vec<T, 6>::Zero();
    row[2] = T(1.0 - xi);
    row[5] = T(xi);
    return row;
  }

  /// Angle θ(ξ) at the coordinates e (6). The field is linear, so that θ̈ is zero for ë = 0.
  template <StateScalar T>
  static SectionAngle<T, 6> rotation(double xi, double l, Vec<T, 6> const& e, Vec<T, 6> const&) {
    Vec<T, 6> const row = rotary<T>(xi, l);
    return {row.dot(e), row, T(0.0)};
  }

  /// Hessian h = ∂²θ/∂e², which is zero.
  template <class T>  // compiled only if used
  static void rotation_hessian(double, double, Vec<T, 6> const&, Mat<T, 6, 6>& h) {
    h.setZero();
  }

  /// Axial, shear and bending strain at the only Gauss point, with p = (x′, y′, θ, θ′).
  struct Section {
    static constexpr int points = 1;
    static constexpr int components = 1;
    static constexpr int parameters = 4;
    static constexpr int strains = 3;

    static Vec3 stiffness(BarConstants const& c) { return {c.EA, c.GA, c.EI}; }
    static Vec3 damping(Damping const& d) { return {d.axial, d.shear, d.bending}; }

    static constexpr int reach = 2;
    /// Index of the coordinate of node j that shape k reads.
    static constexpr int vector(int k, int j) { return 3 * j + (k < 2 ? k : 2); }
    template <class T = double>  // compiled only if used
    static Mat<T, 4, 2> map(double xi, double l) {
      ShapeValues<2> const n = linear_shape(xi, l);
      Mat<T, 4, 2> p;
      for (int j = 0; j < 2; ++j) {
        p(0, j) = p(1, j) = p(3, j) = n.ds[std::size_t(j)];
        p(2, j) = n.s[std::size_t(j)];
      }
      return p;
    }
    template <KernelScalar T>
    static void evaluate(Vec<T, 4> const& p, Vec<T, 3>& strain, Mat<T, 3, 4>& b) {
      using std::cos, std::sin;
      T const c = cos(p[2]), s = sin(p[2]);
      T const stretch = c * p[0] + s * p[1], slide = c * p[1] - s * p[0];
      strain[0] = stretch - 1.0;
      strain[1] = slide;
      strain[2] = p[3];
      b << c, s, slide, T(0), -s, c, -stretch, T(0), T(0), T(0), T(0), T(1);
    }
    template <KernelScalar T>
    static void add_hessian(Vec<T, 4> const& p, Vec<T, 3> const& n, Mat<T, 4, 4>& h) {
      using std::cos, std::sin;
      T const c = cos(p[2]), s = sin(p[2]);
      T const x = -(s * n[0]) - c * n[1], y = c * n[0] - s * n[1];  // ∂²/∂x′∂θ and ∂²/∂y′∂θ
      h(0, 2) += x;
      h(2, 0) += x;
      h(1, 2) += y;
      h(2, 1) += y;
      h(2, 2) -= (c * p[0] + s * p[1]) * n[0] + (c * p[1] - s * p[0]) * n[1];
    }
  };
  using Groups = std::tuple<Section>;  ///< strain laws of the beam
};

/// Law for `count` successive strains of (ε, γ, κ), beginning at index `first`. The points are those of Q at which the
/// weight of these strains is not zero.
template <StrainQuadrature Q, int first, int count>
struct SectionIn {
  using All = SimoVuQuoc::Section;  ///< law of the three strains
  static constexpr int components = All::components, parameters = All::parameters, reach = All::reach;  ///< as in All
  static constexpr int strains = count;
  static constexpr auto rule = detail::rule_of<Q, detail::strain_weights[std::size_t(first)]>();
  static constexpr int points = int(rule.size());

  /// Index of the coordinate of node j that shape k reads.
  static constexpr int vector(int k, int j) { return All::vector(k, j); }
  template <class T = double>  // compiled only if used
  static Mat<T, 4, 2> map(double xi, double l) {
    return All::map<T>(xi, l);
  }
  static Vec<double, count> stiffness(BarConstants const& c) { return All::stiffness(c).segment<count>(first); }
  static Vec<double, count> damping(Damping const& d) { return All::damping(d).segment<count>(first); }
  template <KernelScalar T>
  static void evaluate(Vec<T, 4> const& p, Vec<T, count>& strain, Mat<T, count, 4>& b) {
    Vec<T, 3> all;
    Mat<T, 3, 4> slope;
    All::evaluate<T>(p, all, slope);
    for (int i = 0; i < count; ++i) {
      strain[i] = all[first + i];
      for (int k = 0; k < 4; ++k) b(i, k) = slope(first + i, k);
    }
  }
  template <KernelScalar T>
  static void add_hessian(Vec<T, 4> const& p, Vec<T, count> const& n, Mat<T, 4, 4>& h) {
    Vec<T, 3> all;
    for (int i = 0; i < 3; ++i) all[i] = T(0.0);
    for (int i = 0; i < count; ++i) all[first + i] = n[i];
    All::add_hessian<T>(p, all, h);
  }
};

/// Theory of `LrvfBy`. Strains with the same points belong to one strain law.
template <StrainQuadrature Q>
struct SimoVuQuocBy : SimoVuQuoc {
  static constexpr bool together =
      detail::alike<Q>(&StrainPoint::axial, &StrainPoint::shear);  ///< ε and γ have the same points
  static constexpr bool all =
      together && detail::alike<Q>(&StrainPoint::shear, &StrainPoint::curvature);  ///< ε, γ and κ have the same points
  using Three = std::tuple<SectionIn<Q, 0, 1>, SectionIn<Q, 1, 1>, SectionIn<Q, 2, 1>>;  ///< one law for each strain
  using Two = std::tuple<SectionIn<Q, 0, 2>, SectionIn<Q, 2, 1>>;  ///< one law for ε and γ, another one for κ
  using Groups = std::conditional_t<all, std::tuple<SectionIn<Q, 0, 3>>,
                                    std::conditional_t<together, Two, Three>>;  ///< as few laws as Q permits
};
template <>
struct SimoVuQuocBy<ReducedQuadrature> : SimoVuQuoc {};

/// Planar geometrically exact beam with linear elements and the quadrature Q of the strains: `LrvfBy<Q>::from(bar, n)`.
template <StrainQuadrature Q>
using LrvfBy = Beam<SimoVuQuocBy<Q>>;

/// Planar beam with all strains evaluated in the middle, which does not lock.
using Lrvf = LrvfBy<ReducedQuadrature>;

/// Planar beam with all strains evaluated at both Gauss points, for comparison. This beam locks: its bending stiffness
/// is too large by the factor 1 + GA l²/(12 EI) [Hughes, Taylor & Kanoknukulchai 1977].
using FullLrvf = LrvfBy<FullQuadrature>;

/// Planar beam with ε and γ evaluated in the middle, and κ at both Gauss points. θ is linear and κ is constant in an
/// element. The results therefore equal those of `Lrvf` to round-off, at a higher cost. Selective and reduced
/// quadrature of the literature coincide for this beam.
using SelectiveLrvf = LrvfBy<SelectiveQuadrature>;

}  // namespace polybody::planar
