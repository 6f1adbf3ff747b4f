// No step allocates heap memory. This test is a separate program: it replaces malloc and operator new of the library.
// It replaces malloc on glibc only and without a sanitizer, which has its own malloc.

#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/bodies/se3/planar_se3_beam.hpp>
#include <polybody/bodies/se3/se3_beam.hpp>
#include <polybody/forces/contact.hpp>
#include <polybody/forces/contact_group.hpp>
#include <polybody/forces/contact_set.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/integrators/adams_bashforth_moulton.hpp>
#include <polybody/integrators/coordinate_partitioning.hpp>
#include <polybody/integrators/energy_momentum.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/integrators/symplectic.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/policies/bushing.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/solvers/dense_lu.hpp>

#include "support/chain.hpp"
#include "support/measured_sections.hpp"

namespace {
long taken = 0;  // number of allocations
}

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define POLYBODY_TEST_SANITIZED
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define POLYBODY_TEST_SANITIZED
#endif

#if defined(__GLIBC__) && !defined(POLYBODY_TEST_SANITIZED)
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void* malloc(std::size_t n) { return ++taken, __libc_malloc(n); }
void* calloc(std::size_t n, std::size_t size) { return ++taken, __libc_calloc(n, size); }
void* realloc(void* p, std::size_t n) { return ++taken, __libc_realloc(p, n); }
void* aligned_alloc(std::size_t alignment, std::size_t n) { return ++taken, __libc_memalign(alignment, n); }
int posix_memalign(void** p, std::size_t alignment, std::size_t n) {
  ++taken;
  *p = __libc_memalign(alignment, n);
  return *p == nullptr;
}
}
#endif

// malloc and new are both replaced here, so the pairing of free with new is correct.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"
void* operator new(std::size_t n) {
  ++taken;
  if (void* p = std::malloc(n)) return p;
  throw std::bad_alloc();
}
void* operator new[](std::size_t n) { return operator new(n); }
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete[](void* p) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t) noexcept { std::free(p); }

using namespace polybody;

namespace {

/// Five links on pins in space.
struct RigidChain {
  Chain<InSpace<Constraint>> chain{5, bar_link(0.3)};
  auto const& model() const { return chain.model; }
};

/// The chain of five links in the plane.
struct PlanarChain {
  Chain<InPlane<Constraint>> chain{5, bar_link(0.3)};
  auto const& model() const { return chain.model; }
};

/// An arm of Lrvf elements on a pin, with a driving constraint at its root.
struct DrivenArm {
  using Pin = Joint<planar::Revolute, Constraint>;
  using Drive = Joint<PrescribedAngle<SpinUp>, Constraint>;
  Model<Bodies<planar::Lrvf>, Joints<Pin, Drive>> arm{Gravity{0, -9.81, 0}};

  DrivenArm() {
    Bar const bar{
        .length = 1.0,
        .constants = BarConstants{.EA = 1e5, .EI = 50, .mass_per_length = 1.0, .GA = 3e4, .rotary_inertia = 1e-3},
        .damping = {.axial = 1e-3, .shear = 1e-3, .bending = 1e-3}};
    auto const body = arm.add(planar::Lrvf::from(bar, 6), "arm");
    arm.connect(Pin{}, arm.ground().at({0, 0, 0}), body.at(0.0), "pin");
    arm.connect(Drive{{.law = {.speed = 2.0, .duration = 0.5}}, {}}, arm.ground().at({0, 0, 0}), body.at(0.0), "drive");
  }
  auto const& model() const { return arm; }
};

/// The arm, of Se3 elements.
struct Se3Arm {
  using Pin = Joint<planar::Revolute, Constraint>;
  Model<Bodies<planar::Se3Beam>, Joints<Pin>> arm{Gravity{0, -9.81, 0}};

  Se3Arm() {
    Bar const bar{
        .length = 1.0,
        .constants = BarConstants{.EA = 1e5, .EI = 50, .mass_per_length = 1.0, .GA = 3e4, .rotary_inertia = 1e-3},
        .damping = {.axial = 1e-3, .shear = 1e-3, .bending = 1e-3}};
    arm.connect(Pin{}, arm.ground().at({0, 0, 0}), arm.add(planar::Se3Beam::from(bar, 6), "arm").at(0.0), "pin");
  }
  auto const& model() const { return arm; }
};

/// Two rods in space whose sections have couplings, on a pin and connected by a compliant spherical joint.
template <class B>
struct HungRods {
  using Pin = Joint<Revolute, Constraint>;
  using Ball = Joint<Spherical, Penalty>;
  Model<Bodies<B>, Joints<Pin, Ball>> rods{Gravity{0, -9.81, 0}};

