#include <polybody/io/text_files.hpp>

#include <gtest/gtest.h>

#include <limits>

namespace polybody {
namespace digits_test {

TEST(Digits, AreTheFewestThatReadBackToTheSameNumber) {
  EXPECT_EQ(detail::all_digits(0.1), "0.1");
  EXPECT_EQ(detail::all_digits(-2.0), "-2");
  for (double const x : {1.0 / 3.0, 0.1 + 0.2, std::numeric_limits<double>::min(), -std::numeric_limits<double>::max()})
    EXPECT_EQ(std::stod(detail::all_digits(x)), x);
}

TEST(Digits, GoToTheEndOfAText) {
  std::string text = "t = ";
  detail::append_digits(text, 0.25);
  EXPECT_EQ(text, "t = 0.25");
}

}  // namespace digits_test
}  // namespace polybody
