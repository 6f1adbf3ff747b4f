#pragma once
/// \file
/// Everything that is computed from a state, as arrays. The model itself stays const.

#include <memory>

#include <polybody/kinematics/frame.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/math/simd_vector.hpp>
#include <polybody/math/workers.hpp>
#include <polybody/system/constraint_block.hpp>

namespace polybody {

/// How code is compiled where it decides what data look like: numbers in a pack, and the alignment of fixed-size
/// matrices [bytes]. It is a part of the type, so that objects compiled for different machines do not link.
struct Build {
  int pack = pack_size;                   ///< numbers in a pack
  int alignment = EIGEN_MAX_ALIGN_BYTES;  ///< of fixed-size matrices [bytes]
};

/// Scratch of an evaluation: markers, Jacobians, row blocks, actions. It is laid out once for a model.
template <StateScalar T = double, Build build = Build{}>
struct Data {
  Sequence<MarkerKinematics<T>> markers;  ///< waist 1, one for each marker
  Sequence<T> jacobians;                  ///< arena of the dense Jacobians
  Sequence<ConstraintBlock<T>> rows;      ///< waist 2, one for each joint and each body that owns rows
  Sequence<AppliedWrench<T>> actions;     ///< what force elements do, one for each marker of each
  Sequence<T> states, rates;              ///< first-order ones of force elements, z and ż
  Index first_state = 0;                  ///< among the speeds

  Sequence<Wrench<double>> loads;             ///< per marker: what the tangent's second-order terms need
  Sequence<Mat<double, 6, 6>> own_stiffness;  ///< per marker of the largest force group
  Sequence<double> scratch;                   ///< for pulled blocks: n×18 and n×n of the widest marker

  bool linear_rows = true;  ///< else rows of linear joints are left out, and markers that these alone read
  Sequence<char> read;      ///< per marker: by anything but linear joints

  Workers* workers = nullptr;         ///< threads that share the loops; none by default
  Sequence<T> element_forces;         ///< with workers: of all elements of a body, before they are added in order
  Sequence<double> element_tangents;  ///< the same
  /// With workers: what the parts of a force group do to the few, before it is added in order.
  struct alignas(64) Opposite {
    Sequence<AppliedWrench<T>> actions;  ///< what one part does
  };
  Sequence<Opposite> opposite;                 ///< one for each thread
  static constexpr Index least_elements = 32;  ///< that are worth a thread
  static constexpr Index least_pairs = 32;     ///< markers of the many of a group
  static constexpr Index least_packs = 16;     ///< packs of alike elements that are worth a thread
  static constexpr Index least_markers = 128;  ///< published markers that are worth a thread

  std::shared_ptr<void> kept;  ///< what depends on the types of bodies and joints: poses, gaps, scratch

  Data() = default;
  Data(Data const&) = delete;  // markers and rows point into the arenas
  Data& operator=(Data const&) = delete;
  Data(Data&&) = default;             ///< takes the buffers over: pointers into them stay valid
  Data& operator=(Data&&) = default;  ///< takes the buffers over, as above

  /// Where row i stands among the unknowns, behind the speeds.
  Index unknown_of_row(Index i) const { return first_state + Index(states.size()) + i; }
  /// Whether this evaluation leaves a block out: one of a linear joint, while `linear_rows` is false.
  bool leaves_out(ConstraintBlock<T> const& block) const {
    return block.source == ConstraintSource::linear && !linear_rows;
  }
};

}  // namespace polybody
