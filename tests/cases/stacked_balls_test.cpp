// Two stacked balls on a floor, m ẍ₁ = −k x₁ + k (x₂ − x₁), m ẍ₂ = −k (x₂ − x₁): ω² = (3 ∓ √5)/2 k/m.
#include <gtest/gtest.h>

#include <polybody/polybody.hpp>
#include <polybody/vibration/modes.hpp>

#include "support/held.hpp"

using namespace polybody;

namespace stacked_balls_test {

using OnFloor = Contact<SphereOnPlane>;
using OnBall = Contact<SphereOnSphere>;
using Slide = Joint<Prismatic, Constraint>;
using Group = ContactGroup<OnFloor, OnBall>;

constexpr double radius = 0.1, k = 1e5, mass = 1.0, g = 9.81;

template <class Fs>
struct Stack {
  Model<Bodies<Rigid<>>, Joints<Slide>, Fs> model{Gravity{0, 0, -g}};
  std::vector<Marker<Rigid<>>> balls;

  Stack() {
    for (double const z : {0.0999, 0.2997}) {
      auto const ball = model.add(Rigid<>(mass, 0.004 * Mat3::Identity(), Placement::at({0, 0, z})));
      balls.push_back(ball.at(Vec3(0, 0, 0)));
      model.connect(Slide{Prismatic{.axis = Vec3::UnitZ()}, {}}, model.ground().at({0, 0, z}), balls.back());
    }
  }
};

// Statics and linearisation require the coupling of two bodies in contact, which a time step neglects.
TEST(StackedBalls, OfAGroupRestAndSwingAsThoseOneByOne) {
  OnFloor const floor{{radius}, {.stiffness = k}};
  OnBall const ball{{radius, radius}, {.stiffness = k}};
  Stack<Forces<OnFloor, OnBall>> single;
  single.model.apply(floor, single.balls[0], single.model.ground().at({0, 0, 0}));
  single.model.apply(ball, single.balls[1], single.balls[0]);
  Stack<Forces<Group>> grouped;
  auto const group = grouped.model.apply(Group{}, grouped.balls);
  grouped.model.add_partner(group, floor, grouped.model.ground().at({0, 0, 0}));
  grouped.model.add_partner(group, ball, grouped.balls[0]);
  auto const check_step = [](char const* forces, auto& stack) {
    auto const claim = [&](char const* what, char const* source) {
      return Claim{"closed forms", what, By::closed_form, source, forces};
    };
    State x = stack.model.reference_state();
    EXPECT_LE(equilibrium(stack.model, x).iterations, 3);
    held(claim("height of the lower of two balls [m]", "R − 2 m g/k"), position(stack.model, x, stack.balls[0]).z(),
         radius - 2.0 * mass * g / k, 1e-12);
    held(claim("height of the upper of two balls [m]", "3 R − 3 m g/k"), position(stack.model, x, stack.balls[1]).z(),
         3.0 * radius - 3.0 * mass * g / k, 1e-12);
    Modes const m = modes(linearise(stack.model, x));
    ASSERT_EQ(m.frequency.size(), 2);
    double const unit = std::sqrt(k / mass), golden = 0.5 * (std::sqrt(5.0) - 1.0);
    Claim const modes_of = claim("frequencies of two balls on each other, ω √(m/k)", "√((3 ∓ √5)/2)");
    held(modes_of, m.frequency[0] / unit, golden, 1e-9, {"mode = 1"});
    held(modes_of, m.frequency[1] / unit, 1.0 / golden, 1e-9, {"mode = 2"});
  };
  check_step("contacts one by one", single);
  check_step("contact group", grouped);
}

}  // namespace stacked_balls_test
