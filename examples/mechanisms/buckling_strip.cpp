// Clamped strip under an axial force: the buckling load is that of Euler's column.
#include <polybody/vibration.hpp>

#include "mechanism.hpp"
using namespace polybody;

int main() {
  using Clamp = Joint<planar::Weld, Constraint>;
  using Strip = planar::AncfCable<>;
  Bar const bar{.length = 0.5,
                .section = Rectangle{.height = 1e-3, .width = 0.02},
                .material = Material{.density = 7800, .young = 2e11}};
  Model<Bodies<Strip>, Joints<Clamp>, Forces<PointForce<>>> model;
  auto const strip = model.add(Strip::from(bar, 12), "strip");
  model.connect(Clamp{}, model.ground().at({0, 0, 0}), strip.at(0.0), "clamp");
  model.apply(PointForce<>{.force = {-1, 0, 0}}, strip.at(0.5), "force");  // 1 N
  State x = model.reference_state();
  BucklingModes const buckling = buckling_modes(model, x, {.count = 1});
  mechanism::Picture picture("Clamped strip and its buckling mode, enlarged", 0, 1);
  State bent = x;
  bent.q.head(buckling.shape.rows()) += 0.3 / buckling.shape.col(0).cwiseAbs().maxCoeff() * buckling.shape.col(0);
  std::vector<Vec3> shape;
  for (int i = 0; i <= 40; ++i) shape.push_back(position(model, bent, strip.at(0.5 * i / 40)));
  picture.line({Vec3(0, 0, 0), Vec3(0.5, 0, 0)}, 1);
  picture.line(shape, 0);
  picture.write("buckling_strip");
  double const known = std::pow(std::acos(-1.0) / (2.0 * 0.5), 2) * constants(bar).EI;  // π² EI/(2 l)²
  return mechanism::compare("buckling load [N]", buckling.load_factor[0], known, 2e-4 * known);
}
