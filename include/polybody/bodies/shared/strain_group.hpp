#pragma once
/// \file
/// Elastic energy of an element by a group of strains at its quadrature points:
///   U = ½ ∫ Σ_i C_i (ε_i(p) − ε⁰_i)² dx,  p = P(x) e the group's parameters, linear in the element's coordinates e,
/// ε⁰ the strains free of stress (zero unless given), with Kelvin–Voigt damping and initial stress
/// n_i = C_i (ε_i − ε⁰_i + τ_i ε̇_i) + n⁰_i. Then, with B = ∂ε/∂p and H_i = ∂²ε_i/∂p²,
///   f = −∫ Pᵀ Bᵀ n dx,
///   −∂f/∂e = ∫ Pᵀ [Bᵀ C B + Σ n_i H_i + Σ C_i τ_i B_iᵀ (H_i ṗ)ᵀ] P dx,
///   −∂f/∂ė = ∫ Pᵀ Bᵀ C τ B P dx.
/// Where strains are components of a vector that turns with the body, a law says which part of ε̇ is deformation: ε̇ is
/// then replaced by P_ε ε̇ (`objective_rate`). P is sparse (`StrainMap`). Plain loops, for they run on doubles, dual
/// numbers and packs of elements alike, and compile fast.

#include <array>
#include <numeric>

#include <polybody/bodies/shared/step_means.hpp>
#include <polybody/bodies/shared/strain_laws.hpp>
#include <polybody/math/quadrature.hpp>
#include <polybody/math/secant.hpp>

namespace polybody {

template <StrainFunctions Law>
class StrainGroup {
 public:
  static constexpr int np = Law::parameters, m = Law::strains;

  using P = StrainMap<Law>;
  using Map = typename P::Factors;
  template <class T, int n>
  using Coordinates = typename P::template Coordinates<T, n>;
  using Strains = Vec<double, m>;

  StrainGroup() = default;
  /// At the Gauss points of elements of length l [m]; `initial` is the stress in the reference configuration.
  StrainGroup(BarConstants const& c, Damping const& d, double l, Strains const& initial = Strains::Zero())
    requires StrainLaw<Law>
      : StrainGroup(Law::stiffness(c), Law::damping(d)) {
    initial_ = initial;
    for (int g = 0; g < Law::points; ++g)
      set_point(g, gauss<Law::points>[g].weight * l, Law::map(gauss<Law::points>[g].xi, l));
  }
  /// With C and τ [s]; `set_point` gives each of the points.
  StrainGroup(Strains const& stiffness, Strains const& time) : stiffness_(stiffness), time_(time) {
    damped_ = !time_.isZero(0.0);
    free_.fill(Strains::Zero());
  }
  /// Weight [m], factors of P, and strains free of stress of point g.
  void set_point(int g, double weight, Map const& map, Strains const& free = Strains::Zero()) {
    weights_[g] = weight;
    maps_[g] = map;
    free_[g] = free;
    for (std::size_t k = 0; k < products_.size(); ++k) {
      auto const [s, j, t, l] = P::table.pairs[k];
      products_[k][g] = map(s, j) * map(t, l);
    }
  }

  Strains const& stiffness() const { return stiffness_; }
  /// The stress of strains without damping.
  Strains stress(Strains const& strain) const { return stiffness_.cwiseProduct(strain) + initial_; }

  /// ε at ξ of an element of length l with coordinates x.
  template <int n>
  static Strains strains(double xi, double l, Vec<double, n> const& x)
    requires StrainLaw<Law>
  {
    Vec<double, m> strain;
    Mat<double, m, np> b;
    Law::template evaluate<double>(P::parameters(Law::map(xi, l), Coordinates<double, n>(x)), strain, b);
    return strain;
  }

  /// f += the group's force at coordinates x, rates xd.
  template <KernelScalar T, int n>
  void add_force(Vec<T, n> const& x, Vec<T, n> const& xd, Vec<T, n>& f) const {
    Coordinates<T, n> const e(x), ed(xd);
    Vec<T, P::d> step;
    for (int i = 0; i < P::d; ++i) step[i] = T(0.0);
    for (int g = 0; g < Law::points; ++g) {
      Vec<T, np> const p = P::parameters(maps_[g], e);
      Vec<T, m> stress;
      Mat<T, m, np> b;
      Law::template evaluate<T>(p, stress, b);
      if (damped_) add_damping(rates(b, P::parameters(maps_[g], ed)), stress);
#pragma GCC unroll 8
      for (int i = 0; i < m; ++i) stress[i] = ((stress[i] - free_[g][i]) * stiffness_[i] + initial_[i]) * weights_[g];
      Vec<T, np> pull;  // w Bᵀ n
#pragma GCC unroll 16
      for (int k = 0; k < np; ++k) {
        T sum = b(0, k) * stress[0];
#pragma GCC unroll 8
        for (int i = 1; i < m; ++i) sum += b(i, k) * stress[i];
        pull[k] = sum;
      }
      P::subtract_pulled(maps_[g], pull, f, step);
    }
    P::spread(step, f);
  }

