// Derivatives of runs of mechanisms against reference derivatives. The reference integrates the equations of motion
// in minimal coordinates, written by hand, together with their variational equations. It uses dual numbers in an
// extrapolation method with an error below 1e-12. Derivatives of runs converge to it with the square of the step.
// Extrapolated over three steps they agree to 1e-7 or better.
#include <polybody/gradients/sensitivities.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ffr/planar_ffr.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>

using namespace polybody;

namespace sensitivities_mechanisms_test {

using P = std::span<double const>;
using D = Dual<3>;

// --- an independent integrator -----------------------------------------------------------------------------------

/// Integrates from 0 to `end` in `steps` steps. Each step uses the modified midpoint rule with 2, 4, … 16 substeps,
/// extrapolated to zero substep length [Hairer, Nørsett & Wanner 1993, §II.9]: order 16.
template <std::size_t n, class F>
std::array<D, n> extrapolated(F const& f, std::array<D, n> y, double end, int steps) {
  constexpr std::size_t columns = 8;
  double const h = end / steps;
  auto const moved = [](std::array<D, n> from, std::array<D, n> const& by, double e) {
    for (std::size_t i = 0; i < n; ++i) from[i] += by[i] * e;
    return from;
  };
  for (int step = 0; step < steps; ++step) {
    double const t = step * h;
    std::array<std::array<D, n>, columns> table;
    for (std::size_t k = 0; k < columns; ++k) {
      int const parts = 2 * int(k + 1);
      double const e = h / parts;
      std::array<D, n> last = y, now = moved(y, f(t, y), e);
      for (int i = 1; i < parts; ++i) {
        std::array<D, n> next = moved(last, f(t + i * e, now), 2.0 * e);
        last = now;
        now = next;
      }
      table[k] = now;
      for (std::size_t j = k; j-- > 0;) {
        double const ratio = double(k + 1) / double(j + 1), by = 1.0 / (ratio * ratio - 1.0);
        for (std::size_t i = 0; i < n; ++i) table[j][i] = table[j + 1][i] + (table[j + 1][i] - table[j][i]) * by;
      }
    }
    y = table[0];
  }
  return y;
}

/// The derivatives at the end of runs with steps h, h/2 and h/4, and their limit after elimination of the errors of
/// h² and h³.
template <class Make>
struct Tending {
  std::array<MatX, 3> by;
  MatX limit;

  Tending(Make const& make_with, std::vector<Parameter> const& parameters, double h) {
    for (std::size_t k = 0; k < 3; ++k)
      by[k] =
          sensitivities(make_with(h / double(1 << k)), parameters, GeneralisedAlpha{.rho_inf = 0.9}).derivatives.back();
    MatX const first = (4.0 * by[1] - by[0]) / 3.0, second = (4.0 * by[2] - by[1]) / 3.0;
    limit = (8.0 * second - first) / 7.0;
  }
};
template <class Make>
void expect_tending(Make const& make_with, std::vector<Parameter> const& parameters, double h,
                    std::vector<D> const& expected, double tolerance = 1e-7) {
  Tending const runs(make_with, parameters, h);
  for (Index j = 0; j < Index(parameters.size()); ++j)
    for (Index i = 0; i < Index(expected.size()); ++i) {
      double const exact = expected[std::size_t(i)].d[j];
      double scale = 0.0;
      for (D const& e : expected) scale = std::max(scale, std::abs(e.d[j]));
      std::string const where = parameters[std::size_t(j)].name + ", output " + std::to_string(i);
      EXPECT_NEAR(runs.limit(i, j), exact, tolerance * scale) << where;
      double const coarse = runs.by[1](i, j) - exact, fine = runs.by[2](i, j) - exact;
      if (std::abs(exact) > 0.1 * scale) {
        EXPECT_NEAR(coarse / fine, 4.0, 0.6) << where;
      }
    }
}

// --- Andrews' squeezing mechanism (R3, IVP Test Set "andrews") ---------------------------------------------------

/// A quantity with its first and second derivatives with respect to β.
struct Jet {
  D v, a = 0.0, b = 0.0;

