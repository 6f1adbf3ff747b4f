// Spatial joints compared with motions in closed form, the point pendulum of IFToMM A01 (R1) and a joint test of
// Chrono (J2).

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/math/smooth_table.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/held.hpp"
#include "support/solver_instances.hpp"

using namespace polybody;

namespace joints_exact_test {

template <JointGeometry G>
using Ideal = Joint<G, Constraint>;
using Push = Ideal<PrescribedTranslation<SmoothTable>>;
using Space = Model<Bodies<Rigid<>>, Joints<Ideal<Cylindrical>, Ideal<Distance>, Ideal<PlanarJoint>, Ideal<Prismatic>,
                                            Ideal<Screw>, Ideal<Spherical>, Push>>;

constexpr double g = 9.81;

DormandPrince<Projection> precise() { return {.relative_tolerance = 1e-11, .absolute_tolerance = 1e-11}; }
void run_to(Space const& model, State& x, double t) {
  simulate(model, x, precise(), {.end_time = t, .step = 0.01}).run();
}

Mat3 diagonal(double x, double y, double z) { return Vec3(x, y, z).asDiagonal(); }

/// Checks a vector against its closed form. The arguments are the quantity, the formula and the joint.
void within(char const* case_id, char const* what, char const* source, char const* joint, double error,
            double tolerance, double t, double scale) {
  held_within({case_id, what, By::closed_form, source, std::string(joint) + ", Dormand–Prince"}, error, tolerance,
              {equals("t", t), scale});
}

// Nut on a vertical thread without friction: m s̈ = −m g − N, I θ̈ = p N with s = p θ, so s̈ = −g m/(m + I/p²). It
// makes twenty revolutions in 3 s.
TEST(Screw, LowersANutAtTheExactRate) {
  double const m = 2.0, inertia = 0.05, p = 0.1, fall = g * m / (m + inertia / (p * p));
  Space model{Gravity{0, 0, -g}};
  auto const nut = model.add(Rigid<>(m, diagonal(0.1, 0.1, inertia)), "nut");
  auto const ground = model.ground().at({0, 0, 0});
  auto const thread =
      model.connect(Ideal<Screw>{{.pitch = p, .axis = Vec3::UnitZ()}, {}}, ground, nut.at(Vec3(0, 0, 0)), "thread");
  State x = model.reference_state();
  for (double const t : {0.5, 1.0, 3.0}) {
    run_to(model, x, t);
    double const s = -0.5 * fall * t * t;
    Frame<double> const at = frame(model, x, nut.at(Vec3(0, 0, 0)));
    within("closed forms", "place of a nut on a screw [m]", "−½ s̈ t², s̈ = g m/(m + I/p²)", "Screw",
           (at.r - Vec3(0, 0, s)).norm(), 1e-8, t, std::abs(s));
    within("closed forms", "turn of a nut on a screw", "s/p", "Screw",
           (at.A.col(0) - Vec3(std::cos(s / p), std::sin(s / p), 0)).norm(), 1e-7, t, 1.0);
    // on the nut: m (g − fall) along the axis and I θ̈ = −I fall/p about it
    Wrench<> const w = reaction(model, x, thread);
    within("closed forms", "force of a screw on its nut [N]", "m (g − s̈)", "Screw",
           (w.f - Vec3(0, 0, m * (g - fall))).norm(), 1e-7, t, m * g);
    within("closed forms", "moment of a screw on its nut [N m]", "−I s̈/p", "Screw",
           (w.m - Vec3(0, 0, -inertia * fall / p)).norm(), 1e-7, t, inertia * fall / p);
  }
}

// Generalised-α is exact for a constant acceleration. Newton's method follows the rotation past every half
// revolution.
TEST(Screw, LowersANutByImplicitSteps) {
  Space model{Gravity{0, 0, -g}};
  auto const nut = model.add(Rigid<>(2.0, diagonal(0.1, 0.1, 0.05)), "nut");
  model.connect(Ideal<Screw>{{.pitch = 0.1, .axis = Vec3::UnitZ()}, {}}, model.ground().at({0, 0, 0}),
                nut.at(Vec3(0, 0, 0)), "thread");
  State x = model.reference_state();
  simulate(model, x, GeneralisedAlpha{}, {.end_time = 3.0, .step = 0.01}).run();
  held({"closed forms", "place of a nut on a screw at 3 s [m]", By::closed_form, "−½ s̈ t², s̈ = g m/(m + I/p²)",
        "Screw, generalised-α, h = 0.01 s"},
       position(model, x, nut.at(Vec3(0, 0, 0)))[2], -0.5 * g * 2.0 / 7.0 * 9.0, 1e-8);
}

// Bar of J2 on a pin along y with free sliding along it. It swings as on a Revolute (independent computation) and
// drifts at 0.3 m/s.
TEST(Cylindrical, SwingsAsARevoluteAndDriftsEvenly) {
  struct {
    double t, x, z;
  } const exact[] = {{1, -0.892381486, -1.789875773}, {3, 1.869169564, -0.711480948}, {5, -1.999683869, -0.035558748}};
  Space model{Gravity{0, 0, -9.80665}};
  auto const bar = model.add(Rigid<>(1.0, diagonal(0.04, 0.1, 0.1), Placement::at({2, 0, 0})), "bar");
  model.connect(Ideal<Cylindrical>{{.axis = Vec3::UnitY()}, {}}, model.ground().at({0, 0, 0}), bar.at(Vec3(-2, 0, 0)),
                "sleeve");
  State x = model.reference_state();
  model.set_velocity(x, bar, {0, 0.3, 0}, Vec3::Zero());
  for (auto const& e : exact) {
    run_to(model, x, e.t);
    held_within({"J2", "middle of the bar that slides along its pin [m]", By::independent,
                 "ordinary solver of order eight, and 0.3 t along the pin", "Cylindrical, Dormand–Prince"},
                (position(model, x, bar.at(Vec3(0, 0, 0))) - Vec3(e.x, 0.3 * e.t, e.z)).norm(), 1e-8,
                {equals("t", e.t), 2.0});
  }
}

// Block on a plane inclined by asin 0.6 about y. It moves along a parabola in the plane and rotates at a constant
// rate.
TEST(PlanarJoint, LetsABlockFlyAParabola) {
  Vec3 const n(0.6, 0, 0.8), down(0.8, 0, -0.6), start(0.2, 0, -0.15);
  Space model{Gravity{0, 0, -g}};
  auto const block = model.add(Rigid<>(1.5, diagonal(0.2, 0.3, 0.4)), "block");
  auto const ground = model.ground().at(start);
  auto const plane = model.connect(Ideal<PlanarJoint>{{.normal = n}, {}}, ground, block.at(Vec3(0, 0, 0)), "plane");
  State x = model.reference_state();
  Vec3 const v = 0.5 * Vec3::UnitY() - 2.0 * down;
  model.set_velocity(x, block, v, 3.0 * n);
  for (double const t : {0.4, 2.0}) {
    run_to(model, x, t);
    Frame<double> const at = frame(model, x, block.at(Vec3(0, 0, 0)));
    within("closed forms", "place of a block on an inclined plane [m]", "v t + ½ g sin α t²", "PlanarJoint",
           (at.r - v * t - 0.3 * g * t * t * down).norm(), 1e-8, t, 1.0);
    within("closed forms", "turn of a block on an inclined plane", "exp ωt", "PlanarJoint",
           (at.A - exp_so3<double>(3.0 * t * n)).norm(), 1e-8, t, 1.0);
    within("closed forms", "force of an inclined plane on a block [N]", "m g cos α", "PlanarJoint",
           (reaction(model, x, plane).f - 1.5 * 0.8 * g * n).norm(), 1e-8, t, 1.5 * 0.8 * g);
  }
}

/// R1 (IFToMM A01), closed form: a point mass, released at (−1, 0), gravity along −y.
struct Place {
  double t, x, y;
};
constexpr std::array<Place, 4> r1{{{0.5, -0.3910487915505464, -0.9203699487851922},
                                   {1, 0.9862917511318753, -0.1650108531255412},
                                   {2, -0.7935661953433217, -0.6084839304437915},
                                   {10, -0.2750874625761169, -0.9614192050991251}}};

/// A ball at the end of a rod of 1 m, joined at its centre, moves as a point.
struct OnARod {
  Space model{Gravity{0, -g, 0}};
  BodyHandle<Rigid<>> ball;
  ElementHandle<Ideal<Distance>> rod;
  State x;
  explicit OnARod(Vec3 const& place)
      : ball(model.add(Rigid<>(2.0, diagonal(0.1, 0.1, 0.1), Placement::at(place)), "ball")),
        rod(model.connect(Ideal<Distance>{{.length = 1.0}, {}}, model.ground().at({0, 0, 0}), ball.at(Vec3(0, 0, 0)),
                          "rod")),
        x(model.reference_state()) {}
  Vec3 place() const { return position(model, x, ball.at(Vec3(0, 0, 0))); }
};

TEST(Distance, SwingsAPointWhereThePublishedSolutionIs) {
  OnARod pendulum({-1, 0, 0});
  for (Place const& p : r1) {
    run_to(pendulum.model, pendulum.x, p.t);
    within("R1", "place of the point mass on a rod [m]", "elliptic functions", "Distance",
           (pendulum.place() - Vec3(p.x, p.y, 0)).norm(), 1e-8, p.t, 1.0);
  }
}

// The conical pendulum at the angle α from the vertical: ω² = g/(L cos α), tension m g/cos α.
TEST(Distance, CarriesAConicalPendulum) {
  double const s = 0.6, c = 0.8, omega = std::sqrt(g / c);
  OnARod pendulum({s, -c, 0});
  pendulum.model.set_velocity(pendulum.x, pendulum.ball, {0, 0, -omega * s}, Vec3::Zero());
  for (double const t : {0.3, 1.7, 4.0}) {
    run_to(pendulum.model, pendulum.x, t);
    Vec3 const place(s * std::cos(omega * t), -c, -s * std::sin(omega * t));
    within("closed forms", "place of a conical pendulum [m]", "ω² = g/(L cos α)", "Distance",
           (pendulum.place() - place).norm(), 1e-8, t, 1.0);
    within("closed forms", "pull of a conical pendulum [N]", "m g/cos α", "Distance",
           (reaction(pendulum.model, pendulum.x, pendulum.rod).f + 2.0 * g / c * place).norm(), 1e-6, t, 2.0 * g / c);
  }
}

// A ball with the radius of gyration 0.4 m hangs 0.8 m from its pivot. Without spin about the line to the pivot it
// swings in any direction as a point at (0.4² + 0.8²)/0.8 = 1 m: J ω + m r × v = (J + m l²) n × ṅ.
TEST(Distance, SwingsAsABallOnABallJoint) {
  Vec3 const n(0.6, -0.48, 0.64), rate = Vec3(0.8, 0.36, -0.48) * 2.5;  // n · ṅ = 0
  OnARod point(n);
  point.model.set_velocity(point.x, point.ball, rate, Vec3::Zero());
  Space model{Gravity{0, -g, 0}};
  auto const ball = model.add(Rigid<>(2.0, diagonal(0.32, 0.32, 0.32), Placement::at(0.8 * n)), "ball");
  model.connect(Ideal<Spherical>{}, model.ground().at({0, 0, 0}), ball.at(Vec3(-0.8 * n)), "joint");
  State x = model.reference_state();
  model.set_velocity(x, ball, Vec3::Zero(), n.cross(rate));
  for (double const t : {0.5, 2.0, 4.0}) {
    run_to(point.model, point.x, t);
    run_to(model, x, t);
    held_within({"closed forms", "place of a ball on a ball joint, scaled to the centre of oscillation [m]", By::itself,
                 "point on a rod as long", "Spherical, Dormand–Prince"},
                (point.place() - position(model, x, ball.at(Vec3(0, 0, 0))) / 0.8).norm(), 1e-8, {equals("t", t), 1.0});
  }
  EXPECT_GT((point.place() - n).norm(), 0.1);
}

// Block pushed up a slope of sin = 0.6 along a table from rest to rest. The pushing force is m (s̈ + 0.6 g), the
// force of the rail 0.8 m g across. One metre in two seconds with both ends clamped is the cubic s = 3 x² − 2 x³, x =
// t/2.
TEST(PrescribedTranslation, PushesABlockUpASlope) {
  Vec3 const up(0.8, 0, 0.6), across(-0.6, 0, 0.8);
  double const m = 1.5;
  SmoothTable const table({{0.0, 0.0}, {2.0, 1.0}}, {.first_rate = 0.0, .last_rate = 0.0});
  Space model{Gravity{0, 0, -g}};
  auto const block = model.add(Rigid<>(m, diagonal(0.2, 0.3, 0.4)), "block");
  auto const ground = model.ground().at({0, 0, 0});
  auto const rail = model.connect(Ideal<Prismatic>{{.axis = up}, {}}, ground, block.at(Vec3(0, 0, 0)), "rail");
  auto const push = model.connect(Push{{.law = table, .axis = up}, {}}, ground, block.at(Vec3(0, 0, 0)), "push");
  State x = model.reference_state();
  for (double const t : {0.4, 1.5, 3.0}) {
    run_to(model, x, t);
    double const y = std::min(1.0, 0.5 * t), acceleration = t < 2.0 ? 1.5 - 3.0 * y : 0.0;
    within("closed forms", "place of a block pushed up a slope [m]", "3 x² − 2 x³, x = t/2", "PrescribedTranslation",
           (position(model, x, block.at(Vec3(0, 0, 0))) - (3.0 - 2.0 * y) * y * y * up).norm(), 1e-9, t, 1.0);
    within("closed forms", "push on a block up a slope [N]", "m (s̈ + g sin α)", "PrescribedTranslation",
           (reaction(model, x, push).f - m * (acceleration + 0.6 * g) * up).norm(), 1e-8, t, m * g);
    within("closed forms", "force of the rail of a block up a slope [N]", "m g cos α", "Prismatic",
           (reaction(model, x, rail).f - m * 0.8 * g * across).norm(), 1e-8, t, m * g);
  }
}

}  // namespace joints_exact_test
