#pragma once
/// \file
/// Checks that a state has the sizes of a model, finite values, and quaternions of norm one. Warnings of a model.

#include <polybody/system/state.hpp>
#include <polybody/system/system.hpp>

namespace polybody {

namespace detail {
/// \throws InvalidInput unless x has these sizes and finite coordinates and velocities.
template <class = void>
void require_sizes(State const& x, Index coordinates, Index velocities, Index rows) {
  if (x.q.size() != coordinates || x.v.size() != velocities || x.a.size() != velocities || x.lambda.size() != rows)
    refuse_unfitting_state();
  require_finite(x.q, "The coordinates of the state");
  require_finite(x.v, "The velocities of the state");
}
}  // namespace detail

/// Requires a state of the full model. \throws InvalidInput unless x has the sizes of this model with all of its bodies
/// and joints, and finite coordinates and velocities.
template <class M>
[[gnu::cold]] void require_fitting(M const& model, State const& x) {
  detail::require_sizes(x, model.coordinates(), model.velocities(), model.rows());
}
/// Requires a state of the full model of `system`. \throws InvalidInput unless x has the sizes of this model, and
/// finite coordinates and velocities.
template <class = void>
[[gnu::cold]] void require_fitting(System const& system, State const& x) {
  ModelLayout const& full = system.layout();
  full.watch.require_unchanged();
  detail::require_sizes(x, full.coordinates, full.velocities, full.rows);
}

/// Adds the warnings of bodies whose section matrices are probably not in SI units, without repetitions.
template <class = void>
[[gnu::cold]] void warn_of_units(System const& system, std::vector<std::string>& warnings) {
  std::string_view last;
  for (BodyLayout const& body : system.layout().bodies) {
    if (!body.unit_warning.empty() && body.unit_warning != last)
      warnings.push_back(sentence_of({"Body \"", body.name, "\": ", body.unit_warning}));
    last = body.unit_warning;
  }
}

/// Requires coordinates that an increment of zero (⊞ 0) does not change. A quaternion whose norm is not one would
/// change. \throws InvalidInput naming the body. \param x state of the full model
template <class = void>
[[gnu::cold]] void require_places(System const& system, State const& x) {
  VecX const none = VecX::Zero(x.v.size());
  VecX there = x.q;
  system.plus(x.q, none, there);
  for (Index i = 0; i < there.size(); ++i)
    if (!(std::abs(there[i] - x.q[i]) <= 1e-6 * (1.0 + std::abs(x.q[i]))))
      throw InvalidInput("state.quaternion", {"The coordinates of ", ErrorObject{name_of_coordinate(system, i)},
                                              " are invalid: the norm of a quaternion must be one. Start from "
                                              "reference_state(), and rotate a body by unit quaternions."});
}

/// \throws InvalidInput naming a body with a coordinate or velocity that is NaN, infinite or above `largest_number`.
/// Energies of larger numbers can overflow. \param x state of the full model
template <class = void>
[[gnu::cold]] void require_computable(System const& system, State const& x) {
  ModelLayout const& full = system.layout();
  Index const in_q = first_not_finite(x.q), in_v = first_not_finite(x.v);
  if (in_q < 0 && in_v < 0) return;
  throw InvalidInput(
      "state.not_finite",
      {"A ",
       ErrorObject{in_v < 0 ? "coordinate of " + full.name_of_coordinate(in_q) : "velocity of " + full.name_of(in_v)},
       non_finite_suffix(in_v < 0 ? x.q[in_q] : x.v[in_v]), " in the state. Correct this value."});
}

/// \throws NonFiniteValue naming a joint of `system` whose reaction in x is not finite.
inline void require_finite_reactions(System const& system, State const& x) {
  if (Index const i = first_not_finite(x.lambda); i >= 0)
    throw NonFiniteValue(
        "multiplier.not_finite",
        {"The reaction of ", ErrorObject{system.layout().name_of(system.layout().velocities + i)},
         non_finite_suffix(x.lambda[i]), " at t = ", ErrorTime{x.t}, " s. Check the forces on its bodies."});
}

/// Requires a state at which the model can be evaluated: `require_fitting`, `require_places`, `require_computable` and
/// finite multipliers. \throws InvalidInput otherwise. \param x state of the full model
template <class = void>
void require_usable(System const& system, State const& x) {
  require_fitting(system, x);
  require_places(system, x);
  require_computable(system, x);
  require_finite(x.lambda, "The multipliers of the state");
}

}  // namespace polybody
