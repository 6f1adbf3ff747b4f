// Wallin 2016, sections 2.5.1 and 2.7: the two meshes "differ by an arbitrary rigid body displacement". The tests
// compute in closed form the parts of the difference that a rigid displacement removes, and the remaining parts.
#include <gtest/gtest.h>

#include "../../examples/chapter2_meshes.hpp"
#include "support/held.hpp"
#include "support/refusal.hpp"

namespace thesis_meshes_test {

using namespace chapter2;

Claim closed(char const* what, char const* source, char const* formulation) {
  return {"thesis, ch. 2", what, By::closed_form, source, formulation};
}

planar::Lrvf beam(Index n) { return planar::Lrvf::from(bar(low, 7850.0), n); }

/// Coordinates q of nodes that a function of their number gives as (x, y, theta).
template <class F>
std::vector<double> nodes(Index n, F&& node) {
  std::vector<double> q;
  for (Index i = 0; i <= n; ++i) {
    Vec3 const at = node(double(i));
    q.insert(q.end(), {at[0], at[1], at[2]});
  }
  return q;
}

/// Root mean square of the distances from the mean.
double spread(std::vector<Vec2> const& points) {
  Vec2 mean = Vec2::Zero();
  for (Vec2 const& p : points) mean += p / double(points.size());
  double sum = 0.0;
  for (Vec2 const& p : points) sum += (p - mean).squaredNorm() / double(points.size());
  return std::sqrt(sum);
}

TEST(ThesisMeshes, ARigidDisplacementIsFound) {
  std::vector<Vec2> const from{{0.0, 0.0}, {1.0, 0.2}, {1.7, -0.4}, {2.5, 0.9}};
  std::vector<Vec2> to;
  for (Vec2 const& p : from) to.push_back(Eigen::Rotation2Dd(2.3) * p + Vec2(0.7, -1.1));
  RigidFit const fit = rigid_fit(from, to);
  EXPECT_NEAR(fit.turn, 2.3, 1e-15);
  EXPECT_LT((fit.shift - Vec2(0.7, -1.1)).norm(), 1e-15);
  EXPECT_LT(fit.left, 1e-15);
  EXPECT_GT(fit.apart, 1.0);
  EXPECT_TRUE(has(refusal([&] { (void)rigid_fit(from, {}); }), "the same number of points"));
}

// The rigid displacement has the least sum of squares of all rotations and translations.
TEST(ThesisMeshes, TheRigidDisplacementIsTheBest) {
  std::vector<Vec2> const from{{0.0, 0.0}, {1.0, 0.2}, {1.7, -0.4}}, to{{0.1, 0.3}, {0.8, 0.9}, {1.9, 0.4}};
  RigidFit const best = rigid_fit(from, to);
  auto const left = [&](double turn, Vec2 const& shift) {
    double sum = 0.0;
    for (std::size_t i = 0; i < from.size(); ++i)
      sum += (to[i] - shift - Eigen::Rotation2Dd(turn) * from[i]).squaredNorm();
    return std::sqrt(sum / double(from.size()));
  };
  EXPECT_NEAR(left(best.turn, best.shift), best.left, 1e-15);
  for (double const d : {-1e-3, 1e-3}) {
    EXPECT_GT(left(best.turn + d, best.shift), best.left);
    EXPECT_GT(left(best.turn, best.shift + Vec2(d, 0.0)), best.left);
    EXPECT_GT(left(best.turn, best.shift + Vec2(0.0, d)), best.left);
  }
}

// Uniform strains on straight sections: r = s ((1 + eps) t1 + gamma t2) compared with s t1. The best rigid
// displacement rotates by the angle of the shear, atan(gamma/(1 + eps)). The stretch lambda = |r'| remains for every
// rotation and translation.
TEST(ThesisMeshes, UniformStrainsDifferByATurnAndAStretch) {
  Index const n = 10;
  planar::Lrvf const b = beam(n);
  double const eps = 0.08, gamma = 0.05, theta = 0.4, lambda = std::hypot(1.0 + eps, gamma);
  Vec2 const along = Eigen::Rotation2Dd(theta) * Vec2(1.0 + eps, gamma);
  std::vector<double> const q = nodes(n, [&](double i) { return Vec3(i * along[0], i * along[1], theta); });
  Apart const a = meshes_apart(b, q);
  char const* const body = "Lrvf, 10 elements, uniform stretch 0.08 and shear 0.05";
  held(closed("largest gap of the meshes [m]", "L sqrt(eps^2 + gamma^2)", body), a.gap, length * std::hypot(eps, gamma),
       1e-13);
  EXPECT_LT(a.interpolation.norm(), 1e-14);
  held(closed("turn of the best rigid displacement [rad]", "angle of the shear", body), a.rigid.turn,
       std::atan2(gamma, 1.0 + eps), 1e-14);
  double const straight = std::sqrt(10.0);  // of 0, 1, ..., 10 m about 5 m: ((n + 1)^2 - 1)/12
  held(closed("rms gap left by the best rigid displacement [m]", "(lambda - 1) spread", body), a.rigid.left,
       (lambda - 1.0) * straight, 1e-13);
  EXPECT_NEAR(a.element, lambda - 1.0, 1e-14);
}

// Pure rotation, lambda = 1: in this case the two meshes differ by a rigid displacement. It is the shear, which has
// strain energy.
TEST(ThesisMeshes, AShearWithoutStretchIsARigidTurn) {
  planar::Lrvf const b = beam(10);
  double const psi = 0.1;
  std::vector<double> const q = nodes(10, [&](double i) { return Vec3(i * std::cos(psi), i * std::sin(psi), 0.0); });
  Apart const a = meshes_apart(b, q);
  EXPECT_NEAR(a.rigid.turn, psi, 1e-14);
  EXPECT_LT(a.rigid.left, 1e-13);
  double energy = 0.0;
  for (Index e = 0; e < 10; ++e) energy += b.strain_energy(e, q);
  double const c = 1.0 - std::cos(psi);
  EXPECT_NEAR(energy, 5.0 * (low.EA * c * c + low.GA * std::sin(psi) * std::sin(psi)), 1e-9);
}

// Pure bending has no strain in the middle of the elements. The chords of the position mesh have the length l, those
// of the implied arc l s in the same directions. The figures are similar about the first node. A constraint on
// strains would have no effect.
TEST(ThesisMeshes, PureBendingDiffersByASimilarFigure) {
  for (Index const n : {10, 20, 40}) {
    chapter2::Cantilever<planar::Lrvf> beam(bar(low, 7850.0), n, 30e3);
    State x = beam.model.reference_state();
    equilibrium(beam.model, x, {.load_steps = 5});
    auto const q = coordinates_of(beam.model, x, beam.beam);
    Apart const a = meshes_apart(beam.beam.body(), q);
    double const kappa = 30e3 / low.EI, half = 0.5 * kappa * length / double(n), s = std::sin(half) / half;
    double chord = 0.0;  // longest chord from the first node on the implied circle
    std::vector<Vec2> circle;
    for (Index i = 0; i <= n; ++i) {
      double const turned = kappa * length * double(i) / double(n);
      circle.push_back(Vec2(std::sin(turned), 1.0 - std::cos(turned)) / kappa);
      chord = std::max(chord, circle.back().norm());
    }
    Instance const mesh{.at = equals("elements", double(n))};
    char const* const body = "Lrvf, low stiffness, 30 kN m at rest";
    held(closed("largest gap of the meshes [m]", "(1/s - 1) chord", body), a.gap, (1.0 / s - 1.0) * chord, 1e-9, mesh);
    EXPECT_LT(a.strain.norm(), 1e-9);
    EXPECT_NEAR(a.rigid.turn, 0.0, 1e-9);
    held(closed("rms gap left by the best rigid displacement [m]", "(1/s - 1) spread", body), a.rigid.left,
         (1.0 / s - 1.0) * spread(circle), 1e-9, mesh);
    EXPECT_NEAR(a.bow, (1.0 - std::cos(half)) / kappa, 1e-9);
  }
}

/// Nodes of a state far from the reference.
std::vector<double> any_nodes() {
  return nodes(10, [](double i) {
    return Vec3(1.1 * i + 0.3 * std::sin(2.0 * i), 0.5 * std::sin(3.0 * i), 0.8 * std::cos(1.7 * i) - 0.8);
  });
}

// The difference is the sum of strains and interpolation in any state. The implied curve is integrated with five
// Gauss points, with an error of 4e-13 phi^10 for an element that rotates by phi. The part of the interpolation of the
// Lrvf is the sum of l (1 - s) t1.
TEST(ThesisMeshes, StrainsAndInterpolationMakeTheGap) {
  planar::Lrvf const b = beam(10);
  std::vector<double> const q = any_nodes();
  Apart const a = meshes_apart(b, q);
  MeshDiagnostics const d = mesh_diagnostics(b, q);
  Vec2 interpolation = Vec2::Zero(), found = Vec2::Zero();
  for (std::size_t i = 1; i <= 10 && found.isZero(0.0); ++i) {
    double const first = q[3 * i - 1], last = q[3 * i + 2], half = 0.5 * (last - first);
    interpolation += (1.0 - std::sin(half) / half) * (Eigen::Rotation2Dd(0.5 * (first + last)) * Vec2(1.0, 0.0));
    if ((d.position_nodes[i] - d.rotation_nodes[i]).norm() == a.gap) found = interpolation;
  }
  EXPECT_LT((a.interpolation - found).norm(), 2e-11);
  EXPECT_GT(a.interpolation.norm(), 0.1);
}

Claim only_strains(char const* formulation) {
  return closed("part of the interpolation in the distance of the two meshes, of the length",
                "r' = R (e1 + Gamma) with constant Gamma", formulation);
}

// An element of Se3Beam has one interpolation of position and rotation. The whole distance is due to the strains.
TEST(ThesisMeshes, TheGapOfAnSe3BeamIsThatOfItsStrains) {
  auto const b = planar::Se3Beam::from(bar(low, 7850.0), 10);
  Apart const a = meshes_apart(b, any_nodes());
  EXPECT_LT(a.interpolation_of_all, 2e-11);
  EXPECT_NEAR(a.strain.norm(), a.gap, 2e-11);
  EXPECT_GT(a.gap, 1.0);
}

/// The arm of low stiffness after 4 s of the ramp of 4.5 s (Figure 2.7), under an axial force at the tip.
template <class B>
Apart arm(Index n, double axial_force) {
  RobotArm<B> arm(bar(low, 7850.0), n, 4.5, axial_force);
  State x = arm.model.reference_state();
  simulate(arm.model, x, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = 4.0, .step = 5e-3}).run();
  return meshes_apart(arm.arm.body(), coordinates_of(arm.model, x, arm.arm));
}

