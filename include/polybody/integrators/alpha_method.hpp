#pragma once
/// \file
/// Family of generalised-α methods with algorithmic accelerations a, on Lie groups, for index-3 equations [Arnold &
/// Brüls 2007; Brüls, Cardona & Arnold 2012]:
///   M v̇₁ = f₁ − Gᵀλ₁,  Φ(q₁) = 0,
///   (1 − α_m) a₁ + α_m a₀ = (1 − α_f) v̇₁ + α_f v̇₀,
///   v₁ = v₀ + h((1 − γ) a₀ + γ a₁),   q₁ = q₀ ⊞ (h v₀ + h²((½ − β) a₀ + β a₁)).
/// The Newton unknowns are y = Δa₁ and Δλ₁, with Δq = βh² y, Δv = γh y and Δv̇ = (1 − α_m)/(1 − α_f) y. The constraint
/// equations are divided by βh², so that the entries of the tangent have the magnitude of M and G for any h.
/// Nonholonomic equations, G v + Φ_t = 0 at the end of the step, are divided by γh, so that their rows of the tangent
/// are also rows of G. First-order states use the formulas of a and v, which are the formulas of the family for ż =
/// h(z, t) [Jansen, Whiting & Hulbert 2000]. Generalised-α, HHT-α, Newmark's method and the trapezoidal rule differ
/// only in the four coefficients. Theory: Eqs. 6.1 to 6.3, 6.6 to 6.10.
///
/// A stabilised step also satisfies the derivatives of the constraint equations, Φ̇(q₁, v₁) = 0, by a second set of
/// multipliers μ [Gear, Gupta & Leimkuhler 1985; Arnold, Brüls & Cardona 2015]:
///   q₁ = q₀ ⊞ (h v₀ + h²((½ − β) a₀ + β a₁) − M⁻¹(q₀) Gᵀ(q₀) μ).
/// λ then enforces Φ̇ = 0, and μ enforces Φ = 0. Newton's method solves for λ with the tangent and for μ with the matrix
/// [M, Gᵀ; G, 0] at q₀. The next right-hand side contains the effect of each solution on the other equations.

#include <optional>

#include <polybody/integrators/alpha_vectors.hpp>
#include <polybody/integrators/island_steps.hpp>
#include <polybody/integrators/jerk_at_start.hpp>
#include <polybody/integrators/line_search.hpp>
#include <polybody/integrators/step_tangent.hpp>
#include <polybody/math/sequence.hpp>

namespace polybody {

/// Member of the generalised-α family: coefficients and options of Newton's method.
struct AlphaMethod {
  char const* name;                      ///< name of the integrator in messages
  double alpha_m, alpha_f, gamma, beta;  ///< coefficients α_m, α_f, γ and β [1]
  double tolerance;                      ///< tolerance of Newton's corrections, relative to the accelerations
  NewtonOptions newton;                  ///< options of Newton's method
  bool start_correction;    ///< true: multipliers have second order from the first step on, and across changes of h
  bool second_order_terms;  ///< true: ∂(Gᵀλ)/∂q, ∂(Jᵀw)/∂q in every tangent; false: only after failed steps
  bool stabilised;          ///< true: μ enforces Φ = 0, and λ enforces Φ̇ = 0

  /// Memory of a step, allocated once.
  template <class Solver>
  struct Workspace : AlphaVectors {
    StepTangent<StepSolver<Solver>> tangent;   ///< tangent of a step, with its solver
    ForwardDynamics<Solver> forward;           ///< solver of [M, Gᵀ; G, 0]: accelerations at the start, μ
    StepCheck check;                           ///< checks of the steps of a run
    ReusedFactorisation reused_factorisation;  ///< state of the reused factorisation of the tangent
    double h_factored = 0.0;                   ///< step length of the last factorisation of the tangent [s]
    IslandSteps<AlphaMethod, Solver> islands;  ///< islands of the model, for steps that solve them apart

