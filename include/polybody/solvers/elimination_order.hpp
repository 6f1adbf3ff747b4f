#pragma once
/// \file
/// The order in which a block factorisation eliminates [A, Gᵀ; G, 0]: bodies by minimum degree, a joint's rows only
/// after the body that hangs on it [Baraff 1996], the rows that close a loop only after all bodies and joints of the
/// loop. Then A ≻ 0 makes every pivot definite and no pivoting between blocks is needed.

#include <iterator>
#include <set>

#include <polybody/solvers/block_pattern.hpp>

namespace polybody::detail {

/// A node is what is eliminated at once: one segment, or several that were merged.
struct EliminationOrder {
  struct Node {
    std::vector<int> segments;
    std::vector<int> neighbours;  ///< by place in the order, ascending; all later than the node itself
  };
  std::vector<Node> nodes;  ///< in the order of elimination

  /// `node_of` gives each segment's node, numbered from zero without gaps. A joint in `late` waits for all that is not.
  void compute(BlockPattern const& pattern, std::vector<Block> const& blocks, std::vector<int> const& node_of,
               std::vector<char> const& late) {
    auto const& segments = pattern.segments();
    std::size_t const count = segments.empty() ? 0 : std::size_t(*std::max_element(node_of.begin(), node_of.end())) + 1;
    std::vector<Node> all(count);
    std::vector<long> size(count, 0);
    for (std::size_t s = 0; s < segments.size(); ++s) {
      all[std::size_t(node_of[s])].segments.push_back(int(s));
      size[std::size_t(node_of[s])] += segments[s].size;
    }
    // the graph
    std::vector<std::vector<int>> adjacent(count);
    for (Block const& b : blocks) {
      if (b.rows == 0 || b.cols == 0) continue;
      pattern.for_each_segment(b.row, b.rows, [&](int r) {
        pattern.for_each_segment(b.col, b.cols, [&](int c) {
          int const i = node_of[std::size_t(r)], j = node_of[std::size_t(c)];
          if (i == j) return;
          adjacent[std::size_t(i)].push_back(j);
          adjacent[std::size_t(j)].push_back(i);
        });
      });
    }
    auto const tidy = [](std::vector<int>& v) {
      std::sort(v.begin(), v.end());
      v.erase(std::unique(v.begin(), v.end()), v.end());
    };
    for (auto& v : adjacent) tidy(v);
    // what waits for what
    std::vector<std::vector<int>> releases(count);
    std::vector<int> waits(count, 0);
    std::size_t remaining_early = 0;
    std::vector<char> is_late(count, 0);
    for (std::size_t n = 0; n < count; ++n) {
      std::vector<int> after;
      for (int const s : all[n].segments) {
        if (late[std::size_t(s)]) is_late[n] = 1;
        for (int const before : segments[std::size_t(s)].after)
          if (node_of[std::size_t(before)] != int(n)) after.push_back(node_of[std::size_t(before)]);
      }
      tidy(after);
      waits[n] = int(after.size());
      for (int const before : after) releases[std::size_t(before)].push_back(int(n));
      if (!is_late[n]) ++remaining_early;
    }
    // minimum degree among those that wait for nothing
    std::vector<long> degree(count, 0);
    std::set<std::pair<long, int>> ready;
    std::vector<char> done(count, 0);
    auto const measure = [&](std::size_t n) {
      degree[n] = 0;
      for (int const k : adjacent[n]) degree[n] += size[std::size_t(k)];
    };
    auto const may_go = [&](std::size_t n) { return waits[n] <= 0 && (!is_late[n] || remaining_early == 0); };
    for (std::size_t n = 0; n < count; ++n) {
      measure(n);
      if (may_go(n)) ready.insert({degree[n], int(n)});
    }
    std::vector<int> place(count, -1), merged;
    nodes.clear();
    nodes.reserve(count);
    while (nodes.size() < count) {
      if (ready.empty()) {  // joints that wait for each other, across loops: the next one in order
        std::size_t next = 0;
        while (done[next]) ++next;
        for (std::size_t n = next; n < count; ++n)
          if (!done[n] && waits[n] < waits[next]) next = n;
        ready.insert({degree[next], int(next)});
      }
      std::size_t const n = std::size_t(ready.begin()->second);
      ready.erase(ready.begin());
      done[n] = 1;
      place[n] = int(nodes.size());
      for (int const k : adjacent[n]) {
        auto& of_k = adjacent[std::size_t(k)];
        bool const queued = ready.erase({degree[std::size_t(k)], k}) > 0;
        merged.clear();
        std::set_union(of_k.begin(), of_k.end(), adjacent[n].begin(), adjacent[n].end(), std::back_inserter(merged));
        std::erase_if(merged, [&](int m) { return m == k || m == int(n); });
        of_k.swap(merged);
        measure(std::size_t(k));
        if (queued) ready.insert({degree[std::size_t(k)], k});
      }
      for (int const k : releases[n])
        if (--waits[std::size_t(k)] <= 0 && !done[std::size_t(k)] && may_go(std::size_t(k)))
          ready.insert({degree[std::size_t(k)], k});
      if (!is_late[n] && --remaining_early == 0)
        for (std::size_t k = 0; k < count; ++k)
          if (!done[k] && may_go(k)) ready.insert({degree[k], int(k)});
      nodes.push_back({std::move(all[n].segments), std::move(adjacent[n])});
    }
    for (Node& node : nodes) {
      for (int& k : node.neighbours) k = place[std::size_t(k)];
      std::sort(node.neighbours.begin(), node.neighbours.end());
    }
  }
};

}  // namespace polybody::detail
