#include <polybody/gradients/gradient_result.hpp>

#include <gtest/gtest.h>

#include <map>

using namespace polybody;

namespace reversal_test {

/// Smallest number of steps of a backward sweep with s snapshots, found by trial of every position of the next
/// snapshot.
std::size_t fewest(std::size_t steps, std::size_t snapshots) {
  static std::map<std::pair<std::size_t, std::size_t>, std::size_t> known;
  if (steps <= 1) return 0;
  if (snapshots == 1) return steps * (steps - 1) / 2;
  auto const [at, is_new] = known.try_emplace({steps, snapshots}, 0);
  if (!is_new) return at->second;
  std::size_t best = steps * (steps - 1) / 2;
  for (std::size_t m = 1; m < steps; ++m)
    best = std::min(best, m + fewest(steps - m, snapshots - 1) + fewest(m, snapshots));
  return known[{steps, snapshots}] = best;
}

/// Runs a backward sweep over the steps x → 3x + 1 modulo a prime; checks each step.
CheckpointingReport go_back(std::size_t steps, std::size_t snapshots) {
  auto const next = [](unsigned x) { return (3u * x + 1u) % 65521u; };
  std::vector<unsigned> x{7};
  for (std::size_t k = 0; k < steps; ++k) x.push_back(next(x.back()));
  std::size_t left = steps;
  CheckpointingReport const report = reverse_steps(
      7u, steps, snapshots,
      [&](std::size_t k, unsigned& y) {
        EXPECT_EQ(y, x[k]);
        y = next(y);
      },
      [&](std::size_t k, unsigned before, unsigned after) {
        EXPECT_EQ(k, --left);
        EXPECT_EQ(before, x[k]);
        EXPECT_EQ(after, x[k + 1]);
      });
  EXPECT_EQ(left, 0u);
  EXPECT_EQ(report.steps, steps);
  EXPECT_LE(report.snapshots, std::max<std::size_t>(1, snapshots));
  return report;
}

TEST(Reversal, TakesTheFewestStepsForEveryCountOfSnapshots) {
  for (std::size_t steps = 1; steps <= 60; ++steps)
    for (std::size_t snapshots = 1; snapshots <= 8; ++snapshots)
      EXPECT_EQ(go_back(steps, snapshots).taken, fewest(steps, snapshots) + 1) << steps << ' ' << snapshots;
}

TEST(Reversal, WithASnapshotOfEachStepTakesNoneAgain) { EXPECT_EQ(go_back(100, 100).taken, 100u); }

TEST(Reversal, OfTenThousandStepsWithFiftySnapshotsFollowsTheBinomialSchedule) {
  // r n − C(s + r, r − 1) for r = 3 repetitions: C(52, 50) < 10⁴ ≤ C(53, 50) [Griewank & Walther 2000, Eq. 2.2]
  EXPECT_EQ(binomial_steps(50, 2), 1326u);
  EXPECT_EQ(binomial_steps(50, 3), 23426u);
  CheckpointingReport const report = go_back(10000, 50);
  EXPECT_EQ(report.taken, 3u * 10000u - 1378u + 1u);
  EXPECT_EQ(report.snapshots, 50u);
}

TEST(Reversal, OfNoStepsDoesNothing) { EXPECT_EQ(go_back(0, 3).taken, 0u); }

}  // namespace reversal_test
