#pragma once
/// \file
/// Exact tangent-linear form of a converged step of the generalised-α family (integrators/alpha_method.hpp), with all
/// terms that the matrix of Newton's method omits.
///
/// Inputs are the changes of q₀, v₀, v̇₀ and the algorithmic accelerations a₀, and the change of the equations with a
/// parameter. With y = (δa₁, δλ₁), the changes of q₁, v₁, v̇₁ follow from the formulas of the step, and the equations
///   δ[M v̇₁ − f₁ + G₁ᵀλ₁] = 0,  δΦ(q₁)/βh² = 0  (nonholonomic: δΦ̇/γh = 0)
/// are linear in y. Their left-hand sides are evaluated with dual numbers and therefore contain all terms, among them
/// the derivative of ⊞ and ∂(Gᵀλ)/∂q. The equations are solved by iterative refinement with an approximate
/// factorisation (`StepFactorisations`). The iteration ends if the last correction, or an estimate of the next one
/// (`CorrectionErrorEstimate`), is at the level of round-off.
/// Theory: Eqs. 8.18, 8.19.

#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include <polybody/gradients/step_factorisations.hpp>
#include <polybody/math/types.hpp>

namespace polybody {

// Error estimate of a correction with an approximate factorisation, without another evaluation of the equations.
//
// With a factorisation F of a matrix close to the derivative K of a step, the error after a correction c is E c, with
// E = 1 − F⁻¹K. A probe z = w ∘ ξ has weights w and independent ξ of variance 1/3. The probe is evaluated together
// with the directions of differentiation, and E z = z − F⁻¹K z. The mean of |E z|² is Σ E_ij² w_j²/3 [Hutchinson,
// Commun. Statist. Simul. 18, 1989]. If |c_j| ≤ κ w_j for all n unknowns, Cauchy's inequality gives |E c| ≤ κ √(3 n
// mean |E z|²). The value of one probe replaces the mean. The weights are recent sizes of the unknowns, so that a
// probe hardly changes unknowns that the directions do not change: a planar motion remains planar.

/// Error estimate of corrections to the changes of a₁ (nv) and λ₁ (rows). The change along a direction is multiplied by
/// the size of the parameter of this direction.
class CorrectionErrorEstimate {
 public:
  /// Norms of the two parts of a change of the unknowns.
  struct Parts {
    double a = 0.0;       ///< norm of the change of accelerations [m/s²], [rad/s²]
    double lambda = 0.0;  ///< norm of the change of multipliers [N], [N m]
  };

  /// \param nv number of generalised velocities; \param rows number of constraint equations with multipliers
  explicit CorrectionErrorEstimate(Index nv = 0, Index rows = 0)
      : nv_(nv), weights_(VecX::Zero(nv + rows)), drawn_(weights_) {}

  /// Begins another step: discards the estimate and reduces the weights by 10 %.
  void fade() {
    forget();
    weights_ *= 0.9;
  }
  /// Discards the estimate after a new factorisation.
  void forget() { known_ = false; }
  /// Returns true if an estimate exists.
  bool known() const { return known_; }
  /// Increases the weights to at least `scale` |y|. y (nv + rows) are the changes of the unknowns along a direction,
  /// and `scale` is the size of the parameter of this direction.
  void add(VecX const& y, double scale) { weights_ = weights_.cwiseMax(scale * y.cwiseAbs()); }
  /// Draws a random probe z (nv + rows). Returns false if all weights are zero.
  bool draw(VecX& z) {
    double const least = 1e-14 * weights_.maxCoeff();
    if (!(least > 0.0)) return false;
    for (Index i = 0; i < z.size(); ++i) {
      random_ = random_ * 6364136223846793005u + 1442695040888963407u;  // [Knuth 1998, §3.3.4]
      drawn_[i] = std::max(weights_[i], least);
      z[i] = drawn_[i] * double(std::int64_t(random_)) * 0x1p-63;
    }
    return true;
  }
  /// Computes the estimate from a probe z. \param left (nv + rows) error E z
  void measure(VecX const& left) {
    double const by = std::sqrt(3.0 * double(left.size()));
    leaves_ = {by * left.head(nv_).norm(), by * left.tail(left.size() - nv_).norm()};
    known_ = std::isfinite(leaves_.a + leaves_.lambda);
  }
  /// Estimated upper bounds of the error norms after a `correction` (nv + rows).
  Parts bound(VecX const& correction) const {
    double const kappa = (correction.array().abs() / drawn_.array()).maxCoeff();
    return {kappa * leaves_.a, kappa * leaves_.lambda};
  }

