#pragma once
/// \file
/// The model: typed pools of bodies, joints and forces, put together by the user and then only read.

#include <tuple>

#include <polybody/math/sequence.hpp>
#include <polybody/math/type_list.hpp>
#include <polybody/system/connections.hpp>
#include <polybody/system/list_refusals.hpp>
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
  requires Distinct<Bs...> && Distinct<Js...> && Distinct<Fs...> && detail::no_const<Bs..., Js..., Fs...>
class Model<Bodies<Bs...>, Joints<Js...>, Forces<Fs...>> {
 public:
  using BodyPools = std::tuple<detail::BodyPool<Bs>...>;               ///< a pool for each type of body
  using JointPools = std::tuple<Sequence<detail::JointEntry<Js>>...>;  ///< a pool for each type of joint
  using ForcePools = std::tuple<Sequence<detail::ForceEntry<Fs>>...>;  ///< a pool for each type of force element

  /// Some joint type brings rows into a time step, so an explicit stepper needs a stabilisation.
  static constexpr bool may_have_rows =
      (MultiplierPolicy<typename Js::PolicyType> || ...) || (HasOwnEquations<Bs> || ...);
  /// Some joint type eliminates coordinates from a time step; and how.
  static constexpr bool eliminates = (EliminatingPolicy<typename Js::PolicyType> || ...);
  using Solution = detail::SolutionOf<typename Js::PolicyType...>;   ///< void, or how joint coordinates are solved for
  static constexpr bool all_rigid = (HasRigidLayout<Bs> && ...);     ///< bodies of all types are rigid
  static constexpr bool constant_mass = (Bs::constant_mass && ...);  ///< M of no body type depends on q
  static constexpr bool has_groups = (ForceGroup<Fs> || ...);        ///< of forces
  static constexpr bool has_states = (HasStates<Fs> || ...);         ///< first-order states of forces

  /// A model without parts. Gravity in world axes [m/s²]; none by default.
  explicit Model(Gravity const& gravity = {}) : parts_(gravity) {}

  /// Adds a body; the name appears in every message about it, and no other body has it. Without a name it gets one.
  template <OneOf<Bs...> B>
  BodyHandle<B> add(B const& body, std::string name = "") {
    return detail::add_body(parts_, std::get<detail::BodyPool<B>>(bodies_), body, std::move(name));
  }

  /// What does not move: `model.ground().at(r)` is a marker at r, world axes [m].
  BodyHandle<Ground> ground() const { return {parts_.serial(), 0, "ground"}; }

  /// Joins marker a to marker b. The joint's axes are those of its geometry in world axes at the reference
  /// configuration. \throws InvalidInput naming the joint for a marker of another model, a rigid body
  /// or the ground joined to itself, or parameters that cannot be meant.
  template <OneOf<Js...> J, class A, class B>
  ElementHandle<J> connect(J const& joint, Marker<A> const& a, Marker<B> const& b, std::string name = "") {
    detail::require_pairing<J, A, B>();
    return detail::add_joint(parts_, std::get<Sequence<detail::JointEntry<J>>>(joints_), joint, pooled(a), pooled(b),
                             std::move(name));
  }

  /// Applies a force element to one marker, or between two. \throws InvalidInput as `connect`.
  template <OneOf<Fs...> F, class A>
    requires(F::markers == 1)
  ElementHandle<F> apply(F const& force, Marker<A> const& a, std::string name = "") {
    return apply(force, std::tuple(a), std::move(name));
  }
  /// Between two markers: the first one is that of the force's first wrench.
  template <OneOf<Fs...> F, class A, class B>
    requires(F::markers == 2)
  ElementHandle<F> apply(F const& force, Marker<A> const& a, Marker<B> const& b, std::string name = "") {
    return apply(force, std::tuple(a, b), std::move(name));
  }
  /// Applies a force element to the markers of a tuple. \throws InvalidInput as `connect`.
  template <OneOf<Fs...> F, class... Ms>
    requires(F::markers == sizeof...(Ms))
  ElementHandle<F> apply(F const& force, std::tuple<Ms...> const& markers, std::string name = "") {
    static_assert(tell_enough<F, Ms...>(),
                  "This force needs a marker with more than a point; a moment needs a marker with axes or a tangent, a "
                  "plane needs a marker with axes.");
    return std::apply(
        [&](auto const&... m) { return detail::add_force(parts_, pool_of<F>(), force, std::move(name), pooled(m)...); },
        markers);
  }

