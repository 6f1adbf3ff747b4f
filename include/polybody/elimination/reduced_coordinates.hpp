#pragma once
/// \file
/// Reduced coordinates of a time step, for models with policies that eliminate unknowns. The full velocities are v = T
/// u, with the matrix T of joint trees (`JointTree`) and of linear joints (`LinearElimination`). Bodies, joints and
/// forces do not depend on the elimination.

#include <polybody/elimination/articulated_body.hpp>
#include <polybody/elimination/body_equations.hpp>
#include <polybody/elimination/coordinate_maps.hpp>
#include <polybody/elimination/tree_dynamics.hpp>
#include <polybody/elimination/tree_tangent.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/system/make_operations.hpp>
#include <polybody/system/system.hpp>

namespace polybody {
namespace detail {

/// Coordinate maps with the linear equations of a time step. \tparam Solution solution method of the equations of joint
/// coordinates; void if there are only linear joints
template <class Solution>
class ReducedCoordinates : public CoordinateMaps<Solution> {
  using Maps = CoordinateMaps<Solution>;

 public:
  /// True if the articulated-body algorithm solves the equations.
  static constexpr bool solves_by_bodies = std::is_same_v<Solution, joint_coordinates::ArticulatedBody>;
  /// True if the unknowns of the linear equations are those of a time step. Otherwise the sparse equations of all
  /// bodies (`BodyEquationsOf`) are solved.
  static constexpr bool solves_as_it_is = solves_by_bodies || std::is_void_v<Solution>;

  /// \throws InvalidInput if joints with joint coordinates close a loop. \throws InconsistentInitialConditions if
  /// linear joints contradict each other.
  template <class M>
  explicit ReducedCoordinates(M const& model) : Maps(model) {
    if constexpr (solves_by_bodies) {
      dynamics_ = TreeDynamicsOf<>(reduction_.tree().bodies);
      weight_ = model.gravity().g;
    } else {
      equations_ = BodyEquationsOf<>(reduction_, model.linear_rows(), model.velocities(), model.rows());
    }
  }

  ReducedLayout reduced_layout(ModelLayout const& full) const;

  void coordinate_rates(VecX const& q, VecX const& v, VecX& rate) const override {
    polybody::coordinate_rates(reduction_.tree(), q, v, rate);
  }

  void reduce_state(State const& x, State& out) override {
    ReductionOf<> const& r = reduction_;
    out = {VecX::Zero(r.coordinates()),
           VecX::Zero(r.velocities()),
           VecX::Zero(r.velocities()),
           VecX::Zero(r.rows()),
           x.t,
           {}};
    r.reduce_coordinates(x.q, out.q);
    r.reduce_velocities(x.v, out.v);
    r.reduce_velocities(x.a, out.a);
    r.reduce_rows(x.lambda, out.lambda);
    read_coordinates(r.tree(), x.q, x.v, state_, out.q);
    this->place(out.q, out.v);
    r.tree().reduce_rates(state_, x.v, false, out.v);
    this->place(out.q, out.v);
    r.tree().reduce_rates(state_, x.a, true, out.a);
  }

  void write(BlockWriter const& write_full, BlockSink& sink) override {
    if constexpr (solves_by_bodies)
      write_full(sink);
    else
      equations_.write(write_full, sink);
  }

  std::shared_ptr<FrozenMaps> make_frozen() override {
    if constexpr (solves_by_bodies)
      return std::make_shared<FrozenFactors>(*this);
    else if constexpr (!solves_as_it_is)
      return std::make_shared<FrozenTree>(*this);
    else
      return std::make_shared<FrozenMaps>();
  }
  void balance_to_equations(VecX const& r, VecX& out) override {
    if constexpr (!solves_as_it_is) equations_.from_velocities(r, -1.0, out);
  }
  void rows_to_equations(double const* rows, VecX& out) override {
    if constexpr (!solves_as_it_is) equations_.from_rows(rows, out);
  }
  void correction_from_equations(VecX const& solution, VecX& out) override {
    if constexpr (!solves_as_it_is) {
      read_equations(state_, solution, out);
      equations_.to_eliminated_equations(solution, out.data() + reduction_.velocities() + reduction_.rows());
    }
  }
  Index accelerations(VecX const& q, VecX const& v, double load_factor, VecX const* residual, VecX& out) override {
    if constexpr (solves_by_bodies) {
      Index const body = residual ? dynamics_.accelerations(q, v, *residual, out)
                                  : dynamics_.accelerations_under_gravity(q, v, weight_ * load_factor, out);
      return body < 0 ? -1 : reduction_.tree().bodies[std::size_t(body)].vn;
    }
    return -1;
  }
  void balance(StepPosition const& x, double load_factor, VecX& r) override {
    if constexpr (solves_by_bodies) dynamics_.balance(x.at.q, x.at.v, x.a, weight_ * load_factor, r);
  }

 private:
  /// Stored state of the tree, at which a matrix was written. Maps the right-hand side of a step to the equations of
  /// all bodies, and their solution back.
  class FrozenTree final : public FrozenMaps {
   public:
    explicit FrozenTree(ReducedCoordinates& of) : of_(of), state_(of.state_) {}
    void freeze() override { state_ = of_.state_; }
    void to_equations(VecX const& rhs, VecX& out) override { of_.write_equations(state_, rhs, out); }
    void from_equations(VecX const& solution, VecX& out) override { of_.read_equations(state_, solution, out); }

