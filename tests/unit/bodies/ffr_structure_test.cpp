// Components of a floating frame body: inertia shape integrals, intermediate element frames, bases, and refused
// input.
#include <gtest/gtest.h>

#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/rigid/rigid.hpp>

#include "support/held.hpp"
#include "support/refusal.hpp"

namespace ffr_structure_test {

using namespace polybody;

Bar steel(double length, Placement const& place = {}) {
  return {.length = length,
          .section = Rectangle{.height = 0.03, .width = 0.05},
          .material = Material{.density = 7800.0, .young = 2e11, .poisson = 0.3},
          .placement = place};
}
Placement along(Vec3 const& from, Vec3 const& direction) { return {from, intermediate_axes(direction)}; }

/// Mass, ∫ρ u₀ and the inertia tensor about the origin of bars. Each is computed by `Rigid` and the parallel-axis
/// theorem.
struct Expected {
  double mass = 0.0;
  Vec3 first = Vec3::Zero();
  Mat3 inertia = Mat3::Zero();
  explicit Expected(std::vector<Bar> const& bars) {
    for (Bar const& bar : bars) {
      Rigid<> const b = Rigid<>::from(bar);
      Vec3 const c = bar.placement.origin + bar.placement.axes.col(0) * (0.5 * bar.length);
      mass += b.mass();
      first += b.mass() * c;
      inertia += bar.placement.axes * b.inertia() * bar.placement.axes.transpose() +
                 b.mass() * (c.squaredNorm() * Mat3::Identity() - c * c.transpose());
    }
  }
};

/// Frame with bars along x, parallel and antiparallel to the axis y that makes Eq. A.2 singular, and in general
/// directions.
std::vector<Bar> crooked() {
  return {steel(0.7), steel(0.4, along({0.7, 0, 0}, {0, 1, 0})), steel(0.3, along({0.7, 0.4, 0}, {0.3, -0.4, 0.6})),
          steel(0.5, along({0, 0, 0}, {0, -1, 0}))};
}

TEST(Structure, InertiaOfARigidFrameIsExactWhateverTheMesh) {
  Expected const e(crooked());
  for (Index n : {1, 3}) {
    Structure const s = structure_of(crooked(), {n, n, n, n});
    Ffr const body(s, nodal_coordinates(s));
    std::string const mesh = "Ffr, " + std::to_string(n) + (n == 1 ? " element a bar" : " elements a bar");
    auto const claim = [&](char const* what) {
      return Claim{"closed forms", what, By::closed_form, "prisms and the parallel-axis theorem", mesh};
    };
    held(claim("mass of a frame of four bars [kg]"), body.integrals().mass, e.mass, 1e-12 * e.mass);
    held_within(claim("first moment of a frame of four bars [kg m]"), (body.integrals().first - e.first).norm(),
                1e-12 * e.first.norm(), {.scale = e.first.norm()});
    held_within(claim("inertia of a frame of four bars [kg m²]"), (body.integrals().inertia - e.inertia).norm(),
                1e-12 * e.inertia.norm(), {.scale = e.inertia.norm()});
  }
}

// A rigid motion of all nodes is a rigid motion of every material point, including points off the axis. With the six
// infinitesimal rigid motions Φ, ΦᵀMΦ is the inertia of the rigid frame and KΦ = 0. First- and second-order integrals
// follow from it.
TEST(Structure, RigidMotionsOfTheNodesCarryTheBody) {
  Structure const s = structure_of(crooked(), {2, 1, 2, 1});
  Expected const e(crooked());
  MatX rigid = MatX::Zero(s.size(), 6);
  for (std::size_t i = 0; i < s.nodes.size(); ++i) {
    auto rows = rigid.middleRows<6>(6 * Index(i));
    rows.setIdentity();
    rows.topRightCorner<3, 3>() = -skew<double>(s.nodes[i]);
  }
  MatX const m = rigid.transpose() * (s.mass_matrix() * rigid);
  EXPECT_LT((m.topLeftCorner<3, 3>() - e.mass * Mat3::Identity()).norm(), 1e-12 * e.mass);
  EXPECT_LT((m.topRightCorner<3, 3>() + skew<double>(e.first)).norm(), 1e-12 * e.first.norm());
  EXPECT_LT((m.bottomRightCorner<3, 3>() - e.inertia).norm(), 1e-12 * e.inertia.norm());
  EXPECT_LT((s.stiffness * rigid).norm(), 1e-12 * s.stiffness.norm());
  // u₀ + S Φ (0, θ) = u₀ + θ × u₀: J changes by θ̃ J + (θ̃ J)ᵀ to first order
  FfrIntegrals const x = integrals_of(s, rigid);
  for (int k = 0; k < 3; ++k) {
    Mat3 const turned = skew<double>(Vec3::Unit(k)) * e.inertia, change = turned + turned.transpose();
    for (std::size_t p = 0; p < 6; ++p)
      EXPECT_NEAR(x.inertia_by[p][3 + k], change(symmetric_row[p], symmetric_column[p]), 1e-12 * e.inertia.norm())
          << k << ' ' << p;
    // H = ∫ρ ũ S: for rotations it is J, for translations it is the matrix of ∫ρ u₀
    EXPECT_LT((x.coupling.col(3 + k) - e.inertia.col(k)).norm(), 1e-12 * e.inertia.norm());
    EXPECT_LT((x.coupling.col(k) - e.first.cross(Vec3::Unit(k))).norm(), 1e-12 * e.first.norm());
  }
}

TEST(Structure, IntermediateAxesAreOrthonormalWherePointsEvenAlongY) {
  for (Vec3 const& d :
       {Vec3(1, 0, 0), Vec3(0, 2, 0), Vec3(0, -3, 0), Vec3(1, 2, -3), Vec3(1e-10, 1, 0), Vec3(0, 0, -1)}) {
    Mat3 const c = intermediate_axes(d);
    EXPECT_LT((c.transpose() * c - Mat3::Identity()).norm(), 1e-9) << d.transpose();
    EXPECT_NEAR(c.determinant(), 1.0, 1e-9);
    EXPECT_LT((c.col(0) - d.normalized()).norm(), 1e-9);
  }
}

/// Frequencies of small vibrations in a fixed frame: those of (K, M) of the deformation alone.
VecX held_frequencies(Ffr const& body) {
  return Eigen::GeneralizedSelfAdjointEigenSolver<MatX>(body.integrals().stiffness, body.integrals().mass_matrix)
      .eigenvalues()
      .cwiseSqrt();
}
/// Frequencies of the free body: those of the complete mass matrix, without rigid motions.
VecX free_frequencies(Ffr const& body) {
  VecX q(body.coordinates());
  body.reference({q.data(), std::size_t(q.size())});
  MatX m, k = MatX::Zero(body.velocities(), body.velocities());
  body.mass(0, {q.data(), std::size_t(q.size())}, m);
  k.bottomRightCorner(body.deformations(), body.deformations()) = body.integrals().stiffness;
  return Eigen::GeneralizedSelfAdjointEigenSolver<MatX>(k, m)
      .eigenvalues()
      .tail(body.deformations())
      .cwiseMax(0.0)
      .cwiseSqrt();
}
// Beam of E1 with EI = ρA = L = 1; the frequencies of other motions are far away.
Bar unit() {
  return {.length = 1.0,
          .constants = BarConstants{
              .EA = 1e6, .EI = 1.0, .mass_per_length = 1.0, .GJ = 10.0, .rotary_inertia = 1e-7, .EI_y = 1e4}};
}
double const clamped_free[3] = {3.516015268, 22.03449156, 61.69721441}, free_free[2] = {22.37328545, 61.67282287};

// Euler–Bernoulli frequencies (E1): Craig–Bampton with five fixed-interface modes, tolerance 1e-3.
TEST(Bases, GiveTheFrequenciesOfTheBeam) {
  Structure const s = structure_of(unit(), 16);
  Ffr const nodal(s, nodal_coordinates(s)), tied(s, fixed_interface_modes(s, 4)), cb(s, craig_bampton(s, {0, 16}, 5));
  auto const expect = [](char const* ends, char const* basis, VecX const& found, std::span<double const> exact) {
    for (std::size_t i = 0; i < exact.size(); ++i)
      held({"E1", std::string("frequencies ") + ends + " by bases of a structure, ω √(ρA L⁴/EI)", By::closed_form,
            std::string("β², cos β cosh β = ") + (exact.size() == 3 ? "−1" : "1"),
            std::string("Ffr, 16 elements, ") + basis},
           found[Index(i)], exact[i], 1e-3 * exact[i], {equals("mode", double(i + 1))});
  };
  expect("clamped–free", "nodal coordinates", held_frequencies(nodal), clamped_free);
  expect("clamped–free", "modes of the held structure", held_frequencies(tied), clamped_free);
  expect("clamped–free", "Craig–Bampton", held_frequencies(cb), clamped_free);
  Ffr const mean(s, free_interface_modes(s, 3)), cb_mean(s, craig_bampton(s, {0, 16}, 5, true));
  expect("free–free", "nodal coordinates", free_frequencies(nodal), free_free);
  expect("free–free", "Craig–Bampton", free_frequencies(cb), free_free);
  expect("free–free", "free-interface modes", free_frequencies(mean), free_free);
  expect("free–free", "Craig–Bampton, mean axes", free_frequencies(cb_mean), free_free);
}

// Mean axes: momentum and angular momentum of the deformation are zero.
TEST(Bases, MeanAxesDecoupleTheFrame) {
  Structure const s = structure_of(crooked(), {2, 2, 2, 2});
  for (MatX const& basis : {free_interface_modes(s, 6), craig_bampton(s, {0, 4}, 2, true)}) {
    FfrIntegrals const x = integrals_of(s, basis);
    EXPECT_LT(x.first_by.norm(), 1e-8);
    EXPECT_LT(x.coupling.norm(), 1e-8);
    EXPECT_LT((x.mass_matrix - MatX::Identity(x.size(), x.size())).norm(), 1e-8);
  }
}

// Statics is independent of the frame: a tip force on a clamped bar, with a frame fixed to either end or simply
// supported.
// A frame that holds nodes leaves fewer rigid motions, or none. No deformation mode is omitted.
TEST(Bases, FreeInterfaceModesOfAHeldStructureStartWithTheLowest) {
  Structure const s = structure_of(unit(), 16);
  auto const lowest = [&](ReferenceConditions const& frame) {
    VecX const mode = free_interface_modes(s, 1, frame);
    return std::sqrt(mode.dot(s.stiffness * mode) / mode.dot(s.mass_matrix() * mode));
  };
  EXPECT_NEAR(lowest(ReferenceConditions::none()), free_free[0], 1e-3 * free_free[0]);
  EXPECT_NEAR(lowest(ReferenceConditions::clamped()), clamped_free[0], 1e-3 * clamped_free[0]);
  double const pinned_free = 15.41820572;  // tan β = tanh β
  EXPECT_NEAR(lowest(ReferenceConditions::none().fix(0, 0).fix(0, 1).fix(0, 2)), pinned_free, 1e-3 * pinned_free);
}

TEST(Bases, SimplySupportedFrameHasTheSameFrequencies) {
  Structure const s = structure_of(unit(), 8);
  Ffr const a(s, nodal_coordinates(s)), b(s, nodal_coordinates(s, ReferenceConditions::simply_supported(0, 8)));
  VecX const fa = free_frequencies(a), fb = free_frequencies(b);
  ASSERT_EQ(fa.size(), fb.size());
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(fa[i] / fb[i], 1.0, 1e-7);
}

// A section is rigid. The displacement of a mode at (y, z) is the displacement on the axis plus the rotation times
// the offset.
TEST(Ffr, PointsOffTheAxisMoveWithTheirSection) {
  Structure const s = structure_of(unit(), 3);
  Ffr const body(s, fixed_interface_modes(s, 6));
  double const y = 0.03, z = -0.02;
  FfrPoint const axis = body.at(0.4), off = body.at(0.4, y, z);
  ASSERT_GT(axis.R.norm(), 1e-3);
  for (Index k = 0; k < axis.S.cols(); ++k) {
    Vec3 const turn = axis.R.col(k);
    EXPECT_LT((Vec3(off.S.col(k) - axis.S.col(k)) - turn.cross(Vec3(0, y, z))).norm(), 1e-12);
  }
}

TEST(Ffr, RefusesWhatCannotBeMeant) {
  Structure const s = structure_of(unit(), 4);
  EXPECT_TRUE(has(refusal([&] { fixed_interface_modes(s, 25); }), "25 modes"));
  EXPECT_TRUE(has(refusal([&] { free_interface_modes(s, 25); }), "25 modes"));
  EXPECT_TRUE(has(refusal([&] { craig_bampton(s, {0, 7}, 2); }), "node 7 does not exist"));
  EXPECT_TRUE(has(refusal([&] { craig_bampton(s, {0, 0}, 2); }), "there are 2 boundary nodes, 1 of them distinct"));
  EXPECT_TRUE(has(refusal([&] { nodal_coordinates(s, ReferenceConditions::clamped(9)); }), "node 9 does not exist"));
  EXPECT_TRUE(has(refusal([&] { nodal_coordinates(s, ReferenceConditions().fix(0, 7)); }), "component 7"));
  EXPECT_TRUE(has(refusal([&] { nodal_coordinates(s, ReferenceConditions().fix(0, 0)); }), "not positive definite"));
  EXPECT_TRUE(has(refusal([&] { nodal_coordinates(s, ReferenceConditions::none()); }), "not positive definite"));
  EXPECT_TRUE(has(refusal([&] { intermediate_axes(Vec3::Zero()); }), "two different nodes"));
  Bar bar = unit();
  bar.length = 0.0;
  EXPECT_TRUE(has(refusal([&] { structure_of(bar, 4); }), "length"));
  bar = unit();
  bar.constants->GJ = 0.0;
  EXPECT_TRUE(has(refusal([&] { Ffr::from(bar, 4); }), "GJ"));
  EXPECT_TRUE(has(refusal([&] { structure_of(unit(), 0); }), "element"));
  EXPECT_TRUE(has(refusal([&] { Ffr(s, MatX::Zero(5, 2)); }), "rows"));
  EXPECT_TRUE(has(refusal([&] { Ffr(s, MatX::Ones(s.size(), 2)); }), "positive definite"));
  Bar apart = steel(1.0, {Vec3(5, 0, 0)});
  Structure const two = structure_of({steel(1.0), apart}, {1, 1});
  EXPECT_TRUE(has(refusal([&] { nodal_coordinates(two); }), "not positive definite"));
  Ffr const body(s, fixed_interface_modes(s, 2));
  EXPECT_TRUE(has(refusal([&] { body.at(1.5); }), "outside"));
  EXPECT_TRUE(has(refusal([&] { body.at(0.5, 0.0, 0.0, 1); }), "bar 1 does not exist"));
  EXPECT_TRUE(has(refusal([&] { body.node(5); }), "node 5"));
  EXPECT_TRUE(has(refusal([&] { Ffr(body.integrals(), {}).node(0); }), "integrals only"));
  FfrIntegrals bad = body.integrals();
  bad.stiffness.resize(3, 3);
  EXPECT_TRUE(has(refusal([&] { Ffr(bad, {}); }), "the integral \"stiffness\" is 3×3, but must be "));
  bad = body.integrals();
  bad.mass_matrix(0, 0) = -1.0;
  EXPECT_TRUE(has(refusal([&] { Ffr(bad, {}); }), "positive definite"));
}

}  // namespace ffr_structure_test
