// CASES C6, chordal action: a chain of pitch p on a sprocket of N teeth is a polygon around it, so its strand runs
// unevenly.
//
// Pins at the bottoms of the valleys lie on the pitch circle R = p/(2 sin π/N). Let ψ be the angle of the pin that the
// strand leads to, from the place where the circle's tangent is along the strand. A strand that stays parallel to
// itself has the speed of that pin along it,
//   v = ω R cos ψ,  −π/N ≤ ψ ≤ π/N:  v_min/v_max = cos π/N,  x(ψ) = R sin ψ and a pitch more for every tooth,  mean v =
//   N p n.
// So it is where the strand's end feels a force of constant direction and nothing else, as here: then a strand at rest
// is straight and along the force, wherever its other end is. (One of length L whose end is held on the line z = R − s
// leans by β, L sin β = s − R (1 − cos ψ); its end has v = ω R (cos ψ − sin ψ tan β), and a ratio that depends on L and
// s.)
//
// Both strands lie on the same side of the sprocket and pull with the same force T. Then all pins at the bottoms of
// frictionless valleys are in equilibrium at every ψ: the strands pull with T cos ψ along the tangent on both ends of
// the row of seated pins, which turned by 180° have the same ψ, and every link between them bears T cos ψ/cos π/N. No
// pin climbs its arc. What is left are the depths to which pins are pressed in, of the order T/k.

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/contact_group.hpp>
#include <polybody/forces/point_load.hpp>
#include <polybody/forces/spring_damper.hpp>
#include <polybody/integrators/generalized_alpha.hpp>
#include <polybody/joints/plane_on_plane.hpp>
#include <polybody/joints/prescribed_angle.hpp>
#include <polybody/joints/prescribed_rate.hpp>
#include <polybody/joints/revolute.hpp>
#include <polybody/run/observe.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/vehicle/m113.hpp>
#include <polybody/vehicle/pin_on_sprocket.hpp>

#include "support/held.hpp"

namespace polybody {
namespace chordal_action_test {

constexpr double pi = std::numbers::pi, degree = pi / 180.0, p = m113::pitch, tooth = 2.0 * pi / m113::teeth;
double const pitch_radius = 0.5 * p / std::sin(0.5 * tooth);
constexpr double tension = 2000.0;  // [N]

/// Degrees from one place of rest to the next.
constexpr double stride = 2.0;
/// From rest to rest: a turn in 0.4 s, then 1.6 s of rest, from t = `start` on.
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

/// Fourteen links of the M113 over its sprocket: pins 4 … 9 in the valleys from the top to the bottom, both strands to
/// the rear. Friction of pins that move in their valleys, and dampers across the strands' ends, bring it to rest; at
/// rest they do nothing.
template <class Drive>
struct Chain {
  using Hinge = Joint<Revolute, Constraint>;
  using Driven = Joint<Drive, Constraint>;
  using InPlane = Joint<PlaneOnPlane, Constraint>;
  using Teeth = ContactGroup<Contact<PinOnSprocket<>>>;

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

    auto const sprocket =
        model.add(Rigid<>(m113::thesis.sprocket.mass, Vec3(m113::thesis.sprocket.inertia).asDiagonal().toDenseMatrix()),
                  "sprocket");
    auto const ground = model.ground().at({0, 0, 0});
    model.connect(Hinge{Revolute{.axis = y}, {}}, ground, sprocket.at(Vec3(0, 0, 0)), "axle");
    model.connect(Driven{drive, {}}, ground, sprocket.at(Vec3(0, 0, 0)), "drive");
    std::vector<Marker<Rigid<>>> middles;
    for (std::size_t i = 0; i + 1 < pins.size(); ++i) {
      Placement at{.origin = 0.5 * (pins[i] + pins[i + 1])};
      Vec3 const x = (pins[i] - pins[i + 1]) / p;
      at.axes << x, y, x.cross(y);
      links.push_back(
          model.add(Rigid<>(m113::thesis.link.mass, Vec3(m113::thesis.link.inertia).asDiagonal().toDenseMatrix(), at)));
      if (i > 0)
        model.connect(Hinge{Revolute{.axis = y}, {}}, links[i - 1].at(Vec3(-0.5 * p, 0, 0)),
                      links[i].at(Vec3(0.5 * p, 0, 0)));
      middles.push_back(links[i].at(Vec3(0, 0, 0)));
    }
    model.connect(InPlane{PlaneOnPlane{.normal = y}, {}}, ground, middles[0], "plane");
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
    model.pair_with(
        model.apply(Teeth{}, middles, "chain"),
        Contact<PinOnSprocket<>>{{.profile = profile, .valley = 0.0, .rings = {-m113::tooth_y, m113::tooth_y}},
                                 {.stiffness = k, .damping = 2.5e-3 * k, .onset = m113::onset},
                                 {.coefficient = m113::on_sprocket.friction, .slip_speed = m113::slip_speed}},
        sprocket.at(Vec3(0, 0, 0)), "sprocket");
  }

