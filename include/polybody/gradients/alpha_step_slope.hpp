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

#include <array>
#include <span>

#include <polybody/integrators/alpha_method.hpp>
#include <polybody/solvers/reduced_coordinates.hpp>

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
  State const& before;     ///< at its start, with the speeds that the step set out with
  State const& after;      ///< at its end
  VecX const& own_before;  ///< (nv) a₀
  VecX const& own_after;   ///< (nv) a₁
  double h;                ///< [s]
};

/// A direction along which a step is differentiated.
struct StepDirection {
  EquationSlope by;  ///< what the parameter does to the equations at the end of the step
  State* dx;         ///< the derivative of the state before the step; it becomes that of the state after it
  double dh = 0.0;   ///< that of the length of the step [s]; what the time of its end does to the equations is in `by`
};

namespace detail {
/// The system at a place where its tangent with second-order terms is asked: what eliminated joints hold is taken from
/// the residual that was reduced last. \param r (nv) is scratch
template <class = void>
void evaluate_for_tangent(System& system, StepPlace const& x, VecX& r) {
  system.evaluate(x.at.q, x.at.v, x.at.t);
  if (!system.step_coordinates()) return;
  r.resize(system.speeds());
  system.residual(x.a, x.lambda, r);
}
}  // namespace detail

/// Slopes of converged steps of a method, one step after the other.
template <LinearSolver Solver = DefaultSolver>
class AlphaStepSlope {
 public:
  /// Directions that go through the equations together, a part of a dual number each.
  static constexpr int lanes = 4;

  /// The model must outlive it.
  template <class M>
  [[gnu::cold]] AlphaStepSlope(M const& model, System& system, AlphaMethod const& method)
      : system_(&system), dual_(stepped_system<D>(model, with<Entries::motion>)), method_(method) {
    VecX const any = VecX::Zero(system.rows());
    solver_.analyse(system, 1,
                    [&](BlockSink& sink) { system.tangent({1.0, 1.0, 1.0}, SecondOrder::included, any, sink); });
    Index const nq = system.coordinates(), nv = system.speeds(), rows = system.rows();
    from_ = q_ = Dots::Constant(nq, D(0.0));
    delta_ = v_ = a_ = r_ = Dots::Constant(nv, D(0.0));
    lambda_ = phi_ = rate_ = Dots::Constant(rows, D(0.0));
    rhs_ = correction_ = VecX::Zero(nv + rows);
    for (VecX& y : y_) y = rhs_;
  }

  /// From now on slopes are those of this step. \throws LinearSolverSingular at a singular position.
  void set(StepEnds const& step) {
    double const c = (1.0 - method_.alpha_m) / (1.0 - method_.alpha_f), h = step.h;
    State const& x = step.after;
    TangentCoefficients const k{c, method_.gamma * h, method_.beta * h * h};
    for (bool again = true; again;) {
      detail::evaluate_for_tangent(*system_, {{x.q, x.v, x.t}, x.a, x.lambda}, own_);
      std::size_t const reordered = solver_.reorderings();
      Index const bad = solver_.factor_tangent(*system_, {{x.q, x.v, x.t}, x.a, x.lambda}, k, SecondOrder::included);
      again = bad >= 0 && solver_.reorderings() != reordered;
      if (bad >= 0 && !again)
        throw LinearSolverSingular{"The derivative of the step that ends at t = ", x.t, " s has no pivot at ",
                                   name_of_equation(*system_, bad), "."};
    }
  }

  /// Takes up to `lanes` directions over the step. Returns what the last corrections changed at most, beside all, or
  /// beside a and λ over a parameter's scale where that is more.
  double advance(StepEnds const& step, std::span<StepDirection const> directions) {
    Index const nv = a_.size(), rows = lambda_.size();
    for (std::size_t l = 0; l < directions.size(); ++l) {  // as they were: near what they become
      State const& dx = *directions[l].dx;
      y_[l].head(nv) = dx.memory.head(nv);
      y_[l].tail(rows) = dx.lambda.head(rows);
    }
    double left = std::numeric_limits<double>::infinity();
    for (int k = 0; k < most_corrections; ++k) {
      find_end(step, directions);
      evaluate(step);
      double now = 0.0;
      for (std::size_t l = 0; l < directions.size(); ++l) {
        EquationSlope const& by = directions[l].by;
        VecX& y = y_[l];
        right_hand_side(step, by, Index(l));
        solver_.solve(rhs_, correction_);
        y += correction_;
        now = std::max({now, part(correction_.head(nv), y.head(nv), step.after.a, by.scale),
                        part(correction_.tail(rows), y.tail(rows), step.after.lambda, by.scale)});
      }
      bool const done = now <= 1e-15 || (k > 1 && now <= 1e-10 && now >= 0.3 * left);
      left = now;
      if (done) break;
    }
    find_end(step, directions);
    for (std::size_t l = 0; l < directions.size(); ++l) take_end(step, *directions[l].dx, Index(l));
    return left;
  }

