// Lee's frame (S9a) up to its upper limit load, compared with an independent computation of the exact frame.

#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>

#include <gtest/gtest.h>

#include <polybody/forces/loads.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/statics/equilibrium.hpp>

#include "support/held.hpp"
#include "support/solver_instances.hpp"

using namespace polybody;

namespace lee_frame_test {

using Cable = planar::AncfCable<planar::EngineeringStrain>;

double const EA = 7.2e6 * 6, EI = 7.2e6 * 2;
double const with_shear = 1.3846154e7;  ///< GA for ν = 0.3, k = 5/6

/// Two legs of 120, welded at a right angle and pinned at their other ends. P presses down at 24 from the right
/// angle. A slider can constrain the loaded point to a given u. Its vertical motion and its rotation remain free.
template <class B>
struct LeeFrame {
  using Pin = Joint<planar::Revolute, Constraint>;
  using Corner = Joint<planar::Weld, Constraint>;
  using Rail = Joint<planar::Prismatic, Constraint>;
  Model<Bodies<B, planar::Rigid>, Joints<Pin, Corner, Rail>, Forces<PointForce<>>> model;
  BodyHandle<B> column, beam;
  std::optional<ElementHandle<Pin>> hold;

  LeeFrame(Index n_column, Index n_beam, double GA, double P, std::optional<double> u = {})
      : column(model.add(B::from(leg(Placement::planar(0, 0, 0.5 * std::numbers::pi), GA), n_column), "column")),
        beam(model.add(B::from(leg(Placement::planar(0, 120), GA), n_beam), "beam")) {
    model.connect(Pin{}, model.ground().at({0, 0, 0}), column.at(0.0), "foot");
    model.connect(Corner{}, column.at(120.0), beam.at(0.0), "corner");
    model.connect(Pin{}, model.ground().at({120, 120, 0}), beam.at(120.0), "support");
    model.apply(PointForce<>{.force = {0, -P, 0}}, beam.at(24.0), "P");
    if (u) {
      auto const slider =
          model.add(planar::Rigid({.mass = 1.0, .inertia = 1.0, .placement = Placement::planar(24, 120)}), "slider");
      model.connect(Rail{{.axis = Vec3::UnitY()}, {}}, model.ground().at({24 + *u, 120, 0}), slider.at(Vec2(0, 0)),
                    "rail");
      hold = model.connect(Pin{}, slider.at(Vec2(0, 0)), beam.at(24.0), "hold");
    }
  }
  static Bar leg(Placement const& placement, double GA) {
    return {.length = 120.0,
            .constants = BarConstants{.EA = EA, .EI = EI, .mass_per_length = 1.0, .GA = GA},
            .placement = placement};
  }
  /// Displacement (u, v) under the load: to the right and upwards.
  Vec2 displacement(State const& x) const {
    return (position(model, x, beam.at(24.0)) - Vec3(24, 120, 0)).template head<2>();
  }
};

struct Row {
  double P;
  Vec2 u;
};
std::vector<Row> const no_shear{{2500, {0.06598205, -1.68393990}},    {5000, {0.30961377, -3.79148183}},
                                {7500, {0.84601606, -6.61323586}},    {10000, {1.91433177, -10.70687468}},
                                {12500, {4.01017257, -16.91092759}},  {15000, {8.00962432, -25.84100458}},
                                {17000, {13.74672200, -35.18507243}}, {18000, {18.78689691, -41.37468981}}};
std::vector<Row> const shear{
    {10000, {1.91695526, -10.72539876}}, {15000, {8.02822216, -25.89263379}}, {18000, {18.86762014, -41.48217810}}};

EquilibriumOptions const options{.tolerance = 1e-9};

/// Displacements by load control; each leg has `legs` elements.
template <class B>
std::vector<Vec2> pushed(Index legs, double GA, std::vector<Row> const& rows) {
  std::vector<Vec2> out;
  State x = LeeFrame<B>(legs, legs, GA, 0.0).model.reference_state();
  for (Row const& row : rows) {
    LeeFrame<B> const frame(legs, legs, GA, row.P);
    equilibrium(frame.model, x, options);
    out.push_back(frame.displacement(x));
  }
  return out;
}
Claim exact_frame(char const* what, char const* formulation) {
  return {"S9a", what, By::independent, "shooting on Reissner's beam, arc length", formulation};
}
double miss(Vec2 const& u, Row const& row) { return (u - row.u).norm() / row.u.norm(); }

// Twenty cable elements have an error of 3e-3 of the displacement. Close to the limit load the small error of the
// load dominates. Forty elements have 1e-4.
TEST(LeeFrame, CableFollowsTheExactFrameUpToTheLimit) {
  std::vector<Vec2> const coarse = pushed<Cable>(10, 0.0, no_shear), fine = pushed<Cable>(20, 0.0, no_shear);
  for (std::size_t i = 0; i < no_shear.size(); ++i) {
    char const* const what = "displacement of the load without shear, of itself";
    Instance const at{equals("P", no_shear[i].P), 1.0};
    held_within(exact_frame(what, "planar AncfCable, 20 elements"), miss(coarse[i], no_shear[i]), 3e-3, at);
    held_within(exact_frame(what, "planar AncfCable, 40 elements"), miss(fine[i], no_shear[i]), 1e-4, at);
  }
}

// Two-node elements of order 2, with shear. Two meshes are extrapolated.
TEST(LeeFrame, LrvfExtrapolatesToTheExactFrameWithShear) {
  std::vector<Vec2> const coarse = pushed<planar::Lrvf>(40, with_shear, shear);
  std::vector<Vec2> const fine = pushed<planar::Lrvf>(80, with_shear, shear);
  for (std::size_t i = 0; i < shear.size(); ++i) {
    Vec2 const limit = (4.0 * fine[i] - coarse[i]) / 3.0;
    char const* const what = "displacement of the load with shear, of itself";
    Instance const at{equals("P", shear[i].P), 1.0};
    held_within(exact_frame(what, "planar Lrvf, 160 elements"), miss(fine[i], shear[i]), 1e-3, at);
    held_within(exact_frame(what, "planar Lrvf, 80 and 160 elements extrapolated"), miss(limit, shear[i]), 1e-5, at);
  }
}

// Without shear: GA of a thousand times EA causes an error of 1e-6 of the displacement. Newton's method requires
// substeps between the loads.
TEST(LeeFrame, LrvfExtrapolatesToTheExactFrameWithoutShear) {
  std::vector<Vec2> const coarse = pushed<planar::Lrvf>(40, 1e3 * EA, no_shear);
  std::vector<Vec2> const fine = pushed<planar::Lrvf>(80, 1e3 * EA, no_shear);
  for (std::size_t i = 0; i < no_shear.size(); ++i) {
    Vec2 const limit = (4.0 * fine[i] - coarse[i]) / 3.0;
    char const* const what = "displacement of the load without shear, of itself";
    Instance const at{equals("P", no_shear[i].P), 1.0};
    held_within(exact_frame(what, "planar Lrvf, 160 elements"), miss(fine[i], no_shear[i]), 1e-3, at);
    held_within(exact_frame(what, "planar Lrvf, 80 and 160 elements extrapolated"), miss(limit, no_shear[i]), 1e-5, at);
  }
}

/// Upper limit load from the parabola through three points of the path near u₀. Load control fails at the limit load.
/// With the loaded point on the rail at u the method continues. Secants find the load with zero force of the rail.
template <class B>
struct UpperLimit {
  Index legs;
  double GA;
  State x;
  double v = 0.0;

