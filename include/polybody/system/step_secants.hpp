#pragma once
/// \file
/// A system over a step from q₀ to q₁: forces, rows and markers by secants, so that the step knows the change of every
/// potential and of every row to rounding [Gonzalez 1996, 1999]:
///   f·Δq = −ΔV less what is damped,   Ḡ Δq = ΔΦ.

#include <polybody/system/system.hpp>

namespace polybody {

/// A step of length h from q0 at t to q1; `decay` as in `DiscreteDerivative`.
struct SecantStep {
  VecX const* q0 = nullptr;              ///< (nq) coordinates at its begin
  VecX const* q1 = nullptr;              ///< (nq) coordinates at its end
  double t = 0.0, h = 0.0, decay = 0.0;  ///< t [s], h [s], and the factor of lost strain energy
  VecX const* v0 = nullptr;              ///< the first-order states behind the speeds at t
  VecX const* a = nullptr;               ///< and their rates over the step
};

/// A model's entries for such steps; `self` is what `make` made.
struct SecantOperations {
  /// Room for a model's secants.
  std::shared_ptr<void> (*make)(void const* m, Data<double> const& data);
  void (*evaluate)(void* self, SecantStep const& step);  ///< sets the step at which the others are asked
  /// r = M a − f + Ḡᵀλ over the step.
  void (*residual)(void* self, Data<double> const& data, VecX const& a, VecX const& lambda, VecX& r);
  void (*violation)(void* self, VecX& phi);                    ///< Φ(q₁)
  void (*tangent)(void* self, double scale, BlockSink& sink);  ///< [M + scale K̄, Ḡᵀ; Ḡ, 0]
};

/// Mean forces, rows and tangents over a step, for methods that conserve energy.
class StepSecants {
 public:
  /// \throws InvalidInput for a system that was made without `Capabilities::secants`.
  explicit StepSecants(System const& system)
      : entries_(require_entry(system.entries().first.secants, "secants")),
        self_(entries_->make(system.entries().second, system.data())),
        middle_(VecX::Zero(system.coordinates())),
        speed_(VecX::Zero(system.velocities())) {}

  /// Takes the step. Rows that depend on time are taken at its end; loads and first-order states in its middle, where
  /// `system` is then evaluated.
  void evaluate(System& system, SecantStep const& step) {
    h_ = step.h;
    Index const bodies = system.layout().body_velocities();
    for (Index i = 0; i < middle_.size(); ++i) middle_[i] = 0.5 * ((*step.q0)[i] + (*step.q1)[i]);
    for (Index i = 0; i < bodies; ++i) speed_[i] = ((*step.q1)[i] - (*step.q0)[i]) / step.h;
    for (Index i = bodies; i < speed_.size(); ++i) speed_[i] = (*step.v0)[i] + 0.5 * step.h * (*step.a)[i];
    system.evaluate(middle_, speed_, step.t + 0.5 * step.h);
    entries_->evaluate(self_.get(), step);
  }
  /// r = M a − f + Ḡᵀλ over the step (nv).
  void residual(System const& system, VecX const& a, VecX const& lambda, VecX& r) const {
    entries_->residual(self_.get(), system.data(), a, lambda, r);
  }
  /// Φ(q₁).
  void violation(VecX& phi) const { entries_->violation(self_.get(), phi); }
  /// [M + s K̄, Ḡᵀ; Ḡ, 0] into `sink`, K̄ = −∂f/∂q₁ nearly: symmetric, without the change of Ḡ; Ḡ stands for ∂Φ/∂q₁. Both
  /// are off by the share of a turn that a body makes in the step, and so Newton's method contracts.
  void tangent(System& system, double s, BlockSink& sink) {
    entries_->tangent(self_.get(), s, sink);
    system.tangent_of(TangentPart::force_elements, {.damping = s / h_, .stiffness = 0.5 * s, .states = 0.5 * h_}, sink);
  }

  /// [M + s K̄, Ḡᵀ; G(q₁), 0] of `step`, K̄ with ½ ∂(Gᵀλ)/∂q in the middle, as Ḡ is G there for rows that are quadratic
  /// in q. Where G loses rank within a step, Ḡ and G(q₁) do not even turn alike.
  void exact_tangent(System& system, SecantStep const& step, double s, VecX const& lambda, BlockSink& sink) {
    evaluate(system, step);
    Half forces{sink, system.velocities(), true}, rows{sink, system.velocities(), false};
    BlockSink to_forces(forces), to_rows(rows);
    entries_->tangent(self_.get(), s, to_forces);
    system.tangent_of(TangentPart::force_elements, {.damping = s / h_, .stiffness = 0.5 * s, .states = 0.5 * h_}, sink,
                      &lambda);
    SecantStep end = step;  // of no length, so that its secants are tangents
    end.q0 = step.q1;
    entries_->evaluate(self_.get(), end);
    entries_->tangent(self_.get(), s, to_rows);
  }

 private:
  /// Passes on the equations of motion, or G.
  struct Half {
    BlockSink& sink;
    Index velocities;
    bool forces;
    void add(Index row, Index col, BlockView const& b) {
      if (forces ? row < velocities : row >= velocities && col < velocities) sink.add(row, col, b);
    }
  };

  SecantOperations const* entries_;
  std::shared_ptr<void> self_;
  double h_ = 0.0;
  VecX middle_, speed_;
};

}  // namespace polybody
