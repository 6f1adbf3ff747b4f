// Lee's frame (S9a) by the spatial Lrvf, which stays in its plane, compared with an independent computation of the
// exact frame with shear.

#include <polybody/bodies/lrvf/lrvf.hpp>

#include <gtest/gtest.h>

#include <numbers>

#include <polybody/forces/loads.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/statics/arc_length.hpp>
#include <polybody/statics/equilibrium.hpp>

#include "support/held.hpp"
#include "support/solver_instances.hpp"

using namespace polybody;

namespace spatial_lee_frame_test {

/// Two legs of 120, welded at a right angle and pinned at their other ends. P presses down at 24 from the right
/// angle.
struct LeeFrame {
  using Pin = Joint<Revolute, Constraint>;
  using Corner = Joint<Weld, Constraint>;
  Model<Bodies<Lrvf<>>, Joints<Pin, Corner>, Forces<PointForce<>>> model;
  BodyHandle<Lrvf<>> column, beam;

  LeeFrame(Index n, double P)
      : column(model.add(Lrvf<>::from(leg(Placement::planar(0, 0, 0.5 * std::numbers::pi)), n), "column")),
        beam(model.add(Lrvf<>::from(leg(Placement::planar(0, 120)), n), "beam")) {
    model.connect(Pin{{.axis = Vec3::UnitZ()}, {}}, model.ground().at({0, 0, 0}), column.at(0.0), "foot");
    model.connect(Corner{}, column.at(120.0), beam.at(0.0), "corner");
    model.connect(Pin{{.axis = Vec3::UnitZ()}, {}}, model.ground().at({120, 120, 0}), beam.at(120.0), "support");
    model.apply(PointForce<>{.force = {0, -P, 0}}, beam.at(24.0), "P");
  }
  /// GA for ν = 0.3, k = 5/6. The stiffness against torsion and bending out of the plane is arbitrary.
  static Bar leg(Placement const& placement) {
    return {
        .length = 120.0,
        .constants =
            BarConstants{
                .EA = 7.2e6 * 6, .EI = 7.2e6 * 2, .mass_per_length = 1.0, .GA = 1.3846154e7, .GJ = 8e6, .EI_y = 4e7},
        .placement = placement};
  }
  /// Displacement under the load.
  Vec3 displacement(State const& x) const { return position(model, x, beam.at(24.0)) - Vec3(24, 120, 0); }
};

struct Row {
  double P;
  Vec3 u;
};
std::vector<Row> const stable{{10000, {1.91695526, -10.72539876, 0}},
                              {15000, {8.02822216, -25.89263379, 0}},
                              {18000, {18.86762014, -41.48217810, 0}}};

/// Displacements by load control.
std::vector<Vec3> pushed(Index n) {
  std::vector<Vec3> out;
  State x = LeeFrame(n, 0.0).model.reference_state();
  for (Row const& row : stable) {
    LeeFrame const frame(n, row.P);
    equilibrium(frame.model, x, {.tolerance = 1e-9});
    out.push_back(frame.displacement(x));
  }
  return out;
}

// Elements are of order 2. Two meshes are extrapolated.
TEST(LeeFrameInSpace, ExtrapolatesToTheExactFrame) {
  std::vector<Vec3> const coarse = pushed(40), fine = pushed(80);
  for (std::size_t i = 0; i < stable.size(); ++i) {
    Vec3 const limit = (4.0 * fine[i] - coarse[i]) / 3.0, u = stable[i].u;
    auto const claim = [](char const* mesh) {
      return Claim{"S9a", "displacement under the load, in space", By::independent,
                   "shooting on Reissner's beam, arc length", mesh};
    };
    Instance const at{equals("P", stable[i].P), u.norm()};
    held_within(claim("Lrvf, 80 elements a leg"), (fine[i] - u).norm(), 1e-3 * u.norm(), at);
    held_within(claim("Lrvf, 40 and 80 elements a leg extrapolated"), (limit - u).norm(), 1e-5 * u.norm(), at);
  }
}

// Both limit loads, 18544.5271 and −9392.4896, to the tolerance 0.3 % of S9a. Each is computed by the parabola
// through three points of the path.
TEST(LeeFrameInSpace, HasItsLimitLoads) {
  double const unit = 1e4;
  LeeFrame const frame(48, unit);
  std::vector<PathPoint> const path =
      equilibrium_path(frame.model, frame.model.reference_state(), {.step = 0.03, .max_step = 0.03, .points = 2000},
                       [&](PathPoint const& p) { return p.load_factor > 0.0 && frame.displacement(p.x)[1] < -75.0; });
  double high = 0.0, low = 0.0;
  for (std::size_t i = 1; i + 1 < path.size(); ++i) {
    double const a = path[i - 1].load_factor, b = path[i].load_factor, c = path[i + 1].load_factor;
    double const top = unit * (b - (c - a) * (c - a) / (8.0 * (a - 2.0 * b + c)));
    if (b > a && b >= c) high = std::max(high, top);
    if (b < a && b <= c) low = std::min(low, top);
    EXPECT_EQ(frame.displacement(path[i].x)[2], 0.0);
  }
  auto const of_load = [](char const* what, double value, double exact) {
    held({"S9a", what, By::independent, "shooting on Reissner's beam, arc length", "Lrvf, 48 elements a leg"}, value,
         exact, 3e-3 * std::abs(exact));
  };
  of_load("upper limit load, by arc length", high, 18544.5271);
  of_load("lower limit load, by arc length", low, -9392.4896);
}

}  // namespace spatial_lee_frame_test
