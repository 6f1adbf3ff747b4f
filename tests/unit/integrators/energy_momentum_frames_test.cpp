// Energy-conserving and energy-decaying steps of bodies whose coordinates are frames: `Rigid<>`, `Lrvf` and `Se3Beam`.

#include <polybody/integrators/energy_momentum.hpp>

#include <gtest/gtest.h>

#include <functional>

#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/bodies/se3/se3_beam.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/joints/policies/bushing.hpp>
#include <polybody/joints/policies/penalty.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/marker_frames.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/energy_drift.hpp"
#include "support/solver_instances.hpp"

using namespace polybody;

namespace energy_momentum_frames_test {

Bar rod(double damping = 0.0) {
  return {
      .length = 1.0,
      .constants =
          BarConstants{
              .EA = 2e3, .EI = 3.0, .mass_per_length = 0.5, .GA = 1e3, .GJ = 2.0, .rotary_inertia = 0.01, .EI_y = 4.0},
      .damping = {.axial = damping, .shear = damping, .bending = damping}};
}

/// Section with couplings of all strains, and with the mass outside of the axis.
Section6 coupled() {
  Section6 section;
  Mat<double, 6, 6> factor = Mat<double, 6, 6>::Zero();
  double const scale[] = {40.0, 30.0, 35.0, 1.4, 2.0, 1.7};
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j <= i; ++j)
      factor(i, j) = i == j ? scale[i] : 0.2 * std::sqrt(scale[i] * scale[j]) * (i % 2 - 0.3);
  section.stiffness = factor * factor.transpose();
  double const m = 0.5, y = 0.02, z = -0.01;
  section.mass = Vec6(m, m, m, 0.02, 0.012, 0.01).asDiagonal();
  section.mass(0, 4) = section.mass(4, 0) = m * z;
  section.mass(0, 5) = section.mass(5, 0) = -m * y;
  section.mass(1, 3) = section.mass(3, 1) = -m * z;
  section.mass(2, 3) = section.mass(3, 2) = m * y;
  return section;
}

Mat3 const inertia = Vec3(1.0, 2.0, 2.5).asDiagonal();

/// Error of the rotation vector of a free body after 2 s, with steps of h [s].
double attitude_error(double h) {
  Model<Bodies<Rigid<>>, Joints<>> model;
  auto const body = model.add(Rigid<>(1.0, inertia), "body");
  auto const turned = [&](auto const& integrator, double step) {
    State x = model.reference_state();
    x.v << 0, 0, 0, 0.1, 3.0, 0.2;
    simulate(model, x, integrator, {.end_time = 2.0, .step = step}).run();
    return frame(model, x, body.centre()).A;
  };
  return log_so3(turned(Radau{.tolerance = 1e-12}, 1e-3).transpose() * turned(EnergyMomentum{}, h)).norm();
}

// The unstable rotation about the middle axis of inertia.
TEST(EnergyMomentumOfFrames, FreeRotationHasOrderTwo) {
  double const coarse = attitude_error(0.02), fine = attitude_error(0.01);
  EXPECT_LT(coarse, 0.05);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.1) << coarse << " " << fine;
}

TEST(EnergyMomentumOfFrames, FreeRotationKeepsEnergyAndMomentum) {
  Model<Bodies<Rigid<>>, Joints<>> model;
  model.add(Rigid<>(1.0, inertia), "body");
  State x = model.reference_state();
  x.v << 1.0, 2.0, 3.0, 0.1, 5.0, 0.2;
  held_drift(drift_of(model, x, EnergyMomentum{}, 0.01, 10000),
             "free Rigid about its middle axis, EnergyMomentum, 1e4 steps of 10 ms");
}

