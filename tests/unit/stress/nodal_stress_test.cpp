// Stress at named nodes of the M113's steel link, with matrices and stresses of CalculiX 2.20
// (examples/track_stress/fe_link). References are CalculiX's own values, exact states, and beams. Refused input.
#include <polybody/stress/nodal_stress.hpp>

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/ffr/matrix_structure.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/stress/decoupled_stress.hpp>

#include "m113/links.hpp"
#include "support/held.hpp"
#include "support/number_rows.hpp"
#include "support/refusal.hpp"

namespace polybody {
namespace nodal_stress_test {

std::string file(char const* name) {
  std::string path = POLYBODY_FE_LINK_FILES "/link.";
  return path.append(name);
}
Structure const& link() {
  static Structure const s = read_structure(file("mass.mtx"), file("stiffness.mtx"), file("nodes.txt"));
  return s;
}
NodalStress const& stress() {
  static NodalStress const s = NodalStress::read(file("stress.mtx"), file("stress_nodes.txt"), link().size());
  return s;
}

double const young = m113::youngs_modulus, shear = m113::shear_modulus, poisson = 0.5 * young / shear - 1.0,
             length = m113::pitch, width = m113::cable_width, height = m113::cable_height;

/// Nodal displacements of the field u(r).
template <class Field>
VecX displacements(Field const& u) {
  VecX e(link().size());
  for (std::size_t i = 0; i < link().nodes.size(); ++i) e.segment<3>(3 * Index(i)) = u(link().nodes[i]);
  return e;
}

/// Load case of CalculiX: the rear face is clamped, tension and lift act on the front face.
struct LoadCase {
  double pull = 0.0, lift = 0.0;
  VecX displacements = VecX::Zero(link().size());
  std::vector<Vec6> stress;  ///< at the named nodes

