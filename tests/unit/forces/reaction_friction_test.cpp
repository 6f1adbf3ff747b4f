// Friction that follows the reaction of a joint: laws of the element, tangent of a model, and closed forms.
#include <polybody/forces/reaction_friction.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/bushing.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/energy_audit.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/solvers/dense_lu.hpp>
#include <polybody/testing/force_laws.hpp>

#include "support/held.hpp"
#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace reaction_friction_test {

using Hinge = Joint<Revolute, Constraint>;
using Soft = Joint<Revolute, Penalty>;
using Slide = Joint<Prismatic, Constraint>;

/// Friction bound to a joint about its third axis.
template <class F, class J>
F bound(F force, J const& joint) {
  force.follow(joint, 2);
  return force;
}

// --- laws of the element --------------------------------------------------------------------------------------

StickingBearingFriction<Hinge> const sticking = bound(
    StickingBearingFriction<Hinge>{.coefficient = 0.5, .radius = 2.0, .resistance = {.stiffness = 3.0, .damping = 0.2}},
    Hinge{{.axis = Vec3(0, 0, 1)}, {}});
BearingFriction<Hinge> const sliding =
    bound(BearingFriction<Hinge>{.coefficient = 0.5, .radius = 2.0, .resistance = {.slip_speed = 0.3}},
          Hinge{{.axis = Vec3(0, 0, 1)}, {}});
Vec<double, 5> const load = [] {
  Vec<double, 5> x;
  for (int i = 0; i < 5; ++i) x[i] = 3.0 + i;
  return x;
}();

struct StickingAtALoad {
  static AtMultipliers<StickingBearingFriction<Hinge>, double> force() { return {sticking, load}; }
};
struct SlidingAtALoad {
  static AtMultipliers<BearingFriction<Hinge>, double> force() { return {sliding, load}; }
};
/// The load is the force of the penalties.
struct OfPenalties {
  static BearingFriction<Soft> force() {
    return bound(BearingFriction<Soft>{.coefficient = 0.5, .radius = 2.0, .resistance = {.slip_speed = 0.3}},
                 Soft{Revolute{.axis = Vec3(0, 0, 1)}, Penalty{.stiffness = 5.0, .damping = 0.4}});
  }
};
struct InAGuide {
  static AtMultipliers<GuideFriction<Slide>, double> force() {
    static auto const law = bound(GuideFriction<Slide>{.coefficient = 0.5, .resistance = {.slip_speed = 0.3}},
                                  Slide{{.axis = Vec3(0, 0, 1)}, {}});
    return {law, load};
  }
};
bool const obeyed[] = {
    obeys<StickingAtALoad, ForceLaws>("StickingBearingFriction"), obeys<SlidingAtALoad, ForceLaws>("BearingFriction"),
    obeys<OfPenalties, ForceLaws>("BearingFrictionOfPenalties"), obeys<InAGuide, ForceLaws>("GuideFriction")};

// The reaction of a hinge is (3, 4, 5) N for λ = (3, 4, 5, 6, 7): |F| = √50 N. At ω = 0.4 rad/s, with v_0 = 0.3 rad/s,
// the moment is 0.5 · 2 √50 · 0.4/0.5.
TEST(BearingFriction, IsProportionalToTheReaction) {
  std::array<Frame<double>, 2> f;
  f[1].w = Vec3(0, 0, 0.4);
  auto const w = sliding.wrenches<double>(f, load, {}, 0.0);
  EXPECT_LT((w[1].m - Vec3(0, 0, -0.8 * std::sqrt(50.0))).norm(), 1e-14);
  EXPECT_EQ(w[0].m, -w[1].m);
  EXPECT_EQ(w[1].f.norm(), 0.0);
  EXPECT_EQ(sliding.wrenches<double>(f, 0.0)[1].m.norm(), 0.0);
}

// --- models ---------------------------------------------------------------------------------------------------

