// Contact shapes with invalid or extreme parameters: an error names the parameter, or ten steps give finite numbers.
#include <gtest/gtest.h>

#include <polybody/forces/contact_set.hpp>
#include <polybody/forces/shapes/compound.hpp>

#include "runs.hpp"

namespace polybody::hostile_contact_shapes_test {
namespace {

SpringDamperContact const pads{.stiffness = 1e4, .damping = 10.0, .onset = 1e-3};
Friction const rough{.coefficient = 0.3, .slip_speed = 0.01};

template <class G>
void touch(G const& geometry) {
  Model<Bodies<Rigid<>>, Joints<>, Forces<Contact<G>>> model{Gravity{0, 0, -9.81}};
  auto const body = model.add(Rigid<>(1.0, Vec3(0.1, 0.2, 0.3).asDiagonal(), Placement::at({0, 0, 0.38})), "body");
  model.apply(Contact<G>{geometry, pads, rough}, body.at(Vec3(0, 0, 0)), model.ground().at({0, 0, 0}), "hostile");
  run_ten_steps(model, GeneralisedAlpha{});
}
template <class G>
int try_shape(G const& sane, std::string const& type) {
  EXPECT_NO_THROW(touch(sane)) << type;
  return try_hostile(sane, type, touch<G>);
}

TEST(HostileParameters, OfContactShapes) {
  int tried = 0;
  tried += try_shape(BoxOnPlane{.size = {0.7, 0.7, 0.77}, .rounding = 0.01}, "BoxOnPlane");
  tried += try_shape(CapsuleOnPlane{.radius = 0.39, .length = 0.5}, "CapsuleOnPlane");
  tried += try_shape(PolyhedronOnPlane<>{.corners = {{0.1, 0, -0.385}, {0, 0.1, -0.385}}, .rounding = 0.01},
                     "PolyhedronOnPlane");
  tried += try_shape(CapsuleOnSphere{.radius = 0.2, .length = 0.5, .sphere = 0.19}, "CapsuleOnSphere");
  tried +=
      try_shape(CapsuleOnCapsule{.radius_a = 0.2, .length_a = 0.5, .radius_b = 0.19, .length_b = 0.5, .taper = 1e-4},
                "CapsuleOnCapsule");
  std::cout << tried << " parameters of capsules and shapes on a plane\n";
}
TEST(HostileParameters, OfContactBoxes) {
  int tried = 0;
  tried += try_shape(SphereOnBox{.radius = 0.2, .size = {0.5, 0.5, 0.38}, .rounding = 0.01}, "SphereOnBox");
  tried +=
      try_shape(CapsuleOnBox{.radius = 0.2, .length = 0.4, .size = {0.5, 0.5, 0.38}, .rounding = 0.01, .taper = 1e-4},
                "CapsuleOnBox");
  tried += try_shape(
      BoxOnBox{
          .size_a = {0.3, 0.3, 0.4}, .rounding_a = 0.02, .size_b = {0.5, 0.5, 0.38}, .rounding_b = 0.02, .taper = 1e-4},
      "BoxOnBox");
  std::cout << tried << " parameters of boxes\n";
}
template <class S>
void lie_together(S const& shape) {
  using Set = ContactSet<Shapes<S, Sphere>>;
  Model<Bodies<Rigid<>>, Joints<>, Forces<Set>> model{Gravity{0, 0, -9.81}};
  auto const body = model.add(Rigid<>(1.0, Vec3(0.1, 0.2, 0.3).asDiagonal(), Placement::at({0, 0, 0.38})), "body");
  auto const set = model.apply(Set{pads, rough}, "hostile");
  model.add_member(set, shape, body.at(Vec3(0, 0, 0)), "hostile");
  model.add_member(set, Sphere{.radius = 0.2}, model.ground().at({0, 0, 0}));
  run_ten_steps(model, GeneralisedAlpha{});
}
/// Capsule or box, with its own type in the list of the shapes of the set.
template <class S>
int try_member(S const& sane, std::string const& type) {
  EXPECT_NO_THROW(lie_together(sane)) << type;
  return try_hostile(sane, type, lie_together<S>);
}
TEST(HostileParameters, OfMembersOfContactSets) {
  int tried = 0;
  tried += try_hostile(Sphere{.radius = 0.19}, "Sphere", [](Sphere const& s) { s.check("\"hostile\""); });
  tried += try_member(Capsule{.radius = 0.19, .length = 0.5, .taper = 1e-4}, "Capsule");
  tried += try_member(Box{.size = {0.3, 0.3, 0.38}, .rounding = 0.02, .taper = 1e-4}, "Box");
  std::cout << tried << " parameters of members\n";
}
// The placements of a compound are checked, and so are its shapes.
TEST(HostileParameters, OfCompounds) {
  double const nan = std::numeric_limits<double>::quiet_NaN();
  auto const told = [](auto const& shape) {
    try {
      Compound(shape).check("sledge");
    } catch (InvalidInput const& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  BoxOnPlane const box{.size = {1, 1, 1}};
  EXPECT_EQ(told(Placed{box}), "");
  EXPECT_NE(told(Placed{box, Placement::at({nan, 0, 0})}).find("sledge: the placement's origin"), std::string::npos);
  Placement turned;
  turned.axes(0, 0) = 2.0;
  EXPECT_NE(told(Placed{box, {}, turned}).find("sledge: the placement's axes"), std::string::npos);
  EXPECT_NE(told(Placed{BoxOnPlane{.size = {1, 0, 1}}}).find("sledge: the size of the box"), std::string::npos);
}

}  // namespace
}  // namespace polybody::hostile_contact_shapes_test
