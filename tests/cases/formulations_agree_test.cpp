// One bar in every formulation: a steel cantilever under a small tip force, the stiff pendulum D6c and the moderately
// flexible pendulum D6b.
#include <gtest/gtest.h>

#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/ffr/planar_ffr.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/se3/se3_beam.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/marker_frames.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/statics/equilibrium.hpp>

#include "support/held.hpp"

namespace formulations_agree_test {

using namespace polybody;

template <class B>
constexpr bool plane = B::world == World::plane;
/// A cable has no section orientation except its tangent. A Revolute about the tangent clamps it, and a Spherical
/// joint hangs it.
template <class B>
using Clamp = Joint<
    std::conditional_t<plane<B>, planar::Weld, std::conditional_t<B::observes == MarkerKind::frame, Weld, Revolute>>,
    Constraint>;
template <class B>
using Pin = Joint<std::conditional_t<plane<B>, planar::Revolute,
                                     std::conditional_t<B::observes == MarkerKind::frame, Revolute, Spherical>>,
                  Constraint>;

/// Model type for both cases, which is compiled once.
template <class B>
using ModelOf = Model<Bodies<B>, Joints<Clamp<B>, Pin<B>>, Forces<PointForce<>>>;

/// The other formulations have a bending theory: their shear force is the derivative of the moment.
template <class B>
constexpr bool knows_shear = !std::same_as<B, AncfCable<>> && !std::same_as<B, Ffr> && !std::same_as<B, planar::Ffr>;

template <class B>
std::string const name_of = std::same_as<B, AncfCable<>>             ? "AncfCable"
                            : std::same_as<B, AncfBeam<ElasticLine>> ? "AncfBeam"
                            : std::same_as<B, AncfBeam<Continuum<>>> ? "AncfBeam<Continuum>"
                            : std::same_as<B, Lrvf<>>                ? "Lrvf"
                            : std::same_as<B, Se3Beam>               ? "Se3Beam"
                            : std::same_as<B, Ffr>                   ? "Ffr"
                                                                     : "planar Ffr";
Claim spectral(char const* case_id, std::string const& formulation) {
  return {case_id, "tip [m]", By::independent, "spectral geometrically exact beam, two meshes", formulation};
}

template <class B>
struct EveryFormulation : testing::Test {};
using All =
    testing::Types<AncfCable<>, AncfBeam<ElasticLine>, AncfBeam<Continuum<>>, Lrvf<>, Se3Beam, Ffr, planar::Ffr>;
TYPED_TEST_SUITE(EveryFormulation, All);

// P L³/3EI, to 1 %; 1e-2 L at the tip. Shear adds 3EI/GAL² = 7e-4.
TYPED_TEST(EveryFormulation, SteelCantileverBendsAlike) {
  Bar const bar{.length = 1.0,
                .section = Rectangle{.height = 0.03, .width = 0.02},
                .material = Material{.density = 7800.0, .young = 2e11, .poisson = 0.3}};
  BarConstants const c = constants(bar);
  double const expected = 0.01, force = 3 * c.EI * expected;
  ModelOf<TypeParam> model;
  auto const beam = model.add(TypeParam::from(bar, 16), "beam");
  Clamp<TypeParam> clamp;
  if constexpr (requires { clamp.geometry.axis; }) clamp.geometry.axis = Vec3::UnitX();
  model.connect(clamp, model.ground().at({0, 0, 0}), beam.at(0.0), "clamp");
  model.apply(PointForce<>{.force = {0, force, 0}}, beam.at(1.0));
  State x = model.reference_state();
  equilibrium(model, x);
  Vec3 const tip = position(model, x, beam.at(1.0));
  EXPECT_NEAR(tip[1], expected, 0.01 * expected);
  EXPECT_LT(std::abs(tip[2]), 1e-9);

  // the section force in the middle of the ninth element is in balance with the load, for small angles
  double const s = 8.5 / 16, moment = force * (1.0 - s);
  Vec6 const n = section_forces(model, x, beam.at(s)), e = section_strains(model, x, beam.at(s));
  EXPECT_NEAR(n[5], moment, 0.01 * moment);
  EXPECT_NEAR(e[5], moment / c.EI, 0.01 * moment / c.EI);
  EXPECT_NEAR(curvature(model, x, beam.at(s)), moment / c.EI, 0.01 * moment / c.EI);
  EXPECT_LT(std::abs(n[0]), 0.03 * force);  // its small angle, and the square of the curvature
  EXPECT_LT(std::hypot(n[2], n[3], n[4]), 1e-6 * force);
  if constexpr (knows_shear<TypeParam>) {
    EXPECT_NEAR(n[1], force, 0.01 * force);
    EXPECT_NEAR(e[1], force / c.GA, 0.01 * force / c.GA);
  } else {
    EXPECT_EQ(n[1], 0.0);
  }
  if constexpr (requires { beam.at(s, 0.01); }) {  // the upper fibre is in compression
    EXPECT_NEAR(axial_strain(model, x, beam.at(s, 0.01)), -0.01 * moment / c.EI, 1e-4 * moment / c.EI);
    EXPECT_NEAR(axial_stress(model, x, beam.at(s, 0.01), bar), -0.01 * moment * 2e11 / c.EI, 2e7 * moment / c.EI);
  }
}

// D6c: tolerance 1e-4 m. Cables have no rotary inertia, whose effect is 8e-4 m at 0.5 s.
TYPED_TEST(EveryFormulation, StiffPendulumSwingsAlike) {
  Bar const bar{.length = 1.0,
                .section = Rectangle{.height = 0.05, .width = 0.05},
                .material = Material{.density = 4000.0, .young = 2.1e10, .poisson = 0.3}};
  ModelOf<TypeParam> model{Gravity{0, -9.81, 0}};
  auto const rod = model.add(TypeParam::from(bar, 6), "rod");
  Pin<TypeParam> pin;
  if constexpr (requires { pin.geometry.axis; }) pin.geometry.axis = Vec3::UnitZ();
  model.connect(pin, model.ground().at({0, 0, 0}), rod.at(0.0), "pin");
  struct Row {
    double t, x, y;
  };
  std::vector<Row> const rows{{0.1, 0.9972992192, -0.0734484788},  {0.2, 0.9573053663, -0.2890813990},
                              {0.3, 0.7946942404, -0.6070127388},  {0.5, -0.0893682330, -0.9960014555},
                              {0.7, -0.8681470834, -0.4963098050}, {1.0, -0.9999679437, -0.0080097355}};
  double const tolerance = std::same_as<TypeParam, AncfCable<>> ? 1e-3 : 1e-4;
  std::size_t next = 0;
  State x = model.reference_state();
  for (State const& now : simulate(model, x, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = 1.0, .step = 1e-3})) {
    if (next == rows.size() || std::abs(now.t - rows[next].t) > 1e-9) continue;
    Vec3 const tip = position(model, now, rod.at(1.0));
    held_within(spectral("D6c", name_of<TypeParam> + ", 6 elements, h = 1e-3 s"),
                (tip - Vec3(rows[next].x, rows[next].y, 0)).norm(), tolerance, {equals("t", now.t), 1.0});
    ++next;
  }
  EXPECT_EQ(next, rows.size());
}

