#pragma once
/// \file
/// Linear elastic section of an `Lrvf` in space: section forces, and tangent of an element from the strains at one of
/// its sections. Theory: Eqs. 2.56, 2.57, 2.60 to 2.63, 2.121 to 2.124.

#include <array>
#include <tuple>
#include <vector>

#include <polybody/bodies/lrvf/rotation_interpolation.hpp>
#include <polybody/bodies/lrvf/strain_gradient.hpp>
#include <polybody/bodies/lrvf/strain_quadrature.hpp>
#include <polybody/bodies/shared/rod_section.hpp>

namespace polybody {

/// Strains of an element at one of its sections, in a state.
template <StateScalar T>
struct SectionStrains {
  StrainSection<T> at;  ///< section, with its derivatives with respect to the rotations of the nodes
  double chord = 1.0;   ///< c₀, distance of the nodes in the reference [m]
  Vec<T, 3> gamma;      ///< Γ + Γ₀ = Rᵀ r′, with the axes R of the section
  Vec<T, 3> rate;       ///< Rᵀ ṙ′, for damping
  Vec<T, 6> turning;    ///< (Ω₁, Ω₂), for damping
  Vec<T, 3> n, m;       ///< Γ and l K relative to the reference; after `stress` the section forces N, M
};

/// Section of an element of `Lrvf`: section forces and tangent from the strains of an element.
class LrvfSection : public RodSection {
 public:
  using RodSection::RodSection;

  /// Copy of the section for the quadrature point p. The weight of each strain multiplies its stiffness, and that of
  /// the axial strain also the pretension.
  LrvfSection weighted(StrainPoint const& p) const {
    if (coupled_ && !(p.axial == p.shear && p.shear == p.curvature))
      throw InvalidInput("section.quadrature", {ErrorObject{"Lrvf"},
                                                ": a section with couplings or an offset needs a quadrature with equal "
                                                "weights of all strains. Use ReducedQuadrature or FullQuadrature."});
    LrvfSection out = *this;
    for (int i = 0; i < 6; ++i) out.stiffness_[i] *= i == 0 ? p.axial : i < 3 ? p.shear : p.curvature;
    for (int i = 0; i < 36; ++i) {
      out.matrix_.data()[i] *= p.axial;
      out.damper_.data()[i] *= p.axial;
    }
    out.pretension_ *= p.axial;
    return out;
  }

