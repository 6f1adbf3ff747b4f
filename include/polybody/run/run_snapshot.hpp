#pragma once
/// \file
/// Snapshot of a run in memory, from which the run can be resumed, and ends of steps: grid points, breakpoints of
/// driving constraints and loads, and the end of the run.

#include <algorithm>
#include <cmath>
#include <limits>

#include <polybody/math/checksum.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/run/run_options.hpp>
#include <polybody/system/system.hpp>

namespace polybody {

/// Consecutive steps of equal length. They end at t₀ + k h, so that round-off does not accumulate.
struct StepRow {
  double start = 0.0, length = 0.0;  ///< t₀ and h [s]
  double count = 0.0;                ///< k, count of steps

  double end() const { return start + count * length; }  ///< time at which the last step ended [s]
  /// End of a step from t with the length `taken` [s]. A step of another length, or from another time, restarts the
  /// count.
  double after(double t, double taken) {
    if (t != end() || taken != length) *this = {t, taken, 0.0};
    count += 1.0;
    return end();
  }
};

/// Breakpoints and end time of a run.
class StepPlan {
 public:
  /// Next step of a run.
  struct Next {
    double target, h;   ///< latest end of the step [s]; length of the step [s]
    bool lands, jumps;  ///< in order: true if the step ends at `target`; true if it ends at a breakpoint
  };

  StepPlan() = default;
  /// Run from `start` to `end_time` with steps of about `step` [s]. Breakpoints outside (start, end_time] are ignored.
  [[gnu::cold]] StepPlan(double start, double end_time, double step, Sequence<double> breakpoints)
      : end_time_(end_time), step_(step), breakpoints_(std::move(breakpoints)) {
    erase_if(breakpoints_, [&](double t) { return !(t > start) || !(t <= end_time); });
    sort_once(breakpoints_);
  }

  /// Passes the breakpoints up to t, with a tolerance of 1e-9 of a step plus round-off (0.3 and 0.1 + 0.2 are equal).
  /// Returns t, or a later breakpoint or end time within this tolerance.
  double pass(double t) {
    double const remainder_step = 1e-9 * step_ + rounding(t);
    while (next_ < breakpoints_.size() && breakpoints_[next_] <= t + remainder_step)
      t = std::max(t, breakpoints_[next_++]);
    return end_time_ - t <= remainder_step ? end_time_ : t;
  }

  std::size_t passed() const { return next_; }          ///< number of passed breakpoints
  void go_back(std::size_t passed) { next_ = passed; }  ///< restores the number of passed breakpoints

  /// Next step from t, if possible of length h.
  Next next(double t, double h) const {
    bool const breakpoint = next_ < breakpoints_.size();
    double const target = breakpoint ? breakpoints_[next_] : end_time_, left = target - t;
    // A step may be 1 % longer than requested, so that no tiny step remains. Round-off would dominate in constraint
    // equations that are divided by the square of a tiny step.
    bool const lands = 1.01 * h >= left;
    if (lands && breakpoint) return {target, step_to_just_before(target, t), true, true};
    // If a last step differs from h only by round-off, its length is h, as in a run with a later end time.
    return {target, lands && std::abs(left - h) > rounding(t) ? left : h, lands, false};
  }

 private:
  static double rounding(double t) { return 4.0 * std::numeric_limits<double>::epsilon() * std::abs(t); }
  /// Length of a step that ends just before a breakpoint, at which a time function still has its earlier value.
  static double step_to_just_before(double breakpoint, double t) {
    double h = std::nextafter(breakpoint, t) - t;
    while (t + h >= breakpoint) h = std::nextafter(h, 0.0);
    return h;
  }

  double end_time_ = 0.0, step_ = 0.0;
  Sequence<double> breakpoints_;
  std::size_t next_ = 0;
};

/// Identity of the model of a snapshot: numbers of its unknowns in a step, and names of bodies, joints and forces in
/// order. Masses, lengths and loads are not compared.
struct ModelIdentity {
  Index coordinates = 0, velocities = 0, rows = 0;  ///< sizes of a step, after elimination
  Index eliminated_equations = 0;                   ///< eliminated equations with estimated multipliers in the state
  std::uint64_t names = 0;                          ///< checksum of the names

  bool operator==(ModelIdentity const&) const = default;  ///< true if counts and names are equal
};

/// Identity of a model. \param stepped integrated system: of the model or of its reduced coordinates
template <class = void>
ModelIdentity identity_of(System const& stepped) {
  std::string names;
  for (BodyLayout const& b : stepped.layout().bodies) (names += b.name) += '\n';
  names += '\n';
  for (JointLayout const& j : stepped.layout().joints) (names += j.name) += '\n';
  names += '\n';
  for (ForceLayout const& f : stepped.layout().forces) (names += f.name) += '\n';
  Index const rows = stepped.rows();
  return {stepped.coordinates(), stepped.velocities(), rows, multipliers_of(stepped) - rows, checksum(names)};
}

/// Data from which a run continues with the same model, integrator and options.
struct RunSnapshot {
  ModelIdentity model;     ///< identity of the model
  std::string integrator;  ///< name of the integrator
  State state;             ///< integrated state, reduced if policies eliminate unknowns, with its history
  double step = 0.0;       ///< next step of an integrator that controls its step [s]
  StepRow row;             ///< steps of equal length, up to the last step
  Sequence<int> sides;     ///< signs of the event values, as from `EventDetector::sides`
  RunReport report;        ///< report of the run so far

  /// \throws InvalidInput if a number of the state is NaN or infinite.
  template <class = void>
  void require_finite_state() const {
    polybody::require_finite(state.q, "resume: the coordinates of the snapshot");
    polybody::require_finite(state.v, "resume: the velocities of the snapshot");
    polybody::require_finite(state.a, "resume: the accelerations of the snapshot");
    polybody::require_finite(state.lambda, "resume: the multipliers of the snapshot");
    polybody::require_finite(state.history, "resume: the integrator history of the snapshot");
  }
  /// \throws InvalidInput unless the snapshot has this model, integrator (with the name `by`) and number of events.
  template <class = void>
  void require(ModelIdentity const& of, std::string const& by, std::size_t events) const {
    auto const counts = [](ModelIdentity const& m) {
      return sentence_of({m.coordinates, " coordinates, ", m.velocities, " generalised velocities and ", m.rows,
                          " constraint equations"});
    };
    if (model.coordinates != of.coordinates || model.velocities != of.velocities || model.rows != of.rows)
      throw InvalidInput("resume.model", {ErrorObject{"resume"}, ": the snapshot belongs to another model. It has ",
                                          counts(model), "; this model has ", counts(of), "."});
    if (model != of)
      throw InvalidInput("resume.model",
                         {ErrorObject{"resume"},
                          ": the snapshot belongs to another model, with other names of bodies, joints or forces."});
    if (integrator != by)
      throw InvalidInput("resume.integrator", {ErrorObject{"resume"}, ": the snapshot belongs to a run by ", integrator,
                                               ", not by ", by, "."});
    if (sides.size() != events)
      throw InvalidInput("resume.events", {ErrorObject{"resume"}, ": the snapshot belongs to a run with ",
                                           ErrorValue{sides.size()}, " events, but the options have ", events, "."});
  }
};

}  // namespace polybody
