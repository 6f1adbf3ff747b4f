#pragma once
#include <polybody/run/state_checks.hpp>
#include <polybody/system/make_operations.hpp>
#include <polybody/system/system.hpp>

namespace polybody {

/// Energies of state x; `system` must have been evaluated there. Dead loads have no potential here; their work is not
/// counted. Without allocation.
template <class = void>
Energy energy(System const& system, State const& x) {
  return require_entry(system.entries().first.energy, "energies")(system.entries().second, {x.q, x.v, x.t},
                                                                  system.data());
}

/// Energies of state x of a model. \throws InvalidInput for a state of another model.
template <class M>
Energy energy(M const& model, State const& x) {
  System system(model, with<Capabilities::motion>);
  require_usable(system, x);
  system.evaluate(x.q, x.v, x.t);
  return energy(system, x);
}

/// Linear momentum [kg m/s] and angular momentum about the world's origin [kg m²/s], world axes:
/// the generalised momentum M v paired with the rigid motions.
struct Momentum {
  Vec3 linear = Vec3::Zero();   ///< (3) [kg m/s]
  Vec3 angular = Vec3::Zero();  ///< (3) about the world's origin [kg m²/s]
};

namespace detail {
/// out += A x for the blocks of A among the speeds.
struct ProductSink {
  VecX const& x;
  VecX& out;
  void add(Index row, Index col, BlockView const& b) {
    if (row >= x.size() || col >= x.size()) return;
    for (Index i = 0; i < b.rows; ++i)
      for (Index j = 0; j < b.cols; ++j) out[row + i] += b(i, j) * x[col + j];
  }
};
}  // namespace detail

/// The momentum of a system that was made with `Capabilities::rigid_velocities`.
template <class = void>
Momentum momentum(System& system, State const& x) {
  VecX mv = VecX::Zero(system.velocities()), rigid = mv;
  system.evaluate(x.q, x.v, x.t);
  system.masses(detail::ProductSink{x.v, mv});
  auto const velocities = require_entry(system.entries().first.rigid_velocities, "speeds of rigid motions");
  Momentum p;
  for (int i = 0; i < 3; ++i) {
    velocities(system.entries().second, x.q, Vec3::Unit(i), Vec3::Zero(), rigid);
    p.linear[i] = mv.dot(rigid);
    velocities(system.entries().second, x.q, Vec3::Zero(), Vec3::Unit(i), rigid);
    p.angular[i] = mv.dot(rigid);
  }
  return p;
}
/// Momenta of state x of a model. \throws InvalidInput for a state of another model.
template <class M>
Momentum momentum(M const& model, State const& x) {
  System system(model, with<Capabilities::rigid_velocities>);
  require_usable(system, x);
  return momentum(system, x);
}

}  // namespace polybody
