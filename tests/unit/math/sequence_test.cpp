// A Sequence behaves like a std::vector: its content, its copies and moves, and its living values if a copy throws.
#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <polybody/math/sequence.hpp>

namespace sequence_test {
using namespace polybody;

/// Counts the living values, and refuses the requested copy.
struct Counted {
  inline static int alive = 0, copies_until_refusal = -1;
  int value = 0;
  explicit Counted(int v = 0) : value(v) { ++alive; }
  Counted(Counted const& other) : value(other.value) {
    if (copies_until_refusal == 0) throw std::runtime_error("no more copies");
    if (copies_until_refusal > 0) --copies_until_refusal;
    ++alive;
  }
  Counted(Counted&& other) noexcept : value(other.value) { ++alive; }
  Counted& operator=(Counted const&) = default;
  ~Counted() { --alive; }
};

struct alignas(64) Wide {
  double x = 1.0;
};

std::vector<int> values(Sequence<int> const& s) { return {s.begin(), s.end()}; }

TEST(Sequence, HoldsWhatWasAddedInOrder) {
  Sequence<std::string> s;
  EXPECT_TRUE(s.empty());
  for (int i = 0; i < 100; ++i) s.push_back(std::string(40, char('a' + i % 26)));
  s.emplace_back(3, 'z');
  ASSERT_EQ(s.size(), 101u);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(s[std::size_t(i)], std::string(40, char('a' + i % 26)));
  EXPECT_EQ(s.back(), "zzz");
  EXPECT_EQ(s.front(), std::string(40, 'a'));
  s.pop_back();
  EXPECT_EQ(s.size(), 100u);
}

TEST(Sequence, TakesAValueOfItsOwn) {
  Sequence<std::string> s{std::string(50, 'a')};
  for (int i = 0; i < 20; ++i) s.push_back(s[0]);
  for (int i = 0; i < 20; ++i) s.emplace_back(s.front());
  EXPECT_EQ(s.size(), 41u);
  for (std::string const& each : s) EXPECT_EQ(each, std::string(50, 'a'));
  s.assign(7, s[3]);
  EXPECT_EQ(s.size(), 7u);
  EXPECT_EQ(s.back(), std::string(50, 'a'));
}

TEST(Sequence, NewNumbersAreZero) {
  Sequence<double> s(5, 3.0);
  s.truncate(2);
  s.resize(6);
  EXPECT_EQ(std::vector<double>(s.begin(), s.end()), (std::vector<double>{3.0, 3.0, 0.0, 0.0, 0.0, 0.0}));
  s.resize(7, -1.0);
  EXPECT_EQ(s.back(), -1.0);
  s.resize(1);
  EXPECT_EQ(s.size(), 1u);
}

TEST(Sequence, CopiesAreApartAndMovesAreNot) {
  Sequence<int> a{1, 2, 3};
  Sequence<int> b = a;
  b[0] = 9;
  EXPECT_EQ(values(a), (std::vector<int>{1, 2, 3}));
  int const* const where = b.data();
  Sequence<int> const c = std::move(b);
  EXPECT_EQ(c.data(), where);
  EXPECT_EQ(values(c), (std::vector<int>{9, 2, 3}));
  a = c;
  EXPECT_EQ(values(a), values(c));
  EXPECT_NE(a.data(), c.data());
  a = Sequence<int>{};
  EXPECT_TRUE(a.empty());
  std::vector<int> const from{4, 5};
  a.append(from.begin(), from.end());
  EXPECT_EQ(values(a), from);
  EXPECT_EQ(values(Sequence<int>(from.begin(), from.end())), from);
  EXPECT_EQ(values(Sequence<int>(3, 5)), (std::vector<int>{5, 5, 5}));
}

TEST(Sequence, DestroysWhatItHolds) {
  {
    Sequence<Counted> a(10);
    Sequence<Counted> b = a;
    a.reserve(100);
    a.truncate(4);
    EXPECT_EQ(Counted::alive, 14);
    b.clear();
    EXPECT_EQ(Counted::alive, 4);
    b = std::move(a);
    EXPECT_EQ(Counted::alive, 4);
  }
  EXPECT_EQ(Counted::alive, 0);
}

TEST(Sequence, ACopyThatThrowsLeavesNothingBehind) {
  {
    Sequence<Counted> const a(10);
    Counted::copies_until_refusal = 4;
    EXPECT_THROW(Sequence<Counted>{a}, std::runtime_error);
    EXPECT_EQ(Counted::alive, 10);
    Counted::copies_until_refusal = -1;
  }
  EXPECT_EQ(Counted::alive, 0);
}

TEST(Sequence, StandsAsItsTypeAsks) {
  Sequence<Wide> s(3);
  for (int i = 0; i < 10; ++i) {
    s.push_back({2.0});
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(s.data()) % alignof(Wide), 0u);
  }
  EXPECT_EQ(s[0].x, 1.0);
  EXPECT_EQ(s.back().x, 2.0);
}

TEST(Sequence, HoldsWhatCanOnlyMove) {
  Sequence<std::unique_ptr<int>> s;
  for (int i = 0; i < 10; ++i) s.push_back(std::make_unique<int>(i));
  erase_if(s, [](std::unique_ptr<int> const& p) { return *p % 3 == 0; });
  ASSERT_EQ(s.size(), 6u);
  EXPECT_EQ(*s[0], 1);
  EXPECT_EQ(*s.back(), 8);
}

TEST(Sequence, IsAskedWithinItsEnds) {
  Sequence<int> const s{4, 5};
  EXPECT_EQ(s.at(1), 5);
  EXPECT_THROW(s.at(2), std::out_of_range);
  EXPECT_TRUE(s == (Sequence<int>{4, 5}));
  EXPECT_FALSE(s == (Sequence<int>{4, 5, 6}));
  EXPECT_FALSE(s == (Sequence<int>{4, 6}));
}

TEST(Sequence, MoreThanThereIsRoomForIsRefused) {
  Sequence<double> s{1.0};
  EXPECT_THROW(s.reserve(std::size_t(-1) / 4), std::bad_alloc);
  EXPECT_EQ(s.size(), 1u);
  EXPECT_EQ(s[0], 1.0);
}

TEST(SortOnce, SortsAndKeepsOneOfEach) {
  Sequence<int> s{5, 3, 5, 1, 3, 3, 9};
  sort_once(s);
  EXPECT_EQ(values(s), (std::vector<int>{1, 3, 5, 9}));
  Sequence<int> none;
  sort_once(none);
  EXPECT_TRUE(none.empty());
}

}  // namespace sequence_test
