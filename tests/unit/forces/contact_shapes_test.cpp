#include <gtest/gtest.h>

#include <polybody/forces/shapes/box_contact.hpp>
#include <polybody/forces/shapes/capsule_contact.hpp>
#include <polybody/forces/shapes/compound.hpp>
#include <polybody/forces/shapes/shapes_on_plane.hpp>
#include <polybody/testing/contact_shape_laws.hpp>

#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace contact_shapes_test {

// --- distances from shapes, by independent formulas -----------------------------------------------------------

double outside_box(Vec3 const& size, double rounding, Vec3 const& p) {
  Vec3 const beyond = p.cwiseAbs() - 0.5 * size + Vec3::Constant(rounding);
  return beyond.cwiseMax(0.0).norm() + std::min(beyond.maxCoeff(), 0.0) - rounding;
}
double outside_capsule(double radius, double length, Vec3 const& p) {
  return (p - std::clamp(p[0], -0.5 * length, 0.5 * length) * Vec3::UnitX()).norm() - radius;
}
/// Frames without motion of a rotated by `rotation` at r, and of b at the origin.
Touching placed(Vec3 const& r, Vec3 const& rotation = Vec3::Zero()) {
  return {Frame<double>{.r = r, .A = exp_so3<double>(rotation)}, Frame<double>{}};
}
constexpr double right = 1.5707963267948966;

struct OnPlane {
  static constexpr bool plane = true;
  static double outside_b(Vec3 const& p) { return p[2]; }
};
struct BoxOnPlaneCase : OnPlane {
  static BoxOnPlane geometry() { return {.size = {0.6, 0.8, 1.1}, .rounding = 0.1}; }
  static double outside_a(Vec3 const& p) { return outside_box({0.6, 0.8, 1.1}, 0.1, p); }
  static std::vector<Touching> starts() {
    return {placed({0, 0, 0.549}), placed({0, 0, 0.399}, {right, 0, 0}), placed({0.1, 0, 0.52}, {0, 0.5 * right, 0})};
  }
};
struct CapsuleOnPlaneCase : OnPlane {
  static CapsuleOnPlane geometry() { return {.radius = 0.3, .length = 0.9}; }
  static double outside_a(Vec3 const& p) { return outside_capsule(0.3, 0.9, p); }
  static std::vector<Touching> starts() { return {placed({0, 0, 0.299}), placed({0, 0, 0.749}, {0, right, 0})}; }
};
struct OctahedronOnPlaneCase : OnPlane {
  static PolyhedronOnPlane<> geometry() {
    return {.corners = {{0.7, 0, 0}, {-0.7, 0, 0}, {0, 0.7, 0}, {0, -0.7, 0}, {0, 0, 0.7}, {0, 0, -0.7}},
            .rounding = 0.05};
  }
  static double outside_a(Vec3 const& p) { return (p.cwiseAbs().sum() - 0.7) / std::sqrt(3.0) - 0.05; }
  static std::vector<Touching> starts() { return {placed({0, 0, 0.745}), placed({0, 0, 0.54}, {0, 0.5 * right, 0})}; }
};
struct CompoundCase : OnPlane {
  static Compound<BoxOnPlane, BoxOnPlane, CapsuleOnPlane> geometry() {
    return Compound(Placed{BoxOnPlane{.size = {0.2, 0.2, 0.2}}, Placement::at({0, 0.5, 0}, {0.3, 0.4, 0.5})},
                    Placed{BoxOnPlane{.size = {0.3, 0.2, 0.4}}, Placement::at({0, -0.5, 0})},
                    Placed{CapsuleOnPlane{.radius = 0.1, .length = 1.0}, Placement::at({0.2, 0, 0}, {0, 0, right})});
  }
  static double outside_a(Vec3 const& p) {
    auto const seen = [&](Vec3 const& at, Vec3 const& rotation) {
      return Vec3(exp_so3<double>(rotation).transpose() * (p - at));
    };
    return std::min({outside_box({0.2, 0.2, 0.2}, 0.0, seen({0, 0.5, 0}, {0.3, 0.4, 0.5})),
                     outside_box({0.3, 0.2, 0.4}, 0.0, seen({0, -0.5, 0}, {0, 0, 0})),
                     outside_capsule(0.1, 1.0, seen({0.2, 0, 0}, {0, 0, right}))});
  }
  static std::vector<Touching> starts() { return {placed({0, 0, 0.195})}; }
};

