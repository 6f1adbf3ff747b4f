// Summary of a model as text.
#include <gtest/gtest.h>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/summary.hpp>

namespace polybody {
namespace outline_test {

using Pin = Joint<Revolute, Constraint>;
using Soft = Joint<Revolute, Penalty>;

Rigid<> unit(double x) { return Rigid<>(1.0, Mat3::Identity(), Placement::at({x, 0, 0})); }

TEST(Outline, TellsWhatHangsOnWhat) {
  Model<Bodies<Rigid<>>, Joints<Pin, Soft>, Forces<SpringDamper>> model{Gravity{0, 0, -9.81}};
  Pin const pin{Revolute{.axis = {0, 1, 0}}};
  auto const upper = model.add(unit(0.0), "upper"), lower = model.add(unit(1.0), "lower"),
             other = model.add(unit(2.0), "other"), loose = model.add(unit(5.0), "loose");
  model.connect(pin, model.ground().at({0, 0, 0}), upper.at(Vec3(0, 0, 0)), "hip");
  model.connect(pin, lower.at(Vec3(-0.5, 0, 0)), upper.at(Vec3(0.5, 0, 0)), "knee");  // in either order
  model.connect(Soft{Revolute{.axis = {0, 1, 0}}, Penalty{.stiffness = 1e6, .damping = 1.0}}, upper.at(Vec3(2.0, 0, 0)),
                other.at(Vec3(0, 0, 0)), "mount");
  model.connect(pin, model.ground().at({1.5, 0, 0}), lower.at(Vec3(0.5, 0, 0)), "foot");
  model.apply(SpringDamper{.stiffness = 10.0, .free_length = 1.0}, lower.at(Vec3(0, 0, 0)), loose.at(Vec3(0, 0, 0)),
              "spring");
  EXPECT_EQ(summary(model),
            "4 bodies (28 coordinates, 24 velocities), 4 joints (15 equations), 1 force; gravity (0, 0, -9.81) m/s²\n"
            "    upper: 7 coordinates, by \"hip\" (5 equations) on the ground\n"
            "      lower: 7 coordinates, by \"knee\" (5 equations) on upper\n"
            "      other: 7 coordinates, by \"mount\" (compliant) on upper\n"
            "  loose: 7 coordinates, not joined to the ground\n"
            "closes a loop: \"foot\" (5 equations), the ground and lower\n"
            "force \"spring\" on lower, loose\n");
}

TEST(Outline, OfAChainGoesDownThePage) {
  Model<Bodies<Rigid<>>, Joints<Pin>> model;
  std::optional<BodyHandle<Rigid<>>> before;
  for (int i = 0; i < 200; ++i) {
    auto const link = model.add(unit(i), "link" + std::to_string(i));
    Pin const pin{Revolute{.axis = {0, 1, 0}}};
    if (before)
      model.connect(pin, before->at(Vec3(0.5, 0, 0)), link.at(Vec3(-0.5, 0, 0)));
    else
      model.connect(pin, model.ground().at({-0.5, 0, 0}), link.at(Vec3(-0.5, 0, 0)));
    before = link;
  }
  std::string const text = summary(model);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 201);
  EXPECT_NE(text.find("\n  link199: 7 coordinates, by "), std::string::npos);
  EXPECT_NE(text.find(" on link198\n"), std::string::npos);
}

TEST(Outline, OfAnEmptyModel) {
  Model<Bodies<Rigid<>>, Joints<Pin>> const model;
  EXPECT_EQ(summary(model),
            "0 bodies (0 coordinates, 0 velocities), 0 joints (0 equations), 0 forces; gravity (0, 0, 0) m/s²\n");
}

}  // namespace outline_test
}  // namespace polybody
