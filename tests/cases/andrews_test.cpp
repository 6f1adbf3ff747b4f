// Andrews' squeezing mechanism (R3: IFToMM benchmark A03, IVP Test Set "andrews"), its seven bodies in the plane.

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/integrators/adams_bashforth_moulton.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/doubled_joints.hpp"
#include "support/held.hpp"

namespace polybody {
namespace andrews_test {

/// β, Θ, γ, Φ, δ, Ω, ε.
using Angles = Vec<double, 7>;

Angles angles(std::array<double, 7> const& q) { return Eigen::Map<Angles const>(q.data()); }

/// The names of points and the lengths are those of the test set. The bodies are OF, FE, BDE, EG, AG, HE, AH. The
/// angles of their axes in the table are β, β + Θ, γ, Φ + δ, δ, Ω + ε, ε. \tparam Tree policy of all pins except
/// those at E
template <class Tree = Constraint>
struct Squeezer {
  using Pin = Joint<planar::Revolute, Constraint>;
  using TreePin = Joint<planar::Revolute, Tree>;
  using Pins = std::conditional_t<std::is_same_v<Pin, TreePin>, Joints<Pin>, Joints<TreePin, Pin>>;
  using Body = planar::Rigid;
  static constexpr double drive = 0.033;  ///< [N m] on OF
  Model<Bodies<Body>, Pins, Forces<PointMoment<>, SpringDamper>> model;
  std::vector<BodyHandle<Body>> bodies;
  std::vector<ElementHandle<Pin>> at_e;  ///< of FE to BDE, EG and HE: g₁ … g₆ of the test set
  State x;

  explicit Squeezer(Angles const& q) {
    Vec2 const O(0, 0), A(-0.06934, -0.00227), B(-0.03635, 0.03273), C(0.014, 0.072);
    // Mass, inertia, angle, and two points in body axes: the mass centre, and a point with a known position in the
    // world.
    struct Part {
      double mass, inertia, angle;
      Vec2 centre, known, place;
    };
    auto const turned = [](double angle, double px, double py) {
      return Vec2(std::cos(angle) * px - std::sin(angle) * py, std::sin(angle) * px + std::cos(angle) * py);
    };
    double const b = q[0], bt = q[0] + q[1], pd = q[3] + q[4], d = q[4], oe = q[5] + q[6], e = q[6];
    Vec2 const F = turned(b, 0.007, 0), G = A + turned(d, 0.04, 0), H = A + turned(e, 0, -0.04);
    Part const parts[] = {{0.04325, 2.194e-6, b, {0.00092, 0}, {0, 0}, O},
                          {0.00365, 4.410e-7, bt, {-0.0115, 0}, {0, 0}, F},
                          {0.02373, 5.255e-6, q[2], {0.01043, -0.01874}, {0, 0}, B},
                          {0.00706, 5.667e-7, pd, {0, -0.02 + 0.01421}, {0, 0}, G},
                          {0.07050, 1.169e-5, d, {0.02308, 0.00916}, {0, 0}, A},
                          {0.00706, 5.667e-7, oe, {0.02 - 0.01421, 0}, {0, 0}, H},
                          {0.05498, 1.912e-5, e, {-0.00449, -0.01228}, {0, 0}, A}};
    for (Part const& p : parts) {
      Vec2 const centre = p.place + turned(p.angle, p.centre[0], p.centre[1]);
      bodies.push_back(model.add(Body(p.mass, p.inertia, Placement::planar(centre[0], centre[1], p.angle))));
    }
    auto const on = [&](std::size_t i, double px, double py) {
      return bodies[i].at(Vec2(Vec2(px, py) - parts[i].centre));
    };
    auto const ground = [&](Vec2 const& p) { return model.ground().at({p[0], p[1], 0}); };
    auto const of_fe = on(1, -0.028, 0);
    model.connect(TreePin{}, ground(O), on(0, 0, 0), "O");
    model.connect(TreePin{}, on(0, 0.007, 0), on(1, 0, 0), "F");
    model.connect(TreePin{}, ground(B), on(2, 0, 0), "B");
    model.connect(TreePin{}, ground(A), on(4, 0, 0), "A of AG");
    model.connect(TreePin{}, ground(A), on(6, 0, 0), "A of AH");
    model.connect(TreePin{}, on(4, 0.04, 0), on(3, 0, 0), "G");
    model.connect(TreePin{}, on(6, 0, -0.04), on(5, 0, 0), "H");
    at_e.push_back(model.connect(Pin{}, on(2, 0, -0.035), of_fe, "E of BDE"));
    at_e.push_back(model.connect(Pin{}, on(3, 0, -0.02), of_fe, "E of EG"));
    at_e.push_back(model.connect(Pin{}, on(5, 0.02, 0), of_fe, "E of HE"));
    model.apply(PointMoment<>{.moment = {0, 0, drive}}, on(0, 0, 0), "drive");
    model.apply(SpringDamper{.stiffness = 4530, .free_length = 0.07785}, on(2, 0.02, -0.018), ground(C), "spring");
    x = model.reference_state();
  }
  Squeezer(Squeezer const&) = delete;

