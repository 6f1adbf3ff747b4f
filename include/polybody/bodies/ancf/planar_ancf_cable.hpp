#pragma once
/// \file
/// Gradient-deficient ANCF cable in the plane.
/// Theory: Eqs. 2.12 to 2.18, 2.32.

#include <polybody/bodies/ancf/cable_laws.hpp>
#include <polybody/bodies/shared/planar_beam.hpp>
#include <polybody/math/element_functions.hpp>

namespace polybody::planar {

using polybody::EngineeringStrain, polybody::GreenStrain;

/// Theory of the planar `AncfCable` [Berzeri & Shabana 2000; Gerstmayr & Irschik 2008; thesis Eq. 3.16–3.20]. The
/// position field is a cubic Hermite polynomial with the coordinates (x, y, x′, y′) at each node. The mass matrix is
/// constant. The cable has neither rotation coordinates nor rotary inertia. The template arguments are the strain
/// measure and the numbers of Gauss points for axial strain and bending.
template <class Strain, int axial_points = 5, int bending_points = 3>
struct HermiteCable {
  static constexpr char const* name = "planar::AncfCable";  ///< name of the body type in messages
  static constexpr int node_columns = 4;                    ///< (x, y, x′, y′)
  static constexpr bool vectorised_kernels = true;
  static constexpr std::array<int, 2> section_rows = {0, 5};  ///< rows of axial strain and curvature
  static constexpr int gradients = 1;  ///< number of position gradients that are linear in the coordinates

  static void check(BarConstants const&) {}  ///< accepts every bar
  /// Node at distance s [m] along a straight axis from `origin` [m], rotated from world x by `angle` [rad].
  static Vec4 reference_node(Vec2 const& origin, double angle, double s) {
    double const c = std::cos(angle), d = std::sin(angle);
    return {origin[0] + s * c, origin[1] + s * d, c, d};
  }
  /// Generalised velocities of the node in a rigid motion: velocity v0 of the body-fixed point at the origin of the
  /// world [m/s], angular velocity omega [rad/s].
  static Vec4 rigid_velocity(Vec4 const& node, Vec2 const& v0, double omega) {
    return {v0[0] - omega * node[1], v0[1] + omega * node[0], -omega * node[3], omega * node[2]};
  }
  /// Matrix (2×8) of Σ s_i e_i with the factors `s` of the four nodal vectors e_i.
  template <class T = double>  // compiled only if used
  static Mat<T, 2, 8> spread(std::array<double, 4> const& s) {
    Mat<T, 2, 8> n = Mat<T, 2, 8>::Zero();
    for (int i = 0; i < 4; ++i) n(0, 2 * i) = n(1, 2 * i + 1) = T(s[std::size_t(i)]);
    return n;
  }
  /// Matrix S (2×8) of r = S e at ξ of an element of length l [m].
  template <class T = double>
  static Mat<T, 2, 8> position(double xi, double l) {
    return spread<T>(hermite_shape(xi, l).s);
  }
  /// Matrix S′ (2×8) of r′ = S′ e at ξ of an element of length l [m].
  template <class T = double>
  static Mat<T, 2, 8> gradient(double xi, double l) {
    return spread<T>(hermite_shape(xi, l).ds);
  }
  /// Shape functions of r at ξ, and their derivatives with respect to arc length.
  static ShapeValues<4> axis_shape(double xi, double l) { return hermite_shape(xi, l); }
  /// Row of θ̇ for the rotary inertia; zero, because a cable has no rotary inertia.
  template <class T = double>
  static Vec<T, 8> rotary(double, double) {
    return Vec<T, 8>::Zero();
  }

  /// Angle θ of r′ for the coordinates e (8) and their rates `ed`, and θ̇ = r′ × ṙ′/|r′|². For r̈′ = 0, θ̈ is −2
  /// (r′·ṙ′) θ̇/|r′|².
  template <StateScalar T>
  static SectionAngle<T, 8> rotation(double xi, double l, Vec<T, 8> const& e, Vec<T, 8> const& ed) {
    using std::atan2;
    Mat<double, 2, 8> const d = gradient(xi, l);
    Vec<T, 2> const slope = detail::times(d, e), rate = detail::times(d, ed);
    T const n2 = slope[0] * slope[0] + slope[1] * slope[1], along = slope[0] * rate[0] + slope[1] * rate[1];
    SectionAngle<T, 8> out;
    out.angle = atan2(slope[1], slope[0]);
    for (int i = 0; i < 8; ++i) out.row[i] = (slope[0] * d(1, i) - slope[1] * d(0, i)) / n2;
    out.bias = out.row.dot(ed) * along * (-2.0) / n2;
    return out;
  }