  /// Stress C (strain + τ strain˙) plus the pretension. The stress replaces the strains in s.n and s.m.
  template <StateScalar T>
  void stress(SectionStrains<T>& s) const {
    if (coupled_) return coupled_stress<T>(s);
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

  /// Tangent of the elastic and damping force of an element. With x = Rᵀ (δr₂ − δr₁)/c₀ and θ = (δθ₁, δθ₂), in the axes
  /// R of the section:
  ///   δΓ = x + Γ̃ P θ,  δN = C (ck + cd τ) δΓ + ck C τ δΓ˙,  δt = l (N × δΓ − Γ × δN),
  ///   −δf_r = ∓ l/c₀ R (δN + ck Pθ × N), −δf_θ = Pᵀ δt + Qᵀ δM + ck ∂(Pᵀt + Qᵀ M) θ.
  /// The upper sign is that of node 1.
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
    Mat<T, 3, 6> turn_by_x = transposed_product(through, s.at.spin);
    if (coupled_)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 6; ++j)
          for (int a = 0; a < 3; ++a) turn_by_x(i, j) += by_state.mx(a, i) * s.at.bend(a, j);
    Mat<T, 3, 6> const rt = product(s.at.R, shift), tr = product(s.at.R, turn_by_x);
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
    Mat<T, 3, 3> nx, mx;  ///< ∂N/∂x, and ∂M/∂x of a coupled section
    Mat<T, 3, 6> nt, mt;  ///< ∂N/∂θ, ∂M/∂θ
  };
  /// Derivative δN = C (ck + cd τ) (x + Γ̃ P θ) + ck C τ δΓ˙, and δM in the same form with Q θ. With Γ˙ = u + Γ × Ω and
  /// u = Rᵀ (ṙ₂ − ṙ₁)/c₀:
  ///   δΓ˙ = u × Pθ + δΓ × Ω + Γ × δΩ.
  template <class T>
  Slopes<T> slopes(SectionStrains<T> const& s, StrainGradient const& by, double ck, double cd) const {
    Slopes<T> out;
    Mat<T, 3, 6> const slide = skew_product(s.gamma, s.at.spin);  // Γ̃ P
    if (coupled_) return coupled_slopes<T>(s, by, slide, ck, cd);
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
  template <StateScalar T>
  void coupled_stress(SectionStrains<T>& s) const {
    Vec<T, 3> const spin = detail::of_nodes(s.at.spin, s.turning), slide = cross(s.gamma, spin);
    ScrewVector<T> const strains{s.n, scaled<T>(s.m, 1.0 / l_)};
    ScrewVector<T> rates{slide, scaled<T>(detail::of_nodes(s.at.bend, s.turning), 1.0 / l_)};
    for (int i = 0; i < 3; ++i) rates.translation[i] += s.rate[i];
    if (!damped_) rates = scaled(strains, 0.0);
    RodSection::stress(strains, rates, s.n, s.m);
  }
  /// The slopes with all blocks of the matrices, for the strains and rates δ(Γ, K) and δ(Γ˙, K˙) of `slopes`.
  template <class T>
  Slopes<T> coupled_slopes(SectionStrains<T> const& s, StrainGradient const& by, Mat<T, 3, 6> const& slide, double ck,
                           double cd) const {
    Mat<T, 6, 9> strain, rate;  // by x and θ
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 9; ++j) {
        strain(i, j) = j < 3 ? T(i == j ? 1.0 : 0.0) : slide(i, j - 3);
        strain(3 + i, j) = j < 3 ? T(0.0) : s.at.bend(i, j - 3) / l_;
      }
    Mat<T, 6, 9> stress = detail::small_product(matrix_sum(ck, cd), strain);
    if (damped_) {
      Vec<T, 3> const omega = detail::of_nodes(s.at.spin, s.turning);
      Mat<T, 3, 3> const w = skew(omega);
      Mat<T, 3, 6> const carried = skew_product(s.rate, s.at.spin), turned = skew_product(omega, slide),
                         changed = skew_product<T>(s.gamma, by.spin);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 9; ++j) {
          rate(i, j) = j < 3 ? -w(i, j) : carried(i, j - 3) - turned(i, j - 3) + changed(i, j - 3);
          rate(3 + i, j) = j < 3 ? T(0.0) : T(by.bend(i, j - 3) / l_);
        }
      Mat<T, 6, 9> const more = detail::small_product(matrix_sum(0.0, ck), rate);
      for (int i = 0; i < 54; ++i) stress.data()[i] += more.data()[i];
    }
    Slopes<T> out;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 9; ++j) {
        (j < 3 ? out.nx(i, j) : out.nt(i, j - 3)) = stress(i, j);
        (j < 3 ? out.mx(i, j) : out.mt(i, j - 3)) = stress(3 + i, j);
      }
    return out;
  }
};

namespace detail {
/// Sections at the points of a quadrature, of all elements or of each.
template <StrainQuadrature Quadrature>
class QuadratureSections {
 public:
  static constexpr std::size_t count = Quadrature::points.size();  ///< number of points

  /// `sections` are those of all elements, or of each.
  explicit QuadratureSections(std::vector<LrvfSection> const& sections) {
    for (LrvfSection const& section : sections)
      at_.push_back(
          std::apply([&](auto const&... p) { return std::array{section.weighted(p)...}; }, Quadrature::points));
  }
  /// Sections at the points of element e.
  std::array<LrvfSection, count> const& operator[](Index e) const { return at_[at_.size() == 1 ? 0 : std::size_t(e)]; }

 private:
  std::vector<std::array<LrvfSection, count>> at_;
};
}  // namespace detail

}  // namespace polybody
