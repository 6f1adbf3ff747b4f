// Structure from matrices: a block of 8-node bricks, assembled here by Gauss quadrature. Refused input.
#include <polybody/bodies/ffr/matrix_structure.hpp>

#include <filesystem>

#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/testing/body_laws.hpp>

#include "support/refusal.hpp"

namespace polybody {
using namespace laws;
namespace matrix_structure_test {

/// n equal trilinear bricks in a row along x, from `corner`, isotropic, with the total dimensions `size`. Nodes: four
/// at x = 0, four at the next x, and so on.
struct Block {
  Index n = 2;
  Vec3 size{1.2, 0.3, 0.2}, corner{-0.4, 0.1, 0.3};
  double E = 5000.0, nu = 0.0, density = 40.0;
  std::vector<Vec3> nodes;
  MatX mass, stiffness;

  Block(Index bricks, double poisson) : n(bricks), nu(poisson) {
    for (Index i = 0; i <= n; ++i)
      for (int c = 0; c < 4; ++c)
        nodes.push_back(corner + Vec3(size[0] * double(i) / double(n), c % 2 ? size[1] : 0.0, c / 2 ? size[2] : 0.0));
    mass = stiffness = MatX::Zero(3 * Index(nodes.size()), 3 * Index(nodes.size()));
    Vec3 const h(size[0] / double(n), size[1], size[2]);
    double const point[2] = {0.5 - std::sqrt(1.0 / 12.0), 0.5 + std::sqrt(1.0 / 12.0)};  // of weight ½ each
    for (Index brick = 0; brick < n; ++brick)
      for (int g = 0; g < 8; ++g) {
        Vec3 const xi(point[g & 1], point[g >> 1 & 1], point[g >> 2]);
        double const w = h.prod() / 8.0;
        Mat<double, 6, 24> b = Mat<double, 6, 24>::Zero();
        Vec<double, 8> shape;
        for (int a = 0; a < 8; ++a) {
          Index const bits[3] = {a / 4, a % 2, a / 2 % 2};
          Vec3 f, d;
          for (int k = 0; k < 3; ++k) {
            f[k] = bits[k] ? xi[k] : 1.0 - xi[k];
            d[k] = (bits[k] ? 1.0 : -1.0) / h[k];
          }
          shape[a] = f.prod();
          Vec3 const slope(d[0] * f[1] * f[2], f[0] * d[1] * f[2], f[0] * f[1] * d[2]);
          for (int k = 0; k < 3; ++k) b(k, 3 * a + k) = slope[k];
          for (int k = 0; k < 3; ++k) {  // γ_xy, γ_yz, γ_zx
            b(3 + k, 3 * a + k) = slope[(k + 1) % 3];
            b(3 + k, 3 * a + (k + 1) % 3) = slope[k];
          }
        }
        Mat<double, 6, 6> law = Mat<double, 6, 6>::Zero();
        law.topLeftCorner<3, 3>().setConstant(nu);
        law.topLeftCorner<3, 3>().diagonal().setConstant(1.0 - nu);
        law.bottomRightCorner<3, 3>().diagonal().setConstant(0.5 - nu);
        law *= E / (1.0 + nu) / (1.0 - 2.0 * nu);
        stiffness.block<24, 24>(12 * brick, 12 * brick) += w * b.transpose() * law * b;
        for (int i = 0; i < 8; ++i)
          for (int j = 0; j < 8; ++j)
            for (int k = 0; k < 3; ++k)
              mass(12 * brick + 3 * i + k, 12 * brick + 3 * j + k) += density * w * shape[i] * shape[j];
      }
  }
  double total() const { return density * size.prod(); }
  Vec3 centre() const { return corner + 0.5 * size; }
  /// Inertia tensor about its centre: m/12 (b² + c²), …
  Mat3 inertia() const {
    Vec3 const squares = size.cwiseAbs2();
    return total() / 12.0 *
           Vec3(squares[1] + squares[2], squares[2] + squares[0], squares[0] + squares[1]).asDiagonal();
  }
  Structure structure() const { return structure_of(mass.sparseView(), stiffness.sparseView(), nodes); }
};

Index const last_face = 4;  // nodes of a face

TEST(MatrixStructure, HasTheMassPropertiesOfTheBlock) {
  Block const block(3, 0.3);
  Structure const s = block.structure();
  double const m = block.total();
  EXPECT_NEAR(s.mass, m, 1e-14 * m);
  EXPECT_LT((s.first - m * block.centre()).norm(), 1e-14 * m);
  // ∫ρ u₀u₀ᵀ = m (c cᵀ + diag(a², b², c²)/12)
  Mat3 second = m * block.centre() * block.centre().transpose();
  second.diagonal() += m / 12.0 * block.size.cwiseAbs2();
  EXPECT_LT((s.second - second).norm(), 1e-14 * m);
  EXPECT_LT((MatX(s.mass_matrix()) - block.mass).norm(), 1e-14 * block.mass.norm());
  EXPECT_LT((MatX(s.stiffness) - block.stiffness).norm(), 1e-14 * block.stiffness.norm());
}

// For e = x of the nodes (S e = u₀) or a translation, each integral is a moment of the block.
TEST(MatrixStructure, IntegralsOfKnownFieldsAreMomentsOfTheBlock) {
  Block const block(2, 0.3);
  Structure const s = block.structure();
  VecX place(s.size());
  for (std::size_t i = 0; i < s.nodes.size(); ++i) place.segment<3>(3 * Index(i)) = s.nodes[i];
  double const m = block.total();
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(s.translation[k].dot(place), s.first[Index(k)], 1e-14 * m);
    for (std::size_t l = 0; l < 3; ++l) EXPECT_NEAR(s.moment[k][l].dot(place), s.second(Index(k), Index(l)), 1e-14 * m);
  }
  for (std::size_t p = 0; p < 6; ++p)
    EXPECT_NEAR(place.dot(s.inertia[p] * place), s.second(symmetric_row[p], symmetric_column[p]), 1e-14 * m);
}

// Steel (wave speed 5100 m/s) in kilograms and N/m. Nodes in millimetres have the same rigid motions, but the wave
// speed is 1000 times as large.
TEST(MatrixStructure, RefusesNodesInMillimetresBesideAStiffnessInMetres) {
  Block block(3, 0.3);
  block.mass *= 7850.0 / block.density;
  block.stiffness *= 2.1e11 / block.E;
  EXPECT_NO_THROW(block.structure());
  for (Vec3& node : block.nodes) node *= 1e3;
  std::string const message = refusal([&] { block.structure(); });
  EXPECT_TRUE(has(message, "nodes, masses and stiffness have inconsistent units: waves would travel at ")) << message;
  EXPECT_TRUE(has(message, "Give nodes in metres")) << message;
  EXPECT_NO_THROW(structure_of(block.mass.sparseView(), block.stiffness.sparseView(), block.nodes, 1e8));
}

// ν = 0: the face x = 0 is fixed, and F is distributed over the opposite face. The solution u_x = F x/EA is in the
// span of the elements.
TEST(MatrixStructure, StretchesAsABar) {
  Block const block(3, 0.0);
  Structure const s = block.structure();
  ReferenceConditions face;
  for (Index i = 0; i < 4; ++i)
    for (int c = 0; c < 3; ++c) face.fix(i, c);
  double const force = 7.0, stretch = force * block.size[0] / (block.E * block.size[1] * block.size[2]);
  auto const tip = [&](Ffr const& body) {
    VecX load = VecX::Zero(body.deformations());
    for (Index i = 0; i < last_face; ++i) load += 0.25 * force * body.node(12 + i).S.row(0).transpose();
    VecX const q = body.integrals().stiffness.ldlt().solve(load);
    for (Index i = 0; i < last_face; ++i)
      EXPECT_LT((body.node(12 + i).S * q - Vec3(stretch, 0.0, 0.0)).norm(), 1e-12 * stretch);
  };
  tip(Ffr(s, nodal_coordinates(s, face)));
  tip(Ffr(s, fixed_interface_modes(s, 36, face)));
}

// Static shapes of Craig & Bampton for both faces contain the stretch exactly. In mean axes the distance of the ends
// grows by F L/EA.
TEST(MatrixStructure, CraigBamptonStretchesAsABar) {
  Block const block(3, 0.0);
  Structure const s = block.structure();
  Ffr const body(s, craig_bampton(s, {0, 1, 2, 3, 12, 13, 14, 15}, 2, true));
  EXPECT_EQ(body.deformations(), 8 * 3 + 2 - 6);
  double const force = 7.0, stretch = force * block.size[0] / (block.E * block.size[1] * block.size[2]);
  VecX load = VecX::Zero(body.deformations());
  for (Index i = 0; i < 4; ++i) load += 0.25 * force * (body.node(12 + i).S - body.node(i).S).row(0).transpose();
  VecX const q = body.integrals().stiffness.ldlt().solve(load);
  for (Index i = 0; i < 4; ++i)
    EXPECT_LT(((body.node(12 + i).S - body.node(i).S) * q - Vec3(stretch, 0.0, 0.0)).norm(), 1e-11 * stretch);
}

TEST(MatrixStructure, AFrameIsNotTiedToANodeWithoutRotations) {
  Structure const s = Block(2, 0.3).structure();
  EXPECT_TRUE(has(refusal([&] { craig_bampton(s, {0, 11}, 0); }), "Set mean_axes"));
  EXPECT_TRUE(has(refusal([&] { fixed_interface_modes(s, 2); }), "Fix enough coordinates"));
}

// --- law tests of bodies that require no Bar ---------------------------------------------------------------

struct BlockCase {
  static Bar bar() {
    Block const block(2, 0.3);
    double const m = block.total() / block.size[0];
    return {.length = block.size[0],
            .constants = BarConstants{.EA = 1.0, .EI = 1.0, .mass_per_length = m, .GJ = 1.0, .rotary_inertia = 1.0}};
  }
  static Placement place() { return Placement::at({0.4, -0.3, 0.2}, {0.3, -0.5, 0.9}); }
  static Ffr body(Bar const&) {
    Structure const s = Block(2, 0.3).structure();
    return Ffr(s, free_interface_modes(s, 8), {.placement = place(), .stiffness_damping = 0.01});
  }
  static constexpr double deformation = 0.1;
};

struct MatrixBody : testing::Test, BodyLaws<BlockCase> {
  Block const block{2, 0.3};
};

TEST_F(MatrixBody, MassIsSymmetricAndPositive) {
  MatX const m = mass(configuration());
  EXPECT_LT(mismatch(m, m.transpose()), 1e-15);
  EXPECT_GT(smallest_pivot(m), 1e-6 * m.diagonal().maxCoeff());
}

TEST_F(MatrixBody, InertiaIsMassTimesAcceleration) {
  VecX const q = configuration(), a = velocities();
  EXPECT_LT(mismatch(inertia<double>(q, a), mass(q) * a), 1e-14);
}

TEST_F(MatrixBody, TangentIsTheDerivativeOfTheForce) {
  VecX const q = configuration(), v = velocities();
  MatX by_position(nv, nv), by_speed(nv, nv);
  for (Index j = 0; j < nv; ++j) {
    by_position.col(j) = epsilon_of(force<D>(carried(q, VecX::Unit(nv, j)), v.cast<D>()));
    by_speed.col(j) = epsilon_of(force<D>(q.cast<D>(), along(v, VecX::Unit(nv, j))));
  }
  EXPECT_LT(mismatch(tangent(q, v, 1.0, 0.0), -by_position), 1e-12);
  EXPECT_LT(mismatch(tangent(q, v, 0.0, 1.0), -by_speed), 1e-12);
}

// Kinetic energy ½ m v_c² + ½ Ωᵀ J Ω of a rigid motion of the undeformed block.
TEST_F(MatrixBody, MovesRigidlyAsTheBlock) {
  VecX const q = reference();
  Vec3 const v0 = vector3(), omega = vector3();
  Mat3 const axes = BlockCase::place().axes;
  Vec3 const centre = BlockCase::place().origin + axes * block.centre(), own = axes.transpose() * omega;
  double const expected =
      0.5 * block.total() * (v0 + omega.cross(centre)).squaredNorm() + 0.5 * own.dot(block.inertia() * own);
  EXPECT_NEAR(kinetic_energy(q, rigid_velocity(q, v0, omega)), expected, 1e-13 * expected);
}

// p · v₀ + l · ω of the free body is constant in any deformation, including damping: (rigid motion)ᵀ M v.
TEST_F(MatrixBody, KeepsItsMomentum) {
  VecX const q = configuration(), v = velocities();
  VecX const a = mass(q).ldlt().solve(force<double>(q, v));
  Vec3 const v0 = vector3(), omega = vector3();
  double const rate = slope_at_zero([&](double h) {
    VecX const at = moved<double>(q, h * v);
    return rigid_velocity(at, v0, omega).dot(mass(at) * (v + h * a));
  });
  double const size = rigid_velocity(q, v0, omega).norm() * force<double>(q, v).norm();
  EXPECT_GT(size, 1.0);
  EXPECT_LT(std::abs(rate), 1e-9 * size);
}

// --- refused input -------------------------------------------------------------------------------------------

/// Error message for the block's matrices after a change by `spoil`.
template <class Spoil>
std::string told(Spoil&& spoil) {
  Block block(2, 0.3);
  spoil(block);
  return refusal([&] { block.structure(); });
}

TEST(MatrixStructure, RefusesWhatDoesNotFit) {
  EXPECT_TRUE(has(told([](Block& b) { b.nodes.clear(); }), "no nodes"));
  EXPECT_TRUE(has(told([](Block& b) { b.nodes[7][1] = std::nan(""); }), "node 7, counted from 0, is not finite"));
  EXPECT_TRUE(has(told([](Block& b) { b.nodes.pop_back(); }),
                  "mass matrix is 36×36, but 11 nodes with three displacements each need 33×33"));
  EXPECT_TRUE(has(told([](Block& b) { b.stiffness.conservativeResize(35, 36); }), "stiffness matrix is 35×36"));
  EXPECT_TRUE(has(told([](Block& b) { b.mass(4, 7) = INFINITY; }),
                  "not finite in row 4 (y of node 1), column 7 (y of node 2)"));
  EXPECT_TRUE(has(told([](Block& b) { b.nodes[7][1] = 1e200; }), "node 7, counted from 0, is 1e+200, beyond 1e+150"));
  EXPECT_TRUE(
      has(told([](Block& b) { b.stiffness *= 1e200; }), ", beyond 1e+150, the largest allowed magnitude, in row 0"));
  EXPECT_TRUE(has(told([](Block& b) {
                    b.mass *= 1e140;
                    b.stiffness.setZero();
                    for (Vec3& r : b.nodes) r *= 1e100;
                  }),
                  "moments of mass are not finite"));
  EXPECT_TRUE(has(told([](Block& b) { b.stiffness(5, 0) *= 1.001; }),
                  "stiffness matrix is not symmetric: row 5 (z of node 1), column 0 (x of node 0)"));
  EXPECT_TRUE(has(told([](Block& b) { b.mass.triangularView<Eigen::StrictlyUpper>().setZero(); }),
                  "mass matrix is not symmetric"));
}

TEST(MatrixStructure, RefusesAMassThatIsNotOfSolidElements) {
  EXPECT_TRUE(has(told([](Block& b) { b.mass(0, 4) = b.mass(4, 0) = 0.1; }),
                  "couples different directions in row 4 (y of node 1), column 0"));
  EXPECT_TRUE(has(told([](Block& b) { b.mass(5, 5) *= 1.01; }), "row 5 (z of node 1), column 5 (z of node 1)"));
  EXPECT_TRUE(has(told([](Block& b) { b.mass = -b.mass; }), "not positive definite; its factorisation fails at node"));
  EXPECT_TRUE(has(told([](Block& b) {
                    for (Index i = 0; i < 36; ++i)
                      for (Index k = 15; k < 18; ++k) b.mass(i, k) = b.mass(k, i) = 0.0;
                  }),
                  "not positive definite; its factorisation fails at node 5"));
}

TEST(MatrixStructure, RefusesAStiffnessThatResistsRigidMotions) {
  EXPECT_TRUE(has(told([](Block& b) { std::swap(b.nodes[2], b.nodes[9]); }), "a rigid rotation about "));
  EXPECT_TRUE(has(told([](Block& b) { b.stiffness(21, 21) += 10.0; }),
                  "a rigid displacement along x strains the structure, most in row 21 (x of node 7)"));
}

// --- files -----------------------------------------------------------------------------------------------------

/// Files of the block. A symmetric matrix is stored as its lower triangle.
struct MatrixFiles : testing::Test {
  Block const block{1, 0.3};
  std::filesystem::path const folder =
      std::filesystem::path(testing::TempDir()) /
      (std::string("polybody_") + testing::UnitTest::GetInstance()->current_test_info()->name());
  std::string const mass = (folder / "m.mtx").string(), stiffness = (folder / "k.mtx").string(),
                    nodes = (folder / "nodes.txt").string();
  std::string const banner = "%%MatrixMarket matrix coordinate real symmetric";

