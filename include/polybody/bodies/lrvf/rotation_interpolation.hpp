#pragma once
/// \file
/// How the rotation of a section goes from one node of a beam element to the other: the policies of `Lrvf`. Rotations
/// of the nodes are unit quaternions; δθ₁, δθ₂ and all angular velocities are in the axes of the section that turns.

#include <numbers>

#include <polybody/kinematics/frame.hpp>

namespace polybody {

/// The section in the middle of an element, and how it follows the nodes.
template <StateScalar T>
struct MiddleSection {
  Mat<T, 3, 3> R;     ///< its axes in world axes
  Vec<T, 3> turn;     ///< l K, the material curvature times the element's length [rad]
  Mat<T, 3, 6> spin;  ///< P: δθ = P (δθ₁, δθ₂)
  Mat<T, 3, 6> bend;  ///< Q: δ(l K) = Q (δθ₁, δθ₂)
};

/// Derivatives of a middle section's maps by (δθ₁, δθ₂), for fixed t, m, w.
struct MiddleGradient {
  Mat<double, 6, 6> pulled;  ///< of Pᵀ t + Qᵀ m
  Mat<double, 3, 6> spin;    ///< of P w
  Mat<double, 3, 6> bend;    ///< of Q w
};

/// Any section of an element in motion.
template <StateScalar T>
struct SectionMotion {
  Mat<T, 3, 3> R;     ///< its axes in world axes
  Mat<T, 3, 6> spin;  ///< P: Ω = P (Ω₁, Ω₂)
  Vec<T, 3> bias;     ///< Ω˙ for Ω₁˙ = Ω₂˙ = 0 [rad/s²]
};

/// A rotation field along a bar, at one of its sections.
struct SectionTurn {
  Mat3 R;   ///< axes of the section in world axes
  Vec3 K;   ///< material curvature, R′ = R K̃ [1/m]
  Vec3 dK;  ///< K′ [1/m²]
};

namespace detail {

/// q ⊞ δ for a small δ, whose three components are the variables number `first` and on.
template <int n>
Quaternion<Dual<n>> turning_quaternion(Quaternion<double> const& q, int first) {
  Quaternion<Dual<n>> out(q[0], q[1], q[2], q[3]);
  for (int i = 0; i < 3; ++i) {
    Quaternion<double> half = Quaternion<double>::Zero();
    half[i + 1] = 0.5;
    Quaternion<double> const slope = quaternion_product<double>(q, half);
    for (int k = 0; k < 4; ++k) out[k].d[first + i] = slope[k];
  }
  return out;
}

/// Without motion there is no bias, and as it is quadratic in w, no slope of it.
template <StateScalar T>
bool at_rest(Vec<T, 6> const& w) {
  for (int i = 0; i < 6; ++i)
    if (value_of(w[i]) != 0.0) return false;
  return true;
}

}  // namespace detail

template <class I>
concept RotationInterpolation =
    std::constructible_from<I, Placement> &&
    requires(I const i, Quaternion<double> const a, Vec6 const w, Vec3 const x, MiddleSection<double> middle,
             MiddleGradient gradient, SectionMotion<double> section) {
      i.template middle<double>(a, a, middle);
      i.gradient(a, a, x, x, w, gradient);
      i.template section<double>(0.5, a, a, w, section);
      { i.turn(0.5, 1.0, a, a) } -> std::same_as<SectionTurn>;
      { I::objective } -> std::convertible_to<bool>;  // rigid motions of both nodes carry the whole element
    };

/// The shortest rotation from node to node at constant curvature, R(ξ) = R₁ exp(ξ φ), φ = log(R₁ᵀR₂): a rigid motion of
/// the nodes carries the whole element, and strains do not feel it [Crisfield & Jelenić 1999]. An element must turn by
/// less than half a turn between its nodes; the body as a whole may turn as far as it likes.
///
/// In the middle everything is algebraic in c = tan(|φ|/4) n, n = φ/|φ|  (Wiener–Milenković):
///   δθ = ½ (δθ₁ + δθ₂) + ½ c × (δθ₂ − δθ₁),
///   δφ = Jr⁻¹(φ) δθ₂ − Jr⁻¹(−φ) δθ₁,  Jr⁻¹(±φ) = 1 ± 2a c̃ + h c̃²,  h = a + m  (`ArctanSeries`),
///   δc = G δθ₂ − Gᵀ δθ₁,  G = ¼ ((1 − c²) 1 + 2 c̃ + 2 c cᵀ).
class Objective {
 public:
  static constexpr bool objective = true;
  explicit Objective(Placement const&) {}

