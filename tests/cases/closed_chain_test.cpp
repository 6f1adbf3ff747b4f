// Closed chain of 64 links on two wheels. Its pins have three redundant constraint equations in every shape.

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/redundancy.hpp>
#include <polybody/run/simulate.hpp>

#include "support/doubled_joints.hpp"
#include "support/held.hpp"

namespace polybody {
namespace closed_chain_test {

constexpr int around = 12, straight = 20, links = 2 * (around + straight);
constexpr double length = 0.15;  ///< of a link [m]

struct OfSpace {
  using Body = Rigid<>;
  using Pin = Joint<Revolute, Constraint>;
  using Loose = Joint<PointOnLine, Constraint>;
  static Body body(double mass, double across, Placement const& place) {
    return {mass, Vec3(0.3 * across, 0.8 * across, across).asDiagonal().toDenseMatrix(), place};
  }
  static Marker<Body> at(BodyHandle<Body> const& body, double x, double y) { return body.at(Vec3(x, y, 0)); }
  static Pin pin() { return {Revolute{.axis = Vec3::UnitZ()}, {}}; }
  static Loose loose() { return {PointOnLine{.axis = Vec3::UnitZ()}, {}}; }
};
struct OfThePlane {
  using Body = planar::Rigid;
  using Pin = Joint<planar::Revolute, Constraint>;
  using Loose = Pin;
  static Body body(double mass, double across, Placement const& place) { return {mass, across, place}; }
  static Marker<Body> at(BodyHandle<Body> const& body, double x, double y) { return body.at(Vec2(x, y)); }
  static Pin pin() { return {}; }
  static Loose loose() { return {}; }
};

template <class... Js>
struct Distinctly {
  using Type = Joints<Js...>;
};
template <class J>
struct Distinctly<J, J> {
  using Type = Joints<J>;
};

/// The pins lie on half regular 24-gons around the wheels and on the two tangents between them. The circles of the
/// 24-gons, of radius l/(2 sin(π/24)), are the pitch circles. 12 links lie around each wheel and 20 on each span, all
/// taut. The wheels rotate about pins on the ground. The outermost point of the chain on the left wheel is joined to
/// the wheel by a pin. On the right wheel it is a point on a line along z, which has only the two constraint
/// equations of the plane.
template <class World>
struct ClosedChain {
  using Body = typename World::Body;
  using Pin = typename World::Pin;
  using Loose = typename World::Loose;
  Model<Bodies<Body>, typename Distinctly<Pin, Loose>::Type> model{Gravity{0, -9.81, 0}};
  std::vector<BodyHandle<Body>> chain, wheels;
  std::vector<ElementHandle<Pin>> pins;
  std::vector<ElementHandle<Loose>> loose;
  State x;

