#pragma once
#include <polybody/math/dual.hpp>
#include <polybody/math/errors.hpp>
#include <polybody/math/types.hpp>

namespace polybody {

/// The state of a model. First-order states z are speeds without a coordinate: they stand behind the speeds of the
/// bodies in v, and ż in a.
template <StateScalar T = double>
struct StateOf {
  VecXOf<T> q;        ///< (nq) coordinates
  VecXOf<T> v;        ///< (nv) speeds, then first-order states
  VecXOf<T> a;        ///< (nv) rates of the speeds
  VecXOf<T> lambda;   ///< (rows) multipliers; the joints' generalised force is −Gᵀλ
  double t = 0.0;     ///< time [s]
  VecXOf<T> history;  ///< what the integrator carries from step to step beside the above
};

using State = StateOf<double>;  ///< in doubles

namespace detail {
[[noreturn, gnu::cold]] inline void refuse_unfitting_state() {
  throw InvalidInput(
      "state.size",
      {"The state does not fit the model. Take it from reference_state() after the last body and joint were added."});
}
}  // namespace detail

}  // namespace polybody
