// The comparison helper of the cases: it fails like EXPECT_NEAR, and records the comparison.

#include "support/held.hpp"

#include <gtest/gtest-spi.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>

namespace polybody {
namespace held_test {

/// Sets POLYBODY_CLAIMS during a test, so that nothing is added to the records of the run.
class ClaimsIn {
 public:
  explicit ClaimsIn(std::string const& file) {
    if (char const* const was = std::getenv("POLYBODY_CLAIMS")) before_ = was;
    ::setenv("POLYBODY_CLAIMS", file.c_str(), 1);
  }
  ClaimsIn(ClaimsIn const&) = delete;
  ~ClaimsIn() {
    if (before_)
      ::setenv("POLYBODY_CLAIMS", before_->c_str(), 1);
    else
      ::unsetenv("POLYBODY_CLAIMS");
  }

 private:
  std::optional<std::string> before_;
};

struct Held : testing::Test {
  std::string const file = testing::TempDir() + "polybody claims " + std::to_string(::getpid());
  ClaimsIn const claims{file};
  ~Held() override { std::filesystem::remove(file); }
};
Claim claim() { return {"X1", "length [m]", By::closed_form, "a formula", "a body"}; }

TEST_F(Held, PassesWithinTheToleranceAndFailsBeyond) {
  held(claim(), 1.5, 1.0, 0.5);
  EXPECT_NONFATAL_FAILURE(held(claim(), 1.5, 1.0, 0.4999), "X1, length [m], a body : 1.5 is 0.5 off 1");
  EXPECT_NONFATAL_FAILURE(held(claim(), std::numeric_limits<double>::quiet_NaN(), 1.0, 0.5), "off 1");
  held_within(claim(), 0.5, 0.5, {.scale = 10.0});
  EXPECT_NONFATAL_FAILURE(held_within(claim(), 0.75, 0.5, {equals("t", 2.5)}), "t = 2.5: an error of 0.75");
}

TEST_F(Held, WritesOneLineForEachComparison) {
  held(claim(), 1.25, 1.0, 0.5, {.at = "here", .scale = 2.0});
  held_within(claim(), 0.125, 0.5, {.scale = 10.0});
  std::ifstream in(file);
  std::string first, second, third;
  std::getline(in, first);
  std::getline(in, second);
  EXPECT_FALSE(std::getline(in, third));
  std::string const text = "\tX1\tlength [m]\t1\ta formula\ta body\t";
  EXPECT_NE(first.find("Held.WritesOneLineForEachComparison\t"), std::string::npos);
  EXPECT_NE(first.find(text + "here\tvalue\t1\t1.25\t0.5\t2"), std::string::npos) << first;
  EXPECT_NE(second.find(text + "\tdistance\t0\t0.125\t0.5\t10"), std::string::npos) << second;
}

}  // namespace held_test
}  // namespace polybody
