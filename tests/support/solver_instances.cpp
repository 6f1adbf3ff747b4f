#include <polybody/solvers/block_factor.hpp>
#include <polybody/solvers/default_solver.hpp>
#include <polybody/solvers/dense_lu.hpp>
#include <polybody/solvers/eigen_ldlt.hpp>
#include <polybody/solvers/iterative_refinement.hpp>
#include <polybody/solvers/redundancy_dropping.hpp>

#include <cstdlib>
#include <span>
#ifdef POLYBODY_WITH_KLU
#include <polybody/solvers/klu.hpp>
#endif

template class polybody::BlockFactor<polybody::Symmetry::measured>;
template class Eigen::SparseLU<polybody::EigenSparseLu::Matrix, Eigen::COLAMDOrdering<int>>;
template class Eigen::internal::SparseLUImpl<double, int>;

namespace polybody {
namespace {

template <class Solver>
class Behind final : public SolverInTests {
 public:
  void analyse(Index size, std::span<Block const> blocks) override { solver_.analyse(size, blocks); }
  void begin() override { solver_.begin(); }
  void add(Index row, Index col, BlockView const& b) override { solver_.add(row, col, b); }
  Index factor() override { return solver_.factor(); }
  bool reordered() const override {
    if constexpr (requires { solver_.reordered(); }) return solver_.reordered();
    return false;
  }
  std::size_t reorderings() const override {
    if constexpr (requires { solver_.reorderings(); }) return solver_.reorderings();
    return 0;
  }
  void limit_reorderings(std::size_t count) noexcept override {
    if constexpr (requires { solver_.limit_reorderings(count); }) solver_.limit_reorderings(count);
  }
  std::span<Index const> dropped() const override {
    if constexpr (requires { solver_.dropped(); }) return solver_.dropped();
    return {};
  }
  void mark_redundant(std::span<Index const> unknowns) override {
    if constexpr (requires { solver_.mark_redundant(unknowns); }) solver_.mark_redundant(unknowns);
  }
  bool is_doubtful(double share) const override {
    if constexpr (requires { solver_.is_doubtful(share); }) return solver_.is_doubtful(share);
    return false;
  }
  Sequence<IndexMap<double>> null_vectors(VecX const& sizes) const override {
    if constexpr (requires { solver_.null_vectors(sizes); }) return solver_.null_vectors(sizes);
    return {};
  }
  double sign_of_determinant() const override {
    if constexpr (requires { solver_.sign_of_determinant(); }) return solver_.sign_of_determinant();
    return 0.0;
  }
  void solve(VecX const& b, VecX& x) const override { solver_.solve(b, x); }

 private:
  Solver solver_;
};

/// Uses a solver in time steps or in statics, as a user's solver is used.
template <class Solver>
std::unique_ptr<SolverInTests> behind(SolverFor use) {
  if (use == SolverFor::statics) return std::make_unique<Behind<Solver>>();
  if (use == SolverFor::unsymmetric_steps) return std::make_unique<Behind<StepSolver<UnsymmetricSolver<Solver>>>>();
  return std::make_unique<Behind<StepSolver<Solver>>>();
}

}  // namespace

std::unique_ptr<SolverInTests> solver_named_by_environment(Index size, SolverFor use) {
  char const* const given = std::getenv("POLYBODY_SOLVER");
  std::string const name = given ? given : "";
  if (name.empty()) return nullptr;
  if (name == "EigenSparseLu") return behind<EigenSparseLu>(use);
  if (name == "DenseLu") {
    if (size > 400) return nullptr;
    return behind<DenseLu>(use);
  }
#ifdef POLYBODY_WITH_KLU
  if (name == "Klu") return behind<Klu>(use);
#endif
  // these solvers need pivots within blocks, or symmetry: statics keeps its default
  bool const for_steps =
      name == "BlockLdlt" || name == "BlockLu" || name == "EigenLdlt" || name == "RefinedBlockSolver";
  if (!for_steps) throw InvalidInput("POLYBODY_SOLVER=" + name + " is not a solver that the tests know.");
  if (use == SolverFor::statics) return nullptr;
  if (name == "BlockLdlt") return behind<BlockLdlt>(use);
  if (name == "BlockLu") return behind<BlockLu>(use);
  if (name == "EigenLdlt") return behind<EigenLdlt>(use);
  return behind<IterativeRefinement<BlockSolver>>(use);
}

}  // namespace polybody
