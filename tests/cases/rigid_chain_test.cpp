// Pendulums of several links, released from the horizontal (R8). The reference is an independent ODE solver of order
// eight (DOP853).

#include <gtest/gtest.h>

#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/run/simulate.hpp>

#include "support/chain.hpp"
#include "support/held.hpp"

using namespace polybody;

namespace rigid_chain_test {

using Plane = Chain<InPlane<Constraint>>;
using Space = Chain<InSpace<Constraint>>;

DormandPrince<Projection> precise() { return {.relative_tolerance = 1e-11, .absolute_tolerance = 1e-11}; }

Claim ordinary_solver(char const* what, std::string const& formulation) {
  return {"R8", what, By::independent, "ordinary solver of order eight", formulation};
}

/// Angles of both links from the downward vertical at time t.
struct Angles {
  double t, first, second;
};

/// Published angles include full revolutions, measured ones do not.
double wrapped(double angle) { return std::remainder(angle, 2.0 * std::numbers::pi); }

template <class C, class I>
void expect_angles(C const& chain, I const& integrator, double step, std::vector<Angles> const& exact, double tolerance,
                   std::string const& formulation) {
  State x = chain.model.reference_state();
  for (Angles const& e : exact) {
    simulate(chain.model, x, integrator, {.end_time = e.t, .step = step}).run();
    Instance const at{equals("t", e.t), 1.0};
    held_within(ordinary_solver("angles of both links [rad]", formulation),
                std::abs(wrapped(chain.angle(x, 0) - e.first)), tolerance, at);
    held_within(ordinary_solver("angles of both links [rad]", formulation),
                std::abs(wrapped(chain.angle(x, 1) - e.second)), tolerance, at);
  }
}

std::vector<Angles> const point_masses{{1, -0.625087699806, -1.034585085680},
                                       {2, -0.482971534252, -1.324048712302},
                                       {3, 1.785795522077, 1.118107461205},
                                       {5, -0.627186705067, -1.301315550209}};
std::vector<Angles> const bars{{0.5, 0.448142625932, 1.041962887304},
                               {1, -1.207716238191, -0.814391023091},
                               {2, -0.082758306821, 0.407362074912},
                               {3, 1.025086012289, 0.495734647626}};
std::vector<Angles> const chrono{
    {0.5, 0.801614759963, 1.357616418761}, {1, -0.656406513171, 0.081108625687}, {2, -0.308903760931, -3.342138789353}};

Link const chrono_link{.length = 1.0, .mass = 1.0, .inertia = 1.0, .com = 0.5};

TEST(DoublePendulum, OfPointMassesFollowsThePublishedAngles) {
  Plane const chain(2, point_link());
  expect_angles(chain, precise(), 0.01, point_masses, 1e-6, "(a) two point masses, Dormand–Prince");
  State x = chain.model.reference_state();
  simulate(chain.model, x, precise(), {.end_time = 1.0, .step = 0.01}).run();
  held_within(ordinary_solver("place of the second mass at t = 1 s [m]", "(a) two point masses, Dormand–Prince"),
              (chain.tip(x) - Vec3(-1.444818849943, -1.321794461381, 0.0)).norm(), 1e-8, {.scale = 2.0});
}

TEST(DoublePendulum, OfBarsFollowsThePublishedAngles) {
  expect_angles(Plane(2, bar_link()), precise(), 0.01, bars, 1e-7, "(b) two bars in the plane, Dormand–Prince");
  expect_angles(Space(2, bar_link()), precise(), 0.01, bars, 1e-7, "(b) two bars in space, Dormand–Prince");
}

// Implicit steps converge to the same angles with order two.
TEST(DoublePendulum, OfBarsConvergesAtSecondOrderWithGeneralizedAlpha) {
  Plane const chain(2, bar_link());
  std::vector<double> errors;
  for (double const h : {4e-3, 2e-3, 1e-3}) {
    State x = chain.model.reference_state();
    simulate(chain.model, x, GeneralisedAlpha{}, {.end_time = 1.0, .step = h}).run();
    errors.push_back(std::hypot(chain.angle(x, 0) - bars[1].first, chain.angle(x, 1) - bars[1].second));
  }
  EXPECT_LT(errors[2], 1e-4);
  EXPECT_GT(std::log2(errors[1] / errors[2]), 1.9) << testing::PrintToString(errors);
}

// Tolerances of Chrono's double pendulum test: 1e-3 in states, 1e-6 in the constraint equations, at h = 2e-4.
TEST(DoublePendulum, OfThePeerKeepsItsTolerances) {
  Space const chain(2, chrono_link, 10.0);
  expect_angles(chain, precise(), 0.01, chrono, 1e-7, "(c) the peer's two links in space, Dormand–Prince");
  expect_angles(chain, GeneralisedAlpha{}, 2e-4, {chrono[0], chrono[1]}, 1e-5,
                "(c) the peer's two links in space, generalised-α, h = 2e-4 s");

  State x = chain.model.reference_state();
  simulate(chain.model, x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 2e-4}).run();
  System system(chain.model);
  EXPECT_LT(largest_violation(system, x).position, 1e-6);
  char const* const peer = "(c) the peer's two links in space, generalised-α, h = 2e-4 s";
  held(ordinary_solver("rates of both links at t = 1 s [rad/s]", peer), x.v[5], -1.9495974609, 1e-3);
  held(ordinary_solver("rates of both links at t = 1 s [rad/s]", peer), x.v[11], -3.9480427098, 1e-3);
}