  /// Applies a group of forces to its many markers; `add_partner` brings the few in. \throws InvalidInput as `connect`.
  template <OneOf<Fs...> F, class A>
    requires ForceGroup<F>
  ElementHandle<F> apply(F const& group, std::vector<Marker<A>> const& many, std::string name = "") {
    static_assert(Marker<A>::observes >= F::needs,
                  "This force needs a marker with axes or a tangent, but this body provides less.");
    Sequence<detail::PooledMarker<A>> pooled_many;
    for (Marker<A> const& m : many) pooled_many.push_back(pooled(m));
    return detail::add_group(parts_, pool_of<F>(), group, pooled_many, std::move(name));
  }
  /// One of the few that act on all of the many, by `law`, one of the group's. \throws InvalidInput as `connect`.
  template <OneOf<Fs...> F, class Law, class A>
    requires ForceGroup<F>
  void add_partner(ElementHandle<F> const& group, Law const& law, Marker<A> const& one, std::string name = "") {
    static_assert(Marker<A>::observes >= needs_of_second<Law>(),
                  "This force needs a marker with axes or a tangent, but this body provides less.");
    (void)entry(group);
    detail::add_opponent(parts_, pool_of<F>()[std::size_t(group.index)], law, pooled(one), std::move(name));
  }

  /// The undeformed model as placed, at rest, t = 0, with the initial states of its forces.
  State reference_state() const {
    State x{VecX::Zero(coordinates()), VecX::Zero(velocities()), VecX::Zero(velocities()), VecX::Zero(rows()), 0.0, {}};
    for_each_body([&](auto const& e) { e.body.reference(detail::body_part_of(x.q, e.q0, e.body.coordinates())); });
    if constexpr (has_states)
      for_each_force([&](auto const& e) {
        if constexpr (requires { e.force.initial_states(); }) {
          auto const z = e.force.initial_states();
          std::copy(z.begin(), z.end(), x.v.data() + parts_.velocities + e.state);
        }
      });
    return x;
  }

  /// The first-order states of a force element in x. \throws InvalidInput as `entry`.
  template <OneOf<Fs...> F>
    requires HasStates<F>
  std::span<double, F::states> states(State& x, ElementHandle<F> const& force) const {
    return states_in<F>(x.v, entry(force));
  }
  /// The same of a state that is not written.
  template <OneOf<Fs...> F>
    requires HasStates<F>
  std::span<double const, F::states> states(State const& x, ElementHandle<F> const& force) const {
    return states_in<F>(x.v, entry(force));
  }
  template <OneOf<Fs...> F>
  std::span<double const, F::states> states(State&& x, ElementHandle<F> const& force) const = delete;  ///< x would end

  /// Gives a body the speeds of a rigid motion: `v0` is the velocity of the body-fixed point that is at the
  /// world's origin [m/s], `omega` the angular velocity [rad/s], both in world axes. \throws InvalidInput for a handle
  /// or state of another model.
  template <OneOf<Bs...> B>
  void set_velocity(State& x, BodyHandle<B> const& handle, Vec3 const& v0, Vec3 const& omega) const {
    auto const& e = entry(handle);
    e.body.rigid_velocity(detail::checked_part(std::as_const(x.q), e.q0, e.body.coordinates()), v0, omega,
                          detail::checked_part(x.v, e.v0, e.body.velocities()));
  }

