// Stress in a section: its resultants are the section forces, the surface is free of traction, and the largest values
// are those of textbooks.
#include <polybody/stress/decoupled_stress.hpp>

#include <gtest/gtest.h>

#include <polybody/math/element_functions.hpp>

#include "support/held.hpp"
#include "support/refusal.hpp"

using namespace polybody;

namespace section_stress_test {

constexpr double pi = std::numbers::pi;
Bar bar(decltype(Bar::section) const& section, double poisson = 0.3) {
  return {.length = 1.0, .section = section, .material = Material{.density = 7800, .young = 2e11, .poisson = poisson}};
}
Vec6 const forces = (Vec6() << 900.0, 700.0, -500.0, 40.0, 25.0, -35.0).finished();

/// Contribution of a stress to (N, Q_y, Q_z, M_x, M_y, M_z).
Vec6 part(SectionStress const& s, double y, double z) {
  double const xy = s.shear[0], xz = s.shear[1];
  return (Vec6() << s.axial, xy, xz, y * xz - z * xy, z * s.axial, -y * s.axial).finished();
}

// Stresses are polynomials of degree two, and their moments have degree three times r. Five radii and equal angles
// are exact.
TEST(SectionStress, OfACircleAddsUpToTheForces) {
  double const r = 0.05;
  Bar const round = bar(Circle{.radius = r}, 0.27);
  Vec6 sum = Vec6::Zero();
  for (auto const& g : gauss<5>)
    for (int k = 0; k < 16; ++k) {
      double const angle = 2 * pi * k / 16, y = r * g.xi * std::cos(angle), z = r * g.xi * std::sin(angle);
      sum += part(section_stress(round, forces, y, z), y, z) * (g.weight * r * g.xi * r * 2 * pi / 16);
    }
  held_within(
      {"closed forms", "stress of a section, integrated, less its forces, of these", By::closed_form, "0", "circle"},
      (sum - forces).norm() / forces.norm(), 1e-12, {.scale = 1.0});
}

TEST(SectionStress, LeavesTheSurfaceOfACircleFree) {
  double const r = 0.05;
  for (double const angle : {0.0, 0.4, 1.3, 2.9, 5.1}) {
    Vec2 const normal(std::cos(angle), std::sin(angle));
    SectionStress const s = section_stress(bar(Circle{.radius = r}, 0.27), forces, r * normal[0], r * normal[1]);
    EXPECT_LT(std::abs(s.shear.dot(normal)), 1e-12 * s.shear.norm());
  }
}

// The series of the torque is integrated in 16 pieces of five points in each direction. It is truncated after 30
// terms with an error of 1e-6 of a moment.
TEST(SectionStress, OfARectangleAddsUpToTheForces) {
  for (auto const& [h, w] : {std::pair(0.06, 0.02), {0.02, 0.05}, {0.03, 0.03}}) {
    Bar const flat = bar(Rectangle{.height = h, .width = w});
    Vec6 sum = Vec6::Zero();
    int const n = 16;
    for (int i = 0; i < n * n; ++i)
      for (auto const& a : gauss<5>)
        for (auto const& b : gauss<5>) {
          double const y = h * ((i % n + a.xi) / n - 0.5), z = w * ((double(i / n) + b.xi) / n - 0.5);
          sum += part(section_stress(flat, forces, y, z), y, z) * (a.weight * b.weight * h * w / (n * n));
        }
    held_within({"closed forms", "stress of a section, integrated, less its forces, of these", By::closed_form, "0",
                 "rectangles"},
                (sum - forces).norm() / forces.norm(), 1e-5, {equals("height", h), 1.0});
  }
}

// Largest shear of a torque, M_x/(k a b²), in the middle of the longer sides b: k = 0.208, 0.246, 0.267, 0.299 for
// the ratios 1, 2, 3, 6 [Timoshenko & Goodier 1970, §109, table 4], to the printed digits. It is zero in the corners.
TEST(SectionStress, OfTorqueIsTheTables) {
  Vec6 torque = Vec6::Zero();
  torque[3] = 1.0;
  for (auto const& [ratio, k] : {std::pair(1.0, 0.208), {2.0, 0.246}, {3.0, 0.267}, {6.0, 0.299}}) {
    double const b = 0.01, a = ratio * b, expected = 1.0 / (k * a * b * b);
    Vec2 const lying = section_stress(bar(Rectangle{.height = b, .width = a}), torque, 0.5 * b, 0.0).shear;
    Vec2 const standing = section_stress(bar(Rectangle{.height = a, .width = b}), torque, 0.0, 0.5 * b).shear;
    Claim const table{"Timoshenko & Goodier", "factor k of the largest shear of a torque", By::published,
                      "Timoshenko & Goodier 1970, §109, table 4", "rectangle"};
    held(table, k * expected / lying[1], k, 2.5e-3 * k, {equals("sides", ratio) + ", lying"});
    held(table, -k * expected / standing[0], k, 2.5e-3 * k, {equals("sides", ratio) + ", standing"});
    EXPECT_NEAR(lying[0], 0.0, 1e-9 * expected);
    EXPECT_NEAR(standing[1], 0.0, 1e-9 * expected);
    Vec2 const corner = section_stress(bar(Rectangle{.height = b, .width = a}), torque, 0.5 * b, 0.5 * a).shear;
    EXPECT_LT(corner.norm(), 0.02 * expected);  // 30 terms of 1/k², (8/π²) Σ_{k>60} 1/k² = 0.014
  }
}

// σ = 60, τ = 40 gives 30 ± 50, and √(3600 + 4800).
TEST(SectionStress, TellsPrincipalStressesAndVonMises) {
  SectionStress const s{.axial = 60.0, .shear = {0.0, -40.0}};
  EXPECT_NEAR(s.principal()[0], 80.0, 1e-12);
  EXPECT_NEAR(s.principal()[1], -20.0, 1e-12);
  EXPECT_NEAR(s.von_mises(), std::sqrt(8400.0), 1e-12);
}

TEST(SectionStress, RefusesPointsOutside) {
  EXPECT_TRUE(
      has(refusal([] { section_stress(bar(Circle{.radius = 0.05}), forces, 0.04, 0.04); }), "outside the circle"));
  EXPECT_TRUE(has(refusal([] { section_stress(bar(Rectangle{.height = 0.1, .width = 0.2}), forces, 0.06, 0.0); }),
                  "outside the rectangle"));
  Bar const given{.length = 1.0, .constants = BarConstants{.EA = 1, .EI = 1, .mass_per_length = 1}};
  EXPECT_TRUE(has(refusal([&] { section_stress(given, forces, 0.0, 0.0); }), "Give it a section and a material"));
}

}  // namespace section_stress_test
