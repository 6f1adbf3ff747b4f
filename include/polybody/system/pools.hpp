#pragma once
/// \file
/// What a model stores of each body, marker, joint and force: typed pools, one per type.

#include <array>
#include <cstdint>
#include <string>

#include <polybody/bodies/shared/body.hpp>
#include <polybody/forces/force_group.hpp>
#include <polybody/joints/policies/ancf_linear.hpp>
#include <polybody/joints/policies/joint_coordinates.hpp>
#include <polybody/kinematics/marker.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/system/state.hpp>

namespace polybody {

/// The types that a model may hold.
template <class... Bs>
struct Bodies {};
template <class... Js>
struct Joints {};
template <class... Fs>
struct Forces {};

/// Handle of a joint or a force element in a model. One made by default names nothing and is refused.
template <class Element>
struct ElementHandle {
  std::uint64_t model = 0;  ///< the model's serial number; 0: none
  Index index = 0;          ///< among the joints or forces of its type
  std::string name = {};    ///< its name in messages
};

namespace detail {

template <class B>
struct MarkerEntry {
  Index body;  ///< in the pool of its type
  typename B::Point point;
  Mat3 axes;        ///< (3×3) the marker's axes in the body's at that point
  Index published;  ///< where its data stand
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
  Index a, b;      ///< published markers
  Index row = -1;  ///< first row; −1 for a joint without rows
  std::string name;
  Index rows = 0;             ///< how many
  Index linear = -1;          ///< of a linear joint: its place among the model's linear rows
  std::uint64_t made_in = 0;  ///< serial number of the model that it was added to
};

template <class F>
struct ForceEntry {
  F force;
  std::array<Index, F::markers> markers;  ///< published
  std::string name;
  Index state = 0;            ///< first of its own, among the model's first-order states
  std::uint64_t made_in = 0;  ///< serial number of the model that it was added to
};
template <ForceGroup F>
struct ForceEntry<F> {
  F force;
  Sequence<Index> markers;
  std::string name;
  std::uint64_t made_in = 0;  ///< as above
};

/// How the joint coordinates of a model are solved for: what the first policy says that makes any.
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

/// Whether the entries hold a part with this index that was added to the model with the number `serial`. A copied model
/// accepts the handles of the parts that it got from its original, and neither accepts those added to the other later.
template <class Capabilities>
bool holds(Capabilities const& entries, Index index, std::uint64_t serial) {
  return index >= 0 && std::size_t(index) < entries.size() && entries[std::size_t(index)].made_in == serial;
}

/// Coordinates or speeds of one body.
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
/// A part of a vector of the user's state. \throws InvalidInput where the vector ends before.
template <class Vector>
auto checked_part(Vector& x, Index first, Index size) {
  if (first + size > x.size()) refuse_unfitting_state();
  return std::span(x.data() + first, std::size_t(size));
}

}  // namespace detail
}  // namespace polybody
