// Errors of runs that cannot continue, and the state after such an error.

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/rigid_euler_parameters.hpp>
#include <polybody/forces/user_force.hpp>
#include <polybody/integrators/adams_bashforth_moulton.hpp>
#include <polybody/integrators/coordinate_partitioning.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/integrators/symplectic.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/run/simulate.hpp>

#include "support/chain.hpp"
#include "support/refusal.hpp"

using namespace polybody;

namespace failures_test {

void expect_same(State const& a, State const& b) {
  EXPECT_EQ(a.q, b.q);
  EXPECT_EQ(a.v, b.v);
  EXPECT_EQ(a.a, b.a);
  EXPECT_EQ(a.lambda, b.lambda);
  EXPECT_EQ(a.history, b.history);
  EXPECT_EQ(a.t, b.t);
}

TEST(Failures, AbsurdStepStallsNewtonAndLeavesTheState) {
  Chain<InSpace<Constraint>> chain(4, bar_link());
  State x = chain.model.reference_state();
  GeneralisedAlpha const integrator;
  System system(chain.model);
  auto const method = method_of(integrator);
  auto workspace = method.workspace<DenseLu>(system);
  method.start(system, x, 1e-3, workspace);
  for (int i = 0; i < 100; ++i) method.step(system, x, 1e-3, workspace);
  State const before = x;
  std::string const message = message_of<NewtonConvergenceFailure>(
      [&] { method_of(GeneralisedAlpha{.newton = {.max_iterations = 3}}).step(system, x, 3.0, workspace); });
  EXPECT_TRUE(has(message, "did not converge at t = 3.1"));
  EXPECT_TRUE(has(message, "Take a smaller step"));
  expect_same(x, before);
  // a valid step continues from this state
  EXPECT_NO_THROW(method.step(system, x, 1e-3, workspace));
  EXPECT_NEAR(x.t, 0.101, 1e-12);
}

/// A force that is not a number if t exceeds 0.05.
constexpr auto poison = [](auto const& frames, double t) {
  using T = std::decay_t<decltype(frames[0].r[0])>;
  Wrench<T> w;
  w.f[1] = T(t > 0.05 ? std::numeric_limits<double>::quiet_NaN() : 1.0);
  return std::array{w};
};

/// Two bodies; the force `poison` acts on the second.
struct Poisoned {
  using Push = UserForce<1, std::remove_const_t<decltype(poison)>>;
  using Pin = Joint<planar::Revolute, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Pin>, Forces<Push>> model;
  State x;

