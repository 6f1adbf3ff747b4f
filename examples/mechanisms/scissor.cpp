// Deployable scissor of six units: its height follows from its width.
#include "mechanism.hpp"
using namespace polybody;

int main() {
  using Pin = Joint<planar::Revolute, Constraint>;
  using Rail = Joint<PointInPlane, Constraint>;
  using Drive = Joint<PrescribedTranslation<SmoothRamp>, Constraint>;
  double const l = 0.5, angle = 0.3;  // length of a bar, its angle at the start
  Model<Bodies<planar::Rigid>, Joints<Pin, Rail, Drive>> model{Gravity{0, -9.81, 0}};
  auto const ground = model.ground();
  std::vector<BodyHandle<planar::Rigid>> up, down;  // bars that rise to the right, to the left
  double const w = 0.5 * l * std::cos(angle), h = 0.5 * l * std::sin(angle);
  for (int i = 0; i < 6; ++i) {
    up.push_back(model.add(planar::Rigid(1.0, l * l / 12.0, Placement::planar(w, (2 * i + 1) * h, angle))));
    down.push_back(model.add(planar::Rigid(1.0, l * l / 12.0, Placement::planar(w, (2 * i + 1) * h, -angle))));
    model.connect(Pin{}, up.back().centre(), down.back().centre());
    if (i == 0) continue;
    model.connect(Pin{}, down[std::size_t(i - 1)].at(Vec2(-0.5 * l, 0)), up.back().at(Vec2(-0.5 * l, 0)));
    model.connect(Pin{}, up[std::size_t(i - 1)].at(Vec2(0.5 * l, 0)), down.back().at(Vec2(0.5 * l, 0)));
  }
  model.connect(Pin{}, ground.at({0, 0, 0}), up[0].at(Vec2(-0.5 * l, 0)), "foot");
  model.connect(Rail{{.normal = {0, 1, 0}}}, ground.at({0, 0, 0}), down[0].at(Vec2(0.5 * l, 0)), "rail");
  Drive const drive{{.law = {.target = -0.2, .duration = 1.0}, .axis = {1, 0, 0}}};
  model.connect(drive, ground.at({2.0 * w, 0, 0}), down[0].at(Vec2(0.5 * l, 0)), "drive");

  State x = model.reference_state();
  mechanism::Picture picture("Deployable scissor", 0, 1);
  int step = 0;
  for (auto const& now : simulate(model, x, GeneralisedAlpha{}, {.end_time = 1.2, .step = 2e-3})) {
    if (step++ % 300 != 0) continue;
    for (auto const* bars : {&up, &down})
      for (auto const& bar : *bars)
        picture.line({now.position(bar.at(Vec2(-0.5 * l, 0))), now.position(bar.at(Vec2(0.5 * l, 0)))}, step / 300);
  }
  picture.write("scissor");
  double const width = 2.0 * w - 0.2, known = 6.0 * std::sqrt(l * l - width * width);
  return mechanism::compare("height [m]", position(model, x, up[5].at(Vec2(0.5 * l, 0)))[1], known, 1e-6);
}
