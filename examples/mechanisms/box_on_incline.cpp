// Box on an incline of 30°: it slides with the acceleration g (sin α − μ cos α).
#include <polybody/parts.hpp>

#include "mechanism.hpp"
using namespace polybody;

int main() {
  using Floor = Contact<BoxOnPlane, SpringDamperContact, BristleFriction>;
  Model<Bodies<Rigid<>>, Joints<>, Forces<Floor>> model{
      Gravity{4.905, 0, -9.81 * std::sqrt(0.75)}};  // axes of the incline
  double const mass = 10.0, stiffness = 1e5, friction = 0.3;
  double const depth = mass * 9.81 * std::sqrt(0.75) / (4.0 * stiffness);  // of four corners
  auto const box = model.add(Rigid<>(mass, 0.1 * Mat3::Identity(), Placement::at({0, 0, 0.1 - depth})), "box");
  Floor const floor{{.size = Vec3(0.4, 0.4, 0.2)},
                    {.stiffness = stiffness, .damping = 500.0},
                    {.coefficient = friction, .stiffness = 1e5, .damping = 300.0}};
  model.apply(floor, box.centre(), model.ground().at({0, 0, 0}), "floor");

  State x = model.reference_state();
  mechanism::Picture picture("Box on an incline, in the axes of the incline", 0, 2);
  int step = 0;
  for (auto const& now : simulate(model, x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 5e-4})) {
    if (step++ % 500 != 0) continue;
    std::vector<Vec3> outline;
    for (auto const& [u, w] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}})
      outline.push_back(now.position(box.at(Vec3(0.2 * u, 0, 0.1 * w))));
    picture.line(outline, step / 500, now.t, 3);
  }
  picture.write("box_on_incline");
  double const known = 0.5 * 9.81 * (0.5 - friction * std::sqrt(0.75));
  return mechanism::compare("distance after 1 s [m]", position(model, x, box.centre())[0], known, 0.01);
}