 private:
  Index nv_ = 0;
  VecX weights_, drawn_;  // present weights, and weights of the last probe
  Parts leaves_;
  bool known_ = false;
  std::uint64_t random_ = 0;
};

/// Derivatives of successive, converged steps of a method of the generalised-α family.
template <LinearSolver Solver = DefaultSolver>
class AlphaLinearisedStep {
 public:
  /// Factorisation of the tangent of a step.
  using Factors = typename StepFactorisations<Solver, Derivative::direct>::OfStep;
  /// Largest number of directions in one evaluation of the equations, equal to the number of partial derivatives in a
  /// dual number. With eight directions, the intermediate results between joints and bodies would exceed the cache.
  static constexpr int max_directions = 4;

  /// The model must outlive this object.
  template <class M>
  [[gnu::cold]] AlphaLinearisedStep(M const& model, System& system, AlphaMethod const& method)
      : dual_(stepped_system<D>(model, with<Capabilities::motion>)),
        method_(method),
        factors_(system, method, candidates()) {
    Index const nq = system.coordinates(), nv = system.velocities(), rows = system.rows();
    from_ = q_ = Dots::Constant(nq, D(0.0));
    delta_ = v_ = a_ = r_ = Dots::Constant(nv, D(0.0));
    lambda_ = phi_ = rate_ = Dots::Constant(rows, D(0.0));
    for (std::size_t l = 0; l < y_.size(); ++l) y_[l] = rhs_[l] = correction_[l] = VecX::Zero(nv + rows);
    guess_ = VecX::Zero(nv);
    still_.q = VecX::Zero(nq);
    still_.v = still_.a = still_.history = guess_;
    at_rest_ = {{guess_, VecX::Zero(rows)}, &still_, 0.0};
    probe_ = CorrectionErrorEstimate(nv, rows);
  }

  /// Sets the step to be differentiated. \param near approximate factorisation of the tangent of the step, for example
  /// from the solution of the step; may be null. Either `near` or a factorisation at the end of the step is used,
  /// according to the measured costs. \throws SingularMatrix in a singular configuration.
  void set(StepEnds const& step, Factors* near = nullptr) {
    probe_.fade();
    factors_.set(step, near);
    State const &before = step.before, &after = step.after;
    guess_ = step.increment(method_);
    for (Index i = 0; i < from_.size(); ++i) from_[i].v = before.q[i];
    for (Index i = 0; i < a_.size(); ++i) {
      a_[i].v = after.a[i];
      v_[i].v = after.v[i];
      delta_[i].v = guess_[i];
    }
    for (Index i = 0; i < lambda_.size(); ++i) lambda_[i].v = after.lambda[i];
    size_of_a_ = after.a.norm();
    size_of_lambda_ = after.lambda.head(lambda_.size()).norm();
  }

