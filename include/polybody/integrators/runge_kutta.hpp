#pragma once
/// \file
/// Explicit Runge–Kutta methods on the manifold: with q = q₀ ⊞ δ the pair (δ, v) lives in a vector space and
/// δ˙ = local_rate(δ, v), v̇ = accelerations(q₀ ⊞ δ, v, t) [Munthe-Kaas 1999].

#include <array>
#include <complex>

#include <polybody/integrators/error_tolerance.hpp>
#include <polybody/integrators/explicit_step.hpp>
#include <polybody/integrators/runge_kutta_tableau.hpp>
#include <polybody/integrators/stabilisation.hpp>

namespace polybody {
namespace detail {

/// Stages of an explicit method: positions, speeds and their rates.
template <class Solver, class Stabilisation, int stages>
struct RungeKuttaWorkspace : ExplicitStep<Solver> {
  using Next = ExplicitStep<Solver>;
  using Next::dq, Next::q, Next::v, Next::a, Next::lambda, Next::forward;
  std::array<VecX, stages> position_rate, acceleration;
  typename Stabilisation::Scratch scratch;
  ConstraintFeedback feedback;  ///< of the run

  explicit RungeKuttaWorkspace(System& s) : Next(s), scratch(s) {
    position_rate.fill(v);
    acceleration.fill(v);
  }

  void start(System& system, State& x, Stabilisation const& stabilisation) {
    stabilisation.start(scratch);
    feedback = stabilisation.feedback();
    forward.accelerations(system, {x.q, x.v, x.t}, x.a, x.lambda, feedback);
  }

  /// Rates at x into stage 0: x knows its accelerations.
  void first_stage(System& system, State const& x) {
    dq.setZero();
    system.local_rate(dq, x.v, position_rate[0]);
    acceleration[0] = x.a;
  }
  /// Rates at x + h Σ row[j] k_j into stage i.
  template <std::size_t n>
  void stage(System& system, State const& x, double h, double c, std::array<double, n> const& row, int i) {
    combine(x, h, row, i);
    system.plus(x.q, dq, q);
    system.local_rate(dq, v, position_rate[std::size_t(i)]);
    forward.accelerations(system, {q, v, x.t + c * h}, acceleration[std::size_t(i)], lambda, feedback);
  }

  /// dq, v = h Σ_{j<count} weights[j] k_j (plus v₀).
  template <std::size_t n>
  void combine(State const& x, double h, std::array<double, n> const& weights, int count) {
    dq.setZero();
    v = x.v;
    for (int j = 0; j < count; ++j) {
      if (weights[std::size_t(j)] == 0.0) continue;
      dq += (h * weights[std::size_t(j)]) * position_rate[std::size_t(j)];
      v += (h * weights[std::size_t(j)]) * acceleration[std::size_t(j)];
    }
  }

  /// Projects the combined result and makes it the state at t + h. \param evaluated the last stage is of the combined
  /// result. Returns the evaluations that it takes.
  int accept(System& system, State& x, double h, Stabilisation const& stabilisation, bool evaluated) {
    bool const again = !evaluated || system.rows() > 0;  // a projection moves the state
    system.plus(x.q, dq, q);
    if (again) {
      stabilisation.apply(system, forward, scratch, q, v, x.t + h);
      forward.accelerations(system, {q, v, x.t + h}, a, lambda, feedback);
    } else {
      a = acceleration.back();
    }
    Next::accept(system, x, h);
    return again ? 1 : 0;
  }
};

}  // namespace detail

/// The classical method of order four.
template <class Stabilisation = UnconstrainedOnly>
struct RungeKutta4 {
  static constexpr char const* name = "RungeKutta4";
  static constexpr int order = 4;
  static constexpr bool accepts_constraints = Stabilisation::accepts_constraints;
  static constexpr double stability_limit = 2.8284271247461901;  ///< ωh, a ratio
  using Tableau = detail::ClassicalTableau;                      ///< its coefficients
  /// Where |1 + z + z²/2 + z³/6 + z⁴/24| = 1 along z = hs, s the faster of the roots −d/2 ± √(d²/4 − ω²), d = `rate`
  /// [1/s], ω [rad/s] [Hairer & Wanner 1996, §IV.2].
  static double stable_step(double omega, double rate) {
    double const under = omega * omega - 0.25 * rate * rate;
    std::complex<double> const s =
        under > 0.0 ? std::complex(-0.5 * rate, std::sqrt(under)) : -0.5 * rate - std::sqrt(-under);
    double lo = 2.5, hi = 3.5;  // |z|
    while (hi - lo > 1e-9) {
      double const mid = 0.5 * (lo + hi);
      std::complex<double> const z = mid / std::abs(s) * s;
      (std::abs(1.0 + z * (1.0 + z * (0.5 + z * (1.0 / 6.0 + z / 24.0)))) <= 1.0 ? lo : hi) = mid;
    }
    return lo / std::abs(s);
  }

  Stabilisation stabilisation = {};  ///< how a step keeps to the rows

