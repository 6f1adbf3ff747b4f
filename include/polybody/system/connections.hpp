#pragma once
/// \file
/// Addition of bodies, joints and forces to a model. These functions depend on the types of a joint or force and of its
/// bodies, but not on the type of the model. A program therefore compiles them once for all models.

#include <array>
#include <string>
#include <utility>

#include <polybody/forces/gravity.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/joint_axis.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/system/body_kernels.hpp>
#include <polybody/system/composition.hpp>
#include <polybody/system/linear_constraints.hpp>
#include <polybody/system/markers.hpp>

namespace polybody::detail {

// Check that a driving constraint rotates about the axis of the revolute joint between the same bodies.

/// Geometry whose only free rotation is about its own axis.
template <class G>
concept OneRotationFree = HasFreeDirections<G> && free_turns(free_directions<G>()) == 1 && free_directions<G>()[5];
/// Geometry that prescribes a rotation.
template <class G>
concept RotationDrive = HasRotationAxis<G> && requires(G g) { g.law; };

/// Pins (joints with one free rotation) and driving constraints between rigid bodies. A driving constraint and a pin
/// between the same bodies contradict each other if their axes are not parallel.
class DriveAxes {
 public:
  /// Adds a driving constraint if `drives` is true, otherwise a pin. \param bodies indices of the first velocities of
  /// both bodies; −1 for the ground \param axis (3) unit vector in world axes of the reference state \param name name
  /// of the joint \throws InvalidInput if the axes of a driving constraint and a pin between the same bodies are not
  /// parallel; the message names both joints.
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

/// Numbers of coordinates, equations, markers and bodies of a model. They are zero in a moved-from model, whose pools
/// are empty.
struct ModelCounts {
  Index coordinates = 0, velocities = 0, states = 0, rows = 0, markers = 0, jacobian_size = 0, bodies = 0;

  ModelCounts() = default;
  ModelCounts(ModelCounts const&) = default;
  ModelCounts& operator=(ModelCounts const&) = default;
  ModelCounts(ModelCounts&& other) noexcept : ModelCounts(other) { other.clear(); }
  ModelCounts& operator=(ModelCounts&& other) noexcept {
    ModelCounts const taken = other;
    other.clear();
    return *this = taken;
  }

 private:
  void clear() {
    ModelCounts const none{};
    *this = none;
  }
};

/// Data of a model that do not depend on its type: counts, names, ground markers and linear constraint equations.
struct ModelParts : ModelCounts {
  explicit ModelParts(Gravity const& g) : gravity(g) {}

  Gravity gravity;
  ModelOrigin origin = {};
  Sequence<GroundMarker> ground = {};
  Sequence<LinearConstraints> linear_rows = {};
  Sequence<Index> nonholonomic_equations = {};
  Names body_names = {}, joint_names = {}, force_names = {};
  DriveAxes drive_axes = {};

