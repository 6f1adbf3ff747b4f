#pragma once
/// \file
/// Nodes and matrices in the text formats of Abaqus: *NODE, and *MATRIX OUTPUT with FORMAT=MATRIX INPUT, LABELS or
/// COORDINATE [Abaqus Analysis User's Guide, Generating structural matrices]. CalculiX reads the same *NODE lines.
/// The format COORDINATE agrees with the samples main/pythonDev/TestModels/testData/abaqus of jgerstmayr/EXUDYN.

#include <map>
#include <utility>

#include <polybody/bodies/fe/fe_matrix.hpp>

namespace polybody {

namespace detail {

/// Keyword line of an input file: the name, and the parameters with their values in capital letters.
struct AbaqusKeyword {
  std::string name;                               ///< such as "NODE"; empty for a line of data
  std::map<std::string, std::string> parameters;  ///< value of each parameter
  bool continues = false;                         ///< the next line continues the keyword

  explicit AbaqusKeyword(std::string_view line) {
    line = trimmed(line);
    if (line.empty() || line[0] != '*') return;
    std::vector<std::string_view> const cells = cells_of(line.substr(1));
    name = capitals(cells[0]);
    for (std::size_t k = 1; k < cells.size(); ++k) {
      std::size_t const equals = std::min(cells[k].find('='), cells[k].size());
      std::string_view const value = cells[k].substr(std::min(equals + 1, cells[k].size()));
      parameters[capitals(trimmed(cells[k].substr(0, equals)))] = capitals(trimmed(value));
    }
    continues = cells.size() > 1 && cells.back().empty();
  }
};

/// Refuses keywords that make or move nodes outside of *NODE lines.
template <class = void>  // compiled only if used
void require_plain_nodes(FeText const& text, AbaqusKeyword const& keyword) {
  for (char const* const other : {"NGEN", "NFILL", "NCOPY", "NMAP", "SYSTEM", "INCLUDE"})
    if (keyword.name == other)
      text.fail("*" + keyword.name + " is not read; write every node by a line of *NODE in this file");
  if (keyword.name != "NODE") return;
  auto const system = keyword.parameters.find("SYSTEM");
  if (system != keyword.parameters.end() && system->second != "R")
    text.fail("*NODE with SYSTEM=" + system->second + " is not read; write the nodes in rectangular axes");
  if (keyword.parameters.count("INPUT") > 0) text.fail("*NODE with INPUT is not read; write the nodes in this file");
}

template <class = void>
void refuse_abaqus_fixed(FeText const& text, double value) {
  if (std::abs(value) >= 1e30)
    text.fail(sentence_of({"the entry ", value, " marks a fixed displacement; export the matrix without *BOUNDARY"}));
}

}  // namespace detail

/// Nodes of the *NODE lines of an input file of Abaqus or CalculiX: label, x, y, z.
/// \throws IoError, with the line, for any other content of these lines, and for nodes that other keywords make.
template <class = void>
FeNodes read_abaqus_nodes(std::string const& file) {
  detail::FeText text(file);
  detail::FeNodeList nodes;
  std::string line;
  bool inside = false, instance = false, continues = false;
  while (text.next_filled(line)) {
    std::string_view const data = detail::trimmed(line);
    if (data.starts_with("**")) continue;
    if (std::exchange(continues, false)) {
      continues = data.ends_with(',');
      continue;
    }
    if (data[0] == '*') {
      detail::AbaqusKeyword const keyword(data);
      detail::require_plain_nodes(text, keyword);
      inside = keyword.name == "NODE", instance = keyword.name == "INSTANCE", continues = keyword.continues;
      continue;
    }
    if (instance) text.fail("the instance of the part is moved; export a part whose instance has no translation");
    if (!inside) continue;
    std::vector<std::string_view> cells = detail::cells_of(data);
    while (cells.size() > 4 && cells.back().empty()) cells.pop_back();
    if (cells.size() != 4) text.fail(detail::FeText::quoted(data) + " is not label, x, y, z of a node");
    Vec3 r;
    for (std::size_t k = 0; k < 3; ++k) r[Index(k)] = text.real(cells[k + 1], "a coordinate of a node");
    nodes.add(text, text.integer(cells[0], "the label of a node"), r);
  }
  return nodes.sorted(text, "lines after *NODE");
}

/// Matrix of a file that *MATRIX OUTPUT of Abaqus writes. Each line has node, component, node, component, value
/// (MATRIX INPUT, LABELS; one triangle of a symmetric matrix), or row, column, value (COORDINATE; both triangles). The
/// rows of COORDINATE are x, y, z of each node in ascending order of the labels.
/// \throws IoError, with the line, for any other content.
template <class = void>
FeMatrix read_abaqus_matrix(std::string const& file, FeNodes const& nodes) {
  detail::FeText text(file);
  detail::FeEntries entries(nodes);
  std::string line;
  std::size_t count = 0;
  bool symmetric = true;
  while (text.next_filled(line)) {
    std::string_view const data = detail::trimmed(line);
    if (data.starts_with("**")) continue;
    if (detail::AbaqusKeyword const keyword(data); !keyword.name.empty()) {
      if (keyword.name != "MATRIX INPUT")
        text.fail("*" + keyword.name + " is not expected; the file must contain entries of one matrix, written by " +
                  "*MATRIX OUTPUT");
      auto const type = keyword.parameters.find("TYPE");
      symmetric = type == keyword.parameters.end() || !type->second.starts_with("UNSYM");
      continue;
    }
    std::vector<std::string_view> const words = detail::words_of(data, ", \t\r\v\f");
    if (count == 0) count = words.size();
    if (words.size() != count || (count != 3 && count != 5))
      text.fail(detail::FeText::quoted(data) + " is not an entry: node, component, node, component, value or " +
                "row, column, value, as in the lines before");
    Index row[2];
    for (std::size_t k = 0; k < 2; ++k) {
      Index const first = text.integer(words[count == 5 ? 2 * k : k], "the label of a node or the number of a row");
      if (first < 1)
        text.fail(sentence_of({"the label ", first, " belongs to a variable of Abaqus that is no displacement of a ",
                               "node; use solid elements without constraints"}));
      if (count == 3) detail::FeEntries::require_inside(text, first, 3 * nodes.size());
      row[k] = count == 3 ? first - 1 : entries.row(text, first, text.integer(words[2 * k + 1], "a component"));
    }
    double const value = text.real(words[count - 1], "an entry");
    detail::refuse_abaqus_fixed(text, value);
    entries.add(text, row[0], row[1], value);
  }
  return entries.assembled(text, symmetric && count == 5);
}

}  // namespace polybody
