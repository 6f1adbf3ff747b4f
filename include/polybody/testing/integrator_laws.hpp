#pragma once
/// \file
/// Tests of properties that every integrator with a fixed step has: `IntegratorLaws`.
///
/// Requires GoogleTest.

#include <polybody/run/energy.hpp>
#include <polybody/run/observe.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/solvers/auto_lu.hpp>
#include <polybody/testing/laws.hpp>

namespace polybody::laws {

/// Measured orders: base-2 logarithms of the ratios of consecutive errors at the steps h, h/2, h/4, …
inline std::vector<double> slopes(std::vector<double> const& errors) {
  std::vector<double> slope;
  for (std::size_t i = 1; i < errors.size(); ++i) slope.push_back(std::log2(errors[i - 1] / errors[i]));
  return slope;
}

/// Laws that every integrator with a fixed step satisfies. A case gives the integrator, a conservative model and a run:
///
///     struct Rk4OnTheTop {
///       using Model = TopModel;                // .model, and .start of type State
///       static std::vector<RungeKutta4<Projection>> integrators();  // with different options
///       static constexpr double end_time = 0.5;  // end time [s]
///       static constexpr int steps = 32;         // number of steps of the coarsest run
///     };
///     bool const rk4_obeys = obeys<Rk4OnTheTop, IntegratorLaws>("Rk4OnTheTop");
///
/// If an integrator has a member `stabilised`, Φ̇ = 0 is tested only if this member is true, and Φ̈ = 0 is not tested.
/// A case declares `static constexpr bool keeps_accelerations = false` if the accelerations at the end of a step belong
/// to predicted velocities; Φ̈ = 0 is then not tested.
template <class Case>
struct IntegratorLaws {
  using Integrator = typename decltype(Case::integrators())::value_type;  ///< type of the case's integrators
  static constexpr double slack = 0.1;  ///< largest allowed excess of the declared order over the measured order [1]

  typename Case::Model setup;  ///< model and initial state of the case

  /// Result of a run: final state and energy error.
  struct Outcome {
    State x;                    ///< state at the end of the run
    double energy_error = 0.0;  ///< largest |E − E(0)| during the run [J]
  };
  /// Run of `steps` equal steps from the initial state to the end time.
  Outcome run(Integrator const& integrator, int steps) const {
    Outcome out{setup.start};
    double const start = energy(setup.model, setup.start).total();
    auto simulation =
        simulate(setup.model, out.x, integrator, {.end_time = Case::end_time, .step = Case::end_time / steps});
    for (State const& now : simulation)
      out.energy_error = std::max(out.energy_error, std::abs(energy(setup.model, now).total() - start));
    EXPECT_EQ(simulation.report().steps, steps);
    return out;
  }
  /// Runs with n, 2n, 4n and 8n steps, n = `Case::steps`.
  std::vector<Outcome> refined(Integrator const& integrator) const {
    std::vector<Outcome> runs;
    for (int k = 1; k <= 8; k *= 2) runs.push_back(run(integrator, Case::steps * k));
    return runs;
  }

  /// ‖x_h − x_{h/2}‖ decreases at least by the factor 2^(order − `slack`) if h is halved, for each of q, v, v̇ and λ.
  void state_converges_at_the_declared_order();
  /// max |E(t) − E(0)| decreases at least by the factor 2^(order − `slack`) if h is halved.
  void energy_error_falls_at_the_declared_order();
  /// |Φ| < 1e-10, |Φ̇| < 1e-10 and |Φ̈| < 1e-8 at the end of a run, with the exceptions of the class comment.
  void rows_hold_at_the_end();
  /// `start` does not change q and v. A step advances t by h, reports h, and suggests h for the next step.
  void step_reports_what_it_took();
  /// The final q, v and λ of two runs are bitwise identical.
  void runs_repeat_to_the_last_bit();
  /// If the squares of the initial velocities overflow, a step throws and does not change the state. The workspace
  /// remains usable.
  void failed_step_leaves_the_state_as_it_was();