  MatrixFiles() {
    std::filesystem::create_directories(folder);
    write(mass, lines_of(block.mass, true));
    write(stiffness, lines_of(block.stiffness, false));
    std::vector<std::string> lines = {"# x y z [m]"};
    for (Vec3 const& r : block.nodes)
      lines.push_back(text(r[0]) + "  " + text(r[1]) + " " + text(r[2]) + "  # a corner");
    write(nodes, lines);
  }
  ~MatrixFiles() override { std::filesystem::remove_all(folder); }

  static std::string text(double x) {
    char digits[40];
    std::snprintf(digits, sizeof digits, "%.17g", x);
    return digits;
  }
  static void write(std::string const& file, std::vector<std::string> const& lines) {
    std::ofstream out(file);
    for (std::string const& line : lines) out << line << '\n';
  }
  /// Lines 1 to 3: banner, comment, dimensions.
  static std::vector<std::string> lines_of(MatX const& m, bool symmetric) {
    std::vector<std::string> lines = {
        std::string("%%MatrixMarket matrix coordinate real ") + (symmetric ? "symmetric" : "General"), "% a block", ""};
    for (Index j = 0; j < m.cols(); ++j)
      for (Index i = symmetric ? j : 0; i < m.rows(); ++i)
        if (m(i, j) != 0.0) lines.push_back(std::to_string(i + 1) + " " + std::to_string(j + 1) + " " + text(m(i, j)));
    lines[2] = std::to_string(m.rows()) + " " + std::to_string(m.cols()) + " " + std::to_string(lines.size() - 3);
    return lines;
  }
  /// Error message for a mass file with another text in line `at` (from 1).
  std::string told(std::size_t at, std::string const& line) {
    std::vector<std::string> lines = lines_of(block.mass, true);
    lines[at - 1] = line;
    write(mass, lines);
    return message_of<IoError>([&] { read_structure(mass, stiffness, nodes); });
  }
};

TEST_F(MatrixFiles, HoldWhatWasWritten) {
  Structure const s = read_structure(mass, stiffness, nodes), expected = block.structure();
  EXPECT_EQ((MatX(s.mass_matrix()) - MatX(expected.mass_matrix())).norm(), 0.0);
  EXPECT_EQ((MatX(s.stiffness) - MatX(expected.stiffness)).norm(), 0.0);
  EXPECT_EQ(s.second, expected.second);
}

TEST_F(MatrixFiles, LinesEndWithLfCrLfOrCr) {
  auto const with_ends = [&](std::string const& file, std::string const& end) {
    std::ifstream in(file, std::ios::binary);
    std::string all;
    for (std::string line; std::getline(in, line);) all += line + end;
    in.close();
    std::ofstream(file, std::ios::binary) << all;
  };
  Structure const expected = block.structure();
  for (std::string const end : {"\r\n", "\r"}) {
    MatrixFiles::write(mass, lines_of(block.mass, true));
    MatrixFiles::write(stiffness, lines_of(block.stiffness, false));
    MatrixFiles::write(nodes, {"# the first four", "0 0 0", "0.3 0 0"});
    with_ends(mass, end);
    with_ends(nodes, end);
    EXPECT_TRUE(has(message_of<IoError>([&] { read_structure(mass, stiffness, nodes); }),
                    mass + ", line 3: the matrix is 24×24, but the 2 nodes of " + nodes + " need 6×6"));
    std::vector<std::string> lines{"# x y z [m]"};
    for (Vec3 const& r : block.nodes) lines.push_back(text(r[0]) + " " + text(r[1]) + " " + text(r[2]));
    MatrixFiles::write(nodes, lines);
    for (std::string const& file : {nodes, stiffness}) with_ends(file, end);
    EXPECT_EQ(read_structure(mass, stiffness, nodes).second, expected.second);
  }
}

TEST_F(MatrixFiles, BrokenMatricesAreNamedByFileAndLine) {
  std::string const where = mass + ", line ";
  EXPECT_TRUE(has(told(1, "%%MatrixMarket matrix array real general"), where + "1: the first line must be"));
  EXPECT_TRUE(has(told(1, "1 2 3"), where + "1: the first line must be"));
  EXPECT_TRUE(has(told(3, "24 24"), where + "3: \"24 24\" is not the number of rows"));
  EXPECT_TRUE(has(told(3, "27 27 108"), where + "3: the matrix is 27×27, but the 8 nodes of " + nodes + " need 24×24"));
  EXPECT_TRUE(has(told(3, "24 24 107"),
                  where + "111: \"24 24 0.10666666666666667\" is not the end of the file after 107 entries"));
  EXPECT_TRUE(has(told(3, "24 24 109"), where + "112: the file ends after 108 of 109 entries; it is truncated"));
  EXPECT_TRUE(has(told(7, "7 1"), where + "7: \"7 1\" is not a row, a column and a finite number"));
  EXPECT_TRUE(has(told(7, "7 1 nan"), where + "7: "));
  EXPECT_TRUE(has(told(7, "7 1 1e999"), where + "7: "));
  EXPECT_TRUE(has(told(7, "7 1 1.0 2.0"), where + "7: "));
  EXPECT_TRUE(has(told(111, "24 24 1.0\n\v\f\n7 1 1.0"), where + "113: \"7 1 1.0\" is not the end of the file"));
  EXPECT_TRUE(has(told(7, "7 1.5"), where + "7: \"7 1.5\" is not a row"));  // a blank ends a number
  EXPECT_TRUE(has(told(7, "7 1-2"), where + "7: "));
  EXPECT_TRUE(has(told(7, "7-1 2"), where + "7: "));
  EXPECT_TRUE(has(told(3, "24 24 -1"), where + "3: the number of entries must not be negative, but is -1"));
  EXPECT_TRUE(has(told(7, "25 1 1.0"), where + "7: entry (25, 1) is outside the matrix"));
  EXPECT_TRUE(has(told(7, "0 1 1.0"), where + "7: entry (0, 1) is outside"));
  EXPECT_TRUE(has(told(7, "1 7 1.0"), where + "7: a symmetric matrix is written by its lower triangle"));
  EXPECT_TRUE(has(told(7, "1 1 1.0"), where + "7: entry (1, 1) occurs a second time"));
}

TEST_F(MatrixFiles, TruncatedAndMissingFilesAreNamed) {
  auto const told_now = [&] { return message_of<IoError>([&] { read_structure(mass, stiffness, nodes); }); };
  write(mass, {});
  EXPECT_TRUE(has(told_now(), mass + ", line 1: the first line must be"));
  write(mass, {banner, "% no more"});
  EXPECT_TRUE(has(told_now(), mass + ", line 3: the file ends before the number of rows"));
  std::filesystem::remove(mass);
  EXPECT_TRUE(has(told_now(), mass + ": the file cannot be opened"));
  write(nodes, {"# none"});
  EXPECT_TRUE(has(told_now(), nodes + ", line 2: the file has no nodes"));
  write(nodes, {"0 0 0", "1 0"});
  EXPECT_TRUE(has(told_now(), nodes + ", line 2: \"1 0\" is not x y z of a node"));
  write(nodes, {"0 0 0", "1.5.5.5"});
  EXPECT_TRUE(has(told_now(), nodes + ", line 2: \"1.5.5.5\" is not x y z of a node"));
  write(nodes, {"0 0 0", "1 2-3"});
  EXPECT_TRUE(has(told_now(), nodes + ", line 2: \"1 2-3\" is not x y z of a node"));
  std::filesystem::remove(nodes);
  std::filesystem::create_directories(nodes);
  EXPECT_TRUE(has(told_now(), nodes + ": the file cannot be opened"));
}

TEST_F(MatrixFiles, NodesOfAnotherModelAreNamed) {
  write(nodes, {"0 0 0", "1 0 0"});
  EXPECT_TRUE(has(message_of<IoError>([&] { read_structure(mass, stiffness, nodes); }),
                  mass + ", line 3: the matrix is 24×24, but the 2 nodes of " + nodes + " need 6×6"));
}

TEST_F(MatrixFiles, MatricesThatAreRefusedAreNamed) {
  std::string const message = refusal([&] { read_structure(stiffness, mass, nodes); });
  EXPECT_TRUE(has(message, stiffness + ", " + mass + ", " + nodes + ": Structure: the mass matrix "));
}

}  // namespace matrix_structure_test
}  // namespace polybody
