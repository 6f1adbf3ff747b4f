#pragma once
/// \file
/// The door between models and integrators: which steps which, and the system that is stepped.

#include <polybody/integrators/integrator.hpp>
#include <polybody/solvers/reduced_coordinates.hpp>

namespace polybody {

/// Joints bring no rows into a step of model M, or integrator I keeps to them.
template <class I, class M>
concept ConstraintCompatible = I::accepts_constraints || !M::may_have_rows;

/// M has a constant mass matrix in the unknowns of a step, or I does not ask for one.
template <class I, class M>
concept ConstantMassCompatible =
    !requires { requires I::needs_constant_mass; } || (M::constant_mass && std::is_void_v<typename M::Solution>);

/// One linear system may hold M as often as I needs it.
template <class I, class M>
concept CoupledStageCompatible = !requires { requires I::coupled_stages; } ||
                                 !std::is_same_v<typename M::Solution, joint_coordinates::ArticulatedBody>;

/// M gives means over a step, or I does not ask for them.
template <class I, class M>
concept SecantCompatible = !contains(entries_of<I>(), Capabilities::secants) || HasSecants<M>;

/// I steps M.
template <class I, class M>
concept CompatibleIntegrator = ConstraintCompatible<I, M> && ConstantMassCompatible<I, M> &&
                               ArticulatedBodySolvable<M> && CoupledStageCompatible<I, M> && SecantCompatible<I, M>;

/// Refuses a temporary model, to which the system would keep a reference.
template <class I, Capabilities more = Capabilities::motion, class M>
System system_for(M const&& model) = delete;
/// What integrator I steps of `model`, with the entries that it calls and `more`. The model must outlive it.
template <class I, Capabilities more = Capabilities::motion, class M>
System system_for(M const& model) {
  static_assert(ConstraintCompatible<I, M>,
                "This explicit integrator has no stabilisation, but joints with the Constraint policy add rows. Use "
                "it with Projection, such as RungeKutta4<Projection>, or use an implicit integrator.");
  static_assert(ConstantMassCompatible<I, M>,
                "This integrator asks for bodies of constant mass matrix. Use RungeKutta4.");
  static_assert(
      ArticulatedBodySolvable<M>,
      "joint_coordinates::ArticulatedBody is for models of rigid bodies whose forces have no first-order states. Take "
      "joint_coordinates::Augmented.");
  static_assert(
      CoupledStageCompatible<I, M>,
      "joint_coordinates::ArticulatedBody solves for one set of accelerations at a time, not for the stages of a "
      "step together. Take joint_coordinates::Augmented.");
  if constexpr (contains(entries_of<I>(), Capabilities::secants)) {
    using CompatibilityReport = SecantSupport<M>;
    static_assert(FullStateModel<M>,
                  "A step that conserves energy asks for joints that eliminate nothing: Constraint in place of "
                  "AncfLinear, say.");
    static_assert(
        CompatibilityReport::bodies,
        "A step that conserves energy asks for bodies of constant mass whose coordinates form a vector space and "
        "which give their mean force over a step: cables, ANCF beams, planar rigid bodies and beams. For others use "
        "GeneralisedAlpha.");
    static_assert(CompatibilityReport::policies || !FullStateModel<M>,
                  "A step that conserves energy takes joints with Constraint, Penalty or Bushing. "
                  "For others use GeneralisedAlpha.");
    static_assert(CompatibilityReport::positions,
                  "A step that conserves energy knows rows by the change of their gap, and RollingDisc and KnifeEdge "
                  "have none. Use GeneralisedAlpha.");
    static_assert(CompatibilityReport::elements,
                  "A step that conserves energy takes no force groups. Use GeneralisedAlpha.");
    static_assert(CompatibilityReport::potentials,
                  "A step that conserves energy asks a force's potential on secants: let potential(frames, t) be a "
                  "template on the scalar of the frames.");
  }
  if constexpr (CompatibleIntegrator<I, M>) return stepped_system(model, with < entries_of<I>() | more >);
}

}  // namespace polybody
