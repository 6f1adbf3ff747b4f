#pragma once
/// \file Euler's columns (S9e) and a strip under a force in its stiff plane (S9d): buckling loads of rods, and the
/// bent equilibrium after buckling.

#include <polybody/joints/standard_joints.hpp>

#include "support/buckling.hpp"
#include "support/held.hpp"

namespace polybody {
namespace columns {

/// End conditions of a column along x. The second end slides along x.
enum class Ends { clamped_free, pinned_pinned, clamped_pinned, clamped_clamped };

/// L = EI = 1, four times as stiff out of the x–y plane. The mass is arbitrary, as it does not affect stability.
/// Stretch and shear change Euler's equation to EI θ″ + P (1 − P/EA + P/GA) θ = 0; with GA = EA they cancel. A
/// constrained end adds a transverse force that shears the column by 1/GA.
template <class B>
struct Column {
  using Clamp = Joint<Weld, Constraint>;
  using Pin = Joint<Revolute, Constraint>;
  using Slide = Joint<PointOnLine, Constraint>;
  using Guide = Joint<Prismatic, Constraint>;
  Model<Bodies<B>, Joints<Clamp, Pin, Slide, Guide>, Forces<PointForce<>>> model;
  BodyHandle<B> bar;
  State x;

  Column(Index n, Ends ends, Vec3 const& force)
      : bar(model.add(B::from({.length = 1.0,
                               .constants = BarConstants{.EA = 1e6,
                                                         .EI = 1.0,
                                                         .mass_per_length = 1.0,
                                                         .GA = 1e6,
                                                         .GJ = 1.0,
                                                         .rotary_inertia = 0.1,
                                                         .EI_y = 4.0,
                                                         .rotary_inertia_y = 0.1}},
                              n),
                      "column")) {
    auto const foot = model.ground().at({0, 0, 0}), head = model.ground().at({1, 0, 0});
    if (ends == Ends::pinned_pinned)
      model.connect(Pin{{.axis = Vec3::UnitZ()}, {}}, foot, bar.at(0.0), "pin");
    else
      model.connect(Clamp{}, foot, bar.at(0.0), "clamp");
    if (ends == Ends::clamped_clamped)
      model.connect(Guide{{.axis = Vec3::UnitX()}, {}}, head, bar.at(1.0), "guide");
    else if (ends != Ends::clamped_free)
      model.connect(Slide{{.axis = Vec3::UnitX()}, {}}, head, bar.at(1.0), "slide");
    model.apply(PointForce<>{.force = force}, bar.at(1.0));
    x = model.reference_state();
  }
  double tip_angle() const {
    Mat3 const a = frame(model, x, bar.at(1.0)).A;
    return std::atan2(a(1, 0), a(0, 0));
  }
};

/// The limit of errors in h² and h⁴ from meshes of n, 2n and 4n elements.
template <class F>
double limit_of_meshes(F&& of, Index n) {
  double const a = of(n), b = of(2 * n), c = of(4 * n), once = (4.0 * b - a) / 3.0, twice = (4.0 * c - b) / 3.0;
  return (16.0 * twice - once) / 15.0;
}

template <class B>
double critical_load(Index n, Ends ends, double near) {
  return buckling::critical_force(
      [&](double load) {
        Column<B> column(n, ends, {-load, 0, 0});
        equilibrium(column.model, column.x);
        return buckling::lowest(column.model, column.x);
      },
      0.98 * near, 1.15 * near);
}

/// Critical loads P = π²EI/4L², π²EI/L², 20.190728556426629 EI/L², 4π²EI/L².
template <class B>
void buckles_at_eulers_loads(Index n, char const* formulation) {
  double const pi2 = std::numbers::pi * std::numbers::pi;
  std::pair<Ends, double> const rows[] = {{Ends::clamped_free, 0.25 * pi2},
                                          {Ends::pinned_pinned, pi2},
                                          {Ends::clamped_pinned, 20.190728556426629},
                                          {Ends::clamped_clamped, 4.0 * pi2}};
  char const* const names[] = {"clamped–free", "pinned–pinned", "clamped–pinned", "clamped–clamped"};
  for (auto const& [ends, load] : rows)
    held({"S9e", "Euler's loads, P L²/EI", By::closed_form, "π²/4, π², tan √P = √P, 4π²", formulation},
         limit_of_meshes([&, load = load, ends = ends](Index m) { return critical_load<B>(m, ends, load); }, n), load,
         1e-4 * load, {names[int(ends)]});
}

/// Post-buckling: the clamped–free column is bent in equilibrium, P/P_cr = (2 K(sin ½θ)/π)² for θ = 20°, 40°, 60° at
/// its tip. A transverse force bends it first, and is then removed.
template <class B>
void stands_bent_beyond(Index n, char const* formulation) {
  double const critical = 0.25 * std::numbers::pi * std::numbers::pi;
  for (auto const& [degrees, part] :
       {std::pair{20.0, 1.01539687}, std::pair{40.0, 1.06366327}, std::pair{60.0, 1.15171962}}) {
    double const angle = limit_of_meshes(
        [&](Index m) {
          Column<B> pushed(m, Ends::clamped_free, {-part * critical, 0.02 * critical, 0}),
              column(m, Ends::clamped_free, {-part * critical, 0, 0});
          equilibrium(pushed.model, pushed.x, {.load_steps = 20});
          column.x = pushed.x;
          equilibrium(column.model, column.x);
          return column.tip_angle();
        },
        n);
    held({"S9e", "slope of the tip of a bent column [°]", By::closed_form, "P/P_cr = (2 K(sin ½θ)/π)²", formulation},
         angle * 180.0 / std::numbers::pi, degrees, 1e-3, {equals("P/P_cr", part)});
  }
}

/// S9d: L = 1, b = 0.1, t = 0.01, J = b t³/3 (1 − 0.63 t/b). The reference is a rod without shear: GA is a hundred
/// times that of k = 1. The rotary inertia is arbitrary, as it does not affect stability.
inline Bar strip() {
  double const e = 2.1e11, g = e / 2.6, b = 0.1, t = 0.01, a = b * t;
  return {.length = 1.0,
          .constants = BarConstants{.EA = e * a,
                                    .EI = e * t * b * b * b / 12,
                                    .mass_per_length = 1,
                                    .GA = 100 * g * a,
                                    .GJ = g * b * t * t * t / 3 * (1 - 0.63 * t / b),
                                    .rotary_inertia = 0.1,
                                    .EI_y = e * b * t * t * t / 12,
                                    .rotary_inertia_y = 0.1}};
}

template <class B>
double critical_tip_force(Index n) {
  return buckling::critical_force(
      [&](double force) {
        Model<Bodies<B>, Joints<Joint<Weld, Constraint>>, Forces<PointForce<>>> model;
        auto const bar = model.add(B::from(strip(), n), "strip");
        model.connect(Joint<Weld, Constraint>{}, model.ground().at({0, 0, 0}), bar.at(0.0), "clamp");
        model.apply(PointForce<>{.force = {0, force, 0}}, bar.at(1.0));
        State x = model.reference_state();
        equilibrium(model, x);
        EXPECT_EQ(position(model, x, bar.at(1.0))[2], 0.0);
        return buckling::lowest(model, x);
      },
      8400.0, 8800.0);
}

}  // namespace columns
}  // namespace polybody
