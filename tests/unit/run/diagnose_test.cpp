// Diagnosis of a model before a run: values compared with closed forms, and messages.
#include <gtest/gtest.h>

#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/run/diagnose.hpp>
#include <polybody/vibration/modes.hpp>

#include <sstream>

#include "support/refusal.hpp"

namespace polybody {
namespace check_test {

using Pin = Joint<planar::Revolute, Constraint>;
using Flat = Model<Bodies<planar::Rigid>, Joints<Pin>, Forces<SpringDamper>>;

std::string said(Diagnosis const& c) {
  std::ostringstream out;
  out << c;
  return out.str();
}

/// Two masses of 2 kg, each between the ground and the other on springs of 8 N/m along x: ω² = k/m and 3 k/m.
struct Masses {
  Flat model;
  State x;
  Masses() {
    auto const left = model.add(planar::Rigid(2.0, 1.0, Placement::planar(1, 0, 0)), "left"),
               right = model.add(planar::Rigid(2.0, 1.0, Placement::planar(2, 0, 0)), "right");
    SpringDamper const spring{.stiffness = 8.0, .free_length = 1.0};
    model.apply(spring, model.ground().at({0, 0, 0}), left.at(Vec2(0, 0)));
    model.apply(spring, left.at(Vec2(0, 0)), right.at(Vec2(0, 0)));
    model.apply(spring, right.at(Vec2(0, 0)), model.ground().at({3, 0, 0}));
    x = model.reference_state();
  }
};

TEST(Check, FindsTheStiffestMotion) {
  Masses const m;
  Diagnosis const c = diagnose(m.model, m.x);
  EXPECT_NEAR(c.stiffest, std::sqrt(12.0), 1e-5);
  ASSERT_EQ(c.stable_steps.size(), 3u);
  EXPECT_EQ(c.stable_steps[1].integrator, "CentralDifference");
  EXPECT_NEAR(c.stable_steps[1].step, 2.0 / std::sqrt(12.0), 1e-5);
  EXPECT_EQ(c.unconnected_bodies, (std::vector<std::string>{"left", "right"}));
  EXPECT_TRUE(c.largest_violated_joint.empty());
}

TEST(Check, FindsTheStiffestModeOfACable) {  // compared with the dense eigenproblem
  using Clamp = Joint<planar::Weld, Constraint>;
  Model<Bodies<planar::AncfCable<>>, Joints<Clamp>> model;
  Bar const bar{.length = 1.0, .constants = BarConstants{.EA = 1e4, .EI = 1.0, .mass_per_length = 1.0}};
  auto const cable = model.add(planar::AncfCable<>::from(bar, 4), "cable");
  model.connect(Clamp{}, model.ground().at({0, 0, 0}), cable.at(0.0), "clamp");
  State const x = model.reference_state();
  double largest = 0.0;
  for (double const omega : modes(model, x, 30).frequency) largest = std::max(largest, omega);
  Diagnosis const c = diagnose(model, x);
  EXPECT_NEAR(c.stiffest, largest, 1e-3 * largest);
  EXPECT_EQ(c.stiffest_at, "cable");
  EXPECT_TRUE(c.unconnected_bodies.empty());
}

TEST(Check, SaysWhatItFinds) {
  Flat model;
  auto const bar = model.add(planar::Rigid(1.0, 1.0), "bar");
  model.add(planar::Rigid(1.0, 1.0), "stray");
  model.connect(Pin{}, model.ground().at({0, 0, 0}), bar.at(Vec2(0, 0)), "pin");
  model.connect(Pin{}, model.ground().at({1, 0, 0}), bar.at(Vec2(1, 0)), "second");
  State x = model.reference_state();
  x.q[0] += 0.25;
  Diagnosis const c = diagnose(model, x);
  EXPECT_EQ(c.violation.position, 0.25);
  EXPECT_EQ(c.largest_violated_joint, "joint \"pin\"");
  EXPECT_EQ(c.stiffest, 0.0);
  std::string const text = said(c);
  for (char const* const line :
       {"constraint violation 0.25 m or rad (positions), 0 m/s or rad/s (velocities), the largest in joint \"pin\"\n",
        "4 constraint equations of rank 3, 3 degrees of freedom\n",
        "joint \"second\": 1 redundant constraint equation\n", "not joined to the ground: stray\n"})
    EXPECT_NE(text.find(line), std::string::npos) << line << "in\n" << text;
  EXPECT_EQ(text.find("stiffest"), std::string::npos);
  EXPECT_NE(said(diagnose(Masses{}.model, Masses{}.x)).find("stiffest motion 3.46"), std::string::npos);
}

TEST(Check, TellsWhenNoAccelerationsFollow) {
  Flat model;
  auto const bar = model.add(planar::Rigid(1.0, 0.0), "bar");  // without inertia, and free to rotate
  model.connect(Pin{}, model.ground().at({0, 0, 0}), bar.at(Vec2(0, 0)), "pin");
  Diagnosis const c = diagnose(model, model.reference_state());
  EXPECT_NE(c.unsolved.find("\"bar\""), std::string::npos) << c.unsolved;
}

TEST(Check, RefusesAStateOfAnotherModel) {
  Masses const m;
  Flat other;
  other.add(planar::Rigid(1.0, 1.0));
  EXPECT_TRUE(has(refusal([&] { (void)diagnose(m.model, other.reference_state()); }), "does not fit"));
}

}  // namespace check_test
}  // namespace polybody
