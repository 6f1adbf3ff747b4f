#pragma once
/// \file
/// Elastic force and tangent of an element from a group of strains at its quadrature points.
/// Theory: Eqs. 2.20 to 2.23, 2.126.

#include <numeric>

#include <polybody/bodies/shared/strain_points.hpp>

namespace polybody {

/// Force and tangent of an element from the strains of a law. The energy is
///   U = ∫ Σ_i [½ C_i (ε_i(p) − ε⁰_i)² + n⁰_i (ε_i(p) − ε⁰_i)] dx,  with the parameters p = P(x) e of the group.
/// The parameters are linear in the coordinates e of the element. ε⁰ are the stress-free strains, and n⁰ is the initial
/// stress; both are zero by default. With the damping times τ_i (Kelvin–Voigt), the stress is n_i = C_i (ε_i −
/// ε⁰_i + τ_i ε̇_i) + n⁰_i. With B = ∂ε/∂p and H_i = ∂²ε_i/∂p²,
///   f = −∫ Pᵀ Bᵀ n dx,
///   −∂f/∂e = ∫ Pᵀ [Bᵀ C B + Σ n_i H_i + Σ C_i τ_i B_iᵀ (H_i ṗ)ᵀ] P dx,
///   −∂f/∂ė = ∫ Pᵀ Bᵀ C τ B P dx.
/// If strains are components of a vector that rotates with the body, only a part of ε̇ is deformation. The law then
/// defines this part, P_ε ε̇ (`objective_rate`), which replaces ε̇. If `coupled`, the stress is n = C (ε − ε⁰) + D ε̇ +
/// n⁰ with symmetric matrices C and D of each point, and C τ in the tangents is D. P is sparse (`StrainMap`). The code
/// uses plain loops, which work for doubles, dual numbers and SIMD vectors of elements, and compile fast.
template <StrainFunctions Law, bool coupled = false>
class StrainGroup : public StrainPoints<Law, coupled> {
  using Points = StrainPoints<Law, coupled>;

 protected:
  using Points::quadratic, Points::stiffness_, Points::time_, Points::initial_, Points::damped_, Points::maps_,
      Points::products_, Points::weights_, Points::free_, Points::elastic, Points::viscous;

 public:
  using Points::np, Points::m, Points::Points;
  using typename Points::P;  ///< map from e to p
  template <class T, int n>
  using Coordinates = typename P::template Coordinates<T, n>;  ///< coordinates ê of an element (`StrainMap`)

  /// Adds the force of the group at coordinates x and velocities xd, f += f(x, xd).
  template <KernelScalar T, int n>
  void add_force(Vec<T, n> const& x, Vec<T, n> const& xd, Vec<T, n>& f) const {
    Coordinates<T, n> const e(x), ed(xd);
    Vec<T, P::d> step;
    for (int i = 0; i < P::d; ++i) step[i] = T(0.0);
    for (int g = 0; g < Law::points; ++g) {
      Vec<T, np> const p = P::parameters(maps_[std::size_t(g)], e);
      Vec<T, m> stress;
      Mat<T, m, np> b;
      Law::template evaluate<T>(p, stress, b);
      to_stress(
          g, weights_[std::size_t(g)], [&] { return rates(b, P::parameters(maps_[std::size_t(g)], ed)); }, stress);
      Vec<T, np> pull;  // w Bᵀ n
#pragma GCC unroll 16
      for (int k = 0; k < np; ++k) {
        T sum = b(0, k) * stress[0];
#pragma GCC unroll 8
        for (int i = 1; i < m; ++i) sum += b(i, k) * stress[i];
        pull[k] = sum;
      }
      P::subtract_pulled(maps_[std::size_t(g)], pull, f, step);
    }
    P::spread(step, f);
  }

