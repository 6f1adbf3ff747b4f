#include <polybody/forces/contact_group.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/contact.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/run/applied_wrenches.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/testing/differences.hpp>

#include "support/refusal.hpp"

using namespace polybody;

namespace contact_group_test {

using OnPlane = Contact<SphereOnPlane>;
using OnBall = Contact<SphereOnSphere, HuntCrossleyContact>;
using Group = ContactGroup<OnPlane, OnBall>;
static_assert(ForceGroup<Group> && !ForceElement<Group> && AppliedForce<Group> && !ForceGroup<OnPlane>);

constexpr double radius = 0.1, mass = 0.5, g = 9.81;
Friction const rubber{.coefficient = 0.4, .slip_speed = 0.02};
OnPlane const on_plane{{.radius = radius}, {.stiffness = 2e4, .damping = 15.0}, rubber};
OnBall const on_fixed{{.radius_a = radius, .radius_b = 0.3}, {.stiffness = 2e5, .damping = 0.2}, rubber};
OnBall const on_free{{.radius_a = radius, .radius_b = 0.2}, {.stiffness = 2e5, .damping = 0.2}, rubber};

Rigid<> ball(double m, double r, Vec3 const& at) {
  return Rigid<>(m, Mat3(0.4 * m * r * r * Mat3::Identity()), Placement::at(at));
}

/// Force law of two markers without its approximate gradient. A group then computes the exact blocks by dual numbers.
template <class Law>
struct Exact {
  static constexpr int markers = 2;
  static constexpr bool is_load = false;
  static constexpr MarkerKind needs = Law::needs;
  Law law;
  void check(std::string const& name) const { law.check(name); }
  bool may_touch(Frame<double> const& a, Frame<double> const& b) const { return law.may_touch(a, b); }
  template <StateScalar T>
  std::array<Wrench<T>, 2> wrenches(std::array<Frame<T>, 2> const& f, double t) const {
    return law.template wrenches<T>(f, t);
  }
};
static_assert(!HasOwnStiffness<Exact<OnPlane>>);

/// Each law separately between two markers, or all in a group, with or without the approximate gradient.
enum class Applied { one_by_one, grouped, exactly };
template <Applied how>
struct How {
  using Plane = OnPlane;
  using Ball = OnBall;
  using ForceList = Forces<OnPlane, OnBall>;
};
template <>
struct How<Applied::grouped> : How<Applied::one_by_one> {
  using Grouped = Group;
  using ForceList = Forces<Group>;
};
template <>
struct How<Applied::exactly> {
  using Plane = Exact<OnPlane>;
  using Ball = Exact<OnBall>;
  using Grouped = ContactGroup<Plane, Ball>;
  using ForceList = Forces<Grouped>;
};

/// Balls that fall on a floor, a fixed ball, a heavier ball and a plate. The last two move upwards.
template <Applied how>
struct Heap {
  using Plane = typename How<how>::Plane;
  using Ball = typename How<how>::Ball;
  Model<Bodies<Rigid<>>, Joints<>, typename How<how>::ForceList> model{Gravity{0, 0, -g}};
  std::vector<BodyHandle<Rigid<>>> balls;
  BodyHandle<Rigid<>> heavy = model.add(ball(4.0, 0.2, {-0.5, 0, 0.2}), "heavy ball");
  BodyHandle<Rigid<>> plate = model.add(
      Rigid<>(20.0, Vec3(2, 2, 4).asDiagonal().toDenseMatrix(), Placement::at({0, 0, 0.25}, {0.05, 0.02, 0})), "plate");

