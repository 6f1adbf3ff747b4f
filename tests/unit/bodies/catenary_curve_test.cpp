#include <polybody/bodies/shared/catenary.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/system/model.hpp>

#include "support/refusal.hpp"

namespace polybody {
namespace catenary_curve_test {

// Equilibrium of a uniform cable. The vertical component of the tension grows by the weight per length, and the
// horizontal component is constant. So the slope dz/dx grows by a constant amount per metre of arc length. Slack from
// 2e-6 to 1e3 times the span, with the end above and below.
TEST(Catenary, EndsAtTheEndWithASlopeThatGrowsWithTheArcLength) {
  for (double const slack : {2e-6, 1e-2, 1.0, 1e3})
    for (double const rise : {-0.7, 0.0, 2.0}) {
      Vec3 const down = Vec3(0.2, -0.3, -2.0), up = -down.normalized();
      Vec3 const along = Vec3(1.0, 0.5, 0.0).cross(up).normalized(), end = 1.3 * along + rise * up;
      double const length = end.norm() * (1.0 + slack);
      ReferenceCurve const curve = catenary(end, length, down);
      EXPECT_LT(curve(0.0).origin.norm(), 1e-12 * length);
      EXPECT_LT((curve(length).origin - end).norm(), 1e-9 * length) << slack << ' ' << rise;
      auto const slope = [&](double s) {
        Vec3 const t = curve(s).axes.col(0);
        return t.dot(up) / t.dot(along);
      };
      double const first = slope(0.0), growth = (slope(length) - first) / length;
      for (double const part : {0.2, 0.5, 0.9}) {
        double const s = part * length, h = 1e-4 * length;
        EXPECT_NEAR(slope(s), first + growth * s, 1e-8 * (1.0 + std::abs(growth) * length)) << slack << ' ' << rise;
        Placement const at = curve(s);
        EXPECT_LT((at.axes.transpose() * at.axes - Mat3::Identity()).norm(), 1e-12);
        EXPECT_NEAR(at.axes.determinant(), 1.0, 1e-12);
        if (slack > 10.0) continue;  // the curvature at the lowest point is too large for this difference
        Vec3 const tangent = (curve(s + h).origin - curve(s - h).origin) / (2.0 * h);
        EXPECT_LT((tangent - at.axes.col(0)).norm(), 1e-5) << slack << ' ' << rise;
      }
    }
}

TEST(Catenary, RefusesWhatHangsInNoCatenary) {
  Vec3 const down(0, -1, 0);
  EXPECT_TRUE(has(refusal([&] { catenary({3, 4, 0}, 5.0, down); }), "the length of 5 m must exceed"));
  EXPECT_TRUE(has(refusal([&] { catenary({0, 4, 0}, 5.0, down); }), "the horizontal distance of the ends is 0 m"));
  EXPECT_TRUE(has(refusal([&] { catenary({3, 4, 0}, 6.0, Vec3::Zero()); }), "direction of the weight is zero"));
}

/// Coordinates of a body in its reference state.
template <class B>
VecX reference(B const& body) {
  Model<Bodies<B>, Joints<>> model;
  model.add(body);
  return model.reference_state().q;
}

// The nodes of a cable along the curve lie on it. `from` has a straight natural shape, so the arc is bent.
// `naturally_curved` has no bending moment.
TEST(Catenary, IsWhereCablesLie) {
  using Flat = planar::AncfCable<EngineeringStrain>;
  Bar const bar{.length = 3.0,
                .constants = BarConstants{.EA = 1e5, .EI = 2.0, .mass_per_length = 1.0},
                .placement = Placement::planar(0.5, -0.2, 0.3)};
  ReferenceCurve const curve = catenary({2.0, 0.4, 0.0}, 3.0, {0, -1, 0});
  Flat const laid = Flat::from(bar, 6, curve), natural = Flat::naturally_curved(bar, 6, curve);
  VecX const flat = reference(laid), space = reference(AncfCable<>::from(bar, 6, curve));
  for (Index i = 0; i <= 6; ++i) {
    EXPECT_LT((flat.segment<2>(4 * i) - space.segment<2>(6 * i)).norm(), 1e-14);
    EXPECT_LT((flat.segment<2>(4 * i + 2) - space.segment<2>(6 * i + 3)).norm(), 1e-14);
  }
  EXPECT_TRUE(flat == reference(natural));
  std::span<double const> const q(flat.data(), std::size_t(flat.size()));
  EXPECT_GT(std::abs(laid.section_forces(laid.at(1.2), q)[5]), 0.1);
  EXPECT_LT(std::abs(natural.section_forces(natural.at(1.2), q)[5]), 1e-12);
}

}  // namespace catenary_curve_test
}  // namespace polybody
