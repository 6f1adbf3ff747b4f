// Buckling loads as eigenvalues, against closed forms and published values.
#include <polybody/vibration/buckling.hpp>

#include <gtest/gtest.h>

#include <numbers>
#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/planar/joints.hpp>

#include "support/columns.hpp"
#include "support/refusal.hpp"

using namespace polybody;

namespace buckling_test {

using columns::Ends;
constexpr double pi = std::numbers::pi;

/// Euler's loads with EI = L = 1: π²/4, π², the root of tan √P = √P, 4π² [Timoshenko & Gere 1961, §2.1].
constexpr std::pair<Ends, double> euler[] = {{Ends::clamped_free, 0.25 * pi* pi},
                                             {Ends::pinned_pinned, pi* pi},
                                             {Ends::clamped_pinned, 20.190728556426629},
                                             {Ends::clamped_clamped, 4.0 * pi* pi}};

Bar unit_bar() {
  return {.length = 1.0,
          .constants = BarConstants{.EA = 1e6, .EI = 1.0, .mass_per_length = 1.0, .GA = 1e6, .rotary_inertia = 0.1}};
}

struct Zero {
  Motion operator()(double) const { return {}; }
};

/// Column along x in the plane under the force −1 at its second end, or under gravity g along −x.
template <class B>
struct PlanarColumn {
  using Clamp = Joint<planar::Weld, Constraint>;
  using Pin = Joint<planar::Revolute, Constraint>;
  using Slide = Joint<PrescribedTranslation<Zero>, Constraint>;
  using Guide = Joint<planar::Prismatic, Constraint>;
  Model<Bodies<B>, Joints<Clamp, Pin, Slide, Guide>, Forces<PointForce<>>> model;
  BodyHandle<B> bar;
  State x;

