// Strain of a track link: decoupled after a run of rigid links, and in runs of flexible links of every formulation
// (Wallin 2016, Chapter 4).
#include <gtest/gtest.h>
#include <unistd.h>

#include <polybody/bodies/shared/family.hpp>
#include <polybody/run/body_record.hpp>
#include <polybody/run/energy_audit.hpp>
#include <polybody/se3_beam.hpp>
#include <polybody/signals/filter.hpp>
#include <polybody/signals/samples.hpp>

#include "m113/decoupled_link_strain.hpp"
#include "m113/modal_links.hpp"
#include "support/held.hpp"
#include "support/refusal.hpp"
#include "support/resumed_run.hpp"
#include "support/vehicle_runs.hpp"

using namespace polybody;

namespace track_stress_test {

// True for links without deformations.
template <class Link>
inline constexpr bool is_rigid = formulation_family<Link> == families::rigid;

GeneralisedAlpha integrator() { return {.rho_inf = 0.5, .tolerance = 1e-5}; }

/// Loads and strains of the watched link of the left track.
struct Ride {
  std::vector<double> times, strain, bending;
  std::vector<double> pull;                            ///< half of the force of the tensioner's spring [N]
  Vec3 place = Vec3::Zero(), velocity = Vec3::Zero();  ///< position and velocity of the hull at the end
  double unaccounted = 0.0;
  long halved = 0;
  bool seated = true;

