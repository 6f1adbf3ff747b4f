#include <polybody/bodies/shared/body.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/testing/differences.hpp>
#include <vector>

namespace polybody {
using namespace laws;
namespace body_test {

static_assert(Body<Rigid<>> && Body<Rigid<UnitQuaternion>>);
static_assert(Body<planar::Rigid> && Body<planar::Lrvf>);
static_assert(Body<planar::AncfCable<>> && Body<planar::AncfCable<planar::GreenStrain>>);
static_assert(Body<planar::AncfCable<planar::EngineeringStrain>>);

static_assert(!Body<int> && !Body<Bar> && !Body<MarkerKinematics<double>> && !Body<planar::SimoVuQuoc>);

// A type that lacks any required member is not a body.
struct Weightless : planar::Rigid {
  void gravity() = delete;
};
struct Unmoved : planar::Rigid {
  void plus() = delete;
};
struct Unseen : planar::Rigid {
  void evaluate_marker() = delete;
};
struct Nowhere : planar::Rigid {
  struct world;
};
static_assert(!Body<Weightless> && !Body<Unmoved> && !Body<Unseen> && !Body<Nowhere>);

static_assert(Rigid<>::world == World::space && planar::Rigid::world == World::plane);
static_assert(planar::Lrvf::world == World::plane && planar::AncfCable<>::world == World::plane);

TEST(Part, IsAWindowIntoTheNumbers) {
  std::vector<double> x{0, 1, 2, 3, 4, 5};
  EXPECT_EQ((part<3>(std::span<double const>(x), 2)), Vec3(2, 3, 4));
  part<2>(std::span<double>(x), 3) = Vec2(-1, -2);
  EXPECT_EQ(x, (std::vector<double>{0, 1, 2, -1, -2, 5}));
}

// The default load stiffness of a body without a closed form uses dual numbers. It is compared with finite
// differences of Jᵀw.
TEST(LoadStiffness, ByDualsIsTheDerivativeOfThePulledWrench) {
  Bar const bar{.length = 1.2, .constants = BarConstants{.EA = 900, .EI = 40, .mass_per_length = 2.0}};
  auto const cable = planar::AncfCable<>::from(bar, 3);
  VecX q(16);
  cable.reference(std::span<double>(q.data(), 16));
  for (Index i = 0; i < 16; ++i) q[i] += 0.2 * std::sin(3.0 * double(i));
  auto const p = cable.at(0.55, 0.04);  // in the second element, columns 4 … 11
  Wrench<double> const w{Vec3(3, -2, 7), Vec3(1, 1, 4)};
  Vec6 load;
  load << w.f, w.m;
  auto const pulled = [&](VecX const& at) {
    std::array<double, 48> memory;
    std::array<double, 16> const rest{};
    MarkerKinematics<double> out;
    out.jacobian = memory.data();
    cable.evaluate_marker<double>(p, Mat3::Identity(), std::span<double const>(at.data(), 16), rest, out);
    VecX force(8);
    out.pull(load, force);
    return force;
  };
  Mat<double, 8, 8> k;
  load_stiffness_by_dual_numbers(cable, p, std::span<double const>(q.data(), 16), w, k);
  EXPECT_GT(k.norm(), 1.0);
  for (Index j = 0; j < 8; ++j) {
    VecX const slope = slope_at_zero([&](double h) { return pulled(q + h * VecX::Unit(16, 4 + j)); });
    EXPECT_LT((k.col(j) - slope).norm(), 1e-8 * k.norm()) << j;
  }
}

/// Frame of at(s, y) in the undeformed body.
template <Body B>
Frame<double> reference_frame(B const& body, double s, double y) {
  std::vector<double> q(std::size_t(body.coordinates())), v(std::size_t(body.velocities()));
  body.reference(q);
  std::vector<double> memory(6 * B::point_columns);
  MarkerKinematics<double> out;
  out.jacobian = memory.data();
  body.template evaluate_marker<double>(body.at(s, y), Mat3::Identity(), std::span<double const>(q),
                                        std::span<double const>(v), out);
  return out.frame;
}

// `at` gives the same material point of a bar in all formulations.
TEST(Bodies, AtIsTheSameMaterialPointInAll) {
  Bar const bar{.length = 1.2,
                .section = Rectangle{.height = 0.05, .width = 0.03},
                .material = Material{.density = 7800, .young = 2e11},
                .placement = Placement::planar(2.0, -1.0, 2.2)};
  auto const body = Rigid<>::from(bar);
  auto const flat = planar::Rigid::from(bar);
  auto const beam = planar::Lrvf::from(bar, 5);
  auto const green = planar::AncfCable<>::from(bar, 2);
  auto const engineering = planar::AncfCable<planar::EngineeringStrain>::from(bar, 3);
  for (double const s : {0.0, 0.31, 0.8, 1.2})
    for (double const y : {0.0, -0.02}) {
      Frame<double> const expected = reference_frame(body, s, y);
      for (Frame<double> const& f : {reference_frame(flat, s, y), reference_frame(beam, s, y),
                                     reference_frame(green, s, y), reference_frame(engineering, s, y)}) {
        EXPECT_LT((f.r - expected.r).norm(), 1e-14) << s << ' ' << y;
        EXPECT_LT((f.A - expected.A).norm(), 1e-14) << s << ' ' << y;
      }
    }
}

}  // namespace body_test
}  // namespace polybody
