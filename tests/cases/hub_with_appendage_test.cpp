// Hub with a soft appendage under a torque (CASES3 2, after jgerstmayr/EXUDYN#1).

#include <gtest/gtest.h>

#include <numbers>

#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/ffr/planar_ffr.hpp>
#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/integrators/energy_momentum.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/se3_beam.hpp>

#include "support/held.hpp"

namespace polybody {
namespace hub_with_appendage_test {

using std::numbers::pi;

/// One period of a sine of 4 s, then zero.
struct OnePeriod {
  Motion operator()(double t) const { return {t < 4.0 ? std::sin(0.5 * pi * t) : 0.0, 0.0, 0.0}; }
  std::vector<double> breakpoints() const { return {4.0}; }
};

/// Hub of 5 kg m² on a pin, with an appendage of 5 m that is welded to its rim in equal pieces. The torque is 250 N m
/// times `OnePeriod`.
template <class B>
struct Hub {
  using Pin = Joint<planar::Revolute, Constraint>;
  using Clamp = Joint<planar::Weld, Constraint>;
  Model<Bodies<planar::Rigid, B>, Joints<Pin, Clamp>, Forces<PointMoment<OnePeriod>>> model;
  BodyHandle<planar::Rigid> hub = model.add(planar::Rigid(1.0, 5.0), "hub");
  std::vector<BodyHandle<B>> pieces;
  State x;

