#pragma once
/// \file
/// Search for redundant and contradictory constraint equations of a model: `redundancy`. The rank of G follows from a
/// sparse rank-revealing QR factorisation of Gᵀ.
/// Theory: Eqs. 7.11, 7.12.

#include <Eigen/SparseQR>
#include <algorithm>

#include <polybody/run/initial_conditions.hpp>
#include <polybody/run/private_rows.hpp>
#include <polybody/run/redundant_rows.hpp>

namespace polybody {

/// Rank and contradictions of a model's constraint equations at a state.
struct Redundancy {
  /// A joint and the number of its redundant equations.
  struct Share {
    std::string name;  ///< joint "a"
    Index rows;        ///< number of its redundant equations
  };
  Index rows = 0;                ///< constraint equations
  Index rank = 0;                ///< rank of G
  Index degrees_of_freedom = 0;  ///< generalised velocities of bodies − rank, at this state
  /// Joints with equations that are linear combinations of equations of joints connected earlier, or of other equations
  /// of the same joint.
  std::vector<Share> repeated = {};
  /// Groups of joints (joint "a", joint "b", …) whose redundant equations contradict each other: no small displacement
  /// satisfies them, or no velocities, or no accelerations.
  std::vector<std::string> in_positions = {}, in_velocities = {}, in_accelerations = {};  ///< one text per group
  /// True if no equations contradict each other.
  bool consistent() const { return in_positions.empty() && in_velocities.empty() && in_accelerations.empty(); }
};

namespace detail {

/// Extracts Gᵀ from the blocks of a tangent matrix.
template <class = void>  // compiled only if used
struct ConstraintSink {
  Index velocities;
  std::vector<Eigen::Triplet<double>>& entries;
  void add(Index row, Index col, BlockView const& b) {
    if (row >= velocities || col < velocities) return;
    for (Index j = 0; j < b.cols; ++j)
      for (Index i = 0; i < b.rows; ++i)
        if (b(i, j) != 0.0) entries.emplace_back(int(row + i), int(col - velocities + j), b(i, j));
  }
};

/// Rank-revealing factorisation Gᵀ P = Q [R₁, R₂; 0, 0] with a permutation P. The size of R₁ is the rank. The last rows
/// of PᵀG depend on the first ones: Gᵀc = 0 for each column c of P [−R₁⁻¹R₂; 1]. Columns of G (velocities) are scaled
/// first, then rows, so that every row has the norm 1 in any units. A row is redundant if its distance from the span of
/// the rows before it is less than `threshold`.
template <class Ordering = Eigen::NaturalOrdering<int>>  // natural ordering: the later of two dependent joints is named
class ConstraintFactor {
 public:
  static constexpr double threshold = 1e-6;

  /// \param bodies bodies of the model; rows that `RepeatedRows` finds redundant or `PrivateRows` finds independent are
  /// then not factorised. Empty to factorise all rows
  ConstraintFactor(Index velocities, Index rows, std::vector<Eigen::Triplet<double>> const& entries,
                   Sequence<BodyLayout> const& bodies = {})
      : scale_(std::size_t(rows), 0.0) {
    Sequence<RowEntry> const all = scaled_entries(velocities, entries);
    Sequence<char> removed(std::size_t(rows), 0);
    if (!bodies.empty()) leave_out(bodies, all, removed);
    Sequence<int> column, place(std::size_t(velocities), -1);  // column of each row, row of each velocity
    for (Index i = 0; i < rows; ++i) {
      column.push_back(removed[std::size_t(i)] ? -1 : int(stays_.size()));
      if (!removed[std::size_t(i)]) stays_.push_back(i);
    }
    for (RowEntry const& e : all)
      if (!removed[std::size_t(e.row)]) place[std::size_t(e.velocity)] = 0;
    Index touched = 0;
    for (int& p : place) p = p < 0 ? -1 : int(touched++);
    std::vector<Eigen::Triplet<double>> kept;
    for (RowEntry const& e : all)
      if (!removed[std::size_t(e.row)])
        kept.emplace_back(place[std::size_t(e.velocity)], column[std::size_t(e.row)], e.value);
    Eigen::SparseMatrix<double> transposed(touched, Index(stays_.size()));
    transposed.setFromTriplets(kept.begin(), kept.end());
    qr_.setPivotThreshold(threshold);
    if (touched > 0) qr_.compute(transposed);
    rank_ = touched > 0 ? qr_.rank() : 0;
    find_relations();
  }