struct InSpace {
  static constexpr bool plane = false;
};
struct CapsuleOnSphereCase : InSpace {
  static CapsuleOnSphere geometry() { return {.radius = 0.2, .length = 0.9, .sphere = 0.4}; }
  static double outside_a(Vec3 const& p) { return outside_capsule(0.2, 0.9, p); }
  static double outside_b(Vec3 const& p) { return p.norm() - 0.4; }
  static std::vector<Touching> starts() { return {placed({0.45, 0, 0.599}), placed({0.1, 0, 0.599})}; }
};
struct CapsuleOnCapsuleCase : InSpace {
  static CapsuleOnCapsule geometry() {
    return {.radius_a = 0.2, .length_a = 0.9, .radius_b = 0.3, .length_b = 1.2, .taper = 0.004};
  }
  static double outside_a(Vec3 const& p) { return outside_capsule(0.2, 0.9, p); }
  static double outside_b(Vec3 const& p) { return outside_capsule(0.3, 1.2, p); }
  static std::vector<Touching> starts() {  // parallel, parallel with an offset, crossing at an end
    return {placed({0, 0, 0.499}), placed({0.6, 0, 0.499}), placed({0.6, 0, 0.499}, {0, 0, right})};
  }
};
struct SphereOnBoxCase : InSpace {
  static SphereOnBox geometry() { return {.radius = 0.3, .size = {0.6, 0.8, 1.1}, .rounding = 0.05}; }
  static double outside_a(Vec3 const& p) { return p.norm() - 0.3; }
  static double outside_b(Vec3 const& p) { return outside_box({0.6, 0.8, 1.1}, 0.05, p); }
  static std::vector<Touching> starts() { return {placed({0.25, 0, 0.849}), placed({0.25, 0.35, 0.849})}; }
};
struct CapsuleOnBoxCase : InSpace {
  static CapsuleOnBox geometry() {
    return {.radius = 0.2, .length = 0.9, .size = {0.6, 0.8, 1.1}, .rounding = 0.05, .taper = 0.004};
  }
  static double outside_a(Vec3 const& p) { return outside_capsule(0.2, 0.9, p); }
  static double outside_b(Vec3 const& p) { return outside_box({0.6, 0.8, 1.1}, 0.05, p); }
  static std::vector<Touching> starts() {  // flat on a face, along an edge, off the corner
    return {placed({0, 0, 0.749}), placed({0, 0.35, 0.749}), placed({0.6, 0.35, 0.749})};
  }
};
struct BoxOnBoxCase : InSpace {
  static BoxOnBox geometry() {
    return {
        .size_a = {0.5, 0.6, 0.4}, .rounding_a = 0.05, .size_b = {0.6, 0.8, 1.1}, .rounding_b = 0.04, .taper = 0.004};
  }
  static double outside_a(Vec3 const& p) { return outside_box({0.5, 0.6, 0.4}, 0.05, p); }
  static double outside_b(Vec3 const& p) { return outside_box({0.6, 0.8, 1.1}, 0.04, p); }
  static std::vector<Touching> starts() {  // faces aligned, one beyond an edge, corner over an edge, edge on edge
    return {placed({0, 0, 0.749}), placed({0.3, 0.1, 0.749}), placed({0.09, 0.1, 0.749}),
            placed({0, 0, 0.749}, {0, 0, 0.5 * right}), placed({0.52, 0, 0.71})};
  }
};

bool const obeyed[] = {obeys<BoxOnPlaneCase, ContactShapeLaws>("BoxOnPlane"),
                       obeys<CapsuleOnPlaneCase, ContactShapeLaws>("CapsuleOnPlane"),
                       obeys<OctahedronOnPlaneCase, ContactShapeLaws>("PolyhedronOnPlane"),
                       obeys<CompoundCase, ContactShapeLaws>("Compound"),
                       obeys<CapsuleOnSphereCase, ContactShapeLaws>("CapsuleOnSphere"),
                       obeys<CapsuleOnCapsuleCase, ContactShapeLaws>("CapsuleOnCapsule"),
                       obeys<SphereOnBoxCase, ContactShapeLaws>("SphereOnBox"),
                       obeys<CapsuleOnBoxCase, ContactShapeLaws>("CapsuleOnBox"),
                       obeys<BoxOnBoxCase, ContactShapeLaws>("BoxOnBox")};

// --- values computed by hand ----------------------------------------------------------------------------------

