// The arm and the cantilever of Chapter 2 (examples/chapter2.hpp) for each planar body and integrator; the pin of the
// arm is ideal or stiff.
#include <polybody/bodies/ffr/planar_ffr.hpp>
#include <polybody/se3_beam.hpp>

#include "../examples/chapter2.hpp"
#include "support/swapped_pendulum.hpp"

namespace polybody::chapter2_test {

using swaps::Count;

/// Three steps of the model that `make` creates, by each integrator that can be combined with it.
template <class Make>
void run_each(Make const& make, Count& count) {
  auto const one = [&]<class S>(S const& s) {
    using M = typename std::invoke_result_t<Make>::Model;
    if constexpr (CompatibleIntegrator<S, M>) {
      SCOPED_TRACE(std::string(S::name) + ", " + typeid(S).name());
      double const step = swaps::implicit<S> ? 1e-3 : 1e-7;
      auto const made = make();
      State x = made.model.reference_state();
      simulate(made.model, x, s, {.end_time = 3.0 * step, .step = step}).run();
      EXPECT_NEAR(x.t, 3.0 * step, 1e-12 * step);
      EXPECT_TRUE(x.q.allFinite());
      ++count.run;
    } else {
      ++count.refused;
    }
  };
  std::apply([&](auto const&... s) { (one(s), ...); }, swaps::integrators());
}

template <class B>
Count arm() {
  Bar const bar = chapter2::bar(chapter2::high, 1000.0);
  auto const with = [&]<class P>(P const& policy, Count& count) {
    run_each([&] { return chapter2::RobotArm<B, P>(bar, 2, 1.0, 0.0, policy); }, count);
  };
  Count count;
  with(Constraint{}, count);
  with(Penalty{.stiffness = 1e9, .damping = 1e4}, count);
  return count;
}
template <class B>
Count cantilever() {
  Count count;
  run_each([] { return chapter2::Cantilever<B>(chapter2::bar(chapter2::high, 1000.0), 2, 1e5); }, count);
  return count;
}

TEST(SwapsOfChapter2, RigidArm) { EXPECT_EQ(arm<planar::Rigid>(), (Count{30, 10})); }
TEST(SwapsOfChapter2, ArmOfCables) { EXPECT_EQ(arm<planar::AncfCable<>>(), (Count{30, 10})); }
TEST(SwapsOfChapter2, ArmOfLargeRotationVectors) { EXPECT_EQ(arm<planar::Lrvf>(), (Count{30, 10})); }
TEST(SwapsOfChapter2, ArmOfCircularArcs) { EXPECT_EQ(arm<planar::Se3Beam>(), (Count{30, 10})); }
TEST(SwapsOfChapter2, ArmOnAFloatingFrame) { EXPECT_EQ(arm<planar::Ffr>(), (Count{24, 16})); }
TEST(SwapsOfChapter2, CantileverOfCables) { EXPECT_EQ(cantilever<planar::AncfCable<>>(), (Count{15, 5})); }
TEST(SwapsOfChapter2, CantileverOfLargeRotationVectors) { EXPECT_EQ(cantilever<planar::Lrvf>(), (Count{15, 5})); }
TEST(SwapsOfChapter2, CantileverOfCircularArcs) { EXPECT_EQ(cantilever<planar::Se3Beam>(), (Count{15, 5})); }
TEST(SwapsOfChapter2, CantileverOnAFloatingFrame) { EXPECT_EQ(cantilever<planar::Ffr>(), (Count{12, 8})); }

}  // namespace polybody::chapter2_test