  static constexpr char const* suite = "IntegratorLaws";
  static constexpr Law<IntegratorLaws> laws[] = {
      {"StateConvergesAtTheDeclaredOrder", &IntegratorLaws::state_converges_at_the_declared_order},
      {"EnergyErrorFallsAtTheDeclaredOrder", &IntegratorLaws::energy_error_falls_at_the_declared_order},
      {"RowsHoldAtTheEnd", &IntegratorLaws::rows_hold_at_the_end},
      {"StepReportsWhatItTook", &IntegratorLaws::step_reports_what_it_took},
      {"RunsRepeatToTheLastBit", &IntegratorLaws::runs_repeat_to_the_last_bit},
      {"FailedStepLeavesTheStateAsItWas", &IntegratorLaws::failed_step_leaves_the_state_as_it_was}};
};

template <class Case>
void IntegratorLaws<Case>::state_converges_at_the_declared_order() {
  std::pair<char const*, VecX State::*> const parts[] = {
      {"q", &State::q}, {"v", &State::v}, {"a", &State::a}, {"lambda", &State::lambda}};
  for (auto const& integrator : Case::integrators()) {
    auto const runs = refined(integrator);
    for (auto const& [name, part] : parts) {
      if ((runs[0].x.*part).size() == 0) continue;
      std::vector<double> differences;
      for (std::size_t i = 1; i < runs.size(); ++i)
        differences.push_back((runs[i].x.*part - runs[i - 1].x.*part).norm());
      EXPECT_GT(differences.back(), 1e-12) << name << ": differences are too small to measure an order";
      double const order = slopes(differences).back();
      EXPECT_GT(order, integrator.order - slack) << name << ' ' << ::testing::PrintToString(differences);
    }
  }
}

template <class Case>
void IntegratorLaws<Case>::energy_error_falls_at_the_declared_order() {
  for (auto const& integrator : Case::integrators()) {
    std::vector<double> errors;
    for (auto const& outcome : refined(integrator)) errors.push_back(outcome.energy_error);
    EXPECT_GT(errors.back(), 1e-13) << "energy errors are too small to measure an order";
    EXPECT_GT(slopes(errors).back(), integrator.order - slack) << ::testing::PrintToString(errors);
  }
}

template <class Case>
void IntegratorLaws<Case>::rows_hold_at_the_end() {
  for (auto const& integrator : Case::integrators()) {
    auto const outcome = run(integrator, Case::steps);
    System system(setup.model);
    Violation const open = largest_violation(system, outcome.x);
    EXPECT_LT(open.position, 1e-10);
    // Without stabilisation, a step of a generalised-α method satisfies the constraint equations of positions only:
    // velocities are not tested.
    if constexpr (requires { integrator.stabilised; }) {
      EXPECT_TRUE(open.velocity < 1e-10 || !integrator.stabilised) << open.velocity;
    } else {
      EXPECT_LT(open.velocity, 1e-10);
      if constexpr (!requires { requires !Case::keeps_accelerations; }) {
        EXPECT_LT(open.acceleration, 1e-8);
      }
    }
  }
}

template <class Case>
void IntegratorLaws<Case>::step_reports_what_it_took() {
  for (auto const& integrator : Case::integrators()) {
    State x = setup.start;
    System system(setup.model);
    auto const method = method_of(integrator);
    auto workspace = method.template workspace<AutoLu>(system);
    double const h = Case::end_time / Case::steps;
    method.start(system, x, h, workspace);
    EXPECT_EQ(x.q, setup.start.q);
    EXPECT_EQ(x.v, setup.start.v);
    StepReport const report = method.step(system, x, h, workspace);
    EXPECT_EQ(report.taken, h);
    EXPECT_EQ(report.next, h);
    EXPECT_EQ(x.t, setup.start.t + h);
    EXPECT_GT(report.evaluations, 0);
    EXPECT_EQ(report.rejected, 0);
    EXPECT_NE(x.q, setup.start.q);
  }
}

template <class Case>
void IntegratorLaws<Case>::runs_repeat_to_the_last_bit() {
  for (auto const& integrator : Case::integrators()) {
    State const a = run(integrator, Case::steps).x, b = run(integrator, Case::steps).x;
    EXPECT_EQ(a.q, b.q);
    EXPECT_EQ(a.v, b.v);
    EXPECT_EQ(a.lambda, b.lambda);
  }
}

template <class Case>
void IntegratorLaws<Case>::failed_step_leaves_the_state_as_it_was() {
  for (auto const& integrator : Case::integrators()) {
    State x = setup.start;
    System system(setup.model);
    auto const method = method_of(integrator);
    auto workspace = method.template workspace<AutoLu>(system);
    double const h = Case::end_time / Case::steps;
    method.start(system, x, h, workspace);
    State const sound = x;
    x.v.setConstant(1e200);
    State const before = x;
    EXPECT_THROW(method.step(system, x, h, workspace), Error);
    EXPECT_EQ(x.q, before.q);
    EXPECT_EQ(x.v, before.v);
    EXPECT_EQ(x.a, before.a);
    EXPECT_EQ(x.lambda, before.lambda);
    EXPECT_EQ(x.history, before.history);
    EXPECT_EQ(x.t, before.t);
    // The workspace remains usable.
    x = sound;
    EXPECT_NO_THROW(method.step(system, x, h, workspace));
    EXPECT_GT(x.t, sound.t);
  }
}

}  // namespace polybody::laws
