#include <polybody/io/state_table.hpp>

#include <gtest/gtest.h>

#include <random>

#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/ancf/cholesky_coordinates.hpp>
#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/ffr/planar_ffr.hpp>
#include <polybody/bodies/lrvf/incremental_interpolation.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/bodies/rigid/rigid_euler_parameters.hpp>
#include <polybody/bodies/shared/with_sliders.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/io/run_table.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/simulate.hpp>

#include "support/refusal.hpp"

using namespace polybody;

namespace state_table_test {

using Pin = Joint<Revolute, Constraint>;

/// Two rods of different types on pins and a Maxwell element: q, v, z, and constraint equations of joints and of a
/// body.
struct StateTable : testing::Test {
  Model<Bodies<Rigid<>, Rigid<EulerParameters>>, Joints<Pin>, Forces<MaxwellElement>> model{Gravity{0, 0, -9.81}};
  StateTable() {
    Bar bar{.length = 1.0, .section = Circle{.radius = 0.01}, .material = Material{.density = 7800.0, .young = 2e11}};
    auto const lower_bar = [&] {
      Bar b = bar;
      b.placement = Placement::at({1, 0, 0});
      return b;
    }();
    // the type that comes second is added first
    auto const lower = model.add(Rigid<EulerParameters>::from(lower_bar), "lower");
    auto const upper = model.add(Rigid<>::from(bar), "upper");
    Pin const pin{Revolute{.axis = {0, 1, 0}}};
    model.connect(pin, model.ground().at({0, 0, 0}), upper.at(0.0), "shoulder");
    model.connect(pin, upper.at(1.0), lower.at(0.0), "elbow");
    model.apply(MaxwellElement{.stiffness = 100.0, .damping = 10.0, .free_length = 1.0}, model.ground().at({0, 0, 1}),
                lower.at(0.5), "valve");
  }
};

TEST_F(StateTable, ColumnsAreNamedByTheirOwners) {
  auto const heads = state_columns(model);
  ASSERT_EQ(heads.size(), std::size_t(1 + model.coordinates() + model.velocities() + model.rows()));
  State const x = model.reference_state();
  Table const table = state_table(model, {x});
  EXPECT_EQ(table.columns, heads);
  auto const value = [&](char const* head) { return table.column(head).at(0); };
  EXPECT_EQ(value("t [s]"), 0.0);
  EXPECT_NEAR(value("upper q[0] [m]"), 0.5, 1e-15);  // position of the centre
  EXPECT_NEAR(value("lower q[0] [m]"), 1.5, 1e-15);
  EXPECT_EQ(value("lower q[3] [1]"), 1.0);
  EXPECT_EQ(value("valve z[0]"), 0.0);
  EXPECT_EQ(value("elbow lambda[4]"), 0.0);
  EXPECT_EQ(value("lower lambda[0]"), 0.0);  // constraint of the unit norm
  EXPECT_EQ(std::ranges::count(heads, "lower v[6] [1/s]"), 1);
  EXPECT_EQ(std::ranges::count(heads, "upper v[5] [rad/s]"), 1);
  EXPECT_EQ(std::ranges::count_if(heads, [](std::string const& head) { return head.starts_with("upper v[6]"); }), 0);
}

TEST_F(StateTable, StatesComeBackTheSame) {
  State x = model.reference_state();
  std::vector<State> states;
  for (State const& now : simulate(model, x, GeneralisedAlpha{}, {.end_time = 0.05, .step = 1e-2}))
    states.push_back(now);
  Table const table = state_table(model, states);
  for (std::size_t k = 0; k < states.size(); ++k) {
    State const back = state_from(model, table, k);
    EXPECT_EQ(back.t, states[k].t);
    EXPECT_EQ(back.q, states[k].q);
    EXPECT_EQ(back.v, states[k].v);
    EXPECT_EQ(back.lambda, states[k].lambda);
    EXPECT_EQ(back.a, VecX(VecX::Zero(model.velocities())));
  }
  // a run continues from this state
  State from = state_from(model, table, 3);
  simulate(model, from, GeneralisedAlpha{}, {.end_time = 0.05, .step = 1e-3}).run();
  EXPECT_LT((from.q - x.q).norm(), 1e-4);
}

TEST_F(StateTable, ColumnsMayComeInAnyOrderAndMultipliersMayLack) {
  State x = model.reference_state();
  simulate(model, x, GeneralisedAlpha{}, {.end_time = 0.05, .step = 1e-2}).run();
  Table const table = state_table(model, {x});
  Table other{{"note [1]"}, {{7.0}}};
  for (std::size_t j = table.columns.size(); j-- > 0;)
    if (!has(table.columns[j], "lambda")) {
      other.columns.push_back(table.columns[j]);
      other.rows[0].push_back(table.rows[0][j]);
    }
  State const back = state_from(model, other, 0);
  EXPECT_EQ(back.q, x.q);
  EXPECT_EQ(back.v, x.v);
  EXPECT_EQ(back.lambda, VecX(VecX::Zero(model.rows())));
}

/// A table from other programs, with heads without units.
Table without_units(Table table) {
  for (std::string& head : table.columns)
    if (std::size_t const unit = head.find("] ["); unit != head.npos) head.resize(unit + 1);
  return table;
}

TEST_F(StateTable, HeadsMayLackTheirUnits) {
  State x = model.reference_state();
  simulate(model, x, GeneralisedAlpha{}, {.end_time = 0.05, .step = 1e-2}).run();
  Table const table = state_table(model, {x});
  Table const bare = without_units(table);
  ASSERT_EQ(std::ranges::count(bare.columns, "lower v[6]"), 1);
  ASSERT_EQ(std::ranges::count(bare.columns, "lower v[6] [1/s]"), 0);
  Table some = table;  // some heads with units, some without
  for (std::size_t j = 0; j < some.columns.size(); j += 2) some.columns[j] = bare.columns[j];
  for (Table const* const read : {&bare, &std::as_const(some)}) {
    State const back = state_from(model, *read, 0);
    EXPECT_EQ(back.t, x.t);
    EXPECT_EQ(back.q, x.q);
    EXPECT_EQ(back.v, x.v);
    EXPECT_EQ(back.lambda, x.lambda);
  }
}

TEST_F(StateTable, RefusesAnotherUnitAndOneNumberTwice) {
  Table const table = state_table(model, {model.reference_state()});
  Table other = table;
  *std::ranges::find(other.columns, "upper q[0] [m]") = "upper q[0] [mm]";
  EXPECT_TRUE(has(refusal([&] { state_from(model, other, 0); }),
                  "the unit of the column \"upper q[0] [mm]\" is not [m]. Convert its numbers and rename the column to "
                  "\"upper q[0] [m]\""));
  Table twice = table;
  twice.columns.push_back("upper q[0]");
  twice.rows[0].push_back(0.0);
  EXPECT_TRUE(has(refusal([&] { state_from(model, twice, 0); }),
                  "\"upper q[0]\" and \"upper q[0] [m]\" contain the same quantity"));
}

/// For every body, the coordinates and velocities in [m], [m/s], and no others, scale with the lengths of the body
/// and of its motion.
template <class Made>
void expect_units(Made const& made, std::string const& coordinates, std::string const& velocities) {
  auto const of_size = [&](double size) {
    Mat3 const axes = Eigen::AngleAxisd(0.7, Vec3::UnitZ()).toRotationMatrix();
    Bar const bar{.length = 1.7 * size,
                  .section = Rectangle{.height = 0.1 * size, .width = 0.1 * size},
                  .material = Material{.density = 7800.0, .young = 2e11, .poisson = 0.3},
                  .placement = {.origin = Vec3(0.3, -0.4, 0.0) * size, .axes = axes}};
    return made(bar);
  };
  using B = decltype(of_size(1.0));
  struct Moving {
    Model<Bodies<B>, Joints<>, Forces<>> model;
    std::vector<double> q, v;
    explicit Moving(B const& body, double size) {
      model.add(body, "arm");
      State const x = model.reference_state();
      q.assign(x.q.begin(), x.q.end());
      v.resize(std::size_t(body.velocities()));
      body.rigid_velocity(q, Vec3(0.9, 0.8, 0.0) * size, Vec3(0.0, 0.0, 1.1), v);
    }
  };
  double const times = 1000.0;
  Moving const one(of_size(1.0), 1.0), large(of_size(times), times);
  std::vector<std::string> const heads = state_columns(one.model);
  std::string found[2];
  auto const see = [&](char const* what, std::size_t first, std::vector<double> const& x,
                       std::vector<double> const& y) {
    std::string& units = found[what[0] == 'v'];
    for (std::size_t i = 0; i < x.size(); ++i) {
      std::string const& head = heads[first + i];
      std::string const name = std::string("arm ") + what + '[' + std::to_string(i) + "] [";
      ASSERT_TRUE(head.starts_with(name)) << head;
      std::string const unit = head.substr(name.size(), head.size() - name.size() - 1);
      double const grows = unit[0] == 'm' ? times : 1.0;
      EXPECT_NEAR(y[i], grows * x[i], 1e-11 * (1.0 + std::abs(y[i]))) << head;
      units += (i ? " " : "") + unit;
    }
  };
  see("q", 1, one.q, large.q);
  see("v", 1 + one.q.size(), one.v, large.v);
  EXPECT_EQ(found[0], coordinates);
  EXPECT_EQ(found[1], velocities);
}

TEST(UnitsOfStates, OfRigidBodies) {
  expect_units([](Bar const& bar) { return Rigid<>::from(bar); }, "m m m 1 1 1 1", "m/s m/s m/s rad/s rad/s rad/s");
  expect_units([](Bar const& bar) { return Rigid<EulerParameters>::from(bar); }, "m m m 1 1 1 1",
               "m/s m/s m/s 1/s 1/s 1/s 1/s");
  expect_units([](Bar const& bar) { return planar::Rigid::from(bar); }, "m m rad", "m/s m/s rad/s");
}

TEST(UnitsOfStates, OfCablesAndBeamsByGradients) {
  expect_units([](Bar const& bar) { return AncfCable<>::from(bar, 1); }, "m m m 1 1 1 m m m 1 1 1",
               "m/s m/s m/s 1/s 1/s 1/s m/s m/s m/s 1/s 1/s 1/s");
  std::string const node = "m m m 1 1 1 1 1 1 1 1 1", rate = "m/s m/s m/s 1/s 1/s 1/s 1/s 1/s 1/s 1/s 1/s 1/s";
  expect_units([](Bar const& bar) { return AncfBeam<>::from(bar, 1); }, node + ' ' + node, rate + ' ' + rate);
  expect_units([](Bar const& bar) { return planar::AncfCable<>::from(bar, 1); }, "m m 1 1 m m 1 1",
               "m/s m/s 1/s 1/s m/s m/s 1/s 1/s");
  expect_units([](Bar const& bar) { return WithSliders(planar::AncfCable<>::from(bar, 1), {0.0}); },
               "m m 1 1 m m 1 1 m", "m/s m/s 1/s 1/s m/s m/s 1/s 1/s m/s");
}

TEST(UnitsOfStates, OfBeamsByRotationsAndOfFloatingFrames) {
  std::string const node = "m m m 1 1 1 1", rate = "m/s m/s m/s rad/s rad/s rad/s";
  expect_units([](Bar const& bar) { return Lrvf<>::from(bar, 1); }, node + ' ' + node, rate + ' ' + rate);
  expect_units([](Bar const& bar) { return Lrvf<Incremental>::from(bar, 1); },
               node + ' ' + node + " 1 1 1 1 rad rad rad", rate + ' ' + rate);
  expect_units([](Bar const& bar) { return planar::Lrvf::from(bar, 1); }, "m m rad m m rad",
               "m/s m/s rad/s m/s m/s rad/s");
  expect_units([](Bar const& bar) { return Ffr::from(bar, 1); }, node + " 1 1 1 1 1 1",
               rate + " 1/s 1/s 1/s 1/s 1/s 1/s");
  expect_units([](Bar const& bar) { return planar::Ffr::from(bar, 1); }, "m m rad 1 1 1", "m/s m/s rad/s 1/s 1/s 1/s");
}

/// A body without names of units.
TEST(UnitsOfStates, AreLeftOutWhereABodyNamesNone) {
  Bar const bar{.length = 1.0,
                .section = Rectangle{.height = 0.1, .width = 0.1},
                .material = Material{.density = 7800.0, .young = 2e11, .poisson = 0.3}};
  Model<Bodies<CholeskyCoordinates<AncfCable<>>>, Joints<>, Forces<>> model;  // coordinates [kg^½ m] and [kg^½]
  model.add(CholeskyCoordinates<AncfCable<>>::from(bar, Index(1)), "arm");
  auto const heads = state_columns(model);
  EXPECT_EQ(heads[1], "arm q[0]");
  EXPECT_EQ(heads[13], "arm v[0]");
  State const x = model.reference_state();
  EXPECT_EQ(state_from(model, state_table(model, {x}), 0).q, x.q);
}

TEST_F(StateTable, RefusesWhatIsNoStateOfTheModel) {
  Table table = state_table(model, {model.reference_state()});
  EXPECT_TRUE(has(refusal([&] { state_from(model, table, 1); }), "row 1 does not exist; the table has 1 rows"));
  Table twice = table;
  twice.columns.back() = "t [s]";
  EXPECT_TRUE(has(refusal([&] { state_from(model, twice, 0); }), "duplicate column \"t [s]\""));
  for (char const* needed : {"t [s]", "upper q[6] [1]", "lower v[6] [1/s]", "valve z[0]"}) {
    Table lacking = table;
    *std::ranges::find(lacking.columns, needed) = "something";
    EXPECT_TRUE(has(refusal([&] { state_from(model, lacking, 0); }), std::string("no column \"") + needed + '"'));
  }
  State wrong = model.reference_state();
  wrong.q.conservativeResize(3);
  EXPECT_TRUE(has(refusal([&] { state_table(model, {wrong}); }), "does not fit the model"));
}

}  // namespace state_table_test