  PlanarColumn(Index n, Ends ends, Vec3 const& force, double gravity = 0.0, LoadAxes axes = LoadAxes::world)
      : model{Gravity{-gravity, 0, 0}}, bar(model.add(B::from(unit_bar(), n), "column")) {
    auto const foot = model.ground().at({0, 0, 0}), head = model.ground().at({1, 0, 0});
    if (ends == Ends::pinned_pinned)
      model.connect(Pin{}, foot, bar.at(0.0), "pin");
    else
      model.connect(Clamp{}, foot, bar.at(0.0), "clamp");
    if (ends == Ends::clamped_clamped)
      model.connect(Guide{{.axis = Vec3::UnitX()}, {}}, head, bar.at(1.0), "guide");
    else if (ends != Ends::clamped_free)
      model.connect(Slide{{.law = Zero{}, .axis = {0, 1, 0}}, {}}, head, bar.at(1.0), "slide");
    if (force.norm() > 0.0) model.apply(PointForce<>{.force = force, .axes = axes}, bar.at(1.0), "load");
    x = model.reference_state();
  }
};

template <class C>
void buckles_at_eulers_loads(Index elements, double tolerance, char const* formulation) {
  char const* const names[] = {"clamped–free", "pinned–pinned", "clamped–pinned", "clamped–clamped"};
  for (auto const& [ends, load] : euler) {
    double const found = columns::limit_of_meshes(
        [&, ends = ends](Index n) {
          C const column(n, ends, {-1.0, 0, 0});
          return buckling_modes(column.model, column.x).load_factor[0];
        },
        elements);
    held({"S9e", "Euler's loads as eigenvalues, P L²/EI", By::closed_form, "π²/4, π², tan √P = √P, 4π²", formulation},
         found, load, tolerance * load, {names[int(ends)]});
  }
}

TEST(BucklingModes, OfEulersColumnsInThePlane) {
  buckles_at_eulers_loads<PlanarColumn<planar::Lrvf>>(8, 3e-4, "planar::Lrvf, 8 to 32 elements extrapolated");
  buckles_at_eulers_loads<PlanarColumn<planar::AncfCable<>>>(4, 3e-4,
                                                             "planar::AncfCable, 4 to 16 elements extrapolated");
}
TEST(BucklingModes, OfEulersColumnsInSpace) {
  buckles_at_eulers_loads<columns::Column<Lrvf<>>>(6, 3e-4, "Lrvf, 6 to 24 elements extrapolated");
  buckles_at_eulers_loads<columns::Column<AncfBeam<>>>(3, 1e-3, "AncfBeam, 3 to 12 elements extrapolated");
}

// The higher modes of the pinned column are at k²π², with sines as shapes.
TEST(BucklingModes, OfThePinnedColumnAreSines) {
  PlanarColumn<planar::AncfCable<>> const column(16, Ends::pinned_pinned, {-2.0, 0, 0});
  BucklingModes const found = buckling_modes(column.model, column.x, {.count = 3});
  ASSERT_EQ(found.load_factor.size(), 3);
  for (int k = 1; k <= 3; ++k) {
    EXPECT_NEAR(found.load_factor[k - 1], 0.5 * k * k * pi * pi, 2e-3 * k * k * pi * pi);
    State x = column.x;
    x.v = found.shape.col(k - 1);
    auto const across = [&](double s) { return frame(column.model, x, column.bar.at(s)).v[1]; };
    double const amplitude = across(0.5 / k);
    for (double const s : {0.125, 0.375, 0.75})
      EXPECT_NEAR(across(s) / amplitude, std::sin(k * pi * s), 0.02) << k << ' ' << s;
  }
}

// Column under its own weight: q L³/EI = 7.8373 [Timoshenko & Gere 1961, §2.12].
TEST(BucklingModes, OfAColumnUnderItsOwnWeight) {
  double const found = columns::limit_of_meshes(
      [](Index n) {
        PlanarColumn<planar::AncfCable<>> const column(n, Ends::clamped_free, Vec3::Zero(), 2.0);
        return 2.0 * buckling_modes(column.model, column.x).load_factor[0];
      },
      4);
  EXPECT_NEAR(found, 7.83735, 2e-3);
}

// Lateral buckling of a cantilever strip under a tip force: P = 4.0126 √(EI GJ)/L², if the bending stiffness in the
// plane of the force is much larger [Timoshenko & Gere 1961, §6.3].
TEST(BucklingModes, OfACantileverStripUnderATipForce) {
  Bar bar = columns::strip();
  double const stiffness = bar.constants->EI_y.value() * double(bar.constants->GJ);
  bar.constants->EI = 100.0 * double(bar.constants->EI);
  bar.constants->GA = 100.0 * double(bar.constants->GA);
  bar.constants->EA = 100.0 * double(bar.constants->EA);
  double const found = columns::limit_of_meshes(
      [&](Index n) {
        Model<Bodies<Lrvf<>>, Joints<Joint<Weld, Constraint>>, Forces<PointForce<>>> model;
        auto const beam = model.add(Lrvf<>::from(bar, n), "strip");
        model.connect(Joint<Weld, Constraint>{}, model.ground().at({0, 0, 0}), beam.at(0.0), "clamp");
        model.apply(PointForce<>{.force = {0, 1.0, 0}}, beam.at(1.0));
        return buckling_modes(model, model.reference_state()).load_factor[0];
      },
      4);
  double const exact = 4.0126 * std::sqrt(stiffness);
  held({"S9d", "tip force at which a strip buckles, as an eigenvalue [N]", By::published,
        "Timoshenko & Gere 1961, 4.0126 √(EI GJ)/L²", "Lrvf, 4 to 16 elements extrapolated"},
       found, exact, 1e-3 * exact);
}

// Right-angle frame of Argyris, 1.088 N: from the unloaded state, and from the equilibrium under 1 N.
TEST(BucklingModes, OfTheRightAngleFrame) {
  using Frame = buckling::FlatFrame<Lrvf<>>;
  auto const factor = [](bool loaded) {
    return [=](Index n) {
      Frame const frame(n, buckling::thin_strip, 1.0);
      return buckling_modes(frame.model, loaded ? frame.x : frame.model.reference_state(),
                            {.load_factor = loaded ? 1.0 : 0.0})
          .load_factor[0];
    };
  };
  for (bool const loaded : {false, true}) {
    double const a = factor(loaded)(6), b = factor(loaded)(12), limit = (4.0 * b - a) / 3.0;
    held({"S9c", "force at which the frame buckles, as an eigenvalue [N]", By::published, "Exudyn's rightAngleFrame.py",
          "Lrvf, 6 and 12 elements a leg extrapolated"},
         limit, 1.088, loaded ? 1e-3 : 2e-3, {loaded ? "about 1 N" : "about the unloaded state"});
  }
}

// The limit of the method. Shallow truss of two bars of height h: the linearised path gives ⅔ k h³/L², the limit point
// is at 2/(3√3) k h³/L² = 0.385 k h³/L². An equilibrium near it as the base state gives a closer estimate.
TEST(BucklingModes, OverestimateTheLimitPointOfAShallowTruss) {
  double const k = 1e6, h = 0.02, l = std::hypot(1.0, h), unit = k * h * h * h / (l * l);
  auto const truss = [&](double load, State* bent) {
    Model<Bodies<planar::Rigid>, Joints<Joint<planar::Prismatic, Constraint>>, Forces<SpringDamper, PointForce<>>>
        model;
    auto const apex = model.add(planar::Rigid(1.0, 1.0, Placement::planar(0, h)), "apex");
    model.connect(Joint<planar::Prismatic, Constraint>{{.axis = {0, 1, 0}}, {}}, model.ground().at({0, h, 0}),
                  apex.centre(), "guide");
    for (double const side : {-1.0, 1.0})
      model.apply(SpringDamper{.stiffness = k, .free_length = l}, model.ground().at({side, 0, 0}), apex.centre());
    model.apply(PointForce<>{.force = {0, -load, 0}}, apex.centre());
    State x = model.reference_state();
    if (bent) equilibrium(model, x), *bent = x;
    return load * buckling_modes(model, x, {.load_factor = bent ? 1.0 : 0.0}).load_factor[0];
  };
  double const limit = 2.0 / (3.0 * std::sqrt(3.0));
  EXPECT_NEAR(truss(1.0, nullptr) / unit, 2.0 / 3.0, 1e-3);
  State bent;
  double const closer = truss(0.95 * limit * unit, &bent) / unit;
  EXPECT_GT(closer, limit);
  EXPECT_LT(closer, 1.05 * limit);
}

TEST(BucklingModes, FindNoneUnderTension) {
  PlanarColumn<planar::AncfCable<>> const column(4, Ends::clamped_free, {1.0, 0, 0});
  EXPECT_EQ(buckling_modes(column.model, column.x).load_factor.size(), 0);
}

TEST(BucklingModes, RefuseStatesAndModelsWithoutAnAnswer) {
  using Column = PlanarColumn<planar::Lrvf>;
  auto const told = [](Column const& c, BucklingOptions const& options = {}) {
    return refusal([&] { (void)buckling_modes(c.model, c.x, options); });
  };
  Column const column(2, Ends::clamped_free, {-1, 0, 0}), unloaded(2, Ends::clamped_free, {0, 0, 0}),
      follower(4, Ends::clamped_free, {-1, 0, 0}, 0.0, LoadAxes::marker);
  EXPECT_TRUE(has(told(column, {.count = 0}), "number of modes must be at least 1, but is 0"));
  EXPECT_TRUE(has(told(column, {.load_factor = 1.0}), "not an equilibrium at load factor 1"));
  EXPECT_TRUE(has(told(unloaded), "the model has no load"));
  EXPECT_TRUE(has(told(follower), "not symmetric"));
  Column moving = column;
  moving.x.v[1] = 0.1;
  EXPECT_TRUE(has(told(moving), "must be at rest"));
  Column beyond(8, Ends::clamped_free, {-3.0, 0, 0});  // above π²/4, straight
  beyond.x.q = beyond.model.reference_state().q;
  equilibrium(beyond.model, beyond.x);
  EXPECT_TRUE(has(told(beyond, {.load_factor = 1.0}), "not stable at load factor 1"));
}

}  // namespace buckling_test
