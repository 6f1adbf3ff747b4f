#pragma once
/// \file
/// Linear interpolation of directors, a policy of `Lrvf` for comparison [Romero & Armero 2002; Betsch & Steinmann
/// 2002].
/// Theory: Eq. 2.70.

#include <polybody/bodies/lrvf/elastic_elements.hpp>
#include <polybody/bodies/lrvf/polar_interpolation.hpp>

namespace polybody {

/// Linear interpolation of directors, dᵢ(ξ) = (1 − ξ) dᵢ(0) + ξ dᵢ(1) [Romero & Armero 2002; Betsch & Steinmann 2002].
/// The directors are the columns of Λ = (1 − ξ) R₁ + ξ R₂. Between the nodes Λ is not a rotation matrix. The strains
/// follow from the directors:
///   Γᵢ = dᵢ·r′ − Γ₀ᵢ,  Kᵢ = ½ εᵢⱼₖ dₖ·dⱼ′ − K₀ᵢ.
/// If node 2 is rotated relative to node 1 by φ about the axis n, K + K₀ = sin φ/l n in every section.
/// The policy is objective, and its strains do not depend on the path. In an element that bends by φ, the directors
/// normal to n are shorter than one: in the middle their length is cos(φ/2). Γ is reduced accordingly. The bending
/// energy ½ EI sin²φ/l is largest at φ = π/2: an element with a larger angle is driven to φ = π, at which its energy is
/// zero. The axes of markers are the rotation nearest to Λ, as in `Polar`.
class Directors : public Polar {
 public:
  using Polar::Polar;
};

namespace detail {
/// Directors of one section, and the derivatives of Γ with respect to the rotations of the nodes.
template <StateScalar T>
struct DirectorSection {
  Mat<T, 3, 3> directors;  ///< directors Λ
  Mat<T, 3, 6> slide;      ///< H: δΓ = Λᵀ (δr₂ − δr₁)/c₀ + H (δθ₁, δθ₂)
};
}  // namespace detail

/// Elements with interpolated directors. With δΓ = Λᵀ δr′ + (1 − ξ) (R₁ᵀr′) × δθ₁ + ξ (R₂ᵀr′) × δθ₂ and δ(l K) = δu
/// (`RelativeTurn`), the forces are f_r = ± l/c₀ Λ N,  f_θ = −(l Hᵀ N + Uᵀ M), with H of `DirectorSection` and U =
/// `by_u` of `RelativeTurn`. The upper sign is that of node 1. The tangents are the derivatives of the forces by dual
/// numbers.
template <StrainQuadrature Quadrature>
class ElasticElements<Directors, Quadrature> {
 public:
  /// Chain of `elements` elements, each of arc length l [m]. `sections` are those of all elements, or of each.
  ElasticElements(std::vector<LrvfSection> const& sections, Placement const&, double l, Index elements)
      : sections_(sections), l_(l), free_(std::size_t(elements)) {}

  Index size() const { return Index(free_.size()); }  ///< number of elements

  /// Sets the stress-free state of element e to q, with the distance `chord` of its nodes [m].
  void set_free(Index e, std::span<double const> q, double chord) {
    Free& free = free_[std::size_t(e)];
    free.chord = chord;
    for (int i = 0; i <= count; ++i) free.at[i] = measured(i, e, q, chord);
  }

  /// Writes the elastic and damping force of element e to `out`, plus the moment `moment(i)` on each node i.
  template <StateScalar T, std::invocable<int> Moment>
  void force(Index e, std::span<T const> q, std::span<T const> v, Moment const& moment, Vec<T, 12>& out) const {
    out = detail::zeros<Vec<T, 12>>();
    for (int node = 0; node < 2; ++node) {
      Vec<T, 3> const other = moment(node);
      for (int k = 0; k < 3; ++k) out[6 * node + 3 + k] = other[k];
    }
    add_force<T>(e, q.subspan(std::size_t(7 * e), 14), v.subspan(std::size_t(6 * e), 12), out);
  }

  /// Tangent ck (−∂f/∂δ) + cd (−∂f/∂v): the derivative of −f(q ⊞ ck δ, v + cd δ) with respect to δ.
  template <class T, StateScalar D = Dual<12>>  // compiled only if used
  void tangent(Index e, std::span<double const> q, std::span<double const> v, double ck, double cd,
               Mat<T, 12, 12>& k) const {
    std::array<D, 14> at;
    std::array<D, 12> moving;
    for (int node = 0; node < 2; ++node) {
      for (int i = 0; i < 3; ++i) {
        at[std::size_t(7 * node + i)] = D(q[std::size_t(7 * (e + node) + i)]);
        at[std::size_t(7 * node + i)].d[6 * node + i] = ck;
      }
      Quaternion<D> const turning = detail::turning_quaternion<12>(detail::turned<T>(q, e + node), 6 * node + 3, ck);
      for (int i = 0; i < 4; ++i) at[std::size_t(7 * node + 3 + i)] = turning[i];
    }
    for (int i = 0; i < 12; ++i) {
      moving[std::size_t(i)] = D(v[std::size_t(6 * e + i)]);
      moving[std::size_t(i)].d[i] = cd;
    }
    Vec<D, 12> f = detail::zeros<Vec<D, 12>>();
    add_force<D>(e, std::span<D const>(at), std::span<D const>(moving), f);
    for (int c = 0; c < 12; ++c)
      for (int r = 0; r < 12; ++r) k(r, c) = -f[r].d[c];
  }

