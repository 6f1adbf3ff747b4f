// Chrono's joint tests against ADAMS (J2), the Cardan joint (J4, closed form) and Wallin 2016, Eq. 3.8: pins, balls
// and crosses in space.

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/held.hpp"
#include "support/solver_instances.hpp"

using namespace polybody;

namespace joints_adams_test {

template <JointGeometry G>
using Ideal = Joint<G, Constraint>;
using Space = Model<Bodies<Rigid<>>, Joints<Ideal<Revolute>, Ideal<RevolutePin>, Ideal<Spherical>, Ideal<Universal>,
                                            Ideal<ParallelAxes>, Ideal<PrescribedRate<Constant>>>>;

DormandPrince<Projection> precise() { return {.relative_tolerance = 1e-11, .absolute_tolerance = 1e-11}; }

/// Horizontal and vertical position of the middle of the bar, released at (2, 0) (J2, independent computation).
struct Swing {
  double t, out, up;
};
constexpr std::array<Swing, 5> swings{{{1, -0.892381486, -1.789875773},
                                       {2, -1.951117169, -0.439479003},
                                       {3, 1.869169564, -0.711480948},
                                       {4, 1.296964691, -1.522459388},
                                       {5, -1.999683869, -0.035558748}}};
/// J2: Spherical_Case01 and Universal_Case01 of ADAMS at t = 5, printed values. The tolerance of Chrono's test is
/// 2e-3.
constexpr double adams_out = -1.99967, adams_up = -0.0361929, adams_tolerance = 2e-3;

/// Bar of 4 m that hangs from the origin by one joint. `out` and `up` are the axes of its motion.
template <class J>
struct Swinging {
  Space model{Gravity{0, 0, -9.80665}};
  BodyHandle<Rigid<>> bar;
  ElementHandle<J> joint;
  State x;

  Swinging(J const& by, Vec3 const& inertia, Placement const& place, Vec3 const& end,
           Vec3 const& on_ground = Vec3::Zero())
      : bar(model.add(Rigid<>(1.0, inertia.asDiagonal().toDenseMatrix(), place), "bar")),
        joint(model.connect(by, model.ground().at(on_ground), bar.at(end), "joint")),
        x(model.reference_state()) {}

