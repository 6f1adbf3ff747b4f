#pragma once
/// \file
/// The tangent-linear of a step of Radau (integrators/radau.hpp), exactly: with what Newton's matrix leaves out.
///
/// With y = (δv̇_i, δλ_i) of the three stages the changes of q_i and v_i follow from their formulas, and
///   δ[M v̇_i − f_i + G_iᵀλ_i] = 0,  δ[G_i v̇_i + γ_i] = 0
/// is linear in y. Its left side comes from a pass of dual numbers through each stage. It is solved by the factors of a
/// matrix of all stages, each with its own tangent with second-order terms and slopes of the rows, and corrected until
/// nothing changes. The projection at the end, and the change of v̇ that follows it, are differentiated as solutions of
/// linear equations at their places (gradients/solved_places.hpp).
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <polybody/gradients/projection_slope.hpp>
#include <polybody/gradients/radau_stages.hpp>
#include <polybody/gradients/solved_places.hpp>

namespace polybody {

/// Slopes of steps of Radau, one step after the other. The stages of a step are not in its states, so they are solved
/// for once more. Where a step stalled and was taken with stages longer than itself, slopes are those of a step with
/// stages of its own length; the two differ as their errors do.
template <LinearSolver Solver = DefaultSolver>
class RadauStepSlope {
 public:
  /// Directions that go through the equations together, a part of a dual number each.
  static constexpr int lanes = SolvedPlaces<Solver>::lanes;

  /// The model must outlive it. \param system with `Entries::implicit_step`
  template <class M>
  [[gnu::cold]] RadauStepSlope(M const& model, System& system, Radau const& method)
      : places_(model, system), projection_(method.projection) {
    slack_.assign(3 * std::size_t(system.rows()), 0.0);
    rhs_ = correction_ = VecX::Zero(3 * system.size());
    along_.fill(rhs_);
    slopes_.analyse(system);
    numbers_.resize(system);
    duals_.resize(places_.template system<D>());
    solver_.analyse(system, 3, [&](BlockSink& sink) { write(0.0, 1.0, sink); });
  }

  /// From now on slopes are those of this step. \throws NewtonStalled where its stages are not found again,
  /// LinearSolverSingular at a singular position, NonFinite.
  void set(StepTaken const& step) {
    predict(step);
    solve_stages(step);
    places_.forget();
    finish(numbers_, step, [&](EquationPlace<>& at) {
      places_.solve(at);
      return places_.largest_row();
    });
  }

  /// Takes up to `lanes` derivatives of the state before the step to those of the state after it. Returns what the last
  /// corrections changed at most, beside all, or beside v̇ and λ over a parameter's scale where that is more. \param
  /// slope what the parameter of a direction does to the equations at each place where the step solves some
  template <TellsEquationSlopes F>
  double advance(StepTaken const& step, std::span<State* const> directions, F&& slope) {
    begin(step, directions);
    auto const by = slopes_of_stages(directions.size(), slope);
    double left = std::numeric_limits<double>::infinity();
    for (int k = 0; k < most_corrections; ++k) {
      evaluate(duals_, dual_equations_, step, [&](Index first) { keep_slopes(first, directions.size(), by); });
      double now = 0.0;
      for (std::size_t l = 0; l < directions.size(); ++l) now = std::max(now, correct(l, by));
      bool const done = now <= 1e-15 || (k > 1 && now <= 1e-10 && now >= 0.3 * left);
      left = now;
      if (done) break;
    }
    duals_.find(places_.template system<D>(), step.h);
    places_.again();
    finish(duals_, step, [&](EquationPlace<D>& at) {
      places_.solve(at, directions.size(), slope);
      return 0.0;
    });
    detail::take_slopes(duals_.at.q, directions, &State::q);
    detail::take_slopes(duals_.at.v, directions, &State::v);
    detail::take_slopes(duals_.next, directions, &State::a);
    detail::take_slopes(duals_.lambda[2], directions, &State::lambda);
    return left;
  }

 private:
  using D = typename SolvedPlaces<Solver>::D;
  using T3 = detail::RadauTableau;
  using SlopesOfStages = std::array<std::array<EquationSlope, 3>, std::size_t(lanes)>;
  static constexpr int most_corrections = 60;

