#include <polybody/forces/loads.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/force_differences.hpp>

#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace point_load_test {

double const nan_ = std::numeric_limits<double>::quiet_NaN();
Vec3 const load(3, -1, 2);

TEST(PointForce, DeadKeepsItsDirectionHoweverTheMarkerTurns) {
  Numbers number;
  PointForce<> const force{.force = load};
  for (int k = 0; k < 3; ++k) {
    auto const w = force.wrenches<double>({number.frame()}, 0.0);
    EXPECT_EQ(w[0].f, load);
    EXPECT_EQ(w[0].m, Vec3(0, 0, 0));
  }
}

TEST(PointForce, FollowerKeepsItsDirectionInTheMarkersAxes) {
  Numbers number;
  PointForce<> const force{.force = load, .axes = LoadAxes::marker};
  for (int k = 0; k < 3; ++k) {
    Frame<double> const frame = number.frame();
    auto const w = force.wrenches<double>({frame}, 0.0);
    EXPECT_LT((frame.A.transpose() * w[0].f - load).norm(), 1e-14);
    EXPECT_EQ(w[0].m, Vec3(0, 0, 0));
  }
}

TEST(PointMoment, DeadAndFollowerAreMomentsOnly) {
  Frame<double> const frame = Numbers{}.frame();
  auto const dead = PointMoment<>{.moment = load}.wrenches<double>({frame}, 0.0);
  auto const follower = PointMoment<>{.moment = load, .axes = LoadAxes::marker}.wrenches<double>({frame}, 0.0);
  EXPECT_EQ(dead[0].m, load);
  EXPECT_LT((follower[0].m - frame.A * load).norm(), 1e-15);
  EXPECT_EQ(dead[0].f.norm() + follower[0].f.norm(), 0.0);
}

TEST(PointForce, FollowsItsLawOfTime) {
  PointForce<Window> const push{.force = load, .law = {.from = 1.0, .to = 2.0, .value = 0.5}};
  std::array<Frame<double>, 1> const frame{};
  EXPECT_EQ(push.wrenches<double>(frame, 0.9)[0].f, Vec3(0, 0, 0));
  EXPECT_EQ(push.wrenches<double>(frame, 1.0)[0].f, 0.5 * load);
  EXPECT_EQ(push.wrenches<double>(frame, 2.0)[0].f, Vec3(0, 0, 0));
  PointMoment<SmoothRamp> const turn{.moment = load, .law = {.target = 3.0, .duration = 2.0}};
  EXPECT_EQ(turn.wrenches<double>(frame, 5.0)[0].m, 3.0 * load);
  EXPECT_LT((turn.wrenches<double>(frame, 1.0)[0].m - 1.5 * load).norm(), 1e-14);
}

// Gradient of a follower load: δf = φ × f. A dead load has no gradient.
TEST(PointLoads, GradientIsThatOfTheLoadThatTurns) {
  std::array<Frame<double>, 1> const frame{Numbers{}.frame()};
  PointForce<> const follower{.force = load, .axes = LoadAxes::marker};
  Mat<double, 6, 6> const gradient = wrench_gradient(follower, frame, 0.0, 2.0, 5.0);
  Mat<double, 6, 6> expected = Mat<double, 6, 6>::Zero();
  expected.topRightCorner<3, 3>() = -2.0 * skew<double>(frame[0].A * load);
  EXPECT_LT((gradient - expected).norm(), 1e-14);
  EXPECT_LT(gradient_mismatch(follower, frame, 0.0, 0.7, 31.0), 1e-10);
  EXPECT_LT(gradient_mismatch(PointMoment<>{.moment = load, .axes = LoadAxes::marker}, frame, 0.0, 0.7, 31.0), 1e-10);
  EXPECT_EQ(wrench_gradient(PointForce<>{.force = load}, frame, 0.0, 1.0, 1.0).norm(), 0.0);
}

TEST(PointLoads, RefuseALawThatCannotBeMeant) {
  PointForce<Ramp> const force{.force = load, .law = {.target = 1.0, .duration = -1.0}};
  EXPECT_TRUE(has(refusal([&] { force.check("\"push\""); }), "\"push\": the time function: the duration"));
  PointMoment<Window> const moment{.moment = load, .law = {.from = 1.0, .to = 1.0}};
  EXPECT_TRUE(has(refusal([&] { moment.check("\"turn\""); }), "\"turn\": the time function: a window"));
}

TEST(PointLoads, RefuseNanByName) {
  EXPECT_TRUE(has(refusal([] { PointForce<>{.force = {0, nan_, 0}}.check("\"push\""); }), "\"push\": the force"));
  EXPECT_TRUE(has(refusal([] { PointMoment<>{.moment = {0, 0, nan_}}.check("\"turn\""); }), "\"turn\": the moment"));
}

}  // namespace point_load_test
