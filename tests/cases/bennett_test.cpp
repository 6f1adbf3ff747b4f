// Bennett's linkage, four links and four skew pins with one degree of freedom where a count of equations gives −2,
// passes its folded positions.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/initial_conditions.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/redundancy.hpp>
#include <polybody/run/simulate.hpp>

namespace polybody {
namespace bennett_test {

/// Links of lengths 1 m and sin β/sin α with the twists α and β, alternately. The joint angles θ and φ satisfy
/// tan ½θ tan ½φ = sin ½(β + α)/sin ½(β − α) [Bennett 1903]. The fourth link is the ground.
struct Bennett {
  using Pin = Joint<Revolute, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Pin>> model{Gravity{0, 0, -9.81}};
  State x;
  double gap = 0.0;  ///< of the loop at the start [m]

  /// \param theta angle of the first pin [rad]  \param rate of this angle [rad/s]
  Bennett(double alpha, double beta, double theta, double rate) {
    double const phi =
        2.0 * std::atan2(std::sin(0.5 * (beta + alpha)), std::sin(0.5 * (beta - alpha)) * std::tan(0.5 * theta));
    double const turns[] = {theta, phi, -theta, -phi};
    Vec3 at[5], axis[5];
    Mat3 axes = Mat3::Identity();
    at[0] = Vec3::Zero();
    axis[0] = axes.col(2);
    for (int i = 0; i < 4; ++i) {  // rotation about z, translation along x, twist about x [Denavit & Hartenberg 1955]
      double const twist = i % 2 ? beta : alpha, length = i % 2 ? std::sin(beta) / std::sin(alpha) : 1.0;
      axes = axes * exp_so3<double>(Vec3(0, 0, turns[i]));
      at[i + 1] = at[i] + length * axes.col(0);
      axes = axes * exp_so3<double>(Vec3(twist, 0, 0));
      axis[i + 1] = axes.col(2);
    }
    gap = (at[4] - at[0]).norm() + (axis[4] - axis[0]).norm();
    std::vector<BodyHandle<Rigid<>>> links;
    for (int i = 0; i < 3; ++i) {
      Vec3 const d = at[i + 1] - at[i];
      Mat3 const inertia = (d.squaredNorm() * Mat3::Identity() - d * d.transpose()) / 12.0 + 0.01 * Mat3::Identity();
      links.push_back(model.add(Rigid<>(1.0, inertia, Placement::at(0.5 * (at[i] + at[i + 1])))));
    }
    auto const end = [&](int link, int point) {
      return links[std::size_t(link)].at(Vec3(at[point] - 0.5 * (at[link] + at[link + 1])));
    };
    auto const pin = [&](int i) { return Pin{Revolute{.axis = axis[i]}}; };
    model.connect(pin(0), model.ground().at(at[0]), end(0, 0), "pin 0");
    model.connect(pin(1), end(0, 1), end(1, 1), "pin 1");
    model.connect(pin(2), end(1, 2), end(2, 2), "pin 2");
    model.connect(pin(3), end(2, 3), model.ground().at(at[3]), "pin 3");
    x = model.reference_state();
    model.set_velocity(x, links[0], Vec3::Zero(), rate * axis[0]);
    assemble(model, x);
  }
};

constexpr double degree = std::numbers::pi / 180.0;

TEST(Bennett, HasOneDegreeOfFreedom) {
  Bennett const b(60 * degree, 45 * degree, 1.0, 0.0);
  EXPECT_LT(b.gap, 1e-12);
  Redundancy const r = redundancy(b.model, b.x);
  EXPECT_EQ(r.rows, 20);
  EXPECT_EQ(r.degrees_of_freedom, 1);
}

// At 5 rad/s the first link makes full turns, at rest it swings. Energy in J, of at most 30 J.
template <class I>
void expect_runs(I const& integrator) {
  for (double const beta : {45.0, 120.0})  // with 120° all links have the length 1 m
    for (double const theta : {0.3, 1.0, 2.0, 3.0})
      for (double const step : {1e-3, 2e-3, 4e-3}) {
        Bennett b(60 * degree, beta * degree, theta, theta == 1.0 ? 0.0 : 5.0);
        double const before = energy(b.model, b.x).total();
        RunReport const report = simulate(b.model, b.x, integrator, {.end_time = 2.0, .step = step}).run();
        EXPECT_NEAR(energy(b.model, b.x).total(), before, 5e-3) << beta << ' ' << theta << ' ' << step;
        EXPECT_TRUE(report.warnings.empty()) << beta << ' ' << theta << ' ' << step;
      }
}
TEST(Bennett, FoldsFromAllStartsUnderGeneralisedAlpha) { expect_runs(GeneralisedAlpha{}); }
TEST(Bennett, FoldsFromAllStartsUnderStabilisedSteps) { expect_runs(GeneralisedAlpha{.stabilised = true}); }

}  // namespace bennett_test
}  // namespace polybody
