#pragma once
/// \file
/// Interpolation of the increments of the nodal rotations, a policy of `Lrvf` for comparison.
/// Theory: Eq. 2.71.

#include <polybody/bodies/lrvf/rotation_interpolation.hpp>

namespace polybody {

/// Linear interpolation of the increments δ₁ and δ₂ of the nodes in a step q ⊞ δ [Simo & Vu-Quoc 1986b; Cardona &
/// Géradin 1988; Jelenić & Crisfield 1999]. The increment rotates each section from its previous orientation:
///   R⁺(ξ) = R(ξ) exp(δ(ξ)),  δ(ξ) = (1 − ξ) δ₁ + ξ δ₂,
///   K⁺ = axial(R⁺ᵀ R⁺′) = exp(−δ) K + Jr(δ) δ′.
/// The rotation R and the vector l K of the middle are coordinates of the element. In the middle δ = ½ (δ₁ + δ₂) and
///   R⁺ = R exp(δ),  l K⁺ = exp(−δ) l K + Jr(δ) (δ₂ − δ₁).
/// The derivatives at δ = 0 are
///   δθ = ½ (δθ₁ + δθ₂),  δ(l K) = δθ₂ − δθ₁ + l K × δθ.
/// In the reference configuration R and l K are those of `RelativeRotation`. Forces are the negative gradient of the
/// energy with respect to the rotations of the nodes: for every path, their work equals the loss of energy. The energy
/// is not a function of the nodal coordinates. The tests measure three faults:
/// - The strains depend on the path, and shorter steps do not remove this dependence. After a closed path of the nodes
///   the element is bent, and its stress-free shape differs from the reference by terms of order l².
/// - The strains depend on the steps: an integrator interpolates the increment of a whole step, `equilibrium` the
///   increment of each Newton correction. If the nodes of q ⊞ δ(t) rotate with Ω₁ and Ω₂, the middle rotates with
///   ½ (Ω₁ + Ω₂) only at δ = 0. The leading error is ⅛ (δ₂ − δ₁) × (Ω₂ − Ω₁). The energy error is at best of second
///   order in the step, for every integrator.
/// - The policy is not objective. If an element bent by φ about n rotates rigidly with ω ⊥ n, its middle rotates with
///   cos(φ/2) ω. The rate of l K is then (φ cos(φ/2) − 2 sin(φ/2)) n × ω ≈ −φ³/12 n × ω.
/// Coordinates q that a user sets must include R and l K of the middle of each element. q ⊞ δ computes R and l K.
class Incremental {
 public:
  static constexpr bool objective = false;
  explicit Incremental(Placement const&) {}  ///< the placement has no influence

  template <StateScalar T>
  struct Section : SectionMotion<T> {};

  /// Section in the middle in the reference configuration, on the shortest rotation from node to node: l K =
  /// log(R₁ᵀR₂).
  template <class T>  // compiled only if used
  static CarriedSectionState<T> between(Quaternion<T> const& a, Quaternion<T> const& b) {
    Vec<T, 3> const phi = quaternion_minus<T>(b, a);
    return {quaternion_plus<T>(a, scaled<T>(phi, 0.5)), phi};
  }
  /// Section after the increments `first` and `second` (3) of the nodes, each in the axes of its node [rad].
  template <StateScalar T>
  static CarriedSectionState<T> plus(CarriedSectionState<T> const& s, Vec<T, 3> const& first, Vec<T, 3> const& second) {
    Vec<T, 3> const mean(0.5 * (first[0] + second[0]), 0.5 * (first[1] + second[1]), 0.5 * (first[2] + second[2]));
    Vec<T, 3> const carried = transposed_product(exp_so3<T>(mean), s.turn),
                    bent = product(right_jacobian<T>(mean), difference<T>(second, first));
    return {quaternion_plus<T>(s.axes, mean), {carried[0] + bent[0], carried[1] + bent[1], carried[2] + bent[2]}};
  }

  /// Section in the middle, with P = ½ [1, 1] and Q = [½ (l K)~ − 1, ½ (l K)~ + 1] (`StrainSection`).
  template <StateScalar T>
  static void middle(CarriedSectionState<T> const& s, StrainSection<T>& out) {
    out.R = rotation_matrix<T>(s.axes);
    out.turn = s.turn;
    Mat<T, 3, 3> const x = skew<T>(s.turn);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        double const one = i == j ? 1.0 : 0.0;
        out.spin(i, j) = out.spin(i, 3 + j) = T(0.5 * one);
        out.bend(i, j) = 0.5 * x(i, j) - one;
        out.bend(i, 3 + j) = 0.5 * x(i, j) + one;
      }
  }
  /// Derivatives ∂P = 0;  ∂(Q w) = ∂(l K) × ½ (w₁ + w₂),  ∂(Qᵀ m) = [½ m × ∂(l K); ½ m × ∂(l K)], ∂(l K) = Q (δθ₁,
  /// δθ₂).
  template <class T>  // compiled only if used
  static void gradient(CarriedSectionState<T> const& s, Vec<T, 3> const& m, Vec<T, 6> const& w, StrainGradient& out) {
    StrainSection<T> at;
    middle<T>(s, at);
    Vec<T, 3> half, back;
    for (int i = 0; i < 3; ++i) {
      half[i] = 0.5 * m[i];
      back[i] = -0.5 * (w[i] + w[3 + i]);
    }
    Mat<T, 3, 6> const pulled = skew_product(half, at.bend);
    out.spin = detail::zeros<Mat<T, 3, 6>>();
    out.bend = skew_product(back, at.bend);
    detail::set_rows(pulled, pulled, out.pulled);
  }

  /// Section in the middle with Ω = ½ (Ω₁ + Ω₂) in its axes. Ω is constant if Ω₁ and Ω₂ are constant.
  template <StateScalar T>
  static void section(CarriedSectionState<T> const& s, Section<T>& out) {
    out.R = rotation_matrix<T>(s.axes);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) out.spin(i, j) = out.spin(i, 3 + j) = T(i == j ? 0.5 : 0.0);
  }
  /// Acceleration Ω˙ for Ω₁˙ = Ω₂˙ = 0, which is zero.
  template <StateScalar T>
  Vec<T, 3> bias(Section<T> const&, Vec<T, 6> const&) const {
    return detail::zeros<Vec<T, 3>>();
  }
  /// Derivative of Pᵀx, which is zero because P is constant.
  template <class T>  // compiled only if used
  void spin_gradient(Section<T> const&, Vec<T, 3> const&, Mat<T, 6, 6>& out) const {
    out = detail::zeros<Mat<T, 6, 6>>();
  }
  /// Checks the position ξ of a marker at s [m].
  /// \throws InvalidInput unless ξ is a node or the middle, because other rotations are not stored.
  static void require_known(double xi, double s) {
    if (xi != 0.0 && xi != 1.0 && !(xi > 0.5 - 1e-12 && xi < 0.5 + 1e-12))
      throw InvalidInput("lrvf.no_rotation",
                         {ErrorObject{"Lrvf<Incremental>"}, ": the rotation at s = ", ErrorValue{s},
                          " m is unknown. Place the marker at a node or in the middle of an element."});
  }
};

}  // namespace polybody
