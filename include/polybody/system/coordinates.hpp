#pragma once
/// \file
/// Maps between the unknowns of a time step (reduced vectors) and those of the model (full vectors) if policies
/// eliminate unknowns: v = T u, v̇ = T u̇ + b. The maps are abstract classes; programs without these policies do not
/// compile an implementation.

#include <polybody/math/block_sink.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/system/model_operations.hpp>
#include <polybody/system/state.hpp>

namespace polybody {

/// Sizes and positions in reduced vectors.
struct ReducedLayout {
  /// Sizes of reduced vectors; velocities include first-order states.
  Index coordinates = 0, velocities = 0, rows = 0;
  Sequence<Index> nonholonomic_equations = {};  ///< indices of the nonholonomic equations in reduced vectors
  Sequence<ReducedPosition> places = {};        ///< positions of the bodies, in the order of the model's layout
  /// Index of the full velocity for each reduced velocity. For a joint coordinate, this is the first velocity of the
  /// body that the joint moves.
  Sequence<Index> full_velocity = {};
  Sequence<Index> remaining_equations = {};  ///< indices, in the model, of the constraint equations of a step
  /// Position of a rotation of a joint in reduced vectors.
  struct Turn {
    Index q, v;                     ///< indices of its first coordinate and velocity
    Index coordinates, velocities;  ///< numbers of its coordinates and velocities
  };
  Sequence<Turn> turns = {};  ///< rotations: all joint motions except translations
  /// Indices, in the model, of constraint equations that joint coordinates eliminate but the linear system contains. A
  /// step may store estimates of their multipliers after the multipliers of the remaining equations. The estimates do
  /// not affect the motion; they make the residual of the full model almost zero.
  Sequence<Index> eliminated_equations = {};
  std::vector<std::string> redundant = {};  ///< names of joints with redundant linear constraint equations

  Index equations = 0;            ///< number of unknowns of the linear system; may exceed those of a step
  Index equation_velocities = 0;  ///< number of velocities among these unknowns; velocities come first
  /// Index of the full unknown for each unknown of the linear system; empty if the system has the unknowns of a step.
  Sequence<Index> full_unknown = {};
  bool solves_by_bodies = false;       ///< true if the articulated-body algorithm solves the linear system
  bool moves_by_newton_euler = false;  ///< true if bodies of the tree have no elastic or other own forces
  bool keeps_mass_constant = false;    ///< true if T in v = T u is constant

  /// Computes the `full` multipliers from the multipliers `of_step`. Multipliers of eliminated equations without an
  /// estimate are set to zero.
  template <StateScalar T>
  void expand_rows(VecXOf<T> const& of_step, VecXOf<T>& full) const {
    for (Index i = 0; i < full.size(); ++i) full[i] = T(0.0);
    for (std::size_t i = 0; i < remaining_equations.size(); ++i) full[remaining_equations[i]] = of_step[Index(i)];
    if (of_step.size() == rows) return;
    for (std::size_t i = 0; i < eliminated_equations.size(); ++i)
      full[eliminated_equations[i]] = of_step[rows + Index(i)];
  }
};

/// Iterate of an implicit step.
struct StepPosition {
  At<double> at;           ///< q, v and t, reduced
  VecX const &a, &lambda;  ///< v̇ (nv) and λ (rows), reduced
};

/// Maps between reduced and full vectors of the scalar T.
template <StateScalar T>
class CoordinateMap {
 public:
  using Vector = VecXOf<T>;  ///< coordinates, velocities or constraint equations
  virtual ~CoordinateMap() = default;

  /// Computes `full_q` and `full_v` from reduced q and v. The other functions refer to this state.
  virtual void expand(Vector const& q, Vector const& v, Vector& full_q, Vector& full_v) = 0;
  /// out = T u, or T u + b if `bias` is true.
  virtual void expand_rates(Vector const& u, bool bias, Vector& out) = 0;
  /// out = Tᵀ r. Stores a copy of r for `recover_multipliers`, then overwrites r.
  virtual void reduce(Vector& r, Vector& out) = 0;
  /// Corrects the estimates `lambda` of the multipliers of eliminated joints, so that they balance the residual r of
  /// the last `reduce`. This residual r = M a − f + Gᵀλ must contain the same estimates.
  virtual void recover_multipliers(Data<T> const& data, Vector& lambda) = 0;
  /// out = q ⊞ δ for joint coordinates only.
  virtual void plus(Vector const& q, Vector const& delta, Vector& out) const = 0;
  /// out = δ˙ while q ⊞ δ moves with the reduced velocities v, for joint coordinates only.
  virtual void local_rate(Vector const& delta, Vector const& v, Vector& out) const = 0;
};

/// Stored state of the maps at which a matrix was written, with maps between the unknowns of a step and those of the
/// linear system. This base class stores nothing. Its linear system has the unknowns of a step.
class FrozenMaps {
 public:
  virtual ~FrozenMaps() = default;

