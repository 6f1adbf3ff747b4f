// 5×5 grid of four-bar loops (M6b), 55 bars and 80 hinges, with the data of MBDyn's multibarmech benchmark.

#include <gtest/gtest.h>

#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/doubled_joints.hpp"
#include "support/held.hpp"
#include "support/linkages.hpp"

namespace polybody {
namespace grid_of_loops_test {

constexpr int rows = 5, columns = 5;  ///< number of loops

/// Bars of 1 m and 1 kg hang straight and rotate at 2π/3 rad/s like rigid columns. \tparam Tree policy of the hinges
/// that close no loop
template <class Tree, class Loop = Tree>
struct Grid {
  using Where = InPlane<Tree>;
  using Body = typename Where::Body;
  using Hinge = typename Where::Hinge;
  using Closing = typename InPlane<Loop>::Hinge;
  Model<Bodies<Body>, JointsOf<Hinge, Closing>> model{Gravity{0, -9.81, 0}};
  std::vector<BodyHandle<Body>> verticals, horizontals;  ///< row by row
  State x;

  Grid() {
    Link const bar = bar_link();
    for (int row = 0; row < rows; ++row) {
      for (int i = 0; i <= columns; ++i)
        verticals.push_back(model.add(Where::body(bar, Placement::planar(i, -row - 0.5, -0.5 * std::numbers::pi)),
                                      name("vertical", row, i)));
      for (int i = 0; i < columns; ++i)
        horizontals.push_back(model.add(Where::body(bar, Placement::planar(i + 0.5, -row - 1.0)), name("bar", row, i)));
    }
    for (int row = 0; row < rows; ++row) {
      for (int i = 0; i <= columns; ++i)
        if (row == 0)
          model.connect(Hinge{}, model.ground().at(Vec3(i, 0, 0)), end(row, i, -0.5), name("top", row, i));
        else
          model.connect(Hinge{}, end(row - 1, i, 0.5), end(row, i, -0.5), name("top", row, i));
      for (int i = 0; i < columns; ++i) {
        auto const across = horizontals[std::size_t(row * columns + i)];
        model.connect(Hinge{}, end(row, i, 0.5), Where::at(across, -0.5), name("left", row, i));
        model.connect(Closing{}, Where::at(across, 0.5), end(row, i + 1, 0.5), name("right", row, i));
      }
    }
    x = model.reference_state();
    double const rate = 2.0 * std::numbers::pi / 3.0;  // velocities are those of the world's origin
    for (int row = 0; row < rows; ++row) {
      for (int i = 0; i <= columns; ++i)
        model.set_velocity(x, verticals[std::size_t(row * (columns + 1) + i)], {0, -rate * i, 0}, {0, 0, rate});
      for (int i = 0; i < columns; ++i)
        model.set_velocity(x, horizontals[std::size_t(row * columns + i)], {rate * (row + 1), 0, 0}, {0, 0, 0});
    }
  }
  Grid(Grid const&) = delete;

