#pragma once
/// \file
/// Elastic element of `Se3Beam`: strain, force and tangent of two frames that a helicoidal line connects.
///
/// The motion from frame 1 to frame 2 has the logarithm d = (p, φ) = log(H₁⁻¹ H₂) [Borri & Bottasso 1994; Sonneville,
/// Cardona & Brüls 2014, §4]. With ρ = R₁ᵀ (r₂ − r₁), X = Jr⁻¹(φ), and Y, the derivative of X in the direction p:
///   φ = log(R₁ᵀ R₂),  p = Xᵀ ρ,  T⁻¹(d) = [X, Y; 0, X],
///   δφ = X δθ₂ − Xᵀ δθ₁,  δp = Xᵀ R₁ᵀ (δr₂ − δr₁) + Y δθ₂ − Yᵀ δθ₁.
/// Theory: Eqs. 2.107 to 2.113.

#include <polybody/bodies/shared/body.hpp>
#include <polybody/bodies/shared/rod_section.hpp>
#include <polybody/math/se3.hpp>

namespace polybody {

/// Section of an element of `Se3Beam`.
class HelicoidalSection : public RodSection {
 public:
  using RodSection::RodSection;

  double time(int i) const { return time_[i]; }              ///< damping time of strain i [s]
  double spring(int i) const { return stiffness_[i] / l_; }  ///< stiffness of strain i divided by l
  double pretension() const { return pretension_; }          ///< axial force in the reference configuration [N]
  /// Sum of the stiffness with the factor `ck` and of the damping with the factor `cd`, divided by l.
  Mat<double, 6, 6> slope(double ck, double cd) const { return matrix_sum(ck / l_, cd / l_); }
};

/// Velocities of the nodes of an element.
template <class T>
struct NodeVelocities {
  Vec<T, 3> apart;   ///< ṙ₂ − ṙ₁ in the axes of node 1 [m/s]
  Vec<T, 3> w1, w2;  ///< Ω₁, Ω₂ [rad/s]
};

/// Element between two frames in a state: relative motion d, the operator T⁻¹(d), and the section forces.
template <StateScalar T>
struct HelicoidalElement {
  Mat<T, 3, 3> R;            ///< R₁, axes of node 1 in world axes
  ScrewVector<T> d;          ///< d = log(H₁⁻¹ H₂) [m], [rad]
  OperatorSeries<T> series;  ///< coefficients of T⁻¹(d)
  ScrewMap<T> inverse;       ///< T⁻¹(d)
  Vec<T, 3> n, m;            ///< N and M, set by `set_forces` [N], [N m]

  /// Element of the nodes at `first` and `first + 7` of q.
  HelicoidalElement(std::span<T const> q, Index first) {
    Quaternion<T> const a = entries<4>(q, first + 3), b = entries<4>(q, first + 10);
    set_rotation<T>(a, R);
    Vec<T, 3> const chord = transposed_product<T>(R, difference<T>(entries<3>(q, first + 7), entries<3>(q, first)));
    d.rotation = quaternion_minus<T>(b, a);
    series = tangent_inverse_series<T>(squared_norm(d.rotation));
    inverse.diagonal = one_and_skew<T>(d.rotation, series.f, series.g);
    d.translation = transposed_product<T>(inverse.diagonal, chord);
    inverse.coupling = map_slope<T>(series, d.rotation, d.translation);
  }

