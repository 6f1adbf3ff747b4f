#include <polybody/bodies/planar/lrvf.hpp>

#include <gtest/gtest.h>

#include "support/flexible_body_laws.hpp"
#include "support/refusal.hpp"

using namespace polybody;

namespace {

struct LrvfCase {
  static Bar bar() {
    return {.length = 1.3,
            .constants = BarConstants{.EA = 900, .EI = 40, .mass_per_length = 2.0, .GA = 300, .rotary_inertia = 0.05},
            .placement = Placement::planar(0.4, -0.3, 0.7),
            .damping = {.axial = 0.01, .shear = 0.02, .bending = 0.03}};
  }
  static planar::Lrvf body(Bar const& bar) { return planar::Lrvf::from(bar, 3); }
};

}  // namespace

namespace polybody {
INSTANTIATE_TYPED_TEST_SUITE_P(Lrvf, BodyLaws, LrvfCase);
INSTANTIATE_TYPED_TEST_SUITE_P(Lrvf, FlexibleBodyLaws, LrvfCase);
}
