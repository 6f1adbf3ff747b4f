// Force elements with first-order states, such as controllers, under every kind of integrator, joint policy and
// analysis. A mass on a servo is linear. Its motion follows from a matrix exponential, its modes from a 4×4 matrix.
#include <polybody/io/checkpoint.hpp>
#include <polybody/polybody.hpp>
#include <polybody/run/redundancy.hpp>
#include <polybody/vibration/modes.hpp>
#include <polybody/vibration/steady_rotation.hpp>

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <filesystem>
#include <unsupported/Eigen/MatrixFunctions>

#include "support/held.hpp"

using namespace polybody;

namespace first_order_states_test {

/// Pulls its second marker along x to `target`, by the delayed current of a proportional–integral controller:
///   f = k i,  τ i˙ = p (x₀ − x) + s − i − e ẋ,  ṡ = r (x₀ − x),  z = (i, s)/unit.
struct Servo {
  static constexpr int markers = 2, states = 2;
  static constexpr bool is_load = true;
  static constexpr MarkerKind needs = MarkerKind::point;

  double target = 1.0;  ///< x₀
  double k = 8.0, p = 3.0, r = 2.0, lag = 0.2, e = 0.7;
  double unit = 1.0;

  void check(std::string const& name) const { require_positive(lag, name + ": the lag"); }
  template <StateScalar T>
  std::array<Wrench<T>, 2> wrenches(std::array<Frame<T>, 2> const&, std::array<T, 2> const& z, double) const {
    std::array<Wrench<T>, 2> w;
    w[1].f[0] = z[0] * (k * unit);
    w[0].f[0] = -w[1].f[0];
    return w;
  }
  template <StateScalar T>
  std::array<T, 2> rates(std::array<Frame<T>, 2> const& f, std::array<T, 2> const& z, double) const {
    T const error = target - (f[1].r[0] - f[0].r[0]), speed = f[1].v[0] - f[0].v[0];
    return {((error * p - speed * e) / unit + z[1] - z[0]) / lag, error * (r / unit)};
  }
  std::array<double, 2> initial_states() const { return {0.5 / unit, -0.2 / unit}; }

