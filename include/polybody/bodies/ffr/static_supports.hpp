#pragma once
/// \file
/// Reference conditions that hold a structure without straining it.

#include <polybody/bodies/ffr/ffr_basis.hpp>

namespace polybody {

/// Adds statically determinate supports to `frame`: conditions that prevent rigid motions without straining the
/// structure. All coordinates of the first node a are held. If nodes have no rotations, two more nodes are held. Node b
/// is farthest from a and is held along two coordinate axes: all but the one closest to the line a–b. Node c is
/// farthest from this line and is held along the axis closest to the normal of the plane through a, b and c.
template <class = void>  // compiled only if used
ReferenceConditions statically_determinate(Structure const& s, ReferenceConditions frame = {}) {
  for (int c = 0; c < s.per_node; ++c) frame.fix(0, c);
  if (s.per_node == 6) return frame;
  auto const farthest = [&](auto const& measure) {
    Index best = 0;
    for (Index i = 1; i < Index(s.nodes.size()); ++i)
      if (measure(i).squaredNorm() > measure(best).squaredNorm()) best = i;
    return best;
  };
  auto const from_first = [&](Index i) { return Vec3(s.nodes[std::size_t(i)] - s.nodes.front()); };
  Index const b = farthest(from_first);
  Vec3 const line = from_first(b);
  auto const off_line = [&](Index i) { return Vec3(line.cross(from_first(i))); };
  Index const c = farthest(off_line);
  int along = 0, across = 0;
  line.cwiseAbs().maxCoeff(&along);
  off_line(c).cwiseAbs().maxCoeff(&across);
  return frame.fix(b, (along + 1) % 3).fix(b, (along + 2) % 3).fix(c, across);
}

}  // namespace polybody
