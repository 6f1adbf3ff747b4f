// Properties of Se3Beam and planar::Se3Beam in statics: states of constant strain with one element, absence of locking,
// order two. Se3Beam also in dynamics: symmetry of the tangent, invariance and conservation.

#include <polybody/bodies/se3/planar_se3_beam.hpp>
#include <polybody/bodies/se3/se3_beam.hpp>

#include <gtest/gtest.h>

#include <numbers>

#include <polybody/compare/mesh_diagnostics.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/run/energy.hpp>
#include <polybody/run/simulate.hpp>

#include "support/cantilever.hpp"
#include "support/spatial_cantilever.hpp"
#include "support/straight_se3_bar.hpp"

using namespace polybody;

namespace se3_beam_properties_test {

using std::numbers::pi;
using Rod = SpatialCantilever<Se3Beam>;

double const length = 1.3;
Vec6 const stiffness = (Vec6() << 900, 300, 350, 25, 60, 40).finished();

// ---- beams in space and in the plane

template <class B>
struct Se3Beams : testing::Test {};
using SpaceAndPlane = testing::Types<Se3Beam, planar::Se3Beam>;
TYPED_TEST_SUITE(Se3Beams, SpaceAndPlane);

template <class B>
constexpr bool flat = B::world == World::plane;

/// Cantilever in equilibrium. For a planar beam, the loads are in the plane.
template <class B>
auto loaded(B const& body, TipLoad const& load, int steps = 1) {
  EquilibriumOptions const options{.load_steps = steps};
  if constexpr (flat<B>)
    return Cantilever<B>(body, {.force = load.force.head<2>(), .axes = load.axes, .moment = load.moment[2]}, options);
  else
    return SpatialCantilever<B>(body, load, options);
}
/// Beam whose undeformed shape is `curve`.
template <class B>
B curved(Bar const& bar, Index n, ReferenceCurve const& curve) {
  if constexpr (flat<B>)
    return B::naturally_curved(bar, n, curve);
  else
    return B::from(bar, n, curve);
}
template <class Cantilever>
Frame<double> section_of(Cantilever const& rod, double s) {
  return frame(rod.model, rod.x, rod.bar.at(s));
}
/// Displacement of the tip.
template <class Cantilever>
Vec3 moved(Cantilever const& rod) {
  auto const end = rod.bar.at(rod.bar.body().length());
  return position(rod.model, rod.x, end) - position(rod.model, rod.model.reference_state(), end);
}

// ---- equilibrium of constant strain

// Roll-up by a tip moment M = θ EI/L about any axis across the bar: an arc of radius L/θ. One element reaches nearly
// half a circle, three elements the full one. In the plane one element reaches nearly a full circle.
TYPED_TEST(Se3Beams, OneElementRollsUpToAnArc) {
  Bar const bar{.length = 1.0,
                .constants = BarConstants{.EA = 300, .EI = 1, .mass_per_length = 1, .GA = 200, .GJ = 0.7}};
  struct {
    Index elements;
    double theta;
  } const arcs[] = {
      {1, 0.5 * pi}, {1, (flat<TypeParam> ? 1.9 : 0.95) * pi}, {2, 1.5 * pi}, {3, 2.0 * pi}, {5, 4.0 * pi}};
  for (auto const& [n, theta] : arcs)
    for (double const axis : {0.0, 1.3}) {
      if (flat<TypeParam> && axis != 0.0) continue;
      Vec3 const about(0, -std::sin(axis), std::cos(axis)), across(0, std::cos(axis), std::sin(axis));
      auto const rod = loaded(TypeParam::from(bar, n), {.moment = theta * about}, 20);
      for (double const s : {0.3, 0.5, 1.0}) {
        Vec3 const exact = std::sin(theta * s) / theta * Vec3::UnitX() + (1 - std::cos(theta * s)) / theta * across;
        Frame<double> const section = section_of(rod, s);
        EXPECT_LT((section.r - exact).norm(), 1e-10) << n << ", " << theta << ", " << s;
        EXPECT_LT((section.A - exp_so3<double>(theta * s * about)).norm(), 1e-9) << n << ", " << theta;
      }
    }
}

// A rod with the strains (Γ, K) along its whole length is in equilibrium if n = α K and m = α (e₁ + Γ) + β K. With the
// reference curvature K₀ = K − C⁻¹ m and the shear Γ = C⁻¹ n, one element under the end wrench (n, m) is the helix. In
// the plane α = 0: an arc of another curvature.
TYPED_TEST(Se3Beams, OneElementOfInitialCurvatureBecomesAHelix) {
  double const alpha = flat<TypeParam> ? 0.0 : 12.0, beta = 6.0;
  Vec3 const k = flat<TypeParam> ? Vec3(0, 0, 1.6) : Vec3(0.9, 0.3, 1.6), n = alpha * k,
             gamma = n.cwiseQuotient(stiffness.head<3>());
  Vec3 const m = alpha * (Vec3::UnitX() + gamma) + beta * k, k0 = k - m.cwiseQuotient(stiffness.tail<3>());
  Vec6 const free = six(0, 0, 0, k0[0], k0[1], k0[2]), strains = six(gamma[0], gamma[1], gamma[2], k[0], k[1], k[2]);
  for (Index const elements : {1, 2, 7}) {
    auto const curve = [&](double s) { return helix(free, s); };
    auto const rod = loaded(curved<TypeParam>(straight_bar(), elements, curve),
                            {.force = n, .moment = m, .axes = LoadAxes::marker}, 10);
    for (double const s : {0.3 * length, length}) {
      Placement const exact = helix(strains, s);
      Frame<double> const section = section_of(rod, s);
      EXPECT_LT((section.r - exact.origin).norm(), 1e-9) << elements;
      EXPECT_LT((section.A - exact.axes).norm(), 1e-9) << elements;
      Vec6 const forces = section_forces(rod.model, rod.x, rod.bar.at(s));
      EXPECT_LT((forces - six(n[0], n[1], n[2], m[0], m[1], m[2])).norm(), 1e-7) << elements;
    }
  }
}

// ---- locking, order, symmetry

/// Row of a transverse load: z in space, y in the plane.
template <class B>
constexpr int transverse = flat<B> ? 1 : 2;

/// Tip deflection of a cantilever of slenderness L/h under a small force, divided by F L³/3EI + F L/GA.
template <class B>
double relative_deflection(double slenderness, Index n) {
  double const h = 1.0 / slenderness, young = 1e9;
  Bar const bar{.length = 1.0,
                .section = Rectangle{.height = h, .width = h},
                .material = Material{.density = 1000, .young = young, .poisson = 0.3}};
  BarConstants const c = constants(bar);
  double const force = 1e-4 * 3 * c.EI;
  auto const rod = loaded(B::from(bar, n), {.force = force * Vec3::Unit(transverse<B>)});
  return moved(rod)[transverse<B>] / (force / (3 * c.EI) + force / c.GA);
}

// The curvature is constant in an element: w = F L³/3EI (1 − 1/4n²) + F L/GA for any slenderness, without reduced
// quadrature.
TYPED_TEST(Se3Beams, ThinBeamsDoNotLock) {
  for (double const slenderness : {10.0, 1e2, 1e3, 1e4, 1e5})
    for (Index const n : {1, 2, 4, 16}) {
      double const shear =
          3 * 1e9 / 12 * std::pow(1 / slenderness, 2) / (10 * 1.3 / (12 + 11 * 0.3) * 1e9 / 2.6);  // 3EI/GA L²
      double const expected = (1.0 - 0.25 / double(n * n) + shear) / (1.0 + shear);
      EXPECT_NEAR(relative_deflection<TypeParam>(slenderness, n), expected, 1e-6) << slenderness << ", " << n;
    }
}

// Dead loads, initial curvature: errors decrease with l².
TYPED_TEST(Se3Beams, ErrorsAreOfSecondOrder) {
  bool const plane = flat<TypeParam>;
  auto const tip = [&](Index n) {
    auto const arc = [&](double s) { return helix(plane ? six(0, 0, 0, 0, 0, 1.1) : six(0, 0, 0, 0.4, -0.5, 1.1), s); };
    TipLoad const load{.force = {3, -8, plane ? 0.0 : 15.0}, .moment = plane ? Vec3(0, 0, -2) : Vec3(1, 2, -2)};
    return Vec3(section_of(loaded(curved<TypeParam>(straight_bar(), n, arc), load, 4), length).r);
  };
  Vec3 const a = tip(8), b = tip(16), c = tip(32), d = tip(64), limit = (4.0 * d - c) / 3.0;
  EXPECT_NEAR((a - limit).norm() / (b - limit).norm(), 4.0, 0.1);
  EXPECT_NEAR((b - limit).norm() / (c - limit).norm(), 4.0, 0.03);
}

// Distributed load p over the whole cantilever: w = p L⁴/8EI + p L²/2GA and the support force p L, for small
// deflections. The load acts at points of the helices.
TYPED_TEST(Se3Beams, DistributedLoadBendsTheCantilever) {
  Bar const bar = straight_bar();
  BarConstants const c = constants(bar);
  double const p = 1e-3, bending = flat<TypeParam> ? double(c.EI) : *c.EI_y,
               shear = flat<TypeParam> ? double(c.GA) : *c.GA_z;
  double const exact = p * std::pow(length, 4) / (8 * bending) + p * length * length / (2 * shear);
  Vec3 const force = p * Vec3::Unit(transverse<TypeParam>);
  auto const deflection = [&](Index n) {
    auto rod = loaded(TypeParam::from(bar, n), {});
    apply_distributed(rod.model, rod.bar, PointForce<>{.force = force}, {.from = 0.0, .to = length, .pieces = n});
    rod.x = rod.model.reference_state();
    equilibrium(rod.model, rod.x);
    EXPECT_NEAR(reaction(rod.model, rod.x, rod.clamp).f[transverse<TypeParam>], -p * length, 1e-12);
    return moved(rod)[transverse<TypeParam>];
  };
  double const coarse = deflection(8), fine = deflection(16);
  EXPECT_NEAR((coarse - exact) / (fine - exact), 4.0, 0.01);
  EXPECT_NEAR((4.0 * fine - coarse) / 3.0, exact, 1e-6 * exact);
}

/// Largest distance between the nodes and the curve that the rotations imply, r(0) + ∫ R e₁ ds, without the part
/// Σ ∫ R Γ ds of the strains: the part of the interpolation.
template <class B>
double interpolation_part(Index n) {
  SpatialCantilever<B> const rod(B::from(straight_bar(), n), {.force = {-4, 12, 7}, .moment = {3, -2, 5}},
                                 {.load_steps = 6});
  B const& beam = rod.bar.body();
  std::span<double const> const q = rod.coordinates();
  auto const axes = [&](double s) { return beam.rotation_field(beam.at(s), q).R; };
  std::vector<Vec3> const implied = implied_curve(axes, length, 4 * n, Vec3::Zero());
  double largest = 0.0;
  Vec3 strained = Vec3::Zero();
  for (Index i = 0; i <= n; ++i) {
    Vec3 const node(q[std::size_t(7 * i)], q[std::size_t(7 * i + 1)], q[std::size_t(7 * i + 2)]);
    largest = std::max(largest, (node - implied[std::size_t(4 * i)] - strained).norm());
    if (i == n) break;
    Vec3 const gamma = beam.section_strains({i, 0.5}, q).template head<3>();
    for (GaussPoint const& g : gauss<8>)
      strained += g.weight * length / double(n) * axes((double(i) + g.xi) * length / double(n)) * gamma;
  }
  return largest;
}

// One interpolation has no second curve: nodes and rotations differ by the strains only [thesis Chapter 2]. The two
// interpolations of Lrvf differ by its chords as well.
TEST(Se3BeamMesh, NodesAndRotationsAgreeUpToTheStrains) {
  for (Index const n : {1, 2, 4, 8}) EXPECT_LT(interpolation_part<Se3Beam>(n), 1e-12) << n;
  EXPECT_GT(interpolation_part<Lrvf<>>(4), 5e-4);
}

// At an equilibrium under dead forces the tangent of the free nodes is symmetric. Elsewhere its skew part is
// ½ m̃, with the moments m of the elements on the nodes.
TEST(Se3BeamMesh, TangentIsSymmetricAtEquilibrium) {
  Index const n = 6;
  Bar bar = straight_bar();
  bar.damping = {};
  Rod const rod(Se3Beam::from(bar, n), {.force = {-4, 12, 7}}, {.load_steps = 4});
  auto const assembled = [&](std::span<double const> q) {
    MatX k = MatX::Zero(6 * (n + 1), 6 * (n + 1));
    VecX f = VecX::Zero(6 * (n + 1)), rest = f;
    for (Index e = 0; e < n; ++e) {
      Mat<double, 12, 12> of_element;
      Vec<double, 12> force;
      rod.bar.body().tangent(e, q, numbers(rest), 1.0, 0.0, of_element);
      rod.bar.body().force<double>(e, q, numbers(rest), force);
      k.block<12, 12>(6 * e, 6 * e) += of_element;
      f.segment<12>(6 * e) += force;
    }
    return std::pair(k, f);
  };
  auto const [k, f] = assembled(rod.coordinates());
  EXPECT_GT(rod.tip_displacement().norm(), 0.15);
  MatX const free = k.bottomRightCorner(6 * n, 6 * n);
  EXPECT_LT((free - free.transpose()).norm(), 1e-9 * free.norm());
  EXPECT_LT(f.segment(6, 6 * (n - 1)).norm(), 1e-8);  // inner nodes are in equilibrium
  VecX const away =
      nodes_of(n, [&](double i) { return helix(six(0.1, 0.2, -0.1, 1.5 * i, 0.6, -0.9), i * length / n); });
  auto const [k_away, f_away] = assembled(numbers(away));
  MatX expected = MatX::Zero(6 * (n + 1), 6 * (n + 1));
  for (Index i = 0; i <= n; ++i)
    expected.block<3, 3>(6 * i + 3, 6 * i + 3) = -skew<double>(f_away.segment<3>(6 * i + 3));
  EXPECT_GT(expected.norm(), 1.0);
  EXPECT_LT((k_away - k_away.transpose() - expected).norm(), 1e-11 * k_away.norm());
}

// ---- motion

// A motion of the free beam from two positions and orientations. The integrator is objective as well, so that all nodes
// agree.
template <class I>
VecX flown(Placement const& place, I const& method, double step) {
  Bar bar = straight_bar();
  bar.placement = place;
  Model<Bodies<Se3Beam>, Joints<>> model;
  model.add(Se3Beam::from(bar, 3), "beam");
  State x = model.reference_state();
  for (Index i = 0; i <= 3; ++i) {
    x.v.segment<3>(6 * i) = place.axes * Vec3(0.5, 2.0 * double(i * i), -1.0 * double(i));
    x.v.segment<3>(6 * i + 3) = Vec3(3.0, -4.0 * double(i), 1.0);
  }
  simulate(model, x, method, {.end_time = 0.3, .step = step}).run();
  EXPECT_GT(energy(model, x).strain, 1.0);
  return VecX(carried({.origin = -place.axes.transpose() * place.origin, .axes = place.axes.transpose()}, x.q));
}
TEST(Se3BeamMotion, RigidMotionOfTheWholeModelChangesNothing) {
  Placement const there = Placement::at({3, -2, 7}, {0.7, 2.1, -1.3});
  auto const compare = [&](auto const& method, double step) {
    VecX const a = flown({}, method, step), b = flown(there, method, step);
    for (Index i = 0; i <= 3; ++i) {
      EXPECT_LT((a.segment<3>(7 * i) - b.segment<3>(7 * i)).norm(), 1e-9) << i;
      EXPECT_NEAR(std::abs(a.segment<4>(7 * i + 3).dot(b.segment<4>(7 * i + 3))), 1.0, 1e-9) << i;
    }
    return a;
  };
  VecX const implicit = compare(GeneralisedAlpha{.rho_inf = 0.9}, 2e-4);
  VecX const explicitly = compare(RungeKutta4<>{}, 2e-4);
  EXPECT_LT((implicit.head<3>() - explicitly.head<3>()).norm(), 1e-3);
}

// Without damping, the energy is that of the start, and momentum and angular momentum are constant.
TEST(Se3BeamMotion, FreeFlightConservesEnergyAndMomentum) {
  Bar bar = spatial_lrvf_bar();
  bar.damping = {};
  Model<Bodies<Se3Beam>, Joints<>> model;
  model.add(Se3Beam::from(bar, 4), "beam");
  State x = model.reference_state();
  for (Index i = 0; i <= 4; ++i) {
    x.v.segment<3>(6 * i) = Vec3(0.5, 0.8 * double(i * i), -1.0 * double(i));
    x.v.segment<3>(6 * i + 3) = Vec3(3.0, -2.0 * double(i), 1.0);
  }
  double const before = energy(model, x).total();
  auto const m0 = momentum(model, x);
  simulate(model, x, RungeKutta4<>{}, {.end_time = 0.5, .step = 1e-4}).run();
  EXPECT_GT(energy(model, x).strain, 0.05 * before);
  EXPECT_NEAR(energy(model, x).total(), before, 1e-8 * before);
  auto const m1 = momentum(model, x);
  EXPECT_LT((m1.linear - m0.linear).norm(), 1e-10 * m0.linear.norm());
  EXPECT_LT((m1.angular - m0.angular).norm(), 1e-7 * m0.angular.norm());
}

}  // namespace se3_beam_properties_test
