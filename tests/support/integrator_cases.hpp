#pragma once
/// \file Small conservative models for tests of integrators.

#include <polybody/forces/springs.hpp>

#include "support/chain.hpp"
#include "support/exact_pendulum.hpp"

namespace polybody {

/// A compound pendulum in the plane with an exact motion (constraint equations, no manifold). It starts `phase`
/// seconds after its release from rest.
struct SwingingBar {
  static constexpr double g = 9.81, phase = 0.3;
  using ModelType = Chain<InPlane<Constraint>>::ModelType;
  ExactPendulum exact{2.0, 1.5 * g};  ///< m g l/(J + m l²) of a uniform bar of 1 m
  Chain<InPlane<Constraint>> chain{1, bar_link(), g, exact(phase).angle};
  ModelType const& model = chain.model;
  State start = model.reference_state();

  SwingingBar() { model.set_velocity(start, chain.links[0], Vec3::Zero(), Vec3(0, 0, exact(phase).rate)); }
  SwingingBar(SwingingBar const&) = delete;  // contains references to itself
  /// The force on the bar at the pivot at time t, m (a − g) with the acceleration a of the middle; λ = −R.
  Vec2 reaction(double t) const {
    auto const [angle, rate, acceleration] = exact(phase + t);
    Vec2 const out(std::sin(angle), -std::cos(angle)), across(std::cos(angle), std::sin(angle));
    return 0.5 * (acceleration * across - rate * rate * out) + Vec2(0, g);
  }
};

/// A body on a ball joint (constraint equations and a manifold): slow asymmetric top (R6b), ω₀ in body axes, R(0) =
/// 1.
struct SlowTop {
  using Ball = Joint<Spherical, Constraint>;
  using ModelType = Model<Bodies<Rigid<>>, Joints<Ball>>;
  ModelType model{Gravity{0, 0, -9.81}};
  BodyHandle<Rigid<>> body = model.add(
      Rigid<>(1.0, Vec3(0.02, 0.01, 0.03).asDiagonal().toDenseMatrix(), Placement::at({0.3, 0.1, 0.2})), "top");
  ElementHandle<Ball> pivot =
      model.connect(Ball{}, model.ground().at({0, 0, 0}), body.at(Vec3(-0.3, -0.1, -0.2)), "pivot");
  State start = model.reference_state();

  SlowTop() { model.set_velocity(start, body, Vec3::Zero(), Vec3(1, 2, 5)); }
};

/// A free body between two springs (a manifold, no constraint equations).
struct SprungBody {
  using ModelType = Model<Bodies<Rigid<>>, Joints<>, Forces<SpringDamper>>;
  ModelType model{Gravity{0, 0, -9.81}};
  BodyHandle<Rigid<>> body = model.add(Rigid<>(2.0, Vec3(0.2, 0.3, 0.4).asDiagonal().toDenseMatrix()), "body");
  State start;

  SprungBody() {
    SpringDamper const spring{.stiffness = 80.0, .free_length = 0.7};
    model.apply(spring, model.ground().at({-1, 0, 1}), body.at(Vec3(-0.4, 0.1, 0.0)));
    model.apply(spring, model.ground().at({1, 0.5, 1}), body.at(Vec3(0.3, -0.2, 0.1)));
    start = model.reference_state();
    model.set_velocity(start, body, Vec3(0.3, 0.2, 0.0), Vec3(2, -1, 3));
  }
};

}  // namespace polybody
