#pragma once
/// \file The program of README.md for each combination of body, policy and integrator.

#include <gtest/gtest.h>

#include <polybody/polybody.hpp>
#include <string>
#include <tuple>
#include <typeinfo>

namespace polybody::swaps {

using Laws = NonlinearBushing<LinearLaw, LinearLaw, LinearLaw, LinearLaw, LinearLaw, LinearLaw>;

/// The policies of docs/joints.md with the numbers of a pin of `rows` rows.
template <int rows>
auto policies() {
  LinearLaw const law{.stiffness = 1e6, .damping = 1e2};
  Vec3 const k(1e6, 1e6, 1e6), c(1e2, 1e2, 1e2);
  return std::tuple(Constraint{}, Penalty{.stiffness = 1e6, .damping = 1e2},
                    PenaltyPerEquation<rows>{.stiffness = Vec<double, rows>::Constant(1e6),
                                             .damping = Vec<double, rows>::Constant(1e2)},
                    Bushing{.stiffness = Bushing::diagonal(k, k), .damping = Bushing::diagonal(c, c)},
                    Laws{law, law, law, law, law, law}, JointCoordinates{},
                    JointCoordinatesBy<joint_coordinates::ArticulatedBody>{}, AncfLinear{});
}

/// The integrators of docs/joints.md. `Baumgarte` has numbers, the others are complete without options.
inline auto integrators() {
  return std::tuple(GeneralisedAlpha{.rho_inf = 0.8}, HhtAlpha{}, Newmark{}, Trapezoidal{}, Radau{}, EnergyMomentum{},
                    EnergyDecaying{}, RungeKutta4<>{}, DormandPrince<>{}, AdamsBashforthMoulton<>{},
                    CentralDifference<>{}, RungeKutta4<Projection>{},
                    RungeKutta4<Baumgarte>{.stabilisation = {.alpha = 50.0, .beta = 50.0}},
                    RungeKutta4<NoStabilisation>{}, RungeKutta4<CoordinatePartitioning>{}, DormandPrince<Projection>{},
                    AdamsBashforthMoulton<Projection>{}, CentralDifference<Projection>{}, SymplecticEuler{}, Rattle{});
}

/// Joint J can connect the ground with a second marker on body B, as `Model::connect` requires.
template <class B, class J>
concept Connectable =
    SameWorld<typename J::Geometry, Ground, B> && EnforceablePair<typename J::PolicyType, typename J::Geometry> &&
    EliminableBody<typename J::PolicyType, B> && SufficientFirstMarker<J, Ground> && SufficientSecondMarker<J, B>;

/// Implicit integrators use the step of the README. Explicit ones use a step below their stability limit.
template <class I>
concept implicit = OneOf<I, GeneralisedAlpha, HhtAlpha, Newmark, Trapezoidal, Radau, EnergyMomentum, EnergyDecaying>;

/// Number of combinations of a body.
struct Count {
  int run = 0;      ///< run to their end
  int refused = 0;  ///< that do not compile
  bool operator==(Count const&) const = default;
  friend std::ostream& operator<<(std::ostream& out, Count const& c) {
    return out << c.run << " run, " << c.refused << " refused";
  }
};

/// The program of README.md with its three lines as arguments, for three steps of size `step` [s]. Two elements keep
/// the runs short.
template <class Rod, class J, class I>
void run_program(J const& hinge, I const& stepper, double step) {
  Bar const bar{.length = 1.0, .section = Circle{.radius = 0.01}, .material = Material{.density = 7800, .young = 2e11}};
  Model<Bodies<Rod>, Joints<J>> model{Gravity{0, 0, -9.81}};
  auto const rod = model.add(Rod::from(bar, {.elements = 2}), "rod");
  auto const pin = model.connect(hinge, model.ground().at({0, 0, 0}), rod.at(0.0), "pin");
  State x = model.reference_state();
  double const before = energy(model, x).total();
  for (State const& now : simulate(model, x, stepper, {.end_time = 3.0 * step, .step = step}))
    ASSERT_TRUE(now.q.allFinite());
  EXPECT_NEAR(x.t, 3.0 * step, 1e-12 * step);
  // The centre of mass falls by at most ½ g t²; the error of the energy is below the work of gravity.
  double const fall = 0.5 * 9.81 * x.t * x.t, weight = 9.81 * 7800.0 * std::numbers::pi * 1e-4;
  EXPECT_LE(std::abs(energy(model, x).total() - before), 0.5 * weight * fall);
  EXPECT_LE(constraint_violation(model, x, pin).norm(),
            (ConstrainingPolicy<typename J::PolicyType> ? 0.1 : 4.0) * fall);
}

/// Runs the program of body `Rod` with geometry `pin` under each policy and integrator that can be combined, and counts
/// the others.
template <class Rod, class G = Revolute>
Count run_all(G const& pin = G{.axis = {0, 1, 0}}) {
  Count count;
  auto const with = [&]<class P>(P const& policy) {
    using J = Joint<G, P>;
    std::apply(
        [&]<class... I>(I const&... stepper) {
          if constexpr (Connectable<Rod, J>) {
            auto const one = [&]<class S>(S const& s) {
              if constexpr (CompatibleIntegrator<S, Model<Bodies<Rod>, Joints<J>>>) {
                SCOPED_TRACE(std::string(P::name) + ", " + S::name + ", " + typeid(S).name());
                double const step = implicit<S> ? 1e-3 : 1e-7;
                run_program<Rod>(Joint{pin, policy}, s, step);
                ++count.run;
              } else {
                ++count.refused;
              }
            };
            (one(stepper), ...);
          } else {
            count.refused += int(sizeof...(I));
          }
        },
        integrators());
  };
  std::apply([&](auto const&... policy) { (with(policy), ...); }, policies<constraint_equations<G>()>());
  return count;
}

}  // namespace polybody::swaps
