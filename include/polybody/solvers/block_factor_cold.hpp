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

template <Symmetry symmetry>
void BlockFactor<symmetry>::null_vector(Index dropped, VecX& x) const {
  double* const w = work_.data();
  std::fill_n(w, layout_.unknown.size(), 0.0);
  int const place = layout_.place[std::size_t(dropped)];
  Node const& own = node_at(place);
  Solution const solution = this->solution(w);
  detail::NodeStorage const s = storage(own);
  int const row = place - int(own.x), stride = s.stride();
  double* const y = w + own.x;
  Sequence<double> part(std::size_t(s.size), 0.0);
  for (int p = row + 1; p < s.size; ++p) y[p] = -s.u[row * stride + p];
  for (auto const& k : solution.later(own))
    for (int i = 0; i < k.size; ++i) solution.later(own).of(k)[i] = -s.u[row * stride + s.pad + k.column + i];
  for (Node const* n = &own; n != layout_.nodes.end(); ++n)
    with_constant(direct_[number(*n)], [&](auto size) { solution.template descend<size>(*n); });
  for (Node const* n = layout_.nodes.end(); n != layout_.nodes.begin();) {
    --n;
    with_constant(direct_[number(*n)], [&](auto size) { solution.template ascend<size>(*n); });
    if (n != &own) continue;
    y[row] = 1.0;  // `ascend` has left y[row] zero, so the loop adds its effect on the earlier rows
    for (int r = row - 1; r >= 0; --r) {
      if (s.inverse[r] == 0.0) continue;  // dropped
      double sum = s.u[r * stride + row];
      for (int p = r + 1; p < row; ++p) sum += s.u[r * stride + p] * part[std::size_t(p)];
      part[std::size_t(r)] = -s.inverse[r] * sum;
      y[r] += part[std::size_t(r)];
    }
  }
  for (Index i = 0; i < size_; ++i) x[i] = w[layout_.place[std::size_t(i)]];
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
