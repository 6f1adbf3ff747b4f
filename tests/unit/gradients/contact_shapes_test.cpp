// Derivatives of runs with a box that falls on a larger box and slides on it.
#include <gtest/gtest.h>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/shapes/box_contact.hpp>
#include <polybody/gradients/gradient.hpp>
#include <polybody/gradients/sensitivities.hpp>
#include <polybody/integrators/generalised_alpha.hpp>

#include "support/differences_of_runs.hpp"

using namespace polybody;

namespace contact_shapes_gradients_test {

std::vector<Parameter> const parameters{
    {"mass of the box [kg]", 1.0},  {"stiffness [N/m^1.5]", 2e6},      {"friction [1]", 0.3},
    {"length of the box [m]", 0.1}, {"rounding of the box [m]", 0.01}, {"initial height [m]", 0.165}};

auto const fall = [](std::span<double const> p) {
  using Law = Contact<BoxOnBox, HuntCrossleyContact>;
  using M = Model<Bodies<Rigid<>>, Joints<>, Forces<Law>>;
  M model{Gravity{0, 0, -9.81}};
  Vec3 const size(p[3], 0.12, 0.08);
  auto const box = model.add(Rigid<>(p[0], Vec3(0.002, 0.0015, 0.002).asDiagonal().toDenseMatrix(),
                                     Placement::at({0, 0, p[5]}, {0.1, 0.2, 0.3})),
                             "box");
  model.apply(Law{{.size_a = size, .rounding_a = p[4], .size_b = {0.5, 0.5, 0.2}, .rounding_b = 0.02, .taper = 1e-3},
                  {.stiffness = p[1], .damping = 0.3},
                  {.coefficient = p[2], .slip_speed = 0.05}},
              box.at(Vec3::Zero()), model.ground().at({0, 0, 0}), "base");
  State start = model.reference_state();
  model.set_velocity(start, box, {0.5, 0.1, -0.5}, {0, 1, 0});
  auto const place = [box](auto const& m, auto const& x) {
    auto const r = position(m, x, box.at(Vec3(0.03, 0.02, 0.01)));
    return r[0] + 2.0 * r[2] - 0.5 * r[1];
  };
  std::vector<Output<M>> outputs{{"place [m]", place}};
  return with_objective(Scenario<M>{std::move(model), start, {.end_time = 0.1, .step = 5e-4}, std::move(outputs)},
                        place);
};

TEST(GradientsOfContactShapes, AgreeWithDifferences) {
  GeneralisedAlpha const integrator{.tolerance = 1e-12, .start_correction = false};
  // Changes of a parameter by about 1e-6 of its value: larger ones move a first contact to another step.
  std::vector<Parameter> fine = parameters;
  for (Parameter& p : fine) p.scale = 1e-3 * p.value;
  VecX const direct = sensitivities(fall, parameters, integrator).derivatives.back().row(0).transpose(),
             adjoint = gradient(fall, parameters, integrator).derivatives,
             expected = by_differences(fall, fine, integrator).row(0).transpose();
  double largest = 0.0;
  for (Index j = 0; j < direct.size(); ++j)
    largest = std::max(largest, parameters[std::size_t(j)].size() * std::abs(direct[j]));
  for (Index j = 0; j < direct.size(); ++j) {
    double const size = parameters[std::size_t(j)].size();
    std::string const& name = parameters[std::size_t(j)].name;
    EXPECT_GT(size * std::abs(direct[j]), 1e-6) << name;
    EXPECT_NEAR(size * adjoint[j], size * direct[j], 1e-10 * largest) << name;
    EXPECT_NEAR(size * expected[j], size * direct[j], 1e-5 * largest) << name;
  }
}

}  // namespace contact_shapes_gradients_test
