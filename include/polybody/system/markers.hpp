#pragma once
/// \file
/// Checks of names, markers and joints that are added to a model. The checks do not depend on the model's type.

#include <functional>
#include <string>
#include <utility>

#include <polybody/joints/joint_axis.hpp>
#include <polybody/math/errors.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/system/pools.hpp>

namespace polybody::detail {

/// Names in the order of their addition, with a hash table of open addressing for a search in constant time.
class Names {
 public:
  /// Returns a nonempty name unchanged, and "kind n" for an empty name. n is the first number above `before` for which
  /// the name is free.
  template <class = void>  // a template, to be compiled only if it is used
  [[gnu::cold]] std::string given_or_next(std::string name, char const* kind, std::size_t before) {
    if (!name.empty()) return name;
    Run& taken = run_of(kind);
    if (before < taken.from || before > taken.to) taken.from = taken.to = before;
    for (;; ++taken.to)
      if (name = kind + (" " + std::to_string(taken.to + 1)); !has(name)) return name;
  }
  /// \param what "body", "joint" or "force" \throws InvalidInput if the name is in use.
  template <class = void>
  void require_free(std::string const& name, char const* what) const {
    if (has(name))
      throw InvalidInput("model.duplicate_name", {"Duplicate name of a ", what, ": \"", ErrorObject{name},
                                                  "\". Use another name, or leave it empty to have one generated."});
  }
  template <class = void>
  [[gnu::cold]] void take(std::string const& name) {
    names_.push_back(name);
    if (2 * names_.size() <= slots_.size()) {
      slots_[slot_of(name)] = names_.size();
      return;
    }
    slots_.assign(std::max<std::size_t>(4 * names_.size(), 16), 0);
    for (std::size_t i = 0; i < names_.size(); ++i) slots_[slot_of(names_[i])] = i + 1;
  }

 private:
  /// Range of used numbers: "kind n" is in use for from < n ≤ to.
  struct Run {
    std::string kind;
    std::size_t from = 0, to = 0;
  };
  Run& run_of(char const* kind) {
    for (Run& run : runs_)
      if (run.kind == kind) return run;
    runs_.push_back({kind});
    return runs_.back();
  }

  /// Index of the slot of the name, or of the free slot for it.
  std::size_t slot_of(std::string const& name) const {
    std::size_t i = std::hash<std::string>{}(name) % slots_.size();
    while (slots_[i] != 0 && names_[slots_[i] - 1] != name) i = (i + 1) % slots_.size();
    return i;
  }
  bool has(std::string const& name) const { return !slots_.empty() && slots_[slot_of(name)] != 0; }

  Sequence<std::string> names_;
  Sequence<std::size_t> slots_;  ///< for each slot: index into `names_` plus one; zero for a free slot
  Sequence<Run> runs_;           ///< used numbers of each kind
};

/// Returns the name, or "kind n" with n = `before` + 1 if the name is empty.
inline std::string name_or_next(std::string name, char const* kind, std::size_t before) {
  return name.empty() ? kind + (" " + std::to_string(before + 1)) : std::move(name);
}

/// Joint axes (3×3) from the parameters of the joint, which are checked first. If the rotation axis of a planar joint
/// is not given, it is the normal of the plane. \throws InvalidInput naming the joint for invalid parameters.
template <bool in_plane, class J>
Mat3 checked_triad(J const& joint, std::string const& name) {
  std::string const quoted = sentence_of({"\"", name, "\""});
  if constexpr (requires { joint.geometry.check(name); }) joint.geometry.check(quoted);
  if constexpr (CompliantPolicy<typename J::PolicyType>) joint.policy.check(quoted);
  try {
    if constexpr (in_plane && HasRotationAxis<typename J::Geometry>)
      if (!joint.geometry.axis.given()) {
        typename J::Geometry about_z = joint.geometry;
        about_z.axis = Vec3(0.0, 0.0, 1.0);
        return about_z.triad();
      }
    return joint.geometry.triad();
  } catch (InvalidInput const& e) {
    throw InvalidInput({ErrorObject{quoted}, ": ", ErrorCause{e}});
  }
}

/// Requires that the marker's point provides the kinematics `needs`. \throws InvalidInput for a point without axes.
template <class B>
void require_observed(Marker<B> const& m, MarkerKind needs, std::string const& what) {
  if constexpr (requires { B::observes_at(m.point); })
    if (B::observes_at(m.point) < needs)
      throw InvalidInput("marker.no_axes", {"\"", ErrorObject{what},
                                            "\" needs axes, but a sliding point has none. Use a joint or force that "
                                            "needs a point only, such as Spherical or planar::Revolute."});
}

/// Requires markers that can move relative to each other. \throws InvalidInput if both are on the ground, or on the
/// same rigid body.
template <class A, class B>
void require_apart([[maybe_unused]] Marker<A> const& a, [[maybe_unused]] Marker<B> const& b,
                   [[maybe_unused]] std::string const& name) {
  if constexpr (std::is_same_v<A, Ground> && std::is_same_v<B, Ground>)
    throw InvalidInput("joint.same_body",
                       {"\"", ErrorObject{name}, "\" joins the ground to itself. Give it a marker of a body."});
  else if constexpr (std::is_same_v<A, B> && HasRigidLayout<A>)
    if (a.body == b.body)
      throw InvalidInput("joint.same_body",
                         {"\"", ErrorObject{name}, "\" joins a rigid body to itself. Give it markers of two bodies."});
}

/// Requires a point in the section of a node, if the body has nodes with frames. \throws InvalidInput naming the joint.
template <class B>
void require_node([[maybe_unused]] Marker<B> const& m, [[maybe_unused]] std::string const& name) {
  if constexpr (HasFrameNodes<B>)
    if (B::node_of(m.point) < 0)
      throw InvalidInput(
          "joint.not_at_a_node",
          {"\"", ErrorObject{name},
           "\" has joint coordinates, but its marker is between two nodes of the beam, in element ",
           ErrorValue{int(m.point.element)}, ". Use a mesh with a node at this point, or the policy Constraint."});
}

/// Requires a tangent parallel to the joint's axis at a second marker without axes. \throws InvalidInput naming the
/// joint if the sine of the angle between them exceeds 1e-6.
inline void require_along_tangent(Mat3 const& axes, Mat3 const& triad, std::string const& name) {
  if (axes.col(0).cross(triad.col(2)).norm() > 1e-6)
    throw InvalidInput("joint.axis_not_tangent",
                       {"\"", ErrorObject{name},
                        "\": the second marker has a tangent but no axes, so the joint's axis must be parallel to the "
                        "tangent in the reference configuration."});
}

/// Refuses a marker or handle of another model. \throws InvalidInput naming `what`.
[[noreturn, gnu::cold]] inline void refuse_marker_of_another_model(std::string const& what) {
  throw InvalidInput("model.foreign_handle",
                     {"\"", ErrorObject{what},
                      "\" was given a marker or handle of another model. Use a marker or handle of this model."});
}

}  // namespace polybody::detail
