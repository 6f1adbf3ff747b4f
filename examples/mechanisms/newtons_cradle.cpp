// Newton's cradle: the first of five steel balls stops, and the last one leaves with its speed.
#include "mechanism.hpp"
using namespace polybody;

int main() {
  using Touch = Contact<SphereOnSphere, HertzContact>;
  using Thread = Joint<planar::Revolute, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Thread>, Forces<Touch>> model{Gravity{0, -9.81, 0}};
  double const radius = 0.02, gap = 1e-4, length = 0.2;
  std::vector<BodyHandle<planar::Rigid>> balls;
  for (int i = 0; i < 5; ++i) {
    double const at = i * (2.0 * radius + gap);
    balls.push_back(model.add(planar::Rigid(0.26, 4e-5, Placement::planar(at, 0)), "ball " + std::to_string(i)));
    model.connect(Thread{}, model.ground().at({at, length, 0}), balls[std::size_t(i)].at(Vec2(0, length)),
                  "thread " + std::to_string(i));
    Touch const touch{{.radius_a = radius, .radius_b = radius}, {.modulus = 1.1e11, .radius = 0.5 * radius}};
    if (i > 0)
      model.apply(touch, balls[std::size_t(i - 1)].centre(), balls[std::size_t(i)].centre(),
                  "contact " + std::to_string(i));
  }
  State x = model.reference_state();
  double const speed = 0.5;  // at the lowest point
  model.set_velocity(x, balls[0], {speed, 0, 0}, {0, 0, speed / length});
  Figure figure{.title = "Speeds of the five balls", .x_label = "t [s]", .y_label = "speed [m/s]"};
  figure.y_range = {-0.05, 0.55};
  for (int i = 0; i < 5; ++i) figure.curves.push_back({.label = "ball " + std::to_string(i + 1), .width = 2.5});
  double most = 0.0;
  int step = 0;
  for (auto const& now :
       simulate(model, x, DormandPrince<Projection>{}, {.end_time = 0.006, .step = 1e-6, .max_step = 1e-5})) {
    most = std::max(most, now.position(balls[4].centre())[0] > 0.162 ? now.frame(balls[4].centre()).v.norm() : 0.0);
    if (step++ % 4 != 0 || now.t > 2e-3) continue;
    for (std::size_t i = 0; i < 5; ++i)
      figure.curves[i].x.push_back(now.t), figure.curves[i].y.push_back(now.frame(balls[i].centre()).v[0]);
  }
  std::filesystem::create_directories("out/mechanisms");
  write_figure(figure, "out/mechanisms/newtons_cradle");
  // The gaps separate the impacts, and each impact of two equal balls exchanges their speeds.
  return mechanism::compare("speed of the last ball [m/s]", most, speed, 2e-3);
}
