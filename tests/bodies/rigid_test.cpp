#include <polybody/bodies/rigid.hpp>

#include <gtest/gtest.h>

#include "support/body_laws.hpp"
#include "support/refusal.hpp"

using namespace polybody;

namespace {

struct RigidCase {
  static Bar bar() {
    return {.length = 1.3,
            .constants = BarConstants{.EA = 900, .EI = 40, .mass_per_length = 2.0, .rotary_inertia = 0.05,
                                      .rotary_inertia_y = 0.02},
            .placement = Placement::at({0.4, -0.3, 0.8}, {0.5, -1.0, 0.7})};
  }
  static Rigid<> body(Bar const& bar) { return Rigid<>::from(bar); }
};

}  // namespace

namespace polybody {
INSTANTIATE_TYPED_TEST_SUITE_P(Rigid, BodyLaws, RigidCase);
}
