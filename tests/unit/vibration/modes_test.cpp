#include <polybody/vibration/modes.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ffr/beam_structure.hpp>
#include <polybody/bodies/ffr/ffr_basis.hpp>
#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/statics/equilibrium.hpp>

#include "support/chain.hpp"
#include "support/refusal.hpp"

using namespace polybody;

namespace modes_test {

// The stiffness of a hinged rod consists of a second-order term: ω² = m g d/J about the hinge, here 3g/2L. In the
// inverted position it is −3g/2L.
TEST(Modes, OfAHangingAndOfAStandingRod) {
  for (double const sign : {1.0, -1.0}) {
    Chain<InSpace<Constraint>> chain(1, bar_link(0.8), sign * 9.81, 0.0);
    State x = chain.model.reference_state();
    equilibrium(chain.model, x);
    Modes const m = modes(chain.model, x);
    ASSERT_EQ(m.frequency.size(), 1);
    EXPECT_NEAR(m.frequency[0], sign * std::sqrt(1.5 * 9.81 / 0.8), 1e-9);
    EXPECT_NEAR(std::abs(m.shape(5, 0)), 1.0 / std::sqrt(1.0 * 0.8 * 0.8 / 3.0), 1e-9);  // unit generalised mass
  }
}

// Double pendulum of point masses m, lengths l: ω² = (2 ± √2) g/l.
TEST(Modes, OfADoublePendulum) {
  Chain<InPlane<Constraint>> chain(2, point_link(0.5), 9.81, 0.0);
  State x = chain.model.reference_state();
  equilibrium(chain.model, x);
  Modes const m = modes(chain.model, x);
  ASSERT_EQ(m.frequency.size(), 2);
  for (int i = 0; i < 2; ++i)
    EXPECT_NEAR(m.frequency[i], std::sqrt((2.0 + (i ? 1.0 : -1.0) * std::sqrt(2.0)) * 9.81 / 0.5), 1e-9);
}

/// Mass on a slide with a spring and a damper.
struct Oscillator {
  using Slide = Joint<planar::Prismatic, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Slide>, Forces<SpringDamper>> model;
  State x;
  Oscillator(double mass, double stiffness, double damping) {
    auto const block = model.add(planar::Rigid(mass, 1.0, Placement::planar(2.0, 0.0)), "block");
    model.connect(Slide{}, model.ground().at({0, 0, 0}), block.at(Vec2(0, 0)), "slide");
    model.apply(SpringDamper{.stiffness = stiffness, .damping = damping, .free_length = 2.0},
                model.ground().at({0, 0, 0}), block.at(Vec2(0, 0)));
    x = model.reference_state();
  }
};

TEST(DampedModes, OfAnOscillator) {
  double const m = 2.0, k = 50.0, omega = 5.0, zeta = 0.3;
  Oscillator const o(m, k, 2.0 * zeta * omega * m);
  DampedModes const d = damped_modes(o.model, o.x);
  ASSERT_EQ(d.eigenvalue.size(), 1);
  EXPECT_NEAR(d.frequency(0), omega, 1e-10);
  EXPECT_NEAR(d.damping_ratio(0), zeta, 1e-11);
  EXPECT_NEAR(d.eigenvalue[0].imag(), omega * std::sqrt(1.0 - zeta * zeta), 1e-10);
  EXPECT_NEAR(modes(o.model, o.x).frequency[0], omega, 1e-10);
}

TEST(DampedModes, CreepBackWithoutSwinging) {
  Oscillator const o(1.0, 8.0, 9.0);  // s² + 9 s + 8 = (s + 1)(s + 8)
  DampedModes const d = damped_modes(o.model, o.x);
  ASSERT_EQ(d.eigenvalue.size(), 2);
  EXPECT_NEAR(d.eigenvalue[0].real(), -1.0, 1e-10);
  EXPECT_NEAR(d.eigenvalue[1].real(), -8.0, 1e-10);
  EXPECT_NEAR(d.eigenvalue[0].imag(), 0.0, 1e-10);
}

// A thin rod on a ball joint rotates freely about its axis without inertia. This motion has no frequency. The rod
// swings in two planes, ω² = m g d/(J + m d²).
TEST(Modes, MotionsWithoutInertiaAreLeftOut) {
  using Ball = Joint<Spherical, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Ball>> model{Gravity{0, -9.81, 0}};
  auto const rod = model.add(
      Rigid<>(1.0, Vec3(0.0, 0.1, 0.1).asDiagonal(), Placement::planar(0.0, -0.4, -0.5 * std::numbers::pi)), "rod");
  model.connect(Ball{}, model.ground().at({0, 0, 0}), rod.at(Vec3(-0.4, 0, 0)), "ball");
  State x = model.reference_state();
  x.lambda << 0.0, -9.81, 0.0;  // g = r_b − r_a: −λ acts on the rod
  Modes const m = modes(model, x);
  ASSERT_EQ(m.frequency.size(), 2);
  for (int i = 0; i < 2; ++i) EXPECT_NEAR(m.frequency[i], std::sqrt(9.81 * 0.4 / (0.1 + 0.16)), 1e-9);
}

// Point mass on a bar without inertia, supported by two springs at a and b. Its rotation follows statically, and ω² =
// k₁ k₂ (a − b)²/((k₁ a² + k₂ b²) m).
TEST(Modes, MotionsWithoutInertiaFollowTheOthers) {
  double const k1 = 300.0, k2 = 500.0, a = 0.3, b = -0.5, mass = 2.0, length = 1.0;
  Model<Bodies<planar::Rigid>, Joints<Joint<PointInPlane, Constraint>>, Forces<SpringDamper>> model;
  auto const bar = model.add(planar::Rigid(mass, 0.0), "bar");
  auto const hold = [&](double k, double at) {
    model.apply(SpringDamper{.stiffness = k, .free_length = length}, model.ground().at({at, -length, 0}),
                bar.at(Vec2(at, 0)));
  };
  hold(k1, a);
  hold(k2, b);
  model.connect(Joint<PointInPlane, Constraint>{{.normal = Vec3::UnitX()}, {}}, model.ground().at({0, 0, 0}),
                bar.at(Vec2(0, 0)));
  Modes const m = modes(model, model.reference_state());
  ASSERT_EQ(m.frequency.size(), 1);
  double const square = k1 * k2 * (a - b) * (a - b) / ((k1 * a * a + k2 * b * b) * mass);
  EXPECT_NEAR(m.frequency[0], std::sqrt(square), 1e-9);
}

/// Planar rod, EI = L = 1, 1 kg/m, EA = GA = 1e8 N, clamped or free, under an axial dead force at its second end. The
/// ratio of its highest eigenvalue, near GA over the rotary inertia, to the lowest one is at least 1e16.
struct ThinRod {
  using Clamp = Joint<planar::Weld, Constraint>;
  Model<Bodies<planar::Lrvf>, Joints<Clamp>, Forces<PointForce<>>> model;
  State x;
  ThinRod(Index n, double rotary_inertia, bool clamped, double force = 0.0) {
    BarConstants const constants{.EA = 1e8, .EI = 1, .mass_per_length = 1, .GA = 1e8, .rotary_inertia = rotary_inertia};
    auto const rod = model.add(planar::Lrvf::from(Bar{.length = 1, .constants = constants}, n), "rod");
    if (clamped) model.connect(Clamp{}, model.ground().at({0, 0, 0}), rod.at(0.0), "clamp");
    model.apply(PointForce<>{.force = {force, 0, 0}}, rod.at(1.0));
    x = model.reference_state();
    if (force != 0.0) equilibrium(model, x);
  }
};
/// Limit without errors in h² and h⁴ from meshes of 16, 32 and 64 elements.
template <class F>
double limit_of_meshes(F&& of) {
  double const a = of(16), b = of(32), c = of(64), once = (4.0 * b - a) / 3.0, twice = (4.0 * c - b) / 3.0;
  return (16.0 * twice - once) / 15.0;
}

// Euler–Bernoulli: (βL)² with cosh βL cos βL = −1 and 1. Shear and rotary inertia change the values by at most 1e-7.
TEST(Modes, OfThinRodsKeepTheirLowestFrequencies) {
  for (double const rotary_inertia : {1e-9, 1e-11}) {
    auto const frequency = [&](bool clamped, Index mode) {
      return limit_of_meshes([&](Index n) {
        ThinRod const rod(n, rotary_inertia, clamped);
        return modes(rod.model, rod.x, 6).frequency[mode];
      });
    };
    EXPECT_NEAR(frequency(true, 0), 3.516015268500, 1e-6 * 3.516) << rotary_inertia;
    EXPECT_NEAR(frequency(true, 1), 22.03449156466, 1e-5 * 22.03) << rotary_inertia;
    EXPECT_NEAR(frequency(false, 3), 22.37328544806, 1e-5 * 22.37) << rotary_inertia;
  }
}

// All modes of one model have unit mass and are orthogonal. A shift gives the low modes, and their complement gives
// the high ones.
TEST(Modes, OfThinRodsAreOrthogonalOverTheWholeSpectrum) {
  ThinRod const rod(16, 1e-9, true);
  Linearisation const l = linearise(rod.model, rod.x);
  Modes const all = modes(l, 1000), few = modes(l, 3);
  Index const n = all.frequency.size();
  ASSERT_EQ(n, 48);
  EXPECT_LT((all.shape.transpose() * l.M * all.shape - MatX::Identity(n, n)).cwiseAbs().maxCoeff(), 1e-6);
  for (Index i = 0; i < 3; ++i) EXPECT_NEAR(all.frequency[i], few.frequency[i], 1e-9 * few.frequency[i]);
  for (Index i = 1; i < n; ++i) EXPECT_GE(all.frequency[i], all.frequency[i - 1]);
}

// The lowest squared frequency changes its sign at Euler's load π² EI/4L². Secants on ω² converge to this load.
TEST(Modes, OfThinColumnsFindEulersLoad) {
  double const exact = 0.25 * std::numbers::pi * std::numbers::pi;
  double const found = limit_of_meshes([&](Index n) {
    auto const square = [&](double load) {
      ThinRod const rod(n, 1e-9, true, -load);
      double const w = modes(rod.model, rod.x, 1).frequency[0];
      return w * std::abs(w);
    };
    double a = 0.98 * exact, b = 1.1 * exact, at_a = square(a), at_b = square(b);
    EXPECT_GT(at_a, 0.0);
    EXPECT_LT(at_b, 0.0);
    for (int i = 0; i < 5 && std::abs(b - a) > 1e-6 * b; ++i) {
      double const c = b - at_b * (b - a) / (at_b - at_a);
      a = std::exchange(b, c);
      at_a = std::exchange(at_b, square(c));
    }
    return b;
  });
  EXPECT_NEAR(found, exact, 1e-5 * exact);
}

// Two thin rods on ball joints at x = 0, each with a spring across its far end in two directions. Rotations about
// their axes have neither stiffness nor inertia. The squared frequencies k/(J + m d²) have a ratio of 1e18.
TEST(Modes, KeepLowFrequenciesBesideNeutralMotionsWithoutInertia) {
  using Ball = Joint<Spherical, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Ball>, Forces<SpringDamper>> model;
  for (auto const& [mass, stiffness] : {std::pair{1.0, 1.0}, std::pair{1e-10, 1e8}}) {
    auto const rod =
        model.add(Rigid<>(mass, Vec3(0.0, 0.1 * mass, 0.1 * mass).asDiagonal(), Placement::planar(0.5, 0)));
    model.connect(Ball{}, model.ground().at({0, 0, 0}), rod.at(Vec3(-0.5, 0, 0)));
    for (Vec3 const& foot : {Vec3(1, -1, 0), Vec3(1, 0, -1)})
      model.apply(SpringDamper{.stiffness = stiffness, .free_length = 1.0}, model.ground().at(foot),
                  rod.at(Vec3(0.5, 0, 0)));
  }
  Modes const m = modes(model, model.reference_state());
  ASSERT_EQ(m.frequency.size(), 4);
  double const slow = std::sqrt(1.0 / 0.35), fast = 1e9 * slow;
  for (Index i = 0; i < 2; ++i) {
    EXPECT_NEAR(m.frequency[i], slow, 1e-8 * slow);
    EXPECT_NEAR(m.frequency[2 + i], fast, 1e-6 * fast);  // ε √1e18 = 2e-7
  }
}

// Clamped bar of 24 finite elements, in two planes. Cubic elements of length h have an error of (βh)⁴/1440: 1.0e-6.
TEST(DenseModes, OfThinBarsKeepTheirLowestFrequencies) {
  Structure const s = structure_of(
      Bar{.length = 1.0,
          .constants = BarConstants{.EA = 1e8, .EI = 1.0, .mass_per_length = 1.0, .GJ = 1e7, .rotary_inertia = 1e-12}},
      24);
  std::vector<Index> const free = ReferenceConditions::clamped().free_coordinates(s);
  LowestModes const found = DenseModes{}(submatrix(s.stiffness, free, free), submatrix(s.mass_matrix(), free, free), 4);
  for (Index i = 0; i < 2; ++i) {
    EXPECT_NEAR(std::sqrt(found.squared_frequencies[i]), 3.516015268500, 1e-6 * 3.516) << i;
    EXPECT_NEAR(std::sqrt(found.squared_frequencies[2 + i]), 22.03449156466, 2e-6 * 22.03) << i;
  }
}

TEST(Modes, AskForAStateOfRest) {
  Oscillator o(1.0, 1.0, 0.0);
  o.x.v[0] = 0.1;
  EXPECT_TRUE(has(refusal([&] { modes(o.model, o.x); }), "the state must be at rest"));
}

}  // namespace modes_test
