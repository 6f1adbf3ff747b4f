// The derivative of a vibration with respect to a stiffness, against the derivative of its modal sum.
#include <polybody/gradients/sensitivities.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/run/probe.hpp>

using namespace polybody;

namespace sensitivities_cantilever_test {

using P = std::span<double const>;

constexpr double load = 1e-4, frequency = 4.0, end = 1.0;  ///< [N], [rad/s], [s]

/// ((1 − cos Ωt)/2)² = 3/8 − cos Ωt/2 + cos 2Ωt/8: it begins so smoothly that it does not excite modes above the
/// resolution of the steps.
struct Raised {
  Motion operator()(double t) const {
    double const x = 0.5 * (1.0 - std::cos(frequency * t));
    return {x * x, 0.0, 0.0};
  }
};

/// A cantilever of 1 m, 1 kg and bending stiffness EI under a transverse load at its tip.
auto cantilever(double step) {
  return [step](P p) {
    using Clamp = Joint<planar::Weld, Constraint>;
    using M = Model<Bodies<planar::AncfCable<>>, Joints<Clamp>, Forces<PointForce<Raised>>>;
    M model;
    auto const bar =
        model.add(planar::AncfCable<>::from(
                      {.length = 1.0, .constants = BarConstants{.EA = 1e4, .EI = p[0], .mass_per_length = 1.0}}, 8),
                  "bar");
    model.connect(Clamp{}, model.ground().at({0, 0, 0}), bar.at(0.0), "clamp");
    model.apply(PointForce<Raised>{.force = {0, load, 0}}, bar.at(1.0), "load");
    State const start = model.reference_state();
    std::vector<Output<M>> outputs{
        {"tip y [m]", [bar](M const& m, State const& x) { return position(m, x, bar.at(1.0))[1]; }}};
    return Scenario<M>{std::move(model), start, {.end_time = end, .step = step}, std::move(outputs)};
  };
}

/// Σ φᵢ(L)² F Σₖ cₖ (cos kΩt − cos ωt)/(ω² − k²Ω²), c = 3/8, −1/2, 1/8, φᵢ(L)² = 4/mL, ω² = (βL)⁴ EI/mL⁴,
/// cos βL cosh βL = −1.
double tip(double EI, double t) {
  double sum = 0.0;
  for (int i = 1; i <= 200; ++i) {
    double x = (i - 0.5) * std::numbers::pi;
    for (int k = 0; k < 20; ++k) {  // Newton's method on cos x + 1/cosh x
      double const sech = 1.0 / std::cosh(x);
      x += (std::cos(x) + sech) / (std::sin(x) + sech * std::tanh(x));
    }
    double const w2 = x * x * x * x * EI, w = std::sqrt(w2);
    for (auto const& [k, c] : {std::pair{0.0, 0.375}, std::pair{1.0, -0.5}, std::pair{2.0, 0.125}})
      sum += 4.0 * load * c * (std::cos(k * frequency * t) - std::cos(w * t)) / (w2 - k * k * frequency * frequency);
  }
  return sum;
}

TEST(SensitivitiesOfACantilever, TheSlopeByItsStiffnessTendsToThatOfTheModalSum) {
  double const e = 1e-3;
  double exact = 0.0;
  for (std::size_t k = 0; k < 4; ++k) exact += FourPoints::weights[k] / e * tip(1.0 + FourPoints::places[k] * e, end);
  std::array<double, 3> by{}, value{};
  for (std::size_t k = 0; k < 3; ++k) {
    SensitivityResult const s =
        sensitivities(cantilever(8e-3 / double(1 << k)), {{"EI [N m²]", 1.0}}, GeneralisedAlpha{.rho_inf = 0.9});
    by[k] = s.derivatives.back()(0, 0);
    value[k] = s.values.back()[0];
  }
  EXPECT_NEAR((4.0 * value[2] - value[1]) / 3.0, tip(1.0, end), 1e-5 * tip(1.0, end));
  EXPECT_NEAR((by[0] - by[1]) / (by[1] - by[2]), 4.0, 0.4);
  EXPECT_NEAR((4.0 * by[2] - by[1]) / 3.0, exact, 3e-5 * std::abs(exact));  // eight elements
}

}  // namespace sensitivities_cantilever_test
