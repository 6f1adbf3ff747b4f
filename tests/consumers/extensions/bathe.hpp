#pragma once
// User-defined integrator: the requirements of the concept `polybody::Integrator`, with `System` alone.
#include <polybody/polybody.hpp>

namespace own {

using namespace polybody;

/// Bathe's method of two sub-steps, of order two and L-stable [Bank et al. 1985; Bathe & Baig 2005]. It uses the
/// trapezoidal rule to t + (2 − √2) h, then the second-order backward difference formula, on q₀ ⊞ δ with δ˙ =
/// local_rate(δ, v):
///   y₁ = y₀ + b (y˙₀ + y˙₁),  y₂ = c₁ y₁ − c₀ y₀ + b y˙₂,  y = (δ, v),  b = (1 − √½) h,  2 c₁ = √2 + 1,  2 c₀ = √2 −
///   1,
/// Both sub-steps end with M v̇ + Gᵀλ = f and Φ = 0. At the end of the step the velocities satisfy the constraint
/// equations, and the accelerations are consistent with them.
struct Bathe {
  static constexpr char const* name = "Bathe";
  static constexpr int order = 2;
  static constexpr bool accepts_constraints = true;
  static constexpr Capabilities capabilities =
      Capabilities::tangent;  ///< entries that it calls in addition to `Capabilities::motion`

  double tolerance = 1e-13;  ///< relative tolerance of Newton's corrections of δ, scaled by 1 + max |q|
  int max_iterations = 30;

  void check() const { require_positive(tolerance, "Bathe: the tolerance"); }

  /// Workspace of a step, allocated once. Simulations use `forward` for consistent initial conditions.
  template <class Solver>
  struct Workspace {
    VecX q, v, a, lambda, delta, rate, known_delta, known_v, r, phi, phi_rate, rhs, y;
    TangentSolver<Solver> solver;
    ForwardDynamics<Solver> forward;
    StepCheck check;

    explicit Workspace(System& s)
        : q(VecX::Zero(s.coordinates())),
          v(VecX::Zero(s.velocities())),
          a(v),
          lambda(VecX::Zero(s.rows())),
          delta(v),
          rate(v),
          known_delta(v),
          known_v(v),
          r(v),
          phi(lambda),
          phi_rate(lambda),
          rhs(VecX::Zero(s.size())),
          y(rhs),
          forward(s) {
      solver.analyse(s, 1, [&](BlockSink& sink) { s.tangent({1.0, 1.0, 1.0}, SecondOrder::omitted, lambda, sink); });
    }
  };
  template <class Solver>
  Workspace<Solver> workspace(System& system) const {
    return Workspace<Solver>(system);
  }

  /// Consistent accelerations; q and v do not change.
  template <class W>
  void start(System& system, State& x, double, W& w) const {
    w.forward.accelerations(system, {x.q, x.v, x.t}, x.a, x.lambda);
  }

  /// x changes only at the end, after all operations that can throw.
  template <class W>
  StepReport step(System& system, State& x, double h, W& w) const {
    double const root = std::sqrt(2.0), b = (1.0 - 0.5 * root) * h;
    StepReport report{.taken = h, .next = h};
    w.a = x.a;
    w.lambda = x.lambda;
    w.known_delta = b * x.v;
    w.known_v = x.v + b * x.a;
    solve(system, x, x.t + (2.0 - root) * h, b, w, report);
    w.known_delta = 0.5 * (root + 1.0) * w.delta;
    w.known_v = 0.5 * (root + 1.0) * w.v - 0.5 * (root - 1.0) * x.v;
    solve(system, x, x.t + h, b, w, report);
    w.forward.project_velocities(system, w.q, w.v, x.t + h);
    w.forward.accelerations(system, {w.q, w.v, x.t + h}, w.a, w.lambda);
    x.q.swap(w.q);
    x.v.swap(w.v);
    x.a.swap(w.a);
    x.lambda.swap(w.lambda);
    x.t += h;
    report.evaluations += 2;
    return report;
  }

 private:
  /// v = known_v + b v̇ and δ = known_delta + b δ˙ with the balance and the constraint equations at time t. Newton's
  /// unknowns are Δv̇ and Δλ: Δv = b Δv̇, Δδ = b² Δv̇. The constraint equations are divided by b².
  template <class W>
  void solve(System& system, State const& x, double t, double b, W& w, StepReport& report) const {
    Index const nv = system.velocities(), rows = system.rows();
    double const enough = tolerance * (1.0 + x.q.cwiseAbs().maxCoeff());
    w.v = w.known_v + b * w.a;
    w.delta = w.known_delta + b * w.v;
    for (int k = 0; k < max_iterations; ++k) {
      move(system, x, b, w);
      system.evaluate(w.q, w.v, t);
      system.residual(w.a, w.lambda, w.r);
      system.violation(w.phi);
      w.rhs.head(nv) = -w.r;
      w.rhs.tail(rows) = w.phi / -(b * b);
      if (!system.nonholonomic_equations().empty()) {  // these constraint equations have a rate only
        system.violation_rate(w.phi_rate);
        for (Index const i : system.nonholonomic_equations()) w.rhs[nv + i] = w.phi_rate[i] / -b;
      }
      ++report.evaluations;
      if (!w.rhs.allFinite())
        throw NonFiniteValue("Bathe: the forces or the rows are not finite at t = " + number(t) +
                             " s. Take a smaller step.");
      if (k == 0) {
        TangentCoefficients const c{.mass = 1.0, .damping = b, .stiffness = b * b};
        Index const bad =
            w.solver.factor([&](BlockSink& sink) { system.tangent(c, SecondOrder::omitted, w.lambda, sink); });
        if (bad >= 0)
          throw SingularMatrix("Bathe: the step has no unique solution at t = " + number(t) + " s; see " +
                               name_of_equation(system, bad) + ".");
        ++report.factorisations;
      }
      w.solver.solve(w.rhs, w.y);
      w.a += w.y.head(nv);
      w.lambda += w.y.tail(rows);
      w.v = w.known_v + b * w.a;
      ++report.iterations;
      if (b * b * w.y.head(nv).norm() <= enough) {
        move(system, x, b, w);
        return;
      }
    }
    throw NewtonConvergenceFailure("Bathe: Newton's method does not converge at t = " + number(t) +
                                   " s. Take a smaller step.");
  }
  /// δ and q of the velocity v.
  template <class W>
  void move(System& system, State const& x, double b, W& w) const {
    system.local_rate(w.delta, w.v, w.rate);
    w.delta = w.known_delta + b * w.rate;
    system.plus(x.q, w.delta, w.q);
  }
};

static_assert(Integrator<Bathe>);

}  // namespace own
