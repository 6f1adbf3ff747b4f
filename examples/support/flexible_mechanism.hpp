#pragma once
// Common parts of flexible mechanisms in space: one model type for each type of beam, so that cases share compiled
// code.
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/system/model.hpp>

namespace polybody::flexible {

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

}  // namespace polybody::flexible
