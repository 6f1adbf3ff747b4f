#pragma once
/// \file
/// Extents of the assemblies of a model, in space and in velocity.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <polybody/integrators/unknown_kinds.hpp>

namespace polybody::detail {

/// Extents of the positions and velocities of each assembly of bodies that joints and forces connect. A common
/// translation and a common velocity do not change the extents. Markers on the ground are points of an assembly, at
/// rest. If an assembly has a single point, the world's origin is its second point.
class AssemblyExtents {
 public:
  /// Largest extents along the world axes.
  struct Extent {
    double length = 0.0;  ///< extent of the positions [m]
    double speed = 0.0;   ///< extent of the velocities [m/s]
  };

  AssemblyExtents() = default;
  /// \param full, stepped unknowns of the model and of a time step \param assembly index of the assembly of each body
  template <class = void>
  [[gnu::cold]] AssemblyExtents(System const& system, UnknownPlaces const& full, UnknownPlaces const& stepped,
                                Sequence<Index> const& assembly);

  /// Computes the extents before and at the end (q, v) of a step, and keeps the larger ones. A change of a velocity
  /// over the step also counts as an extent. The bodies of a floating tree are included at the end only.
  void measure(System const& system, State const& before, VecX const& q, VecX const& v) {
    for (Box& box : boxes_) box.extent = {};
    add(positions_, before.q, &Box::ground, &Extent::length);
    add(positions_, q, &Box::ground, &Extent::length);
    add(velocities_, before.v, &Box::rest, &Extent::speed);
    add(velocities_, v, &Box::rest, &Extent::speed);
    for (Point const& p : velocities_) {
      double& speed = boxes_[p.assembly].extent.speed;
      speed = std::max(speed, std::abs(v[p.entry] - before.v[p.entry]));
    }
    if (full_positions_.empty()) return;
    Coordinates const& c = system.step_coordinates();
    c.entries->expand(c.self.get(), q, v, full_q_, full_v_);
    add(full_positions_, full_q_, &Box::ground, &Extent::length);
    add(full_velocities_, full_v_, &Box::rest, &Extent::speed);
  }
  /// Extents of an assembly, from the last `measure`.
  Extent const& operator[](std::size_t assembly) const { return boxes_[assembly].extent; }

 private:
  static constexpr double never = std::numeric_limits<double>::infinity();
  /// Bounds along the world axes; empty without points.
  struct Bounds {
    std::array<double, 3> least{never, never, never}, most{-never, -never, -never};
    void stretch(std::size_t axis, double x) {
      least[axis] = std::min(least[axis], x);
      most[axis] = std::max(most[axis], x);
    }
  };
  struct Box {
    Bounds ground, rest;  ///< bounds of the points at rest: positions, velocities
    Bounds bounds;        ///< workspace
    Extent extent;
  };
  /// Component of a position or velocity: its index in q or v, its assembly and its world axis.
  struct Point {
    Index entry;
    std::uint32_t assembly;
    signed char axis;
  };

  void add(Sequence<Point> const& points, VecX const& x, Bounds Box::* still, double Extent::* of) {
    for (Box& box : boxes_) box.bounds = box.*still;
    for (Point const& p : points) boxes_[p.assembly].bounds.stretch(std::size_t(p.axis), x[p.entry]);
    for (Box& box : boxes_)
      for (std::size_t i = 0; i < 3; ++i)
        box.extent.*of = std::max(box.extent.*of, box.bounds.most[i] - box.bounds.least[i]);
  }
  static Sequence<Point> points_of(Sequence<UnknownPlace> const& unknowns, Sequence<Index> const& assembly) {
    Sequence<Point> out;
    for (std::size_t i = 0; i < unknowns.size(); ++i)
      if (unknowns[i].axis >= 0)
        out.push_back({Index(i), std::uint32_t(assembly[std::size_t(unknowns[i].body)]), unknowns[i].axis});
    return out;
  }
  template <class = void>
  void add_ground(System const& system, Sequence<Index> const& assembly, Sequence<Index>& points);

  Sequence<Box> boxes_;
  Sequence<Point> positions_, velocities_;            // of a time step
  Sequence<Point> full_positions_, full_velocities_;  // of floating trees: a step has the coordinates of the root only
  VecX full_q_, full_v_;
};

template <class>
AssemblyExtents::AssemblyExtents(System const& system, UnknownPlaces const& full, UnknownPlaces const& stepped,
                                 Sequence<Index> const& assembly)
    : positions_(points_of(stepped.of_q, assembly)), velocities_(points_of(stepped.of_v, assembly)) {
  Index count = 0;
  for (Index const a : assembly) count = std::max(count, a + 1);
  boxes_.resize(std::size_t(count));
  Sequence<Index> points(std::size_t(count), 0);
  for (Point const& p : positions_) points[p.assembly] += p.axis == 0;
  if (system.step_coordinates()) {
    Sequence<Point> const positions = points_of(full.of_q, assembly), velocities = points_of(full.of_v, assembly);
    Sequence<Index> all(std::size_t(count), 0);
    for (Point const& p : positions) all[p.assembly] += p.axis == 0;
    auto const floats = [&](Point const& p) { return points[p.assembly] > 0 && points[p.assembly] < all[p.assembly]; };
    for (Point const& p : positions)
      if (floats(p)) full_positions_.push_back(p);
    for (Point const& p : velocities)
      if (floats(p)) full_velocities_.push_back(p);
    for (Point const& p : full_positions_) points[p.assembly] = all[p.assembly];
    full_q_.setZero(system.layout().coordinates);
    full_v_.setZero(system.layout().velocities);
  }
  add_ground(system, assembly, points);
}

/// Adds the markers on the ground. \param points number of points of each assembly
template <class>
void AssemblyExtents::add_ground(System const& system, Sequence<Index> const& assembly, Sequence<Index>& points) {
  ModelLayout const& layout = system.layout();
  auto const add_rest = [](Box& box, Vec3 const& r) {
    for (std::size_t i = 0; i < 3; ++i) {
      box.ground.stretch(i, r[Index(i)]);
      box.rest.stretch(i, 0.0);
    }
  };
  auto const owner = [&](Index marker) { return marker < 0 ? Index(-1) : layout.owners[std::size_t(marker)]; };
  auto const add_marker = [&](Index marker, Index body) {
    if (marker < 0 || body < 0 || owner(marker) >= 0) return;
    std::size_t const k = std::size_t(assembly[std::size_t(body)]);
    add_rest(boxes_[k], system.data().markers[std::size_t(marker)].frame.r);
    ++points[k];
  };
  for (JointLayout const& j : layout.joints) {
    add_marker(j.a, owner(j.b));
    add_marker(j.b, owner(j.a));
  }
  for (ForceLayout const& f : layout.forces) {
    Index body = -1;
    for (Index const marker : f.markers) body = std::max(body, owner(marker));
    for (Index const marker : f.markers) add_marker(marker, body);
  }
  for (std::size_t k = 0; k < boxes_.size(); ++k)
    if (points[k] < 2) add_rest(boxes_[k], Vec3(0, 0, 0));
}

}  // namespace polybody::detail
