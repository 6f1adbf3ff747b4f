#pragma once
/// \file
/// Generalised coordinate partitioning: steps integrate the independent coordinates, and the constraint equations give
/// the dependent ones.

#include <limits>
#include <utility>

#include <polybody/integrators/partitioned_constraints.hpp>
#include <polybody/integrators/sparse_partition.hpp>
#include <polybody/integrators/stabilisation.hpp>

namespace polybody {

/// Generalised coordinate partitioning: a step integrates the independent velocities and coordinates, and the dependent
/// ones follow from the constraint equations,
///   G_d Δq_d = −Φ  (Newton),   G_d v_d = −G_i v_i − Φ_t      [Wehage & Haug 1982; thesis §3.3.1].
/// Full pivoting selects the dependent columns of G; the remaining columns are independent. The columns are selected
/// again if the rank of G changes, or if a dependent coordinate would move more than `largest_ratio` times as fast as
/// an independent one. G_d⁻¹ G_i, and with it the condition number of G_d, is then too large. Nonholonomic equations
/// make velocities dependent, but not coordinates; velocities then have a partition of their own. The ratios depend on
/// the units, because they compare metres with radians.
/// With at most `dense_up_to` velocities, each evaluation eliminates a dense G. In larger systems, the factorisation of
/// a sparse G_d is reused, and the equations of positions and velocities are solved by corrections. If a correction
/// leaves more than a quarter of the violation, G_d is factorised again and the partition is checked.
/// Theory: Eq. 6.26.
struct CoordinatePartitioning {
  static constexpr bool accepts_constraints = true;
  double tolerance = 1e-12;     ///< tolerance of Φ [m], [rad], and for sparse G also of Φ̇, in addition to round-off
  int max_iterations = 10;      ///< limit of Newton iterations; with sparse G three times as many corrections
  double largest_ratio = 10.0;  ///< largest rate of a dependent coordinate relative to that of an independent one
  int dense_up_to = 60;         ///< number of velocities up to which G is dense

  /// Memory between steps: the partition of the coordinates and its factorisation.
  struct Scratch {
    PartitionedConstraints rows{0, 0};  ///< partition of positions; without nonholonomic equations, also of velocities
    PartitionedConstraints all_rows{0, 0};             ///< partition of velocities, if there are nonholonomic equations
    SparsePartitionOf<> sparse_rows, sparse_all_rows;  ///< partitions for sparse G
    VecX phi, rate, column, delta, next;               ///< in order: Φ, Φ̇, a column of G, Δq or Δv, q ⊞ Δq
    bool sparse = false, prepared = false;             ///< true if G is sparse; true if `prepare` was called
    /// Allocates the common memory of dense and sparse partitions.
    explicit Scratch(System const& s)
        : sparse_rows(s.rows(), s.velocities()),
          sparse_all_rows(s.rows(), s.velocities()),
          phi(VecX::Zero(s.rows())),
          rate(phi),
          column(phi),
          delta(VecX::Zero(s.velocities())),
          next(VecX::Zero(s.coordinates())),
          splits_velocities_(!s.nonholonomic_equations().empty()) {
      for (Index const i : s.nonholonomic_equations()) sparse_rows.mark_redundant(i);
    }
    /// At the first call, chooses dense partitions for at most `most_dense` velocities, otherwise sparse ones, and
    /// allocates their memory.
    void prepare(int most_dense) {
      if (std::exchange(prepared, true)) return;
      sparse = delta.size() > most_dense;
      if (sparse) return;
      rows = PartitionedConstraints(phi.size(), delta.size());
      if (splits_velocities_) all_rows = rows;
    }
    /// Dense partition of the velocities.
    PartitionedConstraints& of_velocities() { return splits_velocities_ ? all_rows : rows; }
    /// Sparse partition of the velocities.
    SparsePartitionOf<>& sparse_of_velocities() { return splits_velocities_ ? sparse_all_rows : sparse_rows; }
    /// True if the velocity with the index `speed` is dependent under all constraint equations, including nonholonomic
    /// ones.
    bool is_dependent(Index speed) const {
      if (sparse) return (splits_velocities_ ? sparse_all_rows : sparse_rows).is_dependent(speed);
      return (splits_velocities_ ? all_rows : rows).is_dependent(speed);
    }
    /// Number of times that a partition was selected or changed.
    long choices() const {
      return sparse ? sparse_rows.choices + sparse_all_rows.choices : rows.choices + all_rows.choices;
    }

   private:
    bool splits_velocities_;
  };

