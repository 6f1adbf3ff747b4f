#pragma once
/// \file
/// Model: typed pools of bodies, joints and forces. The user adds bodies, joints and forces; the library only reads
/// them.

#include <tuple>

#include <polybody/forces/force_element.hpp>  // first: a refusal then has a short chain of includes

#include <polybody/math/sequence.hpp>
#include <polybody/math/type_list.hpp>
#include <polybody/system/connections.hpp>
#include <polybody/system/joint_forces.hpp>
#include <polybody/system/list_refusals.hpp>
#include <polybody/system/state.hpp>

namespace polybody {

namespace detail {
template <class M, Capabilities wanted>
class IslandMaker;
}

/// Primary template for invalid lists of types: a static assertion gives the reason.
template <class BodyList, class JointList = Joints<>, class ForceList = Forces<>>
class Model {
  static_assert(detail::position_of_list<BodyList> == 1 && detail::position_of_list<JointList> == 2 &&
                    detail::position_of_list<ForceList> == 3,
                "The lists of a model must have this order: Model<Bodies<...>, Joints<...>, Forces<...>>.");
  static_assert(detail::ListRefusal<BodyList>::checked && detail::ListRefusal<JointList>::checked &&
                detail::ListRefusal<ForceList>::checked);
};

/// Bodies, joints and forces of one mechanism: `Model<Bodies<…>, Joints<…>, Forces<…>> model{Gravity{0, 0, -9.81}};`.
/// `add`, `connect` and `apply` add the parts.
template <Body... Bs, class... Js, AppliedForce... Fs>
  requires Distinct<Bs...> && Distinct<Js...> && Distinct<Fs...> && detail::no_const<Bs..., Js..., Fs...> &&
           (JointType<Js> && ...)
class Model<Bodies<Bs...>, Joints<Js...>, Forces<Fs...>> {
 public:
  using BodyPools = std::tuple<detail::BodyPool<Bs>...>;               ///< one pool for each type of body
  using JointPools = std::tuple<Sequence<detail::JointEntry<Js>>...>;  ///< one pool for each type of joint
  using ForcePools = std::tuple<Sequence<detail::ForceEntry<Fs>>...>;  ///< one pool for each type of force element

  /// True if a joint or body type has constraint equations in a time step. An explicit integrator then needs a
  /// constraint stabilisation.
  static constexpr bool may_have_rows =
      (MultiplierPolicy<typename Js::PolicyType> || ...) || (HasOwnEquations<Bs> || ...);
  /// True if a joint type eliminates coordinates from a time step.
  static constexpr bool eliminates = (EliminatingPolicy<typename Js::PolicyType> || ...);
  using Solution = detail::SolutionOf<typename Js::PolicyType...>;   ///< solution method for joint coordinates, or void
  static constexpr bool all_rigid = (HasRigidLayout<Bs> && ...);     ///< true if all body types are rigid
  static constexpr bool constant_mass = (Bs::constant_mass && ...);  ///< true if M of no body type depends on q
  static constexpr bool has_groups = (ForceGroup<Fs> || ...);        ///< true if there is a type of force group
  static constexpr bool has_states = (HasStates<Fs> || ...);         ///< true if a force type has first-order states

  /// Constructs a model without parts. Gravity is in world axes [m/s²] and zero by default.
  explicit Model(Gravity const& gravity = {}) : parts_(gravity) {}

  /// Adds a body. Messages contain its name, which must be unique among the bodies. If the name is empty, a name is
  /// generated. \throws InvalidInput for a duplicate name.
  template <OneOf<Bs...> B>
  BodyHandle<B> add(B const& body, std::string name = "") {
    return detail::add_body(parts_, std::get<detail::BodyPool<B>>(bodies_), body, std::move(name));
  }
  /// Refuses a body whose type is not in the model's list. Because of the deduced return type, this message is the
  /// first compiler error.
  template <class B>
    requires(!OneOf<B, Bs...>)
  auto add(B const&, std::string const& = "") {
    detail::refuse_body<B>();
    return BodyHandle<B>{};
  }

  /// Handle of the ground. `model.ground().at(r)` is a marker at r in world axes [m].
  BodyHandle<Ground> ground() const { return {parts_.serial(), 0, "ground"}; }

