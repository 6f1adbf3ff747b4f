#pragma once
/// \file
/// Elastic force and tangent of an element from strains with a full stiffness matrix.
/// Theory: Eqs. 2.19 to 2.23, 2.126.

#include <polybody/bodies/shared/strain_group.hpp>

namespace polybody {

/// Group of strains with a stiffness matrix C and a damping matrix D at each point, both symmetric:
///   U = ∫ ½ (ε − ε⁰)ᵀ C (ε − ε⁰) + n⁰·(ε − ε⁰) dx,  n = C (ε − ε⁰) + D ε̇ + n⁰,  f = −∫ Pᵀ Bᵀ n dx.
/// With B = ∂ε/∂p, H_i = ∂²ε_i/∂p² and p = P e of `StrainGroup`, the tangents are
///   −∂f/∂e = ∫ Pᵀ [Bᵀ C B + Σ n_i H_i + Σ D_ij B_iᵀ (H_j ṗ)ᵀ] P dx,  −∂f/∂ė = ∫ Pᵀ Bᵀ D B P dx.
template <StrainFunctions Law>
  requires(!QuadraticStrains<Law> && !HasObjectiveRate<Law> && !HasSquare<Law>)
class MatrixGroup : public StrainGroup<Law> {
  using Group = StrainGroup<Law>;
  using Group::damped_, Group::initial_, Group::maps_, Group::weights_, Group::free_;

 public:
  using Group::np, Group::m;
  using P = StrainMap<Law>;  ///< map from e to p
  template <class T, int n>
  using Coordinates = typename P::template Coordinates<T, n>;  ///< coordinates ê of an element (`StrainMap`)
  using Strains = Vec<double, m>;                              ///< one number for each strain
  using Matrix = Mat<double, m, m>;                            ///< C or D

  /// Group with the initial stress n⁰; `set_point` and `set_matrices` define each point.
  explicit MatrixGroup(Strains const& initial) : Group(Strains::Ones(), Strains::Zero()) { initial_ = initial; }
  /// Sets C and D [N s, N m s, N m² s] of point g.
  void set_matrices(int g, Matrix const& stiffness, Matrix const& damping) {
    matrix_[std::size_t(g)] = stiffness;
    damper_[std::size_t(g)] = damping;
    damped_ = damped_ || !damping.isZero(0.0);
  }
  bool operator==(MatrixGroup const&) const = default;  ///< compares all numbers

  /// Strain energy of an element with the coordinates x [J].
  template <int n>
  double energy(Vec<double, n> const& x) const {
    double u = 0.0;
    Coordinates<double, n> const e(x);
    for (std::size_t g = 0; g < points; ++g) {
      State<double> const at = state<double>(g, P::parameters(maps_[g], e));
      for (int i = 0; i < m; ++i) {
        double sum = 2.0 * initial_[i];
        for (int j = 0; j < m; ++j) sum += matrix_[g](i, j) * at.strain[j];
        u += 0.5 * weights_[g] * sum * at.strain[i];
      }
    }
    return u;
  }

  /// Adds the force of the group at coordinates x and velocities xd, f += f(x, xd).
  template <KernelScalar T, int n>
  void add_force(Vec<T, n> const& x, Vec<T, n> const& xd, Vec<T, n>& f) const {
    Coordinates<T, n> const e(x), ed(xd);
    Vec<T, P::d> step;
    for (int i = 0; i < P::d; ++i) step[i] = T(0.0);
    for (std::size_t g = 0; g < points; ++g) {
      State<T> const at = state<T>(g, P::parameters(maps_[g], e));
      Vec<T, m> const stress = stress_at(g, at, P::parameters(maps_[g], ed), weights_[g]);
      Vec<T, np> pull;  // w Bᵀ n
      for (int k = 0; k < np; ++k) {
        T sum = at.b(0, k) * stress[0];
        for (int i = 1; i < m; ++i) sum += at.b(i, k) * stress[i];
        pull[k] = sum;
      }
      P::subtract_pulled(maps_[g], pull, f, step);
    }
    P::spread(step, f);
  }

