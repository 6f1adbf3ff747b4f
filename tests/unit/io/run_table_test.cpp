#include <polybody/io/run_table.hpp>

#include <gtest/gtest.h>

#include <random>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/io/progress.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/refusal.hpp"

namespace fs = std::filesystem;
using namespace polybody;

namespace run_table_test {

using Pin = Joint<planar::Revolute, Constraint>;

/// A rod of 1 m, released horizontally.
struct RunTable : testing::Test {
  Model<Bodies<planar::Rigid>, Joints<Pin>> model{Gravity{0, -9.81, 0}};
  BodyHandle<planar::Rigid> rod = model.add(
      planar::Rigid::from(
          {.length = 1.0, .section = Circle{.radius = 0.01}, .material = Material{.density = 7800.0, .young = 2e11}}),
      "rod");
  State x;
  fs::path const folder = fs::path(testing::TempDir()) / ("polybody table " + std::to_string(std::random_device{}()));

  RunTable() {
    model.connect(Pin{}, model.ground().at({0, 0, 0}), rod.at(0.0), "pin");
    x = model.reference_state();
  }
  ~RunTable() override { fs::remove_all(folder); }

  auto run(RunOptions options) { return simulate(model, x, GeneralisedAlpha{}, std::move(options)); }
  std::vector<TableColumn> columns() {
    return {{"tip x [m]", [&](auto const& now) { return now.position(rod.at(1.0))[0]; }},
            {"speed [m/s]", [&](State const& now) { return frame(model, now, rod.at(1.0)).v.norm(); }},
            {"tip y [m]", [&](State const& now) { return position(model, now, rod.at(1.0))[1]; }}};
  }
};

TEST_F(RunTable, HoldsEveryStateOfARun) {
  Table const table = tabulate(run({.end_time = 0.1, .step = 1e-2}), columns());
  EXPECT_EQ(table.columns, (std::vector<std::string>{"t [s]", "tip x [m]", "speed [m/s]", "tip y [m]"}));
  ASSERT_EQ(table.rows.size(), 11u);
  EXPECT_EQ(table.rows[0], (std::vector<double>{0.0, 1.0, 0.0, 0.0}));
  for (std::size_t k = 0; k < 11; ++k) {
    EXPECT_NEAR(table.rows[k][0], 0.01 * double(k), 1e-15);
    EXPECT_NEAR(std::hypot(table.rows[k][1], table.rows[k][3]), 1.0, 1e-9);
    // energy of a rod on a pin: (l ω)² = 3 g |y|
    EXPECT_NEAR(std::pow(table.rows[k][2], 2), -3.0 * 9.81 * table.rows[k][3], 2e-3);
  }
  EXPECT_EQ(table.rows.back()[0], x.t);
}

TEST_F(RunTable, SamplesTheFirstStateOnOrAfterEachMultiple) {
  Table const table = tabulate(run({.end_time = 0.1, .step = 1e-2}), columns(), 0.025);
  std::vector<double> const times = table.column("t [s]");
  ASSERT_EQ(times.size(), 5u);
  for (std::size_t k = 0; k < 5; ++k) EXPECT_NEAR(times[k], (std::array{0.0, 0.03, 0.05, 0.08, 0.1})[k], 1e-12);
  x = model.reference_state();
  // the first row and the last row
  EXPECT_EQ(tabulate(run({.end_time = 0.1, .step = 1e-2}), columns(), 7.0).rows.size(), 2u);
}

TEST_F(RunTable, RefusesColumnsThatCannotBeTold) {
  auto const said = [&](std::vector<TableColumn> const& these, double sampling = 0.0) {
    return refusal([&] { tabulate(run({.end_time = 0.1, .step = 1e-2}), these, sampling); });
  };
  auto const zero = [](State const&) { return 0.0; };
  EXPECT_TRUE(has(said({{"", zero}}), "column 1, counted from 1, lacks a name or a value"));
  EXPECT_TRUE(has(said({{"x [m]", zero}, {"y [m]", {}}}), "column 2, counted from 1, lacks"));
  EXPECT_TRUE(has(said({{"x [m]", zero}, {"x [m]", zero}}), "duplicate column \"x [m]\""));
  EXPECT_TRUE(has(said({{"t [s]", zero}}), "duplicate column \"t [s]\""));
  EXPECT_TRUE(has(said({{"x [m]", zero}}, -1.0), "sampling"));
  EXPECT_EQ(x.t, 0.0);
  try {
    tabulate(run({.end_time = 0.1, .step = 1e-2}),
             {{"root [1]", [](State const& now) { return std::sqrt(0.055 - now.t); }}});
    ADD_FAILURE();
  } catch (NonFiniteValue const& failed) {
    EXPECT_STREQ(failed.what(), "tabulate: \"root [1]\" is not finite at t = 0.06 s.");
  }
}

TEST_F(RunTable, ReadsBackToTheSameDoubles) {
  Table const table = tabulate(run({.end_time = 0.1, .step = 1e-2}), columns());
  write_csv(table, folder / "run.csv");
  Table const again = read_csv(folder / "run.csv");
  EXPECT_EQ(again.columns, table.columns);
  EXPECT_EQ(again.rows, table.rows);
}

TEST_F(RunTable, ColumnsOfOneUnitShareAPanel) {
  Table const table = tabulate(run({.end_time = 0.1, .step = 1e-2}), columns());
  auto const figures = detail::figures_of(table);
  ASSERT_EQ(figures.size(), 2u);
  EXPECT_EQ(figures[0].y_label, "[m]");
  EXPECT_EQ(figures[0].curves.size(), 2u);
  EXPECT_EQ(figures[0].curves[1].y, table.column("tip y [m]"));
  EXPECT_EQ(figures[1].y_label, "speed [m/s]");
  EXPECT_FALSE(figures[1].legend);
  EXPECT_EQ(figures[1].x_label, "t [s]");
  // without units each column has its own figure
  EXPECT_EQ(detail::figures_of({{"t [s]", "a", "b"}, {{0.0, 1.0, 2.0}}}).size(), 2u);
}

TEST_F(RunTable, PlotIsOneCall) {
  bool const drawn = plot(tabulate(run({.end_time = 0.1, .step = 1e-2}), columns()), folder / "rod") == DrawResult::png;
  EXPECT_EQ(drawn, find_gnuplot().has_value());
  for (char const* ending : {".csv", ".dat", ".gp"}) EXPECT_TRUE(fs::exists(folder / (std::string("rod") + ending)));
  EXPECT_EQ(fs::exists(folder / "rod.png"), drawn);
  EXPECT_EQ(plot(read_csv(folder / "rod.csv"), folder / "again", false), DrawResult::script_only);
  EXPECT_TRUE(has(refusal([&] { plot(Table{{"t [s]", "x [m]"}, {}}, folder / "none"); }), "0 rows of 2 columns"));
  EXPECT_TRUE(has(refusal([&] { plot(Table{{"t [s]"}, {{1.0}}}, folder / "none"); }), "1 rows of 1 columns"));
  EXPECT_FALSE(fs::exists(folder / "none.csv"));
}

TEST_F(RunTable, ARunTellsItsProgress) {
  std::vector<double> times;
  run({.end_time = 0.05,
       .step = 1e-2,
       .progress =
           [&](RunProgress const& p) {
             EXPECT_EQ(p.start, 0.0);
             EXPECT_EQ(p.end_time, 0.05);
             EXPECT_EQ(p.done, p.now == 0.05);
             times.push_back(p.now);
           }})
      .run();
  ASSERT_EQ(times.size(), 5u);
  EXPECT_EQ(times.back(), x.t);
  // from the start of the run to the end at an event
  bool done = false;
  Event const stop{.name = "low", .value = [](State const& now) { return now.t - 0.071; }, .terminal = true};
  run({.end_time = 1.0,
       .step = 1e-2,
       .events = {stop},
       .progress =
           [&](RunProgress const& p) {
             EXPECT_EQ(p.start, 0.05);
             EXPECT_FALSE(done);
             done = p.done;
           }})
      .run();
  EXPECT_TRUE(done);
  EXPECT_NEAR(x.t, 0.071, 1e-6);
}

TEST_F(RunTable, AProgressBarFollowsARun) {
  std::ostringstream out;
  double time = 0.0;
  RunOptions options{.end_time = 0.1, .step = 1e-2};
  options.progress = progress_bar([&](RunProgress const& p) {
    return std::make_unique<Progress>(p.start, p.end_time, "rod", out, true, [&] { return time += 1.0; });
  });
  run(options).run();
  std::string const text = out.str();
  EXPECT_TRUE(has(text, "rod  10% [")) << text;
  EXPECT_TRUE(has(text, "rod 100% ["));
  EXPECT_TRUE(text.ends_with('\n'));
}

}  // namespace run_table_test
