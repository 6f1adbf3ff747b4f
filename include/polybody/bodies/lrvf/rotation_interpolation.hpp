#pragma once
/// \file
/// Rotation interpolation between the nodes of a beam element: the concepts of a policy of `Lrvf`, and the default
/// policy. Rotations of the nodes are unit quaternions. δθ₁, δθ₂ and all angular velocities are in the axes of the
/// rotating section.
/// Theory: Eqs. 2.64 to 2.67.

#include <polybody/kinematics/frame.hpp>

namespace polybody {

/// Section at which strains are evaluated, with its derivatives with respect to the rotations of the nodes.
template <StateScalar T>
struct StrainSection {
  Mat<T, 3, 3> R;     ///< axes of the section in world axes
  Vec<T, 3> turn;     ///< l K, the material curvature times the length of the element [rad]
  Mat<T, 3, 6> spin;  ///< P: δθ = P (δθ₁, δθ₂)
  Mat<T, 3, 6> bend;  ///< Q: δ(l K) = Q (δθ₁, δθ₂)
};

/// Derivatives of products with the maps P and Q of a `StrainSection` with respect to (δθ₁, δθ₂), for fixed t, m, w.
struct StrainGradient {
  Mat<double, 6, 6> pulled;  ///< derivative of Pᵀ t + Qᵀ m
  Mat<double, 3, 6> spin;    ///< derivative of P w
  Mat<double, 3, 6> bend;    ///< derivative of Q w
};

/// Any section of an element, with the map of its angular velocity. The class `Section` of a policy adds intermediate
/// results that several functions of the policy use.
template <StateScalar T>
struct SectionMotion {
  Mat<T, 3, 3> R;     ///< axes of the section in world axes
  Mat<T, 3, 6> spin;  ///< P: Ω = P (Ω₁, Ω₂)
};

/// Rotation field along a bar, at one of its sections.
struct SectionTurn {
  Mat3 R;   ///< axes of the section in world axes
  Vec3 K;   ///< material curvature, R′ = R K̃ [1/m]
  Vec3 dK;  ///< K′ [1/m²]
};

namespace detail {

/// Product P x of a map P of both nodes (3×6) and a vector x (6).
template <class T>
Vec<T, 3> of_nodes(Mat<T, 3, 6> const& map, Vec<T, 6> const& x) {
  Vec<T, 3> out;
  for (int i = 0; i < 3; ++i) {
    out[i] = map(i, 0) * x[0];
    for (int j = 1; j < 6; ++j) out[i] += map(i, j) * x[j];
  }
  return out;
}
/// Sets `out` to the matrix [A; B].
template <class T>
void set_rows(Mat<T, 3, 6> const& a, Mat<T, 3, 6> const& b, Mat<T, 6, 6>& out) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 6; ++j) {
      out(i, j) = a(i, j);
      out(3 + i, j) = b(i, j);
    }
}
/// Vector x₁ or x₂ of (x₁, x₂).
template <class T>
Vec<T, 3> of_node(int node, Vec<T, 6> const& x) {
  return {x[3 * node], x[3 * node + 1], x[3 * node + 2]};
}

}  // namespace detail

/// Section in the middle of an element. It is stored, because the nodes do not determine it.
template <StateScalar T>
struct CarriedSectionState {
  Quaternion<T> axes;  ///< rotation from the axes of the section to world axes
  Vec<T, 3> turn;      ///< l K [rad]
};

/// Policy for which the nodes determine every section of their element.
template <class I>
concept NodalInterpolation =
    requires(I const i, Quaternion<double> const a, Vec6 const w, Vec3 const x, StrainSection<double> strained,
             StrainGradient gradient, typename I::template Section<double> section) {
      i.template middle<double>(a, a, strained);   // ξ = ½
      i.gradient(a, a, x, x, w, gradient);         // derivatives (`StrainGradient`) for the middle section
      i.template at<double>(0.2, a, a, strained);  // at any ξ: for quadratures with more points
      i.template section<double>(0.5, a, a, section);
      { i.turn(0.5, 1.0, a, a) } -> std::same_as<SectionTurn>;
    };

/// Policy for which the section in the middle depends on the path of the nodes. This section is part of the coordinates
/// of each element, and no other section is available.
template <class I>
concept PathDependentInterpolation =
    requires(I const i, CarriedSectionState<double> const s, Quaternion<double> const a, Vec6 const w, Vec3 const x,
             StrainSection<double> strained, StrainGradient gradient, typename I::template Section<double> section) {
      { i.between(a, a) } -> std::same_as<CarriedSectionState<double>>;  // in the reference configuration
      {
        i.template plus<double>(s, x, x)
      } -> std::same_as<CarriedSectionState<double>>;  // increment by δ₁, δ₂ of q ⊞ δ
      i.template middle<double>(s, strained);
      i.gradient(s, x, w, gradient);  // derivatives for fixed m and w; P is constant
      i.template section<double>(s, section);
      i.require_known(0.5, 0.65);  // for a marker at ξ, at distance s along the bar
    };

