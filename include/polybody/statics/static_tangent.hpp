#pragma once
/// \file
/// The linear equations of statics, [K, Gᵀ; G, 0] (x, μ) = (f, φ), K = −∂f/∂q with every term; x and f have first-order
/// states and their rates behind coordinates and forces. They are solved as
/// [K/u, Gᵀ; G, 0] (x, μ/u) = (f/u, φ), u a power of two as large as K: beside bodies of 1e14 N/m rows of G, whose
/// entries are near one, would otherwise be lost among rounding errors of pivots.

#include <cmath>

#include <polybody/solvers/linear_solver.hpp>
#include <polybody/system/system.hpp>

namespace polybody {

template <LinearSolver Solver>
class StaticTangent {
 public:
  /// The system must outlive this; its state is the one last given to `System::evaluate`, here and below.
  StaticTangent(System& system, VecX const& lambda)
      : system_(&system), nv_(system.speeds()), rhs_(VecX::Zero(system.size())) {
    PatternSink pattern;
    system.tangent({.stiffness = 1.0, .states = 1.0}, SecondOrder::included, lambda, pattern);
    solver_.analyse(system.size(), pattern.blocks);
    solver_.begin();
    BlockSink solver(solver_);
    Passing sink{solver, nv_};
    write(lambda, sink);
    rescale(sink.largest);
  }

  /// −1, or the unknown without a usable pivot.
  Index factor(VecX const& lambda) {
    double largest = 0.0;
    Index const bad = write_and_factor(solver_, [&](BlockSink& solver) {
      Passing sink{solver, nv_};
      write(lambda, sink);
      largest = unit_ * sink.largest;
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

 private:
  /// Passes blocks on and keeps the largest entry of K.
  struct Passing {
    BlockSink& solver;
    Index speeds;
    double largest = 0.0;

    void add(Index row, Index col, BlockView const& b) {
      solver.add(row, col, b);
      if (row >= speeds || col >= speeds) return;
      for (Index j = 0; j < b.cols; ++j)
        for (Index i = 0; i < b.rows; ++i) largest = std::max(largest, std::abs(b(i, j)));
    }
  };

  void write(VecX const& lambda, Passing& sink) {
    system_->tangent({.stiffness = 1.0 / unit_, .states = 1.0 / unit_}, SecondOrder::included, lambda, sink);
  }
  void rescale(double largest) {
    if (largest > 0.0 && std::isfinite(largest)) unit_ = std::ldexp(1.0, std::ilogb(largest));
  }

  System* system_;
  Index nv_;
  Solver solver_;
  double unit_ = 1.0, factored_ = 1.0;  ///< of the next factorisation and of the last one
  VecX rhs_;
};

}  // namespace polybody
