// Convergence of the multipliers of generalised-α in index-3 form (I2) [Arnold & Brüls 2007].

#include <gtest/gtest.h>

#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/testing/integrator_laws.hpp>

#include "support/integrator_cases.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace multipliers_test {

/// Runs a model with steps of h for 1 s, then with another step for 0.2 s.
template <class M, class I>
struct Stepper {
  System system;
  MethodOf<I> method;
  decltype(method.template workspace<DenseLu>(system)) workspace;
  State x;

  Stepper(M const& model, State const& start, I const& i, double h)
      : system(model), method(method_of(i)), workspace(method.template workspace<DenseLu>(system)), x(start) {
    method.start(system, x, h, workspace);
  }
  void step(double h) { method.step(system, x, h, workspace); }
};

/// Largest errors of λ: in the first step, over all steps of h, and after the change to `then`. Also the largest |λ|
/// and the angular velocity.
struct Errors {
  double first = 0.0, before = 0.0, after = 0.0, largest = 0.0, rate = 0.0;
};

GeneralisedAlpha method(double rho, bool correction) {
  return {.rho_inf = rho, .tolerance = 1e-12, .start_correction = correction};
}

Errors in_the_plane(GeneralisedAlpha const& integrator, double h, double then) {
  SwingingBar bar;
  Stepper run(bar.model, bar.start, integrator, h);
  Errors e;
  auto const error = [&] { return (run.x.lambda + bar.reaction(run.x.t)).norm(); };
  for (int i = 0; i < std::lround(1.0 / h); ++i) {
    run.step(h);
    e.largest = std::max(e.largest, run.x.lambda.norm());
    e.rate = std::max(e.rate, std::abs(run.x.v[2]));
    e.before = std::max(e.before, error());
    if (i == 0) e.first = e.before;
  }
  for (int i = 0; i < std::lround(0.2 / then); ++i) {
    run.step(then);
    e.after = std::max(e.after, error());
  }
  return e;
}

/// The reference is Runge–Kutta of order four with the same steps.
Errors on_se3(GeneralisedAlpha const& integrator, double h, double then) {
  SlowTop top;
  Stepper run(top.model, top.start, integrator, h);
  Stepper exact(top.model, top.start, RungeKutta4<Projection>{}, h);
  Errors e;
  auto const advance = [&](double step) {
    run.step(step);
    exact.step(step);
    e.largest = std::max(e.largest, exact.x.lambda.norm());
    e.rate = std::max(e.rate, exact.x.v.tail<3>().norm());
    return (run.x.lambda - exact.x.lambda).norm();
  };
  for (int i = 0; i < std::lround(1.0 / h); ++i) {
    e.before = std::max(e.before, advance(h));
    if (i == 0) e.first = e.before;
  }
  for (int i = 0; i < std::lround(0.2 / then); ++i) e.after = std::max(e.after, advance(then));
  return e;
}

constexpr std::array steps{0.02, 0.01, 0.005, 0.0025};

template <class F>
void expect_second_order(F const& errors_of, double rho) {
  std::vector<double> before, after, back;
  for (double const h : steps) {
    Errors const e = errors_of(method(rho, true), h, 0.25 * h);
    before.push_back(e.before);
    after.push_back(e.after);
    back.push_back(errors_of(method(rho, true), h, 2.0 * h).after);
    double const natural = std::pow(e.rate * h, 2) * e.largest;  // expected error of a method of order two
    EXPECT_LT(e.before, natural) << h;
    EXPECT_LT(e.after, 2.0 * natural) << h;
  }
  EXPECT_GT(slopes(before).back(), 1.9) << rho << ' ' << testing::PrintToString(before);
  EXPECT_GT(slopes(after).back(), 1.9) << rho << ' ' << testing::PrintToString(after);
  EXPECT_GT(slopes(back).back(), 1.9) << rho << ' ' << testing::PrintToString(back);
}

template <class F>
void expect_first_order_without(F const& errors_of, double rho) {
  std::vector<double> first, before, after;
  for (double const h : steps) {
    Errors const e = errors_of(method(rho, false), h, 0.25 * h);
    first.push_back(e.first);
    before.push_back(e.before);
    after.push_back(e.after);
  }
  for (auto const* errors : {&first, &before, &after}) {
    EXPECT_GT(slopes(*errors).back(), 0.8) << testing::PrintToString(*errors);
    EXPECT_LT(slopes(*errors).back(), 1.2) << testing::PrintToString(*errors);
  }
  // the start correction has a large effect: the first step of 0.01 is five times as accurate with it
  EXPECT_GT(first[1], 5.0 * errors_of(method(rho, true), steps[1], steps[1]).first);
}

TEST(Multipliers, ConvergeAtSecondOrderFromTheFirstStepAndAcrossAChangeOfStep) {
  for (double const rho : {0.8, 0.5}) expect_second_order(in_the_plane, rho);
}

TEST(Multipliers, ConvergeAtSecondOrderOnSe3) {
  for (double const rho : {0.8, 0.5}) expect_second_order(on_se3, rho);
}

TEST(Multipliers, WithoutTheCorrectionAreOfFirstOrder) {
  expect_first_order_without(in_the_plane, 0.8);
  expect_first_order_without(on_se3, 0.8);
}

// Without algorithmic damping a disturbance does not decay, but the start still has second order.
TEST(Multipliers, WithoutDampingConvergeAtSecondOrderFromTheStart) {
  std::vector<double> before;
  for (double const h : steps) before.push_back(in_the_plane(method(1.0, true), h, h).before);
  EXPECT_GT(slopes(before)[1], 1.9) << testing::PrintToString(before);
}

}  // namespace multipliers_test