  /// Replaces derivatives of the state before the step, along up to `max_directions` directions, by derivatives of the
  /// state after the step. An unused lane of the dual numbers may evaluate the probe of the error estimate. Returns the
  /// last correction, or the estimate of the next correction if it is smaller. The correction is relative to the
  /// derivatives of a and λ, or to a and λ divided by the parameter's scale if these quotients are larger.
  /// \throws SingularMatrix in a singular configuration.
  double advance(StepEnds const& step, std::span<StepDirection const> directions) {
    std::size_t const n = directions.size();
    bool const far = passes_ > 2, probes = n < std::size_t(max_directions) && !probe_.known() && probe_.draw(y_[n]);
    for (std::size_t l = 0; l < n; ++l) guess(step, directions[l], far, y_[l]);
    find_end(step, directions);
    double left = std::numeric_limits<double>::infinity(), more = left;
    for (passes_ = 1; passes_ <= most_passes; ++passes_) {
      double const before = left;
      left = correct(step, directions);
      if (probes && passes_ == 1) measure(n);
      more = probe_.known() ? std::min(left, left_after(directions)) : left;
      bool const stays = passes_ > 2 && left >= 0.8 * before, shrinks = passes_ > 2 && left * left <= 1e-14 * before;
      if (more <= (factors_.are_exact() ? 1e-11 : 1e-12) || ((stays || shrinks) && left <= 1e-10)) break;
      if (passes_ == 1 || left <= slow * before || factors_.are_nearest()) continue;
      factors_.set_nearest(step);
      probe_.forget();
    }
    factors_.took(std::min(passes_, most_passes));
    if (left > 1e-12) dual_.plus(from_, delta_, q_);  // otherwise the change of q is below its round-off
    take_end(step, directions);
    return more;
  }

 private:
  using D = Dual<max_directions>;
  using Dots = VecXOf<D>;
  using Partials = typename D::Partials;
  static constexpr int most_passes = 30;
  static constexpr double slow = 0.1;  // contraction rate above which the most accurate factorisation is used

  static std::vector<PreconditionerChoice::Candidate> candidates() {
    return {{ApproximateFactors::of_step, 0.0},
            {ApproximateFactors::of_end, 0.7},
            {ApproximateFactors::exact, 2.0},
            {ApproximateFactors::turned, 2.5}};
  }

  /// Vectors of all directions; operator[](i) returns entry i of each. The vector of the probe replaces missing
  /// directions.
  struct Side {
    std::array<double const*, std::size_t(max_directions)> of;
    Partials operator[](Index i) const {
      Partials out;
      for (std::size_t l = 0; l < of.size(); ++l) out[Index(l)] = of[l][i];
      return out;
    }
  };
  template <class F>
  static Side side(std::size_t count, F const& vector_of) {
    Side out;
    for (std::size_t l = 0; l < out.of.size(); ++l) out.of[l] = vector_of(std::min(l, count)).data();
    return out;
  }

  /// Direction of lane l of the dual numbers. In a lane without a direction only y changes, for the probe.
  StepDirection const& along(std::span<StepDirection const> directions, std::size_t l) const {
    return l < directions.size() ? directions[l] : at_rest_;
  }

  /// Sets y to initial values of the changes of a₁ and λ₁: the changes in the previous step, or their extrapolation if
  /// `far` is true.
  void guess(StepEnds const& step, StepDirection const& along, bool far, VecX& y) {
    AlphaMethod const& m = method_;
    State& dx = *along.dx;
    Index const nv = a_.size(), rows = lambda_.size();
    y.head(nv) = StepHistory::own_of(dx);
    y.tail(rows) = dx.lambda.head(rows);
    if (!far) return;
    multipliers_.resize(dx.lambda.size());
    StepHistory(dx).extrapolate(dx, step.h, guess_, multipliers_);
    y.head(nv) =
        ((1.0 - m.alpha_f) * guess_ + m.alpha_f * dx.a - m.alpha_m * StepHistory::own_of(dx)) / (1.0 - m.alpha_m);
    y.tail(rows) = multipliers_.head(rows);
  }

