// The pendulum of ex01_pendulum.cpp, with a picture: angle and force of the pin over time.
//   pendulum out/pendulum        # writes swing.csv and swing.png to this folder
#include <filesystem>
#include <iostream>

#include <polybody/polybody.hpp>
using namespace polybody;

int main(int argc, char** argv) {
  std::filesystem::path const folder = argc > 1 ? argv[1] : ".";
  std::filesystem::create_directories(folder);
  using Pin = Joint<Revolute, Constraint>;
  Bar const bar{.length = 1.0, .section = Circle{.radius = 0.01}, .material = Material{.density = 7800, .young = 2e11}};
  Model<Bodies<Rigid<>>, Joints<Pin>> model{Gravity{0, 0, -9.81}};
  auto const rod = model.add(Rigid<>::from(bar), "rod");
  auto const pin = model.connect(Pin{{.axis = {0, 1, 0}}}, model.ground().at({0, 0, 0}), rod.at(0.0), "pin");
  State x = model.reference_state();
  Table const table =
      tabulate(simulate(model, x, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = 2.0, .step = 1e-3}),
               {{"angle [rad]", [pin](auto const& now) { return now.joint_angle(pin); }},
                {"force of the pin [N]", [pin](auto const& now) { return now.reaction(pin).f.norm(); }}},
               0.01);
  plot(table, folder / "swing");
  double const drift = energy(model, x).total(), gap = constraint_violation(model, x, pin).norm();
  std::cout << "after " << x.t << " s: energy drift " << drift << " J, constraint violation " << gap << " m\n";
  return std::abs(drift) < 1e-3 && gap < 1e-9 ? 0 : 1;
}
