#pragma once
/// \file
/// Rotation interpolation of `Lrvf`, for comparison: the directors are interpolated linearly, then made orthonormal
/// [Romero 2004, §4].
/// Theory: Eq. 2.69.

#include <polybody/bodies/lrvf/strain_gradient.hpp>

namespace polybody {

namespace detail {

/// Relative rotation of node 2 with respect to node 1, by φ about n: u = sin φ n and s = sin²(φ/2), with their
/// derivatives with respect to the rotations of the nodes.
template <StateScalar T>
struct RelativeTurn {
  Quaternion<T> p;  ///< (p₀, p_v), the relative quaternion: u = 2 p₀ p_v, s = p_v·p_v
  Vec<T, 3> u;
  T s;
  Mat<T, 3, 6> by_u;  ///< δu = by_u (δθ₁, δθ₂)
  Vec<T, 6> by_s;     ///< δs = by_s (δθ₁, δθ₂)

  /// Relative rotation and its derivatives: δp = ½ (p ∘ δθ₂ − δθ₁ ∘ p), hence
  ///   δu = p_v p_vᵀ (δθ₁ − δθ₂) + p₀ (p₀ (δθ₂ − δθ₁) + p_v × (δθ₁ + δθ₂)),  δs = ½ u·(δθ₂ − δθ₁).
  RelativeTurn(Quaternion<T> const& a, Quaternion<T> const& b) : p(quaternion_product<T>(conjugate<T>(a), b)) {
    Vec<T, 3> const v(p[1], p[2], p[3]);
    Mat<T, 3, 3> const x = skew(v);
    s = squared_norm(v);
    for (int i = 0; i < 3; ++i) {
      u[i] = 2.0 * p[0] * v[i];
      by_s[i] = -0.5 * u[i];
      by_s[3 + i] = 0.5 * u[i];
      for (int j = 0; j < 3; ++j) {
        T even = -(v[i] * v[j]);
        if (i == j) even += p[0] * p[0];
        by_u(i, j) = p[0] * x(i, j) - even;
        by_u(i, 3 + j) = p[0] * x(i, j) + even;
      }
    }
  }
};

}  // namespace detail

/// Interpolation in which R(ξ) is the rotation nearest to (1 − ξ) R₁ + ξ R₂ (polar decomposition) [Romero 2004, §4].
/// The sections rotate from node 1 about the axis n of the relative rotation of the nodes, as with `RelativeRotation`.
/// The angle α of a section differs from ξφ, with the angle φ of the relative rotation. In the plane normal to n, the
/// weighted mean of 1 and e^{iφ} is 1 − ξ + ξ e^{iφ} = ρ e^{iα}. Hence
///   R = R₁ exp(α n),  ρ² = 1 − 4 ξ (1 − ξ) s,  g = tan(α/2) n = ξ u/D,  D = ρ + 1 − 2 ξ s,  l K = dα/dξ n = u/ρ²,
/// with u = sin φ n, s = sin²(φ/2). The policy is objective, and its strains do not depend on the path. The difference
/// of the angles is α − ξφ = −ξ (1 − ξ) (1 − 2ξ) φ³/6 + O(φ⁵). In the middle R is that of `RelativeRotation`, and l K =
/// 2 tan(φ/2) n. The relative rotation of an element must be less than π.
class Polar {
 public:
  static constexpr bool objective = true;
  explicit Polar(Placement const&) {}  ///< the placement has no influence

  /// Section in a state, with intermediate results for its derivatives.
  template <StateScalar T>
  struct Section : SectionMotion<T> {
    double xi;            ///< ξ ∈ [0, 1]
    Quaternion<T> p;      ///< relative quaternion of the nodes
    Vec<T, 3> g;          ///< tan(α/2) n
    T rho;                ///< ρ = |1 − ξ + ξ e^{iφ}|
    Mat<T, 3, 3> turned;  ///< exp(α n)
  };

