// Cost of the interfaces between body, joint and integrator. One Newton iteration of a chain of rigid links on pins is
// computed through bodies, frames, constraint functions and sinks, and by a loop written by hand for this chain only.
// Both computations fill the same matrix and the same right-hand side, which is checked first. Both use the same
// solver: Eigen's sparse LU, whose values the loop fills directly, and the default block solver. Target: a ratio of at
// most 1.2.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <polybody/polybody.hpp>

namespace {

using namespace polybody;
using Pin = Joint<Revolute, Constraint>;
using Chain = Model<Bodies<Rigid<>>, Joints<Pin>>;
using Matrix6 = Mat<double, 6, 6>;

constexpr double link_length = 0.1, link_mass = 1.0, mass_factor = 1.5, h_gamma = 5e-4, h2_beta = 2.5e-7;
Mat3 const link_inertia = Vec3(1e-4, 1e-3, 1e-3).asDiagonal();
Vec3 const gravity(0, 0, -9.81), pin_axis(0, 1, 0);

Chain make_chain(int links) {
  Chain model{Gravity{gravity}};
  auto const end = [](double side) { return Vec3(side * 0.5 * link_length, 0, 0); };
  std::optional<BodyHandle<Rigid<>>> before;
  for (int i = 0; i < links; ++i) {
    auto const link = model.add(Rigid<>(link_mass, link_inertia, Placement::at({(i + 0.5) * link_length, 0, 0})));
    if (i == 0)
      model.connect(Pin{Revolute{pin_axis}, {}}, model.ground().at({0, 0, 0}), link.at(end(-1)));
    else
      model.connect(Pin{Revolute{pin_axis}, {}}, before->at(end(1)), link.at(end(-1)));
    before = link;
  }
  return model;
}

// Model in a state in which no term vanishes, with its solvers.
struct Fixture {
  Chain model;
  System system;
  VecX q, v, a, lambda, r, phi, rhs, x;
  EigenSparseLu solver;
  BlockSolver block;
  Sequence<Block> blocks;  // blocks of the matrix

  explicit Fixture(int links)
      : model(make_chain(links)),
        system(model),
        q(model.reference_state().q),
        v(VecX::Random(model.velocities())),
        a(VecX::Random(model.velocities())),
        lambda(VecX::Random(model.rows())),
        r(VecX::Zero(model.velocities())),
        phi(VecX::Zero(model.rows())),
        rhs(VecX::Zero(system.size())),
        x(rhs) {
    VecX moved = q;
    system.plus(q, 0.01 * VecX::Random(model.velocities()), moved);
    q = moved;
    PatternSink pattern;
    system.evaluate(q, v, 0.0);
    system.tangent({mass_factor, h_gamma, h2_beta}, SecondOrder::omitted, lambda, pattern);
    solver.analyse(system.size(), pattern.blocks);
    block.analyse(system.size(), pattern.blocks);
    blocks = pattern.blocks;
  }

  void residual() {
    system.evaluate(q, v, 0.0);
    system.residual(a, lambda, r);
    system.violation(phi);
    rhs.head(r.size()) = -r;
    rhs.tail(phi.size()) = phi / -h2_beta;
  }
  template <class Solver>
  void matrix(Solver& sink) {
    sink.begin();
    system.tangent({mass_factor, h_gamma, h2_beta}, SecondOrder::omitted, lambda, sink);
  }
  template <class Solver>
  void solve(Solver& by) {
    by.factor();
    by.solve(rhs, x);
  }
};

// Loop written by hand, without markers, joints and types. The code contains all constants of the chain.
struct Fused {
  int links;
  EigenSparseLu::Matrix matrix;
  std::vector<int> mass_slots, joint_slots;  // 36 per body; up to 4 × 30 per joint
  VecX rhs;
  std::vector<Mat3> axes;
  Eigen::SparseLU<EigenSparseLu::Matrix, Eigen::COLAMDOrdering<int>> lu;
  VecX x;
  BlockSolver block;
  Mat3 triad = constraint_functions::triad_about(pin_axis, "pin");

  Fused(int n, EigenSparseLu::Matrix const& pattern)
      : links(n), matrix(pattern), rhs(VecX::Zero(pattern.rows())), axes(std::size_t(n)), x(rhs) {
    auto const slot = [&](int i, int j) {
      int const *b = matrix.innerIndexPtr() + matrix.outerIndexPtr()[j],
                *e = matrix.innerIndexPtr() + matrix.outerIndexPtr()[j + 1];
      return int(std::lower_bound(b, e, i) - matrix.innerIndexPtr());
    };
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < 6; ++j)
        for (int i = 0; i < 6; ++i) mass_slots.push_back(slot(6 * k + i, 6 * k + j));
    for (int k = 0; k < n; ++k)
      for (int body : {k - 1, k}) {
        if (body < 0) continue;
        for (int m = 0; m < 5; ++m)
          for (int i = 0; i < 6; ++i) {
            joint_slots.push_back(slot(6 * body + i, 6 * n + 5 * k + m));
            joint_slots.push_back(slot(6 * n + 5 * k + m, 6 * body + i));
          }
      }
    lu.analyzePattern(matrix);
  }