    /// Allocates the vectors and `forward`; `analyse` allocates the tangent.
    explicit Workspace(System& s)
        : AlphaVectors(s.coordinates(), s.velocities(), s.rows(), multipliers_of(s), s.layout().states), forward(s) {}

    /// Solver of the present tangent, with or without second-order terms.
    TangentSolver<StepSolver<Solver>>& solver() { return tangent.solver(); }
  };

  template <class Solver>
  Workspace<Solver> workspace(System& system) const {
    Workspace<Solver> w(system);
    analyse(system, w);
    return w;
  }
  /// Analyses the tangent of steps; required after the constructor of a workspace.
  template <class Solver>
  void analyse(System& system, Workspace<Solver>& w) const {
    w.tangent.analyse(system, second_order_terms ? SecondOrder::included : SecondOrder::omitted, w.lambda);
  }

  /// Starts a run, and factorises the tangent for steps of h [s].
  template <class Solver>
  void start(System& system, State& x, double h, Workspace<Solver>& w) const {
    begin(system, x, h, w);
    w.tangent.mark_redundant(w.forward.left_out());
    // factorised here, so that the solver does not change its elimination order within the first step
    w.tangent.evaluate(system, {x.q, x.v, x.t});
    (void)refactor(system, h, {{x.q, x.v, x.t}, x.a, x.lambda}, w);
  }
  /// Computes consistent v̇ and λ at x and discards the history of earlier steps. The tangent is not analysed. \param
  /// corrected applies or omits the start correction; if empty, `jerk_at_start` decides for steps of h
  template <class Solver>
  void begin(System& system, State& x, double h, Workspace<Solver>& w, std::optional<bool> corrected = {}) const {
    w.tangent.forget();
    w.forward.accelerations(system, {x.q, x.v, x.t}, x.a, x.lambda);
    append_multipliers(system, x);
    StepHistory::reset(x);
    w.reused_factorisation.usable = false;
    w.islands.forget(w.forward.leaves_out());
    if (start_correction && corrected != false && corrected.value_or(detail::jerk_at_start(system, x, h, w)))
      StepHistory(x).pretend(x, w.jerk, h);
  }

  template <class Solver>
  StepReport step(System& system, State& x, double h, Workspace<Solver>& w) const {
    (void)start_step(system, x, h, w);
    return w.islands.active() ? advance_apart(system, x, h, w) : advance(system, x, h, w);
  }

  /// Stores v₀ and a₀ of a step of h [s] from x in w. With `start_correction`, corrects them and returns true if v and
  /// a of the history are not yet corrected for h. \param corrected applies or omits this correction; if empty, it is
  /// applied after a start, and later if h resolves the motion
  template <class Solver>
  bool start_step(System& system, State& x, double h, Workspace<Solver>& w, std::optional<bool> corrected = {}) const {
    StepHistory const history(x);
    w.v0 = x.v;
    history.own(w.a0);
    double const shifted = history.shifted();  // step length for which v and a are shifted; 0 after a start
    bool const corrects =
        start_correction && std::abs(h - shifted) > 1e-9 * h && history.jerk(x, w.jerk) &&
        corrected.value_or(shifted == 0.0 || w.of_each_part([&](Index first, Index end) {  // h resolves the motion
          return h * w.norm(w.jerk, first, end) <= 0.5 * w.norm(x.a, first, end);
        }));
    if (corrects) correct(system, x, shifted, h, w);
    return corrects;
  }
  /// Derivative ∂v̇/∂a of the step, a ratio.
  double mass() const { return (1.0 - alpha_m) / (1.0 - alpha_f); }

 private:
  template <class, class>
  friend class IslandSteps;