  /// The pin at the end of the strand that comes in.
  Marker<Rigid<>> end() const { return links.front().at(Vec3(0.5 * p, 0, 0)); }
  double travel(State const& x) const { return position(model, x, end()).x() + 4.0 * p; }
};

/// Of a rigid chain after the sprocket has turned by `angle`.
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
  for (State const& now : simulate(chain.model, x, GeneralizedAlpha{.rho_inf = 0.0, .tolerance = 1e-8},
                                   {.until = last, .step = 0.01, .halvings = 8}))
    if (double const passed = (now.t - Steps::start) / Steps::each;
        passed > -1e-9 && std::abs(passed - std::round(passed)) < 1e-9)
      at_rest.push_back(chain.travel(now));
  return at_rest;
}

/// How deep tension and contact press a pin into its valley: two links pull with 2 T sin π/N, two rings bear it.
double depth(double k) { return 2.0 * tension * std::sin(0.5 * tooth) / (2.0 * k); }

// CASES C6. The speed is slowest as a pin comes in, 18°, and fastest half a tooth later, 36°: v/ω = dx/dψ there, by
// differences of places at rest, up to the pin that comes in on one side only, (11 x₀ − 18 x₁ + 9 x₂ − 2 x₃)/6h, with
// an error of h³ x⁗/4 = 3e-6 of R. Pins that are sunk by d make a wheel smaller by no more than that.
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
         at);  // what is left is how well it rests
    if (error_before > 0.0) {
      EXPECT_LT(error, error_before / 3.0) << k;  // of the order 1/k, and k has grown fourfold
      EXPECT_LT(place, place_before / 3.0) << k;
    }
    error_before = error;
    place_before = place;
  }
  EXPECT_LT(error_before, 1e-4);  // of 1 − cos π/N = 0.049
}

// At constant speed a pin comes in with 2 ω R sin π/N towards its valley and hits it. The part u = 2 ω R sin² π/N of
// that is along the chain; if all of the chain took it on, it would rock in its valleys by u/Ω, Ω² = ΣN/((r_a − r_p)
// M): its pins hang in arcs of r_a − r_p, the seated ones with ΣN ≥ 5 · 2 T sin π/N between them, and M is the mass of
// all links. By no more does its travel differ from that of a rigid chain.
TEST(ChordalAction, MeanSpeedIsAPitchForEachTooth) {
  double const omega = 0.1, start = 1.0, rise = 0.5;
  using Drive = PrescribedRate<Ramp>;
  Chain<Drive> const chain(2e6,
                           Drive{.law = {{.target = omega, .duration = rise, .start = start}}, .axis = Vec3::UnitY()});
  double const normal = 5.0 * 2.0 * tension * std::sin(0.5 * tooth),
               mass = m113::thesis.link.mass * double(chain.links.size());
  double const swing = std::sqrt(normal / ((m113::valley_radius - m113::pin_radius) * mass));
  double const rocking = 2.0 * omega * pitch_radius * std::pow(std::sin(0.5 * tooth), 2) / swing;
  State x = chain.model.reference_state();
  double at_rest = 0.0, begin = 0.0, most = 0.0, first = 0.0;
  double const from = start + rise, until = from + 2.0 * tooth / omega;
  for (State const& now : simulate(chain.model, x, GeneralizedAlpha{.rho_inf = 0.0, .tolerance = 1e-8},
                                   {.until = until, .step = 0.01, .halvings = 8})) {
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
