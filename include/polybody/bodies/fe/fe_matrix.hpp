#pragma once
/// \file
/// Nodes and matrices of a finite element model, with the labels of the finite element program.

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include <polybody/bodies/fe/fe_text.hpp>
#include <polybody/bodies/ffr/structure.hpp>

namespace polybody {

/// Nodes of a finite element model in ascending order of their labels.
struct FeNodes {
  std::string file;             ///< file that contains the nodes
  std::vector<Index> labels;    ///< numbers of the nodes in the finite element program, ascending
  std::vector<Vec3> positions;  ///< undeformed positions, in the unit of length of the file

  Index size() const { return Index(labels.size()); }  ///< number of nodes
  /// Index of the node with this label, or −1.
  Index find(Index label) const {
    auto const place = std::lower_bound(labels.begin(), labels.end(), label);
    return place != labels.end() && *place == label ? Index(place - labels.begin()) : -1;
  }
  /// Index of the node with this label.
  /// \throws InvalidInput if there is no such node.
  Index index(Index label) const {
    Index const i = find(label);
    if (i < 0)
      throw InvalidInput("fe.node", {ErrorObject{file}, ": there is no node ", ErrorValue{label}, " among the ", size(),
                                     " nodes of the file."});
    return i;
  }
  /// Removes the node `label`, which belongs to no element, such as a reference point.
  /// \throws InvalidInput if there is no such node.
  void remove(Index label) {
    Index const i = index(label);
    labels.erase(labels.begin() + i);
    positions.erase(positions.begin() + i);
  }
};

/// Matrix of a finite element model. Its rows and columns are the displacements x, y, z of each node, in the order of
/// `FeNodes`.
struct FeMatrix {
  std::string file;                  ///< file that contains the matrix
  Structure::Sparse entries;         ///< (3n×3n) entries of both triangles, in the units of the file
  std::vector<std::string> remarks;  ///< sentences about the interpretation of the file
};

namespace detail {

/// Nodes of a file in any order, sorted at the end.
class FeNodeList {
 public:
  void add(FeText const& text, Index label, Vec3 const& position) {
    if (label < 1) text.fail(sentence_of({"the label of a node is positive, but here it is ", label}));
    nodes_.push_back({label, text.line(), position});
  }
  /// Sorted nodes.
  /// \throws IoError for a file without nodes (`none` names the missing lines), and for a label that occurs twice.
  FeNodes sorted(FeText const& text, char const* none) {
    if (nodes_.empty()) text.fail(std::string("the file has no nodes: it has no ") + none);
    if (nodes_.size() > std::size_t(std::numeric_limits<int>::max() / 3))
      text.fail("the file has more nodes than a sparse matrix can index");
    std::stable_sort(nodes_.begin(), nodes_.end(), [](Node const& a, Node const& b) { return a.label < b.label; });
    FeNodes all;
    all.file = text.file();
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (i > 0 && nodes_[i].label == nodes_[i - 1].label)
        text.fail_at(nodes_[i].line,
                     sentence_of({"node ", nodes_[i].label, " occurs a second time, after line ", nodes_[i - 1].line}));
      all.labels.push_back(nodes_[i].label);
      all.positions.push_back(nodes_[i].position);
    }
    return all;
  }

 private:
  struct Node {
    Index label, line;
    Vec3 position;
  };
  std::vector<Node> nodes_;
};

/// Name of row i in messages, such as "y of node 17".
template <class = void>  // compiled only if used
std::string row_name(FeNodes const& nodes, Index i) {
  return sentence_of({"xyz"[i % 3], " of node ", nodes.labels[std::size_t(i / 3)]});
}

/// Entries of a matrix in the order of the file, assembled at the end.
class FeEntries {
 public:
  /// \param nodes nodes of the rows; must outlive this object
  explicit FeEntries(FeNodes const& nodes) : nodes_(nodes) {}

