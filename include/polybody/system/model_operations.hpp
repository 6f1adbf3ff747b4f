#pragma once
/// \file
/// Interface between a model and the layers above: an abstract class, implemented where the model's type is known. Each
/// function loops over the model's pools and stores its results in `Data` or in its output arguments.

#include <memory>

#include <polybody/math/block_sink.hpp>
#include <polybody/math/dual.hpp>
#include <polybody/math/errors.hpp>
#include <polybody/system/data.hpp>
#include <polybody/system/island.hpp>

namespace polybody {

class ActiveContactPairs;
class ContactCoupling;

/// Coefficients of the tangent cm M + cd D + ck K with D = −∂f/∂v and K = −∂f/∂q.
struct TangentCoefficients {
  double mass = 0.0;               ///< factor of M
  double damping = 0.0;            ///< factor of −∂f/∂v
  double stiffness = 0.0;          ///< factor of −∂f/∂q
  bool surrogate_friction = true;  ///< true if force groups may approximate a derivative by `own_stiffness` of a law
  bool full = false;               ///< true if second-order terms are included; set by a system
  /// True if the tangent includes the terms that time steps omit: blocks between the two markers of each pair of a
  /// force group, and derivatives of rates with respect to positions.
  bool exact = false;
  /// Pairs of force groups with blocks between their two markers (system/active_contact_pairs.hpp); null: all pairs.
  ActiveContactPairs* pairs = nullptr;
  /// Receives the blocks between the two bodies of each contact of a contact set (system/contact_coupling.hpp); null:
  /// these blocks are not evaluated.
  ContactCoupling* coupling = nullptr;
  double states = damping;  ///< factor of −∂f/∂z and −∂h/∂z, with the first-order states z
};

/// Treatment of the second-order terms ∂(Gᵀλ)/∂q and ∂(Jᵀw)/∂q of a tangent. A time step may omit them as long as
/// Newton's method contracts; statics requires them.
enum class SecondOrder { omitted, included };

/// Groups of functions of a model. An algorithm names the groups that it requires; other groups are not compiled.
enum class Capabilities : unsigned {
  motion = 0,             ///< markers, constraint functions, forces, M, ⊞, energies: always included
  tangent = 1,            ///< cm M + cd D + ck K
  second_order = 2,       ///< second-order terms of the tangent
  coordinate_rates = 4,   ///< q̇
  energy = 8,             ///< powers
  rigid_velocities = 16,  ///< generalised velocities of a rigid motion
  secants = 32,           ///< mean forces over a step, for energy-conserving integration
  compliance = 64,        ///< tangents of compliant joints; part of `tangent`
  implicit_step = 3,      ///< tangent and second_order
  questions = 15,         ///< default of a system: tangent, second_order, coordinate_rates and energy
};
/// Union of two sets of groups.
constexpr Capabilities operator|(Capabilities a, Capabilities b) { return Capabilities(unsigned(a) | unsigned(b)); }
/// True if `all` contains every group of `some`.
constexpr bool contains(Capabilities all, Capabilities some) {
  return (unsigned(all) & unsigned(some)) == unsigned(some);
}

/// Energies of a state [J].
struct Energy {
  double kinetic = 0.0;  ///< kinetic energy T = ½ v·M v of all bodies [J]
  double strain = 0.0;   ///< strain energy of flexible bodies [J]
  double gravity = 0.0;  ///< potential energy of gravity, zero at the world's origin [J]
  double joints = 0.0;   ///< energy stored in compliant joints [J]
  double forces = 0.0;   ///< energy stored in force elements with a potential [J]
  /// Potential energy V [J].
  double potential() const { return strain + gravity + joints + forces; }
  /// Total energy T + V [J].
  double total() const { return kinetic + potential(); }
};

/// Powers in a state [W]. Powers that change a stored energy or the energy of gravity are not included; see `Energy`.
struct Powers {
  double drives = 0.0;      ///< power of motions prescribed in joints, including compliant joints [W]
  double loads = 0.0;       ///< power of loads, and of forces without a potential [W]
  double dissipated = 0.0;  ///< power lost in damped bodies, compliant joints, dampers and contacts, positive [W]
};

/// Position of one body in the reduced vectors, which do not contain the unknowns that policies eliminate.
struct ReducedPosition {
  /// Coordinates of a body in the reduced vectors.
  enum class Kind : unsigned char {
    as_it_is,  ///< all its coordinates
    reduced,   ///< some of its coordinates, with addition as retraction
    carried    ///< coordinates of the joint that moves the body
  };
  Kind kind = Kind::as_it_is;                           ///< kind of its coordinates
  Index q = 0, v = 0, coordinates = 0, velocities = 0;  ///< first coordinate and velocity, numbers of both
};

/// State as the functions of a model receive it: q (nq), v (nv), t.
template <StateScalar T>
struct At {
  VecXOf<T> const& q;  ///< (nq) generalised coordinates
  VecXOf<T> const& v;  ///< (nv) generalised velocities, then first-order states
  double t;            ///< time [s]
};

namespace detail {
/// State and tangent coefficients for the evaluation of second-order terms.
struct StiffnessAt {
  At<double> at;
  TangentCoefficients const& c;
};
}  // namespace detail

/// Mean forces over a step (system/step_secants.hpp).
class SecantOperations;

/// Functions of a model. Functions of groups that were not requested throw `InvalidInput`.
template <StateScalar T>
class ModelOperations {
 public:
  using Vector = VecXOf<T>;  ///< vector of coordinates, velocities or multipliers
  virtual ~ModelOperations() = default;

