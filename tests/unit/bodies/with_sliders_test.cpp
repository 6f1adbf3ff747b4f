#include <polybody/bodies/shared/with_sliders.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/system/system.hpp>
#include <polybody/testing/differences.hpp>

#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace sliding_test {

Bar bar(bool planar) {
  return {
      .length = 1.5,
      .constants =
          BarConstants{.EA = 400.0, .EI = 3.0, .mass_per_length = 0.7, .GA = 150.0, .GJ = 2.0, .rotary_inertia = 0.02},
      .placement = planar ? Placement::planar(0.4, -0.3, 0.7) : Placement::at({0.4, -0.3, 0.2}, {0.5, 0.2, -0.7})};
}

template <class T>
std::span<T const> span_of(std::vector<T> const& x) {
  return x;
}

/// Body of three elements with two sliders in an arbitrary deformation, and its slider in the middle element.
template <class B>
struct Bent {
  using D = Dual<1>;
  static constexpr bool planar = B::world == World::plane;
  WithSliders<B> body{B::from(bar(planar), 3), {0.2, 0.9}};
  typename WithSliders<B>::Point slider = body.at(Slider{1});
  std::size_t n = std::size_t(body.velocities());
  std::vector<double> q = std::vector<double>(n), v = q;

  Bent() {
    Numbers number;
    body.reference(q);
    for (std::size_t i = 0; i < n; ++i) {
      if (i < n - 2) q[i] += number(0.2);
      v[i] = number(2.0);
    }
  }
  /// Marker kinematics at q + ε dq with the velocities v; `jacobian` receives J.
  template <class T>
  MarkerKinematics<T> at(std::vector<T> const& place, std::vector<T>& jacobian) const {
    jacobian.assign(6 * n, T(0.0));
    MarkerKinematics<T> p;
    p.jacobian = jacobian.data();
    std::vector<T> velocities(v.begin(), v.end());
    body.template evaluate_marker<T>(slider, Mat3::Identity(), span_of(place), span_of(velocities), p);
    return p;
  }
  MarkerKinematics<D> along(std::vector<double> const& direction, std::vector<D>& jacobian) const {
    std::vector<D> place;
    for (std::size_t i = 0; i < n; ++i) {
      place.push_back(D(q[i]));
      place.back().d[0] = direction[i];
    }
    return at<D>(place, jacobian);
  }
};

template <class B>
struct SlidingLaws : testing::Test, Bent<B> {};
using Lines = testing::Types<planar::AncfCable<>, AncfCable<>, AncfBeam<>>;
TYPED_TEST_SUITE(SlidingLaws, Lines);

// J is the derivative of r by every coordinate including s, ṙ = J v, and the bias is J̇ v. All are compared with dual
// numbers.
TYPED_TEST(SlidingLaws, JacobianVelocityAndBiasAreTheDerivativesOfThePlace) {
  using D = Dual<1>;
  std::vector<double> jacobian;
  MarkerKinematics<double> const p = this->at(this->q, jacobian);
  std::vector<D> moved_jacobian;
  for (std::size_t i = 0; i < this->n; ++i) {
    std::vector<double> direction(this->n, 0.0);
    direction[i] = 1.0;
    MarkerKinematics<D> const by = this->along(direction, moved_jacobian);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(by.frame.r[k].d[0], jacobian[6 * i + std::size_t(k)], 1e-13) << i;
  }
  MarkerKinematics<D> const by_time = this->along(this->v, moved_jacobian);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(by_time.frame.r[Index(k)].d[0], p.frame.v[Index(k)], 1e-12);
    double bias = 0.0;
    for (std::size_t i = 0; i < this->n; ++i) bias += moved_jacobian[6 * i + k].d[0] * this->v[i];
    EXPECT_NEAR(p.bias[Index(k)], bias, 1e-11 * (1.0 + std::abs(bias)));
  }
  EXPECT_GT(p.bias.norm(), 0.1);
}

TYPED_TEST(SlidingLaws, LoadStiffnessIsTheDerivativeOfTheForce) {
  using D = Dual<1>;
  Wrench<double> const w{.f = {1.0, -2.0, TestFixture::planar ? 0.0 : 3.0}};
  MatX k(Index(this->n), Index(this->n));
  this->body.load_stiffness(this->slider, span_of(this->q), w, k);
  std::vector<D> jacobian;
  for (std::size_t j = 0; j < this->n; ++j) {
    std::vector<double> direction(this->n, 0.0);
    direction[j] = 1.0;
    this->along(direction, jacobian);
    for (std::size_t i = 0; i < this->n; ++i) {
      double slope = 0.0;
      for (std::size_t c = 0; c < 3; ++c) slope += jacobian[6 * i + c].d[0] * w.f[Index(c)];
      EXPECT_NEAR(k(Index(i), Index(j)), slope, 1e-12);
    }
  }
}

