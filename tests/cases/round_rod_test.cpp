// X3: clamped round rod under a tip force, a tip torque, and two welded rods under a torque (after
// google-deepmind/mujoco#2208 and GazzolaLab/PyElastica#135).

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/joints/policies/penalty.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/se3_beam.hpp>
#include <polybody/statics/equilibrium.hpp>

#include "support/held.hpp"

namespace polybody {
namespace round_rod_test {

using std::numbers::pi;

double const length = 0.5, radius = 4e-3, young = 2.5e9, poisson = 0.35, force = 0.05, torque = 0.1;
double const area = pi * radius * radius, shear = young / (2.0 * (1.0 + poisson));
double const GA = 6.0 * (1.0 + poisson) / (7.0 + 6.0 * poisson) * shear * area;  // Cowper 1966

Bar rod(double from) {
  return {.length = length,
          .section = Circle{.radius = radius},
          .material = Material{.density = 1000.0, .young = young, .poisson = poisson},
          .placement = Placement::at({from, 0, 0})};
}

/// Rods in a row along x, welded to the ground and to each other, in equilibrium under a dead load at the last end. A
/// cable has no torsion, and a pin about its tangent clamps it.
template <class B, class Policy = Constraint>
struct Rods {
  static constexpr bool has_axes = B::observes == MarkerKind::frame;
  using Clamp = Joint<std::conditional_t<has_axes, Weld, Revolute>, Policy>;
  Model<Bodies<B>, Joints<Clamp>, Forces<PointForce<>, PointMoment<>>> model;
  std::vector<BodyHandle<B>> rods;
  std::vector<ElementHandle<Clamp>> clamps;
  State x;

