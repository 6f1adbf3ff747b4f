// Rod on a bushing instead of a pin: the uniform rod pendulum (J1), and a comparison with the ideal pin over several
// revolutions.
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/policies/bushing.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include <gtest/gtest.h>

#include "support/held.hpp"

using namespace polybody;

namespace bushing_motion_test {

using Ideal = Joint<Revolute, Constraint>;
using Soft = Joint<Revolute, Bushing>;

/// Well damped bushing with one stiffness in every direction that a pin constrains.
Bushing stiff(double k) {
  Bushing::Matrix const one = Bushing::diagonal({1, 1, 1}, {1, 1, 1});
  return {.stiffness = k * one, .damping = 0.7 * std::sqrt(k) * one};
}

/// Rod of 1 kg and 1 m, initially along x. A pin about z is at its end, or at a distance from it along z.
template <class J>
struct Rod {
  Model<Bodies<Rigid<>>, Joints<Ideal, Soft>> model{Gravity{0, -9.81, 0}};
  Mat3 const inertia = Vec3(0.02, 1.0 / 12, 1.0 / 12).asDiagonal();
  BodyHandle<Rigid<>> rod = model.add(Rigid<>(1.0, inertia, Placement::at({0.5, 0, 0})), "rod");
  ElementHandle<J> pin;

