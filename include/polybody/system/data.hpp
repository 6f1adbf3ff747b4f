#pragma once
/// \file
/// Arrays of all results of an evaluation. An evaluation does not change the model.

#include <memory>

#include <polybody/kinematics/frame.hpp>
#include <polybody/kinematics/marker_kinematics.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/math/simd_vector.hpp>
#include <polybody/math/with_constant.hpp>
#include <polybody/math/workers.hpp>

namespace polybody {

// Constraint equations of joints and bodies, and wrenches of force elements, as arrays. The types of geometries,
// policies and forces are erased.

/// One end of a constraint block: a marker whose twist the equations contain, or velocities that they contain directly.
template <StateScalar T = double>
struct ConstraintSide {
  Index marker = -1;  ///< number of the marker; −1 if the map multiplies velocities
  Index first = 0;    ///< without a marker: index of the first velocity of this end
  Index columns = 0;  ///< columns of the map: six for a marker, otherwise the number of velocities, which may be zero
  T const* map = nullptr;  ///< (rows × columns) derivative of ġ with respect to twist or velocities, column-major
};

/// Source of constraint equations.
enum class ConstraintSource : unsigned char {
  body,      ///< own equations of a body, such as the norm of Euler parameters
  linear,    ///< equations of a joint that are linear in the coordinates
  joint,     ///< equations of a joint between frames
  compliant  ///< constraint function of a compliant joint, enforced by a force: no equations of the model
};

/// Constraint equations of one source, ġ = a.map · (twist or velocities of a) + b.map · (…) + rate. A linear joint may
/// have more than six equations; other sources have up to six equations.
template <StateScalar T = double>
struct ConstraintBlock {
  ConstraintSource source = ConstraintSource::joint;  ///< type of the source
  bool opposite = false;                              ///< true if both ends are markers, and b.map = −a.map
  Index row = -1;                                     ///< first equation in the model; −1 for a compliant joint
  int rows = 0;                                       ///< number m of equations
  int positions = 0;                 ///< for a linear joint: number of position equations, which come first
  Index owner = 0;                   ///< position of the body or joint in the model's layout
  ConstraintSide<T> a = {}, b = {};  ///< two ends of the block
  T const* g = nullptr;              ///< (m) constraint violation
  T const* rate = nullptr;           ///< (m) Φ_t; null if the equations do not depend on time
  T const* answer = nullptr;         ///< (m) λ(g, ġ) of a compliant joint

  /// Multipliers λ (m) of the equations, or λ(g, ġ) of a compliant joint.
  T const* multiplier(VecXOf<T> const& lambda) const { return row >= 0 ? lambda.data() + row : answer; }
};

/// Wrench of a force element on a marker, about the marker's origin, in world axes.
template <StateScalar T = double>
struct AppliedWrench {
  Index source = 0;  ///< position of the force element in the model's layout
  Index marker = 0;  ///< number of the marker
  T w[6] = {};       ///< [f; m] [N, N m], without the load factor
};

namespace detail {

/// r[columns of the marker] += sign · Jᵀ w.
template <StateScalar T>
void add_pulled(MarkerKinematics<T> const& p, T const* w, double sign, T* r) {
  switch (p.shape) {
    case JacobianShape::ground:
      return;
    case JacobianShape::rigid: {
      T const f[3] = {w[0] * sign, w[1] * sign, w[2] * sign};
      T const m[3] = {w[3] * sign + p.arm[1] * f[2] - p.arm[2] * f[1], w[4] * sign + p.arm[2] * f[0] - p.arm[0] * f[2],
                      w[5] * sign + p.arm[0] * f[1] - p.arm[1] * f[0]};
      for (int i = 0; i < 3; ++i) {
        r[p.first + i] += f[i];
        r[p.first + 3 + i] += p.body_axes(0, i) * m[0] + p.body_axes(1, i) * m[1] + p.body_axes(2, i) * m[2];
      }
      return;
    }
    case JacobianShape::dense:
      for (Index c = 0; c < p.columns; ++c) {
        T const* const j = p.jacobian + 6 * c;
        T sum = j[0] * w[0];
        for (int i = 1; i < 6; ++i) sum += j[i] * w[i];
        r[p.first + c] += sum * sign;
      }
  }
}

/// w = [f; m] = mapᵀ λ, the wrench of m multipliers on the marker of an end.
template <int m, StateScalar T>
void wrench_of(T const* map, T const* lambda, T* w) {
  for (int i = 0; i < 6; ++i) {
    T sum = map[m * i] * lambda[0];
    for (int k = 1; k < m; ++k) sum += map[m * i + k] * lambda[k];
    w[i] = sum;
  }
}

/// w = [ṙ; ω], the twist of a frame.
template <StateScalar T>
void read_twist(Frame<T> const& f, T* w) {
  for (int i = 0; i < 3; ++i) {
    w[i] = f.v[i];
    w[3 + i] = f.w[i];
  }
}

/// out (m) += map · x. \tparam m number of rows of the map; 0 stands for `rows`
template <int m, StateScalar T>
void add_mapped(T const* map, Index columns, T const* x, int rows, T* out) {
  int const n = m > 0 ? m : rows;
  for (Index c = 0; c < columns; ++c)
    for (int k = 0; k < n; ++k) out[k] += map[n * c + k] * x[c];
}

}  // namespace detail

/// out (6) = mapᵀ λ, the wrench of the multipliers on the marker of an end; zero for an end without a marker.
template <StateScalar T>
void wrench_at(ConstraintBlock<T> const& block, ConstraintSide<T> const& end, T const* lambda, T* out) {
  for (int i = 0; i < 6; ++i) out[i] = T(0.0);
  if (end.marker < 0) return;
  with_constant(block.rows, [&](auto m) {
    if constexpr (m > 0) detail::wrench_of<m>(end.map, lambda, out);
  });
}

/// Compiler settings that determine the memory layout of `Data`. They are part of its type, so that object files with
/// different settings do not link.
struct Build {
  int simd = simd_size;                   ///< numbers in a SIMD vector
  int alignment = EIGEN_MAX_ALIGN_BYTES;  ///< alignment of fixed-size matrices [bytes]
};

/// Arrays of an evaluation: markers, Jacobians, constraint blocks, applied wrenches. They are allocated once for a
/// model.
template <StateScalar T = double, Build build = Build{}>
struct Data {
  Sequence<MarkerKinematics<T>> markers;  ///< kinematics of each marker
  Sequence<T> jacobians;                  ///< storage of the dense Jacobians
  Sequence<ConstraintBlock<T>> rows;      ///< constraint blocks of all joints, and of bodies with own equations
  Sequence<AppliedWrench<T>> actions;     ///< wrenches: one for each marker of each force element
  Sequence<T> states, rates;              ///< first-order states z of force elements, and ż
  Sequence<T> multipliers;                ///< λ for elements that follow a reaction; empty if there are none
  Index first_state = 0;                  ///< index of the first state z among the velocities

