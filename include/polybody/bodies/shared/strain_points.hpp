#pragma once
/// \file
/// Strain laws of a `StrainGroup`, and its quadrature points: strain energy, and the discrete-gradient force. Without
/// dissipation, the work of this force over a step is the negative change of the energy.
/// Theory: Eq. 2.19.

#include <array>

#include <polybody/bodies/shared/bar.hpp>
#include <polybody/bodies/shared/node_chain.hpp>
#include <polybody/bodies/shared/strain_map.hpp>
#include <polybody/math/element_functions.hpp>
#include <polybody/math/secant.hpp>

namespace polybody {

/// Strains that are quadratic in the parameters, ε_i = ½ Σ_st S_i,st p_s·p_t + const. All shapes p_s (`StrainMap`) read
/// the same nodal vectors. Then H_i = S_i ⊗ 1, and B is linear in p, so that H_i ṗ = B_i(ṗ).
template <class L>
concept QuadraticStrains = requires(Vec<double, L::strains> const n,
                                    Mat<double, L::parameters / L::components, L::parameters / L::components> s) {
  L::template add_hessian<double>(n, s);  // s += Σ n_i S_i
};

/// Strains as functions of parameters, for the groups of an element.
template <class L>
concept StrainFunctions = requires(Vec<double, L::parameters> const p, Vec<double, L::strains> e,
                                   Mat<double, L::strains, L::parameters> b,
                                   Mat<double, L::parameters, L::parameters> h) {
  requires L::points >= 1 && L::reach >= 1;
  requires L::parameters % L::components == 0;      // parameters are vectors with `components` entries, the shapes
  { L::vector(0, 0) } -> std::convertible_to<int>;  // j-th nodal vector that shape s reads; −1 if it reads fewer
  L::template evaluate<double>(p, e, b);            // ε and B
  requires QuadraticStrains<L> || requires { L::template add_hessian<double>(p, e, h); };  // h += Σ n_i H_i for n = e
};

/// Strains with a parameter map along the axis of a bar, a stiffness and a damping.
template <class L>
concept StrainLaw = StrainFunctions<L> && requires(BarConstants const c, Damping const d) {
  { L::map(0.5, 1.0) } -> std::convertible_to<typename StrainMap<L>::Factors>;  // factors of P at ξ for length l
  { L::stiffness(c) } -> std::convertible_to<Vec<double, L::strains>>;          // C
  { L::damping(d) } -> std::convertible_to<Vec<double, L::strains>>;            // τ [s]
};

/// Law with the objective rate P_ε ε̇ of its strains and two derivatives of this rate: P_ε with respect to ε̇, Q with
/// respect to ε.
template <class L>
concept HasObjectiveRate = requires(Vec<double, L::strains>& e, Mat<double, L::strains, L::strains>& m) {
  L::template objective_rate<double>(e, e);
  L::template objective_rate_gradients<double>(e, e, m, m);
};

/// Law with the rate Ḃ of B, whose rows are H_i ṗ.
template <class L>
concept HasSlopeRate = requires(Vec<double, L::parameters> const p, Mat<double, L::strains, L::parameters>& b) {
  L::template slope_rate<double>(p, p, b);
};

/// Law of a strain vector that rotates with the body, with equal stiffness for all components. `square` returns the
/// square of the vector, computed from scalar products of the parameters.
template <class L>
concept HasSquare = requires(Vec<double, L::parameters> const p) {
  { L::template square<double>(p) } -> std::convertible_to<double>;
};

/// Quadrature points of a group of strains: weight, map P and stress-free strains of each point. The stiffness C, the
/// damping time τ and the initial stress n⁰ are equal at all points. If `coupled`, each point has a symmetric stiffness
/// matrix C and a symmetric damping matrix D instead of C and C τ.
template <StrainFunctions Law, bool coupled = false>
class StrainPoints {
  static_assert(!coupled || !(QuadraticStrains<Law> || HasObjectiveRate<Law> || HasSquare<Law>),
                "Stiffness matrices require strains without a special form.");

 public:
  static constexpr int np = Law::parameters, m = Law::strains;  ///< number of parameters and of strains

  using P = StrainMap<Law>;         ///< map from e to p
  using Map = typename P::Factors;  ///< factors N of P at a point
  template <class T, int n>
  using Coordinates = typename P::template Coordinates<T, n>;  ///< coordinates ê of an element (`StrainMap`)
  using Strains = Vec<double, m>;                              ///< one number for each strain
  using Matrix = Mat<double, m, m>;                            ///< C or D

