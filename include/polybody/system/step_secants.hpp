#pragma once
/// \file
/// Evaluation of a system over an energy-conserving step from q₀ to q₁, with secant slopes instead of derivatives. The
/// changes of every potential and constraint function are then exact to round-off [Gonzalez 1996, 1999]:
///   f·Δq = −ΔV minus the dissipated energy,   Ḡ Δq = ΔΦ.
/// Theory: Eq. 6.19.

#include <polybody/system/system.hpp>

namespace polybody {

/// Step of length h from q0 at time t to q1.
struct SecantStep {
  VecX const* q0 = nullptr;  ///< (nq) coordinates at the beginning of the step
  VecX const* q1 = nullptr;  ///< (nq) coordinates at the end of the step
  double t = 0.0;            ///< time at the beginning of the step [s]
  double h = 0.0;            ///< length of the step [s]
  double decay = 0.0;        ///< χ [1]; the step dissipates χ ΔεᵀCΔε, with the strains ε and the elastic stiffness C
  VecX const* v0 = nullptr;  ///< (nv) velocities at t
  VecX const* a = nullptr;   ///< (nv) mean accelerations, and rates of first-order states
};

/// Functions of a model for a `SecantStep`.
class SecantOperations {
 public:
  virtual ~SecantOperations() = default;
  /// Writes the coordinates at the end of a step from q0 with the increments y = h v₀ + (½ + χ) h² a to q1.
  virtual void move(VecX const& q0, VecX const& y, VecX& q1) const = 0;
  /// Sets the step for the other functions.
  virtual void evaluate(SecantStep const& step) = 0;
  virtual VecX const& middle() const = 0;  ///< coordinates in the middle of the step
  /// r = M a − f + Ḡᵀλ over the step (nv).
  virtual void residual(Data<double> const& data, VecX const& a, VecX const& lambda, VecX& r) = 0;
  virtual void violation(VecX& phi) const = 0;              ///< writes Φ(q₁) to phi
  virtual void tangent(double scale, BlockSink& sink) = 0;  ///< adds [M + scale K̄, Ḡᵀ; Ḡ, 0]
};

/// Mean forces, constraint Jacobians and tangents over a step, for energy-conserving integration.
class StepSecants {
 public:
  /// Allocates the workspace. \throws InvalidInput for a system without `Capabilities::secants`.
  explicit StepSecants(System const& system)
      : operations_(system.operations().make_secants(system.data())), speed_(VecX::Zero(system.velocities())) {}

  /// Writes the coordinates at the end of `step` from q0 to `q1`.
  void move(SecantStep const& step, VecX& q1) {
    double const linear = step.h, square = (0.5 + step.decay) * step.h * step.h;
    for (Index i = 0; i < speed_.size(); ++i) speed_[i] = linear * (*step.v0)[i] + square * (*step.a)[i];
    operations_->move(*step.q0, speed_, q1);
  }

  /// Sets the step. Constraint functions of time are evaluated at the end of the step, loads and first-order states at
  /// the midpoint. Afterwards `system` is evaluated at the midpoint.
  void evaluate(System& system, SecantStep const& step) {
    h_ = step.h;
    Index const bodies = system.layout().body_velocities();
    for (Index i = 0; i < speed_.size(); ++i)
      speed_[i] = (*step.v0)[i] + (i < bodies ? 0.5 + step.decay : 0.5) * step.h * (*step.a)[i];
    operations_->evaluate(step);
    system.evaluate(operations_->middle(), speed_, step.t + 0.5 * step.h);
  }
  /// r = M a − f + Ḡᵀλ over the step (nv).
  void residual(System const& system, VecX const& a, VecX const& lambda, VecX& r) const {
    operations_->residual(system.data(), a, lambda, r);
  }
  /// `phi` = Φ(q₁).
  void violation(VecX& phi) const { operations_->violation(phi); }
  /// Adds [M + s K̄, Ḡᵀ; Ḡ, 0] to `sink`. K̄ is a symmetric approximation of −∂f/∂q₁ without the change of Ḡ, and Ḡ
  /// approximates ∂Φ/∂q₁. The relative errors of K̄ and Ḡ are about the fraction of a revolution that a body makes in
  /// the step. Newton's method therefore contracts.
  void tangent(System& system, double s, BlockSink& sink) {
    operations_->tangent(s, sink);
    system.tangent_of(TangentPart::force_elements, {.damping = s / h_, .stiffness = 0.5 * s, .states = 0.5 * h_}, sink);
  }

  /// Adds [M + s K̄, Ḡᵀ; G(q₁), 0] of `step` to `sink`. K̄ includes ½ ∂(Gᵀλ)/∂q at the midpoint, because for constraint
  /// functions that are quadratic in q, Ḡ equals G at the midpoint. If G loses rank within the step, Ḡ does not
  /// approximate G(q₁). Even the directions of rotation that Ḡ and G(q₁) permit can differ.
  void exact_tangent(System& system, SecantStep const& step, double s, VecX const& lambda, BlockSink& sink) {
    evaluate(system, step);
    Half forces{sink, system.velocities(), true}, rows{sink, system.velocities(), false};
    BlockSink to_forces(forces), to_rows(rows);
    operations_->tangent(s, to_forces);
    system.tangent_of(TangentPart::force_elements, {.damping = s / h_, .stiffness = 0.5 * s, .states = 0.5 * h_}, sink,
                      &lambda);
    SecantStep end = step;  // step of zero length: its secants are tangents
    end.q0 = step.q1;
    operations_->evaluate(end);
    operations_->tangent(s, to_rows);
  }

 private:
  /// Sink that forwards only the rows of the equations of motion, or only the rows of G.
  struct Half {
    BlockSink& sink;
    Index velocities;
    bool forces;
    void add(Index row, Index col, BlockView const& b) {
      if (forces ? row < velocities : row >= velocities && col < velocities) sink.add(row, col, b);
    }
  };

  std::shared_ptr<SecantOperations> operations_;
  double h_ = 0.0;
  VecX speed_;
};

}  // namespace polybody
