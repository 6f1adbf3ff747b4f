// Checks of finite element models: each fault has its sentence, and wrong units are guessed. The model is the
// tetrahedron of four nodes with linear shape functions, E = 2.1e11, ν = 0.3, ρ = 7850, edges of 0.1 m: its mass is ρ V
// = ρ a³/6.
#include <polybody/fe_matrices.hpp>

#include <gtest/gtest.h>

#include "support/refusal.hpp"

namespace polybody {
namespace fe_checks_test {

double const edge = 0.1, total = 7850.0 * edge * edge * edge / 6.0;

FeMatrix matrix_of(char const* file, MatX const& m) { return {file, m.sparseView(), {}}; }

/// Linear tetrahedra, each with four nodes of its own.
FeModel tetrahedra(Index count) {
  Mat<double, 6, 12> b = Mat<double, 6, 12>::Zero();
  for (Index a = 0; a < 4; ++a) {
    Vec3 const slope = (a == 0 ? Vec3(-1, -1, -1) : Vec3(Vec3::Unit(a - 1))) / edge;
    for (Index k = 0; k < 3; ++k) {  // γ_xy, γ_yz, γ_zx
      b(k, 3 * a + k) = slope[k];
      b(3 + k, 3 * a + k) = slope[(k + 1) % 3];
      b(3 + k, 3 * a + (k + 1) % 3) = slope[k];
    }
  }
  Mat<double, 6, 6> law = Mat<double, 6, 6>::Zero();
  law.topLeftCorner<3, 3>().setConstant(0.3);
  law.topLeftCorner<3, 3>().diagonal().setConstant(0.7);
  law.bottomRightCorner<3, 3>().diagonal().setConstant(0.2);
  MatX const k = edge * edge * edge / 6.0 * 2.1e11 / (1.3 * 0.4) * b.transpose() * law * b;
  Index const n = 12 * count;
  MatX stiffness = MatX::Zero(n, n), mass = MatX::Zero(n, n);
  FeNodes nodes{"nodes.inp", {}, {}};
  for (Index c = 0; c < count; ++c) {
    stiffness.block(12 * c, 12 * c, 12, 12) = k;
    for (Index i = 0; i < 12; ++i)
      for (Index j = i % 3; j < 12; j += 3) mass(12 * c + i, 12 * c + j) = total / (i == j ? 10.0 : 20.0);
    for (Index a = 0; a < 4; ++a) {
      nodes.labels.push_back(4 * c + a + 1);
      nodes.positions.push_back(Vec3(double(c), 0, 0) + (a == 0 ? Vec3(0, 0, 0) : Vec3(edge * Vec3::Unit(a - 1))));
    }
  }
  return {nodes, matrix_of("m.mtx", mass), matrix_of("k.mtx", stiffness)};
}

TEST(FeChecks, ReportsMassCentreAndRigidMotions) {
  FeModel const model = tetrahedra(1);
  FeReport const report = check_matrices(model, total);
  EXPECT_NEAR(report.mass, total, 1e-14 * total);
  EXPECT_LT((report.centre - Vec3::Constant(0.25 * edge)).norm(), 1e-15);
  EXPECT_LT(report.asymmetry, 1e-15);
  for (double const force : report.rigid_forces) EXPECT_LT(force, 1e-15);
  EXPECT_GT(report.wave_speed, 2000.0);  // steel: 5172 m/s along a bar
  EXPECT_LT(report.wave_speed, 10000.0);
  EXPECT_TRUE(report.remarks.empty());
  EXPECT_NEAR(structure_of(model, total).mass, total, 1e-14 * total);
}

/// Message for a model after a change by `spoil`.
template <class Spoil>
std::string told(Spoil&& spoil, double mass = total) {
  FeModel model = tetrahedra(1);
  spoil(model);
  return refusal([&] { structure_of(model, mass); });
}

TEST(FeChecks, EachFaultNamesFileAndElement) {
  EXPECT_TRUE(has(told([](FeModel& m) { m.stiffness.entries.coeffRef(4, 0) += 1e5; }),
                  "k.mtx: the matrix is not symmetric: the entry of y of node 2 and x of node 1 is "));
  EXPECT_TRUE(has(told([](FeModel& m) { m.stiffness.entries.coeffRef(4, 4) *= 1.01; }),
                  "k.mtx: a rigid displacement along y strains the structure, most at y of node 2"));
  EXPECT_TRUE(has(told([](FeModel& m) { std::swap(m.nodes.positions[0], m.nodes.positions[3]); }),
                  "k.mtx: a rigid rotation about "));
  EXPECT_TRUE(has(told([](FeModel& m) { m.nodes.remove(4); }), "m.mtx: the matrix is 12×12 with the largest entry"));
  EXPECT_TRUE(
      has(told([](FeModel& m) { m.stiffness.entries *= 0.0; }), "k.mtx: the matrix is 12×12 with the largest entry 0"));
  EXPECT_TRUE(has(told([](FeModel&) {}, 2.0), "m.mtx: the total mass is 1.30833333 kg, but the given mass is 2 kg."));
  EXPECT_TRUE(has(told([](FeModel&) {}, -1.0), "check_matrices: the given mass must be positive, but is -1 kg."));
  EXPECT_TRUE(has(told([](FeModel& m) { m.mass.entries.coeffRef(4, 1) = m.mass.entries.coeffRef(1, 4) = 1.0; }),
                  "m.mtx, k.mtx, nodes.inp: Structure: the mass matrix has "));
  EXPECT_TRUE(has(told([](FeModel& m) { m.stiffness.entries *= -1.0; }), "or the stiffness has a negative eigenvalue"));
}

TEST(FeChecks, PartsThatAreNotConnectedAreRefused) {
  FeModel const model = tetrahedra(2);
  EXPECT_TRUE(has(refusal([&] { check_matrices(model, 2.0 * total); }), "k.mtx: more than six motions need no force"));
}

TEST(FeChecks, GuessesTheUnitsOfTheFiles) {
  auto const in_units = [](FeUnits const& u) {
    return in_si(tetrahedra(1), {1.0 / u.length, 1.0 / u.mass, 1.0 / u.force});
  };
  auto const sentence = [&](FeUnits const& u) { return refusal([&] { check_matrices(in_units(u), total); }); };
  std::string const tonnes = sentence(mm_tonne_newton);
  EXPECT_TRUE(has(tonnes,
                  "m.mtx: the total mass is 0.00130833333 kg, but the given mass is 1.30833333 kg. With the nodes "
                  "in millimetres, the masses in tonnes, the stiffness in N/mm, waves travel at "));
  EXPECT_TRUE(has(tonnes, "convert the model by in_si with FeUnits{.length = 0.001, .mass = 1000, .force = 1}."));
  EXPECT_TRUE(has(sentence(mm_kilogram_kilonewton),
                  "nodes.inp: the mean density in the box around the nodes is 1.30833333e-06 kg/m³"));
  EXPECT_TRUE(has(sentence(mm_kilogram_kilonewton), "the masses in kilograms, the stiffness in kN/mm"));
  EXPECT_TRUE(has(sentence(inch_pound_force), "With the nodes in inches"));
  EXPECT_TRUE(has(sentence({1e-3, 1.0, 1e-3}), "k.mtx: waves would travel at "));  // nodes in mm, stiffness in N/m
  EXPECT_TRUE(
      has(sentence({1e-3, 1.0, 1e-3}), "With the nodes in millimetres, the masses in kilograms, the stiffness in N/m"));
  FeReport const soft = check_matrices(in_units({1.0, 1.0, 1e3}), total);  // stiffness in N/mm
  ASSERT_EQ(soft.remarks.size(), 1u);
  EXPECT_TRUE(has(soft.remarks[0],
                  "slower than in metals. With the nodes in metres, the masses in kilograms, the "
                  "stiffness in N/mm"));
  for (FeUnits const& u : {mm_tonne_newton, mm_kilogram_kilonewton, inch_pound_force})
    EXPECT_NEAR(check_matrices(in_si(in_units(u), u), total).mass, total, 1e-12);
  EXPECT_TRUE(has(refusal([&] { in_si(tetrahedra(1), {0.0, 1.0, 1.0}); }),
                  "a unit must be positive and finite, but one is 0."));
}

}  // namespace fe_checks_test
}  // namespace polybody
