#pragma once
/// \file
/// Evaluation of states: `Probe`, `ObservedState` (a state with its evaluation), and a function of model and state for
/// each quantity.

#include <cstring>
#include <optional>

#include <polybody/run/accelerations.hpp>
#include <polybody/run/applied_wrenches.hpp>
#include <polybody/run/energy.hpp>
#include <polybody/run/joint_position.hpp>
#include <polybody/run/marker_frames.hpp>
#include <polybody/run/observe.hpp>
#include <polybody/run/state_checks.hpp>
#include <polybody/system/make_operations.hpp>

namespace polybody {

/// System of the full `model`, for evaluations of its states. The model must outlive the system.
template <class M>
[[gnu::cold]] System observation_system(M const& model) {
  return System(model, with<Capabilities::rigid_velocities>);
}
/// Deleted: the system would keep a reference to a temporary model.
template <class M>
System observation_system(M const&& model) = delete;

/// Function that makes full systems of a model, and the model as its argument.
struct SystemSource {
  System (*make)(void const* model) = nullptr;  ///< null if there is no such function
  void const* model = nullptr;                  ///< the model, with erased type
};
/// Source of systems for evaluations of states of `model`.
template <class M>
SystemSource system_source(M const& model) {
  return {[](void const* m) { return observation_system(*static_cast<M const*>(m)); }, &model};
}

class ObservedState;

/// Evaluates states of a model. Arrays are allocated once, and all results for one state share one evaluation:
///   Probe probe(model);
///   auto const now = probe.at(x);
///   now.energy().total();  now.reaction(pin).f;  now.position(rod.at(1.0));
/// The model must outlive the probe and must not change after its construction. Each thread needs its own probe.
class Probe {
 public:
  /// Probe for states of `model`.
  template <class M>
    requires(!std::same_as<M, System> && !std::same_as<M, Probe>)
  explicit Probe(M const& model) : source_(system_source(model)), system_(source_.make(source_.model)) {}
  template <class M>
    requires(!std::same_as<M, System> && !std::same_as<M, Probe>)
  explicit Probe(M const&& model) = delete;  ///< deleted: a temporary model would not outlive the probe
  /// Probe that makes its system at the first evaluation. \param source makes the system \param of any system of the
  /// same model
  Probe(SystemSource const& source, System const& of) : source_(source), watch_(of.layout().watch) {}
  Probe(Probe const&) = delete;
  Probe& operator=(Probe const&) = delete;

  /// State x with its evaluation. The result refers to x and to this probe. x is evaluated only when a member function
  /// of the result requires it.
  ObservedState at(State const& x);
  ObservedState at(State const&& x) = delete;  ///< deleted: a temporary state would not outlive the result

  /// Number of evaluations so far.
  long evaluations() const { return evaluations_; }
  /// True if `model` is the probed model.
  template <class M>
  bool belongs_to(M const& model) const {
    return system_source(model).model == source_.model;
  }

  /// Full system of the model, not evaluated at a particular state.
  template <class = void>
  System& system() {
    if (!system_) system_.emplace(separate_system());
    system_->layout().watch.require_unchanged();
    return *system_;
  }
  /// Another system of the model, for evaluations that change more than the state.
  template <class = void>
  [[gnu::cold]] System separate_system() const {
    watch_.require_unchanged();
    if (source_.make) return source_.make(source_.model);
    throw InvalidInput("system.missing_capability", {"This run was made from systems without ", ErrorObject{"a probe"},
                                                     ". Make the run with simulate(model, ...), or evaluate its states "
                                                     "with Probe(model)."});
  }
  /// System evaluated at x. The last evaluation is used again if coordinates, velocities and time are the same.
  /// \throws InvalidInput for a state of another model, and if the model has changed.
  template <class = void>
  System& evaluated(State const& x) {
    System& s = system();
    if (current_ && same(x.q, s.at().q) && same(x.v, s.at().v) && x.t == s.at().t) {
      if (x.a.size() != x.v.size() || x.lambda.size() != s.rows()) require_fitting(s, x);  // throws
      return s;
    }
    current_ = has_forces_ = false;
    require_usable(s, x);
    s.evaluate(x.q, x.v, x.t);
    current_ = true;
    ++evaluations_;
    return s;
  }
  /// System that is evaluated at x, with the wrenches of its force elements.
  template <class = void>
  System& with_forces(State const& x) {
    System& s = evaluated(x);
    if (!has_forces_ || !s.data().multipliers.empty()) s.push_forces(x.lambda);
    has_forces_ = true;
    return s;
  }

