// Planar flexible dynamics compared with independent computations: D1, D2, D3 and D6 with published parameters.
#include <gtest/gtest.h>

#include <polybody/polybody.hpp>

#include "support/spin_up.hpp"

namespace dynamics_test {

using namespace polybody;
using planar::EngineeringStrain;
using planar::Lrvf;
using Cable = planar::AncfCable<EngineeringStrain>;

// D1: robot arm of Simo & Vu-Quoc 1986. Pinned at the origin along x, no gravity.
Bar svq_arm() {
  return {.length = 10.0,
          .constants = BarConstants{.EA = 1e4, .EI = 1e3, .mass_per_length = 1.0, .GA = 1e4, .rotary_inertia = 10.0}};
}

Claim spectral(char const* case_id, char const* what, std::string const& formulation) {
  return {case_id, what, By::independent, "spectral geometrically exact beam, two meshes", formulation};
}

template <class B, class Law>
struct DrivenArm {
  using Pin = Joint<planar::Revolute, Constraint>;
  using Drive = Joint<PrescribedAngle<Law>, Constraint>;
  Model<Bodies<B>, Joints<Pin, Drive>> model;
  BodyHandle<B> arm;
  DrivenArm(B const& body, Law const& law) : arm(model.add(body, "arm")) {
    model.connect(Pin{}, model.ground().at({0, 0, 0}), arm.at(0.0), "pin");
    model.connect(Drive{{law}, {}}, model.ground().at({0, 0, 0}), arm.at(0.0), "drive");
  }
};

char const* const forty = "planar Lrvf, 40 elements, h = 2.5e-3 s";

TEST(SimoVuQuocArm, DisplacementDrivenConvergesToTheIndependentSolution) {
  DrivenArm<Lrvf, Ramp> arm(Lrvf::from(svq_arm(), 40), Ramp{.target = 1.5, .duration = 2.5});
  State x = arm.model.reference_state();
  struct Row {
    double t, x, y;
  };
  std::vector<Row> const rows{{0.5, 9.95467, 0.0850}, {1.0, 9.69741, 0.4799}, {2.0, 8.23204, 5.2519},
                              {2.5, 5.05062, 8.5231}, {3.0, 0.0686, 9.98608}, {5.0, -8.0557, 3.7519},
                              {10.0, -2.5966, 9.6614}};
  std::size_t next = 0;
  double energy_after = 0.0;
  for (State const& now :
       simulate(arm.model, x, GeneralisedAlpha{.rho_inf = 0.9}, {.end_time = 10.0, .step = 2.5e-3})) {
    if (next < rows.size() && now.t >= rows[next].t - 1e-9) {
      Vec3 const tip = position(arm.model, now, arm.arm.at(10.0));
      Instance const at{equals("t", now.t), 10.0};  // 0.5 % of L
      held(spectral("D1", "x of the tip, angle driven in 2.5 s [m]", forty), tip[0], rows[next].x, 0.05, at);
      held(spectral("D1", "y of the tip, angle driven in 2.5 s [m]", forty), tip[1], rows[next].y, 0.05, at);
      ++next;
    }
    if (std::abs(now.t - 3.0) < 1e-9) energy_after = energy(arm.model, now).total();
  }
  EXPECT_EQ(next, rows.size());
  held(spectral("D1", "energy at 3 s, angle driven in 2.5 s [J]", forty), energy_after, 256.33, 0.01 * 256.33);
  held({"D1", "energy from 3 s to 10 s [J]", By::closed_form, "invariant after the drive", forty},
       energy(arm.model, x).total(), energy_after, 0.002 * energy_after);
}

TEST(SimoVuQuocArm, TenElementsAsInThePaperStayWithinFivePercentOfTheLength) {
  DrivenArm<Lrvf, Ramp> arm(Lrvf::from(svq_arm(), 10), Ramp{.target = 1.5, .duration = 5.0});
  State x = arm.model.reference_state();
  struct Row {
    double t, x, y;
  };
  std::vector<Row> const rows{{1.0, 9.9233, 0.2375}, {2.5, 8.7431, 4.7879}, {5.0, -2.6005, 9.5806}};
  std::size_t next = 0;
  for (State const& now : simulate(arm.model, x, GeneralisedAlpha{.rho_inf = 0.9}, {.end_time = 5.0, .step = 5e-3}))
    if (next < rows.size() && now.t >= rows[next].t - 1e-9) {
      Vec3 const tip = position(arm.model, now, arm.arm.at(10.0));
      held_within(spectral("D1", "tip, angle driven in 5 s [m]", "planar Lrvf, 10 elements, h = 5e-3 s"),
                  (tip - Vec3(rows[next].x, rows[next].y, 0)).norm(), 0.5, {equals("t", now.t), 10.0});
      ++next;
    }
  EXPECT_EQ(next, rows.size());
}

// τ = 5, all rows of the table.
TEST(SimoVuQuocArm, SlowlyDrivenConvergesToTheIndependentSolution) {
  DrivenArm<Lrvf, Ramp> arm(Lrvf::from(svq_arm(), 40), Ramp{.target = 1.5, .duration = 5.0});
  State x = arm.model.reference_state();
  struct Row {
    double t, x, y;
  };
  for (Row const& row :
       {Row{0.5, 9.9886, 0.0425}, Row{1.0, 9.9233, 0.2375}, Row{2.5, 8.7431, 4.7879}, Row{5.0, -2.6005, 9.5806},
        Row{7.5, 0.1419, 10.0080}, Row{9.0, 5.1927, 8.2075}, Row{10.0, 4.6035, 8.7458}, Row{15.0, 2.9439, 9.5287}}) {
    simulate(arm.model, x, GeneralisedAlpha{.rho_inf = 0.9}, {.end_time = row.t, .step = 2.5e-3}).run();
    held_within(spectral("D1", "tip, angle driven in 5 s [m]", forty),
                (position(arm.model, x, arm.arm.at(10.0)) - Vec3(row.x, row.y, 0)).norm(), 0.05,
                {equals("t", row.t), 10.0});
    if (row.t > 5.0)
      held(spectral("D1", "energy, angle driven in 5 s [J]", forty), energy(arm.model, x).total(), 42.36, 0.01 * 42.36,
           {equals("t", row.t)});
  }
}

TEST(SimoVuQuocArm, TorqueDrivenKeepsTheImpulseExactly) {
  using Pin = Joint<planar::Revolute, Constraint>;
  Model<Bodies<Lrvf>, Joints<Pin>, Forces<PointMoment<Window>>> model;
  auto const arm = model.add(Lrvf::from(svq_arm(), 40), "arm");
  model.connect(Pin{}, model.ground().at({0, 0, 0}), arm.at(0.0), "pin");
  model.apply(PointMoment<Window>{.moment = {0, 0, 80}, .law = {.to = 2.5}}, arm.at(0.0), "torque");
  State x = model.reference_state();
  GeneralisedAlpha const integrator{.rho_inf = 0.9};
  auto const turns = [&](double t, double tip_x, double tip_y) {
    simulate(model, x, integrator, {.end_time = t, .step = 2.5e-3}).run();
    Instance const at{equals("t", t), 10.0};
    held(spectral("D1", "x of the tip, driven by 80 N m [m]", forty), position(model, x, arm.at(10.0))[0], tip_x, 0.05,
         at);
    held(spectral("D1", "y of the tip, driven by 80 N m [m]", forty), position(model, x, arm.at(10.0))[1], tip_y, 0.05,
         at);
  };
  turns(1.0, 9.85887, 0.37794);
  turns(2.5, 8.34343, 5.51855);
  turns(5.0, -1.66986, 9.87162);
  turns(10.0, -6.2302, -7.8323);
  turns(15.0, 9.9904, 0.62665);
  held({"D1", "angular momentum after the torque [N m s]", By::closed_form, "80 N m for 2.5 s", forty},
       momentum(model, x).angular[2], 200.0, 0.01);
  held(spectral("D1", "energy after the torque [J]", forty), energy(model, x).total(), 55.463, 0.01 * 55.463);
}

// D2: spin-up of Kane, Ryan & Banerjee 1987. The base is clamped to a hub of zero radius.
template <class B>
void spins_up(B const& body, spin_up::Share const& share, char const* formulation) {
  DrivenArm<B, SpinUp> const arm(body, spin_up::drive().geometry.law);
  spin_up::follows(arm.model, arm.arm.at(10.0), share, formulation);
}

TEST(SpinUp, CableOfEightElements) {
  spins_up(Cable::from(spin_up::arm(), 8), {1e-3, 0.02}, "planar AncfCable, 8 elements");
}
TEST(SpinUp, LrvfOfTenElements) { spins_up(Lrvf::from(spin_up::arm(), 10), {1e-2, 0.03}, "planar Lrvf, 10 elements"); }

// D3: flying rod of Simo & Vu-Quoc 1986, free in the plane.
template <class B>
void flying_rod(double EI, int elements, Vec2 const& loaded, Vec2 const& free, double plateau, double tolerance) {
  Bar const bar{
      .length = 10.0,
      .constants = BarConstants{.EA = 1e4, .EI = EI, .mass_per_length = 1.0, .GA = 1e4, .rotary_inertia = 10.0},
      .placement = Placement::planar(6.0, 0.0, std::atan2(8.0, -6.0))};
  Model<Bodies<B>, Joints<>, Forces<PointForce<Window>, PointMoment<Window>>> model;
  auto const rod = model.add(B::from(bar, elements), "rod");
  model.apply(PointForce<Window>{.force = {8, 0, 0}, .law = {.to = 2.5}}, rod.at(0.0), "force");
  model.apply(PointMoment<Window>{.moment = {0, 0, -80}, .law = {.to = 2.5}}, rod.at(0.0), "moment");
  State x = model.reference_state();
  simulate(model, x, GeneralisedAlpha{.rho_inf = 0.95}, {.end_time = 5.0, .step = 2.5e-3}).run();
  Momentum const p = momentum(model, x);
  std::string const mesh =
      "planar Lrvf, EI = " + std::to_string(int(EI)) + ", " + std::to_string(elements) + " elements, h = 2.5e-3 s";
  held_within({"D3", "momentum after the loads [N s]", By::closed_form, "8 N for 2.5 s", mesh},
              (p.linear - Vec3(20, 0, 0)).norm(), 1e-6, {.scale = 20.0});
  Vec3 centre = Vec3::Zero();  // centre of mass: the mid-points are exact for the linear field
  for (int i = 0; i < elements; ++i)
    centre += 0.5 / elements *
              (position(model, x, rod.at(10.0 * i / elements)) + position(model, x, rod.at(10.0 * (i + 1) / elements)));
  auto const of_mass = [&](char const* what) {
    return Claim{"D3", what, By::closed_form, "integral of the impulse over the mass", mesh};
  };
  held(of_mass("x of the centre of mass at 5 s [m]"), centre[0], 5.5 + 2.0 * 2.5, 2e-4);
  held(of_mass("y of the centre of mass at 5 s [m]"), centre[1], 4.0, 1e-6);
  held(spectral("D3", "energy after the loads [J]", mesh), energy(model, x).total(), plateau, 0.02 * plateau);
  Vec3 const a = position(model, x, rod.at(0.0)), b = position(model, x, rod.at(10.0));
  held_within(spectral("D3", "loaded end at 5 s [m]", mesh), (a.head<2>() - loaded).norm(), tolerance, {.scale = 10.0});
  held_within(spectral("D3", "free end at 5 s [m]", mesh), (b.head<2>() - free).norm(), tolerance, {.scale = 10.0});
}

TEST(FlyingRod, Stiff) { flying_rod<Lrvf>(500.0, 40, {5.6202, 4.7642}, {15.4085, 4.2645}, 90.2, 0.05); }
TEST(FlyingRod, Flexible) { flying_rod<Lrvf>(100.0, 40, {9.7838, 8.2039}, {8.0742, 1.7588}, 380.0, 0.1); }

// D6b, D6c: pendulums released from the horizontal.
template <class B>
void pendulum(Claim const& claim, B const& body, std::vector<std::array<double, 3>> const& rows, double step,
              double tolerance, double g = 9.81) {
  using Pin = Joint<planar::Revolute, Constraint>;
  Model<Bodies<B>, Joints<Pin>> model{Gravity{0, -g, 0}};
  auto const rod = model.add(body, "rod");
  model.connect(Pin{}, model.ground().at({0, 0, 0}), rod.at(0.0), "pin");
  State x = model.reference_state();
  for (auto const& [t, tip_x, tip_y] : rows) {
    simulate(model, x, GeneralisedAlpha{.rho_inf = 0.9}, {.end_time = t, .step = step}).run();
    Vec3 const tip = position(model, x, rod.at(1.0));
    held_within(claim, (tip - Vec3(tip_x, tip_y, 0)).lpNorm<Eigen::Infinity>(), tolerance, {equals("t", t), 1.0});
  }
}

Bar moderate() {  // D6b
  return {.length = 1.0,
          .constants = BarConstants{
              .EA = 1.5e5, .EI = 5.0, .mass_per_length = 1.0, .GA = 4.807692e4, .rotary_inertia = 3.3333333e-5}};
}
Bar stiff() {  // D6c
  return {.length = 1.0,
          .constants = BarConstants{
              .EA = 5.25e7, .EI = 10937.5, .mass_per_length = 10.0, .GA = 1.68269e7, .rotary_inertia = 2.08333e-3}};
}
// the cable has no shear: reference values with GA = 1e6
TEST(FlexiblePendulum, ModerateCable) {
  pendulum(spectral("D6b", "tip, GA = 1e6 N [m]", "planar AncfCable, 8 elements, h = 1e-3 s"),
           Cable::from(moderate(), 8),
           {{0.5, -0.093390, -0.995671}, {1.0, -0.999921, -0.003370}, {2.0, 0.999386, -0.019993}}, 1e-3, 5e-4);
}
TEST(FlexiblePendulum, ModerateLrvf) {
  pendulum(spectral("D6b", "tip [m]", "planar Lrvf, 32 elements, h = 1e-3 s"), Lrvf::from(moderate(), 32),
           {{0.1, 0.997688, -0.061850},
            {0.2, 0.957377, -0.288926},
            {0.5, -0.093346, -0.995676},
            {1.0, -0.999924, -0.003451}},
           1e-3, 5e-4);
}
std::vector<std::array<double, 3>> const d6c{{0.1, 0.9972992192, -0.0734484788},  {0.2, 0.9573053663, -0.2890813990},
                                             {0.3, 0.7946942404, -0.6070127388},  {0.5, -0.0893682330, -0.9960014555},
                                             {0.7, -0.8681470834, -0.4963098050}, {1.0, -0.9999679437, -0.0080097355}};
TEST(FlexiblePendulum, StiffLrvf) {
  pendulum(spectral("D6c", "tip [m]", "planar Lrvf, 16 elements, h = 1e-3 s"), Lrvf::from(stiff(), 16), d6c, 1e-3,
           1e-4);
}
// The published run has a rotary inertia, which adds 6.25e-4 to the rod's moment of inertia about the pin. It moves
// the tip by 8e-4 m at 0.5 s. The cable has no rotary inertia. For so stiff a rod, gravity reduced in the same ratio
// is equivalent.
TEST(FlexiblePendulum, StiffCable) {
  double const ratio = 1.0 + 2.08333e-3 / (10.0 / 3.0);
  pendulum(
      spectral("D6c", "tip [m]", "planar AncfCable, g smaller by the rotary inertia's share, 8 elements, h = 1e-4 s"),
      Cable::from(stiff(), 8), d6c, 1e-4, 1e-4, 9.81 / ratio);
}

}  // namespace dynamics_test
