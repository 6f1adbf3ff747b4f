#pragma once
/// \file
/// `Subassembly`: access to a model for code that uses only some of the model's types.

#include <polybody/system/model.hpp>

namespace polybody {

/// Reference to a model. The type of a subassembly lists only some of the model's types. A function that builds a hull
/// or a suspension is then compiled once for all models with these types:
///   Subassembly<Bodies<Rigid<>>, Joints<Joint<Revolute, Constraint>>, Forces<SpringDamper>> hull(model);
///   auto const wheel = hull.add(body, "wheel");
///   hull.connect(Joint{Revolute{.axis = axis}}, arm.at({0, 0, 0}), wheel.at({0, 0, 0}), "axle");
/// The handles are those of the model. The model must outlive the subassembly.
template <class BodyList, class JointList = Joints<>, class ForceList = Forces<>>
class Subassembly;
/// Subassembly with bodies, joints and forces of these types.
template <Body... Bs, class... Js, AppliedForce... Fs>
class Subassembly<Bodies<Bs...>, Joints<Js...>, Forces<Fs...>> {
 public:
  /// Refers to `model`, which must have all types of the subassembly.
  template <class AllBodies, class AllJoints, class AllForces>
  explicit Subassembly(Model<AllBodies, AllJoints, AllForces>& model)
      : parts_(model.parts_),
        bodies_(&std::get<detail::BodyPool<Bs>>(model.bodies_)...),
        joints_(&std::get<Sequence<detail::JointEntry<Js>>>(model.joints_)...),
        forces_(&std::get<Sequence<detail::ForceEntry<Fs>>>(model.forces_)...) {}

  /// Adds a body, like `Model::add`.
  template <OneOf<Bs...> B>
  BodyHandle<B> add(B const& body, std::string name = "") {
    return detail::add_body(parts_, pool_of<B>(), body, std::move(name));
  }

  BodyHandle<Ground> ground() const { return {parts_.serial(), 0, "ground"}; }  ///< the ground of the model

  /// Joins marker a to marker b, like `Model::connect`.
  template <OneOf<Js...> J, class A, class B>
  ElementHandle<J> connect(J const& joint, Marker<A> const& a, Marker<B> const& b, std::string name = "") {
    detail::require_pairing<J, A, B>();
    return detail::add_joint(parts_, *std::get<Sequence<detail::JointEntry<J>>*>(joints_), joint, pooled(a), pooled(b),
                             std::move(name));
  }

  /// Applies a force element between two markers, like `Model::apply`.
  template <OneOf<Fs...> F, class A, class B>
    requires(F::markers == 2)
  ElementHandle<F> apply(F const& force, Marker<A> const& a, Marker<B> const& b, std::string name = "") {
    detail::require_kinematics<tell_enough<F, Marker<A>, Marker<B>>()>();
    return detail::add_force(parts_, forces_of<F>(), force, std::move(name), pooled(a), pooled(b));
  }
  /// Applies a force group to its many markers, like `Model::apply`.
  template <OneOf<Fs...> F, class A>
    requires(ForceGroup<F> && !SearchingForceGroup<F>)
  ElementHandle<F> apply(F const& group, std::vector<Marker<A>> const& many, std::string name = "") {
    detail::require_kinematics<(Marker<A>::observes >= F::needs)>();
    Sequence<detail::PooledMarker<A>> pooled_many;
    for (Marker<A> const& m : many) pooled_many.push_back(pooled(m));
    return detail::add_group(parts_, forces_of<F>(), group, pooled_many, std::move(name));
  }
  /// Adds a contact partner with the contact law `law` at marker `one` to a force group, like `Model::add_partner`.
  template <OneOf<Fs...> F, class Law, class A>
    requires(ForceGroup<F> && !SearchingForceGroup<F>)
  void add_partner(ElementHandle<F> const& group, Law const& law, Marker<A> const& one, std::string name = "") {
    detail::require_kinematics<(Marker<A>::observes >= needs_of_second<Law>())>();
    detail::add_contact_partner(parts_, detail::own_entry(forces_of<F>(), group), law, pooled(one), std::move(name));
  }

  /// Applies a contact set, like `Model::apply`.
  template <OneOf<Fs...> F>
    requires SearchingForceGroup<F>
  ElementHandle<F> apply(F const& set, std::string name = "") {
    return detail::add_group(parts_, forces_of<F>(), set, Sequence<detail::PooledMarker<Ground>>{}, std::move(name));
  }
  /// Adds a member, a `shape` at the marker `at`, to a contact set, like `Model::add_member`. `group` is the number of
  /// its group.
  template <OneOf<Fs...> F, class S, class A>
    requires SearchingForceGroup<F>
  Index add_member(ElementHandle<F> const& set, S const& shape, Marker<A> const& at, std::string name = "",
                   int group = 0) {
    detail::require_kinematics<(Marker<A>::observes >= S::needs)>();
    return detail::add_member(parts_, detail::own_entry(forces_of<F>(), set), shape, pooled(at), std::move(name),
                              group);
  }
  /// Excludes the contact of the members m and n of a contact set, like `Model::exclude`.
  template <OneOf<Fs...> F>
    requires SearchingForceGroup<F>
  void exclude(ElementHandle<F> const& set, Index m, Index n) {
    detail::exclude_members(parts_, detail::own_entry(forces_of<F>(), set), m, n);
  }

 private:
  template <class B>
  detail::BodyPool<B>& pool_of() {
    return *std::get<detail::BodyPool<B>*>(bodies_);
  }
  template <class F>
  Sequence<detail::ForceEntry<F>>& forces_of() {
    return *std::get<Sequence<detail::ForceEntry<F>>*>(forces_);
  }
  template <class B>
  detail::PooledMarker<B> pooled(Marker<B> const& m) {
    if constexpr (std::is_same_v<B, Ground>)
      return {m};
    else
      return {m, pool_of<B>()};
  }

  detail::ModelParts& parts_;
  std::tuple<detail::BodyPool<Bs>*...> bodies_;
  std::tuple<Sequence<detail::JointEntry<Js>>*...> joints_;
  std::tuple<Sequence<detail::ForceEntry<Fs>>*...> forces_;
};

}  // namespace polybody
