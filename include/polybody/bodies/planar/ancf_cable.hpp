#pragma once
/// \file
/// Gradient-deficient ANCF cable in the plane: cubic Hermite position field, node coordinates (x, y, x′, y′),
/// constant mass matrix, no rotation coordinate and no rotary inertia
/// [Berzeri & Shabana 2000; Gerstmayr & Irschik 2008; thesis Eq. 3.16–3.20].

#include <polybody/bodies/planar/beam.hpp>
#include <polybody/math/shape_functions.hpp>

namespace polybody::planar {

/// Green strain ε = ½ (r′·r′ − 1) and the exact geometric curvature κ = r′ × r″/|r′|³ (the thesis' choice).
struct GreenStrain {
  static constexpr int curvature_power = 3;

  template <StateScalar T>
  static void axial(Vec<T, 2> const& p, T& strain, Mat<T, 1, 2>& b) {
    strain = 0.5 * (p.squaredNorm() - T(1.0));
    b = p.transpose();
  }
  static Mat<double, 2, 2> axial_hessian(Vec2 const&) { return Mat<double, 2, 2>::Identity(); }
};

/// Engineering strain ε = |r′| − 1 and material bending measure κ = r′ × r″/|r′|² = θ′: linear in the
/// resultants of the exact rod [Gerstmayr & Irschik 2008].
struct EngineeringStrain {
  static constexpr int curvature_power = 2;

  template <StateScalar T>
  static void axial(Vec<T, 2> const& p, T& strain, Mat<T, 1, 2>& b) {
    using std::sqrt;
    T const n = sqrt(p.squaredNorm());
    strain = n - T(1.0);
    b = p.transpose() / n;
  }
  static Mat<double, 2, 2> axial_hessian(Vec2 const& p) {
    double const n = p.norm();
    return (Mat<double, 2, 2>::Identity() - p * p.transpose() / (n * n)) / n;
  }
};

/// The Theory of `AncfCable`.
template <class Strain>
struct HermiteCable {
  static constexpr char const* name = "planar::AncfCable";
  static constexpr int node_columns = 4;

  static void check(BarConstants const&) {}
  static Vec4 reference_node(Vec2 const& origin, double angle, double s) {
    double const c = std::cos(angle), d = std::sin(angle);
    return {origin[0] + s * c, origin[1] + s * d, c, d};
  }
  static Vec4 rigid_velocity(Vec4 const& node, Vec2 const& v0, double omega) {
    return {v0[0] - omega * node[1], v0[1] + omega * node[0], -omega * node[3], omega * node[2]};
  }
  static Mat<double, 2, 8> spread(std::array<double, 4> const& s) {
    Mat<double, 2, 8> n = Mat<double, 2, 8>::Zero();
    for (int i = 0; i < 4; ++i) n(0, 2 * i) = n(1, 2 * i + 1) = s[i];
    return n;
  }
  static Mat<double, 2, 8> position(double xi, double l) { return spread(hermite_shape(xi, l).s); }
  /// A cable has no rotary inertia.
  static Vec<double, 8> rotary(double, double) { return Vec<double, 8>::Zero(); }

  /// Angle of r′; θ̇ = r′ × ṙ′/|r′|², whose derivative without r̈′ is −2 (r′·ṙ′) θ̇/|r′|².
  template <StateScalar T>
  static void rotation(double xi, double l, Vec<T, 8> const& e, Vec<T, 8> const& ed, T& angle,
                       Vec<T, 8>& row, T& bias) {
    using std::atan2;
    Mat<double, 2, 8> const d = spread(hermite_shape(xi, l).ds);
    Vec<T, 2> const slope = d.template cast<T>() * e, rate = d.template cast<T>() * ed;
    T const n2 = slope.squaredNorm();
    angle = atan2(slope[1], slope[0]);
    row = (d.row(1).transpose().template cast<T>() * slope[0] -
           d.row(0).transpose().template cast<T>() * slope[1]) / n2;
    bias = row.dot(ed) * slope.dot(rate) * (-2.0) / n2;
  }

