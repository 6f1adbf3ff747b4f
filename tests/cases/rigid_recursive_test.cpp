// Benchmarks R1, R2, R4, R6, R8 and J1 in joint coordinates. R3 and R5 are in andrews_test.cpp and governor_test.cpp.

#include <gtest/gtest.h>

#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/problem_size.hpp>
#include <polybody/run/simulate.hpp>

#include "support/held.hpp"
#include "support/linkages.hpp"
#include "support/resumed_run.hpp"

namespace polybody {
namespace rigid_recursive_test {

constexpr double g = 9.81, half_pi = 0.5 * std::numbers::pi;
using Plane = Chain<InPlane<JointCoordinates>>;

DormandPrince<Projection> precise() { return {.relative_tolerance = 1e-11, .absolute_tolerance = 1e-11}; }

char const* const by = "joint coordinates, Dormand–Prince";
Claim elliptic(char const* case_id, char const* what) {
  return {case_id, what, By::closed_form, "elliptic functions", by};
}
Claim solver(char const* case_id, char const* what) {
  return {case_id, what, By::independent, "ordinary solver of order eight", by};
}

TEST(JointCoordinates, SwingAPointMass) {  // R1
  Plane const chain(1, point_link(), g, -half_pi);
  State x = chain.model.reference_state();
  for (auto const& [t, px, py] : {std::array{0.5, -0.3910487915505464, -0.9203699487851922},
                                  std::array{2.0, -0.7935661953433217, -0.6084839304437915},
                                  std::array{10.0, -0.2750874625761169, -0.9614192050991251}}) {
    simulate(chain.model, x, precise(), {.end_time = t, .step = 0.01}).run();
    held_within(elliptic("R1", "point mass [m]"), (chain.tip(x) - Vec3(px, py, 0)).norm(), 1e-8, {equals("t", t), 1.0});
  }
}

TEST(JointCoordinates, TellWhatThePinHolds) {  // J1
  Plane const rod(1, bar_link());
  State x = rod.model.reference_state();
  for (auto const& [t, angle, rx, ry] : {std::array{0.25, 1.114159968059, -8.7352815388, 6.7438504085},
                                         std::array{1.0, -1.562621718035, 0.1804260137, 2.4539749449}}) {
    simulate(rod.model, x, precise(), {.end_time = t, .step = 0.01}).run();
    held(elliptic("J1", "angle of the rod [rad]"), rod.angle(x), angle, 1e-9, {equals("t", t)});
    held_within(elliptic("J1", "reaction of the pin [N]"),
                (reaction(rod.model, x, rod.hinges[0]).f - Vec3(rx, ry, 0)).norm(), 1e-7,
                {equals("t", t), std::hypot(rx, ry)});
  }
}

TEST(JointCoordinates, SwingTwoBars) {  // R8b
  Plane const bars(2, bar_link());
  State x = bars.model.reference_state();
  for (auto const& [t, first, second] :
       {std::array{0.5, 0.448142625932, 1.041962887304}, std::array{1.0, -1.207716238191, -0.814391023091},
        std::array{2.0, -0.082758306821, 0.407362074912}}) {
    simulate(bars.model, x, precise(), {.end_time = t, .step = 0.01}).run();
    held(solver("R8", "(b) angle of the first bar [rad]"), bars.angle(x, 0), first, 1e-7, {equals("t", t)});
    held(solver("R8", "(b) angle of the second bar [rad]"), bars.angle(x, 1), second, 1e-7, {equals("t", t)});
  }
}

TEST(JointCoordinates, SwingManyBars) {  // R8d
  for (auto const& [n, px, py] :
       {std::array{3.0, -0.908458260529, -0.025617696288}, std::array{4.0, -0.864582047703, -0.090031032523},
        std::array{10.0, -0.894316852361, -0.146565064747}}) {
    Plane const chain(int(n), bar_link(1.0 / n, 1.0 / n));
    State x = chain.model.reference_state();
    simulate(chain.model, x, precise(), {.end_time = 1.0, .step = 1e-3}).run();
    held_within(solver("R8", "(d) tip of N bars at 1 s [m]"), (chain.tip(x) - Vec3(px, py, 0)).norm(), 1e-7,
                {equals("N", n), 1.0});
  }
}

// R2: constraint equations close the loops. The comparison is after the flat configuration, in which the constraint
// Jacobian loses rank.
TEST(JointCoordinates, TurnFourBars) {
  for (Corner const& e : {breakpoints[0], breakpoints[3]}) {
    FourBars<InPlane<JointCoordinates>, InPlane<Constraint>> bars(e.n);
    simulate(bars.model, bars.x, precise(), {.end_time = e.t, .step = 1e-3}).run();
    held_within({"R2", "corner [m]", By::closed_form, "θ¨ = A sin θ of the parallelogram, elliptic integrals",
                 "N = " + std::to_string(e.n) + ", " + by},
                (bars.corner().head<2>() - Vec2(e.x, e.y)).lpNorm<Eigen::Infinity>(), 1e-6, {equals("t", e.t), 1.0});
  }
}

// R4: five pins in joint coordinates, the sixth by five constraint equations, one of them redundant.
TEST(JointCoordinates, FoldBricard) {
  Bricard<JointCoordinates, Rigid<>, Constraint> b(0.1, {}, {});
  double const before = energy(b.model, b.x).total();
  EXPECT_EQ(problem_size(b.model).coordinates, 5);
  EXPECT_EQ(problem_size(b.model).rows, 5);
  for (auto const& [t, p3] : {std::pair{0.5, Vec3(0.968283679, -1.224625159, 0.750146609)},
                              std::pair{1.0, Vec3(0.510501461, -1.649167599, 0.140123115)},
                              std::pair{2.0, Vec3(-0.969340345, -1.221246895, 0.754278011)}}) {
    auto run = simulate(b.model, b.x, precise(), {.end_time = t, .step = 1e-3});
    run.run();
    EXPECT_EQ(run.report().redundant.size(), 1u) << t;
    std::string const rods = std::string("rods 0.1 m square, ") + by;
    held_within({"R4", "P₃ of the Bricard mechanism [m]", By::independent, "ordinary solver in the one freedom", rods},
                (b.p3() - p3).norm(), 1e-8, {equals("t", t), 1.8});
    held({"R4", "energy [J]", By::closed_form, "invariant", rods}, energy(b.model, b.x).total(), before, 1e-8,
         {equals("t", t)});
  }
}

TEST(JointCoordinates, SpinTheHeavyTop) {  // R6
  using Ball = Joint<Spherical, JointCoordinates>;
  Model<Bodies<Rigid<>>, Joints<Ball>> model{Gravity{0, 0, -g}};
  auto const top = model.add(Rigid<>(15.0, Vec3(0.234375, 0.46875, 0.234375).asDiagonal(), Placement::at({0, 1, 0})));
  model.connect(Ball{}, model.ground().at({0, 0, 0}), top.at(Vec3(0, -1, 0)));
  State x = model.reference_state();
  model.set_velocity(x, top, Vec3::Zero(), Vec3(0, 150, -4.61538));
  for (auto const& [t, place] : {std::pair{0.2, Vec3(0.6055505614, 0.5989576818, -0.5239830274)},
                                 std::pair{1.0, Vec3(0.1733439641, 0.6400885921, -0.7484907911)}}) {
    simulate(model, x, precise(), {.end_time = t, .step = 1e-3}).run();
    held_within(solver("R6", "heavy top: centre of mass [m]"), (x.q.head<3>() - place).norm(), 1e-7,
                {equals("t", t), 1.0});
  }
}

TEST(JointCoordinates, GoOnWithTheSameBits) { expect_resumes<InPlane<JointCoordinates>>(precise()); }

}  // namespace rigid_recursive_test
}  // namespace polybody