  /// Section in the middle of the element, ξ = ½.
  template <StateScalar T>
  void middle(Quaternion<T> const& a, Quaternion<T> const& b, StrainSection<T>& out) const {
    at<T>(0.5, a, b, out);
  }
  /// Derivatives of Pᵀt + Qᵀm, P w and Q w (`StrainSection`) at ξ = ½ with respect to the rotations of the nodes, by
  /// dual numbers. t = l N × Γ, m = M (3), w = (Ω₁, Ω₂).
  template <class T>  // compiled only if used
  void gradient(Quaternion<T> const& a, Quaternion<T> const& b, Vec<T, 3> const& t, Vec<T, 3> const& m,
                Vec<T, 6> const& w, StrainGradient& out) const {
    detail::strain_gradient(*this, 0.5, {a, b}, {t, m, w}, out);
  }
  /// Section at ξ, with δ(u/ρ²) = δu/ρ² + 4 ξ (1 − ξ) u δs/ρ⁴.
  template <StateScalar T>
  void at(double xi, Quaternion<T> const& a, Quaternion<T> const& b, StrainSection<T>& out) const {
    detail::RelativeTurn<T> const turn(a, b);
    Section<T> s;
    place<T>(xi, a, turn, s);
    out.R = s.R;
    out.spin = s.spin;
    T const part = 1.0 / (s.rho * s.rho), more = 4.0 * xi * (1.0 - xi) * part * part;
    for (int i = 0; i < 3; ++i) {
      out.turn[i] = turn.u[i] * part;
      for (int j = 0; j < 6; ++j) out.bend(i, j) = turn.by_u(i, j) * part + turn.u[i] * more * turn.by_s[j];
    }
  }

  /// Section at ξ with R(ξ) and its map P, between nodes with the rotations a and b.
  template <StateScalar T>
  void section(double xi, Quaternion<T> const& a, Quaternion<T> const& b, Section<T>& out) const {
    place<T>(xi, a, detail::RelativeTurn<T>(a, b), out);
  }
  /// Time derivative of Ω for constant w = (Ω₁, Ω₂), from Ω = exp(−α n) Ω₁ + ω, ω = h (ġ − g × ġ), h = 2/(1 + g²). The
  /// equation g D = ξ u gives g¨ from p¨.
  template <StateScalar T>
  Vec<T, 3> bias(Section<T> const& s, Vec<T, 6> const& w) const {
    double const xi = s.xi, eta = 2.0 * xi * (1.0 - xi);
    Quaternion<T> const first = quaternion_rate(s.p, w), second = quaternion_rate(first, w);
    Vec<T, 3> const v(s.p[1], s.p[2], s.p[3]), v1(first[1], first[2], first[3]), v2(second[1], second[2], second[3]);
    T const s0 = squared_norm(v), s1 = 2.0 * dot(v, v1), s2 = 2.0 * (squared_norm(v1) + dot(v, v2));
    T const rho1 = -eta * s1 / s.rho, rho2 = -(eta * s2 + rho1 * rho1) / s.rho;
    T const d0 = s.rho + 1.0 - 2.0 * xi * s0, d1 = rho1 - 2.0 * xi * s1, d2 = rho2 - 2.0 * xi * s2;
    Vec<T, 3> g1, g2;
    for (int i = 0; i < 3; ++i) {
      T const u1 = 2.0 * (first[0] * v[i] + s.p[0] * v1[i]);
      T const u2 = 2.0 * (second[0] * v[i] + 2.0 * first[0] * v1[i] + s.p[0] * v2[i]);
      g1[i] = (xi * u1 - s.g[i] * d1) / d0;
      g2[i] = (xi * u2 - 2.0 * g1[i] * d1 - s.g[i] * d2) / d0;
    }
    T const h = 2.0 / (1.0 + squared_norm(s.g)), h1 = -h * h * dot(s.g, g1);
    Vec<T, 3> const once = difference(g1, cross(s.g, g1)), twice = difference(g2, cross(s.g, g2));
    Vec<T, 3> omega, out;
    for (int i = 0; i < 3; ++i) omega[i] = h * once[i];
    Vec<T, 3> const relative = cross(transposed_product(s.turned, detail::of_node(0, w)), omega);
    for (int i = 0; i < 3; ++i) out[i] = relative[i] + h * twice[i] + h1 * once[i];
    return out;
  }
  /// Derivative of Pᵀx by dual numbers; P depends on the relative rotation only.
  template <class T, StateScalar D = Dual<6>>  // compiled only if used
  void spin_gradient(Section<T> const& s, Vec<T, 3> const& x, Mat<T, 6, 6>& out) const {
    Section<D> moved;
    section<D>(s.xi, detail::turning_quaternion<6>({1.0, 0.0, 0.0, 0.0}, 0), detail::turning_quaternion<6>(s.p, 3),
               moved);
    out = detail::zeros<Mat<T, 6, 6>>();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 6; ++j)
        for (int k = 0; k < 6; ++k) out(j, k) += x[i] * moved.spin(i, j).d[k];
  }
  /// Rotation R with the curvature K and K′ = −u d(ρ²)/dξ/(ρ⁴ l²), d(ρ²)/dξ = −4 (1 − 2ξ) s, at ξ of an element of
  /// length l [m].
  template <class T>  // compiled only if used
  SectionTurn turn(double xi, double l, Quaternion<T> const& a, Quaternion<T> const& b) const {
    detail::RelativeTurn<T> const turn(a, b);
    Section<T> s;
    place<T>(xi, a, turn, s);
    double const part = 1.0 / (s.rho * s.rho * l);
    return {s.R, scaled<T>(turn.u, part), scaled<T>(turn.u, 4.0 * (1.0 - 2.0 * xi) * turn.s * part * part)};
  }

