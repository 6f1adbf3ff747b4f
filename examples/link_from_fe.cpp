// Body from an independent finite element program: a steel link, which is a plate with two holes. CalculiX wrote its
// mass and stiffness matrices (link_from_fe/make_matrices.sh). The program prints the mass properties and frequencies
// of the link and those that CalculiX computed. Then a flexible and a rigid link swing about a node at one hole.
//   link_from_fe --until 1
// Part of a sample run:
//   mass [kg]              1.0234856       1.0234860
//   free frequencies [Hz]  free modes        CalculiX  Craig-Bampton
//     1                      4356.5182       4356.5180      4357.2652
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <numbers>
#include <sstream>

#include <polybody/ffr.hpp>
#include <polybody/polybody.hpp>

#include "support/command_line.hpp"

using namespace polybody;

namespace {

using Hinge = Joint<Revolute, Constraint>;

struct Options {
  std::string files = POLYBODY_LINK_FILES;
  Index modes = 16;
  double end_time = 1.0;
  double step = 1e-3;
};

/// Results of CalculiX.
struct Reference {
  double mass = 0.0;
  Vec3 inertia = Vec3::Zero();
  std::vector<double> frequencies;  ///< angular frequencies [rad/s]; the first six are of rigid motions
};

Reference read_reference(std::string const& file) {
  std::ifstream in(file);
  if (!in) throw IoError(file + ": the file cannot be opened.");
  std::vector<double> numbers;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    for (double x; words >> x;) numbers.push_back(x);
  }
  if (numbers.size() < 14)
    throw IoError(file + ": the file must contain the mass, three moments of inertia and at least ten frequencies.");
  return {numbers[0], {numbers[1], numbers[2], numbers[3]}, {numbers.begin() + 4, numbers.end()}};
}

Index nearest_node(Structure const& s, Vec3 const& r) {
  auto const closer = [&](Vec3 const& a, Vec3 const& b) { return (a - r).squaredNorm() < (b - r).squaredNorm(); };
  return Index(std::min_element(s.nodes.begin(), s.nodes.end(), closer) - s.nodes.begin());
}

/// Angular frequencies of a free body in mean axes [rad/s].
std::vector<double> frequencies(Ffr const& body) {
  std::vector<double> omega;
  for (Index i = 0; i < body.deformations(); ++i)
    omega.push_back(std::sqrt(body.integrals().stiffness(i, i) / body.integrals().mass_matrix(i, i)));
  return omega;
}

/// Positions of the point `end` at tenths of the end time [m]. The body is pinned at its point `pin`, at the world
/// point `at`, and starts horizontally from rest.
template <class B, class Point>
std::vector<Vec3> swing(B const& body, Point const& pin, Point const& end, Vec3 const& at, Options const& o) {
  Model<Bodies<B>, Joints<Hinge>> model{Gravity{0, -9.81, 0}};
  auto const link = model.add(body, "link");
  model.connect(Hinge{Revolute{.axis = {0, 0, 1}}, Constraint{}}, model.ground().at(at), link.at(pin), "pin");
  State x = model.reference_state();
  std::vector<Vec3> path;
  for (auto const& now : simulate(model, x, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = o.end_time, .step = o.step}))
    if (now.t >= 0.1 * o.end_time * (double(path.size()) + 1.0) - 1e-9) path.push_back(now.position(link.at(end)));
  return path;
}

void run(Options const& o) {
  std::string const base = o.files + "/link.";
  Structure const s = read_structure(base + "mass.mtx", base + "stiffness.mtx", base + "nodes.txt");
  Reference const calculix = read_reference(base + "reference.txt");

  // 1. The body, with the static shapes of four nodes at each hole and fixed-interface modes. The floating frame
  // follows the mean motion, because nodes without rotations cannot carry a frame.
  double const centre = 0.05, radius = 0.0125;
  std::vector<Index> pins;
  for (double const x : {-centre, centre})
    for (auto const& [dx, dy] : {std::pair{-1.0, 0.0}, {1.0, 0.0}, {0.0, -1.0}, {0.0, 1.0}})
      pins.push_back(nearest_node(s, {x + dx * radius, dy * radius, 0.0}));
  Ffr const free(s, free_interface_modes(s, 8));
  Ffr const link(s, craig_bampton(s, pins, o.modes, true), {.stiffness_damping = 1e-6});

  // 2. Its mass properties and frequencies.
  FfrIntegrals const& i = link.integrals();
  Vec3 const middle = i.first / i.mass;
  std::printf("%zu nodes, %td Craig-Bampton shapes\n\n", s.nodes.size(), link.deformations());
  std::printf("                       polybody        CalculiX\n");
  std::printf("mass [kg]           %12.7f    %12.7f\n", i.mass, calculix.mass);
  for (int k = 0; k < 3; ++k)
    std::printf("J%c%c [kg m2]          %.6e    %.6e\n", "xyz"[k], "xyz"[k], i.inertia(k, k), calculix.inertia[k]);
  std::printf("centre [m]          (%.1e, %.1e, %.1e)\n\n", middle[0], middle[1], middle[2]);
  std::printf("free frequencies [Hz]  free modes        CalculiX  Craig-Bampton\n");
  std::vector<double> const all = frequencies(free), reduced = frequencies(link);
  double const turn = 2.0 * std::numbers::pi;
  for (std::size_t k = 0; k < 4; ++k)
    std::printf("  %zu                  %13.4f   %13.4f  %13.4f\n", k + 1, all[k] / turn,
                calculix.frequencies[6 + k] / turn, reduced[k] / turn);

  // 3. A flexible and a rigid pendulum about the outer node of the left hole.
  Vec3 const at = s.nodes[std::size_t(pins[0])], end = s.nodes[std::size_t(pins[5])];
  Rigid<> const rigid(i.mass,
                      i.inertia - i.mass * (middle.squaredNorm() * Mat3::Identity() - middle * middle.transpose()),
                      Placement::at(middle, Vec3::Zero()));
  std::vector<Vec3> const flexible_path = swing(link, link.node(pins[0]), link.node(pins[5]), at, o);
  std::vector<Vec3> const rigid_path = swing(rigid, Vec3(at - middle), Vec3(end - middle), at, o);
  std::printf(
      "\nits other hole, as a pendulum:\n  t [s]        flexible x, y [m]            rigid x, y [m]    apart [m]\n");
  for (std::size_t k = 0; k < flexible_path.size(); ++k)
    std::printf("  %4.2f    (%10.7f, %10.7f)  (%10.7f, %10.7f)    %.1e\n", 0.1 * o.end_time * double(k + 1),
                flexible_path[k][0], flexible_path[k][1], rigid_path[k][0], rigid_path[k][1],
                (flexible_path[k] - rigid_path[k]).norm());
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  CommandLine line{
      "Steel link from matrices of CalculiX: mass, frequencies, and motion as a flexible and as a rigid pendulum"};
  line.option("--files", &o.files,
              "folder of link.mass.mtx, link.stiffness.mtx, link.nodes.txt and link.reference.txt");
  line.not_negative("--modes", &o.modes, "number of fixed-interface modes");
  line.positive("--until", &o.end_time, "end of the run [s]");
  line.positive("--step", &o.step, "time step [s]");
  if (auto const code = line.parse(argc, argv)) return *code;
  try {
    run(o);
  } catch (Error const& e) {
    std::cerr << "link_from_fe: " << e.what() << '\n';
    return 1;
  }
}
