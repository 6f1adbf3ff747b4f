#pragma once
/// \file
/// Nodes and matrices without labels: lines x y z, and Matrix Market files.

#include <polybody/bodies/fe/fe_matrix.hpp>
#include <polybody/bodies/ffr/matrix_structure.hpp>

namespace polybody {

/// Nodes of a file with a line x y z for each node, in which # begins a comment. The labels are 1, 2, 3, ….
/// \throws IoError, with the line, for other content.
template <class = void>
FeNodes read_plain_nodes(std::string const& file) {
  FeNodes nodes;
  nodes.file = file;
  nodes.positions = detail::read_nodes(file);
  for (std::size_t i = 0; i < nodes.positions.size(); ++i) nodes.labels.push_back(Index(i) + 1);
  return nodes;
}

/// Matrix of a Matrix Market file (`read_matrix`) with the rows x, y, z of each node. A file that is declared `general`
/// but contains one triangle is read as a symmetric matrix; `FeMatrix::remarks` contains a sentence about it.
/// \throws IoError, with the line, for other content.
template <class = void>
FeMatrix read_matrix_market(std::string const& file, FeNodes const& nodes) {
  Index const n = 3 * nodes.size();
  Structure::Sparse const m = read_matrix(
      file, n, n,
      sentence_of({nodes.size(), " nodes of ", nodes.file, " need ", n, "×", n, ", three displacements each"}));
  detail::FeText const text(file);
  detail::FeEntries entries(nodes);
  for (Index j = 0; j < m.outerSize(); ++j)
    for (Structure::Sparse::InnerIterator it(m, j); it; ++it) entries.add(text, it.row(), j, it.value());
  return entries.assembled(text, false);
}

}  // namespace polybody