  StrainPoints() = default;
  /// Quadrature points with the initial stress n⁰; `set_point` and `set_matrices` define each point.
  explicit StrainPoints(Strains const& initial)
    requires coupled
      : StrainPoints(Strains::Ones(), Strains::Zero()) {
    initial_ = initial;
  }
  /// Quadrature points of elements of length l [m]: those of `Law::rule` if it exists, otherwise Gauss points.
  /// `initial` is the stress n⁰ at ε = ε⁰, such as a pretension.
  StrainPoints(BarConstants const& c, Damping const& d, double l, Strains const& initial = Strains::Zero())
    requires StrainLaw<Law>
      : StrainPoints(Law::stiffness(c), Law::damping(d)) {
    initial_ = initial;
    for (int g = 0; g < Law::points; ++g) set_point(g, point(g).weight * l, Law::map(point(g).xi, l));
  }
  /// Quadrature points with the stiffness C and the damping time τ [s]; `set_point` defines each point.
  StrainPoints(Strains const& stiffness, Strains const& time) : stiffness_(stiffness), time_(time) {
    damped_ = !time_.isZero(0.0);
    free_.fill(Strains::Zero());
  }
  /// Sets the `weight` [m], the factors `map` of P, and the stress-free strains `free` of point g.
  void set_point(int g, double weight, Map const& map, Strains const& free = Strains::Zero()) {
    weights_[std::size_t(g)] = weight;
    maps_[std::size_t(g)] = map;
    free_[std::size_t(g)] = free;
    for (std::size_t k = 0; k < products_.size(); ++k) {
      auto const [s, j, t, l] = P::table.pairs[k];
      products_[k][std::size_t(g)] = map(s, j) * map(t, l);
    }
  }

  /// Sets C and D [N s, N m s, N m² s] of point g.
  void set_matrices(int g, Matrix const& stiffness, Matrix const& damping)
    requires coupled
  {
    matrices_[std::size_t(g)] = {stiffness, damping};
    damped_ = damped_ || !damping.isZero(0.0);
  }

  /// Sets the stress-free strains to those of the coordinates x, ε⁰ = ε(x) at each point.
  template <int n>
  void set_free(Vec<double, n> const& x) {
    Mat<double, m, np> b;
    for (std::size_t g = 0; g < std::size_t(Law::points); ++g)
      Law::template evaluate<double>(P::parameters(maps_[g], Coordinates<double, n>(x)), free_[g], b);
  }

  Strains const& stiffness() const { return stiffness_; }  ///< C of each strain [N] or [N m²]
  /// Stress C (ε − ε⁰) + n⁰ without damping, where `strain` is ε − ε⁰.
  Strains stress(Strains const& strain) const { return stiffness_.cwiseProduct(strain) + initial_; }

  /// Strains ε at ξ of an element of length l with coordinates x.
  template <int n>
  static Strains strains(double xi, double l, Vec<double, n> const& x)
    requires StrainLaw<Law>
  {
    Vec<double, m> strain;
    Mat<double, m, np> b;
    Law::template evaluate<double>(P::parameters(Law::map(xi, l), Coordinates<double, n>(x)), strain, b);
    return strain;
  }

  bool damped() const { return damped_; }                ///< true if any τ is not zero
  bool operator==(StrainPoints const&) const = default;  ///< compares all numbers

  /// Strain energy of an element with the coordinates x [J].
  template <int n>
  double energy(Vec<double, n> const& x) const {
    double u = 0.0;
    Coordinates<double, n> const e(x);
    for (int g = 0; g < Law::points; ++g) {
      Vec<double, m> strain;
      Mat<double, m, np> b;
      Law::template evaluate<double>(P::parameters(maps_[std::size_t(g)], e), strain, b);
      strain -= free_[std::size_t(g)];
#pragma GCC unroll 8
      for (int i = 0; i < m; ++i)
        u += weights_[std::size_t(g)] * (elastic(g, i, strain.data(), 0.5) + initial_[i]) * strain[i];
    }
    return u;
  }

  /// Adds the discrete-gradient force of the group over a step from x0 to x1, with secants S of the strains [Gonzalez
  /// 1996]:
  ///   f += −∫ Pᵀ Sᵀ n dx,  n = C (ε̄ − ε⁰ + decay Δε) + D Δε/h + n⁰,  S P Δx = Δε,
  /// so that f·Δx = −ΔU − ∫ Δεᵀ (decay C + D/h) Δε dx, with D_i = C_i τ_i. The force exerts no moment on the body if
  /// strains are scalar products of the parameters. A strain vector that rotates with the body enters through its
  /// square z
  /// (`HasSquare`): n_z = ½ C (1 + τ Δz/(2h(z̄ + κ₀²))), with κ₀ = 1e-3 1/m, which agrees with the damping of
  /// `objective_rate`. ε⁰ and n⁰ then have no effect, and the term of `decay` exerts a moment.
  template <int n>
  void add_mean_force(Vec<double, n> const& x0, Vec<double, n> const& x1, DiscreteDerivative const& means,
                      Vec<double, n>& f) const {
    using S = Secant<np>;
    Coordinates<double, n> const e0(x0), e1(x1);
    Vec<double, P::d> step = Vec<double, P::d>::Zero();
    for (int g = 0; g < Law::points; ++g) {
      Vec<double, np> const p0 = P::parameters(maps_[std::size_t(g)], e0),
                            p1 = P::parameters(maps_[std::size_t(g)], e1);
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
        Strains stretch, change;
        for (int i = 0; i < m; ++i) {
          change[i] = strain[i].change();
          stretch[i] = means.decay * change[i] + (HasSquare<Law> ? 0.0 : strain[i].mean() - free_[std::size_t(g)][i]);
        }
        for (int i = 0; i < m; ++i) {
          double stress = elastic(g, i, stretch.data(), 1.0);
          if constexpr (!HasSquare<Law>) stress += viscous(g, i, change.data(), means.rate) + initial_[i];
          sum += strain[i].d * stress;
        }
      }
      Vec<double, np> pull;
      for (int k = 0; k < np; ++k) pull[k] = weights_[std::size_t(g)] * sum[k];
      P::subtract_pulled(maps_[std::size_t(g)], pull, f, step);
    }
    P::spread(step, f);
  }

