#pragma once
/// \file
/// Which points of a study are left, for all who work on them.
///
/// Not in polybody.hpp: it comes with study/study.hpp.

#include <exception>
#include <mutex>

#include <polybody/io/progress.hpp>
#include <polybody/study/record.hpp>

namespace polybody {

/// How a study is run.
struct StudyOptions {
  int threads = 1;            ///< that work on points; over several ranks each rank works on one at a time
  bool retry_failed = false;  ///< points that failed in an earlier run are tried again
  bool progress = true;       ///< a bar with the time that is left, where stderr is a terminal
  /// Longest wall-clock time of a point [s]; zero: no limit. A point that exceeds it fails with a sentence, and the
  /// study continues. With a limit each point is computed in a separate process: changes of variables by the function
  /// are lost, and a crash is a failure of its point alone.
  double time_limit = 0.0;
};

namespace detail {

/// Gives points out in their order and records what they gave, in the order in which they end. For several threads.
class StudyQueue {
 public:
  StudyQueue(StudyRecord& record, StudyOptions const& options, std::string const& label)
      : record_(record), outcomes_(record.found()) {
    for (std::size_t i = 0; i < outcomes_.size(); ++i)
      if (!outcomes_[i] || (options.retry_failed && outcomes_[i]->failed())) left_.push_back(i);
    if (options.progress && !left_.empty()) progress_.emplace(0.0, double(left_.size()), label);
  }

  std::size_t left() const { return left_.size(); }  ///< at the start

  /// The next point; nothing where all are given out or the study is stopped.
  std::optional<std::size_t> next() {
    std::lock_guard const lock(mutex_);
    if (error_ || given_ == left_.size()) return std::nullopt;
    return left_[given_++];
  }

  /// Records it. Where that fails the study is stopped.
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

  /// No more points are given out; `rethrow` throws the first reason.
  void stop(std::exception_ptr why) {
    std::lock_guard const lock(mutex_);
    if (!error_) error_ = std::move(why);
  }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

  /// Works on points until none is left: `outcome(i)` gives that of point i.
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