  Jet(D value = 0.0, D first = 0.0, D second = 0.0) : v(value), a(first), b(second) {}
  Jet(double value) : v(value) {}
  friend Jet operator+(Jet const& x, Jet const& y) { return {x.v + y.v, x.a + y.a, x.b + y.b}; }
  friend Jet operator-(Jet const& x, Jet const& y) { return {x.v - y.v, x.a - y.a, x.b - y.b}; }
  friend Jet operator*(Jet const& x, Jet const& y) {
    return {x.v * y.v, x.v * y.a + x.a * y.v, x.v * y.b + x.a * y.a * 2.0 + x.b * y.v};
  }
  friend Jet operator/(Jet const& x, Jet const& y) {
    D const r = x.v / y.v, ra = (x.a - r * y.a) / y.v;
    return {r, ra, (x.b - ra * y.a * 2.0 - r * y.b) / y.v};
  }
  friend Jet sqrt(Jet const& x) {
    using std::sqrt;
    D const s = sqrt(x.v), sa = x.a / (s * 2.0);
    return {s, sa, (x.b - sa * sa * 2.0) / (s * 2.0)};
  }
};
struct Point {
  Jet x, y;
  friend Point operator+(Point const& p, Point const& q) { return {p.x + q.x, p.y + q.y}; }
  friend Point operator-(Point const& p, Point const& q) { return {p.x - q.x, p.y - q.y}; }
  friend Point operator*(Jet const& s, Point const& p) { return {s * p.x, s * p.y}; }
  Point across() const { return {Jet(0.0) - y, x}; }
};
Jet squared(Point const& p) { return p.x * p.x + p.y * p.y; }

/// The point at distances r from p and s from q; `side` selects the side of the line from p to q.
Point crossing(Point const& p, double r, Point const& q, double s, double side) {
  Point const d = q - p;
  Jet const l2 = squared(d), along = (Jet(r * r - s * s) + l2) / (l2 + l2);
  return p + along * d + (Jet(side) * sqrt(Jet(r * r) / l2 - along * along)) * d.across();
}

/// Parameters: masses, stiffness of the spring, driving moment, mass of AG.
struct SqueezerEquations {
  D stiffness, moment, mass;

