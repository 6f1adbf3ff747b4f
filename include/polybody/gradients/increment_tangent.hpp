#pragma once
/// \file
/// Effect of ⊞ on the derivative of a step's equations.
///
/// A step ends at q₁ = q₀ ⊞ δ. For rotational coordinates, a change dδ changes q₁ by the increment u = T dδ at q₁, and
/// `local_rate`(δ, u) = T⁻¹ u [Arnold, Brüls & Cardona 2015]. The tangent C = cm M + cd D + ck K of a system contains K
/// with respect to increments at q₁. The derivative of the equations with respect to y = (δa₁, δλ₁) is therefore
///   [cm M + cd D + ck K T, Gᵀ; G T, 0] = [C + (cm M + cd D) W, Gᵀ; G, 0] diag(T, 1),  W = T⁻¹ − 1.
/// For nonholonomic constraints, the second form contains G + G W instead of G. The size of W is hω/2, with the step h
/// and the angular velocity ω. Newton's method omits W. A correction of derivatives with the factorisation of Newton's
/// method therefore has a relative error of this size.
/// Theory: Eq. 8.20.

#include <algorithm>
#include <vector>

#include <polybody/system/system.hpp>

namespace polybody {

/// Matrix W = T⁻¹ − 1 of a step q₁ = q₀ ⊞ δ, where T dδ is the increment of q₁ due to dδ. It is stored by columns: a 3
/// × 3 block for each rotation of a body or node.
class IncrementTangent {
 public:
  /// Finds the rotational unknowns. W is omitted if the system eliminates unknowns. \param system system of the step
  [[gnu::cold]] explicit IncrementTangent(System const& system) : columns_(std::size_t(system.velocities())) {
    if (system.step_coordinates()) return;
    velocities_ = system.velocities();
    turns_row_.assign(std::size_t(system.size()), 0);
    std::fill_n(turns_row_.begin(), velocities_, char(1));
    for (Index const i : system.nonholonomic_equations()) turns_row_[std::size_t(velocities_ + i)] = 1;
    delta_ = VecX::LinSpaced(velocities_, 0.1, 0.2);
    one_ = rate_ = VecX::Zero(velocities_);
    none_ = VecX::Zero(system.rows());
    Index const of_bodies = system.layout().body_velocities();  // first-order states follow them
    for (Index j = 0; j < of_bodies; ++j) {
      one_[j] = 1.0;
      system.local_rate(delta_, one_, rate_);
      one_[j] = 0.0;
      for (Index i = 0; i < of_bodies; ++i)
        if (rate_[i] != (i == j ? 1.0 : 0.0)) columns_[std::size_t(j)].push_back({i, 0.0});
    }
    give_colours();
  }

  /// Returns true if any unknown is rotational.
  bool any() const { return !colours_.empty(); }
  /// Computes W for a step with the increment delta (nv).
  void set(System const& system, VecX const& delta) {
    for (std::vector<Index> const& colour : colours_) {
      one_.setZero();
      for (Index const j : colour) one_[j] = 1.0;
      system.local_rate(delta, one_, rate_);
      for (Index const j : colour)
        for (Entry& e : columns_[std::size_t(j)]) e.value = rate_[e.row] - (e.row == j ? 1.0 : 0.0);
    }
  }
  /// Replaces the first nv entries of u by T⁻¹ u = u + W u. Other entries remain unchanged.
  void to_increments(VecX& u) {
    if (!any()) return;
    rate_.setZero();
    for (std::vector<Index> const& colour : colours_)
      for (Index const j : colour)
        for (Entry const& e : columns_[std::size_t(j)]) rate_[e.row] += e.value * u[j];
    u.head(velocities_) += rate_;
  }
  /// Replaces the first nv entries of y by T⁻ᵀ y.
  void transpose_to_increments(VecX& y) {
    if (!any()) return;
    rate_.setZero();
    for (std::vector<Index> const& colour : colours_)
      for (Index const j : colour)
        for (Entry const& e : columns_[std::size_t(j)]) rate_[j] += e.value * y[e.row];
    y.head(velocities_) += rate_;
  }
  /// Writes (cm M + cd D) W, and G W for nonholonomic constraints, for the last evaluation of `system`. \param k
  /// factors of the tangent; only those of mass and damping are used
  template <BlockReceiver S>
  void write(System& system, TangentCoefficients const& k, S& receiver) {
    if (!any()) return;
    Sink<S> sink{*this, receiver};
    system.tangent({.mass = k.mass, .damping = k.damping, .exact = k.exact, .pairs = k.pairs}, SecondOrder::omitted,
                   none_, sink);
  }

