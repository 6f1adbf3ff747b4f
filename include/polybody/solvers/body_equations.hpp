#pragma once
/// \file
/// The sparse equations that are solved in place of those in joint coordinates: of all bodies, with the rows of the
/// joints that carry them. Dependents of linear joints are spread, the rows of these are left out.

#include <array>

#include <polybody/math/sequence.hpp>
#include <polybody/system/mapped_sink.hpp>
#include <polybody/system/reduction.hpp>

namespace polybody::detail {

/// A template, so that a program without them compiles none of it.
template <class = void>
class BodyEquationsOf {
 public:
  BodyEquationsOf() = default;
  BodyEquationsOf(ReductionOf<> const& reduction, Sequence<LinearRows> const& linear_rows, Index whole_speeds,
                  Index whole_rows)
      : whole_speeds_(whole_speeds) {
    Index const nv = whole_speeds;
    Sequence<Sequence<UnknownMap::Target>> targets(std::size_t(nv + whole_rows));
    Sequence<bool> dependent(std::size_t(nv), false);
    for (auto const& d : reduction.linear().dependents()) dependent[std::size_t(d.v)] = true;
    for (Index i = 0; i < nv; ++i)
      if (!dependent[std::size_t(i)]) targets[std::size_t(i)].push_back({speeds_++, 1.0});
    for (auto const& d : reduction.linear().dependents())
      for (auto const& t : d.terms)
        targets[std::size_t(d.v)].push_back({targets[std::size_t(t.v)][0].unknown, t.factor});
    Sequence<bool> linear(std::size_t(whole_rows), false);
    for (LinearRows const& rows : linear_rows)
      for (Index i = 0; i < rows.rows(); ++i) linear[std::size_t(rows.row + i)] = true;
    for (Index i = 0; i < whole_rows; ++i)
      if (!linear[std::size_t(i)]) targets[std::size_t(nv + i)].push_back({speeds_ + rows_++, 1.0});
    map_ = UnknownMap(std::move(targets));
    for (Index i = 0; i < nv + whole_rows; ++i) of_.push_back(map_.run(i, 1));
    rows_that_stay_ = reduction.rows_that_stay();
    Sequence<bool> stays(std::size_t(whole_rows), false);
    for (Index const i : rows_that_stay_) stays[std::size_t(i)] = true;
    for (Index i = 0; i < whole_rows; ++i)
      if (!stays[std::size_t(i)] && of_[std::size_t(nv + i)] >= 0) carrying_rows_.push_back(i);
  }

  Index size() const { return speeds_ + rows_; }
  Index speeds() const { return speeds_; }
  /// Rows of the joints that carry bodies, by their number in the model.
  Sequence<Index> const& carrying_rows() const { return carrying_rows_; }
  /// The whole unknown behind each equation.
  Sequence<Index> whole_unknowns() const {
    Sequence<Index> out(std::size_t(size()), -1);
    for (Index i = Index(of_.size()); i-- > 0;)
      if (Index const at = of_[std::size_t(i)]; at >= 0) out[std::size_t(at)] = i;
    return out;
  }

  void write(BlockWriter const& write_whole, BlockSink& sink) {
    std::uint64_t const layout = sink.slots().layout;
    for (MappedSlotsOf<>& slots : slots_)
      if (layout != 0 && slots.leads_to(layout)) {
        slots.begin();
        BlockSink whole(slots);
        return write_whole(whole);
      }
    MappedSlotsOf<>* const slots = layout != 0 ? &slots_[next_slots_] : nullptr;
    if (slots) slots->record(sink.slots());
    MappedSinkOf<> mapped(map_, mapped_, sink, slots);
    BlockSink whole(mapped);
    write_whole(whole);
    if (!mapped.recorded()) return;
    slots->complete();
    next_slots_ = (next_slots_ + 1) % slots_.size();
  }

  /// out = factor · a vector by whole speeds; rows are left as they are.
  void from_speeds(VecX const& whole, double factor, VecX& out) const {
    for (Index i = 0; i < whole.size(); ++i)
      if (Index const to = of_[std::size_t(i)]; to >= 0) out[to] = factor * whole[i];
  }
  /// The rows that stay, from `rows`; zero for those of the joints that carry.
  void from_rows(double const* rows, VecX& out) const {
    for (Index i = speeds_; i < out.size(); ++i) out[i] = 0.0;
    for (std::size_t i = 0; i < rows_that_stay_.size(); ++i) out[of_row(rows_that_stay_[i])] = rows[i];
  }
  /// By whole speeds; zero for what is spread.
  void to_speeds(VecX const& solution, VecX& whole) const {
    for (Index i = 0; i < whole.size(); ++i) {
      Index const from = of_[std::size_t(i)];
      whole[i] = from >= 0 ? solution[from] : 0.0;
    }
  }
  void to_rows(VecX const& solution, double* out) const { take(rows_that_stay_, solution, out); }
  void to_carrying_rows(VecX const& solution, double* out) const { take(carrying_rows_, solution, out); }

 private:
  Index of_row(Index row) const { return of_[std::size_t(whole_speeds_ + row)]; }
  void take(Sequence<Index> const& rows, VecX const& solution, double* out) const {
    for (std::size_t i = 0; i < rows.size(); ++i) out[i] = solution[of_row(rows[i])];
  }

  Index whole_speeds_ = 0, speeds_ = 0, rows_ = 0;
  UnknownMap map_;
  Sequence<Index> of_, rows_that_stay_,
      carrying_rows_;  // of_: place of a whole unknown, −1 where it is spread or left out
  MappedBlocks mapped_;
  std::array<MappedSlotsOf<>, 4> slots_;  // of the solvers that were written to last
  std::size_t next_slots_ = 0;
};

}  // namespace polybody::detail
