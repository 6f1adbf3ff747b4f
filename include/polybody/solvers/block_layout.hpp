#pragma once
/// \file
/// Symbolic phase of a block factorisation. It computes the nodes in elimination order, the position of each block of
/// the matrix and of the fill, and the blocks that each elimination changes. The numeric phase uses only these flat
/// lists.

#include <algorithm>
#include <iterator>
#include <span>
#include <utility>

#include <polybody/math/sequence.hpp>
#include <polybody/solvers/block_kernels.hpp>
#include <polybody/solvers/block_pattern.hpp>

namespace polybody::detail {

// Elimination order of a block factorisation of [A, Gᵀ; G, 0]. Bodies are eliminated by minimum degree, and the
// equations of a joint after its child body [Baraff 1996]. The equations of a closing joint follow after all bodies
// and joints of its loop. If A ≻ 0, every pivot is then definite, and no pivoting between blocks is needed.

/// Computes the elimination order of nodes. A node is one segment, or several merged segments, eliminated together.
class EliminationOrder {
 public:
  struct Node {
    Sequence<int> segments;
    Sequence<int> neighbours;  ///< positions of the neighbours in the order, ascending; all after the node
  };
  Sequence<Node> nodes;  ///< in elimination order

  /// Computes `nodes`. `node_of` is the number of the node of each segment, counted from zero without gaps. Joints
  /// marked in `late` are eliminated after all other nodes.
  [[gnu::cold]] void compute(BlockPattern const& pattern, std::span<Block const> blocks, Sequence<int> const& node_of,
                             Sequence<char> const& late) {
    std::size_t const count = node_of.empty() ? 0 : std::size_t(*std::max_element(node_of.begin(), node_of.end())) + 1;
    left_.clear();
    left_.resize(count);
    remaining_early_ = 0;
    ready_.clear();
    find_neighbours(pattern, blocks, node_of);
    find_waits(pattern, node_of, late);
    for (std::size_t n = 0; n < count; ++n) {
      measure(left_[n]);
      if (may_go(left_[n])) offer(int(n));
    }
    nodes.clear();
    nodes.reserve(count);
    while (nodes.size() < count) eliminate(next());
    for (Node& node : nodes) {
      for (int& k : node.neighbours) k = at(k).place;
      sort_once(node.neighbours);
    }
  }

 private:
  struct Candidate {
    Node node;                  ///< `neighbours` are node numbers here
    Sequence<int> releases;     ///< nodes that wait for this one
    long size = 0, degree = 0;  ///< numbers of unknowns of the node, and of its neighbours
    int waits = 0;              ///< number of nodes that must be eliminated before this one
    int place = -1;             ///< position in the order, once eliminated
    bool late = false;
    bool ready = false;  ///< true if it waits for no node and is not eliminated
  };

  Candidate& at(int n) { return left_[std::size_t(n)]; }

  [[gnu::cold]] void find_neighbours(BlockPattern const& pattern, std::span<Block const> blocks,
                                     Sequence<int> const& node_of) {
    for (std::size_t s = 0; s < node_of.size(); ++s) {
      at(node_of[s]).node.segments.push_back(int(s));
      at(node_of[s]).size += pattern.segments()[s].size;
    }
    for (Block const& b : blocks) {
      BlockPattern::Range const rows = pattern.covered(b.row, b.rows), columns = pattern.covered(b.col, b.cols);
      for (int r = rows.begin; r < rows.end; ++r)
        for (int c = columns.begin; c < columns.end; ++c) {
          int const i = node_of[std::size_t(r)], j = node_of[std::size_t(c)];
          if (i == j) continue;
          at(i).node.neighbours.push_back(j);
          at(j).node.neighbours.push_back(i);
        }
    }
    for (Candidate& k : left_) sort_once(k.node.neighbours);
  }
  [[gnu::cold]] void find_waits(BlockPattern const& pattern, Sequence<int> const& node_of, Sequence<char> const& late) {
    for (std::size_t n = 0; n < left_.size(); ++n) {
      Sequence<int> after;
      for (int const s : left_[n].node.segments) {
        if (late[std::size_t(s)]) left_[n].late = true;
        for (int const before : pattern.segments()[std::size_t(s)].after)
          if (node_of[std::size_t(before)] != int(n)) after.push_back(node_of[std::size_t(before)]);
      }
      sort_once(after);
      left_[n].waits = int(after.size());
      for (int const before : after) at(before).releases.push_back(int(n));
      if (!left_[n].late) ++remaining_early_;
    }
  }

