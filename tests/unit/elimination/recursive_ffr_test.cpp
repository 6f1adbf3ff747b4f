// Bodies with a floating frame in trees of joint coordinates, against the same models with multipliers. Some joints
// are at a deforming point of the carrying body, some at one of the carried body.
#include <gtest/gtest.h>

#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/ffr/planar_ffr.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/run/probe.hpp>

#include "support/held.hpp"
#include "support/random_tree.hpp"
#include "support/refusal.hpp"

using namespace polybody;

namespace recursive_ffr_test {

using random_tree::Draws;

Bar const bar{
    .length = 0.5,
    .constants =
        BarConstants{.EA = 2e4, .EI = 4.0, .mass_per_length = 0.8, .GJ = 3.0, .rotary_inertia = 5e-4, .EI_y = 6.0},
    .placement = {}};

/// Random rigid bodies and floating frames from a seed. Each is connected to the ground, to an earlier body or to
/// nothing.
template <class Policy, class Rigid, class Floating, class... Gs>
struct Mixed {
  Model<Bodies<Rigid, Floating>, Joints<Joint<Gs, Policy>...>> model{Gravity{1.0, -2.0, -9.81}};
  struct Place {
    bool floats;
    std::size_t index;
    Placement placement;
  };
  std::vector<BodyHandle<Rigid>> rigid;
  std::vector<BodyHandle<Floating>> floating;
  std::vector<Place> places;

  /// A marker at a point of the body; along the bar if the body has a floating frame.
  template <class F>
  void at(std::size_t i, Vec3 const& u, F&& f) {
    if (places[i].floats)
      f(floating[places[i].index].at(u[0]));
    else if constexpr (Rigid::world == World::plane)
      f(rigid[places[i].index].at(Vec2(u[0], u[1])));
    else
      f(rigid[places[i].index].at(u));
  }
};

Vec3 drawn_point(Draws& draw, bool floats, bool plane) {
  if (floats) return {0.125 * draw.below(5), 0.0, 0.0};
  Vec3 u = draw.vector(0.3);
  if (plane) u[2] = 0.0;
  return u;
}

template <class M, class Make, class Connect>
void grow(M& m, unsigned seed, bool plane, Make const& make, Connect const& connect) {
  Draws draw{std::mt19937(seed)};
  int const n = 2 + draw.below(3);
  for (int i = 0; i < n; ++i) {
    bool const floats = draw.below(3) > 0;
    Placement placement =
        plane ? Placement::planar(0.0, 0.0, draw.number(-1.0, 1.0)) : Placement::at(draw.vector(1.0), draw.vector(1.0));
    int const carrier = i == 0 ? -1 : draw.below(i + 2) - 2;  // −1: the ground, −2: nothing
    Vec3 const here = drawn_point(draw, floats, plane);
    Vec3 point = plane ? Vec3(0.3, 0.4, 0.0) : draw.vector(1.0), there = point;
    if (carrier >= 0) {
      auto const& c = m.places[std::size_t(carrier)];
      there = drawn_point(draw, c.floats, plane);
      point = c.placement.origin + c.placement.axes * there;
    }
    placement.origin = point - placement.axes * here;
    m.places.push_back({floats, floats ? m.floating.size() : m.rigid.size(), placement});
    make(m, floats, placement, draw);
    if (carrier < -1) continue;
    bool const backwards = draw.below(2) == 0;
    int const geometry = draw.below(5);
    Vec3 const axis = draw.axis();
    m.at(std::size_t(i), here, [&](auto const& b) {
      auto const join = [&](auto const& a) {
        backwards ? connect(m, geometry, axis, b, a) : connect(m, geometry, axis, a, b);
      };
      if (carrier < 0)
        join(m.model.ground().at(point));
      else
        m.at(std::size_t(carrier), there, join);
    });
  }
}

template <class Policy>
struct InSpace : Mixed<Policy, Rigid<>, Ffr, Revolute, Prismatic, Spherical, Universal, Weld> {
  explicit InSpace(unsigned seed) {
    grow(
        *this, seed, false,
        [seed](auto& m, bool floats, Placement const& placement, Draws& draw) {
          double const mass = draw.number(0.5, 3.0);
          Bar placed = bar;
          placed.placement = placement;
          if (floats)
            m.floating.push_back(
                m.model.add(Ffr::from(placed, 2, {.frame = FfrFrame::clamped, .stiffening = seed % 2 == 1})));
          else
            m.rigid.push_back(m.model.add(Rigid<>({.mass = mass,
                                                   .inertia = Vec3(0.02 * mass, 0.03 * mass, 0.04 * mass).asDiagonal(),
                                                   .placement = placement})));
        },
        [](auto& m, int geometry, Vec3 const& axis, auto const& a, auto const& b) {
          if (geometry == 0) m.model.connect(Joint<Revolute, Policy>{{.axis = axis}, {}}, a, b);
          if (geometry == 1) m.model.connect(Joint<Prismatic, Policy>{{.axis = axis}, {}}, a, b);
          if (geometry == 2) m.model.connect(Joint<Spherical, Policy>{}, a, b);
          if (geometry == 3)
            m.model.connect(Joint<Universal, Policy>{{.first = Vec3::UnitX(), .second = Vec3::UnitY()}, {}}, a, b);
          if (geometry == 4) m.model.connect(Joint<Weld, Policy>{}, a, b);
        });
  }
};

template <class Policy>
struct InPlane : Mixed<Policy, planar::Rigid, planar::Ffr, planar::Revolute, planar::Prismatic, planar::Weld> {
  explicit InPlane(unsigned seed) {
    grow(
        *this, seed, true,
        [seed](auto& m, bool floats, Placement const& placement, Draws& draw) {
          double const mass = draw.number(0.5, 3.0);
          Bar placed = bar;
          placed.placement = placement;
          if (floats)
            m.floating.push_back(
                m.model.add(planar::Ffr::from(placed, 2, {.frame = FfrFrame::clamped, .stiffening = seed % 2 == 1})));
          else
            m.rigid.push_back(m.model.add(planar::Rigid(mass, 0.03 * mass, placement)));
        },
        [](auto& m, int geometry, Vec3 const&, auto const& a, auto const& b) {
          if (geometry < 3) m.model.connect(Joint<planar::Revolute, Policy>{}, a, b);
          if (geometry == 3) m.model.connect(Joint<planar::Prismatic, Policy>{{.axis = {0.6, 0.8, 0}}, {}}, a, b);
          if (geometry == 4) m.model.connect(Joint<planar::Weld, Policy>{}, a, b);
        });
  }
};

/// Accelerations and multipliers of trees in motion and in deformation. Each state satisfies the joints, and is
/// reproduced from its joint coordinates.
template <template <class> class Tree, class Policy>
void expect_as_multipliers(char const* world) {
  double worst_a = 0.0, worst_lambda = 0.0, worst_state = 0.0;
  for (unsigned seed = 1; seed < 120; ++seed) {
    Tree<Policy> const free(seed);
    Tree<Constraint> const tied(seed);
    State const x = random_tree::moving(free, seed);
    System system(tied.model);
    VecX a, lambda;
    ForwardDynamics<>(system).accelerations(system, {x.q, x.v, 0.0}, a, lambda);
    VecX open = VecX::Zero(system.rows()), rate = open;
    system.evaluate(x.q, x.v, 0.0);
    system.violation(open);
    system.violation_rate(rate);
    ASSERT_LT(open.norm(), 1e-11) << "seed " << seed;
    ASSERT_LT(rate.norm(), 1e-11) << "seed " << seed;
    ASSERT_LT((x.a - a).norm(), 1e-7 * a.norm()) << "seed " << seed;
    worst_a = std::max(worst_a, (x.a - a).norm() / a.norm());
    if (lambda.size() > 0) worst_lambda = std::max(worst_lambda, (x.lambda - lambda).norm() / lambda.norm());
    System stepped = stepped_system(free.model);
    State again;
    VecX room;
    expand(stepped, reduce(stepped, x), again, room);
    worst_state = std::max(worst_state, (again.v - x.v).norm() / x.v.norm());
    worst_state = std::max(worst_state, (again.a - x.a).norm() / x.a.norm());
  }
  Claim claim{"closed forms",
              std::string("accelerations of random trees with floating bodies, ") + world + ", of their size",
              By::itself, "Constraint", Policy::name};
  held_within(claim, worst_a, 1e-9, {.scale = 1.0});
  claim.what = std::string("multipliers of random trees with floating bodies, ") + world + ", of their size";
  held_within(claim, worst_lambda, 1e-9, {.scale = 1.0});
  EXPECT_LT(worst_state, 1e-9);
}

// The frame is tied to the first end: in mean axes the same sums have errors up to 5e-8 in the multipliers.
TEST(RecursiveFfr, TreesInSpaceAccelerateAsMultipliersSay) {
  expect_as_multipliers<InSpace, JointCoordinates>("in space");
}
TEST(RecursiveFfr, TreesInThePlaneAccelerateAsMultipliersSay) {
  expect_as_multipliers<InPlane, JointCoordinates>("in the plane");
}

/// Three bars in a row that fall from the horizontal, each on the flexible end of the previous one.
template <class Policy>
struct Row {
  using Pin = Joint<Spherical, Policy>;
  Model<Bodies<Ffr>, Joints<Pin>> model{Gravity{0, 0, -9.81}};
  std::vector<BodyHandle<Ffr>> links;
  State x;

