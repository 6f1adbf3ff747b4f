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

/// Section of an element of `Se3Beam` of length l. The strains are those of the line of the centres of mass.
class HelicoidalSection : public RodSection {
 public:
  template <class T = double>  // compiled only if used
  HelicoidalSection(detail::CentredSection const& section, T l, double pretension)
      : RodSection(section, l, pretension), centre_(section.centre) {
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 6; ++i) {
        springs_(i, j) = section.stiffness(i, j) / l;
        dampers_(i, j) = section.damping(i, j) / l;
        coupled_ = coupled_ || (i != j && (springs_(i, j) != 0.0 || dampers_(i, j) != 0.0));
      }
    preload_ = Vec6(Vec6::Zero());
    preload_[0] = pretension;
    preload_[4] = -centre_[2] * pretension;  // −c × N
    preload_[5] = centre_[1] * pretension;
    coupled_ = coupled_ || centre_[1] != 0.0 || centre_[2] != 0.0;
  }

  double time(int i) const { return time_[i]; }                  ///< damping time of strain i [s]
  double spring(int i) const { return stiffness_[i] / l_; }      ///< stiffness of strain i divided by l
  double pretension() const { return pretension_; }              ///< axial force in the reference configuration [N]
  bool coupled() const { return coupled_; }                      ///< true if matrices couple the strains
  Mat<double, 6, 6> const& springs() const { return springs_; }  ///< stiffness divided by l
  Mat<double, 6, 6> const& dampers() const { return dampers_; }  ///< damping divided by l
  Vec6 const& preload() const { return preload_; }               ///< section forces in the reference configuration

  /// Strain energy per length [J/m].
  template <class T = double>  // compiled only if used
  T energy(Vec<T, 6> const& strains) const {
    if (!coupled_) return RodSection::energy<T>(strains);
    T sum = T(0.0);
    for (int i = 0; i < 6; ++i) {
      sum += preload_[i] * strains[i];
      for (int j = 0; j < 6; ++j) sum += 0.5 * l_ * strains[i] * springs_(i, j) * strains[j];
    }
    return sum;
  }
  /// Strains of the axis of the bar: Γ + c × K, K.
  template <class T = double>  // compiled only if used
  Vec<T, 6> axis_strains(Vec<T, 6> const& strains) const {
    return moved<T>(strains, 0, 3);
  }
  /// Section forces about the axis of the bar: N, M + c × N, without damping [N], [N m].
  template <class T = double>  // compiled only if used
  Vec<T, 6> axis_forces(Vec<T, 6> const& strains) const {
    if (!coupled_) return forces<T>(strains);
    Vec<T, 6> n;
    for (int i = 0; i < 6; ++i) {
      n[i] = preload_[i];
      for (int j = 0; j < 6; ++j) n[i] += l_ * springs_(i, j) * strains[j];
    }
    return moved<T>(n, 3, 0);
  }

 private:
  /// x with c × (part of x from entry `of`) added to the part from entry `to`.
  template <class T>
  Vec<T, 6> moved(Vec<T, 6> x, int to, int of) const {
    T const a = x[of], b = x[of + 1], c = x[of + 2];
    x[to] += centre_[1] * c - centre_[2] * b;
    x[to + 1] += centre_[2] * a;
    x[to + 2] -= centre_[1] * a;
    return x;
  }

  Vec3 centre_;                          ///< centre of mass in the section [m]
  Mat<double, 6, 6> springs_, dampers_;  ///< stiffness and damping divided by l
  Vec6 preload_;
  bool coupled_ = false;
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
      for (int r = 0; r < 6; ++r) {
        T sum = T(section.preload()[r]);
        for (int i = 0; i < 3; ++i)
          sum += section.springs()(r, i) * (d.translation[i] - free.translation[i]) +
                 section.springs()(r, 3 + i) * (d.rotation[i] - free.rotation[i]) +
                 section.dampers()(r, i) * rates.translation[i] + section.dampers()(r, 3 + i) * rates.rotation[i];
        (r < 3 ? n[r] : m[r - 3]) = sum;
      }
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

  /// Tangent ck (−∂f/∂δ) + cd (−∂f/∂v), with δ of q ⊞ δ. The columns of B are R₁ᵀ(δr₂ − δr₁), δθ₁, δθ₂; δd = B δ.
  /// With D(d, y) = ∂(T⁻¹(d) y)/∂d (`se3_tangent_inverse_derivative`), the tangent is the sum of
  ///   Bᵀ ∂n,  δn = C/l ((ck + cd τ) δd + ck τ δḋ),
  /// and of the terms of the change of B:
  ///   −δf_r₂ = R₁ (δθ₁ × X N + D₀(φ, N) δφ),
  ///   −δf_θ₁ = −(D₀(φ, N) δp + D₁ δφ),  −δf_θ₂ = −(D₀(−φ, N) δp + D₁(−d) δφ),
  /// where [D₀, D₁; 0, D₀] is D(d, y) of the screw y = (M, N).
  void tangent(HelicoidalSection const& section, NodeVelocities<T> const& v, double ck, double cd,
               Mat<T, 12, 12>& k) const {
    Mat<T, 6, 9> const b = nodal_map();
    Mat<T, 6, 9> const stress = stress_slope(section, b, v, ck, cd);
    ScrewMap<T> const forward = screw_map_derivative<T>(series, d, {m, n}),
                      backward = screw_map_derivative<T>(series, opposite(d), {m, n});
    Vec<T, 3> const pull = product(inverse.diagonal, n);
    Mat<T, 3, 3> const carried = skew<T>(pull);
    Mat<T, 9, 9> local;
    for (int c = 0; c < 9; ++c)
      for (int r = 0; r < 3; ++r) {
        T of_r = T(0.0), of_1 = T(0.0), of_2 = T(0.0), geometric_r = T(0.0), geometric_1 = T(0.0), geometric_2 = T(0.0);
        for (int i = 0; i < 6; ++i) {
          of_r += b(i, r) * stress(i, c);
          of_1 += b(i, 3 + r) * stress(i, c);
          of_2 += b(i, 6 + r) * stress(i, c);
        }
        for (int i = 0; i < 3; ++i) {
          geometric_r += forward.diagonal(r, i) * b(3 + i, c);
          geometric_1 += forward.diagonal(r, i) * b(i, c) + forward.coupling(r, i) * b(3 + i, c);
          geometric_2 += backward.diagonal(r, i) * b(i, c) + backward.coupling(r, i) * b(3 + i, c);
        }
        if (c >= 3 && c < 6) geometric_r -= carried(r, c - 3);
        local(r, c) = of_r + ck * geometric_r;
        local(3 + r, c) = of_1 - ck * geometric_1;
        local(6 + r, c) = of_2 - ck * geometric_2;
      }
    expand(local, k);
  }

 private:
  /// B (6×9) of δd = B (R₁ᵀ(δr₂ − δr₁), δθ₁, δθ₂).
  Mat<T, 6, 9> nodal_map() const {
    Mat<T, 6, 9> b;
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) {
        b(i, j) = inverse.diagonal(j, i);
        b(i, 3 + j) = -inverse.coupling(j, i);
        b(i, 6 + j) = inverse.coupling(i, j);
        b(3 + i, j) = T(0.0);
        b(3 + i, 3 + j) = -inverse.diagonal(j, i);
        b(3 + i, 6 + j) = inverse.diagonal(i, j);
      }
    return b;
  }
  /// Derivative of the section forces (6×9) with respect to the columns of B. With u = R₁ᵀ(ṙ₂ − ṙ₁):
  ///   δḋ = Xᵀ (u × δθ₁) + (−D₀(−φ, u) δφ, 0) + (D(d, Ω₂) + D(−d, Ω₁)) δd.
  Mat<T, 6, 9> stress_slope(HelicoidalSection const& section, Mat<T, 6, 9> const& b, NodeVelocities<T> const& v,
                            double ck, double cd) const {
    Mat<T, 6, 9> out;
    if (section.coupled()) {
      for (int c = 0; c < 9; ++c)
        for (int i = 0; i < 6; ++i) {
          out(i, c) = T(0.0);
          for (int j = 0; j < 6; ++j)
            out(i, c) += (ck * section.springs()(i, j) + cd * section.dampers()(i, j)) * b(j, c);
        }
    } else {
      for (int c = 0; c < 9; ++c)
        for (int i = 0; i < 6; ++i) out(i, c) = b(i, c) * (section.spring(i) * (ck + cd * section.time(i)));
    }
    if (!section.damped() || ck == 0.0) return out;
    Vec<T, 3> const none = detail::zeros<Vec<T, 3>>();
    ScrewMap<T> of_d = sum<T>(screw_map_derivative<T>(series, d, {none, v.w2}),
                              screw_map_derivative<T>(series, opposite(d), {none, v.w1}));
    Mat<T, 3, 3> const by_apart = map_derivative<T>(series, scaled<T>(d.rotation, -1.0), v.apart),
                       swept = transposed_product<T>(inverse.diagonal, skew<T>(v.apart));
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) of_d.coupling(i, j) -= by_apart(i, j);
    Mat<T, 6, 9> rates;
    for (int c = 0; c < 9; ++c)
      for (int r = 0; r < 3; ++r) {
        T p = T(0.0), phi = T(0.0);
        for (int i = 0; i < 3; ++i) {
          p += of_d.diagonal(r, i) * b(i, c) + of_d.coupling(r, i) * b(3 + i, c);
          phi += of_d.diagonal(r, i) * b(3 + i, c);
        }
        if (c >= 3 && c < 6) p += swept(r, c - 3);
        rates(r, c) = p;
        rates(3 + r, c) = phi;
      }
    for (int c = 0; c < 9; ++c)
      for (int i = 0; i < 6; ++i) {
        if (!section.coupled()) {
          out(i, c) += rates(i, c) * (ck * section.spring(i) * section.time(i));
          continue;
        }
        for (int j = 0; j < 6; ++j) out(i, c) += ck * section.dampers()(i, j) * rates(j, c);
      }
    return out;
  }
  /// Writes the tangent in the columns (δr₁, δθ₁, δr₂, δθ₂) to k, from that in the columns of B.
  void expand(Mat<T, 9, 9> const& local, Mat<T, 12, 12>& k) const {
    Mat<T, 3, 3> const back = transposed(R);
    Mat<T, 3, 3> block[3][3];
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) {
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) block[a][b](i, j) = local(3 * a + i, 3 * b + j);
        if (a == 0) block[a][b] = product(R, block[a][b]);
        if (b == 0) block[a][b] = product(block[a][b], back);
      }
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b) {
        double const sign = (a == 0 ? -1.0 : 1.0) * (b == 0 ? -1.0 : 1.0);
        Mat<T, 3, 3> const& from = block[a == 1 ? 1 : a == 3 ? 2 : 0][b == 1 ? 1 : b == 3 ? 2 : 0];
        for (int j = 0; j < 3; ++j)
          for (int i = 0; i < 3; ++i) k(3 * a + i, 3 * b + j) = sign * from(i, j);
      }
  }
};

}  // namespace polybody
