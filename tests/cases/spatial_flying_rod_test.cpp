// Flying rod of Simo & Vu-Quoc 1986 in a plane (D3) by spatial bodies, compared with an independent spectral beam.
// The loads are step functions, so digits converge slowly. The last digits of the table are accurate to ±1.

#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/rigid/rigid.hpp>

#include <gtest/gtest.h>

#include <polybody/forces/loads.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/held.hpp"
#include "support/solver_instances.hpp"

using namespace polybody;

namespace spatial_flying_rod_test {

using Cable = AncfCable<EngineeringStrain>;
using Pin = Joint<Revolute, Constraint>;
/// Model type for all bodies, which is compiled once.
using Sky = Model<Bodies<Lrvf<>, Cable, Rigid<>>, Joints<Pin>, Forces<PointForce<Window>, PointMoment<Window>>>;

struct Row {
  double t;
  Vec4 ends;  ///< x, y of the loaded end and of the free end
};
std::vector<Row> const stiff{{1.0, {4.9997, -0.52223, 0.42397, 7.91306}}, {2.5, {4.43007, -0.78515, 5.9453, 8.9708}},
                             {5.0, {5.6202, 4.7642, 15.4085, 4.2645}},    {7.5, {15.5415, 8.9949, 15.7557, -0.9722}},
                             {10.0, {25.4087, 4.7903, 15.6245, 4.1512}},  {15.0, {25.6097, 2.9702, 35.3646, 5.148}}};
std::vector<Row> const flexible{{1.0, {4.3268, 0.4078, 0.37024, 7.79601}}, {2.5, {4.96312, 4.4760, 3.5832, 6.11186}},
                                {5.0, {9.7838, 8.2039, 8.0742, 1.7588}},   {7.5, {16.268, -0.2834, 17.240, 8.2531}},
                                {10.0, {22.971, 6.4116, 21.3245, 3.6098}}, {15.0, {29.064, 6.6091, 33.937, 5.235}}};

/// Rod from (6, 0) to (0, 8). Bending out of the plane and torsion remain zero.
Bar rod(double EI) {
  return {.length = 10.0,
          .constants = BarConstants{.EA = 1e4,
                                    .EI = EI,
                                    .mass_per_length = 1.0,
                                    .GA = 1e4,
                                    .GJ = 300.0,
                                    .rotary_inertia = 10.0,
                                    .EI_y = 200.0},
          .placement = Placement::planar(6.0, 0.0, std::atan2(8.0, -6.0))};
}

/// A force and a moment act on the first end for 2.5 s.
template <class B>
struct Flight {
  Sky model;
  BodyHandle<B> body;
  double step;
  State x;

  Flight(Bar const& bar, Index n, double h) : body(model.add(B::from(bar, n), "rod")), step(h) {
    model.apply(PointForce<Window>{.force = {8, 0, 0}, .law = {.to = 2.5}}, body.at(0.0), "force");
  }
  template <class Marker>
  void turn(Marker const& marker) {
    model.apply(PointMoment<Window>{.moment = {0, 0, -80}, .law = {.to = 2.5}}, marker, "moment");
    x = model.reference_state();
  }
  void fly_until(double t) {
    simulate(model, x, GeneralisedAlpha{.rho_inf = 0.9}, {.end_time = t, .step = step}).run();
  }

