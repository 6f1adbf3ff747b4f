#pragma once
/// \file
/// Bodies and joints in the block pattern of [A, Gᵀ; G, 0], and the joint between each body and its parent.
/// Theory: Eq. 7.8.

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

#include <polybody/math/sequence.hpp>
#include <polybody/solvers/linear_solver.hpp>

namespace polybody::detail {

/// Finds bodies and joints in the block pattern of a matrix. A segment is a range of unknowns without a block boundary
/// inside. A segment belongs to a joint if the matrix has no block on the diagonal of the segment.
class BlockPattern {
 public:
  static constexpr Index largest_segment = 6;

  struct Segment {
    Index first = 0;
    int size = 0;
    bool joint = true;
    int body = -1;             ///< index of its body; −1 for joints
    Sequence<int> child;       ///< for a joint: segments of the child body in its equations
    Sequence<int> after;       ///< for a joint: segments that are eliminated before it
    bool closes_loop = false;  ///< the joint is eliminated after its whole loop and may be redundant
  };

  [[gnu::cold]] void analyse(Index size, std::span<Block const> blocks) {
    cut(size, blocks);
    for (Block const& b : blocks) mark(b);
    link(blocks);
    match();
  }

  Sequence<Segment> const& segments() const { return segments_; }
  int of(Index unknown) const { return segment_of_[std::size_t(unknown)]; }
  /// Segments from `begin` to `end` − 1.
  struct Range {
    int begin, end;
  };
  /// Segments of the `count` unknowns from `first` on, which are the rows or columns of a block.
  Range covered(Index first, Index count) const {
    return count > 0 ? Range{of(first), of(first + count - 1) + 1} : Range{0, 0};
  }
  /// Joint between a body and its parent; −1 for a free body.
  int primary(int body) const { return bodies_[std::size_t(body)].primary; }
  /// Other joints that constrain only this body, or this body and its parent.
  Sequence<int> const& secondary(int body) const { return bodies_[std::size_t(body)].secondary; }
  Sequence<int> const& segments_of(int body) const { return bodies_[std::size_t(body)].segments; }

 private:
  struct Body {
    Sequence<int> segments, joints, secondary;
    int primary = -1, parent = -1, depth = 0;  // parent −1: the ground, or none
    bool visited = false;
  };
  struct Joint {
    int segment;
    Sequence<std::pair<int, Sequence<int>>> ends;  // body, and its segments in the equations of the joint
    bool used = false;
    bool meets_rows = false;  ///< true if a block couples it with a constraint equation
  };

  [[gnu::cold]] void cut(Index size, std::span<Block const> blocks) {
    Sequence<char> begins(std::size_t(size) + 1, 0);
    begins[0] = 1;
    for (Block const& b : blocks)
      for (Index const at : {b.row, b.row + b.rows, b.col, b.col + b.cols}) begins[std::size_t(at)] = 1;
    divide(blocks, begins);
    segments_.clear();
    segment_of_.assign(std::size_t(size), 0);
    for (Index i = 0; i < size; ++i) {
      if (begins[std::size_t(i)]) segments_.emplace_back().first = i;
      ++segments_.back().size;
      segment_of_[std::size_t(i)] = int(segments_.size()) - 1;
    }
  }

  /// Divides each segment of a body with more than `largest_segment` unknowns into the least number of parts, which
  /// differ in size by at most one.
  [[gnu::cold]] static void divide(std::span<Block const> blocks, Sequence<char>& begins) {
    Index const size = Index(begins.size()) - 1;
    Sequence<char> diagonal(begins.size(), 0);
    for (Block const& b : blocks)
      for (Index i = std::max(b.row, b.col); i < std::min(b.row + b.rows, b.col + b.cols); ++i)
        diagonal[std::size_t(i)] = 1;
    for (Index first = 0, end = 0; first < size; first = end) {
      for (end = first + 1; end < size && !begins[std::size_t(end)];) ++end;
      Index const parts = diagonal[std::size_t(first)] ? (end - first + largest_segment - 1) / largest_segment : 1;
      for (Index k = 1; k < parts; ++k) begins[std::size_t(first + k * (end - first) / parts)] = 1;
    }
  }

