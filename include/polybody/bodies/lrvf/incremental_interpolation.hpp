#pragma once
/// \file
/// Increments of the nodes' rotations interpolated: a policy of `Lrvf` for comparison [Simo & Vu-Quoc 1986b; Cardona &
/// Géradin 1988; Jelenić & Crisfield 1999]. Not in polybody.hpp: `Objective` is what to use.

#include <polybody/bodies/lrvf/rotation_interpolation.hpp>

namespace polybody {

/// The increments of a step, δ₁ and δ₂ of q ⊞ δ, are interpolated linearly, and turn each section from where it stood:
///   R⁺(ξ) = R(ξ) exp(δ(ξ)),  δ(ξ) = (1 − ξ) δ₁ + ξ δ₂,
///   K⁺ = axial(R⁺ᵀ R⁺′) = exp(−δ) K + Jr(δ) δ′.
/// In the middle, whose R and l K are coordinates of the element, δ = ½ (δ₁ + δ₂) and
///   R⁺ = R exp(δ),  l K⁺ = exp(−δ) l K + Jr(δ) (δ₂ − δ₁).
/// By δ, at δ = 0:
///   δθ = ½ (δθ₁ + δθ₂),  δ(l K) = δθ₂ − δθ₁ + l K × δθ.
/// In the reference both are those of `Objective`. Forces are the gradient of the energy along the spins of the nodes:
/// whatever the path, they do the work that the energy loses. It is no function of the nodes. Three measured faults:
/// - Strains depend on the path, and finer steps do not help: after a closed path of the nodes the element is bent, and
///   without stress it rests off its reference, by terms of the order of l².
/// - They depend on the steps: an integrator interpolates the increment of a whole step, `equilibrium` each of Newton's
///   corrections. While q ⊞ δ(t) moves as the nodes spin, the middle spins with ½ (Ω₁ + Ω₂) at δ = 0 only, and is off
///   by ⅛ (δ₂ − δ₁) × (Ω₂ − Ω₁) first: energy stays to the second order of the step at best, under any integrator.
/// - It is not objective. A rigid spin ω of an element bent by φ about n, n ⊥ ω, turns the middle with cos(φ/2) ω, and
///   l K by (φ cos(φ/2) − 2 sin(φ/2)) n × ω ≈ −φ³/12 n × ω.
/// Coordinates that are set by hand need the section in the middle, too: go there by q ⊞ δ.
class Incremental {
 public:
  static constexpr bool objective = false;
  explicit Incremental(Placement const&) {}  ///< the placement has no influence

  template <StateScalar T>
  struct Section : SectionMotion<T> {};

  /// The middle in the reference, on the shortest way from node to node: l K = log(R₁ᵀR₂).
  template <class T>  // compiled where it is used
  static CarriedSection<T> between(Quaternion<T> const& a, Quaternion<T> const& b) {
    Vec<T, 3> const phi = quaternion_minus<T>(b, a);
    return {quaternion_plus<T>(a, scaled<T>(phi, 0.5)), phi};
  }
  /// The section carried along by increments of its nodes, `first` and `second` (3), in their axes [rad].
  template <StateScalar T>
  static CarriedSection<T> plus(CarriedSection<T> const& s, Vec<T, 3> const& first, Vec<T, 3> const& second) {
    Vec<T, 3> const mean(0.5 * (first[0] + second[0]), 0.5 * (first[1] + second[1]), 0.5 * (first[2] + second[2]));
    Vec<T, 3> const carried = transposed_product(exp_so3<T>(mean), s.turn),
                    bent = product(right_jacobian<T>(mean), difference<T>(second, first));
    return {quaternion_plus<T>(s.axes, mean), {carried[0] + bent[0], carried[1] + bent[1], carried[2] + bent[2]}};
  }

  /// P = ½ [1, 1],  Q = [½ (l K)~ − 1, ½ (l K)~ + 1].
  template <StateScalar T>
  static void middle(CarriedSection<T> const& s, StrainSection<T>& out) {
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
  /// ∂P = 0;  ∂(Q w) = ∂(l K) × ½ (w₁ + w₂),  ∂(Qᵀ m) = [½ m × ∂(l K); ½ m × ∂(l K)],  ∂(l K) = Q (δθ₁, δθ₂).
  template <class T>  // compiled where it is used
  static void gradient(CarriedSection<T> const& s, Vec<T, 3> const& m, Vec<T, 6> const& w, StrainGradient& out) {
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

  /// Ω = ½ (Ω₁ + Ω₂) in the axes of the middle, which is constant while Ω₁ and Ω₂ are.
  template <StateScalar T>
  static void section(CarriedSection<T> const& s, Section<T>& out) {
    out.R = rotation_matrix<T>(s.axes);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) out.spin(i, j) = out.spin(i, 3 + j) = T(i == j ? 0.5 : 0.0);
  }
  /// Ω˙ for Ω₁˙ = Ω₂˙ = 0, which is zero.
  template <StateScalar T>
  Vec<T, 3> bias(Section<T> const&, Vec<T, 6> const&) const {
    return detail::zeros<Vec<T, 3>>();
  }
  /// The derivative of Pᵀx, which is zero, for P is constant.
  template <class T>  // compiled where it is used
  void spin_gradient(Section<T> const&, Vec<T, 3> const&, Mat<T, 6, 6>& out) const {
    out = detail::zeros<Mat<T, 6, 6>>();
  }
  /// \throws InvalidInput unless ξ, at s [m], is a node or the middle: no other rotation is carried along.
  static void require_known(double xi, double s) {
    if (xi != 0.0 && xi != 1.0 && !(xi > 0.5 - 1e-12 && xi < 0.5 + 1e-12))
      throw InvalidInput{"Lrvf<Incremental>: at s = ", s,
                         " no rotation is known: increments turn the nodes and the middle of each element only."};
  }
};

}  // namespace polybody
