#pragma once
/// \file
/// Options and result of `gradient`, and the backward sweep with snapshots of states (`reverse_steps`).
/// Theory: Eq. 8.26.

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <polybody/math/compiler.hpp>
#include <polybody/run/run_options.hpp>

namespace polybody {

// Backward sweep over the steps of a run with a limited number of snapshots of its states. The binomial schedule
// repeats the fewest steps [Griewank & Walther 2000, Algorithm 799]. With s snapshots, one of them at the start, and at
// most r computations of each step, a sweep over C(s + r, s) steps is possible.

/// Cost of the backward sweep over a run.
struct CheckpointingReport {
  std::size_t steps = 0;      ///< number of steps of the run
  std::size_t taken = 0;      ///< number of computed steps, including repetitions; at least `steps`
  std::size_t snapshots = 0;  ///< largest number of states stored at the same time
};

/// Largest number of steps C(s + r, s) in a backward sweep with s = `snapshots` and at most r = `times` computations of
/// each step. From 1e15 on, the largest `std::size_t` is returned.
inline std::size_t binomial_steps(std::size_t snapshots, std::size_t times) {
  double count = 1.0;
  for (std::size_t k = 1; k <= std::min(snapshots, times); ++k) count *= double(snapshots + times - k + 1) / double(k);
  return count < 1e15 ? std::size_t(count + 0.5) : std::numeric_limits<std::size_t>::max();
}

/// Optimal number of steps from one snapshot to the next. \param steps number of steps after the snapshot; \param
/// snapshots number of snapshots for these steps, including the first one; at least two
inline std::size_t next_checkpoint(std::size_t steps, std::size_t snapshots) {
  std::size_t times = 1;
  while (binomial_steps(snapshots, times) < steps) ++times;
  std::size_t const spared = binomial_steps(snapshots - 1, times - 1);
  std::size_t const most = steps > spared ? steps - spared : 1;
  return std::max<std::size_t>(1, std::min({binomial_steps(snapshots, times - 1), most, steps - 1}));
}

/// Calls back(k, x_k, x_k+1) for k from `steps` − 1 down to zero. \param first x₀; \param take take(k, x) replaces x_k
/// by x_k+1, with bitwise identical results in each call; \param snapshots largest number of stored states, at least
/// one
template <class X, class Take, class Back>
CheckpointingReport reverse_steps(X const& first, std::size_t steps, std::size_t snapshots, Take&& take, Back&& back) {
  struct Kept {
    std::size_t step;
    X x;
  };
  CheckpointingReport report{.steps = steps};
  std::vector<Kept> kept;  // the first `count` are in use; the memory of the others is reused
  std::size_t count = 1;
  kept.push_back({0, first});
  auto const advance = [&](X& x, std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k, ++report.taken) take(k, x);
  };
  bool at_end = false;
  X before = first, after = first;  // states of the last remaining step
  for (std::size_t end = steps; end > 0;) {
    report.snapshots = std::max(report.snapshots, count);
    Kept& last = kept[count - 1];
    std::size_t const left = end - last.step, free_snapshots = snapshots > count ? snapshots - count : 0;
    if (left > 1 && free_snapshots > 0) {
      std::size_t const from = last.step, to = from + next_checkpoint(left, free_snapshots + 1);
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

/// Storage of the states of a run for the backward sweep.
struct GradientOptions {
  std::size_t snapshots = 0;  ///< largest number of stored states; zero: as many as fit into `memory`
  double memory = 1e9;        ///< memory limit of the snapshots if their number is not given [bytes]
};

/// Result of a run and its derivatives.
struct GradientResult {
  std::vector<std::string> parameters;  ///< names, with units
  double value = 0.0;                   ///< J, in the objective's unit
  VecX derivatives;                     ///< (parameters) dJ/dp [unit of J / unit of p]
  double left = 0.0;                    ///< largest relative change of adjoint multipliers in the last correction
  CheckpointingReport reversal;         ///< numbers of steps, computed steps and snapshots
  double snapshot_size = 0.0;           ///< memory of one snapshot [bytes]
  RunReport run;                        ///< report of the forward run
};

namespace detail {

/// Largest number of stored states. \param size size of one state [bytes]. \throws InvalidInput if `snapshots` is zero
/// and `memory` is less than the size of one state.
template <class = void>
std::size_t snapshots_of(GradientOptions const& options, double size) {
  if (options.snapshots > 0) return options.snapshots;
  if (!(options.memory >= size))
    throw InvalidInput("gradient.memory", {ErrorObject{"gradient"}, ": a snapshot of a state takes ", size,
                                           " bytes, but the allowed memory is ", ErrorValue{options.memory},
                                           " bytes. Increase `memory`."});
  return std::size_t(std::min(options.memory / size, 1e15));
}
/// Memory of a snapshot of x [bytes].
template <class = void>
double size_of_snapshot(State const& x) {
  return 8.0 * double(x.q.size() + x.v.size() + x.a.size() + x.lambda.size() + x.history.size());
}
/// Adds a warning for each parameter without effect on the objective.
template <class = void>
void warn_of_zeros(GradientResult& g) {
  for (std::size_t j = 0; j < g.parameters.size(); ++j)
    if (g.derivatives[Index(j)] == 0.0)
      g.run.add_warning("The objective does not depend on the parameter \"" + g.parameters[j] +
                        "\". Remove it, or use it in the model.");
}

}  // namespace detail
}  // namespace polybody