  /// The equations of all stages. \param keep takes them, for the unknowns from `first` on
  template <StateScalar T, class Keep>
  void evaluate(detail::RadauStages<T>& w, PlaceEquations<T>& equations, StepTaken const& step, Keep&& keep) {
    BasicSystem<T>& s = places_.template system<T>();
    w.find(s, step.h);
    for (std::size_t i = 0; i < 3; ++i) {
      w.put(s, i, step);
      equations.evaluate(s, w.at);
      keep(Index(i) * s.size());
    }
  }

  /// Stages between the accelerations before and after. Rows that repeat others at the middle stage have multipliers
  /// that stay as they were.
  void predict(StepTaken const& step) {
    System& s = places_.template system<double>();
    detail::RadauStages<double>& w = numbers_;
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
    places_.forget();
    places_.solve(w.at);
    std::fill(slack_.begin(), slack_.end(), 0.0);
    for (Index const k : places_.dropped())
      for (std::size_t i = 0; i < 3 && k >= s.speeds(); ++i) {
        slack_[i * std::size_t(s.rows()) + std::size_t(k - s.speeds())] = -1.0;
        w.lambda[i][k - s.speeds()] = step.before.lambda[k - s.speeds()];
      }
  }

  /// Newton's method with the matrix of every iterate, until rounding is left. The last factors stay.
  void solve_stages(StepTaken const& step) {
    System& s = places_.template system<double>();
    detail::RadauStages<double>& w = numbers_;
    Index const nv = s.speeds(), rows = s.rows();
    double left = std::numeric_limits<double>::infinity();
    for (int k = 0;; ++k) {
      evaluate(w, equations_, step, [&](Index first) {
        rhs_.segment(first, nv) = -equations_.balance;
        rhs_.segment(first + nv, rows) = -equations_.rows;
      });
      Index const bad = solver_.factor([&](BlockSink& sink) { write(step.before.t, step.h, sink); });
      if (bad >= 0)
        throw LinearSolverSingular{"The derivative of the step that ends at t = ", step.before.t + step.h,
                                   " s has no pivot at ", name_of_equation(s, bad % s.size()), "."};
      solver_.solve(rhs_, correction_);
      double change = 0.0, all = 0.0;
      for (std::size_t i = 0; i < 3; ++i) {
        Index const first = Index(i) * s.size();
        change = std::max(change, correction_.segment(first, nv).norm());
        w.vd[i] += correction_.segment(first, nv);
        w.lambda[i] += correction_.segment(first + nv, rows);
        all = std::max(all, w.vd[i].norm());
      }
      if (change <= 1e-15 * all || (k > 1 && change <= 1e-6 * (1.0 + all) && change >= 0.9 * left)) break;
      if (!std::isfinite(change) || k == most_corrections)
        throw NewtonStalled{"The stages of the step that ends at t = ", step.before.t + step.h,
                            " s are not found again for its derivative. Take a smaller step."};
      left = change;
    }
    w.find(s, step.h);
    for (std::size_t i = 0; i < 3; ++i) {
      w.put(s, i, step);
      stage_places_[i] = w.at;
    }
  }

  /// The matrix of all stages: block (i, j) is
  ///   δ_ij [M, Gᵀ; G, slack] + h a_ij [D; ∂Φ̈/∂v] + h² (A²)_ij [K; ∂Φ̈/∂q] at stage i.
  void write(double t, double h, BlockSink& sink) {
    System& s = places_.template system<double>();
    detail::RadauStages<double>& w = numbers_;
    Index const n = s.size(), speeds = s.speeds(), rows = s.rows();
    for (int i = 0; i < 3; ++i) {
      std::size_t const stage = std::size_t(i);
      double const at = t + T3::c[i] * h;
      s.plus(w.q0, w.delta[stage], w.at.q);
      slopes_.measure(s, w.at.q, w.v[stage], w.vd[stage], at);
      s.evaluate(w.at.q, w.v[stage], at);
      for (int j = 0; j < 3; ++j) {
        detail::StageSink part{sink, i * n, j * n, speeds};
        s.tangent({i == j ? 1.0 : 0.0, h * T3::a[i][j], h * h * T3::squared(i, j)}, SecondOrder::included,
                  w.lambda[stage], part);
        for (Index k = 0; k < rows && i == j; ++k)
          part.add(speeds + k, speeds + k,
                   Eigen::Map<Mat<double, 1, 1> const>(&slack_[stage * std::size_t(rows) + std::size_t(k)]));
      }
      for (int j = 0; j < 3; ++j)
        slopes_.write(h * T3::a[i][j], h * h * T3::squared(i, j), i * n + speeds, j * n, sink);
    }
  }

