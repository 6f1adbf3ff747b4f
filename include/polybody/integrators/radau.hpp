#pragma once
/// \file
/// Radau IIA method with three stages on the manifold: order five, L-stable, stiffly accurate [Hairer & Wanner 1996,
/// §IV.5, §IV.8]:
///   M(q_i) v̇_i = f(q_i, v_i, t_i) − Gᵀλ_i,   G v̇_i = −γ(q_i, v_i, t_i),   t_i = t₀ + c_i h,
///   v_i = v₀ + h Σ a_ij v̇_j,   q_i = q₀ ⊞ δ_i,   δ_i = h Σ a_ij δ˙(δ_j, v_j).
/// The third stage is the end of the step. The stages satisfy the second derivatives of the constraint equations, so
/// that multipliers have the order of the velocities. `Projection` removes the drift. The Newton unknowns are v̇_i and
/// λ_i of all stages together. The increments δ_i follow from v̇_i. First-order states are part of v_i.
/// Theory: Eqs. 6.13 to 6.16.

#include <array>
#include <utility>

#include <polybody/integrators/constraint_derivatives.hpp>
#include <polybody/integrators/newton_failure.hpp>
#include <polybody/integrators/stabilisation.hpp>
#include <polybody/math/block_sink.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/solvers/auto_lu.hpp>

namespace polybody::detail {

/// Coefficients a_ij and c_i of the Radau IIA method with three stages [Hairer & Wanner 1996, Table IV.5.6].
struct RadauTableau {
  static constexpr double r6 = 2.449489742783178;
  static constexpr double c[3] = {(4.0 - r6) / 10.0, (4.0 + r6) / 10.0, 1.0};
  static constexpr double a[3][3] = {
      {(88.0 - 7.0 * r6) / 360.0, (296.0 - 169.0 * r6) / 1800.0, (-2.0 + 3.0 * r6) / 225.0},
      {(296.0 + 169.0 * r6) / 1800.0, (88.0 + 7.0 * r6) / 360.0, (-2.0 - 3.0 * r6) / 225.0},
      {(16.0 - r6) / 36.0, (16.0 + r6) / 36.0, 1.0 / 9.0}};
  /// (A²)_ij.
  static constexpr double squared(int i, int j) { return a[i][0] * a[0][j] + a[i][1] * a[1][j] + a[i][2] * a[2][j]; }

  /// Lagrange polynomial of node j at s, and its integral from 0 to s.
  struct Inside {
    double value, integral;
  };
  static constexpr Inside inside(std::size_t j, double s) {
    double const k = c[(j + 1) % 3], l = c[(j + 2) % 3], scale = (c[j] - k) * (c[j] - l);
    return {(s - k) * (s - l) / scale, s * (s * (s / 3.0 - 0.5 * (k + l)) + k * l) / scale};
  }
};

/// Shifts the blocks of one stage to their position in the matrix of all stages. Off-diagonal stage blocks omit G and
/// Gᵀ.
struct StageBlockSink {
  BlockSink& sink;
  Index row0, col0, velocities;
  void add(Index row, Index col, BlockView const& b) {
    if (row0 == col0 || (row < velocities && col < velocities)) sink.add(row0 + row, col0 + col, b);
  }
};

}  // namespace polybody::detail

namespace polybody {

struct RadauDerivatives;  // gradients/radau_derivatives.hpp

/// Reference integrator for few, accurate steps, also of stiff models. The matrix of a step has three times the
/// unknowns of the model. It is factorised by `AutoLu`, independent of the solver of the run. If the matrix has more
/// than 64 unknowns, `AutoLu` allocates memory in a step.
struct Radau {
  static constexpr char const* name = "Radau";
  static constexpr int order = 5;
  static constexpr bool accepts_constraints = true;
  static constexpr Capabilities capabilities = Capabilities::tangent;
  static constexpr bool coupled_stages = true;
  using Derivatives = RadauDerivatives;  ///< linearised step and adjoint of a step

  double tolerance = 1e-10;                       ///< tolerance of Newton's corrections, relative to the accelerations
  NewtonOptions newton = {.max_iterations = 50};  ///< many iterations, since the matrix neglects changes of G
  Projection projection = {};                     ///< removes the drift of the constraint equations