  void check() const { stabilisation.check(); }
  template <class Solver>
  auto workspace(System& system) const {
    return detail::RungeKuttaWorkspace<Solver, Stabilisation, 4>(system);
  }
  template <class W>
  void start(System& system, State& x, double, W& w) const {
    w.start(system, x, stabilisation);
  }
  template <class W>
  StepReport step(System& system, State& x, double h, W& w) const {
    w.first_stage(system, x);
    for (std::size_t i = 1; i < 4; ++i) w.stage(system, x, h, Tableau::c[i], Tableau::a[i], int(i));
    w.combine(x, h, Tableau::b, 4);
    StepReport report{.taken = h, .next = h, .factorisations = 4, .evaluations = 4};
    detail::count_if_failed(w.forward.failed, report, [&] { w.accept(system, x, h, stabilisation, false); });
    report.choices = detail::choices_of(w.scratch);
    return report;
  }
};

/// The pair of order 5(4) with step control [Dormand & Prince 1980; Hairer, Nørsett & Wanner 1993, §II.4–5].
template <class Stabilisation = UnconstrainedOnly>
struct DormandPrince {
  static constexpr char const* name = "DormandPrince";
  static constexpr int order = 5;
  static constexpr bool accepts_constraints = Stabilisation::accepts_constraints;
  static constexpr bool adaptive_step = true;
  using Tableau = detail::DormandPrinceTableau;  ///< its coefficients

  /// Error of a step relative to the scale of each kind of unknown of each body: the extent of the bodies that act on
  /// each other and that of their velocities, one radian and the body's angular velocity (`detail::ErrorNorm`).
  double relative_tolerance = 1e-8;
  double absolute_tolerance = 1e-10;  ///< added to the relative one, in the units of coordinates and speeds [m], [rad]
  double min_step = 1e-12;            ///< that may be chosen [s]
  Stabilisation stabilisation = {};   ///< how a step keeps to the rows

  /// Everything that a step needs, allocated once.
  template <class Solver>
  struct Workspace : detail::RungeKuttaWorkspace<Solver, Stabilisation, 7> {
    VecX error, v_error;     ///< of coordinates, by speeds; of speeds
    detail::ErrorNorm norm;  ///< of these
    /// Allocates all of it.
    explicit Workspace(System& s)
        : detail::RungeKuttaWorkspace<Solver, Stabilisation, 7>(s), error(this->v), v_error(this->v), norm(s, true) {}
  };

  void check() const {
    require_positive(relative_tolerance, "DormandPrince: the relative tolerance");
    require_positive(absolute_tolerance, "DormandPrince: the absolute tolerance");
    require_positive(min_step, "DormandPrince: the smallest step");
    stabilisation.check();
  }
  template <class Solver>
  Workspace<Solver> workspace(System& system) const {
    return Workspace<Solver>(system);
  }
  template <class W>
  void start(System& system, State& x, double, W& w) const {
    check();
    w.start(system, x, stabilisation);
  }

  /// Takes at most h, less where the error asks for it. \throws MinimumStepReached.
  template <class W>
  StepReport step(System& system, State& x, double h, W& w) const {
    StepReport report;
    w.first_stage(system, x);
    for (;;) {
      for (int i = 1; i < 7; ++i) w.stage(system, x, h, Tableau::c[std::size_t(i)], Tableau::a[std::size_t(i)], i);
      report.evaluations += 6;
      w.error.setZero();
      w.v_error.setZero();
      for (std::size_t j = 0; j < 7; ++j) {
        w.error += (h * Tableau::error[j]) * w.position_rate[j];
        w.v_error += (h * Tableau::error[j]) * w.acceleration[j];
      }
      double const error = std::sqrt(mean_square(system, x, w));
      double const factor = std::clamp(0.9 * std::pow(std::max(error, 1e-10), -0.2), 0.2, 5.0);
      if (error <= 1.0) {
        w.combine(x, h, Tableau::b, Tableau::stages);
        report.evaluations += detail::count_if_failed(
            w.forward.failed, {.factorisations = report.evaluations, .evaluations = report.evaluations},
            [&] { return w.accept(system, x, h, stabilisation, true); });
        report.factorisations = report.evaluations;
        report.taken = h;
        report.next = std::max(h * factor, min_step);
        return report;
      }
      ++report.rejected;
      h *= std::isfinite(error) ? factor : 0.2;
      if (h < min_step)
        throw MinimumStepReached(
            "step.minimum",
            {ErrorObject{"DormandPrince"}, ": the tolerance requires a step below ", min_step,
             " s at t = ", ErrorTime{x.t},
             " s. The model is stiff or jumps here: use an implicit integrator or declare the breakpoint."});
    }
  }

 private:
  /// ‖error‖² (`ErrorNorm`), and the mean square of the errors of first-order states.
  template <class W>
  double mean_square(System const& system, State const& x, W& w) const {
    detail::ErrorTolerance const tolerance{absolute_tolerance, relative_tolerance};
    w.norm.set_scales(system, tolerance, x, w.q, w.v);
    return w.norm.mean_square(w.error, w.v_error) +
           tolerance.mean_square_each(w.v_error, x.v, w.v, system.velocities() - system.layout().states);
  }
};

}  // namespace polybody
