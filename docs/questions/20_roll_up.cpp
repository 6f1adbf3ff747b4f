// title: Beam that a tip moment rolls up
// thread: https://github.com/OpenFAST/openfast/issues/316
// words: cantilever, large deflection, geometrically exact beam, roll-up test, BeamDyn, load steps
// wanted: A moment at its tip bends a cantilever of 10 m to a circle. The solver converged for λ = 0.4 and 0.8,
//     but not for 1.2 to 2.
// inputs: Length 10 m, EI = 8.33e4 N m², EA = 1e6 N, GA = 4e5 N, GJ = 6e4 N m²; moment λ π EI/L. Three elements
//     `Se3Beam`, ten load steps.
// right: The curvature M/EI is uniform, without stretch and shear: x = L sin ϑ/ϑ and z = L (1 − cos ϑ)/ϑ with ϑ =
//     λ π.
#include <polybody/polybody.hpp>
#include <polybody/se3_beam.hpp>

#include <numbers>

#include "answer.hpp"
using namespace polybody;

int main() {
  using Clamp = Joint<Weld, Constraint>;
  double const length = 10.0, EI = 8.33e4;
  Bar const bar{.length = length,
                .constants = BarConstants{
                    .EA = 1e6, .EI = EI, .mass_per_length = 1, .GA = 4e5, .GJ = 6e4, .rotary_inertia = 1e-3}};
  auto const tip = [&](double angle) {
    Model<Bodies<Se3Beam>, Joints<Clamp>, Forces<PointMoment<>>> model;
    auto const beam = model.add(Se3Beam::from(bar, 3), "beam");
    model.connect(Clamp{}, model.ground().at({0, 0, 0}), beam.at(0.0), "clamp");
    model.apply(PointMoment<>{.moment = {0, -angle * EI / length, 0}}, beam.at(length), "moment");
    State x = model.reference_state();
    equilibrium(model, x, {.load_steps = 10});
    return position(model, x, beam.at(length));
  };
  double const pi = std::numbers::pi;
  Vec3 const arc = tip(1.2 * pi), longer = tip(1.6 * pi), circle = tip(2.0 * pi);
  answer("x of the tip, λ = 1.2 [m]", length * std::sin(1.2 * pi) / (1.2 * pi), arc[0], 1e-9);
  answer("z of the tip, λ = 1.2 [m]", length * (1.0 - std::cos(1.2 * pi)) / (1.2 * pi), arc[2], 1e-9);
  answer("x of the tip, λ = 1.6 [m]", length * std::sin(1.6 * pi) / (1.6 * pi), longer[0], 1e-9);
  answer("z of the tip, λ = 1.6 [m]", length * (1.0 - std::cos(1.6 * pi)) / (1.6 * pi), longer[2], 1e-9);
  answer("gap of the circle, λ = 2 [m]", 0.0, circle.norm(), 1e-9);
  return wrong_answers();
}
