#pragma once
#include <limits>

#include <polybody/integrators/partitioned_rows.hpp>
#include <polybody/integrators/stabilisation.hpp>

namespace polybody {

/// Generalised coordinate partitioning: what a step gives the independent speeds and coordinates stands, the dependent
/// ones follow from the rows,
///   G_d Δq_d = −Φ  (Newton),   G_d v_d = −G_i v_i − Φ_t      [Wehage & Haug 1982; thesis §3.3.1].
/// Independent are the columns of G that full pivoting leaves over. They are chosen anew when a dependent one would
/// move more than `largest_ratio` times as fast as an independent one, that is when G_d⁻¹ G_i, and with it the
/// condition of G_d, has grown too large; and when the rank of G changes. Velocity rows make speeds dependent, not
/// coordinates: with them the two are split apart. Dense: for up to some hundred speeds. Ratios compare metres with
/// radians.
struct CoordinatePartitioning {
  static constexpr bool accepts_rows = true;
  double tolerance = 1e-12;  ///< of Φ, beside what rounding of q leaves
  int max_iterations = 10;
  double largest_ratio = 10.0;  ///< of the rate of a dependent coordinate to that of an independent one

  struct Scratch {
    PartitionedRows rows;      ///< of positions; where there are no velocity rows, of speeds too
    PartitionedRows all_rows;  ///< of speeds where there are
    VecX phi, rate, column, delta, next;
    explicit Scratch(System const& s)
        : rows(s.rows(), s.speeds()),
          all_rows(s.velocity_rows().empty() ? 0 : s.rows(), s.speeds()),
          phi(VecX::Zero(s.rows())),
          rate(phi),
          column(phi),
          delta(VecX::Zero(s.speeds())),
          next(VecX::Zero(s.coordinates())) {}
    PartitionedRows& of_speeds(System const& s) { return s.velocity_rows().empty() ? rows : all_rows; }
  };

  /// \throws InvalidInput unless the tolerance is positive, max_iterations in [1, 10⁶] and the largest ratio at
  /// least 1.
  void check() const {
    require_positive(tolerance, "CoordinatePartitioning: the tolerance");
    require_count(max_iterations, "CoordinatePartitioning: max_iterations");
    if (!(largest_ratio >= 1.0))
      throw InvalidInput{"CoordinatePartitioning: largest_ratio must be at least 1, but is ", largest_ratio, "."};
  }
  void start(Scratch& s) const {
    s.rows.forget();
    s.all_rows.forget();
  }
  RowFeedback feedback() const { return {}; }

  /// \throws NewtonStalled when the positions cannot be brought back.
  template <class Solver>
  void apply(System& system, ForwardDynamics<Solver>& forward, Scratch& s, VecX& q, VecX& v, double t) const {
    if (system.rows() == 0) return;
    double const enough = tolerance + 16.0 * std::numeric_limits<double>::epsilon() * q.cwiseAbs().maxCoeff();
    for (int k = 0;; ++k) {
      reduce(system, s, s.rows, q, v, t);
      if (s.phi.cwiseAbs().maxCoeff() <= enough) break;
      if (k == max_iterations)
        throw NewtonStalled{"CoordinatePartitioning: the positions cannot be brought back to the joints at t = ", t,
                            " s. Take a smaller step."};
      s.rows.solution(0, s.delta);
      system.plus(q, s.delta, s.next);
      q.swap(s.next);
    }
    if (!system.velocity_rows().empty()) return velocities(system, forward, s, q, v, t);
    s.rows.solution(1, s.delta);
    v += s.delta;
  }
  template <class Solver>
  void velocities(System& system, ForwardDynamics<Solver>&, Scratch& s, VecX const& q, VecX& v, double t) const {
    if (system.rows() == 0) return;
    PartitionedRows& rows = s.of_speeds(system);
    reduce(system, s, rows, q, v, t);
    rows.solution(1, s.delta);
    v += s.delta;
  }

 private:
  /// Right-hand sides −Φ and −Φ̇ at (q, v, t), and one of the two reduced.
  template <class = void>
  void reduce(System& system, Scratch& s, PartitionedRows& rows, VecX const& q, VecX const& v, double t) const {
    system.evaluate(q, v, t);
    system.violation(s.phi);
    system.violation_rate(s.rate);
    write(system, s, rows);
    if (rows.reduce(largest_ratio)) return;
    write(system, s, rows);
    rows.choose();
  }
  template <class = void>
  static void write(System& system, Scratch& s, PartitionedRows& rows) {
    rows.begin();
    if (!system.step_coordinates()) {
      system.masses(rows);
    } else {  // the matrix is in other unknowns
      s.delta.setZero();
      for (Index j = 0; j < system.speeds(); ++j) {
        s.delta[j] = 1.0;
        system.rows_times(s.delta, s.column);
        s.delta[j] = 0.0;
        rows.add(system.speeds(), j, s.column);
      }
    }
    for (Index i = 0; i < system.rows(); ++i) {
      rows.right(0, i) = -s.phi[i];
      rows.right(1, i) = -s.rate[i];
    }
    if (&rows == &s.rows)
      for (Index const i : system.velocity_rows()) rows.leave_out(i);
  }
};

}  // namespace polybody
