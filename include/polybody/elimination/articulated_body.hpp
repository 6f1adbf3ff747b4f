#pragma once
/// \file
/// Articulated-body algorithm: eliminates TᵀKT body by body from the tips of a tree to its roots [Featherstone 1983;
/// 2008, §7]. T maps the joint velocities u to the velocities of all bodies. K couples each body only with itself, its
/// parent and its children. The twist of a body at its centre of mass is x = [v; ω] = X x_p + S u. X x_p is the twist
/// due to the twist x_p of the parent, and S contains the motions of the joint. After the elimination of its
/// descendants, a body has the equation K̂ x + C x_p = f. With the blocks B = K(parent, body) and C = K(body, parent):
///   D u = r + Sᵀf − L x_p,    D = SᵀK̂ S,  L = Sᵀ(K̂ X + C),  R = (XᵀK̂ + B) S,
///   K̂_p += Xᵀ(K̂ X + C) + B X − R D⁻¹ L,    f_p += Xᵀf − R D⁻¹(r + Sᵀf),
/// with the generalised forces r of the joint. A root has no parent, and u are its own generalised velocities. The
/// remaining constraint equations, with Jacobian G, are solved with their Schur complement G T (TᵀKT)⁻¹ (G T)ᵀ.
/// Theory: Eqs. 5.25 to 5.28.

#include <polybody/elimination/reduction.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/solvers/dense_lu.hpp>

namespace polybody {

/// Solver of the policy `joint_coordinates::ArticulatedBody`. The scalar type T is always `double`. As a template, the
/// class is compiled only in programs with joint coordinates.
template <class T = double>
class ArticulatedBodySolverOf {
  using Vec3 = Vec<T, 3>;
  using Vec6 = Vec<T, 6>;
  using Mat6 = Mat<T, 6, 6>;
  using VecX = VecXOf<T>;
  using MatX = MatXOf<T>;
  using TreeFrame = TreeFrameOf<T>;
  using TreeState = TreeStateOf<T>;

 public:
  /// Sets the reduction, which contains the tree, and the state of the bodies. Reduction and state must outlive the
  /// solver. Allocates all memory.
  void attach(ReductionOf<> const& reduction, TreeState const& state) {
    reduction_ = &reduction;
    state_ = &state;
    Sequence<TreeBody> const& bodies = reduction.tree().bodies;
    Index const m = reduction.rows();
    nodes_.resize(bodies.size());
    rows_.assign(std::size_t(m), Sequence<Vec6>(bodies.size(), Vec6::Zero()));
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      owner_.resize(std::max(owner_.size(), std::size_t(bodies[i].v0 + velocities_of(bodies[i]))), -1);
      for (Index j = 0; j < velocities_of(bodies[i]); ++j) owner_[std::size_t(bodies[i].v0 + j)] = Index(i);
    }
    for (Index i = 0; i < m; ++i) {
      std::size_t const row = std::size_t(reduction.remaining_equations()[std::size_t(i)]);
      row_of_.resize(std::max(row_of_.size(), row + 1), -1);
      row_of_[row] = i;
    }
    answers_.setZero(reduction.velocities(), m);
    schur_.setZero(m, m);
    open_.setZero(m);
    lambda_.setZero(m);
    none_.setZero(reduction.velocities());
    loops_.analyse(m, {});
  }

  /// Begins a matrix: all its blocks are zero.
  void begin() {
    for (Node& n : nodes_) n = {};
    for (auto& row : rows_) std::fill(row.begin(), row.end(), Vec6(Vec6::Zero()));
    misplaced_ = -1;
  }