  // `tangent_of` assembles the tangent from all groups of an element: it calls `prepare` once, then `add_block` for
  // each block.
  /// Data for the blocks of the tangent: the stiffness h of each point with respect to p. For quadratic strains, the
  /// data are the tangent K̂ with respect to the nodal vectors ê_v of `StrainMap`.
  template <KernelScalar T>
  struct Prepared {
    using Each = std::array<Mat<T, np, np>, std::size_t(Law::points)>;                ///< h of each point
    std::conditional_t<quadratic, Mat<T, P::d * P::reach, P::d * P::reach>, Each> h;  ///< h of each point, or K̂
    Prepared() {}  // NOLINT(modernize-use-equals-default): a defaulted constructor would fill the matrices with zeros
  };

  /// Computes the tangent K̂ of quadratic strains, with N of `StrainMap` and S_i of `QuadraticStrains`:
  ///   K̂_vw = Σ_points (Σ_i β_iv γ_iwᵀ + 1 Σ_st N_sv N_tw σ_st),
  ///   β = B P,  γ = w C [ck B + τ (ck Ḃ + cd B)] P,  Ḃ_i = H_i ṗ,  σ = ck w Σ n_i S_i.
  /// If few strains read many vectors, K̂ takes fewer operations than Pᵀ h P. w is the weight of a point. The loop
  /// processes a few points at a time, so that their data fit into the first-level cache. The blocks above the diagonal
  /// are omitted if `symmetric`.
  template <KernelScalar T, int n>
  void prepare(Vec<T, n> const& x, Vec<T, n> const& xd, double ck, double cd, bool symmetric, Prepared<T>& k) const
    requires quadratic
  {
    constexpr int d = P::d, reach = P::reach, shapes = P::shapes, size = d * reach;
    constexpr int chunk = std::gcd(Law::points, std::max(1, 12 / m)), rows = chunk * m;
    Coordinates<T, n> const e(x), ed(xd);
    for (int first = 0; first < Law::points; first += chunk) {
      std::array<Vec<T, size>, std::size_t(rows)> left, right;     // β, γ
      std::array<Mat<T, shapes, reach>, std::size_t(chunk)> bend;  // σ N
      for (int c = 0; c < chunk; ++c) {
        int const g = first + c;
        Vec<T, np> const p = P::parameters(maps_[g], e), pd = P::parameters(maps_[g], ed);
        Vec<T, m> stress, unused;
        Mat<T, m, np> b, change;
        Law::template evaluate<T>(p, stress, b);
        Law::template evaluate<T>(pd, unused, change);
        for (int i = 0; i < m; ++i)
          for (int q = 0; q < np; ++q)
            change(i, q) =
                (b(i, q) * (ck + time_[i] * cd) + change(i, q) * (time_[i] * ck)) * (weights_[g] * stiffness_[i]);
        to_stress(g, ck * weights_[g], [&] { return rates(b, pd); }, stress);
        for (int i = 0; i < m; ++i) {
          P::pull_row(maps_[g], b, i, left[c * m + i]);
          P::pull_row(maps_[g], change, i, right[c * m + i]);
        }
        Mat<T, shapes, shapes> s;
        for (int t = 0; t < shapes; ++t)
          for (int r = 0; r < shapes; ++r) s(r, t) = T(0.0);
        Law::template add_hessian<T>(stress, s);
        for (int j = 0; j < reach; ++j)
          for (int t = 0; t < shapes; ++t) {
            T sum = s(t, 0) * maps_[g](0, j);
            for (int r = 1; r < shapes; ++r) sum += s(t, r) * maps_[g](r, j);
            bend[c](t, j) = sum;
          }
      }
      for (int v = 0; v < reach; ++v)
        for (int w = 0; w < (symmetric ? v + 1 : reach); ++w) {
          T along(0.0);
          for (int c = 0; c < chunk; ++c)
            for (int t = 0; t < shapes; ++t) along += bend[c](t, v) * maps_[first + c](t, w);
          typename P::template Block<T> sum;
          P::for_each_entry([&](int i, int j) { sum(i, j) = i == j ? along : T(0.0); });
          for (int r = 0; r < rows; ++r)
            P::for_each_entry([&](int i, int j) { sum(i, j) += left[r][d * v + i] * right[r][d * w + j]; });
          T* const to = k.h.data() + d * (v + size * w);
          P::for_each_entry(
              [&](int i, int j) { to[size * j + i] = first == 0 ? sum(i, j) : to[size * j + i] + sum(i, j); });
        }
    }
  }
  /// Adds the block K̂_vw of this group to `block`, for the nodal vectors v and w.
  template <KernelScalar T>
  void add_block(int v, int w, Prepared<T> const& k, typename P::template Block<T>& block) const
    requires quadratic
  {
    if (!P::reads(v) || !P::reads(w)) return;
    auto const& at = P::table.pairs[P::table.first[v][w]];
    T const* const from = k.h.data() + P::d * (at.j + P::d * P::reach * at.l);
    P::for_each_entry([&](int i, int j) { block(i, j) += from[P::d * P::reach * j + i]; });
  }