// Inside of the core the nearest face pushes the sphere out: its centre is 0.1 below the face x = 0.3.
TEST(SphereOnBox, NearestFacePushesTheSphereOutOfTheCore) {
  SphereOnBox const geometry{.radius = 0.2, .size = {0.6, 0.8, 1.0}};
  auto const p = point_of(geometry, Frame<double>{.r = {0.2, 0.05, 0.1}}, Frame<double>{});
  EXPECT_NEAR(p.depth, 0.3, 1e-15);
  EXPECT_EQ(p.normal, Vec3(1, 0, 0));
}
// A path through the box passes; a path beside it, a path to its other side around an edge, and a start inside do not.
TEST(SphereOnBox, PassesOnlyOnPathsThroughTheBox) {
  SphereOnBox const geometry{.radius = 0.1, .size = {0.4, 0.4, 0.4}, .rounding = 0.02};
  auto const passes = [&](Vec3 const& x, Vec3 const& y) {
    Frame<double> const from[2] = {{.r = x}, {}}, to[2] = {{.r = y}, {}};
    return geometry.passes(from, to);
  };
  EXPECT_TRUE(passes({-0.5, 0.1, 0}, {0.5, 0, 0.1}));
  EXPECT_TRUE(passes({-0.4, 0.2, 0}, {0.1, 0.4, 0}));
  EXPECT_FALSE(passes({-0.5, 0.31, 0}, {0.5, 0.31, 0}));
  EXPECT_FALSE(passes({-0.5, 0, 0}, {-0.35, 0, 0}));
  EXPECT_FALSE(passes({-0.25, 0, 0}, {0.5, 0, 0}));
}
TEST(CapsuleOnSphere, PassesOnlyOnPathsThroughTheCapsule) {
  CapsuleOnSphere const geometry{.radius = 0.1, .length = 0.6, .sphere = 0.1};
  auto const passes = [&](Vec3 const& x, Vec3 const& y) {
    Frame<double> const from[2] = {{}, {.r = x}}, to[2] = {{}, {.r = y}};
    return geometry.passes(from, to);
  };
  EXPECT_TRUE(passes({0.2, -0.3, 0}, {0.2, 0.3, 0.1}));
  EXPECT_FALSE(passes({0.6, -0.3, 0}, {0.6, 0.3, 0}));
  EXPECT_FALSE(passes({0.2, -0.1, 0}, {0.2, 0.3, 0}));
}
// A sphere beside a capsule whose axis turns by 0.01 rad, across directions with two equal components.
TEST(CapsuleOnSphere, DoesNotPassWhenTheAxisTurnsSlightly) {
  CapsuleOnSphere const geometry{.radius = 0.1, .length = 1.0, .sphere = 0.1};
  for (Vec3 const& beside : {Vec3(0, 0.3, 0), Vec3(0, -0.2, 0.2), Vec3(0, 0, -0.3)}) {
    Frame<double> from[2] = {}, to[2] = {};
    from[0].A = detail::axes_about<double>(Vec3(0.8, 0.425, 0.42).normalized());
    to[0].A = detail::axes_about<double>(Vec3(0.8, 0.42, 0.425).normalized());
    from[1].r = to[1].r = beside;
    EXPECT_FALSE(geometry.passes(from, to)) << beside.transpose();
  }
}
// Crossing axes: both points are at the crossing, x = 0.2 on a, and lose ½ κ (s − s_k)² = τ (s − s_k)²/(2 l)², where
// l = 0.5 is the half length of a. Parallel axes: the points are at the ends of the common length.
TEST(CapsuleOnCapsule, PointsMeetAtACrossingAndPartForParallelAxes) {
  double const taper = 1e-3;
  CapsuleOnCapsule const geometry{.radius_a = 0.1, .length_a = 1.0, .radius_b = 0.2, .length_b = 0.6, .taper = taper};
  auto const points = [&](Touching const& f) {
    std::vector<ContactPoint<double>> all;
    geometry.for_each_point<double>(f[0], f[1], [&](auto const& p) { all.push_back(p); });
    return all;
  };
  auto const crossing = points(placed({-0.2, 0, 0.28}, {0, 0, right}));
  ASSERT_EQ(crossing.size(), 2u);  // the axis of a is along y, its middle at x = -0.2 on the axis of b
  for (auto const& p : crossing) {
    EXPECT_LT((p.place.head<2>() - Vec2(-0.2, 0)).norm(), 2e-3);
    EXPECT_NEAR(p.depth, 0.02 - 0.25 * taper, 1e-6);
  }
  auto const parallel = points(placed({0.1, 0, 0.28}));
  ASSERT_EQ(parallel.size(), 2u);  // a: x from -0.4 to 0.6, b: x from -0.3 to 0.3
  EXPECT_NEAR(parallel[0].place[0], -0.3, 2e-3);
  EXPECT_NEAR(parallel[1].place[0], 0.3, 2e-3);
  EXPECT_NEAR(parallel[0].depth, 0.02 - 0.01 * taper, 1e-5);
  EXPECT_NEAR(parallel[1].depth, 0.02 - 0.09 * taper, 1e-5);
}

