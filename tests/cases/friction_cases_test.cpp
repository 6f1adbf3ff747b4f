// Cases of friction in contacts: a block at rest on an incline, a sliding block, a box launched along a floor (X10),
// the spin of a ball after a bounce (X11) and a box on a conveyor, with regularised friction and with bristles.

#include <gtest/gtest.h>

#include <numbers>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/bristle_friction.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/forces/user_force.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/energy_audit.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/held.hpp"

using namespace polybody;

namespace friction_cases_test {

constexpr double g = 9.81;

template <class F>
using OnPlane = Contact<SphereOnPlane, SpringDamperContact, F>;
template <class F>
constexpr char const* name_of = std::is_same_v<F, Friction> ? "regularised friction" : "BristleFriction";

Claim closed_form(char const* id, char const* what, char const* source, std::string const& formulation) {
  return {id, what, By::closed_form, source, formulation};
}

/// Force in newtons: A sin 2πft.
struct Shaking {
  double amplitude = 0.0, frequency = 1.0;
  Motion operator()(double t) const {
    double const w = 2.0 * std::numbers::pi * frequency;
    return {amplitude * std::sin(w * t), amplitude * w * std::cos(w * t), -amplitude * w * w * std::sin(w * t)};
  }
};

/// Block of 2 kg on an incline with tan α = 0.25, μ = 0.3, under a force along the incline. The friction force of the
/// weight is 0.83 of the limit.
struct Incline {
  static constexpr double m = 2.0, mu = 0.3, slope = 0.25, stiffness = 1e6;
  Model<Bodies<Rigid<>>, Joints<>, Forces<OnPlane<BristleFriction>, PointForce<Shaking>>> model;
  Placement const plane = Placement::at({0, 0, 0}, {0, std::atan(slope), 0});

