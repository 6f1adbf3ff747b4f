#pragma once
/// \file
/// Error norm of integrators with variable step.
/// Theory: Eqs. 6.31, 6.32.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <polybody/integrators/unknown_kinds.hpp>

namespace polybody::detail {

// Extents of the assemblies of a model, in space and in velocity.

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
  /// over the step also counts as an extent. The bodies of a tree without a joint to the ground are included at the end
  /// only.
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
    c->expand(q, v, full_q_, full_v_);
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
  Sequence<Point> full_positions_, full_velocities_;  // of trees not joined to the ground: a step has only their root
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

/// Absolute and relative tolerance of the errors of a step.
struct ErrorTolerance {
  double absolute, relative;

  /// Tolerated error of a group of unknowns with this `scale`. \param largest largest magnitude in the group, whose
  /// round-off is added
  double of(double scale, double largest) const {
    return absolute + relative * scale + 4.0 * std::numeric_limits<double>::epsilon() * largest;
  }
  /// Tolerated error of one first-order state, relative to its own magnitude, because first-order states have different
  /// units.
  double of_one(double before, double after) const {
    return absolute + relative * std::max(std::abs(before), std::abs(after));
  }
  /// Mean square of the entries of `error` from index `first` on, each divided by its tolerance `of_one`.
  double mean_square_each(VecX const& error, VecX const& before, VecX const& after, Index first) const {
    double sum = 0.0;
    for (Index i = first; i < error.size(); ++i) {
      double const x = error[i] / of_one(before[i], after[i]);
      sum += x * x;
    }
    return error.size() > first ? sum / double(error.size() - first) : 0.0;
  }
};

/// Scaled error of a step [Hairer, Nørsett & Wanner 1993, §II.4], with a scale for each kind of unknown of each body:
///   ‖e‖² = max_g ½ (mean over q in g of (e_q / tol(s_q))² + mean over v in g of (e_v / tol(s_v))²),
///   tol(s) = Atol + Rtol s + 4ε max_g |x|.
/// A group g contains the unknowns of one kind of one body. The scales are the maxima before and after the step of
///   lengths:    s_q the extent of the positions of the assembly, s_v the larger of the extent of its velocities and
///               the change of a velocity over the step;
///   rotations:  s_q = 1 (a quaternion, or one radian), s_v the larger of the largest rate of the group and the ratio
///               of the extents of the velocities and positions of the assembly;
///   others:     the largest entries of the group: gradients, deformations, sliders, coordinates of unknown unit.
/// An assembly consists of bodies that joints and forces connect; markers on the ground are points of the assembly, at
/// rest. Bodies without mutual forces therefore do not affect each other's scales. A common velocity, a common
/// translation and full revolutions do not change the scales. If an assembly has a single point, the world's origin is
/// its second point.
class ErrorNorm {
 public:
  /// Groups the unknowns of a time step. \param by_velocities true if errors of coordinates are increments δ of q ⊞ δ,
  /// which are numbered like velocities
  template <class = void>
  [[gnu::cold]] ErrorNorm(System const& system, bool by_velocities);

  /// Computes the scales from the state before and (q, v) after the step. The system must have been evaluated last at
  /// (q, v).
  void set_scales(System const& system, ErrorTolerance const& tolerance, State const& before, VecX const& q,
                  VecX const& v) {
    extents_.measure(system, before, q, v);
    for (Group& g : groups_) g.largest_q = g.largest_v = 0.0;
    for (VecX const* const x : {&before.q, &q})
      for (std::size_t i = 0; i < of_q_.size(); ++i) raise(of_coordinate(Index(i)).largest_q, (*x)[Index(i)]);
    for (VecX const* const x : {&before.v, &v})
      for (std::size_t i = 0; i < of_v_.size(); ++i) raise(of_velocity(Index(i)).largest_v, (*x)[Index(i)]);
    for (Group& g : groups_) {
      auto const [extent, speed] = extents_[g.assembly];
      bool const length = g.kind == UnknownKind::length, rotation = g.kind == UnknownKind::rotation;
      double const rate = rotation && extent > 0.0 ? std::max(g.largest_v, speed / extent) : g.largest_v;
      g.in_q = share(tolerance.of(length ? extent : rotation ? 1.0 : g.largest_q, g.largest_q), g.errors);
      g.in_v = share(tolerance.of(length ? speed : rate, g.largest_v), g.velocities);
    }
  }