  /// Computes the stiffness h of each point, for `add_block`:
  ///   h = w [ck (BᵀCB + Σ n_i H_i) + Σ D_ij B_iᵀ (ck (H_j ṗ)ᵀ + cd B_j)].
  template <KernelScalar T, int n>
  void prepare(Vec<T, n> const& x, Vec<T, n> const& xd, double ck, double cd, bool,
               typename Group::template Prepared<T>& hs) const {
    Coordinates<T, n> const e(x), ed(xd);
    for (std::size_t g = 0; g < points; ++g) {
      Mat<T, np, np>& h = hs.h[g];
      State<T> const at = state<T>(g, P::parameters(maps_[g], e));
      Vec<T, np> const pd = P::parameters(maps_[g], ed);
      Mat<T, m, np> right = times(matrix_[g], at.b, ck * weights_[g]);
      if (damped_) {
        Mat<T, m, np> const damped = times(damper_[g], changes(at, pd, ck, cd), weights_[g]);
        for (int c = 0; c < np; ++c)
          for (int i = 0; i < m; ++i) right(i, c) += damped(i, c);
      }
      for (int c = 0; c < np; ++c)
        for (int r = 0; r < np; ++r) {
          T sum = at.b(0, r) * right(0, c);
          for (int i = 1; i < m; ++i) sum += at.b(i, r) * right(i, c);
          h(r, c) = sum;
        }
      Law::template add_hessian<T>(at.p, stress_at(g, at, pd, ck * weights_[g]), h);
    }
  }

  /// Adds the discrete-gradient force of the group over a step from x0 to x1, with secants S of the strains (see
  /// `StrainPoints`):
  ///   f += −∫ Pᵀ Sᵀ n dx,  n = C (ε̄ − ε⁰ + decay Δε) + D Δε/h + n⁰,  S P Δx = Δε.
  template <int n>
  void add_mean_force(Vec<double, n> const& x0, Vec<double, n> const& x1, DiscreteDerivative const& means,
                      Vec<double, n>& f) const {
    using S = Secant<np>;
    Coordinates<double, n> const e0(x0), e1(x1);
    Vec<double, P::d> step = Vec<double, P::d>::Zero();
    for (std::size_t g = 0; g < points; ++g) {
      Vec<double, np> const p0 = P::parameters(maps_[g], e0), p1 = P::parameters(maps_[g], e1);
      Vec<S, np> p;
      for (int k = 0; k < np; ++k) p[k] = S::variable(p0[k], p1[k], k);
      Vec<S, m> strain;
      Mat<S, m, np> b;
      Law::template evaluate<S>(p, strain, b);
      Vec<double, np> pull = Vec<double, np>::Zero();
      for (int i = 0; i < m; ++i) {
        double stress = initial_[i];
        for (int j = 0; j < m; ++j) {
          double const change = strain[j].change();
          stress += matrix_[g](i, j) * (strain[j].mean() - free_[g][j] + means.decay * change) +
                    damper_[g](i, j) * means.rate * change;
        }
        for (int k = 0; k < np; ++k) pull[k] += weights_[g] * stress * strain[i].d[k];
      }
      P::subtract_pulled(maps_[g], pull, f, step);
    }
    P::spread(step, f);
  }