// A top on a spherical joint. Gravity exerts no moment about the vertical through the joint.
TEST(EnergyMomentumOfFrames, HeavyTopKeepsEnergyAndVerticalMomentum) {
  Model<Bodies<Rigid<>>, Joints<Joint<Spherical, Constraint>>> model{Gravity{0, 0, -9.81}};
  auto const top = model.add(Rigid<>({.mass = 15.0,
                                      .inertia = Vec3(0.234375, 0.46875, 0.234375).asDiagonal(),
                                      .placement = {.origin = {0, 1, 0}}}),
                             "top");
  model.connect(Joint{Spherical{}, Constraint{}}, model.ground().at({0, 0, 0}), top.at(Vec3(0, -1, 0)), "tip");
  State x = model.reference_state();
  model.set_velocity(x, top, Vec3::Zero(), Vec3(0, 150.0, -4.61));
  double const before = momentum(model, x).angular[2];
  Drift const drift = drift_of(model, x, EnergyMomentum{}, 2e-3, 10000);
  EXPECT_LT(drift.energy, 1e-8);
  EXPECT_LT(drift.violation, 1e-11);
  EXPECT_NEAR(momentum(model, x).angular[2] / before, 1.0, 1e-8);
}

/// Two bodies and two rods in free flight: a spherical joint at a node and one inside of an element, a revolute joint,
/// a penalty, a bushing and a spring.
template <class B>
struct Flock {
  using Ball = Joint<Spherical, Constraint>;
  using Hinge = Joint<Revolute, Constraint>;
  using Soft = Joint<Spherical, Penalty>;
  using Pad = Joint<Revolute, Bushing>;
  Model<Bodies<B, Rigid<>>, Joints<Ball, Hinge, Soft, Pad>, Forces<SpringDamper>> model;
  State x;
  std::function<std::vector<Vec3>()> positions;  ///< of points of the four bodies at x
  explicit Flock(double damping, bool hinge = false, Placement const& moved = {}) {
    auto const at = [&](Vec3 const& r) {
      return Placement{.origin = moved.origin + moved.axes * r, .axes = moved.axes};
    };
    Bar first_rod = rod(damping), second_rod = rod(damping);
    first_rod.placement = at({0, 0, 0});
    second_rod.placement = at({1.2, 0, 0});
    second_rod.constants.reset();
    second_rod.section = coupled();
    auto const first = model.add(B::from(first_rod, 3), "first"), second = model.add(B::from(second_rod, 3), "second");
    auto const body =
                   model.add(Rigid<>({.mass = 0.4, .inertia = 0.01 * inertia, .placement = at({1.1, 0, 0})}), "body"),
               rider = model.add(Rigid<>({.mass = 0.3, .inertia = 0.01 * inertia, .placement = at({0.4, 0.1, 0})}),
                                 "rider");
    model.connect(Ball{}, first.at(1.0), body.at(Vec3(-0.1, 0, 0)), "ball");
    model.connect(Ball{}, first.at(0.4, 0.1, 0.0), rider.at(Vec3(0, 0, 0)), "inside");
    if (hinge)
      model.connect(Hinge{{.axis = Vec3(moved.axes.col(1))}}, body.at(Vec3(0.1, 0, 0)), second.at(0.0), "hinge");
    else {
      model.connect(Soft{{}, {.stiffness = 1e4, .damping = 0.0}}, body.at(Vec3(0.1, 0, 0)), second.at(0.0), "soft");
      model.connect(Pad{{.axis = Vec3(moved.axes.col(0))},
                        {.stiffness = Bushing::diagonal(Vec3::Constant(300.0), Vec3::Constant(2.0)),
                         .damping = Bushing::Matrix::Zero()}},
                    first.at(0.0), rider.at(Vec3(-0.4, -0.1, 0)), "pad");
    }
    model.apply(SpringDamper{.stiffness = 20.0, .free_length = 1.0}, rider.at(Vec3(0.1, 0, 0)), second.at(0.9),
                "spring");
    x = model.reference_state();
    Vec3 const omega = moved.axes * Vec3(0.5, 1.0, 3.0), v0 = moved.axes * Vec3(1, 0, 0.5) + moved.origin.cross(omega);
    for (auto const& part : {first, second}) model.set_velocity(x, part, v0, omega);
    for (auto const& part : {body, rider}) model.set_velocity(x, part, v0, omega);
    positions = [this, first, second, body, rider] {
      return std::vector<Vec3>{position(model, x, first.at(0.7, 0.05, 0.0)), position(model, x, second.at(1.0)),
                               position(model, x, second.at(0.0, 0.0, 0.1)), position(model, x, body.at(Vec3(0, 1, 0))),
                               position(model, x, rider.at(Vec3(0, 0, 1)))};
    };
  }
};