  template <StateScalar T>
  void middle(Quaternion<T> const& a, Quaternion<T> const& b, MiddleSection<T>& out) const {
    Vec<T, 3> const c = quarter<T>(a, b);
    T const z = c.squaredNorm();
    ArctanSeries<T> const s(z);
    Mat<T, 3, 3> const x = skew(c), xx = x * x;
    Mat<T, 3, 3> const half = Mat<T, 3, 3>::Identity() + (x + xx) * (2.0 / (1.0 + z));  // exp(φ/2)
    out.R = rotation_matrix<T>(a) * half;
    out.turn = c * (4.0 * s.a);
    T const h = s.a + s.m;
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) {
        double const one = i == j ? 1.0 : 0.0;
        T const odd = 2.0 * s.a * x(i, j), even = one + h * xx(i, j);
        out.spin(i, j) = 0.5 * (one - x(i, j));
        out.spin(i, 3 + j) = 0.5 * (one + x(i, j));
        out.bend(i, j) = odd - even;
        out.bend(i, 3 + j) = odd + even;
      }
  }

  template <class T>  // compiled where it is used
  void gradient(Quaternion<T> const& a, Quaternion<T> const& b, Vec<T, 3> const& t, Vec<T, 3> const& m,
                Vec<T, 6> const& w, MiddleGradient& out) const {
    using V3 = Vec<T, 3>;
    using M3 = Mat<T, 3, 3>;
    V3 const c = quarter<T>(a, b);
    T const z = c.squaredNorm();
    ArctanSeries<T> const s(z);
    M3 const x = skew<T>(c), outer = c * c.transpose();
    Mat<T, 3, 6> by_nodes;  // ∂c
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) {
        T const even = 0.5 * outer(i, j) + (i == j ? 0.25 * (1.0 - z) : 0.0);
        by_nodes(i, j) = 0.5 * x(i, j) - even;
        by_nodes(i, 3 + j) = 0.5 * x(i, j) + even;
      }
    // by c: of 2a c × y, and of h c × (c × y)
    auto const odd = [&](V3 const& y) -> M3 {
      return 4.0 * s.da * c.cross(y) * c.transpose() - 2.0 * s.a * skew<T>(y);
    };
    auto const even = [&](V3 const& y) -> M3 {
      V3 const once = c.cross(y);
      M3 const along = 2.0 * (s.da + s.dm) * c.cross(once) * c.transpose();
      return along - (s.a + s.m) * (skew<T>(once) + x * skew<T>(y));
    };
    V3 const sum = w.template head<3>() + w.template tail<3>(),
             difference = w.template tail<3>() - w.template head<3>();
    M3 const half = 0.5 * skew<T>(t) + even(m), other = odd(m);
    Mat<T, 6, 6>& pulled = out.pulled;
    pulled.template topRows<3>() = -(half + other) * by_nodes;
    pulled.template bottomRows<3>() = (half - other) * by_nodes;
    out.spin = -0.5 * skew<T>(difference) * by_nodes;
    out.bend = (odd(sum) + even(difference)) * by_nodes;
  }

  /// Ω = exp(−ξφ) Ω₁ + ξ Jr(ξφ) φ˙,  Jr(φ) φ˙ = Ω₂ − exp(−φ) Ω₁, and both once more by time.
  template <StateScalar T>
  void section(double xi, Quaternion<T> const& a, Quaternion<T> const& b, Vec<T, 6> const& w,
               SectionMotion<T>& out) const {
    Vec<T, 3> const phi = quaternion_minus<T>(b, a), part = phi * xi;
    Mat<T, 3, 3> const turned = exp_so3<T>(part), jacobian = right_jacobian<T>(part) * xi;
    Mat<T, 3, 3> const inverse = right_jacobian_inverse<T>(phi);
    out.R = rotation_matrix<T>(a) * turned;
    out.spin.template leftCols<3>() = turned.transpose() - jacobian * inverse.transpose();
    out.spin.template rightCols<3>() = jacobian * inverse;
    out.bias.setZero();
    if (detail::at_rest<T>(w)) return;
    Vec<T, 3> const w1 = w.template head<3>(), w2 = w.template tail<3>();
    Vec<T, 3> const rate = inverse * w2 - inverse.transpose() * w1, carried = exp_so3<T>(-phi) * w1;
    Vec<T, 3> const second = inverse * (w2.cross(carried) - right_jacobian_derivative<T>(phi, rate) * rate);
    Vec<T, 3> const own = jacobian * rate, first = turned.transpose() * w1;
    out.bias = first.cross(own) + right_jacobian_derivative<T>(part, rate) * rate * (xi * xi) + jacobian * second;
  }

  template <class T>  // compiled where it is used
  SectionTurn turn(double xi, double l, Quaternion<T> const& a, Quaternion<T> const& b) const {
    Vec<T, 3> const phi = quaternion_minus<T>(b, a);
    return {rotation_matrix<T>(a) * exp_so3<T>(xi * phi), phi / l, Vec<T, 3>::Zero()};
  }

 private:
  /// tan(|φ|/4) n of the shorter way from a to b.
  template <StateScalar T>
  static Vec<T, 3> quarter(Quaternion<T> const& a, Quaternion<T> const& b) {
    Quaternion<T> const p = quaternion_product<T>(conjugate<T>(a), b);
    T const way = value_of(p[0]) < 0.0 ? T(p[0] - 1.0) : T(p[0] + 1.0);
    return p.template tail<3>() / way;
  }
};

