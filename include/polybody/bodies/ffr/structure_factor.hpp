#pragma once
/// \file
/// Submatrices of the matrices of a structure, and their factorisation.
///
/// Not in polybody.hpp: Eigen's sparse module and factorisations take seconds to compile.

#include <polybody/bodies/ffr/structure.hpp>

namespace polybody {

/// Submatrix of the given rows and columns of a sparse matrix.
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

}  // namespace polybody
