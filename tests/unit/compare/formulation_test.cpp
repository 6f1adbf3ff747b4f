#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/compare/compare.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/penalty.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/run/marker_frames.hpp>

#include <gtest/gtest.h>

namespace formulation_test {

using namespace polybody;

template <class P>
concept HasFormulation = requires { typename Formulation<planar::Rigid, P, GeneralisedAlpha>; };
static_assert(HasFormulation<Constraint> && HasFormulation<Penalty>);
static_assert(!HasFormulation<int>);  // not a policy

TEST(Formulation, CarriesTheValuesOfItsChoices) {
  Formulation<planar::Rigid, Penalty, GeneralisedAlpha> const f{
      "stiff", {.stiffness = 1e6, .damping = 10.0}, {.rho_inf = 0.5}};
  EXPECT_EQ(f.name, "stiff");
  EXPECT_DOUBLE_EQ(f.policy.stiffness, 1e6);
  EXPECT_DOUBLE_EQ(f.integrator.rho_inf, 0.5);
}

TEST(Formulation, MakesItsBodyWithTheMeshThatBelongsToIt) {
  Bar const bar{.length = 2.0, .constants = BarConstants{.EA = 1e5, .EI = 5.0, .mass_per_length = 1.0}};
  using Stiff = Formulation<planar::Rigid, Constraint, GeneralisedAlpha>;
  using Coarse = Formulation<Meshed<planar::AncfCable<>, 3>, Constraint, GeneralisedAlpha>;
  using Fine = Formulation<Meshed<planar::AncfCable<>, 12>, Constraint, GeneralisedAlpha>;
  static_assert(std::same_as<Coarse::BodyType, planar::AncfCable<>> && std::same_as<Stiff::BodyType, planar::Rigid>);
  static_assert(std::same_as<decltype(Stiff{}.body(bar)), planar::Rigid>);
  EXPECT_EQ(Coarse{}.body(bar).elements(), 3);
  EXPECT_EQ(Fine{.name = "fine"}.body(bar).elements(), 12);
  EXPECT_EQ(Stiff{}.body(bar).coordinates(), 3);
  // A mesh that is set at run time.
  using Cable = Formulation<planar::AncfCable<>, Constraint, GeneralisedAlpha>;
  EXPECT_EQ(Cable{}.body(bar).elements(), planar::AncfCable<>::default_elements);
  EXPECT_EQ((Cable{.mesh = {.elements = 5}}.body(bar).elements()), 5);
  EXPECT_EQ((Stiff{.mesh = {.elements = 5}}.body(bar).coordinates()), 3);
}

/// Scenario of a rod on a pin that falls from the horizontal. The output is the height of its tip.
struct Fall {
  template <class F>
  auto operator()(F const& choice) const {
    using Rod = typename F::BodyType;
    using Pin = Joint<planar::Revolute, typename F::PolicyType>;
    using M = Model<Bodies<Rod>, Joints<Pin>>;
    M model{Gravity{0, -9.81, 0}};
    auto const rod = model.add(choice.body(bar), "rod");
    model.connect(Pin{planar::Revolute{}, choice.policy}, model.ground().at({0, 0, 0}), rod.at(0.0), "pin");
    State const start = model.reference_state();
    Output<M> const tip{"tip y [m]", [rod](M const& m, State const& x) { return position(m, x, rod.at(1.0))[1]; }};
    return Scenario<M>{std::move(model), start, {.end_time = 0.1, .step = 1e-3}, {tip}};
  }
  Bar bar{.length = 1.0, .constants = BarConstants{.EA = 1.5e5, .EI = 5.0, .mass_per_length = 1.0}};
};

TEST(Formulation, OneAliasIsOneLineOfAComparison) {
  using Ideal = Formulation<planar::Rigid, Constraint, GeneralisedAlpha>;
  using Cable = Formulation<Meshed<planar::AncfCable<>, 4>, Constraint, GeneralisedAlpha>;
  Comparison const c = compare<Ideal, Cable>(Fall{});
  ASSERT_EQ(c.runs.size(), 2u);
  EXPECT_EQ(c.runs[0].problem_size.coordinates, 3);
  EXPECT_EQ(c.runs[1].problem_size.coordinates, 4 * 5);  // two positions and two slopes at each of five nodes
  EXPECT_NEAR(c.runs[0].outputs[0].back(), -0.75 * 9.81 * 0.1 * 0.1, 2e-3);  // ½ (3 g / 2 l) t² l
  EXPECT_LT(c.runs[1].difference[0], 2e-2);                                  // it vibrates at 5.5 Hz
  EXPECT_GT(c.runs[1].difference[0], 1e-6);
}

}  // namespace formulation_test