  Gravity const& gravity() const { return parts_.gravity; }  ///< [m/s²], world axes
  Index coordinates() const { return parts_.coordinates; }   ///< nq: coordinates of all bodies
  /// Speeds of the bodies, and first-order states of forces behind them.
  Index velocities() const { return parts_.velocities + parts_.states; }
  Index states() const { return parts_.states; }  ///< first-order states of forces
  Index rows() const { return parts_.rows; }      ///< how many rows joints and bodies bring
  /// Those of the rows that hold speeds and no positions, ascending.
  Sequence<Index> const& nonholonomic_equations() const { return parts_.nonholonomic_equations; }
  Index markers() const { return parts_.markers; }              ///< how many markers there are
  Index jacobian_size() const { return parts_.jacobian_size; }  ///< numbers in their dense Jacobians
  Index body_count() const { return parts_.bodies; }            ///< how many bodies, the ground not counted
  std::uint64_t serial() const { return parts_.serial(); }      ///< number that the handles of the model carry
  /// Serial numbers of the models that it was copied from.
  Sequence<std::uint64_t> const& ancestors() const { return parts_.origin.ancestors(); }
  ModelWatch watch() const { return parts_.origin.watch(); }  ///< notices later changes of the model

  /// Bodies, joints and forces as they are stored, by types.
  BodyPools const& body_pools() const { return bodies_; }
  JointPools const& joint_pools() const { return joints_; }                               ///< see `body_pools`
  ForcePools const& force_pools() const { return forces_; }                               ///< see `body_pools`
  Sequence<detail::GroundMarker> const& ground_markers() const { return parts_.ground; }  ///< markers on the ground
  /// Rows of joints that are linear in coordinates.
  Sequence<LinearConstraints> const& linear_rows() const { return parts_.linear_rows; }

  /// \throws InvalidInput when the handle is of another model, or made by default.
  template <OneOf<Bs...> B>
  auto const& entry(BodyHandle<B> const& handle) const {
    return detail::own_entry(std::get<detail::BodyPool<B>>(bodies_).entries, handle);
  }
  /// A joint as it is stored. \throws InvalidInput as above.
  template <OneOf<Js...> J>
  auto const& entry(ElementHandle<J> const& handle) const {
    return detail::own_entry(std::get<Sequence<detail::JointEntry<J>>>(joints_), handle);
  }
  /// A force element as it is stored. \throws InvalidInput as above.
  template <OneOf<Fs...> F>
  auto const& entry(ElementHandle<F> const& handle) const {
    return detail::own_entry(std::get<Sequence<detail::ForceEntry<F>>>(forces_), handle);
  }
  /// Calls f(entry) for every body, in the order of the types.
  template <class F>
  void for_each_body(F&& f) const {
    std::apply([&](auto const&... pool) { (for_each_in(pool.entries, f), ...); }, bodies_);
  }
  /// Calls f(entry) for every joint, in the order of the types.
  template <class F>
  void for_each_joint(F&& f) const {
    std::apply([&](auto const&... pool) { (for_each_in(pool, f), ...); }, joints_);
  }
  /// Calls f(entry) for every force element, in the order of the types.
  template <class F>
  void for_each_force(F&& f) const {
    std::apply([&](auto const&... pool) { (for_each_in(pool, f), ...); }, forces_);
  }

  /// \throws InvalidInput naming `what` for a marker of another model.
  template <class B>
  void require_own(Marker<B> const& marker, std::string const& what) const {
    if constexpr (std::is_same_v<B, Ground>)
      parts_.require_own_ground(marker.model, what);
    else if (!detail::holds(std::get<detail::BodyPool<B>>(bodies_).entries, marker.body, marker.model))
      detail::refuse_marker_of_another_model(what);
  }

 private:
  template <class, class, class>
  friend class Subassembly;

  template <class F, class Vector>
  auto states_in(Vector& v, detail::ForceEntry<F> const& e) const {
    return detail::checked_part(v, parts_.velocities + e.state, F::states).template first<std::size_t(F::states)>();
  }
  template <class Pool, class F>
  static void for_each_in(Pool const& pool, F& f) {
    for (auto const& e : pool) f(e);
  }
  template <class F>
  Sequence<detail::ForceEntry<F>>& pool_of() {
    return std::get<Sequence<detail::ForceEntry<F>>>(forces_);
  }
  template <class B>
  detail::PooledMarker<B> pooled(Marker<B> const& m) {
    if constexpr (std::is_same_v<B, Ground>)
      return {m};
    else
      return {m, std::get<detail::BodyPool<B>>(bodies_)};
  }

  detail::ModelParts parts_;
  BodyPools bodies_;
  JointPools joints_;
  ForcePools forces_;
};

}  // namespace polybody
