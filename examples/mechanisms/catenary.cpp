// Cable between two points at equal height: its sag and pull are those of the catenary.
#include "mechanism.hpp"
using namespace polybody;

int main() {
  using Pin = Joint<planar::Revolute, Constraint>;
  using Cable = planar::AncfCable<>;
  double const span = 1.0, length = 1.2;
  Bar const bar{.length = length, .constants = BarConstants{.EA = 1e5, .EI = 1e-5, .mass_per_length = 0.1}};
  Model<Bodies<Cable>, Joints<Pin>> model{Gravity{0, -9.81, 0}};
  auto const cable = model.add(Cable::from(bar, 24, catenary({span, 0, 0}, length, {0, -1, 0})), "cable");
  auto const left = model.connect(Pin{}, model.ground().at({0, 0, 0}), cable.at(0.0), "left");
  model.connect(Pin{}, model.ground().at({span, 0, 0}), cable.at(length), "right");
  State x = model.reference_state();
  equilibrium(model, x);
  mechanism::Picture picture("Catenary", 0, 1);
  std::vector<Vec3> shape;
  for (int i = 0; i <= 48; ++i) shape.push_back(position(model, x, cable.at(length * i / 48)));
  picture.line(shape, 0);
  picture.write("catenary");
  // 2 a sinh(span/2a) = length, pull H = w a.
  double low = 0.1, high = 10.0;
  for (int i = 0; i < 100; ++i) {
    double const a = 0.5 * (low + high);
    (2.0 * a * std::sinh(0.5 * span / a) > length ? low : high) = a;
  }
  return mechanism::compare("horizontal pull [N]", std::abs(reaction(model, x, left).f[0]), 0.1 * 9.81 * low, 2e-3);
}
