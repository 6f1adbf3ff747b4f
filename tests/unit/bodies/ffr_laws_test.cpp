// Law tests of bodies for the spatial floating frame of reference. The variants are nodal coordinates with and
// without geometric stiffening, modes, mean axes, and a frame of two bars.
#include <polybody/bodies/ffr/ffr.hpp>

#include <polybody/testing/flexible_body_laws.hpp>

namespace polybody {
using namespace laws;
namespace ffr_laws_test {

struct NodalFfrCase {
  static Bar bar() {
    return {.length = 1.3,
            .constants = BarConstants{.EA = 40.0,
                                      .EI = 3.0,
                                      .mass_per_length = 0.7,
                                      .GJ = 2.0,
                                      .rotary_inertia = 0.02,
                                      .EI_y = 5.0,
                                      .rotary_inertia_y = 0.03},
            .placement = Placement::at({0.4, -0.3, 0.2}, {0.3, -0.5, 0.9}),
            .damping = {.axial = 0.02, .shear = 0.03, .bending = 0.01}};
  }
  static Ffr body(Bar const& bar) { return Ffr::from(bar, 2, {.stiffening = false}); }
};
struct StiffenedFfrCase : NodalFfrCase {
  static constexpr double deformation = 0.03;  // second-order theory
  static Ffr body(Bar const& bar) { return Ffr::from(bar, 2, {.stiffening = true}); }
};
// Modes of the free bar. The frame follows the mean motion.
struct MeanAxesFfrCase : StiffenedFfrCase {
  static Ffr body(Bar const& bar) {
    Structure const s = structure_of(bar, 3);
    return Ffr(s, free_interface_modes(s, 5), {.placement = bar.placement, .stiffening = true});
  }
};

bool const ffr_laws_obey[] = {obeys<NodalFfrCase, BodyLaws, FlexibleBodyLaws>("NodalFfr"),
                              obeys<StiffenedFfrCase, BodyLaws, FlexibleBodyLaws>("StiffenedFfr"),
                              obeys<MeanAxesFfrCase, BodyLaws>("MeanAxesFfr")};

}  // namespace ffr_laws_test
}  // namespace polybody
