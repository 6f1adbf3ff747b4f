// Equilibria with a singular stiffness: redundant constraints, and free motions without stiffness.
#include <gtest/gtest.h>

#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/forces/scalar_force.hpp>
#include <polybody/forces/spring_laws.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/minimum_norm.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/statics/arc_length.hpp>
#include <polybody/statics/equilibrium.hpp>

#include "support/chain.hpp"
#include "support/refusal.hpp"

using namespace polybody;

namespace neutral_equilibrium_test {

/// Rods of 1 m and 1 kg, pinned to each other. The first and the last one are pinned to the ground. \tparam Where as
/// for `Chain`
template <class Where>
struct HungChain {
  using Body = typename Where::Body;
  Model<Bodies<Body>, Joints<typename Where::Hinge>> model{Gravity{0, -9.81, 0}};
  std::vector<BodyHandle<Body>> rods;
  std::vector<ElementHandle<typename Where::Hinge>> pins;
  State x;
  EquilibriumReport report;

  explicit HungChain(int n) {
    std::vector<Vec3> points{{0, 0, 0}};
    for (int i = 0; i < n; ++i) {
      double const slope = 2.0 * (i + 0.5) / n - 1.0 + (n > 2 ? 0.1 * std::sin(7.0 * i) : 0.0);
      points.push_back(points.back() + Vec3(std::cos(slope), std::sin(slope), 0));
      Vec3 const middle = 0.5 * (points[std::size_t(i)] + points.back());
      rods.push_back(model.add(Where::body(bar_link(), Placement::planar(middle.x(), middle.y(), slope))));
    }
    auto const pin = Where::hinge({});
    auto const name = [](int i) { return "pin " + std::to_string(i); };
    pins.push_back(model.connect(pin, model.ground().at({0, 0, 0}), Where::at(rods[0], -0.5), name(0)));
    for (int i = 1; i < n; ++i)
      pins.push_back(
          model.connect(pin, Where::at(rods[std::size_t(i) - 1], 0.5), Where::at(rods[std::size_t(i)], -0.5), name(i)));
    pins.push_back(model.connect(pin, Where::at(rods.back(), 0.5), model.ground().at(points.back()), name(n)));
    x = model.reference_state();
    report = equilibrium(model, x);
  }
};

// In space the parallel pins have three redundant constraint equations. The chain hangs as in the plane, and the
// joints carry the same forces. For two rods of half span c and sag s, c² + s² = 1, each end carries m g upwards and
// H = m g c/(2 s) inwards.
TEST(HungChain, InSpaceHangsAsInThePlane) {
  for (int const n : {2, 3, 6, 20}) {
    HungChain<InPlane<Constraint>> const plane(n);
    HungChain<InSpace<Constraint>> const space(n);
    EXPECT_TRUE(plane.report.redundant.empty());
    EXPECT_FALSE(space.report.redundant.empty()) << n;
    EXPECT_TRUE(space.report.free_motions.empty()) << n;
    for (std::size_t i = 0; i < plane.pins.size(); ++i) {
      Vec3 const a = reaction(plane.model, plane.x, plane.pins[i]).f,
                 b = reaction(space.model, space.x, space.pins[i]).f;
      EXPECT_LT((a - b).norm(), 1e-8 * (1.0 + a.norm())) << n << ' ' << i;
      EXPECT_TRUE(space.x.lambda.allFinite());
    }
    if (n != 2) continue;
    double const half = position(space.model, space.x, InSpace<Constraint>::at(space.rods[0], 0.5)).x();
    double const sag = std::sqrt(1.0 - half * half);
    Vec3 const end = reaction(space.model, space.x, space.pins[0]).f;
    EXPECT_NEAR(std::abs(end.y()), 9.81, 1e-9);
    EXPECT_NEAR(std::abs(end.x()), 9.81 * half / (2.0 * sag), 1e-8);
  }
}

// On ball joints no constraint is redundant, but each rod can rotate about its axis.
TEST(HungChain, OnBallJointsSpinsRodByRod) {
  int const n = 12;
  HungChain<InPlane<Constraint>> const plane(n);
  HungChain<OnBallJoints<Constraint>> const balls(n);
  EXPECT_TRUE(balls.report.redundant.empty());
  ASSERT_EQ(balls.report.free_motions.size(), std::size_t(n));
  for (std::size_t i = 0; i < balls.rods.size(); ++i) {
    EXPECT_TRUE(has(balls.report.free_motions[i], "body \"" + balls.rods[i].name + "\" turns about ("));
    EXPECT_LT((position(plane.model, plane.x, InPlane<Constraint>::at(plane.rods[i], 0.5)) -
               position(balls.model, balls.x, OnBallJoints<Constraint>::at(balls.rods[i], 0.5)))
                  .norm(),
              1e-9)
        << i;
  }
}

// Two parallel rods: the constraint equation of the second one is dropped. With the option both share the load.
TEST(RowsThatRepeat, BearNothingOrShareTheLoad) {
  Model<Bodies<Rigid<>>, Joints<Joint<Distance, Constraint>>> model{Gravity{0, 0, -9.81}};
  auto const payload = model.add(Rigid<>(3.0, 0.2 * Mat3::Identity(), Placement::at({0.5, 0, -2.0})), "payload");
  Joint<Distance, Constraint> const rod{Distance{.length = Vec3(0.5, 0, -1.5).norm()}};
  for (char const* name : {"rope", "rope again"})
    model.connect(rod, model.ground().at({0, 0, 0}), payload.at(Vec3(0, 0, 0.5)), name);
  State x = model.reference_state();
  EquilibriumReport const report = equilibrium(model, x);
  EXPECT_EQ(report.redundant, std::vector<std::string>{"joint \"rope again\""});
  EXPECT_EQ(report.free_motions.size(), 1u);
  EXPECT_NEAR(x.lambda[0], 29.43, 1e-9);
  EXPECT_EQ(x.lambda[1], 0.0);
  VecX const shared = minimum_norm_multipliers(model, x);
  EXPECT_NEAR(shared[0], 0.5 * 29.43, 1e-9);
  EXPECT_NEAR(shared[1], 0.5 * 29.43, 1e-9);
}

// A payload on a rod hangs below its hook for every initial state. Only its rotation about the vertical is free, and
// is named.
TEST(NeutralFreedom, OfAPayloadIsItsSpin) {
  for (Vec3 const& start : {Vec3(0, 0, -2.5), Vec3(0.3, 0.2, -2.0)})
    for (Vec3 const& eye : {Vec3(0, 0, 0.5), Vec3(0.1, 0.05, 0.5)}) {
      double const length = (start + eye).norm();
      Model<Bodies<Rigid<>>, Joints<Joint<Distance, Constraint>>> model{Gravity{0, 0, -9.81}};
      auto const payload =
          model.add(Rigid<>(3.0, Vec3(0.1, 0.2, 0.3).asDiagonal().toDenseMatrix(), Placement::at(start)), "payload");
      auto const rope = model.connect(Joint<Distance, Constraint>{Distance{.length = length}},
                                      model.ground().at({0, 0, 0}), payload.at(eye), "rope");
      State x = model.reference_state();
      EquilibriumReport const report = equilibrium(model, x);
      EXPECT_EQ(report.free_motions,
                std::vector<std::string>{"body \"payload\" turns about (0, 0, 1) through (0, 0, 0)"});
      EXPECT_LT((position(model, x, payload.at(Vec3(0, 0, 0))) - Vec3(0, 0, -length - eye.norm())).norm(), 1e-9);
      EXPECT_NEAR(std::abs(reaction(model, x, rope).f.z()), 3.0 * 9.81, 1e-9);
      if (start.x() == 0.0 && eye.x() == 0.0) {  // its position is unchanged
        EXPECT_LT(std::abs(x.q[6]), 1e-12);
      }
    }
}

/// Deflection [m] of a boom on a mast that turns about the vertical, with a load of 500 kg on one or two ropes. \tparam
/// B body of the boom
template <class B>
double sag_of_a_slewing_crane(Index elements, int ropes) {
  using Cable = OnDistance<Rope>;
  Model<Bodies<Rigid<>, B>, Joints<Joint<Revolute, Constraint>, Joint<Weld, Constraint>>, Forces<Cable>> model{
      Gravity{0, 0, -9.81}};
  auto const mast = model.add(Rigid<>(5000.0, 1000.0 * Mat3::Identity()), "mast");
  auto const boom = model.add(B::from({.length = 8.0,
                                       .section = Rectangle{.height = 0.1, .width = 0.12},
                                       .material = Material{.density = 7800, .young = 2.1e11}},
                                      elements),
                              "boom");
  auto const load = model.add(Rigid<>(500.0, 30.0 * Mat3::Identity(), Placement::at({8, 0, -4.3})), "load");
  model.connect(Joint<Revolute, Constraint>{{.axis = {0, 0, 1}}}, model.ground().at({0, 0, 0}), mast.centre());
  model.connect(Joint<Weld, Constraint>{}, mast.centre(), boom.at(0.0));
  for (int i = 0; i < ropes; ++i) {
    double const y = 0.1 * (i - 0.5 * (ropes - 1));
    model.apply(Cable{{.stiffness = 1e6 / ropes, .length = 3.995}}, boom.at(8.0, y, 0.0), load.at({0, y, 0.3}));
  }
  State x = model.reference_state();
  EquilibriumReport const report = equilibrium(model, x);
  EXPECT_EQ(report.negative_pivots, 0);
  EXPECT_TRUE(report.warnings.empty());
  return -position(model, x, boom.at(8.0))[2];
}

// The spin of the load about one rope, and the rotation of the crane, are free: they are neither unstable nor refused.
TEST(NeutralFreedom, OfASlewingCraneIsNotUnstable) {
  for (Index const n : {8, 16}) {
    double const lrvf = sag_of_a_slewing_crane<Lrvf<>>(n, 2), ancf = sag_of_a_slewing_crane<AncfBeam<>>(n, 2);
    EXPECT_NEAR(lrvf, 0.431, 0.002);
    EXPECT_NEAR(sag_of_a_slewing_crane<Lrvf<>>(n, 1), lrvf, 1e-6 * lrvf);
    EXPECT_NEAR(sag_of_a_slewing_crane<AncfBeam<>>(n, 1), ancf, 1e-6 * ancf);
  }
}

using Float = Model<Bodies<planar::Lrvf>, Joints<Joint<planar::Weld, Constraint>>, Forces<PointForce<>>>;

/// Floating beam under the axial forces `left` and `right`.
struct Floating {
  Float model;
  Vec3 const along{std::cos(0.7), std::sin(0.7), 0};
  BodyHandle<planar::Lrvf> beam;

