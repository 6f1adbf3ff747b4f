// Car with four wheels: wheel loads, straight run, steady circle, and the same car with a tyre force written by hand.

#include <gtest/gtest.h>

#include <polybody/parts.hpp>
#include <polybody/polybody.hpp>

#include "support/held.hpp"

using namespace polybody;

namespace car_test {

constexpr double g = 9.81, radius = 0.32, stiffness = 2e5;

// --- code with parts
LinearTyre const grip{
    .longitudinal_stiffness = 6e4, .cornering_stiffness = 4e4, .longitudinal_friction = 1.0, .lateral_friction = 0.9};
TyreRelaxation const relaxation{.longitudinal = 0.2, .lateral = 0.3, .damping_time = 5e-3};

using Part = Wheel<LinearTyre>;
Part part() {
  return {.radius = radius,
          .axle = Vec3::UnitY(),
          .normal = {.stiffness = stiffness, .damping = 500.0, .onset = 1e-3},
          .tyre = grip,
          .relaxation = relaxation};
}
// --- end
/// Tyre force of this wheel on the plane z = 0, written by hand.
// --- code by hand
auto by_hand() {
  auto const tyre = [](auto const& frames, auto const& u) {
    using T = typename std::decay_t<decltype(frames[0].r)>::Scalar;
    using V = Vec<T, 3>;
    using std::sqrt;
    struct {
      V n, x, y, arm;
      T load, vx, sx, sy, rate_x, rate_y;
    } p;
    V const axle = frames[0].A.col(1);
    p.n = V(T(0.0), T(0.0), T(1.0));
    V const m = p.n - axle * axle.dot(p.n);
    T const steep = sqrt(m.dot(m));
    p.x = axle.cross(p.n) / steep;
    p.y = p.n.cross(p.x);
    T const depth = steep * radius - frames[0].r[2];
    p.arm = m * (T(-radius) / steep) + p.n * depth;
    V const v = frames[0].v + frames[0].w.cross(p.arm);
    T const damping = value_of(depth) < 1e-3 ? T(depth * 500e3) : T(500.0), load = depth * stiffness - damping * v[2];
    p.load = value_of(depth) > 0.0 && value_of(load) > 0.0 ? load : T(0.0);
    p.vx = frames[0].v.dot(p.x);
    p.sx = v.dot(p.x);
    p.sy = v.dot(p.y);
    T const slip = p.sx * p.sx + p.sy * p.sy, speed = p.vx * p.vx + slip;
    T const part = (speed - 1.0) / 3.0;
    T const fast = value_of(part) < 0.0 ? T(0.0) : value_of(part) < 1.0 ? T(part * part * (part * -2.0 + 3.0)) : T(1.0);
    T const bound = fast * 1.8 + 0.2;
    T const straight = value_of(p.vx) < 0.0 ? T(-p.vx) : p.vx;
    T const difference = p.vx - p.sx, rolling = value_of(difference) < 0.0 ? T(-difference) : difference;
    T transport = rolling + fast * (straight - rolling);
    T const a = u[0] / 0.2, b = u[1] / 0.3, s2 = a * a + b * b;
    if (value_of(s2) > 0.81 * value_of(bound) * value_of(bound) && value_of(slip) > 0.0) {
      T const over = sqrt(s2) / bound * 10.0 - 9.0;
      transport += (value_of(over) < 1.0 ? T(over * over * (over * -2.0 + 3.0)) : T(1.0)) * sqrt(slip) / bound;
    }
    p.rate_x = -p.sx - transport * a;
    p.rate_y = -p.sy - transport * b;
    return p;
  };
  auto const wrenches = [tyre](auto const& frames, auto const& u, double) {
    using T = typename std::decay_t<decltype(frames[0].r)>::Scalar;
    using std::sqrt;
    auto const p = tyre(frames, u);
    T x = (u[0] + p.rate_x * 5e-3) * (6e4 / 0.2), y = (u[1] + p.rate_y * 5e-3) * (4e4 / 0.3);
    if (std::hypot(value_of(x), value_of(y) / 0.9) > value_of(p.load)) {
      T const share = p.load / sqrt(x * x + y * y * (1.0 / 0.81));
      x = x * share;
      y = y * share;
    }
    std::array<Wrench<T>, 2> w;
    w[0].f = p.n * p.load + p.x * x + p.y * y;
    w[0].m = p.arm.cross(w[0].f);
    w[1].f = -w[0].f;
    w[1].m = -Vec<T, 3>(frames[0].r + p.arm - frames[1].r).cross(w[0].f);
    return w;
  };
  auto const rates = [tyre](auto const& frames, auto const& u, double) {
    auto const p = tyre(frames, u);
    return std::array{p.rate_x, p.rate_y};
  };
  return user_force<2, 2>(wrenches, rates);
}
// --- end
using ByHand = decltype(by_hand());

using Strut = Joint<Cylindrical, Constraint>;
using Steer = Joint<PrescribedAngle<SmoothRamp>, Constraint>;
using Axle = Joint<Revolute, Constraint>;

/// Chassis of 1200 kg on four struts. A hub slides and steers on each strut, and carries a wheel.
// --- code of both
template <class Tyre>
struct Car {
  double const a = 1.2, b = 1.5, half = 0.75, chassis_mass = 1200.0, hub_mass = 20.0, wheel_mass = 15.0;
  Model<Bodies<Rigid<>>, Joints<Strut, Steer, Axle>, Forces<SpringDamper, Tyre>> model{Gravity{0, 0, -g}};
  BodyHandle<Rigid<>> chassis;
  std::vector<ElementHandle<Tyre>> tyres;
  State x;

