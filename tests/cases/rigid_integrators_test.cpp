// Benchmarks R1, R2, R4, R6, R7 and R8 under HHT-α, Radau IIA and Adams methods. Generalised-α and the Runge–Kutta
// methods are in rigid_pendulum_test.cpp, rigid_chain_test.cpp, rigid_top_test.cpp and redundant_joints_test.cpp.

#include <gtest/gtest.h>

#include <polybody/integrators/adams_bashforth_moulton.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/held.hpp"
#include "support/linkages.hpp"
#include "support/refusal.hpp"
#include "support/resumed_run.hpp"

namespace polybody {
namespace rigid_integrators_test {

constexpr double g = 9.81, half_pi = 0.5 * std::numbers::pi;
using Plane = Chain<InPlane<Constraint>>;
using Windows = FourBars<InPlane<Constraint>>;

/// Integrator with its step and its tolerance for each case.
template <class I>
struct Way {
  I integrator = {};
  char const* name = "";
  double step = 0.0;      ///< [s]
  double pendulum = 0.0;  ///< R1 over 10 s [m]
  double links = 0.0;     ///< R8 over 2 s [rad]
  double top = 0.0;       ///< R6 over 0.2 s [m], with a fifth of the step
  double spin = 0.0;      ///< R7 over 2 s [rad/s]
  double bricard = 0.0;   ///< R4 over 2 s [m]
  double energy = 0.0;    ///< of R4 [J]
};

Way<HhtAlpha> hht() { return {{}, "HHT-α", 2.5e-4, 2e-5, 2e-5, 1e-5, 1e-6, 1e-6, 1e-5}; }
Way<Radau> radau() { return {{}, "Radau IIA", 5e-3, 1e-8, 1e-8, 1e-8, 1e-8, 1e-8, 1e-8}; }
Way<AdamsBashforthMoulton<Projection>> adams() {
  return {{.relative_tolerance = 1e-11, .absolute_tolerance = 1e-12},
          "Adams–Bashforth–Moulton",
          1e-3,
          1e-8,
          1e-8,
          1e-8,
          1e-8,
          1e-8,
          1e-8};
}

/// Label such as "HHT-α, h = 0.00025 s". The Adams method chooses its own step.
template <class W>
std::string described(W const& way, double part = 1.0) {
  std::string const name = way.name;
  return name[0] == 'A' ? name : name + ", " + equals("h", part * way.step) + " s";
}
Claim solver(char const* case_id, char const* what, std::string const& formulation) {
  return {case_id, what, By::independent, "ordinary solver of order eight", formulation};
}

struct Place {
  double t, x, y;
};

template <class W>
void expect_pendulum(W const& way) {  // R1
  Plane const chain(1, point_link(), g, -half_pi);
  State x = chain.model.reference_state();
  for (Place const& p :
       {Place{0.5, -0.3910487915505464, -0.9203699487851922}, Place{2, -0.7935661953433217, -0.6084839304437915},
        Place{10, -0.2750874625761169, -0.9614192050991251}}) {
    simulate(chain.model, x, way.integrator, {.end_time = p.t, .step = way.step}).run();
    held_within({"R1", "point mass [m]", By::closed_form, "elliptic functions", "in the plane, " + described(way)},
                (chain.tip(x) - Vec3(p.x, p.y, 0)).norm(), way.pendulum, {equals("t", p.t), 1.0});
  }
}

template <class W>
void expect_links(W const& way) {  // R8a, R8b
  Plane const points(2, point_link()), bars(2, bar_link());
  auto const expect = [&](char const* which, Plane const& chain, double t, double first, double second) {
    State x = chain.model.reference_state();
    simulate(chain.model, x, way.integrator, {.end_time = t, .step = way.step}).run();
    double const off = std::max(std::abs(chain.angle(x, 0) - first), std::abs(chain.angle(x, 1) - second));
    held_within(solver("R8", "angles of both links [rad]", std::string(which) + described(way)), off, way.links,
                {equals("t", t), 1.0});
  };
  char const *const a = "(a) two point masses, ", *const b = "(b) two bars in the plane, ";
  expect(a, points, 1, -0.625087699806, -1.034585085680);
  expect(a, points, 2, -0.482971534252, -1.324048712302);
  expect(b, bars, 1, -1.207716238191, -0.814391023091);
  expect(b, bars, 2, -0.082758306821, 0.407362074912);
}

template <class W>
void expect_windows(W const& way, int n, double end_time,
                    double tolerance) {  // R2, the corner [m]; not under Radau IIA
  Windows bars(n);
  for (Corner const& c : breakpoints) {
    if (c.n != n || c.t > end_time) continue;
    simulate(bars.model, bars.x, way.integrator, {.end_time = c.t, .step = way.step}).run();
    held_within({"R2", "corner [m]", By::closed_form, "θ¨ = A sin θ of the parallelogram, elliptic integrals",
                 "N = " + std::to_string(n) + ", " + described(way)},
                (bars.corner() - Vec3(c.x, c.y, 0)).norm(), tolerance, {equals("t", c.t), 1.0});
  }
}

template <class W>
void expect_bricard(W const& way) {  // R4
  Bricard<> b(0.1);
  double const before = energy(b.model, b.x).total();
  for (auto const& [t, p3] : {std::pair{0.5, Vec3(0.968283679, -1.224625159, 0.750146609)},
                              std::pair{1.0, Vec3(0.510501461, -1.649167599, 0.140123115)},
                              std::pair{2.0, Vec3(-0.969340345, -1.221246895, 0.754278011)}}) {
    auto run = simulate(b.model, b.x, way.integrator, {.end_time = t, .step = way.step});
    run.run();
    EXPECT_EQ(run.report().redundant.size(), 1u) << t;
    std::string const formulation = "rods 0.1 m square, " + described(way);
    Instance const at{equals("t", t), 1.8};
    held_within(
        {"R4", "P₃ of the Bricard mechanism [m]", By::independent, "ordinary solver in the one freedom", formulation},
        (b.p3() - p3).norm(), way.bricard, at);
    held({"R4", "energy [J]", By::closed_form, "invariant", formulation}, energy(b.model, b.x).total(), before,
         way.energy, at);
  }
}

template <class W>
void expect_tops(W const& way) {  // R6, R7
  using Ball = Joint<Spherical, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Ball>> heavy{Gravity{0, 0, -9.81}}, free;
  Mat3 const inertia = Vec3(0.234375, 0.46875, 0.234375).asDiagonal();
  auto const top = heavy.add(Rigid<>(15.0, inertia, Placement::at({0, 1, 0})), "top");
  heavy.connect(Ball{}, heavy.ground().at({0, 0, 0}), top.at(Vec3(0, -1, 0)), "tip");
  State x = heavy.reference_state();
  heavy.set_velocity(x, top, Vec3::Zero(), Vec3(0, 150, -4.61538));
  simulate(heavy, x, way.integrator, {.end_time = 0.2, .step = 0.2 * way.step}).run();
  held_within(solver("R6", "heavy top: centre of mass at 0.2 s [m]", "Rigid, " + described(way, 0.2)),
              (x.q.head<3>() - Vec3(0.6055505614, 0.5989576818, -0.5239830274)).norm(), way.top, {.scale = 1.0});

  auto const body = free.add(Rigid<>(1.0, Vec3(1, 2, 3).asDiagonal().toDenseMatrix()), "body");
  State y = free.reference_state();
  free.set_velocity(y, body, Vec3::Zero(), Vec3(0.01, 5, 0.01));
  simulate(free, y, way.integrator, {.end_time = 2.0, .step = way.step}).run();
  held_within(solver("R7", "torque-free body: angular velocity at 2 s [rad/s]", "Rigid, " + described(way)),
              (y.v.tail<3>() - Vec3(-1.1612500596, 4.8632908919, 0.6704977507)).norm(), way.spin, {.scale = 5.0});
}

TEST(EveryIntegrator, HhtSwingsThePendulum) { expect_pendulum(hht()); }
TEST(EveryIntegrator, RadauSwingsThePendulum) { expect_pendulum(radau()); }
TEST(EveryIntegrator, AdamsSwingsThePendulum) { expect_pendulum(adams()); }
TEST(EveryIntegrator, HhtSwingsTwoLinks) { expect_links(hht()); }
TEST(EveryIntegrator, RadauSwingsTwoLinks) { expect_links(radau()); }
TEST(EveryIntegrator, AdamsSwingsTwoLinks) { expect_links(adams()); }
TEST(EveryIntegrator, HhtTurnsTheFourBars) {
  Way<HhtAlpha> way = hht();
  way.step = 1e-3;
  for (int const n : {1, 2, 40}) expect_windows(way, n, 4, 1e-4);
}
// At the flat positions round-off of the accelerations exceeds the tolerances of the other cases.
TEST(EveryIntegrator, AdamsTurnsTheFourBars) {
  auto way = adams();
  way.integrator.relative_tolerance = 1e-9;
  way.integrator.absolute_tolerance = 1e-10;
  expect_windows(way, 2, 10, 1e-6);
  expect_windows(way, 40, 4, 1e-6);
}

TEST(EveryIntegrator, HhtFoldsBricard) { expect_bricard(hht()); }
TEST(EveryIntegrator, RadauFoldsBricard) { expect_bricard(radau()); }
TEST(EveryIntegrator, AdamsFoldsBricard) { expect_bricard(adams()); }
TEST(EveryIntegrator, HhtSpinsTops) { expect_tops(hht()); }
TEST(EveryIntegrator, RadauSpinsTops) { expect_tops(radau()); }
TEST(EveryIntegrator, AdamsSpinsTops) { expect_tops(adams()); }

TEST(AResumedRun, GoesOnWithTheSameBits) { expect_resumes<InPlane<Constraint>>(GeneralisedAlpha{}); }
TEST(AResumedRun, GoesOnWithTheSameBitsInJointCoordinates) {
  expect_resumes<InPlane<JointCoordinates>>(GeneralisedAlpha{});
}
TEST(AResumedRun, GoesOnWithTheSameBitsByHht) { expect_resumes<InPlane<Constraint>>(HhtAlpha{}); }
TEST(AResumedRun, GoesOnWithTheSameBitsByRadau) { expect_resumes<InPlane<Constraint>>(Radau{}); }
TEST(AResumedRun, GoesOnWithTheSameBitsByAMultistepMethod) {
  expect_resumes<InPlane<Constraint>>(AdamsBashforthMoulton<Projection>{});
}

// The difference between a resumed run and a run without snapshots is due to the tolerance of Newton's method. An
// error of 1e-8 of accelerations of some 30 m/s² (rad/s²) over 0.5 s gives ½ · 3e-7 · 0.5² = 4e-8.
TEST(AResumedRun, DiffersFromOneWithoutSnapshotsWithinNewtonsTolerance) {
  Plane const chain(4, bar_link());
  State with = chain.model.reference_state(), without = with;
  auto run = simulate(chain.model, with, GeneralisedAlpha{}, {.end_time = 0.5, .step = 0.004});
  for (State const& now : run)
    if (now.t > 0.0) run.snapshot();
  simulate(chain.model, without, GeneralisedAlpha{}, {.end_time = 0.5, .step = 0.004}).run();
  EXPECT_LT((with.q - without.q).cwiseAbs().maxCoeff(), 4e-8);
}

TEST(AResumedRun, MayEndLater) {
  Plane const chain(4, bar_link());
  State x = chain.model.reference_state(), y;
  auto run = simulate(chain.model, x, GeneralisedAlpha{}, {.end_time = 0.1, .step = 0.004});
  run.run();
  auto longer = resume(chain.model, y, GeneralisedAlpha{}, {.end_time = 0.2, .step = 0.004}, run.snapshot());
  EXPECT_EQ(bits(y), bits(x));
  EXPECT_EQ(longer.run().steps, 50);
  EXPECT_EQ(y.t, 0.2);
}

TEST(AResumedRun, IsRefusedToAnother) {
  Plane const chain(4, bar_link()), shorter(3, bar_link());
  State x = chain.model.reference_state(), y;
  RunOptions const options{.end_time = 0.1, .step = 0.004}, over{.end_time = -1.0, .step = 0.004};
  auto run = simulate(chain.model, x, GeneralisedAlpha{}, options);
  RunSnapshot const s = run.snapshot();
  EXPECT_TRUE(
      has(refusal([&] { resume(shorter.model, y, GeneralisedAlpha{}, options, s); }), "belongs to another model"));
  EXPECT_TRUE(
      has(refusal([&] { resume(chain.model, y, HhtAlpha{}, options, s); }), "by GeneralisedAlpha, not by HhtAlpha"));
  EXPECT_TRUE(has(refusal([&] { resume(chain.model, y, GeneralisedAlpha{}, over, s); }), "before the start"));
  EXPECT_EQ(y.q.size(), 0);
}

}  // namespace rigid_integrators_test
}  // namespace polybody
