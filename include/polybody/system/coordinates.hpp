#pragma once
/// \file
/// Between the unknowns of a time step and those of the whole model, where policies eliminate some: v = T u,
/// v̇ = T u̇ + b. A table of functions, so that programs whose joints eliminate nothing compile none of it.

#include <polybody/math/block_sink.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/system/model_operations.hpp>
#include <polybody/system/state.hpp>

namespace polybody {

/// What is known of narrow vectors beside the functions.
struct ReducedLayout {
  Index coordinates = 0, velocities = 0, rows = 0;  ///< counts in narrow vectors; states are speeds
  Sequence<Index> nonholonomic_equations = {};      ///< narrow
  Sequence<ReducedPosition> places = {};            ///< of the bodies, in the order of the layout
  Sequence<Index> full_velocity = {};  ///< behind a narrow one; of a joint coordinate, the first of the carried body
  Sequence<Index> remaining_equations = {};  ///< by their number in the model
  /// A turn of a joint, in narrow vectors.
  struct Turn {
    Index q, v;                     ///< its first coordinate and speed
    Index coordinates, velocities;  ///< how many of both it has
  };
  Sequence<Turn> turns = {};  ///< among the joint coordinates; the others are slides and deformations
  /// Eliminated rows of joints that carry bodies, where the equations hold them: a step may keep estimates of their
  /// multipliers behind those of its rows. They move nothing; they bring the residual of the whole model near zero.
  Sequence<Index> eliminated_equations = {};
  std::vector<std::string> redundant = {};  ///< joints whose linear rows repeat others

  /// A linear system of equations may have other unknowns than a time step; those that stand for speeds come first.
  Index equations = 0, equation_velocities = 0;  ///< unknowns of the equations; of these, speeds
  Sequence<Index> full_unknown = {};             ///< behind an equation; empty where they are those of a step
  bool solves_by_bodies = false;                 ///< the tree itself is the solver
  bool moves_by_newton_euler = false;            ///< its bodies have no forces of their own
  bool keeps_mass_constant = false;              ///< T is constant

  /// The `full` multipliers of all rows from those `of_step`; zero for eliminated ones of which it has no estimates.
  template <StateScalar T>
  void expand_rows(VecXOf<T> const& of_step, VecXOf<T>& full) const {
    for (Index i = 0; i < full.size(); ++i) full[i] = T(0.0);
    for (std::size_t i = 0; i < remaining_equations.size(); ++i) full[remaining_equations[i]] = of_step[Index(i)];
    if (of_step.size() == rows) return;
    for (std::size_t i = 0; i < eliminated_equations.size(); ++i)
      full[eliminated_equations[i]] = of_step[rows + Index(i)];
  }
};

/// What a factorisation keeps of the state at which its matrix was written; for trees that are their own solver, that
/// solver.
using FrozenState = std::shared_ptr<void>;

/// Where an implicit step stands: (q, v, t), v̇ and λ in its own unknowns.
struct StepPosition {
  At<double> at;           ///< q, v and t, narrow
  VecX const &a, &lambda;  ///< v̇ (nv) and λ (rows), narrow
};

/// The functions between narrow and whole vectors of the scalar T; `c` is the elimination that made them.
template <StateScalar T>
struct CoordinateMapOperations {
  using Vector = VecXOf<T>;  ///< of coordinates, speeds or rows