/// The rotation vectors Ψ of the nodes relative to the bar's placement R₀, interpolated linearly: R(ξ) = R₀ exp(Ψ(ξ)),
/// K = Jr(Ψ) Ψ′  [thesis §2.3–2.5]. For comparison; use `Objective`. Two faults, both measured in the tests:
/// - It is not objective. While an element turns by φ about one axis and is carried rigidly about another, its
/// curvature and
///   energy change by terms of the order of φ² (energy: 1 % of φ² after a carriage of 2 rad).
/// - Ψ₁ is the vector with |Ψ₁| ≤ π, and Ψ₂ the nearer of Ψ and its complement Ψ (1 − 2π/|Ψ|). As node 1 passes |Ψ₁| =
/// π both
///   change sheets, and the curvature jumps, by terms of the order of φ³/l, unless the element turns about Ψ itself.
class Direct {
 public:
  static constexpr bool objective = false;
  template <class = void>  // compiled where it is used
  explicit Direct(Placement const& placement) : from_(quaternion_of(placement.axes)), axes_(placement.axes) {}

  template <StateScalar T>
  void middle(Quaternion<T> const& a, Quaternion<T> const& b, MiddleSection<T>& out) const {
    Vec<T, 3> const first = vector<T>(a), second = vector<T>(b, first);
    Vec<T, 3> const psi = (first + second) * 0.5, difference = second - first;
    Mat<T, 3, 3> const jacobian = right_jacobian<T>(psi);
    Mat<T, 3, 3> const half = right_jacobian_derivative<T>(psi, difference) * 0.5;
    Mat<T, 3, 3> const inverse1 = right_jacobian_inverse<T>(first), inverse2 = right_jacobian_inverse<T>(second);
    out.R = axes_.cast<T>() * exp_so3<T>(psi);
    out.turn = jacobian * difference;
    out.spin.template leftCols<3>() = jacobian * inverse1 * 0.5;
    out.spin.template rightCols<3>() = jacobian * inverse2 * 0.5;
    out.bend.template leftCols<3>() = (half - jacobian) * inverse1;
    out.bend.template rightCols<3>() = (half + jacobian) * inverse2;
  }

