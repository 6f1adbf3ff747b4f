#pragma once
/// \file Lists of joints and forces of the wide model types, with the names that the tables print.

#include "random_models/realise.hpp"

namespace polybody::random_models {

template <class... Ts>
struct Named {
  std::vector<char const*> names;
};

using Rate = PrescribedRate<SmoothRamp>;
using Turn = PrescribedAngle<SmoothRamp>;
using Stroke = PrescribedDistance<SmoothRamp>;
using Slide = PrescribedTranslation<SmoothRamp>;

using PlanarRevolute = polybody::planar::Revolute;
using PlanarPrismatic = polybody::planar::Prismatic;
using PlanarWeld = polybody::planar::Weld;

template <class G>
struct NameOf {
  static constexpr char const* value = G::name;
};
template <>
struct NameOf<Rate> {
  static constexpr char const* value = "PrescribedRate";
};
template <>
struct NameOf<PlanarRevolute> {
  static constexpr char const* value = "planar::Revolute";
};
template <>
struct NameOf<PlanarPrismatic> {
  static constexpr char const* value = "planar::Prismatic";
};
template <>
struct NameOf<PlanarWeld> {
  static constexpr char const* value = "planar::Weld";
};

template <class P>
constexpr char const* policy_name() {
  if constexpr (std::is_same_v<P, JointCoordinatesBy<joint_coordinates::ArticulatedBody>>)
    return "JointCoordinatesBy<ArticulatedBody>";
  else
    return P::name;
}

/// Placeholder for `PenaltyPerEquation` with as many numbers as the geometry has constraint equations.
struct PerRow {};
template <class P, class G>
using PolicyFor = std::conditional_t<std::is_same_v<P, PerRow>, PenaltyPerEquation<constraint_equations<G>()>, P>;

/// Joints of one policy.
template <class P, class... Gs>
using JointsBy = Joints<Joint<Gs, PolicyFor<P, Gs>>...>;

template <class... Lists>
struct JoinedLists;
template <class... Js>
struct JoinedLists<Joints<Js...>> {
  using type = Joints<Js...>;
};
template <class... Js, class... Ks, class... More>
struct JoinedLists<Joints<Js...>, Joints<Ks...>, More...> : JoinedLists<Joints<Js..., Ks...>, More...> {};
template <class... Lists>
using Together = typename JoinedLists<Lists...>::type;

template <class... Js>
std::vector<std::pair<char const*, char const*>> names_of(Joints<Js...>) {
  return {{NameOf<typename Js::Geometry>::value, policy_name<typename Js::PolicyType>()}...};
}

using AllForces =
    Forces<PointForce<>, PointMoment<>, SpringDamper, AxialSpring, MaxwellElement, SmallContact, FailingForce>;
inline std::vector<char const*> const names_of_all_forces{
    "PointForce", "PointMoment", "SpringDamper", "AxialSpring", "MaxwellElement", "Contact", "user's force"};
using ForcesWithoutStates = Forces<PointForce<>, PointMoment<>, SpringDamper, AxialSpring, SmallContact, FailingForce>;
inline std::vector<char const*> const names_without_states{"PointForce",  "PointMoment", "SpringDamper",
                                                           "AxialSpring", "Contact",     "user's force"};

/// The wide type of these lists.
template <class B, class J, class F>
WideType wide_type(char const* name, std::vector<char const*> const& bodies, std::vector<char const*> const& forces) {
  using R = Realiser<Model<B, J, F>>;
  return {name, R::kinds(bodies, names_of(J{}), forces), &R::realise};
}

/// All geometries of space.
template <class P>
using AllInSpace =
    JointsBy<P, Spherical, Revolute, RevolutePin, Universal, Cylindrical, Prismatic, Screw, PlanarJoint, PointOnLine,
             PointInPlane, ConstantOrientation, ParallelAxes, PerpendicularAxes, Weld, RelativeCoordinates, Distance,
             Gear, RackAndPinion, RollingDisc, KnifeEdge, Turn, Rate, Stroke, Slide>;
/// Geometries that leave joint coordinates; the last three are planar.
template <class P>
using AllWithMotions =
    JointsBy<P, Spherical, Revolute, Universal, Cylindrical, Prismatic, Screw, PlanarJoint, PointOnLine, PointInPlane,
             ConstantOrientation, ParallelAxes, Weld, RelativeCoordinates, PlanarRevolute, PlanarPrismatic, PlanarWeld>;

}  // namespace polybody::random_models
