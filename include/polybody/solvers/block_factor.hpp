#pragma once
/// \file
/// Factorisation of [A, Gᵀ; G, 0] by fixed blocks: the order and every place of the fill are found once, the numbers run
/// through a flat list of block operations without searching, pivoting or allocation.
///
/// A node's rows stand as U = [D | W], D its own block, W its row of later ones, and its columns as Lt, transposed. With
/// D = L Δ R (pivots Δ, unit triangles L, R) elimination makes W ← L⁻¹ W, Lt ← Δ⁻¹ R⁻ᵀ Lt, and C_kl −= Lt_kᵀ W_l for all
/// later k, l. In a symmetric matrix Lt = Δ⁻¹ W and only l ≥ k is made.

#include <cmath>
#include <cstring>
#include <span>

#include <polybody/solvers/block_layout.hpp>

namespace polybody {

/// How a block factorisation treats the half below the diagonal.
enum class Symmetry {
  assumed,   ///< only the upper half is read
  none,      ///< both halves are
  measured,  ///< both are read, and half the work is done when they agree
};

/// The block solver; see `BlockLdlt`, `BlockLu`, `BlockSolver` for its three ways.
template <Symmetry symmetry>
class BlockFactor {
 public:
  /// Below this part of what it was made of, a pivot counts as lost: of a body, and of the rows of a joint.
  static constexpr double body_threshold = 1e-13, row_threshold = 1e-9;
  /// Systems up to this size fall back on one dense block with pivoting.
  static constexpr Index dense_limit = 64;

  void analyse(Index size, std::vector<Block> const& blocks) {
    size_ = size;
    blocks_ = blocks;
    pattern_.analyse(size, blocks);
    lessons_ = {std::vector<char>(pattern_.segments().size(), 0), std::vector<char>(pattern_.segments().size(), 0)};
    reordered_ = false;
    compile();
  }

  void begin() {
    u_.zero();
    if constexpr (two_sided) l_.zero();
    next_ = 0;
  }

  /// Adds a block; the blocks come in the analysed order.
  void add(Index, Index, BlockView const& b) {
    int const end = layout_.first_piece[++next_];
    for (int k = layout_.first_piece[next_ - 1]; k < end; ++k) {
      detail::BlockLayout::Piece const& p = layout_.pieces[std::size_t(k)];
      if constexpr (!two_sided)
        if (p.lower) continue;
      double* const to = (p.lower ? l_.data() : u_.data()) + p.to;
      for (int i = 0; i < p.rows; ++i)
        for (int j = 0; j < p.cols; ++j) to[i * p.row_step + j * p.col_step] += b(p.row + i, p.col + j);
    }
  }

  /// −1, or the unknown without a usable pivot. Rows of a loop that repeat others are dropped: see `dropped`.
  /// After a failure `reordered` may ask for the same matrix once more.
  Index factor() {
    reordered_ = false;
    dropped_count_ = 0;
    bool const symmetric = symmetry == Symmetry::assumed || (symmetry == Symmetry::measured && is_symmetric());
    symmetric_ = symmetric;
    set_scales();
    for (Node const& node : layout_.nodes) {
      if (int const bad = node.pivoted ? eliminate_pivoted(node, symmetric) : eliminate(node, symmetric); bad >= 0)
        return failed(node, bad);
      update(node, symmetric);
    }
    return -1;
  }

  /// The order was changed since the last failure; write and factor the same matrix again.
  bool reordered() const { return reordered_; }
  /// Unknowns (rows of joints) that repeat others; their multipliers are zero.
  std::span<Index const> dropped() const { return {dropped_.data(), dropped_count_}; }
  /// Whether the last factorisation did the half of the work.
  bool was_symmetric() const { return symmetric_; }

  /// x = A⁻¹ b; both may be the same.
  void solve(VecX const& b, VecX& x) const { solve(b.data(), x.data()); }
  /// Column by column.
  void solve(MatX const& b, MatX& x) const {
    for (Index j = 0; j < b.cols(); ++j) solve(b.col(j).data(), x.col(j).data());
  }
  void solve(double const* b, double* x) const;

  /// Multiplications and additions of a factorisation as last compiled, symmetric or not.
  double flops(bool symmetric = true) const;
  /// Entries of the factor without padding.
  Index fill() const;
  Index nodes() const { return Index(layout_.nodes.size()); }

