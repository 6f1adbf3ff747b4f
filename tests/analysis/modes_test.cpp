#include <polybody/vibration/modes.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/spring_damper.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/planar/prismatic.hpp>
#include <polybody/joints/point_in_plane.hpp>
#include <polybody/joints/revolute.hpp>
#include <polybody/joints/spherical.hpp>
#include <polybody/statics/equilibrium.hpp>

#include "support/chain.hpp"
#include "support/refusal.hpp"

using namespace polybody;

namespace modes_test {

// The whole stiffness of a hinged rod is a second-order term: ω² = m g d/J about the hinge, here 3g/2L; upside down it
// is −3g/2L.
TEST(Modes, OfAHangingAndOfAStandingRod) {
  for (double const sign : {1.0, -1.0}) {
    Chain<InSpace<Constraint>> chain(1, bar_link(0.8), sign * 9.81, 0.0);
    State x = chain.model.reference_state();
    equilibrium(chain.model, x);
    Modes const m = modes(chain.model, x);
    ASSERT_EQ(m.frequency.size(), 1);
    EXPECT_NEAR(m.frequency[0], sign * std::sqrt(1.5 * 9.81 / 0.8), 1e-9);
    EXPECT_NEAR(std::abs(m.shape(5, 0)), 1.0 / std::sqrt(1.0 * 0.8 * 0.8 / 3.0), 1e-9);  // unit generalised mass
  }
}

// Double pendulum of point masses m, lengths l: ω² = (2 ± √2) g/l.
TEST(Modes, OfADoublePendulum) {
  Chain<InPlane<Constraint>> chain(2, point_link(0.5), 9.81, 0.0);
  State x = chain.model.reference_state();
  equilibrium(chain.model, x);
  Modes const m = modes(chain.model, x);
  ASSERT_EQ(m.frequency.size(), 2);
  for (int i = 0; i < 2; ++i)
    EXPECT_NEAR(m.frequency[i], std::sqrt((2.0 + (i ? 1.0 : -1.0) * std::sqrt(2.0)) * 9.81 / 0.5), 1e-9);
}

/// A mass on a slide, held by a spring and a damper.
struct Oscillator {
  using Slide = Joint<planar::Prismatic, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Slide>, Forces<SpringDamper>> model;
  State x;
  Oscillator(double mass, double stiffness, double damping) {
    auto const block = model.add(planar::Rigid(mass, 1.0, Placement::planar(2.0, 0.0)), "block");
    model.connect(Slide{}, model.ground().at({0, 0, 0}), block.at(Vec2(0, 0)), "slide");
    model.apply(SpringDamper{.stiffness = stiffness, .damping = damping, .free_length = 2.0},
                model.ground().at({0, 0, 0}), block.at(Vec2(0, 0)));
    x = model.reference_state();
  }
};

TEST(DampedModes, OfAnOscillator) {
  double const m = 2.0, k = 50.0, omega = 5.0, zeta = 0.3;
  Oscillator const o(m, k, 2.0 * zeta * omega * m);
  DampedModes const d = damped_modes(o.model, o.x);
  ASSERT_EQ(d.eigenvalue.size(), 1);
  EXPECT_NEAR(d.frequency(0), omega, 1e-10);
  EXPECT_NEAR(d.damping_ratio(0), zeta, 1e-11);
  EXPECT_NEAR(d.eigenvalue[0].imag(), omega * std::sqrt(1.0 - zeta * zeta), 1e-10);
  EXPECT_NEAR(modes(o.model, o.x).frequency[0], omega, 1e-10);
}

TEST(DampedModes, CreepBackWithoutSwinging) {
  Oscillator const o(1.0, 8.0, 9.0);  // s² + 9 s + 8 = (s + 1)(s + 8)
  DampedModes const d = damped_modes(o.model, o.x);
  ASSERT_EQ(d.eigenvalue.size(), 2);
  EXPECT_NEAR(d.eigenvalue[0].real(), -1.0, 1e-10);
  EXPECT_NEAR(d.eigenvalue[1].real(), -8.0, 1e-10);
  EXPECT_NEAR(d.eigenvalue[0].imag(), 0.0, 1e-10);
}

// A thin rod on a ball joint turns freely about itself without inertia: that motion has no frequency. It swings in two
// planes, ω² = m g d/(J + m d²).
TEST(Modes, MotionsWithoutInertiaAreLeftOut) {
  using Ball = Joint<Spherical, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Ball>> model{Gravity{0, -9.81, 0}};
  auto const rod = model.add(
      Rigid<>(1.0, Vec3(0.0, 0.1, 0.1).asDiagonal(), Placement::planar(0.0, -0.4, -0.5 * std::numbers::pi)), "rod");
  model.connect(Ball{}, model.ground().at({0, 0, 0}), rod.at(Vec3(-0.4, 0, 0)), "ball");
  State x = model.reference_state();
  x.lambda << 0.0, -9.81, 0.0;  // g = r_b − r_a: −λ acts on the rod
  Modes const m = modes(model, x);
  ASSERT_EQ(m.frequency.size(), 2);
  for (int i = 0; i < 2; ++i) EXPECT_NEAR(m.frequency[i], std::sqrt(9.81 * 0.4 / (0.1 + 0.16)), 1e-9);
}

// A point mass on a bar without inertia that two springs hold at a and b: its turn follows without delay, and
// ω² = k₁ k₂ (a − b)²/((k₁ a² + k₂ b²) m).
TEST(Modes, MotionsWithoutInertiaFollowTheOthers) {
  double const k1 = 300.0, k2 = 500.0, a = 0.3, b = -0.5, mass = 2.0, length = 1.0;
  Model<Bodies<planar::Rigid>, Joints<Joint<PointInPlane, Constraint>>, Forces<SpringDamper>> model;
  auto const bar = model.add(planar::Rigid(mass, 0.0), "bar");
  auto const hold = [&](double k, double at) {
    model.apply(SpringDamper{.stiffness = k, .free_length = length}, model.ground().at({at, -length, 0}),
                bar.at(Vec2(at, 0)));
  };
  hold(k1, a);
  hold(k2, b);
  model.connect(Joint<PointInPlane, Constraint>{{.normal = Vec3::UnitX()}, {}}, model.ground().at({0, 0, 0}),
                bar.at(Vec2(0, 0)));
  Modes const m = modes(model, model.reference_state());
  ASSERT_EQ(m.frequency.size(), 1);
  double const square = k1 * k2 * (a - b) * (a - b) / ((k1 * a * a + k2 * b * b) * mass);
  EXPECT_NEAR(m.frequency[0], std::sqrt(square), 1e-9);
}

TEST(Modes, AskForAStateOfRest) {
  Oscillator o(1.0, 1.0, 0.0);
  o.x.v[0] = 0.1;
  EXPECT_TRUE(has(refusal([&] { modes(o.model, o.x); }), "the state must be at rest"));
}

}  // namespace modes_test
