#pragma once
/// \file
/// Deformation coordinates of a floating frame's body: reference conditions that tie the frame to the structure, and
/// bases Φ (N×n), e = Φ q: all free nodal coordinates, modes of vibration, or Craig & Bampton's [1968].
///
/// Not in polybody.hpp: Eigen's sparse module and factorisations would cost every program seconds to compile.

#include <algorithm>
#include <set>

#include <Eigen/Eigenvalues>

#include <polybody/bodies/ffr/structure_factor.hpp>
#include <polybody/math/symmetric_pencil.hpp>

namespace polybody {

/// Which nodal coordinates stay zero in the floating frame. At least six in space must, and those that do must keep the
/// structure from moving as a whole; or none, for modes of the free structure (mean axes).
class ReferenceConditions {
 public:
  /// All coordinates of one node: the frame is tied to it.
  static ReferenceConditions clamped(Index node = 0) {
    ReferenceConditions r;
    r.nodes_.push_back(node);
    return r;
  }
  /// x, y, z and the rotation about x at `a`, y and z at `b`: for beams along x, the frame's x axis runs from a to b.
  static ReferenceConditions simply_supported(Index a, Index b) {
    ReferenceConditions r;
    for (int const c : {0, 1, 2, 3}) r.fix(a, c);
    for (int const c : {1, 2}) r.fix(b, c);
    return r;
  }
  static ReferenceConditions none() { return {}; }  ///< holds nothing: for a free structure

  /// One more, of `node`: component 0–2 a displacement, 3–5 a rotation.
  ReferenceConditions& fix(Index node, int component) {
    single_.emplace_back(node, component);
    return *this;
  }
  /// Only displacements along x, y and rotations about z remain.
  ReferenceConditions& in_plane() {
    in_plane_ = true;
    return *this;
  }

  /// The nodal coordinates that remain, in order. \throws InvalidInput for a node or component that does not exist.
  template <class = void>
  std::vector<Index> free_coordinates(Structure const& s) const {
    std::vector<char> fixed(std::size_t(s.size()), 0);
    auto const mark = [&](Index node, int component) {
      s.require_node(node, "Ffr: a reference condition");
      if (component < 0 || component >= s.per_node)
        throw InvalidInput{"Ffr: a reference condition names component ", component, ", but nodes have ", s.per_node,
                           " (from 0)."};
      fixed[std::size_t(s.per_node * node + component)] = 1;
    };
    for (Index const node : nodes_)
      for (int c = 0; c < s.per_node; ++c) mark(node, c);
    for (auto const& [node, component] : single_) mark(node, component);
    if (in_plane_)
      for (Index i = 0; i < Index(s.nodes.size()); ++i)
        for (int c = 2; c < std::min(s.per_node, 5); ++c) mark(i, c);
    std::vector<Index> free;
    for (Index i = 0; i < s.size(); ++i)
      if (!fixed[std::size_t(i)]) free.push_back(i);
    return free;
  }
  /// Rigid motions of the structure if it were free: 3 `in_plane`, else 6.
  int rigid_motions() const { return in_plane_ ? 3 : 6; }