 private:
  static constexpr bool two_sided = symmetry != Symmetry::assumed;

  using Node = detail::BlockLayout::Node;
  using Neighbour = detail::BlockLayout::Neighbour;

  void compile() {
    layout_.compile(pattern_, blocks_, lessons_);
    u_ = detail::AlignedDoubles(layout_.size_u);
    l_ = detail::AlignedDoubles(layout_.size_l);
    f_ = detail::AlignedDoubles(layout_.size_f);
    inverse_ = scales_ = work_ = detail::AlignedDoubles(layout_.unknown.size());
    swaps_.assign(layout_.unknown.size(), 0);
    dropped_.assign(std::size_t(size_), 0);
    dropped_count_ = 0;
  }
  bool is_symmetric() const;

  /// What each diagonal entry is made of: its own size, and what elimination adds.
  void set_scales() {
    for (Node const& n : layout_.nodes) {
      double const* const d = u_.data() + n.u;
      double* const scale = scales_.data() + n.x;
      for (int i = 0; i < n.size; ++i) {
        scale[i] = std::abs(d[i * n.stride() + i]);
        if (!n.pivoted) continue;
        for (int j = 0; j < n.stride(); ++j) scale[i] = std::max(scale[i], std::abs(d[i * n.stride() + j]));
      }
    }
  }

  int eliminate(Node const& n, bool symmetric) {
    int const stride = n.stride();
    double* const u = u_.data() + n.u;
    double* const l = l_.data() + n.l;
    double* const f = f_.data() + n.f;
    double* const inverse = inverse_.data() + n.x;
    double const* const scale = scales_.data() + n.x;
    for (int r = 0; r < n.size; ++r) {
      double const pivot = u[r * stride + r];
      if (!(std::abs(pivot) > (n.joint ? row_threshold : body_threshold) * scale[r])) {
        if (!n.droppable || !std::isfinite(pivot)) return r;  // only a joint that waits for its whole loop may be redundant
        dropped_[dropped_count_++] = layout_.unknown[n.x + std::size_t(r)];
        inverse[r] = 0.0;
        for (int s = 0; s < n.size; ++s) f[s * n.size + r] = 0.0;
        continue;
      }
      inverse[r] = 1.0 / pivot;
      int const begin = (r + 1) & ~3;
      for (int s = r + 1; s < n.size; ++s) {
        double const factor = u[s * stride + r] * inverse[r];
        f[s * n.size + r] = factor;
        detail::subtract_row(u + s * stride + begin, factor, u + r * stride + begin, stride - begin);
      }
    }
    if (symmetric) {
      for (int r = 0; r < n.size; ++r)
        detail::scale_row(l + r * n.width, inverse[r], u + r * stride + n.pad, n.width);
    } else {
      finish_columns(n, u, l, inverse);
    }
    return -1;
  }

  /// Lt ← Δ⁻¹ R⁻ᵀ Lt.
  static void finish_columns(Node const& n, double const* u, double* l, double const* inverse) {
    for (int r = 0; r < n.size; ++r) {
      double* const row = l + r * n.width;
      detail::scale_row(row, inverse[r], row, n.width);
      for (int s = r + 1; s < n.size; ++s)
        detail::subtract_row(l + s * n.width, u[r * n.stride() + s], row, n.width);
    }
  }

  /// With partial pivoting among the node's rows.
  int eliminate_pivoted(Node const& n, bool symmetric) {
    int const stride = n.stride();
    double* const u = u_.data() + n.u;
    double* const l = l_.data() + n.l;
    double* const f = f_.data() + n.f;
    double* const inverse = inverse_.data() + n.x;
    int* const swap = swaps_.data() + n.x;
    double largest = 0.0;
    for (int i = 0; i < n.size; ++i) largest = std::max(largest, scales_.data()[n.x + std::size_t(i)]);
    if (symmetric)
      for (int r = 0; r < n.size; ++r) std::copy_n(u + r * stride + n.pad, n.width, l + r * n.width);
    for (int r = 0; r < n.size; ++r) {
      int best = r;
      double column = 0.0;
      for (int s = r; s < n.size; ++s)
        if (std::abs(u[s * stride + r]) > std::abs(u[best * stride + r])) best = s;
      for (int s = 0; s < n.size; ++s) column = std::max(column, std::abs(u[s * stride + r]));
      swap[r] = best;
      if (best != r) {
        std::swap_ranges(u + r * stride, u + (r + 1) * stride, u + best * stride);
        std::swap_ranges(f + r * n.size, f + r * n.size + r, f + best * n.size);
      }
      double const pivot = u[r * stride + r];
      if (!(std::abs(pivot) > body_threshold * std::max(column, 1e-3 * body_threshold * largest))) return r;
      inverse[r] = 1.0 / pivot;
      int const begin = (r + 1) & ~3;
      for (int s = r + 1; s < n.size; ++s) {
        double const factor = u[s * stride + r] * inverse[r];
        f[s * n.size + r] = factor;
        detail::subtract_row(u + s * stride + begin, factor, u + r * stride + begin, stride - begin);
      }
    }
    finish_columns(n, u, l, inverse);
    return -1;
  }

