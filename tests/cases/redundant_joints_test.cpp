// Closed loops with redundant joints and loops that pass through a singular configuration: IFToMM A02, N four-bar
// mechanism (R2), and A04, Bricard's mechanism (R4).

#include <gtest/gtest.h>

#include <polybody/integrators/coordinate_partitioning.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/held.hpp"
#include "support/linkages.hpp"

using namespace polybody;

namespace redundant_joints_test {

using Plane = FourBars<InPlane<Constraint>>;
using Space = FourBars<InSpace<Constraint>>;

/// Result of a run of four-bars.
struct Turned {
  double error;   ///< of the corner point B₀ [m]
  double energy;  ///< gained or lost energy [J]
};
template <class I>
Turned turn(Corner const& e, I const& integrator, double step) {
  Plane bars(e.n);
  double const before = energy(bars.model, bars.x).total();
  simulate(bars.model, bars.x, integrator, {.end_time = e.t, .step = step}).run();
  return {(bars.corner() - Vec3(e.x, e.y, 0)).norm(), std::abs(energy(bars.model, bars.x).total() - before)};
}
Corner corner(int n, double t) {
  return *std::find_if(std::begin(breakpoints), std::end(breakpoints),
                       [&](Corner const& c) { return c.n == n && c.t == t; });
}
Claim closed_form(char const* what, std::string const& formulation) {
  return {"R2", what, By::closed_form, "θ¨ = A sin θ of the parallelogram, elliptic integrals", formulation};
}
GeneralisedAlpha const light{.rho_inf = 0.95}, stabilised{.rho_inf = 0.95, .stabilised = true};

// R2: the motion passes ten times in 10 s through the flat configuration, in which the constraint Jacobian loses one
// rank per window. Exudyn's error with two windows at this step is 5e-5. The benchmark allows 0.1 J. The remaining
// errors are those of the methods, of order two. With two windows and ρ∞ = 0.8 they are 5.0e-5, 1.2e-5 and 3.3e-6 at
// h = 1e-3, 5e-4 and 2.5e-4 s. With ρ∞ = 0.95 they are 4.7e-5, 1.2e-5 and 2.5e-6, and with HHT 7.4e-5, 1.8e-5 and
// 4.0e-6.
TEST(FourBar, PassesItsSingularPosition) {
  for (int const n : {1, 2, 40}) {
    Corner const end = corner(n, n == 40 ? 4 : 10);
    auto const expect = [&](char const* who, Turned const& r) {
      std::string const formulation = "N = " + std::to_string(n) + ", " + who + ", h = 1e-3 s";
      held_within(closed_form("corner of N four-bars after 10 s, 40: 4 s [m]", formulation), r.error, 1e-4,
                  {.scale = 1.0});
      held_within({"R2", "energy gained or lost [J]", By::closed_form, "invariant", formulation}, r.energy, 1e-3,
                  {.scale = 1.0});
    };
    expect("generalised-α", turn(end, GeneralisedAlpha{}, 1e-3));
    expect("generalised-α, ρ∞ = 0.95", turn(end, light, 1e-3));
    if (n < 40) expect("stabilised", turn(end, stabilised, 1e-3));  // forty windows do not run with every linear solver
    expect("HHT", turn(end, HhtAlpha{}, 1e-3));
  }
  held_within({"R2", "corner of 2 four-bars after 10 s, the peer's error [m]", By::closed_form,
               "θ¨ = A sin θ of the parallelogram, elliptic integrals", "N = 2, generalised-α, ρ∞ = 0.95, h = 1e-3 s"},
              turn(corner(2, 10), light, 1e-3).error, 5e-5, {.scale = 1.0});
}

// The benchmark's forty windows to its 10 s. The error of order two falls to a quarter with half of the step.
TEST(FourBar, TurnsFortyWindowsForTenSeconds) {
  auto const expect = [](char const* formulation, double step, double tolerance) {
    Turned const r = turn(corner(40, 10), GeneralisedAlpha{}, step);
    held_within(closed_form("corner of 40 four-bars after 10 s [m]", formulation), r.error, tolerance, {.scale = 1.0});
    held_within({"R2", "energy gained or lost in 10 s [J]", By::closed_form, "invariant", formulation}, r.energy, 1e-3,
                {.scale = 1.0});
  };
  expect("N = 40, generalised-α, h = 2e-3 s", 2e-3, 2e-4);
  expect("N = 40, generalised-α, h = 1e-3 s", 1e-3, 5e-5);
}

// Small steps come close to the flat configuration. There the nearly singular matrix amplifies the round-off of the
// corrections.
TEST(FourBar, PassesItsSingularPositionInSmallSteps) {
  auto const expect = [](char const* who, Turned const& r) {
    std::string const formulation = std::string("N = 2, ") + who + ", h = 1.25e-4 s";
    held_within(closed_form("corner of N four-bars after 10 s, 40: 4 s [m]", formulation), r.error, 1.1e-6,
                {.scale = 1.0});
    held_within({"R2", "energy gained or lost [J]", By::closed_form, "invariant", formulation}, r.energy, 1e-5,
                {.scale = 1.0});
  };
  expect("generalised-α", turn(corner(2, 10), GeneralisedAlpha{}, 1.25e-4));
  expect("generalised-α, ρ∞ = 0.95", turn(corner(2, 10), light, 1.25e-4));
  expect("stabilised", turn(corner(2, 10), stabilised, 1.25e-4));
  expect("HHT", turn(corner(2, 10), HhtAlpha{}, 1.25e-4));
  held_within(closed_form("corner after 4 s [m]", "N = 1, generalised-α, h = 6.25e-5 s"),
              turn(corner(1, 4), GeneralisedAlpha{}, 6.25e-5).error, 1e-6, {.scale = 1.0});
  held_within(closed_form("corner after 1 s [m]", "N = 40, generalised-α, h = 2.5e-4 s"),
              turn(corner(40, 1), GeneralisedAlpha{}, 2.5e-4).error, 3e-6, {.scale = 1.0});
}

// In space the four parallel pins have three redundant constraint equations. The solver chooses the joint that is
// reported. The accelerations, the motion and the sum of the joint forces on each body are those of the plane.
TEST(RedundantFourBar, InSpaceMovesAsInThePlane) {
  Plane plane(1);
  Space space(1);
  GeneralisedAlpha const integrator{.tolerance = 1e-10};
  auto run = simulate(space.model, space.x, integrator, {.end_time = 0.6, .step = 1e-3});
  ASSERT_EQ(run.report().redundant.size(), 1u);
  auto planar = simulate(plane.model, plane.x, integrator, {.end_time = 0.6, .step = 1e-3});
  while (!run.done()) {
    run.advance();
    planar.advance();
    System system(space.model);
    system.evaluate(space.x.q, space.x.v, space.x.t);
    VecX r = VecX::Zero(space.model.velocities());
    system.residual(space.x.a, space.x.lambda, r);
    ASSERT_LT(r.norm(), 1e-6);  // M a + Gᵀλ = f
    ASSERT_TRUE(space.x.lambda.allFinite());
    ASSERT_LT((space.corner() - plane.corner()).norm(), 1e-9) << space.x.t;
  }
  EXPECT_EQ(plane.x.t, space.x.t);
}

TEST(RedundantFourBar, ExplicitMethodsTakeItToo) {
  auto const expect_same = [](auto const& integrator) {
    Plane plane(1);
    Space space(1);
    simulate(plane.model, plane.x, integrator, {.end_time = 0.5, .step = 5e-3}).run();
    simulate(space.model, space.x, integrator, {.end_time = 0.5, .step = 5e-3}).run();
    EXPECT_LT((space.corner() - plane.corner()).norm(), 1e-9);
  };
  expect_same(RungeKutta4<Projection>{});
  expect_same(RungeKutta4<CoordinatePartitioning>{});
}

// R2: an explicit method with coordinate partitioning also passes the flat configuration, in which the rank of the
// constraint Jacobian falls.
TEST(FourBar, PartitionedCoordinatesPassItsSingularPosition) {
  Plane bars(1);
  simulate(bars.model, bars.x, RungeKutta4<CoordinatePartitioning>{}, {.end_time = 1.0, .step = 1e-3}).run();
  char const* const formulation = "N = 1, Runge–Kutta 4 by coordinate partitioning, h = 1e-3 s";
  held(closed_form("x of the corner after 1 s [m]", formulation), bars.corner()[0], -0.2607126751836504, 1e-6);
  held(closed_form("y of the corner after 1 s [m]", formulation), bars.corner()[1], -0.9654164391590732, 1e-6);
}

void bricard(double h, std::vector<std::pair<double, Vec3>> const& exact) {
  Bricard<> b(h);
  double const start = energy(b.model, b.x).total();
  for (auto const& [t, p3] : exact) {
    auto run = simulate(b.model, b.x, GeneralisedAlpha{.rho_inf = 0.9}, {.end_time = t, .step = 1e-3});
    run.run();
    EXPECT_EQ(run.report().redundant.size(), 1u) << t;
    std::string const formulation =
        std::string(h > 0.0 ? "rods 0.1 m square" : "thin rods") + ", generalised-α, h = 1e-3 s";
    held_within(
        {"R4", "P₃ of the Bricard mechanism [m]", By::independent, "ordinary solver in the one freedom", formulation},
        (b.p3() - p3).norm(), 1e-3, {equals("t", t), 1.8});
    held({"R4", "energy [J]", By::closed_form, "invariant", formulation}, energy(b.model, b.x).total(), start, 1e-3,
         {equals("t", t)});
    EXPECT_TRUE(b.x.lambda.allFinite());
  }
}

// R4: the published tolerance of the energy is 1e-3 J.
TEST(Bricard, SquareRodsMoveAsPublished) {
  bricard(0.1, {{0.5, {0.968283679, -1.224625159, 0.750146609}},
                {1, {0.510501461, -1.649167599, 0.140123115}},
                {2, {-0.969340345, -1.221246895, 0.754278011}},
                {3, {-0.967199800, -1.228020215, 0.745983176}},
                {4, {0.524899593, -1.643876001, 0.148835846}},
                {5, {0.999999998, -1.000067258, 0.999932740}},
                {6, {0.495873450, -1.654324512, 0.131605204}}});
}

TEST(Bricard, ThinRodsMoveAsPublished) {
  bricard(0.0, {{0.5, {0.968153871, -1.225035436, 0.749644090}},
                {1, {0.508664760, -1.649827063, 0.139035331}},
                {2, {-0.969892004, -1.219455141, 0.756464580}},
                {3, {-0.966341178, -1.230661551, 0.742736073}},
                {4, {0.532399283, -1.641032210, 0.153506643}},
                {5, {0.999999983, -1.000183881, 0.999816102}},
                {6, {0.484302769, -1.658252374, 0.125099532}}});
}

// A duplicate joint is reported as redundant, and nothing else changes.
TEST(RedundantJoint, IsNamedAndHarmless) {
  using Pin = Joint<Revolute, Constraint>;
  auto const swing = [](std::vector<char const*> const& pins, std::vector<std::string>& redundant) {
    Model<Bodies<Rigid<>>, Joints<Pin>> model{Gravity{0, -9.81, 0}};
    auto const rod = model.add(Rigid<>(1.0, Vec3(0.1, 0.2, 0.2).asDiagonal().toDenseMatrix()), "rod");
    for (char const* name : pins)
      model.connect(Pin{{.axis = Vec3::UnitZ()}, {}}, model.ground().at({-1, 0, 0}), rod.at(Vec3(-1, 0, 0)), name);
    State x = model.reference_state();
    auto run = simulate(model, x, GeneralisedAlpha{}, {.end_time = 0.5, .step = 0.01});
    run.run();
    redundant = run.report().redundant;
    return x.q;
  };
  std::vector<std::string> none, named;
  VecX const once = swing({"pin"}, none), twice = swing({"pin", "pin again"}, named);
  EXPECT_TRUE(none.empty());
  EXPECT_EQ(named, std::vector<std::string>{"joint \"pin again\""});
  EXPECT_LT((once - twice).norm(), 1e-10);
}

}  // namespace redundant_joints_test
