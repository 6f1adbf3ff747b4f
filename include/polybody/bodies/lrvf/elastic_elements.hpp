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

#include <polybody/bodies/lrvf/lrvf_section.hpp>
#include <polybody/bodies/lrvf/strain_quadrature.hpp>
#include <polybody/bodies/shared/frame_secants.hpp>

namespace polybody {

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
  /// `sections` are those of all elements, or of each.
  ElasticElements(std::vector<LrvfSection> const& sections, Placement const& placement, double l, Index elements)
      : interpolation_(placement), sections_(sections), l_(l), free_(std::size_t(elements)) {}

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

  /// Calls f(section, strains) for each point of element e with the secants of (Γ, K) over a step, for the motion `x`
  /// between the nodes:  Γ = exp(−ξφ) R₁ᵀ (r₂ − r₁)/c₀ − Γ₀,  l K = φ − φ₀.
  template <class S, class F>
  void for_each_strain(Index e, RelativeSecant<S> const& x, F&& f) const {
    Free const& free = free_[std::size_t(e)];
    for_points<0, count>([&]<int i>() {
      Vec<S, 3> const gamma = transposed_product<S>(exp_so3<S>(scaled<S>(x.phi, Quadrature::points[i].xi)), x.chord);
      Vec<S, 6> strains;
      for (int k = 0; k < 3; ++k) {
        strains[k] = gamma[k] / free.chord - free.at[i].gamma[k];
        strains[3 + k] = (x.phi[k] - free.at[i].turn[k]) / l_;
      }
      f(section<i>(e), strains);
    });
  }

  /// Strain energy of element e [J].
  double energy(Index e, std::span<double const> q) const {
    double sum = section<0>(e).energy(strains_in<0>(e, q));
    for_points<1, count>([&]<int i>() { sum += section<i>(e).energy(strains_in<i>(e, q)); });
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
      if (Quadrature::points[std::size_t(i)].xi == 0.5) return i;
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
    if (section<i>(e).damped()) s.rate = transposed_product(s.at.R, detail::slope<T>(v, 6 * e, 6, free.chord));
    section<i>(e).stress(s);
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
    section<i>(e).tangent(s, by, ck, cd, k);
  }
  template <int i>
  LrvfSection const& section(Index e) const {
    return sections_[e][i];
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
  detail::QuadratureSections<Quadrature> sections_;
  double l_;
  std::vector<Free> free_;
};

}  // namespace polybody
