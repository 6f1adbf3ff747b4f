#pragma once
/// \file
/// Constant linear map p = P e from the coordinates of an element to the parameters of its strains at a point.

#include <algorithm>
#include <array>

#include <polybody/math/simd_vector.hpp>
#include <polybody/math/types.hpp>

namespace polybody {

/// Constant linear map p = P e from the coordinates of an element to the parameters of its strains at a point, and
/// products with P. The parameters of a law form vectors of d = `components` entries, called shapes; np is the total
/// number of entries. Shape s reads at most `reach` nodal vectors. Vector number j of shape s is e_v with v =
/// `vector(s, j)`. One factor N_sj multiplies all components of e_v:
///   p_s = Σ_j N_sj ê_v,  P = N ⊗ 1.
/// ê_v = e_v, except for the vector `difference` of a law: ê_v = e_v − e_0. Strains do not depend on the position of an
/// element. The factors of the positions of its two ends are therefore opposite, and the difference replaces both
/// positions. K̂ = PᵀhP then has the blocks
///   K̂_vw = Σ_(s,j) Σ_(t,l) N_sj N_tl h_st,  v = vector(s, j), w = vector(t, l),
/// with one product for each pair of factors. The tangent K with respect to e has K_0w = −K_vw for the difference v.
template <class Law>
class StrainMap {
 public:
  static constexpr int d = Law::components, np = Law::parameters, shapes = np / d, reach = Law::reach;  ///< sizes of P

  using Factors = Mat<double, shapes, reach>;  ///< matrix of the factors N
  template <class T>
  using Block = Mat<T, d, d>;  ///< block for two nodal vectors

  /// Nodal vector that is read relative to the first one; 0 if there is none.
  static constexpr int difference = [] {
    if constexpr (requires { Law::difference; })
      return int(Law::difference);
    else
      return 0;
  }();
  /// Returns true if ê_v of nodal vector v is the difference e_v − e_0.
  static constexpr bool is_difference(int v) { return difference > 0 && v == difference; }

  /// Calls f(i, j) for the entries of a block.
  template <class F>
  static void for_each_entry(F&& f) {
#pragma GCC unroll 4
    for (int j = 0; j < d; ++j)
#pragma GCC unroll 4
      for (int i = 0; i < d; ++i) f(i, j);
  }

  /// Coordinates ê of an element.
  template <class T, int n>
  struct Coordinates {
    Vec<T, n> const& e;  ///< must outlive this object
    Vec<T, d> step;      ///< difference e_v − e_0; e_0 if the law has no `difference`
    /// Computes the difference from the coordinates x. x must outlive this object.
    explicit Coordinates(Vec<T, n> const& x) : e(x) {
      for (int i = 0; i < d; ++i) step[i] = difference > 0 ? x[d * difference + i] - x[i] : x[i];
    }
    /// Entry i of ê_v for nodal vector v.
    T const& operator()(int v, int i) const { return is_difference(v) ? step[i] : e[d * v + i]; }
  };

  /// Parameters p = P e for the coordinates x of an element.
  template <class T, int n>
  static Vec<T, np> parameters(Factors const& factors, Coordinates<T, n> const& x) {
    Vec<T, np> p;
#pragma GCC unroll 16
    for (int k = 0; k < np; ++k) {
      T sum = x(Law::vector(k / d, 0), k % d) * factors(k / d, 0);
#pragma GCC unroll 8
      for (int j = 1; j < reach; ++j)
        if (Law::vector(k / d, j) >= 0) sum += x(Law::vector(k / d, j), k % d) * factors(k / d, j);
      p[k] = sum;
    }
    return p;
  }
  /// Subtracts Pᵀ s from the force f. The part that belongs to the difference is subtracted from `step`; see `spread`.
  template <class T, int n>
  static void subtract_pulled(Factors const& factors, Vec<T, np> const& s, Vec<T, n>& f, Vec<T, d>& step) {
#pragma GCC unroll 8
    for (int j = 0; j < reach; ++j)
#pragma GCC unroll 16
      for (int k = 0; k < np; ++k) {
        int const v = Law::vector(k / d, j);
        if (v >= 0) (is_difference(v) ? step[k % d] : f[d * v + k % d]) -= s[k] * factors(k / d, j);
      }
  }
  /// Adds `step`, the force on the difference e_v − e_0, to the force on e_v in f, and subtracts it from the force on
  /// e_0.
  template <class T, int n>
  static void spread(Vec<T, d> const& step, Vec<T, n>& f) {
    if constexpr (difference > 0)
      for (int i = 0; i < d; ++i) {
        f[i] -= step[i];
        f[d * difference + i] += step[i];
      }
  }