/// Body of 2 kg whose centre has the distance 0.3 m from a hinge. J_O = 0.5 kg m² about the hinge.
template <class J, class F>
struct Arm {
  static constexpr double m = 2.0, e = 0.3, inertia = 0.5;
  Model<Bodies<Rigid<>>, Joints<J>, Forces<F>> model;
  BodyHandle<Rigid<>> body;
  ElementHandle<J> hinge;
  ElementHandle<F> friction;

  Arm(J const& joint, F const& force, Gravity const& gravity, double angle = 0.0)
      : model(gravity),
        body(model.add(Rigid<>(m, Mat3(Mat3::Identity() * (inertia - m * e * e)),
                               Placement::at(e * Vec3(std::cos(angle), 0, std::sin(angle)), {0, -angle, 0})))),
        hinge(model.connect(joint, model.ground().at({0, 0, 0}), body.at(Vec3(-e, 0, 0)), "hinge")),
        friction(model.apply(force, hinge, "friction")) {}
  State spinning(double omega) const {
    State x = model.reference_state();
    model.set_velocity(x, body, {0, 0, 0}, {0, -omega, 0});
    return x;
  }
  double rate(State const& x) const { return -frame(model, x, body.at(Vec3(0, 0, 0))).w.y(); }
};
Hinge const about_y{{.axis = Vec3(0, 1, 0)}, {}};
template <class J>
BearingFriction<J> bearing(double coefficient, double slip_speed) {
  return {.coefficient = coefficient, .radius = 0.1, .resistance = {.slip_speed = slip_speed}};
}
template <class J>
StickingBearingFriction<J> sticking_bearing(double coefficient) {
  return {.coefficient = coefficient, .radius = 0.1, .resistance = {.stiffness = 1e3, .damping = 5.0}};
}

// The tangent is unsymmetric: its columns of λ are those of Gᵀ − J^T ∂w/∂λ. Differences of the residual check all
// columns for velocities, states and multipliers.
template <class F>
void expect_exact_tangent(F const& force) {
  Arm<Hinge, F> const arm(about_y, force, Gravity{0, 0, -9.81}, 0.4);
  State x = arm.spinning(0.7);
  for (Index i = 0; i < x.lambda.size(); ++i) x.lambda[i] = 3.0 + double(i);
  if constexpr (F::states > 0) x.v[x.v.size() - 1] = 0.001;
  System system(arm.model);
  auto const residual = [&](VecX const& v, VecX const& lambda) {
    VecX r(x.v.size());
    system.evaluate(x.q, v, 0.0);
    system.residual(x.a, lambda, r);
    return r;
  };
  (void)residual(x.v, x.lambda);
  DenseLu sink;
  sink.analyse(x.v.size() + x.lambda.size(), {});
  sink.begin();
  system.tangent({.damping = 1.0, .exact = true}, SecondOrder::omitted, x.lambda, sink);
  MatX const tangent = sink.matrix();
  Index const nv = x.v.size();
  double largest = 0.0;
  for (Index j = 0; j < nv + x.lambda.size(); ++j) {
    VecX const column = slope_at_zero(
        [&](double h) {
          VecX v = x.v, lambda = x.lambda;
          (j < nv ? v[j] : lambda[j - nv]) += h;
          return residual(v, lambda);
        },
        1e-4);
    EXPECT_LT((tangent.col(j).head(nv) - column).norm(), 1e-7 * (1.0 + column.norm())) << j;
    if (j >= nv) largest = std::max(largest, (tangent.col(j).head(nv) - tangent.row(j).head(nv).transpose()).norm());
  }
  EXPECT_GT(largest, 1e-3);  // unsymmetric
}
TEST(ReactionFriction, HasTheExactTangentWithTheColumnsOfTheMultipliers) {
  expect_exact_tangent(bearing<Hinge>(0.5, 0.4));
  expect_exact_tangent(sticking_bearing<Hinge>(0.5));
  expect_exact_tangent(sticking_bearing<Hinge>(0.02));
}

