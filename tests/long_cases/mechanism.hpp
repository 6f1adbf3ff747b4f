#pragma once
/// \file
/// Common parts of the flexible mechanisms M1, M2, M3 and M7: one model type for each type of beam, so that the cases
/// share compiled code.

#include <gtest/gtest.h>

#include <functional>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/marker_frames.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/statics/equilibrium.hpp>

#include "support/held.hpp"

namespace polybody::long_cases {

/// Angle as an arbitrary function of time.
struct Turn {
  std::function<Motion(double)> law;
  std::vector<double> ends = {};  ///< end times of its parts
  Motion operator()(double t) const { return law(t); }
  std::vector<double> breakpoints() const { return ends; }
};

using Hinge = Joint<Revolute, Constraint>;
using Drive = Joint<PrescribedAngle<Turn>, Constraint>;
using Ball = Joint<Spherical, Constraint>;
using Sleeve = Joint<Cylindrical, Constraint>;
using Fixed = Joint<Weld, Constraint>;

template <class B>
using BodiesOf = std::conditional_t<std::is_same_v<B, Rigid<>>, Bodies<B>, Bodies<B, Rigid<>>>;
template <class B>
using Mechanism = Model<BodiesOf<B>, Joints<Hinge, Drive, Ball, Sleeve, Fixed>>;

/// Mesh of a bar in a formulation, and the name of the formulation in the tables.
template <class B>
struct Mesh {
  std::string name;
  std::function<B(Bar const&, Index)> make;
};

inline Hinge hinge(Vec3 const& axis) { return {Revolute{.axis = axis}, {}}; }
inline Drive drive(Vec3 const& axis, Turn const& turn) {
  return {PrescribedAngle<Turn>{.law = turn, .axis = axis}, {}};
}

/// Angle of a rotation R about the axis c, within one revolution of `near`: sin θ c is the axial vector of R, 2 cos θ
/// + 1 its trace.
inline double angle_about(Mat3 const& r, Vec3 const& c, double near) {
  Vec3 const axial(r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1));
  double const angle = std::atan2(0.5 * c.dot(axial), 0.5 * (r.trace() - 1.0));
  return near + std::remainder(angle - near, 2.0 * std::numbers::pi);
}

/// Limit of two meshes whose errors have the given `ratio`.
inline double extrapolated(double coarse, double fine, double ratio) { return fine + (fine - coarse) / (ratio - 1.0); }

}  // namespace polybody::long_cases
