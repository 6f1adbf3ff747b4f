// Spatial rigid slider-crank of the IFToMM library (M5; data of MBDyn and Exudyn) with both published positions of
// the crank's mass centre.

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/bodies/rigid/rigid_euler_parameters.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/doubled_joints.hpp"
#include "support/held.hpp"

namespace polybody {
namespace spatial_slider_crank_test {

/// Crank A–B rotates about x, rod B–C, slider C along x. \tparam Tree policy of hinge, ball and slide; the universal
/// joint closes the loop by constraint equations
template <class Body, class Tree>
struct SliderCrank {
  using Hinge = Joint<Revolute, Tree>;
  using Ball = Joint<Spherical, Tree>;
  using Slide = Joint<Prismatic, Tree>;
  using Cross = Joint<Universal, Constraint>;
  Vec3 const A{0, 0.1, 0.12}, B{0, 0.1, 0.2}, C{0.2, 0, 0};
  Model<Bodies<Body>, Joints<Hinge, Ball, Slide, Cross>> model{Gravity{0, 0, -9.81}};
  BodyHandle<Body> crank, rod, slider;
  Marker<Body> pin_b, end_c;
  State x;

  /// \param arm distance of the crank's mass centre from the hinge
  explicit SliderCrank(double arm)
      : crank(model.add(Body(0.12, 1e-4 * Mat3::Identity(), Placement::at(A + Vec3(0, 0, arm))), "crank")),
        rod(model.add(Body(0.5, inertia_of_rod(), Placement::at(0.5 * (B + C))), "rod")),
        slider(model.add(Body(2.0, 1e-3 * Mat3::Identity(), Placement::at(C)), "slider")),
        pin_b(crank.at(Vec3(0, 0, 0.08 - arm))),
        end_c(slider.at(Vec3(0, 0, 0))) {
    Vec3 const ex = Vec3::UnitX(), half = 0.5 * (C - B);
    model.connect(Hinge{Revolute{.axis = ex}, {}}, model.ground().at(A), crank.at(Vec3(0, 0, -arm)), "hinge");
    model.connect(Ball{}, pin_b, rod.at(Vec3(-half)), "ball");
    model.connect(Slide{Prismatic{.axis = ex}, {}}, model.ground().at(C), end_c, "slide");
    model.connect(Cross{Universal{.first = ex, .second = half.cross(ex).normalized()}, {}}, end_c, rod.at(half),
                  "cross");
    x = model.reference_state();
    Vec3 const turn(6, 0, 0), of_rod(1.92, -0.96, 0.48);  // velocities are those of the world's origin
    model.set_velocity(x, crank, -turn.cross(A), turn);
    model.set_velocity(x, rod, Vec3(0.24, 0, 0) - of_rod.cross(C), of_rod);
    model.set_velocity(x, slider, {0.24, 0, 0}, {0, 0, 0});
  }
  Mat3 inertia_of_rod() const {
    Vec3 const d = (C - B).normalized();
    Mat3 const along = d * d.transpose();
    return 0.004 * (Mat3::Identity() - along) + 0.0004 * along;
  }
  /// Angle of the crank, within one revolution of `near`.
  double angle(double near) const {
    Vec3 const b = position(model, x, pin_b) - A;
    return near + std::remainder(std::atan2(-b[1], b[2]) - near, 2.0 * std::numbers::pi);
  }
  double place() const { return position(model, x, end_c)[0]; }
};

struct Row {
  double t, angle, place;
};
constexpr Row centre_at_mid_arm[] = {{0.1, 0.56003148209, 0.22678718855}, {0.25, 1.94785483758, 0.28486000292},
                                     {0.5, 5.58376255331, 0.18495262978}, {1, 10.91359072986, 0.21172166139},
                                     {2, 21.07274452277, 0.28908519707},  {3, 32.00832775575, 0.22848481370},
                                     {4, 43.60175390652, 0.18823047558}};
constexpr Row centre_at_hinge[] = {{0.1, 0.55204383794, 0.22636901601}, {0.25, 1.79682982684, 0.28124009493},
                                   {0.5, 5.24989884258, 0.18874810326}, {1, 10.48407383852, 0.23376475034},
                                   {2, 20.03128598110, 0.25830444342},  {3, 31.35736345638, 0.19772820061},
                                   {4, 41.80108498641, 0.23894569000},  {5, 51.36943988791, 0.25465008547}};

Claim independent(char const* what, bool mid_arm, std::string const& formulation) {
  return {"M5", std::string(what) + (mid_arm ? ", crank's mass at mid-arm" : ", crank's mass at the hinge"),
          By::independent, "energy integral of one coordinate, DOP853", formulation};
}

/// Both variants to 5 s. \param tolerance of θ per second [rad/s]; dx/dθ is at most 0.078 m/rad
template <class Body, class Tree, class I>
void follows(I const& integrator, double step, double tolerance, std::string const& formulation) {
  for (bool const mid_arm : {true, false}) {
    SliderCrank<Body, Tree> m(mid_arm ? 0.04 : 0.0);
    double const before = energy(m.model, m.x).total();
    held(independent("energy above the hinge at the start [J]", mid_arm, formulation), before - 0.12 * 9.81 * 0.12,
         mid_arm ? 0.62517168 : 0.57462768, 6e-9, {.scale = 1.0});
    auto const compare = [&](Row const& row) {
      simulate(m.model, m.x, integrator, {.end_time = row.t, .step = step}).run();
      Instance const at{equals("t", row.t), 1.0}, of_place{at.at, 0.1};
      double const allowed = tolerance * std::max(1.0, row.t);
      held(independent("angle of the crank [rad]", mid_arm, formulation), m.angle(row.angle), row.angle, allowed, at);
      held(independent("place of the slider [m]", mid_arm, formulation), m.place(), row.place, 0.078 * allowed,
           of_place);
      held({"M5", "energy [J]", By::closed_form, "invariant", formulation}, energy(m.model, m.x).total(), before,
           0.1 * tolerance, {at.at, 1.0});
    };
    if (mid_arm)
      for (Row const& row : centre_at_mid_arm) compare(row);
    else
      for (Row const& row : centre_at_hinge) compare(row);
  }
}

TEST(SpatialSliderCrank, MovesAsTheEnergyIntegralSays) {
  follows<Rigid<>, Constraint>(GeneralisedAlpha{.rho_inf = 0.9}, 5e-4, 1.2e-3,
                               "Rigid, Constraint, generalised-α, h = 0.5 ms");
  follows<Rigid<EulerParameters>, Constraint>(GeneralisedAlpha{.rho_inf = 0.9}, 5e-4, 1.2e-3,
                                              "Rigid<EulerParameters>, Constraint, generalised-α, h = 0.5 ms");
  follows<Rigid<>, JointCoordinates>(Radau{}, 2e-3, 1e-6, "Rigid, joint coordinates, Radau IIA, h = 2 ms");
  follows<Rigid<>, Constraint>(DormandPrince<Projection>{.relative_tolerance = 1e-10, .absolute_tolerance = 1e-12},
                               1e-3, 3e-8, "Rigid, Constraint, Dormand–Prince, tolerance 1e-10");
}

// Every joint twice: hinge, ball, slide and universal joint.
TEST(SpatialSliderCrank, MovesWithDoubledJointsAsWithSingleOnes) {
  auto const make = [] { return SliderCrank<Rigid<>, Constraint>(0.04); };
  RunOptions const options{.end_time = 0.5, .step = 2e-3};
  expect_same_with_doubled_joints(make, GeneralisedAlpha{.tolerance = 1e-10}, options, 1e-9);
  expect_same_with_doubled_joints(make, Radau{}, options, 1e-9);
  expect_same_with_doubled_joints(
      make, DormandPrince<Projection>{.relative_tolerance = 1e-10, .absolute_tolerance = 1e-12}, options, 1e-9);
}

}  // namespace spatial_slider_crank_test
}  // namespace polybody
