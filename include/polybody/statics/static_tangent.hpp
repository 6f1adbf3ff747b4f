#pragma once
/// \file
/// Matrix of the equations of statics: scaling, assembly, factorisation and solution.
/// Theory: Eq. 7.15.

#include <cmath>
#include <cstdint>
#include <span>

#include <polybody/solvers/linear_solver.hpp>
#include <polybody/system/system.hpp>

namespace polybody {

/// Matrix of the equations of statics in a state: scaling, assembly, factorisation and solution.
///
/// The linear equations of statics are [K, Gᵀ; G, 0] (x, μ) = (f, φ). K = −∂f/∂q + ∂(Gᵀλ)/∂q contains all second-order
/// terms. x contains the increments of the coordinates, then those of the first-order states. f contains the forces,
/// then the rates of these states. The equations are scaled to A y = b,
///   A = [K/u, Gᵀ; G, 0],  y = (x, μ/u),  b = (f/u, φ),
/// with a power of two u of the magnitude of K. Without the scaling, the entries of G, which are near one, would be
/// lost in the round-off of pivots of 1e14 N/m.
template <LinearSolver Solver>
class StaticTangent {
 public:
  /// Analyses the sparsity pattern and computes the scale u. `system` must outlive this object. The entries
  /// of the matrix belong to the state of the last call of `System::evaluate`.
  StaticTangent(System& system, VecX const& lambda)
      : system_(&system), nv_(system.velocities()), rhs_(VecX::Zero(system.size())) {
    analyse(lambda);
    solver_.begin();
    BlockSink solver(solver_);
    MotionAccumulator sink{solver, nv_};
    write(lambda, unit_, sink);
    rescale(sink.largest);
  }

  /// Adds a spring to each unknown, A + diag(springs). The first call analyses the sparsity pattern again.
  void set_springs(VecX const& springs, VecX const& lambda) {
    bool const first = springs_.size() == 0;
    springs_ = springs;
    if (first) analyse(lambda);
  }
  /// Removes the springs and analyses the sparsity pattern again.
  void remove_springs(VecX const& lambda) {
    springs_.resize(0);
    analyse(lambda);
  }

  /// Factorises the matrix. Returns −1, or the index of the unknown without a usable pivot.
  Index factor(VecX const& lambda) {
    double largest = 0.0;
    Index const bad = write_and_factor(solver_, [&](BlockSink& solver) {
      MotionAccumulator sink{solver, nv_};
      write(lambda, unit_, sink);
      largest = unit_ * sink.largest;
      for (Index i = 0; i < springs_.size(); ++i) solver.add(i, i, BlockView(&springs_[i], 1, 1, 0, 0));
    });
    factored_ = unit_;
    rescale(largest);
    return bad;
  }

  /// Computes `out` (size) = (x, μ) for f (velocities) and required changes φ of the constraint functions.
  void solve(VecX const& f, VecX const& phi, VecX& out) {
    rhs_ << f / factored_, phi;
    solver_.solve(rhs_, out);
    out.tail(phi.size()) *= factored_;
  }
  /// Computes y = (A + diag(springs))⁻¹ b.
  void solve_scaled(VecX const& b, VecX& y) { solver_.solve(b, y); }
  /// Writes the blocks of A, without springs, with the scale u of the last factorisation.
  template <BlockReceiver S>
  void write_scaled(VecX const& lambda, S& sink) {
    write(lambda, factored_, sink);
  }
  double unit() const { return factored_; }   ///< u of the last factorisation
  double next_unit() const { return unit_; }  ///< u of the next factorisation

  /// Sign of the determinant in the last factorisation, ±1; 0 for solvers that do not provide it.
  double sign_of_determinant() const {
    if constexpr (requires { solver_.sign_of_determinant(); })
      return solver_.sign_of_determinant();
    else
      return 0.0;
  }

  /// Factorises the matrix at the present state. Returns the sign of its determinant, ±1; 0 if the matrix is singular
  /// or if the solver does not provide the sign. The scale u of the next factorisation does not change.
  double sign_here(VecX const& lambda) {
    double const next = unit_;
    double const sign = factor(lambda) < 0 ? sign_of_determinant() : 0.0;
    unit_ = next;
    return sign;
  }

  /// Growth max |A⁻¹ b| for a pseudorandom b. It is of the order of the inverse of the smallest singular value,
  /// except if b is orthogonal to the singular vector by chance.
  double growth() {
    VecX y = rhs_;
    fill_without_order(0, rhs_);
    solver_.solve(rhs_, y);
    return largest_size(y);
  }
  /// Sets `b` to the pseudorandom vector number k with entries between −1 and 1, equal in every run (a multiplicative
  /// hash).
  static void fill_without_order(std::size_t k, VecX& b) {
    for (Index i = 0; i < b.size(); ++i) {
      std::uint64_t h = ((std::uint64_t(k) << 32) + std::uint64_t(i) + 1) * 0x9E3779B97F4A7C15u;
      h = (h ^ (h >> 32)) * 0xD6E8FEB86659FD93u;
      b[i] = double(std::int64_t(h ^ (h >> 32))) * 0x1p-63;
    }
  }
  /// Redundant constraint equations that the solver has omitted, as indices of unknowns. Empty for solvers that do not
  /// report them.
  std::span<Index const> dropped() const {
    if constexpr (requires { solver_.dropped(); })
      return solver_.dropped();
    else
      return {};
  }

 private:
  /// Receiver that adds matrix blocks to a solver and records the largest entry of K.
  struct MotionAccumulator {
    BlockSink& solver;
    Index velocities;
    double largest = 0.0;  ///< largest |K_ij| so far, relative to u

    void add(Index row, Index col, BlockView const& b) {
      solver.add(row, col, b);
      if (row >= velocities || col >= velocities) return;
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
  template <BlockReceiver S>
  void write(VecX const& lambda, double unit, S& sink) {
    system_->tangent({.stiffness = 1.0 / unit, .states = 1.0 / unit}, SecondOrder::included, lambda, sink);
  }
  void rescale(double largest) {
    if (largest > 0.0 && std::isfinite(largest)) unit_ = std::ldexp(1.0, std::ilogb(largest));
  }

  System* system_;
  Index nv_;
  Solver solver_;
  double unit_ = 1.0, factored_ = 1.0;  ///< scale u of the next factorisation, and that of the last one
  VecX rhs_, springs_;
};

}  // namespace polybody
