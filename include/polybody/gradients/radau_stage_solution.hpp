#pragma once
/// \file
/// Solution of the stages of a Radau step with the matrix of all stages. The derivatives of the step require the
/// stages, which no state contains.

#include <polybody/gradients/evaluation_point.hpp>
#include <polybody/gradients/projection_derivative.hpp>
#include <polybody/integrators/radau.hpp>

namespace polybody::detail {

// Stages of a Radau step (integrators/radau.hpp) in any scalar type, for the derivatives of the step.

/// Largest absolute value of the entries of a vector. For dual numbers, the value and each derivative have separate
/// largest absolute values.
template <StateScalar T>
struct LargestParts {
  double value = 0.0;
  void add(T const& x) { value = std::max(value, std::abs(value_of(x))); }
  bool within(double share, LargestParts const& of) const { return value <= share * of.value; }
};
template <int N>
struct LargestParts<Dual<N>> {
  Eigen::Array<double, N + 1, 1> parts = Eigen::Array<double, N + 1, 1>::Zero();
  void add(Dual<N> const& x) {
    parts[0] = std::max(parts[0], std::abs(x.v));
    for (int l = 0; l < N; ++l) parts[l + 1] = std::max(parts[l + 1], std::abs(x.d[l]));
  }
  bool within(double share, LargestParts const& of) const { return (parts <= share * of.parts).all(); }
};

/// Unknowns v̇_i and λ_i of the three stages, and the quantities that depend on them.
template <StateScalar T>
struct RadauStages {
  VecXOf<T> q0, v0;                                     // at the start of the step
  VecXOf<T> next;                                       // workspace; finally v̇ at the end of the step
  std::array<VecXOf<T>, 3> v, vd, lambda, delta, rate;  // v_i, v̇_i, λ_i, δ_i and δ˙_i of the stages
  EvaluationPoint<T> at;                                // a stage; finally the end of the step

  void resize(BasicSystem<T> const& s) {
    q0 = at.q = VecXOf<T>::Constant(s.coordinates(), T(0.0));
    v0 = next = VecXOf<T>::Constant(s.velocities(), T(0.0));
    for (auto* const of : {&v, &vd, &delta, &rate}) of->fill(v0);
    lambda.fill(VecXOf<T>::Constant(s.rows(), T(0.0)));
  }

  /// Computes v_i = v₀ + h Σ a_ij v̇_j and δ_i = h Σ a_ij δ˙(δ_j, v_j). The fixed-point iteration for δ_i ends when the
  /// changes are at round-off. \param h step length, of type T if it varies [s]
  template <class H>
  void find(BasicSystem<T> const& s, H const& h) {
    for (std::size_t i = 0; i < 3; ++i) {
      v[i] = v0;
      add_weighted(vd, i, h, v[i]);
    }
    bool moves = true;
    for (int pass = 0; moves && pass < most_passes; ++pass) {
      LargestParts<T> change, size;
      for (std::size_t j = 0; j < 3; ++j) s.local_rate(delta[j], v[j], rate[j]);
      for (std::size_t i = 0; i < 3; ++i) {
        next.setConstant(T(0.0));
        add_weighted(rate, i, h, next);
        for (Index k = 0; k < next.size(); ++k) {
          change.add(next[k] - delta[i][k]);
          size.add(next[k]);
        }
        delta[i].swap(next);
      }
      moves = !change.within(4e-16, size);
    }
  }

  /// Sets the evaluation point to stage i of the step.
  void put(BasicSystem<T> const& s, std::size_t i, StepTaken const& step) {
    at.also.resize(0);
    at.terms = {};
    s.plus(q0, delta[i], at.q);
    at.v = v[i];
    at.t = step.before.t + RadauTableau::c[i] * step.h;
    at.a = vd[i];
    at.lambda = lambda[i];
  }

 private:
  static constexpr int most_passes = 30;

