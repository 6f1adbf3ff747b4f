#include <polybody/math/workers.hpp>

#include <gtest/gtest.h>

#include <numeric>

#include "support/refusal.hpp"

using namespace polybody;

namespace workers_test {

TEST(Workers, EveryEntryIsVisitedOnceWhateverTheNumber) {
  for (int const threads : {1, 2, 3, 5})
    for (Index const n : {0, 1, 7, 64, 1000}) {
      Workers workers(threads);
      EXPECT_EQ(workers.size(), threads);
      std::vector<int> visits(std::size_t(n), 0);
      for (int round = 0; round < 50; ++round)
        workers.over(n, 8, [&](Index begin, Index end) {
          for (Index i = begin; i < end; ++i) ++visits[std::size_t(i)];
        });
      for (int const v : visits) EXPECT_EQ(v, 50) << threads << ' ' << n;
    }
}

TEST(Workers, PartsBeginAtMultiplesOfFourAndOtherThreadsTakeThem) {
  Workers workers(3);
  std::vector<std::pair<Index, std::thread::id>> parts(3);
  std::atomic<int> count{0};
  workers.over(101, 10, [&](Index begin, Index) { parts[std::size_t(count++)] = {begin, std::this_thread::get_id()}; });
  ASSERT_EQ(count, 3);
  std::vector<std::thread::id> ids;
  for (auto const& [begin, id] : parts) {
    EXPECT_EQ(begin % 4, 0);
    ids.push_back(id);
  }
  std::sort(ids.begin(), ids.end());
  EXPECT_EQ(std::unique(ids.begin(), ids.end()), ids.end());
}

TEST(Workers, ShortLoopsStayWithTheCaller) {
  Workers workers(4);
  int calls = 0;
  std::thread::id const caller = std::this_thread::get_id();
  workers.over(20, 11, [&](Index begin, Index end) {
    ++calls;
    EXPECT_EQ(end - begin, 20);
    EXPECT_EQ(std::this_thread::get_id(), caller);
  });
  EXPECT_EQ(calls, 1);
}

TEST(Workers, AnExceptionReachesTheCallerAndLeavesThemUsable) {
  Workers workers(2);
  auto const failing = [&](Index from) {
    return message_of<NonFiniteValue>([&] {
      workers.over(100, 10, [&](Index begin, Index) {
        if (begin >= from) throw NonFiniteValue("part " + std::to_string(begin));
      });
    });
  };
  EXPECT_TRUE(has(failing(0), "part 0"));  // the error of the first part, if both throw
  EXPECT_TRUE(has(failing(1), "part 48"));
  std::atomic<Index> sum{0};
  workers.over(100, 10, [&](Index begin, Index end) { sum += end - begin; });
  EXPECT_EQ(sum, 100);
}

TEST(Workers, RefuseToBeNone) {
  EXPECT_TRUE(has(refusal([] { Workers none(0); }), "at least one thread"));
  EXPECT_TRUE(has(refusal([] { Workers fewer(-2); }), "at least one thread"));
}

TEST(Workers, LoopsWithoutAnyRunAsTheyStand) {
  Index sum = 0;
  share(nullptr, 10, 1, [&](Index begin, Index end) { sum += 100 * begin + end; });
  EXPECT_EQ(sum, 10);
}

TEST(Workers, MoreThreadsThanAnyMachineHasAreRefused) {
  std::string const said = refusal([] { Workers(1'000'000); });
  EXPECT_TRUE(has(said, "1000000 threads")) << said;
  EXPECT_TRUE(has(said, "processors")) << said;
}

}  // namespace workers_test
