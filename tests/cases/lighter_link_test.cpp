// Results of examples/lighter_link. The optimisation method is compared with a published design, stresses with a
// formula, and derivatives with finite differences of complete runs. The design of a rigid link is compared with the
// rule of equal stress.
#include <gtest/gtest.h>

#include "../../examples/lighter_link/search.hpp"

namespace lighter_link_test {

using namespace lighter_link;

// Five square tubes in a row, loaded at the tip. The least weight for a bounded deflection is 1.340 at 6.016, 5.309,
// 4.494, 3.502, 2.153 [Svanberg 1987, §6].
TEST(LighterLinkMethod, FindsSvanbergsCantilever) {
  std::array<double, 5> const share{61.0, 37.0, 19.0, 7.0, 1.0}, published{6.016, 5.309, 4.494, 3.502, 2.153};
  Design cantilever{.start = std::vector<double>(5, 5.0),
                    .least = std::vector<double>(5, 1.0),
                    .most = std::vector<double>(5, 10.0),
                    .tolerance = 1e-7};
  cantilever.objective = [](std::span<double const> x) {
    ValueAndSlopes f{0.0, std::vector<double>(5, 0.0624)};
    for (double const one : x) f.value += 0.0624 * one;
    return f;
  };
  cantilever.constraint = [&](std::span<double const> x) {
    ValueAndSlopes f{-1.0, {}};
    for (std::size_t i = 0; i < 5; ++i) {
      f.value += share[i] / std::pow(x[i], 3);
      f.derivatives.push_back(-3.0 * share[i] / std::pow(x[i], 4));
    }
    return f;
  };
  BestDesign const best = best_design(cantilever);
  EXPECT_TRUE(best.converged) << best.why;
  EXPECT_NEAR(best.objective, 1.340, 5e-4);
  EXPECT_NEAR(best.constraint, 0.0, 2e-6);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(best.x[i], published[i], 2e-3);
}

// An exception of the user's function passes through the optimiser, which is written in C.
TEST(LighterLinkMethod, LetsErrorsThrough) {
  Design broken{.start = {1.0}, .least = {0.0}, .most = {2.0}};
  broken.objective = [](std::span<double const> x) { return ValueAndSlopes{x[0], {1.0}}; };
  broken.constraint = [](std::span<double const>) -> ValueAndSlopes { throw InvalidInput("no such design"); };
  EXPECT_THROW(best_design(broken), InvalidInput);
}

// Section forces of a rigid link: M(s) = −θ̈ ∫_s (x − s) x dm, including the rotary inertia of each section and of
// the mass, and N(s) = θ̇² ∫_s x dm.
double formula(Task const& task, std::span<double const> heights, std::size_t i, double side, double t) {
  Motion const turn = task.turn(t);
  double const l = task.section_length(), s = l * double(i);
  double moment = task.payload * task.length * (task.length - s) + task.payload_inertia,
         pull = task.payload * task.length;
  for (std::size_t k = i; k < task.sections; ++k) {
    double const m = task.material.density * task.width * heights[k] * l, x = l * (double(k) + 0.5);
    moment += m * (x * (x - s) + (l * l + heights[k] * heights[k]) / 12.0);
    pull += m * x;
  }
  double const n = turn.rate * turn.rate * pull, mz = -turn.acceleration * moment, h = heights[i], w = task.width;
  return (n / (w * h) + side * mz * 6.0 / (w * h * h)) / task.allowed;
}

TEST(LighterLink, StressOfARigidLinkIsThatOfItsInertia) {
  Task const task{.step = 2e-3};
  std::vector<double> const heights{0.03, 0.022, 0.018, 0.012};
  MatX const s = stresses_of(lighter_link::Link<planar::Rigid>{task}, heights);
  double const most = s.cwiseAbs().maxCoeff();
  for (std::size_t i = 0; i < task.sections; ++i)
    for (Index k = 50; k < s.rows(); k += 50) {
      double const upper = s(k, Index(2 * i)), lower = s(k, Index(2 * i + 1)), t = task.step * double(k);
      double const one = formula(task, heights, i, 1.0, t), other = formula(task, heights, i, -1.0, t);
      // the compressive side of the bend can be either side
      EXPECT_NEAR(std::max(upper, lower), std::max(one, other), 1e-3 * most) << i << ' ' << t;
      EXPECT_NEAR(std::min(upper, lower), std::min(one, other), 1e-3 * most) << i << ' ' << t;
    }
}

// In slow motion the stresses of a flexible link are those of a rigid one.
template <class B>
void expect_stress_of_inertia(Index elements) {
  Task const task{.turn = {1.5, 0.5, 2.0}, .end_time = 4.5, .step = 1e-2};
  std::vector<double> const heights{0.03, 0.022, 0.018, 0.012};
  MatX const rigid = stresses_of(lighter_link::Link<planar::Rigid>{task}, heights),
             s = stresses_of(lighter_link::Link<B>{task, elements}, heights);
  EXPECT_LT((s - rigid).cwiseAbs().maxCoeff(), 0.02 * rigid.cwiseAbs().maxCoeff());
}
TEST(LighterLink, TurnedSlowlyAllBearTheSame) {
  expect_stress_of_inertia<planar::Ffr>(1);
  expect_stress_of_inertia<planar::AncfCable<>>(1);
  expect_stress_of_inertia<planar::Lrvf>(3);
}

template <class B>
void expect_derivatives_of_runs(Index elements) {
  Task const task{.turn = {0.5 * std::numbers::pi, 0.1, 0.2}, .end_time = 0.35, .step = 5e-3, .sections = 2};
  Aggregate const aggregate{50.0};
  Candidate const link = candidate<B>("link", task, aggregate, elements);
  std::vector<double> const heights{0.024, 0.016};
  Loaded const loaded = link.loaded(heights);
  EXPECT_NEAR(loaded.aggregate, aggregate(link.stresses(heights)), 1e-9);
  for (std::size_t j = 0; j < heights.size(); ++j) {
    double sum = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
      std::vector<double> h = heights;
      double const e = 5e-4 * heights[j];
      h[j] += FourPoints::places[k] * e;
      sum += FourPoints::weights[k] / e * aggregate(link.stresses(h));
    }
    EXPECT_NEAR(loaded.derivatives[Index(j)], sum, 1e-6 * std::abs(sum));
  }
}
TEST(LighterLink, SlopesOfTheAggregateAreThoseOfRuns) {
  expect_derivatives_of_runs<planar::Rigid>(1);
  expect_derivatives_of_runs<planar::Ffr>(1);
  expect_derivatives_of_runs<planar::Lrvf>(2);
}

