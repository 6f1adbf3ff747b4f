// Sections given by matrices: laws of the bodies that accept couplings, offsets and sections along the bar; refusals.

#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/ancf/ancf_coupled_line.hpp>
#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/ffr/planar_ffr.hpp>
#include <polybody/bodies/lrvf/director_interpolation.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/bodies/lrvf/polar_interpolation.hpp>
#include <polybody/bodies/se3/planar_se3_beam.hpp>
#include <polybody/bodies/se3/se3_beam.hpp>

#include <polybody/testing/flexible_body_laws.hpp>

#include "support/measured_sections.hpp"
#include "support/refusal.hpp"
#include "support/spatial_lrvf.hpp"

namespace polybody {
using namespace laws;
namespace section6_test {

/// Coupled section beside the axis of the bar, which rotates and moves along the bar, with six damping times.
Bar measured_bar() {
  Bar bar = spatial_lrvf_bar();
  bar.section = [](double s) {
    Section6 section = composite().in_units(0.05, 0.02).placed(0.02 + 0.01 * s, -0.03, 0.4 * s);
    section.damping_times << 1e-3, 4e-3, 2e-3, 7e-3, 3e-3, 5e-3;
    return section;
  };
  bar.constants = {};
  bar.pretension = 20.0;
  return bar;
}
template <class B>
struct Case {
  static Bar bar() { return measured_bar(); }
  static B body(Bar const& bar) { return B::from(bar, 3); }
};
template <class B>
struct MeasuredBeam : testing::Test, BodyLaws<Case<B>> {};
using Bodies = testing::Types<Se3Beam, Lrvf<>, Lrvf<Polar>, Lrvf<Directors, FullQuadrature>, AncfBeam<CoupledLine>>;
TYPED_TEST_SUITE(MeasuredBeam, Bodies);

TYPED_TEST(MeasuredBeam, ForceIsTheGradientOfTheEnergyAndTheTangentThatOfTheForce) {
  this->elastic_force_is_the_gradient_of_the_strain_energy();
  this->tangent_is_the_derivative_of_the_force_by_position();
  this->tangent_is_the_derivative_of_the_force_by_speed();
  this->weight_is_the_gradient_of_its_energy();
}
TYPED_TEST(MeasuredBeam, MarkersMoveWithTheSections) {
  this->rigid_velocity_is_the_field_of_a_rigid_motion();
  this->twist_is_jacobian_times_velocities();
  this->jacobian_is_the_derivative_of_the_frame();
  this->bias_is_the_acceleration_at_constant_velocities();
  this->load_stiffness_is_the_derivative_of_the_pulled_wrench();
}

/// Floating frame whose sections have couplings, offsets and damping times: constant along a bar of two elements, with
/// or without geometric stiffening.
template <bool stiffening>
struct FrameCase {
  static constexpr double deformation = stiffening ? 0.03 : 1.0;  // second-order theory
  static constexpr double stiffness = 2.7e4;                      // EA
  static constexpr double length = 1.3;
  static Section6 section(bool damps) {
    Section6 s = composite().in_units(0.05, 0.02).placed(0.02, -0.03, 0.4);
    if (damps) s.damping_times << 0.1, 0.4, 0.2, 0.7, 0.3, 0.5;
    return s;
  }
  static Ffr made(Placement const& placement, bool damps) {
    return Ffr::from({.length = length, .section = section(damps), .placement = placement}, 2,
                     {.stiffening = stiffening});
  }
  static Placement placement() { return Placement::at({0.4, -0.3, 0.8}, {0.5, -1.0, 0.7}); }
  static Ffr body() { return made(placement(), true); }
  static Ffr undamped() { return made(placement(), false); }
  static Ffr elsewhere() { return made(Placement::at({-7.0, 3.0, 5.0}, {1.0, -0.4, 2.0}), true); }
  static std::vector<Ffr::Point> points() {
    Ffr const b = body();
    return {b.at(0.0), b.at(0.31 * length), b.at(length), b.at(0.77 * length, 0.03, -0.05)};
  }
  static double mass() { return section(false).mass(0, 0) * length; }
  static Vec3 centre() {  // the composite section has its centre of mass on its own axis
    return placement().origin + placement().axes * Vec3(0.5 * length, 0.02, -0.03);
  }
};
bool const frames_obey[] = {obeys<FrameCase<false>, BodyLaws, FlexibleBodyLaws>("FfrOfMatrices"),
                            obeys<FrameCase<true>, BodyLaws, FlexibleBodyLaws>("StiffenedFfrOfMatrices")};

// Sections that vary along the bar.
template <>
Ffr Case<Ffr>::body(Bar const& bar) {
  return Ffr::from(bar, 3, {.stiffening = false});
}
using MeasuredFrame = MeasuredBeam<Ffr>;
TEST_F(MeasuredFrame, ForcesAndMarkersAreDerivatives) {
  elastic_force_is_the_gradient_of_the_strain_energy();
  tangent_is_the_derivative_of_the_force_by_position();
  tangent_is_the_derivative_of_the_force_by_speed();
  weight_is_the_gradient_of_its_energy();
  twist_is_jacobian_times_velocities();
  jacobian_is_the_derivative_of_the_frame();
  bias_is_the_acceleration_at_constant_velocities();
  load_stiffness_is_the_derivative_of_the_pulled_wrench();
}

TEST(Section6, BadMatricesAreRefused) {
  auto const refused = [](Section6 const& section, char const* text) {
    Bar const bar{.length = 1.0, .section = section};
    EXPECT_TRUE(has(refusal([&] { Se3Beam::from(bar, 2); }), text));
  };
  Section6 s = composite();
  s.stiffness(3, 4) *= 1.01;
  refused(s, "(4, 5)");
  s = composite();
  s.stiffness(3, 4) = s.stiffness(4, 3) = 40e3;  // 40² > 16.96 · 59.12
  refused(s, "M_y");
  s = composite();
  s.mass(1, 1) *= 1.001;
  refused(s, "[m 1, -m c~; m c~, J]");
  s = composite();
  s.mass(0, 5) = s.mass(5, 0) = -0.05;
  s.mass(1, 5) = s.mass(5, 1) = 0.0;
  refused(s, "centre of mass");
  s = composite().placed(0.4, 0.0);
  s.mass(5, 5) = 1e-3;  // less than m y²
  refused(s, "axis z");
  s = composite();
  s.damping_times[3] = -1.0;
  refused(s, "damping time of M_x");
  s = composite();
  s.stiffness(0, 0) = std::nan("");
  refused(s, "entry (1, 1)");
}

TEST(Section6, OtherBodiesAcceptItWithoutCouplings) {
  Bar const plain{.length = 1.0, .section = uncoupled()}, coupled{.length = 1.0, .section = composite()};
  EXPECT_EQ(constants(plain).EI_y, 1500.0);
  EXPECT_EQ(constants(plain).polar_inertia, 5e-3);
  EXPECT_TRUE(has(refusal([&] { (void)constants(coupled); }), "couples strains"));
  Bar const along{.length = 1.0, .section = [](double) { return uncoupled(); }};
  EXPECT_TRUE(has(refusal([&] { (void)constants(along); }), "function of the arc length"));
  EXPECT_TRUE(has(refusal([&] { (void)constants({.length = 1.0, .section = uncoupled().placed(0.1, 0.0)}); }),
                  "couples strains"));
  EXPECT_TRUE(
      has(refusal([&] { (void)constants({.length = 1.0, .section = uncoupled(), .material = Material{1, 1}}); }),
          "not two of these"));
}

// Mass matrices that an ANCF section cannot have: J_xx ≠ J_yy + J_zz, products with x, and inertia of one direction
// only.
TEST(Section6, AncfBeamNeedsTheMassOfPointsInTheSection) {
  auto const refused = [](Section6 const& section) {
    Bar const bar{.length = 1.0, .section = section};
    return has(refusal([&] { AncfBeam<CoupledLine>::from(bar, 2); }), "must have the mass of points in its plane");
  };
  EXPECT_NO_THROW(AncfBeam<CoupledLine>::from({.length = 1.0, .section = composite().placed(0.2, -0.1)}, 2));
  Section6 s = composite();
  s.mass(3, 3) *= 1.001;
  EXPECT_TRUE(refused(s));
  s = composite();
  s.mass(3, 4) = s.mass(4, 3) = 1e-4;
  EXPECT_TRUE(refused(s));
  s = composite();
  s.mass(4, 5) = s.mass(5, 4) = std::sqrt(s.mass(4, 4) * s.mass(5, 5));
  EXPECT_TRUE(refused(s));
}

// Without couplings the line of `CoupledLine` is that of `ElasticLine`, up to the quadrature of K.
TEST(Section6, CoupledLineWithoutCouplingsIsTheElasticLine) {
  Bar shape{.length = 1.0, .section = Rectangle{0.05, 0.03}, .material = Material{.density = 7800.0, .young = 2e11}};
  auto const same = [](auto const& a, auto const& b) {
    std::vector<double> q(36), v(36);
    a.reference(q);
    for (int i = 0; i < 36; ++i) {
      q[std::size_t(i)] += 1e-4 * std::sin(1.0 + 2.7 * i);
      v[std::size_t(i)] = std::cos(0.3 * i * i);
    }
    Vec<double, 24> f, g;
    Mat<double, 24, 24> m, n;
    a.template force<double>(0, q, v, f);
    b.template force<double>(0, q, v, g);
    a.mass(0, q, m);
    b.mass(0, q, n);
    EXPECT_LT((f - g).norm(), 1e-6 * f.norm());
    EXPECT_LT((m - n).norm(), 1e-12 * m.norm());
    Vec6 const forces = a.section_forces(a.at(0.2), q);
    EXPECT_LT((b.section_forces(b.at(0.2), q) - forces).norm(), 1e-9 * forces.norm());
  };
  Section6 plain = uncoupled();
  plain.mass(3, 3) = plain.mass(4, 4) + plain.mass(5, 5);
  Bar const given{.length = 1.0, .section = plain};
  same(AncfBeam<>::from(given, 2), AncfBeam<CoupledLine>::from(given, 2));
  shape.damping = {.axial = 1e-6, .shear = 2e-6, .bending = 3e-6};
  same(AncfBeam<>::from(shape, 2), AncfBeam<CoupledLine>::from(shape, 2));
}

// Rotation Ω about the first end: ½ Ω·I Ω is the energy of the sections. J_xx ≠ J_yy + J_zz, and the centre of mass is
// beside the axis.
TEST(Section6, StructureHasTheInertiaOfItsSections) {
  Section6 section = uncoupled();
  section.mass(3, 3) = 7e-3;
  section = section.placed(0.02, -0.03, 0.4);
  double const l = 1.2;
  Structure const s = structure_of({.length = l, .section = section}, 3);
  Mat3 inertia = Mat3::Zero();
  for (auto const& g : gauss<3>) {
    Mat<double, 6, 3> twist;  // of a section for unit Ω
    twist << skew<double>(Vec3(-g.xi * l, 0, 0)), Mat3::Identity();
    inertia += g.weight * l * twist.transpose() * section.mass * twist;
  }
  EXPECT_NEAR(s.mass, 3.0 * l, 1e-12);
  EXPECT_LT((s.first - 3.0 * l * Vec3(0.5 * l, 0.02, -0.03)).norm(), 1e-13);
  EXPECT_LT((s.second.trace() * Mat3::Identity() - s.second - inertia).norm(), 1e-12);
  MatX turn(s.size(), 3);  // rotation of the nodes
  for (Index i = 0; i < 4; ++i) turn.middleRows<6>(6 * i) << skew<double>(-s.nodes[std::size_t(i)]), Mat3::Identity();
  EXPECT_LT((turn.transpose() * (s.mass_matrix() * turn) - inertia).norm(), 1e-12);
  EXPECT_LT((s.stiffness * turn).norm(), 1e-9 * MatX(s.stiffness).norm());
}

// Section forces of a cantilever under a tip force and a tip moment, at a point between nodes.
TEST(Section6, FloatingFrameReturnsTheSectionForces) {
  Section6 const section = composite().placed(0.3, 0.2, 0.1);
  double const l = 10.0;
  Ffr const body = Ffr::from({.length = l, .section = section}, 2, {.stiffening = false});
  Vec6 tip;
  tip << 3, -2, 5, 4, 7, -6;
  Structure const s = structure_of({.length = l, .section = section}, 2);
  MatX const held = MatX(s.stiffness).bottomRightCorner(12, 12);
  VecX load = VecX::Zero(12), q(19);
  load.tail(6) = tip;
  body.reference(std::span<double>(q.data(), 19));
  q.tail(12) = held.llt().solve(load);  // the coordinates are relative to the first end
  Vec6 const n = body.section_forces(body.at(0.35 * l), std::span<double const>(q.data(), 19));
  double const arm = 0.65 * l;
  Vec6 exact = tip;
  exact[4] -= arm * tip[2];
  exact[5] += arm * tip[1];
  EXPECT_LT((n - exact).norm(), 1e-8 * exact.norm());
}

TEST(Section6, CouplingsNeedEqualWeightsInLrvf) {
  Bar const bar{.length = 1.0, .section = composite()};
  EXPECT_TRUE(has(refusal([&] { Lrvf<RelativeRotation, SelectiveQuadrature>::from(bar, 2); }), "equal weights"));
  EXPECT_NO_THROW((Lrvf<RelativeRotation, FullQuadrature>::from(bar, 2)));
}
TEST(Section6, AnEmptyFunctionIsRefused) {
  Bar const bar{.length = 1.0, .section = SectionAlong{}};
  EXPECT_TRUE(has(refusal([&] { Se3Beam::from(bar, 2); }), "empty function"));
  EXPECT_TRUE(has(refusal([&] { (void)constants(bar); }), "function of the arc length"));
}

// The solid of a rectangle of steel, 50 mm × 30 mm, has E, A and ρ of the rectangle in each system of units, also with
// the axis beside the rectangle and turned. Its units are the force, the length and f t²/l for the mass.
TEST(Section6, WarningNamesTheSolidThatTheMatricesImply) {
  double const a = 0.05, b = 0.03, area = a * b, e = 2e11, g = 8e10, rho = 7800.0;
  Vec6 c, m;
  c << e * area, g * area, g * area, g * a * b * b * b / 5.0, e * a * b * b * b / 12.0, e * b * a * a * a / 12.0;
  m << rho * area, rho * area, rho * area, 0.7, 0.3, 0.4;
  Section6 const si{.stiffness = c.asDiagonal(), .mass = m.asDiagonal()};
  auto const text = [&](double length, double force) {
    return detail::unit_warning(si.in_units(length, force).placed(0.7 * length * a, -0.4 * length * a, 0.3), 0.25);
  };
  char const* const limits =
      " kg/m³. In SI units E lies in [10000, 1e+15] and ρ in [5, 10000000]. Convert the matrices with "
      "Section6::in_units.";
  std::string const begin = "the section matrices at s = 0.25 m imply E = ";
  double const inch = 0.0254, pound = 4.4482216152605;
  EXPECT_EQ(text(1.0, 1.0), "");
  EXPECT_EQ(text(1e3, 1.0), begin + "2e+05 N/m², A = 1.5e+03 m² and ρ = 7.8e-09" + limits);
  EXPECT_EQ(text(1e-3, 1.0), begin + "2e+17 N/m², A = 1.5e-09 m² and ρ = 7.8e+15" + limits);
  EXPECT_EQ(text(1.0 / inch, 1.0 / pound), begin + "2.9e+07 N/m², A = 2.33 m² and ρ = 0.00073" + limits);
  EXPECT_EQ(text(inch, pound), begin + "1.38e+15 N/m², A = 9.68e-07 m² and ρ = 8.34e+10" + limits);
}

// A carbon tube with R/t = 100, a rope of 200 steel wires, a steel bar with ten times its own mass on it, rubber, and
// the sections of the tests are in SI units.
TEST(Section6, NoWarningOfOtherSolids) {
  auto const of = [](double ea, double ei, double mass) {
    Vec6 c, m;
    c << ea, 0.3 * ea, 0.3 * ea, 0.7 * ei, ei, ei;
    m << mass, mass, mass, 1.0, 1.0, 1.0;
    return detail::unit_warning({.stiffness = c.asDiagonal(), .mass = m.asDiagonal()}, 0.0);
  };
  using std::numbers::pi;
  double const tube = 2.0 * pi * 0.05 * 0.0005, wire = pi * 5e-4 * 5e-4, square = 0.02 * 0.02;
  EXPECT_EQ(of(1e11 * tube, 1e11 * tube * 0.5 * 0.05 * 0.05, 1600.0 * tube), "");
  EXPECT_EQ(of(200 * 2e11 * wire, 200 * 2e11 * wire * 0.25 * 5e-4 * 5e-4, 200 * 7800.0 * wire), "");
  EXPECT_EQ(of(2e11 * square, 2e11 * square * square / 12.0, 11.0 * 7800.0 * square), "");
  EXPECT_EQ(of(1e6 * square, 1e6 * square * square / 12.0, 1100.0 * square), "");
  for (Section6 const& section : {composite().in_units(0.0254, 4.4482216152605), uncoupled(),
                                  box_beam().in_units(0.0254, 4.4482216152605), composite().in_units(0.05, 0.02)})
    EXPECT_EQ(detail::unit_warning(section, 0.0), "");
}

// Each body that accepts matrices has the warning, also for a section that is wrong only at the end of the bar.
TEST(Section6, EveryBodyHasTheWarning) {
  Section6 section = uncoupled();
  section.mass(3, 3) = section.mass(4, 4) + section.mass(5, 5);
  Bar const right{.length = 1.0, .section = section}, wrong{.length = 1.0, .section = section.in_units(1e3, 1.0)},
      wrong_at_the_end{.length = 1.0,
                       .section = [=](double s) { return s < 0.9 ? section : section.in_units(1e3, 1.0); }};
  auto const holds = [&]<class B>(B const*, bool varies) {
    EXPECT_EQ(B::from(right, 2).unit_warning(), "");
    EXPECT_TRUE(has(std::string(B::from(wrong, 2).unit_warning()), "at s = 0 m imply E = "));
    EXPECT_TRUE(!varies || has(std::string(B::from(wrong_at_the_end, 2).unit_warning()), "at s = 1 m imply E = "));
  };
  holds(static_cast<Se3Beam*>(nullptr), true);
  holds(static_cast<Lrvf<>*>(nullptr), true);
  holds(static_cast<AncfBeam<CoupledLine>*>(nullptr), true);
  holds(static_cast<Ffr*>(nullptr), true);
  holds(static_cast<AncfBeam<>*>(nullptr), false);
  holds(static_cast<AncfCable<>*>(nullptr), false);
  holds(static_cast<planar::AncfCable<>*>(nullptr), false);
  holds(static_cast<planar::Lrvf*>(nullptr), false);
  holds(static_cast<planar::Se3Beam*>(nullptr), false);
  holds(static_cast<planar::Ffr*>(nullptr), false);
}

}  // namespace section6_test
}  // namespace polybody
