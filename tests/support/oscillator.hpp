#pragma once
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/solvers/dense_lu.hpp>

#include "support/held.hpp"

namespace polybody {

/// A unit mass on a prismatic joint with a spring of 1 N/m and zero free length: ω = 1, released from x = 1 at rest.
struct Oscillator {
  using Slide = Joint<planar::Prismatic, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Slide>, Forces<SpringDamper>> model;
  State x;

  Oscillator() {
    auto const mass = model.add(planar::Rigid(1.0, 1.0, Placement::planar(1.0, 0.0)), "mass");
    auto const home = model.ground().at({0, 0, 0});
    model.connect(Slide{}, home, mass.at(Vec2(0, 0)), "slide");
    model.apply(SpringDamper{.stiffness = 1.0, .free_length = 0.0}, home, mass.at(Vec2(0, 0)), "spring");
    x = model.reference_state();
  }
  template <class I>
  RunReport run(I const& integrator, double h, int steps) {
    return simulate(model, x, integrator, {.end_time = h * steps, .step = h}).run();
  }
  /// Factor by which a step of h ≫ 1/ω scales the velocity, over steps 21 to 30.
  template <class I>
  double scale_of_a_long_step(I const& integrator) {
    double const h = 1e5;
    System system(model);
    auto const method = method_of(integrator);
    auto workspace = method.template workspace<DenseLu>(system);
    method.start(system, x, h, workspace);
    for (int i = 0; i < 20; ++i) method.step(system, x, h, workspace);
    double const before = x.v[0];
    for (int i = 0; i < 10; ++i) method.step(system, x, h, workspace);
    return std::pow(std::abs(x.v[0] / before), 0.1);
  }
};

/// Linear oscillator (I1): the phase of the trapezoidal rule advances by 2 atan(ωh/2) per step; `ratio` is T_num/T.
struct TrapezoidalPeriod {
  double h, ratio;
};
inline constexpr TrapezoidalPeriod trapezoidal_periods[] = {
    {0.1, 1.00083277850411}, {0.5, 1.02049703761562}, {1.0, 1.07840521614581}};

/// After 100 steps of length h.
inline void held_trapezoidal(Oscillator const& o, TrapezoidalPeriod const& p, std::string const& integrator) {
  char const* const source = "T_num/T = (ωh/2)/atan(ωh/2)";
  Instance const at{equals("h", p.h), 1.0};
  held({"I1", "place of the oscillator after 100 steps", By::closed_form, source, integrator}, o.x.q[0],
       std::cos(100 * p.h / p.ratio), 1e-11, at);
  held({"I1", "speed of the oscillator after 100 steps", By::closed_form, source, integrator}, o.x.v[0],
       -std::sin(100 * p.h / p.ratio), 1e-11, at);
}

}  // namespace polybody
