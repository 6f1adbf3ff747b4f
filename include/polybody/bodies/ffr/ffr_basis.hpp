#pragma once
/// \file
/// Deformation coordinates q of a floating frame: reference conditions that tie the frame to the structure, and bases Φ
/// (N×n) of the nodal coordinates, e = Φ q. A basis consists of all free nodal coordinates, of vibration modes, or of
/// the modes of Craig & Bampton [1968].
/// Theory: Eqs. 2.91 to 2.94.

#include <algorithm>
#include <set>
#include <utility>

#include <Eigen/Eigenvalues>

#include <polybody/bodies/ffr/ffr_options.hpp>
#include <polybody/bodies/ffr/structure.hpp>
#include <polybody/math/symmetric_pencil.hpp>

namespace polybody {

// Extraction and factorisation of submatrices of a structure.

/// Submatrix of the sparse matrix m at the row indices `rows` and the column indices `columns`.
template <class = void>  // compiled only if used
Structure::Sparse submatrix(Structure::Sparse const& m, std::vector<Index> const& rows,
                            std::vector<Index> const& columns) {
  std::vector<int> row(std::size_t(m.rows()), -1);
  for (std::size_t i = 0; i < rows.size(); ++i) row[std::size_t(rows[i])] = int(i);
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t j = 0; j < columns.size(); ++j)
    for (Structure::Sparse::InnerIterator it(m, columns[j]); it; ++it)
      if (row[std::size_t(it.row())] >= 0) entries.emplace_back(row[std::size_t(it.row())], int(j), it.value());
  Structure::Sparse out(Index(rows.size()), Index(columns.size()));
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

/// Matrix with `size` rows: the rows of `shapes` at the indices `free`, and zeros elsewhere.
template <class = void>
MatX scatter_rows(MatX const& shapes, std::vector<Index> const& free, Index size) {
  MatX out = MatX::Zero(size, shapes.cols());
  for (std::size_t i = 0; i < free.size(); ++i) out.row(free[i]) = shapes.row(Index(i));
  return out;
}

/// Factorisation LDLᵀ of a symmetric sparse matrix.
using SparseFactor = Eigen::SimplicialLDLT<Structure::Sparse>;

/// Factorises m.
/// \throws InvalidInput with `what` unless m is positive definite.
template <class = void>
void factor_positive(SparseFactor& factor, Structure::Sparse const& m, std::string const& what) {
  factor.compute(m);
  if (factor.info() != Eigen::Success || !(factor.vectorD().minCoeff() > 1e-13 * factor.vectorD().maxCoeff()))
    throw InvalidInput("structure.not_positive_definite", {ErrorObject{"Ffr"}, ": ", what});
}
/// Checks the stiffness that remains under reference conditions.
/// \throws InvalidInput unless this stiffness is positive definite.
template <class = void>
void require_held(Structure::Sparse const& k) {
  SparseFactor factor;
  factor_positive(
      factor, k,
      "the stiffness that remains under the reference conditions is not positive definite. Fix enough coordinates "
      "to keep the structure from moving as a whole, or use free_interface_modes.");
}

/// Reference conditions: nodal coordinates that remain zero in the floating frame. In space at least six are required,
/// and they must prevent rigid motions of the structure. Modes of the free structure (mean axes) need no conditions.
class ReferenceConditions {
 public:
  /// Conditions on all coordinates of one node, which tie the frame to this node.
  static ReferenceConditions clamped(Index node = 0) {
    ReferenceConditions r;
    r.nodes_.push_back(node);
    return r;
  }
  /// Conditions on x, y, z and the rotation about x at `a`, and on y and z at `b`. For beams along x, the x axis of the
  /// frame points from a to b.
  static ReferenceConditions simply_supported(Index a, Index b) {
    ReferenceConditions r;
    for (int const c : {0, 1, 2, 3}) r.fix(a, c);
    for (int const c : {1, 2}) r.fix(b, c);
    return r;
  }
  static ReferenceConditions none() { return {}; }  ///< no condition, for a free structure

