#pragma once
/// \file
/// Matrices of Nastran in text files of OUTPUT4: dense columns, and sparse columns in both layouts [MSC Nastran DMAP
/// Programmer's Guide, OUTPUT4]. The layouts agree with op4/test/mat_t_s2.op4 of SteveDoyle2/pyNastran.

#include <polybody/bodies/fe/fe_matrix.hpp>

namespace polybody {

namespace detail {

/// First line of a matrix in an OP4 file.
struct Op4Header {
  Index columns = 0, rows = 0, form = 0, type = 0;
  bool wide = false;     ///< strings of a column have two integers, the length and the row
  std::string name;      ///< in capital letters
  FixedColumns numbers;  ///< columns of the lines with numbers

  Op4Header(FeText const& text, std::string_view line) {
    if (line.size() < 33) text.fail("the line is not the header of an OP4 matrix: columns, rows, form, type, name");
    Index* const all[4] = {&columns, &rows, &form, &type};
    for (std::size_t k = 0; k < 4; ++k)
      *all[k] = text.integer(line.substr(8 * k, 8), "an integer of the header of an OP4 matrix");
    wide = rows < 0;
    rows = rows < 0 ? -rows : rows;
    name = capitals(trimmed(line.substr(32, 8)));
    std::string_view const format = line.size() > 40 ? trimmed(line.substr(40)) : "1P,5E16.9";
    numbers = FixedColumns::of(format, "EeDd");
    if (columns < 1 || numbers.per_line == 0)
      text.fail("the header of the OP4 matrix " + name + " must have columns and a format such as 1P,3E23.16");
  }
  /// Refuses complex and non-square matrices, and those with another size than that of the nodes.
  void require_size(FeText const& text, Index nodes) const {
    if (type != 1 && type != 2)
      text.fail(sentence_of({"the type of the matrix ", name, " is ", type, ", but must be 1 or 2 (real)"}));
    if (columns != rows || (rows != 3 * nodes && rows != 6 * nodes))
      text.fail(sentence_of({"the matrix ", name, " is ", rows, "×", columns, ", but ", nodes, " nodes need ",
                             3 * nodes, "×", 3 * nodes, ", or ", 6 * nodes, "×", 6 * nodes, " with rotations"}));
  }
  /// Numbers of the next lines, up to a line that begins with an integer.
  std::vector<double> values(FeText& text) const {
    std::vector<double> all;
    for (std::string line; text.peek(line) && line.find('.') < std::min(numbers.width, std::size_t(32));) {
      text.next(line);
      for (std::string_view const field : numbers.fields(line)) all.push_back(text.real(field, "an entry"));
    }
    return all;
  }
};

/// Columns of one matrix of an OP4 file.
class Op4Columns {
 public:
  Op4Columns(FeText& text, Op4Header const& header, Index nodes) : text_(text), header_(header), nodes_(nodes) {}

  /// Reads all columns. Adds their entries if `entries` is not null.
  void read(FeEntries* entries) {
    for (std::string line;;) {
      if (!text_.next_filled(line)) text_.fail("the file ends within the matrix " + header_.name);
      std::vector<std::string_view> const words = words_of(line);
      if (words.size() != 3) text_.fail(FeText::quoted(line) + " is not column, row and number of words");
      Index const column = integer(words[0]), row = integer(words[1]), count = integer(words[2]);
      if (column > header_.columns) {
        header_.values(text_);
        return;
      }
      if (row > 0)
        take(entries, column, row, count);
      else
        strings(entries, column);
    }
  }

 private:
  Index integer(std::string_view word) const { return text_.integer(word, "an integer of an OP4 column"); }

  /// Strings of a sparse column: length and row in two integers, or in one (65536 (length + 1) + row).
  void strings(FeEntries* entries, Index column) {
    std::string line;
    while (text_.peek(line)) {
      std::size_t const count = words_of(line).size();
      if (count != (header_.wide ? 2u : 1u)) return;
      text_.next(line);
      std::vector<std::string_view> const words = words_of(line);
      Index const first = integer(words[0]);
      if (header_.wide)
        take(entries, column, integer(words[1]), first - 1);
      else
        take(entries, column, first % 65536, first / 65536 - 1);
    }
  }
  /// Reads the numbers of a string. Its length counts words, of which a double has two, or numbers.
  void take(FeEntries* entries, Index column, Index row, Index length) {
    std::vector<double> const values = header_.values(text_);
    Index const count = Index(values.size());
    if (count == 0 || (length != count && length != 2 * count))
      text_.fail(sentence_of({"column ", column, " of the matrix ", header_.name, " has ", count, " numbers from row ",
                              row, ", but declares ", length, " words"}));
    if (!entries) return;
    Index const components = header_.rows / nodes_;
    for (Index const i : {column, row, std::min(row, header_.rows) + count - 1})
      FeEntries::require_inside(text_, i, header_.rows);
    for (Index k = 0; k < count; ++k)
      entries->add(text_, place(row - 1 + k, components), place(column - 1, components), values[std::size_t(k)]);
  }
  static Index place(Index row, Index components) {
    Index const component = row % components;
    return component < 3 ? 3 * (row / components) + component : -1;
  }

  FeText& text_;
  Op4Header const& header_;
  Index nodes_;
};

}  // namespace detail

/// Matrix `name` of a text file of OUTPUT4. Its rows are the components of each node in ascending order of the labels:
/// three displacements, or three displacements and three rotations without entries.
/// \throws IoError, with the line, for other content, and for a file without this matrix.
template <class = void>
FeMatrix read_op4_matrix(std::string const& file, std::string const& name, FeNodes const& nodes) {
  detail::FeText text(file);
  detail::FeEntries entries(nodes);
  std::string line, others;
  while (text.next_filled(line)) {
    detail::Op4Header const header(text, line);
    bool const wanted = header.name == detail::capitals(name);
    if (wanted) header.require_size(text, nodes.size());
    detail::Op4Columns(text, header, nodes.size()).read(wanted ? &entries : nullptr);
    if (wanted) return entries.assembled(text, header.form == 6);
    others += (others.empty() ? "; it has the matrices " : ", ") + header.name;
  }
  text.fail("the file has no OP4 matrix " + name + others);
}

}  // namespace polybody