  /// Initial iterate of Newton's method: extrapolated v̇ and λ, or those of x if `careful`.
  void guess(State& x, double h, bool careful, AlphaVectors& w) const {
    if (careful) {
      w.vd = x.a;
      w.lambda = x.lambda;
    } else {
      StepHistory(x).extrapolate(x, h, w.vd, w.lambda);
    }
    predict(x, h, w);
  }
  /// Computes a, v and Δq of a step of h from x with the final v̇ in w.vd.
  void predict(State const& x, double h, AlphaVectors& w) const {
    double const part = 1.0 / (1.0 - alpha_m);
    double const *const of_v0 = w.v0.data(), *const of_a0 = w.a0.data(), *const from = x.a.data(),
                        *const to = w.vd.data();
    double *const a = w.a.data(), *const v = w.v.data(), *const dq = w.dq.data();
    for_each_simd_block(w.a.size(), [=, m = *this](auto at) {
      auto const v0 = at(of_v0), a0 = at(of_a0),
                 now = part * (m.alpha_f * at(from) + (1.0 - m.alpha_f) * at(to) - m.alpha_m * a0);
      at.set(a, now);
      at.set(v, v0 + h * ((1.0 - m.gamma) * a0 + m.gamma * now));
      at.set(dq, h * v0 + h * h * ((0.5 - m.beta) * a0 + m.beta * now));
    });
  }
  /// Adds the fraction `part` of the correction y: the first entries of y to a, and the others to λ. v̇, v and Δq
  /// change accordingly. \param both_multiplier_sets true if the step has μ besides λ
  void apply(double part, double h, bool both_multiplier_sets, AlphaVectors& w) const {
    double const of_vd = mass(), of_v = h * gamma, of_dq = beta * h * h;
    double const* const y = w.y.data();
    double *const a = w.a.data(), *const vd = w.vd.data(), *const v = w.v.data(), *const dq = w.dq.data();
    for_each_simd_block(w.v.size(), [=](auto at) {
      auto const da = part * at(y);
      at.set(a, at(a) + da);
      at.set(vd, at(vd) + of_vd * da);
      at.set(v, at(v) + of_v * da);
      at.set(dq, at(dq) + of_dq * da);
    });
    if (both_multiplier_sets)
      for (Index i = 0; i < w.dq.size(); ++i) w.dq[i] += part * w.back[i];
    double const* const of_lambda = y + w.v.size();
    double* const lambda = w.lambda.data();
    for_each_simd_block(w.lambda.size(), [=](auto at) { at.set(lambda, at(lambda) + part * at(of_lambda)); });
  }
  CorrectionSize measure(double h, bool both_multiplier_sets, AlphaVectors const& w) const {
    Index const bodies = w.v.size() - w.states;
    double const s = beta * h * h, n = std::sqrt(double(std::max<Index>(bodies, 1)));
    double const change = std::sqrt(squares(w.y.data(), bodies)) +
                          (both_multiplier_sets ? std::sqrt(squares(w.back)) / s : 0.0),
                 moved = std::sqrt(squares(w.vd.data(), bodies));
    CorrectionSize const size{.norm = change / n,
                              .tolerated = tolerance * (1.0 + moved / n) + detail::rounding_of(w.q, s)};
    return detail::StatesInStep{w.states, w.v, w.vd, gamma * h}.join(size, tolerance, w.y.data());
  }
  void right_hand_side(double h, bool both_multiplier_sets, Sequence<Index> const& nonholonomic,
                       AlphaVectors& w) const {
    w.make_right_hand_side(beta * h * h, gamma * h, both_multiplier_sets, nonholonomic);
  }

  /// Evaluates and factorises the tangent for steps of h at x, where `system` was evaluated last. Returns −1 on
  /// success, otherwise the index of the equation without a pivot.
  template <class Solver>
  Index refactor(System& system, double h, StepPosition const& x, Workspace<Solver>& w,
                 bool surrogate_friction = true) const {
    w.h_factored = h;
    TangentCoefficients const c{mass(), h * gamma, beta * h * h, surrogate_friction};
    return w.tangent.factor(system, x, c);
  }

