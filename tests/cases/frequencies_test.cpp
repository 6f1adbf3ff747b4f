// Vibrations of straight beams by Euler–Bernoulli (E1) and Timoshenko (E2) theory, and buckling of a beam in
// compression (S9e).

#include <polybody/vibration/modes.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/statics/equilibrium.hpp>

#include "support/held.hpp"

using namespace polybody;

namespace frequencies_test {

using Clamp = Joint<planar::Weld, Constraint>;
using Pin = Joint<planar::Revolute, Constraint>;

enum class Ends { clamped_free, pinned_pinned, free_free };
char const* name_of(Ends ends) {
  return ends == Ends::clamped_free ? "clamped–free" : ends == Ends::pinned_pinned ? "pinned–pinned" : "free–free";
}

/// Frequencies of a planar beam along x with these end conditions, without rigid motions.
template <class B>
VecX frequencies(Bar const& bar, Index n, Ends ends) {
  Model<Bodies<B>, Joints<Clamp, Pin>> model;
  auto const beam = model.add(B::from(bar, n), "beam");
  double const l = bar.length;
  if (ends == Ends::clamped_free) model.connect(Clamp{}, model.ground().at({0, 0, 0}), beam.at(0.0));
  if (ends == Ends::pinned_pinned) {
    model.connect(Pin{}, model.ground().at({0, 0, 0}), beam.at(0.0));
    model.connect(Pin{}, model.ground().at({l, 0, 0}), beam.at(l));
  }
  Modes const m = modes(model, model.reference_state(), 12);
  Index const rigid = ends == Ends::free_free ? 3 : 0;
  for (Index i = 0; i < rigid; ++i) EXPECT_LT(std::abs(m.frequency[i]), 1e-3 * m.frequency[rigid]);
  return m.frequency.tail(m.frequency.size() - rigid);
}

/// A large EA moves the axial modes to high frequencies.
Bar slender() { return {.length = 1.0, .constants = BarConstants{.EA = 1e6, .EI = 1.0, .mass_per_length = 1.0}}; }

// E1: 8 elements, clamped–free: modes 1 and 2 to 1e-4, mode 3 to 1e-3. With other end conditions the error is that of
// cubic elements with consistent mass. For an element of length l it is ω_h/ω = 1 + (β l)⁴/1440 to leading order
// (dispersion of a wave in a row of elements).
TEST(EulerBernoulli, CableHasTheFrequenciesOfTheBeam) {
  struct Row {
    Ends ends;
    double beta[3];
  };
  double const pi = std::numbers::pi;
  for (Row const& row : {Row{Ends::clamped_free, {1.875104068711961, 4.694091132974175, 7.854757438237613}},
                         Row{Ends::pinned_pinned, {pi, 2 * pi, 3 * pi}},
                         Row{Ends::free_free, {4.730040744862704, 7.853204624095838, 10.99560783800167}}}) {
    VecX const w = frequencies<planar::AncfCable<>>(slender(), 8, row.ends);
    for (int i = 0; i < 3; ++i) {
      double const exact = row.beta[i] * row.beta[i], error = w[i] / exact - 1.0;
      if (row.ends == Ends::clamped_free) {
        held({"E1", "frequencies clamped–free, ω √(ρA L⁴/EI)", By::closed_form, "β², 1 + cos β cosh β = 0",
              "planar AncfCable, 8 elements"},
             w[i], exact, (i < 2 ? 1e-4 : 1e-3) * exact, {equals("mode", i + 1)});
      } else {
        double const expected = std::pow(row.beta[i] / 8.0, 4) / 1440.0;
        EXPECT_NEAR(error, expected, 0.2 * expected) << name_of(row.ends) << ' ' << i;
        held({"E1", std::string("frequencies ") + name_of(row.ends) + ", with the elements' own error, ω √(ρA L⁴/EI)",
              By::closed_form, "β² (1 + (β l)⁴/1440)", "planar AncfCable, 8 elements"},
             w[i], exact * (1.0 + expected), 0.2 * expected * exact, {equals("mode", i + 1)});
      }
    }
  }
}

// In space every bending mode occurs twice, once in each plane.
TEST(EulerBernoulli, SpatialCableBendsInTwoPlanes) {
  using Cable = AncfCable<>;
  using Hold = Joint<Revolute, Constraint>;
  Model<Bodies<Cable>, Joints<Hold>> model;
  Placement const askew = Placement::at({1, 2, 3}, {0.4, -0.9, 1.7});
  Bar bar = slender();
  bar.placement = askew;
  auto const cable = model.add(Cable::from(bar, 8), "cable");
  model.connect(Hold{Revolute{.axis = askew.axes.col(0)}, {}}, model.ground().at(askew), cable.at(0.0), "clamp");
  VecX const w = modes(model, model.reference_state()).frequency;
  double const beta[] = {1.875104068711961, 4.694091132974175, 7.854757438237613};
  for (int i = 0; i < 3; ++i)
    for (int twin = 0; twin < 2; ++twin)
      held({"E1", "frequencies clamped–free, in two planes, ω √(ρA L⁴/EI)", By::closed_form, "β², 1 + cos β cosh β = 0",
            "AncfCable, 8 elements"},
           w[2 * i + twin], beta[i] * beta[i], (i < 2 ? 1e-4 : 1e-3) * beta[i] * beta[i], {equals("mode", i + 1)});
}

/// E2: effects of rotary inertia and shear. Square sections of width h. A large EA moves the axial modes to high
/// frequencies. (One axial mode of the thick free beam would differ by 4e-4 from its fourth bending mode.)
Bar square(double length, double h, double e, double k) {
  double const rho = 7850, a = h * h, i = h * h * h * h / 12.0;
  return {.length = length,
          .constants = BarConstants{.EA = 1e3 * e * a,
                                    .EI = e * i,
                                    .mass_per_length = rho * a,
                                    .GA = k * e / 2.6 * a,
                                    .rotary_inertia = rho * i}};
}
Bar thick() { return square(2.0, 0.4, 1e9, 0.849673202614); }
Bar steel() { return square(1.0, 0.05, 2.1e11, 5.0 / 6.0); }

// Linear elements converge with order two: Richardson extrapolation of 32 and 64 elements gives the limit.
TEST(Timoshenko, LrvfConvergesToThickAndSlenderBeams) {
  struct Row {
    Bar bar;
    char const* name;
    Ends ends;
    std::vector<double> omega;
  };
  for (Row const& row :
       {Row{thick(), "thick", Ends::pinned_pinned, {95.6339808811, 332.234513637, 635.696288366, 965.735466899}},
        Row{thick(), "thick", Ends::clamped_free, {35.1471170634, 189.630725571, 451.968391702, 751.172843383}},
        Row{thick(), "thick", Ends::free_free, {204.165814718, 477.907465926, 795.841399697, 1121.74501164}},
        Row{steel(), "slender", Ends::pinned_pinned, {733.710892927, 2898.81548367, 6395.02032507}},
        Row{steel(), "slender", Ends::clamped_free, {261.963564513, 1622.57753153, 4461.35343888}},
        Row{steel(), "slender", Ends::free_free, {1655.24217476, 4488.59199519, 8600.30960638}}}) {
    VecX const coarse = frequencies<planar::Lrvf>(row.bar, 32, row.ends);
    VecX const fine = frequencies<planar::Lrvf>(row.bar, 64, row.ends);
    for (Index i = 0; i < Index(row.omega.size()); ++i) {
      double const omega = row.omega[std::size_t(i)], c = coarse[i] - omega, f = fine[i] - omega;
      EXPECT_NEAR(c / f, 4.0, 0.1) << name_of(row.ends) << ' ' << omega;
      held({"E2", std::string("frequencies of the ") + row.name + " beam, " + name_of(row.ends) + " [rad/s]",
            By::independent, "roots of Timoshenko's characteristic equation",
            "planar Lrvf, 32 and 64 elements extrapolated"},
           omega + f - (c - f) / 3.0, omega, 5e-5 * omega, {equals("ω", omega)});
    }
  }
}

// S9e: clamped–free, P = π²EI/4L². The lowest frequency vanishes at this load. The straight state is unstable above
// it.
TEST(Buckling, FrequencyVanishesAtEulersLoad) {
  using Cable = planar::AncfCable<planar::EngineeringStrain>;
  double const critical = 0.25 * std::numbers::pi * std::numbers::pi;
  auto const lowest = [&](double load) {
    Model<Bodies<Cable>, Joints<Clamp>, Forces<PointForce<>>> model;
    auto const beam = model.add(Cable::from(slender(), 8), "column");
    model.connect(Clamp{}, model.ground().at({0, 0, 0}), beam.at(0.0));
    model.apply(PointForce<>{.force = {-load, 0, 0}}, beam.at(1.0));
    State x = model.reference_state();
    equilibrium(model, x);
    return modes(model, x, 1).frequency[0];
  };
  EXPECT_GT(lowest(0.999 * critical), 0.0);
  EXPECT_LT(lowest(1.001 * critical), 0.0);
  EXPECT_LT(lowest(0.5 * critical), lowest(0.0));
  double low = 0.99 * critical, high = 1.01 * critical;
  for (int i = 0; i < 12; ++i) {
    double const middle = 0.5 * (low + high);
    (lowest(middle) > 0.0 ? low : high) = middle;
  }
  held({"S9e", "load at which the lowest frequency vanishes, P L²/EI", By::closed_form, "π²/4",
        "planar AncfCable, 8 elements"},
       0.5 * (low + high), critical, 1e-3 * critical);
}

}  // namespace frequencies_test
