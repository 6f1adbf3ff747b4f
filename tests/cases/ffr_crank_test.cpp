// CASES D7: the flexible slider-crank of the IVP Test Set (Simeon), its rod a floating frame with the test set's own
// modal matrices.
#include <gtest/gtest.h>

#include <polybody/bodies/ffr/planar_ffr.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/integrators/generalized_alpha.hpp>
#include <polybody/joints/planar/prismatic.hpp>
#include <polybody/joints/planar/revolute.hpp>
#include <polybody/joints/policies/constraint.hpp>
#include <polybody/joints/prescribed_angle.hpp>
#include <polybody/run/observe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/held.hpp"

namespace ffr_crank_test {

using namespace polybody;

double const pi = 3.1415927, m1 = 0.36, m2 = 0.151104, m3 = 0.075552, l1 = 0.15, l2 = 0.30, j1 = 0.002727,
             j2 = 0.0045339259;
double const young = 0.20e12, height = 0.0080, density = 7870.0, omega = 150.0;

/// Two sine modes across, quadratic displacements along (middle and end); the test set's numbers, its M_q included.
planar::FfrIntegrals rod_integrals() {
  double const b = height * height * l2, m = density * b, k = young * height * height / l2,
               slender = (height / l2) * (height / l2);
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
  double const b13 = -16 * b / (pi * pi * pi), b14 = b * (8 / (pi * pi * pi) - 1 / pi), b24 = b / (2 * pi);
  x.coupling_by << 0, 0, b13, b14, 0, 0, 0, b24, -b13, 0, 0, 0, -b14, -b24, 0, 0;
  x.coupling_by *= density;
  double const p4 = pi * pi * pi * pi;
  x.stiffness << p4 / 24 * slender, 0, 0, 0, 0, p4 * 2 / 3 * slender, 0, 0, 0, 0, 16.0 / 3, -8.0 / 3, 0, 0, -8.0 / 3,
      7.0 / 3;
  x.stiffness *= k;
  return x;
}

struct Steady {
  Motion operator()(double t) const { return {omega * t, omega, 0.0}; }
};

TEST(FlexibleSliderCrank, ReproducesTheTestSetWithItsOwnMatrices) {
  using Pin = Joint<planar::Revolute, Constraint>;
  using Slide = Joint<planar::Prismatic, Constraint>;
  using Drive = Joint<PrescribedAngle<Steady>, Constraint>;
  Model<Bodies<planar::Rigid, planar::Ffr>, Joints<Pin, Slide, Drive>> model;
  auto const crank = model.add(planar::Rigid(m1, j1 - m1 * l1 * l1 / 4, Placement::planar(l1 / 2, 0)), "crank");
  auto const slider = model.add(planar::Rigid(m3, 1e-4, Placement::planar(l1 + l2, 0)), "slider");
  auto const rod = model.add(planar::Ffr(rod_integrals(), {.placement = Placement::planar(l1, 0)}), "rod");
  FfrPoint origin;
  origin.S = origin.R = MatX::Zero(3, 4);
  FfrPoint end = origin;
  end.u = {l2, 0, 0};
  end.S(0, 3) = 1.0;
  model.connect(Pin{}, model.ground().at({0, 0, 0}), crank.at(Vec2(-l1 / 2, 0)), "main bearing");
  model.connect(Drive{{Steady{}}, {}}, model.ground().at({0, 0, 0}), crank.at(Vec2(0, 0)), "drive");
  model.connect(Pin{}, crank.at(Vec2(l1 / 2, 0)), rod.at(origin), "crank pin");
  model.connect(Pin{}, rod.at(end), slider.at(Vec2(0, 0)), "wrist pin");
  model.connect(Slide{}, model.ground().at({0, 0, 0}), slider.at(Vec2(0, 0)), "guide");

  State x = model.reference_state();
  // order of coordinates: crank (x, y, θ), slider, rod (x, y, θ, q)
  double const q4 = 0.169327969e-4;
  x.q[3] = 0.450016933;
  x.q.tail<4>() << 0, 0, 0.103339863e-4, q4;
  x.v[1] = omega * l1 / 2;
  x.v[2] = omega;
  x.v[3] = -0.268938672e-5;
  x.v[7] = omega * l1;
  x.v[8] = -74.9957670;
  x.v.tail<4>() << 0.444896105, 0.463434311e-2, -0.178591076e-5, -0.268938672e-5;

  struct Row {
    double t, phi2, x3, q[4];
  };
  std::vector<Row> const rows{
      {0.025, 0.28982893967, 0.16439623988, {-1.9477824541e-4, -2.0053495884e-5, -5.1499090637e-6, -8.0241594207e-6}},
      {0.05, -0.48815811706, 0.31695478651, {1.2739426524e-3, 4.2086886755e-5, -1.2705137884e-7, 3.29077e-8}},
      {0.1,
       -0.3311734988256260,
       0.1697373328427860,
       {0.1893192899613509e-3, 0.2375751249879174e-4, -0.5323896770569702e-5, -0.8363313279112129e-5}}};
  std::size_t next = 0;
  for (State const& now : simulate(model, x, GeneralizedAlpha{.rho_inf = 0.8}, {.until = 0.1, .step = 1e-5})) {
    if (next == rows.size() || std::abs(now.t - rows[next].t) > 1e-9) continue;
    Row const& row = rows[next++];
    auto const claim = [&](char const* what) {
      bool const printed = row.t == 0.1;
      return Claim{"D7", what, printed ? By::published : By::independent,
                   printed ? "IVP Test Set crank, its own matrices: MEBDFI at a tolerance of 1e-14"
                           : "the test set's equations by another solver",
                   "planar Ffr, 4 modes, generalised-α, h = 1e-5 s"};
    };
    Instance const at{equals("t", now.t)};
    held(claim("angle of the rod [rad]"), now.q[8], row.phi2, 1e-5, at);
    held(claim("place of the slider [m]"), now.q[3], row.x3, 1e-5, at);
    double const size = 1.27e-3;  // of q1 over the run
    held(claim("q₁, first sine across [m]"), now.q[9], row.q[0], 0.01 * std::max(std::abs(row.q[0]), 0.1 * size), at);
    held(claim("q₂, second sine across [m]"), now.q[10], row.q[1], 0.02 * 4.2e-5, {at.at, 4.2e-5});
    held(claim("q₃, stretch of the middle [m]"), now.q[11], row.q[2], 0.02 * 1e-5, {at.at, 1e-5});
    held(claim("q₄, stretch of the end [m]"), now.q[12], row.q[3], 0.02 * 1e-5, {at.at, 1e-5});
  }
  EXPECT_EQ(next, rows.size());
}

}  // namespace ffr_crank_test