  static std::string name(char const* what, int row, int i) {
    return std::string(what) + ' ' + std::to_string(row + 1) + ' ' + std::to_string(i + 1);
  }
  Marker<Body> end(int row, int i, double along) const {
    return Where::at(verticals[std::size_t(row * (columns + 1) + i)], along);
  }
  /// Angles of the bars of each row from the downward vertical.
  Vec<double, 5> angles() const {
    Vec<double, 5> out;
    for (int row = 0; row < rows; ++row)
      out[row] = x.q[model.entry(verticals[std::size_t(row * (columns + 1))]).q0 + 2];
    return out.array() + 0.5 * std::numbers::pi;
  }
  Vec3 corner() const { return position(model, x, end(rows - 1, 0, 0.5)); }
};

struct Row {
  double t;
  double angles[5];
  double y, z;
};
constexpr Row table[] = {
    {0.25, {0.4816359157, 0.5123520843, 0.5233304954, 0.5237261775, 0.5235824103}, 2.4533220701, -4.3559869598},
    {0.5, {0.8282761524, 0.9173684128, 0.9873758056, 1.0359283237, 1.0480966956}, 4.0921652686, -2.8438890512},
    {0.75, {0.9958835012, 1.1816124938, 1.3272148986, 1.4464160660, 1.5479039778}, 4.7269519132, -1.3113250677},
    {1, {0.9472223325, 1.2782864758, 1.5483573160, 1.7496245119, 1.9461470474}, 4.6834999754, -0.3502583167},
    {1.5, {0.4867860766, 0.7340354645, 1.3447591024, 2.0010086459, 2.3895987577}, 3.7041947404, -0.7030433077},
    {2, {0.1413086325, 0.1488976294, 0.2469056776, 0.2061711303, 0.8206689725}, 1.4699072068, -4.6091949283},
    {3, {-1.4486122086, -1.3597168846, -1.0395979722, -0.9887806776, -1.1433718366}, -4.5779434860, -1.8021999741},
    {4, {-0.2358620285, -0.1353700070, -0.0857881912, -0.3054386409, -1.0707964379}, -1.6326153359, -4.3926277572},
    {5, {0.8254795280, 1.3328908276, 1.6257903739, 1.0517228918, 2.8233318970}, 3.8863893387, -0.4052007024},
    {6, {0.0391725577, 0.1571583417, 0.6848947561, 0.4443915031, 0.2764671082}, 1.5311334409, -4.6262927098}};

Claim reduced(char const* what, std::string const& formulation) {
  return {"M6b", what, By::independent, "chain of five angles, DOP853", formulation};
}

/// \param late tolerance after 4 s: the lowest bars are nearly upright at 5 s, which multiplies an error by ten
template <class Tree, class Loop, class I>
void follows(I const& integrator, double step, double early, double late, std::string const& formulation) {
  Grid<Tree, Loop> grid;
  double const before = energy(grid.model, grid.x).total();
  held(reduced("energy at the start [J]", formulation), before, -320.0461532, 1e-7);
  for (Row const& row : table) {
    double const tolerance = row.t > 4.0 ? late : early;
    simulate(grid.model, grid.x, integrator, {.end_time = row.t, .step = step}).run();
    Vec<double, 5> const found = grid.angles();
    double worst = 0.0;
    for (int i = 0; i < 5; ++i) worst = std::max(worst, std::abs(found[i] - row.angles[i]));
    held_within(reduced("angles of the five rows [rad]", formulation), worst, tolerance, {equals("t", row.t), 1.0});
    held_within(reduced("lowest corner on the left [m]", formulation), (grid.corner() - Vec3(row.y, row.z, 0)).norm(),
                3.0 * tolerance, {equals("t", row.t), 5.0});
    held({"M6b", "energy [J]", By::closed_form, "invariant", formulation}, energy(grid.model, grid.x).total(), before,
         1000.0 * tolerance, {.at = equals("t", row.t)});
  }
}

// The bars of every row of the grid are collinear when they pass 90°. The lowest row is the first, at 0.76 s.
TEST(GridOfLoops, FallsAsFiveAnglesDo) {
  follows<Constraint, Constraint>(GeneralisedAlpha{.rho_inf = 0.9}, 1e-3, 1.6e-4, 2e-3,
                                  "planar::Rigid, Constraint, generalised-α, h = 1 ms");
  follows<JointCoordinates, Constraint>(
      GeneralisedAlpha{.rho_inf = 0.9}, 1e-3, 1.6e-4, 2e-3,
      "planar::Rigid, joint coordinates, loops by Constraint, generalised-α, h = 1 ms");
}
TEST(GridOfLoops, FallsAsFiveAnglesDoByRadau) {
  follows<Constraint, Constraint>(Radau{}, 2e-3, 1e-8, 3e-8, "planar::Rigid, Constraint, Radau IIA, h = 2 ms");
}

// Every hinge twice.
TEST(GridOfLoops, MovesWithDoubledHingesAsWithSingleOnes) {
  auto const make = [] { return Grid<Constraint>(); };
  RunOptions const options{.end_time = 0.1, .step = 2e-3};
  expect_same_with_doubled_joints(make, GeneralisedAlpha{.tolerance = 1e-10}, options, 1e-9);
  expect_same_with_doubled_joints(make, Radau{}, options, 1e-9);
}

}  // namespace grid_of_loops_test
}  // namespace polybody