 private:
  std::vector<Index> nodes_;
  std::vector<std::pair<Index, int>> single_;
  bool in_plane_ = false;
};

/// The lowest solutions of K x = ω² M x: ω² ascending, x by columns with xᵀMx = 1.
struct LowestModes {
  VecX squared_frequencies;  ///< [rad²/s²]
  MatX shapes;               ///< (N×count)
};

/// All modes by Eigen's dense solver, of which the lowest are kept: for up to some thousand coordinates.
/// vibration/spectra_modes.hpp has one for larger structures.
struct DenseModes {
  /// The `count` lowest solutions.
  template <class = void>  // compiled where it is used
  LowestModes operator()(Structure::Sparse const& k, Structure::Sparse const& m, Index count) const {
    MatX const dense_k(k), dense_m(m);
    Eigen::GeneralizedSelfAdjointEigenSolver<MatX> const solver(dense_k, dense_m);
    VecX squares = solver.eigenvalues();
    MatX shapes = solver.eigenvectors();
    renew_low_end(dense_k, dense_m, count, squares, shapes);
    return {squares.head(count), shapes.leftCols(count)};
  }
};

namespace detail {

template <class = void>
void require_count(Index count, Index most) {
  if (count < 1 || count > most)
    throw InvalidInput{"Ffr: ", count, " modes are asked for, but the model has 1 to ", most, " to offer."};
}

template <class = void>
void require_mass(Structure::Sparse const& m) {
  SparseFactor factor;
  factor_positive(factor, m, "the structure's mass matrix is not positive definite.");
}

}  // namespace detail

/// Every nodal coordinate that the reference conditions leave. \throws InvalidInput when the structure can still move
/// as a whole.
template <class = void>
MatX nodal_coordinates(Structure const& s, ReferenceConditions const& frame = ReferenceConditions::clamped()) {
  std::vector<Index> const free = frame.free_coordinates(s);
  require_held(submatrix(s.stiffness, free, free));
  return scatter_rows(MatX::Identity(Index(free.size()), Index(free.size())), free, s.size());
}

/// The `count` lowest modes, by `solve`, of the structure held by the reference conditions. \throws InvalidInput as
/// above, and for a count beyond what there is.
template <class Eigensolver = DenseModes>
MatX held_modes(Structure const& s, Index count, ReferenceConditions const& frame = ReferenceConditions::clamped(),
                Eigensolver const& solve = {}) {
  std::vector<Index> const free = frame.free_coordinates(s);
  detail::require_count(count, Index(free.size()));
  Structure::Sparse const k = submatrix(s.stiffness, free, free), m = submatrix(s.mass_matrix(), free, free);
  require_held(k);
  detail::require_mass(m);
  return scatter_rows(solve(k, m, count).shapes, free, s.size());
}

/// The `count` lowest modes, by `solve`, of the free structure that deform it. The frame follows the mean motion:
/// momentum and moment of momentum of the deformation vanish in it to first order (Tisserand's or Buckens' mean axes).
/// \throws InvalidInput as above.
template <class Eigensolver = DenseModes>
MatX free_interface_modes(Structure const& s, Index count,
                          ReferenceConditions const& frame = ReferenceConditions::none(),
                          Eigensolver const& solve = {}) {
  std::vector<Index> const free = frame.free_coordinates(s);
  int const rigid = frame.rigid_motions();
  detail::require_count(count, Index(free.size()) - rigid);
  Structure::Sparse const k = submatrix(s.stiffness, free, free), m = submatrix(s.mass_matrix(), free, free);
  detail::require_mass(m);
  // K alone is singular: with a shift of the size of a low frequency it is not, and the modes stay the same.
  double const shift = 1e-3 * k.diagonal().sum() / m.diagonal().sum();
  LowestModes const modes = solve(Structure::Sparse(k + shift * m), m, count + rigid);
  return scatter_rows(modes.shapes.rightCols(count), free, s.size());
}

/// Craig & Bampton [1968]: the static shapes of unit displacements of the boundary nodes, and the `count` lowest modes
/// with these nodes held, by `solve`; all of them, or those `in_plane`. The frame is tied to the first boundary node,
/// whose shapes are left out, or follows the mean motion (`mean_axes`): then the basis is turned into free modes of the
/// reduced model, less the rigid ones. \throws InvalidInput for boundary nodes that do not exist or repeat, a count
/// beyond what there is, or a frame tied to a node without rotations.
template <class Eigensolver = DenseModes>
MatX craig_bampton(Structure const& s, std::vector<Index> const& boundary, Index count, bool mean_axes = false,
                   bool in_plane = false, Eigensolver const& solve = {}) {
  if (boundary.empty() || std::set<Index>(boundary.begin(), boundary.end()).size() != boundary.size())
    throw InvalidInput("Ffr: Craig-Bampton needs boundary nodes, each once.");
  if (!mean_axes && s.per_node != 6)
    throw InvalidInput("Ffr: nodes without rotations do not hold the frame; say mean_axes in craig_bampton.");
  ReferenceConditions everywhere = ReferenceConditions::none();
  if (in_plane) everywhere.in_plane();
  std::vector<Index> const all = everywhere.free_coordinates(s);
  std::vector<Index> inner, outer;
  for (Index const node : boundary) s.require_node(node, "Ffr: a boundary node");
  for (Index const i : all) {
    auto const at = std::find(boundary.begin(), boundary.end(), i / s.per_node);
    if (at == boundary.end())
      inner.push_back(i);
    else if (mean_axes || at != boundary.begin())
      outer.push_back(i);
  }
  if (count != 0) detail::require_count(count, Index(inner.size()));
  Structure::Sparse const kii = submatrix(s.stiffness, inner, inner), mii = submatrix(s.mass_matrix(), inner, inner);
  MatX shapes = MatX::Zero(s.size(), Index(outer.size()) + count);
  for (std::size_t j = 0; j < outer.size(); ++j) shapes(outer[j], Index(j)) = 1.0;
  if (!inner.empty()) {
    SparseFactor factor;
    factor_positive(factor, kii, "the stiffness between the boundary nodes is not positive definite.");
    MatX const follow = -factor.solve(MatX(submatrix(s.stiffness, inner, outer)));
    shapes.leftCols(Index(outer.size())) += scatter_rows(follow, inner, s.size());
    if (count > 0) {
      detail::require_mass(mii);
      shapes.rightCols(count) = scatter_rows(solve(kii, mii, count).shapes, inner, s.size());
    }
  }
  if (!mean_axes) return shapes;
  MatX const k = shapes.transpose() * (s.stiffness * shapes), m = shapes.transpose() * (s.mass_matrix() * shapes);
  Eigen::GeneralizedSelfAdjointEigenSolver<MatX> const reduced(k, m);
  return shapes * reduced.eigenvectors().rightCols(shapes.cols() - everywhere.rigid_motions());
}

}  // namespace polybody