  Car(Tyre const& tyre, double speed, double steer) {
    auto const spin = [&](double low) { return Vec3(0, speed / low, 0); };
    Vec3 const top(0, 0, 0.55);
    chassis = model.add(Rigid<>(chassis_mass, Vec3(400, 1800, 2000).asDiagonal(), Placement::at(top)), "chassis");
    std::vector<std::pair<BodyHandle<Rigid<>>, double>> wheels;
    std::vector<BodyHandle<Rigid<>>> hubs;
    for (int i = 0; i < 4; ++i) {
      bool const front = i < 2;
      std::string const name = std::string(front ? "front" : "rear") + (i % 2 ? " right" : " left");
      double const carried = 0.5 * chassis_mass * g * (front ? b : a) / (a + b);
      double const low = radius - (carried + (hub_mass + wheel_mass) * g) / stiffness;
      Vec3 const centre(front ? a : -b, i % 2 ? -half : half, low), mount = centre + Vec3(0, 0, 0.5) - top;
      auto const hub = model.add(Rigid<>(hub_mass, 0.5 * Mat3::Identity(), Placement::at(centre)), name + " hub");
      auto const wheel = model.add(Rigid<>(wheel_mass, Vec3(0.5, 1.0, 0.5).asDiagonal(), Placement::at(centre)), name);
      model.connect(Strut{{.axis = Vec3::UnitZ()}, {}}, chassis.at(centre - top), hub.at({0, 0, 0}), name + " strut");
      model.connect(Steer{{.law = {.target = front ? steer : 0.0, .duration = 1.0}, .axis = Vec3::UnitZ()}, {}},
                    chassis.at(centre - top), hub.at({0, 0, 0}), name + " steering");
      model.connect(Axle{{.axis = Vec3::UnitY()}, {}}, hub.at({0, 0, 0}), wheel.at({0, 0, 0}), name + " axle");
      model.apply(SpringDamper{.stiffness = 2.5e4, .damping = 2e3, .free_length = 0.5 + carried / 2.5e4},
                  hub.at({0, 0, 0}), chassis.at(mount), name + " spring");
      tyres.push_back(model.apply(tyre, wheel.at({0, 0, 0}), model.ground().at({0, 0, 0}), name + " tyre"));
      wheels.push_back({wheel, low});
      hubs.push_back(hub);
    }
    x = model.reference_state();
    for (auto const& body : hubs) model.set_velocity(x, body, Vec3(speed, 0, 0), Vec3::Zero());
    model.set_velocity(x, chassis, Vec3(speed, 0, 0), Vec3::Zero());
    for (auto const& [wheel, low] : wheels) {
      Vec3 const r = frame(model, x, wheel.at({0, 0, 0})).r;
      model.set_velocity(x, wheel, Vec3(speed, 0, 0) - spin(low).cross(r), spin(low));
    }
    make_consistent(model, x);
  }
  Frame<double> of(State const& s) const { return frame(model, s, chassis.at({0, 0, 0})); }
};
// --- end

char const* const setting = "Rigid, Wheel<LinearTyre>, h = 2e-3 s";

// Loads of the front and rear wheels: m g b/(2 L) and m g a/(2 L) of the chassis, and the weight of hub and wheel.
TEST(Car, WheelLoadsAndStraightRun) {
  Car<Part> car(part(), 20.0, 0.0);
  EnergyAudit audit(car.model);
  for (State const& now : simulate(car.model, car.x, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = 3.0, .step = 2e-3}))
    audit.record(now);
  for (std::size_t i = 0; i < 4; ++i) {
    double const share = (i < 2 ? car.b : car.a) / (car.a + car.b);
    held({"Car", "load of a wheel [N]", By::closed_form, "½ m g b/L, ½ m g a/L, and hub and wheel", setting},
         applied_wrenches(car.model, car.x, car.tyres[i])[0].f[2], 600.0 * g * share + 35.0 * g, 1e-4,
         {equals("wheel", double(i))});
  }
  Frame<double> const f = car.of(car.x);
  EXPECT_LT((f.r - Vec3(60.0, 0.0, 0.55)).norm(), 1e-7);
  EXPECT_LT((f.A - Mat3::Identity()).norm(), 1e-8);
  EXPECT_NEAR(f.v[0], 20.0, 1e-8);
}

