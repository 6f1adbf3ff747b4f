// title: Box on a conveyor belt
// thread: https://github.com/newton-physics/newton/issues/3489
// words: conveyor belt, surface velocity, moving surface, kinematic body, friction work, slip
// wanted: A box is laid on a moving belt. The test of the example did not verify the motion of the box.
// inputs: Box of 2 kg, μ = 0.25, belt at 0.8 m/s. The belt is a body on a slide with a prescribed translation.
//     Bristle friction of 1e6 N/m and 1500 N s/m.
// right: The box accelerates with μ g until it has the speed v of the belt: slip for v/(μ g) over v²/(2 μ g). The
//     heat is ½ m v², and the drive does the work m v².
#include <polybody/parts.hpp>
#include <polybody/polybody.hpp>

#include "answer.hpp"
using namespace polybody;

int main() {
  using Drive = Joint<PrescribedTranslation<Ramp>, Constraint>;
  using Slide = Joint<Prismatic, Constraint>;
  using Touch = Contact<SphereOnPlane, SpringDamperContact, BristleFriction>;
  Model<Bodies<Rigid<>>, Joints<Drive, Slide>, Forces<Touch>> model{Gravity{0, 0, -9.81}};
  double const v = 0.8, mu = 0.25, m = 2.0;
  auto const belt = model.add(Rigid<>(5.0, Mat3(Mat3::Identity())), "belt");
  auto const box = model.add(Rigid<>(m, Mat3(Mat3::Identity()), Placement::at({0, 0, -m * 9.81 / 1e6})), "box");
  auto const ground = model.ground().at({0, 0, 0});
  model.connect(Slide{{.axis = {1, 0, 0}}}, ground, belt.centre(), "slide");
  model.connect(Drive{{.law = {.target = 100 * v, .duration = 100.0}, .axis = {1, 0, 0}}}, ground, belt.centre(),
                "drive");
  model.apply(Touch{{.radius = 0.0}, {.stiffness = 1e6}, {.coefficient = mu, .stiffness = 1e6, .damping = 1500.0}},
              box.centre(), belt.centre(), "contact");
  State x = model.reference_state();
  model.set_velocity(x, belt, {v, 0, 0}, {0, 0, 0});
  EnergyAudit audit(model);
  double slip = 0.0, lag = 0.0;
  for (auto const& now : simulate(model, x, GeneralisedAlpha{}, {.end_time = 0.5, .step = 5e-5})) {
    audit.record(now);
    if (now.frame(box.centre()).v[0] < 0.99 * v) slip = now.t;
    lag = now.position(belt.centre())[0] - now.position(box.centre())[0];
  }
  answer("time to 99 % of the speed of the belt [s]", 0.99 * v / (mu * 9.81), slip, 1e-4);
  answer("distance of the slip [m]", v * v / (2 * mu * 9.81), lag, 5e-5);
  answer("speed of the box at the end [m/s]", v, frame(model, x, box.centre()).v[0], 1e-9);
  answer("heat [J]", 0.5 * m * v * v, audit.dissipated(), 1e-5);
  answer("work of the drive [J]", m * v * v, audit.work_of_drives(), 1e-6);
  return wrong_answers();
}
