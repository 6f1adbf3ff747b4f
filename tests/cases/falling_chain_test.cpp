// Open chain of links that falls from the horizontal, with its first link pinned to the ground, by five joint
// policies. Compared are the tip position, the constraint violations of the pins and the counts of unknowns. Sources:
// pendulum of N bars (R8d, independent computation), Wallin 2016, §3.5 and Table 3.4.

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/policies/bushing.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/problem_size.hpp>
#include <polybody/run/simulate.hpp>

#include "support/held.hpp"

namespace polybody {
namespace falling_chain_test {

template <class Policy>
using Pin = Joint<Revolute, Policy>;

/// Bodies of a policy: rigid links, in one model for the policies that keep their coordinates, or cables of one
/// element.
template <class Policy>
struct Kind {
  using Link = Rigid<>;
  using ModelType = Model<Bodies<Link>, Joints<Pin<Constraint>, Pin<Penalty>, Pin<Bushing>>>;
  static Link link(Bar const& bar) { return Link::from(bar); }
};
template <>
struct Kind<JointCoordinates> : Kind<Constraint> {
  using ModelType = Model<Bodies<Link>, Joints<Pin<JointCoordinates>>>;
};
template <>
struct Kind<AncfLinear> {
  using Link = AncfCable<>;
  using ModelType = Model<Bodies<Link>, Joints<Pin<AncfLinear>>>;
  static Link link(Bar const& bar) { return Link::from(bar, 1); }
};

/// Stiffness k in every constraint equation. The damping ends the vibrations of the pins, which are closed at the
/// start.
template <class Policy>
Policy policy_of(double k) {
  double const c = std::sqrt(k);
  if constexpr (std::is_same_v<Policy, Penalty>) {
    return {.stiffness = k, .damping = c};
  } else if constexpr (std::is_same_v<Policy, Bushing>) {
    Bushing::Matrix const one = Bushing::Matrix::Identity();
    return {.stiffness = Bushing::Matrix(k * one), .damping = Bushing::Matrix(c * one)};
  } else {
    return {};
  }
}

/// Chain of 16 m and 64 kg in n links. Lengths scale as g t²: after 1 s the shape is that of a chain of 1 m after
/// 0.25 s, whose tip R8d gives. At this time the wave from the pin has not reached the tip, which still falls freely.
constexpr double length = 16.0, stiff = 1e8;

/// Rod of the chain. Its rotary inertia adds 5e-4 to m l²/12 of a rod of 0.25 m. A cable has none. The axial
/// stiffness of 0.25 m is `stiff`. A cable of one element without stretch and bending is r = r₀ + s t, with the
/// kinetic energy of a rigid rod.
Bar rod(double l, double from) {
  return {
      .length = l,
      .constants = BarConstants{.EA = 0.25 * stiff, .EI = 1e-3 * stiff, .mass_per_length = 4.0, .rotary_inertia = 1e-5},
      .placement = Placement::at({from, 0, 0})};
}

/// Chain from one source for all policies.
template <class Policy>
struct Chain {
  typename Kind<Policy>::ModelType model{Gravity{0, -9.81, 0}};
  std::vector<BodyHandle<typename Kind<Policy>::Link>> links;
  std::vector<ElementHandle<Pin<Policy>>> pins;
  State x;
  double l;
  Violation worst;  ///< maximum over the steps

