// Joint coordinates and linear elimination in one model: the motion is that of constraint equations.
#include <gtest/gtest.h>

#include <polybody/polybody.hpp>

namespace polybody::eliminations_together_test {

using Cable = planar::AncfCable<>;
template <class Policy>
using Pin = Joint<planar::Revolute, Policy>;

/// A rigid rod on a hinge and two pinned cables that fall for 0.05 s; with `closed` the first cable hangs on the rod.
template <class Hinge, class Link, class JointList>
State fall(bool closed) {
  Bar bar{.length = 0.5,
          .constants = BarConstants{.EA = 1e4, .EI = 1.0, .mass_per_length = 0.5},
          .placement = Placement::planar(0.5, 0)};
  Model<Bodies<planar::Rigid, Cable>, JointList> model{Gravity{0, -9.81, 0}};
  auto const rod = model.add(planar::Rigid(1.0, 0.02, Placement::planar(0.25, 0)), "rod");
  auto const a = model.add(Cable::from(bar, 2), "a");
  bar.placement = Placement::planar(1.0, 0);
  auto const b = model.add(Cable::from(bar, 2), "b");
  model.connect(Pin<Hinge>{{}, {}}, model.ground().at({0, 0, 0}), rod.at(Vec2(-0.25, 0)), "hinge");
  model.connect(Pin<Link>{{}, {}}, a.at(0.5), b.at(0.0), "link");
  if (closed) model.connect(Pin<Constraint>{{}, {}}, rod.at(Vec2(0.25, 0)), a.at(0.0), "pin");
  State x = model.reference_state();
  simulate(model, x, GeneralisedAlpha{}, {.end_time = 0.05, .step = 1e-4}).run();
  return x;
}

TEST(Eliminations, TogetherMoveLikeConstraintEquations) {
  for (bool const closed : {false, true}) {
    State const rows = fall<Constraint, Constraint, Joints<Pin<Constraint>>>(closed);
    State const both =
        fall<JointCoordinates, AncfLinear, Joints<Pin<JointCoordinates>, Pin<AncfLinear>, Pin<Constraint>>>(closed);
    EXPECT_LT((both.q - rows.q).norm(), 1e-8);
    EXPECT_LT((both.v - rows.v).norm(), 1e-6);
  }
}

}  // namespace polybody::eliminations_together_test
