#pragma once
/// \file
/// The direction of a joint, which has no default: left out, the joint is refused as it is connected.

#include <polybody/joints/constraint_functions.hpp>

namespace polybody {

/// A unit vector (3), world axes at the reference configuration. The joint's own axes, in which its rows are written,
/// do not depend on it.
class JointAxis {
 public:
  JointAxis() = default;  ///< left out
  /// From the vector v (3). Its length is checked where the joint is connected, not here.
  JointAxis(Vec3 const& v) : value_(v), given_(true) {}  // NOLINT: reads as a vector
  /// From three components: x, y, z.
  JointAxis(double x, double y, double z) : value_(x, y, z), given_(true) {}  // NOLINT
  /// From an expression `x` that makes a vector (3).
  template <class X>
    requires std::is_class_v<X> && (!std::is_base_of_v<JointAxis, X>) && std::is_convertible_v<X const&, Vec3>
  JointAxis(X const& x) : value_(x), given_(true) {}  // NOLINT: from an expression that makes a vector

  bool given() const { return given_; }  ///< whether it was given
  /// The direction, not checked; (0, 0, 1) where it was left out.
  operator Vec3 const&() const { return value_; }  // NOLINT
  /// \throws InvalidInput where it was left out; `what` names joint and direction.
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

/// The axis of a turn that serves the plane, too. There it is the plane's normal, which needs no telling.
class TurnAxis : public JointAxis {
 public:
  using JointAxis::JointAxis;  ///< from a vector v, from x, y, z, as `JointAxis`
};

/// A geometry that turns about one.
template <class G>
concept HasRotationAxis = requires(G g) {
  { g.axis } -> std::same_as<TurnAxis&>;
};

namespace constraint_functions {

/// Axes whose third one is `axis`. \throws InvalidInput for an axis that is left out or not of length one, by the name
/// `what`.
template <class = void>  // compiled where it is used
Mat3 triad_about(JointAxis const& axis, std::string const& what) {
  return triad_about(axis.required(what), what);
}

}  // namespace constraint_functions
}  // namespace polybody
