#pragma once
/// \file
/// Warnings of axial forces of at least 5 % of the buckling load, in beams of `Ffr` without geometric stiffening. The
/// deflection of these beams neglects axial forces.

#include <string>
#include <vector>

#include <polybody/kinematics/frame.hpp>
#include <polybody/system/state.hpp>
#include <polybody/system/system.hpp>

namespace polybody {

/// Evaluates axial forces about fifty times in a run, at the ends of steps. Keeps only the warning of the largest axial
/// force relative to the buckling load.
class AxialForceMonitor {
 public:
  static constexpr double worth_warning = 0.05;  ///< smallest reported fraction of the buckling load [1]

  /// Monitor for a run from `start` to `end_time` [s].
  AxialForceMonitor(System const& system, double start, double end_time)
      : every_(0.02 * (end_time - start)), next_(start + every_) {
    for (BodyLayout const& body : system.layout().bodies) asks_ = asks_ || body.axial_share;
  }

  /// True if a body of the model can compute its axial forces.
  bool asks() const { return asks_; }

  /// True if the state at the end of a step at t [s] must be evaluated. \param last true for the last step of the run
  bool is_due(double t, bool last) const { return asks_ && (last || t >= next_); }

  /// Evaluates the axial forces in x, which must have accelerations and multipliers, and updates the warning in
  /// `warnings`. If an evaluation throws, no warning changes.
  template <class = void>  // compiled only if used
  [[gnu::cold]] void look(System& system, State const& x, std::vector<std::string>& warnings) {
    collect(system, x);
    Sequence<double> shares(loads_.size(), 0.0);  // computed before any change, so that an exception changes nothing
    for (std::size_t i = 0; i < loads_.size(); ++i) {
      BodyLayout const& body = system.layout().bodies[i];
      if (!body.axial_share) continue;
      auto const part = [&](VecX const& all, Index first, Index count) {
        return std::span<double const>(all.data() + first, std::size_t(count));
      };
      try {
        shares[i] = body.axial_share(body.body, part(x.q, body.q0, body.coordinates),
                                     part(x.v, body.v0, body.velocities), part(x.a, body.v0, body.velocities),
                                     system.layout().gravity, {loads_[i].data(), loads_[i].size()});
      } catch (InvalidInput const&) {  // NOLINT(bugprone-empty-catch): the axial forces are unknown
      }
    }
    next_ = x.t + every_;
    for (std::size_t i = 0; i < shares.size(); ++i) {
      double const share = shares[i];
      if (!(std::abs(share) >= worth_warning && std::abs(share) > largest_)) continue;
      largest_ = std::abs(share);
      std::erase(warnings, said_);
      said_ = sentence_of(
          {"The beams of \"", system.layout().bodies[i].name, "\" are ",
           (share < 0.0 ? "in compression" : "in tension"), " at t = ", x.t, " s with ", 100.0 * largest_,
           " % of the load that buckles them. The deflection neglects this force; the relative error of the deflection "
           "is about the same percentage. Make the body with .stiffening = true and .frame = FfrFrame::mean_axes, as "
           "`Ffr::from` does."});
      warnings.push_back(said_);
    }
  }

 private:
  /// Collects the wrenches of joints and forces on each body.
  template <class = void>  // compiled only if used
  [[gnu::cold]] void collect(System& system, State const& x) {
    loads_.resize(system.layout().bodies.size());
    for (auto& of_body : loads_) of_body.clear();
    system.evaluate(x.q, x.v, x.t);
    double w[6];
    for (ConstraintBlock<double> const& block : system.data().rows)
      for (ConstraintSide<double> const* const end : {&block.a, &block.b}) {
        if (end->marker < 0) continue;
        wrench_at(block, *end, block.multiplier(x.lambda), w);
        add(system, end->marker, w, -1.0);
      }
    system.push_forces(x.lambda);
    for (AppliedWrench<double> const& action : system.data().actions) add(system, action.marker, action.w, 1.0);
  }
  /// Adds sign · w to the loads of the marker's body; w = [f; m] about the marker, in world axes.
  [[gnu::cold]] void add(System const& system, Index marker, double const* w, double sign) {
    Index const body = system.layout().owners[std::size_t(marker)];
    if (body < 0) return;
    loads_[std::size_t(body)].push_back(
        {system.data().markers[std::size_t(marker)].frame.r,
         {Vec3(sign * w[0], sign * w[1], sign * w[2]), Vec3(sign * w[3], sign * w[4], sign * w[5])}});
  }

  double every_, next_, largest_ = 0.0;
  bool asks_ = false;
  std::string said_;
  Sequence<Sequence<PlacedWrench>> loads_;
};

}  // namespace polybody