  /// Adds the tangent k += ck (−∂f/∂x1) of `add_mean_force` from x0 to x1, which is not symmetric. The derivatives B̄
  /// and H̄ of the strains at the middle of the step replace the secants:
  ///   Pᵀ [B̄ᵀ ((½ + decay) C + D/h) B(x1) + ½ Σ n_i H̄_i] P.
  template <int n>
  void add_mean_tangent(Vec<double, n> const& x0, Vec<double, n> const& x1, DiscreteDerivative const& means, double ck,
                        Mat<double, n, n>& k) const {
    Coordinates<double, n> const e0(x0), e1(x1);
    for (int g = 0; g < Law::points; ++g) {
      Vec<double, np> const p0 = P::parameters(maps_[std::size_t(g)], e0),
                            p1 = P::parameters(maps_[std::size_t(g)], e1);
      Vec<double, np> const middle = 0.5 * (p0 + p1);
      Strains from, to, stress;
      Mat<double, m, np> b, end;
      Law::template evaluate<double>(p0, from, b);
      Law::template evaluate<double>(p1, to, end);
      Law::template evaluate<double>(middle, stress, b);
      Mat<double, np, np> h = Mat<double, np, np>::Zero();
      double const w = ck * weights_[std::size_t(g)];
      Strains const change = to - from, stretch = 0.5 * (from + to) - free_[std::size_t(g)] + means.decay * change;
      for (int i = 0; i < m; ++i) {
        stress[i] =
            0.5 * (elastic(g, i, stretch.data(), w) + viscous(g, i, change.data(), w * means.rate) + w * initial_[i]);
        for (int c = 0; c < np; ++c) {
          double const factor = elastic(g, i, end.data() + m * c, w * (0.5 + means.decay)) +
                                viscous(g, i, end.data() + m * c, w * means.rate);
          for (int r = 0; r < np; ++r) h(r, c) += b(i, r) * factor;
        }
      }
      if constexpr (quadratic) {
        Mat<double, P::shapes, P::shapes> of_shapes = Mat<double, P::shapes, P::shapes>::Zero();
        Law::template add_hessian<double>(stress, of_shapes);
        for (int c = 0; c < np; ++c)
          for (int r = c % P::d; r < np; r += P::d) h(r, c) += of_shapes(r / P::d, c / P::d);
      } else {
        Law::template add_hessian<double>(middle, stress, h);
      }
      P::add_mapped(maps_[std::size_t(g)], h, k);
    }
  }

 private:
  static constexpr GaussPoint point(int g) {
    if constexpr (requires { Law::rule; })
      return Law::rule[std::size_t(g)];
    else
      return gauss<Law::points>[std::size_t(g)];
  }

 protected:
  /// Component i of w C x at point g, for x (m).
  template <class T>
  T elastic(int g, int i, T const* x, double w) const {
    if constexpr (coupled)
      return row_times(matrices_[std::size_t(g)][0], i, x, w);
    else
      return x[i] * (w * stiffness_[i]);
  }
  /// Component i of w D x at point g, for x (m).
  template <class T>
  T viscous(int g, int i, T const* x, double w) const {
    if constexpr (coupled)
      return row_times(matrices_[std::size_t(g)][1], i, x, w);
    else
      return x[i] * (w * stiffness_[i] * time_[i]);
  }

  static constexpr bool quadratic = QuadraticStrains<Law>;  ///< true if the strains are quadratic in the parameters

  Strains stiffness_ = Strains::Zero();             ///< stiffness C
  Strains time_ = Strains::Zero();                  ///< damping times τ [s]
  Strains initial_ = Strains::Zero();               ///< initial stress n⁰
  bool damped_ = false;                             ///< true if any τ is not zero
  std::array<Map, std::size_t(Law::points)> maps_;  ///< factors N of each point
  /// Product of the two factors of each pair (`StrainMap::Pair`), at each point.
  std::array<std::array<double, std::size_t(Law::points)>, quadratic ? 0 : P::table.pairs.size()> products_;
  std::array<double, Law::points> weights_;  ///< weight of each point [m]
  std::array<Strains, Law::points> free_;    ///< stress-free strains ε⁰ of each point

 private:
  template <class T>
  static T row_times(Matrix const& a, int i, T const* x, double w) {
    T sum = x[0] * (w * a(i, 0));
    for (int j = 1; j < m; ++j) sum += x[j] * (w * a(i, j));
    return sum;
  }

  std::array<std::array<Matrix, 2>, coupled ? std::size_t(Law::points) : 0> matrices_{};  ///< C and D of each point
};

}  // namespace polybody
