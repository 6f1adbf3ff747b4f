#pragma once
// Sentences with which Model::connect and simulate refuse a combination of body, policy and integrator, as values that
// a program can print. The test `sentences` compares them with the texts of the static_asserts.
#include <polybody/integrators/system_for.hpp>
#include <polybody/run/any_model.hpp>
#include <polybody/system/model.hpp>

namespace combinations {

using namespace polybody;

template <class I>
struct NamedIntegrator {
  char const* name;
  I integrator;
};

template <class T>
inline constexpr bool sentence_missing = false;

// Text of the static_assert of Model::connect (detail::require_pairing) that refuses joint J between the bodies A and
// B; empty if the joint exists.
template <class J, class A, class B>
constexpr char const* connect_refusal() {
  using G = typename J::Geometry;
  using P = typename J::PolicyType;
  constexpr bool eliminable = EliminableBody<P, A> && EliminableBody<P, B>;
  if constexpr (JointCoordinatePolicy<P> && !eliminable)
    return "JointCoordinates supports joints between the ground, rigid bodies, floating frames, and nodes of beams "
           "with "
           "rotations: Rigid<>, Ffr, Lrvf, Se3Beam and those of polybody::planar; JointCoordinatesBy<ArticulatedBody> "
           "supports rigid bodies only. Use another policy for other bodies.";
  else if constexpr (LinearPolicy<P> && !eliminable)
    return "AncfLinear needs markers that are linear in the coordinates, such as those of ANCF bodies and the ground. "
           "Markers of Rigid, Ffr, Se3Beam and spatial Lrvf are not linear: use Constraint for them.";
  else if constexpr (!SufficientFirstMarker<J, A> || !SufficientSecondMarker<J, B>)
    return "This joint needs a marker with axes, but this body provides only a point or a tangent. Use a joint that "
           "needs only points, such as Spherical. To clamp a cable, use a Revolute about its tangent, with the cable's "
           "marker second.";
  else if constexpr (SameWorld<G, A, B> && EnforceablePair<P, G>)
    return "";
  else
    static_assert(sentence_missing<J>, "Add the sentence of detail::require_pairing.");
}

// Text of the static_assert of system_for that refuses integrator I for model M; empty if the combination exists.
template <class I, class M>
constexpr char const* integrator_refusal() {
  if constexpr (CompatibleIntegrator<I, M>)
    return "";
  else if constexpr (!FullStateModel<M>)
    return "EnergyMomentum and EnergyDecaying do not support policies that eliminate coordinates, such as AncfLinear "
           "and JointCoordinates. Use Constraint.";
  else if constexpr (!SecantSupport<M>::bodies)
    return "EnergyMomentum and EnergyDecaying need bodies with a constant mass matrix and a mean force over a step. "
           "Use GeneralisedAlpha for Ffr, Rigid<EulerParameters>, and Lrvf with another interpolation than "
           "RelativeRotation.";
  else if constexpr (!SecantSupport<M>::elements)
    return "EnergyMomentum and EnergyDecaying do not support force groups. Use GeneralisedAlpha.";
  else
    static_assert(sentence_missing<M>, "Add the sentence of system_for.");
}

// Sentences of the integrators for model M, in the order of the tuple.
template <class M, class... Is>
std::vector<std::string> integrator_refusals(std::tuple<NamedIntegrator<Is>...> const&) {
  return {integrator_refusal<Is, M>()...};
}

// The integrators of the tuple that can integrate M, as the argument of AnyModel.
template <class M, class... Kept>
constexpr auto compatible(SteppedBy<Kept...> kept) {
  return kept;
}
template <class M, class... Kept, class I, class... Is>
constexpr auto compatible(SteppedBy<Kept...>, NamedIntegrator<I> const&, NamedIntegrator<Is> const&... others) {
  if constexpr (CompatibleIntegrator<I, M>)
    return compatible<M>(SteppedBy<Kept..., I>{}, others...);
  else
    return compatible<M>(SteppedBy<Kept...>{}, others...);
}
template <class M, class... Is>
constexpr auto compatible(std::tuple<NamedIntegrator<Is>...> const& all) {
  return std::apply([](auto const&... i) { return compatible<M>(SteppedBy<>{}, i...); }, all);
}

}  // namespace combinations