  /// Joins marker a to marker b. The axes in the joint's geometry refer to world axes in the reference configuration.
  /// \throws InvalidInput naming the joint for a duplicate name, for a marker of another model, for two markers on one
  /// rigid body or on the ground, and for invalid parameters.
  template <OneOf<Js...> J, class A, class B>
  ElementHandle<J> connect(J const& joint, Marker<A> const& a, Marker<B> const& b, std::string name = "") {
    detail::require_pairing<J, A, B>();
    return detail::add_joint(parts_, std::get<Sequence<detail::JointEntry<J>>>(joints_), joint, pooled(a), pooled(b),
                             std::move(name));
  }
  /// Refuses a joint whose type is not in the model's list, for any `others`.
  template <class J, class... Rest>
    requires(!OneOf<J, Js...>)
  auto connect(J const&, [[maybe_unused]] Rest const&... others) {
    detail::refuse_joint<J>();
    return ElementHandle<J>{};
  }
  /// Refuses a joint unless exactly two of the `others` are markers.
  template <OneOf<Js...> J, class... Rest>
    requires(detail::marker_count<Rest...> != 2)
  auto connect(J const&, [[maybe_unused]] Rest const&... others) {
    detail::refuse_joint_ends<J>();
    return ElementHandle<J>{};
  }

  /// Applies a force element to one marker. \throws InvalidInput for a duplicate name, a marker of another model or
  /// invalid parameters.
  template <OneOf<Fs...> F, class A>
    requires(F::markers == 1)
  ElementHandle<F> apply(F const& force, Marker<A> const& a, std::string name = "") {
    return apply(force, std::tuple(a), std::move(name));
  }
  /// Applies a force element between two markers. Its first wrench acts on marker a. \throws InvalidInput for a
  /// duplicate name, a marker of another model or invalid parameters.
  template <OneOf<Fs...> F, class A, class B>
    requires(F::markers == 2)
  ElementHandle<F> apply(F const& force, Marker<A> const& a, Marker<B> const& b, std::string name = "") {
    return apply(force, std::tuple(a, b), std::move(name));
  }
  /// Applies a force element to the markers of a tuple. \throws InvalidInput for a duplicate name, a marker of another
  /// model or invalid parameters.
  template <OneOf<Fs...> F, class... Ms>
    requires(F::markers == sizeof...(Ms))
  ElementHandle<F> apply(F const& force, std::tuple<Ms...> const& markers, std::string name = "") {
    detail::require_kinematics<tell_enough<F, Ms...>()>();
    return std::apply(
        [&](auto const&... m) { return detail::add_force(parts_, pool_of<F>(), force, std::move(name), pooled(m)...); },
        markers);
  }

  /// Applies a force element to the coordinate of a joint, between the markers of the joint. The force acts on the
  /// second marker in the direction of a growing angle or translation. \throws InvalidInput for a duplicate name, a
  /// handle of another model, invalid parameters, or a marker of the joint without axes.
  template <OneOf<Fs...> F, OneOf<Js...> J>
    requires JointForce<F>
  ElementHandle<F> apply(F const& force, ElementHandle<J> const& joint, std::string name = "") {
    constexpr JointMotion::Kind kind = F::Coordinate::motion;
    detail::require_joint_coordinate<kind, typename J::Geometry>();
    auto const& e = entry(joint);
    int const axis = detail::axis_of_coordinate(e, kind, name);
    if constexpr (requires { typename F::FollowedJoint; }) {
      F follower = force;
      if constexpr (detail::require_followed<F, J, eliminates>()) follower.follow(e.joint, axis);
      auto const handle =
          detail::add_joint_force(parts_, pool_of<F>(), follower, std::move(name), bodies_, {{e.a, e.b}, axis});
      pool_of<F>().back().row = e.row;
      return handle;
    } else {
      return detail::add_joint_force(parts_, pool_of<F>(), force, std::move(name), bodies_, {{e.a, e.b}, axis});
    }
  }