  /// sum += h Σ a_ij of_j.
  template <class H>
  static void add_weighted(std::array<VecXOf<T>, 3> const& of, std::size_t i, H const& h, VecXOf<T>& sum) {
    for (std::size_t j = 0; j < 3; ++j) {
      H const weight = h * RadauTableau::a[i][j];
      for (Index k = 0; k < sum.size(); ++k) sum[k] += of[j][k] * weight;
    }
  }
};

/// Computes the stages of successive steps. \tparam Places SolvedPoints or RecordedPoints: the equations, and their
/// solution at the evaluation points after the stages
template <class Places>
class RadauStageSolution {
  using T3 = RadauTableau;
  static constexpr int most_corrections = 60;

 public:
  /// \param places must outlive this object; \param method integrator of the steps
  [[gnu::cold]] RadauStageSolution(Places& places, Radau const& method)
      : places_(&places), projection_(method.projection) {
    System& system = places.template system<double>();
    find_rows(system);
    rhs_ = correction_ = VecX::Zero(3 * system.size());
    if (!system.step_coordinates()) derivatives_.analyse(system);
    numbers_.resize(system);
    solver_.analyse(system, 3, [&](BlockSink& sink) { write(0.0, 1.0, sink); });
  }

  /// Computes the stages of a step again and solves the equations at the points after the stages. \throws
  /// NewtonConvergenceFailure if the stages do not converge, SingularMatrix in a singular configuration,
  /// NonFiniteValue.
  void find(StepTaken const& step) {
    predict(step);
    solve_stages(step);
    places_->forget();
    finish(numbers_, step, [&](EvaluationPoint<>& at) {
      places_->solve(at);
      return places_->largest_row();
    });
  }

  RadauStages<double> const& numbers() const { return numbers_; }                         ///< values of the stages
  std::array<EvaluationPoint<>, 3> const& stage_places() const { return stage_places_; }  ///< points of the stages
  /// Diagonal entry of the matrix for a constraint equation of a stage: −1 if the equation is redundant, so that its
  /// multiplier does not change; otherwise zero.
  double slack(Index stage, Index row) const {
    return slack_[std::size_t(stage * Index(row_of_.size()) + equation_of_[std::size_t(row)])];
  }
  TangentSolver<AutoLu>& solver() { return solver_; }  ///< factors of the matrix of all stages

  /// Evaluates the equations of all stages of a step. \param h step length, of type T if it varies [s]; \param keep
  /// keep(first) takes the equations of each stage from `equations`; `first` is the index of its first unknown
  template <StateScalar T, class H, class Keep>
  void evaluate(RadauStages<T>& w, PointEquations<T>& equations, StepTaken const& step, H const& h, Keep&& keep) {
    BasicSystem<T>& s = places_->template system<T>();
    w.find(s, h);
    for (std::size_t i = 0; i < 3; ++i) {
      w.put(s, i, step);
      equations.evaluate(s, w.at);
      keep(Index(i) * s.size());
    }
  }

  /// Computes the end of the step from the third stage: the projected q and v in w.at, and v̇ in w.next. A correction
  /// adapts v̇ to the constraint equations after the projection.
  template <StateScalar T, class Solve>
  void finish(RadauStages<T>& w, StepTaken const& step, Solve&& solve) {
    BasicSystem<T>& s = places_->template system<T>();
    s.plus(w.q0, w.delta[2], w.at.q);
    w.at.v = w.v[2];
    w.at.t = step.before.t + step.h;
    w.next = w.vd[2];
    if (s.rows() == 0) return;
    projection_.apply(s, w.at, step.h, solve);
    w.at.terms = {.force = 0.0};
    w.at.also = w.vd[2];
    solve(w.at);
    w.next += w.at.a;
  }