  /// Row of the component (1 to 3: displacements) of a node, or −1 for a rotation (4 to 6).
  Index row(FeText const& text, Index label, Index component) const {
    Index const node = nodes_.find(label);
    if (node < 0)
      text.fail(sentence_of({"node ", label, " is not among the ", nodes_.size(), " nodes of ", nodes_.file}));
    if (component < 1 || component > 6)
      text.fail(sentence_of({"component ", component, " of node ", label,
                             " is no displacement; components 1, 2, 3 are displacements along x, y, z"}));
    return component > 3 ? -1 : 3 * node + component - 1;
  }
  /// Adds the entry of rows i and j. An entry of a rotation, with i or j = −1, must be zero.
  void add(FeText const& text, Index i, Index j, double value) {
    if (i >= 0 && j >= 0)
      entries_.push_back({i, j, text.line(), value});
    else if (value != 0.0)
      text.fail("the entry belongs to a rotation; use solid elements, whose nodes have three displacements only");
  }
  /// Refuses a row or column outside the matrix with n rows.
  static void require_inside(FeText const& text, Index i, Index n) {
    if (i < 1 || i > n) text.fail(sentence_of({"row or column ", i, " is outside the matrix, which has ", n, " rows"}));
  }
  /// Matrix of the entries. A matrix that is `symmetric` by its format may contain one entry of each pair.
  /// \throws IoError for entries that occur twice or contradict each other, and for rows without a diagonal entry.
  FeMatrix assembled(FeText const& text, bool symmetric);

 private:
  struct Entry {
    Index i, j, line;
    double value;
    friend bool operator<(Entry const& a, Entry const& b) { return a.j != b.j ? a.j < b.j : a.i < b.i; }
  };

  std::string name(Entry const& e) const {
    return sentence_of({"the entry of ", row_name(nodes_, e.i), " and ", row_name(nodes_, e.j)});
  }
  Entry const* mirror(Entry const& e) const {
    auto const place = std::lower_bound(entries_.begin(), entries_.end(), Entry{e.j, e.i, 0, 0.0});
    return place != entries_.end() && place->i == e.j && place->j == e.i ? &*place : nullptr;
  }
  void require_pair(FeText const& text, Entry const& e, Entry const& other, double largest) const {
    if (!(std::abs(e.value - other.value) <= 1e-9 * largest))
      text.fail_at(std::max(e.line, other.line), sentence_of({name(e), " is ", e.value, ", but its mirror image is ",
                                                              other.value, "; the format is symmetric"}));
  }
  void require_diagonal(FeText const& text, Structure::Sparse const& m) const {
    for (Index i = 0; i < m.rows(); ++i)
      if (m.coeff(i, i) == 0.0)
        text.fail(sentence_of(
            {"the matrix has no diagonal entry of ", row_name(nodes_, i),
             ". Export the matrix without fixed displacements, and remove nodes that belong to no element"}));
  }

  FeNodes const& nodes_;
  std::vector<Entry> entries_;
};

inline FeMatrix FeEntries::assembled(FeText const& text, bool symmetric) {
  std::stable_sort(entries_.begin(), entries_.end());
  double largest = 0.0;
  Index below = 0, above = 0;
  for (std::size_t k = 0; k < entries_.size(); ++k) {
    Entry const& e = entries_[k];
    if (k > 0 && entries_[k - 1].i == e.i && entries_[k - 1].j == e.j)
      text.fail_at(e.line, name(e) + sentence_of({" occurs a second time, after line ", entries_[k - 1].line}));
    if (std::abs(e.value) > largest_number)
      text.fail_at(e.line, name(e) + sentence_of({" is ", e.value, ", beyond ", largest_number}));
    largest = std::max(largest, std::abs(e.value));
    if (e.value != 0.0) (e.i > e.j ? below : above) += e.i != e.j;
  }
  bool const one_triangle = (below == 0) != (above == 0);
  std::vector<Eigen::Triplet<double>> all;
  for (Entry const& e : entries_) {
    if (e.value != 0.0) all.emplace_back(int(e.i), int(e.j), e.value);
    if (e.i == e.j || !(symmetric || one_triangle)) continue;
    Entry const* const other = mirror(e);
    bool const missing = !other || (!symmetric && other->value == 0.0);
    if (missing && e.value != 0.0) all.emplace_back(int(e.j), int(e.i), e.value);
    if (other && symmetric) require_pair(text, e, *other, largest);
  }
  FeMatrix m;
  m.file = text.file();
  m.entries.resize(3 * nodes_.size(), 3 * nodes_.size());
  m.entries.setFromTriplets(all.begin(), all.end());
  require_diagonal(text, m.entries);
  if (one_triangle && !symmetric)
    m.remarks.push_back(m.file + ": the " + (above == 0 ? "upper" : "lower") +
                        " triangle of the matrix is zero; the matrix is read as a symmetric one, which is stored by "
                        "its other triangle.");
  return m;
}

}  // namespace detail
}  // namespace polybody
