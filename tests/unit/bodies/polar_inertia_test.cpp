// Section whose polar inertia is not the sum of the other two inertias.
#include <gtest/gtest.h>

#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/bodies/ffr/beam_structure.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/vibration/modes.hpp>

#include "support/refusal.hpp"

using namespace polybody;

namespace polar_inertia_test {

Bar bar_with(std::optional<double> polar) {
  return {.length = 2.0,
          .constants = BarConstants{.EA = 1e6,
                                    .EI = 1e4,
                                    .mass_per_length = 2.0,
                                    .GA = 1e6,
                                    .GJ = 1.0,
                                    .rotary_inertia = 0.05,
                                    .rotary_inertia_y = 0.03,
                                    .polar_inertia = polar}};
}

TEST(PolarInertia, OfARigidBarStandsAlone) {
  Mat3 const sum = Rigid<>::from(bar_with({})).inertia(), own = Rigid<>::from(bar_with(0.3)).inertia();
  EXPECT_DOUBLE_EQ(sum(0, 0), 2.0 * 0.08);
  EXPECT_DOUBLE_EQ(own(0, 0), 2.0 * 0.3);
  EXPECT_EQ(own(1, 1), sum(1, 1));
  EXPECT_EQ(own(2, 2), sum(2, 2));
}

// A clamped bar of n elements in torsion is equivalent to n discs on n springs GJ/h, with half a disc at the end: ω =
// (2/h) √(GJ/Iρ) sin(π/4n), h = L/n.
TEST(PolarInertia, SetsTheTorsionalFrequency) {
  Index const n = 8;
  double const h = 2.0 / double(n);
  for (std::optional<double> const polar : {std::optional<double>(), std::optional<double>(0.5)}) {
    Model<Bodies<Lrvf<>>, Joints<Joint<Weld, Constraint>>> model;
    auto const bar = model.add(Lrvf<>::from(bar_with(polar), n), "bar");
    model.connect(Joint<Weld, Constraint>{}, model.ground().at({0, 0, 0}), bar.at(0.0), "clamp");
    double const expected =
        2.0 / h * std::sqrt(1.0 / polar.value_or(0.08)) * std::sin(0.25 * std::numbers::pi / double(n));
    EXPECT_NEAR(modes(model, model.reference_state(), 1).frequency[0], expected, 1e-9 * expected);
  }
}

TEST(PolarInertia, IsRefusedWhereMassStandsInPoints) {
  EXPECT_NO_THROW(AncfBeam<>::from(bar_with({}), 2));
  EXPECT_NO_THROW(AncfBeam<>::from(bar_with(0.08), 2));
  EXPECT_TRUE(has(refusal([] { AncfBeam<>::from(bar_with(0.3), 2); }), "the polar inertia is 0.3 kg m"));
  EXPECT_NO_THROW(structure_of(bar_with(0.08), 2));
  EXPECT_TRUE(has(refusal([] { structure_of(bar_with(0.3), 2); }), "use Lrvf or Rigid"));
  EXPECT_TRUE(has(refusal([] { Lrvf<>::from(bar_with(-1.0), 2); }), "polar_inertia"));
}

}  // namespace polar_inertia_test
