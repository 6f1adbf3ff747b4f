#include <gtest/gtest.h>

#include <polybody/forces/shapes/box_contact.hpp>
#include <polybody/forces/shapes/capsule_contact.hpp>
#include <polybody/forces/shapes/compound.hpp>
#include <polybody/forces/shapes/shapes_on_plane.hpp>
#include <polybody/testing/contact_shape_laws.hpp>

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

}  // namespace contact_shapes_test