  /// Equations of one step, as a problem of Newton's method.
  template <class Solver>
  struct Problem {
    AlphaMethod const& method;
    System& system;
    State& x;
    Workspace<Solver>& w;
    double h, look_ahead;  ///< step [s]; fraction of a factorisation's expected use at which its tangent is evaluated
    bool both_multiplier_sets, recomputes_held, surrogate_friction;  ///< the first is true if the step has μ besides λ
    Index bad = -1;
    double applied = 1.0;  ///< applied part of the last correction

    StepPosition place() const { return {{w.q, w.v, x.t + h}, w.vd, w.lambda}; }
    bool evaluate() { return evaluate_at(w.dq); }
    bool evaluate_at(VecX const& dq) {
      system.plus(x.q, dq, w.q);
      w.tangent.evaluate(system, {w.q, w.v, x.t + h});
      w.tangent.balance(system, place(), w.r);
      if (w.phi.size() > 0) system.violation(w.phi);
      if (both_multiplier_sets) w.open = w.phi;
      if (both_multiplier_sets || !system.nonholonomic_equations().empty()) system.violation_rate(w.rate);
      method.right_hand_side(h, both_multiplier_sets, system.nonholonomic_equations(), w);
      return all_finite(w.rhs) && w.tangent.is_finite();
    }
    bool refactor() {
      double const ahead = std::min(look_ahead * w.reused_factorisation.served, 4.0) * h;
      if (ahead > 0.0) {
        for (Index i = 0; i < w.v.size(); ++i) w.ahead[i] = w.dq[i] + ahead * w.v[i];
        system.plus(x.q, w.ahead, w.q);
        w.tangent.evaluate(system, {w.q, w.v, x.t + h});
      }
      if (recomputes_held) w.forward.hold(system, w.q, w.v, x.t + h);
      bool const exact = w.tangent.needs_exact_contacts(w.reused_factorisation.theta);
      bad = method.refactor(system, h, place(), w, surrogate_friction && !exact);
      if (ahead > 0.0 && w.tangent.carries_multipliers()) {
        system.plus(x.q, w.dq, w.q);
        w.tangent.return_to({w.q, w.v, x.t + h});
      }
      return bad < 0;
    }
    bool renews() const { return w.tangent.follows_friction(); }
    CorrectionSize solve() {
      w.tangent.correct(w.rhs, w.y);
      bool const finite = all_finite(w.y);
      if (both_multiplier_sets && finite) {
        w.phi = w.open;
        for (Index i = 0; i < system.velocities(); ++i) w.back[i] = method.beta * h * h * w.y[i];
        system.rows_times(w.back, w.rate);
        w.phi += w.rate;
        for (Index const i : system.nonholonomic_equations()) w.phi[i] = 0.0;  // μ corrects positions only
        w.forward.least_change(system, w.phi, w.back);
      }
      return finite ? method.measure(h, both_multiplier_sets, w)
                    : CorrectionSize{std::numeric_limits<double>::quiet_NaN()};
    }
    AndersonAcceleration& acceleration() { return w.acceleration; }
    VecX& correction() { return w.y; }
    void apply(double part) { method.apply(applied = part, h, both_multiplier_sets, w); }
    bool search(int& count) {
      if (w.lambda.size() > 0 || system.data().actions.empty()) return evaluate();  // only force elements jump
      double const before = w.y.dot(w.rhs);
      if (!evaluate()) return false;
      double const after = w.y.dot(w.rhs), full = applied;
      if (!(before > 0.0) || after >= -0.5 * before) return true;
      bool finite = true;
      count += detail::search_line(before, after, [&](double s) {
        method.apply(s * full - applied, h, false, w);
        applied = s * full;
        finite = evaluate();
        return finite ? w.y.dot(w.rhs) : std::numeric_limits<double>::quiet_NaN();
      });
      return finite;
    }
    /// True if a correction of this `norm` (root mean square of accelerations) moves the bodies further within the step
    /// than their velocities move them.
    bool is_far_from_solution(double norm) const {
      Index const bodies = x.v.size() - w.states;
      return method.beta * h * norm * std::sqrt(double(bodies)) > std::sqrt(squares(x.v.data(), bodies));
    }
    void restart() { method.guess(x, h, false, w); }
    bool is_round_off(double norm) {
      if (!detail::may_be_rounding(w.phi, method.beta * h * h * norm, x.q)) return false;
      w.kept_back = w.back;
      auto const moved = [&] {
        detail::perturb(w.dq, w.q, w.ahead);
        evaluate_at(w.ahead);
        detail::perturb(w.phi, w.q, w.phi);
        w.open = w.phi;
        detail::perturb(w.rate, w.v, w.rate);
        method.right_hand_side(h, both_multiplier_sets, system.nonholonomic_equations(), w);
        bool const finite = std::isfinite(solve().norm);
        w.back -= w.kept_back;
        return finite;
      };
      bool const answer = detail::is_round_off(w.y, norm, w.kept, moved,
                                               [&] { return method.measure(h, both_multiplier_sets, w).norm; });
      w.back.swap(w.kept_back);
      return answer;
    }
  };

