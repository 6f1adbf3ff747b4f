// Beams whose sections are given by 6×6 matrices of stiffness and mass (Section6): couplings, offsets, orientation and
// damping. Wang et al. 2017 define the composite cantilever, in inches and pounds, and the twisted beam.

#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/bodies/ancf/ancf_coupled_line.hpp>
#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/se3/se3_beam.hpp>
#include <polybody/bodies/shared/family.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/run/energy.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/vibration/modes.hpp>

#include <gtest/gtest.h>

#include <complex>
#include <numbers>
#include <optional>

#include "support/held.hpp"
#include "support/measured_sections.hpp"
#include "support/rotating_cantilever.hpp"
#include "support/spatial_cantilever.hpp"

using namespace polybody;

namespace measured_sections_test {

using std::numbers::pi;

constexpr double inch = 0.0254, pound = 4.4482216152605;

/// Displacement of the tip of a cantilever of n elements and 2n elements, extrapolated.
template <class B>
Vec3 extrapolated_tip(Bar const& bar, ReferenceCurve const& curve, Vec3 const& force, Index n, int load_steps = 4) {
  auto const tip = [&](Index m) {
    return SpatialCantilever<B>(B::from(bar, m, curve), {.force = force}, {.load_steps = load_steps})
        .tip_displacement();
  };
  return (4.0 * tip(2 * n) - tip(n)) / 3.0;
}
Placement straight(double s) { return {.origin = Vec3(s, 0, 0)}; }
Placement twisted(double s) {
  return {.origin = Vec3(s, 0, 0), .axes = exp_so3<double>(Vec3(0.05 * pi * s, 0, 0))};  // 90° over 10 m
}

template <class B>
class MeasuredSections : public testing::Test {};
using BodiesWithMatrices = testing::Types<Se3Beam, Lrvf<>, AncfBeam<CoupledLine>>;
TYPED_TEST_SUITE(MeasuredSections, BodiesWithMatrices);
template <class B>
class LinearSections : public testing::Test {};
using LinearBodies = testing::Types<Se3Beam, Lrvf<>, AncfBeam<CoupledLine>, Ffr>;
TYPED_TEST_SUITE(LinearSections, LinearBodies);
template <class B>
class RigidSections : public testing::Test {};
using BodiesWithRigidSections = testing::Types<Se3Beam, Lrvf<>>;
TYPED_TEST_SUITE(RigidSections, BodiesWithRigidSections);

/// Tip displacement of the composite cantilever under 150 lb along z [in].
Vec3 const published_tip(-9.02726627566299e-2, -6.47488486259036e-2, 1.22973648292371);

// Wang et al. 2017, §4.3: a tip force of 150 lb along z bends and twists the composite cantilever of 10 in. The
// converged digits are those of one Legendre element of 18 nodes.
TYPED_TEST(MeasuredSections, CompositeCantileverBendsAndTwists) {
  Bar const bar{.length = 10.0, .section = composite()};
  Vec3 const u = extrapolated_tip<TypeParam>(bar, straight, {0, 0, 150}, 24);
  Claim const tip{"section matrices", "tip displacement of the composite cantilever [in]", By::published,
                  "converged Legendre element (kynema, BeamDyn)",
                  std::string(formulation_family<TypeParam>) + ", 24 and 48 elements, extrapolated"};
  for (int i = 0; i < 3; ++i) held(tip, u[i], published_tip[i], 2e-6, {.at = std::string(1, "xyz"[i]), .scale = 1.23});
}

// Wang et al. 2017, §4.4: a beam twisted by 90° over its length of 10 under a force of −4 MN along z.
TYPED_TEST(MeasuredSections, TwistedBeamByItsCurveAndByTurnedSections) {
  Vec6 c;
  c << 2.5e10, 8.2604167e9, 8.2604167e9, 1.41872656e8, 5.20833e8, 1.30208333e8;
  Section6 const section{.stiffness = c.asDiagonal(), .mass = uncoupled().mass};
  SectionAlong const turned = [&](double s) { return section.placed(0, 0, 0.05 * pi * s); };
  Vec3 const published(-1.14152599953942, -1.71805334646388, -3.59321324026952), force(0, 0, -4e6);
  struct {
    Bar bar;
    ReferenceCurve curve;
    char const* how;
  } const rows[] = {{{.length = 10.0, .section = section}, twisted, "twisted reference"},
                    {{.length = 10.0, .section = turned}, straight, "sections turned along a straight bar"}};
  for (auto const& [bar, curve, how] : rows) {
    Vec3 const u = extrapolated_tip<TypeParam>(bar, curve, force, 32, 8);
    Claim const tip{"section matrices", "tip displacement of the twisted beam [m]", By::published,
                    "converged Legendre element (kynema, BeamDyn)",
                    std::string(formulation_family<TypeParam>) + ", 32 and 64 elements, extrapolated, " + how};
    for (int i = 0; i < 3; ++i) held(tip, u[i], published[i], 1e-4, {.at = std::string(1, "xyz"[i]), .scale = 3.6});
  }
}

// Frequencies of the composite cantilever, also with its section placed 0.3 in and −0.2 in beside the axis of the bar:
// linear spectral element (measured_sections.py). The section of the ANCF beam deforms under the forces of inertia
// beside its axis, which lowers a frequency by less than ½ m ω² c²/GA = 3e-3 in the fifth mode.
TYPED_TEST(LinearSections, FrequenciesOfTheCompositeCantilever) {
  struct {
    Vec2 at;
    double exact[6];
  } const rows[] = {
      {{0, 0}, {23.623638592, 43.55253353, 126.39256298, 173.881967583, 227.382204598, 304.66285032}},
      {{0.3, -0.2}, {22.127986375, 43.184671458, 119.497796247, 175.768874523, 223.799882555, 283.758707421}}};
  for (auto const& [at, exact] : rows) {
    Section6 section = composite().in_units(inch, pound);
    section.mass = section.placed(at[0] * inch, at[1] * inch).mass;
    Bar const bar{.length = 10.0 * inch, .section = section};
    auto const frequencies = [&](Index n) {
      Model<Bodies<TypeParam>, Joints<Joint<Weld, Constraint>>> model;
      auto const beam = model.add(TypeParam::from(bar, n), "beam");
      model.connect(Joint<Weld, Constraint>{}, model.ground().at({0, 0, 0}), beam.at(0.0), "clamp");
      return VecX(modes(model, model.reference_state(), 6).frequency);
    };
    Index const n = std::same_as<TypeParam, Ffr> ? 8 : 16;
    bool const deforms = std::same_as<TypeParam, AncfBeam<CoupledLine>> && at[0] != 0.0;
    VecX const w = (4.0 * frequencies(2 * n) - frequencies(n)) / 3.0;
    for (int i = 0; i < 6; ++i)
      held({"section matrices", "frequency of the composite cantilever [rad/s]", By::independent,
            "linear spectral element (NumPy)",
            std::string(formulation_family<TypeParam>) + ", " + std::to_string(n) + " and " + std::to_string(2 * n) +
                " elements, extrapolated"},
           w[i], exact[i], (deforms ? 2e-3 : 2e-4) * exact[i],
           {.at = equals("mode", i + 1) + (at[0] != 0.0 ? ", offset mass" : ", mass on the axis")});
  }
}

// Blade in rotation about z whose principal axes rotate by 45° from root to tip: Ritz method (measured_sections.py).
TYPED_TEST(LinearSections, FrequenciesOfARotatingTwistedBlade) {
  struct {
    double omega;
    double exact[6];
  } const rows[] = {{0.0, {3.535053, 6.872042, 22.70886, 41.6909, 65.31135, 109.0244}},
                    {4.0, {5.552534, 7.149545, 24.85935, 42.85529, 67.38995, 110.7931}},
                    {8.0, {7.667169, 9.304689, 30.4078, 46.10121, 73.27526, 115.755}}};
  Vec6 c, m;
  c << 1e8, 1e8, 1e8, 1e2, 1.0, 4.0;
  m << 1, 1, 1, 2e-8, 1e-8, 1e-8;
  Section6 const section{.stiffness = c.asDiagonal(), .mass = m.asDiagonal()};
  Bar bar = blade();
  bar.constants = {};
  bar.section = [&](double s) { return section.placed(0, 0, 0.25 * pi * s); };
  Index const n = std::same_as<TypeParam, Ffr> ? 6 : 12;
  for (auto const& [omega, exact] : rows) {
    Vec6 const w = (4.0 * frequencies_in_rotation(TypeParam::from(bar, 2 * n), omega) -
                    frequencies_in_rotation(TypeParam::from(bar, n), omega)) /
                   3.0;
    for (int i = 0; i < 6; ++i)
      held({"section matrices", "frequency of a twisted blade in rotation, ω √(ρA L⁴/EI)", By::independent,
            "Ritz method (NumPy)",
            std::string(formulation_family<TypeParam>) + ", " + std::to_string(n) + " and " + std::to_string(2 * n) +
                " elements, extrapolated"},
           w[i], exact[i], 1e-3 * exact[i], {equals("Ω", omega) + ", mode " + std::to_string(i + 1)});
  }
}

/// Compares the tip displacement u(x) of the composite cantilever with the published histories under a sudden force.
/// They are those of BeamDyn with one element of five nodes and steps of 5 ms, so their own error is about 1 % of the
/// largest deflection.
template <class M, class Tip>
void follow_the_sudden_force(M const& model, Tip const& u, std::string const& formulation) {
  struct {
    double t;
    Vec3 tip;
  } const rows[] = {{0.05, {-3.4306531e-2, -9.0058333e-3, 0.768365773}},
                    {0.1, {-0.24892635, -0.13186415, 2.05348501}},
                    {0.13, {-0.33323172, -0.28293064, 2.34549587}},
                    {0.2, {-7.3756193e-2, -6.4826415e-2, 1.10647129}},
                    {0.3, {-2.0973273e-2, -0.16021467, 0.55309539}}};
  State x = model.reference_state();
  for (auto const& [t, tip] : rows) {
    simulate(model, x, GeneralisedAlpha{.rho_inf = 0.9}, {.end_time = t, .step = 1e-3}).run();
    Vec3 const now = u(x), within = (t < 0.1 ? 0.2 : 1.0) * Vec3(0.01, 0.022, 0.05);  // of each component
    for (int i = 0; i < 3; ++i)
      held({"section matrices", "tip displacement of the composite cantilever under a sudden force [in]", By::published,
            "BeamDyn, one element of 5 nodes, 5 ms (kynema)", formulation + ", generalised-α, 1 ms"},
           now[i], tip[i], within[i], {equals("t", t) + ", " + "xyz"[i], 2.36});
  }
}

// Wang et al. 2017, §4.3: the tip force of 150 lb acts suddenly.
TYPED_TEST(MeasuredSections, CompositeCantileverUnderASuddenForce) {
  Model<Bodies<TypeParam>, Joints<Joint<Weld, Constraint>>, Forces<PointForce<>>> model;
  auto const beam = model.add(TypeParam::from({.length = 10.0, .section = composite()}, 16), "beam");
  model.connect(Joint<Weld, Constraint>{}, model.ground().at({0, 0, 0}), beam.at(0.0), "clamp");
  model.apply(PointForce<>{.force = {0, 0, 150}}, beam.at(10.0), "tip");
  follow_the_sudden_force(
      model, [&](State const& x) { return Vec3(position(model, x, beam.at(10.0)) - Vec3(10, 0, 0)); },
      std::string(formulation_family<TypeParam>) + ", 16 elements");
}

/// The composite cantilever of `Ffr` bodies, n in a row, each of one element, under the tip force.
struct FramesInARow {
  using Clamp = Joint<Weld, Constraint>;
  Model<Bodies<Ffr>, Joints<Clamp>, Forces<PointForce<>>> model;
  std::optional<BodyHandle<Ffr>> last;
  double const length;