  /// Computes the changes of δ, v₁, v̇₁ and λ₁ from the unknowns y of each direction.
  void find_end(StepEnds const& step, std::span<StepDirection const> directions) {
    AlphaMethod const& m = method_;
    std::size_t const n = directions.size();
    double const h = step.h, h2 = h * h, of_a0 = h2 * (0.5 - m.beta), of_a1 = h2 * m.beta;
    auto const state = [&](std::size_t l) -> State const& { return *along(directions, l).dx; };
    Side const q = side(n, [&](std::size_t l) -> VecX const& { return state(l).q; }),
               v = side(n, [&](std::size_t l) -> VecX const& { return state(l).v; }),
               a = side(n, [&](std::size_t l) -> VecX const& { return state(l).a; }),
               own = side(n, [&](std::size_t l) -> VecX const& { return state(l).history; }),
               y = side(n, [&](std::size_t l) -> VecX const& { return y_[l]; });
    Partials dh;
    for (std::size_t l = 0; l < std::size_t(max_directions); ++l) dh[Index(l)] = along(directions, l).dh;
    for (Index i = 0; i < from_.size(); ++i) from_[i].d = q[i];
    for (Index i = 0; i < a_.size(); ++i) {
      Partials const v0 = v[i], a0 = own[i], a1 = y[i];
      double const own0 = step.own_before[i], own1 = step.own_after[i];
      a_[i].d = ((1.0 - m.alpha_m) * a1 + m.alpha_m * a0 - m.alpha_f * a[i]) / (1.0 - m.alpha_f);
      v_[i].d = v0 + h * ((1.0 - m.gamma) * a0 + m.gamma * a1) + dh * ((1.0 - m.gamma) * own0 + m.gamma * own1);
      delta_[i].d = h * v0 + of_a0 * a0 + of_a1 * a1 +
                    dh * (step.before.v[i] + h * ((1.0 - 2.0 * m.beta) * own0 + 2.0 * m.beta * own1));
    }
    for (Index i = 0; i < lambda_.size(); ++i) lambda_[i].d = y[a_.size() + i];
  }