// At a node both adjacent elements give the same axis, slope and contribution to the force.
TYPED_TEST(SlidingLaws, PassesNodesWithoutACorner) {
  double const node = this->body.element_length();
  std::vector<double> before, after;
  this->q[this->n - 1] = node - 1e-9;
  MarkerKinematics<double> const a = this->at(this->q, before);
  this->q[this->n - 1] = node + 1e-9;
  MarkerKinematics<double> const b = this->at(this->q, after);
  EXPECT_LT((a.frame.r - b.frame.r).norm(), 1e-8);
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(before[i], after[i], 1e-6) << i;
}

// A slider at rest is the material point at its position. Material points are unaffected.
TYPED_TEST(SlidingLaws, StandingStillIsAMaterialPoint) {
  this->v[this->n - 1] = 0.0;
  std::vector<double> of_slider, of_point(6 * this->n);
  MarkerKinematics<double> const s = this->at(this->q, of_slider);
  MarkerKinematics<double> p;
  p.jacobian = of_point.data();
  auto const point = this->body.at(0.9);
  this->body.template evaluate_marker<double>(point, Mat3::Identity(), span_of(this->q), span_of(this->v), p);
  EXPECT_EQ(point_columns(this->body, point), TypeParam::point_columns);
  EXPECT_EQ(p.columns, TypeParam::point_columns);
  EXPECT_LT((s.frame.r - p.frame.r).norm() + (s.frame.v - p.frame.v).norm(), 1e-14);
  std::size_t const first = std::size_t(this->body.first_column(point));
  for (std::size_t i = 0; i < std::size_t(p.columns); ++i)
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(of_slider[6 * (first + i) + c], of_point[6 * i + c], 1e-14);
}

TEST(WithSliders, RefusesPlacesAndSlidersThatItHasNot) {
  auto const line = AncfCable<>::from(bar(false), 3);
  EXPECT_TRUE(has(refusal([&] { WithSliders(line, {0.1, 1.6}); }),
                  "WithSliders: the position: s = 1.6 m lies outside the body"));
  WithSliders const body(line, {0.1});
  EXPECT_TRUE(has(refusal([&] { (void)body.at(Slider{1}); }), "slider 1 does not exist; the body has 1"));
}

// The line continues for one element beyond its ends, and an error follows beyond that.
TEST(WithSliders, SaysThatAPointHasGoneOffTheEnd) {
  Bent<AncfCable<>> bent;
  std::vector<double> jacobian;
  bent.q[bent.n - 1] = 1.5 + 0.49;
  EXPECT_NO_THROW(bent.at(bent.q, jacobian));
  bent.q[bent.n - 1] = 1.5 + 0.51;
  EXPECT_TRUE(has(message_of<SliderOutOfRange>([&] { bent.at(bent.q, jacobian); }),
                  "a slider is more than one element length beyond the end of the body: s = 2.01"));
  bent.q[bent.n - 1] = -0.51;
  EXPECT_THROW(bent.at(bent.q, jacobian), SliderOutOfRange);
}

TEST(WithSliders, GivesItsPointsNoAxes) {
  using Ball = Joint<Spherical, Constraint>;
  using Pin = Joint<Revolute, Constraint>;
  Model<Bodies<WithSliders<AncfBeam<>>>, Joints<Ball, Pin>> model;
  auto const beam = model.add(WithSliders(AncfBeam<>::from(bar(false), 3), {0.1}), "beam");
  auto const ground = model.ground().at({0, 0, 0});
  EXPECT_NO_THROW(model.connect(Ball{}, ground, beam.at(Slider{}), "ball"));
  EXPECT_NO_THROW(model.connect(Pin{{.axis = Vec3::UnitZ()}, {}}, ground, beam.at(0.0), "pin at the end"));
  EXPECT_TRUE(has(refusal([&] { model.connect(Pin{{.axis = Vec3::UnitZ()}, {}}, ground, beam.at(Slider{}), "pin"); }),
                  "\"pin\" needs axes, but a sliding point"));
}

static_assert(Body<WithSliders<AncfCable<>>> && Body<WithSliders<planar::AncfCable<>>>);

}  // namespace sliding_test