  explicit FramesInARow(int n) : length(10.0 / n) {
    for (int i = 0; i < n; ++i) {
      std::string const number = std::to_string(i + 1);
      Bar const bar{.length = length, .section = composite(), .placement = {.origin = Vec3(i * length, 0, 0)}};
      auto const part = model.add(Ffr::from(bar, 1), "part " + number);
      if (last)
        model.connect(Clamp{}, last->at(length), part.at(0.0), "weld " + number);
      else
        model.connect(Clamp{}, model.ground().at({0, 0, 0}), part.at(0.0), "clamp");
      last = part;
    }
    model.apply(PointForce<>{.force = {0, 0, 150}}, last->at(length), "tip");
  }
  Vec3 tip(State const& x) const { return position(model, x, last->at(length)) - Vec3(10, 0, 0); }
};

// The deflection of 12 % of the length, and 23 % in the motion, is too large for one floating frame, whose linear
// deflection is 3 % larger and whose axial displacement is zero. A row of n frames deforms n times less in each. The
// sections are inclined to the frame by the shear angle of 0.4 %. The linear strains omit its product with the twist,
// which changes y by up to 2e-3 in for bodies that are longer than their section.
TEST(FramesOfMatrices, CompositeCantileverBendsAndTwists) {
  FramesInARow const row(16);
  State x = row.model.reference_state();
  equilibrium(row.model, x, {.load_steps = 4});
  Vec3 const u = row.tip(x);
  Claim const claim{"section matrices", "tip displacement of the composite cantilever [in]", By::published,
                    "converged Legendre element (kynema, BeamDyn)",
                    std::string(formulation_family<Ffr>) + ", 16 bodies in a row"};
  for (int i = 0; i < 3; ++i)
    held(claim, u[i], published_tip[i], 1e-3, {.at = std::string(1, "xyz"[i]), .scale = 1.23});
}
TEST(FramesOfMatrices, CompositeCantileverUnderASuddenForce) {
  FramesInARow const row(8);
  follow_the_sudden_force(
      row.model, [&](State const& x) { return row.tip(x); },
      std::string(formulation_family<Ffr>) + ", 8 bodies in a row");
}

// A bar with an uncoupled section, and a bar along a parallel line whose section is placed beside it, are the same
// body. Statics under a force, and a free flight with its energy.
TYPED_TEST(RigidSections, AnAxisBesideTheSectionChangesNothing) {
  double const y = 0.04, z = -0.07, l = 1.5;
  Bar const own{.length = l, .section = uncoupled()};
  Bar const beside{.length = l, .section = uncoupled().placed(-y, -z, 0.0), .placement = {.origin = Vec3(0, y, z)}};
  auto const run = [&](Bar const& bar, Vec2 const& centre, auto&& result) {
    Model<Bodies<TypeParam>, Joints<Joint<Weld, Constraint>>, Forces<PointForce<>>> model{Gravity{0, 0, -9.81}};
    auto const beam = model.add(TypeParam::from(bar, 6), "beam");
    model.apply(PointForce<>{.force = {30, 200, -100}}, beam.at(l, centre[0], centre[1]), "pull");
    State x = model.reference_state();
    simulate(model, x, GeneralisedAlpha{.rho_inf = 0.9}, {.end_time = 0.05, .step = 1e-3}).run();
    result(model, x, beam);
  };
  Vec3 r[2], w[2];
  double energies[2];
  Vec6 forces[2];
  auto const keep = [&](int i, Vec2 const& centre) {
    return [&, i, centre](auto const& model, State const& x, auto const& beam) {
      r[i] = position(model, x, beam.at(0.6, centre[0], centre[1]));
      w[i] = frame(model, x, beam.at(0.6)).w;
      energies[i] = energy(model, x).total();
      forces[i] = section_forces(model, x, beam.at(0.6));
    };
  };
  run(own, {0, 0}, keep(0, {0, 0}));
  run(beside, {-y, -z}, keep(1, {-y, -z}));
  EXPECT_LT((r[1] - r[0]).norm(), 1e-8);
  EXPECT_LT((w[1] - w[0]).norm(), 1e-6 * w[0].norm());
  EXPECT_NEAR(energies[1], energies[0], 1e-8 * std::abs(energies[0]));
  EXPECT_LT((forces[1].template head<3>() - forces[0].template head<3>()).norm(), 1e-6 * forces[0].norm());
  // The moment about the other axis: M_axis = M_centre + c × N
  Vec3 const moved = forces[0].template tail<3>() + Vec3(0, -y, -z).cross(forces[0].template head<3>());
  EXPECT_LT((forces[1].template tail<3>() - moved).norm(), 1e-6 * forces[0].norm());
}

/// Eigenvalue of the underdamped mode whose natural frequency |s| is the nearest to `omega`.
std::complex<double> mode_near(DampedModes const& damped, double omega) {
  std::complex<double> found = 0.0;
  for (std::complex<double> const s : damped.eigenvalue)
    if (s.imag() > 0.0 && std::abs(std::abs(s) - omega) < std::abs(std::abs(found) - omega)) found = s;
  return found;
}

// Different damping times of an uncoupled section, D_ii = τ_i C_ii. The strain energy of a mode with the shape φ and
// the frequency ω is that of one strain i. With φᵀKφ = ω² and φᵀMφ = 1, its damping is then φᵀDφ = τ_i ω². The free
// decay of the mode has s² + τ_i ω² s + ω² = 0, hence |s| = ω and the damping ratio −Re s/|s| = ½ ω τ_i.
//
// A slender cantilever has the axial, torsional and bending modes: ω = ½π √(EA/m)/L, ½π √(GJ/J_xx)/L and 1.87510²
// √(EI/m)/L². In its bending modes the energy of shear is 5 EI/(GA L²) < 2e-5 of all. A cantilever that resists
// rotations of its sections, EI/(GA L²) > 1e4, has shear modes, ω = ½π √(GA/m)/L.
TYPED_TEST(LinearSections, EachDampingTimeDampsTheModesOfItsStrain) {
  struct Row {
    int strain;
    double omega;
    char const* mode;
  };
  auto const expect_ratios = [](Vec6 const& stiffness, Vec6 const& mass, Vec6 const& times,
                                std::initializer_list<Row> rows) {
    Section6 const section{.stiffness = stiffness.asDiagonal(), .mass = mass.asDiagonal(), .damping_times = times};
    Model<Bodies<TypeParam>, Joints<Joint<Weld, Constraint>>> model;
    auto const beam = model.add(TypeParam::from({.length = 1.0, .section = section}, 12), "beam");
    model.connect(Joint<Weld, Constraint>{}, model.ground().at({0, 0, 0}), beam.at(0.0), "clamp");
    auto const damped = damped_modes(model, model.reference_state(), 1000);
    for (auto const& [strain, omega, mode] : rows) {
      std::complex<double> const s = mode_near(damped, omega);
      double const ratio = -s.real() / std::abs(s), tau = times[strain];
      EXPECT_NEAR(ratio, 0.5 * std::abs(s) * tau, 5e-4 * ratio) << mode;
      held({"section matrices", "damping ratio of a mode of one strain", By::closed_form, "½ ω τ",
            std::string(formulation_family<TypeParam>) + ", 12 elements"},
           ratio, 0.5 * omega * tau, 0.01 * (0.5 * omega * tau), {.at = mode});  // the mesh changes ω by less than 1 %
    }
  };
  double const quarter = 0.5 * pi, bending = 1.8751040687 * 1.8751040687;
  Vec6 stiffness, mass, times;
  stiffness << 4e4, 4e6, 3e6, 20.0, 4.0, 9.0;
  mass << 1.0, 1.0, 1.0, 1e-3, 4e-4, 6e-4;
  times << 2e-4, 3e-3, 1e-3, 3e-4, 1e-2, 5e-3;
  expect_ratios(stiffness, mass, times,
                {{0, quarter * 200.0, "axial"},
                 {3, quarter * std::sqrt(2e4), "torsion"},
                 {4, bending * 2.0, "bending about y"},
                 {5, bending * 3.0, "bending about z"}});
  stiffness << 1e7, 4e4, 1e4, 1e6, 1e9, 2e9;
  mass << 1.0, 1.0, 1.0, 2.0, 0.8, 1.2;
  times << 1e-5, 2e-4, 6e-4, 1e-5, 1e-4, 3e-4;
  expect_ratios(stiffness, mass, times, {{1, quarter * 200.0, "shear along y"}, {2, quarter * 100.0, "shear along z"}});
}

// Damping with one time τ for all strains: each mode has the damping ratio ½ ω τ, also with couplings.
TYPED_TEST(LinearSections, OneDampingTimeDampsEveryMode) {
  double const tau = 1e-3;
  Section6 section = composite().in_units(inch, pound);
  Bar bar{.length = 10.0 * inch, .section = section};
  if (std::same_as<TypeParam, AncfBeam<CoupledLine>>) {
    bar.damping = {.axial = tau, .shear = tau, .bending = tau};  // also of the strains of the section
  } else {
    section.damping_times.setConstant(tau);
    bar.section = section;
  }
  Model<Bodies<TypeParam>, Joints<Joint<Weld, Constraint>>> model;
  auto const beam = model.add(TypeParam::from(bar, 4), "beam");
  model.connect(Joint<Weld, Constraint>{}, model.ground().at({0, 0, 0}), beam.at(0.0), "clamp");
  State const x = model.reference_state();
  VecX const w = modes(model, x, 6).frequency;
  auto const damped = damped_modes(model, x);
  for (int i = 0; i < 6; ++i) {
    std::complex<double> const exact(-0.5 * tau * w[i] * w[i], w[i] * std::sqrt(1.0 - 0.25 * tau * tau * w[i] * w[i]));
    double nearest = 1e300;
    for (std::complex<double> const s : damped.eigenvalue) nearest = std::min(nearest, std::abs(s - exact));
    EXPECT_LT(nearest, 1e-6 * w[i]) << "mode " << i + 1;
  }
}

// Matrices of a steel bar in newtons, millimetres and tonnes that are given as if they were in SI units: the reports of
// a run and of statics name the first body with such a section, and a run in SI units has no warning.
TYPED_TEST(LinearSections, WrongUnitsGiveAWarning) {
  auto const warnings = [](double length) {
    Section6 section = uncoupled().in_units(length, 1.0);
    section.mass(3, 3) = section.mass(4, 4) + section.mass(5, 5);
    Model<Bodies<TypeParam>, Joints<Joint<Weld, Constraint>>> model;
    auto const arm = model.add(TypeParam::from({.length = 1.0, .section = section}, 2), "arm");
    auto const tip = model.add(
        TypeParam::from({.length = 1.0, .section = section, .placement = {.origin = Vec3(1, 0, 0)}}, 2), "tip");
    model.connect(Joint<Weld, Constraint>{}, model.ground().at({0, 0, 0}), arm.at(0.0), "clamp");
    model.connect(Joint<Weld, Constraint>{}, arm.at(1.0), tip.at(0.0), "splice");
    State x = model.reference_state();
    auto all = equilibrium(model, x).warnings;
    for (auto const& warning : simulate(model, x, GeneralisedAlpha{}, {.end_time = 1e-3, .step = 1e-3}).run().warnings)
      all.push_back(warning);
    return all;
  };
  EXPECT_TRUE(warnings(1.0).empty());
  auto const wrong = warnings(1e3);
  ASSERT_EQ(wrong.size(), 2u);
  EXPECT_TRUE(
      wrong[0].starts_with("Body \"arm\": the section matrices at s = 0 m imply E = 1.36e+04 N/m², A = 1.47e+03 "
                           "m² and ρ = 2.04e-09 kg/m³."))
      << wrong[0];
  EXPECT_EQ(wrong[1], wrong[0]);
}

// Different damping times: the power of the damping forces is never positive.
TYPED_TEST(RigidSections, DampingNeverAddsEnergy) {
  Section6 section = composite();
  section.damping_times << 1e-3, 0.0, 2e-2, 0.5, 1e-4, 0.0;
  Section6 elastic = composite();
  TypeParam const damped = TypeParam::from({.length = 1.0, .section = section}, 1),
                  plain = TypeParam::from({.length = 1.0, .section = elastic}, 1);
  std::vector<double> q(14), v(12);
  damped.reference(q);
  double largest = -1.0, smallest = 1.0;
  for (int n = 0; n < 200; ++n) {
    for (int i = 0; i < 12; ++i) v[std::size_t(i)] = std::sin(1.0 + 7.3 * n + 2.1 * i * i);
    typename TypeParam::template Element<double> with, without;
    damped.template force<double>(0, q, v, with);
    plain.template force<double>(0, q, v, without);
    double power = 0.0;
    for (int i = 0; i < 12; ++i) power += (with[i] - without[i]) * v[std::size_t(i)];
    largest = std::max(largest, power);
    smallest = std::min(smallest, power);
  }
  EXPECT_LE(largest, 0.0);
  EXPECT_LT(smallest, -1.0);
}

}  // namespace measured_sections_test