  /// Velocities of the nodes with the first generalised velocity `first` of v.
  NodeVelocities<T> velocities(std::span<T const> v, Index first) const {
    return {transposed_product<T>(R, difference<T>(entries<3>(v, first + 6), entries<3>(v, first))),
            entries<3>(v, first + 3), entries<3>(v, first + 9)};
  }
  /// Rate ḋ = (Xᵀ u + Y Ω₂ − Yᵀ Ω₁, X Ω₂ − Xᵀ Ω₁), u = R₁ᵀ (ṙ₂ − ṙ₁).
  ScrewVector<T> rate(NodeVelocities<T> const& v) const {
    Vec<T, 3> const p = transposed_product<T>(inverse.diagonal, v.apart), y2 = product(inverse.coupling, v.w2),
                    y1 = transposed_product<T>(inverse.coupling, v.w1);
    ScrewVector<T> out{p,
                       difference<T>(product(inverse.diagonal, v.w2), transposed_product<T>(inverse.diagonal, v.w1))};
    for (int i = 0; i < 3; ++i) out.translation[i] += y2[i] - y1[i];
    return out;
  }
  /// Section forces C (d − d₀ + τ ḋ)/l, and the pretension. `free` is d₀.
  void set_forces(HelicoidalSection const& section, ScrewVector<double> const& free, NodeVelocities<T> const& v) {
    ScrewVector<T> const rates =
        section.damped() ? rate(v) : ScrewVector<T>{detail::zeros<Vec<T, 3>>(), detail::zeros<Vec<T, 3>>()};
    if (section.coupled()) {
      ScrewVector<T> strains = scaled(d, 1.0 / section.length());
      for (int i = 0; i < 3; ++i) {
        strains.translation[i] -= free.translation[i] / section.length();
        strains.rotation[i] -= free.rotation[i] / section.length();
      }
      section.stress(strains, scaled(rates, 1.0 / section.length()), n, m);
      return;
    }
    for (int i = 0; i < 3; ++i) {
      n[i] = d.translation[i] - free.translation[i];
      m[i] = d.rotation[i] - free.rotation[i];
      if (section.damped()) {
        n[i] += rates.translation[i] * section.time(i);
        m[i] += rates.rotation[i] * section.time(3 + i);
      }
      n[i] *= section.spring(i);
      m[i] *= section.spring(3 + i);
    }
    n[0] += section.pretension();
  }

  /// Generalised force −∂(N·δp + M·δφ) of the nodes:
  ///   f_r₁ = −f_r₂ = R₁ X N,  f_θ₁ = Y N + X M,  f_θ₂ = −(Yᵀ N + Xᵀ M).
  void force(Vec<T, 12>& out) const {
    Vec<T, 3> const pull = product(R, product(inverse.diagonal, n)), y1 = product(inverse.coupling, n),
                    x1 = product(inverse.diagonal, m), y2 = transposed_product<T>(inverse.coupling, n),
                    x2 = transposed_product<T>(inverse.diagonal, m);
    for (int i = 0; i < 3; ++i) {
      out[i] = pull[i];
      out[6 + i] = -pull[i];
      out[3 + i] = y1[i] + x1[i];
      out[9 + i] = -(y2[i] + x2[i]);
    }
  }

