#include <polybody/vibration/steady_rotation.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/bodies/rigid/rigid_euler_parameters.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/forces/user_force.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/standard_joints.hpp>

#include "support/refusal.hpp"

using namespace polybody;

namespace steady_rotation_test {

using Pin = Joint<Revolute, Constraint>;
using Ball = Joint<Spherical, Constraint>;
using Drive = Joint<PrescribedAngle<Ramp>, Constraint>;

/// Drag c relative to the ground.
auto const drag = user_force<1>([](auto const& frames, double) {
  using T = typename std::decay_t<decltype(frames[0].r)>::Scalar;
  Wrench<T> w;
  w.f = frames[0].v * T(-1.2);
  return std::array{w};
});

// few model types, for the compilation time
using PlaneModel = Model<Bodies<planar::Rigid>, Joints<>, Forces<SpringDamper, std::decay_t<decltype(drag)>>>;
template <class B>
using SpaceModel = Model<Bodies<B>, Joints<Pin, Ball, Drive>, Forces<SpringDamper>>;

SteadyRotation about_z(double omega) { return {.angular_velocity = {0, 0, omega}}; }

/// Eigenvalues about a steady rotation, without those of free motions, below 1e-4 rad/s.
std::vector<std::complex<double>> eigenvalues(Linearisation const& l) {
  std::vector<std::complex<double>> kept;
  for (std::complex<double> const s : damped_modes(l, 100).eigenvalue)
    if (std::abs(s) > 1e-4) kept.push_back(s);
  return kept;
}

/// Mass m on a spring k, c of free length l₀ whose other end is at the origin. Both rotate about z. In the rotating
/// frame
///   radial ξ¨ + (c/m) ξ˙ − 2Ω η˙ + (k/m − Ω²) ξ = 0,  tangential η¨ + 2Ω ξ˙ + (N/(m r₀) − Ω²) η = 0,
/// and the tension N = k (r₀ − l₀) = m Ω² r₀ cancels the last term: s² (s² + (c/m) s + k/m + 3Ω²) = 0. Normal to the
/// plane ζ¨ + Ω² ζ = 0.
struct Slung {
  double const m = 2.0, k = 50.0, c = 1.2, free_length = 1.0, omega = 3.0;
  double const radius = k * free_length / (k - m * omega * omega);
  std::complex<double> const radial{-0.5 * c / m, std::sqrt(k / m + 3.0 * omega * omega - 0.25 * c * c / (m * m))};

