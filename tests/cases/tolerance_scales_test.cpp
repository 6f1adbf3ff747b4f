// The accuracy of a body is independent of bodies that do not act on it and of a common velocity. It is also
// independent of the distance to the origin and of accumulated rotations. The case is from issue 1392 of Basilisk:
// step control by one norm over orbital velocity and attitude.

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/integrators/adams_bashforth_moulton.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/integrators/symplectic.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/run/simulate.hpp>

using namespace polybody;

namespace tolerance_scales_test {

/// Attraction proportional to 1/r² between two markers.
struct Attraction {
  static constexpr int markers = 2;
  static constexpr MarkerKind needs = MarkerKind::point;
  static constexpr bool is_load = false;
  double mu;  ///< [N m²]

  void check(std::string const&) const {}
  template <StateScalar T>
  std::array<Wrench<T>, 2> wrenches(std::array<Frame<T>, 2> const& f, double) const {
    using std::sqrt;
    Vec<T, 3> const d = f[1].r - f[0].r;
    T const r2 = d.dot(d);
    std::array<Wrench<T>, 2> w;
    w[0].f = d * (T(mu) / (r2 * sqrt(r2)));
    w[1].f = -w[0].f;
    return w;
  }
};

/// Spring about z between two planar bodies.
struct TorsionSpring {
  static constexpr int markers = 2;
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr bool is_load = false;
  double stiffness;  ///< [N m/rad]