// r = V δ/(L + K V²) with the cornering stiffness of both wheels of an axle. Roll and load transfer change the radii of
// the wheels only, because the cornering stiffness does not depend on the load.
TEST(Car, SteadyCircle) {
  double const steer = 0.004, c = 2.0 * 4e4;
  Car<Part> car(part(), 20.0, steer);
  EnergyAudit audit(car.model);
  for (State const& now : simulate(car.model, car.x, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = 8.0, .step = 2e-3}))
    audit.record(now);
  double const wheels = 2.0 * (car.hub_mass + car.wheel_mass), m = car.chassis_mass + 2.0 * wheels;
  double const length = car.a + car.b, front = (car.chassis_mass * car.b / length + wheels) / m;  // share of the weight
  double const understeer = m * (front / c - (1.0 - front) / c);  // K = m (b C_r − a C_f)/(L C_f C_r)
  Frame<double> const f = car.of(car.x);
  double const v = f.v.dot(f.A.col(0)), expected = v * steer / (length + understeer * v * v);
  held({"Car", "yaw rate in a steady circle [rad/s]", By::closed_form, "V δ/(L + K V²)", setting}, f.w[2], expected,
       5e-3 * expected);
  EXPECT_LT(audit.relative(), 1e-6);
}

// Hard steering with sliding tyres: the car with the tyre written by hand moves in the same way.
TEST(Car, AgreesWithATyreByHand) {
  double slides = 0.0;  // largest ratio of lateral force and load of a front wheel
  auto const run = [&](auto car) {
    for (auto const& now :
         simulate(car.model, car.x, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = 1.5, .step = 2e-3})) {
      Vec3 const f = now.applied_wrenches(car.tyres[0])[0].f;
      slides = std::max(slides, std::hypot(f[0], f[1]) / f[2]);
    }
    return car.of(car.x);
  };
  Frame<double> const one = run(Car<Part>(part(), 25.0, 0.12));
  EXPECT_NEAR(slides, 0.9, 1e-3);
  Frame<double> const two = run(Car<ByHand>(by_hand(), 25.0, 0.12));
  EXPECT_LT((one.r - two.r).norm(), 1e-7);
  EXPECT_LT((one.v - two.v).norm(), 1e-7);
}

}  // namespace car_test
