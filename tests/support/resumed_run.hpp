#pragma once
/// \file Runs that are saved in a file and continued, compared bit by bit with the uninterrupted run.

#include <gtest/gtest.h>
#include <unistd.h>

#include <bit>
#include <polybody/io/checkpoint.hpp>
#include <polybody/run/simulate.hpp>
#include <vector>

#include "support/chain.hpp"

namespace polybody {

/// Each number by its bits, so that 0 and −0 differ and NaN equals itself.
inline std::vector<std::uint64_t> bits(State const& x) {
  std::vector<std::uint64_t> all{std::bit_cast<std::uint64_t>(x.t)};
  for (VecX const* part : {&x.q, &x.v, &x.a, &x.lambda, &x.history}) {
    all.push_back(std::uint64_t(part->size()));
    for (double const value : *part) all.push_back(std::bit_cast<std::uint64_t>(value));
  }
  return all;
}

inline void expect_same(RunReport const& a, RunReport const& b) {
  auto const counts = [](RunReport const& r) {
    return std::vector<long>{r.steps,    r.iterations, r.factorisations, r.evaluations,
                             r.rejected, r.halved,     r.over_budget,    r.stopped};
  };
  EXPECT_EQ(counts(a), counts(b));
  EXPECT_EQ(a.redundant, b.redundant);
  EXPECT_EQ(a.warnings, b.warnings);
  EXPECT_EQ(a.last.next, b.last.next);
  EXPECT_EQ(a.last.order, b.last.order);
  EXPECT_EQ(a.last.contraction, b.last.contraction);
  EXPECT_EQ(a.last.left, b.last.left);
  EXPECT_EQ(a.left, b.left);
  ASSERT_EQ(a.events.size(), b.events.size());
  for (std::size_t i = 0; i < a.events.size(); ++i) {
    EXPECT_EQ(a.events[i].name, b.events[i].name);
    EXPECT_EQ(a.events[i].time, b.events[i].time);
  }
}

/// Four rods that fall from the horizontal for 1.5 s. An event occurs whenever the first rod passes the vertical, and
/// breakpoints are on and off the time grid. The run and its continuations write checkpoints at their start and after
/// 60 and 100 steps.
template <class World, class I>
void expect_resumes(I const& integrator) {
  Chain<World> const chain(4, bar_link());
  auto const passed = [&](State const& x) { return position(chain.model, x, World::at(chain.links[0], 0.5))[0]; };
  RunOptions const options{.end_time = 1.5,
                           .step = 0.004,
                           .max_step = 0.01,
                           .breakpoints = {0.4, 0.7321},
                           .events = {{.name = "first rod hangs", .value = passed}}};
  std::string const name = "polybody resumed " + std::to_string(::getpid()) + ".checkpoint";
  auto const file = std::filesystem::path(testing::TempDir()) / name;
  std::vector<RunSnapshot> snapshots;
  std::vector<std::vector<std::uint64_t>> path;
  auto const is_due = [](long steps) { return steps == 0 || steps == 60 || steps == 100; };

  State x = chain.model.reference_state();
  auto run = simulate(chain.model, x, integrator, options);
  for (State const& now : run) {
    path.push_back(bits(now));
    if (!is_due(run.report().steps)) continue;
    write_checkpoint(file, run.snapshot());
    snapshots.push_back(read_checkpoint(file));
    EXPECT_EQ(bits(now), path.back());  // a snapshot does not change the state
  }
  std::filesystem::remove(file);
  ASSERT_EQ(snapshots.size(), 3u);
  ASSERT_GE(run.report().events.size(), 1u);
  for (RunSnapshot const& from : snapshots) {
    State y;
    auto second = resume(chain.model, y, integrator, options, from);
    for (State const& now : second) {
      long const steps = second.report().steps;
      ASSERT_LT(std::size_t(steps), path.size());
      ASSERT_EQ(bits(now), path[std::size_t(steps)])
          << "step " << steps << " of the run from step " << from.report.steps;
      if (is_due(steps) && steps > from.report.steps) second.snapshot();
    }
    expect_same(run.report(), second.report());
  }
}

}  // namespace polybody
