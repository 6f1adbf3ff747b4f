#pragma once
/// \file
/// The model: typed pools of bodies, joints and forces, put together by the user and then only read.

#include <atomic>
#include <tuple>

#include <polybody/forces/gravity.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/math/time_laws.hpp>
#include <polybody/math/type_list.hpp>
#include <polybody/system/body_kernels.hpp>
#include <polybody/system/composition.hpp>
#include <polybody/system/linear_rows.hpp>
#include <polybody/system/list_refusals.hpp>
#include <polybody/system/markers.hpp>
#include <polybody/system/state.hpp>

namespace polybody {

/// Chosen only for lists that make no model: says why.
template <class BodyList, class JointList, class ForceList = Forces<>>
class Model {
  static_assert(detail::ListRefusal<BodyList>::asked && detail::ListRefusal<JointList>::asked &&
                detail::ListRefusal<ForceList>::asked);
};

/// `Model<Bodies<…>, Joints<…>, Forces<…>> model{Gravity{0, 0, -9.81}};` then `add`, `connect`, `apply`.
template <Body... Bs, class... Js, AppliedForce... Fs>
  requires Distinct<Bs...> && Distinct<Js...> && Distinct<Fs...>
class Model<Bodies<Bs...>, Joints<Js...>, Forces<Fs...>> {
 public:
  using BodyPools = std::tuple<detail::BodyPool<Bs>...>;
  using JointPools = std::tuple<std::vector<detail::JointEntry<Js>>...>;
  using ForcePools = std::tuple<std::vector<detail::ForceEntry<Fs>>...>;

  /// Some joint type brings rows into a time step, so an explicit stepper needs a stabilisation.
  static constexpr bool may_have_rows = (KeepsRows<typename Js::PolicyType> || ...) || (OwnsRows<Bs> || ...);
  /// Some joint type eliminates coordinates from a time step; and how.
  static constexpr bool eliminates = (Eliminates<typename Js::PolicyType> || ...);
  using Solution = detail::SolutionOf<typename Js::PolicyType...>;
  static constexpr bool all_rigid = (HasRigidLayout<Bs> && ...);
  static constexpr bool constant_mass = (Bs::constant_mass && ...);
  static constexpr bool has_groups = (ForceGroup<Fs> || ...);  ///< of forces
  static constexpr bool has_states = (HasStates<Fs> || ...);   ///< first-order ones, of forces

  explicit Model(Gravity const& gravity = {}) : gravity_(gravity), serial_(next_serial()) {}

  /// Adds a body; the name appears in every message about it.
  template <OneOf<Bs...> B>
  BodyHandle<B> add(B const& body, std::string name = "") {
    auto& pool = std::get<detail::BodyPool<B>>(bodies_);
    name = detail::name_or_next(std::move(name), "body", std::size_t(count_bodies_));
    BodyKernels<B, double>::add(pool, body, name, coordinates_, speeds_, OwnsRows<B> ? rows_ : -1);
    if constexpr (OwnsRows<B>) rows_ += B::own_rows;
    coordinates_ += pool.entries.back().body.coordinates();
    speeds_ += pool.entries.back().body.speeds();
    ++count_bodies_;
    return {serial_, Index(pool.entries.size()) - 1, std::move(name), pool.entries.shared()};
  }

  BodyHandle<Ground> ground() const { return {serial_, 0, "ground"}; }