  /// \throws InvalidInput unless the tolerance is positive, max_iterations in [1, 10⁶], dense_up_to not negative, and
  /// the largest ratio at least 1.
  void check() const {
    require_positive(tolerance, "CoordinatePartitioning: the tolerance");
    require_count(max_iterations, "CoordinatePartitioning: max_iterations");
    if (dense_up_to < 0)
      throw InvalidInput("integrator.option",
                         {ErrorObject{"CoordinatePartitioning"}, ": dense_up_to must not be negative, but is ",
                          ErrorValue{dense_up_to}, "."});
    if (!(largest_ratio >= 1.0))
      throw InvalidInput("integrator.option",
                         {ErrorObject{"CoordinatePartitioning"}, ": largest_ratio must be at least 1, but is ",
                          ErrorValue{largest_ratio}, "."});
  }
  void start(Scratch& s) const {
    s.prepare(dense_up_to);
    s.rows.forget();
    s.all_rows.forget();
    s.sparse_rows.forget();
    s.sparse_all_rows.forget();
  }
  ConstraintFeedback feedback() const { return {}; }

  /// Selects a partition at (q, v, t), independent of earlier ones.
  template <class = void>
  void choose(System& system, Scratch& s, VecX const& q, VecX const& v, double t) const {
    s.prepare(dense_up_to);
    system.evaluate(q, v, t);
    if (s.sparse) {
      for (auto* const each : {&s.sparse_rows, &s.sparse_of_velocities()}) {
        each->forget();
        write(system, s, *each);
        each->renew(largest_ratio);
      }
      return;
    }
    for (auto* const each : {&s.rows, &s.of_velocities()}) {
      write(system, s, *each);
      each->choose();
    }
  }

  /// Corrects positions and velocities. \throws NewtonConvergenceFailure if the corrections do not converge. \throws
  /// SingularMatrix if a sparse G_d is singular.
  template <class Solver>
  void apply(System& system, ForwardDynamics<Solver>& forward, Scratch& s, VecX& q, VecX& v, double t) const {
    if (system.rows() == 0) return;
    s.prepare(dense_up_to);
    double const enough = tolerance + 16.0 * std::numeric_limits<double>::epsilon() * q.cwiseAbs().maxCoeff();
    if (s.sparse) {
      correct_positions(system, s, q, v, t, enough);
      return correct_velocities(system, s, q, v, t);
    }
    for (int k = 0;; ++k) {
      reduce(system, s, s.rows, q, v, t);
      if (s.phi.cwiseAbs().maxCoeff() <= enough) break;
      if (k == max_iterations)
        throw NewtonConvergenceFailure(
            "projection.not_converged",
            {ErrorObject{"CoordinatePartitioning"},
             ": the projection of the positions onto the constraint equations does not converge at t = ", ErrorTime{t},
             " s. Take a smaller step."});
      s.rows.solution(0, s.delta);
      system.plus(q, s.delta, s.next);
      q.swap(s.next);
    }
    if (!system.nonholonomic_equations().empty()) return velocities(system, forward, s, q, v, t);
    s.rows.solution(1, s.delta);
    v += s.delta;
  }
  template <class Solver>
  void velocities(System& system, ForwardDynamics<Solver>&, Scratch& s, VecX const& q, VecX& v, double t) const {
    if (system.rows() == 0) return;
    s.prepare(dense_up_to);
    if (s.sparse) {
      system.evaluate(q, v, t);
      return correct_velocities(system, s, q, v, t);
    }
    PartitionedConstraints& rows = s.of_velocities();
    reduce(system, s, rows, q, v, t);
    rows.solution(1, s.delta);
    v += s.delta;
  }