  /// Writes the matrix of all stages. With δ_ij = 1 for i = j and δ_ij = 0 otherwise, block (i, j) is
  ///   δ_ij [M, Gᵀ; G, slack] + h a_ij [D; ∂Φ̈/∂v] + h² (A²)_ij [K; ∂Φ̈/∂q] at stage i.
  void write(double t, double h, BlockSink& sink) {
    System& s = places_->template system<double>();
    RadauStages<double>& w = numbers_;
    Index const n = equations_of(s), velocities = equation_velocities_of(s), rows = n - velocities;
    for (int i = 0; i < 3; ++i) {
      std::size_t const stage = std::size_t(i);
      double const at = t + T3::c[i] * h;
      s.plus(w.q0, w.delta[stage], w.at.q);
      derivatives_.measure(s, w.at.q, w.v[stage], w.vd[stage], at);
      evaluate_for_tangent(s, {{w.at.q, w.v[stage], at}, w.vd[stage], w.lambda[stage]}, balance_);
      for (int j = 0; j < 3; ++j) {
        StageBlockSink part{sink, i * n, j * n, velocities};
        s.tangent({i == j ? 1.0 : 0.0, h * T3::a[i][j], h * h * T3::squared(i, j)}, SecondOrder::included,
                  w.lambda[stage], part);
        for (Index k = 0; k < rows && i == j; ++k)
          part.add(velocities + k, velocities + k,
                   Eigen::Map<Mat<double, 1, 1> const>(&slack_[stage * std::size_t(rows) + std::size_t(k)]));
      }
      for (int j = 0; j < 3; ++j)
        derivatives_.write(h * T3::a[i][j], h * h * T3::squared(i, j), i * n + velocities, j * n, sink);
    }
  }

 private:
  /// Initial guess: interpolates v̇ and λ of the stages between the start and the end of the step. Multipliers of
  /// equations that are redundant at the middle stage keep their value at the start.
  void predict(StepTaken const& step) {
    System& s = places_->template system<double>();
    RadauStages<double>& w = numbers_;
    w.q0 = step.before.q;
    w.v0 = step.before.v;
    for (std::size_t i = 0; i < 3; ++i) {
      w.vd[i] = step.before.a + T3::c[i] * (step.after.a - step.before.a);
      w.lambda[i] = step.before.lambda + T3::c[i] * (step.after.lambda - step.before.lambda);
      w.delta[i] = T3::c[i] * step.h * w.v0;
    }
    if (s.rows() == 0) return;
    w.find(s, step.h);
    w.put(s, 1, step);
    places_->forget();
    places_->solve(w.at);
    std::fill(slack_.begin(), slack_.end(), 0.0);
    for (Index const k : places_->dropped()) {
      Index const of_rows = k - equation_velocities_of(s), row = of_rows < 0 ? -1 : row_of_[std::size_t(of_rows)];
      for (std::size_t i = 0; i < 3 && row >= 0; ++i) {
        slack_[i * row_of_.size() + std::size_t(of_rows)] = -1.0;
        w.lambda[i][row] = step.before.lambda[row];
      }
    }
  }
  /// Finds the constraint equation of the step that belongs to each constraint equation of the linear system (−1 for
  /// joints in joint coordinates), and vice versa.
  [[gnu::cold]] void find_rows(System const& s) {
    Index const velocities = equation_velocities_of(s);
    row_of_.assign(std::size_t(equations_of(s) - velocities), -1);
    equation_of_.assign(std::size_t(s.rows()), -1);
    slack_.assign(3 * row_of_.size(), 0.0);
    Coordinates const& c = s.step_coordinates();
    bool const others = c && !c.reduced->full_unknown.empty();
    for (Index k = 0; k < Index(row_of_.size()); ++k) {
      Index row = k;
      if (others) {
        Sequence<Index> const& stay = c.reduced->remaining_equations;
        Index const full = c.reduced->full_unknown[std::size_t(velocities + k)] - s.layout().velocities;
        auto const found = std::lower_bound(stay.begin(), stay.end(), full);
        row = found != stay.end() && *found == full ? Index(found - stay.begin()) : -1;
      }
      row_of_[std::size_t(k)] = row;
      if (row >= 0) equation_of_[std::size_t(row)] = k;
    }
  }

