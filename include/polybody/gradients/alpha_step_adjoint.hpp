#pragma once
/// \file
/// Adjoint of a converged step of the generalised-α family: converts derivatives of a result J of a run with respect to
/// the state after a step to derivatives with respect to the state before it. gradients/alpha_linearised_step.hpp
/// contains the tangent-linear form.
///
/// With the algorithmic accelerations a and y = (a₁, λ₁), the formulas of the step give q₁ = q₀ ⊞ δ(y), v₁(y) and
/// v̇₁(y). With the equations R(y; x₀, p) = 0 of the step,
///   ȳ = ∂J/∂y from x̄₁ and these formulas,   (∂R/∂y)ᵀ μ = ȳ,
///   x̄₀ = (∂x₁/∂x₀)ᵀ x̄₁ − (∂R/∂x₀)ᵀ μ,   dJ/dp −= μᵀ ∂R/∂p  [Cao, Li, Petzold & Serban 2003, discrete].
/// Products with transposed derivatives are computed from one tape of the residual, so that they contain all terms. The
/// equations for μ are solved with a factorisation of the transposed tangent at the end of the step and corrected down
/// to round-off.
/// Theory: Eqs. 8.24, 8.25.

#include <polybody/gradients/adjoint_kernels.hpp>
#include <polybody/gradients/step_factorisations.hpp>

namespace polybody {

/// Adjoint variables: derivatives of a result J of a run with respect to the stored numbers of a state, not to
/// increments.
struct Costate {
  VecX q;       ///< (nq) ∂J/∂q
  VecX v;       ///< (nv) ∂J/∂v
  VecX a;       ///< (nv) ∂J/∂v̇
  VecX lambda;  ///< (rows) ∂J/∂λ
  VecX own;     ///< (nv) ∂J/∂a, with the algorithmic accelerations a

  /// Sets all adjoint variables to zero, for a result that does not depend on the state. \param x state with the same
  /// sizes
  [[gnu::cold]] explicit Costate(State const& x)
      : q(VecX::Zero(x.q.size())), v(VecX::Zero(x.v.size())), a(v), lambda(VecX::Zero(x.lambda.size())), own(v) {}

  /// Change of J for a change dx of the state.
  double dot(State const& dx) const {
    double const sum = q.dot(dx.q) + v.dot(dx.v) + a.dot(dx.a) + lambda.dot(dx.lambda);
    return dx.history.size() >= own.size() ? sum + own.dot(StepHistory::own_of(dx)) : sum;
  }
};

/// Adjoints of converged steps of a method of the generalised-α family, from the last step to the first.
template <LinearSolver Solver = DefaultSolver>
class AlphaStepAdjoint {
 public:
  /// The model must outlive this object.
  template <class M>
  [[gnu::cold]] AlphaStepAdjoint(M const& model, System& system, AlphaMethod const& method)
      : recorded_(stepped_system<ReverseVar>(model, with<Capabilities::motion>)),
        method_(method),
        factors_(system, method, {{ApproximateFactors::exact, 0.0}, {ApproximateFactors::turned, 0.5}}) {
    Index const nq = system.coordinates(), nv = system.velocities(), rows = system.rows();
    from_ = q_ = Numbers::Constant(nq, ReverseVar(0.0));
    delta_ = v_ = a_ = r_ = Numbers::Constant(nv, ReverseVar(0.0));
    lambda_ = phi_ = rate_ = Numbers::Constant(rows, ReverseVar(0.0));
    mu_ = y_ = product_ = VecX::Zero(nv + rows);
    of_q_ = VecX::Zero(nq);
    of_delta_ = of_v_ = of_a_ = VecX::Zero(nv);
    of_lambda_ = VecX::Zero(rows);
  }

