// Chordal action (C6, closed form): a chain of pitch p on a sprocket of N teeth is a polygon, so the velocity of its
// strand varies.
//
// Pins at the bottoms of the valleys are on the pitch circle R = p/(2 sin π/N). Angle ψ gives the position of the pin
// at the end of the strand. It is zero if the circle's tangent at the pin is parallel to the strand. If the strand
// stays parallel to itself, its velocity is the component of the pin's velocity along the strand, v = ω R cos ψ, −π/N
// ≤ ψ ≤ π/N: v_min/v_max = cos π/N, x(ψ) = R sin ψ and a pitch more for every tooth, mean v = N p n. The strand stays
// parallel if the force at its end has a constant direction and is the only force, as here. A strand at rest is then
// straight and along the force, for any position of its other end. (A strand of length L with its end on the line z =
// R − s is inclined by β, L sin β = s − R (1 − cos ψ). The velocity of its end is v = ω R (cos ψ − sin ψ tan β), and
// the velocity ratio depends on L and s.)
//
// Both strands are on the same side of the sprocket, under the same force T. All pins at the bottoms of frictionless
// valleys are then in equilibrium at every ψ. The strands pull with T cos ψ along the tangent on both ends of the row
// of seated pins. These ends have the same ψ after a rotation by 180°. The tension of every link between them is T
// cos ψ/cos π/N. No pin climbs its arc. The remaining difference is the penetration of the pins, of the order T/k.

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/contact_group.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/vehicle/pin_sprocket_contact.hpp>

#include "m113/data.hpp"
#include "support/held.hpp"

namespace polybody {
namespace chordal_action_test {

constexpr double pi = std::numbers::pi, degree = pi / 180.0, p = m113::pitch, tooth = 2.0 * pi / m113::teeth;
double const pitch_radius = 0.5 * p / std::sin(0.5 * tooth);
constexpr double tension = 2000.0;  // [N]

/// Degrees from one position of rest to the next.
constexpr double stride = 2.0;
/// Rotation in steps from rest to rest from t = `start`: each step rotates for 0.4 s and rests for 1.6 s.
struct Steps {
  static constexpr double start = 1.0, turn = 0.4, each = 2.0;

  Motion operator()(double t) const {
    double const passed = std::max(0.0, t - start), whole = std::floor(passed / each),
                 x = std::min(1.0, (passed - whole * each) / turn);
    double const y = 1.0 - x, step = stride * degree;
    return {step * (whole + x * x * x * (10.0 - 15.0 * x + 6.0 * x * x)), step * 30.0 * x * x * y * y / turn,
            step * 60.0 * x * y * (1.0 - 2.0 * x) / (turn * turn)};
  }
};

/// Fourteen links of the M113 over its sprocket. Pins 4 … 9 are in the valleys from the top to the bottom, both
/// strands point to the rear. Friction of moving pins in their valleys and dampers across the ends of the strands
/// damp the motion. At rest they have no force.
template <class Drive>
struct Chain {
  using Hinge = Joint<Revolute, Constraint>;
  using Driven = Joint<Drive, Constraint>;
  using InPlane = Joint<PlanarJoint, Constraint>;
  using Teeth = ContactGroup<Contact<PinSprocketContact<>>>;

  Model<Bodies<Rigid<>>, Joints<Hinge, Driven, InPlane>, Forces<Teeth, PointForce<>, SpringDamper>> model;
  std::vector<BodyHandle<Rigid<>>> links;