 private:
  using D = Dual<lanes>;
  using Dots = VecXOf<D>;
  static constexpr int most_corrections = 30;

  template <class A, class B>
  static double part(A const& correction, B const& y, VecX const& now, double scale) {
    double const all = std::max(y.norm(), now.norm() / scale);
    return all > 0.0 ? correction.norm() / all : correction.norm();
  }

  /// q₁, v₁, v̇₁ and λ₁ with their changes by the y of each direction.
  void find_end(StepEnds const& step, std::span<StepDirection const> directions) {
    State const &before = step.before, &after = step.after;
    AlphaMethod const& m = method_;
    Index const nv = a_.size();
    double const h = step.h, h2 = h * h, of_a0 = h2 * (0.5 - m.beta), of_a1 = h2 * m.beta;
    for (Index i = 0; i < from_.size(); ++i) from_[i] = D(before.q[i]);
    for (Index i = 0; i < nv; ++i) {
      a_[i] = D(after.a[i]);
      v_[i] = D(after.v[i]);
      delta_[i] = D(h * before.v[i] + of_a0 * step.own_before[i] + of_a1 * step.own_after[i]);
    }
    for (Index i = 0; i < lambda_.size(); ++i) lambda_[i] = D(after.lambda[i]);
    for (std::size_t l = 0; l < directions.size(); ++l) {
      State const& dx = *directions[l].dx;
      VecX const& y = y_[l];
      Index const k = Index(l);
      double const dh = directions[l].dh;
      for (Index i = 0; i < from_.size(); ++i) from_[i].d[k] = dx.q[i];
      for (Index i = 0; i < nv; ++i) {
        double const a0 = dx.memory[i], a1 = y[i];
        a_[i].d[k] = ((1.0 - m.alpha_m) * a1 + m.alpha_m * a0 - m.alpha_f * dx.a[i]) / (1.0 - m.alpha_f);
        v_[i].d[k] = dx.v[i] + h * ((1.0 - m.gamma) * a0 + m.gamma * a1);
        delta_[i].d[k] = h * dx.v[i] + of_a0 * a0 + of_a1 * a1;
        if (dh == 0.0) continue;
        double const own0 = step.own_before[i], own1 = step.own_after[i];
        v_[i].d[k] += dh * ((1.0 - m.gamma) * own0 + m.gamma * own1);
        delta_[i].d[k] += dh * (before.v[i] + h * ((1.0 - 2.0 * m.beta) * own0 + 2.0 * m.beta * own1));
      }
      for (Index i = 0; i < lambda_.size(); ++i) lambda_[i].d[k] = y[nv + i];
    }
    dual_.plus(from_, delta_, q_);
  }

  /// M v̇ − f + Gᵀλ, Φ and, where velocity rows are, Φ̇ there.
  void evaluate(StepEnds const& step) {
    dual_.evaluate(q_, v_, step.after.t);
    dual_.residual(a_, lambda_, r_);
    if (phi_.size() > 0) dual_.violation(phi_);
    if (!dual_.velocity_rows().empty()) dual_.violation_rate(rate_);
  }
  /// −δ[M v̇ − f + Gᵀλ] and −δΦ/βh² (−δΦ̇/γh) of direction l, with what the parameter does.
  void right_hand_side(StepEnds const& step, EquationSlope const& by, Index l) {
    double const of_position = -1.0 / (method_.beta * step.h * step.h), of_speed = -1.0 / (method_.gamma * step.h);
    Index const nv = r_.size();
    for (Index i = 0; i < nv; ++i) rhs_[i] = -(r_[i].d[l] + by.balance[i]);
    for (Index i = 0; i < phi_.size(); ++i) rhs_[nv + i] = of_position * (phi_[i].d[l] + by.rows[i]);
    for (Index const i : dual_.velocity_rows()) rhs_[nv + i] = of_speed * (rate_[i].d[l] + by.rows[i]);
  }
  /// dx becomes the derivative of the state after the step.
  void take_end(StepEnds const& step, State& dx, Index l) {
    Index const nv = a_.size();
    own_ = y_[std::size_t(l)].head(nv);
    StepHistory(dx).push(dx, step.h, own_);
    for (Index i = 0; i < q_.size(); ++i) dx.q[i] = q_[i].d[l];
    for (Index i = 0; i < nv; ++i) {
      dx.v[i] = v_[i].d[l];
      dx.a[i] = a_[i].d[l];
    }
    for (Index i = 0; i < lambda_.size(); ++i) dx.lambda[i] = lambda_[i].d[l];
  }

  System* system_;
  BasicSystem<D> dual_;
  TangentSolver<SolverOfSteps<Solver>> solver_;
  AlphaMethod method_;
  Dots from_, delta_, q_, v_, a_, lambda_, r_, phi_, rate_;
  std::array<VecX, std::size_t(lanes)> y_;  // changes of a₁ and λ₁, of each direction
  VecX rhs_, correction_, own_;
};

}  // namespace polybody
