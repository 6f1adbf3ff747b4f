#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/compare/formulation.hpp>
#include <polybody/integrators/generalized_alpha.hpp>
#include <polybody/joints/joint.hpp>

#include <gtest/gtest.h>

namespace formulation_test {

using namespace polybody;

template <class P>
concept HasFormulation = requires { typename Formulation<planar::Rigid, P, GeneralizedAlpha>; };
static_assert(HasFormulation<Constraint> && HasFormulation<Penalty>);
static_assert(!HasFormulation<int>);  // not a policy

TEST(Formulation, CarriesTheValuesOfItsChoices) {
  Formulation<planar::Rigid, Penalty, GeneralizedAlpha> const f{
      "stiff", {.stiffness = 1e6, .damping = 10.0}, {.rho_inf = 0.5}};
  EXPECT_EQ(f.name, "stiff");
  EXPECT_DOUBLE_EQ(f.policy.stiffness, 1e6);
  EXPECT_DOUBLE_EQ(f.integrator.rho_inf, 0.5);
}

}  // namespace formulation_test
