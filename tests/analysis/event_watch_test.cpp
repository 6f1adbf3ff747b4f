#include <polybody/run/event_watch.hpp>

#include <gtest/gtest.h>

#include "support/refusal.hpp"

namespace polybody {
namespace event_watch_test {

/// A run that only counts time.
struct Clock {
  std::vector<Event> events;
  State x{};
  RunReport report;
  EventWatch watch;
  int steps = 0;

  explicit Clock(std::vector<Event> what) : events(std::move(what)) { watch.start(events, x, seen()); }
  static EventWatch::Seen seen() {
    return [](State const& s) -> State const& { return s; };
  }
  /// One step of h; whether an event ended it.
  bool step(double h) {
    State const before = x;
    x.t += h;
    EventWatch::Step const again = [this](State& s, double length) {
      ++steps;
      s.t += length;
      return length;
    };
    EventWatch::Seen const same = seen();
    return watch.meet(events, {before, h, same, again}, x, report);
  }
};

Event at(double time, std::string name, bool stops = false) {
  return {.name = std::move(name), .value = [time](State const& x) { return time - x.t; }, .stops = stops};
}

TEST(EventWatch, EndsAStepWhereAnEventPassesThroughZero) {
  Clock clock({at(0.3, "alarm")});
  EXPECT_FALSE(clock.step(0.25));
  EXPECT_EQ(clock.x.t, 0.25);
  EXPECT_TRUE(clock.step(0.25));
  EXPECT_NEAR(clock.x.t, 0.3, 1e-10);
  ASSERT_EQ(clock.report.events.size(), 1u);
  EXPECT_EQ(clock.report.events[0].name, "alarm");
  EXPECT_EQ(clock.report.events[0].time, clock.x.t);
  EXPECT_FALSE(clock.report.stopped);
  EXPECT_LE(clock.steps, 32);      // 0.25/2³² < 1e-10
  EXPECT_FALSE(clock.step(0.25));  // it is met once
}

TEST(EventWatch, TakesTheFirstOfTwo) {
  Clock clock({at(0.6, "late", true), at(0.2, "early")});
  EXPECT_TRUE(clock.step(1.0));
  EXPECT_NEAR(clock.x.t, 0.2, 1e-10);
  ASSERT_EQ(clock.report.events.size(), 1u);
  EXPECT_EQ(clock.report.events[0].name, "early");
  EXPECT_FALSE(clock.report.stopped);
  EXPECT_TRUE(clock.step(1.0));
  EXPECT_NEAR(clock.x.t, 0.6, 1e-10);
  EXPECT_TRUE(clock.report.stopped);
}

TEST(EventWatch, AnEventThatStartsAtZeroIsNotMet) {
  Clock clock({at(0.0, "start")});
  EXPECT_FALSE(clock.step(0.5));
  EXPECT_TRUE(clock.report.events.empty());
}

TEST(EventWatch, NamesAnEventThatIsNotFinite) {
  Clock clock({{.name = "hole", .value = [](State const& x) { return x.t < 0.5 ? 1.0 : std::nan(""); }}});
  EXPECT_FALSE(clock.step(0.4));
  EXPECT_TRUE(has(message_of<NonFinite>([&] { clock.step(0.4); }), "\"hole\" is not finite at t = 0.8 s"));
}

TEST(EventWatch, ShowsEventsWhatTheUserSees) {
  State shown{};
  std::vector<Event> const events{{.name = "double", .value = [](State const& x) { return 1.0 - x.t; }}};
  EventWatch watch;
  EventWatch::Seen const twice = [&](State const& x) -> State const& {
    shown.t = 2.0 * x.t;
    return shown;
  };
  State x{};
  watch.start(events, x, twice);
  RunReport report;
  State const before = x;
  x.t = 0.8;
  EventWatch::Step const again = [](State& s, double h) {
    s.t += h;
    return h;
  };
  EXPECT_TRUE(watch.meet(events, {before, 0.8, twice, again}, x, report));
  EXPECT_NEAR(x.t, 0.5, 1e-10);
}

TEST(EventWatch, MakesTheUsersStateOnceForAllEvents) {
  int made = 0;
  std::vector<Event> const events{{.name = "a", .value = [](State const& x) { return 1.0 - x.t; }},
                                  {.name = "b", .value = [](State const& x) { return 2.0 - x.t; }},
                                  {.name = "c", .value = [](State const& x) { return 3.0 - x.t; }}};
  EventWatch watch;
  EventWatch::Seen const counted = [&](State const& x) -> State const& {
    ++made;
    return x;
  };
  State x{};
  watch.start(events, x, counted);
  EXPECT_EQ(made, 1);
  RunReport report;
  State const before = x;
  x.t = 0.5;
  EventWatch::Step const again = [](State& s, double h) {
    s.t += h;
    return h;
  };
  EXPECT_FALSE(watch.meet(events, {before, 0.5, counted, again}, x, report));
  EXPECT_EQ(made, 2);
}

}  // namespace event_watch_test
}  // namespace polybody
