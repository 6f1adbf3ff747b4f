#pragma once
/// \file
/// The tangent-linear of a converged step of the generalised-α family (integrators/alpha_method.hpp), exactly: with
/// what Newton's matrix leaves out.
///
/// With y = (δa₁, δλ₁) and the changes of q₀, v₀, v̇₀, a₀ and of the equations by a parameter, those of q₁, v₁, v̇₁
/// follow from the formulas of the step, and
///   δ[M v̇₁ − f₁ + G₁ᵀλ₁] = 0,  δΦ(q₁)/βh² = 0  (of velocity rows δΦ̇/γh)
/// is linear in y. Its left side comes from one pass of dual numbers through the residual, so no term is missing: not
/// the derivative of ⊞, not ∂(Gᵀλ)/∂q. It is solved by the factors of the tangent with second-order terms at the end of
/// the step, and corrected until nothing changes.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <polybody/integrators/alpha_method.hpp>

namespace polybody {

/// What a parameter does to the equations of a step at its end while unknowns stay: ∂r/∂p (nv) and ∂Φ/∂p, of velocity
/// rows ∂Φ̇/∂p (rows).
struct EquationSlope {
  VecX balance;        ///< (nv) ∂r/∂p
  VecX rows;           ///< (rows) ∂Φ/∂p
  double scale = 1.0;  ///< of the parameter, in its own unit: over it a and λ may change by their own size
};

/// The ends of a step of h: its state before and after, and the method's own accelerations there.
struct StepEnds {
  State const& before;     ///< at its start
  State const& after;      ///< at its end
  VecX const& own_before;  ///< (nv) a₀
  VecX const& own_after;   ///< (nv) a₁
  double h;                ///< [s]
};

/// Slopes of converged steps of a method, one step after the other.
template <LinearSolver Solver = DefaultSolver>
class AlphaStepSlope {
  using D = Dual<1>;
  using Dots = VecXOf<D>;

 public:
  /// The model must outlive it.
  template <class M>
  [[gnu::cold]] AlphaStepSlope(M const& model, System& system, AlphaMethod const& method)
      : system_(&system), dual_(model, with<Entries::motion>), method_(method) {
    VecX const any = VecX::Zero(system.rows());
    solver_.analyse(system, 1,
                    [&](BlockSink& sink) { system.tangent({1.0, 1.0, 1.0}, SecondOrder::included, any, sink); });
    r_ = Dots::Constant(system.speeds(), D(0.0));
    phi_ = rate_ = Dots::Constant(system.rows(), D(0.0));
  }

  /// From now on slopes are those of this step. \throws LinearSolverSingular at a singular position.
  void set(StepEnds const& step) {
    double const c = (1.0 - method_.alpha_m) / (1.0 - method_.alpha_f), h = step.h;
    State const& x = step.after;
    TangentCoefficients const k{c, method_.gamma * h, method_.beta * h * h};
    for (bool again = true; again;) {
      system_->evaluate(x.q, x.v, x.t);
      std::size_t const reordered = solver_.reorderings();
      Index const bad = solver_.factor_tangent(*system_, {{x.q, x.v, x.t}, x.a, x.lambda}, k, SecondOrder::included);
      again = bad >= 0 && solver_.reorderings() != reordered;
      if (bad >= 0 && !again)
        throw LinearSolverSingular{"The derivative of the step that ends at t = ", x.t, " s has no pivot at ",
                                   name_of_equation(*system_, bad), "."};
    }
  }