  bool damped() const { return damped_; }

  // The tangent is put together from all groups of an element by `tangent_of`: `prepare` once, then `add_block` for
  // each block.
  static constexpr bool quadratic = QuadraticStrains<Law>;

  /// What the tangent's blocks are made of: h of each point, by p; of quadratic strains K̂ itself, by the vectors that
  /// are read.
  template <KernelScalar T>
  struct Prepared {
    using Each = std::array<Mat<T, np, np>, std::size_t(Law::points)>;
    std::conditional_t<quadratic, Mat<T, P::d * P::reach, P::d * P::reach>, Each> h;
    Prepared() {}  // NOLINT(modernize-use-equals-default): a tuple of defaulted ones would fill them with zeros
  };

  /// K̂_vw = Σ_points Σ_i β_iv γ_iwᵀ + 1 Σ_st N_sv N_tw σ_st, with β = B P, γ = w C [ck B + τ (ck Ḃ + cd B)] P, Ḃ_i =
  /// H_i ṗ, and σ = ck w Σ n_i S_i: of few strains that read many vectors this is less work than Pᵀ h P. A few points
  /// at a time, which fit the first cache. The blocks above the diagonal are left out if `symmetric`.
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
        if (damped_) add_damping(rates(b, pd), stress);
        for (int i = 0; i < m; ++i) {
          stress[i] = ((stress[i] - free_[g][i]) * stiffness_[i] + initial_[i]) * (ck * weights_[g]);
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
  template <KernelScalar T>
  void add_block(int v, int w, Prepared<T> const& k, typename P::template Block<T>& block) const
    requires quadratic
  {
    if (!P::reads(v) || !P::reads(w)) return;
    auto const& at = P::table.pairs[P::table.first[v][w]];
    T const* const from = k.h.data() + P::d * (at.j + P::d * P::reach * at.l);
    P::for_each_entry([&](int i, int j) { block(i, j) += from[P::d * P::reach * j + i]; });
  }

  /// h = w [ck (BᵀCB + Σ n_i H_i) + the part of damping].
  template <KernelScalar T, int n>
  void prepare(Vec<T, n> const& x, Vec<T, n> const& xd, double ck, double cd, bool, Prepared<T>& hs) const
    requires(!quadratic)
  {
    Coordinates<T, n> const e(x), ed(xd);
    for (int g = 0; g < Law::points; ++g) {
      Mat<T, np, np>& h = hs.h[g];
      Vec<T, np> const p = P::parameters(maps_[g], e);
      Vec<T, m> stress;
      Mat<T, m, np> b;
      Law::template evaluate<T>(p, stress, b);
#pragma GCC unroll 8
      for (int r = 0; r < np; ++r) {
        Vec<T, m> scaled;
#pragma GCC unroll 8
        for (int i = 0; i < m; ++i) scaled[i] = b(i, r) * (weights_[g] * stiffness_[i] * ck);
#pragma GCC unroll 8
        for (int c = 0; c <= r; ++c) {
          T sum = scaled[0] * b(0, c);
#pragma GCC unroll 8
          for (int i = 1; i < m; ++i) sum += scaled[i] * b(i, c);
          h(r, c) = sum;
          h(c, r) = sum;
        }
      }
      if (damped_) {
        Vec<T, np> const pd = P::parameters(maps_[g], ed);
        Vec<T, m> const rate = rates(b, pd);
        add_damping_gradient(weights_[g], ck, cd, p, pd, stress, rate, b, h);
        add_damping(rate, stress);
      }
#pragma GCC unroll 8
      for (int i = 0; i < m; ++i)
        stress[i] = ((stress[i] - free_[g][i]) * stiffness_[i] + initial_[i]) * (ck * weights_[g]);
      Law::template add_hessian<T>(p, stress, h);
    }
  }
  /// `block` += the group's share of K̂_vw.
  template <KernelScalar T>
  void add_block(int v, int w, Prepared<T> const& hs, typename P::template Block<T>& block) const
    requires(!quadratic)
  {
    if (v >= P::vectors || w >= P::vectors) return;
    for (int pair = P::table.first[v][w]; pair < P::table.last[v][w]; ++pair) {
      int const from = P::d * (P::table.pairs[pair].s + np * P::table.pairs[pair].t);
#pragma GCC unroll 16
      for (int g = 0; g < Law::points; ++g) {
        T const product(products_[pair][g]);
        T const* const h = hs.h[g].data() + from;
        P::for_each_entry([&](int i, int j) { block(i, j) += product * h[np * j + i]; });
      }
    }
  }

  /// f += the group's force over a step from x0 to x1, by secants S of the strains [Gonzalez 1996]:
  ///   −∫ Pᵀ Sᵀ n dx,  n_i = C_i (ε̄_i − ε⁰_i + (decay + τ_i/h) Δε_i) + n⁰_i,  S P Δx = Δε,
  /// so that f·Δx = −ΔU − Σ ∫ C_i (decay + τ_i/h) Δε_i² dx. It has no moment where strains are made of scalar products.
  /// The others, vectors that turn, go by their square z: n_z = ½ C (1 + τ Δz/(2h(z̄ + κ₀²))), κ₀ = 1e-3 1/m, as
  /// `objective_rate` damps; the part of `decay` has a moment then.
  template <int n>
  void add_mean_force(Vec<double, n> const& x0, Vec<double, n> const& x1, StepMeans const& means,
                      Vec<double, n>& f) const {
    using S = Secant<np>;
    Coordinates<double, n> const e0(x0), e1(x1);
    Vec<double, P::d> step = Vec<double, P::d>::Zero();
    for (int g = 0; g < Law::points; ++g) {
      Vec<double, np> const p0 = P::parameters(maps_[g], e0), p1 = P::parameters(maps_[g], e1);
      Vec<S, np> p;
      for (int k = 0; k < np; ++k) p[k] = S::variable(p0[k], p1[k], k);
      typename S::Slope sum = S::Slope::Zero();
      if constexpr (HasSquare<Law>) {
        S const z = Law::template square<S>(p);
        double const damped = time_[0] * means.rate * z.change() / (2.0 * (z.mean() + 1e-6));
        sum = z.d * (0.5 * stiffness_[0] * (1.0 + damped));
      }
      if (!HasSquare<Law> || means.decay > 0.0) {
        Vec<S, m> strain;
        Mat<S, m, np> b;
        Law::template evaluate<S>(p, strain, b);
        for (int i = 0; i < m; ++i) {
          double stretch = means.decay * strain[i].change();
          if constexpr (!HasSquare<Law>)
            stretch += strain[i].mean() - free_[g][i] + time_[i] * means.rate * strain[i].change();
          sum += strain[i].d * (stiffness_[i] * stretch + (HasSquare<Law> ? 0.0 : initial_[i]));
        }
      }
      Vec<double, np> pull;
      for (int k = 0; k < np; ++k) pull[k] = weights_[g] * sum[k];
      P::subtract_pulled(maps_[g], pull, f, step);
    }
    P::spread(step, f);
  }

  /// k += ck (−∂f/∂x1) of `add_mean_force`, not symmetric, with the strains' gradients B̄ and H̄ of the middle for the
  /// secants:
  ///   Pᵀ [B̄ᵀ C (½ + decay + τ/h) B(x1) + ½ Σ n_i H̄_i] P.
  template <int n>
  void add_mean_tangent(Vec<double, n> const& x0, Vec<double, n> const& x1, StepMeans const& means, double ck,
                        Mat<double, n, n>& k) const {
    Coordinates<double, n> const e0(x0), e1(x1);
    for (int g = 0; g < Law::points; ++g) {
      Vec<double, np> const p0 = P::parameters(maps_[g], e0), p1 = P::parameters(maps_[g], e1);
      Vec<double, np> const middle = 0.5 * (p0 + p1);
      Strains from, to, stress;
      Mat<double, m, np> b, end;
      Law::template evaluate<double>(p0, from, b);
      Law::template evaluate<double>(p1, to, end);
      Law::template evaluate<double>(middle, stress, b);
      Mat<double, np, np> h = Mat<double, np, np>::Zero();
      for (int i = 0; i < m; ++i) {
        double const w = ck * weights_[g], share = means.decay + time_[i] * means.rate;
        stress[i] = 0.5 * w *
                    (stiffness_[i] * (0.5 * (from[i] + to[i]) - free_[g][i] + share * (to[i] - from[i])) + initial_[i]);
        for (int c = 0; c < np; ++c)
          for (int r = 0; r < np; ++r) h(r, c) += w * stiffness_[i] * (0.5 + share) * b(i, r) * end(i, c);
      }
      if constexpr (quadratic) {
        Mat<double, P::shapes, P::shapes> of_shapes = Mat<double, P::shapes, P::shapes>::Zero();
        Law::template add_hessian<double>(stress, of_shapes);
        for (int c = 0; c < np; ++c)
          for (int r = c % P::d; r < np; r += P::d) h(r, c) += of_shapes(r / P::d, c / P::d);
      } else {
        Law::template add_hessian<double>(middle, stress, h);
      }
      P::add_mapped(maps_[g], h, k);
    }
  }

  /// The energy stored [J].
  template <int n>
  double energy(Vec<double, n> const& x) const {
    double u = 0.0;
    Coordinates<double, n> const e(x);
    for (int g = 0; g < Law::points; ++g) {
      Vec<double, m> strain;
      Mat<double, m, np> b;
      Law::template evaluate<double>(P::parameters(maps_[g], e), strain, b);
#pragma GCC unroll 8
      for (int i = 0; i < m; ++i) {
        double const stretch = strain[i] - free_[g][i];
        u += weights_[g] * (0.5 * stiffness_[i] * stretch + initial_[i]) * stretch;
      }
    }
    return u;
  }

 private:
  /// ε̇ = B ṗ.
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

  /// strain += τ P_ε ε̇.
  template <class T>
  void add_damping(Vec<T, m> rate, Vec<T, m>& strain) const {
    if constexpr (HasObjectiveRate<Law>) Law::template objective_rate<T>(strain, rate);
#pragma GCC unroll 8
    for (int i = 0; i < m; ++i) strain[i] += rate[i] * time_[i];
  }

  /// h += Σ_i w C_i τ_i B_iᵀ [Σ_j P_ij (ck (H_j ṗ)ᵀ + cd B_j) + ck Q_ij B_j], with P_ε = 1 and Q = 0 for most laws.
  template <class T>
  void add_damping_gradient(double w, double ck, double cd, Vec<T, np> const& p, Vec<T, np> const& pd,
                            Vec<T, m> const& strain, Vec<T, m> const& rate, Mat<T, m, np> const& b,
                            Mat<T, np, np>& h) const {
    Mat<T, m, np> change;  // ck H_j ṗ + cd B_j by rows
    for (int j = 0; j < m; ++j) {
      Mat<T, np, np> second;
      Vec<T, m> only;
      for (int c = 0; c < np; ++c)
        for (int r = 0; r < np; ++r) second(r, c) = T(0.0);
      for (int i = 0; i < m; ++i) only[i] = T(i == j ? ck : 0.0);
      Law::template add_hessian<T>(p, only, second);
      for (int c = 0; c < np; ++c) {
        T sum = b(j, c) * cd;
        for (int q = 0; q < np; ++q) sum += second(c, q) * pd[q];
        change(j, c) = sum;
      }
    }
    if constexpr (HasObjectiveRate<Law>) {
      Mat<T, m, m> by_rate, by_strain;
      Law::template objective_rate_gradients<T>(strain, rate, by_rate, by_strain);
      Mat<T, m, np> const whole = change;
      for (int i = 0; i < m; ++i)
        for (int c = 0; c < np; ++c) {
          T sum(0.0);
          for (int j = 0; j < m; ++j) sum += by_rate(i, j) * whole(j, c) + by_strain(i, j) * b(j, c) * ck;
          change(i, c) = sum;
        }
    }
    for (int i = 0; i < m; ++i)
      for (int c = 0; c < np; ++c) {
        T const factor = change(i, c) * (w * stiffness_[i] * time_[i]);
        for (int r = 0; r < np; ++r) h(r, c) += b(i, r) * factor;
      }
  }

  Strains stiffness_ = Strains::Zero();
  Strains time_ = Strains::Zero();
  Strains initial_ = Strains::Zero();
  bool damped_ = false;
  std::array<Map, std::size_t(Law::points)> maps_;
  /// Of two factors, for each pair.
  std::array<std::array<double, std::size_t(Law::points)>, quadratic ? 0 : P::table.pairs.size()> products_;
  std::array<double, Law::points> weights_;  ///< [m]
  std::array<Strains, Law::points> free_;    ///< ε⁰
};

}  // namespace polybody
