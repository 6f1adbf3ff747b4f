// Derivatives of a run with a servo and a belt against differences of runs, and the same run from a checkpoint.

#include <gtest/gtest.h>

#include <filesystem>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/belt.hpp>
#include <polybody/forces/servo.hpp>
#include <polybody/gradients/gradient.hpp>
#include <polybody/gradients/sensitivities.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/io/checkpoint.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>

using namespace polybody;

namespace drives_gradient_test {

using Pin = Joint<Revolute>;
using Belt = BeltAndPulley<2>;
using Drive = OnTurns<PidServo<SmoothRamp>>;
using Mechanism = Model<Bodies<Rigid<>>, Joints<Pin>, Forces<Belt, Drive>>;

/// A servo turns the first pulley, a belt the second one. Parameters: proportional and integral gain of the servo,
/// stiffness and pretension of the belt, inertia of the second pulley.
Scenario<Mechanism> driven_pulleys(std::span<double const> p) {
  Mechanism model;
  Vec3 const centre(0.5, 0, 0);
  auto const disc = [](double inertia, Vec3 const& at) {
    return Rigid<>(1.0, Mat3(Mat3::Identity() * inertia), Placement::at(at));
  };
  auto const first = model.add(disc(0.02, {0, 0, 0}), "first"), second = model.add(disc(p[4], centre), "second");
  Pin const about_z{Revolute{.axis = Vec3::UnitZ()}};
  auto const pin = model.connect(about_z, model.ground().at({0, 0, 0}), first.at({0, 0, 0}), "pin");
  model.connect(about_z, model.ground().at(centre), second.at({0, 0, 0}), "other pin");
  model.apply(Belt{.radii = {0.1, 0.15},
                   .centres = {Vec3(0, 0, 0), centre},
                   .axial_stiffness = p[2],
                   .damping = 2.0,
                   .pretension = p[3]},
              first.at({0, 0, 0}), second.at({0, 0, 0}), "belt");
  model.apply(Drive{{.target = {.target = 8.0, .duration = 0.2},
                     .proportional_gain = p[0],
                     .integral_gain = p[1],
                     .derivative_gain = 1.5,
                     .tracking_time = 0.1,
                     .most_force = 6.0}},
              pin, "servo");
  State const start = model.reference_state();
  std::vector<Output<Mechanism>> outputs{{"x of a point of the second pulley [m]", [=](Mechanism const& m, State const& x) {
                                            return position(m, x, second.at({0.1, 0, 0}))[0];
                                          }}};
  return {std::move(model), start, {.end_time = 0.3, .step = 1e-3, .max_step_halvings = 0}, std::move(outputs)};
}
/// The same scenario; the output at the end is the objective function.
auto rated_pulleys(std::span<double const> p) {
  Scenario<Mechanism> scenario = driven_pulleys(p);
  auto const objective = [f = scenario.outputs[0].value](Mechanism const& m, State const& x) { return f(m, x); };
  return with_objective(std::move(scenario), objective);
}
/// The equations are differenced over 4·10⁻⁴ of a parameter. With these values no step ends as close to the bound of the
/// force.
std::vector<Parameter> const parameters{{"proportional gain [N m/rad]", 21.0},
                                        {"integral gain [N m/(rad s)]", 30.0},
                                        {"stiffness [N]", 3e3},
                                        {"pretension [N]", 60.0},
                                        {"inertia [kg m²]", 0.05}};
GeneralisedAlpha const integrator{.rho_inf = 0.8};

double output_of(std::vector<double> const& p) {
  Scenario<Mechanism> s = driven_pulleys(p);
  simulate(s.model, s.start, integrator, s.options).run();
  return s.outputs[0].value(s.model, s.start);
}

TEST(GradientOfDrives, EqualsDifferencesOfRuns) {
  SensitivityResult const forward = sensitivities(driven_pulleys, parameters, integrator);
  GradientResult const backward = gradient(rated_pulleys, parameters, integrator);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    std::vector<double> p;
    for (Parameter const& each : parameters) p.push_back(each.value);
    double const h = 1e-4 * p[i], sane = p[i];
    auto const at = [&](double value) {
      p[i] = value;
      return output_of(p);
    };
    double const central = (8.0 * (at(sane + h) - at(sane - h)) - at(sane + 2.0 * h) + at(sane - 2.0 * h)) / (12.0 * h);
    double const scale = 1e-4 / sane + std::abs(central), direct = forward.derivatives.back()(0, Index(i));
    EXPECT_GT(std::abs(central) * sane, 1e-6) << parameters[i].name;
    EXPECT_NEAR(direct, central, 1e-4 * scale) << parameters[i].name;
    EXPECT_NEAR(backward.derivatives[Index(i)], direct, 1e-6 * scale) << parameters[i].name;
  }
}

TEST(CheckpointOfDrives, KeepsTheStatesOfServoAndBelt) {
  std::vector<double> p;
  for (Parameter const& each : parameters) p.push_back(each.value);
  Scenario<Mechanism> const s = driven_pulleys(p);
  State straight = s.start, x = s.start, y = s.start;
  std::filesystem::path const file = std::filesystem::temp_directory_path() / "polybody_drives.ckp";
  // `snapshot` restarts the integrator, so both runs call it at the same step
  auto full = simulate(s.model, straight, integrator, s.options);
  for (State const& now : full)
    if (std::abs(now.t - 0.1) < 1e-6) full.snapshot();
  auto first = simulate(s.model, x, integrator, s.options);
  for (State const& now : first)
    if (std::abs(now.t - 0.1) < 1e-6) break;
  write_checkpoint(file, first.snapshot());
  resume(s.model, y, integrator, s.options, read_checkpoint(file)).run();
  std::filesystem::remove(file);
  EXPECT_EQ(y.q, straight.q);
  EXPECT_EQ(y.v, straight.v);
  EXPECT_GT(straight.v.tail(4).cwiseAbs().minCoeff(), 1e-6);  // two lengths of the belt, turns and integral part
}

}  // namespace drives_gradient_test