  /// \param k of the contact of a pin with a ring of teeth [N/m]
  Chain(double k, Drive const& drive) {
    Vec3 const y = Vec3::UnitY();
    std::vector<Vec3> pins;
    for (int i = 4; i > 0; --i) pins.emplace_back(-i * p, 0.0, pitch_radius);
    for (int i = 0; i < 6; ++i)
      pins.emplace_back(pitch_radius * std::sin(i * tooth), 0.0, pitch_radius * std::cos(i * tooth));
    for (int i = 1; i < 6; ++i) pins.emplace_back(-i * p, 0.0, -pitch_radius);

    auto const sprocket = model.add(
        Rigid<>(m113::wallin_2016.sprocket.mass, Vec3(m113::wallin_2016.sprocket.inertia).asDiagonal().toDenseMatrix()),
        "sprocket");
    auto const ground = model.ground().at({0, 0, 0});
    model.connect(Hinge{Revolute{.axis = y}, {}}, ground, sprocket.at(Vec3(0, 0, 0)), "axle");
    model.connect(Driven{drive, {}}, ground, sprocket.at(Vec3(0, 0, 0)), "drive");
    std::vector<Marker<Rigid<>>> middles;
    for (std::size_t i = 0; i + 1 < pins.size(); ++i) {
      Placement at{.origin = 0.5 * (pins[i] + pins[i + 1])};
      Vec3 const x = (pins[i] - pins[i + 1]) / p;
      at.axes << x, y, x.cross(y);
      links.push_back(model.add(
          Rigid<>(m113::wallin_2016.link.mass, Vec3(m113::wallin_2016.link.inertia).asDiagonal().toDenseMatrix(), at)));
      if (i > 0)
        model.connect(Hinge{Revolute{.axis = y}, {}}, links[i - 1].at(Vec3(-0.5 * p, 0, 0)),
                      links[i].at(Vec3(0.5 * p, 0, 0)));
      middles.push_back(links[i].at(Vec3(0, 0, 0)));
    }
    model.connect(InPlane{PlanarJoint{.normal = y}, {}}, ground, middles[0], "plane");
    model.apply(PointForce<>{.force = Vec3(-tension, 0, 0)}, end(), "pull");
    model.apply(PointForce<>{.force = Vec3(-tension, 0, 0)}, links.back().at(Vec3(-0.5 * p, 0, 0)), "pull back");
    for (std::size_t const i : {0u, 1u, 2u, 11u, 12u, 13u}) {
      double const x = i < 7 ? 0.5 * p : -0.5 * p;
      Vec3 const above = pins[i < 7 ? i : i + 1] + Vec3(0, 0, 100.0);
      model.apply(SpringDamper{.stiffness = 0.0, .damping = 200.0, .free_length = 0.0}, model.ground().at(above),
                  links[i].at(Vec3(x, 0, 0)));
    }
    SprocketProfile const profile{.teeth = m113::teeth,
                                  .pitch = p,
                                  .pin_radius = m113::pin_radius,
                                  .valley_radius = m113::valley_radius,
                                  .flank = m113::flank,
                                  .tip_radius = m113::tip_radius};
    model.add_partner(
        model.apply(Teeth{}, middles, "chain"),
        Contact<PinSprocketContact<>>{{.profile = profile, .valley = 0.0, .rings = {-m113::tooth_y, m113::tooth_y}},
                                      {.stiffness = k, .damping = 2.5e-3 * k, .onset = m113::onset},
                                      {.coefficient = m113::on_sprocket.friction, .slip_speed = m113::slip_speed}},
        sprocket.at(Vec3(0, 0, 0)), "sprocket");
  }