  explicit Rod(typename J::PolicyType const& policy, double beside = 0.0) {
    Vec3 const at(0, 0, -beside);
    pin = model.connect(J{{.axis = Vec3::UnitZ()}, policy}, model.ground().at(at), rod.at(Vec3(at - Vec3(0.5, 0, 0))),
                        "pin");
  }
  /// State at the release with an angular velocity about the pin.
  State start(double spin) const {
    State x = model.reference_state();
    model.set_velocity(x, rod, {0, 0, 0}, {0, 0, spin});
    return x;
  }
  /// Angle from the downward vertical, in (−π, π].
  double angle(State const& x) const {
    Vec3 const along = frame(model, x, rod.at(Vec3(0, 0, 0))).A.col(0);
    return std::atan2(along[0], -along[1]);
  }
};

/// Uniform rod pendulum (J1): R acts on the rod at the pivot.
struct Swing {
  double t, angle, rx, ry;
};
constexpr Swing swings[] = {{0.25, 1.114159968059, -8.7352815388, 6.7438504085},
                            {0.5, -0.090352089956, 1.9834605859, 24.3453009333}};

TEST(RodOnABushing, HasThePublishedMotionAndReactions) {
  double const k = 1e7;
  Rod<Soft> const rod(stiff(k));
  State x = rod.start(0.0);
  for (Swing const& s : swings) {
    simulate(rod.model, x, GeneralisedAlpha{}, {.end_time = s.t, .step = 5e-4}).run();
    Vec3 const force(s.rx, s.ry, 0.0);
    auto const claim = [](char const* what, By by, char const* source) {
      return Claim{"J1", what, by, source, "Rigid on a bushing of 1e7 N/m, generalised-α, h = 5e-4 s"};
    };
    std::string const at = equals("t", s.t);
    held(claim("angle of the rod [rad]", By::closed_form, "elliptic functions"), rod.angle(x), s.angle, 2e-5,
         {at, 1.0});  // error of the step, and R/k
    held_within(claim("reaction at the pin [N]", By::closed_form, "elliptic functions, ideal joint"),
                (reaction(rod.model, x, rod.pin).f - force).norm(), 2e-3 * force.norm(), {at, force.norm()});
    held(claim("gap of the pin [m]", By::closed_form, "reaction of the ideal pin over k"),
         constraint_violation(rod.model, x, rod.pin).norm(), force.norm() / k, 2e-3 * force.norm() / k, {at});
  }
}

// The compliant pin moves the middle of the rod outward by about R/k. The motion differs from the ideal one by a term
// in 1/k.
TEST(RodOnABushing, ComesNearToTheIdealPinAsItsStiffnessGrows) {
  auto const off = [](double k) {
    Rod<Soft> const rod(stiff(k));
    State x = rod.start(0.0);
    simulate(rod.model, x, GeneralisedAlpha{}, {.end_time = 0.5, .step = 2.5e-4}).run();
    return rod.angle(x) - swings[1].angle;
  };
  double const soft = off(1e4), firm = off(1e5);
  EXPECT_LT(std::abs(soft), 1e-2);
  EXPECT_NEAR(soft / firm, 10.0, 1.0);
}

// Several revolutions about the free axis, with a moment on the pin, which is at a distance from the rod. The motion
// agrees with the ideal one up to 1/k.
TEST(RodOnABushing, TurnsAsOftenAsItLikes) {
  double const spin = 25.0, end_time = 1.0, beside = 0.3;  // kinetic energy 104 J: four full revolutions
  auto const run = [&](auto const& rod) {
    State x = rod.start(spin);
    simulate(rod.model, x, GeneralisedAlpha{}, {.end_time = end_time, .step = 2.5e-4}).run();
    Wrench<> const w = reaction(rod.model, x, rod.pin);
    Vec6 out;
    out << w.f, w.m;
    return std::tuple(rod.angle(x), out, energy(rod.model, x).total());
  };
  auto const [angle, wrench, total] = run(Rod<Ideal>({}, beside));
  EXPECT_GT(wrench.tail<3>().norm(), 50.0);
  auto const difference = [&, angle = angle, wrench = wrench, total = total](double k) {
    auto const [a, w, e] = run(Rod<Soft>(stiff(k), beside));
    return Vec3(std::remainder(a - angle, 2.0 * std::numbers::pi), (w - wrench).norm() / wrench.norm(), e - total);
  };
  Vec3 const soft = difference(1e6), firm = difference(1e7);
  auto const apart = [](char const* what, double error, double scale) {
    held_within({"J1", what, By::itself, "Constraint", "Rigid on a bushing of 1e7 N/m, four turns"}, error, 1e-2,
                {.scale = scale});
  };
  apart("angle of the rod [rad]", std::abs(firm[0]), 1.0);
  apart("wrench of the pin, of its size", std::abs(firm[1]), 1.0);
  apart("energy of the rod [J]", std::abs(firm[2]), 104.0);
  for (int i = 0; i < 2; ++i) EXPECT_NEAR(soft[i] / firm[i], 10.0, 1.5) << i;
  EXPECT_GT(soft[2] / firm[2], 9.0);  // first oscillations: energy falls with 1/k; rotation: with k^(−3/2)
}

// An undamped bushing that couples translations and rotations conserves energy. The energy error of the trapezoidal
// rule is of order h².
TEST(RodOnABushing, KeepsTheEnergyWithoutDamping) {
  Bushing::Matrix k = Bushing::diagonal({900, 700, 800}, {60, 50, 0});
  k(0, 3) = k(3, 0) = 120.0;
  k(1, 4) = k(4, 1) = -90.0;
  k(1, 2) = k(2, 1) = 200.0;
  Rod<Soft> const rod({.stiffness = k, .damping = Bushing::Matrix::Zero()}, 0.2);
  double stored = 0.0;
  auto const drift = [&](double h) {
    State x = rod.start(9.0);
    double const before = energy(rod.model, x).total();
    double worst = 0.0;
    for (State const& now : simulate(rod.model, x, GeneralisedAlpha{.rho_inf = 1.0}, {.end_time = 1.5, .step = h})) {
      Energy const e = energy(rod.model, now);
      worst = std::max(worst, std::abs(e.total() - before));
      stored = std::max(stored, e.joints);
    }
    return worst;
  };
  double const coarse = drift(2e-3), fine = drift(1e-3);
  EXPECT_GT(stored, 1.0);
  EXPECT_LT(fine, 2e-3 * stored);
  EXPECT_NEAR(coarse / fine, 4.0, 0.5);
}

}  // namespace bushing_motion_test
