// title: Hub with a soft appendage
// thread: https://github.com/jgerstmayr/EXUDYN/issues/1
// wanted: A cable is clamped to a rigid hub, which a torque drives. The joint did not hold the planar cable.
// inputs: Hub on a pin, radius 1 m, 5 kg m². Cable of 5 m along the radius, 20×20 mm, ρ = 2766.7 kg/m³, E = 68.952e9
//     Pa, 8 elements. Torque 250 sin(2πt/4) N m up to 4 s, then zero. In the plane.
// right: Angular momentum (500/π)(1 − cos(πt/2)), and 0 from 4 s on. Motion of an inextensible rod by a Ritz method
//     in the slope, with DOP853.
#include <polybody/polybody.hpp>

#include <numbers>

#include "answer.hpp"
using namespace polybody;

int main() {
  using Cable = planar::AncfCable<EngineeringStrain>;
  using Pin = Joint<planar::Revolute, Constraint>;
  using Clamp = Joint<planar::Weld, Constraint>;
  auto const sine = [](double t) -> Motion { return {t < 4.0 ? std::sin(0.5 * std::numbers::pi * t) : 0.0, 0.0, 0.0}; };
  using Torque = PointMoment<std::remove_const_t<decltype(sine)>>;
  Model<Bodies<planar::Rigid, Cable>, Joints<Pin, Clamp>, Forces<Torque>> model;
  auto const hub = model.add(planar::Rigid(1.0, 5.0), "hub");
  auto const cable = model.add(Cable::from({.length = 5.0,
                                            .section = Rectangle{.height = 0.02, .width = 0.02},
                                            .material = Material{.density = 2766.7, .young = 68.952e9},
                                            .placement = Placement::planar(1, 0)},
                                           8),
                               "cable");
  model.connect(Pin{}, model.ground().at({0, 0, 0}), hub.centre(), "pin");
  model.connect(Clamp{}, hub.at(Vec2(1, 0)), cable.at(0.0), "clamp");
  model.apply(Torque{.moment = {0, 0, 250.0}, .law = sine}, hub.centre(), "torque");
  State x = model.reference_state();
  auto const tip = [&](double t) {  // in the axes of the hub, from the rim
    simulate(model, x, GeneralisedAlpha{.rho_inf = 0.9}, {.end_time = t, .step = 5e-4, .breakpoints = {4.0}}).run();
    return Vec3(frame(model, x, hub.centre()).A.transpose() * position(model, x, cable.at(5.0)) - Vec3::UnitX());
  };
  answer("deflection of the tip at 1 s [m]", -1.3363, tip(1.0)[1], 3e-3);
  answer("angle of the hub at 1 s [rad]", 0.85510, coordinates_of(model, x, hub)[2], 1e-3);
  answer("deflection of the tip at 2 s [m]", -0.1188, tip(2.0)[1], 3e-3);
  answer("angle of the hub at 2 s [rad]", 3.80915, coordinates_of(model, x, hub)[2], 1e-3);
  answer("angular momentum at 2 s [kg m²/s]", 318.309886, momentum(model, x).angular[2], 3.2e-4);
  answer("deflection of the tip at 6 s [m]", -0.2563, tip(6.0)[1], 3e-3);
  answer("angle of the hub at 6 s [rad]", 7.61974, coordinates_of(model, x, hub)[2], 1e-3);
  answer("angular momentum at 6 s [kg m²/s]", 0.0, momentum(model, x).angular[2], 3.2e-4);
  return wrong_answers();
}
