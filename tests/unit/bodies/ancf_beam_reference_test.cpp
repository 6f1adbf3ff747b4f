// Curved reference configurations, pretension, SIMD batches of elements, and refused bars.

#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/bodies/shared/element_batches.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/differences.hpp>

#include <random>

#include "support/refusal.hpp"

namespace polybody {
using namespace laws;
namespace ancf_beam_reference_test {

static_assert(IdenticalElements<AncfBeam<>> && IdenticalElements<AncfBeam<Continuum<>>>);

template <class V>
auto as_span(V const& x) {
  return std::span<typename V::Scalar const>(x.data(), std::size_t(x.size()));
}
std::span<double> mutable_view(VecX& x) { return {x.data(), std::size_t(x.size())}; }

double const radius = 2.0, twist = 0.4;  // [m], [rad/m]
/// Arc in the x–y plane whose sections rotate about its tangent.
Placement curve(double s) {
  double const a = s / radius;
  return {radius * Vec3(std::sin(a), 1 - std::cos(a), 0),
          exp_so3<double>(Vec3(0, 0, a)) * exp_so3<double>(Vec3(twist * s, 0, 0))};
}
Bar bar() {
  return {.length = 1.3,
          .section = Rectangle{.height = 0.25, .width = 0.18},
          .material = Material{.density = 45, .young = 2e4, .poisson = 0.3},
          .placement = Placement::at({0.4, -0.3, 0.2}, {0.7, -0.2, 0.5}),
          .damping = {.axial = 0.01, .shear = 0.02, .bending = 0.03}};
}

template <class B>
VecX reference_of(B const& body) {
  VecX q(body.coordinates());
  body.reference(mutable_view(q));
  return q;
}
/// Large random deformation; its number is the seed.
VecX deformed(VecX const& q, unsigned seed) {
  std::mt19937 random{seed};
  std::uniform_real_distribution<double> number(-0.3, 0.3);
  return q + VecX::NullaryExpr(q.size(), [&](Index) { return number(random); });
}
template <class B>
double energy(B const& body, VecX const& q) {
  double sum = 0.0;
  for (Index e = 0; e < body.elements(); ++e) sum += body.strain_energy(e, as_span(q));
  return sum;
}

template <class B>
struct AncfReference : testing::Test {};
using Beams = testing::Types<AncfBeam<>, AncfBeam<Continuum<Locking::present>>, AncfBeam<Continuum<>>>;
TYPED_TEST_SUITE(AncfReference, Beams);

TYPED_TEST(AncfReference, CurvedReferenceStandsOnItsCurveWithoutStress) {
  TypeParam const body = TypeParam::from(bar(), 3, curve);
  VecX const q = reference_of(body), rest = VecX::Zero(q.size());
  Placement const place = bar().placement;
  for (Index i = 0; i <= 3; ++i) {
    Placement const p = curve(1.3 * double(i) / 3);
    EXPECT_LT((q.segment<3>(12 * i) - place.origin - place.axes * p.origin).norm(), 1e-14);
    for (int k = 0; k < 3; ++k)
      EXPECT_LT((q.segment<3>(12 * i + 3 + 3 * k) - place.axes * p.axes.col(k)).norm(), 1e-14);
  }
  for (Index e = 0; e < 3; ++e) {
    Vec<double, 24> f;
    body.template force<double>(e, as_span(q), as_span(rest), f);
    EXPECT_LT(f.norm(), 1e-11);
  }
  EXPECT_LT(energy(body, q), 1e-24);
  EXPECT_LT(body.strain(body.at(0.6, 0.1, -0.05), as_span(q)).norm(), 1e-14);
}

TYPED_TEST(AncfReference, CurvedElementsHaveTheirOwnForceAndTangent) {
  using D = Dual<1>;
  TypeParam const body = TypeParam::from(bar(), 3, curve);
  EXPECT_FALSE(body.alike());
  VecX const q = deformed(reference_of(body), 1), v = deformed(VecX::Zero(q.size()), 2), rest = VecX::Zero(q.size());
  VecXOf<D> const moving = v.cast<D>();
  for (Index e = 0; e < 3; ++e) {
    Mat<double, 24, 24> k;
    body.tangent(e, as_span(q), as_span(v), 1.0, 0.0, k);
    Vec<double, 24> still, slope, column;
    body.template force<double>(e, as_span(q), as_span(rest), still);
    for (int j = 0; j < 24; ++j) {
      VecXOf<D> moved = q.cast<D>();
      moved[12 * e + j].d[0] = 1.0;
      Vec<D, 24> f;
      body.template force<D>(e, as_span(moved), as_span(moving), f);
      for (int i = 0; i < 24; ++i) column[i] = f[i].d[0];
      EXPECT_LT((k.col(j) + column).norm(), 1e-12 * k.norm()) << j;
      slope[j] = slope_at_zero([&](double h) {
        VecX at = q;
        at[12 * e + j] += h;
        return body.strain_energy(e, as_span(at));
      });
    }
    EXPECT_LT((still + slope).norm(), 1e-8 * still.norm());
  }
}

// A straight curve without twist gives the straight bar, through the code of curves.
TYPED_TEST(AncfReference, StraightCurveIsTheStraightBar) {
  TypeParam const straight = TypeParam::from(bar(), 3),
                  curved = TypeParam::from(bar(), 3, [](double s) { return Placement{Vec3(s, 0, 0)}; });
  VecX const q = deformed(reference_of(straight), 3), v = deformed(VecX::Zero(q.size()), 4);
  EXPECT_LT((reference_of(straight) - reference_of(curved)).norm(), 1e-14);
  for (Index e = 0; e < 3; ++e) {
    Vec<double, 24> a, b;
    Mat<double, 24, 24> m, n;
    straight.template force<double>(e, as_span(q), as_span(v), a);
    curved.template force<double>(e, as_span(q), as_span(v), b);
    EXPECT_LT((a - b).norm(), 1e-12 * a.norm());
    straight.mass(e, as_span(q), m);
    curved.mass(e, as_span(q), n);
    EXPECT_LT((m - n).norm(), 1e-13 * m.norm());
  }
}

// A section with its centroid on the axis sweeps the volume A L of the straight bar (Pappus).
TYPED_TEST(AncfReference, CurvedBarHasTheMassOfTheStraightOne) {
  TypeParam const body = TypeParam::from(bar(), 6, curve);
  VecX const q = reference_of(body);
  VecX v(q.size());
  body.rigid_velocity(as_span(q), Vec3(0, 0, 1), Vec3::Zero(), mutable_view(v));
  double energy = 0.0;
  for (Index e = 0; e < 6; ++e) energy += body.kinetic_energy(e, as_span(q), as_span(v));
  EXPECT_NEAR(energy, 0.5 * 45 * 1.3 * 0.25 * 0.18, 1e-13 * energy);
}

// In the reference state the section force is the pretension N along the axis. The ends of the straight bar have the
// force N, and the other forces are zero. If the axis stretches at the rate 1 with constant sections, r˙ = r, the
// power of the force is −N L. (On a curve this holds to the accuracy of the cubic's tangent.)
TYPED_TEST(AncfReference, PretensionIsTheSectionForceOfTheReference) {
  Bar tight = bar();
  tight.pretension = 30.0;
  for (bool const bent : {false, true}) {
    TypeParam const body = bent ? TypeParam::from(tight, 3, curve) : TypeParam::from(tight, 3);
    VecX const q = reference_of(body), rest = VecX::Zero(q.size());
    VecX f = VecX::Zero(q.size()), stretching = f;
    for (Index e = 0; e < 3; ++e) {
      Vec<double, 24> x;
      body.template force<double>(e, as_span(q), as_span(rest), x);
      f.segment<24>(12 * e) += x;
    }
    for (Index i = 0; i < q.size(); i += 12) stretching.segment<6>(i) = q.segment<6>(i);
    EXPECT_NEAR(f.dot(stretching), -30.0 * 1.3, bent ? 1e-3 * 39 : 1e-11);
    if (bent) continue;
    Vec3 const pull = 30.0 * tight.placement.axes.col(0);
    f.head<3>() -= pull;
    f.segment<3>(36) += pull;
    EXPECT_LT(f.norm(), 1e-11);
    EXPECT_NEAR(energy(body, q), 0.5 * 30 * 30 / 900.0 * 1.3, 1e-12);
  }
}

// SIMD vectors of elements and the remaining elements give the results of single elements. Curved elements are
// computed one by one.
TYPED_TEST(AncfReference, BatchesEqualElementsOneByOne) {
  for (bool const bent : {false, true}) {
    Index const n = 7;
    TypeParam const body = bent ? TypeParam::from(bar(), n, curve) : TypeParam::from(bar(), n);
    VecX const q = deformed(reference_of(body), 5), v = deformed(VecX::Zero(q.size()), 6),
               a = deformed(VecX::Zero(q.size()), 7);
    Index next = 0;
    for_each_residual<TypeParam, double>(body, {0, n}, {as_span(q), as_span(v), as_span(a)},
                                         [&](Index e, Vec<double, 24> const& x) {
                                           ASSERT_EQ(e, next++);
                                           Vec<double, 24> inertia, force;
                                           body.template inertia<double>(e, as_span(q), as_span(a), inertia);
                                           body.template force<double>(e, as_span(q), as_span(v), force);
                                           EXPECT_LT((x - (inertia - force)).norm(), 1e-12 * force.norm());
                                         });
    EXPECT_EQ(next, n);
    for_each_element_tangent<TypeParam>(body, {0, n}, {as_span(q), as_span(v)}, {1.5, 0.1, 0.7},
                                        [&](Index e, auto const& k) {
                                          Mat<double, 24, 24> expected, mass;
                                          body.tangent(e, as_span(q), as_span(v), 0.7, 0.1, expected);
                                          body.mass(e, as_span(q), mass);
                                          expected += 1.5 * mass;
                                          EXPECT_LT((k - expected).norm(), 1e-12 * expected.norm()) << e;
                                        });
  }
}

// --- refused input

Bar by_constants() {
  return {.length = 1.0,
          .constants =
              BarConstants{.EA = 900, .EI = 40, .mass_per_length = 2.0, .GA = 300, .GJ = 25, .rotary_inertia = 0.05}};
}
template <class B>
std::string refused(Bar const& b, Index n = 2) {
  return refusal([&] { (void)B::from(b, n); });
}

TEST(AncfBeam, NamesWhatTheBarDoesNotGive) {
  Bar b = by_constants();
  b.constants->GA = 0;
  EXPECT_TRUE(has(refused<AncfBeam<>>(b), "AncfBeam<ElasticLine>: the shear stiffness GA"));
  b = by_constants();
  b.constants->GJ = 0;
  EXPECT_TRUE(has(refused<AncfBeam<>>(b), "the torsional stiffness GJ"));
  b = by_constants();
  b.constants->EI_y = 0.0;
  EXPECT_TRUE(has(refused<AncfBeam<>>(b), "EI_y"));
  b = by_constants();
  b.constants->rotary_inertia = 0.0;
  EXPECT_TRUE(has(refused<AncfBeam<>>(b), "the bar's rotary inertia about z (mass of the gradient r_y)"));
  b = by_constants();
  b.constants->rotary_inertia_y = 0.0;
  EXPECT_TRUE(has(refused<AncfBeam<>>(b), "about y (mass of the gradient r_z)"));
  EXPECT_TRUE(has(refused<AncfBeam<>>(by_constants(), 0), "at least one element"));
  b = by_constants();
  b.length = 0.0;
  EXPECT_TRUE(has(refused<AncfBeam<>>(b), "length"));
}

TEST(AncfBeam, ContinuumNeedsASectionAndACompressibleMaterial) {
  EXPECT_TRUE(has(refused<AncfBeam<Continuum<>>>(by_constants()), "needs the bar's section and material"));
  Bar b = bar();
  b.material->poisson = 0.5;
  EXPECT_TRUE(has(refused<AncfBeam<Continuum<>>>(b), "below 0.5"));
  b.material->poisson = 0.6;
  EXPECT_TRUE(has(refused<AncfBeam<Continuum<>>>(b), "Poisson's ratio must lie in"));
}

TEST(AncfBeam, RefusesCurvesThatNoBarFollows) {
  auto const refused_curve = [](Bar const& b, Index n, ReferenceCurve const& c) {
    return refusal([&] { (void)AncfBeam<>::from(b, n, c); });
  };
  // half height 0.125 m exceeds the radius of curvature of 0.1 m
  auto const sharp = [](double s) {
    return Placement{0.1 * Vec3(std::sin(s / 0.1), 1 - std::cos(s / 0.1), 0), exp_so3<double>(Vec3(0, 0, s / 0.1))};
  };
  Bar b = bar();
  b.length = 0.3;
  EXPECT_TRUE(has(refused_curve(b, 12, sharp), "element 0, counted from 0: the element is turned inside out"));
  b.section = Rectangle{.height = 0.05, .width = 0.3};  // width across the plane of curvature is allowed
  EXPECT_NO_THROW((void)AncfBeam<>::from(b, 12, sharp));
  b.section = Circle{.radius = 0.11};
  EXPECT_TRUE(has(refused_curve(b, 12, sharp), "element 0, counted from 0: the element is turned inside out"));
  EXPECT_TRUE(
      has(refused_curve(bar(), 2, [](double s) { return Placement{Vec3(2 * s, 0, 0)}; }), "must be its arc length"));
  EXPECT_TRUE(has(refused_curve(bar(), 2, [](double s) { return Placement{Vec3(s > 1 ? 0.65 : s, 0, 0)}; }),
                  "element 1, counted from 0: the ends of the element coincide"));
  EXPECT_TRUE(has(refused_curve(bar(), 2, [](double s) { return Placement{Vec3(s, 0, 0), 2 * Mat3::Identity()}; }),
                  "the reference curve at s = 0"));
}

}  // namespace ancf_beam_reference_test
}  // namespace polybody
