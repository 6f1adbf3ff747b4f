#pragma once
#include <cstddef>

#include <polybody/system/state.hpp>

namespace polybody {

/// Iterator over the states of a simulation, one for each step: `for (State const& now : simulate(…))`.
/// \tparam Run a Simulation
template <class Run>
class RunIterator {
 public:
  /** End of the range. */ struct Sentinel {};
  using value_type = State;                                 ///< for std::input_iterator
  using difference_type = std::ptrdiff_t;                   ///< for std::input_iterator
  explicit RunIterator(Run* run) : run_(run) {}             ///< iterator of this run
  State const& operator*() const { return run_->state(); }  ///< state at the end of the last step
  /** Takes a step, or ends if the run is done. */ RunIterator& operator++() {
    if (run_->done())
      finished_ = true;
    else
      run_->advance();
    return *this;
  }
  void operator++(int) { ++*this; }                      ///< takes a step
  bool operator==(Sentinel) const { return finished_; }  ///< true if the run is done

 private:
  Run* run_;
  bool finished_ = false;
};

}  // namespace polybody