  std::uint64_t serial() const { return origin.serial(); }
  /// Requires that the ground with the serial number `given` belongs to this model or to an ancestor of it. \throws
  /// InvalidInput naming `what`.
  void require_own_ground(std::uint64_t given, std::string const& what) const {
    if (!accepts(serial(), origin.ancestors(), given)) refuse_marker_of_another_model(what);
  }
};

/// Marker with the pool of the marker's body. A marker of the ground has no pool.
template <class B>
struct PooledMarker {
  Marker<B> const& marker;
  BodyPool<B>& pool;
};
template <>
struct PooledMarker<Ground> {
  Marker<Ground> const& marker;
};

/// Returns the entry of the model to which `handle` refers. \throws InvalidInput for a handle of another model or a
/// default-constructed handle.
template <class Entries, class Handle>
auto& own_entry(Entries& entries, Handle const& handle) {
  require_filled(handle.model);
  if (!holds(entries, handle.index, handle.model)) refuse_marker_of_another_model(handle.name);
  return entries[std::size_t(handle.index)];
}

/// Requires that the body of the marker belongs to this model. \throws InvalidInput naming `what`.
template <class B>
void require_own(ModelParts const& parts, PooledMarker<B> const& m, std::string const& what) {
  if constexpr (std::is_same_v<B, Ground>)
    parts.require_own_ground(m.marker.model, what);
  else if (!holds(m.pool.entries, m.marker.body, m.marker.model))
    refuse_marker_of_another_model(what);
}

/// Axes (3×3) at a marker's point in the reference state, in world axes.
template <class B>
Mat3 reference_axes(PooledMarker<B> const& m) {
  if constexpr (std::is_same_v<B, Ground>)
    return m.marker.point.axes;
  else
    return BodyKernels<B, double>::reference_axes(m.pool, m.marker);
}

/// Index of the first velocity of the marker's body; −1 for the ground.
template <class B>
Index first_speed(PooledMarker<B> const& m) {
  if constexpr (std::is_same_v<B, Ground>)
    return -1;
  else
    return m.pool.entries[std::size_t(m.marker.body)].v0;
}

/// Adds a marker at the point of m, with `axes` relative to the axes of m. Returns the number of the new marker.
template <class B>
Index publish_at(ModelParts& parts, PooledMarker<B> const& m, Mat3 const& axes) {
  if constexpr (std::is_same_v<B, Ground>)
    parts.ground.push_back({{m.marker.point.origin, product(m.marker.point.axes, axes)}, parts.markers});
  else
    parts.jacobian_size += BodyKernels<B, double>::add_marker(m.pool, m.marker, axes, parts.markers);
  return parts.markers++;
}

/// Returns the linear point of a marker, and writes the indices of its first coordinate and velocity to `side`. A
/// ground point has two or three dimensions like `other`, the world of the other body. \throws InvalidInput naming the
/// joint `what` for a point that is not linear in the coordinates.
template <class B>
LinearPoint linear_side(PooledMarker<B> const& m, World other, LinearSide& side, std::string const& what) {
  if constexpr (std::is_same_v<B, Ground>) {
    return linear_ground(m.marker.point, other == World::plane ? 2 : 3);
  } else {
    auto const& e = m.pool.entries[std::size_t(m.marker.body)];
    side.q0 = e.q0 + e.body.first_column(m.marker.point);
    side.v0 = e.v0 + e.body.first_column(m.marker.point);
    try {
      return linear_point(e.body, m.marker.point);
    } catch (InvalidInput const& error) {
      throw InvalidInput({"\"", ErrorObject{what}, "\": ", ErrorCause{error}, " Use Constraint here."});
    }
  }
}

template <class B>
BodyHandle<B> add_body(ModelParts& parts, BodyPool<B>& pool, B const& body, std::string name) {
  name = parts.body_names.given_or_next(std::move(name), "body", std::size_t(parts.bodies));
  parts.body_names.require_free(name, "body");
  parts.origin.change();
  BodyKernels<B, double>::add(
      pool, body, name, {parts.coordinates, parts.velocities, HasOwnEquations<B> ? parts.rows : -1, parts.serial()});
  if constexpr (HasOwnEquations<B>) parts.rows += B::own_equations;
  parts.coordinates += pool.entries.back().body.coordinates();
  parts.velocities += pool.entries.back().body.velocities();
  ++parts.bodies;
  parts.body_names.take(name);
  return {parts.serial(), Index(pool.entries.size()) - 1, std::move(name), pool.entries.shared()};
}

/// Adds a joint between two markers. \throws InvalidInput if the joint cannot connect these markers; the message names
/// the joint.
template <class J, class A, class B>
[[gnu::cold]] ElementHandle<J> add_joint(ModelParts& parts, Sequence<JointEntry<J>>& pool, J const& joint,
                                         PooledMarker<A> const& a, PooledMarker<B> const& b, std::string name) {
  using G = typename J::Geometry;
  using P = typename J::PolicyType;
  using Requirement = typename J::Measured;
  name = parts.joint_names.given_or_next(std::move(name), G::name, pool.size());
  require_own(parts, a, name);
  require_own(parts, b, name);
  require_apart(a.marker, b.marker, name);
  Mat3 const triad = checked_triad<(A::world == World::plane || B::world == World::plane)>(joint, name);
  Mat3 const axes_a = reference_axes(a), axes_b = reference_axes(b);
  if constexpr (!LinearPolicy<P> && B::observes == MarkerKind::axis &&
                needs_of_second<Requirement>() == MarkerKind::axis)
    require_along_tangent(axes_b, triad, name);
  require_observed(a.marker, needs_of_first<Requirement>(), name);
  require_observed(b.marker, needs_of_second<Requirement>(), name);
  if constexpr (JointCoordinatePolicy<P>) {
    require_node(a.marker, name);
    require_node(b.marker, name);
  }
  parts.joint_names.require_free(name, "joint");
  parts.origin.change();
  if constexpr (LinearPolicy<P>) {  // before markers are added, because this may throw
    LinearConstraints rows{.name = name, .row = parts.rows};
    fill_linear_rows<G>(linear_side(a, B::world, rows.a, name), linear_side(b, A::world, rows.b, name), triad.col(2),
                        rows);
    parts.linear_rows.push_back(std::move(rows));
  }
  if constexpr (ConstrainingPolicy<P> && A::world != World::plane && B::world != World::plane &&
                (OneRotationFree<G> || RotationDrive<G>))
    if constexpr ((HasRigidLayout<A> || std::is_same_v<A, Ground>) && (HasRigidLayout<B> || std::is_same_v<B, Ground>))
      parts.drive_axes.add(RotationDrive<G>, {first_speed(a), first_speed(b)},
                           Vec3(triad(0, 2), triad(1, 2), triad(2, 2)), name);
  Index const pa = publish_at(parts, a, transposed_product(axes_a, triad));
  Index const pb = publish_at(parts, b, transposed_product(axes_b, triad));
  JointEntry<J> entry{joint, pa, pb, -1, name};
  entry.made_in = parts.serial();
  if constexpr (LinearPolicy<P>) {
    entry.linear = Index(parts.linear_rows.size()) - 1;
    entry.rows = parts.linear_rows.back().rows();
  } else if constexpr (ConstrainingPolicy<P>) {
    entry.rows = J::rows;
  }
  if constexpr (ConstrainingPolicy<P>) {
    entry.row = parts.rows;
    parts.rows += entry.rows;
    for (Index i = polybody::nonholonomic_equations<G>(); i > 0; --i)
      parts.nonholonomic_equations.push_back(parts.rows - i);
  }
  pool.push_back(std::move(entry));
  parts.joint_names.take(name);
  return {parts.serial(), Index(pool.size()) - 1, std::move(name)};
}

/// Name of a force, given or generated, after the check of its parameters. \throws InvalidInput for a duplicate name
/// and for invalid parameters; the message names the force.
template <class F>
std::string checked_force_name(ModelParts& parts, Sequence<ForceEntry<F>> const& pool, F const& force,
                               std::string name) {
  name = parts.force_names.given_or_next(std::move(name), "force", pool.size());
  force.check(sentence_of({"\"", name, "\""}));
  parts.force_names.require_free(name, "force");
  return name;
}
/// Adds a force element on markers of the model.
template <class F>
ElementHandle<F> enter_force(ModelParts& parts, Sequence<ForceEntry<F>>& pool, F const& force, std::string name,
                             std::array<Index, F::markers> const& markers) {
  pool.push_back({force, markers, name, parts.states, parts.serial()});
  parts.states += states_of<F>();
  parts.force_names.take(name);
  return {parts.serial(), Index(pool.size()) - 1, std::move(name)};
}

/// Adds a force element on the markers. \throws InvalidInput for a duplicate name and for invalid parameters or
/// markers; the message names the force.
template <class F, class... Bs>
ElementHandle<F> add_force(ModelParts& parts, Sequence<ForceEntry<F>>& pool, F const& force, std::string name,
                           PooledMarker<Bs> const&... markers) {
  name = checked_force_name(parts, pool, force, std::move(name));
  (require_own(parts, markers, name), ...);
  (require_observed(markers.marker, F::needs, name), ...);
  parts.origin.change();
  return enter_force(parts, pool, force, std::move(name), {publish_at(parts, markers, identity())...});
}

/// Adds a force group with its many markers. \throws InvalidInput for a duplicate name and for invalid parameters or
/// markers; the message names the group.
template <class F, class B>
ElementHandle<F> add_group(ModelParts& parts, Sequence<ForceEntry<F>>& pool, F const& group,
                           Sequence<PooledMarker<B>> const& many, std::string name) {
  name = parts.force_names.given_or_next(std::move(name), "group", pool.size());
  group.check(sentence_of({"\"", name, "\""}));
  ForceEntry<F> entry{group, {}, name, parts.serial()};
  for (PooledMarker<B> const& m : many) {
    require_own(parts, m, name);
    require_observed(m.marker, F::needs, name);
  }
  parts.force_names.require_free(name, "force");
  parts.origin.change();
  for (PooledMarker<B> const& m : many) entry.markers.push_back(publish_at(parts, m, identity()));
  if constexpr (requires { entry.force.set_many(0); }) entry.force.set_many(Index(many.size()));
  pool.push_back(std::move(entry));
  parts.force_names.take(name);
  return {parts.serial(), Index(pool.size()) - 1, std::move(name)};
}

/// Adds a contact partner with its contact law to a force group. \throws InvalidInput for invalid parameters or
/// markers; the message names the group.
template <class F, class Law, class B>
void add_contact_partner(ModelParts& parts, ForceEntry<F>& group, Law const& law, PooledMarker<B> const& one,
                         std::string name) {
  require_own(parts, one, group.name);
  name = name_or_next(std::move(name), "partner", group.markers.size() - std::size_t(group.force.many()));
  law.check(sentence_of({"\"", group.name, "\", \"", name, "\""}));
  require_observed(one.marker, needs_of_second<Law>(), group.name);
  parts.origin.change();
  group.markers.push_back(publish_at(parts, one, identity()));
  group.force.add_partner(law, Index(group.markers.size()) - 1, std::move(name));
}

/// Adds a member to a contact set. Returns its number. \throws InvalidInput for an invalid shape or marker; the message
/// names the set.
template <class F, class S, class B>
Index add_member(ModelParts& parts, ForceEntry<F>& set, S const& shape, PooledMarker<B> const& at, std::string name,
                 int group) {
  require_own(parts, at, set.name);
  name = name_or_next(std::move(name), "member", set.markers.size());
  shape.check(sentence_of({"\"", set.name, "\", \"", name, "\""}));
  require_observed(at.marker, S::needs, set.name);
  parts.origin.change();
  set.markers.push_back(publish_at(parts, at, identity()));
  set.force.add_member(shape, first_speed(at), group, std::move(name));
  return set.force.members() - 1;
}

/// Excludes the contact of two members of a contact set. \throws InvalidInput for a number outside of the set.
template <class F>
void exclude_members(ModelParts& parts, ForceEntry<F>& set, Index m, Index n) {
  for (Index const k : {m, n})
    if (k < 0 || k >= set.force.members())
      throw InvalidInput("contact.member", {"\"", ErrorObject{set.name}, "\": the number of a member must lie in [0, ",
                                            int(set.force.members()) - 1, "], but is ", ErrorValue{int(k)}, "."});
  parts.origin.change();
  set.force.exclude(m, n);
}

/// Refuses at compile time a joint that cannot connect markers of A and B.
template <class J, class A, class B>
constexpr void require_pairing() {
  using G = typename J::Geometry;
  using P = typename J::PolicyType;
  static_assert(SameWorld<G, A, B>,
                "A planar joint connects planar bodies, and a spatial joint connects spatial bodies; the ground "
                "belongs to both.");
  static_assert(
      JointCoordinatesIfRequired<P, G>,
      "JointCoordinates needs a joint whose motion has coordinates, such as Revolute, Prismatic, Spherical or "
      "Universal. A Distance or a Gear has no such coordinates: use Constraint.");
  static_assert(
      !JointCoordinatePolicy<P> || (EliminableBody<P, A> && EliminableBody<P, B>),
      "JointCoordinates supports joints between the ground, rigid bodies, floating frames, and nodes of beams "
      "with rotations: Rigid<>, Ffr, Lrvf, Se3Beam and those of polybody::planar; "
      "JointCoordinatesBy<ArticulatedBody> supports rigid bodies only. Use another policy for other bodies.");
  static_assert(!LinearPolicy<P> || (EliminableBody<P, A> && EliminableBody<P, B>),
                "AncfLinear needs markers that are linear in the coordinates, such as those of ANCF bodies and the "
                "ground. Markers of Rigid, Ffr, Se3Beam and spatial Lrvf are not linear: use Constraint for them.");
  static_assert(LinearIfRequired<P, G>,
                "AncfLinear supports Spherical, Revolute and Weld; other joints are not linear in the coordinates.");
  static_assert(
      SufficientFirstMarker<J, A> && SufficientSecondMarker<J, B>,
      "This joint needs a marker with axes, but this body provides only a point or a tangent. Use a joint that needs "
      "only points, such as Spherical. To clamp a cable, use a Revolute about its tangent, with the cable's marker "
      "second.");
}

}  // namespace polybody::detail