  /// Adds a condition at `node`: component 0–2 is a displacement, 3–5 a rotation.
  ReferenceConditions& fix(Index node, int component) {
    single_.emplace_back(node, component);
    return *this;
  }
  /// Restricts the structure to displacements along x and y and rotations about z.
  ReferenceConditions& restrict_to_plane() {
    in_plane_ = true;
    return *this;
  }

  /// Indices of the nodal coordinates without a condition, in ascending order.
  /// \throws InvalidInput for a node or component that does not exist.
  template <class = void>
  std::vector<Index> free_coordinates(Structure const& s) const {
    std::vector<char> fixed(std::size_t(s.size()), 0);
    auto const mark = [&](Index node, int component) {
      s.require_node(node, "Ffr: a reference condition");
      if (component < 0 || component >= s.per_node)
        throw InvalidInput("ffr.component",
                           {ErrorObject{"Ffr"}, ": a reference condition is on component ", ErrorValue{component},
                            ", but nodes have ", s.per_node, " components, counted from 0."});
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
  /// Number of rigid motions of the free structure: 3 after `restrict_to_plane`, otherwise 6.
  int rigid_motions() const { return in_plane_ ? 3 : 6; }

 private:
  std::vector<Index> nodes_;
  std::vector<std::pair<Index, int>> single_;
  bool in_plane_ = false;
};

/// Lowest solutions of K x = ω² M x, with ω² in ascending order and xᵀMx = 1.
struct LowestModes {
  VecX squared_frequencies;  ///< ω² [rad²/s²]
  MatX shapes;               ///< (N×count) shapes x as columns
};

/// Eigenvalue solver that computes all modes with Eigen's dense solver and returns the lowest ones, for up to about a
/// thousand coordinates. vibration/spectra_modes.hpp has a solver for larger structures.
struct DenseModes {
  /// Lowest `count` solutions of K x = ω² M x.
  template <class = void>  // compiled only if used
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
    throw InvalidInput("ffr.modes", {ErrorObject{"Ffr"}, ": ", ErrorValue{count},
                                     " modes are requested, but the number must lie in [1, ", most, "]."});
}

template <class = void>
void require_mass(Structure::Sparse const& m) {
  SparseFactor factor;
  factor_positive(factor, m, "the structure's mass matrix is not positive definite. Every node needs mass.");
}

}  // namespace detail

/// Basis of all nodal coordinates that the reference conditions leave free.
/// \throws InvalidInput if a rigid motion of the structure remains.
template <class = void>
MatX nodal_coordinates(Structure const& s, ReferenceConditions const& frame = ReferenceConditions::clamped()) {
  std::vector<Index> const free = frame.free_coordinates(s);
  require_held(submatrix(s.stiffness, free, free));
  return scatter_rows(MatX::Identity(Index(free.size()), Index(free.size())), free, s.size());
}

/// Lowest `count` modes of the structure under the reference conditions, computed by `solve`.
/// \throws InvalidInput if a rigid motion remains, for a mass matrix that is not positive definite, and for a count
/// below one or above the number of modes.
template <class Eigensolver = DenseModes>
MatX fixed_interface_modes(Structure const& s, Index count,
                           ReferenceConditions const& frame = ReferenceConditions::clamped(),
                           Eigensolver const& solve = {}) {
  std::vector<Index> const free = frame.free_coordinates(s);
  detail::require_count(count, Index(free.size()));
  Structure::Sparse const k = submatrix(s.stiffness, free, free), m = submatrix(s.mass_matrix(), free, free);
  require_held(k);
  detail::require_mass(m);
  return scatter_rows(solve(k, m, count).shapes, free, s.size());
}

/// Rigid motions of the structure (N×6): displacements along x, y, z, and rotations about these axes through the centre
/// of mass.
template <class = void>  // compiled only if used
MatX rigid_motions(Structure const& s) {
  MatX out = MatX::Zero(s.size(), 6);
  Vec3 const centre = s.first / s.mass;
  for (Index i = 0; i < Index(s.nodes.size()); ++i) {
    out.block<3, 3>(s.per_node * i, 0).setIdentity();
    out.block<3, 3>(s.per_node * i, 3) = -skew<double>(Vec3(s.nodes[std::size_t(i)] - centre));
    if (s.per_node == 6) out.block<3, 3>(6 * i + 3, 3).setIdentity();
  }
  return out;
}

/// Lowest `count` deformation modes of the structure under the conditions `frame`, computed by `solve`. Without
/// conditions, the modes are those of the free structure, and the frame follows the mean motion: relative to this
/// frame, momentum and angular momentum of the deformation vanish to first order (mean axes of Tisserand or Buckens).
/// \throws InvalidInput for a count below one or above the number of these modes, and for a mass matrix that is not
/// positive definite.
template <class Eigensolver = DenseModes>
MatX free_interface_modes(Structure const& s, Index count,
                          ReferenceConditions const& frame = ReferenceConditions::none(),
                          Eigensolver const& solve = {}) {
  std::vector<Index> const free = frame.free_coordinates(s);
  MatX held = rigid_motions(s);  // rigid motions of the coordinates that `frame` holds
  held(free, Eigen::all).setZero();
  Index const rigid = 6 - (free.size() < std::size_t(s.size()) ? held.colPivHouseholderQr().rank() : 0);
  detail::require_count(count, Index(free.size()) - rigid);
  Structure::Sparse const k = submatrix(s.stiffness, free, free), m = submatrix(s.mass_matrix(), free, free);
  detail::require_mass(m);
  // K is singular. A shift of the size of a low squared frequency makes K regular and does not change the modes.
  double const shift = 1e-3 * k.diagonal().sum() / m.diagonal().sum();
  LowestModes const modes = solve(Structure::Sparse(k + shift * m), m, count + rigid);
  return scatter_rows(modes.shapes.rightCols(count), free, s.size());
}

/// Basis of the same deformations in another frame: `shapes` (N×n) minus the rigid motion R x of the new frame. With
/// the conditions W e = 0 of the frame, x = (W R)⁻¹ W e. In mean axes W = Rᵀ M. Since K R = 0, the stiffness ΦᵀKΦ is
/// the same in all frames [Agrawal & Shabana 1986; Schwertassek, Wallrapp & Shabana 1999].
/// \throws InvalidInput for shapes of another size. Frames other than mean axes require nodes with rotations, and
/// `simply_supported` also a last node away from the first along x.
template <class = void>
MatX in_frame(Structure const& s, MatX shapes, FfrFrame frame) {
  if (shapes.rows() != s.size())
    throw InvalidInput("ffr.shape_size", {ErrorObject{"Ffr"}, ": the shapes have ", ErrorValue{shapes.rows()},
                                          " rows, but the structure has ", s.size(), " nodal coordinates."});
  MatX const rigid = rigid_motions(s);
  if (frame == FfrFrame::mean_axes) {
    MatX const heavy = s.mass_matrix() * rigid;
    shapes -= rigid * Eigen::LDLT<MatX>(rigid.transpose() * heavy).solve(heavy.transpose() * shapes);
    return shapes;
  }
  if (s.per_node != 6)
    throw InvalidInput("ffr.frame", {ErrorObject{"Ffr"},
                                     ": this FfrFrame needs nodes with rotations, but the nodes have displacements "
                                     "only. Use FfrFrame::mean_axes."});
  Index const last = s.size() - 6;
  std::array<Index, 6> fixed = {0, 1, 2, 3, 4, 5};
  if (frame == FfrFrame::simply_supported) fixed = {0, 1, 2, 3, last + 1, last + 2};
  MatX of_frame(6, shapes.cols()), of_rigid(6, 6);
  for (Index i = 0; i < 6; ++i) {
    of_frame.row(i) = shapes.row(fixed[std::size_t(i)]);
    of_rigid.row(i) = rigid.row(fixed[std::size_t(i)]);
  }
  Eigen::FullPivLU<MatX> const solver(of_rigid);
  if (!solver.isInvertible())
    throw InvalidInput("ffr.frame", {ErrorObject{"Ffr"},
                                     ": FfrFrame::simply_supported needs a first and a last node at different x, but "
                                     "supports at these two nodes do not prevent rigid motion. Use another FfrFrame."});
  shapes -= rigid * solver.solve(of_frame);
  for (Index const i : fixed) shapes.row(i).setZero();
  return shapes;
}

/// Basis of a body from a structure: `shapes` in the frame `options.frame`, or unchanged if this option has no value.
/// \throws InvalidInput if `options.modes` has a value.
template <class = void>
MatX in_frame(Structure const& s, MatX shapes, FfrOptions const& options) {
  if (options.modes)
    throw InvalidInput("ffr.modes", {ErrorObject{"Ffr"},
                                     ": the option `modes` applies only to a body made from a bar. Give a basis with "
                                     "this number of shapes instead."});
  return options.frame ? in_frame(s, std::move(shapes), *options.frame) : std::move(shapes);
}

/// Basis of Craig & Bampton [1968]: constraint modes of the boundary nodes, and the `count` lowest fixed-interface
/// modes, computed by `solve`. The shapes use all coordinates, or those of the plane of x and y if `in_plane`. The
/// frame is tied to the first boundary node, whose constraint modes are omitted. With `mean_axes` the frame follows the
/// mean motion instead. The basis then consists of the free modes of the reduced model, without the rigid ones.
/// \throws InvalidInput for no boundary node, boundary nodes that do not exist or are repeated, a structure with parts
/// that no boundary node holds, a count above the number of modes, or a frame tied to a node without rotations.
template <class Eigensolver = DenseModes>
MatX craig_bampton(Structure const& s, std::vector<Index> const& boundary, Index count, bool mean_axes = false,
                   bool in_plane = false, Eigensolver const& solve = {}) {
  std::size_t const different = std::set<Index>(boundary.begin(), boundary.end()).size();
  if (boundary.empty() || different != boundary.size())
    throw InvalidInput(
        "ffr.boundary",
        {ErrorObject{"Ffr"}, ": Craig-Bampton needs at least one boundary node, and no node twice, but there are ",
         boundary.size(), " boundary nodes, ", different, " of them distinct."});
  if (!mean_axes && s.per_node != 6)
    throw InvalidInput("ffr.boundary", {ErrorObject{"Ffr"},
                                        ": without mean_axes, the boundary nodes must have rotations, but they have "
                                        "displacements only. Set mean_axes of craig_bampton to true."});
  ReferenceConditions everywhere = ReferenceConditions::none();
  if (in_plane) everywhere.restrict_to_plane();
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
    factor_positive(
        factor, kii,
        "the stiffness with fixed boundary nodes is not positive definite. Connect all nodes to boundary nodes.");
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

/// Basis of a body from one bar of n elements with the structure `s`: nodal coordinates, or modes if `options.modes`
/// has a value, which is then removed. \param in_plane true for displacements along x and y and rotations about z only
template <class = void>
MatX bar_shapes(Structure const& s, Index n, FfrOptions& options, bool in_plane) {
  std::optional<Index> const modes = std::exchange(options.modes, {});
  if (modes) return craig_bampton(s, {0, n}, *modes, false, in_plane);
  ReferenceConditions frame = ReferenceConditions::clamped();
  if (in_plane) frame.restrict_to_plane();
  return nodal_coordinates(s, frame);
}

}  // namespace polybody
