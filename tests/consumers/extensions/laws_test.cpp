// User-defined types under the law suites of polybody::testing: a case constructs the type, one line tests
// it.
#include <polybody/testing.hpp>

#include "bathe.hpp"
#include "bolt_in_slot.hpp"
#include "double_pendulum.hpp"
#include "dumbbell.hpp"
#include "hardening_penalty.hpp"
#include "lennard_jones.hpp"
#include "point_on_parabola.hpp"

namespace own {
namespace {

using namespace polybody::laws;

struct DumbbellCase {
  static Dumbbell made(double damping, Vec3 const& r_1 = {0.3, -0.2, 0.5}, Vec3 const& r_2 = {0.9, 0.4, 1.1}) {
    return Dumbbell({.mass_1 = 2.0, .mass_2 = 1.0, .stiffness = 40.0, .damping = damping, .r_1 = r_1, .r_2 = r_2});
  }
  static Dumbbell body() { return made(3.0); }
  static Dumbbell undamped() { return made(0.0); }
  static Dumbbell elsewhere() { return made(3.0, {-7.0, 3.0, 5.0}, {-7.6, 3.6, 5.6}); }  // same length, rotated
  static std::vector<Dumbbell::Point> points() { return {{0}, {1}}; }
  static double mass() { return 3.0; }
  static Vec3 centre() { return {0.5, 0.0, 0.7}; }
  static constexpr double stiffness = 40.0;
};
bool const dumbbell_obeys = obeys<DumbbellCase, BodyLaws, FlexibleBodyLaws>("Dumbbell");

struct BoltInSlotCase {
  static constexpr bool planar = false;
  static constexpr int world_rows = 0;
  static BoltInSlot geometry() { return {.slot = Vec3(1, 0, 0), .axis = Vec3(0, 0, 1)}; }
  static Mate mate(Numbers& number, double) {
    Mate mate{
        .d = {number(), 0, 0}, .R = exp_so3<double>(Vec3(0, 0, number(3.0))), .free_directions = MatX::Zero(6, 2)};
    mate.free_directions(0, 0) = 1.0;  // along the slot
    mate.free_directions(5, 1) = 1.0;  // about the bolt
    return mate;
  }
};
bool const bolt_obeys = obeys<BoltInSlotCase, JointLaws>("BoltInSlot");

struct PointOnParabolaCase {
  static constexpr bool planar = false;
  static constexpr int world_rows = 0;
  static PointOnParabola geometry() { return {.focal_length = 0.6}; }
  static Mate mate(Numbers& number, double) {
    double const x = number();
    Mate mate{
        .d = {x, 0.0, x * x / 2.4}, .R = exp_so3<double>(number.vec<3>(3.0)), .free_directions = MatX::Zero(6, 4)};
    mate.free_directions.col(0) << 1.0, 0.0, x / 1.2, 0.0, 0.0, 0.0;  // along the wire
    mate.free_directions.bottomRightCorner<3, 3>().setIdentity();     // rotations
    return mate;
  }
};
bool const point_on_parabola_obeys = obeys<PointOnParabolaCase, JointLaws>("PointOnParabola");

struct HardeningPenaltyCase {
  static constexpr int rows = 3;
  static constexpr double violation = 0.1;
  static HardeningPenalty policy() { return {.stiffness = 30.0, .hardening = 4e3, .damping = 2.0}; }
};
bool const hardening_penalty_obeys = obeys<HardeningPenaltyCase, PolicyLaws>("HardeningPenalty");

struct LennardJonesCase {
  static LennardJones force() { return {.depth = 2.0, .diameter = 0.9}; }
  static std::array<Frame<double>, 2> frames(Numbers& number) {  // 0.9 to 1.4 m apart
    std::array<Frame<double>, 2> f{number.frame(), number.frame()};
    f[1].r = f[0].r + (1.15 + number(0.25)) * number.vec<3>().normalized();
    return f;
  }
};
bool const lennard_jones_obeys = obeys<LennardJonesCase, ForceLaws>("LennardJones");

struct DoublePendulumCase {
  static DoublePendulum equations() {
    return {.mass_1 = 2.0, .mass_2 = 1.0, .length_1 = 0.8, .length_2 = 0.5, .g = 9.81};
  }
};
bool const double_pendulum_obeys = obeys<DoublePendulumCase, UserSystemLaws>("DoublePendulum");

/// A heavy top on the user-defined joint: constraint equations, rotations, a conservative model.
struct TopOnTheWire {
  using Wire = Joint<PointOnParabola, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Wire>> model{Gravity{0, 0, -9.81}};
  State start;

  TopOnTheWire() {
    auto const top = model.add(
        Rigid<>(1.0, Vec3(0.02, 0.01, 0.03).asDiagonal().toDenseMatrix(), Placement::at({0.5, 0.1, 0.325})), "top");
    model.connect(Wire{{.focal_length = 0.5}, {}}, model.ground().at({0, 0, 0}), top.at(Vec3(0.0, -0.1, -0.2)), "wire");
    start = model.reference_state();
    // ω × (r − r_p) about the point on the wire, which is at rest
    model.set_velocity(start, top, -Vec3(1, 2, 5).cross(Vec3(0.5, 0.0, 0.125)), Vec3(1, 2, 5));
  }
};
struct BatheOnTheWire {
  using Model = TopOnTheWire;
  static auto integrators() { return std::vector<Bathe>(1); }
  static constexpr double end_time = 0.5;
  static constexpr int steps = 64;
};
bool const bathe_obeys = obeys<BatheOnTheWire, IntegratorLaws>("BatheOnTheWire");

}  // namespace
}  // namespace own
