#pragma once
// M2: lateral buckling of a beam that a crank drives through a link [Bauchau et al. 2016, Multibody Syst. Dyn. 37,
// 29–48].
#include <algorithm>
#include <cmath>

#include "flexible_mechanism.hpp"

namespace polybody::flexible {

/// The beam is clamped at the origin along x. Link and crank are at the distance d from it.
template <class B>
struct BucklingBeam {
  static constexpr double d = 1e-4, duration = 0.4;
  Mechanism<B> model;
  BodyHandle<B> beam, link, crank;

  /// \param n elements of the beam \param of_link elements of the link \param of_crank elements of the crank
  BucklingBeam(Mesh<B> const& mesh, Index n, Index of_link = 4, Index of_crank = 2)
      : beam(model.add(mesh.make({.length = 1.0, .constants = of_beam()}, n), "beam")),
        link(model.add(mesh.make({.length = 0.25,
                                  .constants = round_bar(33.02e6, 10.81e6, 914.5, 1189, 1.212, 43.65e-6),
                                  .placement = Placement::at({1, d, 0}, {0, 0.5 * std::numbers::pi, 0})},
                                 of_link),
                       "link")),
        crank(model.add(mesh.make({.length = 0.05,
                                   .constants = round_bar(132.1e6, 43.22e6, 14630, 19020, 4.85, 698.3e-6),
                                   .placement = Placement::at({0.95, d, -0.25})},
                                  of_crank),
                        "crank")) {
    auto const g = model.ground().at({0.95, d, -0.25});
    model.connect(Fixed{}, model.ground().at({0, 0, 0}), beam.at(0.0), "R");
    model.connect(Ball{}, beam.at(1.0, d), link.at(0.0), "C");
    model.connect(hinge(Vec3::UnitY()), link.at(0.25), crank.at(0.05), "B");
    model.connect(hinge(Vec3::UnitY()), g, crank.at(0.0), "G");
    model.connect(drive(Vec3::UnitY(),
                        {[](double t) {
                           double const pi = std::numbers::pi, p = pi / duration, s = std::min(t, duration);
                           double const rest = t < duration ? 1.0 : 0.0;
                           return Motion{-0.5 * pi * (1.0 - std::cos(p * s)), -0.5 * pi * p * std::sin(p * s) * rest,
                                         -0.5 * pi * p * p * std::cos(p * s) * rest};
                         },
                         {duration}}),
                  g, crank.at(0.0), "drive");
  }

  static BarConstants of_beam() {
    return {.EA = 73e6,
            .EI = 608.3,
            .mass_per_length = 2.68,
            .GA = 5.025e6,
            .GJ = 877.2,
            .rotary_inertia = 22.33e-6,
            .EI_y = 60830.0,
            .GA_z = 23.40e6,
            .rotary_inertia_y = 2233e-6};
  }
  static BarConstants round_bar(double ea, double ga, double gj, double ei, double mass, double rotary) {
    return {.EA = ea, .EI = ei, .mass_per_length = mass, .GA = ga, .GJ = gj, .rotary_inertia = rotary};
  }
};

}  // namespace polybody::flexible