  explicit Incline(double amplitude) : model(Gravity{0, 0, -g}) {
    double const depth = m * g * std::cos(std::atan(slope)) / 1e6;
    auto const block = model.add(Rigid<>(m, Mat3(Mat3::Identity()), {-depth * plane.axes.col(2), plane.axes}));
    model.apply(OnPlane<BristleFriction>{{.radius = 0.0},
                                         {.stiffness = 1e6, .damping = 1500.0},
                                         {.coefficient = mu, .stiffness = stiffness, .damping = 1500.0}},
                block.at(Vec3(0, 0, 0)), model.ground().at(plane));
    model.apply(PointForce<Shaking>{.force = plane.axes.col(0), .law = {amplitude, 2.0}}, block.at(Vec3(0, 0, 0)));
  }
  /// Position along the incline after one second and after another 60 s.
  template <class I>
  std::pair<double, double> positions(I const& integrator, double step) const {
    State x = model.reference_state();
    simulate(model, x, integrator, {.end_time = 1.0, .step = step}).run();
    double const loaded = plane.axes.col(0).dot(x.q.head<3>());
    simulate(model, x, integrator, {.end_time = 61.0, .step = step}).run();
    return {loaded, plane.axes.col(0).dot(x.q.head<3>())};
  }
};
// The force of 0.8 N brings the friction force to 0.97 of the limit. After 61 s it passes through zero again, as after
// one second.
template <class I>
void expect_rest(I const& integrator, double step, char const* name) {
  for (double const amplitude : {0.0, 0.8}) {
    auto const [loaded, later] = Incline(amplitude).positions(integrator, step);
    held_within(closed_form("incline", "displacement on an incline in 60 s [m]", "no slip below μN",
                            std::string("BristleFriction, ") + name),
                std::abs(later - loaded), 1e-9, {equals("amplitude", amplitude), 4.6e-6});
    EXPECT_GT(later, 4e-6) << name;  // the sudden load moves the block by m g sin α/σ₀ = 4.76e-6 m, and about 2e-6 m
    EXPECT_LT(later, 8e-6) << name;
  }
}
TEST(BlockOnAnIncline, RestsWithoutCreepAndDrift) {
  expect_rest(GeneralisedAlpha{}, 2e-3, "generalised-α, h = 2e-3 s");
  expect_rest(Radau{}, 5e-3, "Radau IIA, h = 5e-3 s");
  expect_rest(RungeKutta4<>{}, 1e-3, "Runge–Kutta, h = 1e-3 s");
}

// Coulomb sliding (C3): μ = 0.3 and v₀ = 3 m/s stop after 1.019367991845 s and 1.529051987768 m. While σ₁v exceeds μN,
// the friction is that of Coulomb. Later it is Coulomb's friction as soon as z is μN/σ₀. Back motion by μN/σ₀ follows.
TEST(SlidingBlock, WithABristleStopsAsByCoulombsLaw) {
  Model<Bodies<Rigid<>>, Joints<>, Forces<OnPlane<BristleFriction>>> model{Gravity{0, 0, -g}};
  double const depth = 2.0 * g / 1e6, sigma = 1e6;
  auto const block = model.add(Rigid<>(2.0, Mat3(Mat3::Identity()), Placement::at({0, 0, -depth})));
  model.apply(
      OnPlane<BristleFriction>{
          {.radius = 0.0}, {.stiffness = 1e6}, {.coefficient = 0.3, .stiffness = sigma, .damping = 1500.0}},
      block.at(Vec3(0, 0, 0)), model.ground().at({0, 0, 0}));
  State x = model.reference_state();
  model.set_velocity(x, block, {3, 0, 0}, {0, 0, 0});
  Event const stop{
      .name = "stop", .value = [](State const& s) { return s.v[0]; }, .terminal = true, .tolerance = 1e-12};
  simulate(model, x, DormandPrince<>{.relative_tolerance = 1e-10, .absolute_tolerance = 1e-12},
           {.end_time = 1.2, .step = 1e-4, .events = {stop}})
      .run();
  auto const slides = [](char const* what) {
    return closed_form("C3", what, "Coulomb", "BristleFriction, Dormand–Prince");
  };
  held(slides("time to the stop [s]"), x.t, 1.019367991845, 1e-8);
  held(slides("way to the stop [m]"), x.q[0], 1.529051987768, 1e-8);
  simulate(model, x, DormandPrince<>{}, {.end_time = 1.4, .step = 1e-4}).run();
  held(slides("way at rest [m]"), x.q[0], 1.529051987768 - 0.3 * 2.0 * g / sigma, 1e-8);
}

// --- X10: box launched along a floor --------------------------------------------------------------------------

// The contact of a foot by a lambda of the user.
// --- code by hand
auto foot_by_hand(double mu) {
  return user_force<2>([mu]<class T>(std::array<Frame<T>, 2> const& f, double) {
    using std::sqrt;
    Vec<T, 3> const arm(T(0.0), T(0.0), T(-0.005)), v = f[0].v + f[0].w.cross(arm);
    T const depth = 0.005 - f[0].r[2];
    T load = depth * 1e5 - v[2] * 30.0;
    if (value_of(depth) < 0.0 || value_of(load) < 0.0) load = T(0.0);
    T const drag = load * mu / sqrt(T(v[0] * v[0] + v[1] * v[1] + 1e-6));
    std::array<Wrench<T>, 2> w;
    w[0].f = Vec<T, 3>(-drag * v[0], -drag * v[1], load);
    w[0].m = arm.cross(w[0].f);
    w[1].f = -w[0].f;
    w[1].m = -Vec<T, 3>(f[0].r + arm - f[1].r).cross(w[0].f);
    return w;
  });
}
// --- end
/// The same contact by parts.
// --- code with parts
template <class F>
OnPlane<F> foot(F const& friction) {
  return {{.radius = 0.005}, {.stiffness = 1e5, .damping = 30.0}, friction};
}
// --- end

/// Cube of 0.1 m and 1 kg on four feet, launched at 6 m/s.
template <class Foot>
struct Box {
  Model<Bodies<Rigid<>>, Joints<>, Forces<Foot>> model{Gravity{0, 0, -g}};
  BodyHandle<Rigid<>> box =
      model.add(Rigid<>(1.0, Mat3(Mat3::Identity() * 0.01 / 6.0), Placement::at({0, 0, 0.05 - 0.25 * g / 1e5})));
  std::vector<ElementHandle<Foot>> feet;