  void measure(Candidate& n) {
    n.degree = 0;
    for (int const k : n.node.neighbours) n.degree += at(k).size;
  }
  void offer(int n) {
    at(n).ready = true;
    ready_.push_back({-at(n).degree, -n});
    std::push_heap(ready_.begin(), ready_.end());
  }
  bool may_go(Candidate const& n) const { return n.waits <= 0 && (!n.late || remaining_early_ == 0); }

  /// Returns the ready node of least degree. If joints of different loops wait for each other, no node is ready. The
  /// function then returns the first of the nodes that wait for the fewest others.
  int next() {
    while (!ready_.empty()) {
      std::pop_heap(ready_.begin(), ready_.end());
      auto const [degree, node] = ready_.back();
      ready_.pop_back();
      Candidate& least = at(-node);
      if (!least.ready || least.degree != -degree) continue;  // it is eliminated, or its degree has changed
      least.ready = false;
      return -node;
    }
    int best = -1;
    for (int n = 0; n < int(left_.size()); ++n)
      if (at(n).place < 0 && (best < 0 || at(n).waits < at(best).waits)) best = n;
    return best;
  }

  /// Assigns node n the next position. The neighbours of n become neighbours of each other, and nodes that waited only
  /// for n become ready.
  [[gnu::cold]] void eliminate(int n) {
    Candidate& eliminated = at(n);
    eliminated.place = int(nodes.size());
    for (int const k : eliminated.node.neighbours) {
      Sequence<int>& of_k = at(k).node.neighbours;
      merged_.clear();
      std::set_union(of_k.begin(), of_k.end(), eliminated.node.neighbours.begin(), eliminated.node.neighbours.end(),
                     std::back_inserter(merged_));
      erase_if(merged_, [&](int m) { return m == k || m == n; });
      of_k.swap(merged_);
      measure(at(k));
      if (at(k).ready) offer(k);
    }
    for (int const k : eliminated.releases)
      if (--at(k).waits <= 0 && at(k).place < 0 && may_go(at(k))) offer(k);
    if (!eliminated.late && --remaining_early_ == 0)
      for (int k = 0; k < int(left_.size()); ++k)
        if (at(k).place < 0 && may_go(at(k))) offer(k);
    nodes.push_back(std::move(eliminated.node));
  }

  Sequence<Candidate> left_;
  std::size_t remaining_early_ = 0;       ///< number of remaining nodes that are not late
  Sequence<std::pair<long, int>> ready_;  ///< heap of (−degree, −node); degrees may be outdated
  Sequence<int> merged_;
};

class BlockLayout {
 public:
  /// Later node that has a block in the rows of an earlier node.
  struct Neighbour {
    int node, column, size;  ///< position in the order, first column in W of the earlier node, number of unknowns
  };
  /// Node of the elimination: a set of unknowns that are eliminated together. Its rows are stored as [D | W], where D
  /// is its diagonal block and W its blocks with later nodes. Its blocks below D are stored transposed, as Lt.
  struct Node {
    int size, pad, width;    ///< numbers of unknowns, of unknowns with padding, and of columns of W
    std::size_t u, l, f, x;  ///< offsets of [D | W], of Lt if present, of the factor L, and in padded vectors
    int first_neighbour, neighbours;
    int first_target;  ///< first index in `targets`: for each pair of neighbours k before l, the column of l in W of k
    bool pivoted, joint, droppable;
    int stride() const { return pad + width; }
  };
  /// Part of an added block between two segments, with its destination.
  struct Piece {
    std::size_t to;
    int row, col, rows, cols;  ///< first row and column, and size, within the added block
    int stride;                ///< distance between rows of the destination
    bool lower;                ///< true if the destination is Lt, which stores the part transposed
  };
  /// Changes of the elimination order after missing pivots. `merged`: bodies in one node with their joint. `late`:
  /// joints that are eliminated last. `apart`: further joints of merged bodies in separate nodes, because they may be
  /// redundant. `dense`: all unknowns in one node.
  struct NodeHints {
    Sequence<char> merged, late;
    bool apart = false;
    bool dense = false;
  };

  Sequence<Node> nodes;
  Sequence<Neighbour> neighbours;
  Sequence<int> targets;
  Sequence<Piece> pieces;
  Sequence<int> first_piece;  ///< first piece of each added block, and one past the last piece
  Sequence<Index> unknown;    ///< unknown at each position of a padded vector; −1 for padding
  Sequence<int> place;        ///< position of each unknown in a padded vector
  std::size_t size_u = 0, size_l = 0, size_f = 0;
  int largest_w = 0;  ///< number of entries of the largest W, or of unknowns of the largest node

