#pragma once
/// \file
/// Sparse equations that replace the dense equations in joint coordinates. The unknowns are the velocities of all
/// bodies, except velocities that linear joints make dependent, and the multipliers of all constraint equations except
/// those of linear joints. Matrix entries of dependent coordinates are distributed among the independent coordinates.

#include <array>

#include <polybody/elimination/reduced_sink.hpp>
#include <polybody/elimination/reduction.hpp>
#include <polybody/math/sequence.hpp>

namespace polybody::detail {

/// Sparse equations of all bodies. As a template, the class is compiled only in programs with joint coordinates.
template <class = void>
class BodyEquationsOf {
 public:
  BodyEquationsOf() = default;
  BodyEquationsOf(ReductionOf<> const& reduction, Sequence<LinearConstraints> const& linear_rows, Index full_velocities,
                  Index full_constraints)
      : full_velocities_(full_velocities) {
    Index const nv = full_velocities;
    Sequence<Sequence<UnknownMap::Target>> targets(std::size_t(nv + full_constraints));
    Sequence<bool> dependent(std::size_t(nv), false);
    for (auto const& d : reduction.linear().dependents()) dependent[std::size_t(d.v)] = true;
    for (Index i = 0; i < nv; ++i)
      if (!dependent[std::size_t(i)]) targets[std::size_t(i)].push_back({velocities_++, 1.0});
    for (auto const& d : reduction.linear().dependents())
      for (auto const& t : d.terms) {
        Index const to = targets[std::size_t(t.v)][0].unknown;
        targets[std::size_t(d.v)].push_back({to, t.factor});
        dependents_.push_back({d.v, to, t.factor});
      }
    Sequence<bool> linear(std::size_t(full_constraints), false);
    for (LinearConstraints const& rows : linear_rows)
      for (Index i = 0; i < rows.rows(); ++i) linear[std::size_t(rows.row + i)] = true;
    for (Index i = 0; i < full_constraints; ++i)
      if (!linear[std::size_t(i)]) targets[std::size_t(nv + i)].push_back({velocities_ + rows_++, 1.0});
    map_ = UnknownMap(std::move(targets));
    for (Index i = 0; i < nv + full_constraints; ++i)
      of_.push_back(i < nv && dependent[std::size_t(i)] ? -1 : map_.run(i, 1));
    rows_that_stay_ = reduction.remaining_equations();
    Sequence<bool> stays(std::size_t(full_constraints), false);
    for (Index const i : rows_that_stay_) stays[std::size_t(i)] = true;
    for (Index i = 0; i < full_constraints; ++i)
      if (!stays[std::size_t(i)] && of_[std::size_t(nv + i)] >= 0) carrying_rows_.push_back(i);
  }

  Index size() const { return velocities_ + rows_; }
  Index velocities() const { return velocities_; }
  /// Indices, in the model, of the constraint equations of joints with joint coordinates.
  Sequence<Index> const& eliminated_equations() const { return carrying_rows_; }
  /// For each reduced equation: index of its unknown among the full unknowns.
  Sequence<Index> full_unknowns() const {
    Sequence<Index> out(std::size_t(size()), -1);
    for (Index i = Index(of_.size()); i-- > 0;)
      if (Index const at = of_[std::size_t(i)]; at >= 0) out[std::size_t(at)] = i;
    return out;
  }

  void write(BlockWriter const& write_full, BlockSink& sink) {
    std::uint64_t const layout = sink.slots().layout;
    for (ReducedSlotsOf<>& slots : slots_)
      if (layout != 0 && slots.leads_to(layout)) {
        slots.begin();
        BlockSink full(slots);
        return write_full(full);
      }
    ReducedSlotsOf<>* const slots = layout != 0 ? &slots_[next_slots_] : nullptr;
    if (slots) slots->record(sink.slots());
    ReducedSinkOf<> mapped(map_, mapped_, sink, slots);
    BlockSink full(mapped);
    write_full(full);
    if (!mapped.recorded()) return;
    slots->complete();
    next_slots_ = (next_slots_ + 1) % slots_.size();
  }

  /// Sets the entries of `out` for velocities to factor · Tᵀ `full`, where T gives all velocities from the independent
  /// ones. Other entries are unchanged.
  void from_velocities(VecX const& full, double factor, VecX& out) const {
    for (Index i = 0; i < full.size(); ++i)
      if (Index const to = of_[std::size_t(i)]; to >= 0) out[to] = factor * full[i];
    for (Dependent const& d : dependents_) out[d.to] += factor * d.factor * full[d.from];
  }
  /// Sets the entries of `out` for constraint equations: `rows` for the remaining equations, zero for joints with joint
  /// coordinates.
  void from_rows(double const* rows, VecX& out) const {
    for (Index i = velocities_; i < out.size(); ++i) out[i] = 0.0;
    for (std::size_t i = 0; i < rows_that_stay_.size(); ++i) out[of_row(rows_that_stay_[i])] = rows[i];
  }
  /// Computes the full velocities of a `solution`. Dependent velocities are set to zero.
  void to_velocities(VecX const& solution, VecX& full) const {
    for (Index i = 0; i < full.size(); ++i) {
      Index const from = of_[std::size_t(i)];
      full[i] = from >= 0 ? solution[from] : 0.0;
    }
  }
  void to_rows(VecX const& solution, double* out) const { take(rows_that_stay_, solution, out); }
  void to_eliminated_equations(VecX const& solution, double* out) const { take(carrying_rows_, solution, out); }

 private:
  /// Term of a dependent velocity.
  struct Dependent {
    Index from, to;  // full velocity, equation of the independent velocity
    double factor;
  };
  Index of_row(Index row) const { return of_[std::size_t(full_velocities_ + row)]; }
  void take(Sequence<Index> const& rows, VecX const& solution, double* out) const {
    for (std::size_t i = 0; i < rows.size(); ++i) out[i] = solution[of_row(rows[i])];
  }

  Index full_velocities_ = 0, velocities_ = 0, rows_ = 0;
  UnknownMap map_;
  Sequence<Index> of_, rows_that_stay_,
      carrying_rows_;  // of_: equation of each full unknown; −1 if it is distributed or omitted
  Sequence<Dependent> dependents_;
  MappedBlocks mapped_;
  // Destinations of the blocks in the last four solvers that received the matrix.
  std::array<ReducedSlotsOf<>, 4> slots_;
  std::size_t next_slots_ = 0;
};

}  // namespace polybody::detail
