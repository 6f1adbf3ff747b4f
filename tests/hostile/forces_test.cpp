// Forces and joints with invalid or extreme parameters: an error names the parameter, or ten steps and an equilibrium
// give finite numbers.
#include <gtest/gtest.h>

#include <polybody/polybody.hpp>

#include "runs.hpp"

namespace polybody::hostile_forces_test {
namespace {

using OnPlane = Contact<SphereOnPlane>;
using OnSphere = Contact<SphereOnSphere, HertzContact>;
using OnCylinder = Contact<SphereOnCylinder, HuntCrossleyContact>;
using OnGround = Contact<LinkGroundContact<FlatGround>>;
using OnWaves = Contact<LinkGroundContact<Washboard>>;
using OnRoller = Contact<LinkRollerContact<>>;
using OnRims = Contact<GuideHornContact<>>;
using OnSprocket = Contact<PinSprocketContact<>>;
using LinearWheel = Wheel<LinearTyre>;
using MagicWheel = Wheel<MagicFormula, Washboard>;

template <class G>
using Held = Joint<G, Constraint>;
template <class P>
using Pin = Joint<Revolute, P>;
using Laws = NonlinearBushing<LinearLaw, LinearLaw, LinearLaw, LinearLaw, LinearLaw, LinearLaw>;

using Mechanism =
    Model<Bodies<Rigid<>>,
          Joints<Held<Distance>, Held<RevolutePin>, Held<Screw>, Held<Gear>, Held<RackAndPinion>, Held<RollingDisc>,
                 Held<KnifeEdge>, Held<PrescribedAngle<Ramp>>, Held<PrescribedAngle<IntegralOf<SmoothRamp>>>,
                 Held<PrescribedTranslation<SpinUp>>, Held<PrescribedDistance<Constant>>, Held<Revolute>, Pin<Penalty>,
                 Pin<PenaltyPerEquation<5>>, Pin<Bushing>, Pin<Laws>>,
          Forces<SpringDamper, MaxwellElement, AxialSpring, PointForce<>, PointForce<Ramp>, PointForce<Window>,
                 PointMoment<SmoothRamp>, PointMoment<SpinUp>, OnPlane, OnSphere, OnCylinder, OnGround, OnWaves,
                 OnRoller, OnRims, OnSprocket, LinearWheel, MagicWheel>>;

SpringDamperContact const pads{.stiffness = 1e4, .damping = 10.0, .onset = 1e-3};
Friction const rough{.coefficient = 0.3, .slip_speed = 0.01};

/// A free body, 0.4 above the marker of the ground.
struct Stage {
  Mechanism model{Gravity{0, 0, -9.81}};
  BodyHandle<Rigid<>> body =
      model.add(Rigid<>(1.0, Vec3(0.1, 0.2, 0.3).asDiagonal(), Placement::at(Vec3(0, 0, 0.4))), "body");
};

template <class F>
void act(F const& force) {
  Stage s;
  if constexpr (F::markers == 1)
    s.model.apply(force, s.body.at({0.1, 0, 0}), "hostile");
  else if constexpr (std::is_same_v<F, AxialSpring>)
    s.model.apply(force, s.model.ground().at({0, 0, 0}), s.body.at({0, 0, 0}), "hostile");
  else
    s.model.apply(force, s.body.at({0, 0, 0}), s.model.ground().at({0, 0, 0}), "hostile");
  run_ten_steps(s.model, GeneralisedAlpha{});
}

template <class F>
int try_force(F const& sane, std::string const& type) {
  return try_hostile(sane, type, act<F>);
}

TEST(HostileParameters, OfForces) {
  int tried = 0;
  tried += try_force(SpringDamper{.stiffness = 10.0, .damping = 1.0, .free_length = 0.5}, "SpringDamper");
  tried += try_force(MaxwellElement{.stiffness = 10.0, .damping = 1.0, .free_length = 0.5}, "MaxwellElement");
  tried +=
      try_force(AxialSpring{.stiffness = 10.0, .damping = 1.0, .preload = 1.0, .axis = Vec3::UnitZ()}, "AxialSpring");
  tried += try_force(PointForce<>{.force = {1, 2, 3}}, "PointForce");
  tried +=
      try_force(PointForce<Ramp>{.force = {1, 2, 3}, .law = {.target = 1.0, .duration = 0.05}}, "PointForce<Ramp>");
  tried += try_force(PointForce<Window>{.force = {1, 2, 3}, .law = {.from = 0.02, .to = 0.05}}, "PointForce<Window>");
  tried += try_force(PointMoment<SmoothRamp>{.moment = {1, 2, 3}, .law = {.target = 1.0, .duration = 0.05}},
                     "PointMoment<SmoothRamp>");
  tried += try_force(PointMoment<SpinUp>{.moment = {1, 2, 3}, .law = {.speed = 1.0, .duration = 0.05}},
                     "PointMoment<SpinUp>");
  std::cout << tried << " parameters of forces\n";
}

TEST(HostileParameters, OfContacts) {
  int tried = 0;
  tried += try_force(OnPlane{.geometry = {.radius = 0.5}, .normal = pads, .friction = rough}, "SphereOnPlane");
  tried += try_force(
      OnSphere{
          .geometry = {.radius_a = 0.3, .radius_b = 0.2}, .normal = {.modulus = 1e4, .radius = 0.1}, .friction = rough},
      "SphereOnSphere");
  tried +=
      try_force(OnCylinder{.geometry = {.radius = 0.3, .cylinder = 0.2}, .normal = {.stiffness = 1e4, .damping = 0.1}},
                "SphereOnCylinder");
  std::vector<Vec3> const pad{Vec3(0.1, 0.1, -0.41), Vec3(-0.1, 0.1, -0.41)};
  tried +=
      try_force(OnGround{.geometry = {.terrain = {}, .pad = pad}, .normal = pads}, "LinkGroundContact<FlatGround>");
  tried +=
      try_force(OnWaves{.geometry = {.terrain = {.amplitude = 0.1, .wavelength = 2.0}, .pad = pad}, .normal = pads},
                "LinkGroundContact<Washboard>");
  tried += try_force(
      OnRoller{.geometry = {.pitch = 0.15, .half_thickness = 0.15, .half_width = 0.1, .radius = 0.3}, .normal = pads},
      "LinkRollerContact");
  tried += try_force(OnRims{.geometry = {.tip = Vec3(0, 0.05, -0.2), .play = 0.01, .radius = 0.3}, .normal = pads},
                     "GuideHornContact");
  SprocketProfile const profile{
      .teeth = 10, .pitch = 0.1524, .pin_radius = 0.02, .valley_radius = 0.035, .flank = 1.05, .tip_radius = 0.265};
  profile.check("the sane one");
  tried += try_force(OnSprocket{.geometry = {.profile = profile, .valley = 0.0}, .normal = pads}, "PinSprocketContact");
  std::cout << tried << " parameters of contacts\n";
}

TEST(HostileParameters, OfWheels) {
  int tried = 0;
  TyreRelaxation const relaxation{.longitudinal = 0.2, .lateral = 0.3, .damping_time = 1e-3};
  tried += try_force(LinearWheel{.radius = 0.5,
                                 .crown = 0.1,
                                 .axle = Vec3::UnitY(),
                                 .normal = pads,
                                 .tyre = {.longitudinal_stiffness = 1e3,
                                          .cornering_stiffness = 2e3,
                                          .longitudinal_friction = 1.0,
                                          .lateral_friction = 0.9,
                                          .camber_stiffness = 10.0,
                                          .trail = 0.03},
                                 .relaxation = relaxation,
                                 .rolling = RollingResistance{.coefficient = 0.01, .speed = 0.1}},
                     "Wheel<LinearTyre>");
  tried += try_force(MagicWheel{.radius = 0.5,
                                .axle = Vec3::UnitY(),
                                .normal = pads,
                                .tyre = {.longitudinal = MagicCurve{10.0, 1.9, 1.0, 0.97},
                                         .lateral = MagicCurve{12.0, 1.3, 0.9, -0.7},
                                         .aligning = {12.0, 2.4, -0.01, -2.6},
                                         .camber_factor = 0.05},
                                .relaxation = relaxation,
                                .terrain = {.amplitude = 0.01, .wavelength = 4.0}},
                     "Wheel<MagicFormula>");
  std::cout << tried << " parameters of wheels\n";
}

/// A joint between the ground and the body, with markers `arm` below and above each other.
template <class J>
void join(J const& joint, double arm, double height = 0.0) {
  Stage s;
  s.model.connect(joint, s.model.ground().at({0, 0, height}), s.body.at({0, 0, arm}), "hostile");
  run_ten_steps(s.model, GeneralisedAlpha{});
}
template <class G>
int try_geometry(G const& sane, std::string const& type, double arm, double height = 0.0) {
  return try_hostile(sane, type, [&](G const& g) { join(Held<G>{g, Constraint{}}, arm, height); });
}
template <class P>
int try_policy(P const& sane, std::string const& type) {
  return try_hostile(sane, type, [](P const& p) { join(Pin<P>{Revolute{.axis = Vec3::UnitY()}, p}, -0.4); });
}

TEST(HostileParameters, OfJoints) {
  int tried = 0;
  Vec3 const x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  tried += try_geometry(Distance{.length = 0.4}, "Distance", 0.0);
  tried += try_geometry(RevolutePin{.distance = 0.4, .axis = z}, "RevolutePin", 0.0);
  tried += try_geometry(Screw{.pitch = 0.1, .axis = z}, "Screw", -0.4);
  tried += try_geometry(Gear{.teeth_a = 20, .teeth_b = 40, .axis = y, .centres = z}, "Gear", 0.0);
  tried += try_geometry(RackAndPinion{.radius = 0.4, .axis = y, .direction = x}, "RackAndPinion", 0.0);
  tried += try_geometry(RollingDisc{.radius = 0.4, .axis = y, .normal = z}, "RollingDisc", 0.0);
  tried += try_geometry(KnifeEdge{.across = y}, "KnifeEdge", 0.0);
  tried += try_geometry(Revolute{.axis = y}, "Revolute", -0.4);
  tried += try_geometry(PrescribedAngle<Ramp>{.law = {.target = 0.1, .duration = 0.05}, .axis = y},
                        "PrescribedAngle<Ramp>", 0.0);
  tried += try_geometry(PrescribedAngle<IntegralOf<SmoothRamp>>{.law = {{.target = 0.1, .duration = 0.05}}, .axis = y},
                        "PrescribedAngle<IntegralOf<SmoothRamp>>", 0.0);
  tried += try_geometry(PrescribedTranslation<SpinUp>{.law = {.speed = 0.1, .duration = 0.05}, .axis = z},
                        "PrescribedTranslation<SpinUp>", -0.4);
  tried += try_geometry(PrescribedDistance<Constant>{.law = {.value = 0.1}, .length = 0.3},
                        "PrescribedDistance<Constant>", 0.0);
  std::cout << tried << " parameters of joints\n";
}

TEST(HostileParameters, OfPolicies) {
  int tried = 0;
  tried += try_policy(Penalty{.stiffness = 1e5, .damping = 10.0}, "Penalty");
  using Five = Vec<double, 5>;
  tried +=
      try_policy(PenaltyPerEquation<5>{.stiffness = Five(Five::Constant(1e5)), .damping = Five(Five::Constant(10.0))},
                 "PenaltyPerEquation");
  Vec3 const one(1, 1, 1);
  tried += try_policy(Bushing{.stiffness = Bushing::diagonal(1e5 * one, 1e3 * one),
                              .damping = Bushing::diagonal(10.0 * one, 1.0 * one)},
                      "Bushing");
  LinearLaw const law{.stiffness = 1e4, .damping = 10.0};
  tried += try_hostile(law, "LinearLaw of a NonlinearBushing", [&](LinearLaw const& hostile) {
    join(Pin<Laws>{Revolute{.axis = Vec3::UnitY()}, Laws{hostile, law, law, law, law, hostile}}, -0.4);
  });
  MonotoneTable const table({{-1.0, -1e4}, {1.0, 1e4}});
  tried += try_hostile(TabulatedLaw{.force = table, .damping = 10.0}, "TabulatedLaw", [](TabulatedLaw const& hostile) {
    hostile.check("\"hostile\"");
    EXPECT_TRUE(std::isfinite(hostile(0.1, 0.0)));
  });
  tried += try_hostile(Basquin{.range = 1e8, .cycles = 2e6, .exponent = 3.0}, "Basquin", [](Basquin const& hostile) {
    std::array<StressCycle, 1> const cycles{{{.range = 1e7, .mean = 0.0, .count = 1.0}}};
    EXPECT_FALSE(std::isnan(damage(std::span<StressCycle const>(cycles), hostile)));
  });
  std::cout << tried << " parameters of policies\n";
}

}  // namespace
}  // namespace polybody::hostile_forces_test
