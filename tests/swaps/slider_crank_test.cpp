// A slider-crank whose coupler is pinned at both ends: one line swaps the coupler, the policy of its pins or the
// integrator.
#include <polybody/bodies/ffr/planar_ffr.hpp>
#include <polybody/se3_beam.hpp>

#include "support/swapped_pendulum.hpp"

namespace polybody::slider_crank_test {

using swaps::Count;
using Ideal = Joint<planar::Revolute>;

/// Model with a coupler of type B whose pins have the policy P.
template <class B, class P>
using SliderCrank = Model<std::conditional_t<std::same_as<B, planar::Rigid>, Bodies<B>, Bodies<planar::Rigid, B>>,
                          std::conditional_t<std::same_as<P, Constraint>, Joints<Ideal, Joint<planar::Prismatic>>,
                                             Joints<Ideal, Joint<planar::Prismatic>, Joint<planar::Revolute, P>>>>;

/// Runs three steps. The weight moves the parts by at most g t².
template <class B, class P, class I>
void run(B const& coupler, P const& policy, I const& integrator) {
  SCOPED_TRACE(std::string(typeid(B).name()) + ", " + P::name + ", " + I::name);
  SliderCrank<B, P> model{Gravity{0, -9.81, 0}};
  auto const crank = model.add(planar::Rigid(0.2, 1e-3, Placement::planar(0.05, 0, 0)), "crank");
  auto const rod = model.add(coupler, "rod");
  auto const piston = model.add(planar::Rigid(0.5, 1e-4, Placement::planar(0.5, 0, 0)), "piston");
  auto const ground = model.ground().at({0, 0, 0});
  Joint const pin{planar::Revolute{}, policy};
  model.connect(Ideal{}, ground, crank.at(Vec2(-0.05, 0)), "main pin");
  auto const big_end = model.connect(pin, crank.at(Vec2(0.05, 0)), rod.at(0.0), "crank pin");
  model.connect(pin, rod.at(0.4), piston.at(Vec2(0, 0)), "piston pin");
  model.connect(Joint<planar::Prismatic>{{.axis = Vec3::UnitX()}, {}}, ground, piston.at(Vec2(0, 0)), "cylinder");
  double const step = swaps::implicit<I> ? 1e-4 : 1e-7;
  State x = model.reference_state();
  simulate(model, x, integrator, {.end_time = 3.0 * step, .step = step}).run();
  EXPECT_NEAR(x.t, 3.0 * step, 1e-12 * step);
  EXPECT_LE(constraint_violation(model, x, big_end).norm(), 9.81 * x.t * x.t);
  EXPECT_LE((position(model, x, rod.at(0.2)) - Vec3(0.3, 0, 0)).norm(), 9.81 * x.t * x.t);
}

Bar const bar{.length = 0.4,
              .section = Rectangle{.height = 0.006, .width = 0.02},
              .material = Material{.density = 7800, .young = 2e11},
              .placement = Placement::at({0.1, 0, 0})};

TEST(SwapsOfTheSliderCrank, EachCoupler) {
  auto const with = [](auto const& coupler) { run(coupler, Constraint{}, GeneralisedAlpha{}); };
  with(planar::Rigid::from(bar));
  with(planar::Ffr::from(bar));
  with(planar::Ffr::from(bar, 8, {.modes = 2}));
  with(planar::AncfCable<>::from(bar));
  with(planar::AncfCable<EngineeringStrain>::from(bar));
  with(planar::Lrvf::from(bar));
  with(planar::Se3Beam::from(bar));
}

/// Tries each policy for the pins of a rigid and a flexible coupler.
template <class B>
Count each_policy() {
  Count count;
  auto const with = [&]<class P>(P const& policy) {
    if constexpr (swaps::Connectable<B, Joint<planar::Revolute, P>> && EliminableBody<P, planar::Rigid>) {
      if constexpr (CompatibleIntegrator<GeneralisedAlpha, SliderCrank<B, P>>) {
        run(B::from(bar), policy, GeneralisedAlpha{});
        ++count.run;
        return;
      }
    }
    ++count.refused;
  };
  std::apply([&](auto const&... policy) { (with(policy), ...); },
             swaps::policies<constraint_equations<planar::Revolute>()>());
  return count;
}

TEST(SwapsOfTheSliderCrank, EachPolicy) {
  EXPECT_EQ(each_policy<planar::Rigid>(), (Count{7, 1}));
  EXPECT_EQ(each_policy<planar::AncfCable<>>(), (Count{5, 3}));
  EXPECT_EQ(each_policy<planar::Se3Beam>(), (Count{6, 2}));
}

TEST(SwapsOfTheSliderCrank, EachIntegrator) {
  Count count;
  auto const by = [&]<class I>(I const& integrator) {
    if constexpr (CompatibleIntegrator<I, SliderCrank<planar::Rigid, Constraint>>) {
      run(planar::Rigid::from(bar), Constraint{}, integrator);
      ++count.run;
    } else {
      ++count.refused;
    }
  };
  std::apply([&](auto const&... integrator) { (by(integrator), ...); }, swaps::integrators());
  EXPECT_EQ(count, (Count{15, 5}));
}

}  // namespace polybody::slider_crank_test