  void check(std::string const&) const {}
  template <StateScalar T>
  std::array<Wrench<T>, 2> wrenches(std::array<Frame<T>, 2> const& f, double) const {
    using std::atan2;
    auto const &a = f[0].A, &b = f[1].A;
    T const angle = atan2(T(a(0, 0) * b(1, 0) - a(1, 0) * b(0, 0)), T(a(0, 0) * b(0, 0) + a(1, 0) * b(1, 0)));
    std::array<Wrench<T>, 2> w;
    w[0].m[2] = angle * T(stiffness);
    w[1].m[2] = angle * T(-stiffness);
    return w;
  }
};

template <class I>
I with_tolerance(double tolerance) {
  I integrator;
  integrator.relative_tolerance = tolerance;
  integrator.absolute_tolerance = 1e-2 * tolerance;
  return integrator;
}

/// Kepler ellipse of semi-major axis 1 m and eccentricity ½ around `centre` under μ = 1, from its far end at t = 0.
Vec2 ellipse(double t, double centre) {
  double e = t;  // eccentric anomaly from the far end: E + ½ sin E = t
  for (int i = 0; i < 100; ++i) e -= (e + 0.5 * std::sin(e) - t) / (1.0 + 0.5 * std::cos(e));
  return {centre + 0.5 + std::cos(e), std::sqrt(0.75) * std::sin(e)};
}

struct Outcome {
  double error;  ///< of the planet's position at 20 s [m]
  long steps;
};

/// Planet at `centre`, with a wheel and a flying body that do not act on it.
template <class I>
Outcome planet(double tolerance, double rotor, double flight, double centre = 0.0) {
  Model<Bodies<planar::Rigid>, Joints<>, Forces<Attraction>> model;
  auto const planet = model.add(planar::Rigid(1.0, 0.1, Placement::planar(centre + 1.5, 0.0)), "planet");
  model.add(planar::Rigid(1.0, 0.1, Placement::planar(9.0, 0.0)), "wheel");
  auto const shot = model.add(planar::Rigid(1.0, 0.1, Placement::planar(-9.0, 0.0)), "shot");
  model.apply(Attraction{1.0}, planet.at(Vec2(0, 0)), model.ground().at({centre, 0, 0}), "sun");
  State x = model.reference_state();
  model.set_velocity(x, planet, Vec3(0, std::sqrt(0.5 / 1.5), 0), Vec3::Zero());
  x.v[5] = rotor;
  model.set_velocity(x, shot, Vec3(flight, 0, 0), Vec3::Zero());
  long const steps = simulate(model, x, with_tolerance<I>(tolerance), {.end_time = 20.0, .step = 1e-3}).run().steps;
  return {(x.q.head<2>() - ellipse(20.0, centre)).norm(), steps};
}

template <class I>
void keeps_the_orbit(double bound) {
  Outcome const alone = planet<I>(1e-8, 0.0, 0.0);
  EXPECT_LT(alone.error, bound);
  for (double const rotor : {1e2, 1e3, 1e4, 1e5}) {
    Outcome const beside = planet<I>(1e-8, rotor, 0.0);
    EXPECT_NEAR(beside.error, alone.error, 1e-10) << rotor;
    EXPECT_EQ(beside.steps, alone.steps) << rotor;
  }
  Outcome const shot = planet<I>(1e-8, 0.0, 1e5);
  EXPECT_NEAR(shot.error, alone.error, 1e-10);
  EXPECT_EQ(shot.steps, alone.steps);
}

TEST(ToleranceScales, DormandPrinceKeepsAnOrbitBesideFastBodies) { keeps_the_orbit<DormandPrince<>>(5e-6); }
TEST(ToleranceScales, AdamsKeepsAnOrbitBesideFastBodies) { keeps_the_orbit<AdamsBashforthMoulton<>>(5e-5); }

// Round-off of 1e6 m is 1e-10 m.
TEST(ToleranceScales, AnOrbitFarFromTheOriginIsAsExact) {
  Outcome const here = planet<DormandPrince<>>(1e-8, 0.0, 0.0), far = planet<DormandPrince<>>(1e-8, 0.0, 0.0, 1e6);
  EXPECT_LT(far.error, 5e-6);
  EXPECT_NEAR(double(far.steps), double(here.steps), 0.02 * double(here.steps));
}

/// Error of the planet's position at 20 s in a model with a spatial rotor, whose quaternion and velocities have their
/// own scales [m].
template <class I>
double beside_a_rotor_in_space(double rotor) {
  Model<Bodies<planar::Rigid, Rigid<>>, Joints<>, Forces<Attraction>> model;
  auto const planet = model.add(planar::Rigid(1.0, 0.1, Placement::planar(1.5, 0.0)), "planet");
  auto const wheel = model.add(Rigid<>(1.0, Vec3(0.1, 0.1, 0.2).asDiagonal().toDenseMatrix()), "wheel");
  model.apply(Attraction{1.0}, planet.at(Vec2(0, 0)), model.ground().at({0, 0, 0}), "sun");
  State x = model.reference_state();
  model.set_velocity(x, planet, Vec3(0, std::sqrt(0.5 / 1.5), 0), Vec3::Zero());
  model.set_velocity(x, wheel, Vec3::Zero(), Vec3(0, 0, rotor));
  simulate(model, x, with_tolerance<I>(1e-8), {.end_time = 20.0, .step = 1e-3}).run();
  return (x.q.head<2>() - ellipse(20.0, 0.0)).norm();
}

TEST(ToleranceScales, AnOrbitIsAsExactBesideARotorInSpace) {
  for (double const rotor : {0.0, 1e2, 1e5}) EXPECT_LT(beside_a_rotor_in_space<DormandPrince<>>(rotor), 5e-6) << rotor;
  for (double const rotor : {0.0, 1e2})
    EXPECT_LT(beside_a_rotor_in_space<AdamsBashforthMoulton<>>(rotor), 5e-5) << rotor;
}

/// Hub with a panel on a pin and a torsion spring, in flight at a common velocity.
template <class Policy>
struct Spacecraft {
  using Pin = Joint<planar::Revolute, Policy>;
  Model<Bodies<planar::Rigid>, Joints<Pin>, Forces<TorsionSpring>> model;
  State x;
  double velocity;

