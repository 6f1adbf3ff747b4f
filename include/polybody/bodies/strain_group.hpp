#pragma once
/// \file
/// Elastic energy of an element by a group of strains at its quadrature points:
///   U = ½ ∫ Σ_i C_i (ε_i(p) − ε⁰_i)² dx,  p = P(x) e the group's parameters, linear in the element's coordinates e,
/// ε⁰ the strains free of stress (zero unless given), with Kelvin–Voigt damping and initial stress
/// n_i = C_i (ε_i − ε⁰_i + τ_i ε̇_i) + n⁰_i. Then, with B = ∂ε/∂p and H_i = ∂²ε_i/∂p²,
///   f = −∫ Pᵀ Bᵀ n dx,
///   −∂f/∂e = ∫ Pᵀ [Bᵀ C B + Σ n_i H_i + Σ C_i τ_i B_iᵀ (H_i ṗ)ᵀ] P dx,
///   −∂f/∂ė = ∫ Pᵀ Bᵀ C τ B P dx.
/// Where strains are components of a vector that turns with the body, a law says which part of ε̇ is deformation: ε̇ is then
/// replaced by P_ε ε̇ (`objective_rate`).
/// P is sparse: each parameter reads `reach` coordinates, always the same ones. Plain loops, for they run on doubles, dual
/// numbers and packs of elements alike, and compile fast.

#include <array>

#include <polybody/bodies/bar.hpp>
#include <polybody/bodies/step_means.hpp>
#include <polybody/math/pack.hpp>
#include <polybody/math/quadrature.hpp>
#include <polybody/math/secant.hpp>

namespace polybody {

/// Strains as functions of parameters: what a group is made of.
template <class L>
concept StrainFunctions = requires(Vec<double, L::parameters> const p, Vec<double, L::strains> e,
                                   Mat<double, L::strains, L::parameters> b, Mat<double, L::parameters, L::parameters> h) {
  requires L::points >= 1 && L::reach >= 1;
  { L::column(0, 0) } -> std::convertible_to<int>;  // the coordinate that parameter k reads as its j-th
  L::template evaluate<double>(p, e, b);            // ε and B
  L::template add_hessian<double>(p, e, h);         // h += Σ n_i H_i for given n
};

/// … that also know their parameters along the axis of a bar, and their stiffness.
template <class L>
concept StrainLaw = StrainFunctions<L> && requires(BarConstants const c, Damping const d) {
  { L::map(0.5, 1.0) } -> std::convertible_to<Mat<double, L::parameters, L::reach>>;  // P's factors at ξ, length l
  { L::stiffness(c) } -> std::convertible_to<Vec<double, L::strains>>;                // C
  { L::damping(d) } -> std::convertible_to<Vec<double, L::strains>>;                  // τ [s]
};

/// A law that gives p_ε = P_ε(ε) ε̇ and its gradients P_ε by ε̇ and Q by ε.
template <class L>
concept HasObjectiveRate = requires(Vec<double, L::strains>& e, Mat<double, L::strains, L::strains>& m) {
  L::template objective_rate<double>(e, e);
  L::template objective_rate_gradients<double>(e, e, m, m);
};

/// A law of equal stiffness for all strains, which are components of a vector that turns with the body: gives the vector's square
/// from
/// scalar products of its parameters.
template <class L>
concept HasSquare = requires(Vec<double, L::parameters> const p) {
  { L::template square<double>(p) } -> std::convertible_to<double>;
};

template <StrainFunctions Law>
class StrainGroup {
 public:
  static constexpr int np = Law::parameters, m = Law::strains, reach = Law::reach;

  using Map = Mat<double, np, reach>;
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
    Law::template evaluate<double>(parameters<double, n>(Law::map(xi, l), x), strain, b);
    return strain;
  }