  /// Hessian h = ∂²θ/∂e² = S′ᵀ [2xy, y² − x²; y² − x², −2xy]/|r′|⁴ S′ with r′ = (x, y).
  template <class T>
  static void rotation_hessian(double xi, double l, Vec<T, 8> const& e, Mat<T, 8, 8>& h) {
    Mat<double, 2, 8> const d = gradient(xi, l);
    Vec<T, 2> const slope = detail::times(d, e);
    T const x = slope[0], y = slope[1], n4 = (x * x + y * y) * (x * x + y * y);
    T const across = 2.0 * x * y / n4, along = (y * y - x * x) / n4;
    for (int i = 0; i < 8; ++i) {
      T const a = d(0, i) * across + d(1, i) * along, b = d(0, i) * along - d(1, i) * across;
      for (int j = 0; j < 8; ++j) h(i, j) = a * d(0, j) + b * d(1, j);
    }
  }

  using Axial = CableAxial<Strain, axial_points, 2>;  ///< the law of axial strain

  /// Bending with p = (r′, r″) and κ = c/nᵏ, where c = r′ × r″ and n = |r′|. Three Gauss points are suitable for the
  /// cubic field [Gerstmayr & Irschik 2008].
  struct Bending {
    static constexpr int points = bending_points;
    static constexpr int components = 2;
    static constexpr int parameters = 4;
    static constexpr int strains = 1;
    static constexpr int reach = 3;
    static constexpr int difference = 2;
    static constexpr int k = Strain::curvature_power;  ///< power of |r′| in κ

    template <class T = double>
    static Vec<T, 1> stiffness(BarConstants const& c) {
      return Vec<T, 1>(double(c.EI));
    }
    template <class T = double>
    static Vec<T, 1> damping(Damping const& d) {
      return Vec<T, 1>(d.bending);
    }
    static constexpr int vector(int, int j) { return j + 1; }
    template <class T = double>
    static Mat<T, 2, 3> map(double xi, double l) {
      return polybody::detail::cable_curvature_map<T>(xi, l);
    }

    template <KernelScalar T>
    static void evaluate(Vec<T, 4> const& p, Vec<T, 1>& strain, Mat<T, 1, 4>& b) {
      T const inverse2 = one_over(p), inverse = polybody::detail::inverse_power<k>(inverse2);
      T const kappa = (p[0] * p[3] - p[1] * p[2]) * inverse, pull = kappa * inverse2 * double(k);
      strain[0] = kappa;
      b(0, 0) = p[3] * inverse - pull * p[0];
      b(0, 1) = -p[2] * inverse - pull * p[1];
      b(0, 2) = -p[1] * inverse;
      b(0, 3) = p[0] * inverse;
    }
    /// Second derivatives with s = r′, u = ∂c/∂s, w = ∂c/∂r″, and J = ∂²c/∂s∂r″ (a rotation by a right angle):
    ///   ∂²κ/∂s² = (−k (u sᵀ + s uᵀ + c 1) + k (k + 2) c s sᵀ/n²)/nᵏ⁺²,  ∂²κ/∂s∂r″ = J/nᵏ − k s wᵀ/nᵏ⁺².
    template <KernelScalar T>
    static void add_hessian(Vec<T, 4> const& p, Vec<T, 1> const& n, Mat<T, 4, 4>& h) {
      T const inverse2 = one_over(p), each = polybody::detail::inverse_power<k>(inverse2) * n[0],
              a = each * inverse2 * double(k);
      T const c = p[0] * p[3] - p[1] * p[2], along = c * inverse2 * double(k + 2), x = a * p[0], y = a * p[1];
      h(0, 0) += x * (along * p[0] - p[3] * 2.0) - a * c;
      h(1, 1) += y * (along * p[1] + p[2] * 2.0) - a * c;
      T const across = x * (along * p[1] + p[2]) - y * p[3];
      h(0, 1) += across;
      h(1, 0) += across;
      T const of_second[2][2] = {{x * p[1], each - x * p[0]}, {y * p[1] - each, -(y * p[0])}};
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) {
          h(i, 2 + j) += of_second[i][j];
          h(2 + j, i) += of_second[i][j];
        }
    }

   private:
    template <class T>
    static T one_over(Vec<T, 4> const& p) {  // 1/n²
      return T(1.0) / (p[0] * p[0] + p[1] * p[1]);
    }
  };
  using Groups = std::tuple<Axial, Bending>;  ///< the strain laws of the cable
};

/// Gradient-deficient ANCF cable in the plane, with the theory `HermiteCable`: `AncfCable<>::from(bar, n)`,
/// `AncfCable<EngineeringStrain>::from(bar, n)`.
template <class Strain = GreenStrain, int axial_points = 5, int bending_points = 3>
using AncfCable = Beam<HermiteCable<Strain, axial_points, bending_points>>;

}  // namespace polybody::planar
