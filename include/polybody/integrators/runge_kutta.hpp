#pragma once
/// \file
/// Explicit Runge–Kutta methods on the manifold. With q = q₀ ⊞ δ, the pair (δ, v) is in a vector space, and δ˙ =
/// local_rate(δ, v), v̇ = accelerations(q₀ ⊞ δ, v, t) [Munthe-Kaas 1999].
/// Theory: Eqs. 6.22 to 6.24.

#include <array>
#include <complex>

#include <polybody/integrators/error_tolerance.hpp>
#include <polybody/integrators/integrator.hpp>
#include <polybody/integrators/stabilisation.hpp>
#include <polybody/math/compiler.hpp>

namespace polybody::detail {

/// Coefficients c_i, a_ij and b_j of the classical method of order four.
struct ClassicalTableau {
  static constexpr int stages = 4;
  using Row = std::array<double, 4>;
  static constexpr Row c{0.0, 0.5, 0.5, 1.0};
  static constexpr std::array<Row, 4> a{Row{}, Row{0.5}, Row{0.0, 0.5}, Row{0.0, 0.0, 1.0}};
  static constexpr Row b{1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
};

/// Coefficients c_i, a_ij and b_j of the method of order five, with the weights of the error [Dormand & Prince 1980].
/// The seventh stage is evaluated at the result and contributes to the error only.
struct DormandPrinceTableau {
  static constexpr int stages = 6;  ///< number of stages in the result
  using Row = std::array<double, 7>;
  static constexpr Row c{0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0};
  static constexpr std::array<Row, 7> a{Row{},
                                        Row{1.0 / 5},
                                        Row{3.0 / 40, 9.0 / 40},
                                        Row{44.0 / 45, -56.0 / 15, 32.0 / 9},
                                        Row{19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
                                        Row{9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
                                        Row{35.0 / 384, 0.0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}};
  static constexpr Row b = a[6];
  static constexpr Row error{71.0 / 57600, 0.0, -71.0 / 16695, 71.0 / 1920, -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
};

}  // namespace polybody::detail

namespace polybody {
namespace detail {

/// Memory of an explicit method: rates of positions and accelerations of all stages.
template <class Solver, class Stabilisation, int stages>
struct RungeKuttaWorkspace : ExplicitStep<Solver> {
  using Next = ExplicitStep<Solver>;
  using Next::dq, Next::q, Next::v, Next::a, Next::lambda, Next::forward;
  std::array<VecX, stages> position_rate, acceleration;
  typename Stabilisation::Scratch scratch;
  ConstraintFeedback feedback;  ///< feedback of constraint violations

  explicit RungeKuttaWorkspace(System& s) : Next(s), scratch(s) {
    position_rate.fill(v);
    acceleration.fill(v);
  }

  void start(System& system, State& x, Stabilisation const& stabilisation) {
    stabilisation.start(scratch);
    feedback = stabilisation.feedback();
    forward.accelerations(system, {x.q, x.v, x.t}, x.a, x.lambda, feedback);
  }

  /// Computes the rates at x as stage 0, with the accelerations of x.
  void first_stage(System& system, State const& x) {
    dq.setZero();
    system.local_rate(dq, x.v, position_rate[0]);
    acceleration[0] = x.a;
  }
  /// Computes the rates k_i = (δ˙, v̇) of stage i at x + h Σ row[j] k_j.
  template <std::size_t n>
  void stage(System& system, State const& x, double h, double c, std::array<double, n> const& row, int i) {
    combine(x, h, row, i);
    system.plus(x.q, dq, q);
    system.local_rate(dq, v, position_rate[std::size_t(i)]);
    forward.accelerations(system, {q, v, x.t + c * h}, acceleration[std::size_t(i)], lambda, feedback);
  }

  /// Computes dq = h Σ_{j<count} weights[j] δ˙_j and v = v₀ + h Σ_{j<count} weights[j] v̇_j.
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

  /// Projects the combined result and stores it in x as the state at t + h. Returns the number of evaluations. \param
  /// evaluated true if the last stage was evaluated at the combined result
  int accept(System& system, State& x, double h, Stabilisation const& stabilisation, bool evaluated) {
    bool const again = !evaluated || system.rows() > 0;  // a projection changes the state
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

struct RungeKuttaDerivatives;  // gradients/runge_kutta_derivatives.hpp

/// Classical Runge–Kutta method of order four.
template <class Stabilisation = UnconstrainedOnly>
struct RungeKutta4 {
  static constexpr char const* name = "RungeKutta4";
  static constexpr int order = 4;
  static constexpr bool accepts_constraints = Stabilisation::accepts_constraints;
  static constexpr double stability_limit = 2.8284271247461901;  ///< largest stable ωh [1]
  using Tableau = detail::ClassicalTableau;                      ///< coefficients of the method
  using Derivatives = RungeKuttaDerivatives;                     ///< linearised step and adjoint of a step
  /// Largest h with |1 + z + z²/2 + z³/6 + z⁴/24| ≤ 1 for z = hs. The number s is the root of larger magnitude of −d/2
  /// ± √(d²/4 − ω²), with d = `rate` [1/s] and ω = `omega` [rad/s] [Hairer & Wanner 1996, §IV.2].
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

  Stabilisation stabilisation = {};  ///< constraint stabilisation

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
    detail::count_if_failed(w.check.failed, report, [&] { w.accept(system, x, h, stabilisation, false); });
    report.choices = detail::choices_of(w.scratch);
    return report;
  }
};

/// Dormand–Prince pair of order 5(4) with step control [Dormand & Prince 1980; Hairer, Nørsett & Wanner 1993, §II.4–5].
template <class Stabilisation = UnconstrainedOnly>
struct DormandPrince {
  static constexpr char const* name = "DormandPrince";
  static constexpr int order = 5;
  static constexpr bool accepts_constraints = Stabilisation::accepts_constraints;
  static constexpr bool adaptive_step = true;
  using Tableau = detail::DormandPrinceTableau;  ///< coefficients of the method
  using Derivatives = RungeKuttaDerivatives;     ///< linearised step and adjoint of a step

  /// Tolerated error of a step relative to the scale of each kind of unknown of each body. The scales are the extents
  /// of the positions and velocities of an assembly, one radian, and the angular velocity of the body
  /// (`detail::ErrorNorm`).
  double relative_tolerance = 1e-8;
  double absolute_tolerance = 1e-10;  ///< added to the relative part, in the unit of the unknown
  double min_step = 1e-12;            ///< smallest permitted step [s]
  Stabilisation stabilisation = {};   ///< constraint stabilisation

  /// Memory of a step, allocated once.
  template <class Solver>
  struct Workspace : detail::RungeKuttaWorkspace<Solver, Stabilisation, 7> {
    VecX error, v_error;     ///< errors of coordinates, numbered as velocities, and of velocities
    detail::ErrorNorm norm;  ///< norm of these errors
    /// Allocates all members.
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

  /// Integrates over h, or over a shorter step if the tolerance requires it. \throws MinimumStepReached if the
  /// tolerance requires a step below `min_step`.
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
            w.check.failed, {.factorisations = report.evaluations, .evaluations = report.evaluations},
            [&] { return w.accept(system, x, h, stabilisation, true); });
        report.factorisations = report.evaluations;
        report.taken = h;
        report.next = std::max(h * factor, min_step);
        return report;
      }
      ++report.rejected;
      h *= std::isfinite(error) ? factor : 0.2;
      if (h < min_step)
        throw MinimumStepReached("step.minimum",
                                 {ErrorObject{"DormandPrince"}, ": the tolerance requires a step below ", min_step,
                                  " s at t = ", ErrorTime{x.t},
                                  " s. The model is stiff or discontinuous at this time. Use an implicit integrator, "
                                  "or declare the time as a breakpoint."});
    }
  }

 private:
  /// ‖error‖² (`ErrorNorm`), plus the mean square of the errors of first-order states.
  template <class W>
  double mean_square(System const& system, State const& x, W& w) const {
    detail::ErrorTolerance const tolerance{absolute_tolerance, relative_tolerance};
    w.norm.set_scales(system, tolerance, x, w.q, w.v);
    return w.norm.mean_square(w.error, w.v_error) +
           tolerance.mean_square_each(w.v_error, x.v, w.v, system.velocities() - system.layout().states);
  }
};

}  // namespace polybody
