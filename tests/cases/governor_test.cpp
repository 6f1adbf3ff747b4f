// Stiff flyball governor (R5: IFToMM benchmark A05): four bodies in space with stiff spring-dampers.

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/held.hpp"

namespace polybody {
namespace governor_test {

/// A shaft rotates about z and carries a slider of 3 kg and two rods. The rods are 30° below the horizontal and have
/// 5 kg at their ends. A spring-damper connects the middle of each rod with the slider. All bodies rotate at 2π
/// rad/s.
template <class Policy = Constraint>
struct Governor {
  using Pin = Joint<Revolute, Policy>;
  using Slide = Joint<Prismatic, Policy>;
  using Body = Rigid<>;
  Model<Bodies<Body>, Joints<Pin, Slide>, Forces<SpringDamper>> model{Gravity{0, 0, -9.81}};
  BodyHandle<Body> shaft = model.add(prism(0.3), "shaft"), slider = model.add(cube(3.0), "slider");
  std::vector<BodyHandle<Body>> rods;
  State x;

  /// Prism of 1 m along z, 0.01 m square.
  static Body prism(double mass) {
    double const across = mass * (1.0 + 1e-4) / 12.0;
    return {mass, Vec3(across, across, mass * 2e-4 / 12.0).asDiagonal().toDenseMatrix(), Placement::at({0, 0, 0.5})};
  }
  /// Cube of 0.1 m.
  static Body cube(double mass) { return {mass, Mat3::Identity() * (mass * 0.02 / 12.0), Placement::at({0, 0, 0.5})}; }