 private:
  struct Entry {
    Index row;
    double value;  ///< entry of W [1]
  };
  /// Receives blocks of [cm M + cd D, Gᵀ; G, 0] and passes their products with W to `target`.
  template <BlockReceiver S>
  struct Sink {
    IncrementTangent& by;
    S& target;
    void add(Index row, Index col, BlockView const& b) {
      if (!by.turns(row, col, b.rows, b.cols)) return;
      target.add(row, col, by.product(row, col, b));
    }
    void skip(Index row, Index col, Index rows, Index cols) {
      static constexpr double zero = 0.0;
      if (by.turns(row, col, rows, cols)) target.add(row, col, BlockView(&zero, rows, cols, 0, 0));
    }
  };

  bool turns(Index row, Index col, Index rows, Index cols) const {
    auto const turns_row = [&](char turns) { return turns != 0; };
    auto const turns_column = [](std::vector<Entry> const& column) { return !column.empty(); };
    return col < velocities_ && std::any_of(turns_row_.begin() + row, turns_row_.begin() + row + rows, turns_row) &&
           std::any_of(columns_.begin() + col, columns_.begin() + col + cols, turns_column);
  }
  /// b W in the columns of b. Entries of W in rows outside these columns are omitted.
  BlockView product(Index row, Index col, BlockView const& b) {
    product_.assign(std::size_t(b.rows * b.cols), 0.0);
    for (Index j = 0; j < b.cols; ++j)
      for (Entry const& e : columns_[std::size_t(col + j)]) {
        Index const i = e.row - col;
        if (i < 0 || i >= b.cols) continue;
        for (Index r = 0; r < b.rows; ++r)
          if (turns_row_[std::size_t(row + r)]) product_[std::size_t(r * b.cols + j)] += b(r, i) * e.value;
      }
    return {product_.data(), b.rows, b.cols, b.cols, 1};
  }
  /// Gives columns without a common row the same colour. One evaluation then yields all columns of a colour [Curtis,
  /// Powell & Reid 1974].
  [[gnu::cold]] void give_colours() {
    std::vector<std::vector<char>> taken;
    for (Index j = 0; j < velocities_; ++j) {
      std::vector<Entry> const& column = columns_[std::size_t(j)];
      if (column.empty()) continue;
      auto const is_free = [&](std::vector<char> const& rows) {
        return !rows[std::size_t(j)] &&
               std::none_of(column.begin(), column.end(), [&](Entry const& e) { return rows[std::size_t(e.row)]; });
      };
      std::size_t const c = std::size_t(std::find_if(taken.begin(), taken.end(), is_free) - taken.begin());
      if (c == taken.size()) {
        taken.emplace_back(std::size_t(velocities_), 0);
        colours_.emplace_back();
      }
      colours_[c].push_back(j);
      taken[c][std::size_t(j)] = 1;
      for (Entry const& e : column) taken[c][std::size_t(e.row)] = 1;
    }
  }

  Index velocities_ = 0;
  std::vector<std::vector<Entry>> columns_;  // of W, one for each generalised velocity
  std::vector<std::vector<Index>> colours_;  // columns without a common row
  std::vector<char> turns_row_;              // 1 for equations of motion and nonholonomic constraints
  VecX delta_, one_, rate_;
  VecX none_;  // zero multipliers; only second-order terms depend on multipliers
  std::vector<double> product_;
};

}  // namespace polybody
