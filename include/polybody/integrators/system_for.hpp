#pragma once
/// \file
/// The door between models and integrators: which steps which, and the system that is stepped.

#include <polybody/integrators/integrator.hpp>
#include <polybody/solvers/reduced_coordinates.hpp>

namespace polybody {

/// Joints bring no rows into a step of model M, or integrator I keeps to them.
template <class I, class M>
concept KeepsToRows = I::accepts_rows || !M::may_have_rows;

/// M has a constant mass matrix in the unknowns of a step, or I does not ask for one.
template <class I, class M>
concept FindsConstantMass =
    !requires { requires I::needs_constant_mass; } || (M::constant_mass && std::is_void_v<typename M::Solution>);

/// One linear system may hold M as often as I needs it.
template <class I, class M>
concept SolvesItsStages = !requires { requires I::solves_stages_together; } ||
                          !std::is_same_v<typename M::Solution, recursive::ArticulatedBody>;

/// M gives means over a step, or I does not ask for them.
template <class I, class M>
concept FindsSecants = !contains(entries_of<I>(), Entries::secants) || OffersSecants<M>;

/// I steps M.
template <class I, class M>
concept StepsModel =
    KeepsToRows<I, M> && FindsConstantMass<I, M> && SolvesItsBodies<M> && SolvesItsStages<I, M> && FindsSecants<I, M>;

/// Refuses a temporary model, to which the system would keep a reference.
template <class I, Entries more = Entries::motion, class M>
System system_for(M const&& model) = delete;
/// What integrator I steps of `model`, with the entries that it calls and `more`. The model must outlive it.
template <class I, Entries more = Entries::motion, class M>
System system_for(M const& model) {
  static_assert(KeepsToRows<I, M>,
                "This explicit integrator has no stabilisation, but joints with the Constraint policy add rows. Use "
                "it with Projection, such as RungeKutta4<Projection>, or use an implicit integrator.");
  static_assert(FindsConstantMass<I, M>, "This integrator asks for bodies of constant mass matrix. Use RungeKutta4.");
  static_assert(
      SolvesItsBodies<M>,
      "recursive::ArticulatedBody is for models of rigid bodies whose forces have no first-order states. Take "
      "recursive::Augmented.");
  static_assert(SolvesItsStages<I, M>,
                "recursive::ArticulatedBody solves for one set of accelerations at a time, not for the stages of a "
                "step together. Take recursive::Augmented.");
  if constexpr (contains(entries_of<I>(), Entries::secants)) {
    using Offer = SecantOffer<M>;
    static_assert(SteppedWhole<M>,
                  "A step that conserves energy asks for joints that eliminate nothing: Constraint in place of "
                  "AncfLinear, say.");
    static_assert(
        Offer::bodies,
        "A step that conserves energy asks for bodies of constant mass whose coordinates form a vector space and "
        "which give their mean force over a step: cables, ANCF beams, planar rigid bodies and beams. For others use "
        "GeneralizedAlpha.");
    static_assert(Offer::policies || !SteppedWhole<M>,
                  "A step that conserves energy takes joints with Constraint, Penalty or Bushing. "
                  "For others use GeneralizedAlpha.");
    static_assert(Offer::positions,
                  "A step that conserves energy knows rows by the change of their gap, and RollingDisc and KnifeEdge "
                  "have none. Use GeneralizedAlpha.");
    static_assert(Offer::elements, "A step that conserves energy takes no force groups. Use GeneralizedAlpha.");
    static_assert(Offer::potentials,
                  "A step that conserves energy asks a force's potential on secants: let potential(frames, t) be a "
                  "template on the scalar of the frames.");
  }
  if constexpr (StepsModel<I, M>) return stepped_system(model, with < entries_of<I>() | more >);
}

}  // namespace polybody