  /// ‖e‖² of errors of coordinates and velocities, both numbered as velocities; not finite if an error is not finite.
  double mean_square(VecX const& q_error, VecX const& v_error) {
    for (Group& g : groups_) g.sum[0] = 0.0;
    for (std::size_t i = 0; i < of_v_.size(); ++i) {
      Group& g = groups_[of_v_[i]];
      double const q = q_error[Index(i)], v = v_error[Index(i)];
      g.sum[0] += g.in_q * q * q + g.in_v * v * v;
    }
    return 0.5 * largest_sums()[0];
  }

  /// Unknowns of one kind of one body.
  struct Group {
    UnknownKind kind = UnknownKind::other;
    std::uint32_t assembly = 0;
    Index errors = 0, velocities = 0;         ///< numbers of coordinates and of velocities
    double largest_q = 0.0, largest_v = 0.0;  ///< largest |q| and |v| before and after the step
    double in_q = 0.0, in_v = 0.0;            ///< factors of squared entries in the mean square
    std::array<double, 4> sum{};              ///< weighted sums of squares of up to four errors
  };
  Group& of_coordinate(Index i) { return groups_[of_q_[std::size_t(i)]]; }  ///< group of coordinate i
  Group& of_velocity(Index i) { return groups_[of_v_[std::size_t(i)]]; }    ///< group of velocity i
  /// Sets all sums to zero.
  void clear() {
    for (Group& g : groups_) g.sum.fill(0.0);
  }
  /// Largest sums over all groups; not finite if a sum is not finite.
  std::array<double, 4> largest_sums() const {
    std::array<double, 4> largest{};
    for (Group const& g : groups_)
      for (std::size_t j = 0; j < 4; ++j)
        if (!(g.sum[j] <= largest[j]) && !std::isnan(largest[j])) largest[j] = g.sum[j];
    return largest;
  }

 private:
  static double share(double tolerated, Index n) { return n > 0 ? 1.0 / (tolerated * tolerated * double(n)) : 0.0; }
  static void raise(double& largest, double x) { largest = std::max(largest, std::abs(x)); }

  Sequence<std::uint32_t> of_q_, of_v_;  // group of each coordinate and velocity
  Sequence<Group> groups_;
  AssemblyExtents extents_;
};

template <class>
ErrorNorm::ErrorNorm(System const& system, bool by_velocities) {
  UnknownPlaces const full = full_places(system.layout());
  UnknownPlaces const stepped = system.step_coordinates() ? stepped_places(system, full) : full;
  Sequence<Index> const assembly = assemblies_of(system.layout());
  extents_ = AssemblyExtents(system, full, stepped, assembly);
  Sequence<std::array<Index, 3>> number(assembly.size(), {-1, -1, -1});
  auto const group = [&](UnknownPlace const& x) {
    Index& n = number[std::size_t(x.body)][std::size_t(x.kind)];
    if (n < 0) {
      n = Index(groups_.size());
      groups_.push_back({.kind = x.kind, .assembly = std::uint32_t(assembly[std::size_t(x.body)])});
    }
    return std::uint32_t(n);
  };
  for (UnknownPlace const& x : stepped.of_q) {
    of_q_.push_back(group(x));
    ++groups_[of_q_.back()].errors;
  }
  for (UnknownPlace const& x : stepped.of_v) {
    of_v_.push_back(group(x));
    ++groups_[of_v_.back()].velocities;
  }
  if (by_velocities)
    for (Group& g : groups_) g.errors = g.velocities;
}

}  // namespace polybody::detail