  Row() {
    for (int i = 0; i < 3; ++i) {
      Bar link = bar;
      link.placement = Placement::at({bar.length * i, 0, 0}, {0, 0, 0});
      links.push_back(
          model.add(Ffr::from(link, 2, {.frame = FfrFrame::clamped, .stiffening = false, .stiffness_damping = 1e-4})));
      if (i == 0)
        model.connect(Pin{}, model.ground().at({0, 0, 0}), links.back().at(0.0));
      else
        model.connect(Pin{}, links[std::size_t(i) - 1].at(bar.length), links.back().at(0.0));
    }
    x = model.reference_state();
    x.v[1] = 0.3;
  }
};

TEST(RecursiveFfr, ImplicitStepsHaveTheirOrder) {
  auto const tip = [](auto policy, auto const& integrator, double h) {
    Row<decltype(policy)> row;
    simulate(row.model, row.x, integrator, {.end_time = 0.1, .step = h}).run();
    return position(row.model, row.x, row.links.back().at(bar.length));
  };
  GeneralisedAlpha const alpha{.rho_inf = 0.6, .tolerance = 1e-9};
  Vec3 const exact = tip(Constraint{}, alpha, 2.5e-5);
  double last = 0.0;
  for (double const h : {1e-3, 5e-4, 2.5e-4, 1.25e-4}) {
    double const off = (tip(JointCoordinates{}, alpha, h) - exact).norm();
    EXPECT_LT(off, 1.5 * (tip(Constraint{}, alpha, h) - exact).norm());
    if (last > 0.0) {
      EXPECT_NEAR(std::log2(last / off), 2.0, 0.3);
    }
    last = off;
  }
  EXPECT_LT(last, 1e-5);
}

}  // namespace recursive_ffr_test
