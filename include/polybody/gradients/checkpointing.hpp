#pragma once
/// \file
/// The steps of a run taken backwards with few snapshots of its states: the binomial schedule, which computes the least
/// steps again [Griewank & Walther 2000, Algorithm 799]. With s snapshots, of which one is at the start, and no step
/// taken more than r times, as many as C(s + r, s) steps can be gone back.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include <polybody/math/compiler.hpp>

namespace polybody {

/// What going back over the steps of a run took.
struct CheckpointingReport {
  std::size_t steps = 0;      ///< of the run, how many are gone back over
  std::size_t taken = 0;      ///< steps that were computed, each of them once at least
  std::size_t snapshots = 0;  ///< the largest count of states that were kept at a time
};

/// C(s + r, s) steps, s = `snapshots` and r = `times`, or the largest number where that is more.
inline std::size_t binomial_steps(std::size_t snapshots, std::size_t times) {
  double count = 1.0;
  for (std::size_t k = 1; k <= std::min(snapshots, times); ++k) count *= double(snapshots + times - k + 1) / double(k);
  return count < 1e15 ? std::size_t(count + 0.5) : std::numeric_limits<std::size_t>::max();
}

/// From the first of so many steps, kept in a snapshot, the step before which the next snapshot is best taken.
/// \param snapshots those that may be kept of these steps, the first one among them: two at least
inline std::size_t next_checkpoint(std::size_t steps, std::size_t snapshots) {
  std::size_t times = 1;
  while (binomial_steps(snapshots, times) < steps) ++times;
  std::size_t const spared = binomial_steps(snapshots - 1, times - 1);
  std::size_t const most = steps > spared ? steps - spared : 1;
  return std::max<std::size_t>(1, std::min({binomial_steps(snapshots, times - 1), most, steps - 1}));
}

/// Calls back(k, x_k, x_k+1) for k from `steps` − 1 down to zero. \param first x₀; \param take take(k, x): x_k becomes
/// x_k+1, always with the same bits; \param snapshots of states that are kept at a time, one at least
template <class X, class Take, class Back>
CheckpointingReport reverse_steps(X const& first, std::size_t steps, std::size_t snapshots, Take&& take, Back&& back) {
  struct Kept {
    std::size_t step;
    X x;
  };
  CheckpointingReport report{.steps = steps};
  std::vector<Kept> kept;  // the first `count` are in use, the memory of the others is used again
  std::size_t count = 1;
  kept.push_back({0, first});
  auto const advance = [&](X& x, std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k, ++report.taken) take(k, x);
  };
  bool at_end = false;
  X before = first, after = first;  // of the last step that is left
  for (std::size_t end = steps; end > 0;) {
    report.snapshots = std::max(report.snapshots, count);
    Kept& last = kept[count - 1];
    std::size_t const left = end - last.step, room = snapshots > count ? snapshots - count : 0;
    if (left > 1 && room > 0) {
      std::size_t const from = last.step, to = from + next_checkpoint(left, room + 1);
      if (count == kept.size())
        kept.push_back({to, last.x});
      else
        kept[count] = {to, last.x};
      advance(kept[count++].x, from, to);
      continue;
    }
    if (left == 1) {
      std::swap(before, last.x);
      --count;
    } else {
      before = last.x;
      advance(before, last.step, end - 1);
    }
    if (!at_end) {
      after = before;
      advance(after, end - 1, end);
      at_end = true;
    }
    back(end - 1, std::as_const(before), std::as_const(after));
    std::swap(after, before);
    --end;
  }
  return report;
}

}  // namespace polybody
