#pragma once
/// \file
/// Energy audit of a run:
///   work of the drives + of the loads + of gravity = Δ kinetic + Δ stored + dissipated + unaccounted.
/// The unaccounted energy of an exact motion is zero.
/// Theory: Eqs. 11.5 to 11.7.

#include <ostream>
#include <utility>

#include <polybody/run/energy.hpp>
#include <polybody/run/state_checks.hpp>

namespace polybody {

/// Powers [W] in state x with its multipliers; `system` must have been evaluated at x, and made with
/// `Capabilities::energy`. `backwards` (nv) is workspace. Constraint equations of bodies (Euler parameters) and linear
/// joints do no work and are omitted. A potential is assumed to be a function of the frames alone.
template <class = void>
Powers powers(System const& system, State const& x, VecX& backwards) {
  backwards = -x.v;
  return system.operations().powers({x.q, x.v, x.t}, backwards, x.lambda, system.load_factor, system.data());
}
/// Powers [W] in state x. This overload allocates its workspace.
template <class = void>
Powers powers(System const& system, State const& x) {
  VecX backwards;
  return powers(system, x, backwards);
}

/// Energy audit of a run, state by state. Each power is integrated over a step by the parabola through its values in
/// the last three states; energies are exact:
///   EnergyAudit audit(model);
///   for (State const& now : simulate(model, x, integrator, options)) audit.record(now);
/// The unaccounted energy is numerical: gains or losses of the integrator, and the error of the rule. With equal steps
/// and smooth powers, the error of the rule is h³/24 times the sum of the second derivatives of the powers at both ends
/// of the run [Gregory's formula]. The trapezoidal rule replaces the parabola in the first step and in a step of more
/// than twice the preceding one. A corner of a power within a step adds an error of at most h²/8 times the jump of its
/// slope. A jump of a power adds an error of at most ½ h times the jump (closing contacts with dampers). Two
/// breakpoints close before and after the jump make the error small. The multipliers of a state must belong to its
/// time. This condition holds for the states of `simulate`, also with eliminated equations (JointCoordinates,
/// AncfLinear), but not for states that are constructed by hand. The multipliers of `EnergyMomentum` and
/// `EnergyDecaying` belong to the middle of the step, so that the work of drives has an error of O(h). `record` does
/// not allocate memory. The model must outlive the audit and must not change after its construction.
template <class = void>  // compiled only if used
class EnergyAuditOf {
 public:
  /// Audit of runs of this model. The first recorded state begins the audit.
  template <class M>
  explicit EnergyAuditOf(M const& model) : EnergyAuditOf(System(model, with<Capabilities::energy>)) {}
  template <class M>
    requires(!std::same_as<M, System>)
  explicit EnergyAuditOf(M const&& model) = delete;  ///< deleted: a temporary model would not outlive the audit
  /// \param system of the full model, made with `Capabilities::energy`
  explicit EnergyAuditOf(System system) : system_(std::move(system)), backwards_(VecX::Zero(system_.velocities())) {}

  /// Restarts the audit at x. \throws InvalidInput if x does not fit the model.
  void start(State const& x) {
    require_usable(system_, x);
    see(x);
    first_ = last_;
    work_ = {};
    last_step_ = 0.0;
    turnover_ = last_.kinetic;
    started_ = true;
  }

  /// Adds the work since the last state; the first state begins the audit. \throws InvalidInput for a state of another
  /// model, and for a state earlier than the last one.
  void record(State const& x) {
    if (!started_) return start(x);
    if (x.q.size() != system_.coordinates() || x.v.size() != system_.velocities() || x.lambda.size() != system_.rows())
      require_fitting(system_, x);  // throws with a message
    require_computable(system_, x);
    double const h = x.t - t_;
    if (!(h >= 0.0))
      throw InvalidInput("record.time_order",
                         {ErrorObject{"EnergyAudit"}, ": the state at t = ", ErrorTime{x.t},
                          " s is earlier than the last state at t = ", t_, " s. Call start() for another run."});
    Powers const earlier = std::exchange(before_, powers_);
    see(x);
    for (double Powers::* const p : {&Powers::drives, &Powers::loads, &Powers::dissipated})
      work_.*p += work_in_step(earlier.*p, before_.*p, powers_.*p, h);
    last_step_ = h;
    double const in = std::abs(work_.drives) + std::abs(work_.loads) + std::abs(work_of_gravity());
    double const out = std::abs(kinetic()) + std::abs(stored()) + std::abs(work_.dissipated);
    turnover_ = std::max({turnover_, in, out, last_.kinetic});
  }

  /// Work of drives since the start [J].
  double work_of_drives() const { return work_.drives; }
  double work_of_loads() const { return work_.loads; }  ///< work of loads and of forces without a potential [J]
  double work_of_gravity() const { return first_.gravity - last_.gravity; }  ///< decrease of gravity's potential [J]
  double kinetic() const { return last_.kinetic - first_.kinetic; }          ///< increase of kinetic energy [J]
  double stored() const {  ///< increase of the energy stored in bodies, compliant joints and forces [J]
    return (last_.strain - first_.strain) + (last_.joints - first_.joints) + (last_.forces - first_.forces);
  }
  double dissipated() const { return work_.dissipated; }  ///< energy lost in dampers and contacts [J]

  /// Unaccounted energy [J]: positive if the integrator loses energy.
  double unaccounted() const {
    return work_of_drives() + work_of_loads() + work_of_gravity() - kinetic() - stored() - dissipated();
  }
  /// Unaccounted energy relative to the turnover. The turnover is the largest value so far of the supplied work, of the
  /// converted energy, or of the kinetic energy.
  double relative() const { return turnover_ > 0.0 ? std::abs(unaccounted()) / turnover_ : 0.0; }

  /// Powers in the last state.
  Powers const& powers() const { return powers_; }
  Energy const& energy() const { return last_; }  ///< energies in the last state [J]

 private:
  void see(State const& x) {
    system_.evaluate(x.q, x.v, x.t);
    last_ = polybody::energy(system_, x);
    powers_ = polybody::powers(system_, x, backwards_);
    t_ = x.t;
  }

  /// Integral of a power over the step h from its values in three states: of the parabola through them, or by the
  /// trapezoidal rule.
  double work_in_step(double earlier, double before, double now, double h) const {
    double const g = last_step_, trapezoid = 0.5 * h * (before + now);
    if (!(h > 0.0 && h <= 2.0 * g)) return trapezoid;
    return trapezoid - h * h * h / (6.0 * (g + h)) * ((now - before) / h - (before - earlier) / g);
  }

  System system_;
  VecX backwards_;
  Energy first_, last_;
  Powers before_, powers_, work_;  // work_: time integrals of powers [J]
  double t_ = 0.0, last_step_ = 0.0, turnover_ = 0.0;
  bool started_ = false;
};

using EnergyAudit = EnergyAuditOf<>;  ///< energy audit of a run

/// Writes the audit as three lines of text; energies in joules.
template <class = void>
std::ostream& operator<<(std::ostream& out, EnergyAudit const& a) {
  return out << sentence_of({"work of drives ", a.work_of_drives(), ", loads ", a.work_of_loads(), ", gravity ",
                             a.work_of_gravity(), " J\n", "kinetic energy ", a.kinetic(), ", stored ", a.stored(),
                             ", dissipated ", a.dissipated(), " J\n", "unaccounted ", a.unaccounted(), " J, ",
                             a.relative(), " of the turnover\n"});
}

}  // namespace polybody
