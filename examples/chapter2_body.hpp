#pragma once
// The mechanisms of Chapter 2 with one body formulation on each policy: what a file of the folder chapter2 compiles.
#include "chapter2_formulations.hpp"

namespace chapter2 {

// The policies of --policy, with numbers that hold the pin within about a millimetre.
template <class P>
struct NamedPolicy {
  char const* name;
  P policy;
};
inline auto const policies = [] {
  double const k = 1e9, c = 1e5;  // [N/m], [N m/rad]; [N s/m], [N m s/rad]
  Vec3 const ks(k, k, k), cs(c, c, c);
  Bushing const bushing{.stiffness = Bushing::diagonal(ks, ks), .damping = Bushing::diagonal(cs, cs)};
  return std::tuple(NamedPolicy<Constraint>{"constraint", {}},
                    NamedPolicy<Penalty>{"penalty", {.stiffness = k, .damping = c}},
                    NamedPolicy<Bushing>{"bushing", bushing}, NamedPolicy<AncfLinear>{"ancf-linear", {}},
                    NamedPolicy<JointCoordinates>{"joint-coordinates", {}});
}();

template <class T>
inline constexpr bool sentence_missing = false;

// Text of the static_assert of Model::connect (detail::require_pairing) that refuses joint J between the ground and
// body B; empty if the joint exists. The test `sentences` compares the texts.
template <class J, class B>
constexpr char const* connect_refusal() {
  using G = typename J::Geometry;
  using P = typename J::PolicyType;
  if constexpr (JointCoordinatePolicy<P> && !EliminableBody<P, B>)
    return "JointCoordinates supports joints between the ground, rigid bodies and floating frames: Rigid<>, Ffr, "
           "planar::Rigid, planar::Ffr; JointCoordinatesBy<ArticulatedBody> supports rigid bodies only. Use another "
           "policy for other bodies.";
  else if constexpr (LinearPolicy<P> && !EliminableBody<P, B>)
    return "AncfLinear needs markers that are linear in the coordinates, such as those of ANCF bodies and the ground. "
           "Markers of Rigid, Ffr and spatial Lrvf are not linear: use Constraint for them.";
  else if constexpr (SameWorld<G, Ground, B> && EnforceablePair<P, G> && SufficientFirstMarker<J, Ground> &&
                     SufficientSecondMarker<J, B>)
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
    return "EnergyMomentum does not support policies that eliminate coordinates, such as AncfLinear and "
           "JointCoordinates. Use Constraint.";
  else if constexpr (!SecantSupport<M>::bodies)
    return "EnergyMomentum needs bodies with a constant mass matrix and a mean force over a step: cables, ANCF beams, "
           "planar rigid bodies and planar beams. Use GeneralisedAlpha for other bodies.";
  else
    static_assert(sentence_missing<M>, "Add the sentence of system_for.");
}

// The integrators that can integrate M, as the argument of AnyModel.
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

template <class B, class P>
RobotArm<B, P> mechanism_of(std::type_identity<RobotArm<B, P>>, B const& body, Setup const& s, P const& policy) {
  return {body, s.ramp, 0.0, policy};
}
template <class B, class P>
Cantilever<B, P> mechanism_of(std::type_identity<Cantilever<B, P>>, B const& body, Setup const& s, P const& policy) {
  return {body, s.moment, policy};
}

// Mechanism T of body B with policy P.
template <class T, class B, class P>
AnyMechanism any_mechanism(Setup const& s, FormulationMesh const& mesh, P const& policy) {
  Formulation<B, P, GeneralisedAlpha> const formulation{.policy = policy, .mesh = mesh};
  bool constexpr solid = std::is_same_v<B, AncfBeam<Continuum<>>>;  // integrates stresses over the section
  B const body = formulation.body(solid ? solid_bar(s.stiffness, s.density) : bar(s.stiffness, s.density));
  auto const made = std::make_shared<T const>(mechanism_of(std::type_identity<T>{}, body, s, policy));
  std::shared_ptr<typename T::Model const> const model(made, &made->model);
  return {
      std::apply([&](auto const&... i) { return AnyModel(model, compatible<typename T::Model>(SteppedBy<>{}, i...)); },
                 integrators),
      [made, tip = made->body().at(length)](State const& x) { return position(made->model, x, tip); }};
}

// A formulation of EqualErrorStudy. Its types and its mesh select names and axes; `make` creates the mechanism.
template <class B, class P, class I, MeshKind kind>
struct StudiedFormulationOf {
  using BodyType = B;
  using PolicyType = P;
  using IntegratorType = I;
  static constexpr bool has_mesh = kind != MeshKind::none, has_modes = kind == MeshKind::modes;
  std::string name;
  I integrator;
  FormulationMesh mesh;
  MakeMechanism make;
};

template <class B, class P, MeshKind kind, class I>
Combination combination_of(BodyName const& body, MakeMechanism const& make, I const& integrator) {
  std::string const model = body.model + (CompliantPolicy<P> ? std::string(", ") + P::name : "");
  return {.add = [=](EqualErrorStudy& study, Problem const& problem, std::string const& name,
                     FormulationMesh const& mesh, StudyEntry entry) {
    auto const make_case = [problem](auto const& f) { return scenario_of(problem, f.make, f.mesh); };
    entry.model = model;
    study.add(make_case, StudiedFormulationOf<B, P, I, kind>{name, integrator, mesh, make}, std::move(entry));
  }};
}

// Message of the exception that Model throws for this mechanism; empty if it throws none.
inline std::string refusal_of_making(MakeMechanism const& make, MeshKind kind) {
  FormulationMesh mesh{.elements = 2};
  if (kind == MeshKind::modes) mesh.modes = 1;
  try {
    make({}, mesh);
  } catch (InvalidInput const& e) {
    return e.what();
  }
  return {};
}

// Mechanism T of body B with one policy.
template <class T, class B, MeshKind kind, class P>
BodyOnPolicy on_policy(BodyName const& body, NamedPolicy<P> const& policy) {
  BodyOnPolicy out{.body = body, .policy = policy.name};
  std::string refused = connect_refusal<typename T::FirstJoint, B>();
  if constexpr (*connect_refusal<typename T::FirstJoint, B>() == '\0') {
    out.make = [p = policy.policy](Setup const& s, FormulationMesh const& mesh) {
      return any_mechanism<T, B>(s, mesh, p);
    };
    refused = refusal_of_making(out.make, kind);
    auto const by = [&](auto const& i) {
      using I = decltype(i.integrator);
      if constexpr (CompatibleIntegrator<I, typename T::Model>)
        return combination_of<B, P, kind>(body, out.make, i.integrator);
      else
        return Combination{integrator_refusal<I, typename T::Model>()};
    };
    out.by = std::apply([&](auto const&... i) { return std::vector{by(i)...}; }, integrators);
  }
  if (!refused.empty()) out.by.assign(std::tuple_size_v<decltype(integrators)>, Combination{refused});
  return out;
}

// Mechanism of body B on each policy.
template <class B, MeshKind kind = MeshKind::elements>
std::vector<BodyOnPolicy> on_policies(Mechanism mechanism, std::string const& name, std::string const& model) {
  BodyName const body{name, model, kind};
  return std::apply(
      [&](auto const&... p) -> std::vector<BodyOnPolicy> {
        if (mechanism == Mechanism::arm) return {on_policy<RobotArm<B, decltype(p.policy)>, B, kind>(body, p)...};
        return {on_policy<Cantilever<B, decltype(p.policy)>, B, kind>(body, p)...};
      },
      policies);
}

}  // namespace chapter2