  /// Computes the layout. Without `both_halves`, only nodes with pivoting have an Lt.
  [[gnu::cold]] void compile(BlockPattern const& pattern, std::span<Block const> blocks, NodeHints const& hints,
                             bool both_halves) {
    EliminationOrder order;
    order.compute(pattern, blocks, number_nodes(pattern, blocks, hints), hints.late);
    place_nodes(pattern, order, hints, both_halves);
    find_targets();
    place_pieces(pattern, blocks);
  }

 private:
  static constexpr std::size_t fewest_alike = 8;  ///< up to this many joints between the same bodies are separate nodes

  static Sequence<int> number_nodes(BlockPattern const& pattern, std::span<Block const> blocks,
                                    NodeHints const& hints) {
    auto const& segments = pattern.segments();
    Sequence<int> node_of(segments.size(), hints.dense ? 0 : -1);
    if (hints.dense) return node_of;
    int count = 0;
    for (std::size_t s = 0; s < segments.size(); ++s) {
      if (!hints.merged[s] || node_of[s] >= 0) continue;
      auto const take = [&](int t) { node_of[std::size_t(t)] = count; };
      int const body = segments[s].body, primary = pattern.primary(body);
      take(int(s));
      if (primary < 0) {
        for (int const t : pattern.segments_of(body)) take(t);
      } else {
        for (int const t : segments[std::size_t(primary)].child) take(t);
        take(primary);
      }
      for (int const t : pattern.secondary(body))
        if (!hints.apart || segments[std::size_t(t)].size == 1) take(t);
      ++count;
    }
    join_alike(pattern, blocks, node_of, count);
    for (int& n : node_of)
      if (n < 0) n = count++;
    return node_of;
  }

  /// Merges the segments of a body into one node if they have the same neighbours, up to `largest_segment` unknowns.
  /// Separate nodes would have the same fill, and each would repeat the loop over these neighbours.
  [[gnu::cold]] static void join_alike(BlockPattern const& pattern, std::span<Block const> blocks,
                                       Sequence<int>& node_of, int& count) {
    auto const& segments = pattern.segments();
    Sequence<Sequence<int>> touched(segments.size());
    for (Block const& b : blocks) {
      BlockPattern::Range const rows = pattern.covered(b.row, b.rows), columns = pattern.covered(b.col, b.cols);
      for (int r = rows.begin; r < rows.end; ++r)
        for (int c = columns.begin; c < columns.end; ++c) {
          touched[std::size_t(r)].push_back(c);
          touched[std::size_t(c)].push_back(r);
        }
    }
    for (Sequence<int>& of : touched) sort_once(of);
    join_alike_joints(pattern, touched, node_of, count);
    for (std::size_t s = 0; s < segments.size(); ++s) {
      if (node_of[s] >= 0 || segments[s].joint) continue;
      Index size = segments[s].size;
      for (int const t : pattern.segments_of(segments[s].body)) {
        if (t <= int(s) || node_of[std::size_t(t)] >= 0 || touched[std::size_t(t)] != touched[s]) continue;
        size += segments[std::size_t(t)].size;
        if (size > BlockPattern::largest_segment) break;
        node_of[s] = node_of[std::size_t(t)] = count;
      }
      if (node_of[s] >= 0) ++count;
    }
  }

  /// Merges the closing joints between the same bodies into one node if there are more than `fewest_alike`; most of
  /// their equations are redundant. In separate nodes, each joint would update the blocks of every pair of later
  /// joints.
  [[gnu::cold]] static void join_alike_joints(BlockPattern const& pattern, Sequence<Sequence<int>> const& touched,
                                              Sequence<int>& node_of, int& count) {
    auto const& segments = pattern.segments();
    Sequence<int> joints;
    for (std::size_t s = 0; s < segments.size(); ++s)
      if (node_of[s] < 0 && segments[s].joint && segments[s].closes_loop) joints.push_back(int(s));
    auto const before = [&](int a, int b) {
      Sequence<int> const &x = touched[std::size_t(a)], &y = touched[std::size_t(b)];
      if (x == y) return a < b;
      return std::lexicographical_compare(x.begin(), x.end(), y.begin(), y.end());
    };
    std::sort(joints.begin(), joints.end(), before);
    for (std::size_t first = 0, end = 0; first < joints.size(); first = end) {
      while (end < joints.size() && touched[std::size_t(joints[end])] == touched[std::size_t(joints[first])]) ++end;
      if (end - first <= fewest_alike) continue;
      for (std::size_t k = first; k < end; ++k) node_of[std::size_t(joints[k])] = count;
      ++count;
    }
  }

