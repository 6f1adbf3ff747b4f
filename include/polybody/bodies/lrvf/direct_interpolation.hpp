#pragma once
/// \file
/// Linear interpolation of the rotation vectors of the nodes, a policy of `Lrvf` for comparison.
/// Theory: Eq. 2.68.

#include <array>
#include <numbers>

#include <polybody/bodies/lrvf/strain_gradient.hpp>

namespace polybody {

/// Linear interpolation of the rotation vectors Ψ of the nodes relative to the placement R₀ of the bar: R(ξ) = R₀
/// exp(Ψ(ξ)), K = Jr(Ψ) Ψ′ [thesis §2.3–2.5]. This policy is meant for comparison; `RelativeRotation` is recommended.
/// The tests measure two faults:
/// - The policy is not objective. The curvature and the energy of an element that bends by φ about one axis change if
///   the element rotates rigidly about another axis. The relative changes are of order φ²: 0.01 φ² for the energy after
///   a rotation of 2 rad.
/// - The rotation vector Ψ₁ of node 1 has |Ψ₁| ≤ π. For node 2, the rotation vector Ψ and its complement Ψ (1 − 2π/|Ψ|)
///   describe the same rotation. Ψ₂ is the one that is nearer to Ψ₁. If node 1 passes |Ψ₁| = π, both vectors change to
///   their complements. The curvature then jumps by terms of order φ³/l, unless the element rotates about Ψ itself.
class Direct {
 public:
  static constexpr bool objective = false;
  /// Interpolation of rotation vectors relative to the axes of `placement`.
  template <class = void>  // compiled only if used
  explicit Direct(Placement const& placement) : from_(quaternion_of(placement.axes)), axes_(placement.axes) {}

  /// Section in the middle of the element, ξ = ½.
  template <StateScalar T>
  void middle(Quaternion<T> const& a, Quaternion<T> const& b, StrainSection<T>& out) const {
    at<T>(0.5, a, b, out);
  }
  /// Section at ξ, with δ(l K) = Jr(Ψ) (δΨ₂ − δΨ₁) + D(Ψ, Ψ₂ − Ψ₁) ((1 − ξ) δΨ₁ + ξ δΨ₂), D(φ, x) = ∂(Jr(φ) x)/∂φ and
  /// δΨᵢ = Jr⁻¹(Ψᵢ) δθᵢ.
  template <StateScalar T>
  void at(double xi, Quaternion<T> const& a, Quaternion<T> const& b, StrainSection<T>& out) const {
    Vec<T, 3> const first = vector<T>(a), second = vector<T>(b, first), apart = difference(second, first);
    Vec<T, 3> const psi = between<T>(first, second, xi);
    Mat<T, 3, 3> const jacobian = right_jacobian<T>(psi), slope = right_jacobian_derivative<T>(psi, apart);
    Mat<T, 3, 3> bend1, bend2;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        bend1(i, j) = slope(i, j) * (1.0 - xi) - jacobian(i, j);
        bend2(i, j) = slope(i, j) * xi + jacobian(i, j);
      }
    Mat<T, 3, 3> const inverse1 = right_jacobian_inverse<T>(first), inverse2 = right_jacobian_inverse<T>(second);
    out.R = product(axes<T>(), exp_so3<T>(psi));
    out.turn = product(jacobian, apart);
    set_halves<T>(product(jacobian, inverse1), product(jacobian, inverse2), {1.0 - xi, xi}, out.spin);
    set_halves<T>(product(bend1, inverse1), product(bend2, inverse2), {1.0, 1.0}, out.bend);
  }

  /// Derivatives of Pᵀt + Qᵀm, P w and Q w (`StrainSection`) at ξ = ½ with respect to the rotations of the nodes, by
  /// dual numbers. t = l N × Γ, m = M (3), w = (Ω₁, Ω₂).
  template <class T>  // compiled only if used
  void gradient(Quaternion<T> const& a, Quaternion<T> const& b, Vec<T, 3> const& t, Vec<T, 3> const& m,
                Vec<T, 6> const& w, StrainGradient& out) const {
    detail::strain_gradient(*this, 0.5, {a, b}, {t, m, w}, out);
  }

