#pragma once
/// \file
/// Block factorisation of the saddle-point matrix [A, Gᵀ; G, 0], and its solvers by symmetry: `BlockLu`, `BlockSolver`
/// and `BlockLdlt`. The elimination order and the positions of the fill are computed once. Each factorisation runs
/// through a flat list of block operations without search, allocation or pivoting between blocks.
///
/// A node is a set of unknowns that are eliminated together. Its rows are stored as U = [D | W], where D is its
/// diagonal block and W its blocks with later nodes. Its blocks below D are stored transposed, as Lt. D is factorised
/// as L Δ R, with pivots Δ and unit triangular L and R. Elimination computes W ← L⁻¹ W, Lt ← Δ⁻¹ R⁻ᵀ Lt, and C_kl −=
/// Lt_kᵀ W_l for the blocks C of all later nodes k, l. In a symmetric matrix Lt = Δ⁻¹ W, and only blocks with l ≥ k are
/// computed. Afterwards nodes of at most six unknowns store the elimination multipliers D⁻¹ W and D⁻ᵀ Lt of the
/// original blocks. In a solution no node then waits for the triangular solve of another one. If D is nearly singular,
/// sums of products with these multipliers would cancel. Such a node stores L⁻¹ W and Δ⁻¹ R⁻ᵀ Lt.
/// Theory: Eqs. 7.8, 7.9.

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <polybody/math/index_map.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/solvers/block_layout.hpp>
#include <polybody/solvers/block_node.hpp>

namespace polybody {

/// Treatment of the half below the diagonal in a block factorisation.
enum class Symmetry {
  assumed,   ///< only the upper half is read
  none,      ///< both halves are read
  measured,  ///< both halves are read; if they agree up to 1e-12 of the norm, only the upper half is computed
};

/// Block factorisation of a saddle-point matrix; `BlockLdlt`, `BlockLu` and `BlockSolver` are its three variants.
template <Symmetry symmetry>
class BlockFactor {
 public:
  /// Least ratio of a pivot to the sum of the magnitudes of its terms, for bodies (`body_threshold`) and for joints
  /// (`row_threshold`). Smaller pivots count as zero.
  static constexpr double body_threshold = 1e-13, row_threshold = 1e-9;  ///< ratios, pivot to sum of terms
  /// Up to this number of unknowns, one dense block with pivoting is used if changes of the elimination order fail.
  static constexpr Index dense_limit = 64;
  /// Block solver that reads both halves of the matrix.
  using Unsymmetric = BlockFactor<symmetry == Symmetry::assumed ? Symmetry::none : symmetry>;

  BlockFactor() = default;
  BlockFactor(BlockFactor const&) = delete;  // slots_ points into u_ and l_
  BlockFactor& operator=(BlockFactor const&) = delete;
  BlockFactor(BlockFactor&&) = default;             ///< the addresses of `slots()` remain valid
  BlockFactor& operator=(BlockFactor&&) = default;  ///< the addresses of `slots()` remain valid

  [[gnu::cold]] void analyse(Index size, std::span<Block const> blocks) {
    size_ = size;
    blocks_ = Sequence<Block>(blocks.begin(), blocks.end());
    pattern_.analyse(size, blocks);
    hints_ = {Sequence<char>(pattern_.segments().size(), 0), Sequence<char>(pattern_.segments().size(), 0), false,
              false};
    reordered_ = false;
    earlier_.clear();
    kept_ = no_limit;
    left_out_.clear();
    compile();
  }

  void begin() {
    if (kept_ < earlier_.size()) [[unlikely]]
      go_back();
    u_.zero();
    if constexpr (two_sided) l_.zero();
    next_ = 0;
  }

  /// Adds the next block in the analysed order.
  void add(Index, Index, BlockView const& b) {
    int const end = layout_.first_piece[++next_];
    for (int k = layout_.first_piece[next_ - 1]; k < end; ++k) slots_[std::size_t(k)].add(b);
  }
  /// Skips the next block in the analysed order; its entries are zero.
  void skip(Index, Index, Index, Index) { ++next_; }
  /// Addresses to which the blocks are added. They are valid until the next `analyse` or change of the elimination
  /// order (`reordered`).
  BlockSlots slots() const { return {slots_.data(), layout_.first_piece.data(), number_}; }

