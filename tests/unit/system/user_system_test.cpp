// A system of user-defined equations, without bodies and joints, under the integrators of the library.
#include <gtest/gtest.h>

#include <polybody/polybody.hpp>
#include <polybody/system/user_system.hpp>

#include <unsupported/Eigen/MatrixFunctions>

#include "support/held.hpp"

namespace user_system_test {
namespace {

using namespace polybody;

/// The solution of x¨ = −ω² x is x = cos ωt.
struct Oscillator {
  double omega = 3.0;
  Index velocities() const { return 1; }
  void mass(VecX const&, MatX& m) const { m(0, 0) = 2.0; }
  void force(VecX const& q, VecX const&, double, VecX& f) const { f[0] = -2.0 * omega * omega * q[0]; }
};

/// A point of mass m on a circle of radius 1 in the plane, Φ = ½ (x² + y² − 1).
struct Pendulum {
  Index velocities() const { return 2; }
  Index rows() const { return 1; }
  void mass(VecX const&, MatX& m) const { m = 3.0 * MatX::Identity(2, 2); }
  void force(VecX const&, VecX const&, double, VecX& f) const { f << 0.0, -3.0 * 9.81; }
  void tangent(VecX const&, VecX const&, double, double, double, MatX& k) const { k.setZero(2, 2); }
  void violation(VecX const& q, double, VecX& phi) const { phi[0] = 0.5 * (q.squaredNorm() - 1.0); }
  void jacobian(VecX const& q, double, MatX& g) const { g = q.transpose(); }
  void rate(VecX const&, double, VecX& phi_t) const { phi_t[0] = 0.0; }
  void gamma(VecX const&, VecX const& v, double, VecX& gamma) const { gamma[0] = v.squaredNorm(); }
};
static_assert(UserMechanics<Oscillator> && !HasConstraintEquations<Oscillator> && !HasForceTangent<Oscillator>);
static_assert(HasConstraintEquations<Pendulum> && HasForceTangent<Pendulum> && !UserMechanics<int>);

State at(System const& system, VecX const& q) {
  VecX const none = VecX::Zero(system.velocities());
  return {q, none, none, VecX::Zero(system.rows()), 0.0, {}};
}

template <class I>
State run(System& system, State x, I const& integrator, double h, double end_time) {
  auto const method = method_of(integrator);
  auto w = method.template workspace<BlockSolver>(system);
  integrator.check();
  method.start(system, x, h, w);
  while (x.t < end_time - 1e-9) method.step(system, x, std::min(h, end_time - x.t), w);
  return x;
}

template <class I>
void expect_cosine(I const& integrator, double h, double tolerance) {
  System system = system_of(Oscillator{}, "mass", true);
  State const x = run(system, at(system, VecX::Ones(1)), integrator, h, 1.0);
  auto const claim = [](char const* what, char const* source) {
    return Claim{"closed forms", what, By::closed_form, source, std::string(I::name)};
  };
  held(claim("place of a user's oscillator", "cos ωt"), x.q[0], std::cos(3.0), tolerance);
  held(claim("speed of a user's oscillator", "−ω sin ωt"), x.v[0], -3.0 * std::sin(3.0), 3.0 * tolerance,
       {.scale = 3.0});
}

TEST(UserSystem, OscillatesUnderEveryKindOfIntegrator) {
  expect_cosine(GeneralisedAlpha{.rho_inf = 1.0}, 1e-3, 3e-6);
  expect_cosine(HhtAlpha{}, 1e-3, 1e-4);
  expect_cosine(Radau{}, 0.02, 1e-8);
  expect_cosine(RungeKutta4<>{}, 0.01, 1e-6);
  expect_cosine(DormandPrince<>{}, 0.1, 1e-6);
  expect_cosine(AdamsBashforthMoulton<>{}, 0.1, 1e-6);
  expect_cosine(CentralDifference<>{}, 1e-3, 3e-6);
  expect_cosine(SymplecticEuler{}, 1e-4, 2e-3);
  expect_cosine(Rattle{}, 1e-3, 3e-6);
}

// Energy is constant within the accuracy of the method. The multiplier is the tension of the thread: |λ| q = m (v² +
// g·down).
TEST(UserSystem, SwingsOnItsRow) {
  System system = system_of(Pendulum{});
  State const start = at(system, Vec2(1.0, 0.0));
  auto const check = [&](auto const& integrator, double h, double tolerance) {
    State const x = run(system, start, integrator, h, 1.0);
    auto const claim = [&](char const* what, char const* source) {
      return Claim{"closed forms", what, By::closed_form, source, std::string(integrator.name)};
    };
    held(claim("length of a user's pendulum", "1"), x.q.norm(), 1.0, 1e-9);
    held_within(claim("energy of a user's pendulum, of m", "invariant"),
                std::abs(0.5 * x.v.squaredNorm() + 9.81 * x.q[1]), tolerance, {.scale = 9.81});
    held_within(claim("multiplier of a user's pendulum", "m (v² − g y)"),
                std::abs(x.lambda[0] - 3.0 * (x.v.squaredNorm() - 9.81 * x.q[1])), 100.0 * tolerance,
                {.scale = 3.0 * 9.81});
  };
  check(GeneralisedAlpha{}, 1e-3, 1e-4);
  check(Radau{}, 0.01, 1e-7);
  check(RungeKutta4<Projection>{}, 1e-3, 1e-7);
}

TEST(UserSystem, NamesItselfInErrors) {
  struct Broken : Oscillator {
    void force(VecX const&, VecX const&, double, VecX& f) const { f[0] = std::numeric_limits<double>::quiet_NaN(); }
  };
  System system = system_of(Broken{}, "rotor");
  try {
    run(system, at(system, VecX::Ones(1)), GeneralisedAlpha{}, 1e-3, 0.1);
    FAIL();
  } catch (NonFiniteValue const& e) {
    EXPECT_NE(std::string(e.what()).find("body \"rotor\""), std::string::npos) << e.what();
  }
}

/// The solution of z˙ = A z is a spiral, with first-order states only.
struct Spiral {
  Index states() const { return 2; }
  void rates(VecX const& z, double, VecX& h) const { h << -0.5 * z[0] - 3.0 * z[1], 3.0 * z[0] - 0.5 * z[1]; }
};
/// The oscillator with a delayed spring force: 2 ẍ = −18 u − x, τ u̇ = x − u. With u = x it would be the previous
/// oscillator.
struct LaggingSpring {
  double lag = 0.05;
  Index velocities() const { return 1; }
  Index states() const { return 1; }
  void mass(VecX const&, MatX& m) const { m(0, 0) = 2.0; }
  void force(VecX const& q, VecX const& v, VecX const& z, double, VecX& f) const {
    f[0] = -18.0 * z[0] - q[0] - 2.0 * v[0];
  }
  void rates(VecX const& q, VecX const&, VecX const& z, double, VecX& h) const { h[0] = (q[0] - z[0]) / lag; }
  Mat3 matrix() const {
    Mat3 a;
    a << 0, 1, 0, -0.5, -1, -9, 1 / lag, 0, -1 / lag;
    return a;
  }
};
/// Three chemical reactions with very different rates [Robertson 1966; Hairer & Wanner 1996, §IV.1].
struct Robertson {
  Index states() const { return 3; }
  void rates(VecX const& z, double, VecX& h) const {
    double const slow = 0.04 * z[0], fast = 3e7 * z[1] * z[1], middle = 1e4 * z[1] * z[2];
    h << middle - slow, slow - middle - fast, fast;
  }
};
static_assert(UserFirstOrderEquations<Spiral> && UserMechanicsWithStates<LaggingSpring>);
static_assert(!UserMechanics<LaggingSpring> && !UserFirstOrderEquations<LaggingSpring> && UserEquations<Oscillator>);

template <class I>
void expect_states(I const& integrator, double h, double tolerance) {
  System spiral = system_of(Spiral{});
  State x = at(spiral, VecX(0));
  x.v << 1.0, 0.0;
  x = run(spiral, x, integrator, h, 1.0);
  double const shrunk = std::exp(-0.5);
  Claim const turned{"closed forms", "two states on a spiral", By::closed_form, "exp(−½ t) (cos 3t, sin 3t)",
                     std::string(I::name)};
  held(turned, x.v[0], shrunk * std::cos(3.0), tolerance, {"first", 1.0});
  held(turned, x.v[1], shrunk * std::sin(3.0), tolerance, {"second", 1.0});

  System spring = system_of(LaggingSpring{}, "spring", true);
  State y = at(spring, VecX::Ones(1));
  y.v << 0.0, 0.5;
  y = run(spring, y, integrator, h, 1.0);
  Vec3 const expected = LaggingSpring{}.matrix().exp() * Vec3(1.0, 0.0, 0.5);
  held_within({"closed forms", "place, speed and force of a spring that lags", By::closed_form,
               "exp At of three unknowns", std::string(I::name)},
              (Vec3(y.q[0], y.v[0], y.v[1]) - expected).norm(), 20.0 * tolerance, {.scale = 1.0});
}

TEST(UserSystem, MayBeOfFirstOrder) {
  expect_states(GeneralisedAlpha{.rho_inf = 1.0}, 1e-3, 3e-6);
  expect_states(HhtAlpha{}, 1e-3, 1e-5);
  expect_states(Radau{}, 0.02, 1e-8);
  expect_states(RungeKutta4<>{}, 0.01, 1e-6);
  expect_states(DormandPrince<>{}, 0.1, 1e-6);
  expect_states(AdamsBashforthMoulton<>{}, 0.1, 1e-6);
  expect_states(CentralDifference<>{}, 1e-3, 1e-5);
  expect_states(SymplecticEuler{}, 1e-4, 2e-3);
}

// The concentrations at t = 40, with the digits that the documentation of CVODE prints for its example cvRoberts.
TEST(UserSystem, FollowsStiffReactions) {
  System system = system_of(Robertson{}, "reactor");
  State x = at(system, VecX(0));
  x.v << 1.0, 0.0, 0.0;
  Radau const radau{.tolerance = 1e-12};
  auto w = radau.workspace<BlockSolver>(system);
  double h = 1e-5;
  radau.start(system, x, h, w);
  for (; x.t < 40.0 - 1e-9; h *= 1.05) radau.step(system, x, std::min(h, 40.0 - x.t), w);
  Claim const published{"Robertson", "concentrations of three reactions at t = 40", By::published,
                        "cvRoberts in the documentation of CVODE", "Radau IIA"};
  held(published, x.v[0], 0.7158, 5e-5, {"first"});
  held(published, x.v[1], 9.185e-6, 1e-9, {"second"});
  held(published, x.v[2], 0.2842, 5e-5, {"third"});
  held({"Robertson", "sum of the concentrations", By::closed_form, "invariant", "Radau IIA"}, x.v.sum(), 1.0, 1e-10);
}

TEST(System, RefusesWhatItWasMadeWithout) {
  Model<Bodies<Rigid<>>, Joints<>> model;
  model.add(Rigid<>(1.0, Mat3::Identity()));
  System system(model, with<Capabilities::motion>);
  State const x = model.reference_state();
  system.evaluate(x.q, x.v, x.t);
  PatternSink sink;
  EXPECT_THROW(system.tangent({.mass = 1.0}, SecondOrder::omitted, x.lambda, sink), InvalidInput);
  EXPECT_THROW((void)powers(system, x), InvalidInput);
}

/// The columns of G and of Gᵀ form transposes of each other, for every source of constraint equations: frames, Euler
/// parameters, linear joints.
TEST(System, ProductsWithRowsAndTheirTransposeAgree) {
  using Pin = Joint<Revolute, Constraint>;
  using Ball = Joint<Spherical, AncfLinear>;
  Model<Bodies<Rigid<EulerParameters>, AncfCable<>>, Joints<Pin, Ball>> model;
  Bar const bar{.length = 1.0, .section = Circle{.radius = 0.01}, .material = Material{.density = 7800, .young = 2e11}};
  auto const rod = model.add(Rigid<EulerParameters>::from(bar), "rod");
  auto const first = model.add(AncfCable<>::from(bar, 2), "first");
  Bar second_bar = bar;
  second_bar.placement = Placement::at({1.0, 0, 0});
  auto const second = model.add(AncfCable<>::from(second_bar, 2), "second");
  model.connect(Pin{Revolute{.axis = {0, 1, 0}}, {}}, model.ground().at({0, 0, 0}), rod.at(0.0));
  model.connect(Ball{}, first.at(1.0), second.at(0.0));
  System system(model, with<Capabilities::motion>);
  State const x = model.reference_state();
  system.evaluate(x.q, x.v, x.t);
  Index const n = system.velocities(), m = system.rows();
  MatX g(m, n), gt(n, m);
  VecX row(m), column(n);
  for (Index j = 0; j < n; ++j) {
    system.rows_times(VecX::Unit(n, j), row);
    g.col(j) = row;
  }
  for (Index i = 0; i < m; ++i) {
    system.rows_transposed_times(VecX::Unit(m, i), column);
    gt.col(i) = column;
  }
  EXPECT_GT(m, 5 + 1 + 2);
  for (Index i = 0; i < m; ++i) EXPECT_GT(gt.col(i).norm(), 0.1) << i;
  EXPECT_LT((g - gt.transpose()).norm(), 1e-14 * g.norm());
}

}  // namespace
}  // namespace user_system_test
