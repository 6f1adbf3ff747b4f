// title: Heights of a bouncing ball
// thread: https://github.com/jrouwe/JoltPhysics/issues/1286
// words: coefficient of restitution, bounce height, energy gain, impact event, Newton's law of impact
// wanted: A ball with a restitution of 1 bounces. Every bounce was higher than the one before.
// inputs: The ball falls from 1 m on a stop with e = 1 or 0.9; steps of 10 ms.
// right: With t₀ = √(2 h/g) the impacts with e = 1 are at (2 k − 1) t₀. Each impact multiplies the height by e².
#include <polybody/parts.hpp>
#include <polybody/polybody.hpp>

#include "answer.hpp"
using namespace polybody;

int main() {
  using Slide = Joint<planar::Prismatic, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Slide>> model{Gravity{0, -9.81, 0}};
  auto const ball = model.add(planar::Rigid(1.0, 0.01, Placement::planar(0, 1.0)), "ball");
  auto const slide = model.connect(Slide{{.axis = {0, 1, 0}}}, model.ground().at({0, 0, 0}), ball.centre(), "slide");
  double const fall = std::sqrt(2.0 / 9.81);
  State x;
  auto const run = [&](double e, double t) {
    x = model.reference_state();
    auto bounces = simulate(
        model, x, GeneralisedAlpha{},
        {.end_time = t, .step = 1e-2, .events = {impact_at_limit(model, slide, {.lower = 0.0, .restitution = e})}});
    bounces.run();
    return bounces.report().events;
  };
  auto const impacts = run(1.0, 20.0 * fall);
  answer("number of impacts, e = 1 [1]", 10.0, double(impacts.size()), 0.0);
  answer("time of the tenth impact, e = 1 [s]", 19.0 * fall, impacts.back().time, 1e-8);
  answer("height after the tenth impact, e = 1 [m]", 1.0, x.q[1], 1e-8);
  double const e = 0.9;
  double impact = fall, rise = fall;  // time of an impact, and of the rise before it
  for (int k = 0; k < 5; ++k) {
    rise *= e;
    impact += 2.0 * rise;
  }
  run(e, impact - rise);
  answer("height after the fifth impact, e = 0.9 [m]", std::pow(e, 10), x.q[1], 1e-8);
  return wrong_answers();
}
