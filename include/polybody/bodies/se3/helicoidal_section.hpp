#pragma once
/// \file
/// Any section of an element of `Se3Beam`: frame, twist, its time derivative and the pull of a wrench.
///
/// The section at ξ has the frame H(ξ) = H₁ exp(ξ d), d = log(H₁⁻¹ H₂): position and rotation follow from one
/// interpolation [Borri & Bottasso 1994; Sonneville, Cardona & Brüls 2014, §4]. With the twists V₁, V₂ of the nodes and
/// the operators of math/se3.hpp:
///   V(ξ) = Ad(exp(−ξd)) V₁ + ξ T(ξd) ḋ = P₁ V₁ + P₂ V₂,  T(d) ḋ = V₂ − Ad(exp(−d)) V₁.
/// Theory: Eqs. 2.106, 2.115 to 2.118.

#include <polybody/bodies/se3/helicoidal_element.hpp>

namespace polybody {

/// Section at ξ of an element in a state. `P1` and `P2` are maps of twists in section axes. At a node, the section is
/// exactly that of the node.
template <StateScalar T>
struct HelicoidalPoint {
  double xi;               ///< ξ ∈ [0, 1]
  Mat<T, 3, 3> R1, R2;     ///< axes of the nodes in world axes
  Mat<T, 3, 3> R;          ///< axes of the section in world axes
  Vec<T, 3> r;             ///< position of the section on the axis, world axes [m]
  ScrewVector<T> d, part;  ///< d, ξd
  ScrewMap<T> tangent;     ///< T(ξd)
  ScrewMap<T> inverse;     ///< T⁻¹(d)
  ScrewMap<T> carry;       ///< Ad(exp(−ξd))
  ScrewMap<T> P1, P2;      ///< V = P₁ V₁ + P₂ V₂

  /// Section at ξ = `position` of the element whose first node is at `first` in q.
  HelicoidalPoint(double position, std::span<T const> q, Index first) : xi(position) {
    Quaternion<T> const b = entries<4>(q, first + 10);
    set_rotation<T>(b, R2);
    if (inside()) {
      HelicoidalElement<T> const element(q, first);
      R1 = element.R;
      d = element.d;
      inverse = element.inverse;
      place(entries<3>(q, first));
    } else {
      Quaternion<T> const a = entries<4>(q, first + 3);
      set_rotation<T>(a, R1);
      R = xi == 0.0 ? R1 : R2;
      r = entries<3>(q, xi == 0.0 ? first : first + 7);
      ScrewMap<T> const none{detail::zeros<Mat<T, 3, 3>>(), detail::zeros<Mat<T, 3, 3>>()},
          one{identity<T>(), detail::zeros<Mat<T, 3, 3>>()};
      P1 = xi == 0.0 ? one : none;
      P2 = xi == 0.0 ? none : one;
    }
  }
  /// True between the nodes.
  bool inside() const { return xi != 0.0 && xi != 1.0; }

  /// Twists V₁, V₂ of the nodes in their axes, for the velocities of the element from entry `first` of v.
  std::array<ScrewVector<T>, 2> twists(std::span<T const> v, Index first) const {
    return {ScrewVector<T>{transposed_product<T>(R1, entries<3>(v, first)), entries<3>(v, first + 3)},
            ScrewVector<T>{transposed_product<T>(R2, entries<3>(v, first + 6)), entries<3>(v, first + 9)}};
  }
  /// Twist of the section for the twists of the nodes.
  ScrewVector<T> twist(std::array<ScrewVector<T>, 2> const& nodes) const { return sum(P1(nodes[0]), P2(nodes[1])); }