  /// Joins marker a to marker b. The joint's axes are those of its geometry in world axes at the reference
  /// configuration. \throws InvalidInput naming the joint for a marker of another model, a rigid body
  /// or the ground joined to itself, or parameters that cannot be meant.
  template <OneOf<Js...> J, class A, class B>
  ElementHandle<J> connect(J const& joint, Marker<A> const& a, Marker<B> const& b, std::string name = "") {
    using G = typename J::Geometry;
    using P = typename J::PolicyType;
    using Asks = typename J::Measured;
    static_assert(MeetInOneWorld<G, A, B>,
                  "A joint of the plane joins planar bodies and a joint of space joins spatial ones; the ground "
                  "belongs to both.");
    static_assert(HasJointCoordinates<P, G>,
                  "Recursive needs a joint whose motion has coordinates, such as Revolute, Prismatic, Spherical or "
                  "Universal; a Distance or a Gear has none. Use Constraint for it.");
    static_assert(!MakesJointCoordinates<P> || (MayBeEliminated<P, A> && MayBeEliminated<P, B>),
                  "Recursive makes joint coordinates between rigid bodies and the ground: Rigid<> in space, "
                  "planar::Rigid in the plane. Use another policy for joints of other bodies.");
    static_assert(
        !LinearInCoordinates<P> || (MayBeEliminated<P, A> && MayBeEliminated<P, B>),
        "AncfLinear eliminates coordinates, so both markers must be linear in them: ANCF bodies and the ground "
        "are, Rigid, Ffr and Lrvf in space are not. Use Constraint there.");
    static_assert(HasLinearRows<P, G>,
                  "AncfLinear knows Spherical, Revolute and Weld; other joints are not linear in the coordinates.");
    static_assert(
        TellsEnoughFirst<J, A> && TellsEnoughSecond<J, B>,
        "This joint needs more than the marker tells (a full frame, say, of a body that only "
        "publishes a point or a tangent). Use a joint that needs less, such as Spherical; a cable is clamped by a "
        "Revolute about its tangent, with the cable's marker second.");
    auto& pool = std::get<std::vector<detail::JointEntry<J>>>(joints_);
    name = detail::name_or_next(std::move(name), G::name, pool.size());
    require_own(a.model, name);
    require_own(b.model, name);
    detail::require_apart(a, b, name);
    Mat3 const triad = detail::checked_triad(joint, name);
    Mat3 const axes_a = reference_axes(a), axes_b = reference_axes(b);
    if constexpr (!LinearInCoordinates<P> && B::observes == Observes::axis && needs_of_second<Asks>() == Observes::axis)
      detail::require_along_tangent(axes_b, triad, name);
    detail::require_told(a, Asks::needs, name);
    detail::require_told(b, needs_of_second<Asks>(), name);
    if constexpr (LinearInCoordinates<P>) {  // before a marker is published: it may refuse
      LinearRows rows{.name = name, .row = rows_};
      detail::fill_linear_rows<G>(linear_side(a, B::world, rows.a, name), linear_side(b, A::world, rows.b, name),
                                  triad.col(2), rows);
      linear_rows_.push_back(std::move(rows));
    }
    Index const pa = publish_at(a, transposed_product(axes_a, triad));
    Index const pb = publish_at(b, transposed_product(axes_b, triad));
    detail::JointEntry<J> entry{joint, pa, pb, -1, name};
    if constexpr (LinearInCoordinates<P>) {
      entry.linear = Index(linear_rows_.size()) - 1;
      entry.rows = linear_rows_.back().rows();
    } else if constexpr (AddsRows<P>) {
      entry.rows = J::rows;
    }
    if constexpr (AddsRows<P>) {
      entry.row = rows_;
      rows_ += entry.rows;
      for (Index i = polybody::velocity_rows<G>(); i > 0; --i) velocity_rows_.push_back(rows_ - i);
    }
    pool.push_back(std::move(entry));
    return {serial_, Index(pool.size()) - 1, std::move(name)};
  }

  /// Applies a force element to one marker, or between two. \throws InvalidInput as `connect`.
  template <OneOf<Fs...> F, class A>
    requires(F::markers == 1)
  ElementHandle<F> apply(F const& force, Marker<A> const& a, std::string name = "") {
    return apply(force, std::tuple(a), std::move(name));
  }
  template <OneOf<Fs...> F, class A, class B>
    requires(F::markers == 2)
  ElementHandle<F> apply(F const& force, Marker<A> const& a, Marker<B> const& b, std::string name = "") {
    return apply(force, std::tuple(a, b), std::move(name));
  }
  /// Applies a force element to the markers of a tuple. \throws InvalidInput as `connect`.
  template <OneOf<Fs...> F, class... Ms>
    requires(F::markers == sizeof...(Ms))
  ElementHandle<F> apply(F const& force, std::tuple<Ms...> const& markers, std::string name = "") {
    static_assert(
        tell_enough<F, Ms...>(),
        "This force needs more than the marker tells; a moment needs a marker with a frame or a tangent, a plane one "
        "with a frame.");
    auto& pool = std::get<std::vector<detail::ForceEntry<F>>>(forces_);
    name = detail::name_or_next(std::move(name), "force", pool.size());
    force.check("\"" + name + "\"");
    detail::ForceEntry<F> entry{force, {}, name};
    std::size_t k = 0;
    std::apply(
        [&](auto const&... m) {
          (require_own(m.model, name), ...);
          (detail::require_told(m, F::needs, name), ...);
          ((entry.markers[k++] = publish_at(m, Mat3::Identity())), ...);
        },
        markers);
    entry.state = states_;
    states_ += states_of<F>();
    pool.push_back(std::move(entry));
    return {serial_, Index(pool.size()) - 1, std::move(name)};
  }

