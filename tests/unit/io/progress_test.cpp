#include <polybody/io/progress.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

using namespace polybody;

namespace progress_test {

static_assert(!std::is_copy_constructible_v<Progress> && !std::is_copy_assignable_v<Progress>);

/// A terminal in memory and a clock with a prescribed time [s].
struct ProgressBar : testing::Test {
  std::ostringstream out;
  double time = 1000.0;
  int asked = 0;

  Progress::Clock clock() {
    return [this] { return ++asked, time; };
  }

  /// The drawn lines, in the order in which a terminal would show them.
  std::vector<std::string> lines() const {
    std::vector<std::string> drawn;
    std::string const text = out.str();
    for (std::size_t at = text.find('\r'); at != text.npos;) {
      std::size_t const next = text.find('\r', at + 1);
      drawn.push_back(text.substr(at + 1, next == text.npos ? next : next - at - 1));
      at = next;
    }
    return drawn;
  }
};

TEST_F(ProgressBar, ShowsShareElapsedAndTimeLeft) {
  Progress bar(2.0, 6.0, "pendulum", out, true, clock());
  EXPECT_TRUE(out.str().empty());
  time += 20.4;
  bar.update(3.0);  // a quarter in 20.4 s: 61.2 s remain
  EXPECT_EQ(lines().back(), "pendulum  25% [==========>" + std::string(30, ' ') + "]  0:00:20  ETA 0:01:01");
  time = 1000.0 + 5400.0;
  bar.update(5.0);
  auto const last = lines().back();
  EXPECT_NE(last.find(" 75% ["), last.npos) << last;
  EXPECT_TRUE(last.ends_with("1:30:00  ETA 0:30:00")) << last;
}

TEST_F(ProgressBar, NoTimeLeftIsGuessedBeforeTheFirstProgress) {
  Progress bar(0.0, 1.0, "", out, true, clock());
  time += 7;
  bar.update(0.0);
  EXPECT_TRUE(lines().back().starts_with("  0% [>"));
  EXPECT_TRUE(lines().back().ends_with("0:00:07  ETA -:--:--"));
  time += 1;
  bar.update(1e-300);
  EXPECT_TRUE(lines().back().ends_with("ETA >999:59:59"));
}

TEST_F(ProgressBar, RedrawsAtMostTenTimesASecond) {
  Progress bar(0.0, 1.0, "", out, true, clock());
  for (int i = 0; i <= 10000; ++i) {
    time = 1000.0 + 1e-4 * i;
    bar.update(1e-4 * i);
  }
  EXPECT_GE(lines().size(), 9u);
  EXPECT_LE(lines().size(), 11u);
}

TEST_F(ProgressBar, EveryLineFillsSeventyNineSigns) {
  for (std::string const label :
       {"", "short", "a label that is much too long for one line of a terminal", "a\nb\r\tc"}) {
    Progress bar(0.0, 1.0, label, out, true, clock());
    for (double const share : {0.0, 1e-300, 1e-9, 0.1, 0.5, 0.999, 1.0}) {
      time += 3e5;
      bar.update(share);
    }
  }
  ASSERT_EQ(lines().size(), 4u * 8u);
  for (auto line : lines()) {
    if (line.ends_with('\n')) line.pop_back();
    EXPECT_EQ(line.size(), 79u) << line;
    EXPECT_EQ(line.find_first_of("\n\t"), line.npos) << line;
  }
}

TEST_F(ProgressBar, LongLabelsAreCutBetweenSigns) {
  std::string label;
  for (int i = 0; i < 40; ++i) label += "θ";
  Progress bar(0.0, 1.0, label, out, true, clock());
  bar.update(0.5);
  EXPECT_TRUE(lines().back().starts_with(label.substr(0, 48) + "  50% ["));
  EXPECT_EQ(lines().back().size(), 79u + 24u);
}

TEST_F(ProgressBar, FinishDrawsTheFullBarOnceAndEndsTheLine) {
  {
    Progress bar(0.0, 1.0, "run", out, true, clock());
    time += 60;
    bar.update(0.5);
    time += 0.01;
    bar.finish();
    bar.finish();
    bar.update(0.2);
  }
  ASSERT_EQ(lines().size(), 2u);
  EXPECT_NE(lines().back().find("100% [="), std::string::npos);
  EXPECT_EQ(lines().back().find('>'), std::string::npos);
  EXPECT_TRUE(lines().back().ends_with("0:01:00  ETA 0:00:00\n"));
}

TEST_F(ProgressBar, DestructorLeavesTheShareThatWasReached) {
  try {
    Progress bar(0.0, 1.0, "", out, true, clock());
    bar.update(0.1);
    time += 0.05;
    bar.update(0.42);  // too early for the next drawing
    throw std::runtime_error("stop");
  } catch (std::runtime_error const&) {
  }
  ASSERT_EQ(lines().size(), 2u);
  EXPECT_TRUE(lines().back().starts_with(" 42% ["));
  EXPECT_TRUE(out.str().ends_with('\n'));
}

TEST_F(ProgressBar, UnusedDrawsNothing) {
  {
    Progress bar(0.0, 1.0, "", out, true, clock());
  }
  EXPECT_TRUE(out.str().empty());
}

TEST_F(ProgressBar, FinishWithoutUpdateStillSaysSo) {
  {
    Progress(0.0, 1.0, "", out, true, clock()).finish();
  }
  ASSERT_EQ(lines().size(), 1u);
  EXPECT_TRUE(lines()[0].starts_with("100% ["));
}

TEST_F(ProgressBar, SilentAndWithoutClockWhereThereIsNoTerminal) {
  {
    Progress bar(0.0, 1.0, "run", out, false, clock());
    for (int i = 0; i <= 100; ++i, time += 1) bar.update(0.01 * i);
    bar.finish();
  }
  EXPECT_TRUE(out.str().empty());
  EXPECT_EQ(asked, 0);
}

TEST_F(ProgressBar, StandardErrorIsSilentUnderATest) {
  testing::internal::CaptureStderr();  // a file, not a terminal
  EXPECT_FALSE(stderr_is_terminal());
  {
    Progress bar(0.0, 1.0, "run");
    bar.update(0.5);
    bar.finish();
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(ProgressBar, OddRangesAreBounded) {
  std::optional<Progress> bar;
  auto const shown = [&](double start, double end, double now) {
    bar.emplace(start, end, "", out, true, clock());
    bar->update(now);
    auto const text = lines().back().substr(0, 4);
    bar.reset();
    return text;
  };
  EXPECT_EQ(shown(0, 1, 7), "100%");
  EXPECT_EQ(shown(0, 1, -7), "  0%");
  EXPECT_EQ(shown(1, 0, 0.75), " 25%");  // backwards
  EXPECT_EQ(shown(3, 3, 3), "100%");     // empty range
  EXPECT_EQ(shown(0, 1, 0.29), " 29%");
  EXPECT_EQ(shown(0, 1, 0.9999), " 99%");
  auto const before = lines().size();
  bar.emplace(0, 1, "", out, true, clock());
  bar->update(std::nan(""));
  EXPECT_EQ(lines().size(), before);
  double const infinity = std::numeric_limits<double>::infinity();
  EXPECT_THROW(Progress(0, infinity), InvalidInput);
  EXPECT_THROW(Progress(std::nan(""), 1), InvalidInput);
}

TEST_F(ProgressBar, AThrowingStreamDoesNotEndTheProgram) {
  std::ostringstream broken;
  {
    Progress bar(0.0, 1.0, "", broken, true, clock());
    bar.update(0.5);
    broken.exceptions(std::ios::badbit);
    EXPECT_THROW(broken.setstate(std::ios::badbit), std::ios::failure);
  }
  SUCCEED();
}

}  // namespace progress_test