  /// Adds the tangent k += ck (−∂f/∂x1) of `add_mean_force` from x0 to x1, with the derivatives B̄ and H̄ of the strains
  /// at the middle of the step in place of the secants:
  ///   Pᵀ [B̄ᵀ ((½ + decay) C + D/h) B(x1) + ½ Σ n_i H̄_i] P.
  template <int n>
  void add_mean_tangent(Vec<double, n> const& x0, Vec<double, n> const& x1, DiscreteDerivative const& means, double ck,
                        Mat<double, n, n>& k) const {
    Coordinates<double, n> const e0(x0), e1(x1);
    for (std::size_t g = 0; g < points; ++g) {
      Vec<double, np> const p0 = P::parameters(maps_[g], e0), p1 = P::parameters(maps_[g], e1);
      State<double> const from = state<double>(g, p0), to = state<double>(g, p1),
                          middle = state<double>(g, 0.5 * (p0 + p1));
      double const w = ck * weights_[g];
      Strains stress;
      Matrix by_end;
      for (int i = 0; i < m; ++i) {
        stress[i] = 0.5 * w * initial_[i];
        for (int j = 0; j < m; ++j) {
          double const share = means.decay * matrix_[g](i, j) + means.rate * damper_[g](i, j);
          stress[i] +=
              0.5 * w *
              (0.5 * matrix_[g](i, j) * (from.strain[j] + to.strain[j]) + share * (to.strain[j] - from.strain[j]));
          by_end(i, j) = 0.5 * matrix_[g](i, j) + share;
        }
      }
      Mat<double, m, np> const right = times(by_end, to.b, w);
      Mat<double, np, np> h = Mat<double, np, np>::Zero();
      for (int c = 0; c < np; ++c)
        for (int r = 0; r < np; ++r)
          for (int i = 0; i < m; ++i) h(r, c) += middle.b(i, r) * right(i, c);
      Law::template add_hessian<double>(middle.p, stress, h);
      P::add_mapped(maps_[g], h, k);
    }
  }

 private:
  static constexpr std::size_t points = std::size_t(Law::points);
  /// Parameters, strains ε − ε⁰ and B = ∂ε/∂p at a point.
  template <class T>
  struct State {
    Vec<T, np> p;
    Vec<T, m> strain;
    Mat<T, m, np> b;
  };

  template <class T>
  State<T> state(std::size_t g, Vec<T, np> const& p) const {
    State<T> at;
    at.p = p;
    Law::template evaluate<T>(at.p, at.strain, at.b);
    for (int i = 0; i < m; ++i) at.strain[i] = at.strain[i] - free_[g][i];
    return at;
  }
  /// Product w A b.
  template <class T>
  static Mat<T, m, np> times(Matrix const& a, Mat<T, m, np> const& b, double w) {
    Mat<T, m, np> out;
    for (int c = 0; c < np; ++c)
      for (int i = 0; i < m; ++i) {
        T sum = b(0, c) * (w * a(i, 0));
        for (int j = 1; j < m; ++j) sum += b(j, c) * (w * a(i, j));
        out(i, c) = sum;
      }
    return out;
  }
  /// Stress w n = w [C (ε − ε⁰) + D ε̇ + n⁰] for the rates ṗ = `pd`.
  template <class T>
  Vec<T, m> stress_at(std::size_t g, State<T> const& at, Vec<T, np> const& pd, double w) const {
    Vec<T, m> stress, rate;
    for (int j = 0; j < m && damped_; ++j) {
      rate[j] = at.b(j, 0) * pd[0];
      for (int k = 1; k < np; ++k) rate[j] += at.b(j, k) * pd[k];
    }
    for (int i = 0; i < m; ++i) {
      T sum(initial_[i] * w);
      for (int j = 0; j < m; ++j) sum += at.strain[j] * (w * matrix_[g](i, j));
      for (int j = 0; j < m && damped_; ++j) sum += rate[j] * (w * damper_[g](i, j));
      stress[i] = sum;
    }
    return stress;
  }
  /// Rows ck H_j ṗ + cd B_j.
  template <class T>
  static Mat<T, m, np> changes(State<T> const& at, Vec<T, np> const& pd, double ck, double cd) {
    Mat<T, m, np> out;
    for (int j = 0; j < m; ++j) {
      Mat<T, np, np> second;
      Vec<T, m> only;
      for (int c = 0; c < np; ++c)
        for (int r = 0; r < np; ++r) second(r, c) = T(0.0);
      for (int i = 0; i < m; ++i) only[i] = T(i == j ? ck : 0.0);
      Law::template add_hessian<T>(at.p, only, second);
      for (int c = 0; c < np; ++c) {
        T sum = at.b(j, c) * cd;
        for (int q = 0; q < np; ++q) sum += second(c, q) * pd[q];
        out(j, c) = sum;
      }
    }
    return out;
  }

  std::array<Matrix, points> matrix_{}, damper_{};  ///< C and D of each point
};

}  // namespace polybody