  template <class Solver>
  static bool loses_rank(System& system, State const& x, double h, Workspace<Solver>& w) {
    for (Index i = 0; i < x.v.size(); ++i) w.dq[i] = h * x.v[i];
    system.plus(x.q, w.dq, w.q);
    return w.forward.loses_rank(system, {x.q, x.v, x.t}, {w.q, x.v, x.t + h});
  }

  /// Performs one step from x. x changes only if Newton's method converges. A step that does not converge is repeated
  /// without extrapolation, by the full Newton method with all terms of the tangent. μ then acts along Gᵀ of the
  /// iterate, because G rotates far within a step near singular configurations. In models with force groups, a second
  /// repetition uses the approximate stiffness of the groups, because friction jumps. If the rank of G decreases within
  /// a stabilised step, a last repetition omits μ.
  template <class Solver>
  StepReport advance(System& system, State& x, double h, Workspace<Solver>& w, int effort = 0) const {
    bool const careful = effort > 0;
    guess(x, h, careful, w);
    w.tangent.begin_step();
    bool const both_multiplier_sets = stabilised && system.rows() > 0 && effort <= w.tangent.repetitions(system);
    if (both_multiplier_sets) w.forward.hold(system, x.q, x.v, x.t);
    if (w.h_factored == 0.0 || std::abs(h - w.h_factored) > 0.25 * w.h_factored) w.reused_factorisation.usable = false;

    NewtonOptions options = newton;
    if (careful) {
      options.always_refactor = true;
      options.max_growths = 8;  // the damped iteration recovers
      options.max_iterations *= 2;
    }
    // corrections of μ are large and vanish quickly, so their contraction does not predict the other corrections
    options.predictive_stop = options.predictive_stop && !both_multiplier_sets;
    // a new tangent is evaluated near the middle of its expected use, estimated from the use of the last factorisation
    Problem<Solver> problem{*this,
                            system,
                            x,
                            w,
                            h,
                            options.always_refactor ? 0.0 : 0.4,
                            both_multiplier_sets,
                            both_multiplier_sets && careful,
                            effort != 1};
    if (w.tangent.carries_multipliers()) w.reused_factorisation.theta = std::max(w.reused_factorisation.theta, 0.3);
    NewtonReport report = polybody::newton(problem, options, w.reused_factorisation);
    if (report.result != NewtonResult::converged && report.result != NewtonResult::singular &&
        (effort < w.tangent.repetitions(system) || (both_multiplier_sets && loses_rank(system, x, h, w)))) {
      if (effort == 0 && w.islands.begin(*this, system, w))
        return detail::retried(w.check.failed, report, [&] { return advance_apart(system, x, h, w); });
      w.tangent.include(system, w.lambda);
      w.reused_factorisation.usable = false;
      return detail::retried(w.check.failed, report, [&] { return advance(system, x, h, w, effort + 1); });
    }
    if (report.result != NewtonResult::converged && w.tangent.carries_multipliers()) {  // for the message
      system.residual(w.vd, w.lambda, w.r);
      right_hand_side(h, both_multiplier_sets, system.nonholonomic_equations(), w);
    }
    StepReport const step = detail::report_of(h, report);
    detail::count_if_failed(w.check.failed, step, [&] {
      if (report.result != NewtonResult::converged)
        detail::throw_convergence_failure(name, system, x.t + h, report, {problem.bad, w.rhs, w.y});
      // q follows the last correction of dq
      system.plus(x.q, w.dq, w.q);
      w.check.require_end(system, {w.q, w.v, w.lambda, x.t + h, h});
    });
    if (w.solver().lost_rank() || w.tangent.end_step() || report.searches > 0) w.reused_factorisation.usable = false;
    if (w.forward.leaves_out() && w.solver().is_doubtful()) [[unlikely]]
      w.forward.note_doubt();
    if (w.islands.pays(report, options)) (void)w.islands.begin(*this, system, w);
    return accept(x, h, w), step;
  }
  /// Performs one step from x, in which each island has its own iterations and halvings. x changes only if all
  /// converge.
  template <class Solver>
  StepReport advance_apart(System& system, State& x, double h, Workspace<Solver>& w) const {
    StepReport const step = w.islands.step(*this, system, x, h, w);
    detail::count_if_failed(w.check.failed, step,
                            [&] { w.check.require_end(system, {w.q, w.v, w.lambda, x.t + h, h}); });
    w.reused_factorisation.usable = false;
    return accept(x, h, w), step;
  }
  static void accept(State& x, double h, AlphaVectors& w) {
    StepHistory(x).push(x, h, w.a);
    x.q.swap(w.q), x.v.swap(w.v);
    x.a.swap(w.vd), x.lambda.swap(w.lambda);
    x.t += h;
  }

