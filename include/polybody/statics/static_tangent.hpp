#pragma once
/// \file
/// The linear equations of statics, [K, Gᵀ; G, 0] (x, μ) = (f, φ), K = −∂f/∂q with every term; x and f have first-order
/// states and their rates behind coordinates and forces. They are solved as A y = b,
///   A = [K/u, Gᵀ; G, 0],  y = (x, μ/u),  b = (f/u, φ),
/// u a power of two as large as K: beside bodies of 1e14 N/m rows of G, whose entries are near one, would otherwise be
/// lost among rounding errors of pivots.

#include <cmath>
#include <cstdint>
#include <span>

#include <polybody/solvers/linear_solver.hpp>
#include <polybody/system/system.hpp>

namespace polybody {

/// The static equations' matrix at a state, scaled, written, factored and solved with.
template <LinearSolver Solver>
class StaticTangent {
 public:
  /// The system must outlive this; its state is the one last given to `System::evaluate`, here and below.
  StaticTangent(System& system, VecX const& lambda)
      : system_(&system), nv_(system.speeds()), rhs_(VecX::Zero(system.size())) {
    analyse(lambda);
    solver_.begin();
    BlockSink solver(solver_);
    Passing sink{solver, nv_};
    write(lambda, unit_, sink);
    rescale(sink.largest);
  }

  /// From now on unknown i bears a spring of its own, A + diag(springs). The first time it analyses anew.
  void set_springs(VecX const& springs, VecX const& lambda) {
    bool const first = springs_.size() == 0;
    springs_ = springs;
    if (first) analyse(lambda);
  }
  /// Back to A itself; analyses anew.
  void remove_springs(VecX const& lambda) {
    springs_.resize(0);
    analyse(lambda);
  }

  /// −1, or the unknown without a usable pivot.
  Index factor(VecX const& lambda) {
    double largest = 0.0;
    Index const bad = write_and_factor(solver_, [&](BlockSink& solver) {
      Passing sink{solver, nv_};
      write(lambda, unit_, sink);
      largest = unit_ * sink.largest;
      for (Index i = 0; i < springs_.size(); ++i) solver.add(i, i, BlockView(&springs_[i], 1, 1, 0, 0));
    });
    factored_ = unit_;
    rescale(largest);
    return bad;
  }

  /// `out` (size) = (x, μ) for f (speeds) and φ (rows).
  void solve(VecX const& f, VecX const& phi, VecX& out) {
    rhs_ << f / factored_, phi;
    solver_.solve(rhs_, out);
    out.tail(phi.size()) *= factored_;
  }
  /// y = (A + diag(springs))⁻¹ b.
  void solve_scaled(VecX const& b, VecX& y) { solver_.solve(b, y); }
  /// The blocks of A, without springs, in the unit of the last factorisation.
  template <TakesBlocks S>
  void write_scaled(VecX const& lambda, S& sink) {
    write(lambda, factored_, sink);
  }
  double unit() const { return factored_; }   ///< u of the last factorisation
  double next_unit() const { return unit_; }  ///< u of the next one

  /// ±1, the sign of the determinant of the last factorisation; 0 for solvers that do not give it.
  double sign_of_determinant() const {
    if constexpr (requires { solver_.sign_of_determinant(); })
      return solver_.sign_of_determinant();
    else
      return 0.0;
  }

  /// The same at the present state of the system; 0 also for a singular matrix. The next scale u stays.
  double sign_here(VecX const& lambda) {
    double const next = unit_;
    double const sign = factor(lambda) < 0 ? sign_of_determinant() : 0.0;
    unit_ = next;
    return sign;
  }

  /// max |A⁻¹ b| for a b without order: as large as the inverse of the smallest singular value, but for a b that
  /// happens to be normal to its vector.
  double growth() {
    VecX y = rhs_;
    fill_without_order(0, rhs_);
    solver_.solve(rhs_, y);
    return largest_size(y);
  }
  /// The k-th of such b, entries between −1 and 1, the same in every run (a multiplicative hash).
  static void fill_without_order(std::size_t k, VecX& b) {
    for (Index i = 0; i < b.size(); ++i) {
      std::uint64_t h = ((std::uint64_t(k) << 32) + std::uint64_t(i) + 1) * 0x9E3779B97F4A7C15u;
      h = (h ^ (h >> 32)) * 0xD6E8FEB86659FD93u;
      b[i] = double(std::int64_t(h ^ (h >> 32))) * 0x1p-63;
    }
  }
  /// Rows that the solver has dropped by itself, as unknowns. Empty for solvers that do not tell.
  std::span<Index const> dropped() const {
    if constexpr (requires { solver_.dropped(); })
      return solver_.dropped();
    else
      return {};
  }

 private:
  /// Passes blocks on and keeps the largest entry of K.
  struct Passing {
    BlockSink& solver;
    Index speeds;
    double largest = 0.0;  ///< |K_ij| so far, relative to u

    void add(Index row, Index col, BlockView const& b) {
      solver.add(row, col, b);
      if (row >= speeds || col >= speeds) return;
      for (Index j = 0; j < b.cols; ++j)
        for (Index i = 0; i < b.rows; ++i) largest = std::max(largest, std::abs(b(i, j)));
    }
  };

  void analyse(VecX const& lambda) {
    PatternSink pattern;
    write(lambda, 1.0, pattern);
    for (Index i = 0; i < springs_.size(); ++i) pattern.blocks.push_back({i, i, 1, 1});
    solver_.analyse(system_->size(), pattern.blocks);
  }
  template <TakesBlocks S>
  void write(VecX const& lambda, double unit, S& sink) {
    system_->tangent({.stiffness = 1.0 / unit, .states = 1.0 / unit}, SecondOrder::included, lambda, sink);
  }
  void rescale(double largest) {
    if (largest > 0.0 && std::isfinite(largest)) unit_ = std::ldexp(1.0, std::ilogb(largest));
  }

  System* system_;
  Index nv_;
  Solver solver_;
  double unit_ = 1.0, factored_ = 1.0;  ///< of the next factorisation and of the last one
  VecX rhs_, springs_;
};

}  // namespace polybody
