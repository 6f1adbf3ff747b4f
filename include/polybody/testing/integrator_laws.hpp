#pragma once
/// \file
/// What every integrator with a fixed step owes. A case names the integrator, a conservative model and a run:
///
///     struct Rk4OnTheTop {
///       using Model = TopModel;                                  // .model, and .start of type State
///       static std::vector<RungeKutta4<Projection>> integrators();  // that differ in options only
///       static constexpr double until = 0.5;                     // [s]
///       static constexpr int steps = 32;                         // of the coarsest run
///     };
///     bool const rk4_obeys = obeys<Rk4OnTheTop, IntegratorLaws>("Rk4OnTheTop");
///
/// An integrator with a member `stabilised` keeps the rows of speeds where it is true; any other keeps them always. A
/// case says `static constexpr bool keeps_accelerations = false` of an integrator whose last accelerations belong to
/// predicted speeds.
///
/// Not in polybody.hpp: needs GoogleTest.

#include <polybody/run/energy.hpp>
#include <polybody/run/observe.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/solvers/auto_lu.hpp>
#include <polybody/testing/laws.hpp>

namespace polybody::laws {

/// log₂ of the ratio of neighbours: the measured order of errors at h, h/2, h/4, …
inline std::vector<double> slopes(std::vector<double> const& errors) {
  std::vector<double> slope;
  for (std::size_t i = 1; i < errors.size(); ++i) slope.push_back(std::log2(errors[i - 1] / errors[i]));
  return slope;
}

/// The laws of integrators, for one case.
template <class Case>
struct IntegratorLaws {
  using Integrator = typename decltype(Case::integrators())::value_type;  ///< type of the case's integrators
  static constexpr double slack = 0.1;  ///< by how much a measured order may fall short, a part of one order

  typename Case::Model setup;  ///< model and start of the case

  /// Where a run ends, and how much energy it lost or gained on the way.
  struct Outcome {
    State x;                    ///< state at the end of the run
    double energy_error = 0.0;  ///< largest |E − E(0)| on the way [J]
  };
  /// A run of `steps` equal steps from the case's start to its end.
  Outcome run(Integrator const& integrator, int steps) const {
    Outcome out{setup.start};
    double const start = energy(setup.model, setup.start).total();
    auto simulation = simulate(setup.model, out.x, integrator, {.until = Case::until, .step = Case::until / steps});
    for (State const& now : simulation)
      out.energy_error = std::max(out.energy_error, std::abs(energy(setup.model, now).total() - start));
    EXPECT_EQ(simulation.report().steps, steps);
    return out;
  }
  /// The runs at steps, 2 steps, 4 steps, 8 steps.
  std::vector<Outcome> refined(Integrator const& integrator) const {
    std::vector<Outcome> runs;
    for (int k = 1; k <= 8; k *= 2) runs.push_back(run(integrator, Case::steps * k));
    return runs;
  }

  /// ‖x_h − x_{h/2}‖ falls by 2^order as h is halved, for each of q, v, v̇ and λ.
  void state_converges_at_the_declared_order();
  /// max |E(t) − E(0)| falls by 2^order likewise.
  void energy_error_falls_at_the_declared_order();
  /// |Φ| < 1e-10, |Φ̇| < 1e-10 and |Φ̈| < 1e-8 at the end of a run.
  void rows_hold_at_the_end();
  /// `start` leaves q and v; a step takes h, says so, suggests h again and moves t by it.
  void step_reports_what_it_took();
  /// Two runs end in the same bits.
  void runs_repeat_to_the_last_bit();
  /// A step from speeds whose squares overflow throws and leaves the state; the workspace serves on.
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
      EXPECT_GT(differences.back(), 1e-12) << name << ": too small to tell";
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
    EXPECT_GT(errors.back(), 1e-13) << "too small to tell";
    EXPECT_GT(slopes(errors).back(), integrator.order - slack) << ::testing::PrintToString(errors);
  }
}

template <class Case>
void IntegratorLaws<Case>::rows_hold_at_the_end() {
  for (auto const& integrator : Case::integrators()) {
    auto const outcome = run(integrator, Case::steps);
    System system(setup.model);
    Violation const open = violation(system, outcome.x);
    EXPECT_LT(open.position, 1e-10);
    // Without stabilisation a step of the family of generalised-α keeps the rows of the positions only.
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
    double const h = Case::until / Case::steps;
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
    double const h = Case::until / Case::steps;
    method.start(system, x, h, workspace);
    State const sound = x;
    x.v.setConstant(1e200);
    State const before = x;
    EXPECT_THROW(method.step(system, x, h, workspace), Error);
    EXPECT_EQ(x.q, before.q);
    EXPECT_EQ(x.v, before.v);
    EXPECT_EQ(x.a, before.a);
    EXPECT_EQ(x.lambda, before.lambda);
    EXPECT_EQ(x.memory, before.memory);
    EXPECT_EQ(x.t, before.t);
    // The workspace serves on.
    x = sound;
    EXPECT_NO_THROW(method.step(system, x, h, workspace));
    EXPECT_GT(x.t, sound.t);
  }
}

}  // namespace polybody::laws
