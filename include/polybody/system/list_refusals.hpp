#pragma once
/// \file
/// Compile-time messages for lists of types that cannot form a model. Messages about bodies and forces name the missing
/// member.

#include <tuple>

#include <polybody/bodies/shared/body.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/math/type_list.hpp>
#include <polybody/system/pools.hpp>

namespace polybody {

namespace detail {
template <class J>
inline constexpr bool is_joint_type = requires { typename J::PolicyType; };
template <class G, class P>
inline constexpr bool is_joint_type<Joint<G, P>> = true;  // not instantiated here: its own messages come later
}  // namespace detail

/// Type of a joint: a `Joint`, or another type with a member type `PolicyType`.
template <class J>
concept JointType = detail::is_joint_type<J>;

}  // namespace polybody

namespace polybody::detail {

using In = std::span<double const>;
using Out = std::span<double>;

/// Separate checks of the members that the concept `Body` requires. In the messages q and v are the body's coordinates
/// and generalised velocities, e is an element and p a `Point`. If the member is a template, q and v are spans of a
/// scalar T.
template <class B>
struct BodyRefusal {
  static_assert(requires { typename B::Point; }, "A body needs a type Point: a position on it for a marker.");
  static_assert(
      requires {
        { B::world } -> std::convertible_to<World>;
        { B::observes } -> std::convertible_to<MarkerKind>;
        { B::constant_mass } -> std::convertible_to<bool>;
      }, "A body needs static constants: World world, MarkerKind observes and bool constant_mass.");
  static_assert(
      requires {
        { B::element_columns } -> std::convertible_to<int>;
        { B::point_columns } -> std::convertible_to<int>;
      },
      "A body needs static constants: int element_columns and int point_columns, the numbers of velocities on "
      "which an element and a marker depend.");
  static_assert(
      requires(B const b) {
        { b.coordinates() } -> std::convertible_to<Index>;
        { b.velocities() } -> std::convertible_to<Index>;
        { b.elements() } -> std::convertible_to<Index>;
      },
      "A body needs coordinates(), velocities() and elements() const, which return the numbers of its coordinates, "
      "velocities and elements.");
  static_assert(
      requires(B const b, Index e, typename B::Point p) {
        { b.first_column(e) } -> std::convertible_to<Index>;
        { b.first_column(p) } -> std::convertible_to<Index>;
      },
      "A body needs first_column(e) and first_column(p) const, which return the index of the first velocity on which "
      "an element and a marker depend.");
  static_assert(
      requires(B const b, Out out) { b.reference(out); },
      "A body needs reference(q) const, which writes its coordinates in the reference configuration.");
  static_assert(
      requires(B const b, In x, Out out) {
        b.template plus<double>(x, x, out);
        b.template local_rate<double>(x, x, out);
      },
      "A body needs plus<T>(q, delta, out) and local_rate<T>(delta, v, out) const. If the increment is q + delta, "
      "inherit both from AddingCoordinates.");
  static_assert(
      requires(B const b, In x, Out out, Vec3 u) { b.rigid_velocity(x, u, u, out); },
      "A body needs rigid_velocity(q, v0, omega, v) const, which writes its velocities v in a rigid motion.");
  static_assert(
      requires(B const b, Index e, In x, Mat<double, B::element_columns, B::element_columns>& m) { b.mass(e, x, m); },
      "A body needs mass(e, q, m) const, which writes the mass matrix m of an element.");
  static_assert(
      requires(B const b, Index e, In x, Vec<double, B::element_columns>& f) {
        b.template inertia<double>(e, x, x, f);
      }, "A body needs inertia<T>(e, q, a, out) const, which writes M a of an element.");
  static_assert(
      requires(B const b, Index e, In x, Vec<double, B::element_columns>& f) { b.template force<double>(e, x, x, f); },
      "A body needs force<T>(e, q, v, out) const, which writes the elastic, damping and quadratic-velocity force "
      "of an element.");
  static_assert(
      requires(B const b, Index e, In x, Mat<double, B::element_columns, B::element_columns>& k) {
        b.tangent(e, x, x, 1.0, 1.0, k);
      }, "A body needs tangent(e, q, v, ck, cd, k) const, which writes k = -(ck df/dq + cd df/dv) of an element.");
  static_assert(
      requires(B const b, Index e, In x, Vec3 g, Vec<double, B::element_columns>& f) {
        b.template gravity<double>(e, x, g, f);
      }, "A body needs gravity<T>(e, q, g, out) const, which writes the force of the uniform field g on an element.");
  static_assert(
      requires(B const b, Index e, In x, Vec3 g) {
        { b.kinetic_energy(e, x, x) } -> std::convertible_to<double>;
        { b.strain_energy(e, x) } -> std::convertible_to<double>;
        { b.gravity_energy(e, x, g) } -> std::convertible_to<double>;
      }, "A body needs kinetic_energy(e, q, v), strain_energy(e, q) and gravity_energy(e, q, g) const.");
  static_assert(
      requires(B const b, typename B::Point p, Mat3 const& axes, In x, MarkerKinematics<double>& out) {
        b.template evaluate_marker<double>(p, axes, x, x, out);
      },
      "A body needs evaluate_marker<T>(p, axes, q, v, published) const, which writes the frame, Jacobian and bias "
      "of a marker.");
  static_assert(
      requires(B const b, typename B::Point p, In x, Wrench<double> w,
               Mat<double, B::point_columns, B::point_columns>& k) { b.load_stiffness(p, x, w, k); },
      "A body needs load_stiffness(p, q, w, k) const, which writes k = d(J'w)/dq of a marker. "
      "load_stiffness_by_dual_numbers computes it.");
};

/// Separate checks of the members that the concept `ForceElement` requires.
template <class F>
struct ForceRefusal {
  static_assert(
      requires { requires F::markers >= 1; },
      "A force element needs a static constant: int markers, at least 1; a force group needs the members of "
      "ForceGroup.");
  static_assert(
      requires {
        { F::needs } -> std::convertible_to<MarkerKind>;
        { F::is_load } -> std::convertible_to<bool>;
      }, "A force element needs two static constants, `MarkerKind needs` and `bool is_load`.");
  static_assert(
      WrenchFunction<F> || states_of<F>() > 0,
      "A force element needs wrenches<T>(std::array<Frame<T>, markers> frames, double t) const, which returns "
      "std::array<Wrench<T>, markers>.");
  static_assert(HasStates<F> || states_of<F>() == 0,
                "A force element with states needs wrenches<T>(std::array<Frame<T>, markers> frames, std::array<T, "
                "states> z, double t) const and rates<T> with equal arguments, which returns std::array<T, states>.");
  static_assert(
      requires(F const f, std::string name) { f.check(name); },
      "A force element needs check(name) const, which throws InvalidInput for invalid parameters.");
};

/// True if no type of a list is const.
template <class... Ts>
inline constexpr bool no_const = (!std::is_const_v<Ts> && ...);

/// Position of a list among the arguments of `Model`; zero for other types.
template <class List>
inline constexpr int position_of_list = 0;
template <class... Bs>
inline constexpr int position_of_list<Bodies<Bs...>> = 1;
template <class... Js>
inline constexpr int position_of_list<Joints<Js...>> = 2;
template <class... Fs>
inline constexpr int position_of_list<Forces<Fs...>> = 3;

template <class List>
struct ListRefusal {
  static_assert(sizeof(List) == 0, "A model needs lists of types: Model<Bodies<...>, Joints<...>, Forces<...>>.");
};
template <class... Bs>
struct ListRefusal<Bodies<Bs...>> {
  static_assert(no_const<Bs...>,
                "A type in a model's Bodies is const. It is probably the decltype of an `auto const` object. Use "
                "`auto` for this object.");
  static_assert(Distinct<Bs...>,
                "A body type occurs twice in a model's Bodies. List it once; it is used for any number of bodies.");
  static constexpr bool checked = ((Body<Bs> || sizeof(BodyRefusal<Bs>) > 0) && ...);
};
template <class... Js>
struct ListRefusal<Joints<Js...>> {
  static_assert(no_const<Js...>,
                "A type in a model's Joints is const. It is probably the decltype of an `auto const` object. Use "
                "`auto` for this object.");
  static_assert(Distinct<Js...>,
                "A joint type occurs twice in a model's Joints. List it once; it is used for any number of joints.");
  static_assert((JointType<Js> && ...),
                "Joints<...> must list joints. Joint<Revolute> makes a joint from the geometry Revolute.");
  static constexpr bool checked = true;
};
template <class... Fs>
struct ListRefusal<Forces<Fs...>> {
  static_assert(no_const<Fs...>,
                "A type in a model's Forces is const. It is probably the decltype of an `auto const` object. Use "
                "`auto` for this object.");
  static_assert(Distinct<Fs...>,
                "A force type occurs twice in a model's Forces. List it once; it is used for any number of forces.");
  static constexpr bool checked = ((AppliedForce<Fs> || sizeof(ForceRefusal<Fs>) > 0) && ...);
};

/// Refuses a body whose type is not in the model's list.
template <class B>
constexpr void refuse_body() {
  static_assert(Body<B> || JointType<B> || AppliedForce<B>,
                "The argument of add must be a body. Make a body from a bar, for example Rigid<>::from(bar).");
  static_assert(!JointType<B>, "The argument of add is a joint. Use model.connect(joint, a, b).");
  static_assert(!AppliedForce<B>, "The argument of add is a force. Use model.apply(force, a, b).");
  static_assert(!Body<B>, "The type of this body is not in the model's list. Add it to Model<Bodies<...>, ...>.");
}
/// Refuses a joint whose type is not in the model's list.
template <class J>
constexpr void refuse_joint() {
  static_assert(JointType<J> || Body<J> || AppliedForce<J>,
                "The first argument of connect must be a joint. Joint{Revolute{.axis = axis}} makes a joint from a "
                "geometry.");
  static_assert(!JointType<J>,
                "The type of this joint is not in the model's list. Add Joint<Geometry, Policy>, with this geometry "
                "and this policy, to Model<Bodies<...>, Joints<...>>.");
  static_assert(!Body<J>, "The first argument of connect is a body. Use model.add(body).");
  static_assert(!AppliedForce<J>, "The first argument of connect is a force. Use model.apply(force, a, b).");
}
/// Refuses a force whose type is not in the model's list.
template <class F>
constexpr void refuse_force() {
  static_assert(
      AppliedForce<F> || JointType<F>,
      "The first argument of apply must be a force element. user_force<markers>(lambda) makes a force element "
      "from a lambda.");
  static_assert(!AppliedForce<F>,
                "The type of this force is not in the model's list. Add it to Model<Bodies<...>, Joints<...>, "
                "Forces<...>>.");
  static_assert(!JointType<F>, "The first argument of apply is a joint. Use model.connect(joint, a, b).");
}

template <class T>
inline constexpr bool is_marker = false;
template <class B>
inline constexpr bool is_marker<Marker<B>> = true;
template <class T>
inline constexpr bool is_marker_tuple = false;
template <class... Ms>
inline constexpr bool is_marker_tuple<std::tuple<Ms...>> = true;
/// Number of markers among the arguments Ts.
template <class... Ts>
inline constexpr int marker_count = (int(is_marker<Ts>) + ... + 0);

/// Refuses arguments of `connect` that are not a joint and two markers.
template <class J>
constexpr void refuse_joint_ends() {
  static_assert(std::is_void_v<J>,
                "A joint connects two markers. A handle of a body makes a marker: model.connect(joint, a.at(point), "
                "b.at(point)).");
}
/// Refuses arguments of `apply` that are not a force and its markers.
template <class F>
constexpr void refuse_force_ends() {
  static_assert(std::is_void_v<F>,
                "A force element needs as many markers as its constant `markers`. A handle of a body makes a marker: "
                "model.apply(force, a.at(point), b.at(point)). Put more than two markers into a std::tuple.");
}

}  // namespace polybody::detail