// Unbalanced rotor without gravity. The reaction m e √(ω⁴ + ω̇²) brakes it: J ω̇ = −μ r m e √(ω⁴ + ω̇²) has the
// solution ω̇ = −κ ω², κ = β/√(1 − β²), β = μ r m e/J, so that 1/ω = 1/ω₀ + κ t.
template <class J, class F, class I>
void expect_braked(J const& joint, F const& force, I const& integrator, double step, double tolerance,
                   char const* name) {
  using A = Arm<J, F>;
  A const arm(joint, force, Gravity{});
  State x = arm.spinning(20.0);
  if constexpr (F::states > 0) arm.model.states(x, arm.friction)[0] = -0.5 * 0.1 * A::m * A::e * 400.0 / 1e3;
  EnergyAudit audit(arm.model);
  for (State const& now : simulate(arm.model, x, integrator, {.end_time = 2.0, .step = step})) audit.record(now);
  double const beta = 0.5 * 0.1 * A::m * A::e / A::inertia, kappa = beta / std::sqrt(1.0 - beta * beta);
  held({"bearing friction", "angular velocity of an unbalanced rotor [rad/s]", By::closed_form, "1/ω = 1/ω₀ + κ t",
        name},
       arm.rate(x), 1.0 / (1.0 / 20.0 + kappa * 2.0), tolerance);
  // the trapezoidal rule with h = 5e-4 s; the bushing is loaded suddenly
  EXPECT_LT(audit.relative(), tolerance < 1e-6 ? 1e-6 : tolerance < 1e-4 ? 1e-5 : 1e-2) << name;
  EXPECT_GT(audit.dissipated(), 1.0);
}
TEST(ReactionFriction, BrakesAnUnbalancedRotorAsInTheClosedForm) {
  auto const regular = bearing<Hinge>(0.5, 1e-6);
  expect_braked(about_y, regular, GeneralisedAlpha{}, 5e-4, 5e-5, "generalised-α, h = 5e-4 s");
  expect_braked(about_y, regular, Radau{}, 1e-3, 1e-8, "Radau IIA, h = 1e-3 s");
  expect_braked(about_y, regular, RungeKutta4<Projection>{}, 1e-3, 1e-8, "Runge–Kutta with projection, h = 1e-3 s");
  expect_braked(about_y, sticking_bearing<Hinge>(0.5), GeneralisedAlpha{}, 5e-4, 5e-5,
                "bristle, generalised-α, h = 5e-4 s");
  Joint<Revolute, Bushing> const rubber{about_y.geometry,
                                        {.stiffness = Bushing::diagonal(Vec3::Constant(1e8), Vec3::Constant(1e6)),
                                         .damping = Bushing::diagonal(Vec3::Constant(1e4), Vec3::Constant(1e2))}};
  expect_braked(rubber, bearing<Joint<Revolute, Bushing>>(0.5, 1e-6), GeneralisedAlpha{}, 5e-4, 1e-3,
                "bushing of 1e8 N/m, generalised-α, h = 5e-4 s");
}

// The arm rests at an angle φ from the vertical if m g e sin φ < μ r m g. It slips if it is steeper.
TEST(StickingBearingFriction, HoldsAnArmUpToTheLimit) {
  double const limit = 0.5 * 0.1 / Arm<Hinge, StickingBearingFriction<Hinge>>::e;  // sin φ
  for (double const share : {0.9, 1.1}) {
    double const angle = -0.5 * std::numbers::pi + std::asin(share * limit);
    Arm<Hinge, StickingBearingFriction<Hinge>> const arm(about_y, sticking_bearing<Hinge>(0.5), Gravity{0, 0, -9.81},
                                                         angle);
    State x = arm.model.reference_state();
    arm.model.states(x, arm.friction)[0] = share * 0.5 * 0.1 * 2.0 * 9.81 / 1e3;  // the bristle carries the arm
    compute_accelerations(arm.model, x);
    if (share > 1.0) {
      EXPECT_GT(largest_size(x.a.head(6)), 0.1);
      continue;
    }
    VecX const before = x.q;
    simulate(arm.model, x, GeneralisedAlpha{}, {.end_time = 10.0, .step = 1e-2}).run();
    EXPECT_LT((x.q - before).norm(), 1e-9);
  }
}

