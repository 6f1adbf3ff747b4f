// title: Periods of a rigid floater
// thread: https://github.com/OpenFAST/openfast/issues/2704
// words: floating wind turbine, natural period, linearization, eigenanalysis, surge, pitch, heave, hydrostatics
// wanted: A rigid body on a stiffness matrix is linearised. Its eigenfrequencies were wrong.
// inputs: 1.6e7 kg, centre 12 m below the origin, inertia 9e9, 9e9 and 1.2e10 kg m² about the centre. Stiffness at
//     the origin, with the part of gravity: 7e4, 7e4 and 4e6 N/m, 1.5e9, 1.5e9 and 1.1e8 N m/rad.
// right: Heave 2π √(m/k) and yaw 2π √(J/k). Surge u of the origin and pitch ϑ are coupled by the centre at u − d
//     ϑ: the roots of ω⁴ m J − ω² (m k_ϑ + k_u (J + m d²)) + k_u k_ϑ = 0 give two periods, which sway and roll
//     have too.
#include <polybody/polybody.hpp>
#include <polybody/vibration.hpp>

#include <numbers>

#include "answer.hpp"
using namespace polybody;

int main() {
  using Water = Joint<RelativeCoordinates, Bushing>;
  Model<Bodies<Rigid<>>, Joints<Water>> model;
  double const m = 1.6e7, J = 9e9, d = 12.0, ku = 7e4, kt = 1.5e9, turn = 2.0 * std::numbers::pi;
  auto const floater =
      model.add(Rigid<>(m, Mat3(Vec3(J, J, 1.2e10).asDiagonal()), Placement::at({0, 0, -d})), "floater");
  Water const water{{.axis = {0, 0, 1}},
                    {.stiffness = Bushing::diagonal({ku, ku, 4e6}, {kt, kt, 1.1e8}),
                     .damping = Bushing::diagonal({0, 0, 0}, {0, 0, 0})}};
  model.connect(water, model.ground().at({0, 0, 0}), floater.at(Vec3(0, 0, d)), "water");
  VecX const period = turn * modes(model, model.reference_state(), 6).frequency.cwiseInverse();
  double const a = m * J, b = m * kt + ku * (J + m * d * d), root = std::sqrt(b * b - 4 * a * ku * kt);
  answer("surge with pitch [s]", turn * std::sqrt(2 * a / (b - root)), period[0], 1e-7);
  answer("sway with roll [s]", turn * std::sqrt(2 * a / (b - root)), period[1], 1e-7);
  answer("yaw [s]", turn * std::sqrt(1.2e10 / 1.1e8), period[2], 1e-7);
  answer("pitch with surge [s]", turn * std::sqrt(2 * a / (b + root)), period[3], 1e-7);
  answer("roll with sway [s]", turn * std::sqrt(2 * a / (b + root)), period[4], 1e-7);
  answer("heave [s]", turn * std::sqrt(m / 4e6), period[5], 1e-7);
  return wrong_answers();
}
