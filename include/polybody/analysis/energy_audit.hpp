#pragma once
/// \file
/// Where the energy of a run comes from and where it goes:
///   work of the drives + of the loads + of gravity = Δ kinetic + Δ stored + dissipated + unaccounted.
/// For exact motions nothing is unaccounted.

#include <polybody/analysis/energy.hpp>
#include <polybody/analysis/initial_conditions.hpp>

namespace polybody {

/// Powers in a state [W]; gravity, and what stores energy, are counted by `energy`.
struct Powers {
  double drives = 0.0;      ///< of what time prescribes in joints, on bodies and compliant joints
  double loads = 0.0;       ///< of loads, and of forces that have no potential
  double dissipated = 0.0;  ///< in damped bodies, compliant joints, dampers and contacts; positive when lost
};

namespace detail {

/// What `powers` needs besides an evaluated system.
template <class M>
struct PowerScratch {
  typename M::template Scratch<double> scratch_of_bodies;
  VecX backwards;  ///< (nv) −v

  explicit PowerScratch(M const& model) : backwards(VecX::Zero(model.speeds())) {
    for_each_pool_beside(model.body_pools(), scratch_of_bodies, [](auto const& pool, auto& x) {
      for (auto const& e : pool.entries) x.emplace_back(e.body);
    });
  }
};

/// What damping takes from a body: of its forces f(q, v), elastic ones do not know v and those of inertia are even in
/// it, while damping is odd; so −½ v·(f(q, v) − f(q, −v)).
template <class B, class Kept>
double dissipated_in(B const& body, std::span<double const> q, std::span<double const> v,
                     std::span<double const> backwards, Kept& kept) {
  auto&& scratch = kept.force_scratch(body);
  double sum = 0.0;
  for (Index i = 0; i < body.elements(); ++i) {
    body.template force<double>(i, q, v, scratch.force);
    body.template force<double>(i, q, backwards, scratch.x);
    double const* const speed = v.data() + body.first_column(i);
    for (Index k = 0; k < scratch.x.size(); ++k) sum += 0.5 * speed[k] * (scratch.x[k] - scratch.force[k]);
  }
  return sum;
}

template <std::size_t n>
double power_of(std::array<Wrench<double>, n> const& w, std::array<Frame<double>, n> const& frames) {
  double sum = 0.0;
  for (std::size_t k = 0; k < n; ++k) sum += w[k].f.dot(frames[k].v) + w[k].m.dot(frames[k].w);
  return sum;
}

/// λ(g, 0) in the rows that store no energy: laws of a bushing without a potential.
template <class P, int m>
Vec<double, m> rest_without_potential(P const& policy, Vec<double, m> rest) {
  if constexpr (requires { std::get<0>(policy.laws); })
    [&]<std::size_t... i>(std::index_sequence<i...>) {
      auto const clear = [&](std::size_t k, auto const& law) {
        if constexpr (requires { law.potential(0.0); }) rest[Index(k)] = 0.0;
      };
      (clear(i, std::get<i>(policy.laws)), ...);
    }(std::make_index_sequence<std::size_t(m)>{});
  else
    rest.setZero();
  return rest;
}

/// Of a joint whose gap moves by ġ = G v + Φ_t; the bodies feel −Gᵀλ.
///   Rows:       −λ·G v goes to the bodies; on the rows G v = −Φ_t, and it is λ·Φ_t, zero without a drive.
///   Compliant:  so does −λ·G v = λ·Φ_t − λ(g, 0)·ġ − (λ − λ(g, 0))·ġ: work of the drive, less what is stored, less
///   what is lost.
template <class J, int m, class M>
void add_powers(JointEntry<J> const& e, Gap<m> const& gap, Data<M> const& data, VecX const& lambda, Powers& p) {
  Vec<double, m> const l = multiplier(e, gap, data, lambda);
  Vec<double, m> const rate = gap_rate(gap, data.markers[std::size_t(e.a)], data.markers[std::size_t(e.b)]);
  if constexpr (AddsRows<typename J::PolicyType>) {
    p.drives -= l.dot(rate - gap.rate);
  } else {
    Vec<double, m> const rest = e.joint.policy.template multiplier<m, double>(gap.g, Vec<double, m>::Zero());
    p.drives += l.dot(gap.rate);
    p.loads -= rest_without_potential(e.joint.policy, rest).dot(rate);
    p.dissipated += (l - rest).dot(rate);
  }
}

/// Of a force between frames: with a potential, what its wrenches are at rest is stored, and what motion adds is lost.
template <class F, std::size_t n>
void add_powers(F const& force, std::array<Frame<double>, n> const& frames, double t, double scale, Powers& p) {
  double const power = power_of(force.template wrenches<double>(frames, t), frames);
  if constexpr (HasPotential<F>) {
    auto at_rest = frames;
    for (Frame<double>& f : at_rest) f.v = f.w = Vec3::Zero();
    p.dissipated += scale * (power_of(force.template wrenches<double>(at_rest, t), frames) - power);
  } else {
    p.loads += scale * power;
  }
}

/// `powers` without allocation.
template <class M>
Powers powers(System<M> const& system, State const& x, PowerScratch<M>& scratch) {
  Powers p;
  M const& model = system.model();
  Data<M> const& data = system.data();
  scratch.backwards = -x.v;
  for_each_body_with_scratch(model, scratch, [&](auto const& e, auto& kept) {
    if constexpr (!HasRigidLayout<std::decay_t<decltype(e.body)>>)
      p.dissipated +=
          dissipated_in(e.body, body_part(x.q, e.q0, e.body.coordinates()), body_part(x.v, e.v0, e.body.speeds()),
                        body_part(std::as_const(scratch.backwards), e.v0, e.body.speeds()), kept);
  });
  for_each_gap(model, data, [&](auto const& e, auto const& gap) { add_powers(e, gap, data, x.lambda, p); });
  model.for_each_force([&](auto const& e) {
    double const scale = std::decay_t<decltype(e.force)>::is_load ? system.load_factor : 1.0;
    for_each_action(
        e, data, [&](auto const& force, auto const&, auto const& frames) { add_powers(force, frames, x.t, scale, p); });
  });
  return p;
}

}  // namespace detail

/// Powers in state x with its multipliers; `system` must have been evaluated at x. Rows of bodies (Euler parameters)
/// and linear joints do no work and are left out. A potential is taken for a function of the frames alone.
template <class M>
Powers powers(System<M> const& system, State const& x) {
  detail::PowerScratch<M> scratch(system.model());
  return detail::powers(system, x, scratch);
}

/// An account of a run, state by state; powers are integrated by the trapezoidal rule, energies are exact:
///   EnergyAudit audit(model);
///   for (State const& now : simulate(model, x, integrator, options)) audit.record(now);
/// What is unaccounted is the doing of the numbers: what the integrator loses or gains, and what sampling misses. That
/// is h²/12 of what the slopes of the powers grow by [Euler and Maclaurin], and about ½ h of each jump (loads at
/// corners, contacts with dampers at touch). States must have the multipliers of their own time. Those of `simulate`
/// have, also for joints whose rows are eliminated (Recursive, AncfLinear), as it works out what these hold. A state
/// put together by hand has not; nor have those of `EnergyMomentum` and `EnergyDecaying`, whose multipliers belong to
/// the middle of the step: there the drives are right to O(h). A record takes no memory from the heap, but for bodies
/// whose kinetic energy does (floating frames). The model must outlive the audit and must not change after.
template <class M>
class EnergyAudit {
 public:
  explicit EnergyAudit(M const& model) : system_(model), scratch_(model) {}