  void mark(Block const& b) {
    Range const rows = covered(b.row, b.rows);
    for (int s = rows.begin; s < rows.end; ++s) {
      Segment& segment = segments_[std::size_t(s)];
      if (segment.first >= b.col && segment.first < b.col + b.cols) segment.joint = false;
    }
  }

  /// Collects bodies and joints. Segments within the same square diagonal block belong to one body.
  [[gnu::cold]] void link(std::span<Block const> blocks) {
    Sequence<int> root(segments_.size());
    std::iota(root.begin(), root.end(), 0);
    auto const find = [&](int s) {
      while (root[std::size_t(s)] != s) s = root[std::size_t(s)] = root[std::size_t(root[std::size_t(s)])];
      return s;
    };
    for (Block const& b : blocks) {
      if (b.row != b.col || b.rows != b.cols || b.rows == 0) continue;
      Range const tied = covered(b.row, b.rows);
      int const first = find(tied.begin);
      for (int s = tied.begin; s < tied.end; ++s) root[std::size_t(find(s))] = first;
    }
    bodies_.clear();
    joints_.clear();
    Sequence<int> number(segments_.size(), -1), joint_of(segments_.size(), -1);
    for (std::size_t s = 0; s < segments_.size(); ++s) {
      if (segments_[s].joint) {
        joint_of[s] = int(joints_.size());
        joints_.push_back({int(s), {}});
        continue;
      }
      int& n = number[std::size_t(find(int(s)))];
      if (n < 0) {
        n = int(bodies_.size());
        bodies_.emplace_back();
      }
      segments_[s].body = n;
      bodies_[std::size_t(n)].segments.push_back(int(s));
    }
    for (Block const& b : blocks) {
      Range const rows = covered(b.row, b.rows), columns = covered(b.col, b.cols);
      for (int row = rows.begin; row < rows.end; ++row)
        if (segments_[std::size_t(row)].joint) touch(joints_[std::size_t(joint_of[std::size_t(row)])], columns);
    }
    for (std::size_t j = 0; j < joints_.size(); ++j)
      for (auto const& end : joints_[j].ends) bodies_[std::size_t(end.first)].joints.push_back(int(j));
  }

  /// Adds the segments `columns` of a block in the equations of a joint to the bodies of the joint. All columns of a
  /// block belong to one marker.
  [[gnu::cold]] void touch(Joint& joint, Range columns) {
    for (int s = columns.begin; s < columns.end; ++s) {
      int const body = segments_[std::size_t(s)].body;
      if (body < 0) {
        joint.meets_rows = true;
        continue;
      }
      std::size_t end = 0;
      while (end < joint.ends.size() && joint.ends[end].first != body) ++end;
      if (end == joint.ends.size()) joint.ends.push_back({body, {}});
      Sequence<int>& touched = joint.ends[end].second;
      if (std::find(touched.begin(), touched.end(), s) == touched.end()) touched.push_back(s);
    }
  }

  /// True for a joint with one body and one equation: a norm constraint, or a driving constraint against the ground.
  /// Such a joint is not part of the tree.
  bool is_own(Joint const& j) const { return j.ends.size() == 1 && segments_[std::size_t(j.segment)].size == 1; }

