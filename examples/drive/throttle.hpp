#pragma once
// Angular velocity of a drive. Its target values are set during a run.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <vector>

#include <polybody/math/time_functions.hpp>

namespace drive {

using polybody::Motion;

// Angular velocity that approaches its target along cubic polynomials, continuous with its first derivative. All copies
// share one target. `ask(t, target)` sets the target [rad/s] between two steps and changes no value before time t [s].
class Throttle {
 public:
  void ask(double t, double target) {
    Piece const now = piece(t);
    Motion const from = now.at(t);
    double const way = std::abs(target - from.value), duration = std::max(shortest, 1.5 * way / acceleration);
    orders_->before = now;
    orders_->last = {t, duration, now.integral(t), from.value, from.rate, target};
  }
  double target() const { return orders_->last.target; }

  Motion operator()(double t) const { return piece(t).at(t); }
  double integral(double t) const { return t <= 0.0 ? 0.0 : piece(t).integral(t); }

 private:
  static constexpr double acceleration = 6.0;  // [rad/s²]
  static constexpr double shortest = 0.25;     // least duration of a change of speed [s]

  // Speed s from the time `start` on, with x = (t − start)/T: s = s₀ (2x³ − 3x² + 1) + T r₀ (x³ − 2x² + x) + s₁ (3x² −
  // 2x³). s₀ is `speed`, r₀ is `rate`, s₁ is `target`, T is `duration`; the speed is constant after T.
  struct Piece {
    double start = 0.0, duration = 1.0, angle = 0.0, speed = 0.0, rate = 0.0, target = 0.0;

    Motion at(double t) const {
      double const T = duration, x = (t - start) / T, step = target - speed, slope = T * rate;
      if (x >= 1.0) return {target, 0.0, 0.0};
      return {speed + step * x * x * (3.0 - 2.0 * x) + slope * x * (1.0 - x) * (1.0 - x),
              (6.0 * step * x * (1.0 - x) + slope * (1.0 - x) * (1.0 - 3.0 * x)) / T,
              (6.0 * step * (1.0 - 2.0 * x) + slope * (6.0 * x - 4.0)) / (T * T)};
    }
    double integral(double t) const {
      double const T = duration, x = std::min(1.0, (t - start) / T), step = target - speed, slope = T * rate;
      double const within =
          speed * x + step * x * x * x * (1.0 - 0.5 * x) + slope * x * x * (0.5 - 2.0 / 3.0 * x + 0.25 * x * x);
      return angle + T * within + target * std::max(0.0, t - start - T);
    }
  };
  struct Orders {
    Piece before, last;
  };
  Piece const& piece(double t) const { return t < orders_->last.start ? orders_->before : orders_->last; }

  std::shared_ptr<Orders> orders_ = std::make_shared<Orders>();
};

// Target speeds of the left and the right drive, and the time at which they are set.
struct Order {
  double t, left, right;  // [s], [rad/s]
};

// Reads a file of orders: a head line, then lines "t,left,right" [s], [rad/s]. \throws IoError naming file and line.
std::vector<Order> read_orders(std::filesystem::path const& file);

}  // namespace drive