  std::vector<double> filtered(double cut_off = 15.0) const {
    return low_pass(times, strain, {.cut_off = cut_off, .mirrored = true});
  }
};

m113::VehicleOptions options(bool held = false, int elements = 0) {
  m113::VehicleOptions o{.masses = m113::with_steel_links(), .link_elements = elements, .held = held};
  o.start = track_at_rest();
  return o;
}

template <class Link, class Pin>
Ride ride(Ramp const& drive, double end_time, double step, bool held = false, int elements = 0) {
  m113::Vehicle<Link, Pin> const vehicle(Pin{}, {drive, drive}, options(held, elements));
  auto const& side = vehicle.side(m113::Side::left);
  auto const& link = side.links[20];
  State x = vehicle.model.reference_state();
  Ride r;
  EnergyAudit audit(vehicle.model);
  std::optional<LoadRecorder> recorder;
  if constexpr (is_rigid<Link>) {
    recorder.emplace(vehicle.model);
    recorder->add(link);
  }
  auto const look = [&] {
    r.times.push_back(x.t);
    audit.record(x);
    if constexpr (is_rigid<Link>) {
      recorder->record(x);
    } else {
      r.strain.push_back(m113::link_strain(link, x));
      r.bending.push_back(m113::link_bending(link, x, hull_of(vehicle, x).A.col(1)));
    }
    double const travel = (hull_of(vehicle, x).A.transpose() *
                           (position(vehicle.model, x, side.idler[0].at(Vec3(0, 0, 0))) - hull_of(vehicle, x).r))
                              .x() +
                          m113::chassis.x - m113::idler_reference_x;
    r.pull.push_back(0.5 * (m113::preload + m113::tensioner.stiffness * travel));
  };
  auto run = simulate(vehicle.model, x, integrator(), {.end_time = end_time, .step = step, .max_step_halvings = 6});
  look();
  while (!run.done()) {
    run.advance();
    look();
  }
  if constexpr (is_rigid<Link>) {
    auto const stress = DecoupledStress::quasi_static(m113::link_structure(), recorder->of(link));
    r.strain = m113::link_strain(stress);
    r.bending = m113::link_bending(stress);
  }
  r.place = hull_of(vehicle, x).r;
  r.velocity = hull_of(vehicle, x).v;
  r.unaccounted = audit.relative();
  r.halved = run.report().rejected;
  for (m113::Side const s : {m113::Side::left, m113::Side::right})
    r.seated = r.seated && teeth_engaged(vehicle, x, s).holds();
  return r;
}

/// Root mean square of the difference of filtered strains, relative to that of b, after the first tenth of a second.
double off(Ride const& a, Ride const& b) {
  std::vector<double> const x = a.filtered(), y = b.filtered();
  RmsDifference d(0.1, b.times.back());
  d.add({a.times, x}, {b.times, y});
  return d.value();
}

Ramp setting_out() { return {.target = 8.0, .duration = 0.6, .start = 0.1, .rounding = 0.1}; }

// Steel links at h = 1 ms. EA/p is five thousand times as stiff as a contact. Hence a link has the same tension in
// every formulation, and its strain is the tension over EA. The tolerance is 10 % between decoupled and ANCF, and 5 %
// between coupled floating frames and ANCF. Wallin 2016, Chapter 4, reports factors of 2 and 3.
TEST(TrackStress, IsTheSameDecoupledAndCoupledInEveryFormulation) {
  double const end_time = 0.8;
  Ride const cable = ride<AncfCable<>, AncfLinear>(setting_out(), end_time, 1e-3);
  double most = 0.0;
  for (double const e : cable.filtered()) most = std::max(most, std::abs(e));
  EXPECT_GT(most, 1e-6);  // 3 kN and more
  EXPECT_LT(cable.unaccounted, 0.01);
  EXPECT_TRUE(cable.seated);
  auto const alike = [&](Ride const& other, double within, char const* name) {
    auto const apart = [&](char const* what, double difference, double tolerance, double scale) {
      held_within({"thesis §4.4", what, By::itself, "AncfCable, AncfLinear", name}, difference, tolerance,
                  {.scale = scale});
    };
    apart("filtered strain of a link in 0.8 s, root mean square, of it", off(other, cable), within, 1.0);
    apart("place of the hull after 0.8 s [m]", (other.place - cable.place).norm(), 3e-3, 0.5);
    apart("velocity of the hull after 0.8 s [m/s]", (other.velocity - cable.velocity).norm(), 0.02,
          cable.velocity.norm());
    EXPECT_LT(other.unaccounted, 0.01) << name;
    EXPECT_TRUE(other.seated) << name;
    EXPECT_LE(other.halved, 2) << name;
  };
  alike(ride<Rigid<>, Constraint>(setting_out(), end_time, 1e-3), 0.1, "rigid, decoupled");
  alike(ride<Ffr, Constraint>(setting_out(), end_time, 1e-3), 0.05, "FFR");
  alike(ride<Lrvf<>, Constraint>(setting_out(), end_time, 1e-3), 0.05, "LRVF");
  alike(ride<Se3Beam, Constraint>(setting_out(), end_time, 1e-3), 0.05, "SE(3) beam");
  alike(ride<AncfBeam<ElasticLine>, AncfLinear>(setting_out(), end_time, 1e-3), 0.05, "ANCF beam, elastic line");
  alike(ride<AncfBeam<Continuum<>>, AncfLinear>(setting_out(), end_time, 1e-3), 0.05, "ANCF beam, continuum");
  held_within({"thesis §4.4", "filtered strain of a link in 0.8 s, root mean square, of it", By::itself,
               "AncfCable, AncfLinear", "AncfCable, h = 0.5 ms"},
              off(ride<AncfCable<>, AncfLinear>(setting_out(), end_time, 0.5e-3), cable), 0.05, {.scale = 1.0});
}

// A wheel that rolls over a link bends it, by −3 and 3 MPa here. One cubic element has a linear curvature and gives
// half of the moment of a force in its middle. Two elements have a node there and give the moment of the decoupled
// analysis (bending modes begin at 3.8 kHz). The remaining differences are jumps as the wheel enters and leaves the
// link, in different steps.
TEST(TrackStress, TwoElementsBendAsTheDecoupledAnalysisSays) {
  double const end_time = 0.8;
  Ride const rigid = ride<Rigid<>, Constraint>(setting_out(), end_time, 1e-3);
  auto const apart = [&](Ride const& coupled) {
    RmsDifference d(0.1, end_time);
    d.add({coupled.times, coupled.bending}, {rigid.times, rigid.bending});
    return d.value();
  };
  EXPECT_GT(*std::max_element(rigid.bending.begin(), rigid.bending.end()) * m113::youngs_modulus, 2e6);
  EXPECT_LT(apart(ride<AncfCable<>, AncfLinear>(setting_out(), end_time, 1e-3, false, 2)), 0.2);
  EXPECT_GT(apart(ride<AncfCable<>, AncfLinear>(setting_out(), end_time, 1e-3)), 0.5);
}

TEST(TrackStress, RefusesANegativeNumberOfElements) {
  using Track = m113::Vehicle<AncfCable<>, AncfLinear>;
  EXPECT_TRUE(has(refusal([] { Track(AncfLinear{}, {setting_out(), setting_out()}, options(false, -1)); }),
                  "must not be negative, but is -1"));
}

// Tracks that run around a fixed vehicle without driving resistance. The tensioner applies T₀ to either run, and the
// chain carries m v²/p in addition. The mean strain over one revolution of a link is (T₀ + m v²/p)/EA. The runs leave
// the idler at up to 15° from its guide (2 % of T₀).
TEST(TrackStress, FollowsTensionOverEA) {
  for (auto const& [speed, tolerance] : {std::pair(30.0, 0.06), {80.0, 0.025}}) {
    Ramp const drive{.target = speed, .duration = 0.6, .start = 0.05, .rounding = 0.1};
    double const v = speed * m113::rolling_radius, loop = m113::links * m113::pitch / v, end_time = 0.9 + loop;
    auto const follows = [&](Ride const& r, char const* name) {
      double strain = 0.0, pull = 0.0, count = 0.0;
      for (std::size_t i = 0; i < r.times.size(); ++i) {
        if (r.times[i] < end_time - loop) continue;
        strain += r.strain[i];
        pull += r.pull[i];
        ++count;
      }
      double const expected = m113::running_strain(v, pull / count);
      held({"thesis §4.4", "mean strain of a link that goes round, of (T₀ + m v²/p)/EA", By::closed_form, "1", name},
           strain / count / expected, 1.0, tolerance, {equals("speed", speed)});
    };
    follows(ride<Rigid<>, Constraint>(drive, end_time, 1e-3, true), "rigid, decoupled");
    follows(ride<AncfCable<>, AncfLinear>(drive, end_time, 1e-3, true), "ANCF");
  }
}

/// 130 steps, a checkpoint, and 30 further steps; the latter again from the file.
template <class Link, class Pin>
void restarts_with_the_same_bits(char const* name) {
  m113::Vehicle<Link, Pin> const vehicle(Pin{}, {setting_out(), setting_out()}, options());
  RunOptions run_options{.end_time = 0.16, .step = 1e-3, .max_step_halvings = 6};
  for (m113::Side const s : {m113::Side::left, m113::Side::right})
    run_options.events.push_back(m113::derailed(vehicle, s));
  auto const file =
      std::filesystem::path(testing::TempDir()) / ("polybody track " + std::to_string(::getpid()) + ".checkpoint");
  State x = vehicle.model.reference_state(), y;
  auto whole = simulate(vehicle.model, x, integrator(), run_options);
  while (!whole.done()) {
    whole.advance();
    if (whole.report().steps == 130) write_checkpoint(file, whole.snapshot());
  }
  auto rest = resume(vehicle.model, y, integrator(), run_options, read_checkpoint(file));
  EXPECT_EQ(rest.report().steps, 130);
  while (!rest.done()) rest.advance();
  std::filesystem::remove(file);
  EXPECT_EQ(bits(x), bits(y)) << name;
  expect_same(whole.report(), rest.report());
}
TEST(TrackStress, RunsTakenUpFromACheckpointEndInTheSameBits) {
  restarts_with_the_same_bits<Rigid<>, Constraint>("rigid");
  restarts_with_the_same_bits<AncfCable<>, AncfLinear>("ANCF");
  restarts_with_the_same_bits<Ffr, Constraint>("FFR");
}

TEST(TrackStress, FlexibleLinksHaveTheMassAndInertiaOfTheirSteel) {
  m113::Solid const steel = m113::with_steel_links().link;
  EXPECT_NEAR(steel.mass, m113::wallin_2016.link.mass, 1e-9 * steel.mass);
  Structure const s = m113::link_structure();
  EXPECT_NEAR(s.mass, steel.mass, 1e-9 * steel.mass);
  Vec3 const centre = s.first / s.mass;
  Mat3 const second = s.second - s.mass * centre * centre.transpose();
  Mat3 const inertia = second.trace() * Mat3::Identity() - second;
  EXPECT_LT((Vec3(inertia.diagonal()) - Vec3(steel.inertia)).norm(), 1e-9 * inertia.norm());
}

}  // namespace track_stress_test