  /// By dual numbers.
  template <class T, StateScalar D = Dual<6>>  // compiled where it is used
  void gradient(Quaternion<T> const& a, Quaternion<T> const& b, Vec<T, 3> const& t, Vec<T, 3> const& m,
                Vec<T, 6> const& w, MiddleGradient& out) const {
    MiddleSection<D> at;
    middle<D>(detail::turning_quaternion<6>(a, 0), detail::turning_quaternion<6>(b, 3), at);
    out.pulled.setZero();
    out.spin.setZero();
    out.bend.setZero();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 6; ++j)
        for (int k = 0; k < 6; ++k) {
          out.pulled(j, k) += t[i] * at.spin(i, j).d[k] + m[i] * at.bend(i, j).d[k];
          out.spin(i, k) += w[j] * at.spin(i, j).d[k];
          out.bend(i, k) += w[j] * at.bend(i, j).d[k];
        }
  }

  /// Ω = Jr(Ψ) Ψ˙,  Jr(Ψᵢ) Ψᵢ˙ = Ωᵢ, and both once more by time.
  template <StateScalar T>
  void section(double xi, Quaternion<T> const& a, Quaternion<T> const& b, Vec<T, 6> const& w,
               SectionMotion<T>& out) const {
    Vec<T, 3> const first = vector<T>(a), node[2] = {first, vector<T>(b, first)};
    double const share[2] = {1.0 - xi, xi};
    Vec<T, 3> const psi = node[0] * share[0] + node[1] * share[1];
    Mat<T, 3, 3> const jacobian = right_jacobian<T>(psi);
    Vec<T, 3> rate = Vec<T, 3>::Zero(), second = rate;
    out.R = axes_.cast<T>() * exp_so3<T>(psi);
    out.bias.setZero();
    bool const still = detail::at_rest<T>(w);
    for (int i = 0; i < 2; ++i) {
      Mat<T, 3, 3> const inverse = right_jacobian_inverse<T>(node[i]);
      out.spin.template middleCols<3>(3 * i) = jacobian * inverse * share[i];
      if (still) continue;
      Vec<T, 3> const own = inverse * w.template segment<3>(3 * i);
      rate += own * share[i];
      second -= inverse * (right_jacobian_derivative<T>(node[i], own) * own) * share[i];
    }
    if (still) return;
    out.bias = right_jacobian_derivative<T>(psi, rate) * rate + jacobian * second;
  }

  template <class T>  // compiled where it is used
  SectionTurn turn(double xi, double l, Quaternion<T> const& a, Quaternion<T> const& b) const {
    Vec<T, 3> const first = vector<T>(a), rate = (vector<T>(b, first) - first) / l, psi = first + xi * l * rate;
    return {axes_ * exp_so3<T>(psi), right_jacobian<T>(psi) * rate, right_jacobian_derivative<T>(psi, rate) * rate};
  }

 private:
  /// Ψ of a node's rotation, |Ψ| ≤ π.
  template <StateScalar T>
  Vec<T, 3> vector(Quaternion<T> const& q) const {
    return quaternion_log<T>(quaternion_product<T>(conjugate<double>(from_).cast<T>(), q));
  }
  /// Ψ or its complement, whichever is nearer to `other`: the complement if Ψ·other < |Ψ| (|Ψ| − π).
  template <StateScalar T>
  Vec<T, 3> vector(Quaternion<T> const& q, Vec<T, 3> const& other) const {
    using std::sqrt;
    Vec<T, 3> const psi = vector<T>(q);
    T const size2 = psi.squaredNorm();
    double const size = std::sqrt(value_of(size2)), pi = std::numbers::pi;
    if (!(value_of(T(psi.dot(other))) < size * (size - pi))) return psi;
    return psi * (1.0 - 2.0 * pi / sqrt(size2));
  }

  Quaternion<double> from_;
  Mat3 axes_;
};

}  // namespace polybody
