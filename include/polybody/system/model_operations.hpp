#pragma once
/// \file
/// The door between a model and everything above it: one table of plain functions, made where the model's type is
/// known. Each is a loop over the model's pools; what they compute stands in `Data` afterwards.

#include <polybody/math/block_sink.hpp>
#include <polybody/math/dual.hpp>
#include <polybody/system/data.hpp>
#include <polybody/system/layout.hpp>

namespace polybody {

class ActiveContactPairs;

/// Coefficients of the tangent cm M + cd D + ck K, D = −∂f/∂v, K = −∂f/∂q.
struct TangentCoefficients {
  double mass = 0.0;               ///< factor of M
  double damping = 0.0;            ///< factor of −∂f/∂v
  double stiffness = 0.0;          ///< factor of −∂f/∂q
  bool surrogate_friction = true;  ///< force groups may put a cheap matrix in place of a slope (`own_stiffness`)
  bool full = false;               ///< with second-order terms; a system sets it
  /// With all that steps leave out: blocks between the markers of a force group's pairs, and what positions do to
  /// rates.
  bool exact = false;
  ActiveContactPairs* pairs =
      nullptr;              ///< pairs of groups that have such blocks; null: all (system/active_contact_pairs.hpp)
  double states = damping;  ///< factor of −∂f/∂z and −∂h/∂z, z first-order states; a step takes them with its speeds
};

/// Terms ∂(Gᵀλ)/∂q and ∂(Jᵀw)/∂q: a time step may leave them out while Newton contracts; statics may not.
enum class SecondOrder { omitted, included };

/// Which groups of entries a table holds. An algorithm names what it needs, and no more is compiled.
enum class Capabilities : unsigned {
  motion = 0,             ///< markers, gaps, forces, M, ⊞, energies: always there
  tangent = 1,            ///< cm M + cd D + ck K
  second_order = 2,       ///< the tangent's second-order terms
  coordinate_rates = 4,   ///< q˙
  energy = 8,             ///< powers
  rigid_velocities = 16,  ///< speeds of a rigid motion
  secants = 32,           ///< means over a step, for steps that conserve energy
  compliance = 64,        ///< the slopes of compliant joints; part of `tangent`
  implicit_step = 3,      ///< tangent and second_order
  questions = 15,         ///< what a system is made with where nothing else is named
};
/// Both groups.
constexpr Capabilities operator|(Capabilities a, Capabilities b) { return Capabilities(unsigned(a) | unsigned(b)); }
/// Whether all of `some` are among `all`.
constexpr bool contains(Capabilities all, Capabilities some) {
  return (unsigned(all) & unsigned(some)) == unsigned(some);
}

/// Energies of a state [J].
struct Energy {
  double kinetic = 0.0;  ///< of all bodies, ½ v·M v
  double strain = 0.0;   ///< of flexible bodies
  double gravity = 0.0;  ///< zero at the world's origin
  double joints = 0.0;   ///< stored in compliant joints
  double forces = 0.0;   ///< stored in force elements that have a potential
  /// V: all that is stored.
  double potential() const { return strain + gravity + joints + forces; }
  /// T + V.
  double total() const { return kinetic + potential(); }
};

/// Powers in a state [W]; gravity, and what stores energy, are counted by `energy`.
struct Powers {
  double drives = 0.0;      ///< of what time prescribes in joints, on bodies and compliant joints
  double loads = 0.0;       ///< of loads, and of forces that have no potential
  double dissipated = 0.0;  ///< in damped bodies, compliant joints, dampers and contacts; positive when lost
};

/// Where one body stands in narrow vectors, those of a time step that policies have taken unknowns from.
struct ReducedPosition {
  /// What narrow vectors hold of a body.
  enum class Kind : unsigned char {
    as_it_is,  ///< all its coordinates
    reduced,   ///< some of them; they add
    carried    ///< those of its joint
  };
  Kind kind = Kind::as_it_is;                           ///< what they hold
  Index q = 0, v = 0, coordinates = 0, velocities = 0;  ///< its first coordinate and speed; how many of both it has
};

/// A state as entries are handed it: q (nq), v (nv), t.
template <StateScalar T>
struct At {
  VecXOf<T> const& q;  ///< (nq) coordinates
  VecXOf<T> const& v;  ///< (nv) speeds, and first-order states behind them
  double t;            ///< time [s]
};

namespace detail {
/// Where and by which factors second-order terms are taken.
struct StiffnessAt {
  At<double> at;
  TangentCoefficients const& c;
};
}  // namespace detail

/// The mean forces of a step, by secants (system/secant_operations.hpp).
struct SecantOperations;

/// The functions; `m` is the model. Those of a group that was not asked for are null.
template <StateScalar T>
struct ModelOperations {
  using Vector = VecXOf<T>;  ///< of coordinates, speeds or rows