 private:
  static bool same(VecX const& a, VecX const& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), std::size_t(a.size()) * sizeof(double)) == 0;
  }

  SystemSource source_;
  ModelWatch watch_;
  std::optional<System> system_;
  bool current_ = false, has_forces_ = false;  // true if the system is evaluated; true if its wrenches are evaluated
  long evaluations_ = 0;
};

/// State with its evaluation: a state of a run, or the result of `Probe::at`. An observed state refers to a state, so
/// all results belong to the present content of that state. The evaluation is repeated if coordinates, velocities or
/// time differ from those of the last evaluation. To keep a state of a run, copy it: `State const kept = now`.
class ObservedState {
 public:
  double const& t;      ///< time [s]
  VecX const& q;        ///< (nq) generalised coordinates
  VecX const& v;        ///< (nv) generalised velocities, then first-order states
  VecX const& a;        ///< (nv) time derivative of v
  VecX const& lambda;   ///< (rows) multipliers
  VecX const& history;  ///< integrator history

  /// State x, with evaluations by `probe`. Both must outlive this object.
  ObservedState(State const& x, Probe& probe)
      : t(x.t), q(x.q), v(x.v), a(x.a), lambda(x.lambda), history(x.history), x_(&x), probe_(&probe) {}
  ObservedState(ObservedState const&) = delete;  ///< deleted: `State const kept = now` copies the state
  ObservedState& operator=(ObservedState const&) = delete;
  operator State const&() const { return *x_; }  ///< the state itself

  /// Energies [J]. Dead loads have no potential.
  template <class = void>
  Energy energy() const {
    return polybody::energy(evaluated(), *x_);
  }
  /// Linear momentum [kg m/s] and angular momentum about the world's origin [kg m²/s].
  template <class = void>
  Momentum momentum() const {
    return polybody::momentum(evaluated(), *x_);
  }
  /// Mass and centre of mass of all bodies, or of the body `body` only.
  template <class... B>
    requires(sizeof...(B) <= 1)
  CentreOfMass centre_of_mass(BodyHandle<B> const&... body) const {
    return polybody::centre_of_mass(evaluated(), *x_, body...);
  }

  /// Frame of a material point: position, rotation matrix and velocities.
  template <class B>
  Frame<double> frame(Marker<B> const& marker) const {
    return polybody::frame(layout(), *x_, marker);
  }
  /// Position of a material point (3), world axes [m].
  template <class B>
  Vec3 position(Marker<B> const& marker) const {
    return frame(marker).r;
  }
  /// Acceleration [m/s²] and angular acceleration [rad/s²] of a material point (6), world axes, from the accelerations
  /// `a`.
  template <class B>
  Vec6 twist_rate(Marker<B> const& marker) const {
    if constexpr (std::same_as<B, Ground>) {
      require_own(layout(), marker, "acceleration");
      return Vec6::Zero();
    } else {
      BodyInState<B> const body = body_in_state(layout(), *x_, marker, "acceleration");
      require_accelerations();
      return detail::twist_rate(body, marker.point, *x_);
    }
  }
  /// Acceleration of a material point (3), world axes [m/s²].
  template <class B>
  Vec3 acceleration(Marker<B> const& marker) const {
    return twist_rate(marker).template head<3>();
  }
  /// Angular acceleration of a material point (3), world axes [rad/s²].
  template <class B>
  Vec3 angular_acceleration(Marker<B> const& marker) const {
    return twist_rate(marker).template tail<3>();
  }
  /// Section forces (N, Q_y, Q_z, M_x, M_y, M_z) of the beam at a marker [N], [N m].
  template <class B>
  Vec6 section_forces(Marker<B> const& marker) const {
    return polybody::section_forces(layout(), *x_, marker);
  }
  /// Strains (ε, γ_y, γ_z, κ_x, κ_y, κ_z) of the section of the beam at a marker [1], [1/m].
  template <class B>
  Vec6 section_strains(Marker<B> const& marker) const {
    return polybody::section_strains(layout(), *x_, marker);
  }
  /// Coordinates of one body.
  template <class B>
  std::span<double const> coordinates_of(BodyHandle<B> const& body) const {
    return polybody::coordinates_of(layout(), *x_, body);
  }
  /// Generalised velocities of one body.
  template <class B>
  std::span<double const> velocities_of(BodyHandle<B> const& body) const {
    return polybody::velocities_of(layout(), *x_, body);
  }
  /// Accelerations of one body, the rates of `velocities_of`.
  template <class B>
  std::span<double const> accelerations_of(BodyHandle<B> const& body) const {
    std::span<double const> const u = velocities_of(body);
    require_accelerations();
    return std::span(a.data() + (u.data() - v.data()), u.size());
  }

