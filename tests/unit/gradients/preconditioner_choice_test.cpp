// Choice between kinds of approximate factors, for given numbers of refinement passes.
#include <polybody/gradients/step_factorisations.hpp>

#include <gtest/gtest.h>

using namespace polybody;

namespace near_factors_test {

// Number of uses of each kind in `steps` steps if a direction needs passes[kind] passes.
std::vector<int> taken(std::vector<int> const& passes, int steps) {
  PreconditionerChoice choice(
      {{ApproximateFactors::of_step, 0.0}, {ApproximateFactors::of_end, 0.7}, {ApproximateFactors::exact, 2.0}});
  std::vector<int> count(passes.size(), 0);
  for (int i = 0; i < steps; ++i) {
    ApproximateFactors const kind = choice.next();
    EXPECT_EQ(kind, choice.now());
    ++count[std::size_t(kind)];
    choice.add(passes[std::size_t(kind)]);
  }
  return count;
}

TEST(ApproximateFactors, KeepsThoseThatCostLeast) {
  EXPECT_EQ(taken({6, 4, 1}, 100), (std::vector<int>{1, 1, 98}));
  EXPECT_EQ(taken({6, 2, 1}, 100), (std::vector<int>{1, 98, 1}));
  EXPECT_EQ(taken({2, 2, 1}, 100), (std::vector<int>{98, 1, 1}));
}
// A kind that needs one pass cannot be improved: no other kind is tried.
TEST(ApproximateFactors, TriesNoOthersWhereOnePassIsEnough) {
  EXPECT_EQ(taken({1, 1, 1}, 100), (std::vector<int>{100, 0, 0}));
  EXPECT_EQ(taken({4, 1, 1}, 100), (std::vector<int>{1, 99, 0}));
}
// The cost of cheap factors includes the expensive factors that had to follow within the same step.
TEST(ApproximateFactors, CountsWhatOthersCostThatFollowed) {
  PreconditionerChoice choice({{ApproximateFactors::of_step, 0.0}, {ApproximateFactors::exact, 2.0}});
  int cheap = 0;
  for (int i = 0; i < 100; ++i) {
    bool const of_step = choice.next() == ApproximateFactors::of_step;
    cheap += of_step;
    if (of_step) choice.make(ApproximateFactors::exact);
    choice.add(of_step ? 3 : 2);  // 5 and 4 with the cost of the factors
  }
  EXPECT_EQ(cheap, 1);
}
TEST(ApproximateFactors, TriesAgainAfterAHundredSteps) {
  EXPECT_EQ(taken({6, 4, 1}, 400), (std::vector<int>{4, 4, 392}));
}

}  // namespace near_factors_test
