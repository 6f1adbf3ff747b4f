#pragma once
// Synchronisation of a run with wall-clock time.
#include <algorithm>
#include <chrono>
#include <thread>
#include <vector>

namespace drive {

// Clock of a run. A frame at time t [s] of the run is due t seconds of wall-clock time after the start. A frame that is
// late by more than `patience` [s] sets the clock back by its delay, so that a slow machine shows a slow motion.
class WallClock {
 public:
  WallClock(bool waits, double patience) : waits_(waits), patience_(patience) {}

  // Begin and end of the computation of a step.
  void begin_step() { step_began_ = now(); }
  void end_step() { steps_.push_back(now() - step_began_); }

  // Counts the frame at time t [s] of the run. Waits until the frame is due if `waits` is true.
  void frame(double t) {
    ++frames_;
    double const late = now() - began_ - t;
    if (late > 0.0) {
      ++missed_;
      latest_ = std::max(latest_, late);
    }
    if (late > patience_) {
      began_ += late;
      slipped_ += late;
    }
    if (waits_ && late < 0.0) std::this_thread::sleep_for(std::chrono::duration<double>(-late));
  }

  long frames() const { return frames_; }
  long missed() const { return missed_; }
  double latest() const { return latest_; }
  double slipped() const { return slipped_; }  // sum of the delays by which the clock was set back [s]
  // Computing times of all steps in ascending order [s].
  std::vector<double> sorted_steps() const {
    std::vector<double> all = steps_;
    std::sort(all.begin(), all.end());
    return all;
  }

 private:
  static double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  }

  bool waits_;
  double patience_, began_ = now(), step_began_ = 0.0, latest_ = 0.0, slipped_ = 0.0;
  long frames_ = 0, missed_ = 0;
  std::vector<double> steps_;
};

}  // namespace drive