  virtual void freeze() {}  ///< stores the state of the last `expand`
  /// Computes the right-hand side `out` of the linear system from the right-hand side `rhs` of a step.
  virtual void to_equations(VecX const& rhs, VecX& out) { out = rhs; }
  /// out = unknowns of the step from a solution of the linear system.
  virtual void from_equations(VecX const& solution, VecX& out) { out = solution; }
  /// Articulated-body algorithm: factorises the full tangent of `write`. Returns −1 on success, otherwise the index of
  /// the velocity without a pivot.
  virtual Index factor(BlockWriter const&) { return -1; }
  /// Articulated-body algorithm: factorises the exact tangent of `StepCoordinates::balance` with the coefficients k.
  /// Returns −1 on success, otherwise the index of the velocity without a pivot.
  virtual Index factor_balance(StepPosition const&, double /*load_factor*/, TangentCoefficients const&) { return -1; }
  /// Solves with the factors of the last `factor` or `factor_balance`, in the unknowns of a step.
  virtual void solve(VecX const& /*rhs*/, VecX& /*x*/) {}
};

/// Reduced coordinates of a time step in the scalar T.
template <StateScalar T>
class StepCoordinates : public CoordinateMap<T> {};

/// Reduced coordinates in doubles, with the linear system of a time step.
template <>
class StepCoordinates<double> : public CoordinateMap<double> {
 public:
  /// `rate` = q˙, for joint coordinates only.
  virtual void coordinate_rates(VecX const& q, VecX const& v, VecX& rate) const = 0;
  /// out = reduced state of the full state x. If x violates the equations of the eliminated joints, the violation is
  /// lost.
  virtual void reduce_state(State const& x, State& out) = 0;

  /// Writes the full tangent of `write` into `sink`, in the unknowns of the linear system.
  virtual void write(BlockWriter const& write, BlockSink& sink) = 0;
  /// Allocates storage for a state of the maps. The storage must not outlive the maps.
  virtual std::shared_ptr<FrozenMaps> make_frozen() = 0;
  /// For `eliminated_equations`: writes −r of the full model to the right-hand side `out` of the linear system.
  virtual void balance_to_equations(VecX const& r, VecX& out) = 0;
  /// For `eliminated_equations`: copies the right-hand sides `rows` of the constraint equations of a step to `out`, the
  /// right-hand side of the linear system.
  virtual void rows_to_equations(double const* rows, VecX& out) = 0;
  /// For `eliminated_equations`: computes the unknowns of the step from a solution of the linear system, at the state
  /// of the last `expand`. The multipliers of the eliminated equations follow them in `out`.
  virtual void correction_from_equations(VecX const& solution, VecX& out) = 0;
  /// Articulated-body algorithm, without constraint equations: out = u̇ under gravity times `load_factor` if `residual`
  /// is null, otherwise for this residual of the full model. Returns −1 on success, otherwise the index of a velocity
  /// without inertia.
  virtual Index accelerations(VecX const& q, VecX const& v, double load_factor, VecX const* residual, VecX& out) = 0;
  /// Articulated-body algorithm under gravity times `load_factor` only: r = Tᵀ(M(T u̇ + b) − f) at the iterate x.
  virtual void balance(StepPosition const& x, double load_factor, VecX& r) = 0;
};

/// Reduced coordinates of the scalar T; empty if no policy eliminates unknowns.
template <StateScalar T>
struct CoordinatesOf {
  std::shared_ptr<StepCoordinates<T>> maps;      ///< maps; null if no unknowns are eliminated
  std::shared_ptr<ReducedLayout const> reduced;  ///< sizes and positions in reduced vectors

  StepCoordinates<T>* operator->() const { return maps.get(); }  ///< access to the maps
  explicit operator bool() const { return maps != nullptr; }     ///< true if a policy eliminates unknowns
};

using Coordinates = CoordinatesOf<double>;  ///< reduced coordinates in doubles

}  // namespace polybody
