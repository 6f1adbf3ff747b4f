#pragma once
// The mechanisms of Chapter 2 with one body formulation and each policy. Each file of the folder chapter2 compiles them
// for one body.
#include "chapter2_formulations.hpp"

namespace chapter2 {

// The policies of --policy. With the penalty, the tip of the arm moves by about a millimetre relative to the constraint
// (docs/chapter2.md).
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
  return {AnyModel(model, combinations::compatible<typename T::Model>(integrators)),
          [made, tip = made->body().at(length)](State const& x) { return position(made->model, x, tip); }};
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
template <class T, class B, class P>
BodyOnPolicy on_policy(BodyName const& body, NamedPolicy<P> const& policy) {
  BodyOnPolicy out{{.body = body,
                    .policy = policy.name,
                    .usual = std::is_same_v<P, Constraint>,
                    .family = combinations::family_of<B>(body.mesh),
                    .enforcement = P::name}};
  if (CompliantPolicy<P>) out.body.model += ", " + out.enforcement;
  std::string refused = combinations::connect_refusal<typename T::FirstJoint, Ground, B>();
  if constexpr (*combinations::connect_refusal<typename T::FirstJoint, Ground, B>() == '\0') {
    out.make = [p = policy.policy](Setup const& s, FormulationMesh const& mesh) {
      return any_mechanism<T, B>(s, mesh, p);
    };
    refused = refusal_of_making(out.make, body.mesh);
    out.refusals = combinations::integrator_refusals<typename T::Model>(integrators);
  }
  if (!refused.empty()) out.refusals.assign(std::tuple_size_v<decltype(integrators)>, refused);
  return out;
}

// Mechanism of body B with each policy.
template <class B, MeshKind kind = MeshKind::elements>
std::vector<BodyOnPolicy> on_policies(Mechanism mechanism, std::string const& name, std::string const& model) {
  BodyName const body{name, model, kind};
  return std::apply(
      [&](auto const&... p) -> std::vector<BodyOnPolicy> {
        if (mechanism == Mechanism::arm) return {on_policy<RobotArm<B, decltype(p.policy)>, B>(body, p)...};
        return {on_policy<Cantilever<B, decltype(p.policy)>, B>(body, p)...};
      },
      policies);
}

}  // namespace chapter2
