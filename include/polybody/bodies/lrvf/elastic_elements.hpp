#pragma once
/// \file
/// Elastic elements of the spatial `Lrvf`: forces, tangents and energy from the sections of a quadrature, without
/// inertia.
/// Theory: Eqs. 2.56, 2.57, 2.60 to 2.63.

#include <array>
#include <concepts>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include <polybody/bodies/lrvf/rotation_interpolation.hpp>
#include <polybody/bodies/lrvf/strain_gradient.hpp>
#include <polybody/bodies/lrvf/strain_quadrature.hpp>
#include <polybody/bodies/shared/body.hpp>
#include <polybody/bodies/shared/rod_section.hpp>

namespace polybody {

// Linear elastic section of a geometrically exact beam: forces and tangent of an element from the strains at one of
// its sections.

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
    LrvfSection out = *this;
    for (int i = 0; i < 6; ++i) out.stiffness_[i] *= i == 0 ? p.axial : i < 3 ? p.shear : p.curvature;
    out.pretension_ *= p.axial;
    return out;
  }

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
  /// Derivative δN = C (ck + cd τ) (x + Γ̃ P θ) + ck C τ δΓ˙, and δM in the same form with Q θ. With Γ˙ = u + Γ × Ω and
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
};

namespace detail {

/// Unit quaternion of node number `node`.
template <StateScalar T>
Quaternion<T> turned(std::span<T const> q, Index node) {
  return entries<4>(q, 7 * node + 3);
}
/// Index in q of the stored section of element e, after the coordinates of the nodes.
constexpr Index carried_at(Index elements, Index e) { return 7 * (elements + 1 + e); }
template <StateScalar T>
CarriedSectionState<T> carried_section(std::span<T const> q, Index elements, Index e) {
  Index const first = carried_at(elements, e);
  return {entries<4>(q, first), entries<3>(q, first + 4)};
}
template <StateScalar T>
void set_carried_section(std::span<T> q, Index elements, Index e, CarriedSectionState<T> const& section) {
  Index const first = carried_at(elements, e);
  set_entries<4>(q, first, section.axes);
  set_entries<3>(q, first + 4, section.turn);
}
/// Index of component i of (Ω₁, Ω₂) in the velocities (ṙ₁, Ω₁, ṙ₂, Ω₂) of an element.
constexpr int turn_column(int i) { return i < 3 ? 3 + i : 6 + i; }
/// Writes (Ω₁, Ω₂) of an element directly to w. A copy would wait for preceding writes to memory.
template <StateScalar T>
void set_turning(Index e, std::span<T const> v, Vec<T, 6>& w) {
  for (int i = 0; i < 6; ++i) w[i] = v[std::size_t(6 * e + turn_column(i))];
}
/// Quotient (x₂ − x₁)/c₀ of the vectors at `first` and at `first + stride`.
template <StateScalar T>
Vec<T, 3> slope(std::span<T const> x, Index first, Index stride, double chord) {
  return scaled<T>(difference<T>(entries<3>(x, first + stride), entries<3>(x, first)), 1.0 / chord);
}

/// Strains Γ₀ and l K₀ of a section of an element in the reference configuration.
struct FreeStrain {
  Vec3 gamma, turn;
};

}  // namespace detail

/// Elastic elements of interpolations in which the axes of every section form a rotation matrix. The specialisation for
/// `Directors` has other axes. For the section in the middle, the class calls `middle` and `gradient` of the
/// interpolation.
template <RotationInterpolation Interpolation, StrainQuadrature Quadrature>
class ElasticElements {
 public:
  /// Chain of `elements` elements, each of arc length l [m], of a bar with this placement.
  ElasticElements(LrvfSection const& section, Placement const& placement, double l, Index elements)
      : interpolation_(placement),
        sections_(std::apply([&](auto const&... p) { return std::array{section.weighted(p)...}; }, Quadrature::points)),
        l_(l),
        free_(std::size_t(elements)) {}

  Index size() const { return Index(free_.size()); }  ///< number of elements

