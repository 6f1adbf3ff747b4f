// Friction with invalid or extreme parameters: an error names the parameter, or ten steps give finite numbers.
#include <gtest/gtest.h>

#include <polybody/parts.hpp>

#include "runs.hpp"
#include "scalar_force_words.hpp"

namespace polybody {

template <>
inline constexpr auto words_of<BristleFriction> = words("coefficient", "stiffness", "damping");
template <class G, class N>
inline constexpr auto words_of<Contact<G, N, BristleFriction>> = words("geometry", "normal", "friction");
template <>
inline constexpr auto words_of<FrictionCurve> = words("sliding", "break-away", "Stribeck speed|break-away", "viscous");
template <>
inline constexpr auto words_of<DryFriction> = words("curve", "slip speed");
template <>
inline constexpr auto words_of<LuGreFriction> = words("curve", "stiffness", "damping", "elastic share");
template <>
inline constexpr auto words_of<SphericalFriction> = words("curve", "slip speed");
template <>
inline constexpr auto words_of<SphericalBristleFriction> = words("sliding", "stiffness", "damping");
template <>
inline constexpr auto words_of<SlidingResistance> = words("slip speed");
template <>
inline constexpr auto words_of<StickingResistance> = words("stiffness", "damping");
/// The model sets the joint.
template <class G, class P>
void each_hostile(Joint<G, P>&, std::string const&, Changed const&) {}
template <class J, class C, class R>
inline constexpr auto words_of<ReactionFriction<J, C, R>> =
    words("coefficient", "radius", "resistance", "joint", "axis");

namespace hostile_friction_test {
namespace {

using Pin = Joint<Revolute, Constraint>;
using Slide = Joint<Prismatic, Constraint>;

/// A moving body on a joint, with the force between its markers.
template <class J, class F>
void run_on(J const& joint, F const& force) {
  Model<Bodies<Rigid<>>, Joints<J>, Forces<F>> model{Gravity{0, 0, -9.81}};
  auto const arm = model.add(Rigid<>(1.0, Mat3::Identity(), Placement::at({0.5, 0, 0})), "arm");
  auto const a = model.ground().at({0, 0, 0});
  auto const b = arm.at({-0.5, 0, 0});
  auto const handle = model.connect(joint, a, b, "joint");
  if constexpr (JointForce<F>)
    model.apply(force, handle, "hostile");
  else
    model.apply(force, a, b, "hostile");
  run_ten_steps(model, GeneralisedAlpha{});
}
template <class J, class F>
int try_on(J const& joint, F const& sane, std::string const& type) {
  return try_hostile(sane, type, [&](F const& force) { run_on(joint, force); });
}

TEST(HostileParameters, OfFriction) {
  Pin const pin{Revolute{.axis = Vec3::UnitY()}};
  Slide const slide{Prismatic{.axis = Vec3::UnitZ()}};
  FrictionCurve const curve{.sliding = 1.0, .break_away = 1.5, .stribeck_speed = 0.1, .viscous = 0.1};
  int tried = 0;
  tried += try_on(pin, OnAngle<DryFriction>{{curve, 0.01}}, "DryFriction");
  tried += try_on(
      slide, OnTranslation<LuGreFriction>{{.curve = curve, .stiffness = 100.0, .damping = 1.0, .elastic_share = 0.5}},
      "LuGreFriction");
  Joint<Spherical, Constraint> const ball{};
  tried += try_on(ball, SphericalFriction{curve, 0.01}, "SphericalFriction");
  tried += try_on(ball, SphericalBristleFriction{.sliding = 1.0, .stiffness = 100.0, .damping = 1.0},
                  "SphericalBristleFriction");
  tried += try_on(pin,
                  ReactionFriction<Pin, detail::AngleBetween, SlidingResistance>{
                      .coefficient = 0.1, .radius = 0.1, .resistance = {.slip_speed = 0.01}},
                  "BearingFriction");
  tried += try_on(pin,
                  ReactionFriction<Pin, detail::AngleBetween, StickingResistance>{
                      .coefficient = 0.1, .radius = 0.1, .resistance = {.stiffness = 9.0, .damping = 1.0}},
                  "StickingBearingFriction");
  tried += try_hostile(BristleFriction{.coefficient = 0.3, .stiffness = 1e3, .damping = 10.0}, "BristleFriction",
                       [](BristleFriction const& friction) {
                         using Touch = Contact<SphereOnPlane, SpringDamperContact, BristleFriction>;
                         Model<Bodies<Rigid<>>, Joints<>, Forces<Touch>> model{Gravity{0, 0, -9.81}};
                         auto const sphere =
                             model.add(Rigid<>(1.0, Mat3::Identity(), Placement::at({0, 0, 0.19})), "ball");
                         model.apply(Touch{{.radius = 0.2}, {.stiffness = 1e3, .damping = 1.0}, friction},
                                     sphere.at({0, 0, 0}), model.ground().at({0, 0, 0}), "hostile");
                         run_ten_steps(model, GeneralisedAlpha{});
                       });
  std::cout << tried << " parameters of friction\n";
}

}  // namespace
}  // namespace hostile_friction_test
}  // namespace polybody