  /// Returns −1 on success, otherwise the index of the unknown without a usable pivot. Redundant constraint equations
  /// of a loop are dropped: see `dropped`. If `reordered` is true after a failure, the same matrix can be written and
  /// factorised again.
  Index factor() {
    reordered_ = false;
    dropped_count_ = 0;
    bool const symmetric = symmetry == Symmetry::assumed || (symmetry == Symmetry::measured && is_symmetric());
    symmetric_ = symmetric;
    scales_.zero();
    for (int const p : left_out_places_) scales_.data()[p] = std::numeric_limits<double>::infinity();
    for (Node const& node : layout_.nodes) {
      int const bad = with_constant(node.pivoted ? 0 : node.size, [&](auto n) {
        int const lost = eliminate<n>(node, symmetric);
        if (lost < 0) update<n>(node, symmetric);
        return lost;
      });
      if (bad >= 0) return failed(node, bad);
    }
    for (Node const& node : layout_.nodes)
      with_constant(direct_[number(node)], [&](auto n) {
        if constexpr (n > 0) detail::finish_node<n>(storage(node), keeps_columns(node));
      });
    return -1;
  }

  /// True if the last factorisation failed and changed the elimination order: write and factorise the matrix again.
  bool reordered() const { return reordered_; }
  /// Number of changes of the elimination order.
  std::size_t reorderings() const { return std::min(kept_, earlier_.size()); }
  /// Reverts all changes of the elimination order except the first `count`. The factor remains valid until the next
  /// `begin`.
  void limit_reorderings(std::size_t count) noexcept { kept_ = std::min(count, kept_); }
  /// Indices of the multipliers of dropped equations among the unknowns. These multipliers are zero.
  std::span<Index const> dropped() const { return {dropped_.data(), dropped_count_}; }
  /// Until the next `analyse`, every later factorisation drops the multipliers `unknowns` and their equations, whatever
  /// the pivots. Equations that share a node with a singular body are not dropped.
  [[gnu::cold]] void mark_redundant(std::span<Index const> unknowns) {
    left_out_ = Sequence<Index>(unknowns.begin(), unknowns.end());
    place_left_out();
  }
  /// True if the last factorisation dropped more equations than `mark_redundant` lists, or if a pivot of a closing
  /// joint is at most `share` times the sum of the magnitudes of its terms.
  [[gnu::cold]] bool is_doubtful(double share) const;
  /// Computes for each unknown d of `dropped` the vector n with 1 at d, 0 at all other dropped unknowns, and A n = 0 in
  /// all other rows. A is the last factorised matrix. If the equation of d is redundant, n is a null vector of A. The
  /// cost of a vector is proportional to the size of the nodes with nonzero entries.
  /// \param sizes typical magnitudes of the equations, so that A_ij is of the order of sizes_i sizes_j or less. n_i
  /// counts as zero if |n_i| sizes_i ≤ 1e-12 sizes_d, and an entry r_i of A n if |r_i| ≤ 1e-12 sizes_i sizes_d
  [[gnu::cold]] Sequence<IndexMap<double>> null_vectors(VecX const& sizes) const;
  /// True if the last factorisation used symmetry, with half the work.
  bool was_symmetric() const { return symmetric_; }

  /// x = A⁻¹ b; b and x may be the same vector.
  void solve(VecX const& b, VecX& x) const { solve(b.data(), x.data()); }
  /// x = A⁻¹ b, column by column.
  void solve(MatX const& b, MatX& x) const {
    for (Index j = 0; j < b.cols(); ++j) solve(b.col(j).data(), x.col(j).data());
  }
  void solve(double const* b, double* x) const;  ///< b and x have the size of the system and may be the same

  /// Number of multiplications and additions of a symmetric factorisation in the current elimination order.
  double flops() const;
  /// Number of entries of the factor, without padding.
  Index fill() const;
  Index nodes() const { return Index(layout_.nodes.size()); }  ///< number of nodes, eliminated one after another
  /// Unknowns in the order of their elimination.
  Sequence<int> order() const {
    Sequence<int> all;
    for (Index const i : layout_.unknown)
      if (i >= 0) all.push_back(int(i));
    return all;
  }

 private:
  static constexpr bool two_sided = symmetry != Symmetry::assumed;

  using Node = detail::BlockLayout::Node;
  using Neighbour = detail::BlockLayout::Neighbour;

  [[gnu::cold]] void compile() {
    layout_.compile(pattern_, blocks_, hints_, two_sided);
    number_ = BlockSlots::new_layout();
    u_ = detail::AlignedDoubles(layout_.size_u);
    l_ = detail::AlignedDoubles(layout_.size_l);
    f_ = detail::AlignedDoubles(layout_.size_f);
    scaled_ = detail::AlignedDoubles(std::size_t(layout_.largest_w));
    inverse_ = scales_ = work_ = detail::AlignedDoubles(layout_.unknown.size());
    swaps_.assign(layout_.unknown.size(), 0);
    direct_.assign(layout_.nodes.size(), 0);
    dropped_.assign(std::size_t(size_), 0);
    dropped_count_ = 0;
    slots_.clear();
    for (detail::BlockLayout::Piece const& p : layout_.pieces) {
      bool const read = two_sided || !p.lower;
      double* const to = (p.lower ? l_.data() : u_.data()) + (read ? p.to : 0);
      slots_.push_back({to, p.row, p.col, read ? p.rows : 0, read ? p.cols : 0, p.stride, p.lower});
    }
    place_left_out();
  }
  Node const& node_at(int place) const {
    return *std::partition_point(layout_.nodes.begin(), layout_.nodes.end(),
                                 [&](Node const& n) { return n.x + std::size_t(n.pad) <= std::size_t(place); });
  }
  [[gnu::cold]] void place_left_out() {
    left_out_places_.clear();
    for (Index const i : left_out_)
      if (int const p = layout_.place[std::size_t(i)]; !node_at(p).pivoted) left_out_places_.push_back(p);
    sort_once(left_out_places_);
  }
  [[gnu::cold]] bool is_left_out(int place) const {
    return std::binary_search(left_out_places_.begin(), left_out_places_.end(), place);
  }
  bool is_symmetric() const;

