// Rotating blades with printed frequencies, with sections given by matrices: the uniform Euler–Bernoulli beam of Wright
// et al. 1982, the blade with a swept tip that Epps & Chandra 1996 measured, and the twisted blade of a wind turbine
// that the program BModes is delivered with.

#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/bodies/ancf/ancf_coupled_line.hpp>
#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/se3/se3_beam.hpp>
#include <polybody/bodies/shared/family.hpp>
#include <polybody/run/probe.hpp>

#include <gtest/gtest.h>

#include <numbers>

#include "support/held.hpp"
#include "support/rotating_cantilever.hpp"

using namespace polybody;

namespace rotating_blades_test {

template <class B>
class RotatingBlades : public testing::Test {};
using LinearBodies = testing::Types<Se3Beam, Lrvf<>, AncfBeam<CoupledLine>, Ffr>;
TYPED_TEST_SUITE(RotatingBlades, LinearBodies);

// Flap frequencies ω √(ρA L⁴/EI) of a uniform cantilever without hub radius, printed with four decimals. The chordwise
// stiffness is so high that the six lowest modes are flap modes. The remaining error of the third mode is that of
// fourth order in the length of an element, 4e-4 for linear elements.
TYPED_TEST(RotatingBlades, FlapOfAUniformBlade) {
  struct {
    double omega;
    double printed[3];
  } const rows[] = {{0, {3.5160, 22.0345, 61.6972}},
                    {2, {4.1373, 22.6149, 62.2732}},
                    {4, {5.5850, 24.2733, 63.9668}},
                    {8, {9.2568, 29.9954, 70.2930}},
                    {12, {13.1702, 37.6031, 79.6145}}};
  Vec6 c, m;
  c << 1e8, 1e8, 1e8, 1e2, 1.0, 1e4;
  m << 1, 1, 1, 2e-8, 1e-8, 1e-8;
  Bar const bar{.length = 1.0,
                .section = Section6{.stiffness = c.asDiagonal(), .mass = m.asDiagonal()},
                .placement = blade().placement};
  Index const n = std::same_as<TypeParam, Ffr> ? 6 : 12;
  for (auto const& [omega, printed] : rows) {
    Vec6 const w = (4.0 * frequencies_in_rotation(TypeParam::from(bar, 2 * n), omega) -
                    frequencies_in_rotation(TypeParam::from(bar, n), omega)) /
                   3.0;
    for (int i = 0; i < 3; ++i)
      held({"rotating blades", "flap frequency of a uniform blade, ω √(ρA L⁴/EI)", By::published, "Wright et al. 1982",
            std::string(formulation_family<TypeParam>) + ", " + std::to_string(n) + " and " + std::to_string(2 * n) +
                " elements, extrapolated"},
           w[i], printed[i], 5e-4 * printed[i], {equals("Ω", omega) + ", mode " + std::to_string(i + 1)});
  }
}

/// Blade of two bars in a line or with a kink, clamped to a hub that rotates about z with the angular velocity `omega`.
struct BladeOfTwo {
  double omega;
  Bar inner, outer;
  Index inner_elements, outer_elements;
  double tolerance = 1e-9;  // of the relative equilibrium
};
/// Calls `read(model, x, marker at the tip, modes)` with the slowest modes about the relative equilibrium.
template <class B, class F>
void with_modes(BladeOfTwo const& blade, Index count, F const& read) {
  using Pin = Joint<Revolute, Constraint>;
  using Drive = Joint<PrescribedAngle<Ramp>, Constraint>;
  using Clamp = Joint<Weld, Constraint>;
  Model<Bodies<Rigid<>, B>, Joints<Pin, Drive, Clamp>> model;
  auto const hub = model.add(Rigid<>(1.0, Mat3::Identity(), Placement{}), "hub");
  auto const inner = model.add(B::from(blade.inner, blade.inner_elements), "inner blade");
  auto const outer = model.add(B::from(blade.outer, blade.outer_elements), "outer blade");
  model.connect(Pin{{.axis = Vec3::UnitZ()}, {}}, model.ground().at({0, 0, 0}), hub.at({0, 0, 0}), "shaft");
  model.connect(Drive{{Ramp{.target = blade.omega, .duration = 1.0}, Vec3::UnitZ()}, {}}, model.ground().at({0, 0, 0}),
                hub.at({0, 0, 0}), "drive");
  model.connect(Clamp{}, hub.at(blade.inner.placement.origin), inner.at(0.0), "root");
  model.connect(Clamp{}, inner.at(double(blade.inner.length)), outer.at(0.0, 0.0, 0.0), "middle");
  State x = model.reference_state();
  SteadyRotation const rotation{.angular_velocity = Vec3(0, 0, blade.omega), .point = Vec3::Zero()};
  relative_equilibrium(model, x, rotation, {.tolerance = blade.tolerance});
  DampedModes const modes = damped_modes(linearise(model, x, rotation), count);
  read(model, x, outer.at(double(blade.outer.length)), modes);
}

/// Aluminium blade of 31.5 in from the hub radius 2.5 in, with a tip of 6 in that is swept in the plane of rotation; in
/// pounds and inches. The shear and torsion factors of the flat section (1 in × 0.063 in) are those of Hodges, Shang &
/// Cesnik 1996. Returns the three lowest frequencies of flap [Hz] at `rpm` for a sweep in degrees. By symmetry flap and
/// chord do not couple, so that modes of flap are those whose tip moves along the axis of rotation.
template <class B>
std::array<double, 3> swept_frequencies(double rpm, double sweep) {
  double const e = 1.06e7, rho = 2.51e-4, g = e / 2.65, width = 1.0, height = 0.063, area = width * height,
               flap = width * height * height * height / 12.0, chord = width * width * width * height / 12.0,
               angle = sweep * std::numbers::pi / 180.0;
  Vec6 c, m;
  c << e * area, g * area / 1.2, g * area / 14.625, g * (flap + chord) / 65.8526, e * flap, e * chord;
  m << rho * area, rho * area, rho * area, rho * (flap + chord), rho * flap, rho * chord;
  Section6 const section{.stiffness = c.asDiagonal(), .mass = m.asDiagonal()};
  Placement const kink{.origin = Vec3(34, 0, 0), .axes = exp_so3<double>(Vec3(0, 0, -angle))};
  bool const cubic = std::same_as<B, Ffr>;
  BladeOfTwo const blade{.omega = rpm * std::numbers::pi / 30.0,
                         .inner = {.length = 31.5, .section = section, .placement = {.origin = Vec3(2.5, 0, 0)}},
                         .outer = {.length = 6.0, .section = section, .placement = kink},
                         .inner_elements = cubic ? 6 : 16,
                         .outer_elements = cubic ? 2 : 4};
  std::array<double, 3> out{};
  with_modes<B>(blade, 5, [&](auto const& model, State& x, auto const& tip, DampedModes const& modes) {
    std::size_t found = 0;
    for (Index i = 0; i < 5 && found < 3; ++i) {
      Vec3 moved = Vec3::Zero();
      for (VecX const& part : {VecX(modes.shape.col(i).real()), VecX(modes.shape.col(i).imag())}) {
        x.v = part;
        moved += frame(model, x, tip).v.cwiseAbs();
      }
      if (moved[2] > moved[1]) out[found++] = modes.frequency(i) / (2.0 * std::numbers::pi);
    }
  });
  return out;
}

// Measurements with one decimal, read in `rotating.jl` of GXBeam. Without sweep and rotation the closed form of the
// second mode, 22.03/(2π) √(EI/ρA)/L² = 9.32 Hz, is 10 % below the measured frequency; the third is 26.1 Hz. The first
// mode, 1.49 Hz against 1.4 to 1.8 Hz, is omitted.
TYPED_TEST(RotatingBlades, BladeWithASweptTip) {
  struct {
    double sweep, rpm, second, third;
  } const rows[] = {{0, 0, 10.3, 27.7},  {0, 500, 25.2, 47.0},  {0, 750, 36.1, 62.9},
                    {45, 0, 10.4, 24.8}, {45, 500, 21.6, 35.1}, {45, 750, 26.1, 44.8}};
  for (auto const& row : rows) {
    auto const f = swept_frequencies<TypeParam>(row.rpm, row.sweep);
    Claim const claim{"rotating blades", "flap frequency of a blade with a swept tip [Hz]", By::published,
                      "measured by Epps & Chandra 1996", std::string(formulation_family<TypeParam>)};
    std::string const at = equals("sweep", row.sweep) + "°, " + equals("rpm", row.rpm);
    held(claim, f[1], row.second, 0.1 * row.second, {at + ", mode 2"});
    held(claim, f[2], row.third, 0.07 * row.third, {at + ", mode 3"});
  }
}

/// Blade of 33.25 m with the hub radius 1.75 m whose sections rotate by 11.1°, in BModes' file blade_sec_props.dat;
/// rows between these are linear. Inertias are about the axis, which is the line of shear centres.
struct Station {
  double place;                             // part of the length
  double twist;                             // [°]
  double mass, flap_inertia, edge_inertia;  // per length [kg/m], [kg m]
  double flap, edge, torsion, axial;        // stiffnesses [N m²], [N]
  double centre_of_mass, shear_centre;      // chordwise [m]; the tension centre is at 0
};
constexpr Station stations[] = {
    {0, 11.1, 1447.607, 646.044, 646.044, 7681.46e6, 7681.46e6, 2655.23e6, 17152.7e6, 0, 0},
    {0.02105, 11.1, 180.333, 80.48, 80.48, 1169.87e6, 1169.87e6, 408.8e6, 2640.8e6, 0, 0},
    {0.21053, 11.1, 188.37, 7.045, 78.281, 274.4e6, 704.35e6, 18.87e6, 2463.6e6, 0.194, -0.032},
    {0.47368, 3.1, 138.123, 1.635, 28.387, 75.23e6, 255.87e6, 8.48e6, 1809.6e6, 0.164, 0.03},
    {0.73684, 0.6, 61.988, 0.296, 6.704, 11.53e6, 65.85e6, 1.68e6, 788.3e6, 0.183, 0.071},
    {1, 0, 11.353, 0.019, 0.747, 0.23e6, 7.87e6, 0.18e6, 118.5e6, 0.22, 0.098}};

/// Value of one column at x, part of the length.
double interpolated(double Station::* column, double x) {
  Station const* b = stations + 1;
  while (b->place < x && b + 1 < std::end(stations)) ++b;
  Station const* const a = b - 1;
  return a->*column + (x - a->place) / (b->place - a->place) * (b->*column - a->*column);
}

/// Section at the arc length s [m]. BModes has 12 elements of constant section, which is that of their middles, and of
/// constant twist rate. Shear is rigid.
Section6 section_of_bmodes(double s) {
  double const x = s / 33.25, middle = x < 0.8 ? 0.08 * (std::floor(x / 0.08) + 0.5) : (x < 0.9 ? 0.85 : 0.95);
  auto const at = [&](double Station::* column) { return interpolated(column, middle); };
  double const mass = at(&Station::mass), flap = at(&Station::flap_inertia), edge = at(&Station::edge_inertia),
               axial = at(&Station::axial), centre = at(&Station::centre_of_mass);
  Vec6 c, m;
  c << axial, 1e11, 1e11, at(&Station::torsion), at(&Station::flap), at(&Station::edge);
  m << mass, mass, mass, flap + edge, flap, edge;
  Section6 section{.stiffness = c.asDiagonal(), .mass = m.asDiagonal()};
  section.stiffness(0, 5) = section.stiffness(5, 0) = axial * at(&Station::shear_centre);
  section.mass(0, 5) = section.mass(5, 0) = -mass * centre;
  section.mass(2, 3) = section.mass(3, 2) = mass * centre;
  return section.placed(0, 0, interpolated(&Station::twist, x) * std::numbers::pi / 180.0);
}

// Thin shells of glass fibre imply densities down to 34 kg/m³.
TEST(RotatingBlades, SectionsOfBModesAreInSiUnits) {
  for (double s = 0.5; s < 33.25; s += 1.0) EXPECT_EQ(detail::unit_warning(section_of_bmodes(s), s), "");
}

/// The five lowest frequencies [Hz] of this blade at 60 rpm, with n elements in each element of BModes.
template <class B>
VecX twisted_frequencies(Index n) {
  double const split = 0.8 * 33.25;
  BladeOfTwo const blade{
      .omega = 2.0 * std::numbers::pi,
      .inner = {.length = split, .section = SectionAlong(section_of_bmodes), .placement = {.origin = Vec3(1.75, 0, 0)}},
      .outer = {.length = 33.25 - split,
                .section = SectionAlong([=](double s) { return section_of_bmodes(split + s); }),
                .placement = {.origin = Vec3(1.75 + split, 0, 0)}},
      .inner_elements = 10 * n,
      .outer_elements = 2 * n,
      .tolerance = 1e-6};
  VecX out(5);
  with_modes<B>(blade, 5, [&](auto const&, State const&, auto const&, DampedModes const& modes) {
    for (Index i = 0; i < 5; ++i) out[i] = modes.frequency(i) / (2.0 * std::numbers::pi);
  });
  return out;
}

// Frequencies of the flap and chord modes that version 3.00 of BModes prints for its file Test01_nonunif_blade.bmi, by
// 12 Euler–Bernoulli elements with centrifugal stiffness about the undeformed blade [Bir 2009]. The centrifugal force
// beside the axis bends the blade, which BModes neglects. Lrvf and Se3Beam are extrapolated from 12 and 24 elements.
// AncfBeam with 12 elements has a further error of up to 2.5 %.
TYPED_TEST(RotatingBlades, TwistedBladeOfAWindTurbine) {
  double const printed[] = {1.7517, 1.9444, 4.1912, 6.3492, 8.2913};
  bool const once = std::same_as<TypeParam, Ffr> || std::same_as<TypeParam, AncfBeam<CoupledLine>>;
  double const share = std::same_as<TypeParam, AncfBeam<CoupledLine>> ? 0.03 : 0.005;
  VecX f = twisted_frequencies<TypeParam>(1);
  if (!once) f = (4.0 * twisted_frequencies<TypeParam>(2) - f) / 3.0;
  for (int i = 0; i < 5; ++i)
    held({"rotating blades", "frequency of the twisted blade of a wind turbine [Hz]", By::independent,
          "BModes 3.00, Test01_nonunif_blade.out",
          std::string(formulation_family<TypeParam>) + (once ? ", 12 elements" : ", 12 and 24 elements, extrapolated")},
         f[i], printed[i], share * printed[i], {equals("mode", i + 1)});
}

}  // namespace rotating_blades_test
