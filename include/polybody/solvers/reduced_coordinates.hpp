#pragma once
/// \file
/// Reduced coordinates of a time step, for models with policies that eliminate unknowns. The full velocities are v = T
/// u, with the matrix T of joint trees (`JointTree`) and of linear joints (`LinearElimination`). Bodies, joints and
/// forces do not depend on the elimination.

#include <polybody/math/sequence.hpp>
#include <polybody/solvers/articulated_body.hpp>
#include <polybody/solvers/body_equations.hpp>
#include <polybody/solvers/coordinate_maps.hpp>
#include <polybody/solvers/tree_dynamics.hpp>
#include <polybody/solvers/tree_tangent.hpp>
#include <polybody/system/dense_reduction.hpp>
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
  /// True if the dense system TᵀKT is solved.
  static constexpr bool solves_densely = std::is_same_v<Solution, joint_coordinates::DenseMatrix>;
  /// True if the articulated-body algorithm solves the equations; it receives the tangent of the full model.
  static constexpr bool solves_by_bodies = std::is_same_v<Solution, joint_coordinates::ArticulatedBody>;
  /// True if the unknowns of the linear equations are those of a time step. Otherwise the sparse equations of all
  /// bodies (`BodyEquationsOf`) are solved.
  static constexpr bool solves_as_it_is = solves_densely || solves_by_bodies || std::is_void_v<Solution>;

  /// \throws InvalidInput if joints with joint coordinates close a loop. \throws InconsistentInitialConditions if
  /// linear joints contradict each other.
  template <class M>
  explicit ReducedCoordinates(M const& model)
      : Maps(model),
        unit_(VecX::Zero(reduction_.velocities())),
        full_velocities_(model.velocities()),
        full_rows_(model.rows()) {
    if constexpr (solves_by_bodies) {
      dynamics_ = TreeDynamicsOf<>(reduction_.tree().bodies);
      weight_ = model.gravity().g;
    }
    if constexpr (solves_densely)
      prepare_dense();
    else if constexpr (!solves_by_bodies)
      equations_ = BodyEquationsOf<>(reduction_, model.linear_rows(), full_velocities_, full_rows_);
  }

  ReducedLayout reduced_layout(ModelLayout const& full) const;

  static CoordinateOperations const table;

 private:
  using Self = ReducedCoordinates;
  static Self& of(void* c) { return *static_cast<Self*>(c); }

  static constexpr CoordinateOperations make_table() {
    CoordinateOperations out;
    Maps::template enter<Self>(out);
    out.coordinate_rates = &coordinate_rates;
    out.reduced = &reduced;
    out.write = &write;
    out.make_frozen_state = &make_frozen_state;
    out.freeze = &freeze;
    out.to_equations = &to_equations;
    out.from_equations = &from_equations;
    out.balance_to_equations = &balance_to_equations;
    out.rows_to_equations = &rows_to_equations;
    out.correction_from_equations = &correction_from_equations;
    out.accelerations = &accelerations;
    out.balance = &balance;
    out.factor_balance = &factor_balance;
    out.factor = &factor;
    out.solve = &solve;
    return out;
  }

  static void coordinate_rates(void* c, VecX const& q, VecX const& v, VecX& rate) {
    polybody::coordinate_rates(of(c).reduction_.tree(), q, v, rate);
  }

  static void reduced(void* c, State const& x, State& out) {
    Self& s = of(c);
    ReductionOf<> const& r = s.reduction_;
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
    read_coordinates(r.tree(), x.q, x.v, s.state_, out.q);
    s.place(out.q, out.v);
    r.tree().reduce_rates(s.state_, x.v, false, out.v);
    s.place(out.q, out.v);
    r.tree().reduce_rates(s.state_, x.a, true, out.a);
  }

  static void write(void* c, BlockWriter const& write_full, BlockSink& sink) {
    Self& s = of(c);
    if constexpr (solves_densely) {
      for (Index j = 0; j < s.unit_.size(); ++j) {
        s.unit_[j] = 1.0;
        s.expand_rates(s.unit_, false, s.a_);
        s.dense_.set_column(j, s.a_);
        s.unit_[j] = 0.0;
      }
      s.dense_.begin();
      BlockSink dense(s.dense_);
      write_full(dense);
      s.dense_.write(sink);
    } else if constexpr (solves_by_bodies) {
      write_full(sink);
    } else {
      s.equations_.write(write_full, sink);
    }
  }

  /// Factors of a tangent, and the state in which it was evaluated.
  struct Frozen {
    TreeState state;
    ArticulatedBodySolverOf<> solver;
    TreeTangentSolverOf<> tangent;
    bool of_balance = false;  ///< true if the last factorisation is that of `tangent`
  };
  static FrozenState make_frozen_state(void* c) {
    if constexpr (solves_by_bodies) {
      auto frozen = std::make_shared<Frozen>();
      frozen->state = of(c).state_;
      frozen->solver.attach(of(c).reduction_, frozen->state);
      frozen->tangent = TreeTangentSolverOf<>(of(c).reduction_.tree().bodies);
      return frozen;
    }
    return std::make_shared<TreeState>(of(c).state_);
  }
  static void freeze(void* c, void* h) {
    if constexpr (solves_by_bodies)
      static_cast<Frozen*>(h)->state = of(c).state_;
    else if constexpr (!solves_as_it_is)
      *static_cast<TreeState*>(h) = of(c).state_;
  }
  static Index accelerations(void* c, VecX const& q, VecX const& v, double load_factor, VecX const* residual,
                             VecX& out) {
    if constexpr (solves_by_bodies) {
      Self& s = of(c);
      Index const body = residual ? s.dynamics_.accelerations(q, v, *residual, out)
                                  : s.dynamics_.accelerations_under_gravity(q, v, s.weight_ * load_factor, out);
      return body < 0 ? -1 : s.reduction_.tree().bodies[std::size_t(body)].vn;
    }
    return -1;
  }
  static void balance(void* c, StepPosition const& x, double load_factor, VecX& r) {
    if constexpr (solves_by_bodies) of(c).dynamics_.balance(x.at.q, x.at.v, x.a, of(c).weight_ * load_factor, r);
  }
  static Index factor_balance(void* c, void* h, StepPosition const& x, double load_factor,
                              TangentCoefficients const& k) {
    if constexpr (solves_by_bodies) {
      Frozen& frozen = *static_cast<Frozen*>(h);
      frozen.of_balance = true;
      return frozen.tangent.factor(x.at, x.a, of(c).weight_ * load_factor, k);
    }
    return -1;
  }
  static Index factor(void*, void* h, BlockWriter const& write_full) {
    if constexpr (solves_by_bodies) {
      Frozen& frozen = *static_cast<Frozen*>(h);
      frozen.of_balance = false;
      frozen.solver.begin();
      BlockSink sink(frozen.solver);
      write_full(sink);
      return frozen.solver.factor();
    }
    return -1;
  }
  static void solve(void* h, VecX const& rhs, VecX& x) {
    if constexpr (solves_by_bodies) {
      Frozen& frozen = *static_cast<Frozen*>(h);
      frozen.of_balance ? frozen.tangent.solve(rhs, x) : frozen.solver.solve(rhs, x);
    }
  }

  static void to_equations(void* c, void* h, VecX const& rhs, VecX& out) {
    if constexpr (solves_as_it_is) {
      out = rhs;
    } else {
      Self& s = of(c);
      Index const nv = s.reduction_.velocities();
      std::copy_n(rhs.data(), nv, s.reduced_.data());
      s.a_.setZero();
      s.reduction_.expand_velocities(s.reduced_, s.a_);
      s.reduction_.tree().expand_forces(*static_cast<TreeState*>(h), s.reduced_, s.a_);
      out.setZero();
      s.equations_.from_velocities(s.a_, 1.0, out);
      s.equations_.from_rows(rhs.data() + nv, out);
    }
  }
  static void from_equations(void* c, void* h, VecX const& solution, VecX& out) {
    if constexpr (solves_as_it_is)
      out = solution;
    else
      of(c).read_equations(*static_cast<TreeState*>(h), solution, out);
  }
  void read_equations(TreeState& at, VecX const& solution, VecX& out) {
    equations_.to_velocities(solution, a_);
    reduction_.reduce_velocities(a_, reduced_);
    reduction_.tree().reduce_rates(at, a_, false, reduced_);
    Index const nv = reduction_.velocities();
    std::copy_n(reduced_.data(), nv, out.data());
    equations_.to_rows(solution, out.data() + nv);
  }
  static void balance_to_equations(void* c, VecX const& r, VecX& out) {
    if constexpr (!solves_as_it_is) of(c).equations_.from_velocities(r, -1.0, out);
  }
  static void rows_to_equations(void* c, double const* rows, VecX& out) {
    if constexpr (!solves_as_it_is) of(c).equations_.from_rows(rows, out);
  }
  static void correction_from_equations(void* c, VecX const& solution, VecX& out) {
    if constexpr (!solves_as_it_is) {
      Self& s = of(c);
      s.read_equations(s.state_, solution, out);
      s.equations_.to_eliminated_equations(solution, out.data() + s.reduction_.velocities() + s.reduction_.rows());
    }
  }

  void prepare_dense() {
    Sequence<Index> row_of(std::size_t(full_rows_), -1);
    for (Index i = 0; i < reduction_.rows(); ++i)
      row_of[std::size_t(reduction_.remaining_equations()[std::size_t(i)])] = i;
    dense_ = DenseReductionOf<>(full_velocities_, reduction_.velocities(), reduction_.rows(), std::move(row_of));
  }

  using Maps::a_;
  using Maps::reduced_;
  using Maps::reduction_;
  using Maps::state_;

  VecX unit_;
  Index full_velocities_, full_rows_;
  BodyEquationsOf<> equations_;
  DenseReductionOf<> dense_;
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
  if constexpr (!solves_densely && !solves_by_bodies) {
    n.equations = equations_.size();
    n.equation_velocities = equations_.velocities();
    n.full_unknown = equations_.full_unknowns();
    n.eliminated_equations = equations_.eliminated_equations();
  }
  return n;
}

template <class Solution>
constinit CoordinateOperations const ReducedCoordinates<Solution>::table = ReducedCoordinates::make_table();

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
      using Reduced = detail::ReducedCoordinates<Solution>;
      auto self = std::make_shared<Reduced>(model);
      auto reduced = std::make_shared<ReducedLayout>(self->reduced_layout(layout_of(model)));
      return {std::move(self), &Reduced::table, std::move(reduced)};
    } else {
      using Maps = detail::CoordinateMaps<Solution, T>;
      auto self = std::make_shared<Maps>(model);
      auto reduced = std::make_shared<ReducedLayout>(self->reduced_layout());
      return {std::move(self), &detail::map_entries<Maps, T>, std::move(reduced)};
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
