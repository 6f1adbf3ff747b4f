// Bar of four bricks by its matrices, through the formats of all programs (projectchrono/chrono#528: a stiffness that
// is halved). Steel bricks of 0.1 m, E = 2.1e11, ν = 0.3, ρ = 7850, 2×2×2 Gauss points, consistent mass. The folder
// bar_of_bricks has the matrices of an independent program, and the files that CalculiX 2.20 writes for one brick of 1
// m.

#include <gtest/gtest.h>

#include <polybody/fe_matrices.hpp>
#include <polybody/ffr.hpp>

#include "support/fe_files.hpp"
#include "support/held.hpp"

namespace polybody {
namespace bar_of_bricks_test {

std::string file(char const* name) { return std::string(POLYBODY_BRICK_FILES "/") + name; }
double const bar_mass = 31.4;  // 4 · 0.1³ · 7850

FeModel const& bar() {
  static FeModel const model = [] {
    FeNodes const n = read_plain_nodes(file("bar4_nodes.txt"));
    return FeModel{n, read_matrix_market(file("bar4_M.mtx"), n), read_matrix_market(file("bar4_K.mtx"), n)};
  }();
  return model;
}

/// The bar in the format of each program, after a way through files.
struct Way {
  char const* name;
  std::function<FeModel(FeFiles const&)> read;
};

FeModel abaqus(FeFiles const& files, bool coordinates) {
  auto const text = coordinates ? fe::abaqus_coordinates : fe::abaqus_labels;
  FeNodes const n = read_abaqus_nodes(files.put("bar.inp", fe::abaqus_nodes(bar().nodes.positions)));
  return {n, read_abaqus_matrix(files.put("bar_MASS1.mtx", text(bar().mass.entries)), n),
          read_abaqus_matrix(files.put("bar_STIF1.mtx", text(bar().stiffness.entries)), n)};
}
FeModel dmig(FeFiles const& files, bool free) {
  auto const grids = free ? fe::grid_free : fe::grid_large;
  auto const matrix = free ? fe::dmig_free : fe::dmig_large;
  FeNodes const n = read_nastran_nodes(files.put("bar.bdf", grids(bar().nodes.positions)));
  std::string const both =
      files.put("bar.pch", matrix(bar().stiffness.entries, "KAAX") + matrix(bar().mass.entries, "MAAX"));
  return {n, read_dmig_matrix(both, "MAAX", n), read_dmig_matrix(both, "KAAX", n)};
}
FeModel op4(FeFiles const& files, fe::Op4 layout, Index components, Index words) {
  FeNodes const n = read_nastran_nodes(files.put("bar.bdf", fe::grid_free(bar().nodes.positions)));
  std::string const both = files.put("bar.op4", fe::op4(bar().stiffness.entries, "KGG", layout, components, words) +
                                                    fe::op4(bar().mass.entries, "MGG", layout, components, words));
  return {n, read_op4_matrix(both, "mgg", n), read_op4_matrix(both, "KGG", n)};
}
FeModel calculix(FeFiles const& files) {
  FeNodes const n = read_calculix_nodes(files.put("bar.inp", fe::abaqus_nodes(bar().nodes.positions)));
  std::string const dof = files.put("bar.dof", fe::calculix_dof(n.size()));
  return {n, read_calculix_matrix(files.put("bar.mas", fe::calculix_triangle(bar().mass.entries)), dof, n),
          read_calculix_matrix(files.put("bar.sti", fe::calculix_triangle(bar().stiffness.entries)), dof, n)};
}
FeModel ansys(FeFiles const& files, bool list) {
  auto const text = list ? fe::nlist : fe::nblock;
  FeNodes const n = read_ansys_nodes(files.put("bar.cdb", text(bar().nodes.positions)));
  std::string const mapping = files.put("bar.mapping", fe::ansys_mapping(n.size()));
  return {n, read_ansys_matrix(files.put("bar_m.matrix", fe::harwell_boeing(bar().mass.entries)), mapping, n),
          read_ansys_matrix(files.put("bar_k.matrix", fe::harwell_boeing(bar().stiffness.entries)), mapping, n)};
}

std::vector<Way> const ways = {
    {"Matrix Market", [](FeFiles const&) { return bar(); }},
    {"Abaqus, MATRIX INPUT", [](FeFiles const& f) { return abaqus(f, false); }},
    {"Abaqus, COORDINATE", [](FeFiles const& f) { return abaqus(f, true); }},
    {"Nastran DMIG, large field", [](FeFiles const& f) { return dmig(f, false); }},
    {"Nastran DMIG, free field", [](FeFiles const& f) { return dmig(f, true); }},
    {"Nastran OP4, dense", [](FeFiles const& f) { return op4(f, fe::Op4::dense, 6, 2); }},
    {"Nastran OP4, strings", [](FeFiles const& f) { return op4(f, fe::Op4::strings, 6, 2); }},
    {"Nastran OP4, wide strings", [](FeFiles const& f) { return op4(f, fe::Op4::wide_strings, 3, 1); }},
    {"CalculiX", calculix},
    {"Ansys, NBLOCK", [](FeFiles const& f) { return ansys(f, false); }},
    {"Ansys, NLIST", [](FeFiles const& f) { return ansys(f, true); }},
};

Claim claim(char const* what, By by, char const* source, Way const& way) {
  return {"bar of four bricks", what, by, source, std::string("Ffr, files of ") + way.name};
}

// Free frequencies with all modes kept. The references are those of bar4 in an independent program.
TEST(BarOfBricks, HasItsMassAndFrequenciesThroughEveryFormat) {
  double const reference[] = {23048.4111, 23048.4111, 25844.3572, 41747.4934, 55558.2775};
  FeFiles const files("bar_frequencies");
  for (Way const& way : ways) {
    FeModel const model = way.read(files);
    held(claim("mass of the bar [kg]", By::closed_form, "4 · 0.1³ · 7850", way), check_matrices(model, bar_mass).mass,
         bar_mass, 1e-8 * bar_mass);
    Structure const s = structure_of(model, bar_mass);
    Ffr const body(s, free_interface_modes(s, s.size() - 6));
    ASSERT_EQ(body.deformations(), 54) << way.name;
    for (Index i = 0; i < 5; ++i)
      held(claim("free frequencies of the bar [rad/s]", By::independent, "eigenvalues of K and M, NumPy", way),
           std::sqrt(body.integrals().stiffness(i, i) / body.integrals().mass_matrix(i, i)), reference[i],
           1e-8 * reference[i], {equals("mode", double(i + 1))});
  }
}

// Pulled by ±1e5 N, spread over the end faces: F l/(E A) = 1e5 · 0.4/(2.1e11 · 0.01), thinner by ν F b/(E A). The
// element passes the patch test, so that the result is exact.
TEST(BarOfBricks, StretchesAndThinsByTheClosedForm) {
  double const longer = 1e5 * 0.4 / (2.1e11 * 0.01), thinner = 0.3 * 1e5 * 0.1 / (2.1e11 * 0.01);
  FeFiles const files("bar_stretch");
  for (Way const& way : ways) {
    Structure const s = structure_of(way.read(files), bar_mass);
    Ffr const body(s, free_interface_modes(s, s.size() - 6));
    VecX load = VecX::Zero(body.deformations());
    for (Index i = 0; i < 4; ++i) load += 0.25e5 * (body.node(16 + i).S - body.node(i).S).row(0).transpose();
    VecX const q = body.integrals().stiffness.ldlt().solve(load);
    auto const apart = [&](Index a, Index b) -> Vec3 { return (body.node(b).S - body.node(a).S) * q; };
    held(claim("growth of the pulled bar [m]", By::closed_form, "F l/(E A)", way), apart(0, 16)[0], longer,
         1e-6 * longer);
    held(claim("loss of width of the pulled bar [m]", By::closed_form, "ν F b/(E A)", way), -apart(8, 9)[1], thinner,
         1e-6 * thinner);
  }
}

// K₁₁ of one brick of 1 m, from the files of CalculiX 2.20. 2×2×2 Gauss points give 49358974358.97 N/m (the thread).
// Half of this value was the fault of the thread: it is a stiffness of another solid, whose waves are slower by √2.
TEST(BarOfBricks, BrickOfCalculixHasTheStiffnessOfTheThread) {
  for (char const* const nodes : {"brick.inp", "brick.frd"}) {
    FeNodes const n = read_calculix_nodes(file(nodes));
    FeModel const brick{n, read_calculix_matrix(file("brick.mas"), file("brick.dof"), n),
                        read_calculix_matrix(file("brick.sti"), file("brick.dof"), n)};
    held({"bar of four bricks", "K₁₁ of a brick of 1 m [N/m]", By::independent, "2×2×2 Gauss points, NumPy",
          std::string("files of CalculiX 2.20, ") + nodes},
         brick.stiffness.entries.coeff(0, 0), 49358974358.97, 0.01);
    EXPECT_NEAR(check_matrices(brick, 7850.0).mass, 7850.0, 1e-8);
    EXPECT_TRUE(check_matrices(brick, 7850.0).remarks.empty());
  }
}

}  // namespace bar_of_bricks_test
}  // namespace polybody
