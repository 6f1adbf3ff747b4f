#pragma once
/// \file
/// Functions of the block factorisation that are not called in a usual step: changes of the elimination order, null
/// vectors of redundant constraints, counts of operations and entries.

#include <polybody/solvers/block_factor.hpp>

namespace polybody {

template <Symmetry symmetry>
[[gnu::cold]] Index BlockFactor<symmetry>::failed(Node const& n, int r) {
  Index const unknown = layout_.unknown[n.x + std::size_t(r)];
  double const pivot = u_.data()[n.u + std::size_t(r * n.stride() + r)];
  if (!std::isfinite(pivot) || hints_.dense) return unknown;
  detail::BlockLayout::NodeHints const before = hints_;
  auto const& segments = pattern_.segments();
  auto const& segment = segments[std::size_t(pattern_.of(unknown))];
  bool changed = false;
  if (!n.pivoted && n.joint) {  // a joint without a pivot: eliminate it last
    for (std::size_t s = 0; s < segments.size(); ++s)
      if (segments[s].first == segment.first && !hints_.late[s]) {
        hints_.late[s] = 1;
        changed = true;
      }
  } else if (!n.pivoted) {  // a singular body: merge it, and bodies like it, with their joints
    auto const rows = [&](int body) {
      int const primary = pattern_.primary(body);
      return primary < 0 ? 0 : segments[std::size_t(primary)].size;
    };
    for (std::size_t s = 0; s < segments.size(); ++s)
      if (!segments[s].joint && !hints_.merged[s] && segments[s].size == segment.size &&
          rows(segments[s].body) == rows(segment.body)) {
        hints_.merged[s] = 1;
        changed = true;
      }
  }
  if (!changed && n.pivoted && !hints_.apart) changed = hints_.apart = true;
  if (!changed) {
    if (size_ > dense_limit) return unknown;
    hints_.dense = true;
  }
  earlier_.push_back(before);
  compile();
  reordered_ = true;
  return unknown;
}

template <Symmetry symmetry>
bool BlockFactor<symmetry>::is_doubtful(double share) const {
  if (dropped_count_ > left_out_places_.size()) return true;
  for (Node const& n : layout_.nodes) {
    if (!n.droppable || n.pivoted) continue;
    for (std::size_t p = n.x; p < n.x + std::size_t(n.size); ++p) {
      double const inverse = inverse_.data()[p], scale = scales_.data()[p];
      if (inverse != 0.0 && std::isfinite(scale) && !(1.0 > share * scale * std::abs(inverse))) return true;
    }
  }
  return false;
}

/// Null vectors by substitutions that visit only nodes with nonzero entries. Entries of the order of the round-off
/// count as zero; otherwise they would spread over the whole model.
template <Symmetry symmetry>
class BlockFactor<symmetry>::NullSpace {
 public:
  /// Prepares the null vectors of a factorised matrix. \param of its factorisation \param sizes typical magnitudes of
  /// its equations
  NullSpace(BlockFactor const& of, VecX const& sizes)
      : of_(of),
        nodes_(of.layout_.nodes),
        w_(of.work_.data()),
        solution_(of.solution(w_)),
        size_(of.layout_.unknown.size(), 0.0),
        waits_(nodes_.size(), char(0)),
        first_earlier_(nodes_.size() + 1, 0) {
    std::fill_n(w_, size_.size(), 0.0);
    for (Index i = 0; i < sizes.size(); ++i)
      size_[std::size_t(of.layout_.place[std::size_t(i)])] =
          sizes[i] > 0.0 && std::isfinite(sizes[i]) ? sizes[i] : -1.0;
    for (Neighbour const& k : of.layout_.neighbours) ++first_earlier_[std::size_t(k.node) + 1];
    for (std::size_t k = 0; k < nodes_.size(); ++k) first_earlier_[k + 1] += first_earlier_[k];
    earlier_.resize(of.layout_.neighbours.size());
    Sequence<int> next = first_earlier_;
    for (Node const& n : nodes_)
      for (Neighbour const& k : solution_.later(n)) earlier_[std::size_t(next[std::size_t(k.node)]++)] = number(n);
  }

  /// Null vector of one dropped unknown.
  IndexMap<double> vector_of(Index dropped) {
    int const place = of_.layout_.place[std::size_t(dropped)];
    Node const& own = of_.node_at(place);
    limit_ = 1e-12 * std::max(0.0, size_[std::size_t(place)]);
    visited_.clear();
    descend_from(own, place - int(own.x));
    for (int const n : visited_) enter(n);
    Sequence<Index> found;
    while (!front_.empty()) {
      Node const& n = nodes_[std::size_t(leave())];
      ascend(n);
      if (&n == &own) finish(own, place - int(own.x));
      if (!any_left([&](std::size_t p) { return std::abs(w_[p]) * size_[p] <= limit_; }, n)) continue;
      for (std::size_t p = n.x; p < n.x + std::size_t(n.size); ++p)
        if (w_[p] != 0.0) found.push_back(of_.layout_.unknown[p]);
      int const k = number(n);
      for (int e = first_earlier_[std::size_t(k)]; e < first_earlier_[std::size_t(k) + 1]; ++e)
        enter(earlier_[std::size_t(e)]);
    }
    sort_once(found);
    IndexMap<double> out;
    for (Index const i : found) {
      double& entry = w_[of_.layout_.place[std::size_t(i)]];
      out[i] = entry;
      entry = 0.0;
    }
    return out;
  }