  LoadCase() {
    auto const rows = number_rows(file("reference_load.txt"));
    std::size_t const nodes = link().nodes.size();
    EXPECT_EQ(rows.size(), 1 + nodes + nodal_stress_test::stress().spots().size());
    pull = rows.at(0).at(0);
    lift = rows.at(0).at(1);
    for (std::size_t i = 0; i < nodes; ++i)
      for (std::size_t k = 0; k < 3; ++k) displacements[Index(3 * i + k)] = rows.at(1 + i).at(k);
    for (std::size_t i = 1 + nodes; i < rows.size(); ++i) stress.emplace_back(Vec6(Vec6::Map(rows[i].data())));
  }
};

// Blocks are integrated exactly. CalculiX's input gives the nodes to a nanometre.
TEST(FeLink, HasMassAndInertiaOfTheTracksLink) {
  m113::Solid const steel = m113::with_steel_links().link;
  Structure const& s = link();
  Mat3 const inertia = s.second.trace() * Mat3::Identity() - s.second;
  Vec3 const expected = steel.inertia;
  std::vector<double> const printed = numbers_of(file("reference.txt"));
  EXPECT_NEAR(s.mass, steel.mass, 1e-6 * steel.mass);
  EXPECT_NEAR(s.mass, printed.at(0), 1e-6 * s.mass);
  EXPECT_LT(s.first.norm(), 1e-9 * s.mass * length);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(inertia(k, k), expected[k], 1e-6 * expected[k]);
    EXPECT_NEAR(inertia(k, k), printed.at(std::size_t(1 + k)), 1e-6 * expected[k]);
  }
  EXPECT_LT(MatX(inertia - Mat3(inertia.diagonal().asDiagonal())).norm(), 1e-9 * inertia.norm());
}

MatX const& free_modes() {
  static MatX const shapes = free_interface_modes(link(), 8);
  return shapes;
}

TEST(FeLink, HasTheFrequenciesThatCalculixPrints) {
  std::vector<double> const printed = numbers_of(file("reference.txt"));
  ASSERT_EQ(printed.size(), 4u + 14u);
  MatX const& shapes = free_modes();
  MatX const k = shapes.transpose() * (link().stiffness * shapes),
             m = shapes.transpose() * (link().mass_matrix() * shapes);
  for (Index i = 0; i < 8; ++i)
    held({"CalculiX 2.20", "frequencies of the free link of the M113's track [rad/s]", By::independent,
          "what CalculiX prints, 7 digits", "its CalculiX matrices, free-interface modes"},
         std::sqrt(k(i, i) / m(i, i)), printed[std::size_t(10 + i)], 1e-6 * printed[std::size_t(10 + i)],
         {equals("mode", double(i + 1))});
}

// CalculiX extrapolates stresses from the integration points and averages over the elements of a node. The operator
// evaluates them at the node. The difference is 2.1e-5 of the largest stress, due to the 7 digits of the
// displacements.
TEST(NodalStress, IsWhatCalculixFinds) {
  LoadCase const given;
  double largest = 0.0;
  for (Vec6 const& s : given.stress) largest = std::max(largest, s.cwiseAbs().maxCoeff());
  VecX const all = stress().of(given.displacements);
  for (std::size_t i = 0; i < given.stress.size(); ++i) {
    std::string const& name = stress().spots()[i].name;
    std::vector<Vec6> const one = stress().of(name, given.displacements);
    ASSERT_EQ(one.size(), 1u);
    EXPECT_EQ(one[0], all.segment<6>(6 * Index(i)));
    held_within({"CalculiX 2.20", "stress of the M113's link, clamped, pulled and bent [Pa]", By::independent,
                 "what CalculiX extrapolates to the node", "its CalculiX matrices, NodalStress"},
                (one[0] - given.stress[i]).cwiseAbs().maxCoeff(), 1e-4 * largest, {name, largest});
  }
  // The matrices represent that load: its resultant is on the front face, without forces between the faces.
  VecX const force = link().stiffness * given.displacements;
  Vec3 front = Vec3::Zero();
  double between = 0.0;
  for (std::size_t i = 0; i < link().nodes.size(); ++i) {
    double const x = link().nodes[i][0];
    if (x > 0.499 * length)
      front += force.segment<3>(3 * Index(i));
    else if (x > -0.499 * length)
      between = std::max(between, force.segment<3>(3 * Index(i)).norm());
  }
  EXPECT_LT((front - Vec3(given.pull, 0, given.lift)).norm(), 1e-3 * given.pull);
  EXPECT_LT(between, 1e-3 * given.pull);
}

// N/A ± M c/I. The clamp prevents the lateral contraction of the link, which is 2.5 times as wide as long. The effect
// is 1.9 % in the middle and 0.9 % at a third of the distance to the front.
TEST(NodalStress, IsThatOfABeamFarFromTheClamp) {
  LoadCase const given;
  for (auto const& [place, x] : {std::pair("middle", 0.0), std::pair("third", length / 6.0)}) {
    double const axial = given.pull / (width * height),
                 bending = given.lift * (0.5 * length - x) / (width * height * height / 6.0);
    for (auto const& [side, sign] : {std::pair(", wheel side", -1.0), std::pair(", ground side", 1.0)})
      held({"CalculiX 2.20", "axial stress of the M113's link, clamped, pulled and bent [Pa]", By::closed_form,
            "beam, N/A ± M c/I", "its CalculiX matrices, NodalStress"},
           stress().of(std::string(place) + side, given.displacements)[0][0], axial + sign * bending,
           0.02 * (axial + bending), {std::string(place) + side});
  }
}

// Elements with quadratic shapes represent these states, so any error is due to the operator.
TEST(NodalStress, IsExactForUniformStrainAndPureBending) {
  double const lame = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)), strain = 1e-3;
  int const first[6] = {0, 1, 2, 0, 1, 2}, second[6] = {0, 1, 2, 1, 2, 0};
  for (int k = 0; k < 6; ++k) {
    Mat3 gradient = Mat3::Zero();
    gradient(first[k], second[k]) = strain;  // including its rotation
    VecX const e = displacements([&](Vec3 const& r) { return Vec3(gradient * r); });
    Vec6 exact = Vec6::Zero();
    if (k < 3) exact.head<3>().setConstant(lame * strain);
    exact[k] += (k < 3 ? 2.0 : 1.0) * shear * strain;
    for (auto const& spot : stress().spots())
      EXPECT_LT((stress().of(spot.name, e)[0] - exact).norm(), 1e-6 * exact.norm()) << spot.name << ", state " << k;
  }
  double const curvature = 0.01;
  VecX const bent = displacements([&](Vec3 const& r) -> Vec3 {
    double const x = r[0], y = r[1], z = r[2];
    return curvature * Vec3(x * z, -poisson * y * z, -0.5 * (x * x + poisson * (z * z - y * y)));
  });
  for (auto const& spot : stress().spots()) {
    double const side = spot.name.ends_with("wheel side") ? 1.0 : -1.0, outer = 0.5 * young * curvature * height;
    Vec6 exact = Vec6::Zero();
    exact[0] = side * outer;
    EXPECT_LT((stress().of(spot.name, bent)[0] - exact).norm(), 1e-6 * outer) << spot.name;
  }
}