  /// Sets the stress-free state of element e to q, with the distance c₀ = `chord` of its nodes [m].
  void set_free(Index e, std::span<double const> q, double chord) {
    Free& free = free_[std::size_t(e)];
    free.chord = chord;
    for_points<0, stored>([&]<int i>() {
      StrainSection<double> at;
      place<i, double>(e, q, at, free.at[i].gamma);
      free.at[i].turn = at.turn;
    });
  }

  /// Force of element e from the virtual work l Σ w (N·δΓ + M·δK). With δθ₁₂ = (δθ₁, δθ₂), δθ = P δθ₁₂, δK = Q δθ₁₂/l
  /// and δΓ = Rᵀ (δr₂ − δr₁)/c₀ + Γ × δθ, where Γ includes Γ₀, the sums over the points are
  ///   f_r = ± l/c₀ R N,  f_θ = −(Pᵀ t + Qᵀ M),  t = l N × Γ.
  /// The upper sign is that of node 1. The function also adds moment(i), the moment of the inertia forces on node i.
  template <StateScalar T, std::invocable<int> Moment>
  void force(Index e, std::span<T const> q, std::span<T const> v, Moment const& moment, Vec<T, 12>& out) const {
    point_force<0, T>(e, q, v, moment, out);
    for_points<1, count>([&]<int i>() {
      Vec<T, 12> more;
      point_force<i, T>(e, q, v, [](int) { return detail::zeros<Vec<T, 3>>(); }, more);
      for (int k = 0; k < 12; ++k) out[k] += more[k];
    });
  }

  /// Tangent ck (−∂f/∂δ) + cd (−∂f/∂v), with δ of q ⊞ δ. The tangent is not symmetric in general, because rotations do
  /// not commute.
  template <class T>  // compiled only if used
  void tangent(Index e, std::span<double const> q, std::span<double const> v, double ck, double cd,
               Mat<T, 12, 12>& k) const {
    point_tangent<0, T>(e, q, v, ck, cd, k);
    for_points<1, count>([&]<int i>() {
      Mat<T, 12, 12> more;
      point_tangent<i, T>(e, q, v, ck, cd, more);
      for (int c = 0; c < 12; ++c)
        for (int r = 0; r < 12; ++r) k(r, c) += more(r, c);
    });
  }

  /// Strain energy of element e [J].
  double energy(Index e, std::span<double const> q) const {
    double sum = sections_[0].energy(strains_in<0>(e, q));
    for_points<1, count>([&]<int i>() { sum += sections_[i].energy(strains_in<i>(e, q)); });
    return l_ * sum;
  }
  /// Strains (Γ, K) in the middle of element e, in the axes of the middle section [1], [1/m]. At this section the shear
  /// strain is free of the error due to bending.
  Vec6 strains(Index e, std::span<double const> q) const { return strains_in<middle>(e, q); }

 private:
  static constexpr int count = int(Quadrature::points.size());
  /// Index of the point in the middle. If the quadrature has no such point, this index is that of an additional point
  /// after the others.
  static constexpr int middle = [] {
    for (int i = 0; i < count; ++i)
      if (Quadrature::points[i].xi == 0.5) return i;
    return count;
  }();
  static constexpr int stored = middle == count ? count + 1 : count;
  static_assert(!PathDependentInterpolation<Interpolation> || (count == 1 && middle == 0),
                "This interpolation stores one section per element, in its middle, so strains exist there only. "
                "Use ReducedQuadrature.");
  /// Reference configuration of an element.
  struct Free {
    double chord = 1.0;  ///< c₀ [m]
    std::array<detail::FreeStrain, stored> at;
  };

  /// Calls `f.operator()<i>()` for i = first … last − 1.
  template <int first, int last, class F>
  static void for_points(F&& f) {
    [&]<int... i>(std::integer_sequence<int, i...>) {
      (f.template operator()<first + i>(), ...);
    }(std::make_integer_sequence<int, last - first>{});
  }

