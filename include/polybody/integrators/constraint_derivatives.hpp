#pragma once
/// \file
/// Derivatives ∂Φ̈/∂q and ∂Φ̈/∂v of the constraint accelerations by finite differences, also in joint coordinates.

#include <algorithm>

#include <polybody/integrators/newton_failure.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/system/system.hpp>

namespace polybody::detail {

// Converts constraint equations in joint velocities to equations in the velocities of all bodies of a tree.

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
    frozen_ = coordinates_->make_frozen();
    unit_.setZero(system.size());
    equation_.setZero(layout.equations);
    find_bodies(system);
    rows_.assign(std::size_t(system.rows()), {});
    Sequence<Sequence<char>> const touched = bodies_of_rows(system, equations);
    Sequence<Sequence<char>> columns(rows_.size(), Sequence<char>(bodies_.size(), 0));
    VecX u = VecX::Zero(layout.velocities), full = VecX::Zero(system.layout().velocities);
    frozen_->freeze();
    for (Index j = 0; j < layout.velocities; ++j) {
      u[j] = unit_[j] = 1.0;
      coordinates_->expand_rates(u, false, full);
      frozen_->to_equations(unit_, equation_);
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

  /// Stores the state of the last `expand` for `write`.
  void hold() { frozen_->freeze(); }
  /// Adds row i to `sink`; its entries for the velocities `velocities(i)` are `row`. In the sink, `row0` is
  /// the row of the first equation, and `col0` is the column of the first unknown.
  template <class = void>  // compiled only if used
  void write(Index i, double const* row, Index row0, Index col0, BlockSink& sink) {
    Row const& r = rows_[std::size_t(i)];
    for (std::size_t k = 0; k < r.velocities.size(); ++k) unit_[r.velocities[k]] = row[k];
    frozen_->to_equations(unit_, equation_);
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
  std::shared_ptr<FrozenMaps> frozen_;
  Sequence<Part> bodies_;
  Sequence<Row> rows_;
  VecX unit_, equation_;
};

}  // namespace polybody::detail

namespace polybody {

/// Derivatives ∂Φ̈/∂q and ∂Φ̈/∂v of Φ̈ = G v̇ + γ with respect to the unknowns of a time step, by finite differences. They
/// have the block pattern of G. Velocities without a common constraint equation are perturbed together [Curtis, Powell
/// & Reid 1974], so the cost does not grow with the number of joints. With joint coordinates, the cost grows with the
/// number of joints between the root and the bodies of a constraint equation.
class ConstraintDerivatives {
 public:
  /// Reads the block pattern of G. The system must have been evaluated before.
  template <class = void>  // compiled only if used
  void analyse(System& system) {
    blocks_.clear();
    velocities_ = system.velocities();
    entries_ = 0;
    in_tree_ = detail::TreeRows::are_in(system);
    PatternSink pattern;
    system.masses(pattern);
    if (in_tree_) {
      tree_.analyse(system, pattern.blocks);
      for (Index i = 0; i < system.rows(); ++i)
        for (Index const j : tree_.velocities(i)) add_place({i, j, 1, 1});
    } else {
      for (Block const& b : pattern.blocks)
        if (b.row >= velocities_ && b.col < velocities_) add_place({b.row - velocities_, b.col, b.rows, b.cols});
    }
    by_q_.assign(std::size_t(entries_), 0.0);
    by_v_ = by_q_;
    give_colours(system.rows());
    step_.setZero(velocities_);
    q_.setZero(system.coordinates());
    v_ = step_;
    here_.setZero(system.rows());
    gamma_ = there_ = here_;
  }

  /// Computes the derivatives at q, v, v̇ = `vd` and t. The last evaluation of `system` is then at another state.
  template <class = void>  // compiled only if used
  void measure(System& system, VecX const& q, VecX const& v, VecX const& vd, double t) {
    if (colours_ == 0) return;
    system.evaluate(q, v, t);
    rates(system, vd, here_);
    double const size = std::sqrt(std::numeric_limits<double>::epsilon()), of_v = size * (1.0 + largest_size(v));
    for (int colour = 0; colour < colours_; ++colour) {
      for (Index k = 0; k < velocities_; ++k) step_[k] = colour_[std::size_t(k)] == colour ? size : 0.0;
      system.plus(q, step_, q_);
      system.evaluate(q_, v, t);
      rates(system, vd, there_);
      take(colour, size, by_q_);
      for (Index k = 0; k < velocities_; ++k) v_[k] = v[k] + step_[k] * (of_v / size);
      system.evaluate(q, v_, t);
      rates(system, vd, there_);
      take(colour, of_v, by_v_);
    }
  }

