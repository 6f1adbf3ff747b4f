#pragma once
/// \file
/// State of a model: coordinates, velocities, accelerations, multipliers, time and integrator history.

#include <polybody/math/dual.hpp>
#include <polybody/math/errors.hpp>
#include <polybody/math/types.hpp>

namespace polybody {

/// State of a model. First-order states z have no coordinate. In v, they come after the generalised velocities of the
/// bodies; in a, their derivatives ż come after the accelerations of the bodies.
template <StateScalar T = double>
struct StateOf {
  VecXOf<T> q;        ///< (nq) generalised coordinates
  VecXOf<T> v;        ///< (nv) generalised velocities, then first-order states
  VecXOf<T> a;        ///< (nv) time derivative of v
  VecXOf<T> lambda;   ///< (rows) multipliers; the generalised force of the joints is −Gᵀλ
  double t = 0.0;     ///< time [s]
  VecXOf<T> history;  ///< integrator history: further numbers that the integrator needs in the next step
};

using State = StateOf<double>;  ///< state of doubles

namespace detail {
[[noreturn, gnu::cold]] inline void refuse_unfitting_state() {
  throw InvalidInput("state.size",
                     {"The state does not fit the model: their numbers of coordinates, velocities, accelerations or "
                      "multipliers differ. Use model.reference_state() after the last body and joint are added."});
}
}  // namespace detail

}  // namespace polybody
