#pragma once
/// \file
/// Waist 2: the gap, all that a policy knows of a joint.

#include <array>
#include <utility>

#include <polybody/kinematics/frame.hpp>

namespace polybody {

namespace detail {
/// Zeros, each by a store of its own, of which compilers make registers. Of a loop g++ -O2 makes a string instruction,
/// which takes as long to begin as a joint's gap to be measured.
template <class M>
M stored_zeros() {
  M m;
  [&]<std::size_t... i>(std::index_sequence<i...>) {
    ((m.data()[i] = typename M::Scalar(0.0)), ...);
  }(std::make_index_sequence<std::size_t(M::SizeAtCompileTime)>{});
  return m;
}
}  // namespace detail

/// The violation of m rows between frame a and frame b:
///   ġ = Ga Va + Gb Vb + Φ_t,   V = [ṙ; ω] in world axes.
/// Rows are of positions (holonomic), but for those that a geometry names as `nonholonomic_equations`: of these only
/// the rate has a meaning, and g is zero.
template <int m, StateScalar T = double>
struct ConstraintTerms {
  static constexpr int rows = m;
  Vec<T, m> g = detail::zeros<Vec<T, m>>();                ///< (m) violation [m], [rad] or [1]
  Mat<T, m, 6> Ga = detail::stored_zeros<Mat<T, m, 6>>();  ///< (m×6) map of frame a's twist
  Mat<T, m, 6> Gb = detail::stored_zeros<Mat<T, m, 6>>();  ///< (m×6) map of frame b's twist
  Vec<T, m> rate = detail::zeros<Vec<T, m>>();             ///< (m) Φ_t: the rate that is prescribed by time alone
};

/// Axis i of a frame, a column of A.
template <StateScalar T>
Vec<T, 3> axis_of(Frame<T> const& frame, int i) {
  return {frame.A(0, i), frame.A(1, i), frame.A(2, i)};
}

/// [ṙ; ω] of a frame.
template <StateScalar T>
Vec<T, 6> twist(Frame<T> const& frame) {
  Vec<T, 6> v;
  for (int i = 0; i < 3; ++i) {
    v[i] = frame.v[i];
    v[3 + i] = frame.w[i];
  }
  return v;
}

/// Pose and twist of b seen from a, in a's axes: what a compliant joint needs beyond the rows.
template <StateScalar T = double>
struct RelativeMotion {
  Vec<T, 3> d;     ///< (3) r_b − r_a in a's axes [m]
  Mat<T, 3, 3> R;  ///< (3×3) AaᵀAb
  Vec<T, 3> v;     ///< (3) rate of r_b − r_a seen in a's axes [m/s]
  Vec<T, 3> w;     ///< (3) ω_b − ω_a in a's axes [rad/s]
};

/// Pose and twist of b seen from a.
template <StateScalar T>
RelativeMotion<T> relative(Frame<T> const& a, Frame<T> const& b) {
  Vec<T, 3> const d = b.r - a.r;
  return {a.A.transpose() * d, a.A.transpose() * b.A, a.A.transpose() * (b.v - a.v - a.w.cross(d)),
          a.A.transpose() * (b.w - a.w)};
}

/// A function from two frames to a gap, which a policy answers.
template <class G>
concept ConstraintFunction = requires(G const g, Frame<double> const a, Frame<double> const b, double t) {
  requires 1 <= G::rows&& G::rows <= 6;
  { G::needs } -> std::convertible_to<MarkerKind>;
  { g.template constraint_function<double>(a, b, t) } -> std::same_as<ConstraintTerms<G::rows, double>>;
};

/// A joint geometry measures the motions that it stops. Its markers get axes that coincide at the reference
/// configuration: `triad()` in world axes; the joint's axis is the third. It may have `check(name)`, which `connect`
/// calls with the joint's name, and `breakpoints()`, times at which steps are to end; `docs/extending.md` lists what
/// else.
template <class G>
concept JointGeometry =
    ConstraintFunction<G> && requires(G const g, Frame<double> const a, Frame<double> const b, double t) {
      { G::name } -> std::convertible_to<char const*>;
      { G::world } -> std::convertible_to<World>;
      { g.triad() } -> std::convertible_to<Mat3>;
      { g.template gamma<double>(a, b, t) } -> std::same_as<Vec<double, G::rows>>;
    };

/// How many of a geometry's rows, the last ones, hold speeds and no positions (nonholonomic: rolling, a blade); most
/// have none.
template <class G>
constexpr int nonholonomic_equations() {
  if constexpr (requires { G::nonholonomic_equations; })
    return G::nonholonomic_equations;
  else
    return 0;
}

/// Whether Gb = −Ga in all rows, as a geometry says by `opposite_ends`: forces of its rows then work out one wrench for
/// both ends. Most say nothing.
template <class G>
constexpr bool has_opposite_ends() {
  if constexpr (requires { G::opposite_ends; })
    return G::opposite_ends;
  else
    return false;
}

/// Which motions of b against a a geometry leaves free (its member `free`): slides along the joint's axes, then turns
/// about them.
using FreeDirections = std::array<bool, 6>;
template <class G>
concept HasFreeDirections = requires {
  { G::free } -> std::convertible_to<FreeDirections>;
};

namespace detail {
constexpr int free_slides(FreeDirections const& free) { return int(free[0]) + int(free[1]) + int(free[2]); }
constexpr int free_turns(FreeDirections const& free) { return int(free[3]) + int(free[4]) + int(free[5]); }
}  // namespace detail

/// What the second marker of a geometry must observe: `needs_of_second`, or `needs` as for the first.
template <ConstraintFunction G>
constexpr MarkerKind needs_of_second() {
  if constexpr (requires { G::needs_of_second; })
    return G::needs_of_second;
  else
    return G::needs;
}

/// ∂[Gaᵀλ; Gbᵀλ]/∂(δr_a, δφ_a, δr_b, δφ_b), 12×12, rotations δφ in world axes, by dual numbers: δA = δφ × A.
template <ConstraintFunction G, class D = Dual<12>>
Mat<double, 12, 12> wrench_gradient_by_dual_numbers(G const& geometry, Frame<double> const& a, Frame<double> const& b,
                                                    double t, Vec<double, G::rows> const& lambda) {
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
  ConstraintTerms<G::rows, D> const gap = geometry.template constraint_function<D>(moved(a, 0), moved(b, 6), t);
  auto k = detail::zeros<Mat<double, 12, 12>>();
  for (int r = 0; r < G::rows; ++r)
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 12; ++j) {
        k(i, j) += gap.Ga(r, i).d[j] * lambda[r];
        k(i + 6, j) += gap.Gb(r, i).d[j] * lambda[r];
      }
  return k;
}

/// A geometry that gives this gradient in closed form.
template <class G>
concept HasWrenchGradient = requires(G const g, Frame<double> const f, Vec<double, G::rows> const l) {
  { g.wrench_gradient(f, f, l) } -> std::convertible_to<Mat<double, 12, 12>>;
};

/// The same by the geometry's closed form where it has one, else by dual numbers.
template <ConstraintFunction G>
Mat<double, 12, 12> wrench_gradient(G const& geometry, Frame<double> const& a, Frame<double> const& b, double t,
                                    Vec<double, G::rows> const& lambda) {
  if constexpr (HasWrenchGradient<G>)
    return geometry.wrench_gradient(a, b, lambda);
  else
    return wrench_gradient_by_dual_numbers(geometry, a, b, t, lambda);
}

}  // namespace polybody