  /// Adds a block of the full matrix [K, Gᵀ; G, 0].
  void add(Index row, Index col, BlockView const& b) {
    Index const nv = Index(owner_.size());
    if (col >= nv) return;  // Gᵀ
    std::size_t const j = std::size_t(owner_[std::size_t(col)]);
    std::size_t const i = row < nv ? std::size_t(owner_[std::size_t(row)]) : 0;
    Sequence<TreeBody> const& bodies = reduction_->tree().bodies;
    Mat6* const to = row >= nv                      ? nullptr
                     : i == j                       ? &nodes_[i].k
                     : bodies[i].parent == Index(j) ? &nodes_[i].c
                     : bodies[j].parent == Index(i) ? &nodes_[j].b
                                                    : nullptr;
    for (Index l = 0; l < b.rows; ++l) {
      Vec6 g = Vec6::Zero();  // row l in world axes
      for (Index k = 0; k < b.cols; ++k) g += b(l, k) * axis_of(j, col + k - bodies[j].v0);
      if (row >= nv) {
        std::size_t const at = std::size_t(row + l - nv);
        if (at < row_of_.size() && row_of_[at] >= 0) rows_[std::size_t(row_of_[at])][j] += g;
      } else if (to) {
        *to += axis_of(i, row + l - bodies[i].v0) * g.transpose();
      } else if (!g.isZero(0.0)) {
        misplaced_ = Index(std::max(i, j));
      }
    }
  }

  /// Factorises the matrix. Returns −1 on success, otherwise the index of the reduced unknown without a usable pivot.
  /// \throws InvalidInput for a nonzero block between two bodies if neither is the parent of the other.
  Index factor() {
    if (misplaced_ >= 0)
      throw InvalidInput("solver.force_coupling", {"joint_coordinates::ArticulatedBody: a force couples body \"",
                                                   ErrorObject{reduction_->tree().bodies[std::size_t(misplaced_)].name},
                                                   "\" with a body that is neither its parent nor its child in "
                                                   "the tree. Use joint_coordinates::Augmented."});
    for (std::size_t i = nodes_.size(); i-- > 0;)
      if (Index const bad = eliminate(i); bad >= 0) return bad;
    Index const m = schur_.rows();
    if (m == 0) return -1;
    for (Index k = 0; k < m; ++k) {
      for (std::size_t i = 0; i < nodes_.size(); ++i) nodes_[i].f = rows_[std::size_t(k)][i];
      run(none_, answers_.col(k));
      for (Index j = 0; j < m; ++j) schur_(j, k) = row_times(j);
    }
    loops_.begin();
    loops_.add(0, 0, schur_);
    Index const bad = loops_.factor();
    return bad < 0 ? -1 : reduction_->velocities() + bad;
  }

  /// Solves [TᵀKT, (G T)ᵀ; G T, 0] x = rhs.
  void solve(VecX const& rhs, VecX& x) {
    Index const n = reduction_->velocities(), m = schur_.rows();
    for (Node& node : nodes_) node.f.setZero();
    run(rhs, x.head(n));
    if (m == 0) return;
    for (Index j = 0; j < m; ++j) open_[j] = row_times(j) - rhs[n + j];
    loops_.solve(open_, lambda_);
    x.tail(m) = lambda_;
    for (Index k = 0; k < m; ++k) x.head(n) -= lambda_[k] * answers_.col(k);
  }

 private:
  struct Node {
    Mat6 k = Mat6::Zero(), b = k, c = k;           ///< K̂, B, C
    Mat6 s = k, inverse = k, left = k, right = k;  ///< S, D⁻¹, L by rows, R by columns
    Vec6 f = Vec6::Zero(), x = f, u = f;  ///< force on the body; solution x = [v; ω] of the body and u of its joint
    int velocities = 0;

    /// u += part · D⁻¹ given.
    void add_answer(double part, Vec6 const& given) {
      for (int j = 0; j < velocities; ++j)
        for (int i = 0; i < velocities; ++i) u[i] += part * (inverse(i, j) * given[j]);
    }
  };

  static Index velocities_of(TreeBody const& body) { return body.layout == RigidLayout::plane ? 3 : 6; }
  /// Twist [v; ω] of body i for a unit value of its generalised velocity k, in world axes.
  Vec6 axis_of(std::size_t i, Index k) const {
    Vec6 axis = Vec6::Zero();
    if (reduction_->tree().bodies[i].layout == RigidLayout::plane)
      axis[k == 2 ? 5 : k] = 1.0;
    else if (k < 3)
      axis[k] = 1.0;
    else
      axis.template tail<3>() = state_->frames[i].A.col(k - 3);
    return axis;
  }