  Index rank() const { return Index(scale_.size()) - repeated(); }
  Index repeated() const { return Index(relations_.size()); }
  Index factored() const { return Index(stays_.size()); }  ///< number of rows in the factorisation
  /// Index of the k-th redundant row, in ascending order.
  Index row(Index k) const { return relations_[std::size_t(k)].row; }
  /// Null vector c of the k-th redundant row, for scaled rows; c = 1 at this row.
  IndexMap<double> const& scaled_relation(Index k) const { return relations_[std::size_t(k)].c; }
  /// Null vector c of the k-th redundant row.
  IndexMap<double> relation(Index k) const {
    IndexMap<double> c;
    for (auto const& [i, value] : scaled_relation(k)) c[i] = scale_[std::size_t(i)] * value;
    return c;
  }

 private:
  using Qr = Eigen::SparseQR<Eigen::SparseMatrix<double>, Ordering>;

  /// Entries of G after the scaling of columns, then of rows, to the norm 1. Stores the factors of the rows in
  /// `scale_`.
  Sequence<RowEntry> scaled_entries(Index velocities, std::vector<Eigen::Triplet<double>> const& entries) {
    std::vector<double> of_velocity(std::size_t(velocities), 0.0);
    for (auto const& e : entries)
      of_velocity[std::size_t(e.row())] = std::hypot(of_velocity[std::size_t(e.row())], e.value());
    auto const scaled = [&](auto const& e) { return e.value() / of_velocity[std::size_t(e.row())]; };
    for (auto const& e : entries) scale_[std::size_t(e.col())] = std::hypot(scale_[std::size_t(e.col())], scaled(e));
    for (double& s : scale_) s = s > 0.0 ? 1.0 / s : 1.0;
    Sequence<RowEntry> all;
    for (auto const& e : entries)
      all.push_back({Index(e.col()), Index(e.row()), scaled(e) * scale_[std::size_t(e.col())]});
    return all;
  }
  /// Marks the rows that need no factorisation.
  void leave_out(Sequence<BodyLayout> const& bodies, Sequence<RowEntry> const& all, Sequence<char>& removed) {
    relations_ = RepeatedRows<>(bodies, Index(removed.size()), all, threshold).relations();
    for (RowRelation const& r : relations_) removed[std::size_t(r.row)] = 1;
    Sequence<RowEntry> left;
    for (RowEntry const& e : all)
      if (!removed[std::size_t(e.row)]) left.push_back(e);
    PrivateRows<> const own(bodies, Index(removed.size()), left);
    for (Index i = 0; i < Index(removed.size()); ++i) removed[std::size_t(i)] |= char(own[i]);
  }
  /// Computes the null vectors c = P [−R₁⁻¹R₂; 1]. Each back substitution visits only the nonzero entries of c, in
  /// descending order.
  void find_relations() {
    auto const& r = qr_.matrixR();
    Sequence<double> x(std::size_t(rank_), 0.0);
    Sequence<Index> waiting;
    Sequence<char> waits(std::size_t(rank_), 0);
    auto const add = [&](Index i, double value) {
      x[std::size_t(i)] += value;
      if (waits[std::size_t(i)]) return;
      waits[std::size_t(i)] = 1;
      waiting.push_back(i);
      std::push_heap(waiting.begin(), waiting.end());
    };
    for (Index k = rank_; k < factored(); ++k) {
      RowRelation relation{original(k)};
      relation.c[relation.row] = 1.0;
      if (rank_ > 0)
        for (typename Qr::QRMatrixType::InnerIterator e(r, k); e; ++e)
          if (e.row() < rank_) add(e.row(), e.value());
      while (!waiting.empty()) {
        std::pop_heap(waiting.begin(), waiting.end());
        Index const j = waiting.back();
        waiting.pop_back();
        double pivot = 0.0;
        for (typename Qr::QRMatrixType::InnerIterator e(r, j); e; ++e) pivot = e.row() == j ? e.value() : pivot;
        double const value = x[std::size_t(j)] / pivot;
        x[std::size_t(j)] = 0.0;
        waits[std::size_t(j)] = 0;
        if (value == 0.0) continue;
        relation.c[original(j)] = -value;
        for (typename Qr::QRMatrixType::InnerIterator e(r, j); e; ++e)
          if (e.row() < j) add(e.row(), -e.value() * value);
      }
      relations_.push_back(std::move(relation));
    }
    std::sort(relations_.begin(), relations_.end(),
              [](RowRelation const& a, RowRelation const& b) { return a.row < b.row; });
  }
  /// Row of G in column j of the factor.
  Index original(Index j) const { return stays_[std::size_t(rank_ > 0 ? qr_.colsPermutation().indices()[j] : j)]; }

