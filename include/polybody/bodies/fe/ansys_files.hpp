#pragma once
/// \file
/// Nodes and matrices of Ansys: NBLOCK of a .cdb file or the output of NLIST, and the Harwell–Boeing file with its
/// mapping file of HBMAT [Ansys Mechanical APDL Command Reference, HBMAT; Users' guide for
/// the Harwell–Boeing sparse matrix collection]. The formats agree with the samples
/// tests/Verification/ANSYS_rst/STIFF_ANSYS.HB and .mapping of fjramireg/StiffMa.

#include <polybody/bodies/fe/fe_matrix.hpp>

namespace polybody {

namespace detail {

/// Rotated axes of a node, three angles, are refused: the rows of the matrices are then not x, y, z.
template <class = void>  // compiled only if used
void refuse_ansys_angles(FeText const& text, std::vector<std::string_view> const& fields, std::size_t first) {
  for (std::size_t k = first; k < fields.size(); ++k)
    if (!fields[k].empty() && text.real(fields[k], "an angle of the axes of a node") != 0.0)
      text.fail("node " + std::string(fields[0]) + " has rotated axes; rotate them back by NROTAT or NANG");
}

/// Coordinates in the fields from `first`. Zeros at the end of a line may be missing.
template <class = void>
Vec3 ansys_position(FeText const& text, std::vector<std::string_view> const& fields, std::size_t first) {
  Vec3 r = Vec3::Zero();
  for (std::size_t k = 0; k < 3 && first + k < fields.size(); ++k)
    if (!fields[first + k].empty()) r[Index(k)] = text.real(fields[first + k], "a coordinate of a node");
  refuse_ansys_angles(text, fields, first + 3);
  return r;
}

/// Nodes of a block that begins with NBLOCK, such as NBLOCK,6,SOLID, followed by a format such as (3i9,6e21.13e3).
template <class = void>
void read_nblock(FeText& text, FeNodeList& nodes) {
  std::string line;
  text.next(line);
  FixedColumns const integers = FixedColumns::of(line, "iI"), reals = FixedColumns::of(line, "eE");
  if (integers.per_line == 0 || reals.per_line < 3)
    text.fail(FeText::quoted(line) + " is not a format of NBLOCK such as (3i9,6e21.13e3)");
  std::size_t const start = integers.per_line * integers.width;
  while (text.next(line)) {
    std::string_view const first = trimmed(line);
    if (first.starts_with("N,") || first.starts_with("-1") || first.empty()) return;
    std::vector<std::string_view> fields = integers.fields(std::string_view(line).substr(0, start));
    fields.resize(integers.per_line);
    if (line.size() > start)
      for (std::string_view const field : reals.fields(std::string_view(line).substr(start))) fields.push_back(field);
    Vec3 const r = ansys_position(text, fields, integers.per_line);
    nodes.add(text, text.integer(fields[0], "the label of a node"), r);
  }
}

/// Row of the matrix for each equation of a mapping file: lines with equation, node and UX, UY or UZ.
template <class = void>
std::vector<Index> read_ansys_mapping(std::string const& file, FeEntries const& entries) {
  static constexpr std::string_view names[] = {"UX", "UY", "UZ", "ROTX", "ROTY", "ROTZ"};
  FeText text(file);
  std::vector<Index> rows;
  std::string line;
  while (text.next_filled(line)) {
    std::vector<std::string_view> const words = words_of(line);
    if (rows.empty() && words[0] == "Matrix") continue;
    if (words.size() != 3) text.fail(FeText::quoted(line) + " is not equation, node and name of a displacement");
    auto const name = std::find(std::begin(names), std::end(names), words[2]);
    if (name == std::end(names))
      text.fail(FeText::quoted(words[2]) + " is no displacement; the names are UX, UY and UZ");
    if (text.integer(words[0], "the number of an equation") != Index(rows.size()) + 1)
      text.fail(sentence_of({"the equation ", words[0], " is out of order; the next one is ", rows.size() + 1}));
    rows.push_back(entries.row(text, text.integer(words[1], "the label of a node"), name - std::begin(names) + 1));
  }
  if (rows.empty()) text.fail("the file has no lines with equation, node and name of a displacement");
  return rows;
}

/// Reader of a Harwell–Boeing file: a header of four or five lines, then the first entry of each column, the row of
/// each entry, and the entries.
class HarwellBoeing {
 public:
  explicit HarwellBoeing(FeText& text) : text_(text) {
    std::string line = required("the title"), counts = required("the numbers of lines");
    std::vector<std::string_view> const lines = words_of(counts);
    bool const right_side = lines.size() > 4 && text_.integer(lines[4], "a number of lines") > 0;
    line = required("the type and the size of the matrix");
    type_ = capitals(line.substr(0, 3));
    std::vector<std::string_view> const sizes =
        words_of(std::string_view(line).substr(std::min(line.size(), std::size_t(3))));
    if (type_ != "RSA" && type_ != "RUA")
      text_.fail("the type of the matrix is " + FeText::quoted(type_) +
                 ", but must be RSA or RUA: real entries, symmetric or not, assembled");
    if (sizes.size() < 3) text_.fail("the line lacks the numbers of rows, columns and entries");
    for (std::size_t k = 0; k < 3; ++k) size_[k] = text_.integer(sizes[k], "a number of rows, columns or entries");
    if (size_[0] != size_[1] || size_[0] < 1 || size_[2] < 0)
      text_.fail(
          sentence_of({"the matrix is ", size_[0], "×", size_[1], " with ", size_[2], " entries, but must be square"}));
    line = required("the formats");
    line.resize(std::max(line.size(), std::size_t(52)), ' ');
    format_[0] = FixedColumns::of(std::string_view(line).substr(0, 16), "iI");
    format_[1] = FixedColumns::of(std::string_view(line).substr(16, 16), "iI");
    format_[2] = FixedColumns::of(std::string_view(line).substr(32, 20), "eEdDfFgG");
    for (FixedColumns const& format : format_)
      if (format.per_line == 0) text_.fail("the line must have formats such as (10I8) (10I8) (3D25.15)");
    if (right_side) required("the format of the right-hand side");
  }
  bool symmetric() const { return type_ == "RSA"; }
  Index size() const { return size_[0]; }

