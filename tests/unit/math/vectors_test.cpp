#include <gtest/gtest.h>

#include <limits>
#include <polybody/math/vectors.hpp>

namespace vectors_test {

using namespace polybody;

constexpr Index beyond_packs = 3 * simd_size + 2;

TEST(ForPacks, VisitsEachEntryOnce) {
  for (Index n = 0; n < beyond_packs; ++n) {
    VecX x = VecX::LinSpaced(n, 1.0, double(n)), y = VecX::Zero(n);
    for_each_simd_block(n, [&](auto at) { at.set(y, at(y) + 2.0 * at(x)); });
    for (Index i = 0; i < n; ++i) EXPECT_EQ(y[i], 2.0 * double(i + 1)) << n << ", " << i;
  }
}

TEST(Squares, AreThoseOfEveryEntry) {
  for (Index n = 0; n < beyond_packs; ++n)
    EXPECT_EQ(squares(VecX::LinSpaced(n, 1.0, double(n))), double(n * (n + 1) * (2 * n + 1)) / 6.0) << n;
}

TEST(AllFinite, SeesOneEntryWhereverItStands) {
  double const nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (Index i = 0; i < beyond_packs; ++i) {
    VecX x = VecX::Constant(beyond_packs, 1e150);
    EXPECT_TRUE(all_finite(x));  // the sum of squares exceeds the largest number
    for (double const bad : {nan, infinity, -infinity, 1.1e150, -1.1e150}) {
      x[i] = bad;
      EXPECT_FALSE(all_finite(x)) << i << ", " << bad;
    }
  }
  EXPECT_TRUE(all_finite(VecX()));
}

}  // namespace vectors_test