  HungRods() {
    Section6 section = composite().placed(0.02, -0.03);
    section.damping_times << 1e-3, 4e-3, 2e-3, 7e-3, 3e-3, 5e-3;
    Bar bar{.length = 10.0, .section = section};
    auto const first = rods.add(B::from(bar, 3), "first");
    bar.placement.origin = {10.0, 0.0, 0.0};
    auto const second = rods.add(B::from(bar, 3), "second");
    rods.connect(Pin{{.axis = Vec3::UnitZ()}, {}}, rods.ground().at({0, 0, 0}), first.at(0.0), "pin");
    rods.connect(Ball{{}, {.stiffness = 1e5, .damping = 10.0}}, first.at(10.0), second.at(0.0), "ball");
  }
  auto const& model() const { return rods; }
};

/// An ANCF cable on a compliant pin, with a damped spring at its end.
struct SprungCable {
  using Pin = Joint<planar::Revolute, Penalty>;
  Model<Bodies<planar::AncfCable<>>, Joints<Pin>, Forces<SpringDamper>> cable{Gravity{0, -9.81, 0}};

  SprungCable() {
    Bar const bar{.length = 1.0, .constants = BarConstants{.EA = 1e4, .EI = 5, .mass_per_length = 1.0}};
    auto const body = cable.add(planar::AncfCable<>::from(bar, 6), "cable");
    cable.connect(Pin{{}, {.stiffness = 1e5, .damping = 10.0}}, cable.ground().at({0, 0, 0}), body.at(0.0), "pin");
    cable.apply(SpringDamper{.stiffness = 100.0, .damping = 1.0, .free_length = 0.5}, cable.ground().at({1, 0.6, 0}),
                body.at(1.0), "spring");
  }
  auto const& model() const { return cable; }
};

/// A body on a nonlinear bushing, and a second body that hangs from it on a linear bushing.
struct BushedBodies {
  using Pin = Joint<Revolute, Bushing>;
  using Mount = Joint<Revolute, NonlinearBushing<TabulatedLaw, LinearLaw, LinearLaw, LinearLaw, LinearLaw, LinearLaw>>;
  Model<Bodies<Rigid<>>, Joints<Pin, Mount>> bodies{Gravity{0, -9.81, 0}};

  BushedBodies() {
    Rigid<> const ball(1.0, Mat3::Identity(), {});
    auto const first = bodies.add(ball, "first"), second = bodies.add(ball, "second");
    TabulatedLaw const table{MonotoneTable{{{-1.0, -2e3}, {0.0, 0.0}, {0.1, 100.0}}}, 1.0};
    LinearLaw const law{.stiffness = 1e4, .damping = 1.0};
    bodies.connect(Mount{{.axis = Vec3::UnitZ()}, {table, law, law, law, law, law}}, bodies.ground().at({0, 0, 0}),
                   first.at(Vec3(0, 0, 0)), "mount");
    bodies.connect(Pin{{.axis = Vec3::UnitZ()},
                       {.stiffness = 1e4 * Bushing::Matrix::Identity(), .damping = Bushing::Matrix::Identity()}},
                   first.at(Vec3(1, 0, 0)), second.at(Vec3(1, 0.01, 0)), "pin");
  }
  auto const& model() const { return bodies; }
};

/// Balls in a contact group that fall onto the floor and onto one of them, with friction.
struct FallingBalls {
  using OnFloor = Contact<SphereOnPlane>;
  using OnBall = Contact<SphereOnSphere>;
  using Group = ContactGroup<OnFloor, OnBall>;
  Model<Bodies<Rigid<>>, Joints<>, Forces<Group>> balls{Gravity{0, 0, -9.81}};

  FallingBalls() {
    Friction const rough{.coefficient = 0.3, .slip_speed = 0.05};
    std::vector<Marker<Rigid<>>> middles;
    for (double const z : {0.1, 0.31, 0.52})
      middles.push_back(
          balls.add(Rigid<>(1.0, 0.004 * Mat3::Identity(), Placement::at({0.1 * z, 0, z}))).at(Vec3(0, 0, 0)));
    auto const group = balls.apply(Group{}, middles);
    balls.add_partner(group, OnFloor{{0.1}, {.stiffness = 1e4, .damping = 10.0, .onset = 1e-4}, rough},
                      balls.ground().at({0, 0, 0}));
    balls.add_partner(
        group, OnBall{{0.1, 0.1}, {.stiffness = 1e4}, rough},
        balls.add(Rigid<>(1.0, 0.004 * Mat3::Identity(), Placement::at({0.15, 0, 0.2}))).at(Vec3(0, 0, 0)));
  }
  auto const& model() const { return balls; }
};

/// Members of a contact set that fall onto a plane and onto each other, with friction, faster than the margin of the
/// search in each step.
struct FallingSet {
  using Set = ContactSet<Shapes<Sphere, Capsule, Plane>>;
  Model<Bodies<Rigid<>>, Joints<>, Forces<Set>> balls{Gravity{0, 0, -2e6}};