  /// Adds the entries of equations i and j to rows[i] and rows[j].
  void read(FeEntries& entries, std::vector<Index> const& rows) {
    std::vector<Index> const starts = integers(size_[0] + 1, 0, "the start of a column");
    for (std::size_t j = 0; j + 1 < starts.size(); ++j)
      if (starts[j] > starts[j + 1]) text_.fail(sentence_of({"column ", j + 1, " starts behind the next one"}));
    if (starts.front() != 1 || starts.back() != size_[2] + 1)
      text_.fail(sentence_of({"the columns contain entries ", starts.front(), " to ", starts.back() - 1,
                              ", but the matrix has entries 1 to ", size_[2]}));
    std::vector<Index> const places = integers(size_[2], 1, "the row of an entry");
    for (Index const i : places) FeEntries::require_inside(text_, i, size_[0]);
    std::size_t entry = 0, column = 0;
    numbers(size_[2], 2, [&](std::string_view field) {
      while (starts[column + 1] <= Index(entry) + 1) ++column;
      entries.add(text_, rows[std::size_t(places[entry] - 1)], rows[column], text_.real(field, "an entry"));
      ++entry;
    });
  }

 private:
  std::string required(char const* what) {
    std::string line;
    if (!text_.next(line)) text_.fail(std::string("the file ends before ") + what);
    return line;
  }
  /// Calls `take` with the text of each of `count` numbers, which begin on a new line.
  template <class Take>
  void numbers(Index count, std::size_t section, Take&& take) {
    std::string line;
    for (Index k = 0; k < count;) {
      if (!text_.next(line))
        text_.fail(sentence_of({"the file ends after ", k, " of ", count, " numbers; it is truncated"}));
      for (std::string_view const field : format_[section].fields(line)) {
        if (k == count) text_.fail("the line has more numbers than the header declares");
        take(field);
        ++k;
      }
    }
  }
  std::vector<Index> integers(Index count, std::size_t section, char const* what) {
    std::vector<Index> all;
    numbers(count, section, [&](std::string_view field) { all.push_back(text_.integer(field, what)); });
    return all;
  }

  FeText& text_;
  std::string type_;
  Index size_[3] = {0, 0, 0};
  FixedColumns format_[3];
};

}  // namespace detail

/// Nodes of Ansys: of the first NBLOCK of a .cdb file (CDWRITE), or of the table that NLIST prints.
/// \throws IoError, with the line, for nodes with rotated axes and for fields without a number.
template <class = void>
FeNodes read_ansys_nodes(std::string const& file) {
  detail::FeText text(file);
  detail::FeNodeList nodes;
  bool table = false;
  for (std::string line; text.next_filled(line);) {
    std::vector<std::string_view> const words = detail::words_of(line);
    if (detail::capitals(words[0]).starts_with("NBLOCK")) {
      detail::read_nblock(text, nodes);
      break;
    }
    if (words[0] == "NODE" && words.size() > 1 && words[1] == "X") table = true;
    if (!table || std::isalpha(static_cast<unsigned char>(words[0][0]))) continue;
    if (words.size() != 4 && words.size() != 7)
      text.fail(detail::FeText::quoted(line) + " is not node, x, y, z, with or without three angles");
    Vec3 const r = detail::ansys_position(text, words, 1);
    nodes.add(text, text.integer(words[0], "the label of a node"), r);
  }
  return nodes.sorted(text, "NBLOCK and no table NODE X Y Z");
}

/// Matrix of a text file that HBMAT of Ansys writes in Harwell–Boeing format, with its `mapping_file`, which names
/// the node and the displacement of each equation.
/// \throws IoError, with the line, for other content, such as a matrix without values or with other unknowns.
template <class = void>
FeMatrix read_ansys_matrix(std::string const& file, std::string const& mapping_file, FeNodes const& nodes) {
  detail::FeEntries entries(nodes);
  std::vector<Index> const rows = detail::read_ansys_mapping(mapping_file, entries);
  detail::FeText text(file);
  detail::HarwellBoeing matrix(text);
  if (matrix.size() != Index(rows.size()))
    text.fail(sentence_of(
        {"the matrix has ", matrix.size(), " rows, but ", mapping_file, " has ", rows.size(), " equations"}));
  matrix.read(entries, rows);
  return entries.assembled(text, matrix.symmetric());
}

}  // namespace polybody