  /// Constraint violation of a joint, one entry per constraint equation [m], [rad] or [1].
  template <class J>
  auto constraint_violation(ElementHandle<J> const& joint) const {
    return polybody::constraint_violation(evaluated(), joint);
  }
  /// Largest |Φ|, |Φ̇| and |Φ̈| of all constraint equations.
  template <class = void>
  Violation largest_violation() const {
    return detail::violation_of(evaluated(), *x_);
  }
  /// Force [N] and moment [N m] that a joint exerts on its second body, about the joint point on this body.
  template <class J>
  Wrench<double> reaction(ElementHandle<J> const& joint, ReactionAxes axes = ReactionAxes::world) const {
    return polybody::reaction(evaluated(), *x_, joint, axes);
  }
  /// Largest force of any joint on its second body [N].
  template <class = void>
  double peak_joint_force() const {
    return polybody::peak_joint_force(evaluated(), *x_);
  }
  /// Angle of a joint in (−π, π] [rad].
  template <class J>
  double joint_angle(ElementHandle<J> const& joint) const {
    return polybody::joint_angle(evaluated(), joint);
  }
  /// Rate of a joint angle [rad/s].
  template <class J>
  double joint_angle_rate(ElementHandle<J> const& joint) const {
    return polybody::joint_angle_rate(evaluated(), joint);
  }
  /// Translation in a joint [m].
  template <class J>
  double joint_translation(ElementHandle<J> const& joint) const {
    return polybody::joint_translation(evaluated(), joint);
  }
  /// Rate of a joint translation [m/s].
  template <class J>
  double joint_translation_rate(ElementHandle<J> const& joint) const {
    return polybody::joint_translation_rate(evaluated(), joint);
  }

  /// Forces [N] and moments [N m] of a force element on its markers, each about the origin of its marker, world axes.
  template <class F>
  auto applied_wrenches(ElementHandle<F> const& force) const {
    return polybody::applied_wrenches(probe_->with_forces(*x_), force);
  }
  /// Power of a force element or of a drive on the bodies [W]; positive if it adds energy to the bodies.
  template <class E>
  double power(ElementHandle<E> const& element) const {
    return polybody::power(probe_->with_forces(*x_), *x_, element);
  }
  /// Calls visit(TouchingPoint) for every contact point of a contact group with a positive normal force.
  template <class F>
  void for_each_contact(ElementHandle<F> const& group, TouchingPointVisit const& visit) const {
    polybody::for_each_contact(evaluated(), group, visit);
  }

  /// True if the probe evaluates states of `model`.
  template <class M>
  bool belongs_to(M const& model) const {
    return probe_->belongs_to(model);
  }
  /// System of the full model, evaluated at this state.
  template <class = void>
  System& evaluated() const {
    return probe_->evaluated(*x_);
  }

 private:
  template <class = void>
  ModelLayout const& layout() const {
    return probe_->system().layout();
  }
  template <class = void>
  void require_accelerations() const {
    if (detail::lacks_accelerations(*x_)) detail::require_accelerations(probe_->separate_system(), *x_);
  }

  State const* x_;
  Probe* probe_;
};

inline ObservedState Probe::at(State const& x) { return {x, *this}; }