  explicit Box(Foot const& foot) {
    for (double const x : {-0.045, 0.045})
      for (double const y : {-0.045, 0.045})
        feet.push_back(model.apply(foot, box.at(Vec3(x, y, -0.045)), model.ground().at({0, 0, 0})));
  }
  State start() const {
    State x = model.reference_state();
    model.set_velocity(x, box, {6, 0, 0}, {0, 0, 0});
    return x;
  }
  /// Inclination of the box, sin of the angle between its axis and the vertical.
  double tilt(State const& x) const { return std::abs(frame(model, x, box.at(Vec3(0, 0, 0))).A(2, 0)); }
};
/// \param foot contact of a foot for a coefficient of friction
template <class MakeFoot>
void expect_box_slides(std::string const& friction, MakeFoot const& foot) {
  std::string const by = friction + ", generalised-α, h = 2e-4 s";
  auto const box = [&](char const* what, char const* source) { return closed_form("X10", what, source, by); };
  Box const launched(foot(0.5));
  State x = launched.start();
  double stopped = 0.0, least = 1.0;
  for (State const& now : simulate(launched.model, x, GeneralisedAlpha{}, {.end_time = 1.5, .step = 2e-4})) {
    if (stopped == 0.0 && now.v[0] < 2e-3) stopped = now.t;
    bool const settled = now.t > 0.5 && now.t < 1.2;
    for (std::size_t i = 0; i < 4; ++i) {
      double const load = applied_wrenches(launched.model, now, launched.feet[i])[0].f.z();
      least = std::min(least, load);
      if (settled && std::fmod(now.t, 0.1) < 2e-4)
        held(box("load of a foot [N]", "mg/4 (1 ± μ h/b)"), load, 0.5 * g * (i < 2 ? 0.222222 : 0.777778), 0.05,
             {i < 2 ? "rear" : "front"});
    }
  }
  EXPECT_GT(least, 0.0);
  held(box("time to the stop [s]", "v/(μg)"), stopped, 1.2232416, 0.003 * 1.2232416);
  held(box("way to the stop [m]", "v²/(2μg)"), x.q[0], 3.6697248, 0.003 * 3.6697248);
  for (double const mu : {0.85, 0.95}) {  // it tips if μ > 0.9
    Box const other(foot(mu));
    State y = other.start();
    double most = 0.0;
    for (State const& now : simulate(other.model, y, GeneralisedAlpha{}, {.end_time = 0.7, .step = 2e-4})) {
      most = std::max(most, other.tilt(now));
      if (most > 0.2) break;
    }
    EXPECT_EQ(most > 0.2, mu > 0.9) << mu << ' ' << most;
  }
}
TEST(LaunchedBox, SlidesOnItsFeetAndTipsOverAboveTheLimit) {
  auto const slip = [](double mu) { return foot(Friction{.coefficient = mu, .slip_speed = 1e-3}); };
  expect_box_slides("regularised friction", slip);
  expect_box_slides("BristleFriction", [](double mu) {
    return foot(BristleFriction{.coefficient = mu, .stiffness = 1e5, .damping = 30.0});
  });
  Box const parts(slip(0.5));
  Box const by_hand(foot_by_hand(0.5));
  auto const way = [](auto const& box) {
    State x = box.start();
    simulate(box.model, x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 2e-4}).run();
    return x.q[0];
  };
  EXPECT_NEAR(way(parts), way(by_hand), 1e-9);
}

// --- X11: spin at the first bounce ----------------------------------------------------------------------------

/// Ball of 0.5 kg and radius 0.05 m that hits the floor at 2 m/s down and 3 m/s along, without gravity. Returns the
/// state after the bounce.
template <class F>
State bounced(F const& friction) {
  Model<Bodies<Rigid<>>, Joints<>, Forces<OnPlane<F>>> model;
  auto const ball =
      model.add(Rigid<>(0.5, Mat3(Mat3::Identity() * (0.4 * 0.5 * 0.05 * 0.05)), Placement::at({0, 0, 0.0501})));
  model.apply(OnPlane<F>{{.radius = 0.05}, SpringDamperContact::with_restitution(1e6, 0.5, 0.8), friction},
              ball.at(Vec3(0, 0, 0)), model.ground().at({0, 0, 0}));
  State x = model.reference_state();
  model.set_velocity(x, ball, {3, 0, -2}, {0, 0, 0});
  simulate(model, x, DormandPrince<>{.relative_tolerance = 1e-9, .absolute_tolerance = 1e-11},
           {.end_time = 0.01, .step = 1e-6})
      .run();
  EXPECT_GT(x.v[2], 1.5);
  return x;
}
template <class F>
void expect_spin(F const& slippery, F const& rough) {
  auto const spin = [](char const* what, char const* source) {
    return closed_form("X11", what, source, std::string(name_of<F>) + ", Dormand–Prince");
  };
  auto const balance = [&](State const& x, char const* mu) {
    held(spin("m r v′ + J ω′ [kg m²/s]", "m r v"), 0.5 * 0.05 * x.v[0] + 0.4 * 0.5 * 0.0025 * x.v[4], 0.075, 1e-6,
         {mu});
  };
  State const slides = bounced(slippery);
  double const impulse = 2.0 + slides.v[2];
  held(spin("speed after the bounce [m/s]", "v − μ (v_n + v_n′)"), slides.v[0], 3.0 - 0.1 * impulse, 1e-3, {"μ = 0.1"});
  held(spin("spin after the bounce [rad/s]", "5 μ (v_n + v_n′)/(2r)"), slides.v[4], 5.0 * 0.1 * impulse / 0.1, 0.018,
       {"μ = 0.1"});
  balance(slides, "μ = 0.1");
  State const grips = bounced(rough);
  held(spin("speed after the bounce [m/s]", "5/7 v"), grips.v[0], 15.0 / 7.0, 0.02 * 15.0 / 7.0, {"μ = 0.4"});
  held(spin("spin after the bounce [rad/s]", "5/7 v/r"), grips.v[4], 42.857143, 0.02 * 42.857143, {"μ = 0.4"});
  balance(grips, "μ = 0.4");
}
// The bristle is nearly critically damped for the mass 2/7 m of the slip. A soft bristle without damping returns its
// energy.
TEST(BouncedBall, GetsItsSpinAtTheFirstBounce) {
  expect_spin<Friction>({.coefficient = 0.1, .slip_speed = 0.01}, {.coefficient = 0.4, .slip_speed = 0.01});
  expect_spin<BristleFriction>({.coefficient = 0.1, .stiffness = 4e6, .damping = 1500.0},
                               {.coefficient = 0.4, .stiffness = 4e6, .damping = 1500.0});
}

