#pragma once
/// \file
/// Attachment modes and free modes of a structure in mean axes, and statically determinate supports.
/// Theory: Eq. 2.95.

#include <polybody/bodies/ffr/ffr_basis.hpp>

namespace polybody {

/// Adds statically determinate supports to `frame`: conditions that prevent rigid motions without straining the
/// structure. All coordinates of the first node a are held. If nodes have no rotations, two more nodes are held. Node b
/// is farthest from a and is held along two coordinate axes: all but the one closest to the line a–b. Node c is
/// farthest from this line and is held along the axis closest to the normal of the plane through a, b and c.
template <class = void>  // compiled only if used
ReferenceConditions statically_determinate(Structure const& s, ReferenceConditions frame = {}) {
  for (int c = 0; c < s.per_node; ++c) frame.fix(0, c);
  if (s.per_node == 6) return frame;
  auto const farthest = [&](auto const& measure) {
    Index best = 0;
    for (Index i = 1; i < Index(s.nodes.size()); ++i)
      if (measure(i).squaredNorm() > measure(best).squaredNorm()) best = i;
    return best;
  };
  auto const from_first = [&](Index i) { return Vec3(s.nodes[std::size_t(i)] - s.nodes.front()); };
  Index const b = farthest(from_first);
  Vec3 const line = from_first(b);
  auto const off_line = [&](Index i) { return Vec3(line.cross(from_first(i))); };
  Index const c = farthest(off_line);
  int along = 0, across = 0;
  line.cwiseAbs().maxCoeff(&along);
  off_line(c).cwiseAbs().maxCoeff(&across);
  return frame.fix(b, (along + 1) % 3).fix(b, (along + 2) % 3).fix(c, across);
}

namespace detail {

/// Shapes with unit modal mass, by ascending frequency, whose span is that of the columns of `shapes`. Linearly
/// dependent columns are omitted.
template <class = void>
MatX orthogonal_basis(Structure const& s, MatX shapes) {
  MatX k = shapes.transpose() * (s.stiffness * shapes);
  for (Index j = 0; j < shapes.cols(); ++j)
    if (double const size = k(j, j); size > 0.0) shapes.col(j) /= std::sqrt(size);
  k = shapes.transpose() * (s.stiffness * shapes);
  Eigen::SelfAdjointEigenSolver<MatX> const strains(k);
  Index repeated = 0;
  while (repeated < k.rows() && strains.eigenvalues()[repeated] <= 1e-9 * strains.eigenvalues().tail<1>()[0])
    ++repeated;
  shapes = (shapes * strains.eigenvectors().rightCols(k.rows() - repeated)).eval();
  MatX const reduced_k = shapes.transpose() * (s.stiffness * shapes),
             reduced_m = shapes.transpose() * (s.mass_matrix() * shapes);
  Eigen::GeneralizedSelfAdjointEigenSolver<MatX> const reduced(reduced_k, reduced_m);
  return shapes * reduced.eigenvectors();
}

}  // namespace detail

/// Basis of static shapes for nodal loads and of free modes, in mean axes [MacNeal 1971; Rubin 1975; Craig & Kurdila
/// 2006, §17.3]. The inertia of the resulting rigid acceleration balances a load f on the free structure:
///   f_b = f − M R (RᵀM R)⁻¹ Rᵀ f,  K x = f_b,  Rᵀ M x = 0,  with the rigid motions R.
/// Stress and stiffness under such loads therefore equal those of the full model for any number of modes. The basis is
/// suitable for nodes without rotations, which cannot hold the frame in `craig_bampton`, and for loads on patches of
/// nodes.
///
/// The result contains the static shapes of the nodal loads `loads` (N×m) and the `count` lowest modes, computed by
/// `solve`. The shapes are orthogonal with unit modal mass. Linearly dependent shapes are omitted.
/// \throws InvalidInput for loads that do not fit the structure or are not finite, for neither loads nor modes, for a
/// count that is negative or above the number of modes, and for a structure that has motions without strain other than
/// rigid ones.
template <class Eigensolver = DenseModes>
MatX attachment_modes(Structure const& s, MatX const& loads, Index count, Eigensolver const& solve = {}) {
  require_finite(loads, "Ffr: the nodal loads of attachment modes");
  if (loads.rows() != s.size())
    throw InvalidInput("ffr.modes", {ErrorObject{"Ffr"}, ": the nodal loads of attachment modes must have ", s.size(),
                                     " rows, but have ", ErrorValue{loads.rows()}, "."});
  if (count < 0 || loads.cols() + count == 0)
    throw InvalidInput("ffr.modes",
                       {ErrorObject{"Ffr"}, ": attachment modes need at least one load or one mode, but there are ",
                        loads.cols(), " loads and ", ErrorValue{count}, " modes."});
  MatX const rigid = rigid_motions(s), heavy = s.mass_matrix() * rigid;
  Eigen::LDLT<MatX> const mass(rigid.transpose() * heavy);
  std::vector<Index> const free = statically_determinate(s).free_coordinates(s);
  SparseFactor factor;
  factor_positive(factor, submatrix(s.stiffness, free, free),
                  "parts of the structure can move relative to each other without strain. Connect these parts.");
  MatX shapes(s.size(), loads.cols() + count);
  if (loads.cols() > 0) {
    MatX const balanced = loads - heavy * mass.solve(rigid.transpose() * loads);
    MatX held(Index(free.size()), loads.cols());
    for (std::size_t i = 0; i < free.size(); ++i) held.row(Index(i)) = balanced.row(free[i]);
    shapes.leftCols(loads.cols()) = scatter_rows(factor.solve(held), free, s.size());
  }
  if (count > 0) shapes.rightCols(count) = free_interface_modes(s, count, ReferenceConditions::none(), solve);
  return detail::orthogonal_basis(s, in_frame(s, std::move(shapes), FfrFrame::mean_axes));
}

}  // namespace polybody
