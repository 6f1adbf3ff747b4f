// Scott–Russell lift: the foot of the long bar moves along x, and its head moves along y.
#include "mechanism.hpp"
using namespace polybody;

int main() {
  using Pin = Joint<planar::Revolute, Constraint>;
  using Rail = Joint<PointInPlane, Constraint>;
  double const a = 0.6, angle = 35.0 * std::acos(-1.0) / 180.0, c = std::cos(angle), s = std::sin(angle);
  Model<Bodies<planar::Rigid>, Joints<Pin, Rail>, Forces<PointForce<>>> model{Gravity{0, -9.81, 0}};
  auto const ground = model.ground();
  auto const longer = model.add(planar::Rigid(8.0, 8.0 * 1.44 / 12.0, Placement::planar(a * c, a * s, -angle)), "long bar");
  auto const shorter = model.add(planar::Rigid(4.0, 4.0 * 0.36 / 12.0, Placement::planar(0.5 * a * c, 0.5 * a * s, angle)), "short bar");
  model.connect(Pin{}, ground.at({0, 0, 0}), shorter.at(Vec2(-0.5 * a, 0)), "ground pin");
  model.connect(Pin{}, shorter.at(Vec2(0.5 * a, 0)), longer.centre(), "middle pin");
  model.connect(Rail{{.normal = {0, 1, 0}}}, ground.at({0, 0, 0}), longer.at(Vec2(a, 0)), "rail of the foot");
  auto const hold = model.connect(Rail{{.normal = {1, 0, 0}}}, ground.at({2.0 * a * c, 0, 0}), longer.at(Vec2(a, 0)), "hold");
  model.apply(PointForce<>{.force = {0, -120.0 * 9.81, 0}}, longer.at(Vec2(-a, 0)), "load");

  State x = model.reference_state();
  make_consistent(model, x);
  mechanism::Picture picture("Scott-Russell lift", 0, 1);
  for (double const part : {0.6, 0.8, 1.0, 1.2, 1.4}) {
    double const cosine = std::cos(part * angle), sine = std::sin(part * angle);
    picture.line({Vec3(2 * a * cosine, 0, 0), Vec3(0, 2 * a * sine, 0)}, 0);
    picture.line({Vec3(0, 0, 0), Vec3(a * cosine, a * sine, 0)}, 1);
  }
  picture.write("scott_russell");
  // Virtual work: (m g + m_l g/2 + m_s g/4) cot ϑ.
  double const known = (120.0 + 4.0 + 1.0) * 9.81 * c / s;
  return mechanism::compare("force that holds the foot [N]", std::abs(reaction(model, x, hold).f[0]), known, 1e-6);
}
