// Rolling discs: motions in closed form under each method that enforces nonholonomic constraints.

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/joints/nonholonomic.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/run/probe.hpp>

#include "support/held.hpp"
#include "support/velocity_row_runs.hpp"

using namespace polybody;

namespace rolling_test {

constexpr double g = 9.81;
using Wheel = Joint<RollingDisc, Constraint>;
using InSpace = Model<Bodies<Rigid<>>, Joints<Wheel>>;

/// Uniform disc about z of its own axes.
Rigid<> disc(double m, double radius, Placement const& place) {
  double const j = 0.25 * m * radius * radius;
  return Rigid<>(m, Vec3(j, j, 2.0 * j).asDiagonal().toDenseMatrix(), place);
}

/// Checks a distance from a closed form under one integrator of with_each_integrator.
template <class I>
void within(char const* case_id, char const* what, char const* source, I const& integrator, double error,
            double tolerance, double scale) {
  held_within({case_id, what, By::closed_form, source, named(integrator)}, error, tolerance, {.scale = scale});
}

// C4: from rest straight down an incline at (2/3) g sin α. The friction force is a third of the downhill force.
TEST(RollingDisc, RollsDownAnInclineAtTwoThirdsOfThePull) {
  double const m = 4.0, radius = 0.5, alpha = 0.3, t = 1.5, s = std::sin(alpha), c = std::cos(alpha);
  InSpace model{Gravity{g * s, 0, -g * c}};
  Placement const place = Placement::at({0, 0, radius}, {-0.5 * std::numbers::pi, 0, 0});  // its z along the world's y
  auto const wheel = model.add(disc(m, radius, place), "wheel");
  auto const contact = model.connect(Wheel{{.radius = radius, .axis = Vec3::UnitY(), .normal = Vec3::UnitZ()}, {}},
                                     model.ground().at({0, 0, 0}), wheel.at(Vec3::Zero()), "contact");
  double const a = 2.0 / 3.0 * g * s;
  with_each_integrator([&](auto const& integrator, double h, double precise) {
    State const x = rolled(model, model.reference_state(), integrator, t, h);
    Frame<double> const f = frame(model, x, wheel.at(Vec3::Zero()));
    within("C4", "place of a disc down an incline [m]", "½ a t², a = ⅔ g sin α", integrator,
           (f.r - Vec3(0.5 * a * t * t, 0, radius)).norm(), 1e-8, 0.5 * a * t * t);
    within("C4", "spin of a disc down an incline [rad/s]", "a t/R, a = ⅔ g sin α", integrator,
           (f.w - Vec3(0, a * t / radius, 0)).norm(), 1e-8, a * t / radius);
    within("C4", "force of the incline on a disc [N]", "m g cos α, and ⅓ m g sin α against the motion", integrator,
           (reaction(model, x, contact).f - m * g * Vec3(-s / 3.0, 0, c)).norm(), 1e-3 * precise, m * g);
  });
}

/// Steady rolling in a circle. The centre is at the distance r from a vertical axis, the disc leans inwards by β, and
/// the motion rotates at Ω. With e_r outwards and e_t forwards, the disc's axis is b = cos β e_r + sin β e_z. Also ρ
/// = R (sin β e_r − cos β e_z) and ω = Ω e_z + σ b. The rolling condition Ω r e_t + ω × ρ = 0 requires σ = −Ω (r/R +
/// sin β). The ground force is F = −m Ω² r e_r + m g e_z. Its moment ρ × F = m R (Ω² r cos β − g sin β) e_t equals Ω
/// e_z × H = Ω² cos β (−C r/R − A sin β) e_t with C = ½ m R², A = ¼ m R²:
///   Ω² = g tan β/(3/2 r + ¼ R sin β)       [Neimark & Fufaev 1972, ch. II, for a uniform disc].
struct Circle {
  double m = 2.0, radius = 0.4, r = 1.2, lean = 0.35;
  double omega = std::sqrt(g * std::tan(lean) / (1.5 * r + 0.25 * radius * std::sin(lean)));
  Vec3 axis{std::cos(lean), 0, std::sin(lean)}, up{-std::sin(lean), 0, std::cos(lean)};
  InSpace model{Gravity{0, 0, -g}};
  BodyHandle<Rigid<>> wheel = model.add(disc(m, radius, {Vec3(r, 0, radius* std::cos(lean)), axes()}), "wheel");
  ElementHandle<Wheel> contact = model.connect(Wheel{{.radius = radius, .axis = axis, .normal = Vec3::UnitZ()}, {}},
                                               model.ground().at({0, 0, 0}), wheel.at(Vec3::Zero()), "contact");
  State start = model.reference_state();

