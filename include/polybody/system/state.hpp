#pragma once
#include <polybody/math/dual.hpp>
#include <polybody/math/types.hpp>

namespace polybody {

/// The state of a model.
template <StateScalar T = double>
struct StateOf {
  VecXOf<T> q;       ///< (nq) coordinates
  VecXOf<T> v;       ///< (nv) speeds
  VecXOf<T> a;       ///< (nv) rates of the speeds
  VecXOf<T> lambda;  ///< (rows) multipliers; the joints' generalised force is −Gᵀλ
  double t = 0.0;    ///< time [s]
  VecXOf<T> memory;  ///< what the integrator carries from step to step beside the above
};

using State = StateOf<double>;

}  // namespace polybody
