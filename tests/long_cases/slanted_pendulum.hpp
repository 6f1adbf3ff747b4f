#pragma once
/// \file
/// M7: double pendulum of two beams with the second hinge at 45° (data of SHARPy's TestDoublePendulumSlanted). The
/// references are spectral geometrically exact beams and, for rigid bars, Lagrange's equations of two angles.

#include "mechanism.hpp"

namespace polybody::long_cases {

struct PendulumRow {
  double t;
  Vec3 elbow, tip;
};
inline PendulumRow const flexible_pendulum[] = {
    {0.1, {0.496163, -0.000150, -0.061826}, {0.995779, 0.006062, -0.043243}},
    {0.2, {0.451584, -0.000005, -0.214644}, {0.948061, 0.057564, -0.200638}},
    {0.3, {0.323581, 0.000184, -0.381176}, {0.798384, 0.103119, -0.499357}},
    {0.4, {0.134300, 0.000093, -0.481626}, {0.452521, 0.045878, -0.864562}},
    {0.5, {-0.001159, 0.000630, -0.499999}, {-0.177227, 0.034625, -0.966737}},
    {0.6, {-0.224519, -0.000153, -0.446757}, {-0.647742, 0.083750, -0.699428}},
    {1.0, {-0.499203, 0.000347, 0.028214}, {-0.981828, 0.026391, -0.099831}}};
inline PendulumRow const rigid_pendulum[] = {
    {0.1, {0.496163072, 0, -0.061823995}, {0.995775396, 0.006518407, -0.043248861}},
    {0.2, {0.451505312, 0, -0.214809110}, {0.947932693, 0.057903143, -0.200418793}},
    {0.3, {0.323347662, 0, -0.381374212}, {0.798231238, 0.103132580, -0.499057093}},
    {0.4, {0.134146790, 0, -0.481668598}, {0.452354842, 0.045712716, -0.864622882}},
    {0.5, {0.001808020, 0, -0.499996731}, {-0.181215777, 0.036826406, -0.963835179}},
    {0.6, {-0.225373929, 0, -0.446325657}, {-0.648732966, 0.083796882, -0.698803792}},
    {1.0, {-0.498982951, 0, 0.031874977}, {-0.979418342, 0.029173043, -0.103516194}}};

template <class B>
struct SlantedPendulum {
  Mechanism<B> model{Gravity{0, 0, -9.81}};
  BodyHandle<B> upper, lower;
  State x;

  /// \param make makes a body from a bar
  template <class Make>
  explicit SlantedPendulum(Make const& make)
      : upper(model.add(make(bar(0.0)), "upper")), lower(model.add(make(bar(0.5)), "lower")) {
    model.connect(hinge(Vec3::UnitY()), model.ground().at({0, 0, 0}), upper.at(0.0), "hinge");
    model.connect(hinge(Vec3(1, 1, 0).normalized()), upper.at(0.5), lower.at(0.0), "elbow");
    x = model.reference_state();
  }
  SlantedPendulum(SlantedPendulum const&) = delete;

  static Bar bar(double start) {
    return {.length = 0.5,
            .constants = BarConstants{.EA = 2.8e7,
                                      .EI = 933.3,
                                      .mass_per_length = 1.08,
                                      .GA = 1.037e7,
                                      .GJ = 691.4,
                                      .rotary_inertia = 3.6e-5},
            .placement = Placement::at({start, 0, 0})};
  }
};

/// Runs to t = 1 s. \param early, late tolerances of the distance until 0.5 s and after [m]
template <class B, class Make, class I>
void pendulum_follows(Make const& make, I const& integrator, double h, PendulumRow const (&table)[7], double early,
                      double late, std::string const& formulation) {
  SlantedPendulum<B> m(make);
  bool const flexible = &table == &flexible_pendulum;
  auto const claim = [&](char const* what) {
    return Claim{"M7", what, By::independent,
                 flexible ? "spectral geometrically exact beams, RKF78" : "Lagrange's equations of two angles, DOP853",
                 formulation};
  };
  for (PendulumRow const& row : table) {
    simulate(m.model, m.x, integrator, {.end_time = row.t, .step = h}).run();
    double const off = row.t < 0.55 ? early : late;
    Instance const at{equals("t", row.t), 1.0};
    held_within(claim("place of the elbow [m]"), (position(m.model, m.x, m.upper.at(0.5)) - row.elbow).norm(), off, at);
    held_within(claim("place of the tip [m]"), (position(m.model, m.x, m.lower.at(0.5)) - row.tip).norm(), off, at);
    held({"M7", "energy [J]", By::closed_form, "invariant, zero", formulation}, energy(m.model, m.x).total(), 0.0,
         0.1 * off * 9.81, {at.at, 5.0});
  }
}

}  // namespace polybody::long_cases
