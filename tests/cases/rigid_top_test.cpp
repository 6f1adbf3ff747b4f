// Heavy top (R6) and torque-free body (R7): spatial rotations.

#include <gtest/gtest.h>

#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/held.hpp"
#include "support/integrator_cases.hpp"

using namespace polybody;

namespace rigid_top_test {

DormandPrince<Projection> precise() { return {.relative_tolerance = 1e-11, .absolute_tolerance = 1e-11}; }

/// Heavy top of Géradin & Cardona: 15 kg at 1 m from the fixed point, with a spin of 150 rad/s.
struct HeavyTop {
  using Ball = Joint<Spherical, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Ball>> model{Gravity{0, 0, -9.81}};
  State start;

  HeavyTop() {
    auto const top = model.add(
        Rigid<>(15.0, Vec3(0.234375, 0.46875, 0.234375).asDiagonal().toDenseMatrix(), Placement::at({0, 1, 0})), "top");
    model.connect(Ball{}, model.ground().at({0, 0, 0}), top.at(Vec3(0, -1, 0)), "tip");
    start = model.reference_state();
    model.set_velocity(start, top, Vec3::Zero(), Vec3(0, 150, -4.61538));
  }
};

Claim claim(char const* case_id, char const* what, char const* formulation) {
  return {case_id, what, By::independent, "ordinary solver of order eight", formulation};
}
char const* const by_orders = "Rigid, Dormand–Prince";

/// Distance of Euler parameters up to their common sign.
double distance(Vec4 const& a, Vec4 const& b) { return std::min((a - b).norm(), (a + b).norm()); }

TEST(HeavyTop, IsWhereThePublishedSolutionIs) {
  struct {
    double t;
    Vec3 place;
    std::optional<Vec4> parameters;
    std::optional<Vec3> spin;
  } const exact[] = {{0.2,
                      {0.6055505614, 0.5989576818, -0.5239830274},
                      Vec4(-0.7082791530, 0.4387810881, 0.5457283961, 0.0893997528),
                      Vec3(-2.691590912, 150, 4.917260990)},
                     {0.8, {-0.4181624243, 0.9072079679, -0.0459770571}, {}, {}},
                     {1.0,
                      {0.1733439641, 0.6400885921, -0.7484907911},
                      Vec4(0.7329439807, -0.2782857193, 0.5318246113, -0.3201761427),
                      Vec3(-0.822078102, 150, -5.923291348)},
                     {1.5, {-0.9681657156, 0.2503060621, -0.0014220839}, {}, {}},
                     {2.0,
                      {-0.1504168227, -0.7241655916, -0.6730222696},
                      Vec4(0.1229471350, -0.4910798926, 0.3504300303, -0.7879868875),
                      {}}};
  HeavyTop const top;
  State x = top.start;
  for (auto const& e : exact) {
    simulate(top.model, x, precise(), {.end_time = e.t, .step = 1e-3}).run();
    auto const at = [&](double scale) { return Instance{equals("t", e.t), scale}; };
    held_within(claim("R6", "heavy top: centre of mass [m]", by_orders), (x.q.head<3>() - e.place).norm(), 1e-7,
                at(1.0));
    if (e.parameters)
      held_within(claim("R6", "heavy top: Euler parameters", by_orders), distance(x.q.tail<4>(), *e.parameters), 1e-7,
                  at(1.0));
    if (e.spin)
      held_within(claim("R6", "heavy top: angular velocity [rad/s]", by_orders), (x.v.tail<3>() - *e.spin).norm(), 1e-6,
                  at(150.0));
  }
}

// R6: order two in the position of the centre of mass, h = 1e-3 … 1e-4.
TEST(HeavyTop, ConvergesAtSecondOrderWithGeneralizedAlpha) {
  HeavyTop const top;
  std::vector<double> early, late;
  for (double const h : {5e-4, 2.5e-4, 1.25e-4}) {
    State x = top.start;
    simulate(top.model, x, GeneralisedAlpha{}, {.end_time = 0.2, .step = h}).run();
    early.push_back((x.q.head<3>() - Vec3(0.6055505614, 0.5989576818, -0.5239830274)).norm());
    simulate(top.model, x, GeneralisedAlpha{}, {.end_time = 1.0, .step = h}).run();
    late.push_back((x.q.head<3>() - Vec3(0.1733439641, 0.6400885921, -0.7484907911)).norm());
  }
  for (auto const* errors : {&early, &late}) {
    EXPECT_GT(std::log2((*errors)[1] / (*errors)[2]), 1.9) << testing::PrintToString(*errors);
    held_within(claim("R6", "heavy top: centre of mass at 0.2 and 1 s [m]", "Rigid, generalised-α, h = 1.25e-4 s"),
                errors->back(), 2e-4, {.scale = 1.0});
  }
}

TEST(SlowTop, IsWhereThePublishedSolutionIs) {
  struct {
    double t;
    Vec3 place;
  } const exact[] = {{0.25, {0.0906153700, 0.2910247004, -0.2170103188}},
                     {0.5, {-0.2364177304, -0.2668963764, -0.1134591602}},
                     {1.0, {0.3294674415, -0.1755435591, -0.0252123748}}};
  SlowTop const top;
  State fine = top.start, coarse = top.start;
  for (auto const& e : exact) {
    simulate(top.model, fine, precise(), {.end_time = e.t, .step = 1e-3}).run();
    char const* const what = "slow asymmetric top: centre of mass [m]";
    Instance const at{equals("t", e.t), 0.374};
    held_within(claim("R6", what, by_orders), (fine.q.head<3>() - e.place).norm(), 1e-8, at);
    simulate(top.model, coarse, GeneralisedAlpha{}, {.end_time = e.t, .step = 2.5e-4}).run();
    held_within(claim("R6", what, "Rigid, generalised-α, h = 2.5e-4 s"), (coarse.q.head<3>() - e.place).norm(), 1e-4,
                at);
  }
}

/// Torque-free body (R7, Dzhanibekov effect): I = (1, 2, 3), rotating about the middle axis.
struct FreeBody {
  Model<Bodies<Rigid<>>, Joints<>> model;
  State x;
  FreeBody() {
    auto const body = model.add(Rigid<>(1.0, Vec3(1, 2, 3).asDiagonal().toDenseMatrix()), "body");
    x = model.reference_state();
    model.set_velocity(x, body, Vec3::Zero(), Vec3(0.01, 5, 0.01));
  }
};

struct Spin {
  double t;
  Vec3 omega;
};
Spin const r7[] = {{0.5, {-0.0122755034, 4.9999949312, 0.0108118451}},
                   {1.0, {-0.0648826095, 4.9995890078, 0.0383395054}},
                   {2.0, {-1.1612500596, 4.8632908919, 0.6704977507}},
                   {3.0, {-3.8681418083, -3.1682138423, 2.2332876400}}};

TEST(TorqueFreeBody, TumblesAsPublished) {
  FreeBody body;
  double const energy0 = energy(body.model, body.x).kinetic;
  Vec3 const momentum0 = momentum(body.model, body.x).angular;
  DormandPrince<> const integrator{.relative_tolerance = 1e-12, .absolute_tolerance = 1e-13};
  for (Spin const& e : r7) {
    simulate(body.model, body.x, integrator, {.end_time = e.t, .step = 0.01}).run();
    Instance const at{equals("t", e.t), 5.0};
    held_within(claim("R7", "torque-free body: angular velocity [rad/s]", by_orders),
                (body.x.v.tail<3>() - e.omega).norm(), 1e-8, at);
    if (e.t == 1.0)
      held_within(claim("R7", "torque-free body: Euler parameters at 1 s", by_orders),
                  distance(body.x.q.tail<4>(), Vec4(-0.8011321124, 0.0017634284, 0.5984399441, 0.0073390884)), 1e-9,
                  {.scale = 1.0});
    held({"R7", "torque-free body: energy [J]", By::closed_form, "invariant", by_orders},
         energy(body.model, body.x).kinetic, energy0, 1e-8, at);
    held_within({"R7", "torque-free body: angular momentum [N m s]", By::closed_form, "invariant", by_orders},
                (momentum(body.model, body.x).angular - momentum0).norm(), 1e-8, at);
    EXPECT_NEAR(body.x.q.tail<4>().norm(), 1.0, 1e-12);
  }
}

TEST(TorqueFreeBody, ConvergesAtSecondOrderWithGeneralizedAlpha) {
  std::vector<double> errors;
  for (double const h : {4e-3, 2e-3, 1e-3}) {
    FreeBody body;
    simulate(body.model, body.x, GeneralisedAlpha{}, {.end_time = 3.0, .step = h}).run();
    errors.push_back((body.x.v.tail<3>() - r7[3].omega).norm());
  }
  EXPECT_GT(std::log2(errors[1] / errors[2]), 1.9) << testing::PrintToString(errors);
  held_within(claim("R7", "torque-free body: angular velocity at 3 s [rad/s]", "Rigid, generalised-α, h = 1e-3 s"),
              errors[2], 1e-2, {.scale = 5.0});
}

}  // namespace rigid_top_test
