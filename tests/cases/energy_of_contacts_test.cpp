// The energy audit of contact shapes with friction and of wheels closes within 1e-6 of the turnover, and the
// unaccounted energy falls with the step. Other tests of this bound: box_on_plane_test, contact_shapes_test (boxes),
// friction_cases_test (a point with friction and with a bristle), car_test.
#include <gtest/gtest.h>

#include <polybody/parts.hpp>

#include "support/closed_audit.hpp"

namespace polybody {
namespace energy_of_contacts_test {

template <class G, class F = Friction>
using Touch = Contact<G, HuntCrossleyContact, F>;
using Sledge = Compound<BoxOnPlane, CapsuleOnPlane>;
/// Model of one body over the ground with one part.
using M = Model<Bodies<Rigid<>>, Joints<>,
                Forces<Touch<CapsuleOnPlane>, Touch<PolyhedronOnPlane<>>, Touch<SphereOnBox>, Touch<CapsuleOnSphere>,
                       Touch<CapsuleOnCapsule>, Touch<CapsuleOnBox>, Touch<Sledge>, Touch<BoxOnPlane, BristleFriction>,
                       Wheel<LinearTyre>, Wheel<MagicFormula>>>;
using Case = AuditCase<M>;

/// Free body of 1 kg above the ground with the normal y.
template <class F>
auto free_body(F const& force, Vec3 const& inertia, Placement const& place, Vec3 const& v, Vec3 const& w) {
  return [=](M& m) {
    auto const body = m.add(Rigid<>(1.0, Mat3(inertia.asDiagonal()), place), "body");
    Mat3 up;
    up << 1, 0, 0, 0, 0, 1, 0, -1, 0;  // z of the ground is y of the world
    m.apply(force, body.at(Vec3(0, 0, 0)), m.ground().at(Placement{Vec3::Zero(), up}), "part");
    State x = m.reference_state();
    m.set_velocity(x, body, v - w.cross(place.origin), w);
    return x;
  };
}

HuntCrossleyContact const pads{.stiffness = 2e5, .exponent = 2.0, .damping = 0.5};
Friction const rough{.coefficient = 0.3, .slip_speed = 0.2};
Vec3 const of_body(0.01, 0.02, 0.03);
Placement const above(Vec3 const& turned, double height) { return Placement::at({0.05, height, 0.02}, turned); }
template <class L>
Wheel<L> wheel(L const& tyre) {
  Wheel<L> w{.radius = 0.3,
             .normal = {.stiffness = 2e3, .damping = 20.0},
             .tyre = tyre,
             .relaxation = {.longitudinal = 0.2, .lateral = 0.2}};
  w.axle = -Vec3::UnitZ();
  return w;
}
template <class G>
auto falls(G const& shape, Vec3 const& turned, double height) {
  return free_body(Touch<G>{shape, pads, rough}, of_body, above(turned, height), {0.3, -0.4, 0.2}, {1, 2, -3});
}

std::vector<Case> contacts() {
  Vec3 const size(0.1, 0.12, 0.16), base(0.5, 0.5, 0.2);
  std::vector<Vec3> const corners = {{0.1, 0, -0.1}, {-0.1, 0.1, -0.1}, {-0.1, -0.1, -0.1}, {0, 0, 0.1}};
  return {{"CapsuleOnPlane", 0.3, 1e-4, 2, falls(CapsuleOnPlane{.radius = 0.05, .length = 0.3}, {0.2, 0.1, 0.1}, 0.1)},
          {"PolyhedronOnPlane", 0.3, 1e-4, 2, falls(PolyhedronOnPlane<>{.corners = corners}, {0.2, 0.1, 0.1}, 0.15)},
          {"SphereOnBox", 0.3, 1e-4, 2,
           falls(SphereOnBox{.radius = 0.05, .size = base, .rounding = 0.01}, {0, 0, 0}, 0.16)},
          {"CapsuleOnSphere", 0.3, 1e-4, 2,
           falls(CapsuleOnSphere{.radius = 0.05, .length = 0.3, .sphere = 0.1}, {0.2, 0.1, 0.1}, 0.17)},
          {"CapsuleOnCapsule", 0.2, 1e-4, 2,
           falls(CapsuleOnCapsule{.radius_a = 0.05, .length_a = 0.3, .radius_b = 0.05, .length_b = 0.4, .taper = 1e-4},
                 {0.2, 0.5, 0.1}, 0.11)},
          {"CapsuleOnBox", 0.15, 2e-5, 2,
           falls(CapsuleOnBox{.radius = 0.05, .length = 0.3, .size = base, .rounding = 0.01, .taper = 2e-3},
                 {0.2, 0.5, 0.1}, 0.17)},
          {"Compound", 0.3, 1e-4, 2,
           falls(Sledge(Placed{BoxOnPlane{.size = size}, Placement::at({0, 0.1, 0})},
                        Placed{CapsuleOnPlane{.radius = 0.03, .length = 0.35}, Placement::at({0.1, 0, 0})}),
                 {0.2, 0.1, 0.1}, 0.15)},
          {"BoxOnPlane with bristles", 0.3, 1e-4, 2,
           free_body(
               Touch<BoxOnPlane, BristleFriction>{
                   {.size = size}, pads, {.coefficient = 0.3, .stiffness = 1e4, .damping = 60.0}},
               of_body, above({0.2, 0.1, 0.1}, 0.12), {0.3, -0.4, 0.2}, {1, 2, -3})},
          {"Wheel with LinearTyre", 1.0, 2e-4, 2,
           free_body(wheel(LinearTyre{.longitudinal_stiffness = 40.0,
                                      .cornering_stiffness = 30.0,
                                      .longitudinal_friction = 0.6,
                                      .lateral_friction = 0.6}),
                     of_body, above({0, 0.1, 0}, 0.295), {3, 0, 0.1}, {0.1, 0, -2})},
          {"Wheel with MagicFormula", 1.0, 5e-4, 3,
           free_body(wheel(MagicFormula{.longitudinal = MagicCurve{.B = 10.0, .C = 1.5, .D = 0.8},
                                        .lateral = MagicCurve{.B = 8.0, .C = 1.4, .D = 0.8}}),
                     of_body, above({0, 0.1, 0}, 0.295), {3, 0, 0.1}, {0.1, 0, -2})}};
}

TEST(EnergyOfContacts, Closes) { expect_closed(contacts()); }

}  // namespace energy_of_contacts_test
}  // namespace polybody
