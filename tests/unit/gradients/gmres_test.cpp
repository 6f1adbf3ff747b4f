// GMRES on systems with known solutions, and its number of matrix products.
#include <polybody/gradients/adjoint_kernels.hpp>

#include <gtest/gtest.h>

#include <Eigen/Dense>

using namespace polybody;

namespace gmres_test {

// Solves B x = b; returns the number of matrix products.
int solve(MatX const& b_matrix, VecX const& b, VecX& x, Index most = 100) {
  detail::Gmres gmres;
  gmres.begin(b, 1e-14 * b.norm(), most);
  int products = 0;
  while (!gmres.is_done()) {
    VecX product = b_matrix * gmres.next();
    gmres.take(product);
    ++products;
  }
  x.setZero(b.size());
  gmres.add_to(x);
  return products;
}

MatX identity(Index n) { return MatX::Identity(n, n); }
VecX numbers(Index n, double seed) {
  VecX x(n);
  for (Index i = 0; i < n; ++i) x[i] = std::sin(seed * double(i + 1) * double(i + 2));
  return x;
}

TEST(Gmres, TakesOneProductForTheIdentity) {
  VecX const b = numbers(20, 0.3);
  VecX x;
  EXPECT_EQ(solve(3.0 * identity(20), b, x), 1);
  EXPECT_LT((3.0 * x - b).norm(), 1e-14 * b.norm());
}

// I + U Vᵀ of rank r has a minimal polynomial of degree r + 1. Hence r + 1 products are enough for any size of U Vᵀ.
TEST(Gmres, TakesOneProductMoreThanWhatIsMissingHasRanks) {
  Index const n = 40;
  for (int const rank : {1, 2, 5}) {
    MatX m = identity(n);
    for (int k = 0; k < rank; ++k) m += 3.0 * numbers(n, 0.7 + k) * numbers(n, 0.2 + 0.3 * k).transpose();
    VecX const expected = numbers(n, 1.1);
    VecX x;
    EXPECT_LE(solve(m, m * expected, x), rank + 1) << rank;
    EXPECT_LT((x - expected).norm(), 1e-10 * expected.norm()) << rank;
  }
}

// Corrections with the identity as the approximate inverse diverge: the eigenvalues are 1 ± 2i.
TEST(Gmres, ConvergesWhereCorrectionsDiverge) {
  MatX m = identity(10);
  for (Index i = 0; i < 10; i += 2) {
    m(i, i + 1) = 2.0;
    m(i + 1, i) = -2.0;
  }
  VecX const expected = numbers(10, 0.9);
  VecX x;
  EXPECT_LE(solve(m, m * expected, x), 2);
  EXPECT_LT((x - expected).norm(), 1e-13 * expected.norm());
}

// A cyclic shift: the first n − 1 products do not reduce the residual [Saad 2003, §6.5]; the n-th product solves the
// system.
TEST(Gmres, StopsAtTheMostProducts) {
  Index const n = 8;
  MatX shift = MatX::Zero(n, n);
  for (Index i = 0; i < n; ++i) shift((i + 1) % n, i) = 1.0;
  VecX const b = VecX::Unit(n, 0);
  VecX x;
  EXPECT_EQ(solve(shift, b, x, 5), 5);
  EXPECT_LT(x.norm(), 1e-15);
  EXPECT_EQ(solve(shift, b, x), n);
  EXPECT_LT((shift * x - b).norm(), 1e-14);
}

TEST(Gmres, NothingIsSolvedAtOnce) {
  VecX x;
  EXPECT_EQ(solve(identity(3), VecX::Zero(3), x), 0);
  EXPECT_EQ(x.norm(), 0.0);
}

}  // namespace gmres_test
