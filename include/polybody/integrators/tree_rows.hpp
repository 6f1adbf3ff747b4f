#pragma once
/// \file
/// Constraint equations in joint coordinates, as equations in the velocities of all bodies of a tree.

#include <algorithm>

#include <polybody/math/sequence.hpp>
#include <polybody/system/system.hpp>

namespace polybody::detail {

/// Expresses rows A u̇ in joint velocities u as rows f v̇ in the velocities v of all bodies, with v̇ = T u̇ and f T =
/// A. The equations of all bodies include the constraint equations of the tree. Therefore f v̇ = A u̇ for every
/// solution.
class TreeRows {
 public:
  /// True if the equations of the system contain the velocities of all bodies of a tree.
  static bool are_in(System const& system) {
    return system.step_coordinates() && !system.step_coordinates().reduced->eliminated_equations.empty();
  }

  /// Finds the velocities of a time step that each row depends on: those that move a body of the row.
  template <class = void>  // compiled only if used
  void analyse(System& system, Sequence<Block> const& equations) {
    coordinates_ = system.step_coordinates();
    ReducedLayout const& layout = *coordinates_.reduced;
    frozen_ = coordinates_.entries->make_frozen_state(coordinates_.self.get());
    unit_.setZero(system.size());
    equation_.setZero(layout.equations);
    find_bodies(system);
    rows_.assign(std::size_t(system.rows()), {});
    Sequence<Sequence<char>> const touched = bodies_of_rows(system, equations);
    Sequence<Sequence<char>> columns(rows_.size(), Sequence<char>(bodies_.size(), 0));
    VecX u = VecX::Zero(layout.velocities), full = VecX::Zero(system.layout().velocities);
    coordinates_.entries->freeze(coordinates_.self.get(), frozen_.get());
    for (Index j = 0; j < layout.velocities; ++j) {
      u[j] = unit_[j] = 1.0;
      coordinates_.entries->expand_rates(coordinates_.self.get(), u, false, full);
      coordinates_.entries->to_equations(coordinates_.self.get(), frozen_.get(), unit_, equation_);
      u[j] = unit_[j] = 0.0;
      for (std::size_t i = 0; i < rows_.size(); ++i) {
        bool moves = false;
        for (std::size_t k = 0; k < bodies_.size() && !moves; ++k)
          moves = touched[i][k] && has_entry(full, system.layout().bodies[k].v0, system.layout().bodies[k].velocities);
        if (!moves) continue;
        rows_[i].velocities.push_back(j);
        for (std::size_t k = 0; k < bodies_.size(); ++k)
          columns[i][k] |= char(has_entry(equation_, bodies_[k].first, bodies_[k].count));
      }
    }
    for (std::size_t i = 0; i < rows_.size(); ++i)
      for (std::size_t k = 0; k < bodies_.size(); ++k)
        if (columns[i][k]) rows_[i].columns.push_back(bodies_[k]);
  }

  /// Velocities of a time step that row i depends on, ascending.
  Sequence<Index> const& velocities(Index i) const { return rows_[std::size_t(i)].velocities; }

  /// Stores the positions of the last evaluation of the system for `write`.
  void hold() { coordinates_.entries->freeze(coordinates_.self.get(), frozen_.get()); }
  /// Adds row i with the entries `row` at `velocities(i)` to `sink`. `row0` and `col0` are the row and column of the
  /// first equation and of the first unknown in the sink.
  template <class = void>  // compiled only if used
  void write(Index i, double const* row, Index row0, Index col0, BlockSink& sink) {
    Row const& r = rows_[std::size_t(i)];
    for (std::size_t k = 0; k < r.velocities.size(); ++k) unit_[r.velocities[k]] = row[k];
    coordinates_.entries->to_equations(coordinates_.self.get(), frozen_.get(), unit_, equation_);
    for (Index const j : r.velocities) unit_[j] = 0.0;
    for (Part const& part : r.columns)
      sink.add(row0 + r.equation, col0 + part.first, BlockView(equation_.data() + part.first, 1, part.count, 1, 1));
  }

 private:
  /// Contiguous range of unknowns of the equations.
  struct Part {
    Index first = 0, count = 0;
  };
  struct Row {
    Index equation = 0;               ///< index of the equation
    Sequence<Index> velocities = {};  ///< velocities of a time step, ascending
    Sequence<Part> columns = {};      ///< columns of the bodies with entries in f
  };

  static bool has_entry(VecX const& x, Index first, Index count) {
    return std::any_of(x.data() + first, x.data() + first + count, [](double y) { return y != 0.0; });
  }
  void find_bodies(System const& system) {
    Sequence<BodyLayout> const& bodies = system.layout().bodies;
    bodies_.assign(bodies.size(), {});
    for (Index e = coordinates_.reduced->equation_velocities; e-- > 0;) {
      Index const full = coordinates_.reduced->full_unknown[std::size_t(e)];
      for (std::size_t k = 0; k < bodies.size(); ++k)
        if (full >= bodies[k].v0 && full < bodies[k].v0 + bodies[k].velocities) bodies_[k] = {e, bodies_[k].count + 1};
    }
  }
  /// Flags by rows of a time step and by bodies: true if the row contains the body. Also stores the equation of each
  /// row.
  Sequence<Sequence<char>> bodies_of_rows(System const& system, Sequence<Block> const& equations) {
    ReducedLayout const& layout = *coordinates_.reduced;
    Sequence<Index> const& stay = layout.remaining_equations;
    Sequence<Sequence<char>> out(rows_.size(), Sequence<char>(bodies_.size(), 0));
    Sequence<Index> row_of(std::size_t(layout.equations), -1);
    for (Index e = layout.equation_velocities; e < layout.equations; ++e) {
      Index const row = layout.full_unknown[std::size_t(e)] - system.layout().velocities;
      auto const at = std::lower_bound(stay.begin(), stay.end(), row);
      if (at == stay.end() || *at != row) continue;
      row_of[std::size_t(e)] = Index(at - stay.begin());
      rows_[std::size_t(at - stay.begin())].equation = e;
    }
    for (Block const& b : equations)
      for (Index e = b.row; e < b.row + b.rows; ++e)
        for (std::size_t k = 0; k < bodies_.size() && row_of[std::size_t(e)] >= 0; ++k)
          if (b.col < bodies_[k].first + bodies_[k].count && b.col + b.cols > bodies_[k].first)
            out[std::size_t(row_of[std::size_t(e)])][k] = 1;
    return out;
  }

  Coordinates coordinates_;
  FrozenState frozen_;
  Sequence<Part> bodies_;
  Sequence<Row> rows_;
  VecX unit_, equation_;
};

}  // namespace polybody::detail