  /// Section in a state, with intermediate results for its derivatives.
  template <StateScalar T>
  struct Section : SectionMotion<T> {
    double share[2];                    ///< weights 1 − ξ, ξ of the nodes
    Vec<T, 3> psi, node[2];             ///< Ψ, Ψ₁ and Ψ₂
    Mat<T, 3, 3> jacobian, inverse[2];  ///< Jr(Ψ), Jr⁻¹(Ψ₁) and Jr⁻¹(Ψ₂)
  };
  /// Section at ξ with its angular velocity Ω = Jr(Ψ) Ψ˙, where Jr(Ψᵢ) Ψᵢ˙ = Ωᵢ.
  template <StateScalar T>
  void section(double xi, Quaternion<T> const& a, Quaternion<T> const& b, Section<T>& out) const {
    out.share[0] = 1.0 - xi;
    out.share[1] = xi;
    out.node[0] = vector<T>(a);
    out.node[1] = vector<T>(b, out.node[0]);
    out.psi = between<T>(out.node[0], out.node[1], xi);
    out.jacobian = right_jacobian<T>(out.psi);
    out.R = product(axes<T>(), exp_so3<T>(out.psi));
    for (int i = 0; i < 2; ++i) out.inverse[i] = right_jacobian_inverse<T>(out.node[i]);
    set_halves<T>(product(out.jacobian, out.inverse[0]), product(out.jacobian, out.inverse[1]), {1.0 - xi, xi},
                  out.spin);
  }
  /// Time derivative of Ω for constant w = (Ω₁, Ω₂), from the time derivatives of Ω = Jr(Ψ) Ψ˙ and Jr(Ψᵢ) Ψᵢ˙ = Ωᵢ.
  template <StateScalar T>
  Vec<T, 3> bias(Section<T> const& s, Vec<T, 6> const& w) const {
    Vec<T, 3> rate = detail::zeros<Vec<T, 3>>(), second = rate;
    for (int i = 0; i < 2; ++i) {
      Vec<T, 3> const own = product(s.inverse[i], detail::of_node(i, w));
      Vec<T, 3> const turning = product(s.inverse[i], product(right_jacobian_derivative<T>(s.node[i], own), own));
      for (int k = 0; k < 3; ++k) {
        rate[k] += own[k] * s.share[i];
        second[k] -= turning[k] * s.share[i];
      }
    }
    Vec<T, 3> const own = product(right_jacobian_derivative<T>(s.psi, rate), rate);
    Vec<T, 3> const carried = product(s.jacobian, second);
    return {own[0] + carried[0], own[1] + carried[1], own[2] + carried[2]};
  }
  /// Derivative of Pᵢᵀx = sᵢ Jr⁻¹(−Ψᵢ) y with y = Jr(−Ψ) x and the weights sᵢ of the nodes in Ψ. With D(φ, x) = ∂(Jr(φ)
  /// x)/∂φ:
  ///   ∂y/∂Ψ = −D(−Ψ, x),  ∂(Jr⁻¹(−Ψᵢ) y) = Jr⁻¹(−Ψᵢ) (∂y + D(−Ψᵢ, Jr⁻¹(−Ψᵢ) y) ∂Ψᵢ).
  template <class T>  // compiled only if used
  void spin_gradient(Section<T> const& s, Vec<T, 3> const& x, Mat<T, 6, 6>& out) const {
    Vec<T, 3> const y = transposed_product(s.jacobian, x);
    Mat<T, 3, 3> const by_y = right_jacobian_derivative<T>(scaled<T>(s.psi, -1.0), x);
    for (int i = 0; i < 2; ++i) {
      Mat<T, 3, 3> const of_own =
          right_jacobian_derivative<T>(scaled<T>(s.node[i], -1.0), transposed_product(s.inverse[i], y));
      for (int j = 0; j < 2; ++j) {
        Mat<T, 3, 3> slope;
        for (int c = 0; c < 3; ++c)
          for (int r = 0; r < 3; ++r) slope(r, c) = (i == j ? of_own(r, c) : 0.0) - s.share[j] * by_y(r, c);
        Mat<T, 3, 3> const part = transposed_product(s.inverse[i], product(slope, s.inverse[j]));
        for (int c = 0; c < 3; ++c)
          for (int r = 0; r < 3; ++r) out(3 * i + r, 3 * j + c) = s.share[i] * part(r, c);
      }
    }
  }

  /// Rotation R with the curvature K and its derivative K′ at ξ of an element of length l [m].
  template <class T>  // compiled only if used
  SectionTurn turn(double xi, double l, Quaternion<T> const& a, Quaternion<T> const& b) const {
    Vec<T, 3> const first = vector<T>(a), second = vector<T>(b, first), psi = between<T>(first, second, xi);
    Vec<T, 3> const rate = scaled<T>(difference(second, first), 1.0 / l);
    return {product(axes<T>(), exp_so3<T>(psi)), product(right_jacobian<T>(psi), rate),
            product(right_jacobian_derivative<T>(psi, rate), rate)};
  }

 private:
  /// Rotation vector Ψ of a node, |Ψ| ≤ π.
  template <StateScalar T>
  Vec<T, 3> vector(Quaternion<T> const& q) const {
    Quaternion<T> const back(from_[0], -from_[1], -from_[2], -from_[3]);
    return quaternion_log<T>(quaternion_product<T>(back, q));
  }
  /// Rotation vector Ψ or its complement, the one nearer to `other`: the complement if Ψ·other < |Ψ| (|Ψ| − π).
  template <StateScalar T>
  Vec<T, 3> vector(Quaternion<T> const& q, Vec<T, 3> const& other) const {
    using std::sqrt;
    Vec<T, 3> const psi = vector<T>(q);
    T const size2 = squared_norm(psi);
    double const size = std::sqrt(value_of(size2)), pi = std::numbers::pi;
    if (!(value_of(dot(psi, other)) < size * (size - pi))) return psi;
    T const other_way = 1.0 - 2.0 * pi / sqrt(size2);
    return {psi[0] * other_way, psi[1] * other_way, psi[2] * other_way};
  }
  /// Interpolated rotation vector Ψ = (1 − ξ) Ψ₁ + ξ Ψ₂.
  template <class T>
  static Vec<T, 3> between(Vec<T, 3> const& first, Vec<T, 3> const& second, double xi) {
    Vec<T, 3> psi;
    for (int i = 0; i < 3; ++i) psi[i] = first[i] * (1.0 - xi) + second[i] * xi;
    return psi;
  }
  /// Sets `map` to [s₁ A₁, s₂ A₂], with the weights s = `share` and the matrices A₁ = `first`, A₂ = `second`.
  template <class T>
  static void set_halves(Mat<T, 3, 3> const& first, Mat<T, 3, 3> const& second, std::array<double, 2> share,
                         Mat<T, 3, 6>& map) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        map(i, j) = first(i, j) * share[0];
        map(i, 3 + j) = second(i, j) * share[1];
      }
  }
  template <class T>
  Mat<T, 3, 3> axes() const {
    Mat<T, 3, 3> m;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) m(i, j) = T(axes_(i, j));
    return m;
  }

  Quaternion<double> from_;
  Mat3 axes_;
};

}  // namespace polybody
