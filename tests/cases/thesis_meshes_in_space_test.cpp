// The two meshes of beams in space: a helix, and a curved bar under a force across its plane.
#include <gtest/gtest.h>

#include "../../examples/chapter2_space.hpp"
#include "support/held.hpp"

namespace thesis_meshes_in_space_test {

using namespace chapter2;

Claim closed(char const* what, char const* source, char const* formulation) {
  return {"thesis, ch. 2", what, By::closed_form, source, formulation};
}

/// The whole distance of the two meshes of Se3Beam is due to the strains.
template <class B>
void only_strains(SpatialBeam<B> const& beam, char const* formulation) {
  Gap<3> const a = beam.gap();
  double const whole = beam.beam.body().length();
  held_within(closed("part of the interpolation in the distance of the two meshes, of the length",
                     "r' = R (e1 + Gamma) with constant Gamma", formulation),
              a.interpolation_of_all / whole, 1e-12, {.scale = 1.0});
  EXPECT_NEAR(a.strain.norm(), a.gap, 1e-12 * whole);
}

// The forces are zero, and the rotations at the nodes are exact. The chords of the position mesh of Lrvf are longer
// than those of the helix in the plane across its axis, by 1/s with s = sin(w l/2)/(w l/2). A chord of the helix has
// the projection 2 kappa/w^2 sin(w x/2) on this plane.
TEST(ThesisMeshesInSpace, HelixUnderMomentAndTorque) {
  SpatialBeam<Se3Beam> const one = helix<Se3Beam>(10);
  only_strains(one, "Se3Beam, helix, 10 elements");
  EXPECT_LT(one.gap().gap, 1e-11);
  double const w = helix_turn.norm() / length, kappa = helix_turn[2] / length;
  for (Index const n : {10, 20}) {
    double const l = length / double(n), s = std::sin(0.5 * w * l) / (0.5 * w * l);
    double chord = 0.0;
    for (Index i = 1; i <= n; ++i)
      chord = std::max(chord, std::abs(2.0 * kappa / (w * w) * std::sin(0.5 * w * l * double(i))));
    Gap<3> const a = helix<Lrvf<>>(n).gap();
    held(closed("largest gap of the meshes of a helix [m]", "(1/s - 1) chord", "Lrvf, moment and torque"), a.gap,
         (1.0 / s - 1.0) * chord, 1e-9, {.at = equals("elements", double(n))});
    EXPECT_LT(a.strain.norm(), 1e-10);
  }
}

TEST(ThesisMeshesInSpace, BendUnderAForceAcrossItsPlane) {
  SpatialBeam<Se3Beam> const one = bend<Se3Beam>(8);
  only_strains(one, "Se3Beam, 45° bend, 8 elements");
  EXPECT_GT(one.gap().gap, 1e-3);
  double const coarse = bend<Lrvf<>>(16).gap().interpolation_of_all, fine = bend<Lrvf<>>(32).gap().interpolation_of_all;
  EXPECT_GT(fine, 1e-4);
  held(closed("order of the interpolation part of the distance", "sum of l phi^2/24",
              "Lrvf, 45° bend, 16 and 32 elements"),
       std::log2(coarse / fine), 2.0, 0.05);
}

}  // namespace thesis_meshes_in_space_test