 private:
  /// Section with P = [exp(−α n), 0] + h (1 − g̃) ∂g,  ∂g = ξ/D (∂u + 2 (ξ (1 − ξ)/ρ + ξ)/D u ∂s).
  template <StateScalar T>
  static void place(double xi, Quaternion<T> const& a, detail::RelativeTurn<T> const& turn, Section<T>& out) {
    using std::sqrt;
    double const eta = xi * (1.0 - xi);
    out.xi = xi;
    out.p = turn.p;
    out.rho = sqrt(1.0 - 4.0 * eta * turn.s);
    T const part = xi / (out.rho + 1.0 - 2.0 * xi * turn.s), more = 2.0 * (eta / out.rho + xi) * part / xi;
    Mat<T, 3, 6> by_nodes;
    for (int i = 0; i < 3; ++i) {
      out.g[i] = turn.u[i] * part;
      for (int j = 0; j < 6; ++j) by_nodes(i, j) = part * (turn.by_u(i, j) + more * turn.u[i] * turn.by_s[j]);
    }
    T const h = 2.0 / (1.0 + squared_norm(out.g));
    out.turned = one_and_skew<T>(out.g, h, h);
    out.R = product(rotation_matrix<T>(a), out.turned);
    Mat<T, 3, 6> const across = skew_product(out.g, by_nodes);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 6; ++j) {
        out.spin(i, j) = h * (by_nodes(i, j) - across(i, j));
        if (j < 3) out.spin(i, j) += out.turned(j, i);
      }
  }
  /// Rate ½ (p ∘ Ω₂ − Ω₁ ∘ p) of the relative quaternion.
  template <StateScalar T>
  static Quaternion<T> quaternion_rate(Quaternion<T> const& p, Vec<T, 6> const& w) {
    Quaternion<T> const first(T(0.0), w[0], w[1], w[2]), second(T(0.0), w[3], w[4], w[5]);
    Quaternion<T> const after = quaternion_product<T>(p, second), before = quaternion_product<T>(first, p);
    Quaternion<T> out;
    for (int i = 0; i < 4; ++i) out[i] = 0.5 * (after[i] - before[i]);
    return out;
  }
};

}  // namespace polybody
