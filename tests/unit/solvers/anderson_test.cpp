// Anderson acceleration: theoretical results for linear maps, and its effect on Newton's method with an incomplete
// tangent.

#include <gtest/gtest.h>

#include <random>

#include <polybody/solvers/newton.hpp>

using namespace polybody;

namespace anderson_test {

VecX random_vector(Index n, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  return VecX::NullaryExpr(n, [&](Index) { return normal(random); });
}

// f(x) = (J − 1)(x − 1) with J of a given rank; the norm contains only the first entries.
struct LinearMap {
  MatX J;
  VecX x;
  LinearMap(Index n, int rank) : J(MatX::Zero(n, n)), x(random_vector(n, 99)) {
    for (int i = 0; i < rank; ++i)
      J += 0.6 * random_vector(n, 2u * unsigned(i)).normalized() *
           random_vector(n, 2u * unsigned(i) + 1).normalized().transpose();
  }
  VecX correction() const {
    VecX const off = x - VecX::Ones(x.size());
    return J * off - off;
  }
};

// Norms of corrections, relative to the first.
std::vector<double> corrections(LinearMap map, int count) {
  AndersonAcceleration acceleration(map.x.size(), map.x.size());
  std::vector<double> norms;
  for (int k = 0; k < count; ++k) {
    VecX f = map.correction();
    norms.push_back(f.norm() / (k == 0 ? 1.0 : norms.front()));
    if (k > 0) (void)acceleration.fit(f);
    acceleration.combine(f);
    map.x += f;
  }
  norms.front() = 1.0;
  return norms;
}

// Corrections from the second on are in the range of J. If as many differences as its dimensions are used, up to two,
// the present correction vanishes, and the next one is zero [Walker & Ni 2011, Theorem 2.2].
TEST(Anderson, EndsForMapsOfRankOneAndTwo) {
  for (int const rank : {1, 2}) {
    std::vector<double> const norms = corrections(LinearMap(30, rank), rank + 3);
    EXPECT_GT(norms[std::size_t(rank) + 1], 1e-6) << rank;
    EXPECT_LT(norms[std::size_t(rank) + 2], 1e-13) << rank;
  }
  EXPECT_GT(corrections(LinearMap(30, 3), 6).back(), 1e-9);  // for rank three, two differences are not enough
}

// The fit returns ‖J s‖/‖s‖ of the last combined step s, and the least-squares residual of the correction.
TEST(Anderson, FitTellsHowTheMapContracts) {
  LinearMap map(20, 3);
  AndersonAcceleration acceleration(20, 20);
  VecX step = VecX::Zero(20), last = step, before = step;
  for (int k = 0; k < 4; ++k) {
    VecX f = map.correction();
    VecX const plain = f;
    if (k > 0) {
      AndersonFit const fit = acceleration.fit(f);
      EXPECT_NEAR(fit.contraction, (map.J * step).norm() / step.norm(), 1e-12) << k;
      MatX differences(20, k > 1 ? 2 : 1);
      differences.col(0) = f - last;
      if (k > 1) differences.col(1) = last - before;
      VecX const gamma = differences.colPivHouseholderQr().solve(f);
      EXPECT_NEAR(fit.left, std::max(0.1, (f - differences * gamma).norm() / f.norm()), 1e-10) << k;
    }
    EXPECT_EQ(acceleration.combined(), k > 1);
    acceleration.combine(f);
    step = f;
    before = last;
    last = plain;
    map.x += step;
  }
}

// K x + x³ = b. The tangent omits the off-diagonal entries of K, as the tangent of a step omits terms between bodies
// in contact.
struct Incomplete {
  MatX K;
  VecX solution, b, x, y, diagonal;
  double tolerance = 1e-10, beside = 1.0;
  bool complete = false;  // a complete tangent from the second factorisation on
  int factorisations = 0;

  explicit Incomplete(Index n, double off_diagonal, unsigned seed)
      : K(4.0 * MatX::Identity(n, n)), solution(0.3 * random_vector(n, seed)), x(VecX::Zero(n)), y(x) {
    for (Index i = 0; i + 1 < n; ++i) K(i, i + 1) = K(i + 1, i) = off_diagonal;
    b = K * solution + VecX(solution.array().cube());
  }
  bool evaluate() { return x.allFinite(); }
  bool refactor() {
    ++factorisations;
    diagonal = K.diagonal() + VecX(3.0 * x.array().square());
    return true;
  }
  VecX residual() const { return b - K * x - VecX(x.array().cube()); }
  double solve() {
    if (complete && factorisations > 1)
      y = (K + MatX(VecX(3.0 * x.array().square()).asDiagonal())).lu().solve(residual());
    else
      y = residual().cwiseQuotient(diagonal);
    return y.norm() / tolerance;
  }
  void apply() { x += y; }
  double off() const { return (x - solution).norm() / tolerance; }
};
struct Accelerated : Incomplete {
  AndersonAcceleration combinations;
  Accelerated(Index n, double off_diagonal, unsigned seed) : Incomplete(n, off_diagonal, seed), combinations(n, n) {}
  AndersonAcceleration& acceleration() { return combinations; }
  VecX& correction() { return y; }
};

NewtonReport solve(auto& problem, NewtonOptions const& options) {
  ReusedFactorisation kept;
  return newton(problem, options, kept);
}

TEST(Anderson, SavesIterationsOfNewtonsMethodWithAnIncompleteTangent) {
  NewtonOptions const patient{.max_iterations = 60, .factorisation_cost = 1e4};
  for (unsigned seed = 0; seed < 20; ++seed) {
    Incomplete plain(25, -0.6, seed);
    Accelerated fast(25, -0.6, seed);
    NewtonReport const slow = solve(plain, patient), report = solve(fast, patient);
    EXPECT_EQ(report.result, NewtonResult::converged);
    EXPECT_EQ(report.factorisations, 1);
    EXPECT_LE(report.iterations, slow.iterations - 7) << seed;
    EXPECT_LE(fast.off(), 1.0) << seed;
  }
}

// After a renewal the tangent is complete, and the correction after it is the last but one. Differences with the old
// tangent are discarded.
TEST(Anderson, ForgetsWhatAnotherFactorisationFound) {
  Accelerated problem(25, -1.2, 3);
  problem.complete = true;
  NewtonReport const report = solve(problem, {.max_iterations = 60});
  EXPECT_EQ(report.result, NewtonResult::converged);
  EXPECT_EQ(report.factorisations, 2);
  EXPECT_EQ(report.iterations, 6);
  EXPECT_LE(problem.off(), 1.0);
}

// Corrections of full Newton, and corrections that must be small themselves, are not accelerated.
TEST(Anderson, LeavesFullNewtonAlone) {
  for (NewtonOptions const& options : {NewtonOptions{.max_iterations = 60, .always_refactor = true},
                                       NewtonOptions{.max_iterations = 60, .predictive_stop = false}}) {
    Incomplete plain(25, -0.6, 1);
    Accelerated other(25, -0.6, 1);
    EXPECT_EQ(solve(plain, options).iterations, solve(other, options).iterations);
    EXPECT_EQ(plain.x, other.x);
  }
}

}  // namespace anderson_test