  /// Time derivative of the twist of the section for constant ṙ and Ω of the nodes, so that V˙₁ = (−Ω₁ × U₁, 0). The
  /// bracket [c, y] is that of screws, c = Ad(exp(−d)) V₁:
  ///   d̈ = T⁻¹(d) (V˙₂ − Ad(exp(−d)) V˙₁ + [V₂, c] − ∂(T(d) ḋ)/∂d ḋ),
  ///   V˙ = P₁ V˙₁ + P₂ V˙₂ + [Ad(exp(−ξd)) V₁, ξ T(ξd) ḋ] + ξ T(ξd) d̈′ + ξ² ∂(T(ξd) ḋ)/∂(ξd) ḋ,
  /// where d̈′ is d̈ for V˙₁ = V˙₂ = 0.
  ScrewVector<T> twist_rate(std::array<ScrewVector<T>, 2> const& nodes) const {
    ScrewVector<T> const rate1 = node_rate(nodes[0]), rate2 = node_rate(nodes[1]);
    ScrewVector<T> const of_nodes = sum(P1(rate1), P2(rate2));
    if (!inside()) return of_nodes;
    ScrewVector<T> const rate = difference(inverse(nodes[1]), blockwise_transposed(inverse)(nodes[0]));
    ScrewVector<T> const carried = se3_adjoint<T>(opposite(d))(nodes[0]);
    ScrewVector<T> const turning = se3_tangent_derivative<T>(d, rate)(rate);
    ScrewVector<T> const second = tangent(inverse(difference(bracket(nodes[1], carried), turning)));
    ScrewVector<T> const relative = bracket(carry(nodes[0]), tangent(rate));
    ScrewVector<T> const by_part = se3_tangent_derivative<T>(part, rate)(rate);
    return sum(sum(of_nodes, scaled(sum(relative, second), xi)), scaled(by_part, xi * xi));
  }

  /// Maps L₁₁, L₁₂, L₂₁, L₂₂ of δ(P_iᵀ w) = Σ L_ij V_j, for a constant wrench w in section axes and motions V_j of the
  /// nodes. Screws contain the moment of a wrench as translation and the force as rotation, x = (m, f):
  ///   P₂ᵀ w = T⁻¹(−d) y,  P₁ᵀ w = Ad(exp(ξd)) x − T⁻¹(d) y,  y = ξ T(−ξd) x,  δd = T⁻¹(d) V₂ − T⁻¹(−d) V₁.
  std::array<ScrewMap<T>, 4> pull_derivatives(ScrewVector<T> const& x) const {
    ScrewMap<T> const back = blockwise_transposed(inverse);  // T⁻¹(−d)
    ScrewVector<T> const y = scaled(blockwise_transposed(tangent)(x), xi);
    ScrewMap<T> const by_y = scaled(se3_tangent_derivative<T>(opposite(part), x), -xi * xi);  // ∂y/∂d
    ScrewMap<T> const turned = product(blockwise_transposed(carry), product(bracket_map(x), tangent));
    ScrewMap<T> const of_first = sum(se3_tangent_inverse_derivative<T>(d, y), product(inverse, by_y));
    ScrewMap<T> const first = sum(scaled(turned, -xi), scaled(of_first, -1.0)),
                      second =
                          sum(product(back, by_y), scaled(se3_tangent_inverse_derivative<T>(opposite(d), y), -1.0));
    return {scaled(product(first, back), -1.0), product(first, inverse), scaled(product(second, back), -1.0),
            product(second, inverse)};
  }

 private:
  /// Sets the frame and the maps from d.
  void place(Vec<T, 3> const& r1) {
    part = scaled(d, xi);
    T const x = squared_norm(part.rotation);
    RigidMotion<T> const relative = exp_se3<T>(part);
    R = product(R1, relative.A);
    r = product(R1, relative.r);
    for (int i = 0; i < 3; ++i) r[i] += r1[i];
    tangent = screw_map<T>(tangent_series<T>(x), part);
    carry = screw_map<T>(exp_series<T>(x), opposite(part));
    P1 = sum(carry, scaled(product(tangent, blockwise_transposed(inverse)), -xi));
    P2 = scaled(product(tangent, inverse), xi);
  }
  /// Rate (−Ω × U, 0) of the twist of a node with constant ṙ and Ω.
  static ScrewVector<T> node_rate(ScrewVector<T> const& v) {
    return {cross(v.translation, v.rotation), detail::zeros<Vec<T, 3>>()};
  }
};

}  // namespace polybody