  /// True if all functions of `groups` are available.
  virtual bool provides(Capabilities groups) const { return groups == Capabilities::motion; }
  virtual bool has_energy() const { return false; }  ///< true if `energy` is available

  /// Evaluates the kinematics of all markers.
  virtual void evaluate_marker(At<T> at, Data<T>& data) const = 0;
  /// Evaluates constraint functions and their rates for all joints and bodies, and the forces of compliant joints.
  /// Requires evaluated markers.
  virtual void evaluate_constraints(At<T> at, Data<T>& data) const = 0;
  /// Writes γ of all constraint equations to out, without the bias accelerations of the markers.
  virtual void measure_gamma(At<T> at, Data<T> const& data, Vector& out) const = 0;
  /// r += M a − f of all bodies, with gravity times `load_factor`.
  virtual void element_forces(At<T> at, Vector const& a, double load_factor, Data<T>& data, Vector& r) const = 0;
  /// Writes the wrenches of all force elements to data.actions, and the rates of their states to data.rates.
  virtual void push_forces(double t, Data<T>& data) const = 0;
  /// Writes q ⊞ δ to out. The vectors are reduced vectors if `places` is not null.
  virtual void plus(ReducedPosition const* places, Vector const& q, Vector const& delta, Vector& out) const = 0;
  /// Writes the rate δ̇ to out, for which q ⊞ δ moves with the velocities v. The vectors are reduced vectors if
  /// `places` is not null.
  virtual void local_rate(ReducedPosition const* places, Vector const& delta, Vector const& v, Vector& out) const = 0;
  /// Distributes the loops over threads from now on. The results are bitwise identical.
  virtual void share_loops(Data<T>& data, Workers& threads) const = 0;
  /// Adds M to the sink, element by element.
  virtual void masses(At<T>, Data<T>&, BlockSink&) const { missing("masses"); }

  /// Adds the tangent of the bodies' elements to the sink.
  virtual void element_tangents(At<T>, TangentCoefficients const&, Data<T>&, BlockSink&) const { missing("tangents"); }
  /// Adds the tangent of compliant joints, Gᵀ(ck ∂λ/∂g + cd ∂λ/∂ġ)G, to the sink, with ck, cd from c.
  virtual void compliant_tangents(TangentCoefficients const&, Data<T>&, BlockSink&) const { missing("tangents"); }
  /// Adds the tangent of force elements at t [s] to the sink, with loads times `load_factor`. If c.full is true, the
  /// function also subtracts the wrenches of the force elements from data.loads.
  virtual void force_tangents(double /*t*/, double /*load_factor*/, TangentCoefficients const&, Data<T>&,
                              BlockSink&) const {
    missing("tangents");
  }

  /// Adds ck ∂(Gᵀλ)/∂q of all joints, including compliant joints, and of the bodies' constraint equations to the sink,
  /// with ck = c.stiffness. It also adds the wrenches of joints to data.loads.
  virtual void joint_stiffness(At<T>, Vector const& /*lambda*/, TangentCoefficients const&, Data<T>&,
                               BlockSink&) const {
    missing("second-order terms");
  }
  /// Adds ck ∂(Jᵀw)/∂q for the wrenches w in data.loads to the sink, with ck = c.stiffness.
  virtual void load_stiffness(At<T>, TangentCoefficients const&, Data<T>&, BlockSink&) const {
    missing("second-order terms");
  }

  /// Writes q̇ to `rate`. `workspace` has 2 nq + nv entries. The vectors are reduced vectors if `places` is not null.
  virtual void coordinate_rates(ReducedPosition const* /*places*/, Vector const& /*q*/, Vector const& /*v*/,
                                VecXOf<Dual<1>>& /*workspace*/, Vector& /*rate*/) const {
    missing("rates of coordinates");
  }

  /// Energies of the evaluated state [J].
  virtual Energy energy(At<T>, Data<T> const&) const { missing("energies"); }
  /// Powers of the evaluated state [W]. `backwards` is −v.
  virtual Powers powers(At<T>, VecX const& /*backwards*/, VecX const& /*lambda*/, double /*load_factor*/,
                        Data<T> const&) const {
    missing("powers");
  }

  /// Writes the generalised velocities v of a rigid motion. `v0` is the velocity of the body-fixed point at the world's
  /// origin [m/s], `omega` the angular velocity [rad/s], both in world axes.
  virtual void rigid_velocities(Vector const& /*q*/, Vec3 const& /*v0*/, Vec3 const& /*omega*/, Vector& /*v*/) const {
    missing("velocities of rigid motions");
  }

  /// Makes the equations of each island of the model. Empty if the model has one island, or if it has no tangent.
  virtual Sequence<ModelIsland> islands() const { return {}; }

  /// Allocates the workspace for mean forces over a step.
  virtual std::shared_ptr<SecantOperations> make_secants(Data<T> const&) const { missing("secants"); }

 protected:
  /// \throws InvalidInput, because the system was constructed without the capability `group`.
  [[noreturn, gnu::cold]] static void missing(char const* group) {
    throw InvalidInput("system.missing_capability",
                       {"This system was constructed without ", ErrorObject{group},
                        ". Name the capability in the constructor: System(model, with<Capabilities::...>)."});
  }
};

/// Functions of a model of type M, with the groups `wanted`. The specialisation is in system/make_operations.hpp.
template <class M, StateScalar T, Capabilities wanted>
class OperationsOf;

}  // namespace polybody