  Index eliminate(std::size_t i) {
    Node& n = nodes_[i];
    TreeBody const& body = reduction_->tree().bodies[i];
    TreeFrame const& frame = state_->frames[i];
    if (body.carried()) {
      n.velocities = frame.velocities;
      n.s = frame.s;
    } else {
      n.velocities = int(velocities_of(body));
      for (int k = 0; k < n.velocities; ++k) n.s.col(k) = axis_of(i, k);
    }
    int const d = n.velocities;
    Mat6 const ks = n.k * n.s;
    double largest = 0.0;
    for (int r = 0; r < d; ++r)
      for (int c = 0; c < d; ++c) largest = std::max(largest, std::abs(n.inverse(r, c) = n.s.col(r).dot(ks.col(c))));
    if (int const bad = invert_with_pivots(n.inverse, d, largest); bad >= 0) return body.vn + bad;
    if (body.parent < 0) return -1;
    Mat6 shift = Mat6::Identity();  // X
    shift.template topRightCorner<3, 3>() = -skew<T>(frame.arm);
    Mat6 const kx = n.k * shift + n.c;
    for (int r = 0; r < d; ++r) {
      n.left.row(r) = n.s.col(r).transpose() * kx;
      n.right.col(r) = shift.transpose() * ks.col(r) + n.b * n.s.col(r);
    }
    Node& p = nodes_[std::size_t(body.parent)];
    p.k += shift.transpose() * kx + n.b * shift;
    for (int r = 0; r < d; ++r)
      for (int c = 0; c < d; ++c) p.k -= n.inverse(r, c) * n.right.col(r) * n.left.row(c);
    return -1;
  }

  /// Computes the joint velocities u and the twists x of all nodes for the generalised forces r and the node forces f.
  /// Overwrites f.
  template <class Out>
  void run(VecX const& r, Out&& u) {
    Sequence<TreeBody> const& bodies = reduction_->tree().bodies;
    for (std::size_t i = nodes_.size(); i-- > 0;) {
      Node& n = nodes_[i];
      Vec6 given = Vec6::Zero();
      for (int k = 0; k < n.velocities; ++k) given[k] = r[bodies[i].vn + k] + n.s.col(k).dot(n.f);
      n.u.setZero();
      n.add_answer(1.0, given);  // D⁻¹ (r + Sᵀf)
      if (bodies[i].parent < 0) continue;
      Vec6& f = nodes_[std::size_t(bodies[i].parent)].f;
      add_back<T>(n.f, state_->frames[i].arm, f);
      for (int k = 0; k < n.velocities; ++k) f -= n.u[k] * n.right.col(k);
    }
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      Node& n = nodes_[i];
      n.x.setZero();
      if (bodies[i].parent >= 0) {
        Vec6 const& p = nodes_[std::size_t(bodies[i].parent)].x;
        Vec6 by_parent = Vec6::Zero();
        for (int k = 0; k < n.velocities; ++k) by_parent[k] = n.left.row(k).dot(p);
        n.add_answer(-1.0, by_parent);
        add_carried<T>(p, state_->frames[i].arm, n.x);
      }
      for (int k = 0; k < n.velocities; ++k) {
        n.x += n.u[k] * n.s.col(k);
        u[bodies[i].vn + k] = n.u[k];
      }
    }
  }
  /// Row j of G x, with the twists x of the nodes.
  double row_times(Index j) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < nodes_.size(); ++i) sum += rows_[std::size_t(j)][i].dot(nodes_[i].x);
    return sum;
  }

  ReductionOf<> const* reduction_ = nullptr;
  TreeState const* state_ = nullptr;
  Sequence<Node> nodes_;
  Sequence<Index> owner_, row_of_;  // body of each full velocity; index of each equation among the remaining ones
  Sequence<Sequence<Vec6>> rows_;   // G: a row per remaining equation and body
  MatX answers_, schur_;
  VecX open_, lambda_, none_;
  DenseLu loops_;
  Index misplaced_ = -1;
};

}  // namespace polybody
