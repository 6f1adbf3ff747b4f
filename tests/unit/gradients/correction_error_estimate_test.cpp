// Estimates of the remaining error of a correction by a random probe, against the exact error.
#include <polybody/gradients/alpha_linearised_step.hpp>

#include <gtest/gtest.h>

#include <Eigen/Dense>

using namespace polybody;

namespace correction_probe_test {

VecX numbers(Index n, double seed) {
  VecX x(n);
  for (Index i = 0; i < n; ++i) x[i] = std::sin(seed * double(i + 1) * double(i + 2));
  return x;
}
double relative(CorrectionErrorEstimate::Parts const& bound, VecX const& left, Index nv) {
  return std::max(left.head(nv).norm() / bound.a, left.tail(left.size() - nv).norm() / bound.lambda);
}

// E of rank two, as if a contact's blocks were missing; E small and of full rank, like round-off.
std::vector<MatX> errors(Index n) {
  std::vector<MatX> all;
  all.push_back(0.3 * numbers(n, 0.7) * numbers(n, 0.2).transpose() +
                0.1 * numbers(n, 1.3) * numbers(n, 0.9).transpose());
  MatX full(n, n);
  for (Index j = 0; j < n; ++j) full.col(j) = 1e-13 * numbers(n, 0.1 + 0.013 * double(j));
  all.push_back(full);
  return all;
}

TEST(CorrectionErrorEstimate, EstimatesWhatCorrectionsLeave) {
  Index const nv = 40, rows = 20, n = nv + rows;
  for (MatX const& e : errors(n)) {
    CorrectionErrorEstimate probe(nv, rows);
    VecX z(n);
    EXPECT_FALSE(probe.draw(z));
    probe.add(numbers(n, 0.4), 2.0);
    probe.add(numbers(n, 0.6), 1.0);
    double most = 0.0;
    int above = 0;
    for (int step = 0; step < 50; ++step) {
      probe.fade();
      EXPECT_FALSE(probe.known());
      ASSERT_TRUE(probe.draw(z));
      probe.measure(e * z);
      ASSERT_TRUE(probe.known());
      VecX const correction = 0.01 * numbers(n, 0.5 + 0.01 * step), left = e * correction;
      double const part = relative(probe.bound(correction), left, nv);
      most = std::max(most, part);
      above += part > 1.0;
      probe.add(numbers(n, 0.4 + 0.02 * step), 1.0);
    }
    // two exceptions in 50 draws are permitted: one probe may be nearly orthogonal to the missing blocks
    EXPECT_LE(above, 2);
    EXPECT_LT(most, 2.0);
    EXPECT_GT(most, 1e-4);  // the bound is not far above the error
  }
}

// Unknowns that neither a direction nor a correction moves are left out of the estimate, even if the factors give
// them large errors.
TEST(CorrectionErrorEstimate, LeavesAloneWhatDirectionsLeaveAlone) {
  Index const n = 30;
  VecX weights = numbers(n, 0.4), correction = 0.1 * weights, z(n);
  weights.tail(10).setZero();
  correction.tail(10).setZero();
  MatX e = MatX::Zero(n, n);
  e.rightCols(10).setOnes();
  CorrectionErrorEstimate probe(n, 0);
  probe.add(weights, 1.0);
  ASSERT_TRUE(probe.draw(z));
  probe.measure(e * z);
  EXPECT_LT(probe.bound(correction).a, 1e-11);
  correction[n - 1] = 0.01;  // first movement of an ignored unknown
  EXPECT_GT(probe.bound(correction).a, (e * correction).norm());
}

// Weights that a step adds after a probe do not change the estimate by this probe.
TEST(CorrectionErrorEstimate, MeasuresByTheWeightsOfItsProbe) {
  CorrectionErrorEstimate probe(2, 0);
  VecX z(2);
  probe.add(VecX::Unit(2, 0), 1.0);
  ASSERT_TRUE(probe.draw(z));
  MatX const e{{0.0, 1.0}, {0.0, 0.0}};
  probe.measure(e * z);
  probe.add(VecX::Unit(2, 1), 1.0);
  EXPECT_GT(probe.bound(VecX::Unit(2, 1)).a, 0.1);
}

TEST(CorrectionErrorEstimate, KnowsNothingOfProbesThatAreNoNumbers) {
  CorrectionErrorEstimate probe(2, 1);
  probe.add(VecX::Ones(3), 1.0);
  probe.measure(VecX::Constant(3, std::numeric_limits<double>::quiet_NaN()));
  EXPECT_FALSE(probe.known());
}

}  // namespace correction_probe_test