  /// Applies a force group to its many markers. `add_partner` adds contact partners. \throws InvalidInput for a
  /// duplicate name, a marker of another model or invalid parameters.
  template <OneOf<Fs...> F, class A>
    requires(ForceGroup<F> && !SearchingForceGroup<F>)
  ElementHandle<F> apply(F const& group, std::vector<Marker<A>> const& many, std::string name = "") {
    detail::require_kinematics<(Marker<A>::observes >= F::needs)>();
    Sequence<detail::PooledMarker<A>> pooled_many;
    for (Marker<A> const& m : many) pooled_many.push_back(pooled(m));
    return detail::add_group(parts_, pool_of<F>(), group, pooled_many, std::move(name));
  }
  /// Applies a contact set. `add_member` adds its members. \throws InvalidInput for a duplicate name or invalid
  /// parameters.
  template <OneOf<Fs...> F>
    requires SearchingForceGroup<F>
  ElementHandle<F> apply(F const& set, std::string name = "") {
    return detail::add_group(parts_, pool_of<F>(), set, Sequence<detail::PooledMarker<Ground>>{}, std::move(name));
  }
  /// Adds a member to a contact set: a shape at the marker `at`. Returns the number of the member, for `exclude`.
  /// Members of the same positive `group` have no contact with each other. \throws InvalidInput for a handle or marker
  /// of another model or an invalid shape.
  template <OneOf<Fs...> F, class S, class A>
    requires SearchingForceGroup<F>
  Index add_member(ElementHandle<F> const& set, S const& shape, Marker<A> const& at, std::string name = "",
                   int group = 0) {
    detail::require_kinematics<(Marker<A>::observes >= S::needs)>();
    return detail::add_member(parts_, detail::own_entry(pool_of<F>(), set), shape, pooled(at), std::move(name), group);
  }
  /// Excludes the contact of two members of a contact set, by their numbers m and n. \throws InvalidInput for a handle
  /// of another model or an invalid number.
  template <OneOf<Fs...> F>
    requires SearchingForceGroup<F>
  void exclude(ElementHandle<F> const& set, Index m, Index n) {
    detail::exclude_members(parts_, detail::own_entry(pool_of<F>(), set), m, n);
  }
  /// Refuses a force whose type is not in the model's list, for any `others`.
  template <class F, class... Rest>
    requires(!OneOf<F, Fs...>)
  auto apply(F const&, [[maybe_unused]] Rest const&... others) {
    detail::refuse_force<F>();
    return ElementHandle<F>{};
  }
  /// Refuses a force element unless the second argument and `others` contain exactly its one or two markers, or a tuple
  /// of its markers.
  template <OneOf<Fs...> F, class First, class... Rest>
    requires(!ForceGroup<F> && !detail::is_marker_tuple<First> &&
             !(JointForce<F> && detail::is_joint_handle<First, Js...> && sizeof...(Rest) <= 1) &&
             (F::markers > 2 || F::markers != detail::marker_count<First, Rest...>))
  auto apply(F const&, First const&, [[maybe_unused]] Rest const&... others) {
    detail::refuse_force_ends<F>();
    return ElementHandle<F>{};
  }
  /// Adds a contact partner at marker `one`, which interacts with all of the group's many markers by `law`. The group
  /// must list the type of `law`. \throws InvalidInput for a handle or marker of another model or invalid parameters.
  template <OneOf<Fs...> F, class Law, class A>
    requires(ForceGroup<F> && !SearchingForceGroup<F>)
  void add_partner(ElementHandle<F> const& group, Law const& law, Marker<A> const& one, std::string name = "") {
    detail::require_kinematics<(Marker<A>::observes >= needs_of_second<Law>())>();
    detail::add_contact_partner(parts_, detail::own_entry(pool_of<F>(), group), law, pooled(one), std::move(name));
  }

  /// Reference state: undeformed bodies as placed, at rest, t = 0, with the initial states of the forces.
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

  /// First-order states of a force element in x. \throws InvalidInput for a default-constructed handle, a handle of
  /// another model, or a state that is too short.
  template <OneOf<Fs...> F>
    requires HasStates<F>
  std::span<double, F::states> states(State& x, ElementHandle<F> const& force) const {
    return states_in<F>(x.v, entry(force));
  }
  /// Overload for a constant state.
  template <OneOf<Fs...> F>
    requires HasStates<F>
  std::span<double const, F::states> states(State const& x, ElementHandle<F> const& force) const {
    return states_in<F>(x.v, entry(force));
  }
  /// Refuses a temporary state.
  template <OneOf<Fs...> F>
  std::span<double const, F::states> states(State&& x, ElementHandle<F> const& force) const = delete;

