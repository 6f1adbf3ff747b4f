#pragma once
/// \file
/// Elimination order of a block factorisation of [A, Gᵀ; G, 0]. Bodies are eliminated by minimum degree, and the
/// equations of a joint after its child body [Baraff 1996]. The equations of a closing joint follow after all bodies
/// and joints of its loop. If A ≻ 0, every pivot is then definite, and no pivoting between blocks is needed.

#include <iterator>
#include <span>
#include <utility>

#include <polybody/math/sequence.hpp>
#include <polybody/solvers/block_pattern.hpp>

namespace polybody::detail {

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
    bool ready = false;  ///< waits for no node and is not eliminated
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

  /// Returns the ready node of least degree. If no node is ready, because joints of different loops wait for each
  /// other, returns the first of the nodes that wait for the fewest others.
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

}  // namespace polybody::detail