TEST(NodalStress, IsNoneOfASmallRigidMotion) {
  VecX const e = displacements([](Vec3 const& r) { return Vec3(Vec3(0.3, -0.2, 0.1) + Vec3(2, -1, 3).cross(r)); });
  EXPECT_LT(stress().of(e).norm(), 1e-8 * young);
}

TEST(NodalStress, NamesNodesOfTheSurface) {
  EXPECT_EQ(stress().spots().size(), 9u);
  auto const at = [](std::string_view name) {
    for (auto const& spot : stress().spots())
      if (spot.name == name) return link().nodes[std::size_t(spot.node)];
    return Vec3(Vec3::Constant(NAN));
  };
  EXPECT_LT((at("middle, wheel side") - Vec3(0, 0, 0.5 * height)).norm(), 1e-8);
  EXPECT_LT((at("middle edge, wheel side") - Vec3(0, 0.5 * width, 0.5 * height)).norm(), 1e-8);
  EXPECT_LT((at("front eye edge, ground side") - Vec3(length / 3, -0.5 * width, -0.5 * height)).norm(), 1e-8);
  EXPECT_LT((at("rear eye, wheel side") - Vec3(-length / 3, 0, 0.5 * height)).norm(), 1e-8);
}

TEST(NodalStress, OfModesIsThatOfTheirDisplacements) {
  MatX const shapes = free_modes().leftCols(6), q = MatX::Random(6, 5) * 1e-4;
  NodalStress const modal = stress().modal(shapes);
  EXPECT_EQ(modal.matrix().rows(), 54);
  EXPECT_EQ(modal.coordinates(), 6);
  MatX const expected = stress().of(shapes * q);
  EXPECT_LT((modal.of(q) - expected).norm(), 1e-10 * expected.norm());
  std::vector<Vec6> const third = modal.of("third, wheel side", q);
  std::vector<double> const mises = modal.von_mises("third, wheel side", q);
  ASSERT_EQ(third.size(), 5u);
  ASSERT_EQ(mises.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_LT((third[i] - expected.col(Index(i)).segment<6>(6 * 4)).norm(), 1e-10 * expected.norm());
    EXPECT_EQ(mises[i], von_mises(third[i]));
  }
  EXPECT_TRUE(has(refusal([&] { modal.of(shapes * q); }), "have 945 rows, but the stress matrix has 6 columns"));
  EXPECT_TRUE(
      has(refusal([&] { stress().modal(q); }), "the shapes have 6 rows, but the stress matrix has 945 columns"));
}

