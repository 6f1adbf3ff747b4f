// Factor and solve [M, Gᵀ; G, 0] of a tracked vehicle: two closed tracks of 64 links, wheels, sprockets and idlers on a
// chassis, and couplings between links and the bodies in contact with them. All solvers are measured with the same
// matrix in one run. Then the block solver is measured with chains of 64 to 4096 links.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <polybody/solvers/block_factor.hpp>
#include <polybody/solvers/dense_lu.hpp>
#include <polybody/solvers/eigen_ldlt.hpp>
#include <polybody/solvers/eigen_sparse_lu.hpp>
#include <random>
#include <string>

#include "support/blocks.hpp"
#include "timing.hpp"

#ifdef POLYBODY_HAS_KLU
#include <polybody/solvers/klu.hpp>
#endif

namespace {

using namespace polybody;
using timing::eigen_rate;
using timing::fastest;
using Matrix6 = Mat<double, 6, 6>;

struct Draw {
  std::mt19937 engine{1};
  MatX matrix(Index m, Index n) {
    std::uniform_real_distribution<double> d(-1.0, 1.0);
    return MatX::NullaryExpr(m, n, [&] { return d(engine); });
  }
  Matrix6 definite(double size) {
    Matrix6 const a = matrix(6, 6);
    return size * (a * a.transpose() + Matrix6::Identity());
  }
};

/// 155 bodies, 154 pins, two drives, 70 couplings.
Blocks vehicle() {
  Draw draw;
  Blocks b;
  constexpr int links = 64, wheels = 5, on_side = 2 * wheels + 3, bodies = 1 + 2 * (links + on_side);
  for (int i = 0; i < bodies; ++i) b.add(6 * i, 6 * i, draw.definite(1.0));
  Index row = 6 * bodies;
  auto const pin = [&](int i, int j) {
    b.join(row, 6 * i, draw.matrix(5, 6));
    b.join(row, 6 * j, draw.matrix(5, 6));
    row += 5;
  };
  auto const couple = [&](int i, int j) {
    MatX const a = draw.matrix(12, 3), k = 0.1 * a * a.transpose();
    b.add(6 * i, 6 * i, k.topLeftCorner(6, 6));
    b.add(6 * j, 6 * j, k.bottomRightCorner(6, 6));
    b.join(6 * i, 6 * j, k.topRightCorner(6, 6));
  };
  for (int side = 0; side < 2; ++side) {
    int const first = 1 + side * (links + on_side), arm = first + links, wheel = arm + wheels,
              sprocket = wheel + wheels;
    for (int i = 0; i < wheels; ++i) {
      pin(0, arm + i);
      pin(arm + i, wheel + i);
    }
    pin(0, sprocket);
    pin(0, sprocket + 1);             // the tensioner's arm
    pin(sprocket + 1, sprocket + 2);  // the idler on this arm
    for (int i = 0; i < links; ++i) pin(first + i, first + (i + 1) % links);
    // contacts: each wheel with two links, the sprocket with thirteen, the idler with twelve
    for (int i = 0; i < wheels; ++i)
      for (int k = 0; k < 2; ++k) couple(wheel + i, first + 8 + 5 * i + k);
    for (int k = 0; k < 13; ++k) couple(sprocket, first + (58 + k) % links);
    for (int k = 0; k < 12; ++k) couple(sprocket + 2, first + 36 + k);
  }
  for (int side = 0; side < 2; ++side) {  // the sprockets' drives
    int const sprocket = 1 + side * (links + on_side) + links + 2 * wheels;
    b.join(row, 6 * sprocket, draw.matrix(1, 6));
    b.join(row, 0, draw.matrix(1, 6));
    ++row;
  }
  return b;
}

Blocks chain(int links) {
  Draw draw;
  Blocks b;
  for (int i = 0; i < links; ++i) b.add(6 * i, 6 * i, draw.definite(1.0));
  for (int i = 0; i < links; ++i) {
    b.join(6 * links + 5 * i, 6 * i, draw.matrix(5, 6));
    if (i > 0) b.join(6 * links + 5 * i, 6 * (i - 1), draw.matrix(5, 6));
  }
  return b;
}

void compare() {
  Blocks const b = vehicle();
  VecX const rhs = Draw().matrix(b.size, 1);
  VecX x = VecX::Zero(b.size);

  auto ldlt = b.analysed<BlockLdlt>();
  auto lu = b.analysed<BlockLu>();
  auto automatic = b.analysed<BlockSolver>();
  auto shifted = b.analysed<EigenLdlt>();
  auto sparse = b.analysed<EigenSparseLu>();
  sparse.begin();
  b.write(sparse);
  Eigen::SparseMatrix<double> const matrix = sparse.matrix();

  auto const written = [&](auto& solver) {
    return [&] {
      solver.begin();
      b.write(solver);
    };
  };
  auto const solved = [&](auto& solver) {
    return [&] {
      if (solver.factor() >= 0) std::printf("no pivot\n");
      solver.solve(rhs, x);
      benchmark::DoNotOptimize(x.data());
    };
  };
  auto const residual = [&](std::function<void()> const& write, std::function<void()> const& solve) {
    write();
    solve();
    return (matrix * x - rhs).norm() / (rhs.norm() + matrix.norm() * x.norm());
  };
  struct Row {
    char const* name;
    std::function<void()> write, solve;
  };
  std::vector<Row> rows{{"block LDLT", written(ldlt), solved(ldlt)},
                        {"block LU", written(lu), solved(lu)},
                        {"block, symmetry measured", written(automatic), solved(automatic)},
                        {"Eigen SimplicialLDLT, AMD, shifted", written(shifted), solved(shifted)},
                        {"Eigen SparseLU, COLAMD, numeric", written(sparse), solved(sparse)}};
#ifdef POLYBODY_HAS_KLU
  auto klu = b.analysed<Klu>(), klu_in_order = b.analysed(Klu(ldlt.order()));
  rows.push_back({"KLU refactor, its own order", written(klu), solved(klu)});
  rows.push_back({"KLU refactor, block order", written(klu_in_order), solved(klu_in_order)});
#endif
  std::vector<std::pair<std::function<void()>, std::function<void()>>> acts;
  for (Row const& row : rows) acts.push_back({row.write, row.solve});
  std::vector<double> const time = fastest(acts, 101);
  double const limit = ldlt.flops() / eigen_rate();
  std::printf("\nfactor + solve, vehicle with two tracks: %td unknowns, %td in the factor, %.2f Mflop\n", b.size,
              ldlt.fill(), 1e-6 * ldlt.flops());
  for (std::size_t i = 0; i < rows.size(); ++i)
    std::printf("  %-36s %9.1f us   %6.2f x block LDLT   residual %.1e\n", rows[i].name, time[i], time[i] / time[0],
                residual(rows[i].write, rows[i].solve));
  std::printf("  flops at the rate of Eigen's 6x6 product %5.1f us   block LDLT takes %.2f x that (aim: at most 3)\n",
              limit, time[0] / limit);
}

void grow() {
  std::printf("\nfactor + solve of a chain of links on pins, block LDLT\n");
  double first = 0.0;
  for (int const links : {64, 256, 1024, 4096}) {
    Blocks const b = chain(links);
    VecX const rhs = VecX::Ones(b.size);
    VecX x = rhs;
    auto solver = b.analysed<BlockLdlt>();
    double const time = fastest({{[&] {
                                    solver.begin();
                                    b.write(solver);
                                  },
                                  [&] {
                                    solver.factor();
                                    solver.solve(rhs, x);
                                    benchmark::DoNotOptimize(x.data());
                                  }}},
                                51)[0] /
                        links;
    if (first == 0.0) first = time;
    std::printf("  %5d links   %6.3f us a link   %.2f x that at 64\n", links, time, time / first);
  }
}

/// Compares the block solver with dense LU for small chains.
void small() {
  std::printf("\nwrite + factor + solve of small chains\n");
  for (int const links : {1, 2, 4, 8}) {
    Blocks const b = chain(links);
    VecX const rhs = VecX::Ones(b.size);
    VecX x = rhs;
    auto block = b.analysed<BlockSolver>();
    auto dense = b.analysed<DenseLu>();
    auto const all = [&](auto& solver) {
      return [&] {
        solver.begin();
        b.write(solver);
        solver.factor();
        solver.solve(rhs, x);
        benchmark::DoNotOptimize(x.data());
      };
    };
    std::vector<double> const time = fastest({{[] {}, all(block)}, {[] {}, all(dense)}}, 1001);
    std::printf("  %3td unknowns   block %6.2f us   dense LU %6.2f us\n", b.size, time[0], time[1]);
  }
}

void block_product(benchmark::State& state) {
  detail::AlignedDoubles a(48), b(48), c(48);
  a.zero();
  b.zero();
  c.zero();
  for (auto _ : state) {
    detail::subtract_product<6>({c.data(), 8}, {a.data(), 8}, {b.data(), 8}, 6, 6, detail::padded(6));
    benchmark::DoNotOptimize(c.data());
  }
}
BENCHMARK(block_product);

void eigen_product(benchmark::State& state) {
  Matrix6 const a = Matrix6::Random(), b = Matrix6::Random();
  Matrix6 c = Matrix6::Zero();
  for (auto _ : state) {
    c.noalias() -= a.transpose() * b;
    benchmark::DoNotOptimize(c.data());
  }
}
BENCHMARK(eigen_product);

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  compare();
  grow();
  small();
}
