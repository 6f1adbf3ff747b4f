// Steel link of examples/link_from_fe. Its matrices are from CalculiX 2.20. The references are CalculiX's mass,
// moments of inertia and frequencies (link.reference.txt, made by make_matrices.sh), and the plate with two holes.

#include <gtest/gtest.h>

#include <numbers>

#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/ffr/matrix_structure.hpp>

#include "support/held.hpp"
#include "support/number_rows.hpp"

namespace polybody {
namespace link_from_fe_test {

std::string file(char const* name) {
  std::string path = POLYBODY_LINK_FILES "/link.";
  return path.append(name);
}
Structure const& link() {
  static Structure const s = read_structure(file("mass.mtx"), file("stiffness.mtx"), file("nodes.txt"));
  return s;
}
/// Mass, three moments of inertia, then frequencies.
std::vector<double> reference() { return numbers_of(file("reference.txt")); }

/// ∫1, ∫x², ∫y² about the centre of a hole. As in the elements, its edge consists of eight parabolas through the
/// circle. Green's theorem: ½∮(x dy − y dx), ⅓∮x³ dy, −⅓∮y³ dx. Four Gauss points are exact.
Vec3 hole(double radius) {
  Vec3 sum = Vec3::Zero();
  double const turn = std::numbers::pi / 4.0;
  for (int side = 0; side < 8; ++side) {
    auto const on_circle = [&](double eighths) {
      return Vec2(radius * std::cos(eighths * turn), radius * std::sin(eighths * turn));
    };
    Vec2 const a = on_circle(side), b = on_circle(side + 0.5), c = on_circle(side + 1);
    for (auto const& g : gauss<4>) {
      double const t = g.xi;
      Vec2 const r = (1 - t) * (1 - 2 * t) * a + 4 * t * (1 - t) * b + t * (2 * t - 1) * c;
      Vec2 const d = (4 * t - 3) * a + (4 - 8 * t) * b + (4 * t - 1) * c;
      sum += g.weight *
             Vec3(0.5 * (r[0] * d[1] - r[1] * d[0]), std::pow(r[0], 3) * d[1] / 3.0, -std::pow(r[1], 3) * d[0] / 3.0);
    }
  }
  return sum;
}

double const length = 0.15, width = 0.05, thickness = 0.02, off = 0.05, radius = 0.0125, density = 7850.0;

/// Mass and moments of inertia about x, y, z of the plate minus two holes with these ∫1, ∫x², ∫y².
Vec4 plate(Vec3 const& hole) {
  double const area = length * width - 2.0 * hole[0],
               xx = std::pow(length, 3) * width / 12.0 - 2.0 * (hole[1] + off * off * hole[0]),
               yy = length * std::pow(width, 3) / 12.0 - 2.0 * hole[2], zz = area * thickness * thickness / 12.0;
  return density * thickness * Vec4(area, yy + zz, xx + zz, xx + yy);
}

// Mass and centre of mass are integrated exactly. The three Gauss points of the elements neglect a term of degree
// seven around the holes in the moments of inertia.
TEST(LinkFromFe, HasTheMassPropertiesOfThePlate) {
  Structure const& s = link();
  Mat3 const inertia = s.second.trace() * Mat3::Identity() - s.second;
  Vec4 const meshed = plate(hole(radius));
  EXPECT_EQ(s.nodes.size(), 217u);
  char const *const mesh = "its CalculiX matrices, 217 nodes", *const green = "plate less holes edged by parabolas";
  held({"CalculiX 2.20", "mass of the steel link [kg]", By::closed_form, green, mesh}, s.mass, meshed[0],
       1e-9 * meshed[0]);
  EXPECT_LT(s.first.norm(), 1e-9 * s.mass * length);
  for (int k = 0; k < 3; ++k)
    held({"CalculiX 2.20", "moments of inertia of the steel link [kg m²]", By::closed_form, green, mesh}, inertia(k, k),
         meshed[1 + k], 1e-5 * meshed[1 + k], {equals("axis", k + 1)});
  EXPECT_LT(MatX(inertia - Mat3(inertia.diagonal().asDiagonal())).norm(), 1e-9 * inertia.norm());
  // The area of a round hole is larger, for each side, by π/8 − sin α cos α − ⁴⁄₃ sin α (1 − cos α), α = π/8, times
  // the radius squared.
  double const circle = std::numbers::pi * radius * radius, moment = 0.25 * circle * radius * radius;
  double const alpha = std::numbers::pi / 8.0, missing = 8.0 * radius * radius *
                                                         (alpha - std::sin(alpha) * std::cos(alpha) -
                                                          4.0 / 3.0 * std::sin(alpha) * (1.0 - std::cos(alpha)));
  EXPECT_NEAR(circle - hole(radius)[0], missing, 1e-15);
  Vec4 const round = plate({circle, moment, moment});
  held({"CalculiX 2.20", "mass of the steel link [kg]", By::closed_form,
        "plate less round holes, plus what chords cut off", mesh},
       s.mass, round[0] + 2.0 * density * thickness * missing, 1e-9 * round[0]);
  EXPECT_LT(2.0 * missing / (length * width), 2e-4);
}

TEST(LinkFromFe, HasTheMassPropertiesThatCalculixPrints) {
  std::vector<double> const expected = reference();
  Structure const& s = link();
  ASSERT_EQ(expected.size(), 4u + 14u);
  auto const claim = [](char const* what) {
    return Claim{"CalculiX 2.20", what, By::independent, "what CalculiX prints, 7 digits",
                 "its CalculiX matrices, 217 nodes"};
  };
  held(claim("mass of the steel link [kg]"), s.mass, expected[0], 5e-7 * expected[0]);
  for (int k = 0; k < 3; ++k)
    held(claim("moments of inertia of the steel link [kg m²]"), s.second.trace() - s.second(k, k),
         expected[std::size_t(1 + k)], 5e-7 * expected[std::size_t(1 + k)], {equals("axis", k + 1)});
}

TEST(LinkFromFe, HasTheFrequenciesThatCalculixPrints) {
  std::vector<double> const expected = reference();
  ASSERT_EQ(expected.size(), 4u + 14u);
  Ffr const body(link(), free_interface_modes(link(), 8));
  for (Index i = 0; i < 8; ++i) {
    double const omega = std::sqrt(body.integrals().stiffness(i, i) / body.integrals().mass_matrix(i, i));
    held({"CalculiX 2.20", "frequencies of the free steel link [rad/s]", By::independent,
          "what CalculiX prints, 7 digits", "its CalculiX matrices, free-interface modes"},
         omega, expected[std::size_t(10 + i)], 1e-6 * omega, {equals("mode", double(i + 1))});
  }
  // Mean axes: the deformation has no momentum.
  EXPECT_LT(body.integrals().first_by.norm(), 1e-8);
  EXPECT_LT(body.integrals().coupling.norm(), 1e-8);
}

// Static shapes of four nodes at each hole, and fixed-interface modes. By Rayleigh's principle every frequency is an
// upper bound and decreases with more modes. Sixteen modes give the first four frequencies to 1e-3.
TEST(LinkFromFe, CraigBamptonFindsItsFirstFrequencies) {
  std::vector<double> const expected = reference();
  ASSERT_EQ(expected.size(), 4u + 14u);
  Structure const& s = link();
  std::vector<Index> pins;
  for (std::size_t i = 0; i < s.nodes.size(); ++i) {
    Vec3 const r = s.nodes[i];
    double const x = std::abs(r[0]) - off;
    if (r[2] == 0.0 && std::abs(std::hypot(x, r[1]) - radius) < 1e-6 && (std::abs(x) < 1e-6 || std::abs(r[1]) < 1e-6))
      pins.push_back(Index(i));
  }
  ASSERT_EQ(pins.size(), 8u);
  double before[4] = {INFINITY, INFINITY, INFINITY, INFINITY};
  for (Index const count : {0, 8, 16}) {
    Ffr const body(s, craig_bampton(s, pins, count, true));
    ASSERT_EQ(body.deformations(), 8 * 3 + count - 6);
    for (Index i = 0; i < 4; ++i) {
      double const omega = std::sqrt(body.integrals().stiffness(i, i) / body.integrals().mass_matrix(i, i));
      EXPECT_LE(omega, before[i] * (1.0 + 1e-9)) << i;
      EXPECT_GT(omega, expected[std::size_t(10 + i)] * (1.0 - 1e-6)) << i;
      before[i] = omega;
    }
  }
  for (Index i = 0; i < 4; ++i)
    held({"CalculiX 2.20", "frequencies of the free steel link [rad/s]", By::independent,
          "what CalculiX prints, 7 digits", "its CalculiX matrices, Craig–Bampton with 16 modes"},
         before[i], expected[std::size_t(10 + i)], 1e-3 * expected[std::size_t(10 + i)],
         {equals("mode", double(i + 1))});
}

}  // namespace link_from_fe_test
}  // namespace polybody
