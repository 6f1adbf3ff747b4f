#pragma once
/// \file
/// Checks during a run that the values of prescribed motions agree with their rates and accelerations.

#include <algorithm>
#include <cmath>

#include <polybody/math/sequence.hpp>
#include <polybody/system/layout.hpp>

namespace polybody {

/// Comparison of the change of each prescribed value ψ over a step with its rates at both ends, and of the change of
/// the rate with the accelerations:
///   |Δψ − ½h (ψ̇₀ + ψ̇₁)| ≤ ½h |ψ̇₁ − ψ̇₀| + h² â + 10⁻³ h r̂,   |Δψ̇ − ½h (ψ̈₀ + ψ̈₁)| ≤ h â,
/// where â and r̂ are the largest |ψ̈| and |ψ̇| so far. A smooth function of time satisfies these bounds over a step that
/// resolves it. If a step violates the bounds, they are checked for parts of the step, down to h/1024. A function with
/// a jump or with wrong derivatives violates the bounds for parts of any length.
class LawWatch {
 public:
  /// Restarts the check at time t [s]. Times that differ by at most `remainder_step` [s] count as the same breakpoint.
  /// \throws InvalidInput if a prescribed value jumps at t.
  template <class = void>
  [[gnu::cold]] void begin(ModelLayout const& layout, double t, double remainder_step);
  /// Compares the two ends of the step of length h [s] that ends at t [s]. \throws InvalidInput if the bounds are
  /// violated; the message names the joint.
  template <class = void>
  void require(ModelLayout const& layout, double t, double h);

  bool watches() const { return !laws_.empty(); }  ///< true if the model has prescribed motions

  void mark() {  ///< begins a trial step
    for (Watched& law : laws_) law.marked = law.last;
    marked_ = last_;
  }
  void go_back() {  ///< discards the trial step
    for (Watched& law : laws_) law.last = law.marked;
    last_ = marked_;
  }

 private:
  struct Watched {
    std::size_t joint;
    Motion last, marked;
    double rate = 0.0, acceleration = 0.0;  ///< r̂, â: largest |ψ̇| and |ψ̈| so far [unit of ψ per s and per s²]
  };
  static Motion at(JointLayout const& joint, double t) { return joint.law(joint.joint, t); }
  /// Difference x of two prescribed values, reduced by whole periods.
  static double change(JointLayout const& joint, double x) {
    return joint.period > 0.0 ? std::remainder(x, joint.period) : x;
  }
  /// Changes of value and rate over a step, minus the changes that the derivatives predict.
  struct Misfit {
    double value, rate;               ///< misfits [unit of the value, and per s]
    double by_rate, by_acceleration;  ///< predicted changes [unit of the value, and per s]
    bool of_value, of_rate;           ///< true if the misfit of the value or the rate exceeds its bound
  };
  static Misfit misfit(JointLayout const& joint, Watched& law, Motion const& from, Motion const& to, double h) {
    law.rate = std::max({law.rate, std::abs(from.rate), std::abs(to.rate)});
    law.acceleration = std::max({law.acceleration, std::abs(from.acceleration), std::abs(to.acceleration)});
    double const change_of_rate = to.rate - from.rate, by_rate = 0.5 * h * (from.rate + to.rate),
                 by_acceleration = 0.5 * h * (from.acceleration + to.acceleration),
                 value = change(joint, to.value - from.value - by_rate), rate = change_of_rate - by_acceleration,
                 most = 0.5 * h * std::abs(change_of_rate) + h * (h * law.acceleration + 1e-3 * law.rate) +
                        1e-12 * (1.0 + std::abs(from.value) + std::abs(to.value));
    return {value,
            rate,
            by_rate,
            by_acceleration,
            !(std::abs(value) <= most),
            !(std::abs(rate) <= h * law.acceleration + 1e-9 * law.rate + 1e-12)};
  }
  /// Checks parts of a step that violates the bounds. \throws InvalidInput if the parts also violate them.
  template <class = void>
  [[gnu::cold]] static void require_smooth(JointLayout const& joint, Watched& law, Motion from, Motion to, double t,
                                           double h);

  Sequence<Watched> laws_;
  double last_ = 0.0, marked_ = 0.0;  // times of `last` and `marked` [s]
};

template <class>
void LawWatch::begin(ModelLayout const& layout, double t, double remainder_step) {
  bool const first = laws_.empty();
  if (first)
    for (std::size_t i = 0; i < layout.joints.size(); ++i)
      if (layout.joints[i].law) laws_.push_back({i, {}, {}});
  for (Watched& law : laws_) {
    JointLayout const& joint = layout.joints[law.joint];
    Motion const before = law.last;
    law.last = at(joint, t);
    double const gap = t - last_;
    if (first || std::abs(gap) > remainder_step) continue;
    double const jump = change(joint, law.last.value - before.value),
                 most = std::max(std::abs(before.rate), std::abs(law.last.rate)) * std::abs(gap) +
                        1e-9 * (1.0 + std::abs(law.last.value));
    if (!(std::abs(jump) <= most))
      throw InvalidInput("time_function.jump",
                         {"joint \"", ErrorObject{joint.name}, "\": the prescribed value jumps by ", ErrorValue{jump},
                          " at the breakpoint t = ", ErrorTime{t},
                          " s. A prescribed value must be continuous. Use a Ramp or SmoothRamp."});
  }
  last_ = marked_ = t;
  for (Watched& law : laws_) law.marked = law.last;
}

template <class>
void LawWatch::require(ModelLayout const& layout, double t, double h) {
  double const start = t - h;
  bool const follows = std::abs(start - last_) <= 1e-3 * h, again = std::abs(start - marked_) <= 1e-3 * h;
  for (Watched& law : laws_) {
    JointLayout const& joint = layout.joints[law.joint];
    Motion const from = follows ? law.last : again ? law.marked : at(joint, start), to = at(joint, t);
    Misfit const off = misfit(joint, law, from, to, h);
    if (off.of_value || off.of_rate) require_smooth(joint, law, from, to, t, h);
    law.last = to;
  }
  last_ = t;
}

template <class>
void LawWatch::require_smooth(JointLayout const& joint, Watched& law, Motion from, Motion to, double t, double h) {
  Misfit const full = misfit(joint, law, from, to, h);
  double part = h, end = t;
  for (int k = 0; k < 10; ++k) {
    part *= 0.5;
    Motion const middle = at(joint, end - part);
    Misfit const first = misfit(joint, law, from, middle, part), second = misfit(joint, law, middle, to, part);
    if (second.of_value || second.of_rate) {
      from = middle;
    } else if (first.of_value || first.of_rate) {
      to = middle;
      end -= part;
    } else {
      return;
    }
  }
  bool const of_value = full.of_value;
  double const expected = of_value ? full.by_rate : full.by_acceleration;
  throw InvalidInput(
      "time_function.derivatives",
      {"joint \"", ErrorObject{joint.name}, "\": in the step of ", h, " s to t = ", ErrorTime{t}, " s the prescribed ",
       of_value ? "value" : "rate", " changes by ", ErrorValue{expected + (of_value ? full.value : full.rate)},
       ", but the ", of_value ? "rate" : "acceleration", " of the time function predicts ", expected,
       ". Correct the derivatives of the time function. If its rate jumps, declare a breakpoint at this time, in "
       "breakpoints() of the function or in the options of the run. The value must not jump."});
}

}  // namespace polybody