template <class B>
struct EnergyMomentumOfRods : testing::Test {};
using Rods = testing::Types<Se3Beam, Lrvf<>, Lrvf<RelativeRotation, FullQuadrature>>;
TYPED_TEST_SUITE(EnergyMomentumOfRods, Rods);

TYPED_TEST(EnergyMomentumOfRods, JointsOfPointsAndSpringsKeepEnergyAndMomenta) {
  Flock<TypeParam> flock(0.0);
  expect_invariants(drift_of(flock.model, flock.x, EnergyMomentum{}, 0.005, 10000));
}

TYPED_TEST(EnergyMomentumOfRods, JointsOfAxesKeepEnergyAndMomenta) {
  Flock<TypeParam> flock(0.0, true);
  expect_invariants(drift_of(flock.model, flock.x, EnergyMomentum{}, 0.005, 10000));
}

/// Two rods and two bodies in free flight: a universal joint, a prismatic joint, and a weld by penalties of axes.
template <class B>
struct Row {
  using Cross = Joint<Universal, Constraint>;
  using Slide = Joint<Prismatic, Constraint>;
  using Soft = Joint<Weld, PenaltyPerEquation<6>>;
  Model<Bodies<B, Rigid<>>, Joints<Cross, Slide, Soft>> model;
  State x;
  Row() {
    Bar second_rod = rod();
    second_rod.placement.origin = {1.4, 0, 0};
    auto const first = model.add(B::from(rod(), 3), "first"), second = model.add(B::from(second_rod, 3), "second");
    auto const block = model.add(
                   Rigid<>({.mass = 0.4, .inertia = 0.01 * inertia, .placement = {.origin = {1.1, 0, 0}}}), "block"),
               slider = model.add(
                   Rigid<>({.mass = 0.3, .inertia = 0.01 * inertia, .placement = {.origin = {1.3, 0.1, 0}}}), "slider");
    model.connect(Cross{{.first = {0, 1, 0}, .second = {0, 0, 1}}, {}}, first.at(1.0), block.at(Vec3(-0.1, 0, 0)),
                  "cross");
    model.connect(Slide{{.axis = {0, 1, 0}}, {}}, block.at(Vec3(0.1, 0.1, 0)), slider.at(Vec3(-0.1, 0, 0)), "slide");
    Vec6 stiffness;
    stiffness << 1e4, 1e4, 1e4, 50.0, 80.0, 60.0;  // equal for the components in world axes
    model.connect(Soft{{}, {.stiffness = stiffness, .damping = Vec6(Vec6::Zero())}}, slider.at(Vec3(0.1, -0.1, 0)),
                  second.at(0.0), "weld");
    x = model.reference_state();
    for (auto const& part : {first, second}) model.set_velocity(x, part, Vec3(1, 0, 0.5), Vec3(0.5, 1.0, 3.0));
    for (auto const& part : {block, slider}) model.set_velocity(x, part, Vec3(1, 0, 0.5), Vec3(0.5, 1.0, 3.0));
  }
};

TYPED_TEST(EnergyMomentumOfRods, UniversalPrismaticAndPenaltiesOfAxesKeepEnergyAndMomenta) {
  Row<TypeParam> row;
  expect_invariants(drift_of(row.model, row.x, EnergyMomentum{}, 0.002, 10000));
}

// The damping of the rods reduces the energy in every step; the momenta are constant.
TYPED_TEST(EnergyMomentumOfRods, DampersOnlyTakeEnergy) {
  Flock<TypeParam> flock(5e-3, true);
  expect_decay(drift_of(flock.model, flock.x, EnergyMomentum{}, 0.005, 10000), 1e-3);
}