  /// Computes q, q˙ or q¨ of the test set from the coordinates of the bodies.
  Angles read(VecX const& y) const {
    double const b = y[2], bt = y[5], c = y[8], pd = y[11], d = y[14], oe = y[17], e = y[20];
    return angles({b, bt - b, c, pd - d, d, oe - e, e});
  }
  /// Multipliers λ₁ … λ₆.
  Vec6 multipliers() const {
    Vec6 l;
    for (std::size_t i = 0; i < 3; ++i) l.segment<2>(2 * Index(i)) = x.lambda.segment<2>(model.entry(at_e[i]).row);
    return l;
  }
  /// Invariant T + V − M β: the energy less the work of the drive.
  double invariant() const { return energy(model, x).total() - drive * x.q[2]; }
};

Angles const start = angles({-0.0617138900142764496, 0, 0.455279819163070380, 0.222668390165885885,
                             0.487364979543842550, -0.222668390165885885, 1.23054744454982119});

// Published reference: PSIDE at a tolerance of 1e-14, t = 0.03.
Angles const end = angles({15.81077119629904, -15.75637105984298, 0.04082224013073101, -0.5347301163226948,
                           0.5244099658805304, 0.5347301163226948, 1.048080741042263});
Angles const end_rate = angles({1139.920302151208, -1424.379294994111, 11.03291221937134, 19.29337464421385,
                                0.5735699284790808, -19.29337464421385, 0.3231791658026955});
Angles const end_acceleration = angles({-24631.76316945196, 51850.37701610329, 324102.5686413781, 566749.3645176213,
                                        16743.62929479361, -566749.3645176222, 9826.520791458422});

Claim published(char const* what, char const* formulation) {
  return {"R3", what, By::published, "IVP Test Set: PSIDE at a tolerance of 1e-14", formulation};
}
Claim independent(char const* what, char const* formulation) {
  return {"R3", what, By::independent, "ordinary solver of the test set's equations", formulation};
}

TEST(Andrews, StartsAsPublished) {
  Squeezer<> s(start);
  make_consistent(s.model, s.x);
  EXPECT_LT((s.read(s.x.q) - start).norm(), 1e-15);
  Angles const a = s.read(s.x.a);
  held(published("β¨ at the start [rad/s²]", "start of a run"), a[0], 14222.4439199541138706, 1e-7);
  held(published("Θ¨ at the start [rad/s²]", "start of a run"), a[1], -10666.8329399655854029, 1e-7);
  EXPECT_LT(a.tail<5>().norm(), 1e-7);
  Vec6 l = s.multipliers();
  held(published("λ₁ at the start [N]", "start of a run"), l[0], 98.5668703962410896, 1e-9);
  held(published("λ₂ at the start [N]", "start of a run"), l[1], -6.12268834425566266, 1e-9);
  EXPECT_LT(l.tail<4>().norm(), 1e-9);
}

/// Comparison at t = 0.01, 0.02 and 0.03.
template <class Tree = Constraint, class I>
void expect_published(I const& integrator, double step, double tolerance, char const* formulation) {
  Squeezer<Tree> s(start);
  double const before = s.invariant();
  struct {
    double t, beta, theta, gamma;
  } const way[] = {{0.01, 2.1601131315315, -1.8833642311070, 0.15851675800},
                   {0.02, 8.1849058896618, -7.8905053637306, 0.20953691338}};
  for (auto const& w : way) {
    simulate(s.model, s.x, integrator, {.end_time = w.t, .step = step}).run();
    Angles const at = s.read(s.x.q);
    held_within(independent("β, Θ and γ on the way [rad]", formulation),
                (at.head<3>() - Vec3(w.beta, w.theta, w.gamma)).norm(), tolerance, {equals("t", w.t), 2.9});
  }
  simulate(s.model, s.x, integrator, {.end_time = 0.03, .step = step}).run();
  held_within(published("q at 0.03 s [rad]", formulation), (s.read(s.x.q) - end).norm(), tolerance,
              {.scale = end.norm()});
  held_within(published("rates at 0.03 s [rad/s]", formulation), (s.read(s.x.v) - end_rate).norm(), 1e3 * tolerance,
              {.scale = end_rate.norm()});
  // near a dead point, which amplifies errors of q many times
  held_within(published("accelerations at 0.03 s [rad/s²]", formulation), (s.read(s.x.a) - end_acceleration).norm(),
              1e2 * tolerance * end_acceleration.norm(), {.scale = end_acceleration.norm()});
  held({"R3", "energy less the drive's work [J]", By::closed_form, "invariant T + V − M β", formulation}, s.invariant(),
       before, tolerance, {.scale = Squeezer<>::drive * end[0]});
  Vec6 lambda;
  lambda << 199.1753333731910, -29.75531228015052, 23.06654119098399, 31.45271365475927, 22.64249232082739,
      11.61740700019673;
  held_within(published("multipliers at 0.03 s [N]", formulation), (s.multipliers() - lambda).norm(),
              1e2 * tolerance * lambda.norm(), {.scale = lambda.norm()});
}

TEST(Andrews, HasThePublishedDigitsWithDormandPrince) {
  expect_published(DormandPrince<Projection>{.relative_tolerance = 1e-12, .absolute_tolerance = 1e-13}, 1e-5, 1e-8,
                   "Dormand–Prince");
}
TEST(Andrews, HasThePublishedDigitsWithAdams) {
  expect_published(AdamsBashforthMoulton<Projection>{.relative_tolerance = 1e-12, .absolute_tolerance = 1e-13}, 1e-5,
                   1e-8, "Adams–Bashforth–Moulton");
}
TEST(Andrews, HasThePublishedDigitsWithRadau) {
  expect_published(Radau{.tolerance = 1e-12}, 7.5e-6, 1e-8, "Radau IIA, h = 7.5e-6 s");
}
TEST(Andrews, HasThePublishedDigitsInJointCoordinates) {  // the three pins at E close loops
  expect_published<JointCoordinates>(
      DormandPrince<Projection>{.relative_tolerance = 1e-12, .absolute_tolerance = 1e-13}, 1e-5, 1e-8,
      "joint coordinates, Dormand–Prince");
}
TEST(Andrews, IsMetByAlphaMethodsWithinAThousandth) {
  expect_published(GeneralisedAlpha{}, 1e-5, 1e-3, "generalised-α, h = 1e-5 s");
  expect_published(HhtAlpha{}, 1e-5, 1e-3, "HHT-α, h = 1e-5 s");
}

// Small steps keep order two. Newton's tolerance for round-off is scaled with each coordinate, not with the largest
// angle of rotation. It therefore stays below the error of the step.
TEST(Andrews, SmallStepsOfAlphaMethodsKeepTheirOrder) {
  auto const error = [](double step) {
    Squeezer<> s(start);
    simulate(s.model, s.x, GeneralisedAlpha{}, {.end_time = 0.01, .step = step}).run();
    return (s.read(s.x.q).head<3>() - Vec3(2.1601131315315, -1.8833642311070, 0.15851675800)).norm();
  };
  double const coarse = error(2e-6), fine = error(1e-6);
  held_within(independent("β, Θ and γ at 0.01 s [rad]", "generalised-α, h = 1e-6 s"), fine, 1e-7, {.scale = 2.9});
  EXPECT_NEAR(coarse / fine, 4.0, 0.4);
}

// Variant of the multibody benchmark: β(0) = −0.062, position of F at four times.
TEST(Andrews, OfTheBenchmarkCarriesFWhereItIsPublished) {
  Squeezer<> s(angles({-0.062, 0.000214586853799, 0.455279812100370, 0.222668375903028, 0.487364981140633,
                       -0.222668375903027, 1.230547439156601}));
  struct {
    double t, x, y;
  } const way[] = {{0.01, -0.003851290594, 0.005845302453},
                   {0.02, -0.002229411835, 0.006635489648},
                   {0.03, -0.006970260782, -0.000644565461},
                   {0.04, 0.005051245443, -0.004846124171}};
  for (auto const& w : way) {
    simulate(s.model, s.x, DormandPrince<Projection>{.relative_tolerance = 1e-11, .absolute_tolerance = 1e-12},
             {.end_time = w.t, .step = 1e-5})
        .run();
    Claim claim = independent("x of F, β(0) = −0.062 [m]", "Dormand–Prince");
    held(claim, 0.007 * std::cos(s.x.q[2]), w.x, 1e-10, {equals("t", w.t)});
    claim.what = "y of F, β(0) = −0.062 [m]";
    held(claim, 0.007 * std::sin(s.x.q[2]), w.y, 1e-10, {equals("t", w.t)});
  }
}

// Every pin twice: 20 of 40 equations are redundant.
TEST(Andrews, MovesWithDoubledPinsAsWithSingleOnes) {
  auto const make = [] { return Squeezer<>(start); };
  RunOptions const options{.end_time = 5e-3, .step = 2e-5};
  expect_same_with_doubled_joints(make, GeneralisedAlpha{.tolerance = 1e-10}, options, 1e-8);
  expect_same_with_doubled_joints(make, Radau{}, options, 1e-8);
  expect_same_with_doubled_joints(make, RungeKutta4<Projection>{}, options, 1e-8);
}

}  // namespace andrews_test
}  // namespace polybody