  UpperLimit(Index n, double ga) : legs(n), GA(ga), x(LeeFrame<B>(n, n, ga, 0.0, 0.0).model.reference_state()) {}

  double hold(double P, double u) {
    LeeFrame<B> const frame(legs, legs, GA, P, u);
    equilibrium(frame.model, x, options);
    v = frame.displacement(x)[1];
    return reaction(frame.model, x, *frame.hold).f[0];
  }
  /// Load of the path at u.
  double load(double near, double u) {
    double a = near, b = near + 100.0, at_a = hold(a, u), at_b = hold(b, u);
    for (int i = 0; i < 20 && std::abs(b - a) > 1e-4; ++i) {
      double const next = b - at_b * (b - a) / (at_b - at_a);
      a = b;
      at_a = at_b;
      b = next;
      at_b = hold(b, u);
    }
    EXPECT_LT(std::abs(at_b), 1e-3);
    return b;
  }
  /// Limit point (P, u, v).
  Vec3 find(double u0) {
    for (Row const& row : no_shear) load(row.P, row.u[0]);
    double const d = 0.5;
    double const before = load(18500, u0 - d), middle = load(before, u0), v0 = v, after = load(middle, u0 + d), v1 = v;
    double const slope = (after - before) / 2.0, bend = after - 2.0 * middle + before, step = -slope / bend;
    EXPECT_LT(std::abs(step), 2.0);
    return {middle - 0.5 * slope * slope / bend, u0 + d * step, v0 + step * (v1 - v0)};
  }
};

// The independent computation gives 18556.7275 at (26.880571, −48.735135) without shear and 18544.5271 at (26.878328,
// −48.754241) with shear. The tolerance of S9a, 0.3 % with twenty elements, is that of elements of a higher order.
// Twenty cable elements have an error of 0.08 %. The two-node Lrvf requires more than forty elements.
TEST(LeeFrame, UpperLimitLoadIsThatOfTheExactFrame) {
  double const cable = 18556.7275, lrvf = 18544.5271;
  Vec3 const coarse_cable = UpperLimit<Cable>(10, 0.0).find(26.9), fine_cable = UpperLimit<Cable>(20, 0.0).find(26.9);
  char const *const twenty = "planar AncfCable, 20 elements", *const forty = "planar AncfCable, 40 elements";
  held(exact_frame("upper limit load without shear", twenty), coarse_cable[0], cable, 1e-3 * cable);
  held(exact_frame("upper limit load without shear", forty), fine_cable[0], cable, 1e-4 * cable);
  held(exact_frame("u at the upper limit without shear", forty), fine_cable[1], 26.880571, 5e-3);
  held(exact_frame("v at the upper limit without shear", forty), fine_cable[2], -48.735135, 5e-3);
  Vec3 const coarse = UpperLimit<planar::Lrvf>(40, with_shear).find(26.9);
  Vec3 const fine = UpperLimit<planar::Lrvf>(80, with_shear).find(26.9);
  Vec3 const limit = (4.0 * fine - coarse) / 3.0;
  char const* const meshes = "planar Lrvf, 80 and 160 elements extrapolated";
  held(exact_frame("upper limit load with shear", "planar Lrvf, 80 elements"), coarse[0], lrvf, 1e-3 * lrvf);
  EXPECT_NEAR((coarse[0] - lrvf) / (fine[0] - lrvf), 4.0, 0.1);
  held(exact_frame("upper limit load with shear", meshes), limit[0], lrvf, 1e-6 * lrvf);
  held(exact_frame("u at the upper limit with shear", meshes), limit[1], 26.878328, 5e-3);
  held(exact_frame("v at the upper limit with shear", meshes), limit[2], -48.754241, 5e-3);
}

}  // namespace lee_frame_test
