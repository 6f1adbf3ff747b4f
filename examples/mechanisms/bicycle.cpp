// Bicycle without a rider's hands: after a push at 5 m/s it weaves back to the upright position.
#include <Eigen/Eigenvalues>

#include "mechanism.hpp"
using namespace polybody;

int main() {
  using Pin = Joint<Revolute, Constraint>;
  using Roll = Joint<RollingDisc, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Pin, Roll>> model{Gravity{0, 0, -9.81}};
  // Benchmark bicycle of Meijaard, Papadopoulos, Ruina & Schwab 2007; here z is up, and y to the left.
  double const base = 1.02, rear = 0.3, front = 0.35, tilt = 0.1 * std::acos(-1.0), speed = 5.0;
  auto const tensor = [](double xx, double yy, double zz, double xz) {
    Mat3 j = Mat3::Zero();
    j(0, 0) = xx, j(1, 1) = yy, j(2, 2) = zz, j(0, 2) = j(2, 0) = xz;
    return j;
  };
  auto const behind =
      model.add(Rigid<>(2.0, tensor(0.0603, 0.12, 0.0603, 0), Placement::at({0, 0, rear})), "rear wheel");
  auto const frame = model.add(Rigid<>(85.0, tensor(9.2, 11.0, 2.8, -2.4), Placement::at({0.3, 0, 0.9})), "frame");
  auto const fork =
      model.add(Rigid<>(4.0, tensor(0.05892, 0.06, 0.00708, 0.00756), Placement::at({0.9, 0, 0.7})), "fork");
  auto const ahead =
      model.add(Rigid<>(3.0, tensor(0.1405, 0.28, 0.1405, 0), Placement::at({base, 0, front})), "front wheel");
  Vec3 const steer(-std::sin(tilt), 0, std::cos(tilt)), head(base + 0.08, 0, 0);  // a trail of 0.08 m
  auto const ground = model.ground().at({0, 0, 0});
  model.connect(Pin{{.axis = {0, 1, 0}}}, frame.at(Vec3(-0.3, 0, rear - 0.9)), behind.centre(), "rear axle");
  model.connect(Pin{{.axis = {0, 1, 0}}}, fork.at(Vec3(base - 0.9, 0, front - 0.7)), ahead.centre(), "front axle");
  model.connect(Pin{{.axis = steer}}, frame.at(Vec3(head - Vec3(0.3, 0, 0.9))), fork.at(Vec3(head - Vec3(0.9, 0, 0.7))),
                "steering");
  model.connect(Roll{{.radius = rear, .axis = {0, 1, 0}, .normal = {0, 0, 1}}}, ground, behind.centre(),
                "rear contact");
  model.connect(Roll{{.radius = front, .axis = {0, 1, 0}, .normal = {0, 0, 1}}}, ground, ahead.centre(),
                "front contact");

  State x = model.reference_state();
  Vec3 const lean(0.02, 0, 0);  // a push: angular velocity about the line of the wheels
  for (auto const& part : {frame, fork}) model.set_velocity(x, part, {speed, 0, 0}, lean);
  model.set_velocity(x, behind, Vec3(speed, 0, 0) - Vec3(0, speed / rear, 0).cross(Vec3(0, 0, rear)),
                     lean + Vec3(0, speed / rear, 0));
  model.set_velocity(x, ahead, Vec3(speed, 0, 0) - Vec3(0, speed / front, 0).cross(Vec3(base, 0, front)),
                     lean + Vec3(0, speed / front, 0));
  make_consistent(model, x);
  Figure figure{.title = "Lean of the bicycle at 5 m/s", .x_label = "t [s]", .y_label = "lean [rad]", .legend = false};
  figure.curves.push_back({});
  std::vector<double>&times = figure.curves[0].x, &leans = figure.curves[0].y;
  for (auto const& now : simulate(model, x, GeneralisedAlpha{.stabilised = true}, {.end_time = 6.0, .step = 2e-3}))
    times.push_back(now.t), leans.push_back(std::asin(now.frame(frame.centre()).A(2, 1)));
  std::filesystem::create_directories("out/mechanisms");
  write_figure(figure, "out/mechanisms/bicycle");
  // After a second two modes remain, weave and capsize: samples every 0.1 s obey a linear recursion of order 3.
  MatX rows(47, 4);
  for (Index i = 0; i < rows.size(); ++i) rows(i / 4, i % 4) = leans[std::size_t(500 + 50 * (i / 4 + i % 4))];
  Mat3 recursion;
  recursion << 0, 1, 0, 0, 0, 1, rows.leftCols(3).colPivHouseholderQr().solve(rows.col(3)).transpose();
  double const weave = recursion.eigenvalues().array().arg().maxCoeff() / 0.1;
  return mechanism::compare("angular frequency of weave [rad/s]", weave, 4.46486771, 3e-4);
}