  /// Assigns each body its parent and joint, breadth first from the ground, then from one body of each group without
  /// connection to the ground.
  [[gnu::cold]] void match() {
    Sequence<int> queue;
    auto const attach = [&](Joint& j, std::size_t end, int parent) {
      auto const& [body, touched] = j.ends[end];
      Body& b = bodies_[std::size_t(body)];
      Segment& s = segments_[std::size_t(j.segment)];
      b.visited = j.used = true;
      b.primary = j.segment;
      b.parent = parent;
      b.depth = parent < 0 ? 1 : bodies_[std::size_t(parent)].depth + 1;
      s.child = s.after = touched;
      queue.push_back(body);
    };
    for (Joint& j : joints_)
      if (j.ends.size() == 1 && !is_own(j) && !bodies_[std::size_t(j.ends[0].first)].visited) attach(j, 0, -1);
    std::size_t head = 0;
    auto const spread = [&] {
      for (; head < queue.size(); ++head) {
        int const u = queue[head];
        for (int const n : bodies_[std::size_t(u)].joints) {
          Joint& j = joints_[std::size_t(n)];
          if (j.used || j.ends.size() != 2) continue;
          std::size_t const other = j.ends[0].first == u ? 1 : 0;
          if (!bodies_[std::size_t(j.ends[other].first)].visited) attach(j, other, u);
        }
      }
    };
    spread();
    Sequence<std::pair<long, int>> left;  // (−number of joints, body), sorted: most joints first
    for (std::size_t b = 0; b < bodies_.size(); ++b)
      if (!bodies_[b].visited) left.push_back({-long(bodies_[b].joints.size()), int(b)});
    sort_once(left);
    for (auto const& [joints, root] : left) {
      if (bodies_[std::size_t(root)].visited) continue;
      bodies_[std::size_t(root)].visited = true;
      queue.push_back(root);
      spread();
    }
    for (Joint& j : joints_)
      if (!j.used) close(j);
  }

  /// Makes a joint a closing joint: it is eliminated after all bodies and joints of its loop.
  [[gnu::cold]] void close(Joint& j) {
    Segment& s = segments_[std::size_t(j.segment)];
    // An unknown that occurs only in constraint equations, such as the coordinate of a slider, is eliminated last.
    if (j.ends.empty() && j.meets_rows) {
      for (Joint const& other : joints_)
        if (!other.ends.empty()) s.after.push_back(other.segment);
      for (Body const& body : bodies_) s.after.append(body.segments.begin(), body.segments.end());
      return;
    }
    Sequence<int> loop;
    int carrier = -1;  // body at which both branches of the loop begin; it may be eliminated after the joint
    if (j.ends.size() == 2) {
      int a = j.ends[0].first, b = j.ends[1].first;
      while (a != b) {
        int& deeper = b < 0 || (a >= 0 && bodies_[std::size_t(a)].depth >= bodies_[std::size_t(b)].depth) ? a : b;
        loop.push_back(deeper);
        deeper = bodies_[std::size_t(deeper)].parent;
      }
      carrier = a;
    } else {  // joint to the ground, or between more than two bodies: all bodies on the paths to the ground
      for (auto const& end : j.ends) {
        if (is_own(j)) loop.push_back(end.first), carrier = bodies_[std::size_t(end.first)].parent;
        for (int u = end.first; u >= 0 && !is_own(j); u = bodies_[std::size_t(u)].parent) loop.push_back(u);
      }
    }
    sort_once(loop);
    for (auto const& [body, touched] : j.ends) {
      if (loop.size() == 1 && body != loop[0]) continue;  // driving or norm constraint parallel to the tree joint
      s.after.append(touched.begin(), touched.end());
      if (loop.size() == 1) s.child = touched;
    }
    for (int const u : loop) {
      Body& body = bodies_[std::size_t(u)];
      if (loop.size() > 1) s.after.append(body.segments.begin(), body.segments.end());
      if (body.primary >= 0) s.after.push_back(body.primary);
      if (loop.size() == 1) body.secondary.push_back(j.segment);
    }
    s.closes_loop = carrier < 0 || (!is_own(j) && is_rigid(carrier));  // a flexible carrier may deform the loop
  }
  bool is_rigid(int body) const {
    int unknowns = 0;
    for (int const s : bodies_[std::size_t(body)].segments) unknowns += segments_[std::size_t(s)].size;
    return unknowns <= 7;
  }

  Sequence<Segment> segments_;
  Sequence<int> segment_of_;
  Sequence<Body> bodies_;
  Sequence<Joint> joints_;
};

}  // namespace polybody::detail