  /// Tangent ck (−∂f/∂δ) + cd (−∂f/∂v), with δ of q ⊞ δ. The columns of B are δr₂ − δr₁, δθ₁, δθ₂; δd = B δ. With
  /// D(d, y) = ∂(T⁻¹(d) y)/∂d (`se3_tangent_inverse_derivative`), the tangent is the sum of
  ///   Bᵀ ∂n,  δn = C/l ((ck + cd τ) δd + ck τ δḋ),
  /// and of the terms of the change of B:
  ///   −δf_r₂ = R₁ (δθ₁ × X N + D₀(φ, N) δφ),
  ///   −δf_θ₁ = −(D₀(φ, N) δp + D₁ δφ),  −δf_θ₂ = −(D₀(−φ, N) δp + D₁(−d) δφ),
  /// where [D₀, D₁; 0, D₀] is D(d, y) of the screw y = (M, N). Because T⁻¹(d) y − T⁻¹(−d) y = [d, y], the operators at
  /// −d are D(−d, y) = −D(d, y) − [y, ·].
  void tangent(HelicoidalSection const& section, NodeVelocities<T> const& v, double ck, double cd,
               Mat<T, 12, 12>& k) const {
    Mat<T, 3, 3> const pull = product(R, inverse.diagonal);  // R₁ X
    Mat<T, 6, 9> const b = nodal_map(pull);
    Mat<T, 9, 6> left;  // Bᵀ ∂n/∂d, and the change of B
    bool const damped = section.damped() && ck != 0.0, coupled = section.coupled();
    Mat<T, 6, 3> swept;  // part of ∂(N, M)/∂θ₁ at constant d; of ∂N/∂θ₁ only, unless the section is coupled
    if (coupled) {
      left = coupled_factors(section, v, ck, cd, b, swept);
    } else {
      for (int i = 0; i < 6; ++i) {
        T const full(section.spring(i) * (ck + cd * section.time(i)));
        for (int r = 0; r < 9; ++r) left(r, i) = b(i, r) * full;
      }
      if (damped) add_damping(section, v, ck, b, left, swept);
    }
    add_geometric(ck, left);
    Mat<T, 3, 3> const carried = skew_product<T>(product(pull, n), R);
    for (int c = 0; c < 9; ++c) {
      Vec<T, 9> column;
      for (int r = 0; r < 9; ++r) {
        column[r] = left(r, 0) * b(0, c) + left(r, 1) * b(1, c) + left(r, 2) * b(2, c);
        if (c >= 3) column[r] += left(r, 3) * b(3, c) + left(r, 4) * b(4, c) + left(r, 5) * b(5, c);
      }
      if (c >= 3 && c < 6) {
        if (damped)
          for (int r = 0; r < 9; ++r)
            column[r] += b(0, r) * swept(0, c - 3) + b(1, r) * swept(1, c - 3) + b(2, r) * swept(2, c - 3);
        if (damped && coupled)
          for (int r = 3; r < 9; ++r)
            column[r] += b(3, r) * swept(3, c - 3) + b(4, r) * swept(4, c - 3) + b(5, r) * swept(5, c - 3);
        for (int r = 0; r < 3; ++r) column[r] -= ck * carried(r, c - 3);
      }
      int const to = c < 6 ? c : c + 3;
      for (int r = 0; r < 3; ++r) {
        k(r, to) = c < 3 ? column[r] : -column[r];
        k(6 + r, to) = c < 3 ? -column[r] : column[r];
        k(3 + r, to) = c < 3 ? -column[3 + r] : column[3 + r];
        k(9 + r, to) = c < 3 ? -column[6 + r] : column[6 + r];
      }
    }
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 12; ++r) k(r, 6 + c) = -k(r, c);
  }

