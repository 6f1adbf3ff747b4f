// Light cart-pole (M4, proposed for the IFToMM library): a cart of 1e-6 kg under a pendulum of 1 kg.

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/integrators/adams_bashforth_moulton.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/held.hpp"

namespace polybody {
namespace light_cart_pole_test {

constexpr double cart_mass = 1e-6, pole_mass = 1.0, g = 9.81;

/// The cart moves along x. The pendulum has a length of 1 m and its point mass starts at the height of the cart.
template <class Policy>
struct CartPole {
  using Track = Joint<planar::Prismatic, Policy>;
  using Pin = Joint<planar::Revolute, Policy>;
  using Body = planar::Rigid;
  Model<Bodies<Body>, Joints<Track, Pin>> model{Gravity{0, -g, 0}};
  BodyHandle<Body> cart = model.add(Body(cart_mass, 0.0), "cart");
  BodyHandle<Body> mass = model.add(Body(pole_mass, 0.0, Placement::planar(1.0, 0.0)), "mass");
  State x;

  CartPole() {
    model.connect(Track{planar::Prismatic{.axis = {1, 0, 0}}, {}}, model.ground().at(Vec3(0, 0, 0)),
                  cart.at(Vec2(0, 0)), "track");
    model.connect(Pin{}, cart.at(Vec2(0, 0)), mass.at(Vec2(-1, 0)), "pin");
    x = model.reference_state();
  }
  double place() const { return x.q[0]; }
  double speed() const { return x.v[0]; }
  double angle() const { return x.q[5] + 0.5 * std::numbers::pi; }  ///< from the downward vertical
  double rate() const { return x.v[5]; }
};

struct Row {
  double t, angle, rate, place, speed;
};
constexpr Row table[] = {{0.1, 1.521726637241122, -0.9821822274278464, 0.001203674462721252, 0.04817599005613343},
                         {0.3, 1.113582331681900, -3.279890735382987, 0.1027140372631755, 1.447906253715433},
                         {0.45, 0.1161556635400831, -38.08921297898406, 0.8841044742496975, 37.83251145755424},
                         {0.5, -0.6487991074309883, -6.543713163971365, 1.604228354236876, 5.214090794868471},
                         {1, -1.524675515758677, 0.9521010502029073, 1.998934624974967, -0.04389606274977867},
                         {2, 1.385316810188215, -1.935372825677400, 0.01715205063820511, 0.3569169319964900},
                         {3, -1.142919312852145, 3.135977928134140, 1.909846802094183, -1.301241825326495},
                         {4, 0.7411816501442929, -5.634740748935485, 0.3248396230093848, 4.156582213137703},
                         {5, 0.5389876497103512, 7.994783629565927, 0.4867320865554119, -6.861346119552751},
                         {10, -1.549129441894828, 0.6521277749764741, 1.999763282468728, -0.01412845780716923}};

Claim quadrature(char const* what, std::string const& formulation) {
  return {"M4", what, By::independent, "quadrature t(θ) of the energy integral, 40 digits", formulation};
}

/// Comparison at t = 0.1 … 10 s, through eleven crossings of the vertical, each a microsecond long. The published
/// measure accepts 1e-6 as the root mean square of both errors. Here each row of the table satisfies `tolerance` in θ
/// and x.
template <class Policy, class I>
void follows(I const& integrator, double tolerance, std::string const& formulation) {
  CartPole<Policy> c;
  for (Row const& row : table) {
    simulate(c.model, c.x, integrator, {.end_time = row.t, .step = 1e-4}).run();
    Instance const at{equals("t", row.t), 1.0};
    held(quadrature("angle of the pole [rad]", formulation), c.angle(), row.angle, tolerance, at);
    held(quadrature("place of the cart [m]", formulation), c.place(), row.place, tolerance, at);
    // θ̈ is at most 75 rad/s² at the times of the rows, except t = 0.45 s with 3300 rad/s²
    double const slope = row.t == 0.45 ? 3.3e3 : 80.0;
    Instance const of_rate{at.at, std::abs(row.rate)};
    held(quadrature("rate of the pole [rad/s]", formulation), c.rate(), row.rate, slope * tolerance, of_rate);
    held({"M4", "energy [J]", By::closed_form, "invariant, zero", formulation}, energy(c.model, c.x).total(), 0.0,
         100.0 * tolerance, {at.at, g});
    held({"M4", "moment of the masses along the track [kg m]", By::closed_form, "invariant, m l", formulation},
         cart_mass * c.place() + pole_mass * position(c.model, c.x, c.mass.at(Vec2(0, 0)))[0], 1.0, tolerance, at);
  }
}

TEST(LightCartPole, MovesAsTheQuadratureSays) {
  double const rtol = 1e-10, atol = 1e-12;
  follows<Constraint>(DormandPrince<Projection>{.relative_tolerance = rtol, .absolute_tolerance = atol}, 1e-6,
                      "planar::Rigid, Constraint, Dormand–Prince, tolerance 1e-10");
  follows<JointCoordinates>(DormandPrince<>{.relative_tolerance = rtol, .absolute_tolerance = atol}, 1e-6,
                            "planar::Rigid, joint coordinates, Dormand–Prince, tolerance 1e-10");
  follows<Constraint>(AdamsBashforthMoulton<Projection>{.relative_tolerance = 1e-12, .absolute_tolerance = atol}, 1e-6,
                      "planar::Rigid, Constraint, Adams–Bashforth–Moulton, tolerance 1e-12");
}

}  // namespace light_cart_pole_test
}  // namespace polybody
