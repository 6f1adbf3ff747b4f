// Closed mechanisms with redundant joints. The first has two equal branches of a double Cardan shaft (data of
// OpenModelica's issue 8365). The next mechanisms have every joint twice. The motion is that of the mechanism without
// the second joints. The reactions are bounded and continuous. The tests of Andrews' mechanism, the closed chain, the
// grid of loops and the spatial slider-crank double the joints of these mechanisms.

#include <gtest/gtest.h>

#include <numbers>

#include <polybody/forces/loads.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/redundancy.hpp>
#include <polybody/run/simulate.hpp>

#include "support/doubled_joints.hpp"
#include "support/linkages.hpp"

using namespace polybody;

namespace doubled_joints_test {

constexpr double rate = 20.0, load = 9.0, axial_inertia = 5e-4;  // [rad/s], [N m], [kg m²]
constexpr double beta = std::numbers::pi / 6;                    // between neighbouring shafts

struct AtRate {
  Motion operator()(double t) const { return {rate * t, rate, 0}; }
};

/// Input and output shaft at 60°, joined by `branches` equal middle shafts. A middle shaft consists of two halves on
/// a prismatic joint, and has a Cardan joint at both ends.
struct CardanShafts {
  using Pin = Joint<Revolute, Constraint>;
  using Cardan = Joint<Universal, Constraint>;
  using Slide = Joint<Prismatic, Constraint>;
  using Drive = Joint<PrescribedAngle<AtRate>, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Pin, Cardan, Slide, Drive>, Forces<PointMoment<>>> model;
  Vec3 const e1{1, 0, 0}, em{std::cos(beta), std::sin(beta), 0}, e2{std::cos(2 * beta), std::sin(2 * beta), 0};
  BodyHandle<Rigid<>> in, out;
  std::vector<BodyHandle<Rigid<>>> middle;
  std::vector<ElementHandle<Cardan>> first;
  ElementHandle<Drive> drive;
  State x;

