#pragma once
/// \file
/// Interface between models and integrators: compatible pairs, and the system of a model for an integrator.

#include <polybody/elimination/reduced_coordinates.hpp>
#include <polybody/integrators/integrator.hpp>

namespace polybody {

/// Joints of model M add no constraint equations, or integrator I satisfies constraint equations.
template <class I, class M>
concept ConstraintCompatible = I::accepts_constraints || !M::may_have_rows;

/// M has a constant mass matrix in the unknowns of a step, or I does not require it.
template <class I, class M>
concept ConstantMassCompatible =
    !requires { requires I::needs_constant_mass; } || (M::constant_mass && std::is_void_v<typename M::Solution>);

/// One linear system can contain M several times, or I does not require it.
template <class I, class M>
concept CoupledStageCompatible = !requires { requires I::coupled_stages; } ||
                                 !std::is_same_v<typename M::Solution, joint_coordinates::ArticulatedBody>;

/// M provides mean forces over a step, or I does not require them.
template <class I, class M>
concept SecantCompatible = !contains(entries_of<I>(), Capabilities::secants) || HasSecants<M>;

/// Integrator I can integrate model M.
template <class I, class M>
concept CompatibleIntegrator = ConstraintCompatible<I, M> && ConstantMassCompatible<I, M> &&
                               ArticulatedBodySolvable<M> && CoupledStageCompatible<I, M> && SecantCompatible<I, M>;

/// Refuses a temporary model, because the system refers to the model.
template <class I, Capabilities more = Capabilities::motion, class M>
System system_for(M const&& model) = delete;
/// System of `model` for integrator I, with the capabilities that I requires and those of `more`. The model must
/// outlive the system.
template <class I, Capabilities more = Capabilities::motion, class M>
System system_for(M const& model) {
  static_assert(ConstraintCompatible<I, M>,
                "This explicit integrator has no stabilisation, but the Constraint policy and Euler parameters add "
                "constraint equations. Use an integrator with Projection, such as RungeKutta4<Projection>, or an "
                "implicit integrator.");
  static_assert(ConstantMassCompatible<I, M>,
                "This integrator needs bodies with a constant mass matrix and no joint coordinates. Use RungeKutta4.");
  static_assert(ArticulatedBodySolvable<M>,
                "joint_coordinates::ArticulatedBody needs rigid bodies and forces without first-order states. Use "
                "joint_coordinates::Augmented.");
  static_assert(CoupledStageCompatible<I, M>,
                "joint_coordinates::ArticulatedBody solves for one set of accelerations at a time, not for all stages "
                "of a step together. Use joint_coordinates::Augmented.");
  if constexpr (contains(entries_of<I>(), Capabilities::secants)) {
    using CompatibilityReport = SecantSupport<M>;
    static_assert(FullStateModel<M>,
                  "EnergyMomentum and EnergyDecaying do not support policies that eliminate coordinates, such as "
                  "AncfLinear and JointCoordinates. Use Constraint.");
    static_assert(
        CompatibilityReport::bodies,
        "EnergyMomentum and EnergyDecaying need bodies with a constant mass matrix and a mean force over a step. "
        "Use GeneralisedAlpha for Ffr, Rigid<EulerParameters>, and Lrvf with another interpolation than "
        "RelativeRotation.");
    static_assert(CompatibilityReport::policies || !FullStateModel<M>,
                  "EnergyMomentum and EnergyDecaying support the policies Constraint, Penalty and Bushing. Use "
                  "GeneralisedAlpha for others.");
    static_assert(CompatibilityReport::positions,
                  "EnergyMomentum and EnergyDecaying do not support nonholonomic joints (RollingDisc, KnifeEdge). Use "
                  "GeneralisedAlpha.");
    static_assert(CompatibilityReport::elements,
                  "EnergyMomentum and EnergyDecaying do not support force groups. Use GeneralisedAlpha.");
    static_assert(CompatibilityReport::reactions,
                  "EnergyMomentum and EnergyDecaying do not support friction that follows the multipliers of a joint. "
                  "Use GeneralisedAlpha.");
    static_assert(CompatibilityReport::potentials,
                  "EnergyMomentum and EnergyDecaying need the potential of a force for general scalars: declare "
                  "potential(frames, t) as a template on the scalar type of the frames.");
  }
  if constexpr (CompatibleIntegrator<I, M>) return stepped_system(model, with < entries_of<I>() | more >);
}

}  // namespace polybody
