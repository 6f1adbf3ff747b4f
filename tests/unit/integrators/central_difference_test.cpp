#include <polybody/integrators/symplectic.hpp>

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/testing/integrator_laws.hpp>

#include "support/held.hpp"
#include "support/integrator_cases.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace central_difference_test {

struct CentralDifferenceOnFreeBody {
  using Model = SprungBody;
  static auto integrators() { return std::vector<CentralDifference<>>(1); }
  static constexpr double end_time = 1.0;
  static constexpr int steps = 64;
};
struct CentralDifferenceOnBar {
  using Model = SwingingBar;
  static auto integrators() { return std::vector<CentralDifference<Projection>>(1); }
  static constexpr double end_time = 0.5;
  static constexpr int steps = 32;
  static constexpr bool keeps_accelerations = false;  // the accelerations belong to the predicted velocities
};
struct CentralDifferenceOnTop {
  using Model = SlowTop;
  static auto integrators() { return std::vector<CentralDifference<Projection>>(1); }
  static constexpr double end_time = 0.5;
  static constexpr int steps = 64;
  static constexpr bool keeps_accelerations = false;  // the accelerations belong to the predicted velocities
};

}  // namespace central_difference_test

namespace polybody {
bool const central_difference_obey[] = {
    obeys<central_difference_test::CentralDifferenceOnFreeBody, IntegratorLaws>("CentralDifferenceOnFreeBody"),
    obeys<central_difference_test::CentralDifferenceOnBar, IntegratorLaws>("CentralDifferenceOnBar"),
    obeys<central_difference_test::CentralDifferenceOnTop, IntegratorLaws>("CentralDifferenceOnTop")};
}  // namespace polybody

namespace central_difference_test {

/// A free ANCF cable of n elements of 0.25 m, made of steel with a thickness of 1 cm. Its highest mode is a
/// longitudinal mode.
struct FreeCable {
  Model<Bodies<planar::AncfCable<>>, Joints<>> model;
  VecX mode;           ///< mode of the highest frequency, normalised to unit mass
  double omega = 0.0;  ///< the highest frequency [rad/s]
  State start;

  explicit FreeCable(Index n) {
    model.add(planar::AncfCable<>::from({.length = 0.25 * double(n),
                                         .section = Circle{.radius = 0.01},
                                         .material = Material{.density = 7800, .young = 2e11}},
                                        n));
    start = model.reference_state();
    System system(model);
    system.evaluate(start.q, start.v, 0.0);
    auto const matrix = [&](TangentCoefficients const& c) {
      DenseLu sink;
      sink.analyse(system.size(), {});
      sink.begin();
      system.tangent(c, SecondOrder::included, start.lambda, sink);
      return sink.matrix();
    };
    Eigen::GeneralizedSelfAdjointEigenSolver<MatX> const pencil(matrix({.stiffness = 1.0}), matrix({.mass = 1.0}));
    omega = std::sqrt(pencil.eigenvalues().tail<1>()[0]);
    mode = pencil.eigenvectors().rightCols<1>();
  }

  /// Amplitude of the highest mode after each of `steps` steps of length h, from an initial amplitude of 1e-10.
  std::vector<double> amplitudes(double h, int steps) const {
    System system(model);
    CentralDifference<> const integrator;
    auto workspace = integrator.workspace<DenseLu>(system);
    State x = start;
    x.q += 1e-10 * mode;
    integrator.start(system, x, h, workspace);
    std::vector<double> amplitude;
    for (int i = 0; i < steps; ++i) {
      integrator.step(system, x, h, workspace);
      amplitude.push_back((x.q - start.q).norm() / mode.norm());
    }
    return amplitude;
  }
};

// Stability limit (I2): stable if and only if h < 2/ω_max. At h = 1.01 · 2/ω the mode grows in every step by a root
// of μ² − 2 (1 − ½ (ωh)²) μ + 1 = 0 [Hughes 2000, §9.1].
TEST(CentralDifference, IsStableUpToTwoOverTheHighestFrequency) {
  for (Index const n : {1, 4}) {
    FreeCable const cable(n);
    double const limit = 2.0 / cable.omega;
    for (double const a : cable.amplitudes(0.99 * limit, 5000)) ASSERT_LT(a, 1e-8);

    double const c = 1.0 - 0.5 * std::pow(2.02, 2), growth = std::abs(c) + std::sqrt(c * c - 1.0);
    auto const a = cable.amplitudes(1.01 * limit, 40);
    held({"I2", "growth of a mode in a step of 1.01 · 2/ω", By::closed_form, "μ² − 2 (1 − ½ (ωh)²) μ + 1 = 0",
          "CentralDifference, AncfCable"},
         std::pow(a[39] / a[19], 1.0 / 20.0), growth, 0.01 * growth, {equals("elements", double(n))});
    // the growth ends in numbers that are not finite
    EXPECT_THROW(cable.amplitudes(1.01 * limit, 2000), NonFiniteValue);
  }
}

// The highest frequency of an assembly is at most that of its elements.
TEST(CentralDifference, ElementPencilBoundsTheAssembly) {
  double const element = FreeCable(1).omega;
  EXPECT_LT(FreeCable(4).omega, element * (1 + 1e-12));
  EXPECT_GT(FreeCable(4).omega, 0.7 * element);
}

}  // namespace central_difference_test
