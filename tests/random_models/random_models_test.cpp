// 200 random models of one wide type: trees in joint coordinates and loops against the same models with Constraint,
// with every kind of force. Other models: POLYBODY_SEED=n. All wide types: tests/random_models/run.
#include <gtest/gtest.h>

#include <cstdlib>

#include "random_models/checks.hpp"
#include "random_models/wide_types.hpp"

using namespace polybody;
using namespace polybody::random_models;

namespace random_models_test {

TEST(RandomModels, BalanceAndAgreeWithTheirTwins) {
  char const* const given = std::getenv("POLYBODY_SEED");
  std::uint64_t const first = given ? std::strtoull(given, nullptr, 10) : 1;
  std::cout << "POLYBODY_SEED=" << first << '\n';
  WideType const type = trees_by_augmented();
  int compared = 0, failures = 0;
  for (std::uint64_t n = 0; n < 200; ++n) {
    std::uint64_t const seed = (first + n) * wide_types + number_of_trees_by_augmented;
    Outcome const o = examine(seed, wide_types, type);
    EXPECT_EQ(o.error, "") << "seed " << seed;
    for (Residual const& r : o.residuals) EXPECT_LE(r.value, r.tolerance) << r.check << ", seed " << seed;
    compared += !o.singular && !o.redundant;
    failures += o.failures;
  }
  EXPECT_GT(compared, 120);
  EXPECT_GT(failures, 300);
}

}  // namespace random_models_test