  /// Markers; then the gaps of all row blocks and what compliant joints answer.
  void (*evaluate_marker)(void const* m, At<T> at, Data<T>& data) = nullptr;
  /// Gaps and their rates of all joints and own rows; the markers must have been published.
  void (*measure_gaps)(void const* m, At<T> at, Data<T>& data) = nullptr;
  /// γ of all rows without G's markers' biases, into out.
  void (*measure_gamma)(void const* m, At<T> at, Data<T> const& data, Vector& out) = nullptr;
  /// r += M a − f of all bodies, gravity times `load_factor`.
  void (*element_forces)(void const* m, At<T> at, Vector const& a, double load_factor, Data<T>& data,
                         Vector& r) = nullptr;
  /// The wrenches of all force elements into data.actions.
  void (*push_forces)(void const* m, double t, Data<T>& data) = nullptr;
  /// q ⊞ δ and the rate of δ; with `places`, in narrow vectors.
  void (*plus)(void const* m, ReducedPosition const* places, Vector const& q, Vector const& delta,
               Vector& out) = nullptr;
  /// δ˙ while q ⊞ δ moves with v.
  void (*local_rate)(void const* m, ReducedPosition const* places, Vector const& delta, Vector const& v,
                     Vector& out) = nullptr;
  /// From now on the threads share the loops; what is computed stays the same to the last bit.
  void (*share_loops)(void const* m, Data<T>& data, Workers& threads) = nullptr;
  /// M, element by element.
  void (*masses)(void const* m, At<T> at, Data<T>& data, BlockSink& sink) = nullptr;

  /// The tangent of bodies, of compliant joints and of force elements; with second-order terms,
  /// wrenches are added to data.loads.
  void (*element_tangents)(void const* m, At<T> at, TangentCoefficients const& c, Data<T>& data,
                           BlockSink& sink) = nullptr;
  /// The part of compliant joints, Gᵀ(ck ∂λ/∂g + cd ∂λ/∂ġ)G.
  void (*compliant_tangents)(void const* m, TangentCoefficients const& c, Data<T>& data, BlockSink& sink) = nullptr;
  /// The part of force elements at t [s], loads times `load_factor`.
  void (*force_tangents)(void const* m, double t, double load_factor, TangentCoefficients const& c, Data<T>& data,
                         BlockSink& sink) = nullptr;

  /// ck ∂(Gᵀλ)/∂q of joints, of what compliant ones answer too, and of bodies' own rows; ck ∂(Jᵀw)/∂q of data.loads.
  void (*joint_stiffness)(void const* m, At<T> at, Vector const& lambda, TangentCoefficients const& c, Data<T>& data,
                          BlockSink& sink) = nullptr;
  /// ck ∂(Jᵀw)/∂q for the wrenches in data.loads.
  void (*load_stiffness)(void const* m, At<T> at, TangentCoefficients const& c, Data<T>& data,
                         BlockSink& sink) = nullptr;

  /// q˙; `room` (2 nq + nv) is scratch.
  void (*coordinate_rates)(void const* m, ReducedPosition const* places, Vector const& q, Vector const& v,
                           VecXOf<Dual<1>>& room, Vector& rate) = nullptr;

  /// Energies of the evaluated state [J].
  Energy (*energy)(void const* m, At<T> at, Data<T> const& data) = nullptr;
  /// `backwards` is −v.
  Powers (*powers)(void const* m, At<T> at, VecX const& backwards, VecX const& lambda, double load_factor,
                   Data<T> const& data) = nullptr;

  /// v of a rigid motion: `v0` [m/s] of the body-fixed point at the world's origin, `omega` [rad/s], world axes.
  void (*rigid_velocities)(void const* m, Vector const& q, Vec3 const& v0, Vec3 const& omega, Vector& v) = nullptr;

  SecantOperations const* secants = nullptr;  ///< mean forces of a step; null where they were not asked for
};

/// The table for a model of type M; specialised where model types are known (system/make_operations.hpp).
template <class M, StateScalar T, Capabilities wanted>
struct OperationsOf;

}  // namespace polybody