  void update(Node const& n, bool symmetric) {
    double const* const w = u_.data() + n.u + n.pad;
    double const* const l = l_.data() + n.l;
    Neighbour const* const of = layout_.neighbours.data() + n.first_neighbour;
    int const* target = layout_.targets.data() + n.first_target;
    for (int a = 0; a < n.neighbours; ++a) {
      Node const& k = layout_.nodes[std::size_t(of[a].node)];
      double* const rows = u_.data() + k.u;
      double const *const wa = w + of[a].column, *const la = l + of[a].column;
      detail::subtract_product(rows, k.stride(), la, n.width, wa, n.stride(), n.size, k.size, k.pad);
      double* const scale = scales_.data() + k.x;
      for (int r = 0; r < n.size; ++r)
        for (int i = 0; i < k.size; ++i) scale[i] += std::abs(la[r * n.width + i] * wa[r * n.stride() + i]);
      for (int b = a + 1; b < n.neighbours; ++b) {
        int const column = *target++, width = detail::padded(of[b].size);
        detail::subtract_product(rows + k.pad + column, k.stride(), la, n.width, w + of[b].column, n.stride(), n.size,
                                 k.size, width);
        if (!symmetric)
          detail::subtract_product(l_.data() + k.l + column, k.width, wa, n.stride(), l + of[b].column, n.width, n.size,
                                   k.size, width);
      }
    }
  }

  Index failed(Node const& n, int r);