// --- box on a conveyor ----------------------------------------------------------------------------------------

/// Box of 2 kg that is laid on a belt of 0.8 m/s, μ = 0.25.
template <class F>
void expect_conveyed(F const& friction) {
  struct Belt {
    Motion operator()(double t) const { return {0.8 * t, 0.8, 0.0}; }
  };
  using Drive = Joint<PrescribedTranslation<Belt>, Constraint>;
  using Guide = Joint<Prismatic, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Drive, Guide>, Forces<OnPlane<F>>> model{Gravity{0, 0, -g}};
  auto const belt = model.add(Rigid<>(5.0, Mat3(Mat3::Identity()), Placement{}));
  auto const box = model.add(Rigid<>(2.0, Mat3(Mat3::Identity()), Placement::at({0, 0, -2.0 * g / 1e6})));
  auto const ground = model.ground().at({0, 0, 0});
  auto const on_belt = belt.at(Vec3(0, 0, 0));
  model.connect(Guide{{.axis = Vec3(1, 0, 0)}, {}}, ground, on_belt);
  model.connect(Drive{{.law = {}, .axis = Vec3(1, 0, 0)}, {}}, ground, on_belt);
  auto const law = OnPlane<F>{{.radius = 0.0}, {.stiffness = 1e6}, friction};
  model.apply(law, box.at(Vec3(0, 0, 0)), on_belt);
  State x = model.reference_state();
  model.set_velocity(x, belt, {0.8, 0, 0}, {0, 0, 0});
  EnergyAudit audit(model);
  double slips = 0.0, lag = 0.0;
  for (State const& now : simulate(model, x, GeneralisedAlpha{}, {.end_time = 0.5, .step = 5e-5})) {
    audit.record(now);
    Vec3 const apart = position(model, now, on_belt) - position(model, now, box.at(Vec3(0, 0, 0)));
    if (now.v[model.entry(belt).v0] - now.v[model.entry(box).v0] > 2e-3) slips = now.t;
    lag = apart.x();
  }
  auto const conveyor = [](char const* what, char const* source) {
    return closed_form("conveyor", what, source, std::string(name_of<F>) + ", generalised-α, h = 5e-5 s");
  };
  held(conveyor("duration of the slip [s]", "v/(μg)"), slips, 0.3261978, 2e-3);
  held(conveyor("way of the slip [m]", "v²/(2μg)"), lag, 0.1304791, 5e-4);
  held(conveyor("heat [J]", "½ m v²"), audit.dissipated(), 0.64, 1e-3);
  held(conveyor("work of the drive [J]", "m v²"), audit.work_of_drives(), 1.28, 1e-3);
  EXPECT_LT(audit.relative(), 1e-6);
}
TEST(BoxOnAConveyor, SlipsUntilItHasTheSpeedOfTheBelt) {
  expect_conveyed<Friction>({.coefficient = 0.25, .slip_speed = 1e-3});
  expect_conveyed<BristleFriction>({.coefficient = 0.25, .stiffness = 1e6, .damping = 1500.0});
}

}  // namespace friction_cases_test
