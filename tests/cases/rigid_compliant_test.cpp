// Benchmarks R1, R2, R4, R6 and R8 with compliant joints. Stiff penalties and bushings reproduce the motion of ideal
// joints with an error of about 1/k.

#include <gtest/gtest.h>

#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/policies/bushing.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/held.hpp"
#include "support/linkages.hpp"

namespace polybody {
namespace rigid_compliant_test {

constexpr double g = 9.81;

/// Stiffness k in every constraint equation, well damped.
template <class Policy>
Policy stiff(double k) {
  double const c = 0.7 * std::sqrt(k);
  if constexpr (std::is_same_v<Policy, Penalty>) {
    return {.stiffness = k, .damping = c};
  } else {
    Bushing::Matrix const one = Bushing::Matrix::Identity();
    return {.stiffness = Bushing::Matrix(k * one), .damping = Bushing::Matrix(c * one)};
  }
}

template <class Policy>
std::string on(double k, char const* step) {
  return (std::is_same_v<Policy, Penalty> ? "penalties" : "bushings") + equals(" of k", k) +
         ", generalised-α, h = " + step + " s";
}
Claim solver(char const* case_id, char const* what, std::string const& formulation) {
  return {case_id, what, By::independent, "ordinary solver of order eight, ideal joints", formulation};
}

/// R1: a ball with the radius of gyration 0.4 m hangs 0.8 m from the pivot and swings as a point at 1 m. R8b: two
/// bars.
template <class Policy>
void expect_swings(double tolerance) {
  Link const heavy{.length = 1.0, .mass = 2.0, .inertia = 2.0 * 0.16, .com = 0.8};
  Chain<InPlane<Policy>> const ball(1, heavy, g, -0.5 * std::numbers::pi, stiff<Policy>(1e9));
  State x = ball.model.reference_state();
  simulate(ball.model, x, GeneralisedAlpha{}, {.end_time = 2.0, .step = 2.5e-4}).run();
  std::string const formulation = on<Policy>(1e9, "2.5e-4");
  held_within(
      {"R1", "point at 1 m of a ball at 2 s [m]", By::closed_form, "elliptic functions, ideal joint", formulation},
      (ball.tip(x) - Vec3(-0.7935661953433217, -0.6084839304437915, 0)).norm(), tolerance, {.scale = 1.0});

  Chain<InPlane<Policy>> const bars(2, bar_link(), g, 0.5 * std::numbers::pi, stiff<Policy>(1e9));
  State y = bars.model.reference_state();
  for (auto const& [t, first, second] :
       {std::array{0.5, 0.448142625932, 1.041962887304}, std::array{1.0, -1.207716238191, -0.814391023091},
        std::array{2.0, -0.082758306821, 0.407362074912}}) {
    simulate(bars.model, y, GeneralisedAlpha{}, {.end_time = t, .step = 2.5e-4}).run();
    held(solver("R8", "angle of the first bar [rad]", formulation), bars.angle(y, 0), first, tolerance,
         {equals("t", t)});
    held(solver("R8", "angle of the second bar [rad]", formulation), bars.angle(y, 1), second, tolerance,
         {equals("t", t)});
  }
}
TEST(CompliantJoints, PenaltiesSwingAsPublished) { expect_swings<Penalty>(2e-5); }
TEST(CompliantJoints, BushingsSwingAsPublished) { expect_swings<Bushing>(2e-5); }

// R2: in the flat configuration the constraint Jacobian would lose rank. Springs have no effect there. The vibrations
// after each passage fall only as 1/√k. The benchmark allows 0.1 J.
template <class Policy>
void expect_windows(double k, double tolerance) {
  FourBars<InPlane<Policy>> bars(2, stiff<Policy>(k));
  double const before = energy(bars.model, bars.x).total();
  for (Corner const& c : breakpoints) {
    if (c.n != 2 || c.t > 4.0) continue;
    simulate(bars.model, bars.x, GeneralisedAlpha{}, {.end_time = c.t, .step = 5e-4}).run();
    Instance const at{equals("t", c.t), 1.0};
    held_within({"R2", "corner of 2 four-bars [m]", By::closed_form,
                 "θ¨ = A sin θ of the parallelogram, elliptic integrals", on<Policy>(k, "5e-4")},
                (bars.corner() - Vec3(c.x, c.y, 0)).norm(), tolerance, at);
    held({"R2", "energy [J]", By::closed_form, "invariant, less what the joints damp", on<Policy>(k, "5e-4")},
         energy(bars.model, bars.x).total(), before, 0.1, at);
  }
}
TEST(CompliantJoints, PenaltiesTurnFourBarsAsPublished) {
  expect_windows<Penalty>(1e8, 1e-3);
  expect_windows<Penalty>(1e10, 1e-4);
}
TEST(CompliantJoints, BushingsTurnFourBarsAsPublished) {
  expect_windows<Bushing>(1e8, 1e-3);
  expect_windows<Bushing>(1e10, 1e-4);
}

// R4: compliant pins have no constraint equations, so none are redundant.
template <class Policy>
void expect_bricard(double tolerance) {
  Bricard<Policy> b(0.1, stiff<Policy>(1e8));
  for (auto const& [t, p3] : {std::pair{0.5, Vec3(0.968283679, -1.224625159, 0.750146609)},
                              std::pair{1.0, Vec3(0.510501461, -1.649167599, 0.140123115)},
                              std::pair{2.0, Vec3(-0.969340345, -1.221246895, 0.754278011)}}) {
    auto run = simulate(b.model, b.x, GeneralisedAlpha{}, {.end_time = t, .step = 5e-4});
    run.run();
    EXPECT_TRUE(run.report().redundant.empty());
    held_within({"R4", "P₃ of the Bricard mechanism [m]", By::independent, "ordinary solver in the one freedom",
                 on<Policy>(1e8, "5e-4")},
                (b.p3() - p3).norm(), tolerance, {equals("t", t), 1.8});
  }
}
TEST(CompliantJoints, PenaltiesFoldBricardAsPublished) { expect_bricard<Penalty>(1e-5); }
TEST(CompliantJoints, BushingsFoldBricardAsPublished) { expect_bricard<Bushing>(1e-5); }

// R6: the heavy top on a ball joint.
template <class Policy>
void expect_top(double tolerance) {
  using Ball = Joint<Spherical, Policy>;
  Model<Bodies<Rigid<>>, Joints<Ball>> model{Gravity{0, 0, -9.81}};
  Mat3 const inertia = Vec3(0.234375, 0.46875, 0.234375).asDiagonal();
  auto const top = model.add(Rigid<>(15.0, inertia, Placement::at({0, 1, 0})), "top");
  model.connect(Ball{{}, stiff<Policy>(1e9)}, model.ground().at({0, 0, 0}), top.at(Vec3(0, -1, 0)), "tip");
  State x = model.reference_state();
  model.set_velocity(x, top, Vec3::Zero(), Vec3(0, 150, -4.61538));
  simulate(model, x, GeneralisedAlpha{}, {.end_time = 0.2, .step = 1e-4}).run();
  held_within(solver("R6", "heavy top: centre of mass at 0.2 s [m]", on<Policy>(1e9, "1e-4")),
              (x.q.head<3>() - Vec3(0.6055505614, 0.5989576818, -0.5239830274)).norm(), tolerance, {.scale = 1.0});
}
TEST(CompliantJoints, PenaltyBearsTheHeavyTop) { expect_top<Penalty>(5e-5); }
TEST(CompliantJoints, BushingBearsTheHeavyTop) { expect_top<Bushing>(5e-5); }

}  // namespace rigid_compliant_test
}  // namespace polybody