  /// True if Lt is stored. A symmetric node needs Lt = Δ⁻¹ W only during its elimination.
  bool keeps_columns(Node const& n) const { return n.pivoted || !symmetric_; }
  detail::NodeStorage storage(Node const& n) const {
    double* const l = keeps_columns(n) ? l_.data() + n.l : scaled_.data();
    return {
        n.size, n.pad, n.width, u_.data() + n.u, l, f_.data() + n.f, inverse_.data() + n.x, direct_.data() + number(n)};
  }
  std::size_t number(Node const& n) const { return std::size_t(&n - layout_.nodes.data()); }

  /// Arrays of the factor, and the forward and backward substitution of a node.
  struct Solution {
    double *u, *l, *f, *inverse, *w, *scaled;
    char* direct;
    Node const* nodes;
    Neighbour const* neighbours;
    int const* swaps;
    bool symmetric;

    detail::NodeStorage storage(Node const& n) const {
      return {n.size, n.pad, n.width, u + n.u, l + n.l, f + n.f, inverse + n.x, direct + (&n - nodes)};
    }
    detail::LaterNodes<Neighbour, Node> later(Node const& n) const {
      return {neighbours + n.first_neighbour, n.neighbours, nodes, w};
    }
    template <int N>
    void descend(Node const& n) const {
      detail::NodeStorage const s = storage(n);
      double* const y = w + n.x;
      bool const kept = n.pivoted || !symmetric;
      double const* const c = kept ? s.l : s.u + s.pad;
      int const stride = kept ? s.width : s.stride();
      if constexpr (N == 0) return descend_by_triangles(n, c, stride);
      detail::pass_down<N>(c, stride, s.size, y, later(n));
      detail::solve_lower<N>(s, y);
    }
    template <int N>
    void ascend(Node const& n) const {
      if constexpr (N > 0)
        detail::pass_up<N>(storage(n), later(n), w + n.x);
      else
        detail::pull_and_solve(storage(n), later(n), w + n.x);
    }
    void descend_by_triangles(Node const& n, double const* c, int stride) const {
      detail::NodeStorage const s = storage(n);
      double* const y = w + n.x;
      if (n.pivoted)
        for (int r = 0; r < n.size; ++r) std::swap(y[r], y[swaps[n.x + std::size_t(r)]]);
      detail::solve_lower<0>(s, y);
      if (c == s.l) return detail::pass_down<0>(c, stride, s.size, y, later(n));
      for (int r = 0; r < n.size; ++r) scaled[r] = s.inverse[r] * y[r];
      detail::pass_down<0>(c, stride, s.size, scaled, later(n));
    }
  };

  Solution solution(double* w) const {
    return {u_.data(),
            l_.data(),
            f_.data(),
            inverse_.data(),
            w,
            scaled_.data(),
            direct_.data(),
            layout_.nodes.data(),
            layout_.neighbours.data(),
            swaps_.data(),
            symmetric_};
  }

  template <int N>
  int eliminate(Node const& n, bool symmetric) {
    double* const scale = scales_.data() + n.x;  // sums of the magnitudes that eliminations added to the diagonal
    if (n.pivoted) return detail::eliminate_pivoted(storage(n), symmetric, body_threshold, scale, swaps_.data() + n.x);
    return detail::eliminate_node<N>(storage(n), symmetric, n.joint ? row_threshold : body_threshold, scale,
                                     [&](int r, double pivot) {
                                       // only joints that are eliminated after their whole loop may be redundant
                                       if (!std::isfinite(pivot)) return true;
                                       if (!n.droppable && !is_left_out(int(n.x) + r)) return true;
                                       dropped_[dropped_count_++] = layout_.unknown[n.x + std::size_t(r)];
                                       return false;
                                     });
  }