  explicit CardanShafts(int branches) {
    Vec3 const z(0, 0, 1), origin = Vec3::Zero(), second_centre = 0.5 * em, across = z.cross(em);
    auto const shaft = [&](Vec3 const& place, double angle) {
      return model.add(Rigid<>(1.0, axial_inertia * Mat3::Identity(), Placement::at(place, {0, 0, angle})));
    };
    in = shaft(-0.1 * e1, 0);
    out = shaft(second_centre + 0.1 * e2, 2 * beta);
    model.connect(Pin{Revolute{.axis = e1}}, model.ground().at(Vec3(-0.1 * e1)), in.at(origin), "input bearing");
    model.connect(Pin{Revolute{.axis = e2}}, model.ground().at(Vec3(second_centre + 0.1 * e2)), out.at(origin),
                  "output bearing");
    for (int b = 0; b < branches; ++b) {
      std::string const n = " " + std::to_string(b);
      auto const one = shaft(origin, beta), other = shaft(second_centre, beta);
      first.push_back(model.connect(Cardan{{.first = z, .second = across}}, in.at(Vec3(0.1, 0, 0)), one.at(origin),
                                    "first Cardan joint" + n));
      model.connect(Slide{{.axis = em}}, one.at(Vec3(0.2, 0, 0)), other.at(Vec3(-0.3, 0, 0)), "slide" + n);
      model.connect(Cardan{{.first = across, .second = z}}, other.at(origin), out.at(Vec3(-0.1, 0, 0)),
                    "second Cardan joint" + n);
      middle.push_back(one);
    }
    model.apply(PointMoment<>{.moment = -load * e2}, out.at(origin), "load");
    drive =
        model.connect(Drive{{.law = AtRate{}, .axis = e1}}, model.ground().at(Vec3(-0.1 * e1)), in.at(origin), "drive");
    x = model.reference_state();
    assemble(model, x);
  }
};

/// Largest errors of a run of 1 s, and magnitudes of its reactions.
struct Turned {
  double out_speed = 0, middle_speed = 0, torque = 0;      ///< [rad/s], [rad/s], [N m]
  double halves = 0;                                       ///< difference of both branches' torques [N m]
  double largest = 0, jump = 0;                            ///< multiplier; its change in a step
  std::vector<std::string> redundant = {}, warnings = {};  ///< of the report
};
template <class I>
Turned turn(int branches, I const& integrator, bool minimum_norm) {
  CardanShafts s(branches);
  Turned r;
  VecX last;
  Vec3 const origin = Vec3::Zero();
  auto run = simulate(s.model, s.x, integrator, {.end_time = 1.0, .step = 5e-4, .minimum_norm = minimum_norm});
  for (State const& now : run) {
    // ω_m = ω cos β/(1 − sin²β sin² ωt), and the power of the driving torque
    double const angle = rate * now.t, sine2 = std::sin(beta) * std::sin(beta),
                 part = 1 - sine2 * std::sin(angle) * std::sin(angle), wm = rate * std::cos(beta) / part,
                 change = wm / part * sine2 * std::sin(2 * angle) * rate, torque = reaction(s.model, now, s.drive).m[0];
    auto const largest = [](double& of, double value) { of = std::max(of, std::abs(value)); };
    largest(r.out_speed, frame(s.model, now, s.out.at(origin)).w.dot(s.e2) - rate);
    largest(r.middle_speed, frame(s.model, now, s.middle[0].at(origin)).w.dot(s.em) - wm);
    largest(r.torque, torque - (load + branches * 2 * axial_inertia * wm * change / rate));
    largest(r.largest, largest_size(now.lambda));
    if (last.size() > 0) largest(r.jump, largest_size(VecX(now.lambda - last)));
    last = now.lambda;
    if (branches == 2)
      largest(r.halves, reaction(s.model, now, s.first[0]).m[0] - reaction(s.model, now, s.first[1]).m[0]);
  }
  r.redundant = run.report().redundant;
  r.warnings = run.report().warnings;
  return r;
}

/// 36 constraint equations of rank 35. A fixed elimination order would drop one equation of the slide. This equation
/// is independent of the others when the Cardan joints are in phase, at 20 t = kπ. \param middle tolerance of its
/// angular velocity [rad/s]
template <class I>
void expect_two_branches(I const& integrator, double middle) {
  for (bool const minimum_norm : {false, true}) {
    SCOPED_TRACE(testing::Message() << I::name << (minimum_norm ? ", minimum norm" : ""));
    Turned const r = turn(2, integrator, minimum_norm);
    EXPECT_LT(r.out_speed, 1e-6);
    EXPECT_LT(r.middle_speed, middle);
    EXPECT_LT(r.torque, 1e-3);
    EXPECT_LT(r.largest, 20.0);  // one branch alone carries 18
    EXPECT_LT(r.jump, 0.25);     // 18 N m rotate by 0.01 rad per step
    if (minimum_norm) EXPECT_LT(r.halves, 1e-3);
    EXPECT_EQ(r.redundant, std::vector<std::string>{"joint \"second Cardan joint 1\""});
    EXPECT_TRUE(r.warnings.empty()) << r.warnings.front();
  }
}

TEST(TwoCardanBranches, TurnAsOneUnderTheAlphaFamily) {
  double const order_two = 2e-4;  // 1.3e-4 with one branch
  expect_two_branches(GeneralisedAlpha{.rho_inf = 0.8}, order_two);
  expect_two_branches(GeneralisedAlpha{.rho_inf = 0.5}, 2 * order_two);
  expect_two_branches(GeneralisedAlpha{.rho_inf = 0.8, .stabilised = true}, 1e-6);
  expect_two_branches(GeneralisedAlpha{.rho_inf = 1.0}, order_two);
  expect_two_branches(HhtAlpha{}, order_two);
  expect_two_branches(Newmark{}, order_two);
}

TEST(TwoCardanBranches, TurnAsOneUnderOtherMethods) {
  expect_two_branches(Radau{}, 1e-6);
  expect_two_branches(RungeKutta4<Projection>{}, 1e-6);
}

TEST(TwoCardanBranches, NameTheSameJointInARunAndInRedundancy) {
  CardanShafts s(2);
  Redundancy const r = redundancy(s.model, s.x);
  EXPECT_EQ(r.rows - r.rank, 1);
  ASSERT_EQ(r.repeated.size(), 1u);
  EXPECT_EQ(r.repeated[0].name, "joint \"second Cardan joint 1\"");
}

template <class Make>
void expect_same_by_every_method(Make const& make, double end_time) {
  auto const by = [&](auto const& integrator) {
    auto single = make(1), twice = make(2);
    expect_same(single, twice, integrator, {.end_time = end_time, .step = 2e-3}, 1e-9);
  };
  by(GeneralisedAlpha{.tolerance = 1e-10});
  by(GeneralisedAlpha{.tolerance = 1e-10, .stabilised = true});
  by(HhtAlpha{.tolerance = 1e-10});
  by(Radau{});
  by(RungeKutta4<Projection>{});
}

TEST(DoubledJoints, MoveFourBarsAsSingleOnes) {
  for (int const n : {1, 3}) {
    expect_same_by_every_method([n](int each) { return FourBars<InPlane<Constraint>>(n, {}, each); }, 0.5);
    expect_same_by_every_method([n](int each) { return FourBars<InSpace<Constraint>>(n, {}, each); }, 0.5);
  }
}
TEST(DoubledJoints, MoveTheBricardMechanismAsSingleOnes) {
  expect_same_by_every_method([](int each) { return Bricard<>(0.1, {}, {}, each); }, 1.0);
}
TEST(DoubledJoints, MoveThinRodsAsSingleOnes) {  // whose mass is singular
  Bricard<> single(0.0, {}, {}, 1), twice(0.0, {}, {}, 2);
  expect_same(single, twice, GeneralisedAlpha{.tolerance = 1e-10}, {.end_time = 1.0, .step = 2e-3}, 1e-8);
}
// In the flat configuration the rank decreases further.
TEST(DoubledJoints, PassASingularPosition) {
  for (int const n : {1, 2}) {
    Corner const end = *std::find_if(std::begin(breakpoints), std::end(breakpoints),
                                     [n](Corner const& c) { return c.n == n && c.t == 4; });
    auto const expect = [&](auto bars, auto const& integrator) {
      simulate(bars.model, bars.x, integrator, {.end_time = end.t, .step = 1e-3}).run();
      EXPECT_LT((bars.corner() - Vec3(end.x, end.y, 0)).norm(), 1e-4) << n << integrator.name;
    };
    expect(FourBars<InPlane<Constraint>>(n, {}, 2), GeneralisedAlpha{});
    expect(FourBars<InPlane<Constraint>>(n, {}, 2), Radau{});
    expect(FourBars<InSpace<Constraint>>(n, {}, 2), GeneralisedAlpha{});
  }
}

}  // namespace doubled_joints_test