  /// Computes the stiffness h = w [ck (BᵀCB + Σ n_i H_i) + damping terms] of each point (`add_damping_gradient`).
  template <KernelScalar T, int n>
  void prepare(Vec<T, n> const& x, Vec<T, n> const& xd, double ck, double cd, bool, Prepared<T>& hs) const
    requires(!quadratic)
  {
    Coordinates<T, n> const e(x), ed(xd);
    for (int g = 0; g < Law::points; ++g) {
      Mat<T, np, np>& h = hs.h[std::size_t(g)];
      Moving<T> at;
      at.p = P::parameters(maps_[std::size_t(g)], e);
      Law::template evaluate<T>(at.p, at.strain, at.b);
#pragma GCC unroll 8
      for (int r = 0; r < np; ++r) {
        Vec<T, m> scaled;
#pragma GCC unroll 8
        for (int i = 0; i < m; ++i) scaled[i] = elastic(g, i, at.b.data() + m * r, ck * weights_[std::size_t(g)]);
#pragma GCC unroll 8
        for (int c = 0; c <= r; ++c) {
          T sum = scaled[0] * at.b(0, c);
#pragma GCC unroll 8
          for (int i = 1; i < m; ++i) sum += scaled[i] * at.b(i, c);
          h(r, c) = sum;
          h(c, r) = sum;
        }
      }
      Vec<T, m> stress = at.strain;
      if (damped_) {
        at.pd = P::parameters(maps_[std::size_t(g)], ed);
        at.rate = rates(at.b, at.pd);
        add_damping_gradient(g, ck, cd, at, h);
      }
      to_stress(g, ck * weights_[std::size_t(g)], [&] { return at.rate; }, stress);
      Law::template add_hessian<T>(at.p, stress, h);
    }
  }
  /// Adds the block K̂_vw of this group to `block`, for the nodal vectors v and w.
  template <KernelScalar T>
  void add_block(int v, int w, Prepared<T> const& hs, typename P::template Block<T>& block) const
    requires(!quadratic)
  {
    if (v >= P::vectors || w >= P::vectors) return;
    for (int pair = P::table.first[std::size_t(v)][std::size_t(w)];
         pair < P::table.last[std::size_t(v)][std::size_t(w)]; ++pair) {
      int const from = P::d * (P::table.pairs[std::size_t(pair)].s + np * P::table.pairs[std::size_t(pair)].t);
#pragma GCC unroll 16
      for (int g = 0; g < Law::points; ++g) {
        T const product(products_[std::size_t(pair)][std::size_t(g)]);
        T const* const h = hs.h[std::size_t(g)].data() + from;
        P::for_each_entry([&](int i, int j) { block(i, j) += product * h[np * j + i]; });
      }
    }
  }

 private:
  /// Parameters p and strains at a point, their rates, and the derivative B of the strains.
  template <class T>
  struct Moving {
    Vec<T, np> p, pd;
    Vec<T, m> strain, rate;
    Mat<T, m, np> b;  ///< B = ∂ε/∂p
  };

