#pragma once
/// \file
/// Linear elastic section of a geometrically exact beam: forces and tangent of an element from the strains at one of
/// its sections.

#include <polybody/bodies/lrvf/rotation_interpolation.hpp>
#include <polybody/bodies/lrvf/strain_quadrature.hpp>
#include <polybody/bodies/shared/bar.hpp>

namespace polybody {

/// Strains of an element at one of its sections, in a state.
template <StateScalar T>
struct SectionStrains {
  StrainSection<T> at;  ///< section, with its derivatives with respect to the nodes
  double chord = 1.0;   ///< c₀, distance of the nodes in the reference [m]
  Vec<T, 3> gamma;      ///< Γ + Γ₀ = Rᵀ r′, with the axes R of the section
  Vec<T, 3> rate;       ///< Rᵀ ṙ′, for damping
  Vec<T, 6> turning;    ///< (Ω₁, Ω₂), for damping
  Vec<T, 3> n, m;       ///< Γ and l K relative to the reference; after `stress` the section forces N, M
};

/// Stiffness and damping of a section: section forces and tangent from the strains of an element.
class LrvfSection {
 public:
  /// Section for elements of arc length `l`.
  /// \throws InvalidInput for a missing stiffness.
  template <class T = double>  // compiled only if used
  LrvfSection(Bar const& bar, BarConstants const& c, double l) : l_(l), pretension_(bar.pretension) {
    double const shear = bar.damping.shear, bending = bar.damping.bending;
    double const stiffness[] = {c.EA, c.GA, c.GA_z.value_or(c.GA), c.GJ, c.EI_y.value_or(c.EI), c.EI};
    double const time[] = {bar.damping.axial, shear, shear, shear, bending, bending};
    char const* const names[] = {"EA", "GA", "GA_z", "GJ", "EI_y", "EI"};
    for (int i = 0; i < 6; ++i) {
      require_positive(stiffness[i], std::string("Lrvf: the stiffness ") + names[i] + " of the bar");
      stiffness_[i] = stiffness[i];
      time_[i] = time[i];
      damped_ = damped_ || time[i] != 0.0;
    }
  }

  /// Copy of the section for the quadrature point p: each stiffness is multiplied by the weight of its strain.
  LrvfSection weighted(StrainPoint const& p) const {
    LrvfSection out = *this;
    for (int i = 0; i < 6; ++i) out.stiffness_[i] *= i == 0 ? p.axial : i < 3 ? p.shear : p.curvature;
    out.pretension_ *= p.axial;
    return out;
  }

  bool damped() const { return damped_; }  ///< true if a damping time is not zero

  /// Stress C (strain + τ strain˙) plus the pretension. The stress replaces the strains in s.n and s.m.
  template <StateScalar T>
  void stress(SectionStrains<T>& s) const {
    if (damped_) {
      Vec<T, 3> const spin = detail::of_nodes(s.at.spin, s.turning), bend = detail::of_nodes(s.at.bend, s.turning);
      Vec<T, 3> const slide = cross(s.gamma, spin);
      for (int i = 0; i < 3; ++i) {
        s.n[i] += (s.rate[i] + slide[i]) * time_[i];
        s.m[i] += bend[i] * time_[3 + i];
      }
    }
    for (int i = 0; i < 3; ++i) {
      s.n[i] *= stiffness_[i];
      s.m[i] *= stiffness_[3 + i] / l_;
    }
    s.n[0] += pretension_;
  }
  /// Section forces (N, M) for the strains (Γ, K), without damping [N], [N m].
  Vec6 forces(Vec6 const& strains) const {
    Vec6 n = strains;
    for (int i = 0; i < 6; ++i) n[i] *= stiffness_[i];
    n[0] += pretension_;
    return n;
  }
  /// Strain energy per length for the strains (Γ, K) [J/m].
  template <class T = double>  // compiled only if used
  double energy(Vec6 const& strains) const {
    T sum = 0.0;
    for (int i = 0; i < 6; ++i) sum += strains[i] * stiffness_[i] * strains[i];
    return 0.5 * sum + pretension_ * strains[0];
  }

