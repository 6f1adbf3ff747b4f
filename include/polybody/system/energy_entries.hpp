#pragma once
/// \file
/// A model's entries of energy: what a state stores, and where power goes.

#include <polybody/system/force_entries.hpp>

namespace polybody::detail {

/// What damping takes from a body: of its forces f(q, v), elastic ones do not know v and those of inertia are even in
/// it, while damping is odd; so −½ v·(f(q, v) − f(q, −v)). `backwards` is −v.
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
  for (std::size_t k = 0; k < n; ++k)
    for (int i = 0; i < 3; ++i) sum += w[k].f[i] * frames[k].v[i] + w[k].m[i] * frames[k].w[i];
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

template <class M>
struct EnergyEntries {
  using Motion = MotionEntries<M, double>;

  static Energy energy(void const* m, At<double> at, Data<double> const& data) {
    M const& model = Motion::model_of(m);
    Energy sum;
    model.for_each_body([&](auto const& e) {
      auto const q = Motion::coordinates(e, at.q), v = Motion::speeds(e, at.v);
      for (Index i = 0; i < e.body.elements(); ++i) {
        sum.kinetic += e.body.kinetic_energy(i, q, v);
        sum.strain += e.body.strain_energy(i, q);
        sum.gravity += e.body.gravity_energy(i, q, model.gravity().g);
      }
    });
    for_each_gap(model, data, [&](auto const& e, auto const& gap) {
      using J = std::decay_t<decltype(e.joint)>;
      if constexpr (!AddsRows<typename J::PolicyType>) sum.joints += e.joint.policy.template potential<J::rows>(gap.g);
    });
    model.for_each_force([&](auto const& e) {
      for_each_action(e, data, [&](auto const& force, auto const&, auto const& frames) {
        if constexpr (HasPotential<std::decay_t<decltype(force)>>) sum.forces += force.potential(frames, at.t);
      });
    });
    return sum;
  }

  /// Rows of bodies (Euler parameters) and linear joints do no work and are left out. A potential is taken for a
  /// function of the frames alone.
  static Powers powers(void const* m, At<double> at, VecX const& backwards, VecX const& lambda, double load_factor,
                       Data<double> const& data) {
    M const& model = Motion::model_of(m);
    Powers p;
    for_each_pool_beside(model.body_pools(), TypedData<M, double>::of(data).scratch, [&](auto const& pool, auto& kept) {
      using B = std::decay_t<decltype(pool.entries.front().body)>;
      if constexpr (!HasRigidLayout<B>)
        for (std::size_t i = 0; i < pool.entries.size(); ++i) {
          auto const& e = pool.entries[i];
          p.dissipated += dissipated_in(e.body, Motion::coordinates(e, at.q), Motion::speeds(e, at.v),
                                        Motion::speeds(e, backwards), kept[i]);
        }
    });
    for_each_gap(model, data, [&](auto const& e, auto const& gap) { add_powers(e, gap, data, lambda, p); });
    model.for_each_force([&](auto const& e) {
      double const scale = std::decay_t<decltype(e.force)>::is_load ? load_factor : 1.0;
      for_each_action(e, data, [&](auto const& force, auto const&, auto const& frames) {
        add_powers(force, frames, at.t, scale, p);
      });
    });
    return p;
  }

 private:
  /// What a joint does whose gap moves by ġ = G v + Φ_t; the bodies feel −Gᵀλ.
  ///   Rows:       −λ·G v goes to the bodies; on the rows G v = −Φ_t, and it is λ·Φ_t, zero without a drive.
  ///   Compliant:  so does −λ·G v = λ·Φ_t − λ(g, 0)·ġ − (λ − λ(g, 0))·ġ: work of the drive, less what is stored, less
  ///   what is lost.
  template <class J, int m>
  static void add_powers(JointEntry<J> const& e, Gap<m> const& gap, Data<double> const& data, VecX const& lambda,
                         Powers& p) {
    Vec<double, m> const rate =
        gap_rate(gap, data.markers[std::size_t(e.a)].frame, data.markers[std::size_t(e.b)].frame);
    if constexpr (AddsRows<typename J::PolicyType>) {
      for (int i = 0; i < m; ++i) p.drives -= lambda[e.row + i] * (rate[i] - gap.rate[i]);
    } else {
      Vec<double, m> const l = e.joint.policy.template multiplier<m, double>(gap.g, rate);
      Vec<double, m> const rest = e.joint.policy.template multiplier<m, double>(gap.g, Vec<double, m>::Zero());
      Vec<double, m> const lossless = rest_without_potential(e.joint.policy, rest);
      for (int i = 0; i < m; ++i) {
        p.drives += l[i] * gap.rate[i];
        p.loads -= lossless[i] * rate[i];
        p.dissipated += (l[i] - rest[i]) * rate[i];
      }
    }
  }
  /// What a force between frames does: with a potential, what its wrenches are at rest is stored, and what motion adds
  /// is lost.
  template <class F, std::size_t n>
  static void add_powers(F const& force, std::array<Frame<double>, n> const& frames, double t, double scale,
                         Powers& p) {
    double const power = power_of(force.template wrenches<double>(frames, t), frames);
    if constexpr (HasPotential<F>) {
      auto at_rest = frames;
      for (Frame<double>& f : at_rest) f.v = f.w = Vec3::Zero();
      p.dissipated += scale * (power_of(force.template wrenches<double>(at_rest, t), frames) - power);
    } else {
      p.loads += scale * power;
    }
  }
};

}  // namespace polybody::detail
