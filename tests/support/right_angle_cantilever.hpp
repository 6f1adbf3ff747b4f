#pragma once
/// \file The right-angle cantilever of Simo & Vu-Quoc 1988 (D5), loaded out of its plane at the elbow and released.
/// The reference positions are those of an independent spectral beam computation.

#include <gtest/gtest.h>

#include <numbers>

#include <polybody/forces/loads.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "held.hpp"

namespace polybody {
namespace right_angle_cantilever {

/// Rises from 0 to 1 in one second, and falls back to 0 in the next.
struct Triangle {
  Motion operator()(double t) const { return {std::max(0.0, 1.0 - std::abs(t - 1.0)), 0.0, 0.0}; }
  std::vector<double> breakpoints() const { return {0.0, 1.0, 2.0}; }
};

inline Bar leg(Placement const& placement) {
  return {.length = 10.0,
          .constants =
              BarConstants{.EA = 1e6, .EI = 1e3, .mass_per_length = 1.0, .GA = 1e6, .GJ = 1e3, .rotary_inertia = 10.0},
          .placement = placement};
}

/// Two bodies of n elements each, welded to each other and to the ground. The model may have further joint types.
template <class B, class... MoreJoints>
struct RightAngle {
  using Clamp = Joint<Weld, Constraint>;
  using ModelType = Model<Bodies<B>, Joints<Clamp, MoreJoints...>, Forces<PointForce<Triangle>>>;
  ModelType model;
  BodyHandle<B> first, second;
  State x;
  double step;

  RightAngle(Index n, double h)
      : first(model.add(B::from(leg({}), n), "first leg")),
        second(model.add(B::from(leg(Placement::planar(10.0, 0.0, 0.5 * std::numbers::pi)), n), "second leg")),
        step(h) {
    model.connect(Clamp{}, model.ground().at({0, 0, 0}), first.at(0.0), "clamp");
    model.connect(Clamp{}, first.at(10.0), second.at(0.0), "elbow");
    model.apply(PointForce<Triangle>{.force = {0, 0, 50}}, first.at(10.0), "pull");
    x = model.reference_state();
  }
  auto run_until(double t) {
    return simulate(model, x, GeneralisedAlpha{.rho_inf = 0.9}, {.end_time = t, .step = step});
  }
  /// Displacements of elbow and tip in state `now`.
  Vec6 displacements(State const& now) const {
    Vec6 u;
    u << position(model, now, first.at(10.0)) - Vec3(10, 0, 0), position(model, now, second.at(10.0)) - Vec3(10, 10, 0);
    return u;
  }
  Vec6 displacements() const { return displacements(x); }
  double total_energy() const { return energy(model, x).total(); }
};

struct Row {
  double t;
  Vec6 u;  ///< displacements of the elbow and of the tip
};
inline Vec6 six(double a, double b, double c, double d, double e, double f) {
  return (Vec6() << a, b, c, d, e, f).finished();
}
inline std::vector<Row> const table{{1.0, six(-0.054196, 0.022882, 0.951314, -0.003017, -0.023389, 0.054032)},
                                    {2.0, six(-1.011114, 0.267389, 4.115246, 0.106261, -0.692150, 0.069264)},
                                    {3.0, six(-2.049120, 0.239660, 5.501669, 0.788497, -1.061500, 1.507208)},
                                    {4.0, six(-1.564395, -0.427658, 4.642069, 0.441982, -0.706241, 3.508934)},
                                    {5.0, six(-0.851796, -0.764270, 3.111415, -0.540678, -1.062475, 5.479398)},
                                    {6.5, six(-0.432203, -0.737574, 2.458433, -1.297841, -2.106396, 7.407788)},
                                    {10.0, six(-0.772368, 1.628793, -3.095969, 0.004320, -1.970278, 4.463120)},
                                    {15.0, six(-0.032206, 0.406228, 0.159847, -2.206730, -7.286780, -9.204403)},
                                    {20.0, six(-0.53038, 0.78234, -2.60194, 4.09300, -0.95680, 0.49603)},
                                    {30.0, six(-0.125769, -1.332901, -0.223688, -1.736554, -1.501012, 0.168538)}};

inline double const elbow_peak = 5.51285, tip_peak = 8.25210, plateau = 114.880346;

/// Errors at elbow and tip relative to the largest displacement.
inline double miss(Vec6 const& u, Vec6 const& exact) {
  return std::max((u - exact).head<3>().norm() / elbow_peak, (u - exact).tail<3>().norm() / tip_peak);
}

inline Claim exact_frame(char const* what, std::string const& formulation) {
  return {"D5", what, By::independent, "spectral geometrically exact beam, two meshes", formulation};
}
inline void held_displacements(Vec6 const& u, Row const& row, double tolerance, std::string const& formulation) {
  held_within(exact_frame("displacements of elbow and tip, of their peaks", formulation), miss(u, row.u), tolerance,
              {equals("t", row.t), 1.0});
}
inline void held_energy(double found, double tolerance, double t, std::string const& formulation) {
  held(exact_frame("energy after the pull [J]", formulation), found, plateau, tolerance * plateau, {equals("t", t)});
}

/// The reference rows up to 10 s.
template <class Cantilever>
void follows(Index n, double h, double tolerance, std::string const& formulation) {
  Cantilever frame(n, h);
  for (Row const& row : table) {
    if (row.t > 10.0) break;
    frame.run_until(row.t).run();
    held_displacements(frame.displacements(), row, tolerance, formulation);
    if (row.t >= 2.0) held_energy(frame.total_energy(), tolerance, row.t, formulation);
  }
}

}  // namespace right_angle_cantilever
}  // namespace polybody