struct Tip {
  int links;
  double t, x, y;
};
std::vector<Tip> const tips{{3, 0.25, 0.880767899903, -0.295360886340},   {3, 0.5, -0.243303645300, -0.913193847171},
                            {3, 1.0, -0.908458260529, -0.025617696288},   {4, 0.25, 0.879110128751, -0.304401804992},
                            {4, 0.5, -0.250307803491, -0.901990387817},   {4, 1.0, -0.864582047703, -0.090031032523},
                            {10, 0.25, 0.877462524775, -0.306656671158},  {10, 0.5, -0.264645112002, -0.863546754750},
                            {10, 0.75, -0.908445211876, -0.383978760999}, {10, 1.0, -0.894316852361, -0.146565064747}};

template <class C, class I>
void expect_tips(int links, I const& integrator, double step, double end_time, double tolerance,
                 char const* formulation) {
  C const chain(links, bar_link(1.0 / links, 1.0 / links));
  State x = chain.model.reference_state();
  int compared = 0;
  for (Tip const& e : tips) {
    if (e.links != links || e.t > end_time) continue;
    simulate(chain.model, x, integrator, {.end_time = e.t, .step = step}).run();
    held_within(ordinary_solver("tip of N bars [m]", "(d) N = " + std::to_string(links) + formulation),
                (chain.tip(x) - Vec3(e.x, e.y, 0.0)).norm(), tolerance, {equals("t", e.t), 0.9});
    ++compared;
  }
  EXPECT_GE(compared, 2);
}

TEST(LongPendulum, TipIsWhereThePublishedOneIs) {
  for (int const links : {3, 4, 10})
    expect_tips<Plane>(links, precise(), 1e-3, 1.0, 1e-7, " in the plane, Dormand–Prince");
}

TEST(LongPendulum, TipIsThereInSpaceToo) {
  expect_tips<Space>(3, precise(), 1e-3, 1.0, 1e-7, " in space, Dormand–Prince");
}

TEST(LongPendulum, TipIsThereWithImplicitSteps) {
  for (int const links : {3, 4, 10})
    expect_tips<Plane>(links, GeneralisedAlpha{}, 2e-4, 0.5, 1e-5, " in the plane, generalised-α, h = 2e-4 s");
  expect_tips<Space>(10, GeneralisedAlpha{}, 2e-4, 0.5, 1e-5, " in space, generalised-α, h = 2e-4 s");
}

}  // namespace rigid_chain_test
