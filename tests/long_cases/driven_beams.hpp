#pragma once
/// \file
/// M2: lateral buckling of a beam driven by crank and link. M3: flexible shaft through its critical speed. Data:
/// [Bauchau et al. 2016, Multibody Syst. Dyn. 37, 29–48]. The references are spectral geometrically exact beams.

#include "mechanism.hpp"
#include "support/buckling_beam.hpp"

namespace polybody::long_cases {

inline constexpr double pi = std::numbers::pi;

inline Claim spectral(char const* id, char const* what, std::string const& formulation) {
  return {id, what, By::independent, "spectral geometrically exact beams, RKF78", formulation};
}

// ---- M2

struct BucklingRow {
  double t, mid_y, mid_z, tip_y, tip_z;
};
inline constexpr BucklingRow buckling_table[] = {
    {0.05, -2.0080e-06, 0.0018680, 1.8780e-07, 0.0059522}, {0.1, -5.8245e-05, 0.0069426, 5.5057e-06, 0.0221113},
    {0.12, -3.2981e-04, 0.0093962, 4.4090e-05, 0.0299227}, {0.13, -0.0012387, 0.0105765, 2.2254e-04, 0.0337005},
    {0.14, -0.0073181, 0.0113840, 0.0016853, 0.0372117},   {0.15, -0.0345619, 0.0083939, 4.0462e-04, 0.0405648},
    {0.16, -0.0318848, 0.0092753, 0.0021556, 0.0431217},   {0.18, -0.0451246, 0.0079312, -0.0013699, 0.0465028},
    {0.2, -0.0330604, 0.0095055, 0.0029576, 0.0457308},    {0.25, 0.0098950, 0.0086604, -0.0013292, 0.0288587},
    {0.3, -0.0169347, 0.0010592, -0.0013112, 0.0038027},   {0.35, 0.0191311, -0.0038993, 0.0030826, -0.0143032},
    {0.4, -0.0220714, -0.0051619, -0.0040196, -0.0201670}};

/// Run of the mechanism.
template <class B>
struct BucklingRun : BucklingBeam<B> {
  using BucklingBeam<B>::model, BucklingBeam<B>::beam;
  State x = model.reference_state();

  BucklingRun(Mesh<B> const& mesh, Index n) : BucklingBeam<B>(mesh, n) {}
  BucklingRun(BucklingRun const&) = delete;

  void run_until(double t, double h) {
    simulate(model, x, GeneralisedAlpha{.rho_inf = 0.9}, {.end_time = t, .step = h}).run();
  }
  Vec3 moved(double s) const { return position(model, x, beam.at(s)) - Vec3(s, 0, 0); }
};

/// \param lateral tolerances of the lateral displacements until 0.12, 0.14, 0.2, 0.25 and 0.4 s [m]
template <class B>
void beam_buckles(Mesh<B> const& mesh, Index n, double h, std::array<double, 5> const& lateral) {
  BucklingRun<B> m(mesh, n);
  std::string const name = mesh.name + ", " + std::to_string(n) +
                           " elements, generalised-α, h = " + std::to_string(int(std::round(h * 1e6))) + " µs";
  for (BucklingRow const& row : buckling_table) {
    m.run_until(row.t, h);
    double const side = lateral[row.t < 0.125 ? 0 : row.t < 0.145 ? 1 : row.t < 0.225 ? 2 : row.t < 0.275 ? 3 : 4];
    Vec3 const mid = m.moved(0.5), tip = m.moved(1.0);
    Instance const at{equals("t", row.t), 0.045};
    held(spectral("M2", "u_y of the middle [m]", name), mid[1], row.mid_y, side, at);
    held(spectral("M2", "u_z of the middle [m]", name), mid[2], row.mid_z, 1e-5 + 0.3 * side, {at.at, 0.0114});
    held(spectral("M2", "u_y of the tip [m]", name), tip[1], row.tip_y, 0.3 * side, {at.at, 0.0031});
    held(spectral("M2", "u_z of the tip [m]", name), tip[2], row.tip_z, 1e-5 + 0.05 * side, at);
  }
  double const plateau = energy(m.model, m.x).total();
  held(spectral("M2", "energy after the drive [J]", name), plateau, 50.3242, 0.05 * 50.3242);
  double widest = 0.0;
  for (int i = 1; i <= 40; ++i) {
    m.run_until(0.4 + 0.01 * i, h);
    if (i >= 10) widest = std::max(widest, std::abs(m.moved(0.5)[1]));
    held(spectral("M2", "u_z of the tip after the drive [m]", name), m.moved(1.0)[2], -0.0205, 5e-4,
         {equals("t", 0.4 + 0.01 * i)});
    EXPECT_LE(energy(m.model, m.x).total(), plateau * (1.0 + 1e-4));  // not monotone within a period
  }
  held(spectral("M2", "amplitude of the middle after 0.5 s [m]", name), widest, 0.02495, 2.5e-3);
}

// ---- M3

struct ShaftRow {
  double t, u_y, u_z, twist, moved;  ///< middle; φ at T − ψ; axial displacement of T
};
inline constexpr ShaftRow shaft_table[] = {{0, 0.0, -0.0033098, 0.0, -0.0000044},
                                           {0.1, 0.0011203, -0.0030593, -0.0021585, -0.0000042},
                                           {0.25, -0.0078497, -0.0037452, -0.0038356, -0.0000301},
                                           {0.4, -0.0196368, 0.0322159, -0.0045526, -0.0005671},
                                           {0.5, 0.0759292, 0.0292097, -0.0059192, -0.0026403},
                                           {0.75, 0.1224582, 0.0656589, 0.0010898, -0.0077076},
                                           {1, 0.0553761, 0.0237842, 0.0038825, -0.0014480},
                                           {1.1, -0.0160693, -0.0498110, -0.0069122, -0.0010908},
                                           {1.25, 0.2203060, -0.0115077, -0.0201076, -0.0194777},
                                           {1.33, 0.0611805, -0.2627234, -0.0007832, -0.0291560},
                                           {1.5, -0.0921492, 0.0483818, 0.0123220, -0.0043216},
                                           {2, 0.0146282, -0.1089521, -0.0126113, -0.0048219},
                                           {2.25, 0.0707778, 0.2047391, 0.0206015, -0.0187782}};

/// ψ(t) at R.
inline Motion shaft_speed(double t) {
  double const w = 60.0;
  auto const rise = [&](double from, double by, double s, double length) {
    double const p = pi / length;
    return Motion{from * s + by * (s - std::sin(p * s) / p), from + by * (1.0 - std::cos(p * s)),
                  by * p * std::sin(p * s)};
  };
  auto const after = [](double angle, Motion const& m) { return Motion{angle + m.value, m.rate, m.acceleration}; };
  if (t < 0.5) return rise(0.0, 0.4 * w, t, 0.5);
  if (t < 1.0) return {12.0 + 0.8 * w * (t - 0.5), 0.8 * w, 0.0};
  if (t < 1.25) return after(36.0, rise(0.8 * w, 0.2 * w, t - 1.0, 0.25));
  return {51.0 + 1.2 * w * (t - 1.25), 1.2 * w, 0.0};
}

/// Tube of 6 m along x with an eccentric disk in the middle, in static equilibrium.
template <class B>
struct Shaft {
  Mechanism<B> model{Gravity{0, 0, -9.81}};
  BodyHandle<B> tube;
  BodyHandle<Rigid<>> disk;
  State x;

