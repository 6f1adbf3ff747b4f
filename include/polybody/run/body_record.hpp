#pragma once
/// \file
/// Records of selected rigid bodies in a run: their motion, and each wrench on them with its point of action. The
/// records are the input of a stress analysis after the run (decoupled_stress.hpp).
/// Theory: Eqs. 11.18, 11.19.

#include <algorithm>
#include <optional>

#include <polybody/run/state_checks.hpp>
#include <polybody/system/lookup.hpp>
#include <polybody/system/make_operations.hpp>
#include <polybody/system/system.hpp>

namespace polybody {

/// Wrench on a body, in the body's axes; the moment is about the point `at`.
struct LoadSample {
  Vec3 at = Vec3::Zero();  ///< (3) point of action, relative to the body's origin [m]
  Vec3 f = Vec3::Zero();   ///< (3) force [N]
  Vec3 m = Vec3::Zero();   ///< (3) moment about `at` [N m]
};

/// Motion and loads of a body at one time. The loads do not include gravity.
struct BodySample {
  double t = 0.0;                            ///< time [s]
  Frame<double> frame;                       ///< frame of the body at its origin, the centre of mass
  Vec3 acceleration = Vec3::Zero();          ///< (3) acceleration of the origin, world axes [m/s²]
  Vec3 angular_acceleration = Vec3::Zero();  ///< (3) angular acceleration, world axes [rad/s²]
  std::vector<LoadSample> loads;             ///< nonzero loads
};

/// Recorded samples of one body.
struct BodyRecord {
  std::string name;                 ///< name of the body
  Vec3 gravity = Vec3::Zero();      ///< (3) gravity on the body, world axes [m/s²]
  std::vector<BodySample> samples;  ///< samples in the order of time
};

/// Requires at least two samples at increasing times. No interval may exceed `largest` [s], or 1.5 times the median
/// interval if `largest` is 0. \throws InvalidInput otherwise, with a message that begins with `who`.
template <class = void>  // compiled only if used
void require_no_gaps(BodyRecord const& record, double largest, std::string const& who) {
  if (record.samples.size() < 2)
    throw InvalidInput("record.samples", {ErrorObject{who}, "the record needs at least two samples, but has ",
                                          ErrorValue{record.samples.size()}, "."});
  require_not_negative(largest, who, "the largest gap");
  auto const between = [&](std::size_t k) {
    return sentence_of({record.samples[k].t, " s and ", record.samples[k + 1].t, " s"});
  };
  std::vector<double> intervals;
  for (std::size_t k = 0; k + 1 < record.samples.size(); ++k) {
    intervals.push_back(record.samples[k + 1].t - record.samples[k].t);
    if (!(intervals[k] > 0.0))
      throw InvalidInput("record.time_order", {ErrorObject{who}, "the times of the samples must increase, but ",
                                               record.samples[k + 1].t, " s follows ", record.samples[k].t, " s."});
  }
  std::vector<double> sorted = intervals;
  auto const middle = sorted.begin() + std::ptrdiff_t(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  double const gap = largest > 0.0 ? largest : 1.5 * *middle;
  for (std::size_t k = 0; k < intervals.size(); ++k)
    if (intervals[k] > gap * (1.0 + 1e-9))
      throw InvalidInput(
          "record.gap",
          {ErrorObject{who}, "there is no sample between ", between(k), ", a gap of more than ", ErrorValue{gap},
           " s. Record every step, or set largest_gap [s], up to which samples are interpolated."});
}

/// Rigid body in the plane or in space. `at(u)` is the point at the vector u from the centre of mass, in the body's
/// axes.
template <class B>
concept HasRigidPoints = Body<B> && (requires(B const b) { b.at(Vec3()); } || requires(B const b) { b.at(Vec2()); });

namespace detail {
/// Motion of a body's centre of mass in x; its accelerations are the twist rate J v̇ + bias.
template <HasRigidPoints B>
BodySample motion_of_centre(BodyLayout const& place, State const& x) {
  using U = std::conditional_t<B::world == World::plane, Vec2, Vec3>;
  BodyInState<B> const b = body_in_state<B>(place, x);
  Sequence<double> jacobian;
  MarkerKinematics<double> const p = evaluate_marker(b, b.body.at(U(U::Zero())), jacobian);
  Vec6 const rate = p.push(x.a.data() + place.v0) + p.bias;
  return {x.t, p.frame, rate.head<3>(), rate.tail<3>(), {}};
}
}  // namespace detail

/// Records the loads and motions of selected bodies:
///   LoadRecorder recorder(model);
///   recorder.add(link);
///   for (State const& now : simulate(model, x, …)) recorder.record(now);
///   recorder.of(link)   the record
/// The loads are −Gᵀλ of each joint on both of its markers [thesis Eq. 3.3, 4.4] and the wrenches of force elements.
/// Each sample satisfies m (a − g) = Σ f to the accuracy of the integrator, with the gravity g and the loads f.
template <class = void>  // compiled only if used
class LoadRecorderOf {
 public:
  /// Recorder for a model. The model must outlive the recorder and must not change after its construction.
  template <class M>
  explicit LoadRecorderOf(M const& model) : LoadRecorderOf(System(model, with<Capabilities::motion>)) {}
  template <class M>
    requires(!std::same_as<M, System>)
  explicit LoadRecorderOf(M const&& model) = delete;  ///< deleted: a temporary model would not outlive the recorder
  /// \param system of the full model
  explicit LoadRecorderOf(System system) : system_(std::move(system)), recorded_(system_.layout().bodies.size(), -1) {}

  /// Adds a body to the record. \throws InvalidInput after the first sample, and for a body of another model.
  template <class B>
  void add(BodyHandle<B> const& handle) {
    static_assert(HasRigidPoints<B>,
                  "LoadRecorder supports rigid bodies only. For a flexible body use the stress of its sections "
                  "(run/marker_frames.hpp).");
    Index const body = index_of(system_.layout(), handle);
    if (!records_.empty() && !records_.front().samples.empty())
      throw InvalidInput("record.late", {"LoadRecorder: \"", ErrorObject{handle.name},
                                         "\" is added after the first sample. Add all bodies before the run."});
    Index& slot = recorded_[std::size_t(body)];
    if (slot >= 0) return;
    slot = Index(records_.size());
    BodyLayout const& place = system_.layout().bodies[std::size_t(body)];
    Vec3 gravity = system_.layout().gravity;
    if (place.planar) gravity[2] = 0.0;
    records_.push_back({place.name, gravity, {}});
    motions_.push_back({body, &detail::motion_of_centre<B>});
  }

  /// Adds a sample for each recorded body. \throws InvalidInput for a state of another model, and for a state that is
  /// not finite or not later than the last one.
  void record(State const& x) {
    require_fitting(system_, x);
    for (BodyRecord const& r : records_)
      if (!r.samples.empty() && !(x.t > r.samples.back().t))
        throw InvalidInput("record.time_order",
                           {ErrorObject{"LoadRecorder"}, ": a state at t = ", ErrorTime{x.t}, " s follows a state at ",
                            r.samples.back().t, " s. Record each state once, in the order of the run."});
    system_.evaluate(x.q, x.v, x.t);
    for (std::size_t i = 0; i < records_.size(); ++i)
      records_[i].samples.push_back(motions_[i].of(system_.layout().bodies[std::size_t(motions_[i].body)], x));
    for (ConstraintBlock<double> const& block : system_.data().rows)
      for (ConstraintSide<double> const* const end : {&block.a, &block.b}) {
        if (end->marker < 0 || record_of(end->marker) < 0) continue;
        double w[6];
        wrench_at(block, *end, block.multiplier(x.lambda), w);
        add_load(end->marker, w, -1.0);
      }
    system_.push_forces(x.lambda);
    for (AppliedWrench<double> const& action : system_.data().actions) add_load(action.marker, action.w, 1.0);
  }

  /// Record of a body. \throws InvalidInput for a body that was not recorded, or that has no sample yet.
  template <class B>
  BodyRecord const& of(BodyHandle<B> const& handle) const {
    Index const slot = recorded_[std::size_t(index_of(system_.layout(), handle))];
    if (slot < 0)
      throw InvalidInput("record.no_body", {"LoadRecorder: body \"", ErrorObject{handle.name},
                                            "\" was not recorded. Add it to the recorder before the run."});
    BodyRecord const& r = records_[std::size_t(slot)];
    if (r.samples.empty())
      throw InvalidInput("record.samples", {"LoadRecorder: there is no sample of \"", ErrorObject{handle.name},
                                            "\". Call record for each state of the run."});
    return r;
  }

 private:
  /// Recorded body, and the function that evaluates its motion.
  struct Recorded {
    Index body;
    BodySample (*of)(BodyLayout const&, State const&);
  };

  /// Index of the record of a marker's body, or −1.
  Index record_of(Index marker) const {
    Index const body = system_.layout().owners[std::size_t(marker)];
    return body < 0 ? -1 : recorded_[std::size_t(body)];
  }

  /// Adds sign · w to the last sample of the marker's body; w = [f; m] about the marker, in world axes.
  void add_load(Index marker, double const* w, double sign) {
    Index const slot = record_of(marker);
    if (slot < 0 || std::all_of(w, w + 6, [](double e) { return e == 0.0; })) return;
    Vec3 const f = sign * Vec3(w[0], w[1], w[2]), m = sign * Vec3(w[3], w[4], w[5]);
    BodySample& s = records_[std::size_t(slot)].samples.back();
    Mat3 const to_body = s.frame.A.transpose();
    s.loads.push_back(
        {to_body * (system_.data().markers[std::size_t(marker)].frame.r - s.frame.r), to_body * f, to_body * m});
  }

  System system_;
  std::vector<Index> recorded_;  ///< for each body: index of its record, or −1
  std::vector<Recorded> motions_;
  std::vector<BodyRecord> records_;
};

using LoadRecorder = LoadRecorderOf<>;  ///< records loads and motions of bodies

}  // namespace polybody