  template <int i, StateScalar T>
  void place(Index e, std::span<T const> q, StrainSection<T>& at, Vec<T, 3>& gamma) const {
    Quaternion<T> const a = detail::turned<T>(q, e), b = detail::turned<T>(q, e + 1);
    if constexpr (PathDependentInterpolation<Interpolation>)
      interpolation_.template middle<T>(detail::carried_section<T>(q, size(), e), at);
    else if constexpr (i == middle)
      interpolation_.template middle<T>(a, b, at);
    else
      interpolation_.template at<T>(Quadrature::points[i].xi, a, b, at);
    gamma = transposed_product(at.R, detail::slope<T>(q, 7 * e, 7, free_[std::size_t(e)].chord));
  }
  /// Strains and section forces at point i of an element.
  template <int i, StateScalar T>
  void strain(Index e, std::span<T const> q, std::span<T const> v, SectionStrains<T>& s) const {
    Free const& free = free_[std::size_t(e)];
    s.chord = free.chord;
    place<i, T>(e, q, s.at, s.gamma);
    for (int k = 0; k < 3; ++k) {
      s.n[k] = s.gamma[k] - free.at[i].gamma[k];
      s.m[k] = s.at.turn[k] - free.at[i].turn[k];
    }
    detail::set_turning<T>(e, v, s.turning);
    if (sections_[i].damped()) s.rate = transposed_product(s.at.R, detail::slope<T>(v, 6 * e, 6, free.chord));
    sections_[i].stress(s);
  }
  template <int i, StateScalar T, std::invocable<int> Moment>
  void point_force(Index e, std::span<T const> q, std::span<T const> v, Moment const& moment, Vec<T, 12>& out) const {
    SectionStrains<T> s;
    strain<i, T>(e, q, v, s);
    Vec<T, 3> const pull = product(s.at.R, s.n), slide = cross(s.n, s.gamma), t = scaled<T>(slide, l_);
    Vec<T, 6> const of_t = transposed_product(s.at.spin, t), of_m = transposed_product(s.at.bend, s.m);
    double const ratio = l_ / s.chord;
    for (int node = 0; node < 2; ++node) {
      Vec<T, 3> const other = moment(node);
      for (int k = 0; k < 3; ++k) {
        out[6 * node + k] = pull[k] * (node == 0 ? ratio : -ratio);
        out[6 * node + 3 + k] = other[k] - (of_t[3 * node + k] + of_m[3 * node + k]);
      }
    }
  }
  template <int i, class T>
  void point_tangent(Index e, std::span<double const> q, std::span<double const> v, double ck, double cd,
                     Mat<T, 12, 12>& k) const {
    SectionStrains<T> s;
    strain<i, T>(e, q, v, s);
    StrainGradient by;
    Vec<T, 3> const t = scaled<T>(cross(s.n, s.gamma), l_);
    Quaternion<T> const a = detail::turned<T>(q, e), b = detail::turned<T>(q, e + 1);
    if constexpr (PathDependentInterpolation<Interpolation>)
      interpolation_.gradient(detail::carried_section<double>(q, size(), e), s.m, s.turning, by);
    else if constexpr (i == middle)
      interpolation_.gradient(a, b, t, s.m, s.turning, by);
    else
      detail::strain_gradient(interpolation_, Quadrature::points[i].xi, {a, b}, {t, s.m, s.turning}, by);
    sections_[i].tangent(s, by, ck, cd, k);
  }
  template <int i>
  Vec6 strains_in(Index e, std::span<double const> q) const {
    StrainSection<double> at;
    Vec3 gamma;
    place<i, double>(e, q, at, gamma);
    detail::FreeStrain const& free = free_[std::size_t(e)].at[i];
    Vec6 x;
    for (int k = 0; k < 3; ++k) x[k] = gamma[k] - free.gamma[k];
    for (int k = 0; k < 3; ++k) x[3 + k] = (at.turn[k] - free.turn[k]) / l_;
    return x;
  }

  Interpolation interpolation_;
  std::array<LrvfSection, count> sections_;
  double l_;
  std::vector<Free> free_;
};

}  // namespace polybody
