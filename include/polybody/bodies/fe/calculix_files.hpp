#pragma once
/// \file
/// Nodes and matrices of CalculiX: the .sti, .mas and .dof files of *FREQUENCY, SOLVER=MATRIXSTORAGE, and the nodes of
/// .inp and .frd files [CalculiX CrunchiX User's Manual 2.20; cgx User's Manual 2.20, Result format].

#include <polybody/bodies/fe/abaqus_files.hpp>

namespace polybody {

namespace detail {

/// Nodes of the block 2C of a .frd file: lines with −1, the label (5 or 10 characters) and x, y, z (12 each).
template <class = void>  // compiled only if used
FeNodes read_frd_nodes(FeText& text) {
  FeNodeList nodes;
  std::string line;
  std::size_t label = 0;
  while (text.next(line)) {
    std::vector<std::string_view> const words = words_of(line);
    if (label == 0) {
      if (words.empty() || words[0] != "2C") continue;
      if (words.size() != 3 || (words[2] != "0" && words[2] != "1"))
        text.fail("the block of nodes must be text: the line 2C must end with the format 0 or 1");
      label = words[2] == "0" ? 5 : 10;
      continue;
    }
    if (!words.empty() && words[0] == "-3") break;
    if (words.empty() || !line.starts_with(" -1") || line.size() < 3 + label + 36)
      text.fail(FeText::quoted(line) + " is not -1, label, x, y, z of a node");
    std::string_view const fields = line;
    Vec3 r;
    for (std::size_t k = 0; k < 3; ++k)
      r[Index(k)] = text.real(fields.substr(3 + label + 12 * k, 12), "a coordinate of a node");
    nodes.add(text, text.integer(fields.substr(3, label), "the label of a node"), r);
  }
  return nodes.sorted(text, "block 2C");
}

/// Rows of a .dof file, whose line k is node.component of row k.
template <class = void>
std::vector<Index> read_dof_rows(std::string const& file, FeEntries const& entries) {
  FeText text(file);
  std::vector<Index> rows;
  std::string line;
  while (text.next_filled(line)) {
    std::string_view const word = trimmed(line);
    std::size_t const dot = word.find('.');
    if (dot == word.npos) text.fail(FeText::quoted(word) + " is not node.component of a row of the matrix");
    rows.push_back(entries.row(text, text.integer(word.substr(0, dot), "the label of a node"),
                               text.integer(word.substr(dot + 1), "a component")));
  }
  if (rows.empty()) text.fail("the file has no rows: it has no lines node.component");
  return rows;
}

}  // namespace detail

/// Nodes of an input file (.inp) or a result file (.frd) of CalculiX. The result file has six digits, too few for the
/// check of rigid motions in a slender body: prefer the input file.
/// \throws IoError, with the line, for other content.
template <class = void>
FeNodes read_calculix_nodes(std::string const& file) {
  detail::FeText text(file);
  std::string line;
  text.peek(line);
  return detail::trimmed(line).starts_with("1C") ? detail::read_frd_nodes(text) : read_abaqus_nodes(file);
}

/// Matrix of a .sti or .mas file of CalculiX, with lines row, column, value of the upper triangle. `dof_file`, the .dof
/// file, names node and component of each row.
/// \throws IoError, with the line, for other content.
template <class = void>
FeMatrix read_calculix_matrix(std::string const& file, std::string const& dof_file, FeNodes const& nodes) {
  detail::FeEntries entries(nodes);
  std::vector<Index> const rows = detail::read_dof_rows(dof_file, entries);
  detail::FeText text(file);
  std::string line;
  while (text.next_filled(line)) {
    std::vector<std::string_view> const words = detail::words_of(line);
    if (words.size() != 3) text.fail(detail::FeText::quoted(line) + " is not row, column, value of an entry");
    Index place[2];
    for (std::size_t k = 0; k < 2; ++k) {
      Index const i = text.integer(words[k], "a row or column");
      detail::FeEntries::require_inside(text, i, Index(rows.size()));
      place[k] = rows[std::size_t(i - 1)];
    }
    entries.add(text, place[0], place[1], text.real(words[2], "an entry"));
  }
  return entries.assembled(text, true);
}

}  // namespace polybody