 private:
  int number(Node const& n) const { return int(of_.number(n)); }
  /// Adds a node to the heap of nodes to be visited, the largest key first.
  void enter(int key) {
    char& waits = waits_[std::size_t(std::abs(key))];
    if (waits) return;
    waits = 1;
    front_.push_back(key);
    std::push_heap(front_.begin(), front_.end());
  }
  int leave() {
    std::pop_heap(front_.begin(), front_.end());
    int const key = front_.back();
    front_.pop_back();
    waits_[std::size_t(std::abs(key))] = 0;
    return key;
  }
  /// Sets the `small` entries of a node to zero, except those of equations with unknown sizes. Returns true if a
  /// nonzero entry remains.
  template <class Small>
  bool any_left(Small const& small, Node const& n) {
    for (std::size_t p = n.x; p < n.x + std::size_t(n.size); ++p)
      if (size_[p] >= 0.0 && small(p)) w_[p] = 0.0;
    return !is_zero(n);
  }
  bool is_zero(Node const& n) const {
    double const* const y = w_ + n.x;
    return std::all_of(y, y + n.size, [](double entry) { return entry == 0.0; });
  }

  /// Forward substitution of the column of a dropped unknown, from its node `own` on. Lists the visited nodes.
  void descend_from(Node const& own, int row) {
    detail::NodeStorage const s = of_.storage(own);
    double const* const u = s.u + row * s.stride();
    for (int p = row + 1; p < s.size; ++p) w_[own.x + std::size_t(p)] = -u[p];
    for (auto const& k : solution_.later(own)) {
      for (int i = 0; i < k.size; ++i) solution_.later(own).of(k)[i] = -u[s.pad + k.column + i];
      enter(-k.node);
    }
    enter(-number(own));
    while (!front_.empty()) {
      Node const& n = nodes_[std::size_t(-leave())];
      visited_.push_back(number(n));
      if (!any_left([&](std::size_t p) { return std::abs(w_[p]) <= limit_ * size_[p]; }, n)) continue;
      with_constant(of_.direct_[of_.number(n)], [&](auto size) { solution_.template descend<size>(n); });
      for (auto const& k : solution_.later(n)) enter(-k.node);
    }
  }
  void ascend(Node const& n) {
    auto const later = solution_.later(n);
    if (is_zero(n) &&
        std::all_of(later.begin(), later.end(), [&](auto const& k) { return is_zero(nodes_[std::size_t(k.node)]); }))
      return;
    with_constant(of_.direct_[of_.number(n)], [&](auto size) { solution_.template ascend<size>(n); });
  }
  /// Sets the dropped unknown to 1 and changes the earlier rows of its node accordingly.
  void finish(Node const& own, int row) {
    detail::NodeStorage const s = of_.storage(own);
    int const stride = s.stride();
    double* const y = w_ + own.x;
    y[row] = 1.0;  // `ascend` leaves y[row] zero
    Sequence<double> part(std::size_t(row), 0.0);
    for (int r = row - 1; r >= 0; --r) {
      if (s.inverse[r] == 0.0) continue;  // dropped
      double sum = s.u[r * stride + row];
      for (int p = r + 1; p < row; ++p) sum += s.u[r * stride + p] * part[std::size_t(p)];
      part[std::size_t(r)] = -s.inverse[r] * sum;
      y[r] += part[std::size_t(r)];
    }
  }

  BlockFactor const& of_;
  Sequence<Node> const& nodes_;
  double* w_;
  Solution solution_;
  Sequence<double> size_;  // size of the equation at each place, negative if unknown
  double limit_ = 0.0;     // size of the dropped unknown times the limit of entries
  Sequence<char> waits_;
  Sequence<int> front_, visited_;
  Sequence<int> first_earlier_, earlier_;  // for each node: earlier nodes that share a block with it
};

template <Symmetry symmetry>
Sequence<IndexMap<double>> BlockFactor<symmetry>::null_vectors(VecX const& sizes) const {
  Sequence<IndexMap<double>> found;
  if (dropped_count_ == 0) return found;
  NullSpace space(*this, sizes);
  for (Index const i : dropped()) found.push_back(space.vector_of(i));
  return found;
}

template <Symmetry symmetry>
double BlockFactor<symmetry>::flops() const {
  double count = 0.0;
  for (Node const& n : layout_.nodes) {
    double later = 0.0;
    for (int a = 0; a < n.neighbours; ++a) later += layout_.neighbours[std::size_t(n.first_neighbour + a)].size;
    for (int r = 1; r < n.size; ++r) count += r * (r + 4.0 * later);  // half of D; W twice: L⁻¹ W, R⁻¹ Δ⁻¹ W
    count += n.size * later * (later + 2.0);
  }
  return count;
}

template <Symmetry symmetry>
Index BlockFactor<symmetry>::fill() const {
  Index count = 0;
  for (Node const& n : layout_.nodes) {
    count += n.size * (n.size + 1) / 2;
    for (int a = 0; a < n.neighbours; ++a)
      count += n.size * layout_.neighbours[std::size_t(n.first_neighbour + a)].size;
  }
  return count;
}

}  // namespace polybody
