#pragma once
#include <cstddef>

#include <polybody/system/state.hpp>

namespace polybody {

/// Runs through the states of a simulation, one a step: `for (State const& now : simulate(…))`. \tparam Run a
/// Simulation
template <class Run>
class RunIterator {
 public:
  /** The end. */ struct Sentinel {};
  using value_type = State;                                 ///< for std::input_iterator
  using difference_type = std::ptrdiff_t;                   ///< for std::input_iterator
  explicit RunIterator(Run* run) : run_(run) {}             ///< of this run
  State const& operator*() const { return run_->state(); }  ///< as the last step left it
  /** Takes a step, or ends where the run is done. */ RunIterator& operator++() {
    if (run_->done())
      finished_ = true;
    else
      run_->advance();
    return *this;
  }
  void operator++(int) { ++*this; }                      ///< a step further
  bool operator==(Sentinel) const { return finished_; }  ///< the run is done

 private:
  Run* run_;
  bool finished_ = false;
};

}  // namespace polybody