  Poisoned() {
    auto const sound = model.add(planar::Rigid(1.0, 1.0), "sound one");
    auto const pushed = model.add(planar::Rigid(1.0, 1.0), "pushed one");
    model.connect(Pin{}, model.ground().at({0, 0, 0}), sound.at(Vec2(0, 0)), "pin");
    model.apply(Push{poison}, pushed.at(Vec2(0, 0)), "push");
    x = model.reference_state();
  }
  template <class I>
  void expect_named(I const& integrator) {
    State before = x;
    auto run = simulate(model, x, integrator, {.end_time = 1.0, .step = 0.01});
    std::string const message = message_of<NonFiniteValue>([&] {
      while (!run.done()) {
        before = run.state();
        run.advance();
      }
    });
    EXPECT_TRUE(has(message, "\"pushed one\""));
    EXPECT_TRUE(has(message, "is not finite at t = 0.0"));
    EXPECT_GT(x.t, 0.0);
    EXPECT_LE(x.t, 0.0501);  // growing steps end earlier
    expect_same(x, before);
    EXPECT_TRUE(x.q.allFinite() && x.v.allFinite());
  }
};

TEST(Failures, ForceThatIsNoNumberNamesItsBody) {
  Poisoned().expect_named(GeneralisedAlpha{});
  Poisoned().expect_named(RungeKutta4<Projection>{});
  Poisoned().expect_named(DormandPrince<Projection>{});
  Poisoned().expect_named(CentralDifference<Projection>{});
  Poisoned().expect_named(AdamsBashforthMoulton<CoordinatePartitioning>{});
  Poisoned().expect_named(Rattle{});
}

/// A force that fails at its call number `at`: it throws, or returns NaN.
struct Faulty {
  int at = -1, calls = 0;
  bool throws = true;
};
inline auto fails_at(Faulty* fault) {
  return user_force<1>([fault](auto const& frames, double) {
    using T = std::decay_t<decltype(frames[0].r[0])>;
    Wrench<T> w;
    w.f[1] = T(1.0);
    if (fault->calls++ != fault->at) return std::array{w};
    if (fault->throws) throw std::runtime_error("it broke");
    w.f[1] = T(std::numeric_limits<double>::quiet_NaN());
    return std::array{w};
  });
}

// Joints in joint coordinates evaluate the forces again after a step, for their reactions. If a force fails in this
// evaluation, the step fails: the state is unchanged, and a repeated step is bitwise identical.
TEST(Failures, ForceThatFailsAfterTheStepLeavesTheState) {
  using Pin = Joint<planar::Revolute, JointCoordinates>;
  using Push = decltype(fails_at(nullptr));
  Faulty fault;
  Model<Bodies<planar::Rigid>, Joints<Pin>, Forces<Push>> model{Gravity{0, -9.81, 0}};
  auto const rod = model.add(planar::Rigid(1.0, 0.1), "rod");
  model.connect(Pin{}, model.ground().at({-0.5, 0, 0}), rod.at(Vec2(-0.5, 0)), "pin");
  model.apply(fails_at(&fault), rod.at(Vec2(0.5, 0)), "push");
  auto const calls_of_a_step = [&](int at, bool throws, State const& sound) {
    State x = model.reference_state();
    fault = {};
    auto run = simulate(model, x, RungeKutta4<>{}, {.end_time = 1.0, .step = 0.01});
    State const before = x;
    fault = {at, 0, throws};
    try {
      run.advance();
      EXPECT_EQ(at, -1);
    } catch (std::exception const&) {
      expect_same(x, before);
      EXPECT_EQ(run.report().steps, 0);
      run.advance();
    }
    if (sound.q.size() > 0) expect_same(x, sound);
    return std::pair(fault.calls, x);
  };
  auto const [calls, sound] = calls_of_a_step(-1, true, {});
  EXPECT_EQ(calls, 5);  // three stages, the end of the step and the reactions
  for (int at = 0; at < calls; ++at)
    for (bool const throws : {true, false}) calls_of_a_step(at, throws, sound);
}

// The mass matrix of Euler parameters is singular along them, so the last pivot of a body is round-off. Here the body
// tilts by some hundredths of a radian, and the pivot falls below the solver's threshold. The solver then eliminates
// it together with the joint. If a step fails after that, the repeated step begins with the original elimination
// order.
TEST(Failures, StepTakenAgainHasTheOrderOfEliminationThatItBeganWith) {
  using Push = decltype(fails_at(nullptr));
  using Ball = Joint<Spherical, Constraint>;
  constexpr int steps = 12;
  for (int k = 0; k < 24; ++k) {
    double const tilt = 3e-3 + 3e-4 * k;
    Faulty fault;
    Model<Bodies<Rigid<EulerParameters>>, Joints<Ball>, Forces<Push>> model{Gravity{0, 0, -9.81}};
    Mat3 const axes = exp_so3<double>(Vec3(0, tilt, 0)) * exp_so3<double>(Vec3(1, 0, 0));
    Rigid<EulerParameters> const body(1.0, Vec3(1, 1.2, 1.3).asDiagonal().toDenseMatrix(), {Vec3::Zero(), axes});
    auto const top = model.add(body, "top");
    model.connect(Ball{}, model.ground().at(axes.col(2)), top.at(Vec3(0, 0, 1)), "ball");
    model.apply(fails_at(&fault), top.at(Vec3(0, 0, -1)), "push");
    State start = model.reference_state();
    Vec3 const omega(0, 1, 0);
    model.set_velocity(start, top, -omega.cross(axes.col(2)), omega);
    auto const end = [&](int failing) {
      State x = start;
      auto run = simulate(model, x, RungeKutta4<Projection>{}, {.end_time = 1.0, .step = 4e-3});
      for (int i = 0; i < steps; ++i) {
        fault = {i == failing ? 3 : -1};
        if (i == failing) {
          EXPECT_THROW(run.advance(), std::runtime_error);
        }
        run.advance();
      }
      return x;
    };
    State const sound = end(-1);
    for (int step = 0; step < steps; ++step) expect_same(end(step), sound);
  }
}

// A redundant joint is omitted under solvers that find no pivot for its constraint equations. The report names the
// joint; the motion is that of one pin.
TEST(Failures, DoubledJointIsLeftOutAndNamed) {
  using Pin = Joint<Revolute, Constraint>;
  auto const swing = [](auto solver, std::vector<char const*> const& pins, std::vector<std::string>& redundant) {
    Model<Bodies<Rigid<>>, Joints<Pin>> model{Gravity{0, -9.81, 0}};
    auto const rod = model.add(Rigid<>(1.0, Vec3(0.1, 0.2, 0.2).asDiagonal().toDenseMatrix()), "rod");
    for (char const* const name : pins)
      model.connect(Pin{{.axis = Vec3::UnitZ()}, {}}, model.ground().at({-1, 0, 0}), rod.at(Vec3(-1, 0, 0)), name);
    State x = model.reference_state();
    redundant =
        simulate<decltype(solver)>(model, x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 0.01}).run().redundant;
    return x.q;
  };
  auto const expect_left_out = [&](auto solver) {
    std::vector<std::string> one, two;
    VecX const single = swing(decltype(solver){}, {"pin"}, one),
               doubled = swing(decltype(solver){}, {"pin", "pin again"}, two);
    EXPECT_TRUE(one.empty());
    ASSERT_FALSE(two.empty());
    EXPECT_TRUE(has(two.front(), "pin")) << two.front();
    EXPECT_LT((single - doubled).norm(), 1e-8);
  };
  expect_left_out(DenseLu{});
  expect_left_out(EigenSparseLu{});
}

// A point mass on a ball joint can spin about its own axis without inertia.
TEST(Failures, BodyWithoutInertiaIsNamed) {
  Chain<OnBallJoints<Constraint>> chain(1, point_link());
  State x = chain.model.reference_state();
  std::string const message = message_of<SingularMatrix>(
      [&] { simulate(chain.model, x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 0.01}).run(); });
  EXPECT_TRUE(has(message, "body \"link 1\""));
  EXPECT_TRUE(has(message, "a free body without inertia"));
}

TEST(Failures, OpenJointAtTheStartIsNamed) {
  Chain<InPlane<Constraint>> chain(2, bar_link());
  State x = chain.model.reference_state();
  x.q[0] += 1e-3;
  std::string const message = message_of<InconsistentInitialConditions>(
      [&] { simulate(chain.model, x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 0.01}); });
  EXPECT_TRUE(has(message, "joint \"pin"));
  EXPECT_TRUE(has(message, "0.001"));
}

}  // namespace failures_test
