#pragma once
/// \file
/// Queue of the unfinished points of a study, shared by all threads.
///
/// Not in polybody.hpp: it belongs to study/study.hpp.

#include <exception>
#include <mutex>

#include <polybody/io/progress.hpp>
#include <polybody/study/record.hpp>

namespace polybody {

/// Options for running a study.
struct StudyOptions {
  int threads = 1;            ///< number of threads; with several ranks each rank computes one point at a time
  bool retry_failed = false;  ///< computes points again that failed in an earlier run
  bool progress = true;       ///< shows a bar with the remaining time if stderr is a terminal
  /// Wall-clock time limit of a point [s]; zero: no limit. A point that exceeds it is recorded as failed, and the study
  /// continues. With a limit, each point is computed in a separate process. Changes that the function makes to
  /// variables are then lost, and a crash is a failure of one point only.
  double time_limit = 0.0;
};

namespace detail {

/// Thread-safe queue that distributes points in the order of the table. Outcomes are recorded in the order in which the
/// points finish.
class StudyQueue {
 public:
  StudyQueue(StudyRecord& record, StudyOptions const& options, std::string const& label)
      : record_(record), outcomes_(record.found()) {
    for (std::size_t i = 0; i < outcomes_.size(); ++i)
      if (!outcomes_[i] || (options.retry_failed && outcomes_[i]->failed())) left_.push_back(i);
    if (options.progress && !left_.empty()) progress_.emplace(0.0, double(left_.size()), label);
  }

  std::size_t left() const { return left_.size(); }  ///< number of unfinished points at the start

  /// Returns the next point, or nothing if all are distributed or the study is stopped.
  std::optional<std::size_t> next() {
    std::lock_guard const lock(mutex_);
    if (error_ || given_ == left_.size()) return std::nullopt;
    return left_[given_++];
  }

  /// Records the outcome of a point. The study stops if the record cannot be written.
  void finish(std::size_t point, Outcome outcome) {
    std::lock_guard const lock(mutex_);
    try {
      record_.append(point, outcome);
      outcomes_[point] = std::move(outcome);
      if (progress_) progress_->update(double(++finished_));
    } catch (...) {
      if (!error_) error_ = std::current_exception();
    }
  }

  /// Stops the distribution of points. `rethrow` throws `why` of the first stop.
  void stop(std::exception_ptr why) {
    std::lock_guard const lock(mutex_);
    if (!error_) error_ = std::move(why);
  }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

  /// Computes points until none is left: `outcome(i)` returns the outcome of point i.
  template <class F>
  void work(F const& outcome) {
    try {
      while (auto const point = next()) finish(*point, outcome(*point));
    } catch (...) {
      stop(std::current_exception());
    }
  }

  std::vector<std::optional<Outcome>> take() {
    if (progress_) progress_->finish();
    return std::move(outcomes_);
  }

 private:
  StudyRecord& record_;
  std::vector<std::optional<Outcome>> outcomes_;
  std::vector<std::size_t> left_{};
  std::size_t given_ = 0, finished_ = 0;
  std::optional<Progress> progress_{};
  std::exception_ptr error_{};
  std::mutex mutex_{};
};

}  // namespace detail

}  // namespace polybody
