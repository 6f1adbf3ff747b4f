#pragma once
/// \file
/// Arrays of all results of an evaluation. An evaluation does not change the model.

#include <memory>

#include <polybody/kinematics/frame.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/math/simd_vector.hpp>
#include <polybody/math/workers.hpp>
#include <polybody/system/constraint_block.hpp>

namespace polybody {

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
  Index first_state = 0;                  ///< index of the first state z among the velocities

  Sequence<Wrench<double>> loads;             ///< wrench of each marker in r, for the second-order terms of the tangent
  Sequence<Mat<double, 6, 6>> own_stiffness;  ///< for each marker of the largest force group
  Sequence<double> scratch;                   ///< for projected blocks, n×18 and n×n; n: columns of the widest marker

  bool linear_rows = true;  ///< if false, linear joints and markers of linear joints only are omitted
  Sequence<char> read;      ///< for each marker: nonzero if it belongs to a force element or a nonlinear joint

  Workers* workers = nullptr;         ///< threads that share the loops; null for one thread
  Sequence<T> element_forces;         ///< with workers: forces of all elements of a body, added later in fixed order
  Sequence<double> element_tangents;  ///< with workers: tangents of the elements, added later in fixed order
  /// With workers: wrenches on contact partners from one part of a force group. They are added later in fixed order.
  struct alignas(64) Opposite {
    Sequence<AppliedWrench<T>> actions;  ///< wrenches of one part
  };
  Sequence<Opposite> opposite;                 ///< arrays of wrenches, one for each thread
  static constexpr Index least_elements = 32;  ///< least number of elements per thread
  static constexpr Index least_pairs = 32;     ///< least number of the many markers of a group per thread
  static constexpr Index least_batches = 16;   ///< least number of SIMD vectors of elements per thread
  static constexpr Index least_markers = 128;  ///< least number of markers per thread

  std::shared_ptr<void> kept;  ///< arrays that depend on the types of bodies and joints: poses, constraint functions

  Data() = default;
  Data(Data const&) = delete;  // markers and constraint blocks contain pointers into the arrays
  Data& operator=(Data const&) = delete;
  Data(Data&&) = default;             ///< moves the arrays; pointers into them stay valid
  Data& operator=(Data&&) = default;  ///< moves the arrays; pointers into them stay valid

  /// Index of the multiplier λ_i, `i`, among the unknowns, which begin with all velocities.
  Index unknown_of_row(Index i) const { return first_state + Index(states.size()) + i; }
  /// True if the evaluation omits this block: it belongs to a linear joint, and `linear_rows` is false.
  bool leaves_out(ConstraintBlock<T> const& block) const {
    return block.source == ConstraintSource::linear && !linear_rows;
  }
};

}  // namespace polybody