  /// \param extra angular velocity about the contact point, added to that of the steady motion
  explicit Circle(Vec3 const& extra = Vec3::Zero()) {
    Vec3 const w = omega * Vec3::UnitZ() - omega * (r / radius + std::sin(lean)) * axis + extra;
    Vec3 const contact_point = Vec3(r + radius * std::sin(lean), 0, 0);
    model.set_velocity(start, wheel, -w.cross(contact_point), w);
  }
  Mat3 axes() const {
    Mat3 a;
    a << up, axis.cross(up), axis;
    return a;
  }
};

TEST(RollingDisc, RollsSteadilyInACircle) {
  Circle const circle;
  double const t = 1.1 * 2.0 * std::numbers::pi / circle.omega;
  Mat3 const turn = exp_so3<double>(Vec3(0, 0, circle.omega * t));
  with_each_integrator([&](auto const& integrator, double h, double precise) {
    State const x = rolled(circle.model, circle.start, integrator, t, h);
    Frame<double> const f = frame(circle.model, x, circle.wheel.at(Vec3::Zero()));
    Vec3 const force = circle.m * Vec3(-circle.omega * circle.omega * circle.r, 0, g);
    char const* const steady = "Ω² = g tan β/(3/2 r + ¼ R sin β)";
    within("Neimark & Fufaev", "centre of a disc that rolls in a circle [m]", steady, integrator,
           (f.r - turn * Vec3(circle.r, 0, circle.radius * std::cos(circle.lean))).norm(), 3e-5 * precise, circle.r);
    within("Neimark & Fufaev", "axis of a disc that rolls in a circle", steady, integrator,
           (f.A.col(2) - turn * circle.axis).norm(), 3e-5 * precise, 1.0);
    within("Neimark & Fufaev", "force of the ground on a disc that rolls in a circle [N]", "−m Ω² r e_r + m g e_z",
           integrator, (reaction(circle.model, x, circle.contact).f - turn * force).norm(), 1e-3 * precise,
           force.norm());
  });
}

// After a deviation from the steady motion the disc wobbles. Rolling conserves energy.
TEST(RollingDisc, KeepsItsEnergyWhileItWobbles) {
  Circle const circle(Vec3(0.5, 0.4, 0.3));
  double const before = energy(circle.model, circle.start).total();
  double lowest = 1.0, highest = 0.0;
  State x = circle.start;
  for (State const& now :
       simulate(circle.model, x, RungeKutta4<CoordinatePartitioning>{}, {.end_time = 20.0, .step = 2e-3})) {
    double const steep = frame(circle.model, now, circle.wheel.at(Vec3::Zero())).A(2, 2);
    lowest = std::min(lowest, steep);
    highest = std::max(highest, steep);
  }
  EXPECT_GT(highest - lowest, 0.05);  // the disc wobbles
  held_within({"Neimark & Fufaev", "relative change of energy of a disc that wobbles for 20 s", By::closed_form,
               "invariant", "Runge–Kutta 4, CoordinatePartitioning, h = 2e-3 s"},
              std::abs(energy(circle.model, x).total() / before - 1.0), 1e-7, {.scale = 1.0});
}

}  // namespace rolling_test
