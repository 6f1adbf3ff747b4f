#include <polybody/bodies/se3/se3_beam.hpp>

#include <gtest/gtest.h>

#include <numbers>

#include "support/refusal.hpp"
#include "support/straight_se3_bar.hpp"

namespace polybody {
namespace se3_beam_test {

using std::numbers::pi;

double const length = 1.3;
Vec6 const stiffness = (Vec6() << 900, 300, 350, 25, 60, 40).finished();

std::span<double> numbers_of(VecX& x) { return {x.data(), std::size_t(x.size())}; }
VecX reference_of(Se3Beam const& beam) {
  VecX q(beam.coordinates());
  beam.reference(numbers_of(q));
  return q;
}

// Stretch, shear, twist and bending in any combination: each mesh measures the strains of a helix exactly.
TEST(Se3Beam, ConstantStrainsAreExactWithAnyMesh) {
  for (Vec6 const& strains : {six(0.02, 0.1, -0.07, 0, 0, 0), six(0, 0, 0, 0.5, 0, 0), six(0, 0, 0, 0, 0, 2.3),
                              six(0.02, 0.1, -0.07, 0.9, 0.3, -1.6), six(0, 0, 0, 1e-9, 2e-9, -1e-9)})
    for (Index const n : {1, 2, 5}) {
      Se3Beam const beam = Se3Beam::from(straight_bar(), n);
      double const l = length / double(n);
      VecX const q = nodes_of(n, [&](double i) { return helix(strains, l * i); });
      for (double const s : {0.0, 0.4 * length, length}) {
        EXPECT_LT((beam.section_strains(beam.at(s), numbers(q)) - strains).norm(), 2e-14 * double(n));
        EXPECT_LT((beam.section_forces(beam.at(s), numbers(q)) - strains.cwiseProduct(stiffness)).norm(), 5e-11);
      }
      double const energy = 0.5 * length * strains.cwiseAbs2().dot(stiffness);
      EXPECT_NEAR(strain_energy_of(beam, q), energy, 1e-13 * (1.0 + energy));
    }
}

// Position and axes of every section of one element are those of the helix, also off the axis.
TEST(Se3Beam, SectionsOfOneElementLieOnTheHelix) {
  Vec6 const strains = six(0.02, 0.1, -0.07, 0.9, 0.3, -1.6);
  Se3Beam const beam = Se3Beam::from(straight_bar(), 1);
  VecX const q = nodes_of(1, [&](double i) { return helix(strains, length * i); }), rest = VecX::Zero(12);
  std::array<double, 72> memory;
  MarkerKinematics<double> out;
  out.jacobian = memory.data();
  for (double const s : {0.0, 0.17, 0.65, 1.1, length}) {
    beam.evaluate_marker<double>(beam.at(s, 0.1, -0.2), Mat3::Identity(), numbers(q), numbers(rest), out);
    Placement const at = helix(strains, s);
    EXPECT_LT((out.frame.A - at.axes).norm(), 1e-14) << s;
    EXPECT_LT((out.frame.r - at.origin - at.axes * Vec3(0, 0.1, -0.2)).norm(), 1e-14) << s;
  }
}

// A bent and twisted beam in a rigid motion through ten half turns: strains, forces and the tangent in section axes are
// those of the beam at rest.
TEST(Se3Beam, StrainsAndForcesDependOnTheRelativeMotionOnly) {
  Vec6 const strains = six(0.02, 0.1, -0.07, 0.9, 0.3, -1.6);
  Se3Beam const beam = Se3Beam::from(straight_bar(), 1);
  VecX const q = nodes_of(1, [&](double i) { return helix(strains, length * i); }), rest = VecX::Zero(12);
  Vec<double, 12> f, moved_force;
  Mat<double, 12, 12> k, moved_k, turn = Mat<double, 12, 12>::Identity();
  beam.force<double>(0, numbers(q), numbers(rest), f);
  beam.tangent(0, numbers(q), numbers(rest), 1.0, 0.0, k);
  Vec3 const axis = Vec3(2, -1, 2) / 3.0;
  for (int i = 0; i <= 100; ++i) {
    Placement const motion = Placement::at(Vec3(0.1 * i, -3, 2), i * pi / 10.0 * axis);
    VecX const moved = carried(motion, q);
    for (int block : {0, 6}) turn.block<3, 3>(block, block) = motion.axes;  // forces in world axes
    EXPECT_LT((beam.section_strains(beam.at(0.5), numbers(moved)) - strains).norm(), 2e-14 * (1.0 + 0.1 * i));
    beam.force<double>(0, numbers(moved), numbers(rest), moved_force);
    beam.tangent(0, numbers(moved), numbers(rest), 1.0, 0.0, moved_k);
    EXPECT_LT((moved_force - turn * f).norm(), 2e-12 * (1.0 + 0.1 * i) * f.norm());
    EXPECT_LT((moved_k - turn * k * turn.transpose()).norm(), 2e-12 * (1.0 + 0.1 * i) * k.norm());
  }
}

// The rotation of the tip in the beam's own coordinates, step by step with ⊞: the strains jump only past half a turn
// of an element.
TEST(Se3Beam, ATurningTipTwistsTheBeam) {
  int const n = 4;
  Se3Beam const beam = Se3Beam::from(straight_bar(), n);
  VecX q = reference_of(beam), delta = VecX::Zero(beam.velocities()), next = q;
  for (Index i = 0; i <= n; ++i) delta[6 * i + 3] = 0.05 * double(i);  // about x, proportional to s
  for (int k = 1; k <= 240; ++k) {
    beam.plus<double>(numbers(q), numbers(delta), numbers_of(next));
    q = next;
    double const turn = 0.05 * k, shortest = std::remainder(turn, 2 * pi);
    EXPECT_NEAR(beam.section_strains(beam.at(0.0), numbers(q))[3], shortest * n / length, 1e-11) << k;
  }
}

// A straight beam has the exact inertia of the rod for any mesh, with the rotary inertia of its sections.
TEST(Se3Beam, StraightBeamHasTheInertiaOfTheRod) {
  for (Index const n : {1, 3}) {
    Se3Beam const beam = Se3Beam::from(spatial_lrvf_bar(), n);
    VecX const q = reference_of(beam);
    VecX v(beam.velocities());
    Mat3 const axes = spatial_lrvf_bar().placement.axes;
    Vec3 const omega(0.3, -1.1, 0.7), w = axes.transpose() * omega, v0(0.4, 0.2, -0.9);
    Vec3 const middle = spatial_lrvf_bar().placement.origin + 0.5 * length * axes.col(0);
    beam.rigid_velocity(numbers(q), v0, omega, numbers_of(v));
    double kinetic = 0.0;
    for (Index e = 0; e < n; ++e) kinetic += beam.kinetic_energy(e, numbers(q), numbers(v));
    double const m = 2.0 * length, across = m * length * length / 12;
    Vec3 const inertia = length * Vec3(0.08, 0.03, 0.05) + Vec3(0, across, across);
    EXPECT_NEAR(kinetic, 0.5 * m * (v0 + omega.cross(middle)).squaredNorm() + 0.5 * w.dot(inertia.cwiseProduct(w)),
                1e-13);
  }
}

// For small motions of the straight beam, stiffness, damping and mass are those of Lrvf with reduced quadrature. Bent
// beams differ.
TEST(Se3Beam, StraightBeamIsThatOfLrvfForSmallMotions) {
  Se3Beam const beam = Se3Beam::from(spatial_lrvf_bar(), 3);
  Lrvf<> const other = Lrvf<>::from(spatial_lrvf_bar(), 3);
  VecX const q = reference_of(beam), rest = VecX::Zero(beam.velocities());
  Mat<double, 12, 12> a, b;
  for (auto const& [ck, cd] : {std::pair(1.0, 0.0), std::pair(0.0, 1.0)}) {
    beam.tangent(1, numbers(q), numbers(rest), ck, cd, a);
    other.tangent(1, numbers(q), numbers(rest), ck, cd, b);
    EXPECT_LT((a - b).norm(), 1e-13 * b.norm());
  }
  beam.mass(1, numbers(q), a);
  other.mass(1, numbers(q), b);
  EXPECT_EQ(a, b);
  VecX const bent = nodes_of(3, [&](double i) { return helix(six(0, 0, 0, 0.9, 0.3, -1.6), length / 3 * i); });
  beam.tangent(1, numbers(bent), numbers(rest), 1.0, 0.0, a);
  other.tangent(1, numbers(bent), numbers(rest), 1.0, 0.0, b);
  EXPECT_GT((a - b).norm(), 0.02 * b.norm());
}

TEST(Se3Beam, PretensionPullsTheEndsAndStoresItsWork) {
  Bar bar = straight_bar();
  bar.pretension = 70.0;
  Se3Beam const beam = Se3Beam::from(bar, 1);
  VecX q = reference_of(beam), rest = VecX::Zero(12);
  Vec<double, 12> f, expected = Vec<double, 12>::Zero();
  expected[0] = 70.0;
  expected[6] = -70.0;
  beam.force<double>(0, numbers(q), numbers(rest), f);
  EXPECT_LT((f - expected).norm(), 1e-12);
  EXPECT_NEAR(beam.section_forces(beam.at(0.5), numbers(q))[0], 70.0, 1e-12);
  q[7] *= 1.02;
  EXPECT_NEAR(strain_energy_of(beam, q), length * (0.5 * 900 * 0.02 * 0.02 + 70.0 * 0.02), 1e-12);
}

TEST(Se3Beam, RefusesWhatItCannotMean) {
  Bar bar = spatial_lrvf_bar();
  bar.constants->GA = 0.0;
  EXPECT_TRUE(has(refusal([&] { (void)Se3Beam::from(bar, 3); }), "Se3Beam: the stiffness GA of the bar"));
  bar = spatial_lrvf_bar();
  bar.constants->GJ = 0.0;
  EXPECT_TRUE(has(refusal([&] { (void)Se3Beam::from(bar, 3); }), "Se3Beam: the stiffness GJ of the bar"));
  bar = spatial_lrvf_bar();
  EXPECT_TRUE(has(refusal([&] { (void)Se3Beam::from(bar, 0); }), "at least one element"));
  EXPECT_TRUE(has(refusal([&] { (void)Se3Beam::from(bar, 3, ReferenceCurve{}); }), "curve is an empty function"));
  auto const fast = [](double s) { return Placement{.origin = Vec3(2 * s, 0, 0)}; };
  auto const still = [](double) { return Placement{}; };
  EXPECT_TRUE(has(refusal([&] { (void)Se3Beam::from(bar, 3, fast); }), "must be its arc length"));
  EXPECT_TRUE(has(refusal([&] { (void)Se3Beam::from(bar, 3, still); }), "a helical arc of 0 m"));
  auto const spiral = [](double s) { return helix(six(0, 0, 0, 0, 0, 4.0), s); };  // 5.2 rad
  EXPECT_TRUE(has(refusal([&] { (void)Se3Beam::from(bar, 1, spiral); }), "rotate by half a turn or more"));
  EXPECT_NO_THROW((void)Se3Beam::from(bar, 2, spiral));
  auto const crooked = [](double s) { return Placement{.origin = Vec3(s, 0, 0), .axes = 2.0 * identity()}; };
  EXPECT_TRUE(has(refusal([&] { (void)Se3Beam::from(bar, 3, crooked); }), "Se3Beam: the reference curve"));
  Se3Beam const beam = Se3Beam::from(bar, 3);
  EXPECT_TRUE(has(refusal([&] { (void)beam.at(1.4); }), "lies outside the body"));
  EXPECT_TRUE(has(refusal([&] { (void)beam.at(0.5, std::nan("")); }), "y of a point"));
}

}  // namespace se3_beam_test
}  // namespace polybody