  /// \throws InvalidInput unless the tolerance is positive, and for invalid options of `newton` and `projection`.
  void check() const {
    require_positive(tolerance, "Radau: the tolerance");
    newton.check(name);
    projection.check();
  }

  /// Memory of a step, allocated once.
  template <class Solver>
  struct Workspace {
    std::array<VecX, 3> v, vd, lambda, delta, rate;  ///< v, v̇, λ, δ and δ˙ of each stage
    VecX q, r, phi, gamma, next, rhs, y, kept;  ///< in order: q, r, G v̇, γ, δ, −(r, Φ̈) of all stages, two corrections
    TangentSolver<AutoLu> solver, by_stage;     ///< `by_stage` is analysed by the first step that requires it
    ConstraintDerivatives slopes;               ///< ∂Φ̈/∂q and ∂Φ̈/∂v of the constraint equations
    ForwardDynamics<Solver> forward;            ///< solver of [M, Gᵀ; G, 0]: accelerations at the start, projections
    StepCheck check;                            ///< checks of the steps of a run
    Projection::Scratch projected;              ///< memory of `projection`: none
    ReusedFactorisation reused_factorisation;   ///< state of the reused factorisation
    bool has_by_stage = false;                  ///< true if `by_stage` is analysed
    double h_factored = 0.0;                    ///< step length of the last factorisation [s]; 0 if none
    double unsettled = 0.0;                     ///< largest norm of the last correction of a δ_i [m], [rad]
    Sequence<double> slack;  ///< by stages and constraint equations: −1 on the diagonal of a redundant equation keeps
                             ///< its multiplier unchanged

    /// Allocates all members except `by_stage`.
    explicit Workspace(System& s)
        : q(VecX::Zero(s.coordinates())),
          r(VecX::Zero(s.velocities())),
          phi(VecX::Zero(s.rows())),
          gamma(phi),
          next(r),
          rhs(VecX::Zero(3 * s.size())),
          y(rhs),
          kept(rhs),
          forward(s),
          projected(s),
          slack(3 * std::size_t(equations_of(s) - equation_velocities_of(s)), 0.0) {
      v.fill(r);
      vd.fill(r);
      delta.fill(r);
      rate.fill(r);
      lambda.fill(phi);
      solver.analyse(s, 3, [&](BlockSink& pattern) { write(s, 1.0, pattern); });
    }

