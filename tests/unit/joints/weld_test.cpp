#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/standard_joints.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/joint_laws.hpp>

using namespace polybody;
using namespace polybody::laws;

namespace weld_test {

struct WeldCase {
  static constexpr bool planar = false;
  static constexpr int world_rows = 3;
  static Weld geometry() { return {}; }
  static Mate mate(Numbers&, double) { return {.free_directions = MatX::Zero(6, 0)}; }
};

struct PlanarWeldCase {
  static constexpr bool planar = true;
  static constexpr int world_rows = 2;
  static planar::Weld geometry() { return {}; }
  static Mate mate(Numbers& number, double t) { return WeldCase::mate(number, t); }
};

// For a small rotation φ of b the constraint functions a₁·b₂, a₂·b₃, a₃·b₁ are −φ₃, −φ₁, −φ₂ in a's axes.
TEST(Weld, RotationalRowsMeasureTheTurn) {
  Vec3 const phi = Vec3(1, -2, 3) * 1e-7;
  Frame<double> const a{.A = exp_so3<double>(Vec3(0.3, 1, -2))};
  Frame<double> const b{.A = a.A * exp_so3<double>(phi)};
  EXPECT_LT((constraint_function<double>(Weld{}, a, b, 0.0).g.tail<3>() + Vec3(phi[2], phi[0], phi[1])).norm(), 1e-12);
  Frame<double> const c{.A = exp_so3<double>(Vec3(0, 0, 0.7))};
  Frame<double> const d{.A = exp_so3<double>(Vec3(0, 0, 0.7 + 1e-7))};
  EXPECT_NEAR((constraint_function<double>(planar::Weld{}, c, d, 0.0).g[2]), 1e-7, 1e-15);
}

}  // namespace weld_test

namespace polybody {
bool const weld_obey[] = {obeys<weld_test::WeldCase, JointLaws>("Weld"),
                          obeys<weld_test::PlanarWeldCase, JointLaws>("PlanarWeld")};
}  // namespace polybody
