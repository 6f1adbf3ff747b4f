#pragma once
// M1: flexible four-bar mechanism with a misaligned hinge [Bauchau et al. 2016, Multibody Syst. Dyn. 37, 29–48].
#include "flexible_mechanism.hpp"

namespace polybody::flexible {

/// A at the origin, B (0, 0.12, 0), C (0.24, 0.12, 0), D (0.24, 0, 0). The hinge at C is inclined by 5°.
template <class B>
struct FourBar {
  Mechanism<B> model;
  BodyHandle<B> ab, bc, cd;
  ElementHandle<Hinge> at_a;
  ElementHandle<Drive> crank;
  Vec3 const lean{std::sin(std::numbers::pi / 36.0), 0.0, std::cos(std::numbers::pi / 36.0)};

  /// \param turn angle of the crank about z
  FourBar(Mesh<B> const& mesh, Index n, Turn const& turn)
      : ab(model.add(mesh.make(bar(0.12, thick(), 0.0, 0.0, 0.5), n), "AB")),
        bc(model.add(mesh.make(bar(0.24, thick(), 0.0, 0.12, 0.0), 2 * n), "BC")),
        cd(model.add(mesh.make(bar(0.12, thin(), 0.24, 0.12, -0.5), n), "CD")),
        at_a(model.connect(hinge(Vec3::UnitZ()), model.ground().at({0, 0, 0}), ab.at(0.0), "A")),
        crank(model.connect(drive(Vec3::UnitZ(), turn), model.ground().at({0, 0, 0}), ab.at(0.0), "crank")) {
    model.connect(hinge(Vec3::UnitZ()), ab.at(0.12), bc.at(0.0), "B");
    model.connect(hinge(lean), bc.at(0.24), cd.at(0.0), "C");
    model.connect(hinge(Vec3::UnitZ()), cd.at(0.12), model.ground().at({0.24, 0, 0}), "D");
  }

  static Bar bar(double length, BarConstants const& c, double px, double py, double quarter_turns) {
    return {.length = length, .constants = c, .placement = Placement::planar(px, py, quarter_turns * std::numbers::pi)};
  }
  static BarConstants thick() {
    return {.EA = 52.99e6, .EI = 1131, .mass_per_length = 1.997, .GA = 16.88e6, .GJ = 733.5, .rotary_inertia = 42.6e-6};
  }
  static BarConstants thin() {
    return {
        .EA = 13.25e6, .EI = 70.66, .mass_per_length = 0.4992, .GA = 4.22e6, .GJ = 45.84, .rotary_inertia = 2.662e-6};
  }
};

}  // namespace polybody::flexible
