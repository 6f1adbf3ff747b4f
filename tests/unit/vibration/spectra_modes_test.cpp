// Lanczos iteration of Spectra compared with Eigen's dense solver and closed forms. This file is built if Spectra is
// installed.
#include <polybody/vibration/spectra_modes.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ffr/beam_structure.hpp>

#include "support/refusal.hpp"

namespace polybody {
namespace spectra_modes_test {

/// 40 elements. With a round section every bending frequency is double.
Structure bar(double ratio) {
  return structure_of(Bar{.length = 2.0,
                          .constants = BarConstants{.EA = 4e4,
                                                    .EI = 3.0,
                                                    .mass_per_length = 0.7,
                                                    .GJ = 2.0,
                                                    .rotary_inertia = 1e-4,
                                                    .EI_y = 3.0 * ratio,
                                                    .rotary_inertia_y = 1e-4}},
                      40);
}

struct Held {
  Structure::Sparse k, m;
  explicit Held(Structure const& s) {
    std::vector<Index> const free = ReferenceConditions::clamped().free_coordinates(s);
    k = submatrix(s.stiffness, free, free);
    m = submatrix(s.mass_matrix(), free, free);
  }
};

/// Frequencies to 1e-8. The shapes have unit mass and span the subspace of the dense solver.
void expect_alike(LowestModes const& modes, LowestModes const& dense, Structure::Sparse const& m) {
  Index const n = dense.squared_frequencies.size();
  ASSERT_EQ(modes.squared_frequencies.size(), n);
  for (Index i = 0; i < n; ++i) {
    double const omega = std::sqrt(dense.squared_frequencies[i]);
    EXPECT_NEAR(std::sqrt(modes.squared_frequencies[i]), omega, 1e-8 * omega) << i;
    if (i > 0) {
      EXPECT_GE(modes.squared_frequencies[i], modes.squared_frequencies[i - 1] * (1.0 - 1e-9));
    }
  }
  MatX const product = dense.shapes.transpose() * (m * modes.shapes);  // orthogonal if both span the same subspace
  EXPECT_LT((MatX(modes.shapes.transpose() * (m * modes.shapes)) - MatX::Identity(n, n)).norm(), 1e-9);
  EXPECT_LT((product * product.transpose() - MatX::Identity(n, n)).norm(), 1e-8);
  for (Index i = 0; i < n; ++i)  // and modes of different frequencies do not mix
    for (Index j = 0; j < n; ++j)
      if (std::abs(dense.squared_frequencies[i] / dense.squared_frequencies[j] - 1.0) > 1e-3) {
        EXPECT_LT(std::abs(product(i, j)), 1e-6) << i << ' ' << j;
      }
}

// Eleven modes of the round bar: five pairs of bending and torsion as the ninth.
TEST(SpectraModes, AgreeWithTheDenseSolver) {
  for (double const ratio : {1.7, 1.0}) {
    Held const held(bar(ratio));
    expect_alike(SpectraModes{}(held.k, held.m, 11), DenseModes{}(held.k, held.m, 11), held.m);
  }
}

TEST(SpectraModes, AreTheSameInEveryRun) {
  Held const held(bar(1.0));
  LowestModes const one = SpectraModes{}(held.k, held.m, 6), two = SpectraModes{}(held.k, held.m, 6);
  EXPECT_EQ(one.squared_frequencies, two.squared_frequencies);
  EXPECT_EQ(one.shapes, two.shapes);
}

TEST(SpectraModes, LeaveMostOfAllModesToTheDenseSolver) {
  Held const held(structure_of(
      Bar{.length = 1.0,
          .constants = BarConstants{.EA = 40.0, .EI = 3.0, .mass_per_length = 0.7, .GJ = 2.0, .rotary_inertia = 0.02}},
      1));
  EXPECT_EQ(SpectraModes{}(held.k, held.m, 6).squared_frequencies, DenseModes{}(held.k, held.m, 6).squared_frequencies);
}

// E1 clamped–free: ω_i = (β_i/L)² √(EI/ρA), in two planes. With forty cubic elements the error of ω² is (β h/L)⁴/720,
// 2.2e-5 for the fifth mode. The rotary inertia of 1e-9 m² adds 1e-7.
TEST(SpectraModes, OfACantileverAreEulerAndBernoullis) {
  double const beta[] = {1.875104068711961, 4.694091132974175, 7.854757438237613, 10.99554073487547, 14.13716839104647};
  double const length = 1.5, EI = 4.0, density = 0.9;
  Held const held(structure_of(
      Bar{.length = length,
          .constants =
              BarConstants{
                  .EA = 1e7, .EI = EI, .mass_per_length = density, .GJ = 1e3, .rotary_inertia = density * 1e-9}},
      40));
  LowestModes const modes = SpectraModes{}(held.k, held.m, 10);
  for (int i = 0; i < 10; ++i) {
    double const b = beta[i / 2], omega = b * b / (length * length) * std::sqrt(EI / density);
    EXPECT_NEAR(std::sqrt(modes.squared_frequencies[i]), omega, 1.2e-5 * omega) << i;
  }
}

TEST(SpectraModes, ServeTheBases) {
  Structure const s = bar(1.7);
  auto const span = [&](MatX const& a, MatX const& b) {  // of unit mass each
    MatX const product = a.transpose() * (s.mass_matrix() * b);
    return (product * product.transpose() - MatX::Identity(a.cols(), a.cols())).norm();
  };
  EXPECT_LT(span(free_interface_modes(s, 8), free_interface_modes(s, 8, ReferenceConditions::none(), SpectraModes{})),
            1e-6);
  EXPECT_LT(
      span(fixed_interface_modes(s, 8), fixed_interface_modes(s, 8, ReferenceConditions::clamped(), SpectraModes{})),
      1e-8);
  MatX const dense = craig_bampton(s, {0, 40}, 4), lanczos = craig_bampton(s, {0, 40}, 4, false, false, SpectraModes{});
  EXPECT_EQ(dense.leftCols(6), lanczos.leftCols(6));
  EXPECT_LT(span(dense.rightCols(4), lanczos.rightCols(4)), 1e-8);
}

TEST(SpectraModes, SayWhatIsMissing) {
  Structure const s = bar(1.0);
  EXPECT_TRUE(
      has(refusal([&] { SpectraModes{}(s.stiffness, s.mass_matrix(), 3); }), "needs a positive definite stiffness"));
  Held const held(s);
  SpectraModes const hasty{.restarts = 1, .tolerance = 0.0};
  EXPECT_TRUE(
      has(message_of<Error>([&] { hasty(held.k, held.m, 30); }),
          "of 30 modes converged in 1 restarts, or modes of a repeated frequency are missing. Allow more restarts"));
}

}  // namespace spectra_modes_test
}  // namespace polybody
