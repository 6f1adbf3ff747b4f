#pragma once
// A run beside the clock on the wall.
#include <algorithm>
#include <chrono>
#include <thread>
#include <vector>

namespace drive {

// The run's frames are due when the clock has come to their time. One that is late by more than `patience` sets the
// clock back, so that a slow machine shows the motion slowly instead of chasing after it.
class WallClock {
 public:
  WallClock(bool waits, double patience) : waits_(waits), patience_(patience) {}

  // A step is computed between these.
  void begin_step() { step_began_ = now(); }
  void end_step() { steps_.push_back(now() - step_began_); }

  // A frame to time t [s] of the run is ready: waits until it is due.
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
  double slipped() const { return slipped_; }  // by how much the clock was set back, together [s]
  // Of the times of steps, in rising order.
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