  FallingSet() {
    auto const set =
        balls.apply(Set{{.stiffness = 1e4, .damping = 10.0, .onset = 1e-4}, {.coefficient = 0.3, .slip_speed = 0.05}});
    for (int i = 0; i < 30; ++i) {
      auto const body = balls.add(Rigid<>(1.0, 0.004 * Mat3::Identity(), Placement::at({0.02 * i, 0, 0.1 + 0.21 * i})));
      if (i % 3 == 0)
        balls.add_member(set, Capsule{.radius = 0.1, .length = 0.1, .taper = 1e-3}, body.centre());
      else
        balls.add_member(set, Sphere{.radius = 0.1}, body.centre());
    }
    balls.add_member(set, Plane{}, balls.ground().at({0, 0, 0}));
  }
  auto const& model() const { return balls; }
};

/// Three balls that slide on the floor, each with its own contact: three islands.
struct SlidingBalls {
  using OnFloor = Contact<SphereOnPlane>;
  Model<Bodies<Rigid<>>, Joints<>, Forces<OnFloor>> balls{Gravity{0, 0, -9.81}};

  SlidingBalls() {
    for (int i = 0; i < 3; ++i)
      balls.apply(
          OnFloor{{0.1}, {.stiffness = 1e4, .damping = 10.0}, {.coefficient = 0.3, .slip_speed = 0.05}},
          balls.add(Rigid<>(1.0, 0.004 * Mat3::Identity(), Placement::at({0, double(i), 0.099}))).at(Vec3(0, 0, 0)),
          balls.ground().at({0, 0, 0}));
  }
  auto const& model() const { return balls; }
};

/// A floating frame of six modes with geometric stiffening on a pin, and a second one at the end of the first. The
/// size of these bodies is known at run time.
template <class Policy>
struct HungFrames {
  using Pin = Joint<Revolute, Policy>;
  Model<Bodies<Ffr>, Joints<Pin>> frame{Gravity{0, -9.81, 0}};

  HungFrames() {
    Bar const bar{
        .length = 1.0,
        .constants = BarConstants{.EA = 1e5, .EI = 50, .mass_per_length = 1.0, .GJ = 40, .rotary_inertia = 1e-3}};
    Structure const s = structure_of(bar, 4);
    auto const body = frame.add(Ffr(s, fixed_interface_modes(s, 6), {.stiffening = true}), "frame");
    auto const next =
        frame.add(Ffr(s, fixed_interface_modes(s, 6), {.placement = Placement::at({1, 0, 0}, {0, 0, 0})}), "next");
    frame.connect(Pin{{.axis = Vec3::UnitZ()}, {}}, frame.ground().at({0, 0, 0}), body.at(0.0), "pin");
    frame.connect(Pin{{.axis = Vec3::UnitZ()}, {}}, body.at(1.0), next.at(0.0), "second pin");
  }
  auto const& model() const { return frame; }
};

/// An ANCF cable with a Maxwell element at its end: a force with a first-order state.
struct CreepingCable {
  using Pin = Joint<planar::Revolute, Constraint>;
  Model<Bodies<planar::AncfCable<>>, Joints<Pin>, Forces<MaxwellElement>> cable{Gravity{0, -9.81, 0}};

  CreepingCable() {
    Bar const bar{.length = 1.0, .constants = BarConstants{.EA = 1e4, .EI = 5, .mass_per_length = 1.0}};
    auto const body = cable.add(planar::AncfCable<>::from(bar, 6), "cable");
    cable.connect(Pin{}, cable.ground().at({0, 0, 0}), body.at(0.0), "pin");
    cable.apply(MaxwellElement{.stiffness = 100.0, .damping = 10.0, .free_length = 0.5}, cable.ground().at({1, 0.6, 0}),
                body.at(1.0), "damper");
  }
  auto const& model() const { return cable; }
};

/// A chain in joint coordinates, solved by the articulated-body algorithm, under its weight and with a spring at its
/// end.
template <bool sprung>
struct TreeOfLinks {
  using Pin = Joint<Revolute, JointCoordinatesBy<joint_coordinates::ArticulatedBody>>;
  Model<Bodies<Rigid<>>, Joints<Pin>, std::conditional_t<sprung, Forces<SpringDamper>, Forces<>>> tree{
      Gravity{0, -9.81, 0}};