  Rods(Index elements, int count, Vec3 const& f, Vec3 const& m, Policy const& policy = {}) {
    Clamp clamp{{}, policy};
    if constexpr (!has_axes) clamp.geometry.axis = Vec3::UnitX();
    rods.push_back(model.add(B::from(rod(0.0), elements)));
    clamps.push_back(model.connect(clamp, model.ground().at({0, 0, 0}), rods[0].at(0.0)));
    if constexpr (has_axes)
      for (int i = 1; i < count; ++i) {
        rods.push_back(model.add(B::from(rod(i * length), elements)));
        clamps.push_back(model.connect(clamp, rods[rods.size() - 2].at(length), rods.back().at(0.0)));
      }
    model.apply(PointForce<>{.force = f}, rods.back().at(length));
    model.apply(PointMoment<>{.moment = m}, rods.back().at(length));
    x = model.reference_state();
    equilibrium(model, x);
  }
  /// Displacement (u_x, u_y) [m] and slope [rad] of the last end.
  Vec3 tip() const {
    Frame<double> const end = frame(model, x, rods.back().at(length));
    return {end.r[0] - length * double(rods.size()), end.r[1], std::atan2(end.A(1, 0), end.A(0, 0))};
  }
  /// Rotation of the end of a rod about x [rad].
  double twist(std::size_t i, double s) const {
    Mat3 const axes = frame(model, x, rods[i].at(s)).A;
    return std::atan2(axes(2, 1), axes(1, 1));
  }
};

// (a) Elastica without shear, by elliptic integrals: deflection w, slope and shortening of the tip. The section rotates
// by ϑ(s), so that the shear γ = F cos ϑ/kGA and the strain ε = F sin ϑ/EA add
//   ∫ γ cos ϑ ds = F L/kGA to w, and ∫ (γ − F cos ϑ/EA) sin ϑ ds = F w (1/kGA − 1/EA) to the shortening.
Vec3 expected(bool shears) {
  double const w = 4.144367e-3, soft = shears ? 1.0 / GA : 0.0;
  return {-2.0611e-5 - force * w * (soft - 1.0 / (young * area)), w + force * length * soft, 0.01243328};
}
/// \param tolerance relative errors of shortening, deflection and slope
void held_tip(Vec3 const& found, bool shears, Vec3 const& tolerance, char const* formulation) {
  Vec3 const right = expected(shears);
  char const* const what[] = {"shortening of the round rod [m]", "deflection of the round rod [m]",
                              "slope of the round rod [rad]"};
  for (int i = 0; i < 3; ++i)
    held({"X3", what[i], By::independent, "elastica by elliptic integrals", formulation}, found[i], right[i],
         tolerance[i] * std::abs(right[i]));
}
template <class B>
Vec3 bent(Index elements) {
  return Rods<B>(elements, 1, {0, force, 0}, Vec3::Zero()).tip();
}

template <class B>
Vec3 limit() {
  return (4.0 * bent<B>(16) - bent<B>(8)) / 3.0;
}

// The curvature is constant in an element of AncfBeam, Lrvf and Se3Beam. The linear theory then gives n elements the
// relative errors 1/4n² of the deflection and up to 5/8n² of the shortening, and no error of the slope.
TEST(RoundRod, BendsAsTheElastica) {
  Vec3 const stated = Vec3::Constant(1e-4), coarse(1e-2, 4e-3, 1e-4);
  held_tip(bent<AncfCable<EngineeringStrain>>(8), false, stated, "AncfCable, engineering strain, 8 elements");
  held_tip(bent<AncfCable<GreenStrain>>(8), false, stated, "AncfCable, Green strain, 8 elements");
  held_tip(bent<Ffr>(8), false, stated, "Ffr, 8 elements");
  held_tip(bent<AncfBeam<>>(8), true, coarse, "AncfBeam, 8 elements");
  held_tip(bent<Lrvf<>>(8), true, coarse, "Lrvf, 8 elements");
  held_tip(bent<Se3Beam>(8), true, coarse, "Se3Beam, 8 elements");
  held_tip(limit<AncfBeam<>>(), true, stated, "AncfBeam, 8 and 16 elements extrapolated");
  held_tip(limit<Lrvf<>>(), true, stated, "Lrvf, 8 and 16 elements extrapolated");
  held_tip(limit<Se3Beam>(), true, stated, "Se3Beam, 8 and 16 elements extrapolated");
}

// (b), (c) Torsion with the polar moment of the circle: M L/GJ = 0.13428698 rad per rod, GJ = G π r⁴/2.
template <class B, class Policy = Constraint>
void twists(char const* formulation, Policy const& policy = {}, Index elements = 8) {
  double const angle = torque * length / (shear * 0.5 * pi * std::pow(radius, 4));
  EXPECT_NEAR(angle, 0.13428698, 5e-9);
  auto const claim = [&](char const* what) {
    return Claim{"X3", what, By::closed_form, "M L/GJ, GJ = G π r⁴/2", formulation};
  };
  Rods<B, Policy> const one(elements, 1, Vec3::Zero(), {torque, 0, 0}, policy);
  held(claim("twist of the round rod [rad]"), one.twist(0, length), angle, 1e-4 * angle);
  Rods<B, Policy> const two(elements, 2, Vec3::Zero(), {torque, 0, 0}, policy);
  held(claim("twist of two welded rods at the joint [rad]"), two.twist(0, length), angle, 1e-4 * angle, {"first rod"});
  held(claim("twist of two welded rods at the joint [rad]"), two.twist(1, 0.0), angle, 1e-4 * angle, {"second rod"});
  held(claim("twist of two welded rods at the end [rad]"), two.twist(1, length), 2.0 * angle, 2e-4 * angle);
  Claim const moment{"X3", "moment of the weld between two rods [N m]", By::closed_form, "torque at the end",
                     formulation};
  held(moment, -reaction(two.model, two.x, two.clamps[1]).m[0], torque, 1e-4 * torque);
}

// With `Continuum` the directors shrink within an element by ψ²/8 for a twist of ψ from node to node, which changes the
// angle by ψ²/2: 1.4e-4 with 8 elements.
TEST(RoundRod, TwistsByThePolarMoment) {
  twists<AncfBeam<>>("AncfBeam, 8 elements, Constraint");
  twists<AncfBeam<Continuum<>>>("AncfBeam, Continuum, 16 elements, Constraint", {}, 16);
  twists<Lrvf<>>("Lrvf, 8 elements, Constraint");
  twists<Se3Beam>("Se3Beam, 8 elements, Constraint");
  twists<Ffr>("Ffr, 8 elements, Constraint");
  twists<AncfBeam<>, AncfLinear>("AncfBeam, 8 elements, AncfLinear");
  twists<Lrvf<>, Penalty>("Lrvf, 8 elements, Penalty", {.stiffness = 1e7, .damping = 0.0});
  twists<Ffr, JointCoordinates>("Ffr, 8 elements, JointCoordinates");
}

}  // namespace round_rod_test
}  // namespace polybody
