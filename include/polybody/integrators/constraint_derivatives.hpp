#pragma once
#include <polybody/integrators/correction_size.hpp>
#include <polybody/system/system.hpp>

namespace polybody {

/// ∂Φ̈/∂q and ∂Φ̈/∂v of Φ̈ = G v̇ + γ, in the places of the blocks of G, by differences. Speeds that no row shares are
/// moved together [Curtis, Powell & Reid 1974], so the cost does not grow with the number of joints.
class ConstraintDerivatives {
 public:
  /// Reads the places of G. Without them where policies eliminate unknowns: then the slopes are left out.
  template <class = void>  // compiled where it is used
  void analyse(System& system) {
    blocks_.clear();
    velocities_ = system.velocities();
    colour_.assign(std::size_t(velocities_), 0);
    colours_ = 0;
    if (system.step_coordinates()) return;
    PatternSink pattern;
    system.masses(pattern);
    Index entries = 0;
    for (Block const& b : pattern.blocks) {
      if (b.row < velocities_ || b.col >= velocities_) continue;
      blocks_.push_back({{b.row - velocities_, b.col, b.rows, b.cols}, entries});
      entries += b.rows * b.cols;
    }
    by_q_.assign(std::size_t(entries), 0.0);
    by_v_ = by_q_;
    for (Index k = 0; k < velocities_; ++k) give_colour(system.rows(), k);
    step_.setZero(velocities_);
    q_.setZero(system.coordinates());
    v_ = step_;
    here_.setZero(system.rows());
    gamma_ = there_ = here_;
  }

  /// At q, v, v̇ = `vd` and t; `system` stands elsewhere afterwards.
  template <class = void>  // compiled where it is used
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

  /// cv ∂Φ̈/∂v + cq ∂Φ̈/∂q into `sink`, whose first row and column are row0 and col0.
  template <class = void>  // compiled where it is used
  void write(double cv, double cq, Index row0, Index col0, BlockSink& sink) {
    for (auto const& [b, first] : blocks_) {
      sum_.resize(std::size_t(b.rows * b.cols));
      for (std::size_t i = 0; i < sum_.size(); ++i)
        sum_[i] = cv * by_v_[std::size_t(first) + i] + cq * by_q_[std::size_t(first) + i];
      sink.add(row0 + b.row, col0 + b.col, BlockView(sum_.data(), b.rows, b.cols, 1, b.rows));
    }
  }

 private:
  struct Place {
    Block block;
    Index first;
  };

  /// The first colour that no row of speed k has yet.
  template <class = void>
  void give_colour(Index rows, Index k) {
    Sequence<char> touched(std::size_t(rows), 0), taken(std::size_t(colours_) + 1, 0);
    auto const touches = [&](Block const& b, Index speed) { return speed >= b.col && speed < b.col + b.cols; };
    for (Place const& p : blocks_)
      if (touches(p.block, k)) std::fill_n(touched.begin() + p.block.row, p.block.rows, 1);
    for (Place const& p : blocks_)
      for (Index i = 0; i < p.block.rows; ++i)
        if (touched[std::size_t(p.block.row + i)])
          for (Index j = p.block.col; j < std::min(k, p.block.col + p.block.cols); ++j)
            taken[std::size_t(colour_[std::size_t(j)])] = 1;
    int colour = 0;
    while (taken[std::size_t(colour)]) ++colour;
    colour_[std::size_t(k)] = colour;
    colours_ = std::max(colours_, colour + 1);
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

  Index velocities_ = 0;
  int colours_ = 0;
  Sequence<Place> blocks_;
  Sequence<int> colour_;  ///< of each speed
  Sequence<double> by_q_, by_v_, sum_;
  VecX step_, q_, v_, here_, there_, gamma_;
};

}  // namespace polybody