  TreeOfLinks() {
    std::optional<BodyHandle<Rigid<>>> before;
    for (int i = 0; i < 5; ++i) {
      auto const link = tree.add(Rigid<>({.mass = 1.0,
                                          .inertia = Vec3(1e-4, 1e-3, 1e-3).asDiagonal(),
                                          .placement = Placement::at({0.1 * i + 0.05, 0, 0})}));
      Pin const pin{{.axis = Vec3::UnitZ()}, {}};
      if (before)
        tree.connect(pin, before->at(Vec3(0.05, 0, 0)), link.at(Vec3(-0.05, 0, 0)));
      else
        tree.connect(pin, tree.ground().at({0, 0, 0}), link.at(Vec3(-0.05, 0, 0)));
      before = link;
    }
    if constexpr (sprung)
      tree.apply(SpringDamper{.stiffness = 50.0, .damping = 1.0, .free_length = 0.1}, before->at(Vec3(0.05, 0, 0)),
                 tree.ground().at({0.5, 1.0, 0}));
  }
  auto const& model() const { return tree; }
};

/// Number of allocations in 40 steps, from the first step, with a change of the step length in mid-run.
template <class Case, class Solver = BlockSolver, class I>
long in_steps(I const& integrator) {
  Case const setup;
  auto const& model = setup.model();
  State x = model.reference_state();
  System system = stepped_system(model, with<entries_of<I>()>);
  if (system.step_coordinates()) x = reduce(system, x);
  auto const method = method_of(integrator);
  auto workspace = method.template workspace<Solver>(system);
  double const h = 1e-5;  // stable for explicit methods
  method.start(system, x, h, workspace);
  workspace.check.bounds.begin(system, {}, {x.q, x.v, x.lambda, x.t, 1e-3});
  long const before = taken;
  for (int i = 0; i < 20; ++i) method.step(system, x, h, workspace);
  for (int i = 0; i < 20; ++i) method.step(system, x, 0.25 * h, workspace);
  long const count = taken - before;
  EXPECT_GT(x.t, 20 * h);
  EXPECT_TRUE(x.q.allFinite());
  return count;
}

template <class Case>
void expect_none() {
  EXPECT_EQ(in_steps<Case>(GeneralisedAlpha{}), 0);
  EXPECT_EQ((in_steps<Case, DenseLu>(GeneralisedAlpha{})), 0);
  EXPECT_EQ(in_steps<Case>(GeneralisedAlpha{.second_order_terms = true}), 0);
  EXPECT_EQ(in_steps<Case>(GeneralisedAlpha{.stabilised = true}), 0);
  EXPECT_EQ(in_steps<Case>(RungeKutta4<Projection>{}), 0);
  EXPECT_EQ(in_steps<Case>(CentralDifference<Projection>{}), 0);
  EXPECT_EQ(in_steps<Case>(DormandPrince<Projection>{}), 0);
  EXPECT_EQ(in_steps<Case>(AdamsBashforthMoulton<Projection>{.relative_tolerance = 1.0, .absolute_tolerance = 1.0}), 0);
  EXPECT_EQ(in_steps<Case>(RungeKutta4<CoordinatePartitioning>{}), 0);
  EXPECT_EQ(in_steps<Case>(Rattle{}), 0);
  EXPECT_EQ(in_steps<Case>(RungeKutta4<Baumgarte>{.stabilisation = {.alpha = 5.0, .beta = 5.0}}), 0);
}

}  // namespace

TEST(NoAllocation, TheCountersCount) {
  long before = taken;
  std::vector<double> const v(100);
  EXPECT_GT(taken, before);
#if defined(__GLIBC__) && !defined(POLYBODY_TEST_SANITIZED)
  before = taken;
  VecX const x = VecX::Zero(100);  // Eigen calls malloc
  EXPECT_GT(taken, before);
#endif
}

TEST(NoAllocation, InAStepOfARigidChain) { expect_none<RigidChain>(); }

TEST(NoAllocation, InAStepOfADrivenLrvfArm) { expect_none<DrivenArm>(); }

TEST(NoAllocation, InAStepOfAnAncfCableOnCompliantJoints) { expect_none<SprungCable>(); }

TEST(NoAllocation, InAStepOfHungSe3Beams) { expect_none<HungRods<Se3Beam>>(); }

TEST(NoAllocation, InAStepOfHungLrvf) { expect_none<HungRods<Lrvf<>>>(); }

