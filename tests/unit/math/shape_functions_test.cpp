#include <polybody/math/element_functions.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace polybody;

namespace shape_functions_test {

double const length = 0.7;
double const places[] = {0.0, 0.13, 0.5, 0.77, 1.0};

TEST(LinearShape, IsAPartitionOfUnity) {
  for (double const xi : places) {
    ShapeValues<2> const n = linear_shape(xi, length);
    EXPECT_NEAR(n.s[0] + n.s[1], 1.0, 1e-16);
    EXPECT_NEAR(n.ds[0] + n.ds[1], 0.0, 1e-16);
    EXPECT_EQ(n.dds[0], 0.0);
    EXPECT_EQ(n.dds[1], 0.0);
  }
}

// Nodal values of x itself must give x, with derivative one.
TEST(LinearShape, ReproducesStraightLines) {
  for (double const xi : places) {
    ShapeValues<2> const n = linear_shape(xi, length);
    EXPECT_NEAR(n.s[1] * length, xi * length, 1e-16);
    EXPECT_NEAR(n.ds[1] * length, 1.0, 1e-15);
  }
}

TEST(HermiteShape, EachFunctionOwnsOneNodalNumber) {
  for (int end = 0; end < 2; ++end) {
    ShapeValues<4> const n = hermite_shape(end, length);
    for (int i = 0; i < 4; ++i) {
      EXPECT_NEAR(n.s[i], i == 2 * end ? 1.0 : 0.0, 1e-16) << end << ' ' << i;
      EXPECT_NEAR(n.ds[i], i == 2 * end + 1 ? 1.0 : 0.0, 1e-15) << end << ' ' << i;
    }
  }
}

TEST(HermiteShape, IsAPartitionOfUnity) {
  for (double const xi : places) {
    ShapeValues<4> const n = hermite_shape(xi, length);
    EXPECT_NEAR(n.s[0] + n.s[2], 1.0, 1e-15);
    EXPECT_NEAR(n.ds[0] + n.ds[2], 0.0, 1e-15);
    EXPECT_NEAR(n.dds[0] + n.dds[2], 0.0, 1e-14);
  }
}

// Values and derivatives of a cubic at the nodes determine it. Hence every polynomial xᵏ, k ≤ 3, is reproduced with
// its first and second derivative.
TEST(HermiteShape, ReproducesCubicsWithBothDerivatives) {
  double const l = length;
  for (int k = 0; k <= 3; ++k)
    for (double const xi : places) {
      ShapeValues<4> const n = hermite_shape(xi, l);
      double const x = xi * l;
      double const nodal[] = {k == 0 ? 1.0 : 0.0, k == 1 ? 1.0 : 0.0, std::pow(l, k), k * std::pow(l, k - 1)};
      double value = 0.0, first = 0.0, second = 0.0;
      for (int i = 0; i < 4; ++i) {
        value += n.s[i] * nodal[i];
        first += n.ds[i] * nodal[i];
        second += n.dds[i] * nodal[i];
      }
      EXPECT_NEAR(value, std::pow(x, k), 1e-15) << k << ' ' << xi;
      EXPECT_NEAR(first, k == 0 ? 0.0 : k * std::pow(x, k - 1), 1e-14) << k << ' ' << xi;
      EXPECT_NEAR(second, k < 2 ? 0.0 : k * (k - 1) * std::pow(x, k - 2), 1e-13) << k << ' ' << xi;
    }
}

// Central differences of a cubic are exact up to h² s‴/6. Hence they check the derivatives of the second shape
// function against its values.
TEST(HermiteShape, DerivativesFollowFromTheValues) {
  double const h = 1e-4;
  for (double const xi : {0.2, 0.5, 0.9}) {
    ShapeValues<4> const n = hermite_shape(xi, length);
    ShapeValues<4> const up = hermite_shape(xi + h, length), down = hermite_shape(xi - h, length);
    for (int i = 0; i < 4; ++i) {
      EXPECT_NEAR((up.s[i] - down.s[i]) / (2 * h * length), n.ds[i], 1e-7) << i;
      EXPECT_NEAR((up.ds[i] - down.ds[i]) / (2 * h * length), n.dds[i], 1e-10) << i;
    }
  }
}

TEST(ShapeFunctions, AreConstantsOfTheCompiler) {
  static_assert(linear_shape(0.25, 2.0).s[1] == 0.25);
  static_assert(hermite_shape(0.5, 2.0).s[0] == 0.5);
  static_assert(hermite_shape(0.5, 2.0).s[3] == -0.25);
}

}  // namespace shape_functions_test
