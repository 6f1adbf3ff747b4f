#include <polybody/io/state_table.hpp>

#include <gtest/gtest.h>

#include <random>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/bodies/rigid/rigid_euler_parameters.hpp>
#include <polybody/forces/maxwell_element.hpp>
#include <polybody/integrators/generalized_alpha.hpp>
#include <polybody/io/run_table.hpp>
#include <polybody/joints/policies/constraint.hpp>
#include <polybody/joints/revolute.hpp>
#include <polybody/run/simulate.hpp>

#include "support/refusal.hpp"

using namespace polybody;

namespace state_table_test {

using Pin = Joint<Revolute, Constraint>;

/// Two rods of different types on pins and a Maxwell element: q, v, z, and rows of joints and of a body.
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
  ASSERT_EQ(heads.size(), std::size_t(1 + model.coordinates() + model.speeds() + model.rows()));
  State const x = model.reference_state();
  Table const table = state_table(model, {x});
  EXPECT_EQ(table.columns, heads);
  auto const value = [&](char const* head) { return table.column(head).at(0); };
  EXPECT_EQ(value("t [s]"), 0.0);
  EXPECT_NEAR(value("upper q[0]"), 0.5, 1e-15);  // the centre's place
  EXPECT_NEAR(value("lower q[0]"), 1.5, 1e-15);
  EXPECT_EQ(value("lower q[3]"), 1.0);
  EXPECT_EQ(value("valve z[0]"), 0.0);
  EXPECT_EQ(value("elbow lambda[4]"), 0.0);
  EXPECT_EQ(value("lower lambda[0]"), 0.0);  // of its norm
  EXPECT_EQ(std::ranges::count(heads, "lower v[6]"), 1);
  EXPECT_EQ(std::ranges::count(heads, "upper v[6]"), 0);
}

TEST_F(StateTable, StatesComeBackTheSame) {
  State x = model.reference_state();
  std::vector<State> states;
  for (State const& now : simulate(model, x, GeneralizedAlpha{}, {.until = 0.05, .step = 1e-2})) states.push_back(now);
  Table const table = state_table(model, states);
  for (std::size_t k = 0; k < states.size(); ++k) {
    State const back = state_from(model, table, k);
    EXPECT_EQ(back.t, states[k].t);
    EXPECT_EQ(back.q, states[k].q);
    EXPECT_EQ(back.v, states[k].v);
    EXPECT_EQ(back.lambda, states[k].lambda);
    EXPECT_EQ(back.a, VecX(VecX::Zero(model.speeds())));
  }
  // and a run goes on from there
  State from = state_from(model, table, 3);
  simulate(model, from, GeneralizedAlpha{}, {.until = 0.05, .step = 1e-3}).run();
  EXPECT_LT((from.q - x.q).norm(), 1e-4);
}

TEST_F(StateTable, ColumnsMayComeInAnyOrderAndMultipliersMayLack) {
  State x = model.reference_state();
  simulate(model, x, GeneralizedAlpha{}, {.until = 0.05, .step = 1e-2}).run();
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

TEST_F(StateTable, RefusesWhatIsNoStateOfTheModel) {
  Table table = state_table(model, {model.reference_state()});
  EXPECT_TRUE(has(refusal([&] { state_from(model, table, 1); }), "row 1 is asked of a table of 1"));
  Table twice = table;
  twice.columns.back() = "t [s]";
  EXPECT_TRUE(has(refusal([&] { state_from(model, twice, 0); }), "two columns are called \"t [s]\""));
  for (char const* needed : {"t [s]", "upper q[6]", "lower v[6]", "valve z[0]"}) {
    Table lacking = table;
    *std::ranges::find(lacking.columns, needed) = "something";
    EXPECT_TRUE(has(refusal([&] { state_from(model, lacking, 0); }), std::string("no column \"") + needed + '"'));
  }
  State wrong = model.reference_state();
  wrong.q.conservativeResize(3);
  EXPECT_TRUE(has(refusal([&] { state_table(model, {wrong}); }), "does not fit the model"));
}

}  // namespace state_table_test
