// Body on a bushing compared with closed forms (J3).
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/bushing.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/problem_size.hpp>
#include <polybody/solvers/dense_lu.hpp>
#include <polybody/statics/equilibrium.hpp>
#include <polybody/statics/preloads.hpp>
#include <polybody/vibration/modes.hpp>

#include <gtest/gtest.h>

#include "support/held.hpp"

using namespace polybody;

namespace bushing_mount_test {

using Matrix = Bushing::Matrix;
Matrix const none = Matrix::Zero();

using Mount = Joint<Weld, Bushing>;
using Sprung = Joint<RelativeCoordinates, Bushing>;

/// Nonlinear force law f = 1000 u + 1e6 u³.
struct Hardening {
  template <class T>
  T operator()(T const& u, T const&) const {
    return u * 1000.0 + u * u * u * 1e6;
  }
};
using Rubber = NonlinearBushing<Hardening, TabulatedLaw, TabulatedLaw, LinearLaw, LinearLaw, LinearLaw>;

/// One rigid body on one joint to the ground, with a force and a moment.
struct Mounted {
  Model<Bodies<Rigid<>>, Joints<Mount, Sprung, Joint<Weld, Rubber>>, Forces<PointForce<>, PointMoment<>>> model;
  static constexpr double mass = 2.0;
  inline static Vec3 const inertia{0.3, 0.4, 0.6};
  BodyHandle<Rigid<>> body = model.add(Rigid<>(mass, inertia.asDiagonal().toDenseMatrix()), "body");