  Hub(int count, Index elements) {
    model.connect(Pin{}, model.ground().at({0, 0, 0}), hub.centre(), "pin");
    for (int i = 0; i < count; ++i) {
      double const l = 5.0 / count;
      pieces.push_back(model.add(B::from({.length = l,
                                          .section = Rectangle{.height = 0.02, .width = 0.02},
                                          .material = Material{.density = 2766.7, .young = 68.952e9},
                                          .placement = Placement::planar(1.0 + i * l, 0)},
                                         elements),
                                 "piece " + std::to_string(i)));
      if (i == 0)
        model.connect(Clamp{}, hub.at(Vec2(1, 0)), pieces[0].at(0.0), "clamp");
      else
        model.connect(Clamp{}, pieces[std::size_t(i - 1)].at(l), pieces.back().at(0.0));
    }
    model.apply(PointMoment<OnePeriod>{.moment = {0, 0, 250.0}}, hub.centre(), "torque");
    x = model.reference_state();
  }
  Marker<B> tip() const { return pieces.back().at(pieces.back().body().length()); }
};

/// Angle and speed of the hub; tip from the rim and its slope in the axes of the hub [rad], [rad/s], [m], [m], [rad].
struct Row {
  double t, angle, speed, x, y, slope;
};
constexpr Row table[] = {
    {0.5, 0.22508, 0.6250, 4.86164, -1.0825, -0.3008}, {1.0, 0.85510, 1.953, 4.78765, -1.3363, -0.3738},
    {2.0, 3.80915, 3.791, 4.99833, -0.1188, -0.0340},  {3.0, 6.76002, 2.068, 4.85224, 1.1274, 0.3041},
    {4.0, 7.56920, 0.252, 4.99558, 0.1899, 0.0570},    {6.0, 7.61974, -0.027, 4.99193, -0.2563, -0.0773}};

template <class B, class Integrator>
void turns(int pieces, Index elements, Integrator const& method, double momentum_tolerance,
           std::string const& formulation, double h = 1e-3) {
  auto const motion = [&](char const* what) {
    return Claim{"X2", what, By::independent, "inextensible rod, Ritz method in the slope, DOP853", formulation};
  };
  Claim const momentum{"X2", "angular momentum [kg m²/s]", By::closed_form, "(500/π)(1 − cos(πt/2)), 0 from 4 s on",
                       formulation};
  double const peak = 1000.0 / pi;
  Hub<B> m(pieces, elements);
  std::size_t next = 0;
  double lowest = 1e9, highest = 0.0, after = 0.0, dev = 0;
  for (auto const& now : simulate(m.model, m.x, method, {.end_time = 6.0, .step = h})) {
    double const L = now.momentum().angular[2],
                 impulse = now.t < 4.0 ? 0.5 * peak * (1.0 - std::cos(0.5 * pi * now.t)) : 0.0;
    dev = std::max(dev, std::abs(L - impulse * (pi * h / 4) / sin(pi * h / 4)));
    after = std::max(after, std::abs(L - impulse));
    if (now.t > 4.0 + 1e-9) {
      lowest = std::min(lowest, now.energy().total());
      highest = std::max(highest, now.energy().total());
    }
    if (next == std::size(table) || now.t < table[next].t - 1e-9) continue;
    Row const& row = table[next++];
    double const angle = now.coordinates_of(m.hub)[2];
    Mat3 const axes = now.frame(m.hub.centre()).A.transpose();
    Frame<double> const tip = now.frame(m.tip());
    Vec3 const r = axes * tip.r - Vec3::UnitX(), along = axes * tip.A.col(0);
    std::string const at = equals("t", row.t);
    held(motion("angle of the hub [rad]"), angle, row.angle, 1e-3, {at});
    held(motion("speed of the hub [rad/s]"), now.velocities_of(m.hub)[2], row.speed, 4e-3, {at, 3.8});
    held(motion("x of the tip in hub axes [m]"), r[0], row.x, 1e-3, {at});
    held(motion("y of the tip in hub axes [m]"), r[1], row.y, 3e-3, {at, 1.34});
    held(motion("slope of the tip in hub axes [rad]"), std::atan2(along[1], along[0]), row.slope, 1e-3, {at, 0.37});
    held(momentum, L, impulse, momentum_tolerance * peak, {at, peak});
  }
  printf("%s: after %g  dev %g  energy %.8g %.8g\n", formulation.c_str(), after / peak, dev / peak, lowest, highest);
  EXPECT_EQ(next, std::size(table));
  held(motion("least energy after 4 s [J]"), lowest, 0.7578, 0.01 * 0.7578);
  held(motion("largest energy after 4 s [J]"), highest, 0.7578, 0.01 * 0.7578);
}

using Cable = planar::AncfCable<EngineeringStrain>;
using GreenCable = planar::AncfCable<GreenStrain>;
GeneralisedAlpha const method{.rho_inf = 0.9};

TEST(HubWithAppendage, CablesFollowTheRod) {
  turns<Cable>(1, 8, method, 1e-6, "planar AncfCable, engineering strain, 8 elements, GeneralisedAlpha, h = 1 ms");
  turns<GreenCable>(1, 8, method, 1e-6, "planar AncfCable, Green strain, 8 elements, GeneralisedAlpha, h = 1 ms");
  turns<Cable>(1, 8, GeneralisedAlpha{.rho_inf = 1.0}, 1e-6, "ro1");
}
TEST(HubWithAppendage, Em) {
  turns<Cable>(1, 8, EnergyMomentum{}, 1e-9,
               "planar AncfCable, engineering strain, 8 elements, EnergyMomentum, h = 1 ms");
  turns<Cable>(1, 8, EnergyMomentum{}, 1e-9,
               "planar AncfCable, engineering strain, 8 elements, EnergyMomentum, h = .1 ms", 1e-4);
  turns<GreenCable>(1, 8, EnergyMomentum{}, 1e-9,
                    "planar AncfCable, Green strain, 8 elements, EnergyMomentum, h = 1 ms");
}
TEST(HubWithAppendage, Lrvf) {
  turns<planar::Lrvf>(1, 32, method, 1e-6, "planar Lrvf, 32 elements, GeneralisedAlpha, h = 1 ms");
  turns<planar::Se3Beam>(1, 32, method, 1e-6, "planar Se3Beam, 32 elements, GeneralisedAlpha, h = 1 ms");
}
TEST(HubWithAppendage, Ffr) {
  turns<planar::Ffr>(1, 4, method, 1e-6, "planar Ffr, 1 x 4 elements, GeneralisedAlpha, h = 1 ms");
  turns<planar::Ffr>(4, 2, method, 1e-6, "planar Ffr, 4 bodies of 2 elements, GeneralisedAlpha, h = 1 ms");
  turns<planar::Ffr>(8, 1, method, 1e-6, "planar Ffr, 8 bodies of 1 elements, GeneralisedAlpha, h = 1 ms");
}

}  // namespace hub_with_appendage_test
}  // namespace polybody