  /// Corrects v₀ and a₀ for a change of the step from h_old to h_new. The a and v of the method differ from those of
  /// the solution by Δ h v̈ and h² P (C v̈ + [v, v̇]/12). Here Δ = α_m − α_f, C = 1/6 − β − Δ/2, and P projects onto
  /// the directions of the constraint forces. A start applies these differences, and a change of h updates them. The
  /// local error of a step is h³ (C v̈ + [v, v̇]/12), because q(t + h) = q ⊞ (h v + ½h² v̇ + h³(v̈/6 + [v, v̇]/12));
  /// the constraint equations compensate this error. [derived from Arnold & Brüls 2007, Lemma 1; the bracket as in
  /// Arnold, Brüls & Cardona 2015]
  template <class Solver>
  void correct(System& system, State const& x, double h_old, double h_new, Workspace<Solver>& w) const {
    double const delta = alpha_m - alpha_f, c = 1.0 / 6.0 - beta - 0.5 * delta;
    for (Index i = 0; i < w.a0.size(); ++i) w.a0[i] += delta * (h_new - h_old) * w.jerk[i];
    if (system.rows() == 0 || stabilised) return;  // μ does not change velocities
    // [v, v̇]/12, because rates in coordinates ⊞ are v + ½[δ, v] + even terms of δ
    for (Index i = 0; i < w.dq.size(); ++i) w.dq[i] = h_new * x.v[i];
    system.local_rate(w.dq, x.a, w.v);
    for (Index i = 0; i < w.dq.size(); ++i) w.dq[i] = -w.dq[i];
    system.local_rate(w.dq, x.a, w.a);
    for (Index i = 0; i < w.jerk.size(); ++i) w.jerk[i] = c * w.jerk[i] + (w.v[i] - w.a[i]) / (12.0 * h_new);
    w.forward.constrained_part(system, x.q, x.v, x.t, w.jerk, w.v);
    for (Index i = 0; i < w.v0.size(); ++i) w.v0[i] += (h_new * h_new - h_old * h_old) * w.v[i];
  }
};

}  // namespace polybody