TEST(NoAllocation, InAStepOfAPlanarSe3Arm) { expect_none<Se3Arm>(); }

template <class Case>
void expect_none_that_conserves() {
  EXPECT_EQ(in_steps<Case>(EnergyMomentum{}), 0);
  EXPECT_EQ(in_steps<Case>(EnergyDecaying{}), 0);
}

TEST(NoAllocation, InAStepThatConservesEnergy) {
  expect_none_that_conserves<SprungCable>();
  expect_none_that_conserves<PlanarChain>();
  expect_none_that_conserves<RigidChain>();
  expect_none_that_conserves<HungRods<Se3Beam>>();
  expect_none_that_conserves<HungRods<Lrvf<>>>();
}

template <class Case>
void expect_none_by_tree() {
  EXPECT_EQ(in_steps<Case>(RungeKutta4<>{}), 0);
  EXPECT_EQ(in_steps<Case>(DormandPrince<>{}), 0);
  EXPECT_EQ(in_steps<Case>(GeneralisedAlpha{}), 0);
}

TEST(NoAllocation, InAStepOfATree) {
  expect_none_by_tree<TreeOfLinks<false>>();
  expect_none_by_tree<TreeOfLinks<true>>();
}

TEST(NoAllocation, InAStepOfBodiesOnBushings) {
  EXPECT_EQ(in_steps<BushedBodies>(GeneralisedAlpha{.second_order_terms = true}), 0);
}

TEST(NoAllocation, InAStepOfAGroupOfContacts) {
  EXPECT_EQ(in_steps<FallingBalls>(GeneralisedAlpha{}), 0);
  EXPECT_EQ(in_steps<FallingBalls>(GeneralisedAlpha{.second_order_terms = true}), 0);
  EXPECT_EQ(in_steps<FallingBalls>(RungeKutta4<>{}), 0);
}

TEST(NoAllocation, InAStepOfAContactSet) {
  EXPECT_EQ(in_steps<FallingSet>(GeneralisedAlpha{}), 0);
  EXPECT_EQ(in_steps<FallingSet>(GeneralisedAlpha{.second_order_terms = true}), 0);
  EXPECT_EQ(in_steps<FallingSet>(RungeKutta4<>{}), 0);
}

TEST(NoAllocation, InAStepThatSolvesIslandsApart) {
  SlidingBalls const setup;
  State x = setup.balls.reference_state();
  for (Index i = 0; i < 3; ++i) x.v[6 * i] = 1.0;
  System system(setup.balls, with<Capabilities::implicit_step>);
  AlphaMethod const method = method_of(GeneralisedAlpha{});
  auto workspace = method.workspace<BlockSolver>(system);
  method.start(system, x, 1e-4, workspace);
  ASSERT_TRUE(workspace.islands.begin(method, system, workspace));
  long const before = taken;
  for (int i = 0; i < 10; ++i) method.step(system, x, 1e-4, workspace);
  EXPECT_EQ(taken, before);
  EXPECT_TRUE(workspace.islands.active());
  EXPECT_NEAR(x.v[0], 1.0 - 0.3 * 9.81 * 1e-3, 2e-3);  // the contact force differs from the weight at first
}

TEST(NoAllocation, InAStepOfAFloatingFrame) {
  EXPECT_EQ(in_steps<HungFrames<Constraint>>(GeneralisedAlpha{}), 0);
  EXPECT_EQ(in_steps<HungFrames<Constraint>>(GeneralisedAlpha{.second_order_terms = true}), 0);
  EXPECT_EQ(in_steps<HungFrames<Constraint>>(RungeKutta4<Projection>{}), 0);
  EXPECT_EQ(in_steps<HungFrames<JointCoordinates>>(GeneralisedAlpha{}), 0);
  EXPECT_EQ(in_steps<HungFrames<JointCoordinates>>(RungeKutta4<>{}), 0);
}

TEST(NoAllocation, InAStepWithFirstOrderStates) {
  EXPECT_EQ(in_steps<CreepingCable>(GeneralisedAlpha{}), 0);
  EXPECT_EQ(in_steps<CreepingCable>(EnergyMomentum{}), 0);
  EXPECT_EQ(in_steps<CreepingCable>(DormandPrince<Projection>{}), 0);
}

TEST(NoAllocation, InAskingForTheEnergyOfASystem) {
  SprungCable const setup;
  State const x = setup.cable.reference_state();
  System system(setup.cable);
  long const before = taken;
  system.evaluate(x.q, x.v, x.t);
  double const total = energy(system, x).total();
  EXPECT_EQ(taken, before);
  EXPECT_TRUE(std::isfinite(total));
}
