#pragma once
/// \file
/// Energies, momenta and centres of mass in an evaluated system.
/// Theory: Eqs. 11.1, 11.2.

#include <polybody/system/lookup.hpp>
#include <polybody/system/make_operations.hpp>
#include <polybody/system/system.hpp>

namespace polybody {

/// Energies in state x [J]; `system` must have been evaluated at x. Dead loads have no potential, and their work is not
/// counted. This function does not allocate memory.
template <class = void>
Energy energy(System const& system, State const& x) {
  return system.operations().energy({x.q, x.v, x.t}, system.data());
}

/// Linear momentum [kg m/s] and angular momentum about the world's origin [kg m²/s], world axes:
/// products of the generalised momentum M v with the generalised velocities of unit rigid motions.
struct Momentum {
  Vec3 linear = Vec3::Zero();   ///< (3) linear momentum [kg m/s]
  Vec3 angular = Vec3::Zero();  ///< (3) angular momentum about the world's origin [kg m²/s]
};

namespace detail {
/// Adds A x to `out`, with the blocks of A whose rows and columns are generalised velocities.
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

/// Momentum in state x; `system` must have been made with `Capabilities::rigid_velocities` and evaluated at x.
template <class = void>
Momentum momentum(System& system, State const& x) {
  VecX mv = VecX::Zero(system.velocities()), rigid = mv;
  system.masses(detail::ProductSink{x.v, mv});
  Momentum p;
  for (int i = 0; i < 3; ++i) {
    system.operations().rigid_velocities(x.q, Vec3::Unit(i), Vec3::Zero(), rigid);
    p.linear[i] = mv.dot(rigid);
    system.operations().rigid_velocities(x.q, Vec3::Zero(), Vec3::Unit(i), rigid);
    p.angular[i] = mv.dot(rigid);
  }
  return p;
}

/// Mass and centre of mass of a body or of a model in one state.
struct CentreOfMass {
  double mass = 0.0;             ///< mass [kg]
  Vec3 position = Vec3::Zero();  ///< (3) position of the centre of mass, world axes [m]
  Vec3 velocity = Vec3::Zero();  ///< (3) velocity of the centre of mass, world axes [m/s]
};

namespace detail {
/// Centre of mass of the bodies with the generalised velocities [first, first + count). With the generalised velocities
/// u_i of a unit translation along world axis i, and w_i of a unit rotation about this axis through the world's origin,
///   m = u_xᵀ M u_x,  m r = (w_zᵀ M u_y, −w_zᵀ M u_x, w_yᵀ M u_x),  m ṙ_i = u_iᵀ M v.
/// In the plane, w_y and r_z are zero.
template <class = void>
CentreOfMass centre_of_mass(System& system, State const& x, Index first, Index count) {
  VecX mv = VecX::Zero(system.velocities()), rigid = mv, u = mv;
  auto const motion = [&](Vec3 const& v0, Vec3 const& omega) {
    system.operations().rigid_velocities(x.q, v0, omega, rigid);
    return rigid.segment(first, count);
  };
  auto const momentum_of = [&](VecX const& v) {
    mv.setZero();
    system.masses(ProductSink{v, mv});
    return mv.segment(first, count);
  };
  CentreOfMass out;
  auto const translation = [&](int axis) {
    u.segment(first, count) = motion(Vec3::Unit(axis), Vec3::Zero());
    return momentum_of(u);
  };
  VecX const x_momentum = translation(0), y_momentum = translation(1);
  Vec3 const zero = Vec3::Zero();
  out.mass = x_momentum.dot(motion(Vec3::UnitX(), zero));
  if (!(out.mass > 0.0)) return out;
  out.position = Vec3(y_momentum.dot(motion(zero, Vec3::UnitZ())), -x_momentum.dot(motion(zero, Vec3::UnitZ())),
                      x_momentum.dot(motion(zero, Vec3::UnitY()))) /
                 out.mass;
  VecX const all = momentum_of(x.v);
  for (int i = 0; i < 3; ++i) out.velocity[i] = all.dot(motion(Vec3::Unit(i), zero)) / out.mass;
  return out;
}
}  // namespace detail

/// Mass and centre of mass of all bodies in state x, rigid and flexible. `system` must have been made with
/// `Capabilities::rigid_velocities` and must have been evaluated at x. The result is zero for a model without bodies.
template <class = void>
CentreOfMass centre_of_mass(System& system, State const& x) {
  return detail::centre_of_mass(system, x, 0, system.layout().body_velocities());
}
/// Mass and centre of mass of one body in state x. \throws InvalidInput for a handle of another model.
template <class B>
CentreOfMass centre_of_mass(System& system, State const& x, BodyHandle<B> const& body) {
  BodyLayout const& place = system.layout().bodies[std::size_t(index_of(system.layout(), body))];
  return detail::centre_of_mass(system, x, place.v0, place.velocities);
}
}  // namespace polybody