  void residual(VecX const& q, VecX const& v, VecX const& a, VecX const& lambda) {
    int const nv = 6 * links;
    for (int k = 0; k < links; ++k) {
      axes[std::size_t(k)] = rotation_matrix<double>(q.segment<4>(7 * k + 3));
      Vec3 const w = v.segment<3>(6 * k + 3);
      rhs.segment<3>(6 * k) = link_mass * (gravity - a.segment<3>(6 * k));
      rhs.segment<3>(6 * k + 3) = -(link_inertia * a.segment<3>(6 * k + 3)) + (link_inertia * w).cross(w);
    }
    Vec3 const half(0.5 * link_length, 0, 0);
    for (int k = 0; k < links; ++k) {
      Mat3 const& ab = axes[std::size_t(k)];
      Vec3 const rho_b = ab * -half, f = lambda.segment<3>(5 * k);
      Vec3 const b3 = ab * triad.col(2), rb = q.segment<3>(7 * k) + rho_b;
      Vec3 ra = Vec3::Zero(), a1 = triad.col(0), a2 = triad.col(1), rho_a = Vec3::Zero();
      if (k > 0) {
        Mat3 const& aa = axes[std::size_t(k - 1)];
        rho_a = aa * half;
        ra = q.segment<3>(7 * (k - 1)) + rho_a;
        a1 = aa * triad.col(0);
        a2 = aa * triad.col(1);
      }
      Vec3 const c = a1.cross(b3) * lambda[5 * k + 3] + a2.cross(b3) * lambda[5 * k + 4];
      rhs.segment<3>(6 * k) -= f;
      rhs.segment<3>(6 * k + 3) -= ab.transpose() * (rho_b.cross(f) - c);
      if (k > 0) {
        rhs.segment<3>(6 * k - 6) += f;
        rhs.segment<3>(6 * k - 3) -= axes[std::size_t(k - 1)].transpose() * (c - rho_a.cross(f));
      }
      rhs.segment<3>(nv + 5 * k) = (rb - ra) / -h2_beta;
      rhs[nv + 5 * k + 3] = a1.dot(b3) / -h2_beta;
      rhs[nv + 5 * k + 4] = a2.dot(b3) / -h2_beta;
    }
  }

  // Calls mass(k, M) for each link and joint(k, body, Gᵀ) for each end of each pin.
  template <class Mass, class JointBlock>
  void assemble(VecX const& v, Mass&& mass, JointBlock&& joint) {
    Matrix6 m = Matrix6::Zero();
    m.diagonal().head<3>().setConstant(mass_factor * link_mass);
    for (int k = 0; k < links; ++k) {
      Vec3 const w = v.segment<3>(6 * k + 3);
      m.bottomRightCorner<3, 3>() =
          mass_factor * link_inertia + h_gamma * (skew<double>(w) * link_inertia - skew<double>(link_inertia * w));
      mass(k, m);
    }
    Vec3 const half(0.5 * link_length, 0, 0);
    Mat<double, 6, 5> gt;
    for (int k = 0; k < links; ++k) {
      Mat3 const& ab = axes[std::size_t(k)];
      Vec3 const b3 = ab * triad.col(2);
      Vec3 const a1 = k > 0 ? Vec3(axes[std::size_t(k - 1)] * triad.col(0)) : Vec3(triad.col(0));
      Vec3 const a2 = k > 0 ? Vec3(axes[std::size_t(k - 1)] * triad.col(1)) : Vec3(triad.col(1));
      Vec3 const c1 = a1.cross(b3), c2 = a2.cross(b3);
      gt.setZero();
      if (k > 0) {
        Mat3 const& aa = axes[std::size_t(k - 1)];
        gt.topLeftCorner<3, 3>() = -Mat3::Identity();
        gt.bottomLeftCorner<3, 3>() = -(skew<double>(half) * aa.transpose());  // -Aᵀ ρ~ = -u~ Aᵀ
        gt.col(3).tail<3>() = aa.transpose() * c1;
        gt.col(4).tail<3>() = aa.transpose() * c2;
        joint(k, k - 1, gt);
      }
      gt.topLeftCorner<3, 3>().setIdentity();
      gt.bottomLeftCorner<3, 3>() = -(skew<double>(half) * ab.transpose());
      gt.col(3).tail<3>() = -(ab.transpose() * c1);
      gt.col(4).tail<3>() = -(ab.transpose() * c2);
      joint(k, k, gt);
    }
  }
  void assemble(VecX const& v) {
    double* const values = matrix.valuePtr();
    std::fill_n(values, matrix.nonZeros(), 0.0);
    int const *mass_slot = mass_slots.data(), *joint_slot = joint_slots.data();
    assemble(
        v,
        [&](int, Matrix6 const& m) {
          for (int i = 0; i < 36; ++i) values[*mass_slot++] = m.data()[i];
        },
        [&](int, int, Mat<double, 6, 5> const& gt) {
          for (int i = 0; i < 30; ++i) {
            values[*joint_slot++] = gt.data()[i];
            values[*joint_slot++] = gt.data()[i];
          }
        });
  }
  void assemble(VecX const& v, BlockSolver& solver) {
    solver.begin();
    assemble(
        v, [&](int k, Matrix6 const& m) { solver.add(6 * k, 6 * k, m); },
        [&](int k, int body, Mat<double, 6, 5> const& gt) {
          int const row = 6 * links + 5 * k;
          solver.add(6 * body, row, gt);
          solver.add(row, 6 * body, gt.transpose());
        });
  }
  void solve() {
    lu.factorize(matrix);
    x = lu.solve(rhs);
  }
};