    /// Writes the matrix of Newton's method at the last evaluation of `s`. With the Kronecker symbol δ_ij and the
    /// damping and stiffness matrices D and K, block (i, j) is
    ///   δ_ij [M, Gᵀ; G, slack] + h a_ij D + h² (A²)_ij K.
    void write(System& s, double h, BlockSink& sink) {
      for (int i = 0; i < 3; ++i) write_stage(s, h, i, sink);
    }
    /// Writes block row i of the matrix of Newton's method (`write`).
    void write_stage(System& s, double h, int i, BlockSink& sink) {
      Index const n = equations_of(s), velocities = equation_velocities_of(s);
      using T = detail::RadauTableau;
      for (int j = 0; j < 3; ++j) {
        detail::StageBlockSink stage{sink, i * n, j * n, velocities};
        s.tangent({i == j ? 1.0 : 0.0, h * T::a[i][j], h * h * T::squared(i, j)}, SecondOrder::omitted, phi, stage);
        if (i == j)
          for (Index k = 0; k < n - velocities; ++k)
            stage.add(velocities + k, velocities + k,
                      Eigen::Map<Mat<double, 1, 1> const>(&slack[std::size_t(i * (n - velocities) + k)]));
      }
    }
    /// Adds the derivatives of G v̇ + γ at stage i with respect to the stages: h a_ij ∂Φ̈/∂v + h² (A²)_ij ∂Φ̈/∂q.
    void write_slopes(System& s, double h, int i, BlockSink& sink) {
      Index const n = equations_of(s), first = slopes.counts_equations() ? 0 : equation_velocities_of(s);
      using T = detail::RadauTableau;
      for (int j = 0; j < 3; ++j) slopes.write(h * T::a[i][j], h * h * T::squared(i, j), i * n + first, j * n, sink);
    }
    /// Keeps the multipliers of these `redundant` equations unchanged.
    void leave(System const& s, Sequence<Index> const& redundant) {
      Index const velocities = equation_velocities_of(s), rows = equations_of(s) - velocities;
      for (Index const k : redundant)
        for (Index i = 0; i < 3; ++i) slack[std::size_t(i * rows + k - velocities)] = -1.0;
    }
    /// Computes v_i = v₀ + h Σ a_ij v̇_j.
    void set_velocities(VecX const& v0, double h) {
      for (std::size_t i = 0; i < 3; ++i) {
        v[i] = v0;
        for (std::size_t j = 0; j < 3; ++j) v[i] += h * detail::RadauTableau::a[i][j] * vd[j];
      }
    }
    /// Computes δ_i = h Σ a_ij δ˙(δ_j, v_j) by two fixed-point iterations from the last δ. The rate δ˙ depends little
    /// on δ, and without rotations it does not depend on δ.
    void set_positions(System& s, double h) {
      for (int pass = 0; pass < 2; ++pass) {
        unsettled = 0.0;
        for (std::size_t j = 0; j < 3; ++j) s.local_rate(delta[j], v[j], rate[j]);
        for (std::size_t i = 0; i < 3; ++i) {
          next.setZero();
          for (std::size_t j = 0; j < 3; ++j) next += h * detail::RadauTableau::a[i][j] * rate[j];
          delta[i] -= next;
          unsettled = std::max(unsettled, delta[i].norm());
          delta[i] = next;
        }
      }
    }
    /// Replaces the third stage by the values of the stage polynomials, for the initial velocities v0, at the time s h
    /// after the start of the step.
    void end_at(VecX const& v0, double s, double h) {
      v[2] = v0;
      delta[2].setZero();
      for (std::size_t j = 0; j < 3; ++j) {
        auto const [value, integral] = detail::RadauTableau::inside(j, s);
        v[2] += h * integral * vd[j];
        delta[2] += h * integral * rate[j];
      }
      for (VecX* const of : {vd.data(), lambda.data()}) {
        of[2] *= detail::RadauTableau::inside(2, s).value;
        for (std::size_t j = 0; j < 2; ++j) of[2] += detail::RadauTableau::inside(j, s).value * of[j];
      }
    }
  };

  template <class Solver>
  Workspace<Solver> workspace(System& system) const {
    return Workspace<Solver>(system);
  }
  template <class Solver>
  void start(System& system, State& x, double h, Workspace<Solver>& w) const {
    check();
    w.forward.accelerations(system, {x.q, x.v, x.t}, x.a, x.lambda);
    std::fill(w.slack.begin(), w.slack.end(), 0.0);
    if (!w.forward.redundant_rows().empty()) leave_redundant(system, x, h, w);
    w.reused_factorisation.usable = false;
  }

  template <class Solver>
  StepReport step(System& system, State& x, double h, Workspace<Solver>& w) const {
    NewtonReport report;
    StepReport tried;
    double reach = h;  // length of the stages [s]
    bool stages_lose_rank = false;
    // Repetition 1: full Newton. Repetition 2: a matrix for each stage, with stages over h, or over 1.25 h if they lose
    // rank over h. Repetition 3, only with constraint equations: with stages over 1.25 h instead of h, or vice versa.
    for (int effort = 0, last = system.rows() > 0 ? 3 : 2;; ++effort) {
      bool const careful = effort > 0;
      if (effort == 2) stages_lose_rank = loses_rank(system, x, h, w);
      if (effort >= 2) reach = (effort == 2) == stages_lose_rank ? 1.25 * h : h;
      predict(x, reach, w);
      if (careful || std::abs(h - w.h_factored) > 0.25 * w.h_factored) w.reused_factorisation.usable = false;
      NewtonOptions options = newton;
      options.always_refactor = options.always_refactor || careful;
      if (careful) options.max_growths = 8;
      Problem<Solver> problem{*this, system, x, w, reach, system.velocities(), system.rows(), effort >= 2};
      report = polybody::newton(problem, options, w.reused_factorisation);
      if (report.result == NewtonResult::converged) break;
      tried = detail::with_attempt(report, tried, 3);
      if (report.result == NewtonResult::not_finite || effort >= last)
        detail::count_if_failed(w.check.failed, tried, [&] {
          detail::throw_convergence_failure(name, system, x.t + h, report, {problem.bad, w.rhs, w.y});
        });
    }
    StepReport const step = detail::report_of(h, report, 3, tried);
    detail::count_if_failed(w.check.failed, step, [&] { finish(system, x, h, reach, w); });
    return step;
  }