  /// dx, the derivative of the state before the step, becomes that of the state after it. \param own that of the
  /// method's accelerations, likewise. Returns what the last correction changed, beside all, or beside a and λ over the
  /// parameter's scale where that is more.
  double advance(StepEnds const& step, EquationSlope const& by, State& dx, VecX& own) {
    Index const nv = dx.v.size(), rows = dx.lambda.size();
    VecX y = VecX::Zero(nv + rows), rhs = y, correction = y;
    State after = dx;
    double left = std::numeric_limits<double>::infinity();
    for (int k = 0; k < most_corrections; ++k) {
      after = end_of(step, dx, own, y);
      differentiate(step, after, by, rhs);
      solver_.solve(rhs, correction);
      y += correction;
      double const now = std::max(part(correction.head(nv), y.head(nv), step.after.a, by.scale),
                                  part(correction.tail(rows), y.tail(rows), step.after.lambda, by.scale));
      bool const done = now <= 1e-15 || (k > 1 && now <= 1e-10 && now >= 0.3 * left);
      left = now;
      if (done) break;
    }
    after = end_of(step, dx, own, y);
    own = y.head(nv);
    after.memory = dx.memory;
    StepHistory(after).push(dx, step.h, own);
    dx = std::move(after);
    return left;
  }

 private:
  static constexpr int most_corrections = 30;

  static double part(VecX const& correction, VecX const& y, VecX const& now, double scale) {
    double const all = std::max(y.norm(), now.norm() / scale);
    return all > 0.0 ? correction.norm() / all : correction.norm();
  }

  /// δq₁, δv₁, δv̇₁ and δλ₁.
  State end_of(StepEnds const& step, State const& dx, VecX const& own, VecX const& y) {
    Index const nv = dx.v.size();
    AlphaMethod const& m = method_;
    double const h = step.h, h2 = h * h;
    State out = dx;
    out.lambda = y.tail(y.size() - nv);
    delta_.resize(nv);
    for (Index i = 0; i < nv; ++i) {
      double const a0 = own[i], a1 = y[i];
      out.a[i] = ((1.0 - m.alpha_m) * a1 + m.alpha_m * a0 - m.alpha_f * dx.a[i]) / (1.0 - m.alpha_f);
      out.v[i] = dx.v[i] + h * ((1.0 - m.gamma) * a0 + m.gamma * a1);
      delta_[i] = D(h * step.before.v[i] + h2 * ((0.5 - m.beta) * step.own_before[i] + m.beta * step.own_after[i]));
      delta_[i].d[0] = h * dx.v[i] + h2 * ((0.5 - m.beta) * a0 + m.beta * a1);
    }
    set(from_, step.before.q, dx.q);
    to_.resize(from_.size());
    dual_.plus(from_, delta_, to_);
    for (Index i = 0; i < to_.size(); ++i) out.q[i] = to_[i].d[0];
    return out;
  }

  /// −δ[M v̇ − f + Gᵀλ] and −δΦ/βh² at the end of the step, with what the parameter does.
  void differentiate(StepEnds const& step, State const& dx, EquationSlope const& by, VecX& rhs) {
    State const& x = step.after;
    set(q_, x.q, dx.q);
    set(v_, x.v, dx.v);
    set(a_, x.a, dx.a);
    set(lambda_, x.lambda, dx.lambda);
    dual_.evaluate(q_, v_, x.t);
    dual_.residual(a_, lambda_, r_);
    Index const nv = r_.size();
    for (Index i = 0; i < nv; ++i) rhs[i] = -(r_[i].d[0] + by.balance[i]);
    if (phi_.size() == 0) return;
    dual_.violation(phi_);
    double const of_position = -1.0 / (method_.beta * step.h * step.h), of_speed = -1.0 / (method_.gamma * step.h);
    for (Index i = 0; i < phi_.size(); ++i) rhs[nv + i] = of_position * (phi_[i].d[0] + by.rows[i]);
    if (dual_.velocity_rows().empty()) return;
    dual_.violation_rate(rate_);
    for (Index const i : dual_.velocity_rows()) rhs[nv + i] = of_speed * (rate_[i].d[0] + by.rows[i]);
  }

  static void set(Dots& out, VecX const& value, VecX const& dot) {
    out.resize(value.size());
    for (Index i = 0; i < value.size(); ++i) {
      out[i] = D(value[i]);
      out[i].d[0] = dot[i];
    }
  }

  System* system_;
  BasicSystem<D> dual_;
  TangentSolver<SolverOfSteps<Solver>> solver_;
  AlphaMethod method_;
  Dots from_, delta_, to_, q_, v_, a_, lambda_, r_, phi_, rate_;
};

}  // namespace polybody
