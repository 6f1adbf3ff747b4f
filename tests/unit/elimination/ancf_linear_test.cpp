// Linear joints of ANCF bodies [Wallin 2016, §3.5.4]: the same motion and reactions as with multipliers, but without
// multipliers.
#include <gtest/gtest.h>

#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/problem_size.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/statics/equilibrium.hpp>

#include "support/held.hpp"
#include "support/refusal.hpp"

using namespace polybody;

namespace ancf_linear_test {

Bar bar(Placement const& placement, double poisson = 0.3) {
  return {.length = 0.5,
          .section = Rectangle{.height = 0.02, .width = 0.02},
          .material = Material{.density = 1000.0, .young = 1e7, .poisson = poisson},
          .placement = placement};
}

/// A chain of n bars on a support, connected by G; they fall.
template <class B, class G, class Policy>
struct Chain {
  using Pin = Joint<G, Policy>;
  Model<Bodies<B>, Joints<Pin>> model{Gravity{0, -9.81, 0}};
  std::vector<BodyHandle<B>> links;
  std::vector<ElementHandle<Pin>> pins;
  State x;

  Chain(G geometry, int n) {
    for (int i = 0; i < n; ++i) links.push_back(model.add(B::from(bar(Placement::at({0.5 * i, 0, 0})), 2)));
    pins.push_back(model.connect(Pin{geometry, {}}, model.ground().at({0, 0, 0}), links[0].at(0.0)));
    for (std::size_t i = 1; i < links.size(); ++i)
      pins.push_back(model.connect(Pin{geometry, {}}, links[i - 1].at(0.5), links[i].at(0.0)));
    x = model.reference_state();
  }
  void fall(double end_time) { simulate(model, x, GeneralisedAlpha{}, {.end_time = end_time, .step = 1e-3}).run(); }
};

template <class A, class B>
void expect_same(char const* chain, A const& tied, B const& free, double reaction_tolerance) {
  auto const apart = [&](char const* what, double distance, double tolerance, double scale) {
    held_within({"thesis §3.5", what, By::itself, "Constraint", std::string("AncfLinear, ") + chain}, distance,
                tolerance, {.scale = scale});
  };
  apart("coordinates of a chain of beams that falls for 0.2 s", (tied.x.q - free.x.q).norm(), 1e-9, 1.0);
  apart("speeds of a chain of beams that falls for 0.2 s", (tied.x.v - free.x.v).norm(), 1e-6, 1.0);
  double most = 0.0;
  for (std::size_t i = 0; i < tied.pins.size(); ++i) {
    Vec3 const f = reaction(tied.model, tied.x, tied.pins[i]).f;
    EXPECT_GT(f.norm(), 0.5);
    apart("forces of its pins, of their size", (f - reaction(free.model, free.x, free.pins[i]).f).norm() / f.norm(),
          reaction_tolerance, 1.0);
    most = std::max(most, f.norm());
  }
  System system(free.model);
  system.evaluate(free.x.q, free.x.v, free.x.t);
  EXPECT_NEAR(peak_joint_force(system, free.x), most, reaction_tolerance * most);
}

TEST(AncfLinear, PinsACableInThePlane) {
  Chain<planar::AncfCable<>, planar::Revolute, Constraint> held({}, 3);
  Chain<planar::AncfCable<>, planar::Revolute, AncfLinear> free({}, 3);
  held.fall(0.2);
  free.fall(0.2);
  expect_same("planar AncfCable, Revolute", held, free, 1e-6);
  EXPECT_EQ(problem_size(free.model).rows, 0);
  EXPECT_EQ(problem_size(free.model).coordinates, 3 * 12 - 3 * 2);
  EXPECT_EQ(problem_size(free.model).degrees_of_freedom, problem_size(held.model).degrees_of_freedom);
  System system(free.model);
  Violation const open = largest_violation(system, free.x);
  EXPECT_LT(open.position, 1e-15);
  EXPECT_LT(open.acceleration, 1e-12);
}

TEST(AncfLinear, PinsACableInSpace) {
  Chain<AncfCable<>, Spherical, Constraint> held({}, 3);
  Chain<AncfCable<>, Spherical, AncfLinear> free({}, 3);
  Chain<AncfCable<>, Revolute, AncfLinear> pinned({.axis = Vec3::UnitZ()}, 3);
  held.fall(0.2);
  free.fall(0.2);
  pinned.fall(0.2);
  expect_same("AncfCable, Spherical", held, free, 1e-6);
  // the fourth equation of a pin keeps the chain in its plane, in which it moves without this equation too
  expect_same("AncfCable, Revolute", held, pinned, 1e-6);
  EXPECT_EQ(problem_size(pinned.model).coordinates, 3 * 18 - 3 * 4);
}

TEST(AncfLinear, ViolationIsTheDistanceAndTheDifferenceOfGradients) {
  Chain<AncfBeam<>, Revolute, AncfLinear> chain({.axis = Vec3::UnitZ()}, 2);
  EXPECT_LT(constraint_violation(chain.model, chain.x, chain.pins[1]).norm(), 1e-15);
  // node 0 of the second beam: position, then r_z, which lies along the pin
  Index const node = chain.model.coordinates() / 2;
  chain.x.q.segment<3>(node) += Vec3(0.01, -0.02, 0.03);
  chain.x.q.segment<3>(node + 9) += Vec3(0.1, 0.2, -0.3);
  VecX const open = constraint_violation(chain.model, chain.x, chain.pins[1]);
  ASSERT_EQ(open.size(), 6);
  EXPECT_LT((open.head<3>() - Vec3(0.01, -0.02, 0.03)).norm(), 1e-15);
  EXPECT_LT((open.tail<3>() - Vec3(0.1, 0.2, -0.3)).norm(), 1e-15);
  EXPECT_LT(constraint_violation(chain.model, chain.x, chain.pins[0]).norm(), 1e-15);
}

TEST(AncfLinear, PinsAFullyParameterisedBeamBySixEquations) {
  Chain<AncfBeam<>, Revolute, Constraint> held({.axis = Vec3::UnitZ()}, 2);
  Chain<AncfBeam<>, Revolute, AncfLinear> free({.axis = Vec3::UnitZ()}, 2);
  EXPECT_EQ(problem_size(held.model).rows, 2 * 5);
  EXPECT_EQ(problem_size(free.model).coordinates, 2 * 36 - 2 * 6);
  held.fall(0.2);
  free.fall(0.2);
  // the elastic line does not stretch the pin's line in planar motion: the sixth equation has no effect
  expect_same("AncfBeam, Revolute", held, free, 1e-6);
}

TEST(AncfLinear, OnlyTheStrainAlongThePinIsContinuous) {
  // Two beams with Poisson's ratio 0.3 that swing about z; a force along z bends and twists them. Strains ε_αβ = ½
  // (r_α·r_β − δ) on both sides of the pin about z. r_z is common, r_x and r_y are not: ε_zz has one value, the other
  // five have two each.
  using Pin = Joint<Revolute, AncfLinear>;
  Model<Bodies<AncfBeam<Continuum<>>>, Joints<Pin>, Forces<>> model{Gravity{0, -9.81, 4.0}};
  auto const a = model.add(AncfBeam<Continuum<>>::from(bar(Placement::at({0, 0, 0})), 2));
  auto const b = model.add(AncfBeam<Continuum<>>::from(bar(Placement::at({0.5, 0, 0})), 2));
  model.connect(Pin{{.axis = Vec3::UnitZ()}, {}}, model.ground().at({0, 0, 0}), a.at(0.0));
  model.connect(Pin{{.axis = Vec3::UnitZ()}, {}}, a.at(0.5), b.at(0.0));
  State x = model.reference_state();
  simulate(model, x, GeneralisedAlpha{.rho_inf = 0.5}, {.end_time = 0.3, .step = 1e-3}).run();
  auto const strains = [&](auto const& body, double s) {
    auto const& e = model.entry(body);
    auto const p = body.body().at(s);
    Eigen::Map<VecX const> const q(x.q.data() + e.q0 + e.body.first_column(p), 24);
    Mat3 j;
    for (int k = 0; k < 3; ++k) j.col(k) = body.body().gradient_map(p, k) * q;
    return Mat3(0.5 * (j.transpose() * j - Mat3::Identity()));
  };
  Mat3 const left = strains(a, 0.5), right = strains(b, 0.0);
  double const size = left.cwiseAbs().maxCoeff();
  EXPECT_GT(size, 1e-5);
  held_within({"thesis §3.5", "jump of the strain along a pin", By::closed_form, "0, r_z is shared",
               "AncfBeam<Continuum>, AncfLinear"},
              std::abs(left(2, 2) - right(2, 2)), 1e-14, {.scale = size});
  for (auto const& [i, j] : {std::pair{0, 0}, {1, 1}, {0, 1}, {0, 2}, {1, 2}}) {
    EXPECT_GT(std::abs(left(i, j) - right(i, j)), 1e-3 * size) << i << j;
  }
}

TEST(AncfLinear, WeldedBodiesAreOne) {
  // 3 × 2 welded elements, against one body of 6 elements: the same mesh
  Chain<planar::AncfCable<>, planar::Weld, AncfLinear> welded({}, 3);
  using Clamp = Joint<planar::Weld, AncfLinear>;
  Model<Bodies<planar::AncfCable<>>, Joints<Clamp>> full{Gravity{0, -9.81, 0}};
  Bar one = bar({});
  one.length = 1.5;
  auto const beam = full.add(planar::AncfCable<>::from(one, 6));
  full.connect(Clamp{}, full.ground().at({0, 0, 0}), beam.at(0.0));
  State x = full.reference_state();
  simulate(full, x, GeneralisedAlpha{}, {.end_time = 0.1, .step = 1e-3}).run();
  welded.fall(0.1);
  EXPECT_EQ(problem_size(full).coordinates, problem_size(welded.model).coordinates);
  Vec3 const tip = position(full, x, beam.at(1.5));
  EXPECT_LT(tip[1], -0.01);
  held_within({"thesis §3.5", "tip of three beams welded to one [m]", By::itself, "one body of six elements",
               "planar AncfCable, AncfLinear"},
              (tip - position(welded.model, welded.x, welded.links[2].at(0.5))).norm(), 1e-9, {.scale = 1.5});
}

TEST(AncfLinear, HoldsInStaticsWhatABalanceSays) {
  // a cantilever of two welded beams under a force P at its end: root force −P, root moment P L
  using Clamp = Joint<Weld, AncfLinear>;
  Model<Bodies<AncfBeam<Continuum<>>>, Joints<Clamp>, Forces<PointForce<>>> model;
  auto const a = model.add(AncfBeam<Continuum<>>::from(bar({}), 2)),
             b = model.add(AncfBeam<Continuum<>>::from(bar(Placement::at({0.5, 0, 0})), 2));
  auto const root = model.connect(Clamp{}, model.ground().at({0, 0, 0}), a.at(0.0));
  auto const joint = model.connect(Clamp{}, a.at(0.5), b.at(0.0));
  double const p = 1e-4;
  model.apply(PointForce<>{.force = {0, p, 0}}, b.at(0.5));
  State x = model.reference_state();
  equilibrium(model, x);
  Wrench<double> const at_root = reaction(model, x, root), between = reaction(model, x, joint);
  auto const balance = [&](char const* what, double error, double part) {
    held_within({"closed forms", what, By::closed_form, "−P, −P (L − x)", "AncfBeam<Continuum>, AncfLinear"}, error,
                part * p, {.scale = p});
  };
  balance("force at the root of a cantilever of two beams [N]", (at_root.f - Vec3(0, -p, 0)).norm(), 1e-6);
  balance("moment at the root of a cantilever of two beams [N m]", (at_root.m - Vec3(0, 0, -p)).norm(), 1e-4);
  balance("force between the two beams of a cantilever [N]", (between.f - Vec3(0, -p, 0)).norm(), 1e-6);
  balance("moment between the two beams of a cantilever [N m]", (between.m - Vec3(0, 0, -0.5 * p)).norm(), 1e-4);
  System system(model);
  system.evaluate(x.q, x.v, x.t);
  EXPECT_NEAR(peak_joint_force(system, x), p, 1e-6 * p);
}

TEST(AncfLinear, APinHoldsWhatBendsAcrossIt) {
  // the second beam hangs on a pin about z and is loaded along z at its end: the pin carries −r × P, about y
  using Clamp = Joint<Weld, AncfLinear>;
  using Pin = Joint<Revolute, AncfLinear>;
  Model<Bodies<AncfBeam<Continuum<>>>, Joints<Clamp, Pin>, Forces<PointForce<>>> model;
  auto const a = model.add(AncfBeam<Continuum<>>::from(bar({}), 2)),
             b = model.add(AncfBeam<Continuum<>>::from(bar(Placement::at({0.5, 0, 0})), 2));
  model.connect(Clamp{}, model.ground().at({0, 0, 0}), a.at(0.0));
  auto const pin = model.connect(Pin{{.axis = Vec3::UnitZ()}, {}}, a.at(0.5), b.at(0.0));
  double const p = 1e-4;
  model.apply(PointForce<>{.force = {0, 0, p}}, b.at(0.5));
  State x = model.reference_state();
  equilibrium(model, x);
  Wrench<double> const at_pin = reaction(model, x, pin);
  EXPECT_LT((at_pin.f - Vec3(0, 0, -p)).norm(), 1e-6 * p);
  EXPECT_LT((at_pin.m - Vec3(0, 0.5 * p, 0)).norm(), 1e-4 * p);
}

// A cable that has rotated about its pin: the reaction of the joint does not depend on the order of the two bodies.
TEST(AncfLinear, TheGroundTakesWhatACablesPinGives) {
  using Pin = Joint<Revolute, AncfLinear>;
  auto const pulled = [](bool ground_first) {
    Model<Bodies<AncfCable<>>, Joints<Pin>, Forces<PointForce<>>> model{Gravity{0, -9.81, 0}};
    auto const cable = model.add(AncfCable<>::from(bar({}), 2));
    Pin const pin{{.axis = Vec3::UnitZ()}, {}};
    auto const hinge = ground_first ? model.connect(pin, model.ground().at({0, 0, 0}), cable.at(0.0))
                                    : model.connect(pin, cable.at(0.0), model.ground().at({0, 0, 0}));
    model.apply(PointForce<>{.force = {0, 0, 0.1}, .axes = LoadAxes::world}, cable.at(0.5));
    State x = model.reference_state();
    simulate(model, x, GeneralisedAlpha{}, {.end_time = 0.2, .step = 1e-3}).run();
    return reaction(model, x, hinge);
  };
  Wrench<double> const to_cable = pulled(true), to_ground = pulled(false);
  EXPECT_GT(to_cable.m.norm(), 1e-3);
  EXPECT_LT((to_cable.f + to_ground.f).norm(), 1e-6 * to_cable.f.norm());
  EXPECT_LT((to_cable.m + to_ground.m).norm(), 1e-6 * to_cable.m.norm());
}

TEST(AncfLinear, RowsThatRepeatOthersAreNamed) {
  Chain<planar::AncfCable<>, planar::Revolute, AncfLinear> chain({}, 2);
  using Pin = Joint<planar::Revolute, AncfLinear>;
  chain.model.connect(Pin{}, chain.links[0].at(0.5), chain.links[1].at(0.0), "again");
  State x = chain.model.reference_state();
  auto run = simulate(chain.model, x, GeneralisedAlpha{}, {.end_time = 0.01, .step = 1e-3});
  run.run();
  ASSERT_EQ(run.report().redundant.size(), 1u);
  EXPECT_EQ(run.report().redundant[0], "joint \"again\"");
  EXPECT_EQ(problem_size(chain.model).coordinates, 2 * 12 - 2 * 2);
}

TEST(AncfLinear, RowsThatContradictOthersAreNamed) {
  Chain<planar::AncfCable<>, planar::Revolute, AncfLinear> chain({}, 2);
  using Pin = Joint<planar::Revolute, AncfLinear>;
  chain.model.connect(Pin{}, chain.model.ground().at({0.1, 0, 0}), chain.links[0].at(0.0), "second support");
  State x = chain.model.reference_state();
  EXPECT_TRUE(has(message_of<InconsistentInitialConditions>(
                      [&] { simulate(chain.model, x, GeneralisedAlpha{}, {.end_time = 0.01, .step = 1e-3}); }),
                  "second support"));
}

TEST(AncfLinear, RefusesWhatIsNotLinear) {
  using Pin = Joint<planar::Revolute, AncfLinear>;
  Model<Bodies<planar::AncfCable<>>, Joints<Pin>> model;
  auto const a = model.add(planar::AncfCable<>::from(bar({}), 2)),
             b = model.add(planar::AncfCable<>::from(bar(Placement::planar(0.5, 0)), 2));
  EXPECT_TRUE(has(refusal([&] { model.connect(Pin{}, a.at(0.5, 0.01), b.at(0.0), "hinge"); }),
                  "\"hinge\": planar::AncfCable: the position of a point off the axis is not linear in the "
                  "coordinates. Use y = 0 instead of y = 0.01 m. Use Constraint here."));
  EXPECT_EQ(model.markers(), 0);  // the refused joint adds no marker
  using Clamp = Joint<Weld, AncfLinear>;
  Model<Bodies<AncfCable<>>, Joints<Clamp, Joint<Revolute, AncfLinear>>> space;
  auto const c = space.add(AncfCable<>::from(bar({}), 2));
  auto const d = space.add(AncfCable<>::from(bar(Placement::at({0.5, 0, 0}, {0, 0, 1.0})), 2));
  EXPECT_TRUE(has(refusal([&] { space.connect(Clamp{}, c.at(0.5), d.at(0.0), "corner"); }), "\"corner\""));
  EXPECT_TRUE(has(refusal([&] {
                    space.connect(Joint<Revolute, AncfLinear>{{.axis = Vec3::UnitX()}, {}}, c.at(0.5), d.at(0.0),
                                  "pin");
                  }),
                  "\"pin\""));
}

}  // namespace ancf_linear_test
