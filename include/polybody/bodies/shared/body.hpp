#pragma once
/// \file
/// Concepts of bodies, which list the members that a body type must have. Further contents are the workspaces of loops
/// over elements, and the load stiffness of a marker by dual numbers.
/// Theory: Eq. 1.30.

#include <span>

#include <polybody/kinematics/marker_kinematics.hpp>

namespace polybody {

/// Map of `n` successive entries of x, the coordinates or generalised velocities of a body, beginning at `first`.
template <int n, class T>
auto part(std::span<T> x, Index first) {
  using Scalar = std::remove_const_t<T>;
  using Map = std::conditional_t<std::is_const_v<T>, Eigen::Map<Vec<Scalar, n> const>, Eigen::Map<Vec<Scalar, n>>>;
  return Map(x.data() + first);
}

/// Copy of `n` entries of `x` beginning at `first`, as a vector. The copy compiles faster than Eigen's expressions.
template <int n, class T>
Vec<std::remove_const_t<T>, n> entries(std::span<T> x, Index first) {
  Vec<std::remove_const_t<T>, n> out;
  for (int i = 0; i < n; ++i) out[i] = x[std::size_t(first + i)];
  return out;
}
/// Writes `value` (n) to x, beginning at entry `first`.
template <int n, class T>
void set_entries(std::span<T> x, Index first, Vec<T, n> const& value) {
  for (int i = 0; i < n; ++i) x[std::size_t(first + i)] = value[i];
}

/// Order of the coordinates and generalised velocities of a rigid body that joints with `JointCoordinates` can move.
enum class RigidLayout : unsigned char {
  quaternion,  ///< (r, unit quaternion) and (ṙ, Ω in body axes)
  plane        ///< (x, y, θ) and their rates
};

/// Rigid body that declares the order of its coordinates, which are the position of the centre of mass and the
/// rotation.
template <class B>
concept HasRigidLayout = requires {
  { B::layout } -> std::convertible_to<RigidLayout>;
};

/// Body that deforms relative to a frame which joints with `JointCoordinates` can move. The coordinates and generalised
/// velocities of the frame come first, in the order `frame_layout`. The coordinates of the deformation follow and form
/// a vector space. The number of columns of a marker is known only at run time.
template <class B>
concept FloatingFrameBody = requires(B const b) {
  { B::frame_layout } -> std::convertible_to<RigidLayout>;
  { b.deformations() } -> std::convertible_to<Index>;
};

/// Chain of nodes with frames, which joints with `JointCoordinates` can connect. A node has the coordinates and the
/// generalised velocities of a rigid body (`RigidLayout`), stored one node after another. `node_of(p)` is the number of
/// the node in whose section the point p is; −1 between nodes. `node_arm(p)` (3) is the vector from the node to p, in
/// the axes of the node [m].
template <class B>
concept HasFrameNodes = requires(B const b, typename B::Point p) {
  { B::node_of(p) } -> std::same_as<Index>;
  { b.node_arm(p) } -> std::same_as<Vec3>;
};

/// True for bodies that move by m r̈ = m g and J Ω˙ + Ω × J Ω = 0 if only gravity acts on them. The declaration holds
/// for the type itself and not for derived types.
template <class B>
inline constexpr bool moves_by_newton_euler = false;

/// Body whose points are linear in the coordinates e of their element, r = S e. `position_map` returns the constant
/// matrix S. `gradients` is the number of position gradients ∂r/∂x, ∂r/∂y, ∂r/∂z that are also linear in e.
template <class B>
concept HasLinearPoints = requires(B const b, typename B::Point p) {
  { B::gradients } -> std::convertible_to<int>;
  b.position_map(p);
};

/// Body whose elements compute inertia, force and tangent. The spans contain the coordinates or velocities of the whole
/// body. Element e uses the columns [first_column(e), first_column(e) + element_columns). A body whose size is known
/// only at run time has `element_columns = Eigen::Dynamic` and a single element with all columns. Coordinates may be on
/// a manifold, q ⊞ δ (`plus`); δ has as many entries as there are generalised velocities. A `Point` can be copied and
/// default-constructed; `at(…)` creates a point. `docs/extending.md` describes each member, and the optional members.
template <class B>
concept Body = requires(B const b, Index e, std::span<double const> x, std::span<double> out, typename B::Point p,
                        MarkerKinematics<double>& published, Vec<double, B::element_columns>& vector,
                        Mat<double, B::element_columns, B::element_columns>& matrix,
                        Mat<double, B::point_columns, B::point_columns>& stiffness, Vec3 g) {
  { B::world } -> std::convertible_to<World>;
  { B::observes } -> std::convertible_to<MarkerKind>;
  { B::constant_mass } -> std::convertible_to<bool>;
  { b.coordinates() } -> std::convertible_to<Index>;
  { b.velocities() } -> std::convertible_to<Index>;
  { b.elements() } -> std::convertible_to<Index>;
  { b.first_column(e) } -> std::convertible_to<Index>;
  b.reference(out);                             // q of the undeformed body as placed
  b.template plus<double>(x, x, out);           // q ⊞ δ
  b.template local_rate<double>(x, x, out);     // δ˙ of q ⊞ δ for velocities v
  b.rigid_velocity(x, g, g, out);               // v of a rigid motion
  b.mass(e, x, matrix);                         // M
  b.template inertia<double>(e, x, x, vector);  // M a
  b.template force<double>(e, x, x, vector);    // elastic, damping and quadratic-velocity force
  b.tangent(e, x, x, 1.0, 1.0, matrix);         // ck (−∂f/∂q) + cd (−∂f/∂v)
  b.template gravity<double>(e, x, g, vector);  // force of a uniform field g [m/s²]
  { b.kinetic_energy(e, x, x) } -> std::convertible_to<double>;
  { b.strain_energy(e, x) } -> std::convertible_to<double>;
  { b.gravity_energy(e, x, g) } -> std::convertible_to<double>;
  { b.first_column(p) } -> std::convertible_to<Index>;
  b.template evaluate_marker<double>(p, identity(), x, x, published);
  b.load_stiffness(p, x, Wrench<double>{}, stiffness);  // ∂(Jᵀw)/∂q
};

/// Body with its own constraint equations between its coordinates, such as |θ| = 1 for Euler parameters θ:
///   Φ(q) = 0,  G = ∂Φ/∂q,  Φ̈ = G v̇ + γ.
/// G has `own_equations` rows and one column for each generalised velocity of the body. The number of generalised
/// velocities is known at compile time. The equations are counted and solved like those of a joint.
template <class B>
concept HasOwnEquations = requires(B const b, std::span<double const> x, Vec<double, B::own_equations>& rows,
                                   Mat<double, B::own_equations, B::element_columns>& map,
                                   Mat<double, B::element_columns, B::element_columns>& stiffness) {
  b.template own_constraint<double>(x, rows);                      // Φ
  b.template own_jacobian<double>(x, map);                         // G
  b.template own_gamma<double>(x, x, rows);                        // γ(q, v)
  b.own_stiffness(x, Vec<double, B::own_equations>(), stiffness);  // ∂(Gᵀλ)/∂q
};

/// Body whose deflection does not include the effect of axial forces (geometric stiffening). `axial_share` returns the
/// factor between its axial forces and those at which its beams buckle, negative in compression: at −1 the beams
/// buckle. A run warns if the magnitude is at least 0.05.
template <class B>
concept WithoutGeometricStiffening =
    requires(B const b, std::span<double const> x, Vec3 g, std::span<PlacedWrench const> loads) {
      { b.axial_share(x, x, x, g, loads) } -> std::convertible_to<double>;  // at q, v, v̇
    };

/// Number of columns of an element of `body`.
template <class B>
Index element_columns(B const& body) {
  return B::element_columns == Eigen::Dynamic ? body.velocities() : Index(B::element_columns);
}
/// Number of columns of a marker at p on `body`. A body whose markers differ in size defines `columns_of(p)`.
template <class B>
Index point_columns(B const& body, [[maybe_unused]] typename B::Point const& p) {
  if constexpr (requires { body.columns_of(p); })
    return body.columns_of(p);
  else
    return B::point_columns == Eigen::Dynamic ? body.velocities() : Index(B::point_columns);
}

/// Coordinates, generalised velocities and accelerations of a body.
template <StateScalar T = double>
struct BodyMotion {
  std::span<T const> q, v, a = {};  ///< q, v and v̇ of the whole body
};

/// Body of one element that adds its residual, M v̇ − f minus the weight under g, to the rows of its generalised
/// velocities. For a small body this sum is faster than storing the terms and reading them again.
template <class B, class T>
concept HasBodyResidual =
    requires(B const b, BodyMotion<T> const& x, Vec3 const& g, T* rows) { b.add_residual(x, g, rows); };

/// Workspace of the loops over the elements of a body. The workspace is on the stack if the sizes are known at compile
/// time. Otherwise it is stored with the data of the body, so that no step allocates memory.
template <class B, class T>
struct ForceScratch {
  Vec<T, B::element_columns> x, force, weight;  ///< residual M a − f, force f and weight of an element
  VecXOf<T> workspace;                          ///< workspace of `residual`, if the body has this function
  /// Sets the sizes that are known only at run time.
  explicit ForceScratch([[maybe_unused]] B const& body) {
    if constexpr (B::element_columns == Eigen::Dynamic)
      for (auto* const v : {&x, &force, &weight}) v->resize(body.velocities());
    if constexpr (requires { body.workspace_size(); }) workspace.resize(body.workspace_size());
  }
};
/// Workspace for the tangent and the mass matrix of an element.
template <class B>
struct TangentScratch {
  Mat<double, B::element_columns, B::element_columns> k, m;  ///< tangent and mass matrix
  /// Sets the sizes that are known only at run time.
  explicit TangentScratch([[maybe_unused]] B const& body) {
    if constexpr (B::element_columns == Eigen::Dynamic)
      for (auto* const matrix : {&k, &m}) matrix->resize(body.velocities(), body.velocities());
  }
};

namespace detail {
/// Workspace stored for each body. It contains the workspace of an element if the size of the body is known only at run
/// time.
template <class B, class T>
struct ThreadScratch {
  MatX of_point;  ///< load stiffness of a marker whose size is known only at run time
  explicit ThreadScratch([[maybe_unused]] B const& body) {
    if constexpr (B::point_columns == Eigen::Dynamic) of_point.resize(body.velocities(), body.velocities());
  }
  ForceScratch<B, T> force_scratch(B const& body) const { return ForceScratch<B, T>(body); }
  TangentScratch<B> tangent_scratch(B const& body) const { return TangentScratch<B>(body); }
  MatX& point_scratch() { return of_point; }
};
template <class B, class T>
  requires(B::element_columns == Eigen::Dynamic)
struct ThreadScratch<B, T> {
  ForceScratch<B, T> force;
  TangentScratch<B> tangent;
  explicit ThreadScratch(B const& body) : force(body), tangent(body) {}
  ForceScratch<B, T>& force_scratch(B const&) { return force; }
  TangentScratch<B>& tangent_scratch(B const&) { return tangent; }
  MatX& point_scratch() { return tangent.k; }
};
}  // namespace detail

/// Body whose points share costly intermediate results: `pose` computes them once, then `evaluate_marker` uses them for
/// each point.
template <class B, class T>
concept HasSharedPose = requires(B const b, std::span<T const> x, typename B::Point p,
                                 typename B::template Pose<T>& pose, MarkerKinematics<T>& out) {
  b.template pose<T>(x, x, pose);
  b.evaluate_marker(p, identity(), pose, out);
};

namespace detail {
struct NoPose {};
template <class B, class T>
struct PoseOf {
  using Type = NoPose;
};
template <class B, class T>
  requires HasSharedPose<B, T>
struct PoseOf<B, T> {
  using Type = typename B::template Pose<T>;
};
}  // namespace detail

/// Load stiffness ∂(Jᵀw)/∂q (columns × columns) of a marker whose J has a fixed number of columns, by dual numbers. The
/// coordinates of the body must add, q ⊞ δ = q + δ. `body.local(p)` is the point p for a body that has only the
/// coordinates on which the marker depends.
template <class B>
void load_stiffness_by_dual_numbers(B const& body, typename B::Point const& p, std::span<double const> q,
                                    Wrench<double> const& w, Mat<double, B::point_columns, B::point_columns>& out) {
  constexpr int n = B::point_columns;
  using D = Dual<n>;
  std::array<D, n> coordinates, at_rest;
  std::array<D, 6 * n> jacobian;
  Index const first = body.first_column(p);
  for (int i = 0; i < n; ++i) {
    coordinates[i] = D::variable(q[first + i], i);
    at_rest[i] = D(0.0);
  }
  MarkerKinematics<D> published;
  published.jacobian = jacobian.data();
  published.columns = n;
  published.shape = JacobianShape::dense;
  body.template evaluate_marker<D>(body.local(p), identity(), std::span<D const>(coordinates),
                                   std::span<D const>(at_rest), published);
  Mat<D, 6, 1> wrench;
  for (int i = 0; i < 3; ++i) {
    wrench[i] = D(w.f[i]);
    wrench[i + 3] = D(w.m[i]);
  }
  Mat<D, n, 1> force;
  published.pull(wrench, force);
  for (int i = 0; i < n; ++i) out.row(i) = force[i].d.matrix().transpose();
}

}  // namespace polybody
