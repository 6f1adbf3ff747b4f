#pragma once
/// \file
/// Pools in which a model stores its bodies, markers, joints and forces: one pool for each type.

#include <array>
#include <cstdint>
#include <string>

#include <polybody/bodies/shared/body.hpp>
#include <polybody/forces/force_group.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/kinematics/marker.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/system/state.hpp>

namespace polybody {

/// List of the types of bodies that a model can contain.
template <class... Bs>
struct Bodies {};
/// List of the types of joints that a model can contain.
template <class... Js>
struct Joints {};
/// List of the types of forces that a model can contain.
template <class... Fs>
struct Forces {};

/// Handle of a joint or a force element in a model. A default-constructed handle refers to nothing and is refused.
template <class Element>
struct ElementHandle {
  std::uint64_t model = 0;  ///< serial number of the model; 0: none
  Index index = 0;          ///< index among the joints or forces of its type
  std::string name = {};    ///< name in messages
};

namespace detail {

template <class B>
struct MarkerEntry {
  Index body;  ///< index of the body in the pool of its type
  typename B::Point point;
  Mat3 axes;        ///< (3×3) axes of the marker relative to those of the body at that point
  Index published;  ///< index of its data in `Data::markers`
};

template <class B>
struct BodyPool {
  BodyTable<B> entries;
  Sequence<MarkerEntry<B>> markers;
};

struct GroundMarker {
  Placement placement;
  Index published;
};

template <class J>
struct JointEntry {
  using JointType = J;
  J joint;
  Index a, b;      ///< marker indices
  Index row = -1;  ///< first constraint equation; −1 for a joint without equations
  std::string name;
  Index rows = 0;             ///< number of constraint equations
  Index linear = -1;          ///< for a linear joint: index among the model's `LinearConstraints`
  std::uint64_t made_in = 0;  ///< serial number of the model to which the joint was added
};

template <class F>
struct ForceEntry {
  F force;
  std::array<Index, F::markers> markers;  ///< marker indices
  std::string name;
  Index state = 0;            ///< index of its first state among the model's first-order states
  std::uint64_t made_in = 0;  ///< serial number of the model to which the force was added
  Index row = -1;             ///< first multiplier that the force follows; −1 for none
};
template <ForceGroup F>
struct ForceEntry<F> {
  F force;
  Sequence<Index> markers;
  std::string name;
  std::uint64_t made_in = 0;  ///< serial number of the model to which the group was added
};

/// Solution method for the joint coordinates of a model: that of the first policy with joint coordinates, or void.
template <class... Ps>
struct SolutionAmong {
  using Type = void;
};
template <class P, class... Ps>
struct SolutionAmong<P, Ps...> : SolutionAmong<Ps...> {};
template <JointCoordinatePolicy P, class... Ps>
struct SolutionAmong<P, Ps...> {
  using Type = typename P::Solution;
  static_assert(((!JointCoordinatePolicy<Ps> || std::is_same_v<typename SolutionAmong<Ps>::Type, void> ||
                  std::is_same_v<typename SolutionAmong<Ps>::Type, Type>) &&
                 ...),
                "All joints with joint coordinates of a model must use the same JointCoordinatesBy<...> option.");
};
template <class... Ps>
using SolutionOf = typename SolutionAmong<Ps...>::Type;

/// True if `entries` has an entry with this index that was added to the model with the serial number `serial`. A copied
/// model accepts handles of entries that it copied from its original. Neither model accepts handles of entries that
/// were added to the other model after the copy.
template <class Entries>
bool holds(Entries const& entries, Index index, std::uint64_t serial) {
  return index >= 0 && std::size_t(index) < entries.size() && entries[std::size_t(index)].made_in == serial;
}

/// Coordinates or velocities of one body.
template <class Vector>
auto body_part(Vector const& x, Index first, Index size) {
  using T = typename Vector::Scalar;
  return std::span<T const>(x.data() + first, std::size_t(size));
}
template <class Vector>
auto body_part_of(Vector& x, Index first, Index size) {
  using T = typename Vector::Scalar;
  return std::span<T>(x.data() + first, std::size_t(size));
}
/// Part of a vector of the user's state. \throws InvalidInput if the vector is too short.
template <class Vector>
auto checked_part(Vector& x, Index first, Index size) {
  if (first + size > x.size()) refuse_unfitting_state();
  return std::span(x.data() + first, std::size_t(size));
}

}  // namespace detail
}  // namespace polybody