// D6b, 3 s. The tolerance is 5e-4 for cables of 8 elements and for beams of order two with enough elements. It is 2 %
// for floating frames. Cables have no shear.
TYPED_TEST(EveryFormulation, FlexiblePendulumSwingsAlike) {
  using B = TypeParam;
  Bar const bar{.length = 1.0,
                .section = Rectangle{.height = 0.02, .width = 0.02},
                .material = Material{.density = 2500.0, .young = 3.75e8, .poisson = 0.3}};
  constexpr bool cable = std::same_as<B, AncfCable<>>, frame = std::same_as<B, Ffr> || std::same_as<B, planar::Ffr>;
  Index const elements = cable ? 8 : frame ? 6 : std::same_as<B, Lrvf<>> || std::same_as<B, Se3Beam> ? 64 : 32;
  double const tolerance = frame ? 0.02 : 5e-4;
  ModelOf<B> model{Gravity{0, -9.81, 0}};
  auto const rod = model.add(B::from(bar, elements), "rod");
  Pin<B> pin;
  if constexpr (requires { pin.geometry.axis; }) pin.geometry.axis = Vec3::UnitZ();
  model.connect(pin, model.ground().at({0, 0, 0}), rod.at(0.0), "pin");
  struct Row {
    double t;
    Vec3 tip;
  };
  std::vector<Row> const with_shear{{0.1, {0.997688, -0.061850, 0}},  {0.2, {0.957377, -0.288926, 0}},
                                    {0.5, {-0.093346, -0.995676, 0}}, {1.0, {-0.999924, -0.003451, 0}},
                                    {1.5, {0.269393, -0.963020, 0}},  {2.0, {0.999390, -0.020173, 0}},
                                    {3.0, {-0.997764, -0.063488, 0}}};
  std::vector<Row> const without{{0.5, {-0.093390, -0.995671, 0}},
                                 {1.0, {-0.999921, -0.003370, 0}},
                                 {2.0, {0.999386, -0.019993, 0}},
                                 {3.0, {-0.997753, -0.063940, 0}}};
  State x = model.reference_state();
  for (Row const& row : cable ? without : with_shear) {
    simulate(model, x, GeneralisedAlpha{.rho_inf = 0.9}, {.end_time = row.t, .step = 1e-3}).run();
    held_within(spectral("D6b", name_of<B> + ", " + std::to_string(elements) + " elements, h = 1e-3 s"),
                (position(model, x, rod.at(1.0)) - row.tip).norm(), tolerance, {equals("t", row.t), 1.0});
  }
}

}  // namespace formulations_agree_test