  Heap() {
    // a row along x: two hit the heavy ball, the middle one the fixed ball, all the plate or the floor
    for (int i = 0; i < 5; ++i)
      balls.push_back(model.add(ball(mass, radius, {-0.6 + 0.27 * i, 0.04 * i, 0.52 + 0.03 * i})));
    auto const floor = model.ground().at({0, 0, 0}), post = model.ground().at({0.1, 0.1, 0.1});
    if constexpr (how == Applied::one_by_one) {
      for (auto const& b : balls) {
        auto const centre = b.at(Vec3(0, 0, 0));
        model.apply(on_plane, centre, floor);
        model.apply(on_plane, centre, plate.at(Vec3(0, 0, 0)));
        model.apply(on_fixed, centre, post);
        model.apply(on_free, centre, heavy.at(Vec3(0, 0, 0)));
      }
    } else {
      std::vector<Marker<Rigid<>>> many;
      for (auto const& b : balls) many.push_back(b.at(Vec3(0, 0, 0)));
      auto const group = model.apply(typename How<how>::Grouped{}, many, "balls");
      model.add_partner(group, Plane{on_plane}, floor, "floor");
      model.add_partner(group, Plane{on_plane}, plate.at(Vec3(0, 0, 0)), "plate");
      model.add_partner(group, Ball{on_fixed}, post, "post");
      model.add_partner(group, Ball{on_free}, heavy.at(Vec3(0, 0, 0)), "heavy ball");
    }
  }
  State start() const {
    State x = model.reference_state();
    model.set_velocity(x, plate, {0, 0, 1.0}, {0, 0, 0});
    model.set_velocity(x, heavy, {-0.1, 0, 2.0}, {0, 0, 0});
    model.set_velocity(x, balls[1], {0.3, 0.1, 0}, {0, 0, 0});
    return x;
  }
};

struct Fall {
  State x;
  RunReport report;
};
template <Applied how, class I>
Fall fallen(I const& integrator, double step) {
  Heap<how> const heap;
  Fall fall{heap.start(), {}};
  auto run = simulate(heap.model, fall.x, integrator, {.end_time = 0.5, .step = step});
  fall.report = run.run();
  return fall;
}
double apart(State const& a, State const& b) { return std::max((a.q - b.q).norm(), (a.v - b.v).norm()); }

// --- motion of a group, compared with single contacts ---------------------------------------------------------

// The sums have a different order. The results of an explicit method differ at most by round-off. Markers out of
// reach are excluded several at a time. The remaining pairs have the order of single contacts, for any number of
// markers.
TEST(ContactGroup, FindsThePairsThatMayTouchOneAfterTheOther) {
  using Pairs = std::vector<std::pair<Index, Index>>;
  for (int const planes : {0, 1, 20, 40})
    for (int const fixed : {0, 3, 24, 40}) {
      int const many = 77, few = planes + fixed;
      Group group;
      group.set_many(many);
      for (int k = 0; k < planes; ++k) group.add_partner(on_plane, many + k, "plane");
      for (int k = 0; k < fixed; ++k) group.add_partner(on_fixed, many + planes + k, "ball");
      laws::Numbers number;
      std::vector<Frame<double>> frames;
      for (int k = 0; k < many + few; ++k) frames.push_back(number.frame());
      auto const frame = [&](Index k) -> Frame<double> const& { return frames[std::size_t(k)]; };
      for (auto const& [begin, end] : Pairs{{0, many}, {5, 5}, {3, 4}, {31, 64}, {70, 77}}) {
        Pairs expected, found;
        group.for_each_candidate([&](Index i, Index j, auto const& law) {
          if (i >= begin && i < end && law.may_touch(frame(i), frame(j))) expected.emplace_back(i, j);
        });
        group.for_each_pair(frame, [&](Index i, Index j, auto const&) { found.emplace_back(i, j); }, begin, end);
        EXPECT_EQ(found, expected) << planes << " " << fixed << " from " << begin;
        if (few > 0 && end - begin > 10) {
          EXPECT_GT(found.size(), 0u);
          EXPECT_LT(found.size(), std::size_t(few * (end - begin)));
        }
      }
    }
}
// A marker with a NaN is kept as a pair, so the NaN reaches the check of the forces.
TEST(ContactGroup, PassesOverNothingThatIsNoNumber) {
  ContactReach const reach = ContactReach::sphere({0, 0, 0}, 1.0);
  double const nan = std::nan("");
  EXPECT_TRUE(reach.holds(Vec3(0.9, 0.0, 0.0)));
  EXPECT_FALSE(reach.holds(Vec3(1.1, 0.0, 0.0)));
  EXPECT_TRUE(reach.holds(Vec3(nan, 5.0, 0.0)));
}

TEST(ContactGroup, IsTheSumOfItsContacts) {
  State const one_by_one = fallen<Applied::one_by_one>(RungeKutta4<>{}, 2e-4).x;
  EXPECT_LT(apart(fallen<Applied::grouped>(RungeKutta4<>{}, 2e-4).x, one_by_one), 1e-11);
  // all contacts have acted: no body is at its position of free fall
  Heap<Applied::grouped> const heap;
  State const start = heap.start();
  auto const disturbed = [&](BodyHandle<Rigid<>> const& body) {
    auto const& e = heap.model.entry(body);
    Vec6 change = one_by_one.v.segment<6>(e.v0) - start.v.segment<6>(e.v0);
    change[2] += g * one_by_one.t;
    return change;
  };
  for (auto const& b : heap.balls) {
    EXPECT_GT(disturbed(b).head<3>().norm(), 0.5) << b.name;
    EXPECT_GT(disturbed(b).tail<3>().norm(), 0.5) << b.name;  // spin due to friction
  }
  EXPECT_GT(disturbed(heap.heavy).norm(), 0.1);
  EXPECT_GT(disturbed(heap.plate).norm(), 0.01);
}

// Newton's method leaves a fraction `tolerance` of the accelerations in every step. Bodies change their velocities by
// some m/s, all together by less than 100 m/s. Impacts amplify the error up to ten times: 1000 · tolerance. The lower
// limit of the iteration is 30 times the round-off of a coordinate over βh² (see AlphaMethod), here 1e-6 m/s² for
// half a second.
TEST(ContactGroup, MovesAsItsContactsDoWhateverNewtonKnowsOfThem) {
  for (double const tolerance : {1e-6, 1e-8}) {
    GeneralisedAlpha const alpha{.tolerance = tolerance};
    Fall const one_by_one = fallen<Applied::one_by_one>(alpha, 2e-4), grouped = fallen<Applied::grouped>(alpha, 2e-4),
               exactly = fallen<Applied::exactly>(alpha, 2e-4);
    EXPECT_LT(apart(grouped.x, one_by_one.x), 1e3 * tolerance + 5e-7);
    EXPECT_LT(apart(exactly.x, one_by_one.x), 1e3 * tolerance + 5e-7);
  }
}

// --- cost in Newton iterations --------------------------------------------------------------------------------

TEST(ContactGroup, StandInCostsNewtonHardlyMoreThanExactBlocks) {
  GeneralisedAlpha const alpha{};
  for (double const step : {2e-4, 1e-4}) {
    RunReport const all = fallen<Applied::one_by_one>(alpha, step).report,
                    own = fallen<Applied::grouped>(alpha, step).report,
                    exact = fallen<Applied::exactly>(alpha, step).report;
    std::printf(
        "heap, h = %g s: iterations per step %.3f by all blocks, %.3f by own exact blocks, %.3f by the stand-in\n",
        step, double(all.iterations) / double(all.steps), double(exact.iterations) / double(exact.steps),
        double(own.iterations) / double(own.steps));
    EXPECT_GT(all.iterations, 1.1 * double(all.steps));  // the iteration count is not trivial
    EXPECT_LT(own.iterations, 1.1 * double(exact.iterations));
    EXPECT_LT(own.iterations, 1.25 * double(all.iterations));
  }
}

/// Balls that slide on the floor until they roll. The steps do not resolve the end of the slip, which changes by 7/2
/// μ g h = 0.014 m/s per step.
template <Applied how>
RunReport rolled(double slip_speed) {
  using Plane = typename How<how>::Plane;
  using Grouped = typename How<how>::Grouped;
  Model<Bodies<Rigid<>>, Joints<>, Forces<Grouped>> model{Gravity{0, 0, -g}};
  OnPlane const law{
      {.radius = radius}, {.stiffness = 1e5, .damping = 50.0}, {.coefficient = 0.4, .slip_speed = slip_speed}};
  std::vector<Marker<Rigid<>>> many;
  std::vector<BodyHandle<Rigid<>>> balls;
  for (int i = 0; i < 10; ++i) {
    balls.push_back(model.add(ball(mass, radius, {0, 0.3 * i, radius - mass * g / 1e5})));
    many.push_back(balls.back().at(Vec3(0, 0, 0)));
  }
  model.add_partner(model.apply(Grouped{}, many), Plane{law}, model.ground().at({0, 0, 0}));
  State x = model.reference_state();
  for (int i = 0; i < 10; ++i) model.set_velocity(x, balls[std::size_t(i)], {0.1 + 0.1 * i, 0, 0}, {0, 0, 0});
  RunReport const report = simulate(model, x, GeneralisedAlpha{}, {.end_time = 0.5, .step = 1e-3}).run();
  for (int i = 0; i < 10; ++i)  // a solid ball that rolls keeps 5/7 of its velocity
    EXPECT_NEAR(frame(model, x, many[std::size_t(i)]).v.x(), 5.0 / 7.0 * (0.1 + 0.1 * i), slip_speed);
  return report;
}
TEST(ContactGroup, StandInCostsNewtonHardlyMoreWhereSlipEnds) {
  for (double const slip_speed : {0.05, 0.02}) {
    RunReport const own = rolled<Applied::grouped>(slip_speed), exact = rolled<Applied::exactly>(slip_speed);
    std::printf(
        "balls that come to roll, v_s = %g m/s: iterations per step %.3f by own exact blocks, %.3f by the stand-in\n",
        slip_speed, double(exact.iterations) / double(exact.steps), double(own.iterations) / double(own.steps));
    EXPECT_LT(own.iterations, 1.5 * double(exact.iterations));
  }
}

// --- energy ---------------------------------------------------------------------------------------------------

// The penetrations of two balls into the floor are 0.01 and 0.02. The first ball also penetrates the post by 0.05.
TEST(ContactGroup, EnergyCountsWhatItStores) {
  Model<Bodies<Rigid<>>, Joints<>, Forces<Group>> model;
  std::vector<Marker<Rigid<>>> many;
  for (double const depth : {0.01, 0.02, -0.5})
    many.push_back(model.add(ball(mass, radius, {100.0 * depth, 0, radius - depth})).at(Vec3(0, 0, 0)));
  auto const group = model.apply(Group{}, many);
  EXPECT_EQ(energy(model, model.reference_state()).forces, 0.0);
  model.add_partner(group, on_plane, model.ground().at({0, 0, 0}));
  EXPECT_NEAR(energy(model, model.reference_state()).forces, 0.5 * 2e4 * (1e-4 + 4e-4), 1e-12);
  model.add_partner(group, on_fixed, model.ground().at({1.0 + radius + 0.3 - 0.05, 0, radius - 0.01}));
  EXPECT_NEAR(energy(model, model.reference_state()).forces, 5.0 + 2e5 * std::pow(0.05, 2.5) / 2.5, 1e-10);
}

// --- bad input ------------------------------------------------------------------------------------------------

struct Floor {
  Model<Bodies<Rigid<>>, Joints<>, Forces<Group>> model;
  BodyHandle<Rigid<>> one = model.add(ball(mass, radius, {0, 0, 1}), "marble");
  std::vector<Marker<Rigid<>>> many{one.at(Vec3(0, 0, 0))};
};

TEST(ContactGroup, RefusesMarkersAndHandlesOfAnotherModel) {
  Floor a, b;
  auto const group = a.model.apply(Group{}, a.many, "marbles"), of_b = b.model.apply(Group{}, b.many, "others");
  auto const floor = a.model.ground().at({0, 0, 0});
  std::string const told = " was given a marker or handle of another model";
  EXPECT_TRUE(has(refusal([&] { a.model.apply(Group{}, b.many, "marbles"); }), "\"marbles\"" + told));
  EXPECT_TRUE(has(refusal([&] { a.model.add_partner(of_b, on_plane, floor); }), "\"others\"" + told));
  EXPECT_TRUE(has(refusal([&] { a.model.add_partner(group, on_plane, b.model.ground().at({0, 0, 0})); }),
                  "\"marbles\"" + told));
  ElementHandle<Group> const unset;
  EXPECT_TRUE(has(refusal([&] { a.model.add_partner(unset, on_plane, floor); }), "A default-constructed handle"));
  System const system(a.model, with<Capabilities::motion>);
  EXPECT_TRUE(has(refusal([&] { for_each_contact(system, of_b, [](auto const&) {}); }), "\"others\"" + told));
  EXPECT_TRUE(
      has(refusal([&] { for_each_contact(system, unset, [](auto const&) {}); }), "A default-constructed handle"));
  // a refused call has changed nothing
  EXPECT_EQ(a.model.entry(group).markers.size(), 1u);
  EXPECT_EQ(std::get<0>(a.model.force_pools()).size(), 1u);
  int partners = 0;
  a.model.entry(group).force.for_each_partner([&](auto const&) { ++partners; });
  EXPECT_EQ(partners, 0);
}

TEST(ContactGroup, NamesItselfAndTheOpponentInMessages) {
  Floor f;
  auto const group = f.model.apply(Group{}, f.many, "marbles");
  auto const floor = f.model.ground().at({0, 0, 0});
  OnPlane bad = on_plane;
  bad.geometry.radius = -1.0;
  EXPECT_TRUE(has(refusal([&] { f.model.add_partner(group, bad, floor, "floor"); }),
                  "\"marbles\", \"floor\": the sphere's radius"));
  f.model.add_partner(group, on_plane, floor);
  EXPECT_TRUE(
      has(refusal([&] { f.model.add_partner(group, bad, floor); }), "\"marbles\", \"partner 2\": the sphere's radius"));
  // a group with its own contact partners also checks them
  Group full;
  full.add_partner(bad, 0, "floor");
  EXPECT_TRUE(
      has(refusal([&] { f.model.apply(full, f.many, "more marbles"); }), "\"more marbles\": the sphere's radius"));
}

TEST(ContactGroup, MayHaveNoMarkersAndNoOpponents) {
  Floor f;
  auto const empty = f.model.apply(Group{}, std::vector<Marker<Rigid<>>>{});
  f.model.apply(Group{}, f.many);
  f.model.add_partner(empty, on_plane, f.model.ground().at({0, 0, 0}));
  State x = f.model.reference_state();
  simulate(f.model, x, GeneralisedAlpha{}, {.end_time = 0.1, .step = 0.01}).run();
  EXPECT_EQ(x.q, f.model.reference_state().q);
}

}  // namespace contact_group_test