  /// Whole q, v from narrow ones; this place is kept for what follows.
  void (*expand)(void* c, Vector const& q, Vector const& v, Vector& full_q, Vector& full_v) = nullptr;
  /// T u, or T u + b.
  void (*expand_rates)(void* c, Vector const& u, bool bias, Vector& out) = nullptr;
  /// out = Tᵀ r; r is used up, and kept as it was for the multipliers.
  void (*reduce)(void* c, Vector& r, Vector& out) = nullptr;
  /// Adds to estimates of the multipliers of eliminated joints what they lack in the last r that was reduced, M a − f +
  /// Gᵀλ with these estimates.
  void (*recover_multipliers)(void* c, Data<T> const& data, Vector& lambda) = nullptr;
  /// q ⊞ δ and its rate for joint coordinates; other bodies see to their own.
  void (*plus)(void* c, Vector const& q, Vector const& delta, Vector& out) = nullptr;
  /// δ˙ while q ⊞ δ moves with the narrow speeds v, for joint coordinates.
  void (*local_rate)(void* c, Vector const& delta, Vector const& v, Vector& out) = nullptr;
};

/// The functions that coordinates of a step's own offer in doubles.
struct CoordinateOperations : CoordinateMapOperations<double> {
  /// q˙ of joint coordinates.
  void (*coordinate_rates)(void* c, VecX const& q, VecX const& v, VecX& rate) = nullptr;
  /// The narrow state next to a whole one: exact where this one keeps to the eliminated joints.
  void (*reduced)(void* c, State const& x, State& out) = nullptr;

  /// The whole tangent that `write` gives, in the unknowns of the equations.
  void (*write)(void* c, BlockWriter const& write, BlockSink& sink) = nullptr;
  /// Makes a place to keep; `hold` copies the state of the last `expand` into it.
  FrozenState (*held)(void* c) = nullptr;
  void (*hold)(void* c, void* held) = nullptr;  ///< see `held`
  /// A right-hand side of a time step as one of the equations, and a solution of these as one of the step's unknowns.
  void (*to_equations)(void* c, void* held, VecX const& rhs, VecX& out) = nullptr;
  /// Unknowns of the step from a solution of the equations, at the place that is held.
  void (*from_equations)(void* c, void* held, VecX const& solution, VecX& out) = nullptr;
  /// Where there are `eliminated_equations`: −r of the whole model into the equations; the rows of a step into them; a
  /// solution as one of the step's unknowns at the place of the last `expand`, and behind these the multipliers of the
  /// carrying rows.
  void (*balance_to_equations)(void* c, VecX const& r, VecX& out) = nullptr;
  /// Adds the rows of a step to a right-hand side of the equations.
  void (*rows_to_equations)(void* c, double const* rows, VecX& out) = nullptr;
  /// A correction of a step, and behind it the multipliers of the carrying rows, from a solution of the equations.
  void (*correction_from_equations)(void* c, VecX const& solution, VecX& out) = nullptr;
  /// For trees that are their own solver: u̇ where no rows stay, under weight alone or with `unbalance` (of the
  /// whole model); −1, or the speed whose freedom has no inertia.
  Index (*accelerations)(void* c, VecX const& q, VecX const& v, double load_factor, VecX const* unbalance,
                         VecX& out) = nullptr;
  /// For them under weight alone: r = Tᵀ(M(T u̇ + b) − f) at a step's place; and the factors of its exact tangent there,
  /// −1 or the speed without a pivot.
  void (*balance)(void* c, StepPosition const& x, double load_factor, VecX& r) = nullptr;
  /// The factors of this balance's tangent; `k` has its coefficients.
  Index (*factor_balance)(void* c, void* held, StepPosition const& x, double load_factor,
                          TangentCoefficients const& k) = nullptr;
  /// Factors the whole tangent that `write` gives: −1, or the speed without a pivot.
  Index (*factor)(void* c, void* held, BlockWriter const& write) = nullptr;
  /// Solves with the last factors, of `factor` or `factor_balance`; in the unknowns of a step.
  void (*solve)(void* held, VecX const& rhs, VecX& x) = nullptr;
};

/// Coordinates of the scalar T with their functions; none where a policy eliminates nothing.
template <StateScalar T>
struct CoordinatesOf {
  /// The functions: of doubles more than the maps.
  using Table = std::conditional_t<std::same_as<T, double>, CoordinateOperations, CoordinateMapOperations<T>>;

  std::shared_ptr<void> self;                                    ///< the elimination, which `entries` take as `c`
  Table const* entries = nullptr;                                ///< null: nothing is eliminated
  std::shared_ptr<ReducedLayout const> reduced;                  ///< what is known of the narrow vectors
  explicit operator bool() const { return entries != nullptr; }  ///< whether a policy eliminates anything
};

using Coordinates = CoordinatesOf<double>;  ///< in doubles

}  // namespace polybody