/// Policy of `Lrvf` for the rotations of the sections within an element.
template <class I>
concept RotationInterpolation =
    (NodalInterpolation<I> || PathDependentInterpolation<I>) && std::constructible_from<I, Placement> &&
    requires(I const i, Vec6 const w, Vec3 const x, typename I::template Section<double> section,
             Mat<double, 6, 6> pulled) {
      requires std::derived_from<typename I::template Section<double>, SectionMotion<double>>;
      { i.template bias<double>(section, w) } -> std::same_as<Vec3>;  // Ω˙ for Ω₁˙ = Ω₂˙ = 0 [rad/s²]
      i.spin_gradient(section, x, pulled);                            // derivative of Pᵀ x, for a fixed x
      { I::objective } -> std::convertible_to<bool>;  // rigid motions of both nodes move the element rigidly
    };

/// Policy whose rotations are functions of the relative rotation of the nodes, R₁ exp(ξφ), as required for
/// energy-conserving steps.
template <class I>
concept SecantInterpolation = requires { requires I::secants; };

/// Rotation with constant curvature on the shortest path from node to node, R(ξ) = R₁ exp(ξ φ), φ = log(R₁ᵀR₂)
/// [Crisfield & Jelenić 1999]. A rigid motion of the nodes moves the whole element rigidly, and the strains do not
/// change. The relative rotation of the nodes of an element must be less than π. The rotation of the whole body is not
/// limited.
///
/// At ξ = ½, with c = tan(|φ|/4) n, n = φ/|φ| (Wiener–Milenković), and a, m of `ArctanSeries`:
///   δθ = ½ (δθ₁ + δθ₂) + ½ c × (δθ₂ − δθ₁),
///   δφ = Jr⁻¹(φ) δθ₂ − Jr⁻¹(−φ) δθ₁,  Jr⁻¹(±φ) = 1 ± 2a c̃ + h c̃²,  h = a + m,
///   δc = G δθ₂ − Gᵀ δθ₁,  G = ¼ ((1 − c²) 1 + 2 c̃ + 2 c cᵀ).
class RelativeRotation {
 public:
  static constexpr bool objective = true;
  static constexpr bool secants = true;           ///< supports energy-conserving steps
  explicit RelativeRotation(Placement const&) {}  ///< the placement has no influence

  /// Section in a state, with intermediate results for its derivatives.
  template <StateScalar T>
  struct Section : SectionMotion<T> {
    double xi;                               ///< ξ ∈ [0, 1]
    Vec<T, 3> phi, part;                     ///< φ, ξφ
    Mat<T, 3, 3> turned, jacobian, inverse;  ///< exp(ξφ), Jr(ξφ), Jr⁻¹(φ)
  };

  /// Section in the middle between nodes with the rotations a and b, in closed form.
  template <StateScalar T>
  void middle(Quaternion<T> const& a, Quaternion<T> const& b, StrainSection<T>& out) const {
    Vec<T, 3> const c = quarter<T>(a, b);
    T const z = squared_norm(c);
    ArctanSeries<T> const s(z);
    T const part = 2.0 / (1.0 + z);
    out.R = product(rotation_matrix<T>(a), one_and_skew<T>(c, part, part));  // exp(φ/2) = 1 + 2 (c̃ + c̃²)/(1 + c²)
    Mat<T, 3, 3> const x = skew(c);
    T const odd = 2.0 * s.a, h = s.a + s.m;
    for (int j = 0; j < 3; ++j) {
      out.turn[j] = c[j] * (4.0 * s.a);
      for (int i = 0; i < 3; ++i) {
        double const one = i == j ? 1.0 : 0.0;
        T const even = one + h * (c[i] * c[j] - one * z);
        out.spin(i, j) = 0.5 * (one - x(i, j));
        out.spin(i, 3 + j) = 0.5 * (one + x(i, j));
        out.bend(i, j) = odd * x(i, j) - even;
        out.bend(i, 3 + j) = odd * x(i, j) + even;
      }
    }
  }