  /// Applies a group of forces to its many markers; `pair_with` brings the few in. \throws InvalidInput as `connect`.
  template <OneOf<Fs...> F, class A>
    requires ForceGroup<F>
  ElementHandle<F> apply(F const& group, std::vector<Marker<A>> const& many, std::string name = "") {
    static_assert(Marker<A>::observes >= F::needs, "This force needs more than the marker tells.");
    auto& pool = std::get<std::vector<detail::ForceEntry<F>>>(forces_);
    name = detail::name_or_next(std::move(name), "group", pool.size());
    group.check("\"" + name + "\"");
    detail::ForceEntry<F> entry{group, {}, name};
    for (Marker<A> const& m : many) {
      require_own(m.model, name);
      detail::require_told(m, F::needs, name);
    }
    for (Marker<A> const& m : many) entry.markers.push_back(publish_at(m, Mat3::Identity()));
    entry.force.set_many(Index(many.size()));
    pool.push_back(std::move(entry));
    return {serial_, Index(pool.size()) - 1, std::move(name)};
  }
  /// One of the few that act on all of the many, by one of the group's laws. \throws InvalidInput as `connect`.
  template <OneOf<Fs...> F, class Law, class A>
    requires ForceGroup<F>
  void pair_with(ElementHandle<F> const& group, Law const& law, Marker<A> const& one, std::string name = "") {
    static_assert(Marker<A>::observes >= needs_of_second<Law>(), "This force needs more than the marker tells.");
    require_own(group);
    require_own(one.model, group.name);
    auto& entry = std::get<std::vector<detail::ForceEntry<F>>>(forces_)[std::size_t(group.index)];
    name = detail::name_or_next(std::move(name), "opponent", entry.markers.size() - std::size_t(entry.force.many()));
    law.check("\"" + group.name + "\", \"" + name + "\"");
    detail::require_told(one, needs_of_second<Law>(), group.name);
    entry.markers.push_back(publish_at(one, Mat3::Identity()));
    entry.force.pair_with(law, Index(entry.markers.size()) - 1, std::move(name));
  }

  /// The undeformed model as placed, at rest, t = 0, with the initial states of its forces.
  State reference_state() const {
    State x{VecX::Zero(coordinates_), VecX::Zero(speeds()), VecX::Zero(speeds()), VecX::Zero(rows_), 0.0, {}};
    for_each_body([&](auto const& e) { e.body.reference(detail::body_part_of(x.q, e.q0, e.body.coordinates())); });
    if constexpr (has_states)
      for_each_force([&](auto const& e) {
        if constexpr (requires { e.force.initial_states(); }) {
          auto const z = e.force.initial_states();
          std::copy(z.begin(), z.end(), x.v.data() + speeds_ + e.state);
        }
      });
    return x;
  }

  /// The first-order states of a force element in x. \throws InvalidInput as `entry`.
  template <OneOf<Fs...> F>
    requires HasStates<F>
  std::span<double, F::states> states(State& x, ElementHandle<F> const& force) const {
    return std::span<double, F::states>(x.v.data() + speeds_ + entry(force).state, F::states);
  }
  template <OneOf<Fs...> F>
    requires HasStates<F>
  std::span<double const, F::states> states(State const& x, ElementHandle<F> const& force) const {
    return std::span<double const, F::states>(x.v.data() + speeds_ + entry(force).state, F::states);
  }

  /// Gives a body the speeds of a rigid motion: `v0` is the velocity of the body-fixed point that is at the
  /// world's origin [m/s], `omega` the angular velocity [rad/s], both in world axes.
  template <OneOf<Bs...> B>
  void set_velocity(State& x, BodyHandle<B> const& handle, Vec3 const& v0, Vec3 const& omega) const {
    auto const& e = entry(handle);
    e.body.rigid_velocity(detail::body_part(x.q, e.q0, e.body.coordinates()), v0, omega,
                          detail::body_part_of(x.v, e.v0, e.body.speeds()));
  }

  Gravity const& gravity() const { return gravity_; }
  Index coordinates() const { return coordinates_; }
  /// Speeds of the bodies, and first-order states of forces behind them.
  Index speeds() const { return speeds_ + states_; }
  Index states() const { return states_; }
  Index rows() const { return rows_; }
  /// Those of the rows that hold speeds and no positions, ascending.
  std::vector<Index> const& velocity_rows() const { return velocity_rows_; }
  Index markers() const { return markers_; }
  Index jacobian_size() const { return jacobian_size_; }
  Index body_count() const { return count_bodies_; }
  std::uint64_t serial() const { return serial_; }

