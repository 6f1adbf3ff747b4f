#include <polybody/joints/angle.hpp>
#include <polybody/joints/constraint_functions.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/standard_joints.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/differences.hpp>

#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace rows_test {

constexpr double untouched = 7.0;

ConstraintTerms<6> full() {
  ConstraintTerms<6> gap;
  gap.g.setConstant(untouched);
  gap.Ga.setConstant(untouched);
  gap.Gb.setConstant(untouched);
  return gap;
}

// Only rows [first, first + n) of a gap of six are written.
void expect_only(ConstraintTerms<6> const& gap, int first, int n) {
  for (int i = 0; i < 6; ++i) {
    bool const inside = i >= first && i < first + n;
    EXPECT_EQ(gap.g[i] == untouched && gap.Ga.row(i).isConstant(untouched) && gap.Gb.row(i).isConstant(untouched),
              !inside)
        << "row " << i;
  }
}

TEST(Rows, EachIsWrittenWhereItIsAskedFor) {
  Numbers number;
  Frame<double> const a = number.frame(), b = number.frame();
  ConstraintTerms<6> together = full(), in_plane = full(), square = full(), slide = full();
  constraint_functions::coincident(a, b, together, 2);
  constraint_functions::coincident<2>(a, b, in_plane, 1);
  constraint_functions::perpendicular<6, double>(a.A.col(0), b.A.col(1), square, 4);
  constraint_functions::no_slide<6, double>(a.A.col(2), a, b, slide, 5);
  expect_only(together, 2, 3);
  expect_only(in_plane, 1, 2);
  expect_only(square, 4, 1);
  expect_only(slide, 5, 1);
}

TEST(Rows, GapsAreTheirFormulas) {
  Numbers number;
  Frame<double> const a = number.frame(), b = number.frame();
  ConstraintTerms<6> gap;
  constraint_functions::coincident(a, b, gap);
  EXPECT_EQ(gap.g.head<3>(), b.r - a.r);
  constraint_functions::perpendicular<6, double>(a.A.col(0), b.A.col(1), gap, 3);
  EXPECT_NEAR(gap.g[3], a.A.col(0).dot(b.A.col(1)), 1e-15);
  constraint_functions::no_slide<6, double>(a.A.col(2), a, b, gap, 0);
  EXPECT_NEAR(gap.g[0], a.A.col(2).dot(b.r - a.r), 1e-15);
}

// u rotates with ω_a, w with ω_b about one axis: g = cos(β + (ω_b − ω_a) t), so g̈ = −(ω_b − ω_a)² cos β.
TEST(Rows, PerpendicularGammaOfTwoTurningAxes) {
  double const beta = 0.7;
  Frame<double> const a{.w = {0, 0, 0.4}}, b{.w = {0, 0, -1.1}};
  EXPECT_NEAR(
      (constraint_functions::perpendicular_gamma<double>(Vec3(1, 0, 0), Vec3(std::cos(beta), std::sin(beta), 0), a, b)),
      -1.5 * 1.5 * std::cos(beta), 1e-15);
}

// a rotates with ω about z; b moves along world x with speed s from (x, 0, 0). For u = a₂, g = −sin(ωt) (x + s t), so
// g̈ = −2 ω s (Coriolis). For u = a₁, g̈ = −ω² x (centripetal).
TEST(Rows, NoSlideGammaOfARadialMotion) {
  double const omega = 0.7, s = 1.3, x = 2.0;
  Frame<double> const a{.w = {0, 0, omega}}, b{.r = {x, 0, 0}, .v = {s, 0, 0}};
  EXPECT_NEAR((constraint_functions::no_slide_gamma<double>(Vec3(0, 1, 0), a, b)), -2.0 * omega * s, 1e-15);
  EXPECT_NEAR((constraint_functions::no_slide_gamma<double>(Vec3(1, 0, 0), a, b)), -omega * omega * x, 1e-15);
}

TEST(Rows, DistanceIsItsFormula) {
  Numbers number;
  Frame<double> const a = number.frame(), b = number.frame();
  ConstraintTerms<6> rod = full();
  constraint_functions::distance(a, b, 0.5, rod, 4);
  expect_only(rod, 4, 1);
  EXPECT_NEAR(rod.g[4], (b.r - a.r).norm() - 0.5, 1e-15);
}

// --- lists of constraint equations ----------------------------------------------------------------------------------

