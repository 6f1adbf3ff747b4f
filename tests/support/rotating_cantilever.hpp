#pragma once
/// \file A cantilever of unit ρA, EI and L, clamped at the axis to a hub in steady rotation (E3; Wright et al. 1982).

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/vibration/steady_rotation.hpp>

#include "held.hpp"

namespace polybody {

/// Frequencies of flap and chord together, ascending, for nine angular velocities; inextensible Euler–Bernoulli beam.
struct RotatingCantilever {
  double omega;
  double frequency[6];
};
inline constexpr RotatingCantilever rotating_cantilevers[] = {
    {0.0, {3.516015, 3.516015, 22.034491, 22.034491, 61.697214, 61.697214}},
    {1.0, {3.543236, 3.681647, 22.158458, 22.181011, 61.833677, 61.841763}},
    {2.0, {3.621797, 4.137320, 22.526311, 22.614922, 62.241059, 62.273184}},
    {3.0, {3.743512, 4.797279, 23.126493, 23.320264, 62.913481, 62.984967}},
    {4.0, {3.897723, 5.585001, 23.941501, 24.273349, 63.841573, 63.966760}},
    {6.0, {4.263225, 7.360373, 26.129042, 26.809082, 66.413436, 66.683914}},
    {8.0, {4.657150, 9.256837, 28.908873, 29.995382, 69.836241, 70.292962}},
    {10.0, {5.048975, 11.202328, 32.119686, 33.640366, 73.976464, 74.649295}},
    {12.0, {5.427049, 13.170150, 35.636976, 37.603112, 78.704925, 79.614478}}};

/// Compares the frequency `found` with the table, within a relative tolerance; i counts flap and chord together.
inline void held_frequency(RotatingCantilever const& row, int i, double found, double share, char const* formulation) {
  held({"E3", "flap and chord frequencies of a rotating cantilever, ω √(ρA L⁴/EI)", By::independent,
        "collocation; Wright et al. 1982 at Ω = 12", formulation},
       found, row.frequency[i], share * row.frequency[i], {equals("Ω", row.omega) + ", mode " + std::to_string(i + 1)});
}

/// Stretch and shear stiffnesses are so high that their effect is negligible: a frequency loses about Ω²/EA and ω
/// EI/GA.
inline Bar blade() {
  return {.length = 1.0,
          .constants =
              BarConstants{.EA = 1e8, .EI = 1.0, .mass_per_length = 1.0, .GA = 1e8, .GJ = 1.0, .rotary_inertia = 1e-8},
          .placement = Placement::at({1, 2, 3}, {0.4, -0.9, 1.7})};
}

/// The six lowest frequencies of the body made of `blade()`, in steady rotation about a general axis.
template <class B>
Vec6 frequencies_in_rotation(B const& body, double omega) {
  using Pin = Joint<Revolute, Constraint>;
  using Drive = Joint<PrescribedAngle<Ramp>, Constraint>;
  using Clamp = Joint<Weld, Constraint>;
  Model<Bodies<Rigid<>, B>, Joints<Pin, Drive, Clamp>> model;
  Placement const root = blade().placement;
  Vec3 const axis = root.axes.col(2);
  auto const hub = model.add(Rigid<>(1.0, Mat3::Identity(), root), "hub");
  auto const arm = model.add(body, "blade");
  model.connect(Pin{{.axis = axis}, {}}, model.ground().at(root), hub.at({0, 0, 0}), "shaft");
  model.connect(Drive{{Ramp{.target = omega, .duration = 1.0}, axis}, {}}, model.ground().at(root), hub.at({0, 0, 0}),
                "drive");
  if constexpr (B::observes == MarkerKind::frame)
    model.connect(Clamp{}, hub.at({0, 0, 0}), arm.at(0.0), "clamp");
  else
    model.connect(Pin{{.axis = root.axes.col(0)}, {}}, hub.at({0, 0, 0}), arm.at(0.0), "clamp");
  State x = model.reference_state();
  SteadyRotation const rotation{.angular_velocity = omega * axis, .point = root.origin};
  relative_equilibrium(model, x, rotation, {.tolerance = 1e-9});
  DampedModes const modes = damped_modes(linearise(model, x, rotation), 6);
  Vec6 found;
  for (Index i = 0; i < 6; ++i) {
    EXPECT_LT(std::abs(modes.damping_ratio(i)), 1e-6) << omega << ' ' << i;
    found[i] = modes.frequency(i);
  }
  return found;
}

}  // namespace polybody
