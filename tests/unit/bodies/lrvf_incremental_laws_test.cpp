// Law tests of all bodies and of flexible bodies for the spatial Lrvf with interpolated increments. Separate tests
// replace the laws that do not apply.

#include <polybody/bodies/lrvf/incremental_interpolation.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>

#include <polybody/testing/flexible_body_laws.hpp>

#include "support/spatial_lrvf.hpp"

namespace polybody {
using namespace laws;
namespace lrvf_incremental_laws_test {

using Beam = Lrvf<Incremental>;
Index const n = 3;

/// Not a case of a bar: the law tests would place markers at sections without a known rotation.
struct Spinning {
  static Bar bar() { return spatial_lrvf_bar(); }
  static Bar at_rest(Bar bar) {
    bar.damping = {};
    return bar;
  }
  static Beam body() { return Beam::from(bar(), n); }
  static Beam undamped() { return Beam::from(at_rest(bar()), n); }
  static Beam elsewhere() {
    Bar moved = bar();
    moved.placement = Placement::at({-7.0, 3.0, 5.0}, {1.0, -0.4, 2.0});
    return Beam::from(moved, n);
  }
  static double mass() { return constants(bar()).mass_per_length * bar().length; }
  static Vec3 centre() { return bar().placement.origin + bar().placement.axes.col(0) * (0.5 * bar().length); }
  static constexpr double stiffness = 940.0;
  static std::vector<Beam::Point> points() {
    double const length = bar().length;
    return {body().at(0.0), body().at(length), body().at(length / 3.0, 0.07),
            body().at(2.0 * length / 3.0, 0.03, -0.05)};
  }
};
struct Elastic : Spinning {
  static Bar bar() { return without_rotary_inertia(spatial_lrvf_bar()); }
  static Beam body() { return Beam::from(bar(), n); }
  static Beam undamped() { return Beam::from(at_rest(bar()), n); }
};
/// Markers on the sections whose rotation the elements store.
struct Middles : Spinning {
  static std::vector<Beam::Point> points() {
    double const length = bar().length;
    return {body().at(0.5 * length), body().at(length / 6.0, 0.07), body().at(5.0 * length / 6.0, 0.03, -0.05)};
  }
};
/// Circular arc, whose elements have its curvature from the start.
struct Curved : Spinning {
  static Beam arc(Bar const& bar) {
    return Beam::from(bar, n, [](double s) {
      return Placement{Vec3(std::sin(s), 1.0 - std::cos(s), 0.0), exp_so3<double>(Vec3(0.0, 0.0, s))};
    });
  }
  static Beam body() { return arc(bar()); }
  static Beam undamped() { return arc(at_rest(bar())); }
  static Vec3 centre() {  // of the polygon through the nodes
    std::vector<double> q(std::size_t(body().coordinates()));
    body().reference(q);
    Vec3 sum = Vec3::Zero();
    for (Index i = 0; i <= n; ++i) sum += Vec3(part<3>(std::span<double const>(q), 7 * i)) / (i % n == 0 ? 2.0 * n : n);
    return sum;
  }
};

bool const spinning = obeys<Spinning, BodyLaws>("IncrementalLrvf");
bool const elastic = obeys<Elastic, FlexibleBodyLaws>("IncrementalLrvf");
bool const curved = obeys<Curved, BodyLaws>("CurvedIncrementalLrvf");

/// All laws of markers except `LocalRateMovesTheBodyWithItsSpeeds`, which requires markers that are functions of the
/// nodes.
template <class Case>
struct MiddleLaws : BodyLaws<Case> {
  static constexpr char const* suite = "MiddleLaws";
  static constexpr Law<MiddleLaws> laws[] = {
      {"FrameIsOrthonormal", &MiddleLaws::frame_is_orthonormal},
      {"TwistIsJacobianTimesSpeeds", &MiddleLaws::twist_is_jacobian_times_velocities},
      {"JacobianIsTheDerivativeOfTheFrame", &MiddleLaws::jacobian_is_the_derivative_of_the_frame},
      {"BiasIsTheAccelerationAtConstantSpeeds", &MiddleLaws::bias_is_the_acceleration_at_constant_velocities},
      {"LoadStiffnessIsTheDerivativeOfThePulledWrench",
       &MiddleLaws::load_stiffness_is_the_derivative_of_the_pulled_wrench},
      {"SpeedsOfTheMiddleWithinAStep", &MiddleLaws::velocities_of_the_middle_within_a_step}};

