// Integrators, runs, statics and modes with invalid or extreme options.
#include <gtest/gtest.h>

#include <polybody/polybody.hpp>
#include <polybody/vibration/steady_rotation.hpp>

#include "runs.hpp"

namespace polybody::hostile_integrators_test {
namespace {

using Hinge = Joint<planar::Revolute, Constraint>;

/// Two links on a pin at an angle [rad] from the horizontal, with a push.
struct Pendulum {
  Model<Bodies<planar::Rigid>, Joints<Hinge>, Forces<PointForce<>>> model{Gravity{0, -9.81, 0}};

  explicit Pendulum(double angle = 0.0) {
    Bar const bar{.length = 1.0, .constants = BarConstants{.EA = 1e6, .EI = 1e3, .mass_per_length = 1.0}};
    Bar first = bar, next = bar;
    first.placement = Placement::planar(0.0, 0.0, angle);
    next.placement = Placement::planar(std::cos(angle), std::sin(angle), angle);
    auto const a = model.add(planar::Rigid::from(first), "a"), b = model.add(planar::Rigid::from(next), "b");
    model.connect(Hinge{}, model.ground().at({0, 0, 0}), a.at(0.0), "pin");
    model.connect(Hinge{}, a.at(1.0), b.at(0.0), "hinge");
    model.apply(PointForce<>{.force = {1, 1, 0}}, b.at(1.0), "push");
  }
};

template <class I>
int try_integrator(I const& sane) {
  Pendulum const pendulum;
  return try_hostile(sane, I::name, [&](I const& i) { run_ten_steps(pendulum.model, i); });
}

TEST(HostileParameters, OfIntegrators) {
  int tried = 0;
  tried += try_integrator(GeneralisedAlpha{});
  tried += try_integrator(HhtAlpha{});
  tried += try_integrator(Newmark{.gamma = 0.6, .beta = 0.3025});
  tried += try_integrator(Trapezoidal{});
  tried += try_integrator(EnergyMomentum{});
  tried += try_integrator(EnergyDecaying{});
  tried += try_integrator(Radau{});
  tried += try_integrator(Rattle{});
  tried += try_integrator(RungeKutta4<Baumgarte>{.stabilisation = {.alpha = 10.0, .beta = 10.0}});
  tried += try_integrator(CentralDifference<Projection>{});
  tried += try_integrator(DormandPrince<Projection>{});
  tried += try_integrator(AdamsBashforthMoulton<CoordinatePartitioning>{});
  std::cout << tried << " options of integrators\n";
}

TEST(HostileParameters, OfRuns) {
  Pendulum const pendulum;
  RunOptions const sane{.end_time = 0.1, .step = 0.01, .breakpoints = {0.05}, .events = {{"low", [](State const& x) {
                                                                                            return x.q[1] + 0.01;
                                                                                          }}}};
  int tried = try_hostile(sane, "RunOptions", [&](RunOptions const& options) {
    run_ten_steps(pendulum.model, GeneralisedAlpha{}, options);
    run_ten_steps(pendulum.model, DormandPrince<Projection>{}, options);
  });
  std::cout << tried << " options of runs\n";
}

TEST(HostileParameters, OfStatics) {
  Pendulum const pendulum(-0.5 * std::numbers::pi);
  State hanging = pendulum.model.reference_state();
  equilibrium(pendulum.model, hanging);
  int tried = try_hostile(EquilibriumOptions{}, "EquilibriumOptions", [&](EquilibriumOptions const& options) {
    State x = pendulum.model.reference_state();
    equilibrium(pendulum.model, x, options);
    expect_finite(x);
  });
  tried += try_hostile(ArcLengthOptions{}, "ArcLengthOptions", [&](ArcLengthOptions const& options) {
    int points = 0;
    for (PathPoint const& point :
         equilibrium_path(pendulum.model, hanging, options, [&](PathPoint const&) { return ++points >= 10; })) {
      expect_finite(point.x);
      EXPECT_TRUE(std::isfinite(point.load_factor));
    }
  });
  std::cout << tried << " options of statics\n";
}

}  // namespace
}  // namespace polybody::hostile_integrators_test
