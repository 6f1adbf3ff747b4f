#pragma once
// Random trees of rigid and flexible bodies in joint coordinates, against the same models with multipliers. Some joints
// are at a deforming point of the carrying body, some at one of the carried body.
#include <gtest/gtest.h>

#include <polybody/bodies/ffr/ffr_options.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/run/probe.hpp>

#include "support/held.hpp"
#include "support/random_tree.hpp"

namespace flexible_trees {

using namespace polybody;
using random_tree::Draws;

inline Bar const bar{
    .length = 0.5,
    .constants =
        BarConstants{.EA = 2e4, .EI = 4.0, .mass_per_length = 0.8, .GJ = 3.0, .rotary_inertia = 5e-4, .EI_y = 6.0},
    .placement = {}};

/// Flexible body of `placed`: a floating frame, or a beam with nodes at the points of `drawn_point`.
template <class Flexible>
Flexible bent(Bar const& placed, unsigned seed) {
  if constexpr (FloatingFrameBody<Flexible>)
    return Flexible::from(placed, 2, {.frame = FfrFrame::clamped, .stiffening = seed % 2 == 1});
  Bar shearing = placed;
  shearing.constants->GA = 8e3;
  shearing.constants->GA_z = 8e3;
  return Flexible::from(shearing, 4);
}

/// Random rigid and flexible bodies from a seed. Each is connected to the ground, to an earlier body or to nothing.
template <class Policy, class Rigid, class Flexible, class... Gs>
struct Mixed {
  Model<Bodies<Rigid, Flexible>, Joints<Joint<Gs, Policy>...>> model{Gravity{1.0, -2.0, -9.81}};
  struct Place {
    bool bends;
    std::size_t index;
    Placement placement;
  };
  std::vector<BodyHandle<Rigid>> rigid;
  std::vector<BodyHandle<Flexible>> flexible;
  std::vector<Place> places;

  /// Adds a flexible body with this placement, or the body `solid`.
  void add(bool bends, Placement const& placement, unsigned seed, Rigid const& solid) {
    Bar placed = bar;
    placed.placement = placement;
    if (bends)
      flexible.push_back(model.add(bent<Flexible>(placed, seed)));
    else
      rigid.push_back(model.add(solid));
  }
  /// A marker at a point of the body; along the bar if the body is flexible.
  template <class F>
  void at(std::size_t i, Vec3 const& u, F&& f) {
    if (places[i].bends)
      f(flexible[places[i].index].at(u[0]));
    else if constexpr (Rigid::world == World::plane)
      f(rigid[places[i].index].at(Vec2(u[0], u[1])));
    else
      f(rigid[places[i].index].at(u));
  }
};

inline Vec3 drawn_point(Draws& draw, bool bends, bool plane) {
  if (bends) return {0.125 * draw.below(5), 0.0, 0.0};
  Vec3 u = draw.vector(0.3);
  if (plane) u[2] = 0.0;
  return u;
}

template <class M, class Make, class Connect>
void grow(M& m, unsigned seed, bool plane, Make const& make, Connect const& connect) {
  Draws draw{std::mt19937(seed)};
  int const n = 2 + draw.below(3);
  for (int i = 0; i < n; ++i) {
    bool const bends = draw.below(3) > 0;
    Placement placement =
        plane ? Placement::planar(0.0, 0.0, draw.number(-1.0, 1.0)) : Placement::at(draw.vector(1.0), draw.vector(1.0));
    int const carrier = i == 0 ? -1 : draw.below(i + 2) - 2;  // −1: the ground, −2: nothing
    Vec3 const here = drawn_point(draw, bends, plane);
    Vec3 point = plane ? Vec3(0.3, 0.4, 0.0) : draw.vector(1.0), there = point;
    if (carrier >= 0) {
      auto const& c = m.places[std::size_t(carrier)];
      there = drawn_point(draw, c.bends, plane);
      point = c.placement.origin + c.placement.axes * there;
    }
    placement.origin = point - placement.axes * here;
    m.places.push_back({bends, bends ? m.flexible.size() : m.rigid.size(), placement});
    make(m, bends, placement, draw);
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

template <class Policy, class Flexible>
struct InSpace : Mixed<Policy, Rigid<>, Flexible, Revolute, Prismatic, Spherical, Universal, Weld> {
  explicit InSpace(unsigned seed) {
    grow(
        *this, seed, false,
        [seed](auto& m, bool bends, Placement const& placement, Draws& draw) {
          double const mass = draw.number(0.5, 3.0);
          m.add(bends, placement, seed,
                Rigid<>({.mass = mass,
                         .inertia = Vec3(0.02 * mass, 0.03 * mass, 0.04 * mass).asDiagonal(),
                         .placement = placement}));
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

template <class Policy, class Flexible>
struct InPlane : Mixed<Policy, planar::Rigid, Flexible, planar::Revolute, planar::Prismatic, planar::Weld> {
  explicit InPlane(unsigned seed) {
    grow(
        *this, seed, true,
        [seed](auto& m, bool bends, Placement const& placement, Draws& draw) {
          double const mass = draw.number(0.5, 3.0);
          m.add(bends, placement, seed, planar::Rigid(mass, 0.03 * mass, placement));
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
template <template <class, class> class Tree, class Flexible, class Policy>
void expect_as_multipliers(char const* which) {
  double worst_a = 0.0, worst_lambda = 0.0, worst_state = 0.0;
  for (unsigned seed = 1; seed < 120; ++seed) {
    Tree<Policy, Flexible> const free(seed);
    Tree<Constraint, Flexible> const tied(seed);
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
  Claim claim{"closed forms", std::string("accelerations of random trees with ") + which + ", of their size",
              By::itself, "Constraint", Policy::name};
  held_within(claim, worst_a, 1e-9, {.scale = 1.0});
  claim.what = std::string("multipliers of random trees with ") + which + ", of their size";
  held_within(claim, worst_lambda, 1e-9, {.scale = 1.0});
  EXPECT_LT(worst_state, 1e-9);
}

}  // namespace flexible_trees
