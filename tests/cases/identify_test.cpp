// Results of examples/identify. The least-squares method is compared with NIST's certified values, and derivatives
// with finite differences of complete runs. Confidence intervals are compared with the scatter of many records. A
// rigid arm causes a bias of the mount's stiffness.
#include <gtest/gtest.h>

#include "../../examples/identify/arm.hpp"

namespace identify_test {

using namespace identify;

Numbers const truth{2000.0, 12.0, 25.0, 0.25};

// Misra1a of NIST's Statistical Reference Datasets, y = b₁ (1 − exp(−b₂ x)): 14 points, certified to 11 digits.
TEST(IdentifyLeastSquares, FindsNistsCertifiedNumbers) {
  std::array<double, 14> const x{77.6,  114.9, 141.1, 190.8, 239.9, 289.0, 332.8,
                                 378.4, 434.8, 477.3, 536.8, 593.1, 689.1, 760.0},
      y{10.07, 14.73, 17.94, 23.93, 29.61, 35.18, 40.02, 44.82, 50.76, 55.05, 61.01, 66.40, 75.47, 81.78};
  for (Vec2 const& start : {Vec2(500.0, 1e-4), Vec2(250.0, 5e-4)}) {
    LeastSquares const misra{[&](VecX const& u) {
                               Vec2 const b = u.cwiseProduct(start);
                               VecX r(14);
                               for (std::size_t i = 0; i < 14; ++i)
                                 r[Index(i)] = b[0] * (1.0 - std::exp(-b[1] * x[i])) - y[i];
                               return r;
                             },
                             [&](VecX const& u) {
                               Vec2 const b = u.cwiseProduct(start);
                               MatX j(14, 2);
                               for (std::size_t i = 0; i < 14; ++i)
                                 j.row(Index(i)) << 1.0 - std::exp(-b[1] * x[i]), b[0] * x[i] * std::exp(-b[1] * x[i]);
                               return MatX(j * start.asDiagonal());
                             }};
    LeastSquaresFit const fit = least_squares(misra, Vec2(1.0, 1.0), 1e-12, 100);
    EXPECT_TRUE(fit.converged);
    EXPECT_NEAR(fit.at[0] * start[0], 2.3894212918e+02, 1e-7);
    EXPECT_NEAR(fit.at[1] * start[1], 5.5015643181e-04, 1e-13);
    EXPECT_NEAR(2.0 * fit.sums.back(), 1.2455138894e-01, 1e-10);
    EXPECT_NEAR(fit.deviation(), 1.0187876330e-01, 1e-10);
    EXPECT_NEAR(start[0] * std::sqrt(fit.covariance()(0, 0)), 2.7070075241, 1e-6);
    EXPECT_NEAR(start[1] * std::sqrt(fit.covariance()(1, 1)), 7.2668688436e-06, 1e-12);
  }
}

template <class B>
void expect_derivatives_of_runs(Index elements) {
  Candidate const arm = candidate<B>("arm", {.end_time = 0.2}, elements);
  MatX const exact = arm.derivatives(truth);
  double const rounding = 1e-12 * std::sqrt(double(exact.rows()));  // of the runs in the finite differences [m]
  for (std::size_t j = 0; j < truth.size(); ++j) {
    VecX sum = VecX::Zero(exact.rows());
    double const e = 2e-3 * truth[j];
    for (std::size_t k = 0; k < 4; ++k) {
      Numbers p = truth;
      p[j] += FourPoints::places[k] * e;
      sum += FourPoints::weights[k] / e * arm.tip(p);
    }
    EXPECT_LT((exact.col(Index(j)) - sum).norm(), 1e-7 * sum.norm() + rounding / e) << names[j];
  }
}
TEST(Identify, DerivativesAreThoseOfRuns) {
  expect_derivatives_of_runs<planar::Ffr>(2);
  expect_derivatives_of_runs<planar::Lrvf>(4);
}

// A formulation identifies the exact parameters from its own record without noise.
TEST(Identify, FindsTheNumbersOfItsOwnRecord) {
  Candidate const arm = candidate<planar::AncfCable<>>("cable", {.end_time = 0.4, .step = 5e-3}, 2);
  Estimate const found = estimate(arm, arm.tip(truth), {3000.0, 8.0, 37.5, 0.16});
  EXPECT_TRUE(found.converged);
  for (std::size_t j = 0; j < truth.size(); ++j) EXPECT_NEAR(found.value[j], truth[j], 1e-6 * truth[j]) << names[j];
}

// For d = p̂ − p with its covariance C, dᵀC⁻¹d has the mean 4 and the variance 8 if C is correct.
TEST(Identify, IntervalsAreTheScatterOfManyRecords) {
  Candidate const arm = candidate<planar::Rigid>("rigid", {.end_time = 0.8, .step = 5e-3});
  VecX const record = arm.tip(truth);
  int const records = 60;
  double mean = 0.0;
  std::array<int, 4> inside{};
  for (int seed = 0; seed < records; ++seed) {
    Estimate const e = estimate(arm, with_noise(record, 5e-4, std::uint64_t(seed) + 100), truth);
    Vec4 off;
    for (std::size_t j = 0; j < truth.size(); ++j) {
      off[Index(j)] = e.value[j] - truth[j];
      inside[j] += std::abs(off[Index(j)]) < e.interval(j);
    }
    mean += off.dot(e.covariance.ldlt().solve(off)) / records;
  }
  EXPECT_NEAR(mean, 4.0, 3.0 * std::sqrt(8.0 / records));
  for (int const in : inside) EXPECT_GE(in, records - 8);  // 57 are expected, 49 or less have a probability of 2e-4
}

// A rigid arm adds the arm's own compliance to the mount. A flexible arm does not add it.
TEST(Identify, ARigidArmTakesItsOwnComplianceForTheMounts) {
  Experiment const experiment{.end_time = 1.0, .step = 4e-3, .sampling = 2e-2};
  VecX const record = with_noise(exact_record(experiment, truth), 5e-4, 7);
  Estimate const rigid = estimate(candidate<planar::Rigid>("rigid", experiment), record, truth),
                 flexible = estimate(candidate<planar::Lrvf>("Lrvf", experiment, 10), record, truth);
  // at rest the tip of the clamped arm sinks by w l⁴/8EI under its weight w l, and the rotation of the mount adds w
  // l³/2k_t
  double const ei = constants(strip()).EI, own = 1.0 / (8.0 * ei), mounts = 1.0 / (2.0 * truth[2]),
               expected = truth[2] * mounts / (mounts + own);
  EXPECT_NEAR(rigid.value[2], expected, 0.06 * truth[2]);
  EXPECT_GT(truth[2] - rigid.value[2], 5.0 * rigid.interval(2));
  EXPECT_GT(rigid.deviation, 1.3 * flexible.deviation);
  EXPECT_NEAR(flexible.deviation, 5e-4, 1.5e-4);
  for (std::size_t j = 0; j < truth.size(); ++j)
    EXPECT_NEAR(flexible.value[j], truth[j], 2.0 * flexible.interval(j)) << names[j];
}

}  // namespace identify_test