// Rigid link rotating about the direction of its pins. The mean stress in a section is ½ ρω² (p²/4 − x²). The surface
// at y = 0 differs from the mean by 0.05 %. The stress is independent of the fixed nodes.
TEST(NodalStress, AfterARigidRunIsTheCentrifugalOne) {
  Model<Bodies<Rigid<>>, Joints<>, Forces<>> model;
  auto const body = model.add(Rigid<>::from(m113::link_bar()), "link");
  double const omega = 300.0;
  State x = model.reference_state();
  model.set_velocity(x, body, Vec3::Zero(), Vec3(0, omega, 0));
  LoadRecorder recorder(model);
  recorder.add(body);
  for (State const& now : simulate(model, x, RungeKutta4<Projection>{}, {.end_time = 2e-4, .step = 1e-4}))
    recorder.record(now);
  auto const decoupled = DecoupledStress::quasi_static(link(), recorder.of(body));
  MatX const& e = decoupled.displacements();
  double const half = 0.5 * length, full = 0.5 * m113::density * omega * omega * half * half;
  for (auto const& [name, at] :
       {std::pair("middle, wheel side", 0.0), std::pair("middle, ground side", 0.0),
        std::pair("third, ground side", length / 6.0), std::pair("third, wheel side", length / 6.0)}) {
    std::vector<Vec6> const history = stress().of(name, e);
    ASSERT_EQ(history.size(), 3u);
    for (Vec6 const& s : history)
      held({"thesis §4.3", "axial stress of a spinning link of solid elements [Pa]", By::closed_form,
            "½ ρω² (p²/4 − x²)", "Rigid, quasi-static, NodalStress"},
           s[0], full * (1.0 - at * at / (half * half)), 0.002 * full, {name});
  }
  ReferenceConditions hold = ReferenceConditions::none();
  for (int k = 0; k < 3; ++k) hold.fix(0, k);
  auto const on_nodes =
      DecoupledStress::quasi_static(link(), recorder.of(body), {}, hold.fix(3, 2).fix(3, 0).fix(1, 2));
  MatX const s = stress().of(e);
  EXPECT_GT((on_nodes.displacements() - e).norm(), 0.1 * e.norm());
  EXPECT_LT((stress().of(on_nodes.displacements()) - s).norm(), 1e-8 * s.norm());
}

TEST(VonMises, OfKnownStates) {
  auto const of = [](double xx, double yy, double zz, double xy, double yz, double zx) {
    Vec6 s;
    s << xx, yy, zz, xy, yz, zx;
    return von_mises(s);
  };
  double const s = 3e6;
  EXPECT_NEAR(of(s, 0, 0, 0, 0, 0), s, 1e-9 * s);
  EXPECT_NEAR(of(0, -s, 0, 0, 0, 0), s, 1e-9 * s);
  EXPECT_NEAR(of(0, 0, s, 0, 0, 0), s, 1e-9 * s);
  EXPECT_NEAR(of(0, 0, 0, s, 0, 0), std::sqrt(3.0) * s, 1e-9 * s);
  EXPECT_NEAR(of(0, 0, 0, 0, s, 0), std::sqrt(3.0) * s, 1e-9 * s);
  EXPECT_NEAR(of(0, 0, 0, 0, 0, -s), std::sqrt(3.0) * s, 1e-9 * s);
  EXPECT_EQ(of(s, s, s, 0, 0, 0), 0.0);
  EXPECT_NEAR(of(s, -s, 0, 0, 0, 0), std::sqrt(3.0) * s, 1e-9 * s);  // shear in axes at 45°
}

/// Two files in a folder of this process.
class NodalStressFiles : public testing::Test {
 protected:
  NodalStressFiles() {
    std::filesystem::create_directories(folder);
    put(matrix, "%%MatrixMarket matrix coordinate real general\n12 6 2\n1 1 5.0\n12 6 -7.0\n");
    put(names, "# node name\n1  the far end \n\n0 near\n");
  }
  ~NodalStressFiles() override { std::filesystem::remove_all(folder); }
  static void put(std::string const& path, std::string const& text) { std::ofstream(path) << text; }
  std::string told(std::string const& path, std::string const& text, Index coordinates = 6) {
    put(path, text);
    return message_of<IoError>([&] { NodalStress::read(matrix, names, coordinates); });
  }

  std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / ("polybody nodal stress " + std::to_string(::getpid()));
  std::string matrix = (folder / "stress.mtx").string(), names = (folder / "names.txt").string();
};

TEST_F(NodalStressFiles, AreReadInTheOrderOfTheNames) {
  NodalStress const s = NodalStress::read(matrix, names, 6);
  ASSERT_EQ(s.spots().size(), 2u);
  EXPECT_EQ(s.spots()[0].name, "the far end");
  EXPECT_EQ(s.spots()[0].node, 1);
  EXPECT_EQ(s.spots()[1].name, "near");
  EXPECT_EQ(s.spots()[1].node, 0);
  VecX const e = VecX::LinSpaced(6, 1.0, 6.0);
  EXPECT_EQ(s.of("the far end", e)[0], Vec6(5.0 * Vec6::Unit(0)));
  EXPECT_EQ(s.of("near", e)[0], Vec6(-42.0 * Vec6::Unit(5)));
}