  Sequence<Wrench<double>> loads;             ///< wrench on each marker in the residual, for second-order terms
  Sequence<Mat<double, 6, 6>> own_stiffness;  ///< workspace: stiffness of each marker of a force group
  Sequence<double> scratch;                   ///< workspace: blocks of n×18 and n×n; n: columns of the widest Jacobian

  bool linear_rows = true;  ///< if false, linear joints are omitted, and markers that only they use
  Sequence<char> read;      ///< for each marker: nonzero if it belongs to a force element or a nonlinear joint

  Workers* workers = nullptr;         ///< threads that share the loops; null for one thread
  Sequence<T> element_forces;         ///< with workers: forces of all elements of a body, added later in fixed order
  Sequence<double> element_tangents;  ///< with workers: tangents of the elements, added later in fixed order
  /// With workers: wrenches of a part of a force group on contact partners. They are added later in a fixed order.
  struct alignas(64) Opposite {
    Sequence<AppliedWrench<T>> actions;  ///< wrenches of one part
  };
  Sequence<Opposite> opposite;                 ///< arrays of wrenches, one for each thread
  static constexpr Index least_elements = 32;  ///< least number of elements per thread
  static constexpr Index least_pairs = 32;     ///< least number of markers of a force group per thread
  static constexpr Index least_batches = 16;   ///< least number of SIMD vectors of elements per thread
  static constexpr Index least_markers = 128;  ///< least number of markers per thread

  /// Pairs of a force group that a search has found.
  struct FoundPairs {
    Index marker = 0;              ///< number of the first marker of the group
    std::shared_ptr<void> search;  ///< the `Search` of the group's type
  };
  Sequence<FoundPairs> found_pairs;  ///< pairs of each `SearchingForceGroup`

  std::shared_ptr<void> kept;  ///< arrays that depend on the types of bodies and joints: poses, constraint functions

  Data() = default;
  Data(Data const&) = delete;  // markers and constraint blocks contain pointers into the arrays
  Data& operator=(Data const&) = delete;
  Data(Data&&) = default;             ///< moves the arrays; pointers into them stay valid
  Data& operator=(Data&&) = default;  ///< moves the arrays; pointers into them stay valid

  /// Index of multiplier i among the unknowns. The velocities are the first unknowns.
  Index unknown_of_row(Index i) const { return first_state + Index(states.size()) + i; }
  /// True if the evaluation omits this block: it belongs to a linear joint, and `linear_rows` is false.
  bool leaves_out(ConstraintBlock<T> const& block) const {
    return block.source == ConstraintSource::linear && !linear_rows;
  }
};

}  // namespace polybody
