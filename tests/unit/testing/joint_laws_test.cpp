// The laws of joints accept right geometries of every length, and refuse a term with a relative error of 1e-5.
#include <polybody/joints/constraint_functions.hpp>
#include <polybody/joints/joint_axis.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/joint_laws.hpp>

#include "support/broken_laws.hpp"

namespace polybody {
using namespace laws;
namespace joint_laws_test {

constexpr double radius = 0.6;  // [m]

/// Term of the helix with a relative error of 1e-5.
enum class Wrong { nothing, map, gamma, gradient };

/// A point of b slides along a helix of a about z: s₁ = R cos(s₃/p) and s₂ = R sin(s₃/p), with the displacements s of b
/// in the axes of a.
struct HelicalGuide {
  static constexpr char const* name = "HelicalGuide";
  static constexpr int rows = 2;
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr MarkerKind needs_of_second = MarkerKind::point;
  static constexpr World world = World::space;
  double pitch;  // p [m/rad]
  Wrong wrong = Wrong::nothing;
  JointAxis axis = Vec3(0, 0, 1);
  Mat3 triad() const { return polybody::constraint_functions::triad_about(axis, "HelicalGuide: the axis"); }

  template <StateScalar T>
  ConstraintTerms<2, T> constraint_function(Frame<T> const& a, Frame<T> const& b, double) const {
    using std::cos, std::sin;
    ConstraintTerms<3, T> const s = displacements(a, b);
    T const phi = s.g[2] / pitch, by_cos = cos(phi) * (radius / pitch), by_sin = sin(phi) * (radius / pitch);
    ConstraintTerms<2, T> out;
    out.g[0] = s.g[0] - cos(phi) * radius;
    out.g[1] = s.g[1] - sin(phi) * radius;
    for (int j = 0; j < 6; ++j) {
      out.Ga(0, j) = s.Ga(0, j) + by_sin * s.Ga(2, j);
      out.Gb(0, j) = s.Gb(0, j) + by_sin * s.Gb(2, j) * (wrong == Wrong::map ? 1.0 + 1e-5 : 1.0);
      out.Ga(1, j) = s.Ga(1, j) - by_cos * s.Ga(2, j);
      out.Gb(1, j) = s.Gb(1, j) - by_cos * s.Gb(2, j);
    }
    return out;
  }
  template <StateScalar T>
  Vec<T, 2> gamma(Frame<T> const& a, Frame<T> const& b, double) const {
    using std::cos, std::sin;
    ConstraintTerms<3, T> const s = displacements(a, b);
    T const phi = s.g[2] / pitch;
    T const rate = (Vec<T, 6>(s.Ga.row(2)).dot(twist(a)) + Vec<T, 6>(s.Gb.row(2)).dot(twist(b))) / pitch;
    T g[3];
    for (int i = 0; i < 3; ++i) g[i] = polybody::constraint_functions::no_slide_gamma(axis_of(a, i), a, b);
    Vec<T, 2> out;
    out[0] = g[0] + sin(phi) * g[2] * (radius / pitch) +
             cos(phi) * rate * rate * radius * (wrong == Wrong::gamma ? 1.0 + 1e-5 : 1.0);
    out[1] = g[1] - cos(phi) * g[2] * (radius / pitch) + sin(phi) * rate * rate * radius;
    return out;
  }
  /// The term (i, i) with the largest size, or all terms, as dual numbers give them.
  Mat<double, 12, 12> wrench_gradient(Frame<double> const& a, Frame<double> const& b, Vec<double, 2> const& l) const {
    Mat<double, 12, 12> k = wrench_gradient_by_dual_numbers(*this, a, b, 0.0, l);
    if (wrong == Wrong::gradient) {
      Index largest = 0;
      k.diagonal().cwiseAbs().maxCoeff(&largest);
      k(largest, largest) *= 1.0 + 1e-5;
    }
    return k;
  }

 private:
  template <StateScalar T>
  static ConstraintTerms<3, T> displacements(Frame<T> const& a, Frame<T> const& b) {
    ConstraintTerms<3, T> s;
    for (int i = 0; i < 3; ++i) polybody::constraint_functions::no_slide(axis_of(a, i), a, b, s, i);
    return s;
  }
};

/// Pitch in mm/rad.
template <int mm, Wrong wrong = Wrong::nothing>
struct Helix {
  static constexpr bool planar = false;
  static constexpr int world_rows = 0;
  static HelicalGuide geometry() { return {.pitch = 1e-3 * mm, .wrong = wrong}; }
  static Mate mate(Numbers& number, double) {
    double const phi = number(3.0), pitch = 1e-3 * mm, c = radius * std::cos(phi), s = radius * std::sin(phi);
    Mate mate{.d = {c, s, pitch * phi}, .R = exp_so3<double>(number.vec<3>(3.0)), .free_directions = MatX::Zero(6, 4)};
    mate.free_directions.col(0) << -s, c, pitch, 0, 0, 0;
    mate.free_directions.bottomRightCorner<3, 3>().setIdentity();
    return mate;
  }
};

TEST(JointLaws, AcceptHelicesOfEveryPitch) {
  EXPECT_EQ(broken<JointLaws<Helix<10000>>>(), Names{});
  EXPECT_EQ(broken<JointLaws<Helix<200>>>(), Names{});
  EXPECT_EQ(broken<JointLaws<Helix<50>>>(), Names{});
  EXPECT_EQ(broken<JointLaws<Helix<10>>>(), Names{});
  EXPECT_EQ(broken<JointLaws<Helix<1>>>(), Names{});
}

template <int mm>
void expect_that_wrong_terms_are_found() {
  Names const maps = broken<JointLaws<Helix<mm, Wrong::map>>>();
  EXPECT_EQ(std::ranges::count(maps, std::string("MapsAreTheDerivativeOfTheFunction")), 1);
  EXPECT_EQ((broken<JointLaws<Helix<mm, Wrong::gamma>>>()), Names{"GammaIsTheSecondDerivativeWithoutAccelerations"});
  EXPECT_EQ((broken<JointLaws<Helix<mm, Wrong::gradient>>>()), Names{"WrenchGradientIsTheDerivativeOfTheWrenches"});
}
TEST(JointLaws, FindAWrongTermOfRelativeSize1em5) {
  expect_that_wrong_terms_are_found<10000>();
  expect_that_wrong_terms_are_found<200>();
  expect_that_wrong_terms_are_found<1>();
}

// --- differences ------------------------------------------------------------------------------------------------

TEST(Differences, FollowFunctionsOfEveryLength) {
  for (double const length : {1e-3, 0.1, 1.0, 100.0})
    EXPECT_NEAR(slope_at_zero([&](double h) { return std::sin(0.3 + h / length); }) * length, std::cos(0.3),
                1e-9 * std::max(1.0, 1e-3 * length))
        << length;
  Vec3 const slope = slope_at_zero([](double h) { return Vec3(std::exp(h), h, 7.0); });
  EXPECT_LT((slope - Vec3(1, 1, 0)).norm(), 1e-12);
}

TEST(Differences, StayWithinTheLargestStep) {
  double most = 0.0;
  (void)slope_at_zero([&](double h) { return most = std::max(most, std::abs(h)); }, 0.25);
  EXPECT_EQ(most, 0.25);
}

}  // namespace joint_laws_test
}  // namespace polybody