/// All kinds of equations, two of them in another order than in the joints of the library.
struct Rod {
  static constexpr char const* name = "Rod";
  static constexpr World world = World::space;
  Required<double> length;
  using Equations =
      EquationList<NoTranslation<2>, FixedDistance<&Rod::length>, planar::Coincident, Perpendicular<1, 0>>;
  Mat3 triad() const { return Mat3::Identity(); }
};
static_assert(JointGeometry<Rod> && constraint_equations<Rod>() == 5);
static_assert(!has_opposite_ends<Rod>() && has_opposite_ends<Universal>());
static_assert(needs_of_first<Rod>() == MarkerKind::frame && needs_of_second<Rod>() == MarkerKind::frame);
static_assert(needs_of_first<Universal>() == MarkerKind::frame && needs_of_second<Universal>() == MarkerKind::axis);
static_assert(needs_of_first<Spherical>() == MarkerKind::point && needs_of_second<PointOnLine>() == MarkerKind::point);

TEST(EquationList, WritesItsEquationsInTheirOrder) {
  Numbers number;
  Frame<double> const a = number.frame(), b = number.frame();
  ConstraintTerms<5> const gap = constraint_function(Rod{.length = 0.5}, a, b, 0.0);
  Vec3 const d = b.r - a.r;
  EXPECT_NEAR(gap.g[0], a.A.col(2).dot(d), 1e-15);
  EXPECT_NEAR(gap.g[1], d.norm() - 0.5, 1e-15);
  EXPECT_EQ((gap.g.segment<2>(2)), d.head<2>());
  EXPECT_NEAR(gap.g[4], a.A.col(1).dot(b.A.col(0)), 1e-15);
}

// The sums of the equations' terms and the dual numbers of the constraint function agree.
TEST(EquationList, GradientIsThatOfTheDualNumbers) {
  Numbers number;
  Frame<double> const a = number.frame(), b = number.frame();
  Vec<double, 5> const lambda = number.vec<5>();
  Mat<double, 12, 12> const k = wrench_gradient_by_dual_numbers(Rod{.length = 0.5}, a, b, 0.0, lambda);
  EXPECT_LT((wrench_gradient(Rod{.length = 0.5}, a, b, 0.0, lambda) - k).norm(), 1e-13 * k.norm());
}

// Two free rotations have moving axes, and a distance prevents no motion along an axis: no free directions.
TEST(EquationList, FreeDirectionsAreTheMotionsThatNoEquationPrevents) {
  EXPECT_EQ(free_directions<Revolute>(), (FreeDirections{false, false, false, false, false, true}));
  EXPECT_EQ(free_directions<PointInPlane>(), (FreeDirections{true, true, false, true, true, true}));
  EXPECT_EQ(free_directions<planar::Prismatic>(), (FreeDirections{true}));
  EXPECT_EQ(free_directions<planar::Revolute>(), (FreeDirections{false, false, false, false, false, true}));
  static_assert(!HasFreeDirections<Universal> && !HasFreeDirections<Rod> && HasMotions<Universal>);
}

/// Own function beside a list: it precedes the functions of the list.
struct Lifted : Spherical {
  template <StateScalar T>
  ConstraintTerms<3, T> constraint_function(Frame<T> const& a, Frame<T> const& b, double t) const {
    ConstraintTerms<3, T> terms = Equations::constraint_function<T>(*this, a, b);
    terms.g[2] -= t;
    terms.rate[2] = T(-1.0);
    return terms;
  }
};
TEST(EquationList, OwnFunctionsPrecedeIt) {
  static_assert(JointGeometry<Lifted> && !HasFreeDirections<Lifted>);
  ConstraintTerms<3> const gap = constraint_function<double>(Lifted{}, {}, {}, 0.25);
  EXPECT_EQ(gap.g, Vec3(0, 0, -0.25));
  EXPECT_EQ(gap.rate, Vec3(0, 0, -1));
  EXPECT_EQ((constraint_gamma<double>(Lifted{}, {}, {}, 0.25)), Vec3(0, 0, 0));
}

TEST(Wrapped, LeavesLessThanHalfATurn) {
  double const pi = std::numbers::pi;
  EXPECT_EQ(constraint_functions::wrapped(3.0), 3.0);
  EXPECT_NEAR(constraint_functions::wrapped(3.5), 3.5 - 2.0 * pi, 1e-15);
  EXPECT_NEAR(constraint_functions::wrapped(-200.0 * pi + 0.25), 0.25, 1e-12);
}

