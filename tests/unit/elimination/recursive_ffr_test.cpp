// Bodies with a floating frame in trees of joint coordinates, against the same models with multipliers.
#include <gtest/gtest.h>

#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/ffr/planar_ffr.hpp>
#include <polybody/integrators/generalised_alpha.hpp>

#include "support/flexible_trees.hpp"

using namespace polybody;

namespace recursive_ffr_test {

using namespace flexible_trees;

// The frame is tied to the first end: in mean axes the same sums have errors up to 5e-8 in the multipliers.
TEST(RecursiveFfr, TreesInSpaceAccelerateAsMultipliersSay) {
  expect_as_multipliers<InSpace, Ffr, JointCoordinates>("floating frames in space");
}
TEST(RecursiveFfr, TreesInThePlaneAccelerateAsMultipliersSay) {
  expect_as_multipliers<InPlane, planar::Ffr, JointCoordinates>("floating frames in the plane");
}

/// Three bars in a row that fall from the horizontal, each on the flexible end of the previous one.
template <class Policy>
struct Row {
  using Pin = Joint<Spherical, Policy>;
  Model<Bodies<Ffr>, Joints<Pin>> model{Gravity{0, 0, -9.81}};
  std::vector<BodyHandle<Ffr>> links;
  State x;

  Row() {
    for (int i = 0; i < 3; ++i) {
      Bar link = bar;
      link.placement = Placement::at({bar.length * i, 0, 0}, {0, 0, 0});
      links.push_back(
          model.add(Ffr::from(link, 2, {.frame = FfrFrame::clamped, .stiffening = false, .stiffness_damping = 1e-4})));
      if (i == 0)
        model.connect(Pin{}, model.ground().at({0, 0, 0}), links.back().at(0.0));
      else
        model.connect(Pin{}, links[std::size_t(i) - 1].at(bar.length), links.back().at(0.0));
    }
    x = model.reference_state();
    x.v[1] = 0.3;
  }
};

TEST(RecursiveFfr, ImplicitStepsHaveTheirOrder) {
  auto const tip = [](auto policy, auto const& integrator, double h) {
    Row<decltype(policy)> row;
    simulate(row.model, row.x, integrator, {.end_time = 0.1, .step = h}).run();
    return position(row.model, row.x, row.links.back().at(bar.length));
  };
  GeneralisedAlpha const alpha{.rho_inf = 0.6, .tolerance = 1e-9};
  Vec3 const exact = tip(Constraint{}, alpha, 2.5e-5);
  double last = 0.0;
  for (double const h : {1e-3, 5e-4, 2.5e-4, 1.25e-4}) {
    double const off = (tip(JointCoordinates{}, alpha, h) - exact).norm();
    EXPECT_LT(off, 1.5 * (tip(Constraint{}, alpha, h) - exact).norm());
    if (last > 0.0) {
      EXPECT_NEAR(std::log2(last / off), 2.0, 0.3);
    }
    last = off;
  }
  EXPECT_LT(last, 1e-5);
}

}  // namespace recursive_ffr_test