  BodyPools const& body_pools() const { return bodies_; }
  JointPools const& joint_pools() const { return joints_; }
  ForcePools const& force_pools() const { return forces_; }
  std::vector<detail::GroundMarker> const& ground_markers() const { return ground_; }
  std::vector<LinearRows> const& linear_rows() const { return linear_rows_; }

  /// \throws InvalidInput when the handle is of another model, or made by default.
  template <OneOf<Bs...> B>
  auto const& entry(BodyHandle<B> const& handle) const {
    require_own(handle);
    return std::get<detail::BodyPool<B>>(bodies_).entries[std::size_t(handle.index)];
  }
  template <OneOf<Js...> J>
  auto const& entry(ElementHandle<J> const& handle) const {
    require_own(handle);
    return std::get<std::vector<detail::JointEntry<J>>>(joints_)[std::size_t(handle.index)];
  }
  template <OneOf<Fs...> F>
  auto const& entry(ElementHandle<F> const& handle) const {
    require_own(handle);
    return std::get<std::vector<detail::ForceEntry<F>>>(forces_)[std::size_t(handle.index)];
  }
  /// Calls f(entry) for every body, in the order of the types.
  template <class F>
  void for_each_body(F&& f) const {
    std::apply([&](auto const&... pool) { (for_each_in(pool.entries, f), ...); }, bodies_);
  }
  template <class F>
  void for_each_joint(F&& f) const {
    std::apply([&](auto const&... pool) { (for_each_in(pool, f), ...); }, joints_);
  }
  template <class F>
  void for_each_force(F&& f) const {
    std::apply([&](auto const&... pool) { (for_each_in(pool, f), ...); }, forces_);
  }

  /// \throws InvalidInput when `serial` is another model's.
  void require_own(std::uint64_t serial, std::string const& what) const {
    if (serial != serial_) detail::refuse_marker_of_another_model(what);
  }
  /// \throws InvalidInput for a handle of another model, or one made by default.
  template <class Handle>
  void require_own(Handle const& handle) const {
    detail::require_filled(handle.model);
    require_own(handle.model, handle.name);
  }

 private:
  template <class Pool, class F>
  static void for_each_in(Pool const& pool, F& f) {
    for (auto const& e : pool) f(e);
  }
  static std::uint64_t next_serial() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
  }

  template <class B>
  Mat3 reference_axes(Marker<B> const& m) const {
    if constexpr (std::is_same_v<B, Ground>) {
      return m.point.axes;
    } else {
      return BodyKernels<B, double>::reference_axes(std::get<detail::BodyPool<B>>(bodies_), m);
    }
  }

  template <class B>
  Index publish_at(Marker<B> const& m, Mat3 const& axes) {
    if constexpr (std::is_same_v<B, Ground>) {
      ground_.push_back({{m.point.origin, product(m.point.axes, axes)}, markers_});
    } else {
      jacobian_size_ += BodyKernels<B, double>::add_marker(std::get<detail::BodyPool<B>>(bodies_), m, axes, markers_);
    }
    return markers_++;
  }

  /// The linear point of a marker, and where its body stands; the ground takes the world of the other.
  /// \throws InvalidInput naming the joint `what` for a point that is not linear in the coordinates.
  template <class B>
  detail::LinearPoint linear_side(Marker<B> const& m, World other, LinearSide& side, std::string const& what) const {
    if constexpr (std::is_same_v<B, Ground>) {
      return detail::linear_ground(m.point, other == World::plane ? 2 : 3);
    } else {
      auto const& e = std::get<detail::BodyPool<B>>(bodies_).entries[std::size_t(m.body)];
      side.q0 = e.q0 + e.body.first_column(m.point);
      side.v0 = e.v0 + e.body.first_column(m.point);
      try {
        return detail::linear_point(e.body, m.point);
      } catch (InvalidInput const& error) {
        throw InvalidInput("\"" + what + "\": " + error.what() + " Use Constraint here.");
      }
    }
  }

  Gravity gravity_;
  std::uint64_t serial_;
  BodyPools bodies_;
  JointPools joints_;
  ForcePools forces_;
  std::vector<detail::GroundMarker> ground_;
  std::vector<LinearRows> linear_rows_;
  std::vector<Index> velocity_rows_;
  Index coordinates_ = 0, speeds_ = 0, states_ = 0, rows_ = 0, markers_ = 0, jacobian_size_ = 0, count_bodies_ = 0;
};

}  // namespace polybody