  /// Adds k += Pᵀ h P entry by entry, for any h.
  template <int n>
  static void add_mapped(Factors const& factors, Mat<double, np, np> const& h, Mat<double, n, n>& k) {
    Mat<double, np, n> p = Mat<double, np, n>::Zero();
    for (int r = 0; r < np; ++r)
      for (int j = 0; j < reach; ++j) {
        int const v = Law::vector(r / d, j);
        if (v < 0) continue;
        p(r, d * v + r % d) += factors(r / d, j);
        if (is_difference(v)) p(r, r % d) -= factors(r / d, j);
      }
    for (int c = 0; c < n; ++c)
      for (int r = 0; r < np; ++r) {
        double sum = 0.0;  // entry of h P
        for (int q = 0; q < np; ++q) sum += h(r, q) * p(q, c);
        if (sum == 0.0) continue;
        for (int i = 0; i < n; ++i) k(i, c) += p(r, i) * sum;
      }
  }

  /// Computes row `row` of B P, where B is `b`, with respect to the nodal vectors that all shapes read.
  template <class T, int m>
  static void pull_row(Factors const& factors, Mat<T, m, np> const& b, int row, Vec<T, d * reach>& out) {
    for (int j = 0; j < reach; ++j)
#pragma GCC unroll 4
      for (int i = 0; i < d; ++i) {
        T sum = b(row, i) * factors(0, j);
#pragma GCC unroll 4
        for (int s = 1; s < shapes; ++s) sum += b(row, d * s + i) * factors(s, j);
        out[d * j + i] = sum;
      }
  }

  /// Largest index of a nodal vector that is read, plus one.
  static constexpr int vectors = [] {
    int most = 0;
    for (int s = 0; s < shapes; ++s)
      for (int j = 0; j < reach; ++j) most = std::max(most, Law::vector(s, j));
    return most + 1;
  }();
  /// Number of factors N_sj that belong to a nodal vector, `vector(s, j)` ≥ 0.
  static constexpr int count = [] {
    int sum = 0;
    for (int s = 0; s < shapes; ++s)
      for (int j = 0; j < reach; ++j) sum += Law::vector(s, j) >= 0;
    return sum;
  }();
  /// Pair of factors N_sj N_tl. Block (v, w) has the pairs [first[v][w], last[v][w]).
  struct Pair {
    int s, j, t, l;  ///< indices of N_sj N_tl
  };
  /// All pairs of factors in the order of the blocks.
  struct Pairs {
    std::array<Pair, std::size_t(count* count)> pairs{};                                      ///< all pairs
    std::array<std::array<int, std::size_t(vectors)>, std::size_t(vectors)> first{}, last{};  ///< range of a block
  };
  /// Table of the pairs, computed at compile time.
  static constexpr Pairs table = [] {
    Pairs out;
    int next = 0;
    for (int v = 0; v < vectors; ++v)
      for (int w = 0; w < vectors; ++w) {
        out.first[std::size_t(v)][std::size_t(w)] = next;
        for (int s = 0; s < shapes; ++s)
          for (int j = 0; j < reach; ++j)
            for (int t = 0; t < shapes; ++t)
              for (int l = 0; l < reach; ++l)
                if (Law::vector(s, j) == v && Law::vector(t, l) == w) out.pairs[std::size_t(next++)] = {s, j, t, l};
        out.last[std::size_t(v)][std::size_t(w)] = next;
      }
    return out;
  }();
  /// Returns true if a shape reads nodal vector v.
  static constexpr bool reads(int v) {
    return v < vectors && table.first[std::size_t(v)][std::size_t(v)] < table.last[std::size_t(v)][std::size_t(v)];
  }
};

}  // namespace polybody