  /// ∂²θ/∂e² = S′ᵀ [2xy, y² − x²; y² − x², −2xy]/|r′|⁴ S′ with r′ = (x, y).
  static void rotation_hessian(double xi, double l, Vec<double, 8> const& e, Mat<double, 8, 8>& h) {
    Mat<double, 2, 8> const d = spread(hermite_shape(xi, l).ds);
    Vec2 const slope = d * e;
    double const x = slope[0], y = slope[1], n4 = std::pow(slope.squaredNorm(), 2);
    Mat<double, 2, 2> of_slope;
    of_slope << 2.0 * x * y, y * y - x * x, y * y - x * x, -2.0 * x * y;
    h = d.transpose() * (of_slope / n4) * d;
  }

  /// Axial strain at five Gauss points; p = r′.
  struct Axial {
    static constexpr int points = 5;
    static constexpr int parameters = 2;
    static constexpr int strains = 1;

    static Vec<double, 1> stiffness(BarConstants const& c) { return Vec<double, 1>(double(c.EA)); }
    static Vec<double, 1> damping(Damping const& d) { return Vec<double, 1>(d.axial); }
    static Mat<double, 2, 8> map(double xi, double l) { return spread(hermite_shape(xi, l).ds); }

    template <StateScalar T>
    static void evaluate(Vec<T, 2> const& p, Vec<T, 1>& strain, Mat<T, 1, 2>& b) {
      Strain::template axial<T>(p, strain[0], b);
    }
    static void hessian(Vec2 const& p, std::array<Mat<double, 2, 2>, 1>& h) {
      h[0] = Strain::axial_hessian(p);
    }
  };

  /// Bending at three Gauss points [Gerstmayr & Irschik 2008]; p = (r′, r″), κ = c/nᵏ with
  /// c = r′ × r″, n = |r′|.
  struct Bending {
    static constexpr int points = 3;
    static constexpr int parameters = 4;
    static constexpr int strains = 1;
    static constexpr int k = Strain::curvature_power;

    static Vec<double, 1> stiffness(BarConstants const& c) { return Vec<double, 1>(double(c.EI)); }
    static Vec<double, 1> damping(Damping const& d) { return Vec<double, 1>(d.bending); }
    static Mat<double, 4, 8> map(double xi, double l) {
      ShapeValues<4> const s = hermite_shape(xi, l);
      Mat<double, 4, 8> p;
      p << spread(s.ds), spread(s.dds);
      return p;
    }

    template <StateScalar T>
    static void evaluate(Vec<T, 4> const& p, Vec<T, 1>& strain, Mat<T, 1, 4>& b) {
      using std::sqrt;
      T const n2 = p[0] * p[0] + p[1] * p[1];
      T const nk = k == 2 ? n2 : n2 * sqrt(n2);
      T const kappa = (p[0] * p[3] - p[1] * p[2]) / nk, pull = kappa * double(k) / n2;
      strain[0] = kappa;
      b << p[3] / nk - pull * p[0], -p[2] / nk - pull * p[1], -p[1] / nk, p[0] / nk;
    }
    static void hessian(Vec4 const& p, std::array<Mat<double, 4, 4>, 1>& h) {
      Vec2 const slope = p.head<2>(), by_slope(p[3], -p[2]), by_second(-p[1], p[0]);
      double const n2 = slope.squaredNorm(), nk = k == 2 ? n2 : n2 * std::sqrt(n2);
      double const c = p[0] * p[3] - p[1] * p[2];
      Mat<double, 2, 2> turn;
      turn << 0.0, 1.0, -1.0, 0.0;
      Mat<double, 2, 2> const a = by_slope * slope.transpose();
      h[0].setZero();
      h[0].topLeftCorner<2, 2>() =
          (-k * (a + a.transpose() + c * Mat<double, 2, 2>::Identity()) +
           k * (k + 2) * c / n2 * slope * slope.transpose()) / (n2 * nk);
      h[0].topRightCorner<2, 2>() = turn / nk - k * slope * by_second.transpose() / (n2 * nk);
      h[0].bottomLeftCorner<2, 2>() = h[0].topRightCorner<2, 2>().transpose();
    }
  };
  using Groups = std::tuple<Axial, Bending>;
};

/// Planar ANCF cable: `AncfCable<>::from(bar, n)`, `AncfCable<EngineeringStrain>::from(bar, n)`.
template <class Strain = GreenStrain>
using AncfCable = Beam<HermiteCable<Strain>>;

static_assert(Body<AncfCable<>>);

}  // namespace polybody::planar
