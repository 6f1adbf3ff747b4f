// title: Spin of a ball at its first bounce
// thread: https://github.com/mbsim-env/mbsim/issues/49
// words: bouncing ball, oblique impact, friction in an impact, coefficient of restitution, rolling
// wanted: A ball without spin bounces on a rough floor. It began to rotate only after its last bounce.
// inputs: Ball of 0.5 kg and 0.05 m, 2 m/s down and 3 m/s along, e = 0.8, μ = 0.1 or 0.4, no gravity. Contact of
//     1e6 N/m, regularised friction with a slip speed of 0.01 m/s.
// right: The normal impulse is m (1 + e) v_n = 1.8 N s. With μ = 0.1 the ball slides during the whole impact, so
//     its speed falls by μ (1 + e) v_n and its spin is 5 μ (1 + e) v_n/(2 r). With μ = 0.4 it grips and leaves
//     rolling, with 5/7 of its speed. Both keep the angular momentum m r v about the contact point.
#include <polybody/polybody.hpp>

#include "answer.hpp"
using namespace polybody;

int main() {
  using Floor = Contact<SphereOnPlane>;
  double const m = 0.5, r = 0.05, e = 0.8, v = 3.0, down = 2.0;
  auto const bounced = [&](double mu) {
    Model<Bodies<Rigid<>>, Joints<>, Forces<Floor>> model;
    auto const ball =
        model.add(Rigid<>(m, 0.4 * m * r * r * Mat3::Identity(), Placement::at({0, 0, r + 1e-4})), "ball");
    model.apply(Floor{.geometry = {.radius = r},
                      .normal = SpringDamperContact::with_restitution(1e6, m, e),
                      .friction = {.coefficient = mu, .slip_speed = 0.01}},
                ball.centre(), model.ground().at({0, 0, 0}), "floor");
    State x = model.reference_state();
    model.set_velocity(x, ball, {v, 0, -down}, {0, 0, 0});
    simulate(model, x, DormandPrince<>{.relative_tolerance = 1e-9, .absolute_tolerance = 1e-11},
             {.end_time = 0.01, .step = 1e-6})
        .run();
    return frame(model, x, ball.centre());
  };
  Frame<double> const slides = bounced(0.1), grips = bounced(0.4);
  double const impulse = 0.1 * (1.0 + e) * down;
  answer("normal speed after the impact [m/s]", e * down, slides.v[2], 1e-5);
  answer("speed along the floor, μ = 0.1 [m/s]", v - impulse, slides.v[0], 1e-4);
  answer("spin, μ = 0.1 [rad/s]", 2.5 * impulse / r, slides.w[1], 2e-3);
  answer("speed along the floor, μ = 0.4 [m/s]", 5.0 / 7.0 * v, grips.v[0], 1e-6);
  answer("spin, μ = 0.4 [rad/s]", 5.0 / 7.0 * v / r, grips.w[1], 1e-5);
  answer("m r v + J ω, μ = 0.4 [kg m²/s]", m * r * v, m * r * grips.v[0] + 0.4 * m * r * r * grips.w[1], 1e-9);
  return wrong_answers();
}