  /// During the motion q ⊞ δ(t) with δ˙ = `local_rate`(δ, v), the angular velocity of the middle is R_m Jr(δ_m) δ˙_m,
  /// δ_m = ½ (δ₁ + δ₂). It equals the marker's R_m ½ (Ω₁ + Ω₂) at δ = 0 only. By the series of Jr the leading term of
  /// the difference is ⅛ (δ₂ − δ₁) × (Ω₂ − Ω₁).
  void velocities_of_the_middle_within_a_step() {
    VecX const q = this->configuration(), v = this->velocities(), whole = this->vector(this->nv, 0.8);
    double first = 0.0;
    for (double const share : {1e-3, 1.0}) {
      VecX const delta = share * whole, rate = this->rates(delta, v);
      auto const now = this->template moved<double>(q, delta);
      auto const passing = this->template moved<Dual<1>>(q, this->along(delta, rate));
      for (auto const& p : this->points()) {
        auto const seen = this->template see<double>(p, Mat3::Identity(), now, v).marker.frame;
        auto const moving =
            this->template see<Dual<1>>(p, Mat3::Identity(), passing, v.template cast<Dual<1>>()).marker.frame;
        Index const a = 6 * p.element + 3, b = a + 6;
        Vec3 const mean = 0.5 * (delta.segment<3>(a) + delta.segment<3>(b)),
                   spin = right_jacobian<double>(mean) * (0.5 * (rate.segment<3>(a) + rate.segment<3>(b)));
        EXPECT_LT(mismatch(epsilon_of(moving.A), seen.A * skew<double>(spin)), 1e-13);
        Vec3 const off = spin - seen.A.transpose() * seen.w,
                   expected =
                       (delta.segment<3>(b) - delta.segment<3>(a)).cross(v.segment<3>(b) - v.segment<3>(a)) / 8.0;
        first = std::max(first, expected.norm() / share);
        if (share < 1.0) {
          EXPECT_LT((off - expected).norm(), 10.0 * share * share);
        }
      }
    }
    EXPECT_GT(first, 0.1);
  }
};
bool const middles = obeys<Middles, MiddleLaws>("IncrementalLrvf");

using Bodily = BodyLaws<Elastic>;

// The laws about rigid motions of objective bodies do not hold, because a rigid rotation bends an element (see
// below). Forces do work in it, and damping dissipates energy. A translation causes no strain: forces are in
// equilibrium, moments are not.
TEST(IncrementalLrvf, ATranslationIsNotFelt) {
  FlexibleBodyLaws<Elastic> of;
  VecX const q = of.configuration(), v = of.velocities(), shift = of.rigid_velocity(q, of.velocity(), Vec3::Zero());
  VecX const f = of.internal_force(q, v);
  EXPECT_LT(std::abs(f.dot(shift)), 1e-13 * f.norm() * shift.norm());
  EXPECT_LT(of.damping_force(q, shift).norm(), 1e-13 * f.norm());
  VecX const spin = of.rigid_velocity(q, Vec3::Zero(), of.spin());
  EXPECT_GT(std::abs(f.dot(spin)), 1e-3 * f.norm() * spin.norm());
}

// The nodes move rigidly.
TEST(IncrementalLrvf, RigidVelocityIsTheFieldOfARigidMotionAtTheNodes) {
  Bodily of;
  VecX const q = of.configuration();
  Vec3 const v0 = of.velocity(), omega = of.spin();
  VecX const v = of.rigid_velocity(q, v0, omega);
  for (auto const& p : of.points()) {
    auto const f = of.see<double>(p, of.turned(), q, v).marker.frame;
    EXPECT_LT((f.v - v0 - omega.cross(f.r)).norm(), 1e-14);
    EXPECT_LT((f.w - omega).norm(), 1e-14);
  }
}

// R₁, R₂ = R_m exp(∓φ/2): ½ (R₁ᵀ + R₂ᵀ) ω, and (R₂ᵀ − R₁ᵀ) ω plus φ × this vector, for ω across φ.
TEST(IncrementalLrvf, ARigidSpinBendsByTheThirdPowerOfTheAngle) {
  Beam const beam = Beam::from({.length = 1.3, .constants = spatial_lrvf_bar().constants}, 1);
  Bodily const of;
  auto const bending = [&](double phi) {  // rate of l K
    VecX q(beam.coordinates()), v(beam.velocities());
    beam.reference(mutable_view(q));
    VecXOf<Dual<1>> delta = VecXOf<Dual<1>>::Zero(12), next(q.size());
    VecX bend = VecX::Zero(12), bent = q;
    bend[5] = -0.5 * phi;
    bend[11] = 0.5 * phi;
    beam.plus<double>(view(q), view(bend), mutable_view(bent));
    beam.rigid_velocity(view(bent), Vec3::Zero(), Vec3::UnitX(), mutable_view(v));
    for (int i = 0; i < 12; ++i) delta[i].d[0] = v[i];
    beam.plus<Dual<1>>(view(VecXOf<Dual<1>>(bent.cast<Dual<1>>())), view(delta), mutable_view(next));
    Vec3 rate;
    for (int k = 0; k < 3; ++k) rate[k] = next[14 + 4 + k].d[0];
    return rate;
  };
  for (double const phi : {0.1, 0.5, 1.0, 2.0}) {
    double const expected = phi * std::cos(0.5 * phi) - 2.0 * std::sin(0.5 * phi);
    EXPECT_LT((bending(phi) - Vec3(0.0, expected, 0.0)).norm(), 1e-14) << phi;
  }
  EXPECT_NEAR(bending(0.01)[1] / 1e-6, -1.0 / 12.0, 1e-5);
}

TEST(IncrementalLrvf, StandsWhereTheBarIsPlaced) {
  Bodily const of;
  Placement const place = spatial_lrvf_bar().placement;
  VecX const q = of.reference(), rest = VecX::Zero(of.nv);
  for (Index i = 0; i <= 2 * n; ++i) {
    double const s = spatial_lrvf_bar().length * double(i) / double(2 * n);
    auto const f = of.see<double>(of.body.at(s, 0.06), Mat3::Identity(), q, rest).marker.frame;
    EXPECT_LT((f.r - place.origin - place.axes * Vec3(s, 0.06, 0.0)).norm(), 1e-14) << s;
    EXPECT_LT((f.A - place.axes).norm(), 1e-14) << s;
  }
}

TEST(IncrementalLrvf, RefusesMarkersWithoutARotation) {
  Beam const beam = Spinning::body();
  double const l = beam.element_length();
  for (double const s : {0.1 * l, 0.49 * l, 1.51 * l, 2.9 * l, -1e-6, 3.0 * l + 1e-6})
    EXPECT_THROW((void)beam.at(s), InvalidInput) << s;
  for (double const s : {0.0, 0.5 * l * (1.0 + 1e-15), l, 2.5 * l, 3.0 * l * (1.0 + 1e-15)})
    EXPECT_NO_THROW((void)beam.at(s)) << s;
}

}  // namespace lrvf_incremental_laws_test
}  // namespace polybody