  /// Derivatives of Pᵀt + Qᵀm, P w and Q w (`StrainSection`) at ξ = ½ with respect to the rotations of the nodes, in
  /// closed form. t = l N × Γ, m = M (3), w = (Ω₁, Ω₂).
  template <class T>  // compiled only if used
  void gradient(Quaternion<T> const& a, Quaternion<T> const& b, Vec<T, 3> const& t, Vec<T, 3> const& m,
                Vec<T, 6> const& w, StrainGradient& out) const {
    Vec<T, 3> const c = quarter<T>(a, b), w1 = detail::of_node(0, w), w2 = detail::of_node(1, w);
    T const z = squared_norm(c);
    ArctanSeries<T> const s(z);
    Vec<T, 3> const sum(w1[0] + w2[0], w1[1] + w2[1], w1[2] + w2[2]), apart = difference(w2, w1);
    Mat<T, 3, 3> const x = skew(c), of_t = skew(t), of_apart = skew(apart);
    Mat<T, 3, 3> const even = even_slope(s, c, m), odd = odd_slope(s, c, m);
    Mat<T, 3, 3> const even_w = even_slope(s, c, apart), odd_w = odd_slope(s, c, sum);
    Mat<T, 3, 6> by_nodes;                      // ∂c
    Mat<T, 3, 3> pulled1, pulled2, spin, bend;  // derivatives with respect to c
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) {
        T const symmetric = 0.5 * c[i] * c[j] + (i == j ? 0.25 * (1.0 - z) : 0.0);
        by_nodes(i, j) = 0.5 * x(i, j) - symmetric;
        by_nodes(i, 3 + j) = 0.5 * x(i, j) + symmetric;
        T const half = 0.5 * of_t(i, j) + even(i, j);
        pulled1(i, j) = -(half + odd(i, j));
        pulled2(i, j) = half - odd(i, j);
        spin(i, j) = -0.5 * of_apart(i, j);
        bend(i, j) = odd_w(i, j) + even_w(i, j);
      }
    out.spin = product(spin, by_nodes);
    out.bend = product(bend, by_nodes);
    Mat<T, 3, 6> const first = product(pulled1, by_nodes), second = product(pulled2, by_nodes);
    detail::set_rows(first, second, out.pulled);
  }

  /// Section at ξ with R = R₁ exp(ξφ) and Ω = exp(−ξφ) Ω₁ + ξ Jr(ξφ) φ˙, where Jr(φ) φ˙ = Ω₂ − exp(−φ) Ω₁.
  template <StateScalar T>
  void section(double xi, Quaternion<T> const& a, Quaternion<T> const& b, Section<T>& out) const {
    out.xi = xi;
    out.phi = quaternion_minus<T>(b, a);
    out.part = scaled<T>(out.phi, xi);
    out.turned = exp_so3<T>(out.part);
    out.jacobian = right_jacobian<T>(out.part);
    out.inverse = right_jacobian_inverse<T>(out.phi);
    Mat<T, 3, 3> const first = product(out.jacobian, transposed(out.inverse)),
                       second = product(out.jacobian, out.inverse);
    out.R = product(rotation_matrix<T>(a), out.turned);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        out.spin(i, j) = out.turned(j, i) - first(i, j) * xi;
        out.spin(i, 3 + j) = second(i, j) * xi;
      }
  }
  /// Time derivative of Ω for constant w = (Ω₁, Ω₂), from the time derivatives of the equations for Ω and φ˙
  /// (`section`).
  template <StateScalar T>
  Vec<T, 3> bias(Section<T> const& s, Vec<T, 6> const& w) const {
    Vec<T, 3> const w1 = detail::of_node(0, w), w2 = detail::of_node(1, w);
    Vec<T, 3> const rate = difference<T>(product(s.inverse, w2), transposed_product(s.inverse, w1));
    Vec<T, 3> const carried = transposed_product(exp_so3<T>(s.phi), w1);
    Vec<T, 3> const turning = product(right_jacobian_derivative<T>(s.phi, rate), rate);
    Vec<T, 3> const second = product(s.jacobian, product(s.inverse, difference(cross(w2, carried), turning)));
    Vec<T, 3> const by_part = product(right_jacobian_derivative<T>(s.part, rate), rate);
    Vec<T, 3> const relative = cross(transposed_product(s.turned, w1), product(s.jacobian, rate));
    Vec<T, 3> out;
    for (int i = 0; i < 3; ++i) out[i] = (relative[i] + second[i]) * s.xi + by_part[i] * (s.xi * s.xi);
    return out;
  }
  /// Derivative of Pᵀx = [exp(ξφ) x − Jr⁻¹(φ) y; Jr⁻¹(−φ) y],  y = ξ Jr(−ξφ) x. With D(φ, x) = ∂(Jr(φ) x)/∂φ the
  /// derivatives with respect to φ are
  ///   ∂y = −ξ² D(−ξφ, x),  ∂(Jr⁻¹(±φ) y) = Jr⁻¹(±φ) (∂y ∓ D(±φ, Jr⁻¹(±φ) y)),  ∂(exp(ξφ) x) = −ξ exp(ξφ) x̃ Jr(ξφ).
  template <class T>  // compiled only if used
  void spin_gradient(Section<T> const& s, Vec<T, 3> const& x, Mat<T, 6, 6>& out) const {
    Mat<T, 3, 3> const& inverse = s.inverse;
    double const xi = s.xi;
    Vec<T, 3> const back = scaled<T>(s.phi, -1.0), part_back = scaled<T>(s.phi, -xi);
    Mat<T, 3, 3> const turning = product(s.turned, skew_product(x, s.jacobian));
    Vec<T, 3> const y = scaled<T>(transposed_product(s.jacobian, x), xi);
    Mat<T, 3, 3> const by_y = right_jacobian_derivative<T>(part_back, x);
    Mat<T, 3, 3> const by_first = right_jacobian_derivative<T>(s.phi, product(inverse, y));
    Mat<T, 3, 3> const by_second = right_jacobian_derivative<T>(back, transposed_product(inverse, y));
    Mat<T, 3, 3> of_first, of_second;
    Mat<T, 3, 6> by_nodes;  // ∂φ = Jr⁻¹(φ) δθ₂ − Jr⁻¹(−φ) δθ₁
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        of_first(i, j) = by_y(i, j) * (xi * xi) + by_first(i, j);
        of_second(i, j) = by_second(i, j) - by_y(i, j) * (xi * xi);
        by_nodes(i, j) = -inverse(j, i);
        by_nodes(i, 3 + j) = inverse(i, j);
      }
    Mat<T, 3, 3> first = product(inverse, of_first);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) first(i, j) -= turning(i, j) * xi;
    detail::set_rows(product(first, by_nodes), product(transposed_product(inverse, of_second), by_nodes), out);
  }

  /// Section at ξ, with l K = φ in every section and δφ = Jr⁻¹(φ) δθ₂ − Jr⁻¹(−φ) δθ₁.
  template <StateScalar T>
  void at(double xi, Quaternion<T> const& a, Quaternion<T> const& b, StrainSection<T>& out) const {
    Section<T> s;
    section<T>(xi, a, b, s);
    out.R = s.R;
    out.turn = s.phi;
    out.spin = s.spin;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        out.bend(i, j) = -s.inverse(j, i);
        out.bend(i, 3 + j) = s.inverse(i, j);
      }
  }

  /// Rotation R with K = φ/l and K′ = 0 at ξ of an element of length l [m].
  template <class T>  // compiled only if used
  SectionTurn turn(double xi, double l, Quaternion<T> const& a, Quaternion<T> const& b) const {
    Vec<T, 3> const phi = quaternion_minus<T>(b, a);
    return {product(rotation_matrix<T>(a), exp_so3<T>(scaled<T>(phi, xi))), scaled<T>(phi, 1.0 / l),
            detail::zeros<Vec<T, 3>>()};
  }

 private:
  /// Vector tan(|φ|/4) n of the shorter path from a to b.
  template <StateScalar T>
  static Vec<T, 3> quarter(Quaternion<T> const& a, Quaternion<T> const& b) {
    Quaternion<T> const p = quaternion_product<T>(conjugate<T>(a), b);
    T const way = value_of(p[0]) < 0.0 ? T(p[0] - 1.0) : T(p[0] + 1.0);
    return {p[1] / way, p[2] / way, p[3] / way};
  }
  /// Derivative with respect to c of 2a c × y (`odd_slope`), and of h c × (c × y) (`even_slope`).
  template <class T>
  static Mat<T, 3, 3> odd_slope(ArctanSeries<T> const& s, Vec<T, 3> const& c, Vec<T, 3> const& y) {
    Vec<T, 3> const once = cross(c, y);
    Mat<T, 3, 3> m = skew(y);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) m(i, j) = 4.0 * s.da * once[i] * c[j] - 2.0 * s.a * m(i, j);
    return m;
  }
  template <class T>
  static Mat<T, 3, 3> even_slope(ArctanSeries<T> const& s, Vec<T, 3> const& c, Vec<T, 3> const& y) {
    Vec<T, 3> const once = cross(c, y), twice = cross(c, once);
    Mat<T, 3, 3> const of_once = skew(once), both = skew_of_skew(c, y);
    Mat<T, 3, 3> m;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        m(i, j) = 2.0 * (s.da + s.dm) * twice[i] * c[j] - (s.a + s.m) * (of_once(i, j) + both(i, j));
    return m;
  }
};

}  // namespace polybody
