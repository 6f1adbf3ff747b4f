#pragma once
/// \file
/// Copies of the data of a run that a failed step must restore. The driver of the run restores its own data.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <polybody/run/axial_force_monitor.hpp>
#include <polybody/run/run_options.hpp>

namespace polybody {

/// Report and monitors of a run before a step. Every step stores the numbers; texts are stored just before they change.
struct StepUndo {
  bool has_user = false;  ///< true if `user` belongs to this step
  State user;             ///< user's state before its update in this step

  void end(State const& x) { sizes_ = sizes_of(x); }  ///< stores the sizes of the state at the end of a step
  bool fits(State const& x) const { return sizes_ == sizes_of(x); }  ///< true if x has the stored sizes
  /// \throws InvalidInput for a step of h [s] from x: the sizes of x were changed, the run has ended at `end_time` [s],
  /// or h is below the resolution of floating-point numbers at x.t.
  [[noreturn, gnu::cold]] void refuse_step(State const& x, double end_time, double h) const {
    if (!fits(x))
      throw InvalidInput(
          "state.size",
          {"The sizes of the state were changed since the last step, which ended at t = ", ErrorTime{x.t},
           " s. Only the run may change the sizes; the `action` of an event may change entries of q and v."});
    if (!(x.t < end_time))
      throw InvalidInput("run.ended", {ErrorObject{"advance"}, ": the run has ended at t = ", ErrorTime{x.t},
                                       " s. Check done() first, or give a later `end_time`."});
    throw InvalidInput("run.clock", {"Double precision does not resolve a step of ", ErrorValue{h},
                                     " s at t = ", ErrorTime{x.t}, " s. Start the run at a time near zero."});
  }
  /// Stores the run before a step.
  void begin(RunReport const& report) {
    warnings_ = report.warnings.size();
    has_user = counted_ = restarted_ = false;
    axial_.reset();
  }
  /// Stores the user's state before its update in this step.
  [[gnu::cold]] void keep_user(State const& x) {
    user = x;
    has_user = true;
  }
  /// Stores the counts before this step is counted.
  [[gnu::cold]] void keep_counts(RunCounts const& counts) {
    counts_ = counts;
    counted_ = true;
  }
  /// Stores the redundant joints before a restart.
  [[gnu::cold]] void keep_redundant(RunReport const& report) {
    redundant_ = report.redundant;
    restarted_ = true;
  }
  /// Stores the monitor and the warnings before an evaluation of axial forces.
  [[gnu::cold]] void keep_axial(AxialForceMonitor const& axial, RunReport const& report) {
    if (axial_) return;
    said_.assign(report.warnings.begin(), report.warnings.begin() + std::ptrdiff_t(warnings_));
    axial_ = axial;
  }
  /// Restores the run as it was before the step.
  [[gnu::cold]] void put_back(RunReport& report, AxialForceMonitor& axial) {
    if (axial_) {
      axial = std::move(*axial_);
      report.warnings.swap(said_);
    } else {
      report.warnings.resize(warnings_);
    }
    if (restarted_) report.redundant.swap(redundant_);
    if (counted_) static_cast<RunCounts&>(report) = counts_;
  }

 private:
  using Sizes = std::array<Index, 5>;
  static Sizes sizes_of(State const& x) {
    return {x.q.size(), x.v.size(), x.a.size(), x.lambda.size(), x.history.size()};
  }

  Sizes sizes_{};  // of q, v, a, λ and the integrator history at the end of the last step
  std::size_t warnings_ = 0;
  RunCounts counts_;
  bool counted_ = false, restarted_ = false;
  std::vector<std::string> redundant_, said_;
  std::optional<AxialForceMonitor> axial_;
};

}  // namespace polybody