  /// Evaluates the equations and corrects y. Returns the largest relative correction.
  double correct(StepEnds const& step, std::span<StepDirection const> directions) {
    Index const nv = a_.size(), rows = lambda_.size();
    evaluate(step);
    right_hand_sides(step, directions);
    double most = 0.0;
    for (std::size_t l = 0; l < directions.size(); ++l) {
      VecX &y = y_[l], &correction = correction_[l];
      factors_.solve(rhs_[l], correction);
      y += correction;
      double const scale = directions[l].by.scale;
      most = std::max({most, part(correction.head(nv), y.head(nv), size_of_a_ / scale),
                       part(correction.tail(rows), y.tail(rows), size_of_lambda_ / scale)});
    }
    apply(step.h, directions.size());
    return most;
  }
  /// Passes the result of the probe in lane l to the error estimate.
  void measure(std::size_t l) {
    factors_.solve(rhs_[l], correction_[l]);
    correction_[l] += y_[l];
    probe_.measure(correction_[l]);
  }
  /// Estimate of the largest relative correction in the next iteration.
  double left_after(std::span<StepDirection const> directions) const {
    Index const nv = a_.size(), rows = lambda_.size();
    double most = 0.0;
    for (std::size_t l = 0; l < directions.size(); ++l) {
      double const scale = directions[l].by.scale;
      CorrectionErrorEstimate::Parts const left = probe_.bound(correction_[l]);
      most = std::max({most, relative(left.a, y_[l].head(nv), size_of_a_ / scale),
                       relative(left.lambda, y_[l].tail(rows), size_of_lambda_ / scale)});
    }
    return most;
  }
  template <class B>
  static double relative(double size, B const& y, double least) {
    double const all = std::max(y.norm(), least);
    return all > 0.0 ? size / all : size;
  }
  template <class A, class B>
  static double part(A const& correction, B const& y, double least) {
    return relative(correction.norm(), y, least);
  }
  /// Evaluates M v̇ − f + Gᵀλ, Φ and, for nonholonomic constraints, Φ̇ at the end of the step.
  void evaluate(StepEnds const& step) {
    dual_.plus(from_, delta_, q_);
    dual_.evaluate(q_, v_, step.after.t);
    dual_.residual(a_, lambda_, r_);
    if (phi_.size() > 0) dual_.violation(phi_);
    if (!dual_.nonholonomic_equations().empty()) dual_.violation_rate(rate_);
  }
  /// Computes −δ[M v̇ − f + Gᵀλ] and −δΦ/βh² (nonholonomic: −δΦ̇/γh) of each direction, including the effect of its
  /// parameter.
  void right_hand_sides(StepEnds const& step, std::span<StepDirection const> directions) {
    double const of_position = -1.0 / (method_.beta * step.h * step.h), of_velocity = -1.0 / (method_.gamma * step.h);
    Index const nv = r_.size();
    std::size_t const with_probe = std::min(directions.size() + 1, std::size_t(max_directions));
    for (std::size_t l = 0; l < with_probe; ++l) {
      EquationDerivative const& of = along(directions, l).by;
      for (Index i = 0; i < nv; ++i) rhs_[l][i] = -(r_[i].d[Index(l)] + of.balance[i]);
      for (Index i = 0; i < phi_.size(); ++i) rhs_[l][nv + i] = of_position * (phi_[i].d[Index(l)] + of.rows[i]);
      for (Index const i : dual_.nonholonomic_equations())
        rhs_[l][nv + i] = of_velocity * (rate_[i].d[Index(l)] + of.rows[i]);
    }
  }
  /// Adds the effect of the correction of y to the derivatives at the end of the step.
  void apply(double h, std::size_t count) {
    double const of_a = method_.mass(), of_v = method_.gamma * h, of_delta = method_.beta * h * h;
    Side const by = side(count, [&](std::size_t l) -> VecX const& { return correction_[l]; });
    for (Index i = 0; i < a_.size(); ++i) {
      Partials const change = by[i];
      a_[i].d += of_a * change;
      v_[i].d += of_v * change;
      delta_[i].d += of_delta * change;
    }
    for (Index i = 0; i < lambda_.size(); ++i) lambda_[i].d += by[a_.size() + i];
  }

  /// Replaces the derivatives of the state before the step by derivatives of the state after the step.
  void take_end(StepEnds const& step, std::span<StepDirection const> directions) {
    Index const nv = a_.size();
    for (std::size_t l = 0; l < directions.size(); ++l) {
      State& dx = *directions[l].dx;
      guess_ = y_[l].head(nv);
      StepHistory(dx).push(dx, step.h, guess_);
      probe_.add(y_[l], directions[l].by.scale);
    }
    auto const take = [&](Dots const& from, VecX State::* part) {
      for (Index i = 0; i < from.size(); ++i)
        for (std::size_t l = 0; l < directions.size(); ++l) (directions[l].dx->*part)[i] = from[i].d[Index(l)];
    };
    take(q_, &State::q);
    take(v_, &State::v);
    take(a_, &State::a);
    take(lambda_, &State::lambda);
  }

  BasicSystem<D> dual_;
  AlphaMethod method_;
  StepFactorisations<Solver, Derivative::direct> factors_;
  CorrectionErrorEstimate probe_;
  State still_;            // zero change of the state before a step
  StepDirection at_rest_;  // direction in which only y changes
  int passes_ = 1;         // number of evaluations for the last group of directions
  double size_of_a_ = 0.0, size_of_lambda_ = 0.0;
  Dots from_, delta_, q_, v_, a_, lambda_, r_, phi_, rate_;
  std::array<VecX, std::size_t(max_directions)> y_, rhs_, correction_;  // y: changes of a₁ and λ₁, of each direction
  VecX guess_, multipliers_;
};

}  // namespace polybody
