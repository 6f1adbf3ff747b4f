// Grids of four-bar loops that hang and rotate pass their singular configurations under Radau, whatever policy makes
// the coordinates of a step.

#include <gtest/gtest.h>

#include <numbers>

#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/linkages.hpp"

namespace polybody {
namespace hung_grids_test {

using Bar = planar::Rigid;
template <class Policy>
using Pin = Joint<planar::Revolute, Policy>;

/// Vertical column of square loops. Each bar has a length of 1 m and a mass of 1 kg. All loops rotate at `rate` [rad/s]
/// like one rigid column. \tparam M model with bars and pins  \tparam Tree policy of the pins that close no loop
template <class M, class Tree>
struct Column {
  M model{Gravity{0, -9.81, 0}};
  std::vector<BodyHandle<Bar>> left, right, across;
  State x;

  explicit Column(int loops) {
    double const down = -0.5 * std::numbers::pi;
    auto const bar = [&](double px, double py, double angle) {
      return model.add(Bar(1.0, 1.0 / 12.0, Placement::planar(px, py, angle)));
    };
    Vec2 const first(-0.5, 0), last(0.5, 0);
    for (int k = 0; k < loops; ++k) {
      std::size_t const i = std::size_t(k);
      left.push_back(bar(0, -k - 0.5, down));
      right.push_back(bar(1, -k - 0.5, down));
      across.push_back(bar(0.5, -k - 1.0, 0));
      if (k == 0) {
        model.connect(Pin<Tree>{}, model.ground().at({0, 0, 0}), left[0].at(first));
        model.connect(Pin<Tree>{}, model.ground().at({1, 0, 0}), right[0].at(first));
      } else {
        model.connect(Pin<Tree>{}, left[i - 1].at(last), left[i].at(first));
        model.connect(Pin<Tree>{}, right[i - 1].at(last), right[i].at(first));
      }
      model.connect(Pin<Tree>{}, left[i].at(last), across[i].at(first));
      model.connect(Pin<Constraint>{}, across[i].at(last), right[i].at(last));
    }
  }
  void rotate(double rate) {
    x = model.reference_state();
    for (std::size_t k = 0; k < left.size(); ++k) {  // velocities are those of the world's origin
      model.set_velocity(x, left[k], {0, 0, 0}, {0, 0, rate});
      model.set_velocity(x, right[k], {0, -rate, 0}, {0, 0, rate});
      model.set_velocity(x, across[k], {rate * double(k + 1), 0, 0}, {0, 0, 0});
    }
  }
  Column(Column const&) = delete;
};

template <class Tree>
using ColumnOf = Column<Model<Bodies<Bar>, JointsOf<Pin<Tree>, Pin<Constraint>>>, Tree>;

/// The opposite bars of each loop stay parallel, and the energy is constant, in J.
template <class C>
void expect_runs_through(C& column, double rate, double step, double tolerance) {
  column.rotate(rate);
  double const before = energy(column.model, column.x).total();
  simulate(column.model, column.x, Radau{}, {.end_time = 2.0, .step = step}).run();
  EXPECT_NEAR(energy(column.model, column.x).total(), before, tolerance) << step;
  for (std::size_t k = 0; k < column.left.size(); ++k) {
    auto const angle = [&](BodyHandle<Bar> const& bar) { return column.x.q[column.model.entry(bar).q0 + 2]; };
    EXPECT_NEAR(angle(column.left[k]), angle(column.right[k]), 1e-8) << step << ", loop " << k;
  }
}

// Each loop is flat on the way. Without the change of the constraint Jacobian in its matrix, Newton's method stalls
// between 0.38 and 1.52 s.
TEST(HungGrids, TwoFourBarsOnJointCoordinatesRunThroughUnderRadau) {
  for (double const step : {5e-3, 2e-3, 1e-3}) {
    ColumnOf<JointCoordinates> column(2);
    expect_runs_through(column, 5.0, step, step > 2e-3 ? 1e-6 : 2e-7);
  }
}
TEST(HungGrids, ThreeToFiveLoopsOnJointCoordinatesRunThroughUnderRadau) {
  for (int const loops : {3, 4, 5})
    for (double const step : {5e-3, 2e-3}) {
      ColumnOf<JointCoordinates> column(loops);
      expect_runs_through(column, 2.0 * std::numbers::pi / 3.0, step, 1e-5);
    }
}
// A cable on a linear pin, which has no connection with the loops, eliminates coordinates of the model.
TEST(HungGrids, LoopsBesideACableOnALinearPinRunThroughUnderRadau) {
  using Cable = planar::AncfCable<>;
  Column<Model<Bodies<Bar, Cable>, Joints<Pin<Constraint>, Pin<AncfLinear>>>, Constraint> column(2);
  auto const cable = column.model.add(
      Cable::from({.length = 0.5,
                   .constants = BarConstants{.EA = 1e3, .EI = 1.0, .mass_per_length = 1.0, .rotary_inertia = 0.0},
                   .placement = Placement::planar(5.0, 0.0, -0.5 * std::numbers::pi)},
                  1));
  column.model.connect(Pin<AncfLinear>{}, column.model.ground().at({5, 0, 0}), cable.at(0.0));
  expect_runs_through(column, 5.0, 2e-3, 1e-5);
}

}  // namespace hung_grids_test
}  // namespace polybody