  /// Strain rates ε̇ = B ṗ.
  template <class T>
  static Vec<T, m> rates(Mat<T, m, np> const& b, Vec<T, np> const& pd) {
    Vec<T, m> rate;
#pragma GCC unroll 8
    for (int i = 0; i < m; ++i) {
      T sum = b(i, 0) * pd[0];
#pragma GCC unroll 8
      for (int k = 1; k < np; ++k) sum += b(i, k) * pd[k];
      rate[i] = sum;
    }
    return rate;
  }

  /// Replaces the strains ε at point g by the stress w n. \param rate_of returns ε̇ of a damped group
  template <class T, class RateOf>
  void to_stress(int g, double w, RateOf&& rate_of, Vec<T, m>& strain) const {
    if constexpr (coupled) {
      Vec<T, m> stretch, rate;
      for (int i = 0; i < m; ++i) stretch[i] = strain[i] - free_[std::size_t(g)][i];
      if (damped_) rate = rate_of();
      for (int i = 0; i < m; ++i) {
        strain[i] = elastic(g, i, stretch.data(), w) + w * initial_[i];
        if (damped_) strain[i] += viscous(g, i, rate.data(), w);
      }
    } else {
      if (damped_) {
        Vec<T, m> rate = rate_of();
        if constexpr (HasObjectiveRate<Law>) Law::template objective_rate<T>(strain, rate);
#pragma GCC unroll 8
        for (int i = 0; i < m; ++i) strain[i] += rate[i] * time_[i];
      }
#pragma GCC unroll 8
      for (int i = 0; i < m; ++i)
        strain[i] = ((strain[i] - free_[std::size_t(g)][i]) * stiffness_[i] + initial_[i]) * w;
    }
  }

  /// Adds the derivative of the damping at point g with the weight w, h += Σ_i w C_i τ_i B_iᵀ Σ_j [D_ij (ck (H_j ṗ)ᵀ +
  /// cd B_j) + ck Q_ij B_j], with D = P_ε and Q of `HasObjectiveRate`. Most laws have D = 1 and Q = 0.
  template <class T>
  void add_damping_gradient(int g, double ck, double cd, Moving<T> const& at, Mat<T, np, np>& h) const {
    Mat<T, m, np> change;  // rows ck H_j ṗ + cd B_j
    if constexpr (HasSlopeRate<Law>) {
      Law::template slope_rate<T>(at.p, at.pd, change);
      for (int k = 0; k < m * np; ++k) change.data()[k] = at.b.data()[k] * cd + change.data()[k] * ck;
    } else {
      for (int j = 0; j < m; ++j) {
        Mat<T, np, np> second;
        Vec<T, m> only;
        for (int c = 0; c < np; ++c)
          for (int r = 0; r < np; ++r) second(r, c) = T(0.0);
        for (int i = 0; i < m; ++i) only[i] = T(i == j ? ck : 0.0);
        Law::template add_hessian<T>(at.p, only, second);
        for (int c = 0; c < np; ++c) {
          T sum = at.b(j, c) * cd;
          for (int q = 0; q < np; ++q) sum += second(c, q) * at.pd[q];
          change(j, c) = sum;
        }
      }
    }
    if constexpr (HasObjectiveRate<Law>) {
      Mat<T, m, m> by_rate, by_strain;
      Law::template objective_rate_gradients<T>(at.strain, at.rate, by_rate, by_strain);
      Mat<T, m, np> const whole = change;
      for (int i = 0; i < m; ++i)
        for (int c = 0; c < np; ++c) {
          T sum(0.0);
          for (int j = 0; j < m; ++j) sum += by_rate(i, j) * whole(j, c) + by_strain(i, j) * at.b(j, c) * ck;
          change(i, c) = sum;
        }
    }
    for (int i = 0; i < m; ++i)
      for (int c = 0; c < np; ++c) {
        T const factor = viscous(g, i, change.data() + m * c, weights_[std::size_t(g)]);
        for (int r = 0; r < np; ++r) h(r, c) += at.b(i, r) * factor;
      }
  }
};

}  // namespace polybody
