#pragma once
/// \file
/// Reader for sparse matrices of a finite element program in the coordinate format of Matrix Market.

#include <unordered_set>
#include <vector>

#include <Eigen/SparseCore>

#include <polybody/bodies/ffr/number_reader.hpp>

namespace polybody {

/// Reads a sparse m×n matrix from a Matrix Market file [Boisvert, Pozo & Remington 1996]: coordinate, real or integer,
/// general or symmetric. A symmetric matrix is given by its lower triangle. Eigen's unsupported loader is not used: it
/// returns half of a symmetric matrix and does not check indices. `need` is the end of the message "the matrix is 2×2,
/// but the …" and explains the required size.
/// \throws IoError, with the line, for any other content.
template <class = void>  // compiled only if used
Eigen::SparseMatrix<double> read_matrix(std::string const& file, Index m, Index n, std::string const& need) {
  NumberReader lines(file, '%');
  std::string banner;
  lines.raw(banner);
  for (char& c : banner) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
  std::istringstream words(banner);
  std::string mark, object, format, field, kind;
  words >> mark >> object >> format >> field >> kind;
  if (mark != "%%matrixmarket" || object != "matrix" || format != "coordinate" ||
      (field != "real" && field != "integer") || (kind != "general" && kind != "symmetric"))
    lines.fail(
        "the first line must be '%%MatrixMarket matrix coordinate real general' or '%%MatrixMarket matrix coordinate "
        "real symmetric'; write the matrix in one of these formats");
  Index rows = 0, columns = 0, count = 0;
  std::string const sizes = "the number of rows, of columns and of entries";
  if (!lines.next(sizes, rows, columns, count)) lines.fail("the file ends before " + sizes);
  if (count < 0) lines.fail("the number of entries must not be negative, but is " + std::to_string(count));
  if (rows != m || columns != n)
    lines.fail("the matrix is " + std::to_string(rows) + "×" + std::to_string(columns) + ", but the " + need);
  if (kind == "symmetric" && m != n) lines.fail("a symmetric matrix has as many rows as columns");
  std::vector<Eigen::Triplet<double>> entries;
  std::unordered_set<Index> seen;
  for (Index e = 0; e < count; ++e) {
    Index i = 0, j = 0;
    double value = 0.0;
    if (!lines.next("a row, a column and a finite number", i, j, value))
      lines.fail("the file ends after " + std::to_string(e) + " of " + std::to_string(count) +
                 " entries; it is truncated");
    if (i < 1 || i > m || j < 1 || j > n)
      lines.fail("entry (" + std::to_string(i) + ", " + std::to_string(j) +
                 ") is outside the matrix, whose rows are 1 to " + std::to_string(m) + " and columns 1 to " +
                 std::to_string(n));
    if (kind == "symmetric" && i < j)
      lines.fail("a symmetric matrix is written by its lower triangle, but this entry is above the diagonal");
    if (!seen.insert(n * i + j).second)
      lines.fail("entry (" + std::to_string(i) + ", " + std::to_string(j) + ") occurs a second time");
    entries.emplace_back(int(i - 1), int(j - 1), value);
    if (kind == "symmetric" && i != j) entries.emplace_back(int(j - 1), int(i - 1), value);
  }
  lines.next("the end of the file after " + std::to_string(count) + " entries");
  Eigen::SparseMatrix<double> matrix(m, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace polybody
