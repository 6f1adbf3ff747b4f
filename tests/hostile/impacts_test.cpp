// Balls that bounce by events until their impacts accumulate: no ball falls through the floor.
#include <gtest/gtest.h>

#include <cstdlib>
#include <polybody/polybody.hpp>

#include "support/refusal.hpp"

namespace polybody {
namespace impacts_test {

constexpr double g = 9.81;

/// The lowest height at the end of a step, and the number of steps.
struct Bounced {
  double lowest = 0.0;
  long steps = 0;
  RunReport report;
  State end;
};

Event floor_event(double restitution, bool rests, double height = 0.0) {
  return {.name = "floor",
          .value = [height](State const& x) { return x.q[1] - height; },
          .action = [restitution](State& x) { x.v[1] *= -restitution; },
          .rests = rests};
}

template <class I>
Bounced bounce(I const& integrator, double restitution, double step, double height, bool rests, double speed = 0.0) {
  Model<Bodies<planar::Rigid>, Joints<>> model{Gravity{0, -g, 0}};
  model.add(planar::Rigid(1.0, 0.01, Placement::at({0, height, 0})), "ball");
  Bounced out;
  out.end = model.reference_state();
  out.end.v[1] = speed;
  auto run = simulate(model, out.end, integrator,
                      {.end_time = 10.0, .step = step, .events = {floor_event(restitution, rests)}});
  while (!run.done()) {
    run.advance();
    out.lowest = std::min(out.lowest, out.end.q[1]);
    if (++out.steps > 200000) throw Error("the run does not end");
  }
  out.report = run.report();
  return out;
}

/// Time at which a ball dropped from 1 m comes to rest, by the sum of flights; infinite for e = 1.
double comes_to_rest(double e) { return std::sqrt(2.0 / g) * (1.0 + e) / (1.0 - e); }

template <class I>
void expect_bounces(I const& integrator, std::vector<double> const& restitutions, std::vector<double> const& steps,
                    double within) {
  for (double const e : restitutions)
    for (double const step : steps) {
      SCOPED_TRACE(std::string(I::name) + ", e = " + number(e) + ", step " + number(step));
      try {
        Bounced const ball = bounce(integrator, e, step, 1.0, true);
        EXPECT_GE(ball.lowest, -1e-6);
        EXPECT_EQ(ball.end.t, 10.0);
        if (e < 1.0 && comes_to_rest(e) < 9.0) {
          EXPECT_NEAR(ball.end.q[1], 0.0, 1e-9);
          EXPECT_NEAR(ball.end.v[1], 0.0, 1e-9);
          ASSERT_FALSE(ball.report.events.empty());
          EXPECT_EQ(ball.report.events.back().name, "floor comes to rest");
          EXPECT_NEAR(ball.report.events.back().time, comes_to_rest(e), within * comes_to_rest(e));
        }
        if (e < 1.0) {
          std::string const said = refusal([&] { bounce(integrator, e, step, 1.0, false); });
          if (comes_to_rest(e) < 9.0) {
            EXPECT_TRUE(has(said, "The event \"floor\" occurs again"));
          }
        }
      } catch (std::exception const& error) {
        ADD_FAILURE() << error.what();
      }
    }
}

bool all() {
  char const* const asked = std::getenv("POLYBODY_HOSTILE");
  return asked && std::string(asked) == "all";
}

TEST(Impacts, ABallNeverFallsThroughAFloorOfEvents) {
  std::vector<double> const e = all() ? std::vector<double>{0.0, 0.1, 0.3, 0.5, 0.8, 0.9, 0.95, 1.0}
                                      : std::vector<double>{0.0, 0.5, 0.8},
                            h = all() ? std::vector<double>{0.1, 1e-2, 1e-3} : std::vector<double>{1e-2};
  expect_bounces(GeneralisedAlpha{}, e, h, 1e-6);
  expect_bounces(HhtAlpha{}, e, h, 1e-6);
  expect_bounces(Newmark{}, e, h, 1e-6);
  expect_bounces(Trapezoidal{}, e, h, 1e-6);
  expect_bounces(EnergyMomentum{}, e, h, 1e-6);
  expect_bounces(EnergyDecaying{}, e, h, 0.2);
  expect_bounces(Radau{}, e, h, 1e-6);
  expect_bounces(Rattle{}, e, h, 1e-6);
  expect_bounces(RungeKutta4<>{}, e, h, 1e-6);
  expect_bounces(CentralDifference<>{}, e, h, 0.2);
  expect_bounces(SymplecticEuler{}, e, h, 0.4);  // a first-order method: steps that end at impacts dissipate energy
  expect_bounces(DormandPrince<>{}, e, h, 1e-6);
  // a multistep method restarts with short steps after each resting contact of the ball
  expect_bounces(AdamsBashforthMoulton<>{.relative_tolerance = 1e-5, .absolute_tolerance = 1e-5}, e, h, 1e-2);
}

}  // namespace impacts_test
}  // namespace polybody
