// Axial forces that a floating frame without geometric stiffening neglects, compared with the buckling loads. The
// references are Euler's columns and Greenhill's column, which buckles under its own weight at q L³/EI = 7.8373
// (first zero of J₋₁⸝₃). The warnings of runs are checked.
#include <gtest/gtest.h>

#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/ffr/planar_ffr.hpp>
#include <polybody/compare/compare.hpp>
#include <polybody/polybody.hpp>

namespace axial_warnings_test {

using namespace polybody;
using std::numbers::pi;

constexpr double EI = 2.0, length = 1.5, density = 0.8;  // [N m², m, kg/m]

Bar column() {
  return {
      .length = length,
      .constants = BarConstants{.EA = 1e7, .EI = EI, .mass_per_length = density, .GJ = 1.0, .rotary_inertia = 1e-4}};
}

/// Column in a frame tied to its first end, without geometric stiffening.
template <class Body = Ffr>
Body unstiffened(Bar const& bar, Index n) {
  return Body::from(bar, n, {.frame = FfrFrame::clamped, .stiffening = false});
}
/// Ratio for a body at rest at the origin, under loads and gravity.
double share(Ffr const& body, Vec3 const& gravity, std::vector<PlacedWrench> const& loads) {
  std::vector<double> q(std::size_t(body.coordinates())), zero(std::size_t(body.velocities()), 0.0);
  body.reference(q);
  return body.axial_share(q, zero, zero, gravity, loads);
}
std::vector<PlacedWrench> pressed_with(double p) {
  return {{Vec3(0, 0, 0), {Vec3(p, 0, 0), Vec3(0, 0, 0)}}, {Vec3(length, 0, 0), {Vec3(-p, 0, 0), Vec3(0, 0, 0)}}};
}

TEST(AxialForces, ShareOfEulersLoads) {
  Structure const s = structure_of(column(), 8);
  double const euler = pi * pi * EI / (length * length);
  Ffr const cantilever = unstiffened(column(), 8),
            pinned(s, fixed_interface_modes(s, 4, ReferenceConditions::simply_supported(0, 8))),
            in_mean_axes = Ffr::from(column(), 8, {.stiffening = false});
  for (double const part : {0.1, 0.5, 1.0}) {
    EXPECT_NEAR(share(cantilever, Vec3::Zero(), pressed_with(0.25 * part * euler)), -part, 2e-3 * part);
    EXPECT_NEAR(share(pinned, Vec3::Zero(), pressed_with(part * euler)), -part, 2e-3 * part);
    EXPECT_NEAR(share(in_mean_axes, Vec3::Zero(), pressed_with(part * euler)), -part, 2e-3 * part);
  }
  EXPECT_NEAR(share(cantilever, Vec3::Zero(), pressed_with(-0.05 * euler)), 0.2, 1e-3);  // in tension
  EXPECT_EQ(share(Ffr::from(column(), 8), Vec3::Zero(), pressed_with(euler)), 0.0);
}

TEST(AxialForces, ShareOfGreenhillsWeight) {
  double const falls = 7.83734 * EI / (density * length * length * length);
  EXPECT_NEAR(share(unstiffened(column(), 12), Vec3(-0.3 * falls, 0, 0), {}), -0.3, 1e-3);
  EXPECT_NEAR(share(unstiffened(column(), 12), Vec3(0, -falls, 0), {}), 0.0, 1e-9);  // horizontal
}

// A beam that rotates with Ω about its root has N = ½ ρA Ω² (L² − x²). The largest ∫N w′² dx / ∫EI w″² dx is
// 0.0976244 ρA Ω² L⁴/EI (Ritz method with x² to x⁸).
template <class Body>
double spun(Body const& body, double omega) {
  std::vector<double> q(std::size_t(body.coordinates())), v(std::size_t(body.velocities()), 0.0), a = v;
  body.reference(q);
  v[body.velocities() == 3 + body.deformations() ? 2 : 5] = omega;
  return body.axial_share(q, v, a, Vec3::Zero(), {});
}
TEST(AxialForces, ShareOfCentrifugalForces) {
  double const found = spun(unstiffened(column(), 12), 2.0);
  EXPECT_NEAR(found, 0.0976244 * density * 4.0 * std::pow(length, 4) / EI, 1e-3 * found);
  EXPECT_NEAR(spun(unstiffened<planar::Ffr>(column(), 12), 2.0), found, 1e-3 * found);
  Bar turned = column();
  turned.placement = Placement::at({1.0, 2.0, 3.0}, {0.0, 0.0, 0.7});
  EXPECT_NEAR(spun(unstiffened(turned, 12), 2.0), found, 1e-9 * found);
  EXPECT_NEAR(spun(unstiffened(column(), 12), 4.0), 4.0 * found, 1e-9 * found);
}

template <class B, class Clamp = Joint<Weld, Constraint>, class Force = PointForce<>>
struct Pressed {
  Model<Bodies<B>, Joints<Clamp>, Forces<Force>> model;
  State x;
  Pressed(B body, double p) {
    auto const b = model.add(std::move(body), "column");
    model.connect(Clamp{}, model.ground().at({0, 0, 0}), b.at(0.0), "clamp");
    model.apply(Force{.force = {-p, 0, 0}}, b.at(length));
    x = model.reference_state();
  }
  std::vector<std::string> warnings() {
    return simulate(model, x, GeneralisedAlpha{.rho_inf = 0.6}, {.end_time = 0.05, .step = 1e-3}).run().warnings;
  }
};

TEST(AxialForces, ARunWarnsOfThem) {
  double const buckles = 0.25 * pi * pi * EI / (length * length);
  std::vector<std::string> const said = Pressed<Ffr>(unstiffened(column(), 4), 0.17 * buckles).warnings();
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("\"column\" are in compression at t = "), std::string::npos) << said[0];
  EXPECT_NE(said[0].find(" % of the load that buckles them"), std::string::npos) << said[0];
  EXPECT_NE(said[0].find(".stiffening = true"), std::string::npos) << said[0];
  EXPECT_TRUE(Pressed<Ffr>(unstiffened(column(), 4), 0.03 * buckles).warnings().empty());
  EXPECT_TRUE(Pressed<Ffr>(Ffr::from(column(), 4), 0.17 * buckles).warnings().empty());
  using InPlane = Pressed<planar::Ffr, Joint<planar::Weld, Constraint>>;
  EXPECT_EQ(InPlane(unstiffened<planar::Ffr>(column(), 4), 0.17 * buckles).warnings().size(), 1u);
}

// The tension N of the reference state displaces a free end inwards by N L/EA.
TEST(AxialForces, OfAPretensionShortenTheBody) {
  Bar bar = column();
  bar.constants->EA = 500.0;
  bar.pretension = 3.0;
  Model<Bodies<Ffr>, Joints<Joint<Weld, Constraint>>> model;
  auto const body = model.add(Ffr::from(bar, 3));
  model.connect(Joint<Weld, Constraint>{}, model.ground().at({0, 0, 0}), body.at(0.0));
  State x = model.reference_state();
  equilibrium(model, x);
  EXPECT_NEAR(position(model, x, body.at(length))[0], length * (1.0 - 3.0 / 500.0), 1e-10);
}

}  // namespace axial_warnings_test
