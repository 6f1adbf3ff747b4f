#pragma once
#include <polybody/system/system.hpp>

namespace polybody {

/// Energies of a state [J].
struct Energy {
  double kinetic = 0.0;
  double strain = 0.0;   ///< of flexible bodies
  double gravity = 0.0;  ///< zero at the world's origin
  double joints = 0.0;   ///< stored in compliant joints
  double forces = 0.0;   ///< stored in force elements that have a potential
  double potential() const { return strain + gravity + joints + forces; }
  double total() const { return kinetic + potential(); }
};

/// Energies of state x. Dead loads have no potential here; their work is not counted.
template <class M>
Energy energy(M const& model, State const& x) {
  System<M> system(model);
  system.evaluate(x.q, x.v, x.t);
  return energy(system, x);
}

/// The same without allocation; `system` must have been evaluated at x.
template <class M>
Energy energy(System<M> const& system, State const& x) {
  Energy sum;
  M const& model = system.model();
  model.for_each_body([&](auto const& e) {
    auto const q = detail::body_part(x.q, e.q0, e.body.coordinates());
    auto const v = detail::body_part(x.v, e.v0, e.body.speeds());
    for (Index i = 0; i < e.body.elements(); ++i) {
      sum.kinetic += e.body.kinetic_energy(i, q, v);
      sum.strain += e.body.strain_energy(i, q);
      sum.gravity += e.body.gravity_energy(i, q, model.gravity().g);
    }
  });
  for_each_gap(model, system.data(), [&](auto const& e, auto const& gap) {
    constexpr int m = std::decay_t<decltype(gap)>::rows;
    using P = typename std::decay_t<decltype(e.joint)>::PolicyType;
    if constexpr (AddsForce<P>) sum.joints += e.joint.policy.template potential<m>(gap.g);
  });
  model.for_each_force([&](auto const& e) {
    detail::for_each_action(e, system.data(), [&](auto const& force, auto const&, auto const& frames) {
      if constexpr (HasPotential<std::decay_t<decltype(force)>>) sum.forces += force.potential(frames, x.t);
    });
  });
  return sum;
}

/// Linear momentum [kg m/s] and angular momentum about the world's origin [kg m²/s], world axes:
/// the generalised momentum M v paired with the rigid motions.
struct Momentum {
  Vec3 linear = Vec3::Zero();
  Vec3 angular = Vec3::Zero();
};

template <class M>
Momentum momentum(M const& model, State const& x) {
  Momentum p;
  model.for_each_body([&](auto const& e) {
    using B = std::decay_t<decltype(e.body)>;
    constexpr int n = B::element_columns;
    auto const q = detail::body_part(x.q, e.q0, e.body.coordinates());
    auto const v = detail::body_part(x.v, e.v0, e.body.speeds());
    VecX rigid(e.body.speeds());
    auto const paired = [&](Vec3 const& v0, Vec3 const& omega) {
      e.body.rigid_velocity(q, v0, omega, detail::body_part_of(rigid, 0, rigid.size()));
      double sum = 0.0;
      Vec<double, n> mv(element_columns(e.body));
      for (Index i = 0; i < e.body.elements(); ++i) {
        e.body.template inertia<double>(i, q, v, mv);
        sum += mv.dot(rigid.template segment<n>(e.body.first_column(i), mv.size()));
      }
      return sum;
    };
    for (int i = 0; i < 3; ++i) {
      p.linear[i] += paired(Vec3::Unit(i), Vec3::Zero());
      p.angular[i] += paired(Vec3::Zero(), Vec3::Unit(i));
    }
  });
  return p;
}

}  // namespace polybody
