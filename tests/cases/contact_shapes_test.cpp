// Boxes, capsules and polyhedra in contact: loads at rest, rolling, and the energy of impacts.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/bristle_friction.hpp>
#include <polybody/forces/contact_group.hpp>
#include <polybody/forces/shapes/box_contact.hpp>
#include <polybody/forces/shapes/capsule_contact.hpp>
#include <polybody/forces/shapes/shapes_on_plane.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/run/energy_audit.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/held.hpp"

using namespace polybody;

namespace contact_shapes_case_test {

constexpr double g = 9.81, mass = 1.0, k = 1e5;
constexpr DormandPrince<> precise{.relative_tolerance = 1e-11, .absolute_tolerance = 1e-13};
constexpr GeneralisedAlpha damped{.rho_inf = 0.8};
SpringDamperContact const pads{.stiffness = k, .damping = 60.0};
Friction const rough{.coefficient = 0.5, .slip_speed = 1e-3};

Mat3 inertia_of_box(double m, Vec3 const& s) {
  return Vec3(m / 12.0 * (s[1] * s[1] + s[2] * s[2]), m / 12.0 * (s[0] * s[0] + s[2] * s[2]),
              m / 12.0 * (s[0] * s[0] + s[1] * s[1]))
      .asDiagonal();
}
Claim closed_form(char const* what, char const* source, char const* formulation) {
  return {"closed forms", what, By::closed_form, source, formulation};
}
/// Largest speed of a body [m/s], with its rotation times 0.1 m.
double speed(Frame<double> const& f) { return f.v.norm() + 0.1 * f.w.norm(); }

/// A free body above the ground's marker at the origin.
template <class Law>
struct OverGround {
  Model<Bodies<Rigid<>>, Joints<>, Forces<Law>> model;
  BodyHandle<Rigid<>> body;
  ElementHandle<Law> contact;