TEST_F(NodalStressFiles, ThatAreBrokenAreNamedByFileAndLine) {
  std::string const in_names = names + ", line ", in_matrix = matrix + ", line ";
  EXPECT_TRUE(
      has(told(names, "1 end\n2 beyond\n"), in_names + "2: node 2 does not exist; the structure has nodes 0 to 1"));
  EXPECT_TRUE(has(told(names, "-1 end\n"), in_names + "1: node -1 does not exist"));
  EXPECT_TRUE(has(told(names, "0 end\n1 end\n"), in_names + "2: duplicate node name \"end\""));
  EXPECT_TRUE(has(told(names, "0\n"), in_names + "1: \"0\" is not the number of a node and its name"));
  EXPECT_TRUE(has(told(names, "end\n"), in_names + "1: \"end\" is not the number"));
  EXPECT_TRUE(has(told(names, "# none\n"), in_names + "2: the file names no nodes"));
  EXPECT_TRUE(has(told(names, "0 near\n"), in_matrix + "2: the matrix is 12×6, but the 1 nodes of " + names +
                                               " need 6×6, six stresses per node"));
  put(names, "1 far\n0 near\n");
  std::string const banner = "%%MatrixMarket matrix coordinate real general\n";
  EXPECT_TRUE(has(told(matrix, banner + "12 6 1\n13 1 5.0\n"),
                  in_matrix + "3: entry (13, 1) is outside the matrix, whose rows are 1 to 12 and columns 1 to 6"));
  EXPECT_TRUE(has(told(matrix, banner + "12 6 1\n12 7 5.0\n"), in_matrix + "3: entry (12, 7) is outside"));
  EXPECT_TRUE(has(told(matrix, banner + "12 6 2\n7 1 5.0\n7 1 5.0\n"), in_matrix + "4: entry (7, 1) occurs a second"));
  EXPECT_TRUE(has(told(matrix, banner + "12 6 2\n7 1 5.0\n"), in_matrix + "4: the file ends after 1 of 2 entries"));
  EXPECT_TRUE(has(told(matrix, "%%MatrixMarket matrix coordinate real symmetric\n12 6 1\n1 1 5.0\n"),
                  in_matrix + "2: a symmetric matrix has as many rows as columns"));
  std::filesystem::remove(matrix);
  EXPECT_TRUE(
      has(message_of<IoError>([&] { NodalStress::read(matrix, names, 6); }), matrix + ": the file cannot be opened"));
}

TEST_F(NodalStressFiles, ThatDoNotFitTheQuestionAreRefused) {
  NodalStress const s = NodalStress::read(matrix, names, 6);
  VecX const e = VecX::Zero(6);
  EXPECT_TRUE(has(refusal([&] { s.of("nearly", e); }),
                  "no node is called \"nearly\". The named nodes are \"the far end\", \"near\"."));
  EXPECT_TRUE(has(refusal([&] { s.von_mises("", e); }), "no node is called \"\""));
  EXPECT_TRUE(
      has(refusal([&] { s.of(VecX::Zero(5)); }), "the displacements have 5 rows, but the stress matrix has 6 columns"));
  EXPECT_TRUE(has(refusal([&] { s.of("near", VecX::Zero(7)); }), "the displacements have 7 rows"));
  for (Index const n : {0, 7, -3})
    EXPECT_TRUE(has(refusal([&] { NodalStress::read(matrix, names, n); }),
                    std::to_string(n) + " coordinates are not three displacements per node"));
  NodalStress::Matrix m(6, 3);
  EXPECT_TRUE(has(refusal([&] { NodalStress(m, {}); }), "at least one node is needed"));
  EXPECT_TRUE(has(refusal([&] { NodalStress(m, {{0, "a"}, {1, "b"}}); }), "has 6 rows, but 2 nodes need 12"));
  m.insert(4, 2) = NAN;
  EXPECT_TRUE(has(refusal([&] { NodalStress(m, {{0, "a"}}); }), "row 4, column 2 of the matrix is "));
  EXPECT_TRUE(has(refusal([&] { NodalStress(NodalStress::Matrix(12, 3), {{0, "a"}, {1, "a"}}); }),
                  "duplicate node name \"a\""));
}

}  // namespace nodal_stress_test
}  // namespace polybody