  /// The start, values of the stages, and derivatives as they were: near what they become.
  void begin(StepTaken const& step, std::span<State* const> directions) {
    detail::lift(step.before.q, directions, &State::q, duals_.q0);
    detail::lift(step.before.v, directions, &State::v, duals_.v0);
    for (std::size_t i = 0; i < 3; ++i) {
      detail::lift(numbers_.vd[i], directions, &State::a, duals_.vd[i]);
      detail::lift(numbers_.lambda[i], directions, &State::lambda, duals_.lambda[i]);
      duals_.delta[i] = numbers_.delta[i].template cast<D>();
    }
  }
  template <class F>
  SlopesOfStages slopes_of_stages(std::size_t directions, F&& slope) {
    SlopesOfStages out;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t l = 0; l < directions; ++l) out[l][i] = slope(stage_places_[i], l);
    return out;
  }

  /// −δ of the equations of a stage, with what the parameters do, into `along_`.
  void keep_slopes(Index first, std::size_t directions, SlopesOfStages const& by) {
    VecXOf<D> const &balance = dual_equations_.balance, &rows = dual_equations_.rows;
    std::size_t const stage = std::size_t(first / places_.template system<double>().size());
    for (std::size_t l = 0; l < directions; ++l) {
      EquationSlope const& of = by[l][stage];
      double* const to = along_[l].data() + first;
      for (Index i = 0; i < balance.size(); ++i) to[i] = -(balance[i].d[Index(l)] + of.balance[i]);
      for (Index i = 0; i < rows.size(); ++i) to[balance.size() + i] = -(rows[i].d[Index(l)] + of.rows[i]);
    }
  }
  /// Corrects δv̇ and δλ of the stages along direction l. Returns by how much, beside all.
  double correct(std::size_t l, SlopesOfStages const& by) {
    solver_.solve(along_[l], correction_);
    Index const n = places_.template system<double>().size(), nv = numbers_.v0.size(), k = Index(l);
    double now = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      double const scale = by[l][i].scale;
      VecX const of_a = correction_.segment(Index(i) * n, nv),
                 of_lambda = correction_.segment(Index(i) * n + nv, n - nv);
      now = std::max({now, add_slope(of_a, k, scale, duals_.vd[i]), add_slope(of_lambda, k, scale, duals_.lambda[i])});
    }
    return now;
  }
  static double add_slope(VecX const& correction, Index l, double scale, VecXOf<D>& to) {
    double slopes = 0.0, values = 0.0;
    for (Index i = 0; i < to.size(); ++i) {
      to[i].d[l] += correction[i];
      slopes = std::hypot(slopes, to[i].d[l]);
      values = std::hypot(values, to[i].v);
    }
    double const all = std::max(slopes, values / scale);
    return all > 0.0 ? correction.norm() / all : correction.norm();
  }

  /// The end from the third stage: q and v in w.at, back on the rows, and v̇, by the rows where they moved to, in
  /// w.next.
  template <StateScalar T, class Solve>
  void finish(detail::RadauStages<T>& w, StepTaken const& step, Solve&& solve) {
    BasicSystem<T>& s = places_.template system<T>();
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

  SolvedPlaces<Solver> places_;
  ProjectionSlope projection_;
  TangentSolver<AutoLu> solver_;
  RowSlopes slopes_;
  PlaceEquations<double> equations_;
  PlaceEquations<D> dual_equations_;
  detail::RadauStages<double> numbers_;
  detail::RadauStages<D> duals_;
  std::array<EquationPlace<>, 3> stage_places_;
  Sequence<double> slack_;  // by stages and rows: −1 on the diagonal of a row that repeats others
  std::array<VecX, std::size_t(lanes)> along_;
  VecX rhs_, correction_;
};

/// Slopes of runs by Radau.
template <>
struct SlopesOfStages<Radau> {
  using Type = RadauStepSlope<>;  ///< of its steps
};

}  // namespace polybody
