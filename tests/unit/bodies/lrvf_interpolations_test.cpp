// Comparison of the interpolations of rotations after Romero [2004]: objectivity, path dependence, fields.

#include <polybody/bodies/lrvf/director_interpolation.hpp>
#include <polybody/bodies/lrvf/incremental_interpolation.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>

#include <Eigen/SVD>
#include <numbers>

#include "support/spatial_lrvf.hpp"

namespace polybody {
namespace lrvf_interpolations_test {

using Quaternions = std::array<Quaternion<double>, 2>;
double const pi = std::numbers::pi;

Quaternion<double> quaternion(Vec3 const& turn) { return quaternion_of(exp_so3<double>(turn)); }

/// Element whose nodes have the relative rotation φ. Its axis is normal to the axis of their common rotation.
Quaternions turned_apart(double phi, double carriage = 1.1) {
  Quaternion<double> const first = quaternion(Vec3(carriage, 0.2, 0.0)),
                           half = quaternion(Vec3(0.0, 0.6 * phi, 0.8 * phi));
  return {first, quaternion_product<double>(first, half)};
}
template <class I>
SectionTurn field(double xi, Quaternions const& nodes) {
  return I(Placement{}).turn(xi, 1.0, nodes[0], nodes[1]);
}
/// Angle between two rotations, for small angles.
double angle(Mat3 const& a, Mat3 const& b) { return (a - b).norm() / std::sqrt(2.0); }

// sin((1 − ξ) φ/2) a + sin(ξ φ/2) b over sin(φ/2) [Shoemake 1985]. The great circle between the quaternions rotates
// at a constant rate about one axis, like `RelativeRotation`.
TEST(LrvfInterpolations, SphericalLinearInterpolationIsObjective) {
  for (double const phi : {0.01, 0.5, 2.0, 3.0}) {
    Quaternions const nodes = turned_apart(phi);
    double const half = 0.5 * phi;
    for (double const xi : {0.1, 0.5, 0.83}) {
      Quaternion<double> q;
      for (int i = 0; i < 4; ++i)
        q[i] = (std::sin((1.0 - xi) * half) * nodes[0][i] + std::sin(xi * half) * nodes[1][i]) / std::sin(half);
      EXPECT_LT(angle(rotation_matrix<double>(q), field<RelativeRotation>(xi, nodes).R), 5e-15) << phi << ' ' << xi;
    }
  }
}

// The polar decomposition Λ (ΛᵀΛ)^(−½) of the mean of the directors is the rotation of `Polar`.
TEST(LrvfInterpolations, PolarIsTheNearestRotationToTheDirectors) {
  for (double const phi : {0.01, 0.5, 2.0, 3.0})
    for (double const xi : {0.2, 0.5, 0.9}) {
      Quaternions const nodes = turned_apart(phi);
      Mat3 const mean = (1.0 - xi) * rotation_matrix<double>(nodes[0]) + xi * rotation_matrix<double>(nodes[1]);
      Eigen::JacobiSVD<Mat3> const svd(mean, Eigen::ComputeFullU | Eigen::ComputeFullV);
      Mat3 const nearest = svd.matrixU() * svd.matrixV().transpose();
      EXPECT_LT(angle(nearest, field<Polar>(xi, nodes).R), 1e-13) << phi << ' ' << xi;
    }
}

// α − ξφ = −ξ (1 − ξ) (1 − 2ξ) φ³/6. This is the third cumulant of a variable that is 1 with the probability ξ and 0
// otherwise, log(1 − ξ + ξ e^{iφ}). For rotation vectors the difference is of second order if the nodes are rotated
// from the placement.
TEST(LrvfInterpolations, FieldsDifferByTheThirdOrTheSecondOrder) {
  double const xi = 0.25;
  auto const off = [&](auto const* policy, double phi) {
    using I = std::remove_cvref_t<decltype(*policy)>;
    Quaternions const nodes = turned_apart(phi);
    return angle(field<I>(xi, nodes).R, field<RelativeRotation>(xi, nodes).R);
  };
  Polar const* const polar = nullptr;
  Direct const* const direct = nullptr;
  double const phi = 0.1;
  EXPECT_NEAR(off(polar, phi) / (phi * phi * phi), xi * (1.0 - xi) * (1.0 - 2.0 * xi) / 6.0, 1e-4);
  EXPECT_NEAR(off(polar, 2.0 * phi) / off(polar, phi), 8.0, 0.1);
  EXPECT_NEAR(off(direct, 2.0 * phi) / off(direct, phi), 4.0, 0.2);
  EXPECT_GT(off(direct, phi), 1e-4);
  Quaternions const nodes = turned_apart(2.0);
  EXPECT_LT(angle(field<Polar>(0.5, nodes).R, field<RelativeRotation>(0.5, nodes).R), 1e-15);
}

// K is the rotation of the field per length, and K′ its derivative. Both are compared with finite differences along
// the element.
TEST(LrvfInterpolations, CurvatureOfPolarIsTheDerivativeOfItsField) {
  Quaternions const nodes = turned_apart(1.5);
  double const xi = 0.3, h = 1e-5;
  SectionTurn const before = field<Polar>(xi - h, nodes), at = field<Polar>(xi, nodes),
                    after = field<Polar>(xi + h, nodes);
  EXPECT_LT((at.R * skew<double>(at.K) - (after.R - before.R) / (2.0 * h)).norm(), 1e-8);
  EXPECT_LT((at.dK - (after.K - before.K) / (2.0 * h)).norm(), 1e-8);
  EXPECT_GT(at.dK.norm(), 0.1);
}

double const l = 1.3, EI = 40.0;
template <class I>
Lrvf<I> element() {
  Bar bar = spatial_lrvf_bar();
  bar.placement = {};
  bar.damping = {};
  return Lrvf<I>::from(bar, 1);
}
/// Nodes at the distance l, bent by φ about z symmetrically to the middle.
VecX bent(double phi) {
  return nodes_of(1, [&](double i) { return Placement::at(Vec3((i - 0.5) * l, 0, 0), Vec3(0, 0, (i - 0.5) * phi)); });
}
template <class I>
Vec6 strains(VecX const& q) {
  Lrvf<I> const beam = element<I>();
  return beam.section_strains(beam.at(0.5), numbers(q));
}

TEST(LrvfInterpolations, CurvatureInTheMiddleIsAsDerived) {
  for (double const phi : {0.1, 1.0, 2.5}) {
    EXPECT_NEAR(strains<RelativeRotation>(bent(phi))[5], phi / l, 1e-14);
    EXPECT_NEAR(strains<Polar>(bent(phi))[5], 2.0 * std::tan(0.5 * phi) / l, 1e-13);
    EXPECT_NEAR(strains<Directors>(bent(phi))[5], std::sin(phi) / l, 1e-14);
    EXPECT_NEAR(strains<Polar>(bent(phi))[0], 0.0, 1e-14);
    EXPECT_NEAR(strains<Directors>(bent(phi))[0], std::cos(0.5 * phi) - 1.0, 1e-14);  // director with this length
  }
}

// The bending energy at half a revolution is zero if the distance of the nodes gives Γ₁ = 0.
TEST(LrvfInterpolations, DirectorsSnapThroughBeyondAQuarterOfATurn) {
  auto const energy = [](double phi) { return strain_energy_of(element<Directors>(), bent(phi)); };
  auto const of_bending = [&](double phi) {
    double const stretch = std::cos(0.5 * phi) - 1.0;
    return energy(phi) - 0.5 * 900.0 * stretch * stretch * l;
  };
  EXPECT_NEAR(of_bending(0.5 * pi), 0.5 * EI / l, 1e-11);
  EXPECT_NEAR(of_bending(pi), 0.0, 1e-11);
}

template <class I>
double change(VecX const& q, Placement const& motion) {
  return (strains<I>(carried(motion, q)) - strains<I>(q)).norm();
}
TEST(LrvfInterpolations, ARigidMotionStrainsNoneButRotationVectors) {
  VecX const q = bent(1.0);
  for (double const turn : {0.5, 2.0, 3.1}) {
    Placement const motion = Placement::at(Vec3(1, -2, 3), Vec3(turn, 0.1, 0.0));
    EXPECT_LT(change<RelativeRotation>(q, motion), 1e-14);
    EXPECT_LT(change<Polar>(q, motion), 1e-14);
    EXPECT_LT(change<Directors>(q, motion), 1e-14);
    EXPECT_GT(change<Direct>(q, motion), 1e-3) << turn;
  }
}

/// Rotations of both nodes of `element`.
Quaternions nodes_at(VecX const& q) { return {q.segment<4>(3), q.segment<4>(10)}; }
/// q ⊞ δ with the δ that moves the nodes to `next`.
template <class I>
VecX gone_to(Lrvf<I> const& beam, VecX const& q, Quaternions const& next) {
  VecX delta = VecX::Zero(12), out = q;
  for (int i = 0; i < 2; ++i)
    delta.segment<3>(6 * i + 3) = quaternion_minus<double>(next[std::size_t(i)], nodes_at(q)[std::size_t(i)]);
  beam.template plus<double>(numbers(q), numbers(delta), {out.data(), std::size_t(out.size())});
  return out;
}
template <class I>
VecX straight(Lrvf<I> const& beam) {
  VecX q(beam.coordinates());
  beam.reference({q.data(), std::size_t(q.size())});
  return q;
}
template <class I>
Vec3 turn_of(Lrvf<I> const& beam, VecX const& q) {
  return l * beam.section_strains(beam.at(0.5 * l), numbers(q)).template tail<3>();
}
/// l K after a closed path of node 2 in n steps: rotation about y, then towards z and back. Node 1 is at rest.
template <class I>
Vec3 after_a_round(int n) {
  Lrvf<I> const beam = element<I>();
  VecX q = straight(beam);
  for (int i = 1; i <= n; ++i) {
    double const t = 2.0 * pi * i / n;
    q = gone_to(beam, q, {quaternion(Vec3::Zero()), quaternion(Vec3(0.0, std::sin(t), 1.0 - std::cos(t)))});
  }
  return turn_of(beam, q);
}

// The strains of the other interpolations are functions of the nodes, so a closed path does not change them.
// Increments leave a curvature, which finer steps do not remove. The field of the nodes does not contain the rotation
// ½ (δθ₁ + δθ₂).
TEST(LrvfInterpolations, IncrementsLeaveACurvatureAfterAClosedPath) {
  double const coarse = after_a_round<Incremental>(200).norm(), fine = after_a_round<Incremental>(400).norm();
  EXPECT_NEAR(fine, 0.78, 0.005);
  EXPECT_NEAR(coarse / fine, 1.0, 0.001);
  EXPECT_LT(after_a_round<RelativeRotation>(200).norm(), 1e-13);
  EXPECT_LT(after_a_round<Polar>(200).norm(), 1e-13);
  EXPECT_LT(after_a_round<Direct>(200).norm(), 1e-13);
  EXPECT_LT(after_a_round<Directors>(200).norm(), 1e-13);
}

// A rigid rotation of a bent element changes its curvature, as with `Direct`.
TEST(LrvfInterpolations, IncrementsAreNotObjective) {
  Lrvf<Incremental> const beam = element<Incremental>();
  Quaternions const nodes = {quaternion(Vec3(0, 0, -0.5)), quaternion(Vec3(0, 0, 0.5))};
  VecX const q = gone_to(beam, straight(beam), nodes);
  EXPECT_NEAR((turn_of(beam, q) - Vec3(0, 0, 1)).norm(), 0.0, 1e-15);
  Quaternion<double> const carriage = quaternion(Vec3(1.0, 0.0, 0.0));
  VecX const turned = gone_to(
      beam, q, {quaternion_product<double>(carriage, nodes[0]), quaternion_product<double>(carriage, nodes[1])});
  EXPECT_NEAR((turn_of(beam, turned) - Vec3(0, 0, 1)).norm(), 0.08, 0.005);
}

// About one axis increments add up: the result is independent of the path, and all strains are those of
// `RelativeRotation`.
TEST(LrvfInterpolations, IncrementsInThePlaneAreObjective) {
  Lrvf<Incremental> const beam = element<Incremental>();
  Lrvf<RelativeRotation> const other = element<RelativeRotation>();
  VecX q = straight(beam), p = straight(other);
  for (double const turn : {0.4, 1.7, -0.8, 2.9, 1.1})
    for (double const phi : {0.5, -2.0, 1.3}) {
      Quaternions const nodes = {quaternion(Vec3(0, 0, turn - 0.5 * phi)), quaternion(Vec3(0, 0, turn + 0.5 * phi))};
      q = gone_to(beam, q, nodes);
      p = gone_to(other, p, nodes);
      Vec6 const strains = beam.section_strains(beam.at(0.5 * l), numbers(q));
      EXPECT_LT((strains - other.section_strains(other.at(0.5 * l), numbers(p))).norm(), 1e-14) << turn << ' ' << phi;
      EXPECT_NEAR(strains[5], phi / l, 1e-14);
      EXPECT_GT(strains.head<3>().norm(), 0.1);  // Γ is also nonzero
    }
}

}  // namespace lrvf_interpolations_test
}  // namespace polybody
