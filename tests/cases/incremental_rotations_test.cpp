// Beam with interpolated increments compared with a beam with `RelativeRotation`. The first quantity is the remaining
// tip displacement after a closed load path [after Romero 2004]. The second is the difference in motion as steps and
// elements become finer.

#include <polybody/bodies/lrvf/incremental_interpolation.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/statics/equilibrium.hpp>

#include <numbers>

#include "support/spatial_lrvf.hpp"

using namespace polybody;

namespace incremental_rotations_test {

double const pi = std::numbers::pi, length = 1.3;

struct Wave {
  double (*factor)(double t);
  Motion operator()(double t) const { return {factor(t), 0.0, 0.0}; }
};
using Clamp = Joint<Weld, Constraint>;
/// Model type for both bodies, which is compiled once.
using Beams = Model<Bodies<Lrvf<RelativeRotation>, Lrvf<Incremental>>, Joints<Clamp>, Forces<PointMoment<Wave>>>;

Bar bar() {
  Bar b = spatial_lrvf_bar();
  b.placement = {};
  b.damping = {};
  return b;
}

template <class B>
struct Beam {
  Beams model;
  BodyHandle<B> body;
  State x;

  explicit Beam(Index elements) : body(model.add(B::from(bar(), elements), "beam")) {}
  void load(Vec3 const& moment, double s, double (*factor)(double)) {
    model.apply(PointMoment<Wave>{.moment = moment, .law = {factor}}, body.at(s));
  }
  Vec3 tip() const { return position(model, x, body.at(length)); }
  double total_energy() const { return energy(model, x).total(); }
};

/// Displacement of the tip and strain energy after a load cycle. A moment in world axes grows about y, rotates by z
/// and vanishes.
struct Left {
  double tip;
  Mat3 turn;
  double energy;
  double farthest;  ///< largest tip displacement during the cycle
};
template <class I>
Left after_a_round(Index elements, int steps) {
  Beam<Lrvf<I>> beam(elements);
  beam.model.connect(Clamp{}, beam.model.ground().at({0, 0, 0}), beam.body.at(0.0), "clamp");
  beam.load({0, 25, 0}, length, [](double t) { return std::sin(t); });
  beam.load({0, 0, 25}, length, [](double t) { return 1.0 - std::cos(t); });
  beam.x = beam.model.reference_state();
  Left left{};
  for (int i = 1; i <= steps; ++i) {
    beam.x.t = 2.0 * pi * i / steps;
    equilibrium(beam.model, beam.x);
    left.tip = (beam.tip() - Vec3(length, 0, 0)).norm();
    left.farthest = std::max(left.farthest, left.tip);
  }
  left.turn = frame(beam.model, beam.x, beam.body.at(length)).A;
  left.energy = energy(beam.model, beam.x).strain;
  return left;
}

// After the cycle no element is strained. The sections in the middle of the elements have rotated against their
// nodes, so the beam stays bent. Finer steps do not reduce this error. Finer elements reduce it with l²: a rotation
// across the curvature has an error of φ²/8.
TEST(IncrementalRotations, ARoundOfTheLoadLeavesTheTipOff) {
  Left const objective = after_a_round<RelativeRotation>(8, 32);
  EXPECT_GT(objective.farthest, 0.9);
  EXPECT_LT(objective.tip, 1e-13);
  Left const coarse = after_a_round<Incremental>(4, 32), middle = after_a_round<Incremental>(8, 32),
             fine = after_a_round<Incremental>(16, 32);
  EXPECT_NEAR(coarse.tip, 2.0e-2, 1e-4);  // [m]
  EXPECT_NEAR(middle.tip, 5.0e-3, 3e-5);
  EXPECT_NEAR(fine.tip, 1.24e-3, 1e-5);
  EXPECT_NEAR(coarse.tip / middle.tip, 4.0, 0.05);
  EXPECT_NEAR(middle.tip / fine.tip, 4.0, 0.05);
  EXPECT_NEAR((middle.turn - Mat3::Identity()).norm() / std::sqrt(2.0), 5.2e-3, 5e-5);
  for (Left const& left : {coarse, middle, fine}) EXPECT_LT(left.energy, 1e-20);

  // each Newton correction is an increment, so the number of corrections also has an influence
  double const few = after_a_round<Incremental>(8, 16).tip, many = after_a_round<Incremental>(8, 64).tip;
  EXPECT_NEAR(few, many, 0.01 * many);
  EXPECT_GT(std::abs(few - many), 1e-3 * many);
}

/// Moment on both ends of a free beam for 0.35 s, which bends and twists it about all axes.
double pulse(double t) { return t < 0.0 || t > 0.25 ? 0.0 : std::pow(std::sin(4.0 * pi * t), 2); }
struct Flight {
  Vec3 tip;      ///< [m]
  double drift;  ///< relative energy drift after the loads
};
template <class I, class Integrator>
Flight flown(Index elements, double h, Integrator const& integrator) {
  Beam<Lrvf<I>> beam(elements);
  beam.load({0, 20, 0}, length, pulse);
  beam.load({10, 0, 15}, 0.0, [](double t) { return pulse(t - 0.1); });
  beam.x = beam.model.reference_state();
  simulate(beam.model, beam.x, integrator, {.end_time = 0.35, .step = h}).run();
  double const before = beam.total_energy();
  simulate(beam.model, beam.x, integrator, {.end_time = 1.0, .step = h}).run();
  return {beam.tip(), beam.total_energy() / before - 1.0};
}

GeneralisedAlpha const conserving{.rho_inf = 1.0};

// The difference to `RelativeRotation` is not due to the steps. It remains while both converge. It is the difference
// between two elements, and small compared with the effect of finer elements.
TEST(IncrementalRotations, InMotionItConvergesBesideObjective) {
  auto const off = [](Index elements, double h) {
    return (flown<Incremental>(elements, h, conserving).tip - flown<RelativeRotation>(elements, h, conserving).tip)
        .norm();
  };
  Vec3 const a = flown<Incremental>(4, 1e-3, conserving).tip, b = flown<Incremental>(4, 5e-4, conserving).tip,
             c = flown<Incremental>(4, 2.5e-4, conserving).tip;
  EXPECT_NEAR((a - b).norm() / (b - c).norm(), 4.0, 0.3);
  EXPECT_NEAR(off(4, 2.5e-4), 6.4e-5, 1e-6);
  EXPECT_NEAR(off(4, 5e-4) / off(4, 2.5e-4), 1.0, 0.02);
  EXPECT_NEAR(off(16, 5e-4), 1.26e-5, 2e-7);
  double const by_mesh =
      (flown<RelativeRotation>(4, 5e-4, conserving).tip - flown<RelativeRotation>(8, 5e-4, conserving).tip).norm();
  EXPECT_LT(off(4, 5e-4), 0.01 * by_mesh);
}

// Forces are gradients of the energy along the rotations of the nodes. The energy is conserved to the order with
// which a step follows these rotations. The error of the interpolation is of order two. It is hidden in the error of
// `GeneralisedAlpha`. `RungeKutta4` loses its fourth order.
TEST(IncrementalRotations, EnergyStaysToTheSecondOrder) {
  auto const ratio = [](auto const* policy, double h, auto const& integrator) {
    using I = std::remove_cvref_t<decltype(*policy)>;
    return flown<I>(4, h, integrator).drift / flown<I>(4, 0.5 * h, integrator).drift;
  };
  Incremental const* const increments = nullptr;
  RelativeRotation const* const objective = nullptr;
  EXPECT_NEAR(ratio(increments, 1e-3, conserving), 4.0, 0.1);
  EXPECT_NEAR(flown<Incremental>(4, 5e-4, conserving).drift / flown<RelativeRotation>(4, 5e-4, conserving).drift, 1.0,
              0.01);
  RungeKutta4<Projection> const fourth{};
  EXPECT_NEAR(ratio(increments, 5e-4, fourth), 4.0, 0.2);
  EXPECT_GT(ratio(objective, 5e-4, fourth), 15.0);
}

// About one axis the increments add up, and they do so in a run.
TEST(IncrementalRotations, InThePlaneTheRunIsThatOfObjective) {
  auto const tip = [](auto const* policy) {
    using I = std::remove_cvref_t<decltype(*policy)>;
    Beam<Lrvf<I>> beam(4);
    beam.load({0, 0, 30}, length, pulse);
    beam.x = beam.model.reference_state();
    simulate(beam.model, beam.x, conserving, {.end_time = 0.5, .step = 1e-3}).run();
    return beam.tip();
  };
  Incremental const* const increments = nullptr;
  RelativeRotation const* const objective = nullptr;
  EXPECT_LT((tip(increments) - tip(objective)).norm(), 1e-9);
  EXPECT_GT((tip(objective) - Vec3(length, 0, 0)).norm(), 0.1);
}

}  // namespace incremental_rotations_test