  Index size_ = 0;
  std::vector<Block> blocks_;
  detail::BlockPattern pattern_;
  detail::BlockLayout layout_;
  detail::BlockLayout::Lessons lessons_;
  bool reordered_ = false, symmetric_ = false;
  std::size_t next_ = 0;  // block to be added
  std::vector<int> swaps_;
  std::vector<Index> dropped_;
  std::size_t dropped_count_ = 0;
  detail::AlignedDoubles u_, l_, f_, inverse_, scales_;
  mutable detail::AlignedDoubles work_;
};

template <Symmetry symmetry>
bool BlockFactor<symmetry>::is_symmetric() const {
  for (Node const& n : layout_.nodes) {
    double const *const u = u_.data() + n.u, *const l = l_.data() + n.l;
    double largest = 0.0, apart = 0.0;
    for (int r = 0; r < n.size; ++r) {
      for (int c = 0; c < n.size; ++c) {
        largest = std::max(largest, std::abs(u[r * n.stride() + c]));
        apart = std::max(apart, std::abs(u[r * n.stride() + c] - u[c * n.stride() + r]));
      }
      for (int k = 0; k < n.width; ++k) {
        largest = std::max(largest, std::abs(u[r * n.stride() + n.pad + k]));
        apart = std::max(apart, std::abs(u[r * n.stride() + n.pad + k] - l[r * n.width + k]));
      }
    }
    if (apart > 1e-12 * largest) return false;
  }
  return true;
}

template <Symmetry symmetry>
Index BlockFactor<symmetry>::failed(Node const& n, int r) {
  Index const unknown = layout_.unknown[n.x + std::size_t(r)];
  double const pivot = u_.data()[n.u + std::size_t(r * n.stride() + r)];
  if (!std::isfinite(pivot) || lessons_.dense) return unknown;
  auto const& segments = pattern_.segments();
  auto const& segment = segments[std::size_t(pattern_.of(unknown))];
  bool changed = false;
  if (!n.pivoted && n.joint) {  // what hangs on it cannot carry it alone: it waits for all others
    for (std::size_t s = 0; s < segments.size(); ++s)
      if (segments[s].first == segment.first && !lessons_.late[s]) {
        lessons_.late[s] = 1;
        changed = true;
      }
  } else if (!n.pivoted) {  // a singular body: it and its joint become one; so do those like it
    auto const rows = [&](int body) {
      int const primary = pattern_.primary(body);
      return primary < 0 ? 0 : segments[std::size_t(primary)].size;
    };
    for (std::size_t s = 0; s < segments.size(); ++s)
      if (!segments[s].joint && !lessons_.merged[s] && segments[s].size == segment.size &&
          rows(segments[s].body) == rows(segment.body))
{
        lessons_.merged[s] = 1;
        changed = true;
      }
  }
  if (!changed) {
    if (size_ > dense_limit) return unknown;
    lessons_.dense = true;
  }
  compile();
  reordered_ = true;
  return unknown;
}

template <Symmetry symmetry>
void BlockFactor<symmetry>::solve(double const* b, double* x) const {
  double* const w = work_.data();
  for (std::size_t i = 0; i < layout_.unknown.size(); ++i) w[i] = layout_.unknown[i] < 0 ? 0.0 : b[layout_.unknown[i]];
  double const* const inverses = inverse_.data();
  for (Node const& n : layout_.nodes) {
    double* const y = w + n.x;
    double const *const f = f_.data() + n.f, *const l = l_.data() + n.l;
    if (n.pivoted)
      for (int r = 0; r < n.size; ++r) std::swap(y[r], y[swaps_[n.x + std::size_t(r)]]);
    for (int r = 0; r < n.size; ++r)
      for (int s = r + 1; s < n.size; ++s) y[s] -= f[s * n.size + r] * y[r];
    Neighbour const* const of = layout_.neighbours.data() + n.first_neighbour;
    for (int a = 0; a < n.neighbours; ++a) {
      Node const& k = layout_.nodes[std::size_t(of[a].node)];
      for (int r = 0; r < n.size; ++r) detail::subtract_row(w + k.x, y[r], l + r * n.width + of[a].column, k.pad);
    }
  }
  for (auto it = layout_.nodes.rbegin(); it != layout_.nodes.rend(); ++it) {
    Node const& n = *it;
    double* const y = w + n.x;
    double const *const u = u_.data() + n.u, *const inverse = inverses + n.x;
    Neighbour const* const of = layout_.neighbours.data() + n.first_neighbour;
    for (int a = 0; a < n.neighbours; ++a) {
      Node const& k = layout_.nodes[std::size_t(of[a].node)];
      for (int r = 0; r < n.size; ++r)
        y[r] -= detail::dot_rows(u + r * n.stride() + n.pad + of[a].column, w + k.x, k.pad);
    }
    for (int r = n.size - 1; r >= 0; --r) {
      double sum = y[r];
      for (int s = r + 1; s < n.size; ++s) sum -= u[r * n.stride() + s] * y[s];
      y[r] = sum * inverse[r];
    }
  }
  for (std::size_t i = 0; i < layout_.unknown.size(); ++i)
    if (layout_.unknown[i] >= 0) x[layout_.unknown[i]] = w[i];
}

template <Symmetry symmetry>
double BlockFactor<symmetry>::flops(bool symmetric) const {
  double count = 0.0;
  for (Node const& n : layout_.nodes) {
    double later = 0.0;
    for (int a = 0; a < n.neighbours; ++a) later += layout_.neighbours[std::size_t(n.first_neighbour + a)].size;
    for (int r = 1; r < n.size; ++r) count += r * (r + 2.0 * later);  // the node's own half and its row
    count += n.size * later * (later + 1.0);
    if (!symmetric) count += n.size * later * (later - 1.0) + n.size * (n.size - 1.0) * (n.size / 3.0 + later);
  }
  return count;
}

template <Symmetry symmetry>
Index BlockFactor<symmetry>::fill() const {
  Index count = 0;
  for (Node const& n : layout_.nodes) {
    count += n.size * (n.size + 1) / 2;
    for (int a = 0; a < n.neighbours; ++a) count += n.size * layout_.neighbours[std::size_t(n.first_neighbour + a)].size;
  }
  return count;
}

}  // namespace polybody