  std::vector<double> scale_;
  Sequence<Index> stays_;  // factorised rows, ascending
  Qr qr_;
  Index rank_ = 0;  // rank of the factorised rows
  Sequence<RowRelation> relations_;
};

}  // namespace detail

/// Counts the redundant constraint equations of a model at x (coordinates, velocities and time) and names their joints,
/// with a separate factorisation. A run selects the equations to drop by the same rule, except that it keeps equations
/// that are redundant only at x (`leave_out_redundant`). A contradiction in positions is found to first order: call
/// this function at the final state of `assemble`.
/// \throws InvalidInput for a state of another model.
template <class = void>
Redundancy redundancy(System& system, State const& x) {
  require_fitting(system, x);
  require_places(system, x);
  system.evaluate(x.q, x.v, x.t);
  std::vector<Eigen::Triplet<double>> entries;
  detail::ConstraintSink<> sink{system.velocities(), entries};
  VecX phi = VecX::Zero(system.rows()), rate = phi, gamma = phi;
  system.masses(sink);
  detail::ConstraintFactor<> const factor(system.velocities(), system.rows(), entries,
                                          system.step_coordinates() ? Sequence<BodyLayout>() : system.layout().bodies);
  system.violation(phi);
  system.violation_rate(rate);
  system.acceleration_bias(gamma);

  Redundancy out{.rows = system.rows(),
                 .rank = factor.rank(),
                 .degrees_of_freedom = system.layout().body_velocities() - factor.rank()};
  Sequence<IndexMap<double>> null_vectors;
  detail::ContradictionLimits const limits;
  double const in_velocities = limits.relative * (1.0 + largest_size(x.v)),
               in_accelerations = limits.relative * (1.0 + largest_size(gamma));
  for (Index k = 0; k < factor.repeated(); ++k) {
    IndexMap<double> const c = factor.relation(k);
    null_vectors.push_back(factor.scaled_relation(k));
    double const largest = largest_size(c);
    auto const compare = [&](VecX const& b, double limit, std::vector<std::string>& found) {
      double sum = 0.0;
      for (auto const& [i, value] : c) sum += value * b[i];
      if (std::abs(sum) <= limit * largest) return;
      VecX all = VecX::Zero(system.rows());
      for (auto const& [i, value] : c) all[i] = value;
      found.push_back(detail::names_in(system, all));
    };
    compare(phi, limits.position, out.in_positions);
    compare(rate, in_velocities, out.in_velocities);
    compare(gamma, in_accelerations, out.in_accelerations);
  }
  ModelLayout const& layout = system.layout();
  Sequence<Index> const joint_of = system.step_coordinates() ? Sequence<Index>() : layout.joint_of_rows();
  for (Index const row : detail::choose_redundant(null_vectors, {})) {
    Index const joint = std::size_t(row) < joint_of.size() ? joint_of[std::size_t(row)] : -1;
    std::string const name =
        joint >= 0 ? layout.joints[std::size_t(joint)].title() : system.name_of(system.velocities() + row);
    if (out.repeated.empty() || out.repeated.back().name != name) out.repeated.push_back({name, 0});
    ++out.repeated.back().rows;
  }
  return out;
}

/// Counts the redundant constraint equations of a model at x and names their joints. \throws InvalidInput for a state
/// of another model.
template <class M>
Redundancy redundancy(M const& model, State const& x) {
  System system(model, with<Capabilities::motion>);
  return redundancy(system, x);
}

}  // namespace polybody
