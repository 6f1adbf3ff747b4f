// Surfaces of a model. They are closed, their normals point outwards, they enclose the volume of the bodies, and they
// move with the bodies.
#include <gtest/gtest.h>

#include <map>
#include <numbers>
#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/io/visual.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/statics/equilibrium.hpp>

#include "support/refusal.hpp"

namespace visual_test {

using namespace polybody;
constexpr double pi = std::numbers::pi;

template <class Act>
void expect_refused(Act&& act, std::vector<std::string> const& parts) {
  std::string const told = refusal(act);
  for (std::string const& part : parts) EXPECT_TRUE(has(told, part));
}

/// Every edge occurs once in each direction: the surface is closed, and all polygons have the same orientation.
void expect_closed(Surface const& s) {
  std::map<std::pair<int, int>, int> walked;
  int begin = 0;
  for (int const end : s.ends) {
    for (int k = begin; k < end; ++k)
      ++walked[{s.corners[std::size_t(k)], s.corners[std::size_t(k + 1 == end ? begin : k + 1)]}];
    begin = end;
  }
  for (auto const& [edge, times] : walked) {
    EXPECT_EQ(times, 1);
    EXPECT_EQ(walked.count({edge.second, edge.first}), 1u);
  }
}

Bar square() {
  return {.length = 2.0,
          .section = Rectangle{.height = 0.1, .width = 0.06},
          .material = Material{.density = 7800.0, .young = 2e11, .poisson = 0.3},
          .placement = Placement{Vec3(1, -2, 0), exp_so3<double>(Vec3(0, 0, 0.7))}};
}

TEST(Surface, ShapesAreClosedAndHoldTheirVolume) {
  Bar const round{.length = 2.0, .section = Circle{.radius = 0.3}};
  Surface const b = box({2, 3, 4}), c = cylinder(0.3, 2.0, Vec3(0.6, 0, 0.8), 12);
  expect_closed(b);
  expect_closed(c);
  EXPECT_NEAR(volume(b), 24.0, 1e-13);
  EXPECT_NEAR(volume(c), pi * 0.09 * 2.0, 1e-13);
  for (Vec3 const& p : c.points) EXPECT_NEAR(std::abs(p.dot(Vec3(0.6, 0, 0.8))), 1.0, 1e-14);
  EXPECT_EQ(outline(round, 7).size(), 7u);
}
TEST(Surface, CapsuleIsClosedAndRound) {
  Vec3 const axis(0.6, 0, 0.8);
  Surface const s = capsule(0.3, 2.0, axis, 48);
  expect_closed(s);
  double const volume_of_capsule = pi * 0.09 * 2.0 + 4.0 / 3.0 * pi * 0.027;
  EXPECT_NEAR(volume(s), volume_of_capsule, 0.01 * volume_of_capsule);
  for (Vec3 const& p : s.points) EXPECT_NEAR((p - std::clamp(p.dot(axis), -1.0, 1.0) * axis).norm(), 0.3, 0.003);
}

TEST(Surface, RefusesWhatHasNoShape) {
  expect_refused([] { box({1, 0, 1}); }, {"box", "size"});
  expect_refused([] { cylinder(-1.0, 1.0); }, {"cylinder", "radius"});
  expect_refused([] { cylinder(1.0, 1.0, Vec3(1, 1, 0)); }, {"cylinder", "axis"});
  expect_refused([] { capsule(0.0, 1.0); }, {"capsule", "radius"});
  expect_refused([] { capsule(1.0, 0.0); }, {"capsule", "length"});
  expect_refused([] { capsule(1.0, 1.0, Vec3(1, 1, 0)); }, {"axis"});
  expect_refused([] { capsule(1.0, 1.0, Vec3::UnitX(), 3); }, {"capsule", "four sides", "3"});
  expect_refused([] { outline({.length = 1.0, .section = Circle{.radius = 1.0}}, 2); }, {"three sides"});
  expect_refused(
      [] { outline({.length = 1.0, .constants = BarConstants{.EA = 1.0, .EI = 1.0, .mass_per_length = 1.0}}); },
      {"no section"});
}

template <class B>
B made(Bar const& bar) {
  if constexpr (requires { B::from(bar); })
    return B::from(bar);
  else
    return B::from(bar, 6);
}

template <class B>
struct SweptBody : testing::Test {};
using Swept = testing::Types<Rigid<>, AncfCable<>, AncfBeam<ElasticLine>, AncfBeam<Continuum<>>, Lrvf<>, planar::Lrvf>;
TYPED_TEST_SUITE(SweptBody, Swept);

// Reference state: a block of height × width × length at the placement of the bar, without stress.
TYPED_TEST(SweptBody, IsTheBarWhereItWasPlaced) {
  Bar const bar = square();
  Model<Bodies<TypeParam>, Joints<>> model;
  auto const body = model.add(made<TypeParam>(bar), "bar");
  Visual visual(model);
  visual.sweep(body, bar, 9);
  VisualPart const part = visual.at(model.reference_state()).front();
  EXPECT_EQ(part.name, "bar");
  expect_closed(part.surface);
  EXPECT_NEAR(volume(part.surface), 2.0 * 0.1 * 0.06, 1e-14);
  Vec3 const corner = bar.placement.origin + bar.placement.axes * Vec3(2.0, 0.05, -0.03);
  double nearest = 1.0;
  for (Vec3 const& p : part.surface.points) nearest = std::min(nearest, (p - corner).norm());
  EXPECT_LT(nearest, 1e-13);
  EXPECT_EQ(part.axial_stress.size(), HasSections<TypeParam> ? 40u : 0u);
  for (double const s : part.axial_stress) EXPECT_NEAR(s, 0.0, 1e-2);
}

// Rigid motion in the plane, which every formulation has: v = v₀ + ω × r at every point.
TYPED_TEST(SweptBody, MovesWithItsPoints) {
  Bar const bar = square();
  Model<Bodies<TypeParam>, Joints<>> model;
  auto const body = model.add(made<TypeParam>(bar), "bar");
  Visual visual(model);
  visual.sweep(body, bar, 9);
  visual.attach(body.at(0.5), box({0.1, 0.2, 0.3}));
  State x = model.reference_state();
  Vec3 const v0(0.4, -0.2, 0.0), omega(0.0, 0.0, 1.3);
  model.set_velocity(x, body, v0, omega);
  for (VisualPart const& part : visual.at(x)) {
    ASSERT_EQ(part.velocities.size(), part.surface.points.size());
    for (std::size_t i = 0; i < part.velocities.size(); ++i)
      EXPECT_LT((part.velocities[i] - v0 - omega.cross(part.surface.points[i])).norm(), 1e-13);
  }
}

// Half a circle by an end moment. Plane sections along an arc of unchanged length enclose the same volume [Pappus],
// up to the relative error (π/n)²/6 of the chords of n = 60 pieces. The stress is ± M h/2I = E h κ/2 at the faces.
TEST(SweptBodies, BendWithTheBody) {
  Bar bar{.length = 2.0,
          .section = Rectangle{.height = 0.02, .width = 0.03},
          .material = Material{.density = 1000.0, .young = 1e9, .poisson = 0.3}};
  using Clamp = Joint<Weld, Constraint>;
  Model<Bodies<Lrvf<>>, Joints<Clamp>, Forces<PointMoment<>>> model;
  auto const body = model.add(Lrvf<>::from(bar, 20), "bar");
  model.connect(Clamp{}, model.ground().at({0, 0, 0}), body.at(0.0), "clamp");
  double const kappa = pi / 2.0, stress = 1e9 * 0.01 * kappa;
  model.apply(PointMoment<>{.moment = {0, 0, constants(bar).EI * kappa}}, body.at(2.0));
  State x = model.reference_state();
  equilibrium(model, x, {.load_steps = 8});
  Visual visual(model);
  visual.sweep(body, bar, 60);
  VisualPart const& part = visual.at(x).front();
  double const chord = std::pow(pi / 60, 2) / 6, mesh = std::pow(pi / 20, 2) / 6;
  EXPECT_NEAR(volume(part.surface), 2.0 * 0.02 * 0.03, 2.0 * (chord + mesh) * 2.0 * 0.02 * 0.03);
  auto const [least, most] = std::minmax_element(part.axial_stress.begin(), part.axial_stress.end());
  EXPECT_NEAR(*most, stress, 1e-6 * stress);
  EXPECT_NEAR(*least, -stress, 1e-6 * stress);
}

TEST(AttachedShapes, AreCarriedByTheirMarker) {
  Model<Bodies<Rigid<>>, Joints<>> model;
  auto const body = model.add(Rigid<>(2.0, Mat3::Identity()), "brick");
  Visual visual(model);
  visual.attach(body.at({1, 0, 0}), box({0.2, 0.4, 0.6}), "brick");
  visual.attach(model.ground().at({0, 0, 5}), cylinder(1.0, 1.0), "post");
  State x = model.reference_state();
  Mat3 const turn = exp_so3<double>(Vec3(0.3, -1.2, 2.0));
  x.q << Vec3(4, 5, 6), quaternion_of(turn);
  auto const& parts = visual.at(x);
  ASSERT_EQ(parts.size(), 2u);
  Vec3 middle = Vec3::Zero();
  for (Vec3 const& p : parts[0].surface.points) middle += p / 8.0;
  EXPECT_LT((middle - (Vec3(4, 5, 6) + turn.col(0))).norm(), 1e-14);
  EXPECT_NEAR(volume(parts[0].surface), 0.2 * 0.4 * 0.6, 1e-13);
  EXPECT_NEAR(volume(parts[1].surface), pi, 1e-12);
}

// A line is a closed tube between its markers, also if they coincide for a moment.
TEST(Lines, ConnectTheirMarkers) {
  Model<Bodies<Rigid<>>, Joints<>> model;
  auto const body = model.add(Rigid<>(2.0, Mat3::Identity()), "brick");
  Visual visual(model);
  visual.line(model.ground().at({0, 0, 5}), body.at({1, 0, 0}), 0.01, "rope");
  EXPECT_EQ(visual.bodies_without_shape(), std::vector<std::string>{"brick"});
  State x = model.reference_state();
  x.v << 0, 0, 0, 0, 0, 3;
  for (Vec3 const& r : {Vec3(4, 5, 6), Vec3(-1, 0, 2), Vec3(-1, 0, 5)}) {
    x.q.head<3>() = r;
    VisualPart const& rope = visual.at(x)[0];
    Vec3 const end = r + Vec3(1, 0, 0);
    double const length = (end - Vec3(0, 0, 5)).norm();
    expect_closed(rope.surface);
    EXPECT_NEAR(volume(rope.surface), pi * 1e-4 * length, 1e-12);
    for (std::size_t i = 0; i < rope.surface.points.size(); ++i) {
      bool const far = i >= rope.surface.points.size() / 2;
      Vec3 const arm = rope.surface.points[i] - (far ? end : Vec3(0, 0, 5));
      EXPECT_LT(arm.norm(), 0.0105);
      EXPECT_LT(std::abs(arm.dot(end - Vec3(0, 0, 5))), 1e-14);
      EXPECT_LT((rope.velocities[i] - Vec3(0, far ? 3 : 0, 0)).norm(), 1e-14);
    }
  }
}

TEST(Visual, RefusesWhatIsOfAnotherModel) {
  Model<Bodies<Rigid<>>, Joints<>> model, other;
  auto const body = other.add(Rigid<>::from(square()), "bar");
  Visual visual(model);
  expect_refused([&] { visual.sweep(body, square(), 3); }, {"bar", "another model"});
  expect_refused([&] { visual.attach(body.at(0.0), box({1, 1, 1}), "brick"); }, {"brick", "another model"});
  expect_refused([&] { visual.line(model.ground().at({0, 0, 0}), body.at(0.0), 1.0, "rope"); },
                 {"rope", "another model"});
  Visual right(other);
  expect_refused([&] { right.sweep(body, square(), 0); }, {"bar", "one piece"});
  expect_refused([&] { right.line(body.at(0.0), body.at(1.0), 0.0, "rope"); }, {"rope", "radius"});
}

}  // namespace visual_test
