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
      out = detail::small_product(section.slope(ck, cd), b);
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
    if (section.coupled()) {
      Mat<T, 6, 9> const more = detail::small_product(section.slope(0.0, ck), rates);
      for (int i = 0; i < 54; ++i) out.data()[i] += more.data()[i];
      return out;
    }
    for (int c = 0; c < 9; ++c)
      for (int i = 0; i < 6; ++i) out(i, c) += rates(i, c) * (ck * section.spring(i) * section.time(i));
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