  Shaft(Mesh<B> const& mesh, Index n)
      : tube(model.add(mesh.make({.length = 6.0,
                                  .constants = BarConstants{.EA = 313.4e6,
                                                            .EI = 354.5e3,
                                                            .mass_per_length = 11.64,
                                                            .GA = 60.5e6,
                                                            .GJ = 272.7e3,
                                                            .rotary_inertia = 13.17e-3}},
                                 n),
                       "tube")),
        disk(model.add(Rigid<>(70.573, Vec3(2.0325024, 1.03095393, 1.03095393).asDiagonal().toDenseMatrix(),
                               Placement::at({3, 0, 0.05})),
                       "disk")) {
    auto const ground = model.ground().at({0, 0, 0});
    model.connect(hinge(Vec3::UnitX()), ground, tube.at(0.0), "R");
    model.connect(drive(Vec3::UnitX(), {shaft_speed, {0.5, 1.0, 1.25}}), ground, tube.at(0.0), "motor");
    model.connect(Fixed{}, tube.at(3.0), disk.at(Vec3(0, 0, -0.05)), "hub");
    model.connect(Sleeve{Cylindrical{.axis = Vec3::UnitX()}, {}}, model.ground().at({6, 0, 0}), tube.at(6.0), "T");
    x = model.reference_state();
    equilibrium(model, x);
  }
  Shaft(Shaft const&) = delete;
};

/// \param whirl tolerances of u_y and u_z until 0.5, 1.1, 1.5 and 2.25 s [m]
template <class B>
void shaft_whirls(Mesh<B> const& mesh, Index n, double h, std::array<double, 4> const& whirl) {
  Shaft<B> m(mesh, n);
  std::string const name = mesh.name + ", " + std::to_string(n) +
                           " elements, generalised-α, h = " + std::to_string(int(std::round(h * 1e6))) + " µs";
  for (ShaftRow const& row : shaft_table) {
    simulate(m.model, m.x, GeneralisedAlpha{.rho_inf = 0.9}, {.end_time = row.t, .step = h}).run();
    double const off = whirl[row.t < 0.55 ? 0 : row.t < 1.15 ? 1 : row.t < 1.55 ? 2 : 3];
    Vec3 const mid = position(m.model, m.x, m.tube.at(3.0));
    Instance const at{equals("t", row.t), 0.27};
    held(spectral("M3", "u_y of the middle [m]", name), mid[1], row.u_y, off, at);
    held(spectral("M3", "u_z of the middle [m]", name), mid[2], row.u_z, off, at);
    held(spectral("M3", "axial displacement of T [m]", name), position(m.model, m.x, m.tube.at(6.0))[0] - 6.0,
         row.moved, 1e-6 + 0.1 * off, {at.at, 0.0292});
    double const psi = shaft_speed(row.t).value;
    held(spectral("M3", "twist at T [rad]", name),
         angle_about(frame(m.model, m.x, m.tube.at(6.0)).A, Vec3::UnitX(), psi) - psi, row.twist, 1e-5 + 0.1 * off,
         {at.at, 0.02});
  }
}

}  // namespace polybody::long_cases
