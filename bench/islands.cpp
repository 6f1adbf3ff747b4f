// Balls (0.1 m, 1 kg) that nothing connects, on a plane with friction (0.8, slip speed 0.01 m/s), GeneralisedAlpha at
// 1 ms, 0.5 s: rolling, sliding, and landing with sliding from 0.02 to 0.32 m. The counter `per_ball` is the time per
// ball and step; its ratio to that of one ball is the cost that independent balls impose on each other.
#include <cmath>
#include <numbers>
#include <polybody/polybody.hpp>

#include "registered.hpp"

namespace {

using namespace polybody;
using OnPlane = Contact<SphereOnPlane>;

enum class BallMotion { rolling, sliding, landing };

struct Balls {
  Model<Bodies<Rigid<>>, Joints<>, Forces<OnPlane>> model{Gravity{0, 0, -9.81}};
  State start;

  Balls(BallMotion motion, int count) {
    double const radius = 0.1;
    for (int i = 0; i < count; ++i) {
      double const height = motion == BallMotion::landing ? 0.02 + 0.3 * std::fmod(0.618034 * i, 1.0) : -1e-4;
      auto const ball = model.add(
          Rigid<>(1.0, 0.004 * Mat3::Identity(), Placement::at({0.5 * (i % 40), 0.5 * (i / 40), radius + height})));
      model.apply(OnPlane{{radius}, {.stiffness = 1e5, .damping = 100.0}, {.coefficient = 0.8, .slip_speed = 0.01}},
                  ball.at(Vec3(0, 0, 0)), model.ground().at({0, 0, 0}));
    }
    start = model.reference_state();
    for (int i = 0; i < count; ++i) {
      double const v = 1.0 + std::fmod(0.618034 * i, 1.0),
                   direction = 2.0 * std::numbers::pi * std::fmod(0.414 * i, 1.0);
      double* const of_ball = start.v.data() + 6 * i;
      of_ball[0] = v * std::cos(direction);
      of_ball[1] = v * std::sin(direction);
      if (motion == BallMotion::rolling) {
        of_ball[3] = -of_ball[1] / radius;
        of_ball[4] = of_ball[0] / radius;
      }
    }
  }
};

}  // namespace

int main(int argc, char** argv) {
  for (auto const& [name, motion] :
       {std::pair("rolling", BallMotion::rolling), std::pair("sliding", BallMotion::sliding),
        std::pair("landing", BallMotion::landing)})
    for (int const count : {1, 200, 1000})
      registered::add("balls/" + std::string(name) + "/GeneralisedAlpha/balls:" + std::to_string(count),
                      [motion, count](benchmark::State& state) {
                        Balls const balls(motion, count);
                        State x;
                        registered::time_runs(state, 6 * count, [&] {
                          x = balls.start;
                          return simulate(balls.model, x, GeneralisedAlpha{}, {.end_time = 0.5, .step = 1e-3});
                        });
                        using benchmark::Counter;
                        state.counters["per_ball"] =
                            Counter(500.0 * count, Counter::kIsIterationInvariantRate | Counter::kInvert);
                      })
          ->Unit(benchmark::kMillisecond);
  return registered::run(argc, argv);
}