  explicit Chain(int n, double k = stiff) : l(length / n) {
    Pin<Policy> const pin{Revolute{.axis = Vec3::UnitZ()}, policy_of<Policy>(k)};
    for (int i = 0; i < n; ++i) {
      links.push_back(model.add(Kind<Policy>::link(rod(l, i * l))));
      auto const here = links.back().at(0.0);
      pins.push_back(i == 0 ? model.connect(pin, model.ground().at({0, 0, 0}), here)
                            : model.connect(pin, links[std::size_t(i) - 1].at(l), here));
    }
    x = model.reference_state();
  }
  /// Integrates for one second.
  void fall(double h = 2e-3) {
    System system(model);
    for (State const& now : simulate(model, x, GeneralisedAlpha{}, {.end_time = 1.0, .step = h})) {
      Violation const open = largest_violation(system, now);
      worst.position = std::max(worst.position, open.position);
      worst.velocity = std::max(worst.velocity, open.velocity);
    }
  }
  Vec3 tip() const { return position(model, x, links.back().at(l)); }
  /// Norm of the forces in all pins, √Σ F² [N], and norm of their constraint violations, √Σ g² [m].
  double force() const {
    double sum = 0.0;
    for (auto const& pin : pins) sum += reaction(model, x, pin).f.squaredNorm();
    return std::sqrt(sum);
  }
  double opening() const {
    double sum = 0.0;
    for (auto const& pin : pins) sum += constraint_violation(model, x, pin).squaredNorm();
    return std::sqrt(sum);
  }
};

template <class Policy>
Chain<Policy> fallen(int n, double k = stiff) {
  Chain<Policy> chain(n, k);
  chain.fall();
  return chain;
}
Chain<Constraint> const& ideal() {
  static Chain<Constraint> const chain = fallen<Constraint>(64);
  return chain;
}

// Tip of ten links: sixteen times the tip of the 1 m chain at 0.25 s (R8d). Ideal joints have an error of order h²,
// compliant joints an additional error of order F/k.
TEST(FallingChain, OfTenLinksHasThePublishedTip) {
  Vec3 const exact = length * Vec3(0.877462524775, -0.306656671158, 0.0);
  auto const expect = [&](char const* policy, Vec3 const& tip, double tolerance) {
    held_within(
        {"R8", "tip of ten links of 1.6 m after 1 s [m]", By::independent, "ordinary solver in the turns of the links",
         std::string("10 links, generalised-α, h = 2 ms, ") + policy},
        (tip - exact).norm(), tolerance, {.scale = (exact - Vec3(length, 0, 0)).norm()});
  };
  expect("Constraint", fallen<Constraint>(10).tip(), 2e-5);
  expect("JointCoordinates", fallen<JointCoordinates>(10).tip(), 2e-5);
  expect("Penalty", fallen<Penalty>(10).tip(), 1e-4);
  expect("Bushing", fallen<Bushing>(10).tip(), 1e-4);
  expect("cables, AncfLinear", fallen<AncfLinear>(10).tip(), 5e-4);
}

// All policies agree within 1 % of the displacement of the tip, and within 0.5 mm of its 5 m.
TEST(FallingChain, HasOneTipByFivePolicies) {
  Vec3 const tip = ideal().tip();
  double const way = (tip - Vec3(length, 0, 0)).norm();
  // the influence of the pin falls by a constant factor per link: 64 links away the tip falls freely, −½ g t²
  held({"thesis §3.5", "fall of the tip after 1 s, whip under way [m]", By::closed_form, "−½ g t²",
        "64 links, Constraint, generalised-α, h = 2 ms"},
       tip[1], -0.5 * 9.81, 1e-5);
  Chain<Constraint> fine(64);
  fine.fall(1e-3);
  auto const expect = [&](char const* policy, Vec3 const& other, double part) {
    held_within({"thesis §3.5", "tip of 64 links after 1 s [m]", By::itself, "Constraint, h = 2 ms",
                 std::string("64 links, generalised-α, ") + policy},
                (other - tip).norm(), part * way, {.scale = way});
  };
  expect("Constraint, h = 1 ms", fine.tip(), 5e-6);
  expect("JointCoordinates, h = 2 ms", fallen<JointCoordinates>(64).tip(), 5e-6);
  expect("Penalty, h = 2 ms", fallen<Penalty>(64).tip(), 1e-4);
  expect("Bushing, h = 2 ms", fallen<Bushing>(64).tip(), 1e-4);
  expect("cables, AncfLinear, h = 2 ms", fallen<AncfLinear>(64).tip(), 1e-4);
}

/// Constraint violation g = F/k with the force F of the ideal chain. The position error of the tip has the same
/// origin.
template <class Policy>
void expect_one_over_k() {
  double opening = 0.0, off = 0.0;
  for (double const k : {1e6, 1e7, 1e8}) {
    Chain<Policy> const chain = fallen<Policy>(64, k);
    double const opens = chain.opening(), away = (chain.tip() - ideal().tip()).norm();
    held_within(
        {"thesis §3.5", "gaps of 64 pins times their stiffness, k √Σ g² [N]", By::itself, "forces of ideal pins, √Σ F²",
         std::string("64 links, ") + (std::is_same_v<Policy, Penalty> ? "Penalty" : "Bushing")},
        std::abs(k * opens - ideal().force()), 0.01 * ideal().force(), {equals("k", k), ideal().force()});
    if (opening > 0.0) {
      EXPECT_NEAR(opening / opens, 10.0, 0.05) << k;
      EXPECT_NEAR(off / away, 10.0, 0.15) << k;
    }
    opening = opens;
    off = away;
  }
}
TEST(FallingChain, OpensPenaltiesAsOneOverTheStiffness) { expect_one_over_k<Penalty>(); }
TEST(FallingChain, OpensBushingsAsOneOverTheStiffness) { expect_one_over_k<Bushing>(); }

// A cable of one element is equivalent to a spring EA/l in series with an ideal pin.
TEST(FallingChain, OfCablesIsThatOfSpringsAsStiff) {
  Vec3 const spring = fallen<Penalty>(64).tip() - ideal().tip(), cable = fallen<AncfLinear>(64).tip() - ideal().tip();
  EXPECT_GT(spring.norm(), 1e-4);
  held_within({"thesis §3.5", "stretch of the chain at its tip [m]", By::itself, "Penalty of k = EA/l",
               "64 cables, AncfLinear"},
              (cable - spring).norm(), 0.03 * spring.norm(), {.scale = spring.norm()});
}

// A step of generalised-α satisfies the constraint equations of `Constraint`, not their rates. Joint coordinates
// satisfy both.
TEST(FallingChain, PinsWithoutSpringsStayClosed) {
  Chain<JointCoordinates> const joints = fallen<JointCoordinates>(64);
  auto const expect = [](char const* what, char const* policy, double gap, double tolerance) {
    held_within({"thesis §3.5", what, By::closed_form, "pins stay closed", std::string("64 links, ") + policy}, gap,
                tolerance, {.scale = length});
  };
  expect("largest gap of a pin in 1 s [m]", "JointCoordinates", joints.worst.position, 1e-12);
  expect("largest rate of a gap in 1 s [m/s]", "JointCoordinates", joints.worst.velocity, 1e-12);
  expect("largest gap of a pin in 1 s [m]", "cables, AncfLinear", fallen<AncfLinear>(64).worst.position, 1e-12);
  expect("largest gap of a pin in 1 s [m]", "Constraint", ideal().worst.position, 1e-10);
}

// Coordinates, constraints and degrees of freedom counted as in Table 3.4 of Wallin 2016. A rigid link has seven
// coordinates and the norm of its parameters, a cable twelve coordinates. A pin has five constraint equations, or
// four between cables. Penalties and bushings have none.
TEST(FallingChain, IsCountedAsInTheThesis) {
  constexpr Index n = 64;
  auto const expect = [](char const* policy, ProblemSize const& c, Index coordinates, Index constraints, Index freedoms,
                         Index rows) {
    auto const same = [&](char const* what, Index found, Index counted) {
      held({"thesis, ch. 3", what, By::closed_form, "counted as Table 3.4 does", std::string("64 links, ") + policy},
           double(found), double(counted), 0.0);
    };
    same("coordinates of the chain", c.coordinates, coordinates);
    same("constraints of the chain", c.constraints, constraints);
    same("degrees of freedom of the chain", c.degrees_of_freedom, freedoms);
    EXPECT_EQ(c.rows, rows);
  };
  expect("Constraint", problem_size(Chain<Constraint>(n).model), 7 * n, n + 5 * n, n, 5 * n);
  expect("Penalty", problem_size(Chain<Penalty>(n).model), 7 * n, n, 6 * n, 0);
  expect("Bushing", problem_size(Chain<Bushing>(n).model), 7 * n, n, 6 * n, 0);
  expect("JointCoordinates", problem_size(Chain<JointCoordinates>(n).model), n, 0, n, 0);
  expect("cables, AncfLinear", problem_size(Chain<AncfLinear>(n).model), 12 * n - 4 * n, 0, 8 * n, 0);
}

}  // namespace falling_chain_test
}  // namespace polybody