  /// The pin at the end of the incoming strand.
  Marker<Rigid<>> end() const { return links.front().at(Vec3(0.5 * p, 0, 0)); }
  double travel(State const& x) const { return position(model, x, end()).x() + 4.0 * p; }
};

/// Travel of a rigid chain after a rotation of the sprocket by `angle`.
double rigid_travel(double angle) {
  double const teeth = std::round(angle / tooth);
  return teeth * p + pitch_radius * std::sin(angle - teeth * tooth);
}

/// Travel of the strand's end at rest, after 0°, 2°, … 40°.
std::vector<double> travels(double k) {
  Chain<PrescribedAngle<Steps>> const chain(k, {.law = {}, .axis = Vec3::UnitY()});
  State x = chain.model.reference_state();
  std::vector<double> at_rest;
  double const last = Steps::start + 20.0 * Steps::each;
  for (State const& now : simulate(chain.model, x, GeneralisedAlpha{.rho_inf = 0.0, .tolerance = 1e-8},
                                   {.end_time = last, .step = 0.01, .max_step_halvings = 8}))
    if (double const passed = (now.t - Steps::start) / Steps::each;
        passed > -1e-9 && std::abs(passed - std::round(passed)) < 1e-9)
      at_rest.push_back(chain.travel(now));
  return at_rest;
}

/// Penetration of a pin in its valley due to tension: two links pull with 2 T sin π/N, and two rings carry it.
double depth(double k) { return 2.0 * tension * std::sin(0.5 * tooth) / (2.0 * k); }

// Velocity ratio of chordal action (C6, closed form). The velocity is smallest as a pin engages, at 18°, and largest
// half a tooth later, at 36°. There v/ω = dx/dψ follows from finite differences of positions at rest. At the engaging
// pin the difference is one-sided: (11 x₀ − 18 x₁ + 9 x₂ − 2 x₃)/6h, with an error of h³ x⁗/4 = 3e-6 of R. A
// penetration d of the pins reduces the radius by at most d.
TEST(ChordalAction, StrandRunsAsUnevenlyAsAPolygon) {
  double const h = stride * degree;
  double error_before = 0.0, place_before = 0.0;
  for (double const k : {2e6, 8e6, 32e6}) {
    std::vector<double> const x = travels(k);
    ASSERT_EQ(x.size(), 21u);
    double place = 0.0;  // the largest error of a travel
    for (std::size_t i = 0; i < x.size(); ++i)
      place = std::max(place, std::abs(x[i] - x[0] - rigid_travel(double(i) * h)));
    double const slowest = (11.0 * x[9] - 18.0 * x[8] + 9.0 * x[7] - 2.0 * x[6]) / (6.0 * h);
    double const fastest = (8.0 * (x[19] - x[17]) - (x[20] - x[16])) / (12.0 * h);
    double const error = std::abs(slowest / fastest - std::cos(pi / m113::teeth)), sunk = depth(k) / pitch_radius;
    auto const claim = [](char const* what, char const* source) {
      return Claim{"C6", what, By::closed_form, source, "14 links of Rigid, contacts of 2e6 to 3.2e7 N/m"};
    };
    Instance const at{equals("k", k), 1.0};
    held_within(claim("travel of the strand's end, of a pitch", "R sin ψ, and a pitch for every tooth"), place / p,
                depth(k) / p, at);
    held(claim("slowest speed over fastest", "cos π/N"), slowest / fastest, std::cos(pi / m113::teeth), sunk, at);
    held(claim("fastest speed over ω R", "1"), fastest / pitch_radius, 1.0, sunk, at);
    held(claim("travel in a tooth, of a pitch", "1"), (x[18] - x[0]) / p, 1.0, 1e-6,
         at);  // the remaining error is due to the residual motion at rest
    if (error_before > 0.0) {
      EXPECT_LT(error, error_before / 3.0) << k;  // the error has the order 1/k, and k is four times as large
      EXPECT_LT(place, place_before / 3.0) << k;
    }
    error_before = error;
    place_before = place;
  }
  EXPECT_LT(error_before, 1e-4);  // compared with 1 − cos π/N = 0.049
}

// At constant angular velocity a pin hits its valley with 2 ω R sin π/N. The component u = 2 ω R sin² π/N of this
// velocity is along the chain. If the whole chain had this velocity, it would oscillate in its valleys with the
// amplitude u/Ω, Ω² = ΣN/((r_a − r_p) M). Its pins move like pendulums in arcs of r_a − r_p. The seated pins carry ΣN
// ≥ 5 · 2 T sin π/N together, and M is the mass of all links. Hence u/Ω bounds the difference between its travel and
// that of a rigid chain.
TEST(ChordalAction, MeanSpeedIsAPitchForEachTooth) {
  double const omega = 0.1, start = 1.0, rise = 0.5;
  using Drive = PrescribedRate<Ramp>;
  Chain<Drive> const chain(2e6,
                           Drive{.law = {{.target = omega, .duration = rise, .start = start}}, .axis = Vec3::UnitY()});
  double const normal = 5.0 * 2.0 * tension * std::sin(0.5 * tooth),
               mass = m113::wallin_2016.link.mass * double(chain.links.size());
  double const swing = std::sqrt(normal / ((m113::valley_radius - m113::pin_radius) * mass));
  double const rocking = 2.0 * omega * pitch_radius * std::pow(std::sin(0.5 * tooth), 2) / swing;
  State x = chain.model.reference_state();
  double at_rest = 0.0, begin = 0.0, most = 0.0, first = 0.0;
  double const from = start + rise, end_time = from + 2.0 * tooth / omega;
  for (State const& now : simulate(chain.model, x, GeneralisedAlpha{.rho_inf = 0.0, .tolerance = 1e-8},
                                   {.end_time = end_time, .step = 0.01, .max_step_halvings = 8})) {
    if (now.t <= start) at_rest = chain.travel(now);
    if (now.t < from - 1e-9) continue;
    double const turned = omega * (now.t - start - 0.5 * rise), travel = chain.travel(now) - at_rest;
    if (begin == 0.0) {
      begin = now.t;
      first = travel;
    }
    most = std::max(most, std::abs(travel - rigid_travel(turned)));
  }
  EXPECT_LT(most, rocking);  // 0.12 mm
  double const mean = (chain.travel(x) - at_rest - first) / (x.t - begin);
  held({"C6", "mean speed of the chain [m/s]", By::closed_form, "N p n", "14 links of Rigid, contacts of 2e6 N/m"},
       mean, m113::teeth * p * omega / (2.0 * pi), 2.0 * rocking / (x.t - begin));
}

}  // namespace chordal_action_test
}  // namespace polybody
