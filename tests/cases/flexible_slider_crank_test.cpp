// Slider-crank with a flexible coupler that is pinned at both ends (D8). The crank reaches 150 rad/s within 0.1 s. The
// slider then loads the coupler with 0.3 of its Euler load. flexible_slider_crank.py computes the reference values.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/ffr/planar_ffr.hpp>
#include <polybody/polybody.hpp>

#include "support/flexible_slider_crank.hpp"
#include "support/held.hpp"

namespace flexible_slider_crank_test {

using namespace polybody;
using namespace slider_crank;

/// Reference values at a time.
struct Row {
  double t, bend, unstiffened, slider;  ///< [s], deflection [mm], the same without axial forces [mm], slider [m]
};
std::vector<Row> const rows{
    {0.01, -0.0764, -0.0764, 0.4999996}, {0.02, -0.2713, -0.2717, 0.4999119}, {0.03, -0.4619, -0.4686, 0.4980347},
    {0.04, -0.2140, -0.2288, 0.4841255}, {0.05, 1.1184, 1.2254, 0.4337923},   {0.06, 2.2037, 2.0667, 0.3468586},
    {0.07, 0.5876, 0.4393, 0.3000466},   {0.08, -4.3013, -3.3815, 0.3701660}, {0.09, -1.3614, -3.1083, 0.4951124},
    {0.10, 5.4199, 5.4958, 0.4233217},   {0.11, 1.5197, 1.5255, 0.3067437},   {0.12, -4.1395, -2.6620, 0.3425434},
    {0.13, -2.8910, -4.8746, 0.4807175}, {0.14, 4.6350, 5.7899, 0.4511963},   {0.15, 2.7564, 1.7970, 0.3186618},
    {0.16, -3.0452, -2.4806, 0.3233175}, {0.17, -4.4080, -5.9350, 0.4587953}, {0.18, 3.2376, 5.4728, 0.4749053},
    {0.19, 3.5694, 2.8562, 0.3362978},   {0.20, -2.0274, -1.5180, 0.3096658},
};
double const peak = 5.58144, unstiffened_peak = 6.16115;  // [mm], reference values

using Method = GeneralisedAlpha;
Method const method{.rho_inf = 0.8};
template <class B>
using Under = Formulation<B, Constraint, Method>;

/// Formulation of a floating frame of eight elements with options.
template <class B>
struct WithOptions {
  using BodyType = B;
  using PolicyType = Constraint;
  using IntegratorType = Method;
  std::string name;
  FfrOptions options;
  Constraint policy = {};
  Method integrator = method;
  B body(Bar const& bar) const { return B::from(bar, 8, options); }
};

/// Requires the reference deflection within 2 % of its peak at all times, and the reference position of the slider.
void expect_the_reference(ComparedRun const& run, bool stiffened = true) {
  SCOPED_TRACE(run.name);
  double most = 0.0;
  for (double const b : run.outputs[1]) most = std::max(most, std::abs(b));
  double const expected = stiffened ? peak : unstiffened_peak;
  Claim const claim{
      "D8", stiffened ? "deflection of the coupler [mm]" : "deflection of the coupler without axial forces [mm]",
      By::independent, stiffened ? "chain of rigid segments" : "sine modes on the moving chord", run.name};
  std::size_t next = 0;
  for (std::size_t i = 0; i < run.times.size() && next < rows.size(); ++i) {
    if (std::abs(run.times[i] - rows[next].t) > 1e-9) continue;
    Row const& row = rows[next++];
    held(claim, run.outputs[1][i], stiffened ? row.bend : row.unstiffened, 0.02 * expected,
         {equals("t", row.t), expected});
    EXPECT_NEAR(run.outputs[0][i], row.slider, stiffened ? 4e-5 : 4e-4) << row.t;  // the reference has no axial strain
  }
  EXPECT_EQ(next, rows.size());
  EXPECT_NEAR(most, expected, 0.02 * expected);
}

TEST(FlexibleSliderCrank, FormulationsAgreeInThePlane) {
  Comparison const c =
      compare(in_the_plane, Under<planar::Rigid>{"planar Rigid", {}, method},
              Under<Meshed<planar::Ffr, 4>>{"planar Ffr, 4 elements", {}, method},
              Under<Modal<planar::Ffr, 8, 2>>{"planar Ffr, 2 modes", {}, method},
              Under<Meshed<planar::AncfCable<>, 8>>{"planar AncfCable, Green strain, 8 elements", {}, method},
              Under<Meshed<planar::AncfCable<EngineeringStrain>, 8>>{
                  "planar AncfCable, engineering strain, 8 elements", {}, method},
              Under<Meshed<planar::Lrvf, 16>>{"planar Lrvf, 16 elements", {}, method});
  ASSERT_EQ(c.runs.size(), 6u);
  for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_NEAR(c.runs[0].outputs[0][20 * (i + 1)], rows[i].slider, 4e-4);
  for (std::size_t i = 1; i < c.runs.size(); ++i) {
    expect_the_reference(c.runs[i]);
    EXPECT_TRUE(c.runs[i].run.warnings.empty()) << c.runs[i].run.warnings[0];
  }
}

TEST(FlexibleSliderCrank, FormulationsAgreeInSpace) {
  Comparison const c =
      compare(in_space, Under<Meshed<Ffr, 4>>{"Ffr, 4 elements", {}, method},
              Under<Modal<Ffr, 8, 2>>{"Ffr, 2 modes", {}, method},
              Under<Meshed<AncfCable<>, 8>>{"AncfCable, Green strain, 8 elements", {}, method},
              Under<Meshed<AncfCable<EngineeringStrain>, 8>>{"AncfCable, engineering strain, 8 elements", {}, method},
              Under<Meshed<Lrvf<>, 16>>{"Lrvf, 16 elements", {}, method});
  ASSERT_EQ(c.runs.size(), 5u);
  for (ComparedRun const& run : c.runs) expect_the_reference(run);
}

TEST(FlexibleSliderCrank, WithoutStiffeningTheFramesFollowTheLinearModel) {
  using Flat = WithOptions<planar::Ffr>;
  Comparison const c = compare(
      in_the_plane, Flat{"planar Ffr, 8 elements, no stiffening", {.stiffening = false}},
      Flat{"planar Ffr, 2 modes, no stiffening", {.stiffening = false, .modes = 2}},
      Flat{"planar Ffr on its chord, no stiffening", {.frame = FfrFrame::simply_supported, .stiffening = false}});
  for (ComparedRun const& run : c.runs) {
    expect_the_reference(run, false);
    ASSERT_EQ(run.run.warnings.size(), 1u);
    EXPECT_NE(run.run.warnings[0].find("FfrFrame::mean_axes"), std::string::npos) << run.run.warnings[0];
  }
  Comparison const d = compare(in_space, WithOptions<Ffr>{"Ffr, 8 elements, no stiffening", {.stiffening = false}},
                               WithOptions<Ffr>{"Ffr, 2 modes, no stiffening", {.stiffening = false, .modes = 2}});
  for (ComparedRun const& run : d.runs) expect_the_reference(run, false);
}

TEST(FlexibleSliderCrank, StiffenedFramesOnTheChordFollowTheReference) {
  Comparison const c = compare(in_the_plane, WithOptions<planar::Ffr>{"planar Ffr on its chord, 8 elements",
                                                                      {.frame = FfrFrame::simply_supported}});
  expect_the_reference(c.runs[0]);
}

/// Smallest eigenvalue of the mass matrix of the rod, bent to a half sine of amplitude a [m].
double smallest_mass(FfrFrame frame, Index elements, double a) {
  planar::Ffr const body = planar::Ffr::from(rod_bar, elements, {.frame = frame});
  std::vector<double> q(std::size_t(body.coordinates()), 0.0);
  double const k = std::numbers::pi / rod_length;
  for (Index i = 1; i <= elements; ++i) {
    double const x = rod_length * double(i) / double(elements);
    q[std::size_t(3 * i + 1)] = a * (std::sin(k * x) - k * x);  // relative to the first end
    q[std::size_t(3 * i + 2)] = a * k * (std::cos(k * x) - 1.0);
  }
  MatX m;
  body.mass(0, q, m);
  return Eigen::SelfAdjointEigenSolver<MatX>(m).eigenvalues()[0];
}

// The mass matrix is complete to first order in q. The missing terms grow with the rotation of the frame against the
// body, which mean axes keep small.
TEST(FlexibleSliderCrank, MeanAxesKeepTheStiffenedMassPositive) {
  for (Index const n : {4, 8}) {
    EXPECT_LT(smallest_mass(FfrFrame::clamped, n, 5.6e-3), 0.0) << n;
    EXPECT_GT(smallest_mass(FfrFrame::mean_axes, n, 5.6e-3), 0.0) << n;
    EXPECT_GT(smallest_mass(FfrFrame::mean_axes, n, 0.0), 0.0) << n;
  }
}

}  // namespace flexible_slider_crank_test
