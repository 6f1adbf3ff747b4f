#pragma once
/// \file The spin-up of Kane, Ryan & Banerjee 1987 (D2), with tip positions of an independent spectral beam
/// computation.

#include <gtest/gtest.h>

#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "held.hpp"
#include "support/spin_up_arm.hpp"

namespace polybody {
namespace spin_up {

struct Row {
  double t, u1, u2;
};
inline std::vector<Row> const table{{2.5, -0.00132267702, -0.15128355864}, {5.0, -0.01265463625, -0.46847618344},
                                    {6.5, -0.01860342132, -0.56994836841}, {7.0, -0.01861825545, -0.57131180646},
                                    {7.5, -0.01774186447, -0.55908345896}, {10.0, -0.00707233630, -0.36281451565},
                                    {15.0, 5.13989706e-4, 1.30362629e-3},  {16.0, 5.13921471e-4, 3.0797417e-3},
                                    {17.0, 5.14138491e-4, -2.5335130e-3},  {18.0, 5.13873046e-4, -2.0682774e-3}};
inline double const largest_lag = -0.573835;   ///< at t = 6.762 s
inline double const steady = 5.139493e-4;      ///< mean of u₁ from 15 s on
inline double const swing_at_speed = 0.00364;  ///< largest |u₂| from 15 s on

/// Tolerance of u₂, relative to the largest lag up to 15 s and to the amplitude of the remaining swing after 15 s.
struct Share {
  double lag, swing;
};

/// Spins up the model whose arm ends in `tip`; u is the tip's displacement in the hub's axes. The foreshortening of
/// the tip is u₁ = −½ ∫ w′² ds, of second order in w: an error δ of u₂ causes 2 u₁ δ/u₂. The steady stretch is
/// compared to a thousandth.
template <class M, class Tip>
void follows(M const& model, Marker<Tip> const& tip, Share const& share, char const* formulation) {
  SpinUp const law = drive().geometry.law;
  State x = model.reference_state();
  double const tolerance = -share.lag * largest_lag, late = share.swing * swing_at_speed;
  auto const claim = [&](char const* what) {
    return Claim{"D2", what, By::independent, "spectral geometrically exact beam, two meshes", formulation};
  };
  std::size_t next = 0;
  double lag = 0.0, lag_time = 0.0, shortest = 0.0, sum = 0.0, swing = 0.0, astray = 0.0;
  int count = 0;
  for (State const& now : simulate(model, x, GeneralisedAlpha{.rho_inf = 0.9}, {.end_time = 18.0, .step = 5e-3})) {
    Vec3 const u = exp_so3<double>(Vec3(0, 0, -law(now.t).value)) * position(model, now, tip) - Vec3(10, 0, 0);
    if (next < table.size() && now.t >= table[next].t - 1e-9) {
      Row const& row = table[next++];
      bool const turns = row.t >= 15.0;
      Instance const at{equals("t", row.t), turns ? swing_at_speed : 0.0};
      held(claim(turns ? "u₂ of the tip from 15 s on [m]" : "u₂ of the tip up to 10 s [m]"), u[1], row.u2,
           turns ? late : tolerance, at);
      held(claim(turns ? "u₁ of the tip from 15 s on [m]" : "u₁ of the tip up to 10 s [m]"), u[0], row.u1,
           turns ? 1e-3 * steady : 2.0 * std::abs(row.u1 / row.u2) * tolerance, {at.at});
    }
    if (u[1] < lag) {
      lag = u[1];
      lag_time = now.t;
    }
    shortest = std::min(shortest, u[0]);
    astray = std::max(astray, std::abs(u[2]));
    if (now.t > 15.0) {
      sum += u[0];
      swing = std::max(swing, std::abs(u[1]));
      ++count;
    }
  }
  EXPECT_EQ(next, table.size());
  held(claim("largest lag u₂ [m]"), lag, largest_lag, tolerance);
  held(claim("time of the largest lag [s]"), lag_time, 6.762, 0.01);
  held(claim("largest shortening u₁ [m]"), shortest, -0.0188232, 0.07 * tolerance);
  held(claim("largest swing from 15 s on [m]"), swing, swing_at_speed, late);
  held(claim("mean stretch u₁ from 15 s on [m]"), sum / count, steady, 1e-3 * steady);
  EXPECT_EQ(astray, 0.0);
}

}  // namespace spin_up
}  // namespace polybody
