// Statics, modes, rotations, audits and observers refuse an invalid state and name the cause. None returns a NaN.
#include <gtest/gtest.h>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/energy_audit.hpp>
#include <polybody/run/initial_conditions.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/statics/arc_length.hpp>
#include <polybody/statics/equilibrium.hpp>
#include <polybody/vibration/steady_rotation.hpp>

#include "support/refusal.hpp"

using namespace polybody;

namespace hostile_states_test {

using Ball = Joint<Spherical, Constraint>;

/// Body that hangs from a point.
struct Hanging {
  Model<Bodies<Rigid<>>, Joints<Ball>> model{Gravity{0, 0, -9.81}};
  BodyHandle<Rigid<>> body =
      model.add(Rigid<>(2.0, Vec3(0.1, 0.2, 0.25).asDiagonal(), Placement::at({0, 0, -1})), "bob");
  ElementHandle<Ball> pivot = model.connect(Ball{}, model.ground().at({0, 0, 0}), body.at({0, 0, 1}), "pivot");
};

/// State, and the text that every refusal contains.
struct Hostile {
  State x;
  std::string named;
};

std::vector<Hostile> hostile_states(State const& sane) {
  double const nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Hostile> all(8, {sane, ""});
  all[0].x.q[1] = nan;
  all[0].named = "The coordinates of the state must be finite";
  all[1].x.q[2] = HUGE_VAL;
  all[1].named = "The coordinates of the state must be finite";
  all[2].x.v[4] = nan;
  all[2].named = "The velocities of the state must be finite";
  all[3].x.q[0] = 1e200;
  all[3].named = "A coordinate of body \"bob\" is 1e+200";
  all[4].x.v[0] = -1e200;
  all[4].named = "A velocity of body \"bob\" is -1e+200";
  all[5].x.q.tail<4>().setZero();
  all[5].named = "body \"bob\" are invalid";
  all[6].x.lambda[2] = nan;
  all[6].named = "The multipliers of the state must be finite";
  all[7].x.q.conservativeResize(3);
  all[7].named = "does not fit the model";
  return all;
}

TEST(HostileStates, AreRefusedByNameOutsideOfRuns) {
  Hanging const h;
  SteadyRotation const turning{.angular_velocity = {0, 0, 1.0}};
  for (Hostile const& hostile : hostile_states(h.model.reference_state())) {
    State x = hostile.x;
    auto const said = [&](auto const& act) { return has(refusal(act), hostile.named); };
    EXPECT_TRUE(said([&] { equilibrium(h.model, x); }));
    EXPECT_TRUE(said([&] { equilibrium_path(h.model, x); }));
    EXPECT_TRUE(said([&] { relative_equilibrium(h.model, x, turning); }));
    EXPECT_TRUE(said([&] { linearise(h.model, x); }));
    EXPECT_TRUE(said([&] { linearise(h.model, x, turning); }));
    EXPECT_TRUE(said([&] { rotating_state(h.model, x, turning); }));
    EXPECT_TRUE(said([&] { energy(h.model, x); }));
    EXPECT_TRUE(said([&] { momentum(h.model, x); }));
    EXPECT_TRUE(said([&] { constraint_violation(h.model, x, h.pivot); }));
    EXPECT_TRUE(said([&] { reaction(h.model, x, h.pivot); }));
    EXPECT_TRUE(said([&] { EnergyAudit(h.model).start(x); }));
  }
}

// Also during an audit, whose sums would otherwise remain NaN.
TEST(HostileStates, DoNotEnterAnAccountOfEnergy) {
  Hanging const h;
  State x = h.model.reference_state();
  EnergyAudit audit(h.model);
  audit.record(x);
  x.v[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(has(refusal([&] { audit.record(x); }), "A velocity of body \"bob\" is not finite"));
  x.v[3] = 0.0;
  x.t = 0.1;
  audit.record(x);
  EXPECT_TRUE(std::isfinite(audit.stored()));
}

TEST(HostileStates, CountsOfModesAreOneAtLeast) {
  Hanging const h;
  State const x = h.model.reference_state();
  for (Index const count : {Index(0), Index(-1), std::numeric_limits<Index>::min()}) {
    EXPECT_TRUE(has(refusal([&] { modes(h.model, x, count); }), "modes: the number of modes must be at least 1"));
    EXPECT_TRUE(has(refusal([&] { damped_modes(h.model, x, count); }), "the number of modes must be at least 1"));
  }
  EXPECT_EQ(modes(h.model, x, std::numeric_limits<Index>::max()).frequency.size(), 3);
}

// An unreachable tolerance, and iterations that do not end.
TEST(HostileStates, AssemblyComesToAnEnd) {
  Hanging const h;
  State x = h.model.reference_state();
  EXPECT_TRUE(has(refusal([&] { assemble(h.model, x, std::nan("")); }), "assemble: the tolerance"));
  EXPECT_TRUE(has(refusal([&] { assemble(h.model, x, 1e-12, -1); }), "assemble: max_iterations"));
  EXPECT_TRUE(has(refusal([&] { assemble(h.model, x, 1e-12, 2'000'000'000); }), "assemble: max_iterations"));
}

}  // namespace hostile_states_test
