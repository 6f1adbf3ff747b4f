#pragma once
/// \file
/// Bulk data of Nastran: GRID and DMIG entries in small field, large field and free field format [MSC Nastran Quick
/// Reference Guide, Bulk Data Entries].

#include <utility>

#include <polybody/bodies/fe/fe_matrix.hpp>

namespace polybody {

namespace detail {

/// Entry of the bulk data: its name and its fields 2 to 9, followed by the same fields of the continuation lines.
struct NastranCard {
  std::string name;                 ///< in capital letters, without *
  std::vector<std::string> fields;  ///< without blanks around them
  std::string const& at(std::size_t k) const {
    static std::string const blank;
    return k < fields.size() ? fields[k] : blank;
  }
};

/// Reader of the entries of bulk data.
class NastranBulk {
 public:
  explicit NastranBulk(FeText& text) : text_(text) {}

  /// Reads the next entry; returns false at the end of the file.
  bool next(NastranCard& card) {
    std::string line;
    if (!next_line(line)) return false;
    card.fields.clear();
    card.name = append(line, card.fields);
    while (peek_line(line) && continues(line)) {
      next_line(line);
      append(line, card.fields);
    }
    return true;
  }

 private:
  static bool continues(std::string const& line) {
    std::string_view const first = std::string_view(line).substr(0, std::min(line.find(','), std::size_t(8)));
    return trimmed(first).empty() || first[0] == '+' || first[0] == '*';
  }
  static void clean(std::string& line) {
    line.resize(std::min(line.find('$'), line.size()));
    for (std::size_t tab = line.find('\t'); tab != line.npos; tab = line.find('\t'))
      line.replace(tab, 1, 8 - tab % 8, ' ');
    line.resize(line.find_last_not_of(" \r\v\f") + 1);
  }
  bool peek_line(std::string& line) {
    for (; text_.peek(line); text_.skip()) {
      clean(line);
      if (!line.empty()) return true;
    }
    return false;
  }
  bool next_line(std::string& line) {
    std::string kept;
    if (!peek_line(line)) return false;
    return text_.next(kept);
  }
  /// Appends the fields of a line, filled up to four or eight, and returns the name in its first field.
  std::string append(std::string const& line, std::vector<std::string>& fields) {
    std::vector<std::string_view> words;
    std::string_view const all = line;
    bool const free = line.find(',') != line.npos;
    if (free)
      words = cells_of(all);
    else
      words.push_back(trimmed(all.substr(0, 8)));
    bool const large = words[0].ends_with('*') || words[0].starts_with('*');
    std::size_t const count = large ? 4 : 8, width = large ? 16 : 8;
    if (!free)
      for (std::size_t k = 0; k < count && 8 + k * width < all.size(); ++k)
        words.push_back(trimmed(all.substr(8 + k * width, width)));
    if (free && words.size() > count + 1 && !(words.size() == count + 2 && is_mark(words.back())))
      text_.fail(sentence_of({"the line has ", words.size() - 1, " fields, more than ", count}));
    words.resize(count + 1);
    for (std::size_t k = 1; k <= count; ++k) fields.emplace_back(words[k]);
    std::string_view name = words[0];
    if (name.ends_with('*')) name.remove_suffix(1);
    return capitals(trimmed(name));
  }
  static bool is_mark(std::string_view word) { return word.empty() || word[0] == '+' || word[0] == '*'; }

  FeText& text_;
};

template <class = void>  // compiled only if used
void require_blank_or_zero(FeText const& text, std::string const& field, std::string const& label, char const* what) {
  if (!field.empty() && field != "0")
    text.fail("GRID " + label + " has " + what + " " + field +
              "; export the nodes in the basic coordinate system and without constraints");
}

/// Position of a GRID entry. Blank coordinates are zero.
template <class = void>
Vec3 grid_position(FeText const& text, NastranCard const& card) {
  require_blank_or_zero(text, card.at(1), card.at(0), "the coordinate system");
  require_blank_or_zero(text, card.at(5), card.at(0), "displacements in the coordinate system");
  require_blank_or_zero(text, card.at(6), card.at(0), "the constraints");
  Vec3 r = Vec3::Zero();
  for (std::size_t k = 0; k < 3; ++k)
    if (!card.at(2 + k).empty()) r[Index(k)] = text.real(card.at(2 + k), "a coordinate of a node");
  return r;
}

/// Form of a DMIG matrix in its header: true for a symmetric matrix.
template <class = void>
bool dmig_symmetric(FeText const& text, NastranCard const& card) {
  std::string const &form = card.at(2), &type = card.at(3);
  if (form != "1" && form != "6")
    text.fail("the form of the matrix is " + FeText::quoted(form) + ", but must be 1 (square) or 6 (symmetric)");
  if (type != "1" && type != "2")
    text.fail("the type of the entries is " + FeText::quoted(type) + ", but must be 1 or 2 (real)");
  return form == "6";
}

}  // namespace detail

/// Nodes of the GRID entries of a bulk data file of Nastran, in the basic coordinate system.
/// \throws IoError, with the line, for other coordinate systems, fixed displacements and fields without a number.
template <class = void>
FeNodes read_nastran_nodes(std::string const& file) {
  detail::FeText text(file);
  detail::NastranBulk bulk(text);
  detail::FeNodeList nodes;
  for (detail::NastranCard card; bulk.next(card);) {
    if (card.name == "GRDSET" || card.name.starts_with("INCLUDE"))
      text.fail(card.name + " is not read; write every node by a GRID entry in this file");
    if (card.name != "GRID") continue;
    Vec3 const r = detail::grid_position(text, card);
    nodes.add(text, text.integer(card.at(0), "the label of a node"), r);
  }
  return nodes.sorted(text, "GRID entries");
}

/// Matrix `name` of the DMIG entries of a bulk data or punch file of Nastran, square or symmetric, with real entries.
/// A symmetric matrix contains one entry of each pair.
/// \throws IoError, with the line, for other content of these entries, and for a file without this matrix.
template <class = void>
FeMatrix read_dmig_matrix(std::string const& file, std::string const& name, FeNodes const& nodes) {
  detail::FeText text(file);
  detail::NastranBulk bulk(text);
  detail::FeEntries entries(nodes);
  bool found = false, symmetric = false;
  std::string others;
  for (detail::NastranCard card; bulk.next(card);) {
    if (card.name != "DMIG") continue;
    bool const header = card.at(1) == "0", wanted = detail::capitals(card.at(0)) == detail::capitals(name);
    if (header && !wanted) others += (others.empty() ? "" : ", ") + card.at(0);
    if (!wanted) continue;
    if (header) {
      if (std::exchange(found, true)) text.fail("the matrix " + name + " has a second header");
      symmetric = detail::dmig_symmetric(text, card);
      continue;
    }
    Index const label = text.integer(card.at(1), "the label of a node"),
                column = entries.row(text, label, text.integer(card.at(2), "a component, 1 to 6"));
    for (std::size_t k = 4; k < card.fields.size(); k += 4) {
      if (card.at(k).empty() && card.at(k + 1).empty() && card.at(k + 2).empty()) continue;
      Index const node = text.integer(card.at(k), "the label of a node"),
                  row = entries.row(text, node, text.integer(card.at(k + 1), "a component, 1 to 6"));
      entries.add(text, row, column, text.real(card.at(k + 2), "an entry"));
    }
  }
  if (!found)
    text.fail("the file has no header of a DMIG matrix " + name +
              (others.empty() ? "" : "; it has the matrices " + others));
  return entries.assembled(text, symmetric);
}

}  // namespace polybody
