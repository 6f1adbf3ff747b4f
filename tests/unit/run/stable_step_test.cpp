// Warning of steps that are unstable for compliant joints: at the limit of the closed form, and runs on both sides of
// it.

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/integrators/symplectic.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/bushing.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/simulate.hpp>

#include "support/held.hpp"
#include "support/refusal.hpp"

namespace polybody {
namespace stable_step_test {

using Pin = Joint<planar::Revolute, Penalty>;

/// Body of 2 kg and 0.1 kg m² on a compliant pin 0.3 m from its mass centre. Across, ω² = k s and d = c s with s =
/// 1/m + r²/J = 0.5 + 0.9. Along, s = 1/m.
struct Pinned {
  static constexpr double s = 0.5 + 0.3 * 0.3 / 0.1, k = 3e4;
  Model<Bodies<planar::Rigid>, Joints<Pin>> model;
  State x;
  /// \param damping ratio ζ, d = 2ζω
  explicit Pinned(double damping) {
    auto const body = model.add(planar::Rigid(2.0, 0.1), "body");
    model.connect(Pin{{}, {.stiffness = k, .damping = 2.0 * damping * std::sqrt(k / s)}},
                  model.ground().at({-0.3, 0, 0}), body.at(Vec2(-0.3, 0)), "pin");
    x = model.reference_state();
    x.v << 1e-6, 2e-6, 1e-6;
  }
};

template <class I, class M>
std::vector<std::string> warnings(I const& integrator, M const& model, State const& start, double h) {
  State x = start;
  return simulate(model, x, integrator, {.end_time = h, .step = h}).report().warnings;
}

/// Returns true if 500 steps leave the velocities below a hundred times their initial values.
template <class I, class M>
bool stays(I const& integrator, M const& model, State const& start, double h) {
  State x = start;
  double const before = x.v.norm();
  try {
    for (State const& now : simulate(model, x, integrator, {.end_time = 500 * h, .step = h}))
      if (!(now.v.norm() < 100.0 * before)) return false;
  } catch (Error const&) {
    return false;
  }
  return true;
}

/// Smallest step with a warning near `limit`, by bisection.
template <class I, class M>
double warned_from(I const& integrator, M const& model, State const& start, double limit) {
  double low = 0.9 * limit, high = 1.1 * limit;
  for (int i = 0; i < 16; ++i) {
    double const middle = 0.5 * (low + high);
    (warnings(integrator, model, start, middle).empty() ? low : high) = middle;
  }
  return 0.5 * (low + high);
}
/// Records this step. The iteration for the highest frequency converges from below, so the step is never too short.
template <class I, class M>
void held_limit(char const* what, char const* source, I const& integrator, M const& model, State const& start,
                double limit, double part, std::string const& at = {}) {
  held({"closed forms", what, By::closed_form, source, std::string(I::name)},
       warned_from(integrator, model, start, limit), limit, part * limit, {at});
}

/// `limit` is the largest stable step of the closed form: below it neither warning nor growth, above it both.
template <class I>
void expect_limit(I const& integrator, double damping, double limit) {
  Pinned const p(damping);
  EXPECT_TRUE(warnings(integrator, p.model, p.x, 0.9999 * limit).empty()) << I::name << damping;
  EXPECT_TRUE(stays(integrator, p.model, p.x, 0.9 * limit)) << I::name << damping;
  held_limit("largest stable step on a compliant pin [s]",
             damping == 0.0 ? "limit of the method over ω" : "limit of the method for 2 ζ ω", integrator, p.model, p.x,
             limit, 1e-3, equals("ζ", damping));
  auto const warned = warnings(integrator, p.model, p.x, 1.02 * limit);
  ASSERT_EQ(warned.size(), 1u) << I::name << damping;
  for (char const* part : {"\"pin\"", I::name, "k h²/m", "steps of at most"}) EXPECT_TRUE(has(warned[0], part));
  EXPECT_FALSE(stays(integrator, p.model, p.x, 1.02 * limit)) << I::name << damping;
}

double const omega = std::sqrt(Pinned::k * Pinned::s);

// ωh = 2, 2 and √8 [Hughes 2000, §9.1; Hairer, Lubich & Wanner 2006, §I.1; Hairer & Wanner 1996, §IV.2].
TEST(StableStep, OfUndampedJointsIsThatOfTheImaginaryAxis) {
  expect_limit(CentralDifference<>{}, 0.0, 2.0 / omega);
  expect_limit(SymplecticEuler{}, 0.0, 2.0 / omega);
  expect_limit(Rattle{}, 0.0, 2.0 / omega);
  expect_limit(RungeKutta4<>{}, 0.0, std::sqrt(8.0) / omega);
}

// With x₁ = −x₀, v₁ = −v₀, a₁ = −a₀ the equations of a step give ω²h² + 4dh = 4 for central differences and ω²h² +
// 2dh = 4 for symplectic Euler. With d = 2ζω these are quadratic in ωh.
TEST(StableStep, OfDampedJointsIsShorter) {
  for (double const z : {0.1, 0.7, 4.0}) {
    double const verlet = std::sqrt(16.0 * z * z + 4.0) - 4.0 * z, euler = std::sqrt(4.0 * z * z + 4.0) - 2.0 * z;
    expect_limit(CentralDifference<>{}, z, verlet / omega);
    expect_limit(Rattle{}, z, verlet / omega);
    expect_limit(SymplecticEuler{}, z, euler / omega);
  }
}

// On the negative real axis the stability limit of Runge–Kutta is 1 + z/2 + z²/6 + z³/24 = 0, z = −2.785293563405282.
// The fast root of ζ = 5/4 is 2ω.
TEST(StableStep, OfOverdampedJointsUnderRungeKuttaIsThatOfTheRealAxis) {
  double const z = -2.785293563405282;
  ASSERT_NEAR(1.0 + z / 2 + z * z / 6 + z * z * z / 24, 0.0, 1e-12);
  expect_limit(RungeKutta4<>{}, 1.25, -z / (2.0 * omega));
}

TEST(StableStep, OfIntegratorsWithoutALimitIsNotWarnedOf) {
  Pinned const p(0.0);
  EXPECT_TRUE(warnings(GeneralisedAlpha{}, p.model, p.x, 100.0 / omega).empty());
  EXPECT_TRUE(warnings(DormandPrince<>{}, p.model, p.x, 100.0 / omega).empty());
}

// A slide along y prevents the rotation of the body: ω² = k/m.
TEST(StableStep, KnowsWhatRowsHold) {
  using Slide = Joint<planar::Prismatic, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Pin, Slide>> model;
  auto const body = model.add(planar::Rigid(2.0, 0.1), "body");
  model.connect(Pin{{}, {.stiffness = Pinned::k, .damping = 0.0}}, model.ground().at({-0.3, 0, 0}),
                body.at(Vec2(-0.3, 0)));
  model.connect(Slide{{.axis = Vec3::UnitY()}, {}}, model.ground().at({0, 0, 0}), body.at(Vec2(0, 0)), "slide");
  double const limit = 2.0 / std::sqrt(Pinned::k / 2.0);
  State const x = model.reference_state();
  EXPECT_TRUE(warnings(CentralDifference<Projection>{}, model, x, 0.9999 * limit).empty());
  EXPECT_EQ(warnings(CentralDifference<Projection>{}, model, x, 1.0001 * limit).size(), 1u);
  held_limit("largest stable step of a body on a slide [s]", "2/√(k/m)", CentralDifference<Projection>{}, model, x,
             limit, 1e-4);
}

// Bushings: the largest of kᵢ/m and of the rotational kᵢ/Iᵢ.
TEST(StableStep, OfABushingIsThatOfItsStiffestCoordinate) {
  using Mount = Joint<Weld, Bushing>;
  for (double const turn : {500.0, 10.0}) {
    Model<Bodies<Rigid<>>, Joints<Mount>> model;
    auto const body = model.add(Rigid<>(2.0, Vec3(0.1, 0.2, 0.3).asDiagonal().toDenseMatrix()), "body");
    model.connect(
        Mount{{}, {.stiffness = Bushing::diagonal({1e3, 2e3, 3e3}, {turn, 0, 0}), .damping = Bushing::Matrix::Zero()}},
        model.ground().at({0, 0, 0}), body.at(Vec3(0, 0, 0)), "mount");
    double const limit = 2.0 / std::sqrt(std::max(3e3 / 2.0, turn / 0.1));
    EXPECT_TRUE(warnings(CentralDifference<>{}, model, model.reference_state(), 0.9999 * limit).empty()) << turn;
    EXPECT_EQ(warnings(CentralDifference<>{}, model, model.reference_state(), 1.001 * limit).size(), 1u) << turn;
    held_limit("largest stable step on a bushing [s]", "2/√max(kᵢ/m, kᵢ/Iᵢ)", CentralDifference<>{}, model,
               model.reference_state(), limit, 1e-3, equals("k_θ", turn));
  }
}

// Eight bodies of 2 kg, each pinned to the next at the mass centres: ω² = 4 k/m sin²(jπ/16), at most j = 7. The
// iteration converges from below, to half a per cent.
TEST(StableStep, OfAChainIsThatOfItsHighestMode) {
  Model<Bodies<planar::Rigid>, Joints<Pin>> model;
  std::vector<BodyHandle<planar::Rigid>> bodies;
  for (int i = 0; i < 8; ++i) bodies.push_back(model.add(planar::Rigid(2.0, 0.1)));
  for (std::size_t i = 0; i < 7; ++i)
    model.connect(Pin{{}, {.stiffness = Pinned::k, .damping = 0.0}}, bodies[i].at(Vec2(0, 0)),
                  bodies[i + 1].at(Vec2(0, 0)));
  double const highest = 2.0 * std::sqrt(Pinned::k / 2.0) * std::sin(7.0 * std::numbers::pi / 16.0),
               limit = 2.0 / highest;
  State x = model.reference_state();
  for (Index i = 0; i < x.v.size(); ++i) x.v[i] = 1e-6 * std::sin(double(i * i));
  EXPECT_TRUE(warnings(CentralDifference<>{}, model, x, 0.9999 * limit).empty());
  EXPECT_TRUE(stays(CentralDifference<>{}, model, x, 0.9 * limit));
  EXPECT_EQ(warnings(CentralDifference<>{}, model, x, 1.005 * limit).size(), 1u);
  held_limit("largest stable step of eight bodies on pins [s]", "1/(√(k/m) sin(7π/16))", CentralDifference<>{}, model,
             x, limit, 5e-3);
  EXPECT_FALSE(stays(CentralDifference<>{}, model, x, 1.005 * limit));
}

TEST(StableStep, NamesTheJointThatIsTooStiff) {
  Model<Bodies<planar::Rigid>, Joints<Pin>> model;
  for (auto const& [name, k] : {std::pair{"soft", 1e3}, std::pair{"hard", 1e5}, std::pair{"medium", 1e4}}) {
    auto const body = model.add(planar::Rigid(1.0, 1.0));
    model.connect(Pin{{}, {.stiffness = k, .damping = 0.0}}, model.ground().at({0, 0, 0}), body.at(Vec2(0, 0)), name);
  }
  auto const warned = warnings(RungeKutta4<>{}, model, model.reference_state(), 0.1);
  ASSERT_EQ(warned.size(), 1u);
  EXPECT_TRUE(has(warned[0], "\"hard\""));
  EXPECT_TRUE(has(warned[0], "1000")) << warned[0];  // k h² of 1 kg
}

}  // namespace stable_step_test
}  // namespace polybody