  struct Shape {
    Jet inertia;    ///< Σ m |c_β|² + I φ_β²; its second derivative is not stored
    Jet potential;  ///< potential energy of the spring
    D gamma;
  };
  Shape at(D const& beta) const {
    using std::atan2;
    using std::cos;
    using std::sin;
    D const c = cos(beta), s = sin(beta);
    Point const along{Jet(c, -s, -c), Jet(s, c, -s)}, O{0.0, 0.0}, A{-0.06934, -0.00227}, B{-0.03635, 0.03273},
        C{0.014, 0.072};
    Point const F = Jet(0.007) * along, E = crossing(F, 0.028, B, 0.035, side_e),
                G = crossing(A, 0.04, E, 0.02, side_g), H = crossing(A, 0.04, E, 0.02, side_h);
    Shape out;
    Jet j(0.0);
    // a body with its first axis along u and its mass centre at (x, y) from p
    auto const body = [&](D const& m, double inertia, Point const& p, Point const& u, double x, double y) {
      Point const centre = p + Jet(x) * u + Jet(y) * u.across();
      D const turn = u.x.v * u.y.a - u.y.v * u.x.a, turn_b = u.x.v * u.y.b - u.y.v * u.x.b;
      j.v += m * (centre.x.a * centre.x.a + centre.y.a * centre.y.a) + turn * turn * inertia;
      j.a += m * (centre.x.a * centre.x.b + centre.y.a * centre.y.b) * 2.0 + turn * turn_b * (2.0 * inertia);
    };
    auto const axis = [](Point const& from, Point const& to, double length) { return Jet(1.0 / length) * (to - from); };
    auto const from_second = [](Point const& second) { return Point{second.y, Jet(0.0) - second.x}; };
    Point const bde = from_second(axis(E, B, 0.035));
    body(0.04325, 2.194e-6, O, along, 0.00092, 0.0);
    body(0.00365, 4.410e-7, F, axis(E, F, 0.028), -0.0115, 0.0);
    body(0.02373, 5.255e-6, B, bde, 0.01043, -0.01874);
    body(0.00706, 5.667e-7, G, from_second(axis(E, G, 0.02)), 0.0, -0.02 + 0.01421);
    body(mass, 1.169e-5, A, axis(A, G, 0.04), 0.02308, 0.00916);
    body(0.00706, 5.667e-7, H, axis(H, E, 0.02), 0.02 - 0.01421, 0.0);
    body(0.05498, 1.912e-5, A, from_second(axis(H, A, 0.04)), -0.00449, -0.01228);
    out.inertia = j;
    Jet const stretch = sqrt(squared(B + Jet(0.02) * bde + Jet(-0.018) * bde.across() - C)) - Jet(0.07785);
    out.potential = Jet(stiffness * 0.5) * stretch * stretch;
    out.gamma = atan2(bde.y.v, bde.x.v);
    return out;
  }
  /// β̇ and β̈ = (moment − V_β − ½ J_β β̇²)/J.
  std::array<D, 2> operator()(double, std::array<D, 2> const& y) const {
    Shape const s = at(y[0]);
    return {y[1], (moment - s.potential.a - s.inertia.a * y[1] * y[1] * 0.5) / s.inertia.v};
  }
  static constexpr double side_e = 1.0, side_g = 1.0, side_h = -1.0;
};

/// This mechanism with bodies and pins; names and numbers are those of the test set. Parameters as above.
auto squeezer(double end, double step) {
  return [=](P p) {
    using Pin = Joint<planar::Revolute, Constraint>;
    using Body = planar::Rigid;
    using M = Model<Bodies<Body>, Joints<Pin>, Forces<PointMoment<>, SpringDamper>>;
    M model;
    Vec<double, 7> q;
    q << -0.0617138900142764496, 0, 0.455279819163070380, 0.222668390165885885, 0.487364979543842550,
        -0.222668390165885885, 1.23054744454982119;
    auto const turned = [](double angle, double x, double y) {
      return Vec2(std::cos(angle) * x - std::sin(angle) * y, std::sin(angle) * x + std::cos(angle) * y);
    };
    Vec2 const O(0, 0), A(-0.06934, -0.00227), B(-0.03635, 0.03273), C(0.014, 0.072);
    Vec2 const F = turned(q[0], 0.007, 0), G = A + turned(q[4], 0.04, 0), H = A + turned(q[6], 0, -0.04);
    struct Part {
      double mass, inertia, angle;
      Vec2 centre, place;
    };
    std::array<Part, 7> const parts{{{0.04325, 2.194e-6, q[0], {0.00092, 0}, O},
                                     {0.00365, 4.410e-7, q[0] + q[1], {-0.0115, 0}, F},
                                     {0.02373, 5.255e-6, q[2], {0.01043, -0.01874}, B},
                                     {0.00706, 5.667e-7, q[3] + q[4], {0, -0.02 + 0.01421}, G},
                                     {p[2], 1.169e-5, q[4], {0.02308, 0.00916}, A},
                                     {0.00706, 5.667e-7, q[5] + q[6], {0.02 - 0.01421, 0}, H},
                                     {0.05498, 1.912e-5, q[6], {-0.00449, -0.01228}, A}}};
    std::vector<BodyHandle<Body>> bodies;
    for (Part const& part : parts) {
      Vec2 const centre = part.place + turned(part.angle, part.centre[0], part.centre[1]);
      bodies.push_back(model.add(Body(part.mass, part.inertia, Placement::planar(centre[0], centre[1], part.angle))));
    }
    auto const on = [&](std::size_t i, double x, double y) { return bodies[i].at(Vec2(Vec2(x, y) - parts[i].centre)); };
    auto const ground = [&](Vec2 const& at) { return model.ground().at({at[0], at[1], 0}); };
    model.connect(Pin{}, ground(O), on(0, 0, 0));
    model.connect(Pin{}, on(0, 0.007, 0), on(1, 0, 0));
    model.connect(Pin{}, ground(B), on(2, 0, 0));
    model.connect(Pin{}, ground(A), on(4, 0, 0));
    model.connect(Pin{}, ground(A), on(6, 0, 0));
    model.connect(Pin{}, on(4, 0.04, 0), on(3, 0, 0));
    model.connect(Pin{}, on(6, 0, -0.04), on(5, 0, 0));
    model.connect(Pin{}, on(2, 0, -0.035), on(1, -0.028, 0));
    model.connect(Pin{}, on(3, 0, -0.02), on(1, -0.028, 0));
    model.connect(Pin{}, on(5, 0.02, 0), on(1, -0.028, 0));
    model.apply(PointMoment<>{.moment = {0, 0, p[1]}}, on(0, 0, 0));
    model.apply(SpringDamper{.stiffness = p[0], .free_length = 0.07785}, on(2, 0.02, -0.018), ground(C));
    State const start = model.reference_state();
    std::vector<Output<M>> outputs{{"beta [rad]", [](M const&, State const& x) { return x.q[2]; }},
                                   {"gamma [rad]", [](M const&, State const& x) { return x.q[8]; }},
                                   {"rate of beta [rad/s]", [](M const&, State const& x) { return x.v[2]; }}};
    return Scenario<M>{std::move(model), start, {.end_time = end, .step = step}, std::move(outputs)};
  };
}

TEST(SensitivitiesOfMechanisms, AndrewsSqueezerTendsToItsEquationInBeta) {
  SqueezerEquations const equations{D::variable(4530.0, 0), D::variable(0.033, 1), D::variable(0.0705, 2)};
  double const end = 0.005;
  std::array<D, 2> const start{-0.0617138900142764496, 0.0};
  // check of the equation itself: published β¨ and β(0.01)
  EXPECT_NEAR(equations(0.0, start)[1].v, 14222.4439199541138706, 1e-6);
  EXPECT_NEAR(extrapolated(equations, start, 0.01, 200)[0].v, 2.1601131315315, 1e-11);
  auto const y = extrapolated(equations, start, end, 100), check = extrapolated(equations, start, end, 150);
  for (int j = 0; j < 3; ++j) EXPECT_NEAR(y[0].d[j], check[0].d[j], 1e-11 * std::abs(y[0].d[j]));
  std::vector<Parameter> const parameters{
      {"stiffness [N/m]", 4530.0}, {"moment [N m]", 0.033}, {"mass of AG [kg]", 0.0705}};
  auto const make_with = [&](double h) { return squeezer(end, h); };
  expect_tending(make_with, parameters, 1e-5, {y[0], equations.at(y[0]).gamma, y[1]});
}

// --- flyball governor (R5, IFToMM A05) ---------------------------------------------------------------------------

/// Coordinates: rotation of the shaft, angle of both rods below the horizontal, height of the slider. Springs and
/// dampers are 0.005 of those of the benchmark, so that the steps resolve them. Parameters: stiffness of the springs,
/// mass of the slider, initial spin.
struct GovernorEquations {
  D stiffness, slider;
  double damping = 200.0;

