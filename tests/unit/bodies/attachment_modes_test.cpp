#include <polybody/bodies/ffr/attachment_modes.hpp>
#include <polybody/bodies/ffr/beam_structure.hpp>

#include <gtest/gtest.h>

#include "support/refusal.hpp"

using namespace polybody;

namespace attachment_modes_test {

Structure bar(Index elements = 6) {
  return structure_of(Bar{.length = 1.2,
                          .section = Rectangle{.height = 0.05, .width = 0.03},
                          .material = Material{.density = 7800.0, .young = 2e11, .poisson = 0.3}},
                      elements);
}
MatX unit_loads(Structure const& s, std::vector<Index> const& places) {
  MatX loads = MatX::Zero(s.size(), Index(places.size()));
  for (std::size_t k = 0; k < places.size(); ++k) loads(places[k], Index(k)) = 1.0;
  return loads;
}

/// Static response of the complete free model and of the basis, both with the inertia that balances the load.
TEST(AttachmentModes, AnswerTheirLoadsAsTheWholeModelDoes) {
  Structure const s = bar();
  MatX const loads = unit_loads(s, {0, 2, 20, 4}), basis = attachment_modes(s, loads, 1), rigid = rigid_motions(s),
             m = s.mass_matrix();
  MatX const balanced = loads - m * rigid * (rigid.transpose() * m * rigid).ldlt().solve(rigid.transpose() * loads);
  MatX const answer = basis * (basis.transpose() * s.stiffness * basis).ldlt().solve(basis.transpose() * balanced);
  EXPECT_LT((s.stiffness * answer - balanced).norm(), 1e-7 * balanced.norm());
}

TEST(AttachmentModes, AreOrthogonalInMeanAxes) {
  Structure const s = bar();
  MatX const basis = attachment_modes(s, unit_loads(s, {0, 1, 2, 14, 20, 38}), 4), m = s.mass_matrix();
  ASSERT_EQ(basis.cols(), 10);
  MatX const modal_mass = basis.transpose() * m * basis, k = basis.transpose() * s.stiffness * basis;
  EXPECT_LT((modal_mass - MatX::Identity(10, 10)).norm(), 1e-8);
  MatX const off = k - MatX(k.diagonal().asDiagonal());
  EXPECT_LT(off.norm(), 1e-8 * k.norm());
  EXPECT_LT((rigid_motions(s).transpose() * m * basis).norm(), 1e-8);
  EXPECT_TRUE(std::is_sorted(k.diagonal().begin(), k.diagonal().end()));
}

TEST(AttachmentModes, HoldTheFreeModesThatAreAskedFor) {
  Structure const s = bar();
  MatX const modes = free_interface_modes(s, 4), basis = attachment_modes(s, unit_loads(s, {1, 20}), 4);
  for (Index j = 0; j < 4; ++j) {
    double const omega2 = modes.col(j).dot(s.stiffness * modes.col(j));
    EXPECT_NEAR(basis.col(j).dot(s.stiffness * basis.col(j)) / omega2, 1.0, 1e-8);
  }
}

TEST(AttachmentModes, LeaveOutWhatRepeats) {  // two equal loads; forces at both ends along a free bar, with the inertia
  Structure const s = bar(1);
  EXPECT_EQ(attachment_modes(s, unit_loads(s, {1, 1, 2}), 0).cols(), 2);
}

TEST(AttachmentModes, RefuseWhatDoesNotFit) {
  Structure const s = bar();
  EXPECT_TRUE(has(refusal([&] { attachment_modes(s, MatX::Zero(5, 1), 1); }), "must have 42 rows, but have 5."));
  EXPECT_TRUE(has(refusal([&] { attachment_modes(s, MatX(s.size(), 0), 0); }),
                  "one load or one mode, but there are 0 loads and 0 modes"));
  EXPECT_TRUE(has(refusal([&] { attachment_modes(s, MatX(s.size(), 0), 37); }), "37 modes are requested"));
}

}  // namespace attachment_modes_test
