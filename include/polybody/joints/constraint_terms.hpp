#pragma once
/// \file
/// Interface between joint geometries and policies: constraint function, Jacobians and prescribed rate of a joint.
/// Theory: Eqs. 4.1 to 4.3, 4.17.

#include <array>
#include <utility>

#include <polybody/kinematics/frame.hpp>

namespace polybody {

namespace detail {
/// Zero matrix with one assignment for each entry, so that compilers keep the entries in registers. For a loop, g++ -O2
/// emits a string instruction, whose startup needs as much time as the evaluation of a joint's constraint function.
template <class M>
M stored_zeros() {
  M m;
  [&]<std::size_t... i>(std::index_sequence<i...>) {
    ((m.data()[i] = typename M::Scalar(0.0)), ...);
  }(std::make_index_sequence<std::size_t(M::SizeAtCompileTime)>{});
  return m;
}
}  // namespace detail

/// Constraint function of m equations between frame a and frame b, with its Jacobians:
///   ġ = Ga Va + Gb Vb + Φ_t,   V = [ṙ; ω] in world axes.
/// The equations are holonomic, except the last `nonholonomic_equations` of a geometry: these define only a rate, and
/// their g is zero.
template <int m, StateScalar T = double>
struct ConstraintTerms {
  static constexpr int rows = m;
  Vec<T, m> g = detail::zeros<Vec<T, m>>();                ///< (m) violation [m], [rad] or [1]
  Mat<T, m, 6> Ga = detail::stored_zeros<Mat<T, m, 6>>();  ///< (m×6) Jacobian for the twist of frame a
  Mat<T, m, 6> Gb = detail::stored_zeros<Mat<T, m, 6>>();  ///< (m×6) Jacobian for the twist of frame b
  Vec<T, m> rate = detail::zeros<Vec<T, m>>();  ///< (m) Φ_t: the part of ġ that is prescribed as a function of time
};

/// Axis i of a frame: column i of A.
template <StateScalar T>
Vec<T, 3> axis_of(Frame<T> const& frame, int i) {
  return {frame.A(0, i), frame.A(1, i), frame.A(2, i)};
}

/// Twist [ṙ; ω] of a frame.
template <StateScalar T>
Vec<T, 6> twist(Frame<T> const& frame) {
  Vec<T, 6> v;
  for (int i = 0; i < 3; ++i) {
    v[i] = frame.v[i];
    v[3 + i] = frame.w[i];
  }
  return v;
}

/// Pose and twist of b relative to a, in the axes of a.
template <StateScalar T = double>
struct RelativeMotion {
  Vec<T, 3> d;     ///< (3) r_b − r_a in a's axes [m]
  Mat<T, 3, 3> R;  ///< (3×3) AaᵀAb
  Vec<T, 3> v;     ///< (3) rate of r_b − r_a relative to a, in a's axes [m/s]
  Vec<T, 3> w;     ///< (3) ω_b − ω_a in a's axes [rad/s]
};

/// Pose and twist of b relative to a, in the axes of a.
template <StateScalar T>
RelativeMotion<T> relative(Frame<T> const& a, Frame<T> const& b) {
  Vec<T, 3> const d = b.r - a.r;
  return {a.A.transpose() * d, a.A.transpose() * b.A, a.A.transpose() * (b.v - a.v - a.w.cross(d)),
          a.A.transpose() * (b.w - a.w)};
}

/// Geometry with a list of its constraint equations (`EquationList`, constraint_functions.hpp).
template <class G>
concept HasEquationList = requires { G::Equations::rows; };

/// Number of constraint equations of a geometry: its member `rows`, or that of its list; zero if both are missing.
template <class G>
constexpr int constraint_equations() {
  if constexpr (requires { G::rows; })
    return G::rows;
  else if constexpr (HasEquationList<G>)
    return G::Equations::rows;
  else
    return 0;
}

/// Geometry with its own function `constraint_function`, which is used instead of that of its list.
template <class G>
concept HasOwnConstraintFunction = requires(G const g, Frame<double> const a, double t) {
  { g.template constraint_function<double>(a, a, t) } -> std::same_as<ConstraintTerms<constraint_equations<G>()>>;
};

/// Geometry with its own function `gamma`, which is used instead of that of its list.
template <class G>
concept HasOwnGamma = requires(G const g, Frame<double> const a, double t) {
  { g.template gamma<double>(a, a, t) } -> std::same_as<Vec<double, constraint_equations<G>()>>;
};

/// Constraint terms of a geometry at two frames and a time t [s], from its own function or its list.
template <StateScalar T, class G>
[[gnu::always_inline]] inline ConstraintTerms<constraint_equations<G>(), T> constraint_function(G const& geometry,
                                                                                                Frame<T> const& a,
                                                                                                Frame<T> const& b,
                                                                                                double t) {
  if constexpr (HasOwnConstraintFunction<G>)
    return geometry.template constraint_function<T>(a, b, t);
  else
    return G::Equations::template constraint_function<T>(geometry, a, b);
}

/// γ (rows) of a geometry at two frames and a time t [s], from its own function or its list.
template <StateScalar T, class G>
Vec<T, constraint_equations<G>()> constraint_gamma(G const& geometry, Frame<T> const& a, Frame<T> const& b, double t) {
  if constexpr (HasOwnGamma<G>)
    return geometry.template gamma<T>(a, b, t);
  else
    return G::Equations::template gamma<T>(geometry, a, b);
}

/// Constraint function of two frames, on which a joint policy acts.
template <class G>
concept ConstraintFunction = requires {
  requires 1 <= constraint_equations<G>() && constraint_equations<G>() <= 6;
  requires HasEquationList<G> || requires {
    { G::needs } -> std::convertible_to<MarkerKind>;
  };
  requires HasEquationList<G> || HasOwnConstraintFunction<G>;
};

/// Geometry of a joint: its constraint function measures the motions that the joint prevents. The markers of the joint
/// get axes that coincide at the reference configuration: `triad()` in world axes. For most joints in space the third
/// axis is the joint axis. Optional members are `check(name)`, which `connect` calls with the joint's name, and
/// `breakpoints()`, times at which steps end. `docs/extending.md` lists all members.
template <class G>
concept JointGeometry = ConstraintFunction<G> && requires(G const g) {
  { G::name } -> std::convertible_to<char const*>;
  { G::world } -> std::convertible_to<World>;
  { g.triad() } -> std::convertible_to<Mat3>;
  requires HasEquationList<G> || HasOwnGamma<G>;
};

/// Number of nonholonomic equations of a geometry, which constrain velocities only (rolling, a blade). These are the
/// last equations of the geometry. Zero for most geometries.
template <class G>
constexpr int nonholonomic_equations() {
  if constexpr (requires { G::nonholonomic_equations; })
    return G::nonholonomic_equations;
  else
    return 0;
}

/// True if Gb = −Ga in all rows (member `opposite_ends` of the geometry, or of its list; default false). The wrench of
/// such equations is computed once for both ends.
template <class G>
constexpr bool has_opposite_ends() {
  if constexpr (requires { G::opposite_ends; })
    return G::opposite_ends;
  else if constexpr (HasEquationList<G> && !HasOwnConstraintFunction<G>)
    return G::Equations::opposite_ends;
  else
    return false;
}

/// True for each motion of b relative to a that a geometry leaves free: three translations along the joint's axes, then
/// three rotations about these axes.
using FreeDirections = std::array<bool, 6>;

/// Number of translations in `free`.
constexpr int free_slides(FreeDirections const& free) { return int(free[0]) + int(free[1]) + int(free[2]); }
/// Number of rotations in `free`.
constexpr int free_turns(FreeDirections const& free) { return int(free[3]) + int(free[4]) + int(free[5]); }

namespace detail {
/// Motions that no equation of the list of G prevents. In the plane these are two translations and one rotation.
template <class G>
constexpr FreeDirections free_of_list() {
  FreeDirections free = G::Equations::free;
  if (G::world == World::plane) free[2] = free[3] = free[4] = false;
  return free;
}
}  // namespace detail

/// Geometry with a list whose equations prevent motions along and about axes of the joint. A geometry with two free
/// rotations is excluded, since the axes of these rotations move relative to each other.
template <class G>
concept ListsFreeDirections = !HasOwnConstraintFunction<G> && requires {
  requires G::Equations::along_axes && free_turns(detail::free_of_list<G>()) != 2;
};

/// Geometry with free directions: its member `free`, or those of its list.
template <class G>
concept HasFreeDirections = ListsFreeDirections<G> || requires {
  { G::free } -> std::convertible_to<FreeDirections>;
};

/// Free directions of a geometry.
template <HasFreeDirections G>
constexpr FreeDirections free_directions() {
  if constexpr (requires { G::free; })
    return G::free;
  else
    return detail::free_of_list<G>();
}

/// Marker kind that a geometry requires of its first marker: its member `needs`, or that of its list.
template <ConstraintFunction G>
constexpr MarkerKind needs_of_first() {
  if constexpr (requires { G::needs; })
    return G::needs;
  else
    return G::Equations::needs;
}

/// Marker kind that a geometry requires of its second marker: `needs_of_second`, by default `needs`, or that of its
/// list.
template <ConstraintFunction G>
constexpr MarkerKind needs_of_second() {
  if constexpr (requires { G::needs_of_second; })
    return G::needs_of_second;
  else if constexpr (requires { G::needs; })
    return G::needs;
  else
    return G::Equations::needs_of_second;
}

/// ∂[Gaᵀλ; Gbᵀλ]/∂(δr_a, δφ_a, δr_b, δφ_b), 12×12, rotations δφ in world axes, by dual numbers: δA = δφ × A.
template <ConstraintFunction G, class D = Dual<12>>
Mat<double, 12, 12> wrench_gradient_by_dual_numbers(G const& geometry, Frame<double> const& a, Frame<double> const& b,
                                                    double t, Vec<double, constraint_equations<G>()> const& lambda) {
  auto const moved = [](Frame<double> const& f, int first) {
    Frame<D> m;
    for (int i = 0; i < 3; ++i) {
      m.r[i] = D::variable(f.r[i], first + i);
      for (int j = 0; j < 3; ++j) {
        m.A(i, j) = D(f.A(i, j));
        m.A(i, j).d[first + 3 + (i + 1) % 3] = f.A((i + 2) % 3, j);
        m.A(i, j).d[first + 3 + (i + 2) % 3] = -f.A((i + 1) % 3, j);
      }
    }
    return m;
  };
  ConstraintTerms<constraint_equations<G>(), D> const terms =
      constraint_function<D>(geometry, moved(a, 0), moved(b, 6), t);
  auto k = detail::zeros<Mat<double, 12, 12>>();
  for (int r = 0; r < constraint_equations<G>(); ++r)
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 12; ++j) {
        k(i, j) += terms.Ga(r, i).d[j] * lambda[r];
        k(i + 6, j) += terms.Gb(r, i).d[j] * lambda[r];
      }
  return k;
}

/// Geometry with a wrench gradient in closed form.
template <class G>
concept HasWrenchGradient = requires(G const g, Frame<double> const f, Vec<double, constraint_equations<G>()> const l) {
  { g.wrench_gradient(f, f, l) } -> std::convertible_to<Mat<double, 12, 12>>;
};

/// Wrench gradient: the closed form of the geometry or of its list, otherwise by dual numbers.
template <ConstraintFunction G>
Mat<double, 12, 12> wrench_gradient(G const& geometry, Frame<double> const& a, Frame<double> const& b, double t,
                                    Vec<double, constraint_equations<G>()> const& lambda) {
  if constexpr (HasWrenchGradient<G>)
    return geometry.wrench_gradient(a, b, lambda);
  else if constexpr (HasEquationList<G> && !HasOwnConstraintFunction<G>)
    return G::Equations::wrench_gradient(geometry, a, b, lambda);
  else
    return wrench_gradient_by_dual_numbers(geometry, a, b, t, lambda);
}

}  // namespace polybody