TYPED_TEST(EnergyMomentumOfRods, EnergyDecayingOnlyTakesEnergy) {
  Flock<TypeParam> flock(0.0, true);
  Drift const drift = drift_of(flock.model, flock.x, EnergyDecaying{.rho_inf = 0.8}, 0.005, 10000);
  EXPECT_LT(drift.largest_gain, 1e-11);
  EXPECT_GT(drift.energy, 1e-3);
  EXPECT_LT(drift.linear, 1e-10);
}

// A rigid motion of the start moves the whole motion.
TYPED_TEST(EnergyMomentumOfRods, RigidMotionOfTheStartMovesTheResult) {
  Mat3 const turn = exp_so3<double>({1.0, -0.5, 2.0});
  auto const end = [&](bool moved) {
    Model<Bodies<TypeParam>, Joints<>> model;
    Bar bar = rod(2e-3);
    if (moved) bar.placement = {.origin = {3, -2, 5}, .axes = turn};
    auto const body = model.add(TypeParam::from(bar, 3), "rod");
    State x = model.reference_state();
    for (Index node = 0; node < 4; ++node) {
      Vec3 const v = Vec3(0.3 * double(node), 1.0 - double(node), 0.5 * double(node * node));
      x.v.template segment<3>(6 * node) = moved ? Vec3(turn * v) : v;
      x.v.template segment<3>(6 * node + 3) << 1.0 - double(node), 2.0, 0.5;
    }
    simulate(model, x, EnergyMomentum{.tolerance = 1e-12}, {.end_time = 0.5, .step = 0.005}).run();
    return position(model, x, body.at(0.9, 0.05, 0.0));
  };
  EXPECT_LT((turn * end(false) + Vec3(3, -2, 5) - end(true)).norm(), 1e-9);
}

// Runs with all joints, a spring and damped rods are equal too. The bushing's components refer to axes that the
// library derives from the joint axis; the rotation of the start also moves these axes.
TYPED_TEST(EnergyMomentumOfRods, RigidMotionOfTheStartMovesJointedModels) {
  auto const axes_of_pad = [](Vec3 const& axis) { return constraint_functions::triad_about(axis, "pad"); };
  Placement const moved{.origin = {3, -2, 5},
                        .axes = axes_of_pad(Vec3(2, -3, 6) / 7.0) * axes_of_pad(Vec3(1, 0, 0)).transpose()};
  auto const distance = [&](auto const& integrator, bool hinge) {
    auto const ends = [&](Placement const& start) {
      Flock<TypeParam> flock(2e-3, hinge, start);
      simulate(flock.model, flock.x, integrator, {.end_time = 0.5, .step = 0.005}).run();
      return flock.positions();
    };
    auto const plain = ends({}), there = ends(moved);
    double largest = 0.0;
    for (std::size_t i = 0; i < plain.size(); ++i)
      largest = std::max(largest, (moved.origin + moved.axes * plain[i] - there[i]).norm());
    return largest;
  };
  for (bool const hinge : {false, true}) {
    EXPECT_LT(distance(EnergyMomentum{.tolerance = 1e-12}, hinge), 1e-11);
    EXPECT_LT(distance(EnergyDecaying{.rho_inf = 0.8, .tolerance = 1e-12}, hinge), 1e-11);
  }
}

TYPED_TEST(EnergyMomentumOfRods, StepHasOrderTwo) {
  auto const end = [&](auto const& integrator, double h) {
    Flock<TypeParam> flock(0.0, true);
    simulate(flock.model, flock.x, integrator, {.end_time = 0.1, .step = h}).run();
    return VecX(flock.x.q);
  };
  VecX const exact = end(Radau{.tolerance = 1e-11}, 2.5e-4);
  double const coarse = (end(EnergyMomentum{}, 1e-3) - exact).norm(),
               fine = (end(EnergyMomentum{}, 5e-4) - exact).norm();
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.2) << coarse << " " << fine;
}

}  // namespace energy_momentum_frames_test