  /// f += the group's force at coordinates x, rates xd.
  template <KernelScalar T, int n>
  void add_force(Vec<T, n> const& x, Vec<T, n> const& xd, Vec<T, n>& f) const {
    for (int g = 0; g < Law::points; ++g) {
      Vec<T, np> const p = parameters<T, n>(maps_[g], x);
      Vec<T, m> stress;
      Mat<T, m, np> b;
      Law::template evaluate<T>(p, stress, b);
      if (damped_) add_damping(rates(b, parameters<T, n>(maps_[g], xd)), stress);
#pragma GCC unroll 8
      for (int i = 0; i < m; ++i) stress[i] = ((stress[i] - free_[g][i]) * stiffness_[i] + initial_[i]) * weights_[g];
#pragma GCC unroll 8
      for (int k = 0; k < np; ++k) {
        T s = b(0, k) * stress[0];
#pragma GCC unroll 8
        for (int i = 1; i < m; ++i) s += b(i, k) * stress[i];
#pragma GCC unroll 8
        for (int j = 0; j < reach; ++j) f[Law::column(k, j)] -= s * maps_[g](k, j);
      }
    }
  }

  /// k += ck (−∂f/∂x) + cd (−∂f/∂xd).
  template <KernelScalar T, int n>
  void add_tangent(Vec<T, n> const& x, Vec<T, n> const& xd, double ck, double cd, Mat<T, n, n>& k) const {
    for (int g = 0; g < Law::points; ++g) {
      Vec<T, np> const p = parameters<T, n>(maps_[g], x);
      Vec<T, m> stress;
      Mat<T, m, np> b;
      Law::template evaluate<T>(p, stress, b);
      Mat<T, np, np> h;  // of the energy in p: BᵀCB, symmetric, and what follows
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
        Vec<T, np> const pd = parameters<T, n>(maps_[g], xd);
        Vec<T, m> const rate = rates(b, pd);
        add_damping_gradient(weights_[g], ck, cd, p, pd, stress, rate, b, h);
        add_damping(rate, stress);
      }
#pragma GCC unroll 8
      for (int i = 0; i < m; ++i) stress[i] = ((stress[i] - free_[g][i]) * stiffness_[i] + initial_[i]) * (ck * weights_[g]);
      Law::template add_hessian<T>(p, stress, h);
      add_mapped<T, n>(maps_[g], h, k);
    }
  }

  /// f += the group's force over a step from x0 to x1, by secants S of the strains [Gonzalez 1996]:
  ///   −∫ Pᵀ Sᵀ n dx,  n_i = C_i (ε̄_i − ε⁰_i + (decay + τ_i/h) Δε_i) + n⁰_i,  S P Δx = Δε,
  /// so that f·Δx = −ΔU − Σ ∫ C_i (decay + τ_i/h) Δε_i² dx. It has no moment where strains are made of scalar products. The
  /// others,
  /// vectors that turn, go by their square z: n_z = ½ C (1 + τ Δz/(2h(z̄ + κ₀²))), κ₀ = 1e-3 1/m, as `objective_rate` damps; the
  /// part of `decay` has a moment then.
  template <int n>
  void add_mean_force(Vec<double, n> const& x0, Vec<double, n> const& x1, StepMeans const& means, Vec<double, n>& f) const {
    using S = Secant<np>;
    for (int g = 0; g < Law::points; ++g) {
      Vec<double, np> const p0 = parameters<double, n>(maps_[g], x0), p1 = parameters<double, n>(maps_[g], x1);
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
          if constexpr (!HasSquare<Law>) stretch += strain[i].mean() - free_[g][i] + time_[i] * means.rate * strain[i].change();
          sum += strain[i].d * (stiffness_[i] * stretch + (HasSquare<Law> ? 0.0 : initial_[i]));
        }
      }
      for (int k = 0; k < np; ++k)
        for (int j = 0; j < reach; ++j) f[Law::column(k, j)] -= weights_[g] * sum[k] * maps_[g](k, j);
    }
  }

  /// k += ck (−∂f/∂x1) of `add_mean_force`, not symmetric, with the strains' gradients B̄ and H̄ of the middle for the secants:
  ///   Pᵀ [B̄ᵀ C (½ + decay + τ/h) B(x1) + ½ Σ n_i H̄_i] P.
  template <int n>
  void add_mean_tangent(Vec<double, n> const& x0, Vec<double, n> const& x1, StepMeans const& means, double ck,
                        Mat<double, n, n>& k) const {
    for (int g = 0; g < Law::points; ++g) {
      Vec<double, np> const p0 = parameters<double, n>(maps_[g], x0), p1 = parameters<double, n>(maps_[g], x1);
      Vec<double, np> const middle = 0.5 * (p0 + p1);
      Strains from, to, stress;
      Mat<double, m, np> b, end;
      Law::template evaluate<double>(p0, from, b);
      Law::template evaluate<double>(p1, to, end);
      Law::template evaluate<double>(middle, stress, b);
      Mat<double, np, np> h = Mat<double, np, np>::Zero();
      for (int i = 0; i < m; ++i) {
        double const w = ck * weights_[g], share = means.decay + time_[i] * means.rate;
        stress[i] = 0.5 * w * (stiffness_[i] * (0.5 * (from[i] + to[i]) - free_[g][i] + share * (to[i] - from[i])) + initial_[i]);
        for (int c = 0; c < np; ++c)
          for (int r = 0; r < np; ++r) h(r, c) += w * stiffness_[i] * (0.5 + share) * b(i, r) * end(i, c);
      }
      Law::template add_hessian<double>(middle, stress, h);
      add_mapped<double, n>(maps_[g], h, k);
    }
  }

  /// The energy stored [J].
  template <int n>
  double energy(Vec<double, n> const& x) const {
    double u = 0.0;
    for (int g = 0; g < Law::points; ++g) {
      Vec<double, m> strain;
      Mat<double, m, np> b;
      Law::template evaluate<double>(parameters<double, n>(maps_[g], x), strain, b);
#pragma GCC unroll 8
      for (int i = 0; i < m; ++i) {
        double const stretch = strain[i] - free_[g][i];
        u += weights_[g] * (0.5 * stiffness_[i] * stretch + initial_[i]) * stretch;
      }
    }
    return u;
  }

 private:
  /// p = P x.
  template <class T, int n>
  static Vec<T, np> parameters(Map const& map, Vec<T, n> const& x) {
    Vec<T, np> p;
#pragma GCC unroll 8
    for (int k = 0; k < np; ++k) {
      T s = x[Law::column(k, 0)] * map(k, 0);
#pragma GCC unroll 8
      for (int j = 1; j < reach; ++j) s += x[Law::column(k, j)] * map(k, j);
      p[k] = s;
    }
    return p;
  }

  /// k += Pᵀ h P, column by column of h.
  template <class T, int n>
  static void add_mapped(Map const& map, Mat<T, np, np> const& h, Mat<T, n, n>& k) {
#pragma GCC unroll 8
    for (int c = 0; c < np; ++c) {
      Vec<T, n> pulled;  // Pᵀ h e_c
#pragma GCC unroll 16
      for (int r = 0; r < n; ++r) pulled[r] = T(0.0);
#pragma GCC unroll 8
      for (int r = 0; r < np; ++r)
#pragma GCC unroll 8
        for (int j = 0; j < reach; ++j) pulled[Law::column(r, j)] += h(r, c) * map(r, j);
#pragma GCC unroll 8
      for (int j = 0; j < reach; ++j)
#pragma GCC unroll 16
        for (int r = 0; r < n; ++r) k(r, Law::column(c, j)) += pulled[r] * map(c, j);
    }
  }

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
  void add_damping_gradient(double w, double ck, double cd, Vec<T, np> const& p, Vec<T, np> const& pd, Vec<T, m> const& strain,
                            Vec<T, m> const& rate, Mat<T, m, np> const& b, Mat<T, np, np>& h) const {
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
  std::array<Map, Law::points> maps_;
  std::array<double, Law::points> weights_;  ///< [m]
  std::array<Strains, Law::points> free_;    ///< ε⁰
};

}  // namespace polybody