  OverGround(Law const& law, Mat3 const& inertia, Placement const& at, Gravity const& gravity = {0, 0, -g})
      : model(gravity),
        body(model.add(Rigid<>(mass, inertia, at), "body")),
        contact(model.apply(law, body.at(Vec3(0, 0, 0)), model.ground().at({0, 0, 0}), "contact")) {}
  State start(Vec3 const& v, Vec3 const& w) const {
    State x = model.reference_state();
    model.set_velocity(x, body, v, w);
    return x;
  }
  Frame<double> frame_in(State const& x) const { return frame(model, x, body.at(Vec3(0, 0, 0))); }
};

// --- loads at rest ------------------------------------------------------------------------------------------------

// A box on a larger box on the floor. Each lower corner of the small box has four points with the weight 1/4: three at
// the depth d, and the far end of the upright edge at d − τ. Therefore m g = k (4 d − τ).
TEST(ContactShapes, BoxFallsOnABoxAndSettles) {
  using Stack = Contact<BoxOnBox>;
  using Floor = Contact<BoxOnPlane>;
  Vec3 const small(0.1, 0.1, 0.1), large(0.3, 0.4, 0.1);
  double const taper = 2e-5;
  Model<Bodies<Rigid<>>, Joints<>, Forces<Stack, Floor>> model{Gravity{0, 0, -g}};
  auto const lower = model.add(Rigid<>(2.0, inertia_of_box(2.0, large), Placement::at({0, 0, 0.0501})), "lower box");
  auto const upper = model.add(
      Rigid<>(mass, inertia_of_box(mass, small), Placement::at({0.05, -0.03, 0.19}, {0.1, 0.15, 0.4})), "upper box");
  model.apply(Floor{{.size = large, .rounding = 0.01}, pads, rough}, lower.at(Vec3(0, 0, 0)),
              model.ground().at({0, 0, 0}), "floor");
  auto const stack = model.apply(
      Stack{{.size_a = small, .rounding_a = 0.01, .size_b = large, .rounding_b = 0.01, .taper = taper}, pads, rough},
      upper.at(Vec3(0, 0, 0)), lower.at(Vec3(0, 0, 0)), "stack");
  State x = model.reference_state();
  Probe probe(model);
  for (State const& now : simulate(model, x, damped, {.end_time = 1.5, .step = 5e-4})) {
    ObservedState const seen(now, probe);
    if (now.t < 1.4999) continue;
    double load = 0.0;
    seen.for_each_contact(stack, [&](TouchingPoint const& p) { load += p.force[2]; });
    EXPECT_NEAR(load, mass * g, 1e-6);
  }
  Frame<double> const on_top = frame(model, x, upper.at(Vec3(0, 0, 0))),
                      below = frame(model, x, lower.at(Vec3(0, 0, 0)));
  EXPECT_LT(speed(on_top) + speed(below), 1e-4);
  EXPECT_NEAR(on_top.A.col(2).dot(below.A.col(2)), 1.0, 1e-9);
  held(closed_form("depth of a box on a box [m]", "(m g/k + τ)/4", "BoxOnBox, generalised-alpha, h = 0.5 ms"),
       0.1 - (on_top.r - below.r).dot(below.A.col(2)), 0.25 * (mass * g / k + taper), 1e-8);
  EXPECT_NEAR(below.r[2], 0.05 - 3.0 * mass * g / (4.0 * k), 1e-8);
}

// The bristles of a box on an inclined box hold it: after the first second it does not creep.
TEST(ContactShapes, BoxSticksToAnInclinedBox) {
  using Stick = Contact<BoxOnBox, SpringDamperContact, BristleFriction>;
  double const slope = std::atan(0.3);
  Vec3 const size(0.1, 0.1, 0.08);
  OverGround<Stick> const box(
      {{.size_a = size, .rounding_a = 0.01, .size_b = {1, 1, 0.2}, .rounding_b = 0.02, .taper = 1e-5},
       pads,
       {.coefficient = 0.5, .stiffness = 1e5, .damping = 60.0}},
      inertia_of_box(mass, size), Placement::at({0, 0, 0.14 - 2.4e-5}), {g * std::sin(slope), 0, -g * std::cos(slope)});
  State x = box.start({0, 0, 0}, {0, 0, 0});
  simulate(box.model, x, damped, {.end_time = 1.0, .step = 5e-4}).run();
  Frame<double> const before = box.frame_in(x);
  simulate(box.model, x, damped, {.end_time = 3.0, .step = 5e-4}).run();
  EXPECT_LT((box.frame_in(x).r - before.r).norm(), 1e-9);
  EXPECT_LT(before.r[0], 1e-4);
}

// A capsule across two fixed ones, with its centre at 0.1 m and 0.2 m from them: lever rule.
TEST(ContactShapes, CapsuleLiesAcrossTwoCapsules) {
  using Cross = Contact<CapsuleOnCapsule>;
  Model<Bodies<Rigid<>>, Joints<>, Forces<Cross>> model{Gravity{0, 0, -g}};
  auto const bar = model.add(Rigid<>(mass, Vec3(0.001, 0.02, 0.02).asDiagonal(), Placement::at({0, 0, 0.06})), "bar");
  Cross const cross{{.radius_a = 0.03, .length_a = 0.5, .radius_b = 0.03, .length_b = 0.3, .taper = 1e-5}, pads, rough};
  ElementHandle<Cross> at[2];
  for (int i = 0; i < 2; ++i)
    at[i] = model.apply(cross, bar.at(Vec3(0, 0, 0)),
                        model.ground().at(Placement::at({i == 0 ? -0.1 : 0.2, 0, 0}, {0, 0, 0.5 * EIGEN_PI})),
                        i == 0 ? "left" : "right");
  State x = model.reference_state();
  Probe probe(model);
  double load[2] = {};
  for (State const& now : simulate(model, x, damped, {.end_time = 1.0, .step = 5e-4})) {
    ObservedState const seen(now, probe);
    for (int i = 0; i < 2; ++i) {
      load[i] = 0.0;
      seen.for_each_contact(at[i], [&](TouchingPoint const& p) { load[i] += p.force[2]; });
    }
  }
  auto const claim = [](char const* source) {
    return closed_form("load of a capsule across two others [N]", source, "CapsuleOnCapsule, generalised-alpha");
  };
  held(claim("m g · 2/3"), load[0], mass * g * 2.0 / 3.0, 1e-3, {"near"});
  held(claim("m g/3"), load[1], mass * g / 3.0, 1e-3, {"far"});
}

/// A polyhedron falls and comes to rest with three corners on the floor, which carry m g/3 each.
void expect_three_corners(std::vector<Vec3> const& corners, double inertia, double height) {
  using Floor = Contact<PolyhedronOnPlane<>>;
  OverGround<Floor> const solid({{.corners = corners}, pads, rough}, inertia * Mat3::Identity(),
                                Placement::at({0, 0, 0.2}, {0.5, 0.8, 0.1}));
  State x = solid.start({0, 0, 0}, {1, 2, 0});
  Probe probe(solid.model);
  std::vector<double> loads;
  for (State const& now : simulate(solid.model, x, damped, {.end_time = 2.5, .step = 5e-4})) {
    ObservedState const seen(now, probe);
    loads.clear();
    seen.for_each_contact(solid.contact, [&](TouchingPoint const& p) { loads.push_back(p.force[2]); });
  }
  ASSERT_EQ(loads.size(), 3u);
  for (double const load : loads) EXPECT_NEAR(load, mass * g / 3.0, 1e-3);
  EXPECT_LT(speed(solid.frame_in(x)), 1e-4);
  EXPECT_NEAR(solid.frame_in(x).r[2], height - mass * g / (3.0 * k), 1e-7);
}
// Regular octahedron with corners at r: a face is at the distance r/√3 from the centre; J = m r²/5.
TEST(ContactShapes, OctahedronSettlesOnAFace) {
  double const r = 0.1;
  expect_three_corners({{r, 0, 0}, {-r, 0, 0}, {0, r, 0}, {0, -r, 0}, {0, 0, r}, {0, 0, -r}}, 0.2 * mass * r * r,
                       r / std::sqrt(3.0));
}
// Regular tetrahedron with corners at a (±1, ±1, ±1): a face is at the distance a/√3; edge l = 2 √2 a, J = m l²/20.
TEST(ContactShapes, TetrahedronSettlesOnAFace) {
  double const a = 0.06;
  expect_three_corners({{a, a, a}, {a, -a, -a}, {-a, a, -a}, {-a, -a, a}}, 0.4 * mass * a * a, a / std::sqrt(3.0));
}

// --- rolling ------------------------------------------------------------------------------------------------------

// A capsule slides, then rolls: m r v + J ω is constant about the line of contact, so that v = v₀/(1 + J/(m r²)).
TEST(ContactShapes, CapsuleRollsOnAPlane) {
  double const r = 0.05, axial = 1.1e-3, v = 2.0;
  OverGround<Contact<CapsuleOnPlane>> const roller({{.radius = r, .length = 0.4}, pads, rough},
                                                   Vec3(axial, 0.02, 0.02).asDiagonal(),
                                                   Placement::at({0, 0, r - mass * g / (2.0 * k)}));
  State x = roller.start({0, v, 0}, {0, 0, 0});
  simulate(roller.model, x, damped, {.end_time = 1.0, .step = 5e-4}).run();
  Frame<double> const f = roller.frame_in(x);
  held(closed_form("speed of a rolling capsule [m/s]", "v₀/(1 + J/(m r²))", "CapsuleOnPlane, generalised-alpha"),
       f.v[1], v / (1.0 + axial / (mass * r * r)), 1e-3 * v);
  EXPECT_NEAR(-r * f.w[0], f.v[1], 1e-3);
  EXPECT_LT(std::abs(f.v[0]) + std::abs(f.w[2]), 1e-6);
}

// --- energy -------------------------------------------------------------------------------------------------------

/// Energy and number of states in contact for a run without friction and damping.
template <class G>
void expect_conserved(G const& geometry, Mat3 const& inertia, Placement const& at, Vec3 const& v, Vec3 const& w,
                      double end) {
  using Elastic = Contact<G, HuntCrossleyContact>;
  OverGround<Elastic> const pair({geometry, {.stiffness = 5e6, .damping = 0.0}}, inertia, at);
  State x = pair.start(v, w);
  Probe probe(pair.model);
  double const before = energy(pair.model, x).total();
  double drift = 0.0;
  std::size_t most = 0, states = 0;
  for (State const& now : simulate(pair.model, x, precise, {.end_time = end, .step = 5e-4})) {
    ObservedState const seen(now, probe);
    std::size_t points = 0;
    seen.for_each_contact(pair.contact, [&](TouchingPoint const&) { ++points; });
    most = std::max(most, points);
    states += points > 0;
    drift = std::max(drift, std::abs(energy(pair.model, now).total() - before));
  }
  EXPECT_GT(states, 3u);
  EXPECT_GE(most, std::size_t(most_points<G>() > 1 ? 2 : 1));
  EXPECT_LT(drift, 1e-7 * std::max(1.0, std::abs(before)));
}
Vec3 const block(0.1, 0.12, 0.16), base(0.5, 0.5, 0.2);
BoxOnBox const boxes{.size_a = block, .rounding_a = 0.01, .size_b = base, .rounding_b = 0.01, .taper = 5e-5};

TEST(ContactShapes, BoxTumblesOnABoxWithoutLossOfEnergy) {
  expect_conserved(boxes, inertia_of_box(mass, block), Placement::at({0.1, 0, 0.25}, {0.3, 0.5, 0.1}), {0.3, 0.1, 0},
                   {1, 4, 1}, 0.5);
}
// aligned faces, with one face beyond an edge
TEST(ContactShapes, BoxFallsFlatOnTheEdgeOfABoxWithoutLossOfEnergy) {
  expect_conserved(boxes, inertia_of_box(mass, block), Placement::at({0.22, 0.05, 0.19}), {0.2, 0, 0}, {0, 0, 0}, 0.4);
}
TEST(ContactShapes, SphereBouncesOverTheEdgeOfABoxWithoutLossOfEnergy) {
  expect_conserved(SphereOnBox{.radius = 0.05, .size = base, .rounding = 0.01}, 0.001 * Mat3::Identity(),
                   Placement::at({0.15, 0.1, 0.18}), {0.25, 0, 0}, {0, 0, 0}, 0.6);
}
// nearly parallel capsules that rotate through the parallel position during the impact
TEST(ContactShapes, CapsulesThatBecomeParallelConserveEnergy) {
  expect_conserved(
      CapsuleOnCapsule{.radius_a = 0.04, .length_a = 0.3, .radius_b = 0.05, .length_b = 0.4, .taper = 5e-5},
      Vec3(0.001, 0.01, 0.01).asDiagonal(), Placement::at({0.02, 0, 0.0905}, {0, 0, -0.002}), {0, 0, -0.5},
      {0, 0.3, 4.0}, 0.02);
}
TEST(ContactShapes, CapsuleFallsAcrossABoxWithoutLossOfEnergy) {
  expect_conserved(CapsuleOnBox{.radius = 0.04, .length = 0.7, .size = base, .rounding = 0.01, .taper = 5e-5},
                   Vec3(0.001, 0.05, 0.05).asDiagonal(), Placement::at({0, 0.05, 0.17}, {0, 0.05, 0.3}), {0, 0, 0},
                   {0, 0, 1}, 0.5);
}
TEST(ContactShapes, EnergyAuditOfBoxesCloses) {
  OverGround<Contact<BoxOnBox, HuntCrossleyContact>> const pair(
      {boxes, {.stiffness = 2e6, .damping = 0.5}, {.coefficient = 0.3, .slip_speed = 0.1}}, inertia_of_box(mass, block),
      Placement::at({0.1, 0, 0.22}, {0.3, 0.5, 0.1}));
  State x = pair.start({0.3, 0.1, 0}, {1, 4, 1});
  EnergyAudit audit(pair.model);
  for (State const& now : simulate(pair.model, x, RungeKutta4{}, {.end_time = 0.25, .step = 1e-5})) audit.record(now);
  EXPECT_GT(audit.dissipated(), 0.1);
  EXPECT_LT(audit.relative(), 1e-6) << audit;
}

// --- groups -------------------------------------------------------------------------------------------------------

// Boxes in a group move like boxes with contacts one by one.
TEST(ContactShapes, ActInGroupsAsOneByOne) {
  using Floor = Contact<BoxOnPlane>;
  using OnBase = Contact<BoxOnBox>;
  using Group = ContactGroup<Floor, OnBase>;
  Floor const floor{{.size = block}, pads, rough};
  OnBase const on_base{boxes, pads, rough};
  Model<Bodies<Rigid<>>, Joints<>, Forces<Floor, OnBase>> single{Gravity{0, 0, -g}};
  Model<Bodies<Rigid<>>, Joints<>, Forces<Group>> grouped{Gravity{0, 0, -g}};
  std::vector<Marker<Rigid<>>> many;
  for (int i = 0; i < 2; ++i) {
    Rigid<> const body(mass, inertia_of_box(mass, block), Placement::at({0.4 * i, 0, 0.25 - 0.15 * i}, {0.2, 0.1, 0}));
    auto const box = single.add(body);
    single.apply(floor, box.at(Vec3(0, 0, 0)), single.ground().at({0, 0, 0}));
    single.apply(on_base, box.at(Vec3(0, 0, 0)), single.ground().at({0, 0, 0.05}));
    many.push_back(grouped.add(body).at(Vec3(0, 0, 0)));
  }
  auto const group = grouped.apply(Group{}, many, "boxes");
  grouped.add_partner(group, floor, grouped.ground().at({0, 0, 0}), "floor");
  grouped.add_partner(group, on_base, grouped.ground().at({0, 0, 0.05}), "base");
  State x = single.reference_state(), y = grouped.reference_state();
  simulate(single, x, RungeKutta4{}, {.end_time = 0.2, .step = 1e-4}).run();
  simulate(grouped, y, RungeKutta4{}, {.end_time = 0.2, .step = 1e-4}).run();
  EXPECT_LT((x.q - y.q).norm() + (x.v - y.v).norm(), 1e-9);
}

}  // namespace contact_shapes_case_test