  /// Sets the generalised velocities of a body to those of a rigid motion. `v0` is the velocity of the body-fixed point
  /// at the world's origin [m/s], `omega` the angular velocity [rad/s], both in world axes. \throws InvalidInput for a
  /// handle of another model, or if the state is too short.
  template <OneOf<Bs...> B>
  void set_velocity(State& x, BodyHandle<B> const& handle, Vec3 const& v0, Vec3 const& omega) const {
    auto const& e = entry(handle);
    e.body.rigid_velocity(detail::checked_part(std::as_const(x.q), e.q0, e.body.coordinates()), v0, omega,
                          detail::checked_part(x.v, e.v0, e.body.velocities()));
  }

  Gravity const& gravity() const { return parts_.gravity; }  ///< gravity in world axes [m/s²]
  Index coordinates() const { return parts_.coordinates; }   ///< number nq of coordinates of all bodies
  /// Number nv of generalised velocities and first-order states. The states of forces follow the velocities of bodies.
  Index velocities() const { return parts_.velocities + parts_.states; }
  Index states() const { return parts_.states; }  ///< number of first-order states of forces
  Index rows() const { return parts_.rows; }      ///< number of constraint equations of joints and bodies
  /// Indices of the nonholonomic constraint equations, ascending.
  Sequence<Index> const& nonholonomic_equations() const { return parts_.nonholonomic_equations; }
  Index markers() const { return parts_.markers; }              ///< number of markers
  Index jacobian_size() const { return parts_.jacobian_size; }  ///< number of entries of all dense marker Jacobians
  Index body_count() const { return parts_.bodies; }            ///< number of bodies without the ground
  std::uint64_t serial() const { return parts_.serial(); }      ///< serial number, which the model's handles contain
  /// Serial numbers of the models from which this model was copied.
  Sequence<std::uint64_t> const& ancestors() const { return parts_.origin.ancestors(); }
  ModelWatch watch() const { return parts_.origin.watch(); }  ///< detects later changes of the model

  BodyPools const& body_pools() const { return bodies_; }                                 ///< stored bodies by type
  JointPools const& joint_pools() const { return joints_; }                               ///< stored joints by type
  ForcePools const& force_pools() const { return forces_; }                               ///< stored forces by type
  Sequence<detail::GroundMarker> const& ground_markers() const { return parts_.ground; }  ///< markers on the ground
  /// Constraint equations of joints that are linear in coordinates.
  Sequence<LinearConstraints> const& linear_rows() const { return parts_.linear_rows; }

  /// Stored entry of a body. \throws InvalidInput for a default-constructed handle or a handle of another model.
  template <OneOf<Bs...> B>
  auto const& entry(BodyHandle<B> const& handle) const {
    return detail::own_entry(std::get<detail::BodyPool<B>>(bodies_).entries, handle);
  }
  /// Stored entry of a joint. \throws InvalidInput for a default-constructed handle or a handle of another model.
  template <OneOf<Js...> J>
  auto const& entry(ElementHandle<J> const& handle) const {
    return detail::own_entry(std::get<Sequence<detail::JointEntry<J>>>(joints_), handle);
  }
  /// Stored entry of a force element. \throws InvalidInput for a default-constructed handle or a handle of another
  /// model.
  template <OneOf<Fs...> F>
  auto const& entry(ElementHandle<F> const& handle) const {
    return detail::own_entry(std::get<Sequence<detail::ForceEntry<F>>>(forces_), handle);
  }
  /// Calls f(entry) for every body, type by type.
  template <class F>
  void for_each_body(F&& f) const {
    std::apply([&](auto const&... pool) { (for_each_in(pool.entries, f), ...); }, bodies_);
  }
  /// Calls f(entry) for every joint, type by type.
  template <class F>
  void for_each_joint(F&& f) const {
    std::apply([&](auto const&... pool) { (for_each_in(pool, f), ...); }, joints_);
  }
  /// Calls f(entry) for every force element, type by type.
  template <class F>
  void for_each_force(F&& f) const {
    std::apply([&](auto const&... pool) { (for_each_in(pool, f), ...); }, forces_);
  }

  /// Requires a marker of this model. \throws InvalidInput naming `what` for a marker of another model.
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
  template <class, Capabilities>
  friend class detail::IslandMaker;

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
