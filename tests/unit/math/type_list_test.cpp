#include <polybody/math/type_list.hpp>

#include <gtest/gtest.h>

using namespace polybody;

namespace type_list_test {

TEST(TypeList, KnowsItsSize) {
  EXPECT_EQ(TypeList<>::size, 0u);
  EXPECT_EQ((TypeList<int, char, int>::size), 3u);
}

TEST(TypeList, CountsHowOftenATypeStands) {
  EXPECT_EQ((count_of<int>), 0u);
  EXPECT_EQ((count_of<int, char, double>), 0u);
  EXPECT_EQ((count_of<int, char, int, double, int>), 2u);
  EXPECT_EQ((count_of<int, int const, int&>), 0u);  // qualifiers make another type
}

TEST(TypeList, OneOfMeansExactlyOnce) {
  EXPECT_TRUE((OneOf<int, char, int>));
  EXPECT_FALSE((OneOf<int, char, double>));
  EXPECT_FALSE((OneOf<int, int, int>));
  EXPECT_FALSE((OneOf<int>));
}

TEST(TypeList, DistinctRefusesATwin) {
  EXPECT_TRUE((Distinct<>));
  EXPECT_TRUE((Distinct<int, char, double>));
  EXPECT_FALSE((Distinct<int, char, int>));
}

}  // namespace type_list_test
