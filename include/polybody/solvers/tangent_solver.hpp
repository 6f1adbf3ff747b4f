#pragma once
#include <polybody/solvers/articulated_body.hpp>
#include <polybody/solvers/linear_solver.hpp>
#include <polybody/system/reduced_system.hpp>

namespace polybody {

/// The linear systems of an integrator: written by the mechanics, factored and solved by a linear solver, in whatever
/// unknowns the mechanics choose for them. Trees that ask for `recursive::ArticulatedBody` are solved by their own
/// elimination, whatever the solver.
template <class M, LinearSolver Solver>
class TangentSolver {
 public:
  /// Allocates all there is to be. \param copies of the unknowns, side by side, as a method of several stages has them
  template <class Write>
  void analyse(System<M>& system, Index copies, Write&& write) {
    copies_ = copies;
    if constexpr (System<M>::solves_by_bodies) {
      if (copies > 1)
        throw InvalidInput(
            "recursive::ArticulatedBody solves for one set of accelerations at a time, not for the stages of a "
            "method together. Take recursive::Augmented.");
    } else {
      PatternSink pattern;
      write(pattern);
      solver_.analyse(copies * system.equations(), pattern.blocks);
    }
    if constexpr (!System<M>::solves_as_it_is) {
      rhs_.setZero(copies * system.equations());
      x_ = rhs_;
      part_.setZero(system.size());
      solution_ = part_;
      equations_.setZero(system.equations());
    }
  }
  /// … for the tangent itself.
  void analyse(System<M>& system, SecondOrder second, VecX const& lambda) {
    analyse(system, 1, [&](PatternSink& sink) { system.tangent({1.0, 1.0, 1.0}, second, lambda, sink); });
  }

  /// Writes and factors where `system` was evaluated last. −1, or the equation without a pivot (`name_of_equation`).
  template <class Write>
  Index factor(System<M>& system, Write&& write) {
    system.hold(held_);
    if constexpr (System<M>::solves_by_bodies) {
      solver_.attach(system.reduction(), held_);
      solver_.begin();
      write(solver_);
      return solver_.factor();
    } else {
      return write_and_factor(solver_, [&](Solver& sink) { write(sink); });
    }
  }
  Index factor(System<M>& system, TangentCoefficients const& c, SecondOrder second, VecX const& lambda) {
    return factor(system, [&](auto& sink) { system.tangent(c, second, lambda, sink); });
  }

  /// x by the unknowns of the time step.
  void solve(System<M>& system, VecX const& rhs, VecX& x) {
    if constexpr (System<M>::solves_as_it_is) {
      solver_.solve(rhs, x);
    } else {
      Index const n = system.size(), m = system.equations();
      for (Index k = 0; k < copies_; ++k) {
        part_ = rhs.segment(k * n, n);
        system.spread(held_, part_, equations_);
        rhs_.segment(k * m, m) = equations_;
      }
      solver_.solve(rhs_, x_);
      for (Index k = 0; k < copies_; ++k) {
        equations_ = x_.segment(k * m, m);
        system.gather(held_, equations_, solution_);
        x.segment(k * n, n) = solution_;
      }
    }
  }

  /// Equations that repeat others, as of the last factorisation. Empty for solvers that do not tell.
  std::span<Index const> dropped() const {
    if constexpr (requires { solver_.dropped(); })
      return solver_.dropped();
    else
      return {};
  }

 private:
  std::conditional_t<System<M>::solves_by_bodies, ArticulatedBodySolver, Solver> solver_;
  typename System<M>::Held held_;
  Index copies_ = 1;
  VecX rhs_, x_, part_, solution_, equations_;
};

}  // namespace polybody
