// Drives with invalid or extreme parameters: an error names the parameter, or ten steps give finite numbers. The words
// of messages follow the fields of each drive.
#include <gtest/gtest.h>

#include <polybody/parts.hpp>

#include "runs.hpp"

namespace polybody {

// drives
template <class Target>
inline constexpr auto words_of<Servo<Target>> =
    words("target", "proportional gain", "derivative gain", "largest force", "largest speed|derivative gain");
template <class Target>
inline constexpr auto words_of<PidServo<Target>> =
    words("target", "proportional gain", "integral gain", "derivative gain", "tracking time", "largest force",
          "largest speed|derivative gain");
template <class L>
inline constexpr auto words_of<RateLimited<L>> = words("law", "largest rate", "lag");
template <class Voltage>
inline constexpr auto words_of<DcMotor<Voltage>> =
    words("voltage", "resistance", "inductance", "motor constant", "gear ratio");
template <class Throttle>
inline constexpr auto words_of<TorqueSpeedCurve<Throttle>> = words("torque", "throttle");
template <int N>
inline constexpr auto words_of<BeltAndPulley<N>> =
    words("radius|span|centres", "centre", "axial stiffness", "damping", "pretension", "sense|centres");
template <>
inline constexpr auto words_of<Differential> = words("stiffness", "damping");

namespace hostile_drives_test {
namespace {

using Pin = Joint<Revolute>;
template <class... F>
using Mechanism = Model<Bodies<Rigid<>>, Joints<Pin>, Forces<F...>>;
Rigid<> disc(Vec3 const& centre) { return {1.0, Mat3(Mat3::Identity() * 0.1), Placement::at(centre)}; }
Pin const about_z{Revolute{.axis = Vec3::UnitZ()}};

/// Runs a body on a hinge with the law.
template <class L>
void drive(L const& law) {
  Mechanism<OnTurns<L>> model;
  auto const body = model.add(disc({0, 0, 0}), "body");
  auto const pin = model.connect(about_z, model.ground().at({0, 0, 0}), body.at({0, 0, 0}), "pin");
  model.apply(OnTurns<L>{law}, pin, "hostile");
  run_ten_steps(model, GeneralisedAlpha{});
}
/// Runs N bodies on hinges with the force element.
template <class F>
void run_shafts(F const& force, std::array<Vec3, F::markers> const& centres) {
  Mechanism<F> model;
  std::vector<BodyHandle<Rigid<>>> shafts;
  for (Vec3 const& centre : centres) {
    shafts.push_back(model.add(disc(centre)));
    model.connect(about_z, model.ground().at(centre), shafts.back().at({0, 0, 0}));
  }
  if constexpr (F::markers == 2)
    model.apply(force, shafts[0].at({0, 0, 0}), shafts[1].at({0, 0, 0}), "hostile");
  else
    model.apply(force, std::tuple(shafts[0].at({0, 0, 0}), shafts[1].at({0, 0, 0}), shafts[2].at({0, 0, 0})),
                "hostile");
  run_ten_steps(model, GeneralisedAlpha{});
}

TEST(HostileParameters, OfDrives) {
  int tried = 0;
  Servo<> const servo{
      .target = {0.5}, .proportional_gain = 10.0, .derivative_gain = 2.0, .most_force = 3.0, .most_speed = 1.0};
  tried += try_hostile(servo, "Servo", drive<Servo<>>);
  tried += try_hostile(RateLimited<Servo<>>{.law = servo, .most_rate = 20.0, .lag = 0.1}, "RateLimited",
                       drive<RateLimited<Servo<>>>);
  PidServo<> const pid{.target = {0.5},
                       .proportional_gain = 10.0,
                       .integral_gain = 5.0,
                       .derivative_gain = 2.0,
                       .tracking_time = 0.1,
                       .most_force = 3.0,
                       .most_speed = 1.0};
  tried += try_hostile(pid, "PidServo", drive<PidServo<>>);
  tried += try_hostile(
      DcMotor<>{.voltage = {12.0}, .resistance = 1.0, .inductance = 0.01, .constant = 0.1, .gear_ratio = 3.0},
      "DcMotor", drive<DcMotor<>>);
  tried += try_hostile(TorqueSpeedCurve<>{.torque = MonotoneTable({{0.0, 1.0}, {5.0, 0.0}}), .throttle = {0.5}},
                       "TorqueSpeedCurve", drive<TorqueSpeedCurve<>>);
  std::array const centres = {Vec3(0, 0, 0), Vec3(1, 0, 0)};
  tried += try_hostile(BeltAndPulley<2>{.radii = {0.1, 0.2},
                                        .centres = centres,
                                        .axial_stiffness = 1e4,
                                        .damping = 5.0,
                                        .pretension = 50.0,
                                        .senses = {1, -1}},
                       "BeltAndPulley", [&](BeltAndPulley<2> const& belt) { run_shafts(belt, centres); });
  tried += try_hostile(Differential{.stiffness = 100.0, .damping = 1.0}, "Differential", [](Differential const& gears) {
    run_shafts(gears, {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()});
  });
  std::cout << tried << " parameters of drives\n";
}

template <class L>
std::string refusal_of(L const& law) {
  try {
    drive(law);
  } catch (InvalidInput const& e) {
    return e.what();
  }
  return "";
}
TEST(DriveParameters, AreNamedWithValueUnitAndRange) {
  EXPECT_EQ(refusal_of(Servo<>{.target = {}, .proportional_gain = -2.0, .derivative_gain = 1.0}),
            "\"hostile\": the proportional gain must be zero or positive, and finite, but is -2 N m/rad.");
  EXPECT_EQ(refusal_of(Servo<>{.target = {}, .proportional_gain = 2.0, .derivative_gain = 1.0, .most_force = 0.0}),
            "\"hostile\": the largest force must be positive, but is 0 N m. Use infinity for no bound.");
  EXPECT_EQ(refusal_of(Servo<>{.target = {}, .proportional_gain = 2.0, .derivative_gain = 0.0, .most_speed = 1.0}),
            "\"hostile\": the derivative gain must be positive if the largest speed is finite, but is 0 N m s/rad. It "
            "controls the speed.");
  EXPECT_EQ(
      refusal_of(PidServo<>{
          .target = {}, .proportional_gain = 2.0, .integral_gain = -1.0, .derivative_gain = 0.0, .tracking_time = 1.0}),
      "\"hostile\": the integral gain must be zero or positive, and finite, but is -1 N m/rad/s.");
  EXPECT_EQ(refusal_of(DcMotor<>{.voltage = {}, .resistance = 1.0, .inductance = 0.0, .constant = 1.0}),
            "\"hostile\": the inductance must be positive and finite, but is 0 H.");
  EXPECT_EQ(
      refusal_of(DcMotor<>{.voltage = {}, .resistance = 1.0, .inductance = 1.0, .constant = 1.0, .gear_ratio = 0.0}),
      "\"hostile\": the gear ratio must be finite and not zero, but is 0.");
}
TEST(DriveParameters, OfBeltsAreNamedWithThePulley) {
  std::array const centres = {Vec3(0, 0, 0), Vec3(0.25, 0, 0)};
  auto const refusal = [&](BeltAndPulley<2> const& belt) -> std::string {
    try {
      run_shafts(belt, centres);
    } catch (InvalidInput const& e) {
      return e.what();
    }
    return "";
  };
  BeltAndPulley<2> belt{
      .radii = {0.1, 0.2}, .centres = centres, .axial_stiffness = 1e4, .pretension = 50.0, .senses = {1, -1}};
  EXPECT_EQ(refusal(belt),
            "\"hostile\": the centres of pulleys 0 and 1 are 0.25 m apart, but their distance must exceed 0.3 m, the "
            "difference of the radii (their sum for opposite senses).");
  belt.senses = {1, 2};
  EXPECT_EQ(refusal(belt), "\"hostile\": the sense of pulley 1 must be 1 or -1, but is 2.");
  belt.senses = {1, 1};
  EXPECT_EQ(refusal(belt), "");
  belt.radii = {0.1};
  EXPECT_EQ(refusal(belt), "\"hostile\": the radius of pulley 1 must be positive and finite, but is 0 m.");
}

}  // namespace
}  // namespace hostile_drives_test
}  // namespace polybody
