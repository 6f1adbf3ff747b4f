// title: Shaft that turns an arm
// thread: https://github.com/Dhondtguido/CalculiX/issues/42
// wanted: The far end of a shaft turns slowly, and an arm on its near end follows. The arm turned by 0.055 rad instead
//     of 0.01 rad with a coarse mesh, and only in dynamics.
// inputs: Shaft of 2 m, arm of 1 m at a right angle, both 10×10 mm, E = 2e11 Pa, ν = 0, ρ = 100 kg/m³. Points hold
//     both ends of the shaft. The turn of the far end is 0.02 t rad up to 0.5 s, then 0.01 rad. 2 + 4 elements.
// right: Legendre–Ritz method with 24 functions and exact modal response. The tip vibrates about the ramp at 22.04 Hz.
#include <polybody/ffr.hpp>
#include <polybody/polybody.hpp>

#include <numbers>

#include "answer.hpp"
using namespace polybody;

int main() {
  using Corner = Joint<Weld, Constraint>;
  using Ball = Joint<Spherical, Constraint>;
  using Drive = Joint<PrescribedAngle<Ramp>, Constraint>;
  Model<Bodies<Ffr>, Joints<Corner, Ball, Drive>> model;
  auto const bar = [](double length, double angle) {
    return Bar{.length = length,
               .section = Rectangle{.height = 0.01, .width = 0.01},
               .material = Material{.density = 100.0, .young = 2e11, .poisson = 0.0},
               .placement = Placement::at({0, 0, 0}, {0, 0, angle})};
  };
  auto const shaft = model.add(Ffr::from(bar(2.0, 0.0), 2), "shaft"),
             arm = model.add(Ffr::from(bar(1.0, 0.5 * std::numbers::pi), 4), "arm");
  auto const near = model.ground().at({0, 0, 0}), far = model.ground().at({2, 0, 0});
  model.connect(Corner{}, shaft.at(0.0), arm.at(0.0), "corner");
  model.connect(Ball{}, near, shaft.at(0.0), "near end");
  model.connect(Ball{}, far, shaft.at(2.0), "far end");
  model.connect(Drive{{.law = {.target = 0.01, .duration = 0.5}, .axis = Vec3::UnitX()}}, far, shaft.at(2.0), "drive");
  State x = model.reference_state();
  auto const tip = [&](double t) {
    simulate(model, x, GeneralisedAlpha{.rho_inf = 0.9}, {.end_time = t, .step = 2e-4}).run();
    return position(model, x, arm.at(1.0))[2];
  };
  answer("deflection of the tip at 0.01 s [m]", 5.610e-5, tip(0.01), 2e-6);
  answer("deflection of the tip at 0.02 s [m]", 3.46715e-4, tip(0.02), 2e-6);
  answer("deflection of the tip at 0.1 s [m]", 1.859582e-3, tip(0.1), 2e-6);
  answer("deflection of the tip at 0.5 s [m]", 9.982518e-3, tip(0.5), 2e-6);
  answer("deflection of the tip at 1 s [m]", 9.982472e-3, tip(1.0), 2e-6);
  return wrong_answers();
}