  explicit Spacecraft(double common) : velocity(common) {
    double const open = 0.2;
    auto const hub = model.add(planar::Rigid(100.0, 20.0), "hub");
    auto const panel = model.add(
        planar::Rigid(10.0, 40.0 / 12.0, Placement::planar(0.5 + std::cos(open), std::sin(open), open)), "panel");
    model.connect(Pin{}, hub.at(Vec2(0.5, 0)), panel.at(Vec2(-1, 0)), "pin");
    model.apply(TorsionSpring{5.0}, hub.at(Vec2(0, 0)), panel.at(Vec2(0, 0)), "spring");
    x = model.reference_state();
    x.v << common, 0.0, 0.3, common - 0.3 * std::sin(open), 0.3 * (0.5 + std::cos(open)), 0.3;
  }
  double hub_x() const { return x.q[0] - velocity * x.t; }
  double angle() const { return x.q[2]; }
  double opening() const { return x.q[5] - x.q[2]; }
};

// Independent computation by DOP853 at a tolerance of 1e-13 with the data of Basilisk's issue 1392.
struct {
  double t, x, y, angle, opening;
} constexpr exact[] = {{5.0, 0.10859823, 0.08353374, 1.56762583, 0.01727412},
                       {20.0, -0.10779035, 0.84771457, 5.99235376, 0.18823469},
                       {50.0, -0.03204552, 1.94890694, 15.09720528, -0.13013544}};

template <class Policy, class I>
void does_not_feel_a_common_velocity() {
  long steps[2] = {0, 0};
  for (int const moving : {0, 1}) {
    Spacecraft<Policy> craft(moving ? 7600.0 : 0.0);
    for (auto const& e : exact) {
      steps[moving] +=
          simulate(craft.model, craft.x, with_tolerance<I>(1e-8), {.end_time = e.t, .step = 0.01}).run().steps;
      EXPECT_NEAR(craft.hub_x(), e.x, 1e-6) << moving << ' ' << e.t;
      EXPECT_NEAR(craft.x.q[1], e.y, 1e-6) << moving << ' ' << e.t;
      EXPECT_NEAR(craft.angle(), e.angle, 1e-6) << moving << ' ' << e.t;
      EXPECT_NEAR(craft.opening(), e.opening, 1e-6) << moving << ' ' << e.t;
    }
    EXPECT_NEAR(craft.x.v[5] - craft.x.v[2], 0.14579714, 1e-6) << moving;
  }
  EXPECT_NEAR(double(steps[1]), double(steps[0]), 0.1 * double(steps[0]));
}

TEST(ToleranceScales, DormandPrinceDoesNotFeelACommonVelocity) {
  does_not_feel_a_common_velocity<Constraint, DormandPrince<Projection>>();
  does_not_feel_a_common_velocity<JointCoordinates, DormandPrince<>>();
}
TEST(ToleranceScales, AdamsDoesNotFeelACommonVelocity) {
  does_not_feel_a_common_velocity<Constraint, AdamsBashforthMoulton<Projection>>();
  does_not_feel_a_common_velocity<JointCoordinates, AdamsBashforthMoulton<>>();
}

template <class I>
void is_invariant_at_fixed_steps(I const& integrator, double bound) {
  double angle[2], opening[2];
  for (int const moving : {0, 1}) {
    Spacecraft<Constraint> craft(moving ? 7600.0 : 0.0);
    simulate(craft.model, craft.x, integrator, {.end_time = 50.0, .step = 0.01}).run();
    angle[moving] = craft.angle();
    opening[moving] = craft.opening();
  }
  EXPECT_NEAR(angle[1], angle[0], bound);
  EXPECT_NEAR(opening[1], opening[0], bound);
}

TEST(ToleranceScales, FixedStepsAreInvariantUnderACommonVelocity) {
  is_invariant_at_fixed_steps(RungeKutta4<Projection>{}, 1e-9);
  is_invariant_at_fixed_steps(CentralDifference<Projection>{}, 1e-9);
  is_invariant_at_fixed_steps(GeneralisedAlpha{}, 5e-6);  // index 3: 6e-11 m, the round-off of 4e5 m, divided by h²
}

// The accuracy of the satellite's attitude is the same with and without a wheel. Both rotate about one axis in the
// plane.
TEST(ToleranceScales, AccumulatedTurnsOfAWheelDoNotCount) {
  for (double const rate : {0.0, 1e3, 1e5}) {
    Model<Bodies<planar::Rigid>, Joints<Joint<planar::Revolute, Constraint>>, Forces<TorsionSpring>> model;
    auto const hub = model.add(planar::Rigid(100.0, 20.0), "hub");
    auto const wheel = model.add(planar::Rigid(1.0, 0.1, Placement::planar(0.0, 0.0)), "wheel");
    model.connect(Joint<planar::Revolute, Constraint>{}, hub.at(Vec2(0, 0)), wheel.at(Vec2(0, 0)), "bearing");
    model.apply(TorsionSpring{20.0}, hub.at(Vec2(0, 0)), model.ground().at({0, 0, 0}), "spring");
    State x = model.reference_state();
    x.v[2] = 0.5;  // about the ground: φ¨ = −φ, because the bearing has no moment
    x.v[5] = rate;
    simulate(model, x, with_tolerance<DormandPrince<Projection>>(1e-8), {.end_time = 20.0, .step = 1e-3}).run();
    EXPECT_NEAR(x.q[2], 0.5 * std::sin(20.0), 1e-6) << rate;
    EXPECT_NEAR(x.v[2], 0.5 * std::cos(20.0), 1e-6) << rate;
  }
}

}  // namespace tolerance_scales_test