namespace detail {
/// Evaluates a quantity, `question`, in state x of a model. An observed state of this model is evaluated by its own
/// probe, other states by a new probe.
template <class M, std::convertible_to<State const&> X, class F>
auto answer(M const& model, X const& x, F const& question) {
  if constexpr (std::same_as<X, ObservedState>)
    if (x.belongs_to(model)) return question(x);
  Probe probe(model);
  return question(probe.at(x));
}
}  // namespace detail

/// Type of a model, as opposed to a system.
template <class T>
concept ProbedModel = !std::same_as<T, System>;

/// Energies in state x of a model [J]. To evaluate several quantities in one state, use `Probe`.
/// \throws InvalidInput for a state of another model.
template <ProbedModel M, std::convertible_to<State const&> X>
Energy energy(M const& model, X const& x) {
  return detail::answer(model, x, [](ObservedState const& now) { return now.energy(); });
}
/// Momentum in state x of a model.
template <ProbedModel M, std::convertible_to<State const&> X>
Momentum momentum(M const& model, X const& x) {
  return detail::answer(model, x, [](ObservedState const& now) { return now.momentum(); });
}
/// Mass and centre of mass of all bodies of a model in state x, or of the body `body` only.
template <ProbedModel M, std::convertible_to<State const&> X, class... B>
  requires(sizeof...(B) <= 1)
CentreOfMass centre_of_mass(M const& model, X const& x, BodyHandle<B> const&... body) {
  return detail::answer(model, x, [&](ObservedState const& now) { return now.centre_of_mass(body...); });
}
/// Constraint violation of a joint in state x of a model.
template <ProbedModel M, std::convertible_to<State const&> X, class J>
auto constraint_violation(M const& model, X const& x, ElementHandle<J> const& joint) {
  return detail::answer(model, x, [&](ObservedState const& now) { return now.constraint_violation(joint); });
}
/// Largest constraint violations in state x of a model.
template <ProbedModel M, std::convertible_to<State const&> X>
Violation largest_violation(M const& model, X const& x) {
  return detail::answer(model, x, [](ObservedState const& now) { return now.largest_violation(); });
}
/// Reaction of a joint in state x of a model.
template <ProbedModel M, std::convertible_to<State const&> X, class J>
Wrench<double> reaction(M const& model, X const& x, ElementHandle<J> const& joint,
                        ReactionAxes axes = ReactionAxes::world) {
  return detail::answer(model, x, [&](ObservedState const& now) { return now.reaction(joint, axes); });
}
/// Wrenches of a force element in state x of a model, for the first-order states that x contains.
template <ProbedModel M, std::convertible_to<State const&> X, class F>
auto applied_wrenches(M const& model, X const& x, ElementHandle<F> const& force) {
  return detail::answer(model, x, [&](ObservedState const& now) { return now.applied_wrenches(force); });
}
/// Power of a force element or of a drive in state x of a model [W].
template <ProbedModel M, std::convertible_to<State const&> X, class E>
double power(M const& model, X const& x, ElementHandle<E> const& element) {
  return detail::answer(model, x, [&](ObservedState const& now) { return now.power(element); });
}
/// Angle of a joint in state x of a model, in (−π, π] [rad].
template <ProbedModel M, std::convertible_to<State const&> X, class J>
double joint_angle(M const& model, X const& x, ElementHandle<J> const& joint) {
  return detail::answer(model, x, [&](ObservedState const& now) { return now.joint_angle(joint); });
}
/// Rate of a joint angle in state x of a model [rad/s].
template <ProbedModel M, std::convertible_to<State const&> X, class J>
double joint_angle_rate(M const& model, X const& x, ElementHandle<J> const& joint) {
  return detail::answer(model, x, [&](ObservedState const& now) { return now.joint_angle_rate(joint); });
}
/// Translation in a joint in state x of a model [m].
template <ProbedModel M, std::convertible_to<State const&> X, class J>
double joint_translation(M const& model, X const& x, ElementHandle<J> const& joint) {
  return detail::answer(model, x, [&](ObservedState const& now) { return now.joint_translation(joint); });
}
/// Rate of a joint translation in state x of a model [m/s].
template <ProbedModel M, std::convertible_to<State const&> X, class J>
double joint_translation_rate(M const& model, X const& x, ElementHandle<J> const& joint) {
  return detail::answer(model, x, [&](ObservedState const& now) { return now.joint_translation_rate(joint); });
}

}  // namespace polybody