TEST(ThesisMeshes, TheInterpolationPartOnTheArm) {
  for (double const force : {0.0, 100e3}) {
    Apart const one = arm<planar::Se3Beam>(10, force), two = arm<planar::Lrvf>(10, force);
    Instance const at{equals("force at the tip", force), 1.0};
    held_within(only_strains("planar Se3Beam, low stiffness, ramp of 4.5 s"), one.interpolation_of_all / length, 1e-12,
                at);
    EXPECT_NEAR(one.strain.norm(), one.gap, 1e-12 * length);
    EXPECT_GT(one.gap, 0.1);
    EXPECT_GT(two.interpolation_of_all, 1e-3);
  }
}

// phi is proportional to l, so that sum l (1 - s) t1 is of second order. The angles at the nodes also depend on the
// mesh.
TEST(ThesisMeshes, TheInterpolationPartOfTheLrvfIsOfSecondOrder) {
  double const coarse = arm<planar::Lrvf>(20, 0.0).interpolation_of_all,
               fine = arm<planar::Lrvf>(40, 0.0).interpolation_of_all;
  held({"thesis, ch. 2", "order of the interpolation part of the distance", By::closed_form, "sum of l phi^2/24",
        "Lrvf, low stiffness, 20 and 40 elements"},
       std::log2(coarse / fine), 2.0, 0.1);
}

}  // namespace thesis_meshes_test
