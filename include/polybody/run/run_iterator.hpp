#pragma once
/// \file
/// Systems of a run, and the iterator over its states.

#include <cstddef>
#include <memory>

#include <polybody/run/probe.hpp>

namespace polybody {

/// Systems of a run: the integrated one, and the full one if policies eliminate unknowns.
struct RunSystems {
  std::unique_ptr<System> stepped;  ///< integrated system; a pointer, because workspaces refer to it
  std::unique_ptr<System> full;     ///< full system; null if policies eliminate nothing
  SystemSource questions = {};      ///< makes full systems, for evaluations of the states of the run
};

/// Iterator over the states of a simulation, one for each step: `for (auto const& now : simulate(…))`.
/// \tparam Run a Simulation
template <class Run>
class RunIterator {
 public:
  /** End of the range. */ struct Sentinel {};
  using value_type = State;                                       ///< for std::input_iterator
  using difference_type = std::ptrdiff_t;                         ///< for std::input_iterator
  explicit RunIterator(Run* run) : run_(run) {}                   ///< iterator of this run
  ObservedState const& operator*() const { return run_->now(); }  ///< state at the end of the last step
  /** Takes a step, or ends if the run is done. */ RunIterator& operator++() {
    if (run_->done())
      finished_ = true;
    else
      run_->advance();
    return *this;
  }
  void operator++(int) { ++*this; }                      ///< takes a step
  bool operator==(Sentinel) const { return finished_; }  ///< true past the last state of the run

 private:
  Run* run_;
  bool finished_ = false;
};

}  // namespace polybody