  Floating(Index n, double left, double right)
      : beam(model.add(
            planar::Lrvf::from({.length = 2.0,
                                .constants = BarConstants{.EA = 1e4, .EI = 1.0, .mass_per_length = 1.0, .GA = 1e4},
                                .placement = Placement::planar(0.3, 0.2, 0.7)},
                               n),
            "beam")) {
    model.apply(PointForce<>{.force = Vec3(-left * along)}, beam.at(0.0));
    model.apply(PointForce<>{.force = Vec3(right * along)}, beam.at(2.0));
  }
};

// Under F at both ends the beam is longer by F L/EA, and its middle is at rest: the equilibrium with the least
// motion. The dense solver is used for 4 elements, the sparse one for 40. The arc-length method agrees.
TEST(NeutralFreedom, OfABeamInTensionIsToMove) {
  for (Index const n : {4, 40}) {
    Floating const s(n, 10.0, 10.0);
    State x = s.model.reference_state();
    Vec3 const middle = position(s.model, x, s.beam.at(1.0));
    EquilibriumReport const report = equilibrium(s.model, x);
    EXPECT_EQ(report.free_motions.size(), 2u) << n;
    for (std::string const& motion : report.free_motions) EXPECT_TRUE(has(motion, "body \"beam\" moves along ("));
    auto const check_step = [&](State const& at, double tolerance) {
      Vec3 const ends = position(s.model, at, s.beam.at(2.0)) - position(s.model, at, s.beam.at(0.0));
      EXPECT_LT((ends - (2.0 + 10.0 * 2.0 / 1e4) * s.along).norm(), tolerance) << n;
      EXPECT_LT((position(s.model, at, s.beam.at(1.0)) - middle).norm(), tolerance) << n;
    };
    check_step(x, 1e-11);
    auto const path = equilibrium_path(s.model, s.model.reference_state(), {.step = 0.25, .max_step = 0.25},
                                       [](PathPoint const& p) { return p.load_factor > 0.999; });
    Vec3 const ends =
        position(s.model, path.back().x, s.beam.at(2.0)) - position(s.model, path.back().x, s.beam.at(0.0));
    EXPECT_NEAR(ends.norm(), 2.0 + path.back().load_factor * 20.0 / 1e4, 1e-9) << n;
  }
}

// An excess of one part in a thousand at one end: no equilibrium exists, and the message gives the direction of the
// motion.
TEST(NeutralFreedom, ThatALoadExcitesIsRefused) {
  for (Index const n : {4, 40}) {
    Floating const s(n, 10.0, 10.01);
    State x = s.model.reference_state();
    State const before = x;
    std::string const text = message_of<SingularMatrix>([&] { equilibrium(s.model, x); });
    EXPECT_TRUE(has(text, "No stiffness resists this motion: body \"beam\"")) << n;
    EXPECT_TRUE(has(text, "The loads excite this motion")) << n;
    EXPECT_TRUE(x.q == before.q && x.v == before.v) << n;
    EXPECT_THROW(equilibrium_path(s.model, before), SingularMatrix) << n;
  }
}

}  // namespace neutral_equilibrium_test