  /// Iterates Newton's method until the corrections are at round-off. A factorisation is reused while each correction
  /// is at most a tenth of the last one. The final factorisation also solves for the derivatives. Its matrix is
  /// evaluated at stages with a relative distance of at most 10⁻⁸ from the solution.
  void solve_stages(StepTaken const& step) {
    double left = std::numeric_limits<double>::infinity(), moved = left;  // moved: change since the factorisation
    for (int k = 0;; ++k) {
      find_right_hand_side(step);
      if (moved == std::numeric_limits<double>::infinity()) {
        factor(step);
        moved = 0.0;
      }
      auto const [change, all] = correct();
      moved += change;
      if (change <= 1e-15 * all || (k > 1 && change <= 1e-6 * (1.0 + all) && change >= 0.9 * left)) {
        if (moved > 1e-8 * all) factor(step);
        break;
      }
      if (!std::isfinite(change) || k == most_corrections)
        throw NewtonConvergenceFailure("derivative.not_converged",
                                       {"The stages of the step to t = ", ErrorTime{step.before.t + step.h},
                                        " s do not converge when they are recomputed for the derivatives. Take a "
                                        "smaller step."});
      if (change > 0.1 * left) moved = std::numeric_limits<double>::infinity();
      left = change;
    }
    RadauStages<double>& w = numbers_;
    BasicSystem<double>& s = places_->template system<double>();
    w.find(s, step.h);
    for (std::size_t i = 0; i < 3; ++i) {
      w.put(s, i, step);
      stage_places_[i] = w.at;
    }
  }
  void find_right_hand_side(StepTaken const& step) {
    evaluate(numbers_, equations_, step, step.h, [&](Index first) {
      rhs_.segment(first, equations_.balance.size()) = -equations_.balance;
      rhs_.segment(first + equations_.balance.size(), equations_.rows.size()) = -equations_.rows;
    });
  }
  /// Factorises the matrix at the current stages.
  void factor(StepTaken const& step) {
    System& s = places_->template system<double>();
    numbers_.find(s, step.h);
    Index const bad = solver_.factor([&](BlockSink& sink) { write(step.before.t, step.h, sink); });
    if (bad >= 0)
      throw SingularMatrix("derivative.singular",
                           {"The equations of the linearised step to t = ", ErrorTime{step.before.t + step.h},
                            " s are singular at ", ErrorObject{name_of_equation(s, bad % equations_of(s))},
                            ". Avoid the singular configuration, or take a smaller step."});
  }
  /// Corrects the stages. Returns the norm of the largest change of v̇ of a stage, and the largest norm of v̇ [m/s²],
  /// [rad/s²].
  std::pair<double, double> correct() {
    RadauStages<double>& w = numbers_;
    Index const nv = w.v0.size(), n = rhs_.size() / 3;
    solver_.solve(rhs_, correction_);
    double change = 0.0, all = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      Index const first = Index(i) * n;
      change = std::max(change, correction_.segment(first, nv).norm());
      w.vd[i] += correction_.segment(first, nv);
      w.lambda[i] += correction_.segment(first + nv, n - nv);
      all = std::max(all, w.vd[i].norm());
    }
    return {change, all};
  }

  Places* places_;
  ProjectionDerivative projection_;
  TangentSolver<AutoLu> solver_;
  ConstraintDerivatives derivatives_;
  PointEquations<double> equations_;
  RadauStages<double> numbers_;
  std::array<EvaluationPoint<>, 3> stage_places_;
  Sequence<Index> row_of_, equation_of_;  // equation of the step for each equation of the linear system; vice versa
  Sequence<double> slack_;                // by stages and constraint equations of the linear system
  VecX rhs_, correction_, balance_;
};

}  // namespace polybody::detail
