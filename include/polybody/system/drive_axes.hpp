#pragma once
/// \file
/// Check that driving constraints rotate about the axes of the revolute joints between the same bodies.

#include <array>
#include <string>
#include <utility>

#include <polybody/joints/joint_axis.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/math/sequence.hpp>

namespace polybody::detail {

/// Geometry whose only free rotation is about its own axis.
template <class G>
concept OneRotationFree = HasFreeDirections<G> && !G::free[3] && !G::free[4] && G::free[5];
/// Geometry that prescribes a rotation.
template <class G>
concept RotationDrive = HasRotationAxis<G> && requires(G g) { g.law; };

/// Pins (joints with one free rotation) and driving constraints between rigid bodies. A driving constraint and a pin
/// with different axes contradict each other.
class DriveAxes {
 public:
  /// Adds a driving constraint if `drives` is true, otherwise a pin. \param bodies indices of the first velocities of
  /// both bodies; −1 for the ground \param axis (3) unit vector in world axes of the reference state \param name name
  /// of the joint \throws InvalidInput if a driving constraint and a pin between the same bodies have different axes;
  /// the message names both joints.
  template <class = void>  // a template, to be compiled only if it is used
  [[gnu::cold]] void add(bool drives, std::pair<Index, Index> bodies, Vec3 const& axis, std::string const& name) {
    if (bodies.first > bodies.second) std::swap(bodies.first, bodies.second);
    for (Turn const& other : turns_[drives ? 0 : 1]) {
      if (other.bodies != bodies || parallel(axis, other.axis)) continue;
      Turn const mine{bodies, axis, name};
      Turn const &drive = drives ? mine : other, &pin = drives ? other : mine;
      throw InvalidInput(
          "drive.axis",
          {"\"", ErrorObject{drive.name}, "\" drives a rotation about ", text(drive.axis), ", but \"", pin.name,
           "\" allows only a rotation about ", text(pin.axis),
           " between these bodies (world axes in the reference configuration). Use the same axis for both."});
    }
    turns_[drives ? 1 : 0].push_back({bodies, axis, name});
  }

 private:
  struct Turn {
    std::pair<Index, Index> bodies;  ///< indices of the bodies' first velocities; −1 for the ground
    Vec3 axis;
    std::string name;
  };
  static bool parallel(Vec3 const& a, Vec3 const& b) {
    double off = 0.0;
    for (int i = 0; i < 3; ++i) {
      int const j = (i + 1) % 3, k = (i + 2) % 3;
      off += std::abs(a[j] * b[k] - a[k] * b[j]);
    }
    return off < 1e-6;
  }
  [[gnu::cold]] static std::string text(Vec3 const& x) { return sentence_of({"(", x[0], ", ", x[1], ", ", x[2], ")"}); }

  std::array<Sequence<Turn>, 2> turns_;  ///< pins, drives
};

}  // namespace polybody::detail