 private:
  /// Evaluates the polynomials of stages over the length `reach` [s] at x.t + h, and projects the result onto the
  /// constraint equations.
  template <class Solver>
  void finish(System& system, State& x, double h, double reach, Workspace<Solver>& w) const {
    w.set_positions(system, reach);
    if (reach != h) w.end_at(x.v, h / reach, reach);
    system.plus(x.q, w.delta[2], w.q);
    projection.apply(system, w.forward, w.projected, w.q, w.v[2], x.t + h);
    if (system.rows() > 0) {  // also projects v̇, at the projected positions and velocities
      w.forward.hold(system, w.q, w.v[2], x.t + h);
      system.acceleration_bias(w.gamma);
      system.rows_times(w.vd[2], w.phi);
      w.phi += w.gamma;
      w.forward.least_change(system, w.phi, w.next);
      w.vd[2] += w.next;
    }
    w.check.require_end(system, {w.q, w.v[2], w.lambda[2], x.t + h, h});
    x.q.swap(w.q);
    x.v.swap(w.v[2]);
    x.a.swap(w.vd[2]);
    x.lambda.swap(w.lambda[2]);
    x.t += h;
  }

  /// Initial stages, with the acceleration and velocity of x.
  template <class Solver>
  static void predict(State const& x, double h, Workspace<Solver>& w) {
    for (std::size_t i = 0; i < 3; ++i) {
      w.vd[i] = x.a;
      w.lambda[i] = x.lambda;
      w.delta[i] = detail::RadauTableau::c[i] * h * x.v;
    }
    w.set_velocities(x.v, h);
  }

  /// True if the constraint Jacobian is much closer to a loss of rank at one of the stages than at x.
  template <class Solver>
  static bool loses_rank(System& system, State const& x, double h, Workspace<Solver>& w) {
    predict(x, h, w);
    for (std::size_t i = 0; i < 3; ++i) {
      system.plus(x.q, w.delta[i], w.q);
      if (w.forward.loses_rank(system, {x.q, x.v, x.t}, {w.q, w.v[i], x.t + detail::RadauTableau::c[i] * h}))
        return true;
    }
    return false;
  }

  /// Excludes equations that are redundant at the start: their multipliers remain unchanged. If fewer equations are
  /// redundant at the second stage of the first step, the start is a singular configuration, and the redundant
  /// equations of the second stage are used instead.
  template <class Solver>
  static void leave_redundant(System& system, State const& x, double h, Workspace<Solver>& w) {
    auto const at_start = w.forward.redundant_rows();
    Sequence<Index> rows(at_start.begin(), at_start.end());
    predict(x, h, w);
    system.plus(x.q, w.delta[1], w.q);
    w.forward.hold(system, w.q, w.v[1], x.t + detail::RadauTableau::c[1] * h);
    auto const in_middle = w.forward.redundant_rows();
    if (in_middle.size() < rows.size()) rows = Sequence<Index>(in_middle.begin(), in_middle.end());
    w.leave(system, rows);
  }

  /// Equations of one step, as a problem of Newton's method.
  template <class Solver>
  struct Problem {
    Radau const& method;
    System& system;
    State const& x;
    Workspace<Solver>& w;
    double h;  ///< length of the stages [s]
    Index nv, rows;
    bool by_stage;
    Index bad = -1;