  /// Strain energy of element e [J].
  double energy(Index e, std::span<double const> q) const {
    double sum = 0.0;
    for (int i = 0; i < count; ++i) sum += sections_[e][std::size_t(i)].energy(strains(i, e, q));
    return l_ * sum;
  }
  /// Strains (Γ, K) in the middle of element e, components along the directors [1], [1/m].
  Vec6 strains(Index e, std::span<double const> q) const { return strains(count, e, q); }

 private:
  static constexpr int count = int(Quadrature::points.size());
  /// Position ξ of point i. The last point, after those of the quadrature, is the middle.
  static constexpr double place(int i) { return i == count ? 0.5 : Quadrature::points[std::size_t(i)].xi; }
  struct Free {
    double chord = 1.0;  ///< c₀ [m]
    std::array<detail::FreeStrain, count + 1> at;
  };

  template <StateScalar T>
  static void set_section(double xi, std::array<Mat<T, 3, 3>, 2> const& nodes, Vec<T, 3> const& slope,
                          detail::DirectorSection<T>& out) {
    double const share[] = {1.0 - xi, xi};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) out.directors(i, j) = nodes[0](i, j) * share[0] + nodes[1](i, j) * share[1];
    for (int node = 0; node < 2; ++node) {
      Mat<T, 3, 3> const x = skew<T>(transposed_product(nodes[std::size_t(node)], slope));
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) out.slide(i, 3 * node + j) = x(i, j) * share[node];
    }
  }
  /// Adds the force of element e; q and v contain only this element.
  template <StateScalar T>
  void add_force(Index e, std::span<T const> q, std::span<T const> v, Vec<T, 12>& out) const {
    Free const& free = free_[std::size_t(e)];
    Quaternion<T> const a = detail::turned<T>(q, 0), b = detail::turned<T>(q, 1);
    detail::RelativeTurn<T> const turn(a, b);
    std::array<Mat<T, 3, 3>, 2> const nodes = {rotation_matrix<T>(a), rotation_matrix<T>(b)};
    Vec<T, 3> const slope = detail::slope<T>(q, 0, 7, free.chord), rate = detail::slope<T>(v, 0, 6, free.chord);
    double const ratio = l_ / free.chord;
    for (int i = 0; i < count; ++i) {
      detail::DirectorSection<T> at;
      set_section<T>(place(i), nodes, slope, at);
      SectionStrains<T> s;
      s.gamma = transposed_product(at.directors, slope);
      detail::set_turning<T>(0, v, s.turning);
      s.at.spin = detail::zeros<Mat<T, 3, 6>>();  // `rate` contains all of Γ˙
      s.at.bend = turn.by_u;
      Vec<T, 3> const moved = transposed_product(at.directors, rate), slid = detail::of_nodes(at.slide, s.turning);
      for (int k = 0; k < 3; ++k) {
        s.n[k] = s.gamma[k] - free.at[std::size_t(i)].gamma[k];
        s.m[k] = turn.u[k] - free.at[std::size_t(i)].turn[k];
        s.rate[k] = moved[k] + slid[k];
      }
      sections_[e][std::size_t(i)].stress(s);
      Vec<T, 3> const pull = product(at.directors, s.n);
      Vec<T, 6> const of_n = transposed_product(at.slide, s.n), of_m = transposed_product(turn.by_u, s.m);
      for (int k = 0; k < 3; ++k)
        for (int node = 0; node < 2; ++node) {
          out[6 * node + k] += pull[k] * (node == 0 ? ratio : -ratio);
          out[6 * node + 3 + k] -= of_n[3 * node + k] * l_ + of_m[3 * node + k];
        }
    }
  }
  /// Strains Γ and l K at point i, including their values in the reference configuration.
  static detail::FreeStrain measured(int i, Index e, std::span<double const> q, double chord) {
    Quaternion<double> const a = detail::turned<double>(q, e), b = detail::turned<double>(q, e + 1);
    Vec<double, 3> const slope = detail::slope<double>(q, 7 * e, 7, chord);
    detail::DirectorSection<double> at;
    set_section<double>(place(i), {rotation_matrix<double>(a), rotation_matrix<double>(b)}, slope, at);
    return {transposed_product(at.directors, slope), detail::RelativeTurn<double>(a, b).u};
  }
  Vec6 strains(int i, Index e, std::span<double const> q) const {
    Free const& free = free_[std::size_t(e)];
    detail::FreeStrain const now = measured(i, e, q, free.chord), &then = free.at[std::size_t(i)];
    Vec6 x;
    for (int k = 0; k < 3; ++k) x[k] = now.gamma[k] - then.gamma[k];
    for (int k = 0; k < 3; ++k) x[3 + k] = (now.turn[k] - then.turn[k]) / l_;
    return x;
  }

  detail::QuadratureSections<Quadrature> sections_;
  double l_;
  std::vector<Free> free_;
};

}  // namespace polybody
