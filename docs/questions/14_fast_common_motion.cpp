// title: Tolerance beside an orbital speed
// thread: https://github.com/AVSLab/basilisk/pull/1392
// words: adaptive step size, relative tolerance, error norm, satellite, solar panel, attitude
// wanted: An adaptive integrator controls the attitude of a satellite. One error norm contained the orbital speed
//     of 7600 m/s, so the steps were too long for the attitude.
// inputs: Hub of 100 kg and 20 kg m², panel of 10 kg and 2 m on a pin 0.5 m from the hub's centre, torsion spring
//     of 5 N m/rad. In the plane, at 7600 m/s and 0.3 rad/s, panel at 0.2 rad. Tolerance 1e-8.
// right: DOP853 of SciPy at a tolerance of 1e-13, without the common motion. By Galilean invariance the angles and
//     the number of steps do not depend on the common motion.
#include <polybody/parts.hpp>
#include <polybody/polybody.hpp>

#include "answer.hpp"
using namespace polybody;

int main() {
  using Pin = Joint<planar::Revolute, Constraint>;
  using Spring = OnAngle<LinearSpring>;
  double steps[2] = {0.0, 0.0};
  State x;
  for (int const moving : {0, 1}) {
    Model<Bodies<planar::Rigid>, Joints<Pin>, Forces<Spring>> model;
    double const speed = moving ? 7600.0 : 0.0, rate = 0.3, open = 0.2;
    auto const hub = model.add(planar::Rigid(100.0, 20.0), "hub");
    auto const panel = model.add(
        planar::Rigid(10.0, 10.0 * 4 / 12, Placement::planar(0.5 + std::cos(open), std::sin(open), open)), "panel");
    auto const pin = model.connect(Pin{}, hub.at(Vec2(0.5, 0)), panel.at(Vec2(-1, 0)), "pin");
    model.apply(Spring{{.stiffness = 5.0, .free = -open}}, pin, "spring");
    x = model.reference_state();
    model.set_velocity(x, hub, {speed, 0, 0}, {0, 0, rate});
    model.set_velocity(x, panel, {speed, 0, 0}, {0, 0, rate});  // of the same rigid motion
    steps[moving] =
        double(simulate(model, x, DormandPrince<Projection>{.relative_tolerance = 1e-8, .absolute_tolerance = 1e-10},
                        {.end_time = 50.0, .step = 0.01})
                   .run()
                   .steps);
  }
  answer("position of the hub at 50 s, less 7600 t [m]", -0.03204552, x.q[0] - 7600.0 * 50.0, 1e-6);
  answer("angle of the hub at 50 s [rad]", 15.09720528, x.q[2], 1e-6);
  answer("angle of the panel at 50 s [rad]", -0.13013544, x.q[5] - x.q[2], 1e-6);
  answer("rate of the panel at 50 s [rad/s]", 0.14579714, x.v[5] - x.v[2], 1e-6);
  answer("ratio of the numbers of steps, in flight to at rest [1]", 1.0, steps[1] / steps[0], 0.1);
  return wrong_answers();
}