  /// Converts, in place, the adjoint variables of the state after the step to adjoint variables of the state before it.
  /// Returns the norm of the last correction of μ, relative to μ. \param mu (nv + rows) negative derivatives of J with
  /// respect to terms added to M v̇ − f + Gᵀλ and to Φ (nonholonomic: Φ̇). \throws SingularMatrix in a singular
  /// configuration.
  double backward_step(StepEnds const& step, Costate& x, VecX& mu) {
    record(step);
    factors_.set(step);
    Index const nv = a_.size(), rows = lambda_.size();
    double const h = step.h, of_a1 = method_.mass(), of_v1 = method_.gamma * h, of_d1 = method_.beta * h * h;
    pull_position(x.q);
    VecX const q_before = of_q_, delta_by_q = of_delta_;
    y_.head(nv) = x.own + of_a1 * x.a + of_v1 * x.v + of_d1 * delta_by_q;
    y_.tail(rows) = x.lambda.head(rows);
    double const left = solution_.solve(
        y_, mu_,
        [&](VecX const& of) -> VecX const& {
          pull_equations(step, of);
          product_.head(nv) = of_a1 * of_a_ + of_v1 * of_v_ + of_d1 * of_delta_;
          product_.tail(rows) = of_lambda_;
          return product_;
        },
        [&](VecX const& rhs, VecX& correction) { factors_.solve(rhs, correction); }, most_products);
    factors_.took(solution_.products());
    VecX const v1 = x.v - of_v_, a1 = x.a - of_a_, delta = delta_by_q - of_delta_;
    by_length_ = delta.dot(step.before.v +
                           h * ((1.0 - 2.0 * method_.beta) * step.own_before + 2.0 * method_.beta * step.own_after)) +
                 v1.dot((1.0 - method_.gamma) * step.own_before + method_.gamma * step.own_after);
    x.q = q_before - of_q_;
    x.v = v1 + h * delta;
    x.own = h * (1.0 - method_.gamma) * v1 + h * h * (0.5 - method_.beta) * delta +
            method_.alpha_m / (1.0 - method_.alpha_f) * a1;
    x.a = -method_.alpha_f / (1.0 - method_.alpha_f) * a1;
    x.lambda.setZero();
    mu = mu_;
    mu.tail(rows) *= of_positions(h);
    for (Index const i : recorded_.nonholonomic_equations()) mu[nv + i] = mu_[nv + i] * of_velocities(h);
    return left;
  }

  /// Derivative of J with respect to the length of the step in the last `backward_step`, at fixed times in the
  /// equations [J's unit/s].
  double step_length_derivative() const { return by_length_; }

 private:
  using Numbers = VecXOf<ReverseVar>;
  static constexpr Index most_products = 60;

  /// Factors of Φ and Φ̇ in R.
  double of_positions(double h) const { return 1.0 / (method_.beta * h * h); }
  double of_velocities(double h) const { return 1.0 / (method_.gamma * h); }

  void take(Numbers const& from, VecX& derivatives) { detail::take_derivatives(recording_, from, derivatives); }

  /// Records q₁ = q₀ ⊞ δ, then M v̇ − f + Gᵀλ, Φ and, for nonholonomic constraints, Φ̇ at the end of the step.
  void record(StepEnds const& step) {
    State const &before = step.before, &after = step.after;
    Tape::On const on(recording_);
    VecX const increment = step.increment(method_);
    detail::set_variables(before.q, from_);
    for (Index i = 0; i < delta_.size(); ++i) delta_[i] = ReverseVar::variable(increment[i]);
    recorded_.plus(from_, delta_, q_);
    moved_ = recording_.size();
    detail::set_variables(after.v, v_);
    detail::set_variables(after.a, a_);
    detail::set_variables(after.lambda.head(lambda_.size()), lambda_);
    recorded_.evaluate(q_, v_, after.t);
    recorded_.residual(a_, lambda_, r_);
    if (phi_.size() > 0) recorded_.violation(phi_);
    if (!recorded_.nonholonomic_equations().empty()) recorded_.violation_rate(rate_);
  }

  /// Computes (∂q₁/∂q₀)ᵀ q̄ and (∂q₁/∂δ)ᵀ q̄.
  void pull_position(VecX const& q) {
    recording_.clear_derivatives(moved_);
    detail::add_to_derivatives(recording_, q_, q);
    recording_.sweep(moved_);
    take(from_, of_q_);
    take(delta_, of_delta_);
  }
  /// Computes the products of the transposed derivatives of R with μ.
  void pull_equations(StepEnds const& step, VecX const& mu) {
    Index const nv = r_.size();
    recording_.clear_derivatives(recording_.size());
    for (Index i = 0; i < nv; ++i) recording_.slope(r_[i].number) += mu[i];
    double const of_phi = of_positions(step.h), of_rate = of_velocities(step.h);
    for (Index i = 0; i < phi_.size(); ++i) recording_.slope(phi_[i].number) += of_phi * mu[nv + i];
    for (Index const i : recorded_.nonholonomic_equations()) recording_.slope(rate_[i].number) += of_rate * mu[nv + i];
    recording_.sweep(recording_.size());
    take(from_, of_q_);
    take(delta_, of_delta_);
    take(v_, of_v_);
    take(a_, of_a_);
    take(lambda_, of_lambda_);
  }

  BasicSystem<ReverseVar> recorded_;
  AlphaMethod method_;
  StepFactorisations<Solver, Derivative::transposed> factors_;
  Tape recording_;
  std::size_t moved_ = 0;  // number of operations up to q₁
  Numbers from_, delta_, q_, v_, a_, lambda_, r_, phi_, rate_;
  detail::TransposedSolution solution_;
  VecX mu_, y_, product_;
  double by_length_ = 0.0;
  VecX of_q_, of_delta_, of_v_, of_a_, of_lambda_;
};

}  // namespace polybody