    double time(std::size_t i) const { return x.t + detail::RadauTableau::c[i] * h; }
    void evaluate_stage(std::size_t i, VecX const& delta) {
      system.plus(x.q, delta, w.q);
      system.evaluate(w.q, w.v[i], time(i));
    }
    bool evaluate(bool perturbed = false) {
      w.set_positions(system, h);
      for (std::size_t i = 0; i < 3; ++i) {
        if (perturbed) detail::perturb(w.delta[i], w.q, w.next);
        evaluate_stage(i, perturbed ? w.next : w.delta[i]);
        system.residual(w.vd[i], w.lambda[i], w.r);
        system.acceleration_bias(w.gamma);
        system.rows_times(w.vd[i], w.phi);
        if (perturbed) detail::perturb(w.phi, w.vd[i], w.phi);
        Index const first = Index(i) * (nv + rows);
        for (Index k = 0; k < nv; ++k) w.rhs[first + k] = -w.r[k];
        for (Index k = 0; k < rows; ++k) w.rhs[first + nv + k] = -(w.phi[k] + w.gamma[k]);
      }
      return all_finite(w.rhs);
    }
    /// Writes the matrix with each block row evaluated at its own stage. Near a singular configuration, the change of G
    /// between two stages is as large as its distance from a matrix of lower rank.
    void write_by_stage(BlockSink& sink) {
      for (int i = 0; i < 3; ++i) {
        auto const k = std::size_t(i);
        system.plus(x.q, w.delta[k], w.q);
        w.slopes.measure(system, w.q, w.v[k], w.vd[k], time(k));
        evaluate_stage(k, w.delta[k]);
        w.by_stage.hold_copy(k);
        w.write_stage(system, h, i, sink);
        w.write_slopes(system, h, i, sink);
      }
    }
    bool refactor_by_stage() {
      auto const write = [&](BlockSink& sink) { write_by_stage(sink); };
      if (!w.has_by_stage) {
        w.slopes.analyse(system);
        w.by_stage.analyse(system, 3, write);
        w.has_by_stage = true;
      }
      w.h_factored = 0.0;
      bad = w.by_stage.factor(write);
      return bad < 0;
    }
    bool refactor() {
      if (by_stage) return refactor_by_stage();
      evaluate_stage(1, w.delta[1]);
      w.h_factored = h;
      bad = w.solver.factor([&](BlockSink& sink) { w.write(system, h, sink); });
      return bad < 0;
    }
    CorrectionSize solve() {
      (by_stage ? w.by_stage : w.solver).solve(w.rhs, w.y);
      return measure();
    }
    CorrectionSize measure() const {
      Index const bodies = nv - system.layout().states;
      double const n = std::sqrt(double(std::max<Index>(bodies, 1)));
      double change = w.unsettled / (h * h);
      for (Index i = 0; i < 3; ++i) change = std::max(change, w.y.segment(i * (nv + rows), bodies).norm());
      CorrectionSize size{all_finite(w.y) ? change / n : std::numeric_limits<double>::quiet_NaN(),
                          method.tolerance * (1.0 + w.vd[2].head(bodies).norm() / n) + detail::rounding_of(w.v[2], h)};
      for (std::size_t i = 0; i < 3; ++i)
        size = detail::StatesInStep{system.layout().states, w.v[i], w.vd[i], h}.join(
            size, method.tolerance, w.y.data() + Index(i) * (nv + rows));
      return size;
    }
    void apply(double part) {
      if (part != 1.0) w.y *= part;
      for (std::size_t i = 0; i < 3; ++i) {
        Index const first = Index(i) * (nv + rows);
        for (Index k = 0; k < nv; ++k) w.vd[i][k] += w.y[first + k];
        for (Index k = 0; k < rows; ++k) w.lambda[i][k] += w.y[first + nv + k];
      }
      w.set_velocities(x.v, h);
    }
    bool is_round_off(double norm) {
      if (!detail::may_be_rounding(h * h * norm, x.q)) return false;
      auto const moved = [&] { return evaluate(true) && std::isfinite(solve().norm); };
      return detail::is_round_off(w.y, norm, w.kept, moved, [&] { return measure().norm; });
    }
  };
};

}  // namespace polybody
