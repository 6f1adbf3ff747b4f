#pragma once
/// \file
/// The Body concept: what a formulation supplies, and the second-order term that dual numbers supply for it.

#include <span>

#include <polybody/kinematics/published.hpp>

namespace polybody {

/// `n` entries of a body's coordinates or speeds `x` from `first`, as a vector expression.
template <int n, class T>
auto part(std::span<T> x, Index first) {
  using Scalar = std::remove_const_t<T>;
  using Map = std::conditional_t<std::is_const_v<T>, Eigen::Map<Vec<Scalar, n> const>, Eigen::Map<Vec<Scalar, n>>>;
  return Map(x.data() + first);
}

/// The same entries of `x` from `first` as a vector: `n` numbers are copied without Eigen's expressions, which cost
/// more to compile.
template <int n, class T>
Vec<std::remove_const_t<T>, n> entries(std::span<T> x, Index first) {
  Vec<std::remove_const_t<T>, n> out;
  for (int i = 0; i < n; ++i) out[i] = x[std::size_t(first + i)];
  return out;
}
/// Writes `value` (n) into x from entry `first` on.
template <int n, class T>
void set_entries(std::span<T> x, Index first, Vec<T, n> const& value) {
  for (int i = 0; i < n; ++i) x[std::size_t(first + i)] = value[i];
}

/// How a rigid body whose pose a joint may give writes it: coordinates and speeds.
enum class RigidLayout : unsigned char {
  quaternion,  ///< (r, unit quaternion) and (ṙ, Ω in body axes)
  plane        ///< (x, y, θ) and their rates
};

/// A rigid body that says how it writes its pose, from its centre of mass.
template <class B>
concept HasRigidLayout = requires {
  { B::layout } -> std::convertible_to<RigidLayout>;
};

/// A body that deforms in a frame whose pose a joint may give: first the coordinates and speeds of the frame, which
/// `frame_layout` names, then those of the deformation, which add. All its markers are of run-time width.
template <class B>
concept FloatsOnFrame = requires(B const b) {
  { B::frame_layout } -> std::convertible_to<RigidLayout>;
  { b.deformations() } -> std::convertible_to<Index>;
};

/// Bodies that nothing but weight and their own inertia moves, m r̈ = m g and J Ω˙ + Ω × J Ω = 0, where no joint or
/// force acts: a type says so of itself, not of those derived from it.
template <class B>
inline constexpr bool moves_by_newton_euler = false;

/// A body whose points are linear in its coordinates, r = S e with constant S; and so are so many of the gradients r_α.
template <class B>
concept HasLinearPoints = requires(B const b, typename B::Point p) {
  { B::gradients } -> std::convertible_to<int>;
  b.position_map(p);
};

/// A body is made of elements: fixed-size units that yield inertia, force and tangent. Spans cover the whole
/// body; element e touches the columns [first_column(e), first_column(e) + element_columns). A body whose size is known
/// at run time only says `element_columns = Eigen::Dynamic`: it is one element, and touches all its columns. Positions
/// may live on a manifold, q ⊞ δ (`plus`); δ has as many entries as there are speeds. A `Point` is copied and has a
/// default; `at(…)` makes one. `docs/extending.md` tells what each member gives, and what else a body may have.
template <class B>
concept Body = requires(B const b, Index e, std::span<double const> x, std::span<double> out, typename B::Point p,
                        Published<double>& published, Vec<double, B::element_columns>& vector,
                        Mat<double, B::element_columns, B::element_columns>& matrix,
                        Mat<double, B::point_columns, B::point_columns>& stiffness, Vec3 g) {
  { B::world } -> std::convertible_to<World>;
  { B::observes } -> std::convertible_to<Observes>;
  { B::constant_mass } -> std::convertible_to<bool>;
  { b.coordinates() } -> std::convertible_to<Index>;
  { b.speeds() } -> std::convertible_to<Index>;
  { b.elements() } -> std::convertible_to<Index>;
  { b.first_column(e) } -> std::convertible_to<Index>;
  b.reference(out);                             // q of the undeformed body as placed
  b.template plus<double>(x, x, out);           // q ⊞ δ
  b.template local_rate<double>(x, x, out);     // δ˙ of q ⊞ δ moving with speeds v
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
  b.template publish<double>(p, identity(), x, x, published);
  b.load_stiffness(p, x, Wrench<double>{}, stiffness);  // ∂(Jᵀw)/∂q
};

/// A body that owns rows between its coordinates, such as the norm of Euler parameters: Φ(q) = 0 with G = ∂Φ/∂q
/// (own_rows × all speeds of the body, whose number is fixed) and γ, Φ̈ = G v̇ + γ. They are counted and solved like a
/// joint's.
template <class B>
concept OwnsRows = requires(B const b, std::span<double const> x, Vec<double, B::own_rows>& rows,
                            Mat<double, B::own_rows, B::element_columns>& map,
                            Mat<double, B::element_columns, B::element_columns>& stiffness) {
  b.template own_gap<double>(x, rows);                        // Φ
  b.template own_map<double>(x, map);                         // G
  b.template own_gamma<double>(x, x, rows);                   // γ(q, v)
  b.own_stiffness(x, Vec<double, B::own_rows>(), stiffness);  // ∂(Gᵀλ)/∂q
};

/// A body may say how near its beams are to buckling by axial forces that its deflection leaves out, with a sign: at −1
/// they buckle. A run warns of it.
template <class B>
concept LeavesOutAxialForces =
    requires(B const b, std::span<double const> x, Vec3 g, std::span<PlacedWrench const> loads) {
      { b.axial_share(x, x, x, g, loads) } -> std::convertible_to<double>;  // at q, v, v̇
    };

/// Columns that an element of a body, or a marker on it, touches. A body whose markers differ says `columns_of(point)`.
template <class B>
Index element_columns(B const& body) {
  return B::element_columns == Eigen::Dynamic ? body.speeds() : Index(B::element_columns);
}
/// Columns that a marker at p of `body` touches.
template <class B>
Index point_columns(B const& body, [[maybe_unused]] typename B::Point const& p) {
  if constexpr (requires { body.columns_of(p); })
    return body.columns_of(p);
  else
    return B::point_columns == Eigen::Dynamic ? body.speeds() : Index(B::point_columns);
}

/// Coordinates, speeds and accelerations of a body.
template <StateScalar T = double>
struct BodyMotion {
  std::span<T const> q, v, a = {};  ///< q, v and v̇ of the whole body
};

/// A body of one element that adds M v̇ − f, less its weight under g, to its `speeds` rows itself: where that is little,
/// to write its parts and read them again takes longer than they do.
template <class B, class T>
concept AddsUnbalance =
    requires(B const b, BodyMotion<T> const& x, Vec3 const& g, T* rows) { b.add_unbalance(x, g, rows); };

/// What the loops over a body's elements need besides it: on the stack where sizes are known at compile time, else kept
/// with the body's data, so that no step allocates.
template <class B, class T>
struct ForceScratch {
  Vec<T, B::element_columns> x, force, weight;  ///< for an element: M a − f, force and weight
  VecXOf<T> room;                               ///< for a body that balances at once
  /// Takes the sizes that are known at run time only from the body.
  explicit ForceScratch([[maybe_unused]] B const& body) {
    if constexpr (B::element_columns == Eigen::Dynamic)
      for (auto* const v : {&x, &force, &weight}) v->resize(body.speeds());
    if constexpr (requires { body.room(); }) room.resize(body.room());
  }
};
/// Room for an element's tangent and mass.
template <class B>
struct TangentScratch {
  Mat<double, B::element_columns, B::element_columns> k, m;  ///< tangent and mass
  /// Takes the sizes that are known at run time only from the body.
  explicit TangentScratch([[maybe_unused]] B const& body) {
    if constexpr (B::element_columns == Eigen::Dynamic)
      for (auto* const matrix : {&k, &m}) matrix->resize(body.speeds(), body.speeds());
  }
};

namespace detail {
/// Kept with the data for each body of run-time size; nothing for the others.
template <class B, class T>
struct KeptScratch {
  MatX of_point;  ///< for a marker's load stiffness, where its size is known at run time only
  explicit KeptScratch([[maybe_unused]] B const& body) {
    if constexpr (B::point_columns == Eigen::Dynamic) of_point.resize(body.speeds(), body.speeds());
  }
  ForceScratch<B, T> force_scratch(B const& body) const { return ForceScratch<B, T>(body); }
  TangentScratch<B> tangent_scratch(B const& body) const { return TangentScratch<B>(body); }
  MatX& point_scratch() { return of_point; }
};
template <class B, class T>
  requires(B::element_columns == Eigen::Dynamic)
struct KeptScratch<B, T> {
  ForceScratch<B, T> force;
  TangentScratch<B> tangent;
  explicit KeptScratch(B const& body) : force(body), tangent(body) {}
  ForceScratch<B, T>& force_scratch(B const&) { return force; }
  TangentScratch<B>& tangent_scratch(B const&) { return tangent; }
  MatX& point_scratch() { return tangent.k; }
};
}  // namespace detail

/// A body whose points share what is dear to compute: `pose` once, then `publish` each point from it.
template <class B, class T>
concept SharesPose = requires(B const b, std::span<T const> x, typename B::Point p, typename B::template Pose<T>& pose,
                              Published<T>& out) {
  b.template pose<T>(x, x, pose);
  b.publish(p, identity(), pose, out);
};

namespace detail {
struct NoPose {};
template <class B, class T>
struct PoseOf {
  using Type = NoPose;
};
template <class B, class T>
  requires SharesPose<B, T>
struct PoseOf<B, T> {
  using Type = typename B::template Pose<T>;
};
}  // namespace detail

/// ∂(Jᵀw)/∂q, columns × columns, of a marker with J of fixed width by dual numbers: the default for a body
/// that has no closed form and whose coordinates add, q ⊞ δ = q + δ. `body.local(p)` is p in a body made of the
/// marker's columns only.
template <class B>
void load_stiffness_by_duals(B const& body, typename B::Point const& p, std::span<double const> q,
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
  Published<D> published;
  published.jacobian = jacobian.data();
  published.columns = n;
  published.shape = JacobianShape::dense;
  body.template publish<D>(body.local(p), identity(), std::span<D const>(coordinates), std::span<D const>(at_rest),
                           published);
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
