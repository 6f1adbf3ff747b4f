#pragma once
/// \file
/// What a run leaves of chosen rigid bodies: motion, and every wrench with the material point it acts on. It is what a
/// stress analysis after the run starts from (decoupled_stress.hpp).
///
/// Not in polybody.hpp: few programs need it.

#include <optional>

#include <polybody/run/initial_conditions.hpp>
#include <polybody/system/model_entries.hpp>
#include <polybody/system/system.hpp>

namespace polybody {

/// A wrench on a body, in the body's axes; the moment is about the point itself.
struct RecordedLoad {
  Vec3 at = Vec3::Zero();  ///< (3) material point, from the body's origin [m]
  Vec3 f = Vec3::Zero();   ///< (3) [N]
  Vec3 m = Vec3::Zero();   ///< (3) [N m]
};

/// A body at one time. Gravity, a field, is not among the loads.
struct BodySample {
  double t = 0.0;                            ///< [s]
  Frame<double> frame;                       ///< of its origin (the centre of mass) and axes, world axes
  Vec3 acceleration = Vec3::Zero();          ///< (3) of the origin, world axes [m/s²]
  Vec3 angular_acceleration = Vec3::Zero();  ///< (3) world axes [rad/s²]
  std::vector<RecordedLoad> loads;           ///< those that are not zero
};

/// The samples of one body, in order.
struct BodyRecord {
  std::string name;
  Vec3 gravity = Vec3::Zero();  ///< (3) that the body feels, world axes [m/s²]
  std::vector<BodySample> samples;
};

/// A rigid body, in the plane or in space: its points are `at(u)`, u from its centre of mass in its axes.
template <class B>
concept HasRigidPoints = Body<B> && (requires(B const b) { b.at(Vec3()); } || requires(B const b) { b.at(Vec2()); });

/// Takes down what acts on the bodies of interest:
///   LoadRecorder recorder(model);
///   recorder.add(link);
///   for (State const& now : simulate(model, x, …)) recorder.record(now);
///   recorder.of(link)   the record
/// With the force w = −Gᵀλ of a joint on either marker [thesis Eq. 3.3, 4.4], and those of force elements, m a = Σ F
/// holds of each sample as well as the integrator solves it.
template <class M>
class LoadRecorder {
 public:
  /// The model must outlive the recorder and must not change after.
  explicit LoadRecorder(M const& model)
      : model_(&model), system_(model, with<Entries::motion>), owner_(std::size_t(model.markers()), -1) {}

  /// From now on this body is recorded. \throws InvalidInput after the first sample, and for a body of another model.
  template <class B>
  void add(BodyHandle<B> const& handle) {
    static_assert(HasRigidPoints<B>,
                  "Loads are recorded of rigid bodies; a flexible body knows its own stress (stress/section.hpp).");
    auto const& e = model().entry(handle);
    if (!records_.empty() && !records_.front().samples.empty())
      throw InvalidInput("LoadRecorder: \"" + handle.name +
                         "\" comes after the first sample. Add all bodies before the run.");
    if (find(e.v0) >= 0) return;
    Index const slot = Index(records_.size());
    Vec3 gravity = model().gravity().g;
    if (B::world == World::plane) gravity[2] = 0.0;
    records_.push_back({e.name, gravity, {}});
    first_speeds_.push_back(e.v0);
    for (auto const& m : std::get<detail::BodyPool<B>>(model().body_pools()).markers)
      if (m.body == handle.index) owner_[std::size_t(m.published)] = slot;
  }

  /// One more sample of all of them. \throws InvalidInput for a state of another model, one that is not finite or not
  /// later than the last.
  void record(State const& x) {
    require_fitting(model(), x);
    for (BodyRecord const& r : records_)
      if (!r.samples.empty() && !(x.t > r.samples.back().t))
        throw InvalidInput("LoadRecorder: a state at " + number(x.t) + " s comes after one at " +
                           number(r.samples.back().t) + " s. Record each state once, in the order of the run.");
    system_.evaluate(x.q, x.v, x.t);
    model().for_each_body([&](auto const& e) {
      if constexpr (HasRigidPoints<std::decay_t<decltype(e.body)>>)
        if (Index const slot = find(e.v0); slot >= 0) records_[std::size_t(slot)].samples.push_back(motion(e, x));
    });
    for (RowBlock<double> const& block : system_.data().rows)
      for (RowEnd<double> const* const end : {&block.a, &block.b}) {
        if (end->marker < 0 || owner_[std::size_t(end->marker)] < 0) continue;
        double w[6];
        wrench_at(block, *end, block.multiplier(x.lambda), w);
        add_load(end->marker, w, -1.0);
      }
    system_.push_forces();
    for (Action<double> const& action : system_.data().actions) add_load(action.marker, action.w, 1.0);
  }

  /// \throws InvalidInput for a body that was not recorded, or of which there is no sample yet.
  template <class B>
  BodyRecord const& of(BodyHandle<B> const& handle) const {
    Index const slot = find(model().entry(handle).v0);
    if (slot < 0)
      throw InvalidInput("LoadRecorder: body \"" + handle.name +
                         "\" was not recorded. Add it to the recorder before the run.");
    BodyRecord const& r = records_[std::size_t(slot)];
    if (r.samples.empty())
      throw InvalidInput("LoadRecorder: there is no sample of \"" + handle.name +
                         "\" yet. Call record for each state of the run.");
    return r;
  }

 private:
  M const& model() const { return *model_; }
  Index find(Index v0) const {
    for (std::size_t i = 0; i < first_speeds_.size(); ++i)
      if (first_speeds_[i] == v0) return Index(i);
    return -1;
  }

  /// twist˙ = J v̇ + bias of the centre of mass.
  template <class Entry>
  BodySample motion(Entry const& e, State const& x) const {
    using B = std::decay_t<decltype(e.body)>;
    using U = std::conditional_t<B::world == World::plane, Vec2, Vec3>;
    Published<double> p;
    std::vector<double> jacobian(std::size_t(6 * e.body.speeds()));
    p.jacobian = jacobian.data();
    p.columns = e.body.speeds();
    e.body.template publish<double>(e.body.at(U(U::Zero())), Mat3::Identity(),
                                    detail::body_part(x.q, e.q0, e.body.coordinates()),
                                    detail::body_part(x.v, e.v0, e.body.speeds()), p);
    Vec6 const rate = p.push(x.a.data() + e.v0) + p.bias;
    return {x.t, p.frame, rate.head<3>(), rate.tail<3>(), {}};
  }

  /// sign · w = [f; m] about the marker, world axes.
  void add_load(Index marker, double const* w, double sign) {
    Index const slot = owner_[std::size_t(marker)];
    if (slot < 0 || std::all_of(w, w + 6, [](double e) { return e == 0.0; })) return;
    Vec3 const f = sign * Vec3(w[0], w[1], w[2]), m = sign * Vec3(w[3], w[4], w[5]);
    BodySample& s = records_[std::size_t(slot)].samples.back();
    Mat3 const to_body = s.frame.A.transpose();
    s.loads.push_back(
        {to_body * (system_.data().markers[std::size_t(marker)].frame.r - s.frame.r), to_body * f, to_body * m});
  }

  M const* model_;
  System system_;
  std::vector<Index> owner_;         ///< of each marker: its body's record, or −1
  std::vector<Index> first_speeds_;  ///< of the recorded bodies
  std::vector<BodyRecord> records_;
};

}  // namespace polybody
