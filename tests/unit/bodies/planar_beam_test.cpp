#include <polybody/bodies/shared/planar_beam.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <vector>

#include "support/refusal.hpp"

namespace polybody {
namespace planar_beam_test {

// Functions of the beam template that are independent of the beam theory. The theories have their own tests.
template <class B>
struct PlanarBeam : testing::Test {
  static Bar bar() {
    return {.length = 1.2,
            .constants = BarConstants{.EA = 900, .EI = 40, .mass_per_length = 2.0, .GA = 300},
            .placement = Placement::planar(0.4, -0.3, 0.7)};
  }
};
using Beams = testing::Types<planar::Lrvf, planar::AncfCable<>, planar::AncfCable<planar::EngineeringStrain>>;
TYPED_TEST_SUITE(PlanarBeam, Beams);

TYPED_TEST(PlanarBeam, NeighboursShareANode) {
  TypeParam const beam = TypeParam::from(this->bar(), 3);
  int const n = TypeParam::node_columns;
  EXPECT_EQ(beam.elements(), 3);
  EXPECT_EQ(beam.coordinates(), 4 * n);
  EXPECT_EQ(beam.velocities(), 4 * n);
  for (Index e = 0; e < 3; ++e) EXPECT_EQ(beam.first_column(e), e * n);
  EXPECT_DOUBLE_EQ(beam.element_length(), 0.4);
  EXPECT_DOUBLE_EQ(beam.length(), 1.2);
  EXPECT_EQ(beam.constants().EA, 900);
}

TYPED_TEST(PlanarBeam, FindsTheElementOfAPoint) {
  TypeParam const beam = TypeParam::from(this->bar(), 3);
  for (double const s : {0.0, 0.1, 0.39, 0.41, 0.9, 1.2}) {
    auto const p = beam.at(s, 0.05);
    EXPECT_NEAR((double(p.element) + p.xi) * 0.4, s, 1e-15);
    EXPECT_EQ(p.y, 0.05);
    EXPECT_GE(p.xi, 0.0);
    EXPECT_LE(p.xi, 1.0 + 1e-15);
  }
  EXPECT_EQ(beam.at(0.41).element, 1);
  EXPECT_EQ(beam.at(1.2).element, 2);  // the end belongs to the last element
  EXPECT_EQ(beam.first_column(beam.at(0.41)), TypeParam::node_columns);
}

// The position of a node is equal from both adjacent elements, also in a deformed beam.
TYPED_TEST(PlanarBeam, IsContinuousAcrossANode) {
  TypeParam const beam = TypeParam::from(this->bar(), 3);
  std::vector<double> q(std::size_t(beam.coordinates())), v(q.size());
  beam.reference(q);
  for (std::size_t i = 0; i < q.size(); ++i) {
    q[i] += 0.1 * std::sin(3.0 * double(i));
    v[i] = std::cos(2.0 * double(i));
  }
  using Span = std::span<double const>;
  auto const left = beam.template centre_line<double>({0, 1.0, 0.0}, Span(q), Span(v));
  auto const right = beam.template centre_line<double>({1, 0.0, 0.0}, Span(q), Span(v));
  EXPECT_LT((left.r - right.r).norm() + (left.v - right.v).norm(), 1e-15);
  EXPECT_NEAR(left.angle, right.angle, 1e-15);
  EXPECT_NEAR(left.rate, right.rate, 1e-14);
}

// centre_line and publish agree.
TYPED_TEST(PlanarBeam, CentreLineIsWhatAMarkerPublishes) {
  TypeParam const beam = TypeParam::from(this->bar(), 3);
  std::vector<double> q(std::size_t(beam.coordinates())), v(q.size());
  beam.reference(q);
  for (std::size_t i = 0; i < q.size(); ++i) {
    q[i] += 0.1 * std::sin(3.0 * double(i));
    v[i] = std::cos(2.0 * double(i));
  }
  std::array<double, 48> memory;
  MarkerKinematics<double> out;
  out.jacobian = memory.data();
  using Span = std::span<double const>;
  auto const p = beam.at(0.7);
  beam.template evaluate_marker<double>(p, Mat3::Identity(), Span(q), Span(v), out);
  auto const c = beam.template centre_line<double>(p, Span(q), Span(v));
  EXPECT_LT((out.frame.r.template head<2>() - c.r).norm(), 1e-15);
  EXPECT_LT((out.frame.v.template head<2>() - c.v).norm(), 1e-15);
  EXPECT_NEAR(std::atan2(out.frame.A(1, 0), out.frame.A(0, 0)), c.angle, 1e-15);
  EXPECT_DOUBLE_EQ(out.frame.w[2], c.rate);
  EXPECT_DOUBLE_EQ(out.bias[5], c.rate_bias);
}

// The mass is independent of the mesh.
TYPED_TEST(PlanarBeam, KeepsItsMassWhateverTheMesh) {
  for (Index const n : {1, 2, 7}) {
    TypeParam const beam = TypeParam::from(this->bar(), n);
    std::vector<double> q(std::size_t(beam.coordinates())), v(q.size());
    beam.reference(q);
    beam.rigid_velocity(q, Vec3(3.0, 4.0, 0.0), Vec3::Zero(), v);
    double energy = 0.0;
    for (Index e = 0; e < n; ++e) energy += beam.kinetic_energy(e, q, v);
    EXPECT_NEAR(energy, 0.5 * 2.0 * 1.2 * 25.0, 1e-12) << n;
  }
}

TYPED_TEST(PlanarBeam, RefusesToHaveNoElement) {
  for (Index const n : {0, -1})
    EXPECT_TRUE(has(refusal([&] { (void)TypeParam::from(this->bar(), n); }), "at least one element"));
}

TYPED_TEST(PlanarBeam, RefusesToLeaveThePlane) {
  for (Placement const& p : {Placement::at({0, 0, 0.1}), Placement::at({0, 0, 0}, {0.1, 0, 0})}) {
    Bar bar = this->bar();
    bar.placement = p;
    EXPECT_TRUE(has(refusal([&] { (void)TypeParam::from(bar, 2); }), "a planar body must lie in the plane"));
  }
}

TYPED_TEST(PlanarBeam, RefusesABadBar) {
  Bar bar = this->bar();
  bar.constants->EI = -1.0;
  EXPECT_TRUE(has(refusal([&] { (void)TypeParam::from(bar, 2); }), "EI"));
}

TYPED_TEST(PlanarBeam, RefusesPointsThatAreNone) {
  TypeParam const beam = TypeParam::from(this->bar(), 3);
  EXPECT_TRUE(has(refusal([&] { (void)beam.at(1.3); }), "outside the body"));
  EXPECT_TRUE(has(refusal([&] { (void)beam.at(0.5, std::nan("")); }), "y of a point"));
}

}  // namespace planar_beam_test
}  // namespace polybody
