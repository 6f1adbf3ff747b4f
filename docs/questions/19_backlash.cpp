// title: Backlash that never pulls
// thread: https://github.com/modelica/ModelicaStandardLibrary/issues/2247
// words: ElastoBacklash, ElastoGap, gear play, dead zone, contact damping, pulling force, restitution
// wanted: A rotor moves within the play of a spring with a damper. As the flanks separate, the damper can pull;
//     the laws of two library parts differ there.
// inputs: J = 0.01 kg m², play 0.2 rad, 100 N m/rad and 0.2 N m s/rad at the flanks, from the middle at v = 2
//     rad/s.
// right: In contact J ẍ + c ẋ + k x = 0, until the torque k x + c ẋ is zero after t = 2 arccos ζ/ω_d. With a =
//     arccos ζ the speed is then e v, e = exp(−2 ζ a/√(1 − ζ²)) = 0.7440794, at the penetration c e v/k. The
//     largest penetration is v/ω exp(−ζ a/√(1 − ζ²)).
#include <polybody/parts.hpp>
#include <polybody/polybody.hpp>

#include "answer.hpp"
using namespace polybody;

int main() {
  using Play = OnAngle<Backlash>;
  Model<Bodies<planar::Rigid>, Joints<>, Forces<Play>> model;
  double const J = 0.01, play = 0.2, k = 100.0, c = 0.2, v = 2.0;
  auto const rotor = model.add(planar::Rigid(1.0, J), "rotor");
  auto const flanks = model.apply(Play{{.play = play, .stiffness = k, .damping = c}}, model.ground().at({0, 0, 0}),
                                  rotor.centre(), "play");
  double const zeta = 0.5 * c / std::sqrt(k * J), omega = std::sqrt(k / J), root = std::sqrt(1 - zeta * zeta),
               a = std::acos(zeta), e = std::exp(-2 * zeta * a / root);
  State x = model.reference_state();
  model.set_velocity(x, rotor, {0, 0, 0}, {0, 0, v});
  double pull = 0.0;
  auto const run_to = [&](double t) {
    DormandPrince<> const method{.relative_tolerance = 1e-10, .absolute_tolerance = 1e-12};
    for (auto const& now : simulate(model, x, method, {.end_time = t, .step = 1e-5}))
      pull = std::max(pull, now.applied_wrenches(flanks)[1].m[2] * now.coordinates_of(rotor)[2]);
  };
  double const contact = 0.5 * play / v, leaving = contact + 2 * a / (omega * root);  // times
  run_to(contact + a / (omega * root));
  answer("largest penetration [rad]", v / omega * std::exp(-zeta * a / root), x.q[2] - 0.5 * play, 1e-8);
  run_to(0.1);
  answer("speed after the first contact [rad/s]", -e * v, x.v[2], 1e-7);
  answer("angle at 0.1 s [rad]", 0.5 * play + c * e * v / k - e * v * (0.1 - leaving), x.q[2], 1e-7);
  run_to(0.3);
  answer("speed after the second contact [rad/s]", e * e * v, x.v[2], 1e-7);
  answer("largest pull, torque times angle [N m rad]", 0.0, pull, 0.0);
  return wrong_answers();
}