  explicit Governor(Policy const& policy = {}) {
    double const rod = 0.3, ball = 5.0, mass = rod + ball, own = rod * 2e-4 / 12.0;  // a prism and a point
    double const centre = (0.5 * rod + ball) / mass;
    double const across =
        rod * ((1.0 + 1e-4) / 12.0 + (centre - 0.5) * (centre - 0.5)) + ball * (1.0 - centre) * (1.0 - centre);
    double const down = std::numbers::pi / 6.0;
    model.connect(Pin{Revolute{.axis = Vec3::UnitZ()}, policy}, model.ground().at({0, 0, 0}),
                  shaft.at(Vec3(0, 0, -0.5)), "bearing");
    model.connect(Slide{Prismatic{.axis = Vec3::UnitZ()}, policy}, shaft.at(Vec3(0, 0, 0)), slider.at(Vec3(0, 0, 0)),
                  "slide");
    for (double const side : {1.0, -1.0}) {
      Mat3 axes;
      axes << side * std::cos(down), 0, side * std::sin(down), 0, side, 0, -std::sin(down), 0, std::cos(down);
      Vec3 const pivot(0.05 * side, 0, 1);
      rods.push_back(model.add(Body(mass, Vec3(own, across, across).asDiagonal().toDenseMatrix(),
                                    Placement{pivot + centre * axes.col(0), axes}),
                               side > 0 ? "right" : "left"));
      model.connect(Pin{Revolute{.axis = Vec3::UnitY()}, policy}, shaft.at(Vec3(0.05 * side, 0, 0.5)),
                    rods.back().at(Vec3(-centre, 0, 0)));
      model.apply(SpringDamper{.stiffness = 8e5, .damping = 4e4, .free_length = 0.5},
                  rods.back().at(Vec3(0.5 - centre, 0, 0)), slider.at(Vec3(0.05 * side, 0, 0)));
    }
    x = model.reference_state();
    Vec3 const spin(0, 0, 2.0 * std::numbers::pi);
    model.set_velocity(x, shaft, Vec3::Zero(), spin);
    model.set_velocity(x, slider, Vec3::Zero(), spin);
    for (auto const& rod_handle : rods) model.set_velocity(x, rod_handle, Vec3::Zero(), spin);
  }
  double height() const { return position(model, x, slider.at(Vec3(0, 0, 0)))[2]; }
  /// Angle of rod i below the horizontal.
  double angle(std::size_t i) const { return std::asin(-frame(model, x, rods[i].at(Vec3(0, 0, 0))).A(2, 0)); }
  /// Angle of the shaft, within one revolution.
  double turn() const {
    Mat3 const A = frame(model, x, shaft.at(Vec3(0, 0, 0))).A;
    return std::atan2(A(1, 0), A(0, 0));
  }
};

struct MarkerKinematics {
  double t, height, angle, turn;
};
constexpr MarkerKinematics r5[] = {
    {0.1, 0.5238364756, 0.4961738691, 0.622106681}, {0.2, 0.5850798118, 0.4277204683, 1.213937177},
    {0.5, 0.7432494248, 0.2594913815, 2.807679488}, {1, 0.5014209224, 0.5218333016, 5.586346966},
    {2, 0.5059092943, 0.5166637974, 11.173267076},  {3, 0.5132460783, 0.5082455270, 16.761308972},
    {5, 0.5355631037, 0.4828745766, 27.942531991},  {7.5, 0.6771929637, 0.3285415751, 42.102747732},
    {10, 0.6196229171, 0.3900737018, 55.935409909}};

template <class Policy = Constraint, class I>
void expect_r5(I const& integrator, double step, double tolerance, double momentum_tolerance, char const* formulation,
               Policy const& policy = {}) {
  Governor<Policy> governor(policy);
  double const before = momentum(governor.model, governor.x).angular[2];
  auto const claim = [&](char const* what) {
    return Claim{"R5", what, By::independent, "ordinary solver in the three freedoms", formulation};
  };
  double drift = 0.0;
  for (MarkerKinematics const& p : r5) {
    simulate(governor.model, governor.x, integrator, {.end_time = p.t, .step = step}).run();
    Instance const at{equals("t", p.t)};
    held(claim("height of the slider [m]"), governor.height(), p.height, tolerance, at);
    for (std::size_t i : {0u, 1u}) held(claim("angle of both rods [rad]"), governor.angle(i), p.angle, tolerance, at);
    double const turns = std::remainder(governor.turn() - p.turn, 2.0 * std::numbers::pi);
    held(claim("turn of the shaft [rad]"), p.turn + turns, p.turn, 10.0 * tolerance, at);
    drift = std::max(drift, std::abs(momentum(governor.model, governor.x).angular[2] - before) / before);
  }
  // no moment about z acts on the governor
  held_within({"R5", "angular momentum about z, drift of itself", By::closed_form, "invariant", formulation}, drift,
              momentum_tolerance, {.scale = 1.0});
}

// The published tolerance of s is 1e-4 at h = 1e-3.
TEST(Governor, MovesAsPublishedWithAlphaMethods) {
  expect_r5(GeneralisedAlpha{}, 1e-3, 1e-4, 1e-5, "generalised-α, h = 1e-3 s");
  expect_r5(HhtAlpha{}, 1e-3, 1e-4, 1e-5, "HHT-α, h = 1e-3 s");
}
TEST(Governor, MovesAsPublishedToTheDigitsWithRadau) { expect_r5(Radau{}, 5e-3, 1e-8, 1e-9, "Radau IIA, h = 5e-3 s"); }
TEST(Governor, MovesAsPublishedInJointCoordinates) {
  expect_r5<JointCoordinates>(GeneralisedAlpha{}, 1e-3, 1e-4, 1e-5, "joint coordinates, generalised-α, h = 1e-3 s");
}
// Pins and slide have deflections F/k, some 200 N/1e9 N/m.
TEST(Governor, MovesAsPublishedOnPenalties) {
  expect_r5(GeneralisedAlpha{}, 1e-3, 1e-4, 2e-5, "penalties of 1e9 N/m, generalised-α, h = 1e-3 s",
            Penalty{.stiffness = 1e9, .damping = 1e4});
}

}  // namespace governor_test
}  // namespace polybody