// At constant angular velocities about a common axis θ = ω_rel t grows linearly: no γ, and θ̇ = ω_rel.
TEST(Turn, GrowsEvenlyAboutAFixedAxis) {
  Frame<double> const a{.A = exp_so3<double>(Vec3(0, 0, 0.4)), .w = {0, 0, 1.0}};
  Frame<double> const b{.A = exp_so3<double>(Vec3(0, 0, 3.0)), .w = {0, 0, 3.5}};
  ConstraintTerms<2> const xy = constraint_functions::turned(a, b);
  ConstraintTerms<1> const turn = constraint_functions::angle(xy);
  EXPECT_NEAR(turn.g[0], 2.6, 1e-15);
  EXPECT_NEAR((turn.Ga * twist(a) + turn.Gb * twist(b)).value(), 2.5, 1e-14);
  EXPECT_NEAR(constraint_functions::turn_gamma(xy, a, b), 0.0, 1e-14);
}

// A point passes at velocity v along y, at the distance x: θ = atan(y/x), θ˙ = x v/(x² + y²), θ¨ = −2 x y v²/(x² +
// y²)². If y = x, θ¨ = −v²/(2 x²).
TEST(Turn, GammaOfThePassingPoint) {
  double const x = 2.0, v = 3.0;
  Frame<double> const a, b{.r = {x, x, 0}, .v = {0, v, 0}};
  ConstraintTerms<2> const xy = constraint_function(PointOnLine{}, a, b, 0.0);
  EXPECT_NEAR(constraint_functions::angle_gamma(xy, constraint_gamma(PointOnLine{}, a, b, 0.0), a, b),
              -v * v / (2.0 * x * x), 1e-14);
}

TEST(TriadOf, HoldsBothAxesAndRefusesOthers) {
  Mat3 const e = constraint_functions::triad_of({0, 1, 0}, {0.6, 0, 0.8}, "cross");
  EXPECT_EQ(e.col(0), Vec3(0, 1, 0));
  EXPECT_EQ(e.col(2), Vec3(0.6, 0, 0.8));
  EXPECT_NEAR(e.determinant(), 1.0, 1e-15);
  EXPECT_TRUE(has(refusal([] { (void)constraint_functions::triad_of({1, 0, 0}, {0.6, 0, 0.8}, "cross"); }),
                  "cross: the two axes must be perp"));
  EXPECT_TRUE(has(refusal([] { (void)constraint_functions::triad_of({1, 1, 0}, {0, 0, 1}, "cross"); }),
                  "cross: the first axis must be a unit"));
  EXPECT_TRUE(has(refusal([] { (void)constraint_functions::triad_of({1, 0, 0}, {0, 0, 2}, "cross"); }),
                  "cross: the second axis must be a unit"));
}

TEST(TriadAbout, IsRightHandedWithTheAxisThird) {
  Numbers number;
  for (Vec3 const& axis :
       {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(Vec3(1, 1, 1).normalized()),
        Vec3(Vec3(1e-9, 1, 0).normalized()), Vec3(number.vec<3>().normalized())}) {
    Mat3 const e = constraint_functions::triad_about(axis, "pin");
    EXPECT_LT((e.transpose() * e - Mat3::Identity()).norm(), 1e-14);
    EXPECT_GT(e.determinant(), 0.0);
    EXPECT_EQ(e.col(2), axis);
  }
}

TEST(TriadAbout, RefusesWhatIsNoUnitVector) {
  double const nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  for (Vec3 const& axis : {Vec3(0, 0, 0), Vec3(0, 0, 2), Vec3(0, 1 + 1e-8, 0)})
    EXPECT_TRUE(
        has(refusal([&] { (void)constraint_functions::triad_about(axis, "pin"); }), "pin must be a unit vector"));
  for (Vec3 const& axis : {Vec3(nan, 0, 1), Vec3(0, 0, infinite)})
    EXPECT_TRUE(has(refusal([&] { (void)constraint_functions::triad_about(axis, "pin"); }), "pin must be finite"));
  EXPECT_NO_THROW((void)constraint_functions::triad_about(Vec3(0, 1 + 1e-10, 0), "pin"));  // round-off is accepted
}

}  // namespace rows_test
