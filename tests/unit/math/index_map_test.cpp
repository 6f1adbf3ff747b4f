// Values by an index: sorted by index, one value per index, for any order of insertion.
#include <gtest/gtest.h>

#include <map>
#include <random>

#include <polybody/math/index_map.hpp>

using namespace polybody;

namespace {

TEST(IndexMap, DoesWhatStdMapDoes) {
  std::mt19937 draw(3);
  IndexMap<double> ours;
  std::map<Index, double> theirs;
  for (int i = 0; i < 2000; ++i) {
    Index const at = Index(draw() % 50);
    if (draw() % 3 == 0) {
      ours.erase(at);
      theirs.erase(at);
    } else {
      ours[at] += i;
      theirs[at] += i;
    }
    auto expected = theirs.begin();
    for (auto const& [index, value] : ours) {
      ASSERT_NE(expected, theirs.end());
      EXPECT_EQ(index, expected->first);
      EXPECT_EQ(value, expected->second);
      ++expected;
    }
    EXPECT_EQ(expected, theirs.end());
    Index const asked = Index(draw() % 50);
    EXPECT_EQ(ours.find(asked) != nullptr, theirs.contains(asked));
    if (double const* const found = ours.find(asked)) {
      EXPECT_EQ(*found, theirs.at(asked));
    }
  }
}

}  // namespace