  void expect_the_swings(Vec3 const& out, char const* formulation) {
    for (Swing const& s : swings) {
      simulate(model, x, precise(), {.end_time = s.t, .step = 0.01}).run();
      Vec3 const at = position(model, x, bar.at(Vec3(0, 0, 0)));
      held_within({"J2", "middle of the bar [m]", By::independent, "ordinary solver of order eight", formulation},
                  (at - s.out * out - Vec3(0, 0, s.up)).norm(), 1e-8, {equals("t", s.t), 2.0});
    }
    Vec3 const last = position(model, x, bar.at(Vec3(0, 0, 0)));
    held_within({"J2", "middle of the bar at 5 s [m]", By::published, "Chrono's data of ADAMS, 6 digits", formulation},
                (last - adams_out * out - Vec3(0, 0, adams_up)).norm(), adams_tolerance, {.scale = 2.0});
  }
};

Vec3 const along_x(0.04, 0.1, 0.1), along_z(0.1, 0.1, 0.04);

TEST(AdamsCases, SphericalSwingsInThePlaneOfItsRelease) {
  Swinging(Ideal<Spherical>{}, along_x, Placement::at({2, 0, 0}), {-2, 0, 0})
      .expect_the_swings(Vec3::UnitX(), "Spherical, Dormand–Prince");
}

// The bar lies along its own z, which is the world's y. It swings about x, one arm of the cross, which is fixed to
// the ground or to the bar. The other arm is vertical or along the bar.
TEST(AdamsCases, UniversalSwingsAboutEitherArm) {
  Placement const level = Placement::at({0, 2, 0}, {-0.5 * std::numbers::pi, 0, 0});
  for (auto const& [first, second] : {std::pair{Vec3(1, 0, 0), Vec3(0, 0, 1)},
                                      {Vec3(1, 0, 0), Vec3(0, 1, 0)},
                                      {Vec3(0, 0, 1), Vec3(1, 0, 0)},
                                      {Vec3(0, 1, 0), Vec3(1, 0, 0)}})
    Swinging(Ideal<Universal>{{.first = first, .second = second}, {}}, along_z, level, {0, 0, -2})
        .expect_the_swings(Vec3::UnitY(), "Universal, Dormand–Prince");
}

// Two forms of the revolute joint: Wallin 2016, Eq. 3.8, with points half a metre apart along the pin, and the
// spherical form of §3.5.1. Motion and wrench on the bar agree.
TEST(RevolutePin, IsTheRevoluteOfTheSphericalForm) {
  Placement const level = Placement::at({2, 0, 0});
  Swinging one(Ideal<Revolute>{{.axis = Vec3::UnitY()}, {}}, along_x, level, {-2, 0.3, 0}, {0, 0.3, 0});
  Swinging other(Ideal<RevolutePin>{{.distance = 0.5, .axis = Vec3::UnitY()}, {}}, along_x, level, {-2, 0.3, 0},
                 {0, -0.2, 0});
  one.expect_the_swings(Vec3::UnitX(), "Revolute, Dormand–Prince");
  other.expect_the_swings(Vec3::UnitX(), "RevolutePin, Dormand–Prince");
  auto const alike = [](char const* what, double distance, double tolerance, double scale) {
    held_within({"J2", what, By::itself, "Revolute", "RevolutePin, Dormand–Prince"}, distance, tolerance,
                {.scale = scale});
  };
  alike("place and turn of the bar at 5 s", (one.x.q - other.x.q).norm(), 1e-8, 2.0);
  Wrench<> const by_one = reaction(one.model, one.x, one.joint), by_other = reaction(other.model, other.x, other.joint);
  EXPECT_NEAR(by_one.m.norm(), 0.3 * by_one.f.norm(), 1e-7);  // the pin's point is 0.3 m from the plane of the bar
  EXPECT_GT(by_one.m.norm(), 0.1);
  alike("force of the pin at 5 s [N]", (by_one.f - by_other.f).norm(), 1e-6, by_one.f.norm());
  alike("moment of the pin at 5 s [N m]", (by_one.m - by_other.m).norm(), 1e-6, by_one.m.norm());
}

// J4, closed form: two shafts at β = 30°, the first at 1 rad/s. The ratio ω₂/ω₁ = cos β/(1 − sin²β cos²φ) is between
// cos β and 1/cos β. The angle φ is between the arm of the first shaft and the plane of both shafts. The second shaft
// is constrained along its axis only, and the cross constrains its position.
TEST(CardanJoint, HasTheRatioOfSpeeds) {
  double const beta = std::numbers::pi / 6.0, c = std::cos(beta), s2 = 0.25;
  Vec3 const n(c, 0.5, 0);
  Space model{};
  Mat3 const inertia = Vec3(0.02, 0.1, 0.1).asDiagonal();
  auto const first = model.add(Rigid<>(1.0, inertia, Placement::at({-1, 0, 0})), "first");
  auto const second = model.add(Rigid<>(1.0, inertia, Placement::at(n, {0, 0, beta})), "second");
  auto const ground = model.ground().at({0, 0, 0});
  model.connect(Ideal<Revolute>{{.axis = Vec3::UnitX()}, {}}, ground, first.at(Vec3(1, 0, 0)), "bearing");
  model.connect(Ideal<ParallelAxes>{{.axis = n}, {}}, ground, second.at(Vec3(-1, 0, 0)), "sleeve");
  model.connect(Ideal<Universal>{{.first = Vec3::UnitY(), .second = Vec3::UnitZ()}, {}}, first.at(Vec3(1, 0, 0)),
                second.at(Vec3(-1, 0, 0)), "cross");
  model.connect(Ideal<PrescribedRate<Constant>>{{.law = {{.value = 1.0}}, .axis = Vec3::UnitX()}, {}}, ground,
                first.at(Vec3(1, 0, 0)), "motor");
  State x = model.reference_state();
  model.set_velocity(x, first, Vec3::Zero(), Vec3::UnitX());
  model.set_velocity(x, second, Vec3::Zero(), n / c);
  double least = 2.0, most = 0.0;
  for (int i = 0; i <= 8; ++i) {
    double const phi = i * std::numbers::pi / 4.0;
    if (i > 0) simulate(model, x, precise(), {.end_time = phi, .step = 0.01}).run();
    double const ratio = frame(model, x, second.at(Vec3(0, 0, 0))).w.dot(n);
    held({"J4", "ratio of the speeds of two shafts on a cross", By::closed_form, "cos β/(1 − sin²β cos²φ)",
          "Universal, Dormand–Prince"},
         ratio, c / (1.0 - s2 * std::cos(phi) * std::cos(phi)), 1e-9, {equals("φ", phi)});
    least = std::min(least, ratio);
    most = std::max(most, ratio);
  }
  Claim const extreme{"J4", "least and largest ratio of the speeds", By::closed_form, "cos β, 1/cos β",
                      "Universal, Dormand–Prince"};
  held(extreme, least, 0.8660254, 1e-7, {"least"});
  held(extreme, most, 1.1547005, 1e-7, {"largest"});
}

}  // namespace joints_adams_test
