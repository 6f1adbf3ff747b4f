// Law tests of bodies for the planar floating frame of reference.
#include <polybody/bodies/ffr/planar_ffr.hpp>

#include <polybody/testing/flexible_body_laws.hpp>

namespace polybody {
using namespace laws;
namespace planar_ffr_laws_test {

struct PlanarFfrCase {
  static Bar bar() {
    return {.length = 1.3,
            .constants = BarConstants{.EA = 400.0, .EI = 30.0, .mass_per_length = 0.7, .rotary_inertia = 0.02},
            .placement = Placement::planar(0.4, -0.3, 0.7),
            .damping = {.axial = 0.02, .bending = 0.01}};
  }
  static planar::Ffr body(Bar const& bar) { return planar::Ffr::from(bar, 2, {.stiffening = false}); }
};
struct StiffenedPlanarFfrCase : PlanarFfrCase {
  static constexpr double deformation = 0.2;  // second-order theory
  static planar::Ffr body(Bar const& bar) { return planar::Ffr::from(bar, 2, {.stiffening = true}); }
};

bool const planar_ffr_laws_obey[] = {obeys<PlanarFfrCase, BodyLaws, FlexibleBodyLaws>("PlanarFfr"),
                                     obeys<StiffenedPlanarFfrCase, BodyLaws, FlexibleBodyLaws>("StiffenedPlanarFfr")};

}  // namespace planar_ffr_laws_test
}  // namespace polybody
