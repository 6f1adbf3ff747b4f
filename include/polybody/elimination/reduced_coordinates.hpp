#pragma once
/// \file
/// Reduced coordinates of a time step, for models with policies that eliminate unknowns. The full velocities are v = T
/// u, with the matrix T of joint trees (`JointTree`) and of linear joints (`LinearElimination`). Bodies, joints and
/// forces do not depend on the elimination.
///
/// Sparse equations (`BodyEquationsOf`) replace the dense equations in joint coordinates. The unknowns are the
/// velocities of all bodies, except velocities that linear joints make dependent, and the multipliers of all constraint
/// equations except those of linear joints. Matrix entries of dependent coordinates are distributed among the
/// independent coordinates.
/// Theory: Eqs. 5.11, 5.12.

#include <array>

#include <polybody/elimination/articulated_body.hpp>
#include <polybody/elimination/coordinate_maps.hpp>
#include <polybody/elimination/reduced_sink.hpp>
#include <polybody/elimination/reduction.hpp>
#include <polybody/elimination/tree_dynamics.hpp>
#include <polybody/elimination/tree_tangent.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/system/make_operations.hpp>
#include <polybody/system/system.hpp>

namespace polybody {

namespace detail {

/// Sparse equations of all bodies. As a template, the class is compiled only in programs with joint coordinates.
template <class = void>
class BodyEquationsOf {
 public:
  BodyEquationsOf() = default;
  BodyEquationsOf(ReductionOf<> const& reduction, Sequence<LinearConstraints> const& linear_rows, Index full_velocities,
                  Index full_constraints)
      : full_velocities_(full_velocities) {
    Index const nv = full_velocities;
    Sequence<Sequence<UnknownMap::Target>> targets(std::size_t(nv + full_constraints));
    Sequence<bool> dependent(std::size_t(nv), false);
    for (auto const& d : reduction.linear().dependents()) dependent[std::size_t(d.v)] = true;
    for (Index i = 0; i < nv; ++i)
      if (!dependent[std::size_t(i)]) targets[std::size_t(i)].push_back({velocities_++, 1.0});
    for (auto const& d : reduction.linear().dependents())
      for (auto const& t : d.terms) {
        Index const to = targets[std::size_t(t.v)][0].unknown;
        targets[std::size_t(d.v)].push_back({to, t.factor});
        dependents_.push_back({d.v, to, t.factor});
      }
    Sequence<bool> linear(std::size_t(full_constraints), false);
    for (LinearConstraints const& rows : linear_rows)
      for (Index i = 0; i < rows.rows(); ++i) linear[std::size_t(rows.row + i)] = true;
    for (Index i = 0; i < full_constraints; ++i)
      if (!linear[std::size_t(i)]) targets[std::size_t(nv + i)].push_back({velocities_ + rows_++, 1.0});
    map_ = UnknownMap(std::move(targets));
    for (Index i = 0; i < nv + full_constraints; ++i)
      of_.push_back(i < nv && dependent[std::size_t(i)] ? -1 : map_.run(i, 1));
    rows_that_stay_ = reduction.remaining_equations();
    Sequence<bool> stays(std::size_t(full_constraints), false);
    for (Index const i : rows_that_stay_) stays[std::size_t(i)] = true;
    for (Index i = 0; i < full_constraints; ++i)
      if (!stays[std::size_t(i)] && of_[std::size_t(nv + i)] >= 0) carrying_rows_.push_back(i);
  }

  Index size() const { return velocities_ + rows_; }
  Index velocities() const { return velocities_; }
  /// Indices, in the model, of the constraint equations of joints with joint coordinates.
  Sequence<Index> const& eliminated_equations() const { return carrying_rows_; }
  /// For each reduced equation: index of its unknown among the full unknowns.
  Sequence<Index> full_unknowns() const {
    Sequence<Index> out(std::size_t(size()), -1);
    for (Index i = Index(of_.size()); i-- > 0;)
      if (Index const at = of_[std::size_t(i)]; at >= 0) out[std::size_t(at)] = i;
    return out;
  }

  void write(BlockWriter const& write_full, BlockSink& sink) {
    std::uint64_t const layout = sink.slots().layout;
    for (ReducedSlotsOf<>& slots : slots_)
      if (layout != 0 && slots.leads_to(layout)) {
        slots.begin();
        BlockSink full(slots);
        return write_full(full);
      }
    ReducedSlotsOf<>* const slots = layout != 0 ? &slots_[next_slots_] : nullptr;
    if (slots) slots->record(sink.slots());
    ReducedSinkOf<> mapped(map_, mapped_, sink, slots);
    BlockSink full(mapped);
    write_full(full);
    if (!mapped.recorded()) return;
    slots->complete();
    next_slots_ = (next_slots_ + 1) % slots_.size();
  }

  /// Sets the entries of `out` for velocities to factor · Tᵀ `full`, where T gives all velocities from the independent
  /// ones. Other entries are unchanged.
  void from_velocities(VecX const& full, double factor, VecX& out) const {
    for (Index i = 0; i < full.size(); ++i)
      if (Index const to = of_[std::size_t(i)]; to >= 0) out[to] = factor * full[i];
    for (Dependent const& d : dependents_) out[d.to] += factor * d.factor * full[d.from];
  }
  /// Sets the entries of `out` for constraint equations: `rows` for the remaining equations, zero for joints with joint
  /// coordinates.
  void from_rows(double const* rows, VecX& out) const {
    for (Index i = velocities_; i < out.size(); ++i) out[i] = 0.0;
    for (std::size_t i = 0; i < rows_that_stay_.size(); ++i) out[of_row(rows_that_stay_[i])] = rows[i];
  }
  /// Computes the full velocities of a `solution`. Dependent velocities are set to zero.
  void to_velocities(VecX const& solution, VecX& full) const {
    for (Index i = 0; i < full.size(); ++i) {
      Index const from = of_[std::size_t(i)];
      full[i] = from >= 0 ? solution[from] : 0.0;
    }
  }
  void to_rows(VecX const& solution, double* out) const { take(rows_that_stay_, solution, out); }
  void to_eliminated_equations(VecX const& solution, double* out) const { take(carrying_rows_, solution, out); }

 private:
  /// Term of a dependent velocity.
  struct Dependent {
    Index from, to;  // full velocity, equation of the independent velocity
    double factor;
  };
  Index of_row(Index row) const { return of_[std::size_t(full_velocities_ + row)]; }
  void take(Sequence<Index> const& rows, VecX const& solution, double* out) const {
    for (std::size_t i = 0; i < rows.size(); ++i) out[i] = solution[of_row(rows[i])];
  }

  Index full_velocities_ = 0, velocities_ = 0, rows_ = 0;
  UnknownMap map_;
  Sequence<Index> of_, rows_that_stay_,
      carrying_rows_;  // of_: equation of each full unknown; −1 if it is distributed or omitted
  Sequence<Dependent> dependents_;
  MappedBlocks mapped_;
  // Destinations of the blocks in the last four solvers that received the matrix.
  std::array<ReducedSlotsOf<>, 4> slots_;
  std::size_t next_slots_ = 0;
};

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
