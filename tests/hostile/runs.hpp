#pragma once
/// \file Short runs for hostile parameters: every state of a run is finite.

#include <polybody/polybody.hpp>

#include "parameter_words.hpp"

namespace polybody {

inline void expect_finite(State const& x) {
  EXPECT_TRUE(x.q.allFinite()) << "q at t = " << x.t;
  EXPECT_TRUE(x.v.allFinite()) << "v at t = " << x.t;
  EXPECT_TRUE(x.a.allFinite()) << "a at t = " << x.t;
  EXPECT_TRUE(x.lambda.allFinite()) << "lambda at t = " << x.t;
  EXPECT_TRUE(std::isfinite(x.t));
}

/// At most ten steps of a run.
template <class M, class I>
void run_ten_steps(M const& model, I const& integrator, RunOptions const& options = {.end_time = 0.1, .step = 0.01}) {
  State x = model.reference_state();
  int steps = 0;
  try {
    for (State const& now : simulate(model, x, integrator, options)) {
      expect_finite(now);
      EXPECT_TRUE(std::isfinite(energy(model, now).total())) << "energy at t = " << now.t;
      if (++steps >= 10) break;
    }
  } catch (Error const&) {
    if (steps > 0) expect_finite(x);
    throw;
  }
}

}  // namespace polybody
