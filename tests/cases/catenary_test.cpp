// Catenary (S11) in the plane: a cable and a chain of rigid links, supported at equal heights. The links have ideal
// pins, springs, or joint coordinates.

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/bushing.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/statics/equilibrium.hpp>

#include "support/held.hpp"

namespace polybody {
namespace catenary_test {

using Cable = planar::AncfCable<EngineeringStrain>;
template <class Policy>
using Pin = Joint<planar::Revolute, Policy>;
/// Model type for all tests, which is compiled once.
using Hanging =
    Model<Bodies<planar::Rigid, Cable>, Joints<Pin<Constraint>, Pin<Penalty>, Pin<Bushing>, Pin<JointCoordinates>>>;

/// Angle between successive chords of n chords of length l with their ends on a circle, span s: Σ l cos δ(i − (n −
/// 1)/2) = s.
double turn_of_chords(int n, double l, double s) {
  double low = 0.0, high = 2.0 * std::numbers::pi / n;
  for (int k = 0; k < 60; ++k) {
    double const mid = 0.5 * (low + high);
    double sum = -s;
    for (int i = 0; i < n; ++i) sum += l * std::cos(mid * (i - 0.5 * (n - 1)));
    (sum > 0.0 ? low : high) = mid;
  }
  return low;
}

// Cable of 10 m and 10 N/m with supports 8 m apart; 20 elements, EI = 1e-3 N m². The initial shape is an arc. The
// stiffer cable starts from the equilibrium of the softer one. EA = 1e9 approximates the inextensible cable: H
// differs by 5e-6.
TEST(PlanarCatenary, HangsWithThePublishedForceAndSag) {
  struct Row {
    double EA, H, sag;
  };
  double const turn = turn_of_chords(20, 0.5, 8.0);
  VecX hanging(84);
  Vec2 r(0.0, 0.0);
  for (int i = 0; i <= 20; ++i) {
    double const at_node = turn * (i - 10), chord = at_node + 0.5 * turn;
    hanging.segment<4>(4 * i) << r, std::cos(at_node), std::sin(at_node);
    r += 0.5 * Vec2(std::cos(chord), std::sin(chord));
  }
  for (Row const& row :
       {Row{1e4, 33.35480862, 2.687462764}, Row{1e6, 33.81541787, 2.654709857}, Row{1e9, 33.82018790, 2.654375092}}) {
    Bar const bar{.length = 10.0, .constants = BarConstants{.EA = row.EA, .EI = 1e-3, .mass_per_length = 1.0}};
    Hanging model{Gravity{0, -10.0, 0}};
    auto const cable = model.add(Cable::from(bar, 20), "cable");
    auto const left = model.connect(Pin<Constraint>{}, model.ground().at({0, 0, 0}), cable.at(0.0), "left");
    model.connect(Pin<Constraint>{}, model.ground().at({8, 0, 0}), cable.at(10.0), "right");
    State x = model.reference_state();
    x.q = hanging;
    equilibrium(model, x, {.max_iterations = 200});
    hanging = x.q;
    Wrench<> const f = reaction(model, x, left);
    char const* const mesh = "planar AncfCable, 20 elements";
    Instance const at{row.EA == 1e9 ? "EA = 1e9, inextensible" : equals("EA", row.EA)};
    auto const elastic = [&](char const* what) {
      return Claim{"S11", what, By::independent, "elastic catenary without bending", mesh};
    };
    held(elastic("horizontal force of the cable [N]"), -f.f[0], row.H, 1e-3 * row.H, at);
    held({"S11", "vertical force of the cable [N]", By::closed_form, "half of its weight", mesh}, f.f[1], 50.0, 1e-6,
         at);
    held(elastic("sag of the cable [m]"), -position(model, x, cable.at(5.0))[1], row.sag, 1e-3 * row.sag, at);
  }
}

/// N uniform links of length l [m] and mass m [kg] over a span [m].
struct Links {
  int n;
  double l, m, span;
};
/// Horizontal and vertical force at the first support, sag of the middle pin, slope of the first link.
struct Hang {
  double H, V, sag, slope;
};

/// Equilibrium of a link under its weight, at its middle, and the forces at its ends: tan θᵢ = (V − m g (i + ½))/H.
/// Pins of stiffness k deflect along their forces by (H, V − m g i)/k. The span gives Σ l cos θᵢ + (N + 1) H/k = s. N
/// is even.
Hang closed_form(Links const& c, double k) {
  double const w = c.m * 9.81, v = 0.5 * c.n * w;
  Hang out{};
  double low = 1e-3 * v, high = 1e3 * v;
  for (int step = 0; step < 200; ++step) {
    double const h = 0.5 * (low + high);
    double span = (c.n + 1) * h / k;
    out = {h, v, 0.0, std::atan2(v - 0.5 * w, h)};
    for (int i = 0; i < c.n; ++i) {
      double const slope = std::atan2(v - w * (i + 0.5), h);
      span += c.l * std::cos(slope);
      if (2 * i < c.n) out.sag += c.l * std::sin(slope) + (v - w * i) / k;
    }
    (span < c.span ? low : high) = h;
  }
  return out;
}

/// Links along an arc, one after the other. The pins have an initial deflection of `open` along the arc, because
/// springs without tension cannot support a chain. The far support may have another policy.
template <class Policy>
struct Chain {
  Hanging model{Gravity{0, -9.81, 0}};
  ElementHandle<Pin<Policy>> first;
  std::vector<BodyHandle<planar::Rigid>> links;
  Links c;
  State x;
  template <class Far>
  Chain(Links const& chain, Policy const& policy, Far const& far, double open = 0.0) : c(chain) {
    double const turn = turn_of_chords(c.n, c.l + open, c.span);
    Vec2 const end(0.5 * c.l, 0.0);
    Vec2 r(0.0, 0.0);
    for (int i = 0; i < c.n; ++i) {
      double const angle = turn * (i - 0.5 * (c.n - 1));
      Vec2 const half = 0.5 * (c.l + open) * Vec2(std::cos(angle), std::sin(angle));
      r += half;
      links.push_back(model.add(planar::Rigid(c.m, c.m * c.l * c.l / 12.0, Placement::planar(r[0], r[1], angle))));
      r += half;
      if (i == 0)
        first = model.connect(Pin<Policy>{{}, policy}, model.ground().at({0, 0, 0}), links[0].at(-end), "support");
      else
        model.connect(Pin<Policy>{{}, policy}, links[std::size_t(i) - 1].at(end), links[std::size_t(i)].at(-end));
    }
    model.connect(Pin<Far>{{}, far}, links.back().at(end), model.ground().at({c.span, 0, 0}), "far support");
    x = model.reference_state();
    equilibrium(model, x);
  }
  Hang hang() const {
    Vec3 const f = reaction(model, x, first).f;
    auto const& middle = links[std::size_t(c.n / 2) - 1];
    Vec3 const along = frame(model, x, links[0].at(Vec2(0, 0))).A.col(0);
    return {-f[0], f[1], -position(model, x, middle.at(Vec2(0.5 * c.l, 0)))[1], std::atan2(-along[1], along[0])};
  }
};

/// Compares a chain with its equilibrium, link by link, to 1e-9 of each quantity.
void held_chain(Hang const& found, Hang const& exact, std::string const& formulation, std::string const& at = {}) {
  auto const expect = [&](char const* what, double value, double reference) {
    held({"S11", what, By::closed_form, "balance of each link", formulation}, value, reference, 1e-9 * reference, {at});
  };
  expect("horizontal force of the chain [N]", found.H, exact.H);
  expect("vertical force of the chain [N]", found.V, exact.V);
  expect("sag of the chain [m]", found.sag, exact.sag);
  expect("slope of the chain's first link [rad]", found.slope, exact.slope);
}

Links const ten{10, 0.1, 1.0, 0.8}, twenty{20, 0.05, 0.5, 0.8};
Hang const of_ten{33.0892370968, 49.05, 0.2668644258, 0.9275781698};

TEST(HangingChain, HasThePublishedForcesAndShape) {
  double const rigid = std::numeric_limits<double>::infinity();
  Hang const exact_ten = closed_form(ten, rigid), exact_twenty = closed_form(twenty, rigid);
  EXPECT_NEAR(exact_ten.H, of_ten.H, 1e-9);  // the published digits satisfy the equilibrium
  EXPECT_NEAR(exact_ten.sag, of_ten.sag, 1e-10);
  EXPECT_NEAR(exact_ten.slope, of_ten.slope, 1e-10);
  EXPECT_NEAR(exact_twenty.H, 33.1554563512, 1e-9);
  EXPECT_NEAR(exact_twenty.sag, 0.2657915666, 1e-10);
  held_chain(Chain(ten, Constraint{}, Constraint{}).hang(), of_ten, "10 rigid links on ideal pins");
  held_chain(Chain(twenty, Constraint{}, Constraint{}).hang(), exact_twenty, "20 rigid links on ideal pins");
}

// The tree starts at the first support and a pin at the far one closes the loop. The time steps are tested in
// tests/unit/elimination/recursive_loop_test.cpp.
TEST(HangingChain, HangsAlikeOnJointCoordinates) {
  held_chain(Chain(ten, JointCoordinates{}, Constraint{}).hang(), of_ten, "10 rigid links on joint coordinates");
}

// Springs instead of pins: they agree with their closed form at every stiffness, and with the published force up to
// 1/k.
void expect_springs(char const* pins, auto&& of_stiffness) {
  double last = 0.0;
  for (double const k : {1e7, 1e8, 1e9}) {
    Hang const h = Chain(ten, of_stiffness(k), of_stiffness(k), of_ten.H / k).hang();
    held_chain(h, closed_form(ten, k), std::string("10 rigid links on ") + pins, equals("k", k));
    double const error = std::abs(h.H - of_ten.H);
    if (last > 0.0) {
      EXPECT_NEAR(last / error, 10.0, 0.01) << k;
    }
    last = error;
  }
  EXPECT_LT(last, 2e-6 * of_ten.H);
}
TEST(HangingChain, HangsOnPenaltiesWithAnErrorOfOneOverK) {
  expect_springs("penalties of 1e7 to 1e9 N/m", [](double k) { return Penalty{.stiffness = k, .damping = 0.0}; });
}
TEST(HangingChain, HangsOnBushingsWithAnErrorOfOneOverK) {
  expect_springs("bushings of 1e7 to 1e9 N/m", [](double k) {
    return Bushing{.stiffness = Bushing::diagonal(Vec3::Constant(k), Vec3::Zero()), .damping = Bushing::Matrix::Zero()};
  });
}

}  // namespace catenary_test
}  // namespace polybody