  /// Begins anew at x. \throws InvalidInput when x does not fit the model.
  void start(State const& x) {
    require_fitting(system_.model(), x);
    see(x);
    first_ = last_;
    work_ = {};
    turnover_ = last_.kinetic;
    started_ = true;
  }

  /// Adds what happened since the last state; the first one begins. \throws InvalidInput for a state of another model,
  /// or earlier than the last one.
  void record(State const& x) {
    if (!started_) return start(x);
    if (x.q.size() != system_.coordinates() || x.v.size() != system_.speeds() || x.lambda.size() != system_.rows())
      require_fitting(system_.model(), x);  // which words it
    double const h = x.t - t_;
    if (!(h >= 0.0))
      throw InvalidInput("EnergyAudit: the state at t = " + number(x.t) +
                         " s is earlier than the last one at t = " + number(t_) + " s. Call start() for another run.");
    Powers const before = powers_;
    see(x);
    work_.drives += 0.5 * h * (before.drives + powers_.drives);
    work_.loads += 0.5 * h * (before.loads + powers_.loads);
    work_.dissipated += 0.5 * h * (before.dissipated + powers_.dissipated);
    double const in = std::abs(work_.drives) + std::abs(work_.loads) + std::abs(work_of_gravity());
    double const out = std::abs(kinetic()) + std::abs(stored()) + std::abs(work_.dissipated);
    turnover_ = std::max({turnover_, in, out, last_.kinetic});
  }

  /// Since the start [J].
  double work_of_drives() const { return work_.drives; }
  double work_of_loads() const { return work_.loads; }
  double work_of_gravity() const { return first_.gravity - last_.gravity; }
  double kinetic() const { return last_.kinetic - first_.kinetic; }  ///< gained
  double stored() const {                                            ///< in bodies, compliant joints and forces
    return (last_.strain - first_.strain) + (last_.joints - first_.joints) + (last_.forces - first_.forces);
  }
  double dissipated() const { return work_.dissipated; }

  /// What does not add up [J]: positive where the integrator loses energy.
  double unaccounted() const {
    return work_of_drives() + work_of_loads() + work_of_gravity() - kinetic() - stored() - dissipated();
  }
  /// Its size against the largest sum so far of what came in, or of what it became, or the largest kinetic energy.
  double relative() const { return turnover_ > 0.0 ? std::abs(unaccounted()) / turnover_ : 0.0; }

  /// In the last state.
  Powers const& powers() const { return powers_; }
  Energy const& energy() const { return last_; }

 private:
  void see(State const& x) {
    system_.evaluate(x.q, x.v, x.t);
    last_ = polybody::energy(system_, x);
    powers_ = detail::powers(system_, x, scratch_);
    t_ = x.t;
  }

  System<M> system_;
  detail::PowerScratch<M> scratch_;
  Energy first_, last_;
  Powers powers_, work_;  // work_: their integrals [J]
  double t_ = 0.0, turnover_ = 0.0;
  bool started_ = false;
};

}  // namespace polybody
