// Joint forces of a spinning ring, and deflections of compliant joints (C5).
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/policies/bushing.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include <gtest/gtest.h>

#include "support/held.hpp"

using namespace polybody;

namespace spinning_ring_test {

/// Closed ring of N links that spins about its centre, links tangential (C5, closed form).
template <class Policy>
struct Ring {
  using Pin = Joint<Revolute, Policy>;
  Model<Bodies<Rigid<>>, Joints<Pin>> model;
  std::vector<BodyHandle<Rigid<>>> links;
  std::vector<ElementHandle<Pin>> pins;
  double const half_angle, middle;  ///< π/N, distance of the links' middles from the centre

  Ring(int n, double mass, double length, Policy const& policy)
      : half_angle(std::numbers::pi / n), middle(0.5 * length / std::tan(half_angle)) {
    double const across = mass * length * length / 12.0;
    for (int i = 0; i < n; ++i) {
      double const angle = 2.0 * half_angle * i;
      links.push_back(model.add(Rigid<>(mass, Vec3(0.1 * across, across, across).asDiagonal().toDenseMatrix(),
                                        Placement::planar(middle * std::cos(angle), middle * std::sin(angle),
                                                          angle + 0.5 * std::numbers::pi)),
                                "link " + std::to_string(i + 1)));
    }
    for (int i = 0; i < n; ++i)
      pins.push_back(model.connect(Pin{{.axis = Vec3::UnitZ()}, policy},
                                   links[std::size_t(i)].at(Vec3(0.5 * length, 0, 0)),
                                   links[std::size_t((i + 1) % n)].at(Vec3(-0.5 * length, 0, 0))));
  }
  /// Steady state with links moved outward such that every joint opens by `gap`: its two ends move by `gap`/(2 sin
  /// π/N) each.
  State spinning(double omega, double gap) const {
    State x = model.reference_state();
    for (auto const& link : links) {
      Index const q0 = model.entry(link).q0;
      x.q.segment<3>(q0) *= 1.0 + gap / (2.0 * std::sin(half_angle) * middle);
      model.set_velocity(x, link, {0, 0, 0}, {0, 0, omega});
    }
    return x;
  }
  /// Direction of the force of joint i on the previous link: tangential, along (sin, −cos) of the joint's polar
  /// angle, rotated by `turned`.
  Vec3 direction(int i, double turned) const {
    double const angle = half_angle * (2 * i + 1) + turned;
    return {std::sin(angle), -std::cos(angle), 0.0};
  }
};

struct Spin {
  int links;
  double mass, length, omega, force;
};
constexpr Spin spins[] = {{10, 1.0, 0.1, 10.0, 24.8989828488}, {40, 2.0, 0.15, 5.0, 303.650375515}};

/// Relative errors of joint forces and deflections after a hundred steps from the steady state, which is constant.
/// The stages of the integrator deflect stiff joints by a fraction of R (ω h)², and the joints respond. In
/// deflections of 2e-6 m this error of fourth order is still 1e-6 at ω h = 5e-4.
template <class Integrator, class Policy>
void expect_ring(Spin const& s, Policy const& policy, double stiffness, std::string const& pins) {
  double const h = 1e-4 / s.omega, tolerance = std::isinf(stiffness) ? 1e-10 : 1e-8;
  Ring<Policy> const ring(s.links, s.mass, s.length, policy);
  // k g = F (1 + u/R) with the outward displacement u = g/(2 sin π/N) and F at the middle radius R of the closed
  // ring: g = F/(k − m ω²/(4 sin² π/N))
  double const sine = std::sin(ring.half_angle), softening = s.mass * s.omega * s.omega / (4.0 * sine * sine);
  double const open = std::isinf(stiffness) ? 0.0 : s.force / (stiffness - softening);
  double const force = std::isinf(stiffness) ? s.force : stiffness * open;
  EXPECT_NEAR(force, s.force, 1e-3 * s.force);
  EXPECT_NEAR(s.force, s.mass * s.omega * s.omega * s.length * std::cos(ring.half_angle) / (4.0 * sine * sine),
              1e-10 * s.force);
  State x = ring.spinning(s.omega, open);
  double worst = 0.0, worst_moment = 0.0, worst_gap = 0.0;
  for (State const& now : simulate(ring.model, x, Integrator{}, {.end_time = 100 * h, .step = h}))
    for (int const i : {0, s.links / 3, s.links - 1}) {
      Wrench<> const w = reaction(ring.model, now, ring.pins[std::size_t(i)]);
      worst = std::max(worst, (w.f - force * ring.direction(i, s.omega * now.t)).norm());
      worst_moment = std::max(worst_moment, w.m.norm());
      if constexpr (!std::is_same_v<Policy, Constraint>) {
        double const g = constraint_violation(ring.model, now, ring.pins[std::size_t(i)]).norm();
        worst_gap = std::max(worst_gap, std::abs(g - open));
        EXPECT_NEAR(g, s.force / stiffness, 1e-3 * g);
      }
    }
  EXPECT_LT(worst_moment, tolerance * force) << s.links;
  Instance const at{equals("N", s.links), force};
  std::string const formulation = "rings of 10 and 40 links in space, " + pins + ", Runge–Kutta 4, ωh = 1e-4";
  held_within({"C5", "force of the joints [N]", By::closed_form, "m ω² l cos(π/N)/(4 sin²(π/N)), with the gap's share",
               formulation},
              worst, tolerance * force, at);
  if (open > 0.0)
    held_within(
        {"C5", "gap of the joints [m]", By::closed_form, "force over stiffness, with the gap's share", formulation},
        worst_gap, tolerance * open, {at.at, open});
}

TEST(SpinningRing, HasTheForceOfTheClosedForm) {
  for (Spin const& s : spins)
    expect_ring<RungeKutta4<Projection>>(s, Constraint{}, std::numeric_limits<double>::infinity(), "ideal pins");
}
TEST(SpinningRing, OpensPenaltiesByTheForceOverTheStiffness) {
  PenaltyPerEquation<5> const penalty{.stiffness = Vec<double, 5>(1e7, 1e7, 1e7, 100.0, 100.0),
                                      .damping = Vec<double, 5>::Zero()};
  for (Spin const& s : spins) expect_ring<RungeKutta4<>>(s, penalty, 1e7, "penalties of 1e7 N/m");
}
TEST(SpinningRing, OpensBushingsByTheForceOverTheStiffness) {
  Bushing const bushing{.stiffness = Bushing::diagonal({1e7, 1e7, 1e7}, {100, 100, 0}),
                        .damping = Bushing::Matrix::Zero()};
  for (Spin const& s : spins) expect_ring<RungeKutta4<>>(s, bushing, 1e7, "bushings of 1e7 N/m");
}

}  // namespace spinning_ring_test
