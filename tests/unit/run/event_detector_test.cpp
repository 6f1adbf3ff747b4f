#include <polybody/run/event_detector.hpp>

#include <gtest/gtest.h>

#include "support/refusal.hpp"

namespace polybody {
namespace event_watch_test {

/// Run without dynamics, which advances the time only.
struct Clock {
  std::vector<Event> events;
  State x{};
  RunReport report;
  EventDetector watch;
  int steps = 0;

  explicit Clock(std::vector<Event> what) : events(std::move(what)) { watch.start(events, x, {0.1, seen(), drift()}); }
  static std::function<State const&(State const&)> seen() {
    return [](State const& s) -> State const& { return s; };
  }
  static std::function<void(State&, double)> drift() {
    return [](State& s, double h) { s.t += h; };
  }
  /// One step of h. \return true if an event ended it
  bool step(double h) {
    State const before = x;
    x.t += h;
    EventDetector::Step const again = [this](State& s, double length) {
      ++steps;
      s.t += length;
      return length;
    };
    return watch.meet(events, {before, h, again, {h, seen(), drift()}}, x, report);
  }
};

Event at(double time, std::string name, bool stops = false) {
  return {.name = std::move(name), .value = [time](State const& x) { return time - x.t; }, .terminal = stops};
}

TEST(EventDetector, EndsAStepWhereAnEventPassesThroughZero) {
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
  EXPECT_FALSE(clock.step(0.25));  // the event occurs once
}

TEST(EventDetector, TakesTheFirstOfTwo) {
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

TEST(EventDetector, AnEventThatStartsAtZeroIsNotMet) {
  Clock clock({at(0.0, "start")});
  EXPECT_FALSE(clock.step(0.5));
  EXPECT_TRUE(clock.report.events.empty());
}

TEST(EventDetector, NamesAnEventThatIsNotFinite) {
  Clock clock({{.name = "hole", .value = [](State const& x) { return x.t < 0.5 ? 1.0 : std::nan(""); }}});
  EXPECT_FALSE(clock.step(0.4));
  EXPECT_TRUE(has(message_of<NonFiniteValue>([&] { clock.step(0.4); }), "\"hole\" is not finite at t = 0.8 s"));
}

TEST(EventDetector, ShowsEventsWhatTheUserSees) {
  State shown{};
  std::vector<Event> const events{{.name = "double", .value = [](State const& x) { return 1.0 - x.t; }}};
  EventDetector watch;
  std::function<State const&(State const&)> const twice = [&](State const& x) -> State const& {
    shown.t = 2.0 * x.t;
    return shown;
  };
  State x{};
  std::function<void(State&, double)> const on = Clock::drift();
  watch.start(events, x, {0.8, twice, on});
  RunReport report;
  State const before = x;
  x.t = 0.8;
  EventDetector::Step const again = [](State& s, double h) {
    s.t += h;
    return h;
  };
  EXPECT_TRUE(watch.meet(events, {before, 0.8, again, {0.8, twice, on}}, x, report));
  EXPECT_NEAR(x.t, 0.5, 1e-10);
}

TEST(EventDetector, MakesTheUsersStateOnceForAllEvents) {
  int made = 0;
  std::vector<Event> const events{{.name = "a", .value = [](State const& x) { return 1.0 - x.t; }},
                                  {.name = "b", .value = [](State const& x) { return 2.0 - x.t; }},
                                  {.name = "c", .value = [](State const& x) { return 3.0 - x.t; }}};
  EventDetector watch;
  std::function<State const&(State const&)> const counted = [&](State const& x) -> State const& {
    ++made;
    return x;
  };
  State x{};
  std::function<void(State&, double)> const on = Clock::drift();
  watch.start(events, x, {0.5, counted, on});
  EXPECT_EQ(made, 1);
  RunReport report;
  State const before = x;
  x.t = 0.5;
  EventDetector::Step const again = [](State& s, double h) {
    s.t += h;
    return h;
  };
  EXPECT_FALSE(watch.meet(events, {before, 0.5, again, {0.5, counted, on}}, x, report));  // it requires rates
  made = 0;
  State const middle = x;
  x.t = 0.9;
  EXPECT_FALSE(watch.meet(events, {middle, 0.4, again, {0.5, counted, on}}, x, report));
  EXPECT_EQ(made, 1);
}

/// Point in free flight: height q, velocity v.
struct Flight {
  std::vector<Event> events;
  State x{};
  RunReport report;
  EventDetector watch;
  std::function<State const&(State const&)> seen = [](State const& s) -> State const& { return s; };
  std::function<void(State&, double)> fly = [](State& s, double h) {
    s.q[0] += h * s.v[0] + 0.5 * h * h * s.a[0];
    s.v[0] += h * s.a[0];
    s.t += h;
  };
  EventDetector::Step again = [this](State& s, double h) {
    fly(s, h);
    return h;
  };

  Flight(double speed, Event event) : events{std::move(event)} {
    x.q = VecX::Zero(1);
    x.v = VecX::Constant(1, speed);
    x.a = VecX::Constant(1, -9.81);
    watch.start(events, x, {0.1, seen, fly});
  }
  bool step(double h) {
    State const before = x;
    fly(x, h);
    return watch.meet(events, {before, h, again, {h, seen, fly}}, x, report);
  }
};
Event above(double height) {
  return {.name = "height", .value = [height](State const& s) { return s.q[0] - height; }};
}

TEST(EventDetector, FindsTwoZerosInOneStep) {
  // thrown upwards at 0.4 m/s: apex at 0.008155 m after 0.0408 s
  double const first = (0.4 - std::sqrt(0.16 - 2.0 * 9.81 * 0.008)) / 9.81,
               second = (0.4 + std::sqrt(0.16 - 2.0 * 9.81 * 0.008)) / 9.81;
  Flight flight(0.4, above(0.008));
  EXPECT_TRUE(flight.step(0.1));
  EXPECT_NEAR(flight.x.t, first, 1e-9);
  EXPECT_TRUE(flight.step(0.1));
  EXPECT_NEAR(flight.x.t, second, 1e-9);
  EXPECT_EQ(flight.report.events.size(), 2u);
  Flight short_steps(0.4, above(0.00815));  // with steps before the one in which the value has its extremum
  bool met = false;
  for (int k = 0; k < 5 && !met; ++k) met = short_steps.step(0.013);
  EXPECT_TRUE(met);
  EXPECT_LT(short_steps.x.t, 0.4 / 9.81);
  Flight too_low(0.4, above(0.0082));
  EXPECT_FALSE(too_low.step(0.1));
  EXPECT_TRUE(too_low.report.events.empty());
}

TEST(EventDetector, PutsBackWhatAStepHasChanged) {
  Flight flight(1.0, above(0.04));
  flight.events[0].terminal = true;
  flight.step(0.02);
  Sequence<int> const sides = flight.watch.sides();
  EXPECT_TRUE(flight.step(0.06));
  EXPECT_TRUE(flight.report.stopped);
  flight.watch.put_back(flight.report);
  EXPECT_EQ(flight.watch.sides(), sides);
  EXPECT_TRUE(flight.report.events.empty());
  EXPECT_FALSE(flight.report.stopped);
}

}  // namespace event_watch_test
}  // namespace polybody