 private:
  /// Evaluates the right-hand sides −Φ and −Φ̇ at (q, v, t), and reduces one of the two partitions, `rows`.
  template <class = void>
  void reduce(System& system, Scratch& s, PartitionedConstraints& rows, VecX const& q, VecX const& v, double t) const {
    system.evaluate(q, v, t);
    system.violation(s.phi);
    system.violation_rate(s.rate);
    write(system, s, rows);
    if (rows.reduce(largest_ratio)) return;
    write(system, s, rows);
    rows.choose();
  }
  /// Corrects the positions by Newton's method with a reused factorisation. The system is then evaluated at the result.
  template <class = void>
  void correct_positions(System& system, Scratch& s, VecX& q, VecX const& v, double t, double enough) const {
    Corrections corrections{s.sparse_rows, system, s, largest_ratio};
    for (int k = 0;; ++k) {
      system.evaluate(q, v, t);
      system.violation(s.phi);
      double const open = largest_size(s.phi);
      if (open <= enough) return;
      if (k == 3 * max_iterations)
        throw NewtonConvergenceFailure(
            "projection.not_converged",
            {ErrorObject{"CoordinatePartitioning"},
             ": the projection of the positions onto the constraint equations does not converge at t = ", ErrorTime{t},
             " s. Take a smaller step."});
      corrections.take(s.phi, open);
      system.plus(q, s.delta, s.next);
      q.swap(s.next);
    }
  }
  /// Corrects the velocities with a reused factorisation, up to the round-off of G v. The system must be evaluated at
  /// (q, v, t).
  template <class = void>
  void correct_velocities(System& system, Scratch& s, VecX const& q, VecX& v, double t) const {
    Corrections corrections{s.sparse_of_velocities(), system, s, largest_ratio};
    for (int k = 0;; ++k) {
      system.violation_rate(s.rate);
      double const open = largest_size(s.rate), terms = (1.0 + corrections.partition.largest_entry()) * largest_size(v);
      if (open <= tolerance + 64.0 * std::numeric_limits<double>::epsilon() * (1.0 + terms)) return;
      if (k == 3 * max_iterations)
        throw NewtonConvergenceFailure(
            "projection.not_converged",
            {ErrorObject{"CoordinatePartitioning"},
             ": the projection of the velocities onto the constraint equations does not converge at t = ", ErrorTime{t},
             " s, because redundant constraint equations contradict the others, or the configuration is singular. Take "
             "a smaller step, or run diagnose(model, x)."});
      corrections.take(s.rate, open);
      v += s.delta;
      system.evaluate(q, v, t);
    }
  }
  /// Solves with a reused factorisation. The factorisation is renewed if a correction leaves more than a quarter of the
  /// violation: first with the present partition, then with a new one.
  struct Corrections {
    SparsePartitionOf<>& partition;
    System& system;
    Scratch& s;
    double limit;                                             ///< largest permitted entry of |G_d⁻¹ G_i| [1]
    double before = std::numeric_limits<double>::infinity();  ///< largest |Φ| [m, rad] or |Φ̇| [m/s, rad/s] before the
                                                              ///< last correction
    int renewals = 0;

    template <class = void>
    void take(VecX& open, double size) {
      bool const slow = size > 0.25 * before;
      if (slow && renewals > 0) partition.forget();
      if (slow || !partition.has_factors()) {
        write(system, s, partition);
        partition.renew(limit);
        ++renewals;
      }
      before = size;
      open *= -1.0;
      partition.solve(open, s.delta);
    }
  };

  template <class Rows>
  static void write(System& system, Scratch& s, Rows& rows) {
    rows.begin();
    if (!system.step_coordinates()) {
      system.masses(rows);
    } else {  // the mass matrix has other unknowns than v
      s.delta.setZero();
      for (Index j = 0; j < system.velocities(); ++j) {
        s.delta[j] = 1.0;
        system.rows_times(s.delta, s.column);
        s.delta[j] = 0.0;
        rows.add(system.velocities(), j, s.column);
      }
    }
    if constexpr (std::same_as<Rows, PartitionedConstraints>) take_right_hand_sides(system, s, rows);
  }
  template <class = void>
  static void take_right_hand_sides(System& system, Scratch& s, PartitionedConstraints& rows) {
    for (Index i = 0; i < system.rows(); ++i) {
      rows.right(0, i) = -s.phi[i];
      rows.right(1, i) = -s.rate[i];
    }
    if (&rows == &s.rows)
      for (Index const i : system.nonholonomic_equations()) rows.mark_redundant(i);
  }
};

/// Names of the independent velocities that are selected first in a run from x: body, and index of the velocity in the
/// body, counted from 0.
template <class = void>
std::vector<std::string> independent_velocities(System& system, State const& x,
                                                CoordinatePartitioning const& policy = {}) {
  CoordinatePartitioning::Scratch scratch(system);
  policy.start(scratch);
  policy.choose(system, scratch, x.q, x.v, x.t);
  std::vector<std::string> names;
  std::string body;
  int number = 0;
  for (Index i = 0; i < system.velocities(); ++i) {
    std::string const name = system.name_of(i);
    number = name == body ? number + 1 : 0;
    body = name;
    if (!scratch.is_dependent(i)) names.push_back(name + ", velocity " + std::to_string(number));
  }
  return names;
}

}  // namespace polybody
