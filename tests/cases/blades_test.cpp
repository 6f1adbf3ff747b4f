// Knife edges in the plane: motions in closed form under each method that enforces nonholonomic constraints.

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/joints/nonholonomic.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/run/probe.hpp>

#include "support/held.hpp"
#include "support/velocity_row_runs.hpp"

using namespace polybody;

namespace blades_test {

constexpr double g = 9.81;
using Blade = Joint<KnifeEdge, Constraint>;
using InPlane = Model<Bodies<planar::Rigid>, Joints<Blade>>;

/// Checks a distance from a closed form under one integrator of with_each_integrator.
template <class I>
void within(char const* what, char const* source, I const& integrator, double error, double tolerance, double scale) {
  held_within({"Neimark & Fufaev", what, By::closed_form, source, named(integrator)}, error, tolerance,
              {.scale = scale});
}

// A knife edge is under the centre of mass of a body on an incline. The pull p acts along x. The body starts at rest
// along x and rotates with ω. The rotation is free, θ = ωt. Along the blade u̇ = p cos θ, so u = (p/ω) sin ωt and
//   x = p/(2ω²) sin² ωt,  y = p/(2ω) (t − sin(2ωt)/(2ω)):
// The path is a cycloid across the incline, not down [Neimark & Fufaev 1972, ch. III]. The force across the blade is
// m (u ω + p sin θ) = 2 m p sin θ.
TEST(KnifeEdge, GoesAlongACycloidAcrossAnIncline) {
  double const m = 3.0, omega = 2.0, p = g * std::sin(0.4), t = 2.3;
  InPlane model{Gravity{p, 0, 0}};
  auto const sleigh = model.add(planar::Rigid(m, 0.7), "sleigh");
  auto const blade =
      model.connect(Blade{{.across = Vec3::UnitY()}, {}}, model.ground().at({0, 0, 0}), sleigh.at({0, 0}), "blade");
  State start = model.reference_state();
  model.set_velocity(start, sleigh, Vec3::Zero(), Vec3(0, 0, omega));
  double const s = std::sin(omega * t), c = std::cos(omega * t);
  Vec3 const place(p / (2.0 * omega * omega) * s * s, p / (2.0 * omega) * (t - s * c / omega), omega * t);
  Vec3 const speed(p / omega * s * c, p / omega * s * s, omega);
  with_each_integrator([&](auto const& integrator, double h, double precise) {
    State const x = rolled(model, start, integrator, t, h);
    within("place and turn of a blade on an incline", "cycloid across it", integrator, (x.q - place).norm(),
           2e-6 * precise, 1.0);
    within("speeds of a blade on an incline", "(p/ω) sin ωt along the blade", integrator, (x.v - speed).norm(),
           2e-6 * precise, 1.0);
    within("force across a blade on an incline [N]", "2 m p sin ωt", integrator,
           (reaction(model, x, blade).f - 2.0 * m * p * s * Vec3(-s, c, 0)).norm(), 1e-4 * precise, 2.0 * m * p);
    System system(model);
    system.evaluate(x.q, x.v, x.t);
    EXPECT_NEAR(peak_joint_force(system, x), 2.0 * m * p * std::abs(s), 1e-4 * precise) << integrator.name;
  });
}

// Chaplygin's sleigh: the centre of mass is a ahead of the blade. With J = I + m a², u̇ = a ω² and J ω̇ = −m a u ω.
// The energy m u² + J ω² = m U² is constant, so
//   u = U tanh(k t + c),  ω = U √(m/J) / cosh(k t + c),  k = a m U/J:
// The motion tends to a straight line, although no energy is lost [Neimark & Fufaev 1972, ch. III; Bloch 2003, §1.7].
TEST(KnifeEdge, LetsChaplyginsSleighGoStraight) {
  double const m = 2.0, inertia = 0.5, a = 0.6, J = inertia + m * a * a, U = 1.5, k = a * m * U / J, c = -2.0, t = 3.0;
  auto const along = [&](double time) { return U * std::tanh(k * time + c); };
  auto const turn = [&](double time) { return U * std::sqrt(m / J) / std::cosh(k * time + c); };
  InPlane model{};
  auto const sleigh = model.add(planar::Rigid(m, inertia, Placement::planar(a, 0)), "sleigh");
  model.connect(Blade{{.across = Vec3::UnitY()}, {}}, model.ground().at({0, 0, 0}), sleigh.at({-a, 0}), "blade");
  State start = model.reference_state();
  model.set_velocity(start, sleigh, Vec3(along(0), 0, 0), Vec3(0, 0, turn(0)));
  // θ = √(J/m)/a (atan sinh(kt + c) − atan sinh c)
  double const angle = std::sqrt(J / m) / a * (std::atan(std::sinh(k * t + c)) - std::atan(std::sinh(c)));
  with_each_integrator([&](auto const& integrator, double h, double precise) {
    State const x = rolled(model, start, integrator, t, h);
    Vec2 const blade = x.v.head<2>() - a * turn(t) * Vec2(-std::sin(angle), std::cos(angle));
    auto const claim = [&](char const* what, char const* source) {
      return Claim{"Neimark & Fufaev", what, By::closed_form, source, named(integrator)};
    };
    held(claim("turn of Chaplygin's sleigh [rad]", "√(J/m)/a (atan sinh(kt + c) − atan sinh c)"), x.q[2], angle,
         2e-6 * precise);
    held(claim("rate of turn of Chaplygin's sleigh [rad/s]", "U √(m/J)/cosh(kt + c)"), x.v[2], turn(t), 2e-6 * precise);
    within("speed of the blade of Chaplygin's sleigh [m/s]", "U tanh(kt + c)", integrator,
           (blade - along(t) * Vec2(std::cos(angle), std::sin(angle))).norm(), 5e-6 * precise, U);
    held(claim("energy of Chaplygin's sleigh [J]", "½ m U²"), energy(model, x).total(), 0.5 * m * U * U,
         1e-6 * precise);
  });
}

}  // namespace blades_test