TEST(LighterLink, TheAggregateIsALittleAboveTheLargest) {
  MatX s(2, 3);
  s << 0.2, 0.9, 1.0, -1.0, 0.5, 1.0;
  EXPECT_NEAR(Aggregate{200.0}(s), 1.0 + std::log(2.0) / 200.0, 1e-9);  // two equal largest values
  EXPECT_GT(Aggregate{20.0}(s), Aggregate{200.0}(s));
  EXPECT_LT(Aggregate{20.0}(s), 1.0 + std::log(6.0) / 20.0);
}

// With a flexible formulation the search also leaves its start and ends at the bound.
TEST(LighterLink, TheLightestFlexibleLinkIsAtTheBound) {
  Task const task{.step = 9e-3, .sections = 2};
  Lightest const found = lightest(candidate<planar::Lrvf>("Lrvf", task, {200.0}, 3), task, {});
  EXPECT_TRUE(found.converged) << found.why;
  EXPECT_NEAR(found.aggregate, 1.0, 2e-4);
  EXPECT_LT(found.mass, 0.8 * found.masses.front());
}

// Without vibration all sections of the lightest link have the allowed stress. They are computed from the tip to the
// root: 6 θ̈ moment(h)/(w h²) = allowed. (At the largest θ̈ the tension due to θ̇² is a tenth of a percent.)
TEST(LighterLink, TheLightestRigidLinkIsStressedEvenly) {
  Task const task{.step = 4e-3, .sections = 3};
  Lightest const found = lightest(candidate<planar::Rigid>("rigid", task, {400.0}), task, {});
  EXPECT_TRUE(found.converged) << found.why;
  EXPECT_NEAR(found.aggregate, 1.0, 2e-4);
  double const most = task.turn.middle - task.turn.time * std::atanh(1.0 / std::sqrt(3.0));
  std::vector<double> even(3, 0.02);
  for (std::size_t i = 3; i-- > 0;)
    for (int again = 0; again < 60; ++again)
      even[i] *= std::sqrt(std::max(formula(task, even, i, 1.0, most), formula(task, even, i, -1.0, most)));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found.heights[i], even[i], 0.015 * even[i]) << i;
  EXPECT_NEAR(found.mass, task.mass(even), 0.012 * task.mass(even));
  EXPECT_GT(found.mass, task.mass(even));  // the aggregate is above the maximum
}

}  // namespace lighter_link_test
