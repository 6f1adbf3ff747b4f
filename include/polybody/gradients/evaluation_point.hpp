#pragma once
/// \file
/// The linear equations that steps of several stages solve, place by place:
///   M a + Gᵀλ = force f,   G (a + also) + bias γ + rate Φ̇ + position Φ = 0.
/// Accelerations have all of f and γ. A projection has neither: with position = 1/h² the coordinates move by δ = h² a,
/// with rate = 1/h the speeds by h a. So all of them are as large as accelerations, and lose no digits beside f.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <polybody/gradients/alpha_linearised_step.hpp>

namespace polybody {

/// What stands in the equations of a place; what is set where nothing is said are those of accelerations.
struct EquationTerms {
  double force = 1.0;     ///< factor of f: one, or zero
  double bias = 1.0;      ///< factor of γ
  double rate = 0.0;      ///< factor of Φ̇ [1/s]
  double position = 0.0;  ///< factor of Φ [1/s²]
};

/// A place where equations are solved, with their solution.
template <StateScalar T = double>
struct EvaluationPoint {
  VecXOf<T> q;          ///< (nq) coordinates
  VecXOf<T> v;          ///< (nv) speeds, and first-order states behind them
  double t = 0.0;       ///< time [s]
  EquationTerms terms;  ///< of the equations
  VecXOf<T> also;       ///< (nv) accelerations that the rows see beside a; empty where there are none
  VecXOf<T> a;          ///< (nv) accelerations: the solution
  VecXOf<T> lambda;     ///< (rows) multipliers: the solution
};

/// The left sides of the equations at a place.
template <StateScalar T = double>
class PointEquations {
 public:
  VecXOf<T> balance;  ///< (nv) M a + Gᵀλ − force f
  VecXOf<T> rows;     ///< (rows) G (a + also) + bias γ + rate Φ̇ + position Φ

  /// Evaluates them by the a and λ of the place.
  void evaluate(BasicSystem<T>& system, EvaluationPoint<T> const& x) {
    resize(system);
    system.evaluate(x.q, x.v, x.t);
    system.residual(x.a, x.lambda, balance);
    if (x.terms.force == 0.0) {
      system.residual(none_, no_rows_, part_);
      balance -= part_;
    }
    if (rows.size() == 0) return;
    if (x.also.size() > 0) part_ = x.a + x.also;
    system.rows_times(x.also.size() > 0 ? part_ : x.a, rows);
    if (x.terms.bias != 0.0) {
      system.acceleration_bias(of_rows_);
      add(x.terms.bias);
    }
    if (x.terms.rate != 0.0) {
      system.violation_rate(of_rows_);
      add(x.terms.rate);
    }
    if (x.terms.position != 0.0) {
      system.violation(of_rows_);
      add(x.terms.position);
    }
  }

 private:
  void resize(BasicSystem<T> const& system) {
    if (none_.size() == system.velocities()) return;
    none_ = VecXOf<T>::Constant(system.velocities(), T(0.0));
    no_rows_ = VecXOf<T>::Constant(system.rows(), T(0.0));
    balance = part_ = none_;
    rows = of_rows_ = no_rows_;
  }
  void add(double factor) {
    for (Index i = 0; i < rows.size(); ++i) rows[i] += of_rows_[i] * factor;
  }

  VecXOf<T> none_, no_rows_, part_, of_rows_;
};

/// What a parameter does to the equations of place x, while x and its solution stay: f(x, l) for direction number l.
template <class F>
concept EquationDerivativeFunction = requires(F f, EvaluationPoint<> const& x, std::size_t l) {
  { f(x, l) } -> std::convertible_to<EquationDerivative>;
};

/// The slopes of the steps of integrator I, `Type`, where it solves equations at places; specialised on the header of
/// these slopes.
template <class I>
struct StageDerivatives;

/// The adjoints of the steps of integrator I, `Type`, likewise.
template <class I>
struct StageAdjoints;

namespace detail {
/// The header of the adjoints of integrator I is there.
template <class I>
concept HasStageAdjoints = requires { typename StageAdjoints<I>::Type; };
/// The header of the slopes of integrator I is there.
template <class I>
concept HasStageDerivatives = requires { typename StageDerivatives<I>::Type; };
}  // namespace detail

/// A step that was taken.
struct StepTaken {
  State const& before;  ///< at its start
  State const& after;   ///< at its end
  double h;             ///< its length [s]
};

}  // namespace polybody