  [[gnu::cold]] void place_nodes(BlockPattern const& pattern, EliminationOrder const& order, NodeHints const& hints,
                                 bool both_halves) {
    auto const& segments = pattern.segments();
    local_.assign(segments.size(), 0);
    place_.assign(segments.size(), 0);
    nodes.clear();
    neighbours.clear();
    unknown.clear();
    size_u = size_l = size_f = 0;
    largest_w = 0;
    Sequence<int> size(order.nodes.size(), 0);
    for (std::size_t k = 0; k < order.nodes.size(); ++k)
      for (int const s : order.nodes[k].segments) {
        local_[std::size_t(s)] = size[k];
        place_[std::size_t(s)] = int(k);
        size[k] += segments[std::size_t(s)].size;
      }
    for (std::size_t k = 0; k < order.nodes.size(); ++k) {
      auto const& from = order.nodes[k];
      Node n{};
      n.size = size[k];
      n.pad = padded(n.size);
      n.joint = n.droppable = true;
      n.pivoted = hints.dense;
      for (int const s : from.segments) {
        auto const& segment = segments[std::size_t(s)];
        n.joint = n.joint && segment.joint;
        n.droppable = n.droppable && segment.joint && (segment.closes_loop || hints.late[std::size_t(s)]);
        n.pivoted = n.pivoted || (hints.merged[std::size_t(s)] && from.segments.size() > 1);
        for (int i = 0; i < segment.size; ++i) unknown.push_back(segment.first + i);
      }
      n.u = size_u;
      n.l = size_l;
      n.f = size_f;
      n.x = unknown.size() - std::size_t(n.size);
      unknown.resize(n.x + std::size_t(n.pad), -1);
      n.first_neighbour = int(neighbours.size());
      n.neighbours = int(from.neighbours.size());
      for (int const later : from.neighbours) {
        neighbours.push_back({later, n.width, size[std::size_t(later)]});
        n.width += padded(size[std::size_t(later)]);
      }
      size_u += std::size_t(n.size) * std::size_t(n.stride());
      if (both_halves || n.pivoted) size_l += std::size_t(n.size) * std::size_t(n.width);
      largest_w = std::max(largest_w, n.size * std::max(n.width, 1));
      size_f += std::size_t(padded(n.size * n.size));
      nodes.push_back(n);
    }
    place.assign(unknown.size(), 0);
    for (std::size_t i = 0; i < unknown.size(); ++i)
      if (unknown[i] >= 0) place[std::size_t(unknown[i])] = int(i);
  }

  void find_targets() {
    targets.clear();
    std::size_t pairs = 0;
    for (Node const& n : nodes) pairs += std::size_t(n.neighbours) * std::size_t(std::max(n.neighbours - 1, 0)) / 2;
    targets.reserve(pairs);
    for (Node& n : nodes) {
      n.first_target = int(targets.size());
      for (int a = 0; a < n.neighbours; ++a) {
        Node const& k = nodes[std::size_t(neighbours[std::size_t(n.first_neighbour + a)].node)];
        std::size_t at = std::size_t(k.first_neighbour);
        for (int b = a + 1; b < n.neighbours; ++b) {
          while (neighbours[at].node != neighbours[std::size_t(n.first_neighbour + b)].node) ++at;
          targets.push_back(neighbours[at].column);
        }
      }
    }
  }

  [[gnu::cold]] void place_pieces(BlockPattern const& pattern, std::span<Block const> blocks) {
    auto const column = [&](Node const& n, int k) {
      std::size_t i = std::size_t(n.first_neighbour);
      while (neighbours[i].node != k) ++i;
      return neighbours[i].column;
    };
    pieces.clear();
    first_piece.assign(1, 0);
    for (Block const& b : blocks) {
      BlockPattern::Range const rows = pattern.covered(b.row, b.rows), columns = pattern.covered(b.col, b.cols);
      for (int r = rows.begin; r < rows.end; ++r)
        for (int c = columns.begin; c < columns.end; ++c) {
          auto const &sr = pattern.segments()[std::size_t(r)], &sc = pattern.segments()[std::size_t(c)];
          int const pr = place_[std::size_t(r)], pc = place_[std::size_t(c)];
          int const lr = local_[std::size_t(r)], lc = local_[std::size_t(c)];
          Node const& n = nodes[std::size_t(std::min(pr, pc))];
          Piece p{
              0,      int(sr.first - b.row), int(sc.first - b.col), sr.size, sc.size, pr > pc ? n.width : n.stride(),
              pr > pc};
          if (p.lower) {
            p.to = n.l + std::size_t(lc * n.width + column(n, pr) + lr);
          } else {
            p.to = n.u + std::size_t(lr * n.stride() + (pr == pc ? 0 : n.pad + column(n, pc)) + lc);
          }
          pieces.push_back(p);
        }
      first_piece.push_back(int(pieces.size()));
    }
  }

  Sequence<int> local_, place_;  // for each segment: position of its first unknown in its node, and the node
};

}  // namespace polybody::detail