// Median of the ratio time of `ours` / time of `theirs` of interleaved timings.
template <class F, class G>
double ratio(F&& ours, G&& theirs, int repeats) {
  auto const seconds = [](auto&& f) {
    auto const begin = std::chrono::steady_clock::now();
    for (int i = 0; i < 20; ++i) f();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  std::vector<double> ratios;
  for (int i = 0; i < repeats; ++i) {
    double const a = seconds(ours), b = seconds(theirs);
    ratios.push_back(a / b);
  }
  std::nth_element(ratios.begin(), ratios.begin() + repeats / 2, ratios.end());
  return ratios[std::size_t(repeats / 2)];
}

int const links = 64;
Fixture& fixture() {
  static Fixture f(links);
  return f;
}
Fused& fused() {
  static Fused f(links, (fixture().residual(), fixture().matrix(fixture().solver), fixture().solver.matrix()));
  return f;
}

void waists_residual(benchmark::State& s) {
  for (auto _ : s) fixture().residual();
}
void fused_residual(benchmark::State& s) {
  for (auto _ : s) fused().residual(fixture().q, fixture().v, fixture().a, fixture().lambda);
}
void waists_matrix(benchmark::State& s) {
  for (auto _ : s) fixture().matrix(fixture().block);
}
void fused_matrix(benchmark::State& s) {
  for (auto _ : s) fused().assemble(fixture().v, fused().block);
}
void waists_solve(benchmark::State& s) {
  for (auto _ : s) {
    fixture().matrix(fixture().block);
    fixture().solve(fixture().block);
  }
}
BENCHMARK(waists_residual);
BENCHMARK(fused_residual);
BENCHMARK(waists_matrix);
BENCHMARK(fused_matrix);
BENCHMARK(waists_solve);

}  // namespace

int main(int argc, char** argv) {
  Fixture& w = fixture();
  Fused& f = fused();
  f.residual(w.q, w.v, w.a, w.lambda);
  f.assemble(w.v);
  w.residual();
  w.matrix(w.solver);
  double const off = (w.rhs - f.rhs).cwiseAbs().maxCoeff() / w.rhs.cwiseAbs().maxCoeff();
  double const off_matrix = (EigenSparseLu::Matrix(w.solver.matrix() - f.matrix)).norm() / f.matrix.norm();
  std::printf("agreement of the two: right-hand side %.1e, matrix %.1e\n", off, off_matrix);
  if (!(off < 1e-12 && off_matrix < 1e-12)) return 1;
  w.matrix(w.block);
  w.solve(w.block);
  f.block.analyse(w.system.size(), w.blocks);
  VecX const solution = w.x;
  f.assemble(w.v, f.block);
  f.block.factor();
  f.block.solve(f.rhs, f.x);
  if (!((f.x - solution).norm() < 1e-9 * solution.norm())) return 1;
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  auto const by_hand = [&] { f.residual(w.q, w.v, w.a, w.lambda); };
  auto const row = [](char const* what, double value) { std::printf("  %-44s %.2f\n", what, value); };
  std::printf("\nwaists / hand-fused, %d links\n", links);
  row("residual", ratio([&] { w.residual(); }, by_hand, 201));
  row("matrix, into the values of a sparse matrix", ratio([&] { w.matrix(w.solver); }, [&] { f.assemble(w.v); }, 201));
  row("matrix, into the block solver", ratio([&] { w.matrix(w.block); }, [&] { f.assemble(w.v, f.block); }, 201));
  row("whole Newton iteration, block solver", ratio(
                                                  [&] {
                                                    w.residual();
                                                    w.matrix(w.block);
                                                    w.solve(w.block);
                                                  },
                                                  [&] {
                                                    by_hand();
                                                    f.assemble(w.v, f.block);
                                                    f.block.factor();
                                                    f.block.solve(f.rhs, f.x);
                                                  },
                                                  201));
  row("whole Newton iteration, Eigen SparseLU", ratio(
                                                    [&] {
                                                      w.residual();
                                                      w.matrix(w.solver);
                                                      w.solve(w.solver);
                                                    },
                                                    [&] {
                                                      by_hand();
                                                      f.assemble(w.v);
                                                      f.solve();
                                                    },
                                                    21));
  std::printf("  (target of the whole iteration: at most 1.20)\n");
}
