#pragma once
/// \file
/// Direction of a joint. There is no default direction: `connect` refuses a joint without a direction, unless the
/// direction is the rotation axis of a planar model.

#include <polybody/joints/constraint_functions.hpp>

namespace polybody {

/// Unit vector (3), world axes at the reference configuration. The constraint equations contain the marker axes of
/// `triad()`, not this vector.
class JointAxis {
 public:
  JointAxis() = default;  ///< no direction given
  /// Direction v (3). `connect` checks its length.
  JointAxis(Vec3 const& v) : value_(v), given_(true) {}  // NOLINT: reads as a vector
  /// Direction with the components x, y, z.
  JointAxis(double x, double y, double z) : value_(x, y, z), given_(true) {}  // NOLINT
  /// Direction from an expression `x` with a vector (3) as its value.
  template <class X>
    requires std::is_class_v<X> && (!std::is_base_of_v<JointAxis, X>) && std::is_convertible_v<X const&, Vec3>
  JointAxis(X const& x) : value_(x), given_(true) {}  // NOLINT: from an expression that makes a vector

  bool given() const { return given_; }  ///< true if a direction is given
  /// Direction without a check; (0, 0, 1) if none is given.
  operator Vec3 const&() const { return value_; }  // NOLINT
  /// Given direction (3). \throws InvalidInput if no direction is given; `what` names joint and direction.
  Vec3 const& required(std::string const& what) const {
    if (!given_)
      throw InvalidInput(
          "joint.no_axis",
          {ErrorObject{what},
           " is missing. Give a unit vector in world axes at the reference configuration, such as {0, 0, 1}."});
    return value_;
  }

 private:
  Vec3 value_ = Vec3(0.0, 0.0, 1.0);
  bool given_ = false;
};

/// Rotation axis of a geometry for space and for the plane. In the plane the axis is the normal and may be omitted.
class TurnAxis : public JointAxis {
 public:
  using JointAxis::JointAxis;  ///< from a vector v, or from x, y, z, like `JointAxis`
};

/// Geometry with a rotation about a `TurnAxis`.
template <class G>
concept HasRotationAxis = requires(G g) {
  { g.axis } -> std::same_as<TurnAxis&>;
};

namespace constraint_functions {

/// Right-handed triad with the third axis `axis`. \throws InvalidInput, with the name `what`, if the axis is missing or
/// its length is not one.
template <class = void>  // compiled only if used
Mat3 triad_about(JointAxis const& axis, std::string const& what) {
  return triad_about(axis.required(what), what);
}

}  // namespace constraint_functions
}  // namespace polybody