  /// Adds cv ∂Φ̈/∂v + cq ∂Φ̈/∂q of the last `measure` to `sink`, at the state of the last evaluation of the system.
  /// `row0` is the row of the first constraint equation in `sink`, and `col0` is the column of the first velocity. If
  /// the equations include the bodies of a tree, `row0` is the row of the first equation instead.
  template <class = void>  // compiled only if used
  void write(double cv, double cq, Index row0, Index col0, BlockSink& sink) {
    if (in_tree_) tree_.hold();
    for (std::size_t k = 0; k < blocks_.size();) {
      auto const& [b, first] = blocks_[k];
      // the entries of one row of the tree are contiguous
      Index const count = in_tree_ ? Index(tree_.velocities(b.row).size()) : b.rows * b.cols;
      sum_.resize(std::size_t(count));
      for (std::size_t i = 0; i < sum_.size(); ++i)
        sum_[i] = cv * by_v_[std::size_t(first) + i] + cq * by_q_[std::size_t(first) + i];
      if (in_tree_)
        tree_.write(b.row, sum_.data(), row0, col0, sink);
      else
        sink.add(row0 + b.row, col0 + b.col, BlockView(sum_.data(), b.rows, b.cols, 1, b.rows));
      k += in_tree_ ? std::size_t(count) : 1;
    }
  }
  /// True if `row0` of `write` is the row of the first equation, not of the first constraint equation.
  bool counts_equations() const { return in_tree_; }

 private:
  struct Place {
    Block block;
    Index first;
  };

  void add_place(Block const& block) {
    blocks_.push_back({block, entries_});
    entries_ += block.rows * block.cols;
  }

  /// Assigns to each velocity the first colour that no other velocity of its constraint equations has.
  template <class = void>
  void give_colours(Index rows) {
    Sequence<Sequence<Index>> velocities_of, rows_of;
    velocities_of.resize(std::size_t(rows));
    rows_of.resize(std::size_t(velocities_));
    for (Place const& p : blocks_)
      for (Index i = p.block.row; i < p.block.row + p.block.rows; ++i)
        for (Index j = p.block.col; j < p.block.col + p.block.cols; ++j) {
          velocities_of[std::size_t(i)].push_back(j);
          rows_of[std::size_t(j)].push_back(i);
        }
    colour_.assign(std::size_t(velocities_), 0);
    colours_ = 0;
    for (Index k = 0; k < velocities_; ++k) {
      Sequence<char> taken(std::size_t(colours_) + 1, 0);
      for (Index const i : rows_of[std::size_t(k)])
        for (Index const j : velocities_of[std::size_t(i)])
          if (j < k) taken[std::size_t(colour_[std::size_t(j)])] = 1;
      int colour = 0;
      while (taken[std::size_t(colour)]) ++colour;
      colour_[std::size_t(k)] = colour;
      colours_ = std::max(colours_, colour + 1);
    }
  }
  template <class = void>
  void rates(System& system, VecX const& vd, VecX& out) {
    system.rows_times(vd, out);
    system.acceleration_bias(gamma_);
    for (Index i = 0; i < out.size(); ++i) out[i] += gamma_[i];
  }
  template <class = void>
  void take(int colour, double step, Sequence<double>& slopes) const {
    for (auto const& [b, first] : blocks_)
      for (Index j = 0; j < b.cols; ++j)
        if (colour_[std::size_t(b.col + j)] == colour)
          for (Index i = 0; i < b.rows; ++i)
            slopes[std::size_t(first + j * b.rows + i)] = (there_[b.row + i] - here_[b.row + i]) / step;
  }

  Index velocities_ = 0, entries_ = 0;
  int colours_ = 0;
  bool in_tree_ = false;  ///< true if the equations include all bodies of a tree
  detail::TreeRows tree_;
  Sequence<Place> blocks_;
  Sequence<int> colour_;  ///< colour of each velocity
  Sequence<double> by_q_, by_v_, sum_;
  VecX step_, q_, v_, here_, there_, gamma_;
};

}  // namespace polybody