  std::array<D, 6> operator()(double, std::array<D, 6> const& y) const {
    using std::cos;
    using std::sin;
    using std::sqrt;
    double const rod = 0.3, ball = 5.0, mass = rod + ball, own = rod * 2e-4 / 12.0, g = 9.81;
    double const centre = (0.5 * rod + ball) / mass;
    double const across =
        rod * ((1.0 + 1e-4) / 12.0 + (centre - 0.5) * (centre - 0.5)) + ball * (1.0 - centre) * (1.0 - centre);
    D const ca = cos(y[1]), sa = sin(y[1]), radius = ca * centre + 0.05;
    D const inertia = (radius * radius * mass + sa * sa * own + ca * ca * across) * 2.0 + slider * (0.02 / 12.0) +
                      0.3 * 2e-4 / 12.0,
            by_angle = (radius * sa * (-2.0 * mass * centre) + sa * ca * (2.0 * own - 2.0 * across)) * 2.0;
    D const up = sa * -0.5 - y[2] + 1.0, length = sqrt(ca * ca * 0.25 + up * up),
            length_by_angle = (ca * sa * -0.25 - up * ca * 0.5) / length, length_by_height = -up / length;
    D const rate = length_by_angle * y[4] + length_by_height * y[5],
            force = (stiffness * (length - 0.5) + rate * damping) * 2.0;
    return {y[3],
            y[4],
            y[5],
            -by_angle * y[4] * y[3] / inertia,
            (by_angle * y[3] * y[3] * 0.5 + ca * (2.0 * mass * g * centre) - force * length_by_angle) /
                (2.0 * (mass * centre * centre + across)),
            -(force * length_by_height) / slider - g};
  }
};

auto governor(double end, double step) {
  return [=](P p) {
    using Pin = Joint<Revolute, Constraint>;
    using Slide = Joint<Prismatic, Constraint>;
    using Body = Rigid<>;
    using M = Model<Bodies<Body>, Joints<Pin, Slide>, Forces<SpringDamper>>;
    M model{Gravity{0, 0, -9.81}};
    double const rod = 0.3, ball = 5.0, mass = rod + ball, own = rod * 2e-4 / 12.0, thin = 0.3 * (1.0 + 1e-4) / 12.0;
    double const centre = (0.5 * rod + ball) / mass, down = std::numbers::pi / 6.0;
    double const across =
        rod * ((1.0 + 1e-4) / 12.0 + (centre - 0.5) * (centre - 0.5)) + ball * (1.0 - centre) * (1.0 - centre);
    auto const inertia = [](double x, double y, double z) { return Mat3(Vec3(x, y, z).asDiagonal()); };
    double const cube = p[1] * 0.02 / 12.0;
    auto const shaft = model.add(Body(0.3, inertia(thin, thin, own), Placement::at({0, 0, 0.5})), "shaft");
    auto const slider = model.add(Body(p[1], inertia(cube, cube, cube), Placement::at({0, 0, 0.5})), "slider");
    model.connect(Pin{Revolute{.axis = Vec3::UnitZ()}, {}}, model.ground().at({0, 0, 0}), shaft.at(Vec3(0, 0, -0.5)));
    model.connect(Slide{Prismatic{.axis = Vec3::UnitZ()}, {}}, shaft.at(Vec3(0, 0, 0)), slider.at(Vec3(0, 0, 0)));
    std::vector<BodyHandle<Body>> rods;
    for (double const side : {1.0, -1.0}) {
      Mat3 axes;
      axes << side * std::cos(down), 0, side * std::sin(down), 0, side, 0, -std::sin(down), 0, std::cos(down);
      Vec3 const pivot(0.05 * side, 0, 1);
      rods.push_back(
          model.add(Body(mass, inertia(own, across, across), Placement{pivot + centre * axes.col(0), axes})));
      model.connect(Pin{Revolute{.axis = Vec3::UnitY()}, {}}, shaft.at(Vec3(0.05 * side, 0, 0.5)),
                    rods.back().at(Vec3(-centre, 0, 0)));
      model.apply(SpringDamper{.stiffness = p[0], .damping = 200.0, .free_length = 0.5},
                  rods.back().at(Vec3(0.5 - centre, 0, 0)), slider.at(Vec3(0.05 * side, 0, 0)));
    }
    State start = model.reference_state();
    Vec3 const spin(0, 0, p[2]);
    model.set_velocity(start, shaft, Vec3::Zero(), spin);
    model.set_velocity(start, slider, Vec3::Zero(), spin);
    for (auto const& one : rods) model.set_velocity(start, one, Vec3::Zero(), spin);
    auto const one = rods[0];
    std::vector<Output<M>> outputs{
        {"height [m]", [=](M const& m, State const& x) { return position(m, x, slider.at(Vec3(0, 0, 0)))[2]; }},
        {"angle [rad]",
         [=](M const& m, State const& x) { return std::asin(-frame(m, x, one.at(Vec3(0, 0, 0))).A(2, 0)); }},
        {"turn [rad]", [=](M const& m, State const& x) {
           Mat3 const A = frame(m, x, shaft.at(Vec3(0, 0, 0))).A;
           return std::atan2(A(1, 0), A(0, 0));
         }}};
    return Scenario<M>{std::move(model), start, {.end_time = end, .step = step}, std::move(outputs)};
  };
}

TEST(SensitivitiesOfMechanisms, TheFlyballGovernorTendsToItsEquationsInThreeFreedoms) {
  double const end = 0.25;
  GovernorEquations equations{D::variable(4e3, 0), D::variable(3.0, 1)};
  std::array<D, 6> const start{
      D(0.0), D(std::numbers::pi / 6.0), D(0.5), D::variable(2.0 * std::numbers::pi, 2), D(0.0), D(0.0)};
  // check of the equations themselves with the springs of the benchmark: reference solution of the IFToMM benchmark
  // A05 (R5)
  GovernorEquations stiff{D(8e5), D(3.0), 4e4};
  auto const published = extrapolated(stiff, start, 0.1, 2000);
  EXPECT_NEAR(published[2].v, 0.5238364756, 2e-10);
  EXPECT_NEAR(published[1].v, 0.4961738691, 2e-10);
  EXPECT_NEAR(published[0].v, 0.622106681, 2e-9);
  auto const y = extrapolated(equations, start, end, 200), check = extrapolated(equations, start, end, 300);
  for (std::size_t i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(y[i].d[j], check[i].d[j], 1e-12 * (1.0 + std::abs(y[i].d[j])));
  auto const make_with = [&](double h) { return governor(end, h); };
  expect_tending(make_with, {{"stiffness [N/m]", 4e3}, {"mass [kg]", 3.0}, {"spin [rad/s]", 2.0 * std::numbers::pi}},
                 1e-3, {y[2], y[1], y[0]});
}

// --- flexible slider-crank (D7, IVP Test Set "crank") ------------------------------------------------------------

namespace crank {

constexpr double pi = 3.1415927, m1 = 0.36, m2 = 0.151104, l1 = 0.15, l2 = 0.30, j1 = 0.002727, j2 = 0.0045339259,
                 height = 0.0080, density = 7870.0, b = height * height * l2;
/// Data of the test set: two lateral sine modes, quadratic longitudinal displacements (nodes at the middle and the
/// end).
constexpr double b13 = -16 * b / (pi * pi * pi), b14 = b * (8 / (pi * pi * pi) - 1 / pi), b24 = b / (2 * pi);

planar::FfrIntegrals rod(double young) {
  double const m = density * b, k = young * height * height / l2, slender = (height / l2) * (height / l2);
  planar::FfrIntegrals x = planar::FfrIntegrals::zero(4);
  x.mass = m2;
  x.first = {0.5 * m2 * l2, 0.0};
  x.first_by << 0, 0, density * b * 2 / 3, density * b / 6, density * b * 2 / pi, 0, 0, 0;
  x.inertia = j2;
  x.inertia_by << 0, 0, 2 * density * l2 * b / 3, 2 * density * l2 * b / 6;
  x.coupling << density * l2 * b / pi, -density * l2 * b / (2 * pi), 0, 0;
  x.mass_matrix << 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 8, 1, 0, 0, 1, 2;
  x.mass_matrix *= m;
  x.inertia_second = x.mass_matrix;
  x.coupling_by << 0, 0, b13, b14, 0, 0, 0, b24, -b13, 0, 0, 0, -b14, -b24, 0, 0;
  x.coupling_by *= density;
  double const p4 = pi * pi * pi * pi;
  x.stiffness << p4 / 24 * slender, 0, 0, 0, 0, p4 * 2 / 3 * slender, 0, 0, 0, 0, 16.0 / 3, -8.0 / 3, 0, 0, -8.0 / 3,
      7.0 / 3;
  x.stiffness *= k;
  return x;
}

struct Steady {
  double omega = 150.0;
  Motion operator()(double t) const { return {omega * t, omega, 0.0}; }
};

/// Coordinates φ₂ and q of the rod, whose end carries the slider; the crank rotates at ω. Parameters: E, the slider's
/// mass, ω.
struct Equations {
  D young, m3, omega;

  /// y = (φ₂, q, φ̇₂, q̇).
  std::array<D, 10> operator()(double t, std::array<D, 10> const& y) const {
    using std::cos;
    using std::sin;
    planar::FfrIntegrals const one = rod(1.0);
    D const phi1 = omega * t, ax = -omega * omega * l1 * cos(phi1), ay = -omega * omega * l1 * sin(phi1);
    D const c = cos(y[0]), s = sin(y[0]), w = y[5], length = y[4] + l2, rate = y[9];
    D const bx = c * ax + s * ay, by = c * ay - s * ax;  // acceleration of the crank pin, in axes of the rod
    // [mass matrix, constraint equation of the joint] (φ̈₂, q̈, λ) = forces
    constexpr std::size_t n = 6;
    std::array<std::array<D, n + 1>, n> A{};
    D inertia = j2, inertia_rate = 0.0, sx = one.first[0], sy = one.first[1];
    std::array<D, 4> turn;  // c + Bᵀq
    for (Index i = 0; i < 4; ++i) {
      D by_q = one.inertia_by[i];
      turn[std::size_t(i)] = one.coupling[i];
      sx += y[std::size_t(1 + i)] * one.first_by(0, i);
      sy += y[std::size_t(1 + i)] * one.first_by(1, i);
      inertia += y[std::size_t(1 + i)] * one.inertia_by[i];
      for (Index j = 0; j < 4; ++j) {
        D const& qj = y[std::size_t(1 + j)];
        by_q += qj * (2.0 * one.mass_matrix(i, j));
        turn[std::size_t(i)] += qj * one.coupling_by(j, i);
        inertia += y[std::size_t(1 + i)] * qj * one.mass_matrix(i, j);
        A[std::size_t(1 + i)][std::size_t(1 + j)] = one.mass_matrix(i, j);
        A[std::size_t(1 + i)][n] +=
            y[std::size_t(6 + j)] * w * (2.0 * one.coupling_by(i, j)) - young * qj * one.stiffness(i, j);
      }
      inertia_rate += by_q * y[std::size_t(6 + i)];
      A[std::size_t(1 + i)][n] += by_q * w * w * 0.5 - bx * one.first_by(0, i) - by * one.first_by(1, i);
      A[0][std::size_t(1 + i)] = A[std::size_t(1 + i)][0] = turn[std::size_t(i)];
    }
    A[0][0] = inertia;
    A[0][n] = -(w * inertia_rate) - (by * sx - bx * sy);
    // the slider at x = l₁ cos φ₁ + (l₂ + q₄) cos φ₂
    D const x_phi = -(length * s), x_q = c, x_rest = ax - length * c * w * w - rate * s * w * 2.0;
    A[0][0] += m3 * x_phi * x_phi;
    A[0][4] += m3 * x_phi * x_q;
    A[4][0] += m3 * x_phi * x_q;
    A[4][4] += m3 * x_q * x_q;
    A[0][n] -= m3 * x_phi * x_rest;
    A[4][n] -= m3 * x_q * x_rest;
    // l₁ sin φ₁ + (l₂ + q₄) sin φ₂ = 0
    A[0][5] = A[5][0] = length * c;
    A[4][5] = A[5][4] = s;
    A[5][n] = length * s * w * w - rate * c * w * 2.0 - ay;
    for (std::size_t k = 0; k < n; ++k) {
      std::size_t pivot = k;
      for (std::size_t i = k + 1; i < n; ++i)
        if (std::abs(A[i][k].v) > std::abs(A[pivot][k].v)) pivot = i;
      std::swap(A[k], A[pivot]);
      for (std::size_t i = k + 1; i < n; ++i) {
        D const f = A[i][k] / A[k][k];
        for (std::size_t j = k; j <= n; ++j) A[i][j] -= f * A[k][j];
      }
    }
    std::array<D, n> z;
    for (std::size_t k = n; k-- > 0;) {
      D sum = A[k][n];
      for (std::size_t j = k + 1; j < n; ++j) sum -= A[k][j] * z[j];
      z[k] = sum / A[k][k];
    }
    return {y[5], y[6], y[7], y[8], y[9], z[0], z[1], z[2], z[3], z[4]};
  }
};

constexpr double q3_start = 0.103339863e-4, q4_start = 0.169327969e-4;

auto made(double end, double step) {
  return [=](P p) {
    using Pin = Joint<planar::Revolute, Constraint>;
    using Slide = Joint<planar::Prismatic, Constraint>;
    using Drive = Joint<PrescribedAngle<Steady>, Constraint>;
    using M = Model<Bodies<planar::Rigid, planar::Ffr>, Joints<Pin, Slide, Drive>>;
    M model;
    auto const arm = model.add(planar::Rigid(m1, j1 - m1 * l1 * l1 / 4, Placement::planar(l1 / 2, 0)), "crank");
    auto const slider = model.add(planar::Rigid(p[1], 1e-4, Placement::planar(l1 + l2, 0)), "slider");
    auto const link = model.add(planar::Ffr(rod(p[0]), {.placement = Placement::planar(l1, 0)}), "rod");
    FfrPoint origin;
    origin.S = origin.R = MatX::Zero(3, 4);
    FfrPoint tip = origin;
    tip.u = {l2, 0, 0};
    tip.S(0, 3) = 1.0;
    model.connect(Pin{}, model.ground().at({0, 0, 0}), arm.at(Vec2(-l1 / 2, 0)));
    model.connect(Drive{{Steady{p[2]}}, {}}, model.ground().at({0, 0, 0}), arm.at(Vec2(0, 0)));
    model.connect(Pin{}, arm.at(Vec2(l1 / 2, 0)), link.at(origin));
    model.connect(Pin{}, link.at(tip), slider.at(Vec2(0, 0)));
    model.connect(Slide{}, model.ground().at({0, 0, 0}), slider.at(Vec2(0, 0)));
    State start = model.reference_state();
    start.q[3] = l1 + l2 + q4_start;
    start.q.tail<4>() << 0, 0, q3_start, q4_start;
    start.v[1] = p[2] * l1 / 2;
    start.v[2] = p[2];
    start.v[7] = p[2] * l1;
    start.v[8] = -p[2] * l1 / (l2 + q4_start);
    std::vector<Output<M>> outputs{{"phi2 [rad]", [](M const&, State const& x) { return x.q[8]; }},
                                   {"q1 [m]", [](M const&, State const& x) { return x.q[9]; }},
                                   {"q2 [m]", [](M const&, State const& x) { return x.q[10]; }},
                                   {"q4 [m]", [](M const&, State const& x) { return x.q[12]; }}};
    return Scenario<M>{std::move(model), start, {.end_time = end, .step = step}, std::move(outputs)};
  };
}

}  // namespace crank

TEST(SensitivitiesOfMechanisms, TheFlexibleSliderCrankTendsToItsEquations) {
  using namespace crank;
  // check of the equations themselves: published initial values on the smooth solution, at t = 0.025 [Simeon, IVP
  // Test Set "crank"] (D7)
  std::array<D, 10> start{D(0.0),
                          D(0.0),
                          D(0.0),
                          D(q3_start),
                          D(q4_start),
                          D(-150.0 * l1 / (l2 + q4_start)),
                          D(0.444896105),
                          D(0.463434311e-2),
                          D(-0.178591076e-5),
                          D(-0.268938672e-5)};
  auto const published = extrapolated(Equations{D(0.2e12), D(0.075552), D(150.0)}, start, 0.025, 400);
  EXPECT_NEAR(published[0].v, 0.28982893967, 2e-11);
  EXPECT_NEAR(published[1].v, -1.9477824541e-4, 2e-11);
  EXPECT_NEAR(published[4].v, -8.0241594207e-6, 2e-12);
  // a rod with a hundredth of that modulus, so that the steps resolve its longitudinal vibration
  D const young = D::variable(0.2e10, 0), m3 = D::variable(0.075552, 1), omega = D::variable(150.0, 2);
  start = {D(0.0), D(0.0), D(0.0), D(q3_start), D(q4_start), -omega * l1 / (l2 + q4_start),
           D(0.0), D(0.0), D(0.0), D(0.0)};
  double const end = 0.01;
  auto const y = extrapolated(Equations{young, m3, omega}, start, end, 200),
             check = extrapolated(Equations{young, m3, omega}, start, end, 300);
  for (std::size_t i : {0u, 1u, 2u, 4u})
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(y[i].d[j], check[i].d[j], 1e-11 * std::abs(y[i].d[j]));
  auto const make_with = [&](double h) { return made(end, h); };
  expect_tending(make_with, {{"young [Pa]", 0.2e10}, {"mass [kg]", 0.075552}, {"omega [rad/s]", 150.0}}, 2e-5,
                 {y[0], y[1], y[2], y[4]});
}

}  // namespace sensitivities_mechanisms_test