  ClosedChain() {
    double const step = std::numbers::pi / around, radius = length / (2.0 * std::sin(0.5 * step)),
                 half = 0.5 * straight * length;
    std::vector<Vec2> point;  // counterclockwise from the lower end of the right wheel's half
    for (double const side : {1.0, -1.0}) {
      for (int i = 0; i <= around; ++i)
        point.push_back(side * Vec2(half + radius * std::sin(step * i), -radius * std::cos(step * i)));
      for (int i = 1; i < straight; ++i) point.push_back(side * Vec2(half - length * i, radius));
    }
    for (int i = 0; i < links; ++i) {
      Vec2 const a = point[std::size_t(i)], along = point[std::size_t((i + 1) % links)] - a, middle = a + 0.5 * along;
      EXPECT_NEAR(along.norm(), length, 1e-14);
      chain.push_back(
          model.add(World::body(1.5, 4e-3, Placement::planar(middle[0], middle[1], std::atan2(along[1], along[0]))),
                    "link " + std::to_string(i + 1)));
    }
    for (double const side : {1.0, -1.0})
      wheels.push_back(
          model.add(World::body(20.0, 1.0, Placement::planar(side * half, 0.0)), side > 0.0 ? "right" : "left"));
    auto const first = [&](int i) { return World::at(chain[std::size_t(i)], -0.5 * length, 0.0); };
    for (std::size_t i : {0u, 1u})
      pins.push_back(model.connect(World::pin(), model.ground().at({i == 0 ? half : -half, 0, 0}),
                                   World::at(wheels[i], 0, 0), i == 0 ? "right axle" : "left axle"));
    for (int i = 0; i < links; ++i)
      pins.push_back(model.connect(World::pin(), World::at(chain[std::size_t(i)], 0.5 * length, 0.0),
                                   first((i + 1) % links), "pin " + std::to_string(i + 1)));
    loose.push_back(model.connect(World::loose(), World::at(wheels[0], radius, 0.0), first(around / 2), "right tooth"));
    pins.push_back(
        model.connect(World::pin(), World::at(wheels[1], -radius, 0.0), first(links / 2 + around / 2), "left tooth"));
    x = model.reference_state();
  }
};
using Space = ClosedChain<OfSpace>;
using Plane = ClosedChain<OfThePlane>;

// A loop of N parallel pins has 5 N constraint equations. Its links have six rigid motions and N − 3 relative
// motions: 6 N − (N + 3) = 5 N − 3 equations are independent. Axles, tooth and point add 5 + 5 + 5 + 2. The rank of
// the 337 equations is 334. There are 6·66 generalised velocities. The degrees of freedom are N − 2 as in the plane,
// 3·66 − 2·(64 + 2 + 2).
TEST(ClosedChain, RepeatsThreeRows) {
  Space const space;
  Plane const plane;
  Redundancy const r = redundancy(space.model, space.x), p = redundancy(plane.model, plane.x);
  auto const counts = [](char const* chain, Redundancy const& found, Index rows, Index rank) {
    auto const same = [&](char const* what, Index value, Index counted) {
      held({"closed forms", what, By::closed_form, "counted: 5 N − 3 rows of N pins hold", chain}, double(value),
           double(counted), 0.0);
    };
    same("rows of a closed chain on two wheels", found.rows, rows);
    same("rank of a closed chain on two wheels", found.rank, rank);
    same("degrees of freedom of a closed chain on two wheels", found.degrees_of_freedom, 62);
  };
  counts("64 links in space", r, 337, 334);
  counts("64 links in the plane", p, 136, 136);
  EXPECT_TRUE(r.consistent());
  ASSERT_EQ(r.repeated.size(), 1u);
  EXPECT_EQ(r.repeated[0].name, "joint \"pin 64\"");  // which closes the loop
  EXPECT_EQ(r.repeated[0].rows, 3);
}

/// Forces of all pins in space and in the plane.
struct PinForces {
  double difference = 0.0, largest = 0.0, out_of_plane = 0.0;
};
PinForces compare(Space const& space, Plane const& plane) {
  PinForces out;
  for (std::size_t i = 0; i < space.pins.size(); ++i) {
    auto const s = space.x.lambda.segment<5>(space.model.entry(space.pins[i]).row);
    auto const p = plane.x.lambda.segment<2>(plane.model.entry(plane.pins[i]).row);
    out.difference = std::max(out.difference, (s.head<2>() - p).norm());
    out.largest = std::max(out.largest, p.norm());
    out.out_of_plane = std::max(out.out_of_plane, s.tail<3>().norm());
  }
  double const tooth = plane.x.lambda.segment<2>(plane.model.entry(plane.loose[0]).row).norm();
  out.largest = std::max(out.largest, tooth);
  double const loose = space.x.lambda.segment<2>(space.model.entry(space.loose[0]).row).norm();
  out.difference = std::max(out.difference, std::abs(loose - tooth));
  return out;
}

// Chain that falls off the wheels after its release. The planar chain has no redundant constraints, so its forces are
// unique. The forces of the spatial chain are equal at every step. The forces out of the plane are zero, although
// three constraint equations could transmit them.
template <class I>
void expect_the_plane(char const* formulation, I const& integrator, double step, double end_time, double tolerance,
                      double energy_tolerance) {
  Space space;
  Plane plane;
  double const start = energy(space.model, space.x).total();
  auto run = simulate(space.model, space.x, integrator, {.end_time = end_time, .step = step});
  auto planar = simulate(plane.model, plane.x, integrator, {.end_time = end_time, .step = step});
  EXPECT_TRUE(planar.report().redundant.empty());
  ASSERT_GE(run.report().redundant.size(), 1u);
  ASSERT_LE(run.report().redundant.size(), 3u);
  for (std::string const& name : run.report().redundant)
    EXPECT_NE(name.find("joint \"pin "), std::string::npos) << name;
  double largest = 0.0, apart = 0.0;
  while (!run.done()) {
    run.advance();
    planar.advance();
    PinForces const f = compare(space, plane);
    largest = std::max(largest, f.largest);
    ASSERT_LT(f.difference, tolerance * (1.0 + f.largest)) << space.x.t;
    apart = std::max({apart, f.difference / (1.0 + f.largest), f.out_of_plane / (1.0 + f.largest)});
    ASSERT_LT(f.out_of_plane, tolerance * (1.0 + f.largest)) << space.x.t;
    ASSERT_LT(space.x.lambda.cwiseAbs().maxCoeff(), (1.0 + tolerance) * (1.0 + f.largest)) << space.x.t;
  }
  EXPECT_GT(largest, 20.0 * 9.81);  // an axle carries its wheel and the tension of the chain
  EXPECT_NEAR(energy(space.model, space.x).total(), start, energy_tolerance);
  held_within({"closed forms", "pin forces of a closed chain that falls, of the largest", By::itself,
               "the chain in the plane", formulation},
              apart, tolerance, {.scale = 1.0});
}

TEST(ClosedChain, FallsAsInThePlaneWithImplicitSteps) {
  expect_the_plane("64 links in space, generalised-α", GeneralisedAlpha{.tolerance = 1e-10}, 1e-3, 0.5, 1e-6, 1.0);
}
TEST(ClosedChain, FallsAsInThePlaneWithExplicitSteps) {
  expect_the_plane("64 links in space, Runge–Kutta 4", RungeKutta4<Projection>{}, 1e-3, 0.2, 1e-6, 1e-3);
}

// Every joint twice: in space, three equations are redundant without the second joints.
TEST(ClosedChain, MovesWithDoubledJointsAsWithSingleOnes) {
  RunOptions const options{.end_time = 0.04, .step = 2e-3};
  expect_same_with_doubled_joints([] { return Plane(); }, GeneralisedAlpha{.tolerance = 1e-10}, options, 1e-9);
  expect_same_with_doubled_joints([] { return Space(); }, GeneralisedAlpha{.tolerance = 1e-10}, options, 1e-9);
  expect_same_with_doubled_joints([] { return Plane(); }, RungeKutta4<Projection>{}, options, 1e-9);
}

}  // namespace closed_chain_test
}  // namespace polybody
