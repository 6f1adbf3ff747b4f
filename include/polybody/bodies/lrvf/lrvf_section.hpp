#pragma once
/// \file
/// The linear elastic section of a large rotation vector beam: forces and tangent of an element from the strains in its
/// middle.

#include <polybody/bodies/lrvf/rotation_interpolation.hpp>
#include <polybody/bodies/shared/bar.hpp>

namespace polybody {

/// An element in a state, by its middle section.
template <StateScalar T>
struct StrainedSection {
  MiddleSection<T> at;
  double chord = 1.0;  ///< c₀, distance of the nodes in the reference [m]
  Vec<T, 3> gamma;     ///< R_mᵀ r′
  Vec<T, 3> rate;      ///< R_mᵀ ṙ′, for damping
  Vec<T, 6> turning;   ///< (Ω₁, Ω₂), for damping
  Vec<T, 3> n, m;      ///< Γ and l K less those of the reference; after `stress` the section forces N, M
};

class LrvfSection {
 public:
  /// For elements of arc length `l`. \throws InvalidInput for a stiffness that is missing.
  template <class T = double>  // compiled where it is used
  LrvfSection(Bar const& bar, BarConstants const& c, double l) : l_(l), pretension_(bar.pretension) {
    stiffness_ = Vec<T, 6>{{c.EA, c.GA, c.GA_z.value_or(c.GA), c.GJ, c.EI_y.value_or(c.EI), c.EI}};
    char const* const names[] = {"EA", "GA", "GA_z", "GJ", "EI_y", "EI"};
    for (int i = 0; i < 6; ++i)
      require_positive(stiffness_[i], std::string("Lrvf: the stiffness ") + names[i] + " of the bar");
    double const shear = bar.damping.shear, bending = bar.damping.bending;
    time_ = Vec<T, 6>{{bar.damping.axial, shear, shear, shear, bending, bending}};
    for (int i = 0; i < 6; ++i) damped_ = damped_ || time_[i] != 0.0;
  }

  bool damped() const { return damped_; }

  /// Stress = C (strain + τ strain˙), in place of the strains in s.n and s.m.
  template <StateScalar T>
  void stress(StrainedSection<T>& s) const {
    if (damped_) {
      Vec<T, 3> const spin = s.at.spin * s.turning, bend = s.at.bend * s.turning;
      Vec<T, 3> const slide = s.rate + s.gamma.cross(spin);
      for (int i = 0; i < 3; ++i) {
        s.n[i] += slide[i] * time_[i];
        s.m[i] += bend[i] * time_[3 + i];
      }
    }
    for (int i = 0; i < 3; ++i) {
      s.n[i] *= stiffness_[i];
      s.m[i] *= stiffness_[3 + i] / l_;
    }
    s.n[0] += pretension_;
  }
  /// (N, M) of strains (Γ, K), without damping [N], [N m].
  Vec6 forces(Vec6 const& strains) const {
    Vec6 n = strains;
    for (int i = 0; i < 6; ++i) n[i] *= stiffness_[i];
    n[0] += pretension_;
    return n;
  }
  /// Energy of strains (Γ, K) [J/m].
  template <class T = double>  // compiled where it is used
  double energy(Vec6 const& strains) const {
    Vec<T, 6> const x = strains;
    return 0.5 * x.dot(stiffness_.cwiseProduct(x)) + pretension_ * x[0];
  }

  /// The tangent of the elastic and damping force of an element. With x = R_mᵀ (δr₂ − δr₁)/c₀ and θ = δθ₁₂, all in the
  /// axes of the middle section:
  ///   δΓ = x + Γ̃ P θ,  δN = C (ck + cd τ) δΓ + ck C τ δΓ˙,  δt = l (N × δΓ − Γ × δN),
  ///   −δf_r = ∓ l/c₀ R_m (δN + ck Pθ × N),  −δf_θ = Pᵀ δt + Qᵀ δM + ck ∂(Pᵀt + Qᵀ M) θ.
  template <class T>  // compiled where it is used
  void tangent(StrainedSection<T> const& s, MiddleGradient const& by, double ck, double cd, Mat<T, 12, 12>& k) const {
    using V3 = Vec<T, 3>;
    using M3 = Mat<T, 3, 3>;
    Vec<T, 6> const stiffness = stiffness_, time = time_;
    V3 const c1 = stiffness.template head<3>(), c2 = stiffness.template tail<3>() / l_;
    V3 const full1 = c1.cwiseProduct(V3::Constant(ck) + cd * time.template head<3>());
    V3 const full2 = c2.cwiseProduct(V3::Constant(ck) + cd * time.template tail<3>());
    M3 const gamma = skew<T>(s.gamma), n = ck * skew<T>(s.n);
    Mat<T, 3, 6> const slide = gamma * s.at.spin;  // Γ̃ P
    M3 nx = full1.asDiagonal();
    Mat<T, 3, 6> nt = full1.asDiagonal() * slide, mt = full2.asDiagonal() * s.at.bend;
    if (damped_) {  // Γ˙ = u + Γ × Ω, u = R_mᵀ (ṙ₂ − ṙ₁)/c₀:  δΓ˙ = u × Pθ + δΓ × Ω + Γ × δΩ
      Mat<T, 3, 6> const &spin_change = by.spin, &bend_change = by.bend;
      V3 const omega = s.at.spin * s.turning;
      V3 const d1 = ck * c1.cwiseProduct(time.template head<3>()), d2 = ck * c2.cwiseProduct(time.template tail<3>());
      M3 const w = skew<T>(omega);
      nx -= d1.asDiagonal() * w;
      nt += d1.asDiagonal() * (skew<T>(s.rate) * s.at.spin - w * slide + gamma * spin_change);
      mt += d2.asDiagonal() * bend_change;
    }
    Mat<T, 6, 6> const& pulled_change = by.pulled;
    Mat<T, 6, 3> const pulled = s.at.spin.transpose() * (l_ * (n - gamma * nx));
    Mat<T, 6, 6> const turn =
        s.at.spin.transpose() * (l_ * (n * slide - gamma * nt)) + s.at.bend.transpose() * mt + ck * pulled_change;
    M3 const rr = s.at.R * (l_ / (s.chord * s.chord) * nx) * s.at.R.transpose();
    Mat<T, 3, 6> const rt = s.at.R * (l_ / s.chord * (nt - n * s.at.spin));
    Mat<T, 6, 3> const tr = pulled * (1.0 / s.chord) * s.at.R.transpose();
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) {
        double const si = i == 0 ? -1.0 : 1.0, sj = j == 0 ? -1.0 : 1.0;
        for (int c = 0; c < 3; ++c)
          for (int r = 0; r < 3; ++r) {
            k(6 * i + r, 6 * j + c) = si * sj * rr(r, c);
            k(6 * i + r, 6 * j + 3 + c) = si * rt(r, 3 * j + c);
            k(6 * i + 3 + r, 6 * j + c) = sj * tr(3 * i + r, c);
            k(6 * i + 3 + r, 6 * j + 3 + c) = turn(3 * i + r, 3 * j + c);
          }
      }
  }

 private:
  double l_, pretension_;
  Vec6 stiffness_;  ///< EA, GA, GA_z, GJ, EI_y, EI
  Vec6 time_;       ///< of damping [s]
  bool damped_ = false;
};

}  // namespace polybody
