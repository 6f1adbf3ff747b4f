#include <polybody/forces/user_force.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/force_differences.hpp>

using namespace polybody;
using namespace polybody::laws;

namespace user_force_test {

// Drag −c |v| v, and a torque that rotates the marker's first axis towards the world's z.
auto const drag = user_force<1>([](auto const& frames, double) {
  using T = typename std::decay_t<decltype(frames[0].r)>::Scalar;
  using std::sqrt;
  Wrench<T> w;
  T const speed = sqrt(frames[0].v.squaredNorm());
  w.f = frames[0].v * (speed * -3.0);
  Vec<T, 3> const axis = frames[0].A.col(0);
  w.m = axis.cross(Vec<T, 3>(T(0.0), T(0.0), T(2.0)));
  return std::array{w};
});

// Inverse-square attraction between two markers that decays with time.
auto const attraction = user_force<2>([](auto const& frames, double t) {
  using T = typename std::decay_t<decltype(frames[0].r)>::Scalar;
  using std::sqrt;
  Vec<T, 3> const d = frames[1].r - frames[0].r;
  T const l2 = d.squaredNorm();
  std::array<Wrench<T>, 2> w;
  w[0].f = d * (std::exp(-t) / (l2 * sqrt(l2)));
  w[1].f = -w[0].f;
  return w;
});

static_assert(ForceElement<std::decay_t<decltype(drag)>> && ForceElement<std::decay_t<decltype(attraction)>>);
static_assert(!HasPotential<std::decay_t<decltype(drag)>>);

TEST(UserForce, IsWhatTheLambdaReturns) {
  Frame<double> const frame{.v = {0, 2, 0}};
  auto const w = drag.wrenches<double>({frame}, 0.0);
  EXPECT_EQ(w[0].f, Vec3(0, -12, 0));
  EXPECT_EQ(w[0].m, Vec3(0, -2, 0));
  auto const pulled = attraction.wrenches<double>({Frame<double>{}, Frame<double>{.r = {0, 0, 2}}}, 1.0);
  EXPECT_LT((pulled[0].f - Vec3(0, 0, std::exp(-1.0) / 4.0)).norm(), 1e-15);
}

TEST(UserForce, GradientComesFromDualNumbers) {
  Numbers number;
  for (auto const& [ck, cd] : {std::pair{1.0, 0.0}, {0.0, 1.0}, {0.7, 31.0}}) {
    EXPECT_LT(gradient_mismatch(drag, {number.frame()}, 0.3, ck, cd), 1e-9);
    EXPECT_LT(gradient_mismatch(attraction, {number.frame(), number.frame()}, 0.3, ck, cd), 1e-9);
  }
}

}  // namespace user_force_test
