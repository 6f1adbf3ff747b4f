#pragma once
#include <limits>
#include <utility>

#include <polybody/integrators/partitioned_constraints.hpp>
#include <polybody/integrators/sparse_partition.hpp>
#include <polybody/integrators/stabilisation.hpp>

namespace polybody {

/// Generalised coordinate partitioning: what a step gives the independent speeds and coordinates stands, the dependent
/// ones follow from the rows,
///   G_d Δq_d = −Φ  (Newton),   G_d v_d = −G_i v_i − Φ_t      [Wehage & Haug 1982; thesis §3.3.1].
/// Independent are the columns of G that full pivoting leaves over. They are chosen anew when a dependent one would
/// move more than `largest_ratio` times as fast as an independent one, that is when G_d⁻¹ G_i, and with it the
/// condition of G_d, has grown too large; and when the rank of G changes. Velocity rows make speeds dependent, not
/// coordinates: with them the two are split apart. Ratios compare metres with radians.
/// Up to `dense_up_to` speeds G is eliminated in each evaluation. Beyond, factors of a sparse G_d are kept and both
/// equations are solved by corrections; where one leaves more than a fourth open, G_d is factored and the split looked
/// at anew.
struct CoordinatePartitioning {
  static constexpr bool accepts_constraints = true;
  double tolerance = 1e-12;     ///< of Φ, beside what rounding of q leaves
  int max_iterations = 10;      ///< of Newton's method for the positions, before it throws
  double largest_ratio = 10.0;  ///< of the rate of a dependent coordinate to that of an independent one
  int dense_up_to = 60;         ///< speeds

  /// What is kept from step to step: the choice of coordinates and its factorisation.
  struct Scratch {
    PartitionedConstraints rows{0, 0};      ///< of positions; where there are no velocity rows, of speeds too
    PartitionedConstraints all_rows{0, 0};  ///< of speeds where there are
    SparsePartitionOf<> sparse_rows, sparse_all_rows;  ///< the same splits where G is sparse
    VecX phi, rate, column, delta, next;               ///< in order: Φ, Φ̇, a column of G, Δq or Δv, q ⊞ Δq
    bool sparse = false, prepared = false;             ///< G is sparse; the choice between the two was made
    /// Allocates what both ways need.
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
    /// Chooses dense or sparse by the number of speeds, at most `most_dense` for dense, once, and allocates what that
    /// needs.
    void prepare(int most_dense) {
      if (std::exchange(prepared, true)) return;
      sparse = delta.size() > most_dense;
      if (sparse) return;
      rows = PartitionedConstraints(phi.size(), delta.size());
      if (splits_velocities_) all_rows = rows;
    }
    PartitionedConstraints& of_velocities() {
      return splits_velocities_ ? all_rows : rows;
    }  ///< the split of speeds, dense
    /// The split of speeds, sparse.
    SparsePartitionOf<>& sparse_of_velocities() { return splits_velocities_ ? sparse_all_rows : sparse_rows; }
    /// Whether `speed` depends by all rows, of positions and speeds.
    bool is_dependent(Index speed) const {
      if (sparse) return (splits_velocities_ ? sparse_all_rows : sparse_rows).is_dependent(speed);
      return (splits_velocities_ ? all_rows : rows).is_dependent(speed);
    }
    /// How often a split was chosen or changed.
    long choices() const {
      return sparse ? sparse_rows.choices + sparse_all_rows.choices : rows.choices + all_rows.choices;
    }

   private:
    bool splits_velocities_;
  };

  /// \throws InvalidInput unless the tolerance is positive, max_iterations in [1, 10⁶] and the largest ratio at
  /// least 1.
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

  /// A split for (q, v, t) whatever was chosen before.
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

  /// \throws NewtonConvergenceFailure when the positions cannot be brought back.
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
  /// Right-hand sides −Φ and −Φ̇ at (q, v, t), and one of the two reduced.
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
  /// The positions by Newton's method with kept factors. The system is evaluated at what comes out.
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
  /// The speeds likewise, where the system was evaluated last: to what rounding leaves of G v.
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
  /// Solves with kept factors, and renews them where a correction left more than a fourth open: first with the split
  /// that there is, then with a new one.
  struct Corrections {
    SparsePartitionOf<>& partition;
    System& system;
    Scratch& s;
    double limit;                                             ///< of |R|, a ratio
    double before = std::numeric_limits<double>::infinity();  ///< what the last one found open, in the unit of the rows
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
    } else {  // the matrix is in other unknowns
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

/// The independent speeds that a run from x takes first, by the names of their bodies and their numbers there.
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
    if (!scratch.is_dependent(i)) names.push_back(name + ", speed " + std::to_string(number));
  }
  return names;
}

}  // namespace polybody
