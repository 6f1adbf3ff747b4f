#pragma once
// Cantilevers in space: the Princeton beam (case S6) and the 45° bend of Bathe & Bolourchi (case S7).
#include <cmath>
#include <numbers>

#include <polybody/bodies/shared/bar.hpp>

namespace polybody::spatial_cantilevers {

// Beam of Dowell & Traybar 1975, with axis 2 across its stiff direction. The statics do not depend on the inertia.
inline Bar princeton(double mass_per_length = 1.0, double rotary_inertia = 1e-5) {
  double const e = 71.7e9, g = e / 2.62, h = 12.3777e-3, w = 3.2024e-3, a = h * w;
  double const iz = w * h * h * h / 12, iy = h * w * w * w / 12;
  return {.length = 0.508,
          .constants = BarConstants{.EA = e * a,
                                    .EI = e * iz,
                                    .mass_per_length = mass_per_length,
                                    .GA = g * a,
                                    .GJ = 0.198 * g * (iy + iz),
                                    .rotary_inertia = rotary_inertia,
                                    .EI_y = e * iy}};
}

inline constexpr double bend_radius = 100.0;  // [m]

// Bar of the bend, with a section of 1 m x 1 m.
inline Bar bend_bar(double ga, double gj) {
  return {.length = bend_radius * std::numbers::pi / 4,
          .constants = BarConstants{
              .EA = 1e7, .EI = 1e7 / 12, .mass_per_length = 1, .GA = ga, .GJ = gj, .rotary_inertia = 1.0 / 12}};
}
// Placement of the section at arc length s: an arc in the plane z = 0.
inline Placement bend_curve(double s) {
  double const angle = s / bend_radius;
  return Placement::at(bend_radius * Vec3(std::sin(angle), 1 - std::cos(angle), 0), Vec3(0, 0, angle));
}

}  // namespace polybody::spatial_cantilevers
