// title: Platform on two Scott–Russell linkages
// thread: https://github.com/jgerstmayr/EXUDYN/issues/39
// wanted: A platform is lifted by two Scott–Russell linkages. With revolute pins everywhere the Jacobian was
//     singular.
// inputs: Long bars of 1.2 m and 8 kg, short bars of 0.6 m and 4 kg, units at x = 0 and 1.5 m, angle 35°. Platform
//     of 120 kg, its centre 0.5 m from the left head; its right end slides on the right head. In the plane.
// right: Virtual work: the force that holds a foot is (N + m_l g/2 + m_s g/4) cot ϑ, with the load N of the head.
#include <polybody/polybody.hpp>

#include <numbers>

#include "answer.hpp"
using namespace polybody;

int main() {
  using Pin = Joint<planar::Revolute, Constraint>;
  using Guide = Joint<PointInPlane, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Pin, Guide>> model{Gravity{0, -9.81, 0}};
  double const a = 0.6, D = 1.5, angle = 35.0 * std::numbers::pi / 180.0, c = a * std::cos(angle),
               s = a * std::sin(angle);
  Guide const rail{PointInPlane{.normal = {0, 1, 0}}}, hold{PointInPlane{.normal = {1, 0, 0}}};
  auto const platform = model.add(planar::Rigid(120, 10, Placement::planar(0.5, 2 * s)), "platform");
  std::vector<ElementHandle<Guide>> holders;
  for (double const x : {0.0, D}) {
    auto const longer =
        model.add(planar::Rigid(8, 8 * 1.44 / 12, Placement::planar(x + c, s)), x > 0 ? "long 2" : "long 1");
    auto const shorter = model.add(planar::Rigid(4, 4 * 0.36 / 12, Placement::planar(x + 0.5 * c, 0.5 * s)),
                                   x > 0 ? "short 2" : "short 1");
    model.connect(Pin{}, model.ground().at({x, 0, 0}), shorter.at(Vec2(-0.5 * c, -0.5 * s)));
    model.connect(Pin{}, shorter.at(Vec2(0.5 * c, 0.5 * s)), longer.at(Vec2(0, 0)));
    auto const foot = longer.at(Vec2(c, -s)), head = longer.at(Vec2(-c, s));
    model.connect(rail, model.ground().at({x + 2 * c, 0, 0}), foot);
    holders.push_back(model.connect(hold, model.ground().at({x + 2 * c, 0, 0}), foot));
    if (x > 0)
      model.connect(rail, platform.at(Vec2(D - 0.5, 0)), head);
    else
      model.connect(Pin{}, platform.at(Vec2(-0.5, 0)), head);
  }
  State x = model.reference_state();
  equilibrium(model, x);
  answer("force on the left foot [N]", 1190.861215, reaction(model, x, holders[0]).f.norm(), 1e-5);
  answer("force on the right foot [N]", 630.455938, reaction(model, x, holders[1]).f.norm(), 1e-5);
  answer("height of the platform [m]", 0.68829172, position(model, x, platform.at(Vec2(0, 0)))[1], 1e-8);
  return wrong_answers();
}