  template <class M, class B, class Point>
  Linearisation turning(M model, B const& body, Point const& centre) const {
    auto const mass = model.add(body, "mass");
    SpringDamper const spring{.stiffness = k, .damping = c, .free_length = free_length};
    model.apply(spring, model.ground().at({0, 0, 0}), mass.at(centre));
    State x = model.reference_state();
    relative_equilibrium(model, x, about_z(omega));
    EXPECT_NEAR(x.q.template head<2>().norm(), radius, 1e-10);
    return linearise(model, x, about_z(omega));
  }
};

TEST(SteadyRotation, OfAMassOnASpringInThePlane) {
  Slung const slung;
  auto const s =
      eigenvalues(slung.turning(PlaneModel(), planar::Rigid(slung.m, 0.3, Placement::planar(0.9, 0.9)), Vec2(0, 0)));
  ASSERT_EQ(s.size(), 1u);
  EXPECT_LT(std::abs(s[0] - slung.radial), 1e-8);
}

// In space the body's own rotation is included. A sphere with a tilted spin keeps it, and in the rotating frame the
// spin axis rotates with Ω.
TEST(SteadyRotation, OfAMassOnASpringInSpace) {
  Slung const slung;
  Rigid<> const sphere(slung.m, 0.3 * Mat3::Identity(), Placement::at({0.9, 0.9, 0}, {0.3, -0.5, 0.7}));
  auto const s = eigenvalues(slung.turning(SpaceModel<Rigid<>>(), sphere, Vec3(0, 0, 0)));
  ASSERT_EQ(s.size(), 3u);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_LT(std::abs(s[i] - std::complex<double>(0.0, slung.omega)), 1e-6);
  EXPECT_LT(std::abs(s[2] - slung.radial), 1e-8);
}

// Mass at rest on the axis, with spring k and drag c relative to the ground: in the world s = −c/2m ± i ω_d. In a
// frame that rotates with Ω the two whirls have |ω_d ∓ Ω| and the same decay. This requires ∂f/∂v Dw in K and the
// Coriolis terms in D.
TEST(SteadyRotation, ShiftsWhirlsByItsOwnRate) {
  double const m = 2.0, k = 50.0, c = 1.2, omega = 3.0;
  PlaneModel model;
  auto const mass = model.add(planar::Rigid(m, 0.3), "mass");
  model.apply(SpringDamper{.stiffness = k, .free_length = 0.0}, model.ground().at({0, 0, 0}), mass.at(Vec2(0, 0)));
  model.apply(drag, mass.at(Vec2(0, 0)));
  auto const s = eigenvalues(linearise(model, model.reference_state(), about_z(omega)));
  double const decay = 0.5 * c / m, swing = std::sqrt(k / m - decay * decay);
  ASSERT_EQ(s.size(), 2u);
  EXPECT_LT(std::abs(s[0] - std::complex<double>(-decay, swing - omega)), 1e-9);
  EXPECT_LT(std::abs(s[1] - std::complex<double>(-decay, swing + omega)), 1e-9);
}

/// Hub driven about z, and a thin uniform rod of length L hinged to it at the distance e from the axis.
struct Blade {
  SpaceModel<Rigid<>> model;
  State x;
  Blade(double omega, double e, double length, Vec3 const& hinge, Gravity const& gravity = {}) : model(gravity) {
    auto const hub = model.add(Rigid<>(1.0, Mat3::Identity()), "hub");
    double const j = 3.0 * length * length / 12.0;
    auto const rod =
        model.add(Rigid<>(3.0, Vec3(0.0, j, j).asDiagonal(), Placement::at({e + 0.5 * length, 0, 0})), "rod");
    model.connect(Pin{{.axis = Vec3::UnitZ()}, {}}, model.ground().at({0, 0, 0}), hub.at({0, 0, 0}), "shaft");
    model.connect(Drive{{Ramp{.target = omega, .duration = 1.0}, Vec3::UnitZ()}, {}}, model.ground().at({0, 0, 0}),
                  hub.at({0, 0, 0}), "drive");
    model.connect(Pin{{.axis = hinge}, {}}, hub.at({e, 0, 0}), rod.at({-0.5 * length, 0, 0}), "hinge");
    x = model.reference_state();
  }
};

// The centrifugal force on an element dm of the rod at s from the hinge is Ω² (e + s) dm. In flapping by β its moment
// arm is s β, so ω² = Ω² ∫(e + s) s ds/∫s² ds = Ω² (1 + 3e/2L). In lagging, the force rotates with the radius, and
// only its part due to e remains: ω² = Ω² 3e/2L.
TEST(SteadyRotation, OfAHingedBlade) {
  double const omega = 7.0, e = 0.3, length = 2.0;
  for (bool const flaps : {true, false}) {
    Blade blade(omega, e, length, flaps ? Vec3(0, 1, 0) : Vec3(0, 0, 1));
    relative_equilibrium(blade.model, blade.x, about_z(omega));
    DampedModes const m = damped_modes(linearise(blade.model, blade.x, about_z(omega)));
    ASSERT_EQ(m.eigenvalue.size(), 1);
    EXPECT_NEAR(m.frequency(0), omega * std::sqrt((flaps ? 1.0 : 0.0) + 1.5 * e / length), 1e-9);
    EXPECT_NEAR(m.damping_ratio(0), 0.0, 1e-10);
  }
}

/// Body that rotates freely about the second of its principal axes, fixed at its centre of mass away from the origin.
template <class B>
std::vector<std::complex<double>> spinning(Vec3 const& inertia, double omega) {
  Placement const place = Placement::at({1, 2, -1}, {0.4, -0.9, 1.7});
  SpaceModel<B> model;
  auto const body = model.add(B(2.0, inertia.asDiagonal(), place), "body");
  model.connect(Ball{}, model.ground().at(place.origin), body.at({0, 0, 0}), "ball");
  SteadyRotation const rotation{.angular_velocity = omega * place.axes.col(1), .point = place.origin};
  return eigenvalues(linearise(model, rotating_state(model, model.reference_state(), rotation), rotation));
}

// Euler's equations about a rotation Ω about axis 1: I₀ w₀˙ = (I₁ − I₂) Ω w₂, I₂ w₂˙ = (I₀ − I₁) Ω w₀, so s² = −Ω²
// (I₁ − I₀)(I₁ − I₂)/(I₀ I₂). The other motion is a constant tilt of the angular momentum, which rotates with Ω. The
// rotation about the middle axis is unstable.
template <class B>
void spins() {
  double const omega = 5.0;
  auto const stable = spinning<B>({1.0, 2.0, 1.5}, omega);
  ASSERT_EQ(stable.size(), 2u);
  EXPECT_LT(std::abs(stable[0] - std::complex<double>(0.0, omega * std::sqrt(1.0 * 0.5 / 1.5))), 1e-8);
  EXPECT_LT(std::abs(stable[1] - std::complex<double>(0.0, omega)), 1e-8);

  auto const tumbling = spinning<B>({1.0, 1.5, 2.0}, omega);
  ASSERT_EQ(tumbling.size(), 3u);
  double const rate = omega * std::sqrt(0.5 * 0.5 / 2.0);
  EXPECT_NEAR(std::max(tumbling[0].real(), tumbling[1].real()), rate, 1e-8);
  EXPECT_NEAR(std::min(tumbling[0].real(), tumbling[1].real()), -rate, 1e-8);
  EXPECT_NEAR(std::abs(tumbling[0].imag()) + std::abs(tumbling[1].imag()), 0.0, 1e-8);
  EXPECT_LT(std::abs(tumbling[2] - std::complex<double>(0.0, omega)), 1e-8);
}
TEST(SteadyRotation, OfAFreeBody) { spins<Rigid<>>(); }
TEST(SteadyRotation, OfAFreeBodyInEulerParameters) { spins<Rigid<EulerParameters>>(); }

// Conical pendulum of a point mass: at the angle ϑ from the vertical cos ϑ = g/(l Ω²). The effective potential
// Ω²sin⁴ϑ₀/(2 sin²ϑ) − (g/l) cos ϑ gives ω² = Ω² (1 + 3 cos² ϑ). Gravity is along the axis, so the rotation is
// steady.
TEST(SteadyRotation, OfAConicalPendulum) {
  double const g = 9.81, length = 0.8, omega = 4.5;
  SpaceModel<Rigid<>> model{Gravity{0, 0, -g}};
  Placement const start = Placement::at(length * Vec3(std::sin(0.6), 0.0, -std::cos(0.6)), {0, -0.6, 0});
  auto const bob = model.add(Rigid<>(1.0, 1e-9 * Mat3::Identity(), start), "bob");
  model.connect(Ball{}, model.ground().at({0, 0, 0}), bob.at({0, 0, length}), "ball");
  State x = model.reference_state();
  relative_equilibrium(model, x, about_z(omega));
  double const cosine = g / (length * omega * omega);
  EXPECT_NEAR(x.q[2], -length * cosine, 1e-8);
  auto const s = eigenvalues(linearise(model, x, about_z(omega)));
  auto const nearest = *std::min_element(s.begin(), s.end(), [&](auto a, auto b) {
    double const expected = omega * std::sqrt(1.0 + 3.0 * cosine * cosine);
    return std::abs(a - std::complex<double>(0.0, expected)) < std::abs(b - std::complex<double>(0.0, expected));
  });
  EXPECT_LT(std::abs(nearest - std::complex<double>(0.0, omega * std::sqrt(1.0 + 3.0 * cosine * cosine))), 1e-6);
}

// At rest both linearisations agree.
TEST(SteadyRotation, OfZeroIsRest) {
  Blade blade(0.0, 0.3, 2.0, {0, 1, 0}, Gravity{0, 0, -9.81});
  blade.x.q.tail<7>() << 0.3, 0.0, -1.0, std::sqrt(0.5), 0.0, std::sqrt(0.5), 0.0;  // hanging
  relative_equilibrium(blade.model, blade.x, about_z(0.0));
  EXPECT_NEAR(damped_modes(linearise(blade.model, blade.x, about_z(0.0))).frequency(0), std::sqrt(1.5 * 9.81 / 2.0),
              1e-9);
  EXPECT_NEAR(modes(linearise(blade.model, blade.x, about_z(0.0))).frequency[0],
              modes(blade.model, blade.x).frequency[0], 1e-10);
}

TEST(SteadyRotation, RefusesWhatIsNotSteady) {
  Blade level(7.0, 0.3, 2.0, {0, 1, 0});
  SteadyRotation const right = about_z(7.0);
  State start = level.x;
  EXPECT_TRUE(has(refusal([&] { linearise(level.model, start, right); }), "do not balance as the model rotates"));
  EXPECT_TRUE(has(refusal([&] { linearise(level.model, start, about_z(6.9)); }),
                  "joint \"drive\" does not rotate with the model"));
  SteadyRotation const tilted{.angular_velocity = {0, 7, 0}};
  EXPECT_TRUE(
      has(refusal([&] { relative_equilibrium(level.model, start, tilted); }), "joint \"shaft\" does not rotate"));
  EXPECT_EQ(start.q, level.x.q);
  State const moving = rotating_state(level.model, start, right);
  EXPECT_TRUE(has(refusal([&] { damped_modes(level.model, moving); }), "linearise(model, x, SteadyRotation{...})"));

  // gravity normal to the axis pulls the rod back and forth
  Blade across(7.0, 0.3, 2.0, {0, 0, 1}, Gravity{-1.0, 0, 0});
  relative_equilibrium(across.model, across.x, right);
  EXPECT_TRUE(has(refusal([&] { linearise(across.model, across.x, right); }), "do not rotate with the model"));

  PlaneModel plane;
  plane.add(planar::Rigid(1.0, 1.0), "disc");
  EXPECT_TRUE(has(refusal([&] { rotating_state(plane, plane.reference_state(), {.angular_velocity = {1, 0, 1}}); }),
                  "body \"disc\" is planar"));
}

// Least-norm corrections leave free motions unchanged: a body that falls along the axis is not a steady rotation.
TEST(SteadyRotation, NamesTheBodyThatForcesPushWhereNothingResists) {
  SpaceModel<Rigid<>> model{Gravity{0, 0, -1.0}};
  model.add(Rigid<>(1.0, Vec3(0.1, 0.2, 0.3).asDiagonal().toDenseMatrix()), "top");
  State x = model.reference_state();
  State const before = x;
  EXPECT_TRUE(has(message_of<SingularMatrix>([&] { relative_equilibrium(model, x, about_z(2.0)); }), "body \"top\""));
  EXPECT_TRUE(x.q == before.q && x.v == before.v);
}

// With a spring softer than m Ω² the mass has no equilibrium.
TEST(SteadyRotation, FindsNothingBeyondTheCriticalSpeed) {
  PlaneModel model;
  auto const mass = model.add(planar::Rigid(2.0, 0.3, Placement::planar(1.2, 0.0)), "mass");
  model.apply(SpringDamper{.stiffness = 50.0, .free_length = 1.0}, model.ground().at({0, 0, 0}), mass.at(Vec2(0, 0)));
  State x = model.reference_state();
  EXPECT_TRUE(has(message_of<NewtonConvergenceFailure>([&] { relative_equilibrium(model, x, about_z(5.1)); }),
                  "there may be no solution"));
}

}  // namespace steady_rotation_test
