// Balls that bounce by events until their impacts accumulate, and balls on an elastic floor: no ball falls through.
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

struct Counted {
  int runs = 0, refused = 0, warned = 0;
};

/// Drops a ball from 1 m on an elastic floor with the coefficient of restitution e (0: ten times the critical damping).
/// The run lasts 10 s. It ends in a refusal, it warns, or the ball stays above the depth at which the floor alone
/// stores the energy of the fall, ½ k d² = m g (1 m + d), and below 1 m.
template <class I>
void drop_on_contact(I const& integrator, double e, double step, Counted& count) {
  SCOPED_TRACE(std::string(I::name) + ", e = " + number(e) + ", step " + number(step));
  constexpr double stiffness = 1e5, mass = 1.0, weight = mass * g, height = 1.0;
  double const depth = (weight + std::sqrt(weight * weight + 2.0 * stiffness * weight * height)) / stiffness;
  auto const floor = e > 0.0 ? SpringDamperContact::with_restitution(stiffness, mass, e)
                             : SpringDamperContact{.stiffness = stiffness, .damping = 20.0 * std::sqrt(stiffness)};
  Model<Bodies<Rigid<>>, Joints<>, Forces<Contact<SphereOnPlane>>> model{Gravity{0, 0, -g}};
  auto const ball = model.add(Rigid<>(mass, Mat3::Identity() * 1e-3, Placement::at({0, 0, height})), "ball");
  model.apply(Contact<SphereOnPlane>{.geometry = {.radius = 0.0}, .normal = floor}, ball.at(Vec3(0, 0, 0)),
              model.ground().at({0, 0, 0}), "floor");
  State x = model.reference_state();
  double lowest = height, highest = height;
  ++count.runs;
  try {
    auto run = simulate(model, x, integrator, {.end_time = 10.0, .step = step, .max_step = step});
    for (State const& now : run) {
      lowest = std::min(lowest, now.q[2]);
      highest = std::max(highest, now.q[2]);
    }
    if (!run.report().warnings.empty()) {
      ++count.warned;
      return;
    }
  } catch (Error const&) {
    ++count.refused;
    return;
  }
  EXPECT_GE(lowest, -1.05 * depth);
  EXPECT_LE(highest, 1.1 * height);
}

TEST(Impacts, ABallNeverFallsThroughAFloorOfContact) {
  Counted count;
  for (double const e :
       all() ? std::vector<double>{0.0, 0.05, 0.1, 0.3, 0.5, 0.8, 0.9, 0.95, 1.0} : std::vector<double>{0.0, 0.5, 1.0})
    for (double const h : all() ? std::vector<double>{3e-2, 1e-2, 3e-3, 1e-3, 3e-4} : std::vector<double>{1e-2, 1e-3}) {
      drop_on_contact(GeneralisedAlpha{}, e, h, count);
      drop_on_contact(HhtAlpha{}, e, h, count);
      drop_on_contact(Newmark{}, e, h, count);
      drop_on_contact(Trapezoidal{}, e, h, count);
      drop_on_contact(Radau{}, e, h, count);
      drop_on_contact(Rattle{}, e, h, count);
      drop_on_contact(RungeKutta4<>{}, e, h, count);
      drop_on_contact(CentralDifference<>{}, e, h, count);
      drop_on_contact(SymplecticEuler{}, e, h, count);
      drop_on_contact(DormandPrince<>{}, e, h, count);
      drop_on_contact(AdamsBashforthMoulton<>{}, e, h, count);
    }
  std::cout << count.runs << " runs, " << count.refused << " refused, " << count.warned << " with a warning\n";
  EXPECT_LT(count.refused + count.warned, count.runs);
}

}  // namespace impacts_test
}  // namespace polybody