// Sum of the weights of all points, which is the stiffness relative to that of one sphere.
TEST(BoxOnBox, PointsOfCornersAndEdgesHaveTheStatedWeights) {
  BoxOnBox const geometry{
      .size_a = {0.4, 0.4, 0.4}, .rounding_a = 0.05, .size_b = {1.2, 1.2, 1.2}, .rounding_b = 0.05, .taper = 1e-5};
  auto const weight = [&](Touching const& f) {
    double sum = 0.0;
    geometry.for_each_point<double>(f[0], f[1], [&](auto const& p) { sum += p.handover.share; });
    return sum;
  };
  EXPECT_EQ(weight(placed({0.1, 0.05, 0.799}, {0, 0, 0.3})), 4.0);  // four corners on a face
  double const down = std::acos(1.0 / std::sqrt(3.0));              // the diagonal of a points down
  Vec3 const about = Vec3(1, 1, 1).cross(Vec3(0, 0, -1)).normalized();
  double const corner = 0.15 * std::sqrt(3.0) + 0.05;
  EXPECT_EQ(weight(placed({0, 0, 0.6 + corner - 0.001}, (EIGEN_PI - down) * about)), 1.5);  // one corner of a on a face
  // one corner of b on a face of a: the frames of both cases exchanged, with a as the larger box
  BoxOnBox const exchanged{.size_a = geometry.size_b,
                           .rounding_a = geometry.rounding_b,
                           .size_b = geometry.size_a,
                           .rounding_b = geometry.rounding_a,
                           .taper = geometry.taper};
  Touching f = placed({0, 0, 0.6 + corner - 0.001}, (EIGEN_PI - down) * about);
  std::swap(f[0], f[1]);
  double of_b = 0.0;
  exchanged.for_each_point<double>(f[0], f[1], [&](auto const& p) { of_b += p.handover.share; });
  EXPECT_EQ(of_b, 1.0);
  // edge of a along y across the edge of b along x: both boxes are inclined by 45 degrees
  double const edge_a = 0.15 * std::sqrt(2.0) + 0.05, edge_b = 0.55 * std::sqrt(2.0) + 0.05;
  Touching crossing = placed({0, 0, edge_a + edge_b - 0.001}, {0, 0.5 * right, 0});
  crossing[1].A = exp_so3<double>(Vec3(0.5 * right, 0, 0));
  EXPECT_EQ(weight(crossing), 0.5);
}

// --- bad input ------------------------------------------------------------------------------------------------

TEST(ContactShapes, RefuseSizesByName) {
  auto const told = [](auto const& shape) { return refusal([&] { shape.check("\"crate\""); }); };
  EXPECT_TRUE(has(told(BoxOnPlane{}), "\"crate\": the size of the box must be positive and finite, but is 0"));
  EXPECT_TRUE(has(told(BoxOnPlane{.size = {1, 0.2, 1}, .rounding = 0.11}),
                  "\"crate\": the rounding of the box must lie between 0 and half of the smallest size, 0.1 m, but is "
                  "0.11 m"));
  EXPECT_TRUE(has(told(BoxOnPlane{.size = {1, 1, 1}, .rounding = -0.1}), "but is -0.1 m"));
  EXPECT_TRUE(
      has(told(PolyhedronOnPlane<>{}), "the number of corners of the polyhedron must lie in [1, 16], but is 0"));
  EXPECT_TRUE(has(told(PolyhedronOnPlane<2>{.corners = std::vector<Vec3>(3, Vec3::Zero())}), "[1, 2], but is 3"));
  EXPECT_TRUE(has(told(SphereOnBox{.radius = 0.0, .size = {1, 1, 1}}),
                  "the sum of the sphere's radius and the rounding of the box must be positive"));
  EXPECT_TRUE(has(told(CapsuleOnSphere{.radius = 0.0, .length = 1.0, .sphere = 0.0}),
                  "the sum of the radii of capsule and sphere must be positive"));
  EXPECT_TRUE(
      has(told(CapsuleOnCapsule{.radius_a = 0.0, .length_a = 1.0, .radius_b = 0.0, .length_b = 1.0, .taper = 0.1}),
          "the sum of the radii of the capsules must be positive"));
  EXPECT_TRUE(has(told(CapsuleOnBox{.radius = 0.0, .length = 1.0, .size = {1, 1, 1}, .taper = 0.1}),
                  "the sum of the capsule's radius and the rounding of the box must be positive"));
  BoxOnBox boxes{.size_a = {1, 1, 1}, .rounding_a = 0.0, .size_b = {1, 1, 1}, .rounding_b = 0.0, .taper = 0.1};
  EXPECT_TRUE(has(told(boxes), "the sum of the roundings of the boxes must be positive"));
  boxes.rounding_b = 0.1;
  boxes.taper = 0.0;
  EXPECT_TRUE(has(told(boxes), "\"crate\": the taper of the edges must be positive and finite, but is 0"));
}

}  // namespace contact_shapes_test