   private:
    ReducedCoordinates& of_;
    TreeState state_;
  };
  /// Factors of a tangent by the articulated-body algorithm, and the state in which it was evaluated.
  class FrozenFactors final : public FrozenMaps {
   public:
    explicit FrozenFactors(ReducedCoordinates& of) : of_(of), state_(of.state_), tangent_(of.reduction_.tree().bodies) {
      solver_.attach(of.reduction_, state_);
    }
    void freeze() override { state_ = of_.state_; }
    Index factor(BlockWriter const& write_full) override {
      of_balance_ = false;
      solver_.begin();
      BlockSink sink(solver_);
      write_full(sink);
      return solver_.factor();
    }
    Index factor_balance(StepPosition const& x, double load_factor, TangentCoefficients const& k) override {
      of_balance_ = true;
      return tangent_.factor(x.at, x.a, of_.weight_ * load_factor, k);
    }
    void solve(VecX const& rhs, VecX& x) override { of_balance_ ? tangent_.solve(rhs, x) : solver_.solve(rhs, x); }

   private:
    ReducedCoordinates& of_;
    TreeState state_;
    ArticulatedBodySolverOf<> solver_;
    TreeTangentSolverOf<> tangent_;
    bool of_balance_ = false;  // true if the last factorisation is that of tangent_
  };

  void write_equations(TreeState& at, VecX const& rhs, VecX& out) {
    Index const nv = reduction_.velocities();
    std::copy_n(rhs.data(), nv, reduced_.data());
    a_.setZero();
    reduction_.expand_velocities(reduced_, a_);
    reduction_.tree().expand_forces(at, reduced_, a_);
    out.setZero();
    equations_.from_velocities(a_, 1.0, out);
    equations_.from_rows(rhs.data() + nv, out);
  }
  void read_equations(TreeState& at, VecX const& solution, VecX& out) {
    equations_.to_velocities(solution, a_);
    reduction_.reduce_velocities(a_, reduced_);
    reduction_.tree().reduce_rates(at, a_, false, reduced_);
    Index const nv = reduction_.velocities();
    std::copy_n(reduced_.data(), nv, out.data());
    equations_.to_rows(solution, out.data() + nv);
  }

  using Maps::a_;
  using Maps::reduced_;
  using Maps::reduction_;
  using Maps::state_;

  BodyEquationsOf<> equations_;
  std::conditional_t<solves_by_bodies, TreeDynamicsOf<>, bool> dynamics_{};
  Vec3 weight_ = Vec3(0, 0, 0);
};

template <class Solution>
ReducedLayout ReducedCoordinates<Solution>::reduced_layout(ModelLayout const& full) const {
  ReducedLayout n = Maps::reduced_layout();
  n.solves_by_bodies = solves_by_bodies;
  n.moves_by_newton_euler = true;
  for (TreeBody const& body : reduction_.tree().bodies) n.moves_by_newton_euler &= body.by_newton_euler;
  for (Index const row : reduction_.linear().redundant()) {
    std::string name = full.name_of(full.velocities + row);
    if (n.redundant.empty() || n.redundant.back() != name) n.redundant.push_back(std::move(name));
  }
  n.equations = n.velocities + n.rows;
  n.equation_velocities = n.velocities;
  if constexpr (!solves_by_bodies) {
    n.equations = equations_.size();
    n.equation_velocities = equations_.velocities();
    n.full_unknown = equations_.full_unknowns();
    n.eliminated_equations = equations_.eliminated_equations();
  }
  return n;
}

}  // namespace detail

/// Model that can be solved with its `Solution`. `joint_coordinates::ArticulatedBody` requires that all bodies are
/// rigid and no force has first-order states.
template <class M>
concept ArticulatedBodySolvable =
    !std::is_same_v<typename M::Solution, joint_coordinates::ArticulatedBody> || (M::all_rigid && !M::has_states);

/// Coordinates of a time step of `model` in the scalar T; empty if its joints eliminate no unknowns.
/// \throws InvalidInput if joints with joint coordinates close a loop; InconsistentInitialConditions if linear joints
/// contradict each other.
template <StateScalar T = double, class M>
CoordinatesOf<T> coordinates_of(M const& model) {
  if constexpr (M::eliminates) {
    using Solution = typename M::Solution;
    static_assert(ArticulatedBodySolvable<M>,
                  "joint_coordinates::ArticulatedBody needs rigid bodies and forces without first-order states. Use "
                  "joint_coordinates::Augmented.");
    if constexpr (std::same_as<T, double>) {
      auto maps = std::make_shared<detail::ReducedCoordinates<Solution>>(model);
      auto reduced = std::make_shared<ReducedLayout>(maps->reduced_layout(layout_of(model)));
      return {std::move(maps), std::move(reduced)};
    } else {
      auto maps = std::make_shared<detail::CoordinateMaps<Solution, T>>(model);
      auto reduced = std::make_shared<ReducedLayout>(maps->reduced_layout());
      return {std::move(maps), std::move(reduced)};
    }
  } else {
    return {};
  }
}

/// Equations of a time step of `model`, without the unknowns that its policies eliminate, in the scalar T.
template <StateScalar T = double, class M, Capabilities wanted = Capabilities::implicit_step>
BasicSystem<T> stepped_system(M const& model, With<wanted> = {}) {
  return BasicSystem<T>(model, with<wanted>, coordinates_of<T>(model));
}
/// Refuses a temporary model, because the system keeps a reference to its model.
template <StateScalar T = double, class M, Capabilities wanted = Capabilities::implicit_step>
BasicSystem<T> stepped_system(M const&& model, With<wanted> = {}) = delete;

}  // namespace polybody