  /// Tangent of the elastic and damping force of an element. With x = Rᵀ (δr₂ − δr₁)/c₀ and θ = (δθ₁, δθ₂), in the axes
  /// R of the section:
  ///   δΓ = x + Γ̃ P θ,  δN = C (ck + cd τ) δΓ + ck C τ δΓ˙,  δt = l (N × δΓ − Γ × δN),
  ///   −δf_r = ∓ l/c₀ R (δN + ck Pθ × N), −δf_θ = Pᵀ δt + Qᵀ δM + ck ∂(Pᵀt + Qᵀ M) θ.
  template <class T>  // compiled only if used
  void tangent(SectionStrains<T> const& s, StrainGradient const& by, double ck, double cd, Mat<T, 12, 12>& k) const {
    Slopes<T> const by_state = slopes(s, by, ck, cd);
    Mat<T, 3, 3> const& nx = by_state.nx;
    Mat<T, 3, 6> const &nt = by_state.nt, &mt = by_state.mt;
    Vec<T, 3> const n = scaled<T>(s.n, ck);
    Mat<T, 3, 3> const of_n = skew(n), by_x = skew_product(s.gamma, nx);
    Mat<T, 3, 6> const n_spin = skew_product(n, s.at.spin), n_slide = skew_product(n, skew_product(s.gamma, s.at.spin)),
                       by_theta = skew_product(s.gamma, nt);
    Mat<T, 3, 3> through;       // ∂t/∂x, with t = l N × Γ for a fixed Γ
    Mat<T, 3, 6> shift, moved;  // ∂(R N)/∂θ in the axes of the section, ∂t/∂θ
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) through(i, j) = l_ * (of_n(i, j) - by_x(i, j));
      for (int j = 0; j < 6; ++j) {
        shift(i, j) = nt(i, j) - n_spin(i, j);
        moved(i, j) = l_ * (n_slide(i, j) - by_theta(i, j));
      }
    }
    Mat<T, 3, 3> const back = transposed(s.at.R), rr = transposed_product(back, product(nx, back));
    Mat<T, 3, 6> const rt = product(s.at.R, shift), tr = product(s.at.R, transposed_product(through, s.at.spin));
    Mat<T, 6, 6> const of_t = transposed_product(s.at.spin, moved), of_m = transposed_product(s.at.bend, mt);
    double const by_force = l_ / s.chord, step_length_derivative = 1.0 / s.chord;
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) {
        double const si = i == 0 ? -1.0 : 1.0, sj = j == 0 ? -1.0 : 1.0;
        for (int c = 0; c < 3; ++c)
          for (int r = 0; r < 3; ++r) {
            int const a = 3 * i + r, b = 3 * j + c;
            k(6 * i + r, 6 * j + c) = si * sj * by_force * step_length_derivative * rr(r, c);
            k(6 * i + r, 6 * j + 3 + c) = si * by_force * rt(r, b);
            k(6 * i + 3 + r, 6 * j + c) = sj * step_length_derivative * tr(c, a);
            k(6 * i + 3 + r, 6 * j + 3 + c) = of_t(a, b) + of_m(a, b) + ck * by.pulled(a, b);
          }
      }
  }

 private:
  /// Derivatives of the section forces with respect to x and to θ = (δθ₁, δθ₂) (see `tangent`).
  template <class T>
  struct Slopes {
    Mat<T, 3, 3> nx;      ///< ∂N/∂x
    Mat<T, 3, 6> nt, mt;  ///< ∂N/∂θ, ∂M/∂θ
  };
  /// Derivatives δN = C (ck + cd τ) (x + Γ̃ P θ) + ck C τ δΓ˙ and, in the same form, δM of Q θ. With Γ˙ = u + Γ × Ω and
  /// u = Rᵀ (ṙ₂ − ṙ₁)/c₀:
  ///   δΓ˙ = u × Pθ + δΓ × Ω + Γ × δΩ.
  template <class T>
  Slopes<T> slopes(SectionStrains<T> const& s, StrainGradient const& by, double ck, double cd) const {
    Slopes<T> out;
    Mat<T, 3, 6> const slide = skew_product(s.gamma, s.at.spin);  // Γ̃ P
    for (int i = 0; i < 3; ++i) {
      T const full = stiffness_[i] * (ck + cd * time_[i]),
              full_bend = stiffness_[3 + i] / l_ * (ck + cd * time_[3 + i]);
      for (int j = 0; j < 3; ++j) out.nx(i, j) = i == j ? full : T(0.0);
      for (int j = 0; j < 6; ++j) {
        out.nt(i, j) = full * slide(i, j);
        out.mt(i, j) = full_bend * s.at.bend(i, j);
      }
    }
    if (!damped_) return out;
    Vec<T, 3> const omega = detail::of_nodes(s.at.spin, s.turning);
    Mat<T, 3, 3> const w = skew(omega);
    Mat<T, 3, 6> const carried = skew_product(s.rate, s.at.spin), turned = skew_product(omega, slide),
                       changed = skew_product<T>(s.gamma, by.spin);
    for (int i = 0; i < 3; ++i) {
      T const d = ck * stiffness_[i] * time_[i], d_bend = ck * stiffness_[3 + i] / l_ * time_[3 + i];
      for (int j = 0; j < 3; ++j) out.nx(i, j) -= d * w(i, j);
      for (int j = 0; j < 6; ++j) {
        out.nt(i, j) += d * (carried(i, j) - turned(i, j) + changed(i, j));
        out.mt(i, j) += d_bend * by.bend(i, j);
      }
    }
    return out;
  }

  double l_, pretension_;
  Vec6 stiffness_;  ///< EA, GA, GA_z, GJ, EI_y, EI
  Vec6 time_;       ///< damping times [s]
  bool damped_ = false;
};

}  // namespace polybody