// Block on an inclined guide: v = g (sin α − μ cos α) t. With v_0 the regularised law differs by less than v_0.
TEST(GuideFriction, SlidesDownAnIncline) {
  double const alpha = 0.6, mu = 0.3;
  Vec3 const down(std::cos(alpha), 0, -std::sin(alpha));
  using Friction = GuideFriction<Slide>;
  Model<Bodies<Rigid<>>, Joints<Slide>, Forces<Friction>> model{Gravity{0, 0, -9.81}};
  auto const block = model.add(Rigid<>(2.0, Mat3(Mat3::Identity()), Placement{}));
  auto const guide = model.connect(Slide{{.axis = down}, {}}, model.ground().at({0, 0, 0}), block.at(Vec3(0, 0, 0)));
  model.apply(Friction{.coefficient = mu, .resistance = {.slip_speed = 1e-6}}, guide, "friction");
  State x = model.reference_state();
  model.set_velocity(x, block, 1e-3 * down, {0, 0, 0});
  simulate(model, x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 1e-3}).run();
  EXPECT_NEAR(x.v.head<3>().dot(down), 1e-3 + 9.81 * (std::sin(alpha) - mu * std::cos(alpha)), 1e-6);
}

// A planar hinge has two multipliers and its axis is z. The rotor is balanced: ω̇ = −μ r m g/J.
TEST(BearingFriction, BrakesABalancedPlanarRotor) {
  using Pin = Joint<planar::Revolute, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Pin>, Forces<BearingFriction<Pin>>> model{Gravity{0, -9.81, 0}};
  auto const rotor = model.add(planar::Rigid(2.0, 0.05, Placement::planar(0, 0)));
  auto const pin = model.connect(Pin{}, model.ground().at({0, 0, 0}), rotor.at(Vec2(0, 0)), "pin");
  model.apply(bearing<Pin>(0.2, 1e-6), pin, "bearing");
  State x = model.reference_state();
  model.set_velocity(x, rotor, {0, 0, 0}, {0, 0, 10});
  simulate(model, x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 1e-3}).run();
  EXPECT_NEAR(x.v[2], 10.0 - 0.2 * 0.1 * 2.0 * 9.81 / 0.05, 1e-9);
}

TEST(ReactionFriction, RefusesInvalidParameters) {
  auto const message = [](BearingFriction<Hinge> const& force) {
    return refusal([&] { Arm<Hinge, BearingFriction<Hinge>> const arm(about_y, force, Gravity{}); });
  };
  EXPECT_EQ(message({.coefficient = -1.0, .radius = 0.1, .resistance = {.slip_speed = 1.0}}),
            "\"friction\": the coefficient of friction must be zero or positive, and finite, but is -1.");
  EXPECT_EQ(message({.coefficient = 1.0, .radius = -0.1, .resistance = {.slip_speed = 1.0}}),
            "\"friction\": the radius of the bearing must be zero or positive, and finite, but is -0.1 m.");
  EXPECT_EQ(message({.coefficient = 1.0, .radius = 0.1, .resistance = {.slip_speed = 0.0}}),
            "\"friction\": the slip speed of the friction must be positive and finite, but is 0 rad/s.");
  EXPECT_EQ(refusal([&] { bearing<Hinge>(0.1, 1.0).check("\"f\""); }),
            "\"f\": this friction follows the reaction of a joint. Apply it to the handle of the joint instead of two "
            "markers.");
  StickingResistance const no_stiffness{.stiffness = 0.0, .damping = 1.0}, no_damping{.stiffness = 1.0, .damping = 0.0};
  ScalarUnits const units = detail::AngleBetween::units;
  EXPECT_EQ(refusal([&] { no_stiffness.check("\"f\"", units); }),
            "\"f\": the bristle stiffness of the friction must be positive and finite, but is 0 N m/rad.");
  EXPECT_EQ(refusal([&] { no_damping.check("\"f\"", units); }),
            "\"f\": the bristle damping of the friction must be positive and finite, but is 0 N m s/rad.");
}

}  // namespace reaction_friction_test