  template <class J>
  explicit Mounted(J const& joint, Vec3 const& at = Vec3::Zero(), Vec3 const& on_ground = Vec3::Zero()) {
    model.connect(joint, model.ground().at(on_ground), body.at(at), "mount");
  }
  void load(Vec3 const& force, Vec3 const& at, Vec3 const& moment = Vec3::Zero()) {
    model.apply(PointForce<>{.force = force}, body.at(at), "force");
    model.apply(PointMoment<>{.moment = moment}, body.at(at), "moment");
  }
  State at_rest() const {
    State x = model.reference_state();
    equilibrium<DenseLu>(model, x);
    return x;
  }
  Frame<> moved(State const& x) const { return frame(model, x, body.at(Vec3(0, 0, 0))); }
  VecX frequencies() const { return modes(model, model.reference_state()).frequency; }
};

Vec3 const k{1000.0, 2000.0, 4000.0}, k_turn{50.0, 70.0, 90.0};
Bushing const diagonal{.stiffness = Bushing::diagonal(k, k_turn), .damping = none};

Claim mount(char const* what, char const* source) {
  return {"J3", what, By::closed_form, source, "Rigid on a bushing"};
}

// Static deflections (J3, closed form): u = F/k and θ = M/k_θ along and about each axis. About one axis the moment
// may have any size.
TEST(BushingMount, GivesWayAsTheLoadOverTheStiffness) {
  for (int i = 0; i < 3; ++i)
    for (double const size : {1.0, 60.0}) {
      Mounted m{Mount{{}, diagonal}};
      m.load(Vec3(10.0, -20.0, 30.0), {0, 0, 0}, Vec3::Unit(i) * size);
      State const x = m.at_rest();
      Frame<> const f = m.moved(x);
      Instance const at{"axis " + std::to_string(i) + equals(", M", size), 1.0};
      held_within(mount("place under force and moment [m]", "F/k"),
                  (f.r - Vec3(10.0, -20.0, 30.0).cwiseQuotient(k)).norm(), 1e-12, {at.at, 0.015});
      held_within(mount("turn under force and moment", "exp M/k_θ"),
                  (f.A - exp_so3<double>(Vec3::Unit(i) * size / k_turn[i])).norm(), 1e-12, at);
    }
}

// Natural frequencies (J3, closed form): ω = √(k/m) and √(k_θ/I).
TEST(BushingMount, SwingsWithItsSixFrequencies) {
  Mounted const m{Mount{{}, diagonal}};
  VecX expected(6);
  expected << (k / m.mass).cwiseSqrt(), k_turn.cwiseQuotient(m.inertia).cwiseSqrt();
  std::sort(expected.begin(), expected.end());
  VecX const found = m.frequencies();
  ASSERT_EQ(found.size(), 6);
  for (Index i = 0; i < 6; ++i)
    held(mount("frequencies [rad/s]", "√(k/m), √(k_θ/I)"), found[i], expected[i], 1e-12 * expected.norm(),
         {equals("mode", double(i + 1))});
}

// Force with a moment arm (J3, closed form): θ = F a/k_θ and u = F/k + a θ. For large rotations, with a dead load at
// the end of a rotating arm: k_θ θ = F a cos θ, u = F/k + a sin θ.
TEST(BushingMount, GivesWayUnderALever) {
  double const a = 0.7;
  for (double const force : {1e-3, 1.0, 80.0}) {
    Mounted m{Mount{{}, diagonal}};
    m.load({0, force, 0}, {a, 0, 0});
    double theta = 0.0;
    for (int i = 0; i < 200; ++i) theta = force * a * std::cos(theta) / k_turn[2];  // contracts by F a/k_θ < 1
    Vec3 const tip = position(m.model, m.at_rest(), m.body.at(Vec3(a, 0, 0)));
    held(mount("deflection under a lever [m]", "F/k + a sin θ, k_θ θ = F a cos θ"), tip[1],
         force / k[1] + a * std::sin(theta), 1e-12, {equals("F", force)});
    held(mount("reach of a lever [m]", "a cos θ, k_θ θ = F a cos θ"), tip[0], a * std::cos(theta), 1e-12,
         {equals("F", force)});
    double const linear = force * a / k_turn[2];
    if (force == 1e-3) {
      held(mount("deflection under a lever and a small force [m]", "F/k + a θ, θ = F a/k_θ"), tip[1],
           force / k[1] + a * linear, 1e-9 * linear);
    }
  }
}

// Moment arm within the bushing: its marker is at the point of the force. With u_c = u − a θ the energy ½ k
// u_c² + ½ k_θ θ² has the coupling −k a. The force acts along the coordinate u alone, so θ = F a/k_θ and u = F/k + a
// θ hold for every size.
TEST(BushingMount, CouplesForceAndTurn) {
  double const a = 0.7;
  Matrix coupled = diagonal.stiffness;
  coupled(5, 5) += k[1] * a * a;
  coupled(1, 5) = coupled(5, 1) = -k[1] * a;
  for (double const force : {1e-3, 1.0, 40.0}) {
    Mounted m{Mount{{}, {.stiffness = coupled, .damping = none}}};
    m.load({0, force, 0}, {0, 0, 0});
    Frame<> const f = m.moved(m.at_rest());
    double const theta = force * a / k_turn[2];
    held_within(mount("place under a force that turns, too [m]", "F/k + a θ, θ = F a/k_θ"),
                (f.r - Vec3(0, force / k[1] + a * theta, 0)).norm(), 1e-12, {equals("F", force), force / k[1]});
    held_within(mount("turn under a force that turns, too", "exp θ, θ = F a/k_θ"),
                (f.A - exp_so3<double>(Vec3(0, 0, theta))).norm(), 1e-12, {equals("F", force), 1.0});
  }
}

// Spring about the axis that a Revolute leaves free: ω = √(k_θ/I) about it. The spring works up to half a revolution.
TEST(BushingMount, MayHoldTheFreeDirectionToo) {
  Bushing const spring{.stiffness = Bushing::diagonal({1e8, 1e8, 1e8}, {1e8, 1e8, 12.0}), .damping = none};
  Mounted sprung{Sprung{{.axis = Vec3::UnitX()}, spring}};
  held(mount("frequency about a spring [rad/s]", "√(k_θ/I)"), sprung.frequencies()[0], std::sqrt(12.0 / 0.3), 1e-7);
  sprung.load({0, 0, 0}, {0, 0, 0}, {30.0, 0, 0});
  held_within(mount("turn under force and moment", "exp M/k_θ, M/k_θ = 2.5"),
              (sprung.moved(sprung.at_rest()).A - exp_so3<double>(Vec3(2.5, 0, 0))).norm(), 1e-9, {.scale = 1.0});
}

// Nonlinear force laws: u with f(u) = F, and tables at their points.
TEST(BushingMount, FollowsItsLaws) {
  TabulatedLaw const stop{MonotoneTable{{{-0.02, -400.0}, {-0.01, -20.0}, {0.0, 0.0}, {0.01, 20.0}, {0.02, 400.0}}},
                          0.0};
  LinearLaw const turn{.stiffness = 50.0, .damping = 0.0};
  Mounted m{Joint<Weld, Rubber>{{}, Rubber{Hardening{}, stop, stop, turn, turn, turn}}};
  m.load({50.0 + 125.0, 20.0, -400.0}, {0, 0, 0});  // f(0.05)
  held_within({"J3", "place under nonlinear laws [m]", By::closed_form, "f(u) = F, and points of tables",
               "Rigid on a nonlinear bushing"},
              (m.moved(m.at_rest()).r - Vec3(0.05, 0.01, -0.02)).norm(), 1e-12, {.scale = 0.05});
}

TEST(BushingMount, AddsNoRows) {
  Mounted const m{Mount{{}, diagonal}};
  ProblemSize const c = problem_size(m.model);
  EXPECT_EQ(c.rows, 0);
  EXPECT_EQ(c.degrees_of_freedom, 6);
  static_assert(!decltype(m.model)::may_have_rows);
}

// Preloads of markers at the distance d in the reference state. The force on the body is K d, and zero if the markers
// coincide.
TEST(Preloads, AreWhatTheReferenceStateStores) {
  Vec3 const d(0.001, -0.002, 0.003);
  Mounted const tight{Mount{{}, diagonal}}, apart{Mount{{}, diagonal}, Vec3(0.1, 0.2, 0.3), Vec3(0.1, 0.2, 0.3) - d};
  ASSERT_EQ(preloads(tight.model).size(), 1u);
  EXPECT_EQ(preloads(tight.model)[0].wrench.f.norm() + preloads(tight.model)[0].wrench.m.norm(), 0.0);
  Preload const p = preloads(apart.model)[0];
  EXPECT_EQ(p.joint, "mount");
  EXPECT_LT((p.wrench.f + k.cwiseProduct(d)).norm(), 1e-12);
  EXPECT_LT(p.wrench.m.norm(), 1e-12);
  EXPECT_NEAR(energy(apart.model, apart.model.reference_state()).joints, 0.5 * d.dot(k.cwiseProduct(d)), 1e-15);
}

// In the plane: the force on the body is K d, with its moment about the centre of mass. The pin leaves the rotation
// free.
TEST(BushingMount, HoldsAPlanarPinToo) {
  using Pin = Joint<planar::Revolute, Bushing>;
  Model<Bodies<planar::Rigid>, Joints<Pin>> model;
  auto const body = model.add(planar::Rigid(1.0, 1.0, {}), "body");
  auto const pin = model.connect(Pin{{}, diagonal}, model.ground().at({0.3, 0.1, 0}), body.at(Vec2(0.3, 0.1)), "pin");
  State x = model.reference_state();
  x.q[0] = 0.01;
  x.q[1] = -0.02;
  System system(model);
  system.evaluate(x.q, x.v, x.t);
  VecX r(3);
  system.residual(x.a, x.lambda, r);
  double const fx = -k[0] * 0.01, fy = k[1] * 0.02;
  EXPECT_LT((r + Vec3(fx, fy, 0.3 * fy - 0.1 * fx)).norm(), 1e-12);
  x = model.reference_state();
  x.q[2] = 0.5;  // rotated about the centre of mass, then moved back to the pin
  x.q.head<2>() = Vec2(0.3, 0.1) - Eigen::Rotation2Dd(0.5) * Vec2(0.3, 0.1);
  EXPECT_LT(reaction(model, x, pin).f.norm(), 1e-12);
  EXPECT_LT(reaction(model, x, pin).m.norm(), 1e-12);
}

}  // namespace bushing_mount_test