 private:
  /// B (6×9) of δd = B (δr₂ − δr₁, δθ₁, δθ₂), with `pull` = R₁ X.
  Mat<T, 6, 9> nodal_map(Mat<T, 3, 3> const& pull) const {
    Mat<T, 6, 9> b;
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) {
        b(i, j) = pull(j, i);
        b(i, 3 + j) = -inverse.coupling(j, i);
        b(i, 6 + j) = inverse.coupling(i, j);
        b(3 + i, j) = T(0.0);
        b(3 + i, 3 + j) = -inverse.diagonal(j, i);
        b(3 + i, 6 + j) = inverse.diagonal(i, j);
      }
    return b;
  }
  /// Adds the factors of δd in the change of B to `left` (9×6).
  void add_geometric(double ck, Mat<T, 9, 6>& left) const {
    ScrewMap<T> const at = screw_map_derivative<T>(series, d, {m, n});
    Mat<T, 3, 3> const turned = product(R, at.diagonal), of_n = skew<T>(n), of_m = skew<T>(m);
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) {
        left(i, 3 + j) += ck * turned(i, j);
        left(3 + i, j) -= ck * at.diagonal(i, j);
        left(3 + i, 3 + j) -= ck * at.coupling(i, j);
        left(6 + i, j) += ck * (at.diagonal(i, j) + of_n(i, j));
        left(6 + i, 3 + j) += ck * (at.coupling(i, j) + of_m(i, j));
      }
  }
  /// Adds Bᵀ ck C/l τ ∂ḋ/∂d to `left`, and sets `swept` to ck C_Γ/l τ Xᵀ ũ. With u = R₁ᵀ(ṙ₂ − ṙ₁):
  ///   δḋ = (Xᵀ (u × δθ₁), 0) + (D(d, (u, Ω₂ − Ω₁)) − [(−u, Ω₁), ·]) δd.
  void add_damping(HelicoidalSection const& section, NodeVelocities<T> const& v, double ck, Mat<T, 6, 9> const& b,
                   Mat<T, 9, 6>& left, Mat<T, 6, 3>& swept) const {
    ScrewMap<T> const at = screw_map_derivative<T>(series, d, {v.apart, difference<T>(v.w2, v.w1)});
    Mat<T, 3, 3> const of_u = skew<T>(v.apart), of_w = skew<T>(v.w1);
    Mat<T, 3, 3> of_p, of_phi, coupling;
    Mat<T, 3, 3> const turned = transposed_product<T>(inverse.diagonal, of_u);
    for (int i = 0; i < 3; ++i) {
      double const pull = ck * section.spring(i) * section.time(i),
                   bend = ck * section.spring(3 + i) * section.time(3 + i);
      for (int j = 0; j < 3; ++j) {
        T const same = at.diagonal(i, j) - of_w(i, j);
        of_p(i, j) = pull * same;
        of_phi(i, j) = bend * same;
        coupling(i, j) = pull * (at.coupling(i, j) + of_u(i, j));
        swept(i, j) = pull * turned(i, j);
      }
    }
    for (int j = 0; j < 3; ++j)
      for (int r = 0; r < 9; ++r) {
        left(r, j) += b(0, r) * of_p(0, j) + b(1, r) * of_p(1, j) + b(2, r) * of_p(2, j);
        T sum = b(0, r) * coupling(0, j) + b(1, r) * coupling(1, j) + b(2, r) * coupling(2, j);
        if (r >= 3) sum += b(3, r) * of_phi(0, j) + b(4, r) * of_phi(1, j) + b(5, r) * of_phi(2, j);
        left(r, 3 + j) += sum;
      }
  }
  /// Bᵀ (S + ck D ∂ḋ/∂d) with S = ck C + cd D, for matrices C and D divided by l. Sets `swept` to ck D (Xᵀ ũ, 0).
  Mat<T, 9, 6> coupled_factors(HelicoidalSection const& section, NodeVelocities<T> const& v, double ck, double cd,
                               Mat<T, 6, 9> const& b, Mat<T, 6, 3>& swept) const {
    Mat<T, 6, 6> slope = section.slope(ck, cd);
    if (section.damped()) {
      Mat<double, 6, 6> const damper = section.slope(0.0, ck);
      ScrewMap<T> const at = screw_map_derivative<T>(series, d, {v.apart, difference<T>(v.w2, v.w1)});
      Mat<T, 3, 3> const of_u = skew<T>(v.apart), of_w = skew<T>(v.w1),
                         turned = transposed_product<T>(inverse.diagonal, of_u);
      Mat<T, 6, 6> rate = detail::zeros<Mat<T, 6, 6>>();
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          rate(i, j) = rate(3 + i, 3 + j) = at.diagonal(i, j) - of_w(i, j);
          rate(i, 3 + j) = at.coupling(i, j) + of_u(i, j);
        }
      Mat<T, 6, 6> const more = detail::small_product(damper, rate);
      for (int i = 0; i < 36; ++i) slope.data()[i] += more.data()[i];
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 6; ++i) {
          swept(i, j) = T(0.0);
          for (int k = 0; k < 3; ++k) swept(i, j) += damper(i, k) * turned(k, j);
        }
    }
    Mat<T, 9, 6> left;
    for (int i = 0; i < 6; ++i)
      for (int r = 0; r < 9; ++r) {
        left(r, i) = T(0.0);
        for (int k = 0; k < 6; ++k) left(r, i) += b(k, r) * slope(k, i);
      }
    return left;
  }
};

}  // namespace polybody
