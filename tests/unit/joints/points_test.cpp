#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/standard_joints.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/joint_laws.hpp>

#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace points_test {

/// b at d, with any rotation; its point moves freely along the axes of `free`.
Mate at(Numbers& number, Vec3 const& d, std::vector<Index> const& free) {
  Index const n = Index(free.size());
  Mate mate{.d = d, .R = exp_so3<double>(number.vec<3>(3.0)), .free_directions = MatX::Zero(6, n + 3)};
  for (Index j = 0; j < n; ++j) mate.free_directions(free[std::size_t(j)], j) = 1.0;
  mate.free_directions.bottomRightCorner<3, 3>().setIdentity();
  return mate;
}

struct PointOnLineCase {
  static constexpr bool planar = false;
  static constexpr int world_rows = 0;
  static PointOnLine geometry() { return {}; }
  static Mate mate(Numbers& number, double) { return at(number, {0, 0, number(2.0)}, {2}); }
};

struct PointInPlaneCase {
  static constexpr bool planar = false;
  static constexpr int world_rows = 0;
  static PointInPlane geometry() { return {}; }
  static Mate mate(Numbers& number, double) { return at(number, {number(2.0), number(2.0), 0}, {0, 1}); }
};

using Slide = PrescribedTranslation<SmoothRamp>;
Slide const slide{.law = {.target = 0.6, .duration = 4.0}};

struct SlideCase {
  static constexpr bool planar = false;
  static constexpr int world_rows = 0;
  static Slide geometry() { return slide; }
  static Mate mate(Numbers& number, double t) {
    return at(number, {number(2.0), number(2.0), slide.law(t).value}, {0, 1});
  }
};

Frame<double> const b{.r = {0.1, 0.2, 0.3}};

TEST(PointOnLine, RowsAreTheOffsetFromTheLine) {
  EXPECT_EQ((constraint_function<double>(PointOnLine{}, {}, b, 0.0).g), Vec2(0.1, 0.2));
}

TEST(PointInPlane, RowIsTheHeightOverThePlane) {
  EXPECT_EQ((constraint_function<double>(PointInPlane{}, {}, b, 0.0).g[0]), 0.3);
}

TEST(PrescribedTranslation, RowIsWhatTheSlideLacks) {
  PrescribedTranslation<Constant> const still{.law = {.value = 0.25}};
  EXPECT_DOUBLE_EQ((constraint_function<double>(still, {}, b, 0.0).g[0]), 0.05);
}

TEST(PrescribedTranslation, TellsTheCornersOfItsLawAndRefusesAJump) {
  PrescribedTranslation<Ramp> const ramp{.law = {.target = 1.0, .duration = 2.0, .start = 0.5}};
  EXPECT_EQ(ramp.breakpoints(), (std::vector{0.5, 2.5}));
  EXPECT_NO_THROW(ramp.check("\"slide\""));
  PrescribedTranslation<Window> const jump{.law = {.from = 1.0, .to = 2.0, .value = -3.0}};
  EXPECT_TRUE(has(refusal([&] { jump.check("\"slide\""); }),
                  "\"slide\": the time function: the value jumps from 0 to -3 at t = 1 s"));
}

TEST(Points, RefuseAxesThatAreNotUnitVectors) {
  EXPECT_TRUE(
      has(refusal([] { (void)PointOnLine{.axis = {0, 0, 0}}.triad(); }), "PointOnLine: the axis must be a unit"));
  EXPECT_TRUE(
      has(refusal([] { (void)PointInPlane{.normal = {0, 2, 0}}.triad(); }), "PointInPlane: the normal must be a unit"));
  EXPECT_TRUE(has(refusal([] { (void)Slide{.law = slide.law, .axis = {0, 2, 0}}.triad(); }),
                  "PrescribedTranslation: the axis"));
}

}  // namespace points_test

namespace polybody {
bool const points_obey[] = {obeys<points_test::PointOnLineCase, JointLaws>("PointOnLine"),
                            obeys<points_test::PointInPlaneCase, JointLaws>("PointInPlane"),
                            obeys<points_test::SlideCase, JointLaws>("PrescribedTranslation")};
}  // namespace polybody