  /// y˙ = A (y − y₀) of y = (x, ẋ, i, s) with this mass; y₀ = (x₀, 0, 0, 0).
  Mat<double, 4, 4> matrix(double mass) const {
    Mat<double, 4, 4> a;
    a << 0, 1, 0, 0, 0, 0, k / mass, 0, -p / lag, -e / lag, -1 / lag, 1 / lag, -r, 0, 0, 0;
    return a;
  }
};
static_assert(ForceElement<Servo> && HasStates<Servo> && !WrenchFunction<Servo> && !HasPotential<Servo>);

constexpr double mass = 2.0, end_time = 1.5;

/// A free body in the plane; the servo pulls at its centre.
struct Plane {
  Model<Bodies<planar::Rigid>, Joints<>, Forces<Servo>> model;
  ElementHandle<Servo> servo;
  explicit Plane(Servo const& s = {}) {
    auto const body = model.add(planar::Rigid(mass, 0.3), "mass");
    servo = model.apply(s, model.ground().at({0, 0, 0}), body.at(Vec2(0, 0)), "servo");
  }
  State start() const {
    State x = model.reference_state();
    x.v[0] = 0.3;
    return x;
  }
};

/// (x, ẋ, i, s) after `t` s.
Vec<double, 4> exact(Servo const& s, double t) {
  Vec<double, 4> const rest(s.target, 0, 0, 0), start(0.0, 0.3, 0.5, -0.2);
  Mat<double, 4, 4> const propagator = (s.matrix(mass) * t).exp();
  return rest + propagator * (start - rest);
}

template <class I>
double error_of(I const& integrator, double h, double unit = 1.0) {
  Plane plane{Servo{.unit = unit}};
  State x = plane.start();
  simulate(plane.model, x, integrator, {.end_time = end_time, .step = h}).run();
  auto const z = plane.model.states(std::as_const(x), plane.servo);
  Vec<double, 4> const y(x.q[0], x.v[0], z[0] * unit, z[1] * unit);
  EXPECT_LT(std::abs(x.q[1]) + std::abs(x.q[2]), 1e-12);
  return (y - exact(Servo{}, end_time)).norm();
}

template <class I>
void expect_order(I const& integrator, double h, double largest) {
  double const coarse = error_of(integrator, h), fine = error_of(integrator, 0.5 * h);
  EXPECT_GT(std::log2(coarse / fine), I::order - 0.15) << I::name << ' ' << coarse << ' ' << fine;
  held_within({"closed forms", "place, speed and states of a mass on a servo at 1.5 s", By::closed_form,
               "exp At of four unknowns", std::string(I::name)},
              fine, largest, {equals("h", 0.5 * h), 1.0});
}

TEST(FirstOrderStates, ConvergeAtTheOrderOfEachIntegrator) {
  expect_order(GeneralisedAlpha{.rho_inf = 0.8}, 0.01, 6e-4);
  expect_order(GeneralisedAlpha{.rho_inf = 0.2}, 0.01, 2e-3);
  expect_order(HhtAlpha{}, 0.01, 8e-4);
  expect_order(Newmark{}, 0.01, 6e-4);
  expect_order(Radau{}, 0.1, 1e-6);
  expect_order(EnergyMomentum{}, 0.01, 6e-4);
  expect_order(EnergyDecaying{.rho_inf = 0.9}, 0.005, 3e-3);
  expect_order(RungeKutta4<>{}, 0.05, 1e-5);
  expect_order(CentralDifference<>{}, 0.01, 2e-3);
  expect_order(Rattle{}, 0.01, 2e-3);
  expect_order(SymplecticEuler{}, 0.002, 2e-2);
}

TEST(FirstOrderStates, KeepToTheToleranceOfStepControl) {
  auto const controlled = [](auto const& integrator) {
    held_within({"closed forms", "place, speed and states of a mass on a servo at 1.5 s", By::closed_form,
                 "exp At of four unknowns", std::string(integrator.name)},
                error_of(integrator, 0.1), 1e-8, {.scale = 1.0});
  };
  controlled(DormandPrince<>{.relative_tolerance = 1e-10, .absolute_tolerance = 1e-12});
  controlled(AdamsBashforthMoulton<>{.relative_tolerance = 1e-10, .absolute_tolerance = 1e-12});
}

// States in units that make them as large as pressures in pascals do not reduce the accuracy of the motion.
TEST(FirstOrderStates, MayHaveAnyUnit) {
  for (double const unit : {1e-7, 1e4}) {
    EXPECT_NEAR(error_of(GeneralisedAlpha{}, 0.01, unit), error_of(GeneralisedAlpha{}, 0.01), 1e-9) << unit;
    EXPECT_NEAR(error_of(Radau{}, 0.1, unit), error_of(Radau{}, 0.1), 1e-9) << unit;
    EXPECT_NEAR(error_of(EnergyMomentum{}, 0.01, unit), error_of(EnergyMomentum{}, 0.01), 1e-9) << unit;
  }
  DormandPrince<> const tight{.relative_tolerance = 1e-10, .absolute_tolerance = 1e-12};
  AdamsBashforthMoulton<> const adams{.relative_tolerance = 1e-10, .absolute_tolerance = 1e-12};
  EXPECT_LT(error_of(tight, 0.1, 1e-7), 1e-8);
  EXPECT_LT(error_of(adams, 0.1, 1e-7), 1e-8);
}

/// A double pendulum of rods with a servo, with one policy for its pins.
template <class B, class P>
State swing(B const& rod, B const& second, P policy, auto const& integrator, double h) {
  using Pin = Joint<Revolute, P>;
  Model<Bodies<B>, Joints<Pin>, Forces<Servo>> model{Gravity{0, 0, -9.81}};
  auto const a = model.add(rod, "a"), b = model.add(second, "b");
  model.connect(Pin{Revolute{.axis = {0, 1, 0}}, policy}, model.ground().at({0, 0, 0}), a.at(0.0), "pin");
  model.connect(Pin{Revolute{.axis = {0, 1, 0}}, policy}, a.at(0.5), b.at(0.0), "knee");
  auto const servo = model.apply(Servo{.target = 0.3}, model.ground().at({0, 0, 0}), b.at(0.5), "servo");
  State x = model.reference_state();
  simulate(model, x, integrator, {.end_time = 0.4, .step = h}).run();
  auto const z = model.states(std::as_const(x), servo);
  EXPECT_NE(z[0], 0.5);
  return x;
}
Bar bar_at(double x) {
  return {.length = 0.5,
          .section = Circle{.radius = 0.01},
          .material = Material{.density = 7800, .young = 2e9},
          .placement = Placement::at({x, 0, 0})};
}

TEST(FirstOrderStates, AreTheSameUnderEveryPolicy) {
  Rigid<> const a = Rigid<>::from(bar_at(0.0)), b = Rigid<>::from(bar_at(0.5));
  State const x = swing(a, b, Constraint{}, Radau{}, 0.005);
  for (State const& y : {swing(a, b, JointCoordinates{}, Radau{}, 0.005),
                         swing(a, b, Constraint{}, RungeKutta4<CoordinatePartitioning>{}, 5e-4)}) {
    ASSERT_EQ(y.v.size(), x.v.size());
    EXPECT_LT((y.q - x.q).norm(), 1e-8);
    EXPECT_LT((y.v.tail(2) - x.v.tail(2)).norm(), 1e-7);
  }
}

TEST(FirstOrderStates, StandBesideEliminatedLinearJoints) {
  using Ball = Joint<Spherical, AncfLinear>;
  using Held = Joint<Spherical, Constraint>;
  auto const run = [](auto joint) {
    using J = decltype(joint);
    Model<Bodies<AncfCable<>>, Joints<J>, Forces<Servo>> model{Gravity{0, 0, -9.81}};
    auto const cable = model.add(AncfCable<>::from(bar_at(0.0), 2), "cable");
    model.connect(joint, model.ground().at({0, 0, 0}), cable.at(0.0), "ball");
    model.apply(Servo{.target = 0.3}, model.ground().at({0, 0, 0}), cable.at(0.5), "servo");
    State x = model.reference_state();
    simulate(model, x, GeneralisedAlpha{}, {.end_time = 0.1, .step = 1e-3}).run();
    return x;
  };
  State const x = run(Held{}), y = run(Ball{});
  ASSERT_EQ(y.v.size(), x.v.size());
  EXPECT_LT((y.q - x.q).norm(), 1e-7);
  EXPECT_LT((y.v.tail(2) - x.v.tail(2)).norm(), 1e-7);
}

// An integrating controller keeps a weight at its target next to a spring: k i = m g + c x, s = i.
TEST(FirstOrderStates, FindTheirEquilibrium) {
  using Spring = Joint<planar::Weld, Penalty>;
  Model<Bodies<planar::Rigid>, Joints<Spring>, Forces<Servo>> model{Gravity{-9.81, 0, 0}};
  auto const body = model.add(planar::Rigid(mass, 0.3), "mass");
  model.connect(Spring{planar::Weld{}, Penalty{.stiffness = 100.0, .damping = 0.0}}, model.ground().at({0, 0, 0}),
                body.at(Vec2(0, 0)), "spring");
  auto const servo = model.apply(Servo{.target = 0.4}, model.ground().at({0, 0, 0}), body.at(Vec2(0, 0)), "servo");
  State x = model.reference_state();
  equilibrium(model, x);
  auto const z = model.states(std::as_const(x), servo);
  auto const claim = [](char const* what, char const* source) {
    return Claim{"closed forms", what, By::closed_form, source, "planar Rigid, Servo"};
  };
  held(claim("place at which a servo holds a weight [m]", "its target"), x.q[0], 0.4, 1e-9);
  held(claim("force of a servo that holds a weight [N]", "m g + c x"), 8.0 * z[0], mass * 9.81 + 100.0 * 0.4, 1e-6);
  EXPECT_NEAR(z[1], z[0], 1e-8);
  EXPECT_EQ(x.v.head(3).norm(), 0.0);
  Servo const without_integral{.target = 0.4, .r = 0.0};  // s is arbitrary
  Model<Bodies<planar::Rigid>, Joints<Spring>, Forces<Servo>> undetermined = model;
  undetermined.apply(without_integral, model.ground().at({0, 0, 0}), body.at(Vec2(0, 0)), "lazy servo");
  State y = undetermined.reference_state();
  EquilibriumReport const report = equilibrium(undetermined, y);
  ASSERT_EQ(report.free_motions.size(), 1u);
  EXPECT_NE(report.free_motions[0].find("servo"), std::string::npos)
      << report.free_motions[0];  // either state can balance the other
  EXPECT_NEAR(y.q[0], 0.4, 1e-9);
}

/// A mass on a prismatic joint, with a servo.
struct Slide {
  using Guide = Joint<Prismatic, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Guide>, Forces<Servo>> model;
  ElementHandle<Servo> servo;
  Slide() {
    auto const body = model.add(Rigid<>(mass, Mat3::Identity()), "mass");
    model.connect(Guide{{.axis = Vec3::UnitX()}, {}}, model.ground().at({0, 0, 0}), body.at(Vec3(0, 0, 0)), "guide");
    servo = model.apply(Servo{}, model.ground().at({0, 0, 0}), body.at(Vec3(0, 0, 0)), "servo");
  }
};

TEST(FirstOrderStates, BringOneModeEach) {
  Slide slide;
  State x = slide.model.reference_state();
  auto const z = slide.model.states(x, slide.servo);
  z[0] = z[1] = 0.0;
  x.q[0] = 1.0;
  DampedModes const found = damped_modes(slide.model, x);
  Eigen::EigenSolver<Mat<double, 4, 4>> const expected(Servo{}.matrix(mass));
  std::vector<std::complex<double>> upper;
  for (int i = 0; i < 4; ++i)
    if (expected.eigenvalues()[i].imag() >= 0.0) upper.push_back(expected.eigenvalues()[i]);
  std::sort(upper.begin(), upper.end(), [](auto a, auto b) { return std::abs(a) < std::abs(b); });
  ASSERT_EQ(found.eigenvalue.size(), Index(upper.size()));
  for (Index i = 0; i < found.eigenvalue.size(); ++i) {
    std::complex<double> const s = found.eigenvalue[i];
    held_within({"closed forms", "eigenvalues of a mass on a servo, of their size", By::closed_form,
                 "those of a 4×4 matrix", "Rigid on a slide, damped modes"},
                std::abs(s - upper[std::size_t(i)]) / std::abs(s), 1e-9, {equals("mode", double(i + 1)), 1.0});
    // (x, i, s) of a mode: s² m x = k i
    EXPECT_LT(std::abs(s * s * mass * found.shape(0, i) - 8.0 * found.shape(6, i)), 1e-8 * std::abs(found.shape(6, i)));
  }
  EXPECT_THROW((void)modes(slide.model, x), InvalidInput);
  EXPECT_THROW((void)linearise(slide.model, x, SteadyRotation{.angular_velocity = Vec3::UnitZ()}), InvalidInput);
}

TEST(FirstOrderStates, AreNoFreedoms) {
  Slide const slide;
  State const x = slide.model.reference_state();
  EXPECT_EQ(redundancy(slide.model, x).degrees_of_freedom, 1);
  EXPECT_EQ(problem_size(slide.model).degrees_of_freedom, 1);
  EXPECT_EQ(x.v.size(), 8);
  Momentum const p = momentum(slide.model, x);
  EXPECT_EQ(p.linear.norm() + p.angular.norm(), 0.0);
}

// At a constant length, the tension of spring and damper in series relaxes. A weight that hangs on them creeps down.
TEST(FirstOrderStates, RelaxAndCreep) {
  MaxwellElement const element{.stiffness = 50.0, .damping = 20.0, .free_length = 0.4};
  auto const elongation = [&](auto joint, Gravity const& gravity) {
    using J = decltype(joint);
    Model<Bodies<Rigid<>>, Joints<J>, Forces<MaxwellElement>> model{gravity};
    auto const body = model.add(Rigid<>(mass, Mat3::Identity(), Placement::at({0, 0, -1.0})), "weight");
    model.connect(joint, model.ground().at({0, 0, -1.0}), body.at(Vec3(0, 0, 0)), "guide");
    auto const damper = model.apply(element, model.ground().at({0, 0, 0}), body.at(Vec3(0, 0, 0)), "damper");
    State x = model.reference_state();
    simulate(model, x, Radau{}, {.end_time = 2.0, .step = 0.02}).run();
    return std::pair(model.states(std::as_const(x), damper)[0], x);
  };
  double const relaxed = elongation(Joint<Weld, Constraint>{}, {}).first;
  auto const claim = [](char const* what, char const* source) {
    return Claim{"closed forms", what, By::closed_form, source, "MaxwellElement, Radau IIA"};
  };
  held(claim("elongation of the damper of a Maxwell element held at a length [m]", "u (1 − exp(−k t/c))"), relaxed,
       0.6 * (1.0 - std::exp(-50.0 / 20.0 * 2.0)), 1e-9);
  // c z˙ = N, so the momentum is m g t − c z at any time
  using Slider = Joint<Prismatic, Constraint>;
  auto const [z, x] = elongation(Slider{Prismatic{.axis = {0, 0, 1}}, {}}, Gravity{0, 0, -9.81});
  held(claim("momentum of a weight that creeps, and c z of its damper [N s]", "m g t"), 20.0 * z - mass * x.v[2],
       mass * 9.81 * 2.0, 1e-7);
}

// Kinetic energy becomes energy of the spring and is lost in the damper; no load does work.
TEST(FirstOrderStates, StoreAndDissipate) {
  Model<Bodies<planar::Rigid>, Joints<>, Forces<MaxwellElement>> model;
  auto const body = model.add(planar::Rigid(2.0, 0.1, Placement::planar(1.5, 0)), "mass");
  model.apply(MaxwellElement{.stiffness = 50.0, .damping = 20.0, .free_length = 1.0}, model.ground().at({0, 0, 0}),
              body.at(Vec2(0, 0)), "damper");
  State x = model.reference_state();
  x.v[1] = 0.3;
  Energy const start = energy(model, x);
  EXPECT_NEAR(start.forces, 0.5 * 50.0 * 0.25, 1e-12);
  EnergyAudit audit(model);
  audit.record(x);
  EXPECT_NEAR(audit.powers().dissipated, 25.0 * 25.0 / 20.0, 1e-12);
  for (State const& now : simulate(model, x, Radau{}, {.end_time = 2.0, .step = 1e-3})) audit.record(now);
  EXPECT_EQ(audit.work_of_loads(), 0.0);
  EXPECT_GT(audit.dissipated(), 1.0);
  EXPECT_LT(audit.relative(), 1e-5);
}

// The work of the servo counts as the work of a load.
TEST(FirstOrderStates, WorkAsLoads) {
  Plane plane;
  State x = plane.start();
  EnergyAudit audit(plane.model);
  for (State const& now : simulate(plane.model, x, GeneralisedAlpha{}, {.end_time = end_time, .step = 1e-3}))
    audit.record(now);
  EXPECT_GT(std::abs(audit.work_of_loads()), 0.1);
  EXPECT_LT(audit.relative(), 1e-5);
}

template <class I>
void expect_resumed(I const& integrator, double h) {
  Plane plane;
  State straight = plane.start(), x = straight;
  auto full = simulate(plane.model, straight, integrator, {.end_time = 1.0, .step = h});
  for (State const& now : full)
    if (now.t >= 0.5 && now.t < 0.5 + h) full.snapshot();
  std::filesystem::path const file = std::filesystem::temp_directory_path() / "polybody_states.ckp";
  auto first = simulate(plane.model, x, integrator, {.end_time = 1.0, .step = h});
  for (State const& now : first)
    if (now.t >= 0.5) break;
  write_checkpoint(file, first.snapshot());
  State y = plane.model.reference_state();
  auto rest = resume(plane.model, y, integrator, {.end_time = 1.0, .step = h}, read_checkpoint(file));
  rest.run();
  std::filesystem::remove(file);
  EXPECT_EQ(y.q, straight.q) << I::name;
  EXPECT_EQ(y.v, straight.v) << I::name;
}
TEST(FirstOrderStates, GoOnFromACheckpoint) {
  expect_resumed(GeneralisedAlpha{}, 0.0625);
  expect_resumed(RungeKutta4<>{}, 0.0625);
}

TEST(FirstOrderStates, AreNamedInErrors) {
  auto const broken = user_force<1, 1>(
      [](auto const& frames, auto const& z, double) {
        using T = typename std::decay_t<decltype(frames[0].r)>::Scalar;
        Wrench<T> w;
        w.f[0] = z[0];
        return std::array{w};
      },
      [](auto const&, auto const& z, double t) {
        return std::array{z[0] * (t > 0.1 ? std::numeric_limits<double>::quiet_NaN() : 1.0)};
      });
  Model<Bodies<planar::Rigid>, Joints<>, Forces<std::remove_const_t<decltype(broken)>>> model;
  auto const body = model.add(planar::Rigid(mass, 0.3), "mass");
  auto const pump = model.apply(broken, body.at(Vec2(0, 0)), "pump");
  auto const message = [&](auto const& integrator) {
    State x = model.reference_state();
    model.states(x, pump)[0] = 1.0;
    try {
      simulate(model, x, integrator, {.end_time = 1.0, .step = 0.01}).run();
    } catch (NonFiniteValue const& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_NE(message(GeneralisedAlpha{}).find("force \"pump\""), std::string::npos) << message(GeneralisedAlpha{});
  EXPECT_NE(message(RungeKutta4<>{}).find("force \"pump\""), std::string::npos) << message(RungeKutta4<>{});
  Plane plane;
  State x = plane.start();
  EXPECT_THROW((void)plane.model.states(x, ElementHandle<Servo>{}), InvalidInput);
}

}  // namespace first_order_states_test
