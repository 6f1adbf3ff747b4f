#pragma once
/// \file
/// Linear equations that Runge–Kutta steps solve at each evaluation point:
///   M a + Gᵀλ = force f,   G (a + also) + bias γ + rate Φ̇ + position Φ = 0.
/// The factors force, bias, rate and position are those of `EquationTerms`. For accelerations, force = bias = 1, and
/// rate and position are zero or the coefficients of Baumgarte's feedback. For a projection, force = bias = 0. With
/// position = 1/h², the projection changes the coordinates by δ = h² a; with rate = 1/h, it changes the velocities by h
/// a. The unknowns a of a projection thus have the size of accelerations and do not lose digits when f is subtracted.
/// Theory: Eq. 8.21.

#include <polybody/gradients/alpha_linearised_step.hpp>

namespace polybody {

/// Factors of the terms in the equations of an evaluation point. The default values are those of accelerations without
/// Baumgarte's feedback.
struct EquationTerms {
  double force = 1.0;     ///< factor of f: one, or zero
  double bias = 1.0;      ///< factor of γ
  double rate = 0.0;      ///< factor of Φ̇ [1/s]
  double position = 0.0;  ///< factor of Φ [1/s²]
};

/// Point at which a Runge–Kutta step solves its linear equations, with the solution.
template <StateScalar T = double>
struct EvaluationPoint {
  VecXOf<T> q;          ///< (nq) coordinates
  VecXOf<T> v;          ///< (nv) generalised velocities, then first-order states
  double t = 0.0;       ///< time [s]
  EquationTerms terms;  ///< factors of the terms of the equations
  VecXOf<T> also;       ///< (nv) accelerations added to a in the constraint equations; empty if there are none
  VecXOf<T> a;          ///< (nv) accelerations of the solution
  VecXOf<T> lambda;     ///< (rows) multipliers of the solution
};

/// Residuals of the linear equations of motion and of the constraint equations at an evaluation point.
template <StateScalar T = double>
class PointEquations {
 public:
  VecXOf<T> balance;  ///< (nv) M a + Gᵀλ − force f
  VecXOf<T> rows;     ///< (rows) G (a + also) + bias γ + rate Φ̇ + position Φ

  /// Evaluates the residuals with a and λ of the point x.
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

/// Function f(x, l): derivative of the equations at a fixed point x with respect to the parameter of direction l.
template <class F>
concept EquationDerivativeFunction = requires(F f, EvaluationPoint<> const& x, std::size_t l) {
  { f(x, l) } -> std::convertible_to<EquationDerivative>;
};

namespace detail {
/// Integrator that names the derivatives of its steps: `I::Derivatives` has the templates LinearisedStep and
/// StepAdjoint.
template <class I>
concept HasStageDerivatives = requires { typename I::Derivatives::template LinearisedStep<I>; };
}  // namespace detail

/// Step of a run.
struct StepTaken {
  State const& before;  ///< state at the start of the step
  State const& after;   ///< state at the end of the step
  double h;             ///< length of the step [s]
};

}  // namespace polybody
