// Question 15 of docs/twenty_questions.md: a fast top whose rotation is stable keeps its energy under every method of
// fixed step.

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/integrators/symplectic.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/marker_frames.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/refusal.hpp"

namespace polybody {
namespace free_spin_test {

/// Moments of inertia 0.1, 0.2 and 0.3 kg m², rotation about the axis of the largest one.
struct FreeTop {
  Model<Bodies<Rigid<>>, Joints<>> model;
  BodyHandle<Rigid<>> top = model.add(Rigid<>(1.0, Vec3(0.1, 0.2, 0.3).asDiagonal().toDenseMatrix()), "top");
  State x = model.reference_state();

  FreeTop() { model.set_velocity(x, top, Vec3::Zero(), Vec3(0.2, 0.1, 10)); }
  Vec3 spin() const { return x.v.tail<3>(); }
  /// Angular momentum, world axes [N m s].
  Vec3 momentum() const { return frame(model, x, top.at(Vec3(0, 0, 0))).A * Vec3(0.1, 0.2, 0.3).cwiseProduct(spin()); }
};

/// Largest deviations over a run.
struct Drift {
  double energy = 0.0;       ///< relative
  double across = 0.0;       ///< largest |Ω₁|, |Ω₂| [rad/s]
  double in_momentum = 0.0;  ///< of the angular momentum [N m s]
};
template <class I>
Drift drift(I const& integrator) {
  FreeTop free;
  Vec3 const momentum = free.momentum();
  Drift out;
  for (State const& now : simulate(free.model, free.x, integrator, {.end_time = 100.0, .step = 0.01})) {
    Vec3 const spin = now.v.tail<3>();
    out.across = std::max({out.across, std::abs(spin[0]), std::abs(spin[1])});
    double const e = 0.5 * spin.dot(Vec3(0.1, 0.2, 0.3).cwiseProduct(spin));
    out.energy = std::max(out.energy, std::abs(e / 15.003 - 1.0));
  }
  out.in_momentum = (free.momentum() - momentum).norm();
  return out;
}

// 1e4 steps. Half steps of Ω by v̇ end 29 % above the bound of |Ω₁|, √(Σ …) = 0.2236068 rad/s, or gain 1.4e4 J.
TEST(FreeSpin, KeepsItsEnergyUnderEveryMethodOfFixedStep) {
  auto const expect = [](char const* name, Drift const& d) {
    EXPECT_LT(d.energy, 1e-3) << name;
    EXPECT_LT(d.across, 1.01 * 0.2236068) << name;
  };
  expect("RungeKutta4", drift(RungeKutta4<>{}));
  expect("GeneralisedAlpha", drift(GeneralisedAlpha{}));
  expect("HhtAlpha", drift(HhtAlpha{}));
  expect("Newmark", drift(Newmark{}));
}
TEST(FreeSpin, IsConservedByFreeRotationsOfExplicitSteps) {
  auto const expect = [](char const* name, Drift const& d) {
    EXPECT_LT(d.energy, 1e-10) << name;
    EXPECT_LT(d.across, (1.0 + 1e-6) * 0.2236068) << name;
    EXPECT_LT(d.in_momentum, 1e-10) << name;
  };
  expect("SymplecticEuler", drift(SymplecticEuler{}));
  expect("CentralDifference", drift(CentralDifference<>{}));
  expect("Rattle", drift(Rattle{}));
}

// Ω(1 s) from DOP853 at 1e-13 (question 15).
template <class I>
double error_of(I const& integrator, double step) {
  FreeTop free;
  simulate(free.model, free.x, integrator, {.end_time = 1.0, .step = step}).run();
  return (free.spin() - Vec3(-0.11346007, -0.19268319, 9.99954788)).norm();
}
TEST(FreeSpin, ConvergesWithOrderTwo) {
  auto const expect = [](char const* name, double coarse, double fine) {
    EXPECT_NEAR(coarse / fine, 4.0, 0.4) << name;
    EXPECT_LT(fine, 2e-4) << name;
  };
  expect("Rattle", error_of(Rattle{}, 0.01), error_of(Rattle{}, 0.005));
  expect("CentralDifference", error_of(CentralDifference<>{}, 0.01), error_of(CentralDifference<>{}, 0.005));
  // no force acts, so SymplecticEuler has the free rotation alone
  expect("SymplecticEuler", error_of(SymplecticEuler{}, 0.01), error_of(SymplecticEuler{}, 0.005));
}
// A rotation about a principal axis: the angle of 1 rad per step is exact.
TEST(FreeSpin, AboutAPrincipalAxisIsExact) {
  FreeTop free;
  free.x.v.tail<3>() = Vec3(0, 0, 100);
  simulate(free.model, free.x, Rattle{}, {.end_time = 0.1, .step = 0.01}).run();
  Vec3 const axis = frame(free.model, free.x, free.top.at(Vec3(0, 0, 0))).A.col(0);
  EXPECT_NEAR(axis[0], std::cos(10.0), 1e-12);
  EXPECT_NEAR(axis[1], std::sin(10.0), 1e-12);
}

/// Top on a ball joint at its tip, 0.5 m below its centre of mass, inclined by 45°.
struct HeavyTop {
  using Ball = Joint<Spherical, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Ball>> model{Gravity{0, 0, -9.81}};
  State x;
  explicit HeavyTop(double spin) {
    Mat3 axes = Mat3::Identity();
    double const c = std::sqrt(0.5);
    axes << 1, 0, 0, 0, c, c, 0, -c, c;
    auto const top = model.add(Rigid<>(1.0, Vec3(0.02, 0.02, 0.04).asDiagonal().toDenseMatrix(),
                                       Placement{.origin = Vec3(0, 0.5 * c, 0.5 * c), .axes = axes}),
                               "top");
    model.connect(Ball{}, model.ground().at({0, 0, 0}), top.at(Vec3(0, 0, -0.5)), "tip");
    x = model.reference_state();
    model.set_velocity(x, top, Vec3::Zero(), axes * Vec3(0, 0, spin));
  }
};
template <class I>
double energy_drift(I const& integrator, double step) {
  HeavyTop top(100.0);
  double const start = energy(top.model, top.x).total();
  double worst = 0.0;
  for (State const& now : simulate(top.model, top.x, integrator, {.end_time = 20.0, .step = step}))
    worst = std::max(worst, std::abs(energy(top.model, now).total() - start));
  return worst / start;
}
// ½ J Ω² of the spin is 200 J.
TEST(FreeSpin, OfAHeavyTopKeepsItsEnergyUnderRattle) { EXPECT_LT(energy_drift(Rattle{}, 2e-3), 1e-3); }

TEST(FreeSpin, WithAStepThatDoesNotResolveItIsRefused) {
  FreeTop free;
  free.x.v.tail<3>() = Vec3(20, 100, 300);
  State const before = free.x;
  RunOptions const long_steps{.end_time = 1.0, .step = 0.1, .max_step_halvings = 0};
  auto const start = [&] { simulate(free.model, free.x, CentralDifference<>{}, long_steps).run(); };
  std::string const said = message_of<NewtonConvergenceFailure>(start);
  EXPECT_TRUE(has(said, "The rotation of body \"top\" in the step to t = 0.1 s does not converge")) << said;
  EXPECT_TRUE(has(said, "the angular velocity times the step is 31.68")) << said;
  EXPECT_TRUE(has(said, "Take a smaller step")) << said;
  EXPECT_EQ(free.x.q, before.q);
  EXPECT_EQ(free.x.v, before.v);
}

}  // namespace free_spin_test
}  // namespace polybody
