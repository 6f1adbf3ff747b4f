// Sections given by matrices: laws of the bodies that accept couplings, offsets and sections along the bar; refusals.

#include <polybody/bodies/lrvf/director_interpolation.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/lrvf/polar_interpolation.hpp>
#include <polybody/bodies/se3/se3_beam.hpp>

#include <polybody/testing/flexible_body_laws.hpp>

#include "support/measured_sections.hpp"
#include "support/refusal.hpp"
#include "support/spatial_lrvf.hpp"

namespace polybody {
using namespace laws;
namespace section6_test {

/// Coupled section beside the axis of the bar, which rotates and moves along the bar, with six damping times.
Bar measured_bar() {
  Bar bar = spatial_lrvf_bar();
  bar.section = [](double s) {
    Section6 section = composite().in_units(0.05, 0.02).placed(0.02 + 0.01 * s, -0.03, 0.4 * s);
    section.damping_times << 1e-3, 4e-3, 2e-3, 7e-3, 3e-3, 5e-3;
    return section;
  };
  bar.constants = {};
  bar.pretension = 20.0;
  return bar;
}
template <class B>
struct Case {
  static Bar bar() { return measured_bar(); }
  static B body(Bar const& bar) { return B::from(bar, 3); }
};
template <class B>
struct MeasuredBeam : testing::Test, BodyLaws<Case<B>> {};
using Bodies = testing::Types<Se3Beam, Lrvf<>, Lrvf<Polar>, Lrvf<Directors, FullQuadrature>>;
TYPED_TEST_SUITE(MeasuredBeam, Bodies);

TYPED_TEST(MeasuredBeam, ForceIsTheGradientOfTheEnergyAndTheTangentThatOfTheForce) {
  this->elastic_force_is_the_gradient_of_the_strain_energy();
  this->tangent_is_the_derivative_of_the_force_by_position();
  this->tangent_is_the_derivative_of_the_force_by_speed();
  this->weight_is_the_gradient_of_its_energy();
}
TYPED_TEST(MeasuredBeam, MarkersMoveWithTheSections) {
  this->rigid_velocity_is_the_field_of_a_rigid_motion();
  this->twist_is_jacobian_times_velocities();
  this->jacobian_is_the_derivative_of_the_frame();
  this->bias_is_the_acceleration_at_constant_velocities();
  this->load_stiffness_is_the_derivative_of_the_pulled_wrench();
}

TEST(Section6, BadMatricesAreRefused) {
  auto const refused = [](Section6 const& section, char const* text) {
    Bar const bar{.length = 1.0, .section = section};
    EXPECT_TRUE(has(refusal([&] { Se3Beam::from(bar, 2); }), text));
  };
  Section6 s = composite();
  s.stiffness(3, 4) *= 1.01;
  refused(s, "(4, 5)");
  s = composite();
  s.stiffness(3, 4) = s.stiffness(4, 3) = 40e3;  // 40² > 16.96 · 59.12
  refused(s, "M_y");
  s = composite();
  s.mass(1, 1) *= 1.001;
  refused(s, "[m 1, -m c~; m c~, J]");
  s = composite();
  s.mass(0, 5) = s.mass(5, 0) = -0.05;
  s.mass(1, 5) = s.mass(5, 1) = 0.0;
  refused(s, "centre of mass");
  s = composite().placed(0.4, 0.0);
  s.mass(5, 5) = 1e-3;  // less than m y²
  refused(s, "axis z");
  s = composite();
  s.damping_times[3] = -1.0;
  refused(s, "damping time of M_x");
  s = composite();
  s.stiffness(0, 0) = std::nan("");
  refused(s, "entry (1, 1)");
}

TEST(Section6, OtherBodiesAcceptItWithoutCouplings) {
  Bar const plain{.length = 1.0, .section = uncoupled()}, coupled{.length = 1.0, .section = composite()};
  EXPECT_EQ(constants(plain).EI_y, 1500.0);
  EXPECT_EQ(constants(plain).polar_inertia, 5e-3);
  EXPECT_TRUE(has(refusal([&] { (void)constants(coupled); }), "couples strains"));
  Bar const along{.length = 1.0, .section = [](double) { return uncoupled(); }};
  EXPECT_TRUE(has(refusal([&] { (void)constants(along); }), "function of the arc length"));
  EXPECT_TRUE(has(refusal([&] { (void)constants({.length = 1.0, .section = uncoupled().placed(0.1, 0.0)}); }),
                  "couples strains"));
  EXPECT_TRUE(
      has(refusal([&] { (void)constants({.length = 1.0, .section = uncoupled(), .material = Material{1, 1}}); }),
          "not two of these"));
}

TEST(Section6, CouplingsNeedEqualWeightsInLrvf) {
  Bar const bar{.length = 1.0, .section = composite()};
  EXPECT_TRUE(has(refusal([&] { Lrvf<RelativeRotation, SelectiveQuadrature>::from(bar, 2); }), "equal weights"));
  EXPECT_NO_THROW((Lrvf<RelativeRotation, FullQuadrature>::from(bar, 2)));
}
TEST(Section6, AnEmptyFunctionIsRefused) {
  Bar const bar{.length = 1.0, .section = SectionAlong{}};
  EXPECT_TRUE(has(refusal([&] { Se3Beam::from(bar, 2); }), "empty function"));
  EXPECT_TRUE(has(refusal([&] { (void)constants(bar); }), "function of the arc length"));
}

}  // namespace section6_test
}  // namespace polybody
