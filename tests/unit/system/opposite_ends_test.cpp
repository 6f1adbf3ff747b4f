#include <gtest/gtest.h>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/joints/policies/bushing.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/system/make_operations.hpp>
#include <polybody/system/model.hpp>
#include <polybody/system/system.hpp>

using namespace polybody;

namespace opposite_ends_test {

static_assert(has_opposite_ends<Joint<Revolute, Constraint>::Measured>());
static_assert(!has_opposite_ends<Joint<Revolute, Bushing>::Measured>(), "It measures other rows.");

// Most joints here apply one wrench to both ends, RevolutePin applies two. For any rates b and multipliers λ the
// power b·(Gᵀλ) equals λ·(G b), which uses the maps of both ends. Frames are arbitrary and the joints are violated.
template <class G>
void expect_power_of_rates(G const& geometry) {
  static constexpr double rounding = 1e-13;
  using Link = Joint<G, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Link>> model;
  auto const a = model.add(Rigid<>(1.0, Mat3::Identity())), b = model.add(Rigid<>(2.0, Mat3::Identity()));
  model.connect(Link{geometry, {}}, model.ground().at({0.3, 0.1, -0.2}), a.at(Vec3(0.2, -0.4, 0.1)));
  model.connect(Link{geometry, {}}, a.at(Vec3(0.5, 0.6, 0.7)), b.at(Vec3(-0.3, 0.8, 0.2)));
  State x = model.reference_state();
  System s(model);
  auto const number = [](Index i) { return std::sin(1.7 * double(i) + 0.4); };
  VecX const moved = VecX::NullaryExpr(s.velocities(), number),
             rates = VecX::NullaryExpr(s.velocities(), [&](Index i) { return number(i + 30); });
  VecX const lambda = VecX::NullaryExpr(s.rows(), [&](Index i) { return number(i + 70); });
  VecX q = x.q, force = x.v, rate(s.rows());
  s.plus(x.q, moved, q);
  s.evaluate(q, x.v, 0.0);
  s.rows_transposed_times(lambda, force);
  s.rows_times(rates, rate);
  EXPECT_GT(std::abs(lambda.dot(rate)), 0.1) << G::name;
  EXPECT_NEAR(rates.dot(force), lambda.dot(rate), rounding * rates.norm() * force.norm()) << G::name;
}

TEST(OppositeEnds, HaveThePowerOfTheRates) {
  expect_power_of_rates(Revolute{.axis = Vec3::UnitY()});
  expect_power_of_rates(Weld{});
  expect_power_of_rates(Spherical{});
  expect_power_of_rates(ConstantOrientation{});
  expect_power_of_rates(ParallelAxes{.axis = Vec3::UnitX()});
  expect_power_of_rates(Universal{.first = Vec3::UnitX(), .second = Vec3::UnitY()});
  expect_power_of_rates(RevolutePin{.distance = 0.2, .axis = Vec3::UnitZ()});
}

}  // namespace opposite_ends_test
