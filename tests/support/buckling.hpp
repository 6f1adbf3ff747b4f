#pragma once
/// \file Right-angle frame of two flat strips (S9c, Argyris; data of Exudyn's rightAngleFrame.py), and the buckling
/// force of a structure.

#include <gtest/gtest.h>

#include <numbers>

#include <polybody/forces/loads.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/statics/equilibrium.hpp>
#include <polybody/vibration/modes.hpp>

namespace polybody {
namespace buckling {

/// The lowest squared frequency about x, negative if x is unstable.
template <class M>
double lowest(M const& model, State const& x) {
  double const w = modes(model, x, 1).frequency[0];
  return w * std::abs(w);
}

/// Zero of `lowest(force)` between a, stable, and b, unstable, by the secant method. The function is not evaluated at
/// the last iterate, because the stiffness is singular there.
template <class F>
double critical_force(F&& lowest, double a, double b) {
  double at_a = lowest(a), at_b = lowest(b);
  EXPECT_GT(at_a, 0.0);
  EXPECT_LT(at_b, 0.0);
  for (int i = 0; i < 30; ++i) {
    double const c = b - at_b * (b - a) / (at_b - at_a);
    if (std::abs(c - b) < 1e-5 * std::abs(c)) return c;
    a = b;
    at_a = at_b;
    b = c;
    at_b = lowest(c);
  }
  ADD_FAILURE() << "no critical force was found";
  return b;
}

/// Two legs of 240 mm, 30 mm high in the plane and 0.6 mm thick, in equilibrium under `force` at the tip. Units are N
/// and mm; the mass is arbitrary, as it does not affect stability. The reference values are for a frame without
/// shear: GA is ten times EA.
template <class B>
struct FlatFrame {
  using Clamp = Joint<Weld, Constraint>;
  Model<Bodies<B>, Joints<Clamp>, Forces<PointForce<>>> model;
  BodyHandle<B> first, second;
  State x;

  FlatFrame(Index n, double J, double force)
      : first(model.add(B::from(leg({}, J), n), "first leg")),
        second(model.add(B::from(leg(Placement::planar(240.0, 0.0, -0.5 * std::numbers::pi), J), n), "second leg")) {
    model.connect(Clamp{}, model.ground().at({0, 0, 0}), first.at(0.0), "clamp");
    model.connect(Clamp{}, first.at(240.0), second.at(0.0), "corner");
    model.apply(PointForce<>{.force = {force, 0, 0}}, second.at(240.0), "pull");
    x = model.reference_state();
    equilibrium(model, x);
  }
  static Bar leg(Placement const& placement, double J) {
    double const e = 71240, g = e / 2.62, b = 30, t = 0.6;
    return {.length = 240.0,
            .constants = BarConstants{.EA = e * b * t,
                                      .EI = e * t * b * b * b / 12,
                                      .mass_per_length = 1.0,
                                      .GA = 10 * e * b * t,
                                      .GJ = g * J,
                                      .rotary_inertia = 75.0,
                                      .EI_y = e * b * t * t * t / 12,
                                      .rotary_inertia_y = 75.0},
            .placement = placement};
  }
};

/// Searches between 1 and 1.2 N.
template <class B>
double critical_force_of_the_frame(Index n, double J) {
  return critical_force(
      [&](double force) {
        FlatFrame<B> const frame(n, J, force);
        return lowest(frame.model, frame.x);
      },
      1.0, 1.2);
}
inline double const thin_strip = 30 * 0.6 * 0.6 * 0.6 / 3;               ///< J = b t³/3
inline double const thick_strip = thin_strip * (1.0 - 0.63 * 0.6 / 30);  ///< for a strip of finite thickness

}  // namespace buckling
}  // namespace polybody