  Vec3 end(double s) const { return position(model, x, body.at(s)); }
  /// Larger position error of the two ends [m].
  double miss(Row const& row) const {
    Vec3 const a(row.ends[0], row.ends[1], 0), b(row.ends[2], row.ends[3], 0);
    return std::max((end(0.0) - a).norm(), (end(10.0) - b).norm());
  }
  /// Centre of mass of the rod: −m x_c is its energy in a field of 1 m/s², m = 10 kg.
  Vec3 centre() const {
    Vec3 sum = Vec3::Zero();
    auto const q = coordinates_of(model, x, body);
    for (int k = 0; k < 3; ++k)
      for (Index e = 0; e < body.body().elements(); ++e)
        sum[k] -= body.body().gravity_energy(e, q, Vec3::Unit(k)) / 10.0;
    return sum;
  }
  double total_energy() const { return energy(model, x).total(); }
  Momentum total_momentum() const { return momentum(model, x); }
};

/// Closed forms of D3: the impulse 8·min(t, 2.5), and the centre of mass, 3 + 0.4 t² and then 5.5 + 2 (t − 2.5) on
/// the line y = 4.
template <class B>
void moves_as_a_full(Flight<B> const& flight, char const* formulation) {
  double const t = flight.x.t, x = t < 2.5 ? 3.0 + 0.4 * t * t : 5.5 + 2.0 * (t - 2.5);
  held_within({"D3", "momentum of the rod in space [N s]", By::closed_form, "8 N for 2.5 s", formulation},
              (flight.total_momentum().linear - Vec3(8 * std::min(t, 2.5), 0, 0)).norm(), 1e-10,
              {equals("t", t), 8 * std::min(t, 2.5)});
  held_within({"D3", "centre of mass of the rod in space [m]", By::closed_form, "integral of the impulse over the mass",
               formulation},
              (flight.centre() - Vec3(x, 4.0, 0.0)).norm(), 1e-5, {equals("t", t), 5.0});
}

/// Compares the run with the rows of the table. After the loads energy and angular momentum are constant to the order
/// of the integrator. D3 gives the energy approximately.
template <class B>
void follows(Flight<B> flight, std::vector<Row> const& rows, double tolerance, double plateau,
             char const* formulation) {
  double kept = 0.0, angular = 0.0;
  for (Row const& row : rows) {
    flight.fly_until(row.t);
    char const* const spectral = "spectral geometrically exact beam, two meshes";
    held_within({"D3", "ends of the rod in space [m]", By::independent, spectral, formulation}, flight.miss(row),
                tolerance, {equals("t", row.t), 10.0});
    moves_as_a_full(flight, formulation);
    if (row.t == 2.5) {
      kept = flight.total_energy();
      angular = flight.total_momentum().angular[2];
      held({"D3", "energy after the loads [J]", By::independent, spectral, formulation}, kept, plateau,
           0.005 * plateau);
    } else if (row.t > 2.5) {
      Instance const at{equals("t", row.t), 1.0};
      held_within({"D3", "relative change of energy after the loads", By::closed_form, "invariant", formulation},
                  std::abs(flight.total_energy() / kept - 1.0), 1e-4, at);
      held_within({"D3", "relative change of the moment of momentum after the loads", By::closed_form, "invariant",
                   formulation},
                  std::abs(flight.total_momentum().angular[2] / angular - 1.0), 2e-5, at);
    }
  }
}

template <class B>
Flight<B> thrown(double EI, Index n, double h) {
  Flight<B> flight(rod(EI), n, h);
  flight.turn(flight.body.at(0.0));
  return flight;
}

// Tolerances up to 15 s: a thousandth of the length for the stiff rod, two thousandths for the flexible rod with
// twice as many elements.
TEST(FlyingRodOfThePlane, StiffLrvfFollowsTheExactRod) {
  follows(thrown<Lrvf<>>(500, 40, 5e-3), stiff, 0.01, 90.2, "Lrvf, 40 elements, EI = 500, h = 5 ms");
}
TEST(FlyingRodOfThePlane, FlexibleLrvfFollowsTheExactRod) {
  follows(thrown<Lrvf<>>(100, 80, 2.5e-3), flexible, 0.02, 380.0, "Lrvf, 80 elements, EI = 100, h = 2.5 ms");
}

/// A cable has no rotary inertia. Here the rotary inertia is as large as the other terms: 10·10 against 10·10²/12 kg
/// m². Discs on the nodes provide it. Each disc is pinned along the tangent, so it rotates with the tangent. Its own
/// mass is negligible.
Flight<Cable> strung(double EI, Index n, double h) {
  Bar const bar = rod(EI);
  Flight<Cable> flight(bar, n, h);
  Vec3 const along = bar.placement.axes.col(0);
  for (Index i = 0; i <= n; ++i) {
    double const s = 10.0 * double(i) / double(n), share = (i == 0 || i == n ? 0.5 : 1.0) * 10.0 / double(n);
    auto const disc = flight.model.add(
        Rigid<>(1e-8, 10.0 * share * Mat3::Identity(), {bar.placement.origin + s * along, bar.placement.axes}));
    flight.model.connect(Pin{Revolute{.axis = along}, {}}, disc.at(Vec3(0, 0, 0)), flight.body.at(s));
    if (i == 0) flight.turn(disc.at(Vec3(0, 0, 0)));
  }
  flight.x = flight.model.reference_state();
  return flight;
}

// The cable also has no shear. The shear of the rod is of the order of 80 N m/(10 m GA) = 8e-4.
TEST(FlyingRodOfThePlane, CableWithDiscsFollowsTheExactRod) {
  follows(strung(500, 40, 5e-3), stiff, 0.01, 90.2, "AncfCable with discs, 40 elements, EI = 500, h = 5 ms");
}

// Without discs the cable is a different rod, half a metre or more away after one second. Its overall motion is still
// correct.
TEST(FlyingRodOfThePlane, CableAloneHasTheMotionOfItsCentreOnly) {
  Flight<Cable> flight = thrown<Cable>(500, 16, 1e-3);
  flight.fly_until(1.0);
  EXPECT_GT(flight.miss(stiff[0]), 0.5);
  char const* const alone = "AncfCable without discs, 16 elements, EI = 500, h = 1 ms";
  moves_as_a_full(flight, alone);
  flight.fly_until(3.0);
  moves_as_a_full(flight, alone);
}

}  // namespace spatial_flying_rod_test