  template <int N>
  void update(Node const& n, bool symmetric) {
    detail::NodeStorage const s = storage(n);
    double const *const w = s.u + s.pad, *const l = s.l;
    Neighbour const* const of = layout_.neighbours.data() + n.first_neighbour;
    int const* target = layout_.targets.data() + n.first_target;
    int const stride = n.stride();
    for (int a = 0; a < n.neighbours; ++a) {
      Node const& k = layout_.nodes[std::size_t(of[a].node)];
      double* const rows = u_.data() + k.u;
      double const *const wa = w + of[a].column, *const la = l + of[a].column;
      detail::add_sizes<N>(scales_.data() + k.x, {la, n.width}, {wa, stride}, n.size, k.pad);
      detail::subtract_product<N>({rows, k.stride()}, {la, n.width}, {wa, stride}, n.size, k.size, k.pad);
      for (int b = a + 1; b < n.neighbours; ++b) {
        int const column = *target++, width = detail::padded(of[b].size);
        detail::subtract_product<N>({rows + k.pad + column, k.stride()}, {la, n.width}, {w + of[b].column, stride},
                                    n.size, k.size, width);
        if (!symmetric)
          detail::subtract_product<N>({l_.data() + k.l + column, k.width}, {wa, stride}, {l + of[b].column, n.width},
                                      n.size, k.size, width);
      }
    }
  }

  Index failed(Node const& n, int r);
  class NullSpace;
  [[gnu::cold]] void go_back() {
    hints_ = earlier_[kept_];
    earlier_.resize(kept_);
    kept_ = no_limit;
    compile();
  }

  static constexpr std::size_t no_limit = std::numeric_limits<std::size_t>::max();

  Index size_ = 0;
  Sequence<Block> blocks_;
  detail::BlockPattern pattern_;
  detail::BlockLayout layout_;
  detail::BlockLayout::NodeHints hints_;
  Sequence<detail::BlockLayout::NodeHints> earlier_;  // hints before each change of the order
  std::size_t kept_ = no_limit;                       // number of changes that the next factorisation keeps
  bool reordered_ = false, symmetric_ = false;
  std::size_t next_ = 0;        // next block to be added
  std::uint64_t number_ = 0;    // number of the layout
  Sequence<BlockPiece> slots_;  // destinations of the pieces of all blocks
  Sequence<int> swaps_;
  mutable Sequence<char> direct_;  // size of each node, or 0 if it stores no elimination multipliers
  Sequence<Index> dropped_, left_out_;
  Sequence<int> left_out_places_;  // positions of the unknowns left_out_ in nodes without pivoting, ascending
  std::size_t dropped_count_ = 0;
  mutable detail::AlignedDoubles u_, l_, f_, inverse_, scaled_, work_;  // `solve` changes only scaled_ and work_
  detail::AlignedDoubles scales_;
};

template <Symmetry symmetry>
bool BlockFactor<symmetry>::is_symmetric() const {
  for (Node const& n : layout_.nodes) {
    detail::Difference off;
    for (int r = 0; r < n.size; ++r) {
      double const* const u = u_.data() + n.u + r * n.stride();
      for (int c = 0; c < r; ++c) off.compare(u[c], u_.data()[n.u + std::size_t(c * n.stride() + r)]);
      off.compare(u + n.pad, l_.data() + n.l + r * n.width, n.width);
      off.enlarge(u[r]);
    }
    if (!off.is_round_off()) return false;
  }
  return true;
}

template <Symmetry symmetry>
void BlockFactor<symmetry>::solve(double const* b, double* x) const {
  double* const w = work_.data();
  int const* const place = layout_.place.data();
  for (Index i = 0; i < size_; ++i) w[place[i]] = b[i];
  Solution const solution = this->solution(w);
  char const* direct = direct_.data();
  for (Node const& n : layout_.nodes) with_constant(*direct++, [&](auto size) { solution.template descend<size>(n); });
  for (Node const* n = layout_.nodes.end(); n != layout_.nodes.begin();) {
    --n;
    with_constant(*--direct, [&](auto size) { solution.template ascend<size>(*n); });
  }
  for (Index i = 0; i < size_; ++i) x[i] = w[place[i]];
}

/// Block LU factorisation in the elimination order of `BlockLdlt`, for unsymmetric tangents.
using BlockLu = BlockFactor<Symmetry::none>;
/// Block LU factorisation that does half the work if the matrix is symmetric.
using BlockSolver = BlockFactor<Symmetry::measured>;

/// Block LDLᵀ factorisation of a symmetric matrix; the half below the diagonal is not read. The tangent is unsymmetric
/// with friction, or with damping of rotating flexible bodies. `BlockLdlt` then factorises a wrong matrix, and
/// Newton's method converges slowly. `BlockSolver` reads both halves and measures the asymmetry.
using BlockLdlt = BlockFactor<Symmetry::assumed>;

}  // namespace polybody

#include <polybody/solvers/block_factor_cold.hpp>
