#pragma once
/// \file
/// Equations of motion as integrators and solvers evaluate them,
///   M(q) v̇ = f(q, v, t) − Gᵀλ,   Φ(q, t) = 0,   increments q ⊞ δ.
/// First-order states, ż = h(q, v, z, t), are the last entries of v. They are velocities with unit mass that move no
/// coordinate, and every integrator of v also integrates them.
/// The type of the model is erased here: a table of functions fills arrays, from which the equations are assembled. If
/// policies eliminate unknowns, the equations contain only the remaining unknowns u,
///   Tᵀ(M(T u̇ + b) − f) + (G T)ᵀλ = 0,   v = T u,  v̇ = T u̇ + b.

#include <cmath>

#include <polybody/math/sequence.hpp>
#include <polybody/system/assembly.hpp>
#include <polybody/system/coordinates.hpp>

namespace polybody {

/// Capabilities as a constructor argument: `System(model, with<Capabilities::tangent>)`.
template <Capabilities groups>
struct With {};
/// Value of `With` for these capabilities.
template <Capabilities groups>
inline constexpr With<groups> with{};

/// Returns the function `entry`. \param group name of its capability in the message \throws InvalidInput if `entry` is
/// null: the system was constructed without this capability.
template <class F>
F require_entry(F entry, char const* group) {
  if (!entry)
    throw InvalidInput("system.missing_capability",
                       {"This system was constructed without ", ErrorObject{group},
                        ". Name the capability in the constructor: System(model, with<Capabilities::...>)."});
  return entry;
}

/// Parts of the tangent that `tangent_of` evaluates separately.
enum class TangentPart { compliant_joints, force_elements };

/// Equations of motion of a model with their workspace. All other functions refer to the state of the last `evaluate`.
template <StateScalar T>
class BasicSystem {
 public:
  using Vector = VecXOf<T>;  ///< coordinates, velocities or constraint equations, of the scalar T

  /// Equations of the model. The model must outlive the system. If the model changes afterwards, evaluations throw.
  template <class M, Capabilities wanted = Capabilities::questions>
    requires requires { sizeof(OperationsOf<M, T, wanted>); }
  explicit BasicSystem(M const& model, With<wanted> = {}, CoordinatesOf<T> coordinates = {})
      : BasicSystem(&model, OperationsOf<M, T, wanted>::table, layout_of(model),
                    OperationsOf<M, T, wanted>::make_data(model), std::move(coordinates)) {}
  template <class M, Capabilities wanted = Capabilities::questions>
    requires requires { sizeof(OperationsOf<M, T, wanted>); }
  explicit BasicSystem(M const&& model, With<wanted> = {}, CoordinatesOf<T> = {}) = delete;  ///< refuses a temporary
  /// Equations from functions of any origin, which receive `model` as their first argument.
  [[gnu::cold]] BasicSystem(void const* model, ModelOperations<T> const& entries, ModelLayout layout, Data<T> data,
                            CoordinatesOf<T> coordinates);
  BasicSystem(BasicSystem&&) noexcept;  ///< invalidates references to the moved system, such as those of a workspace
  ~BasicSystem();

  /// Names of bodies, joints and forces, and their positions in vectors.
  ModelLayout const& layout() const { return layout_; }
  /// Maps between the unknowns of a time step and those of the model. They convert to false if no unknowns are
  /// eliminated.
  CoordinatesOf<T> const& step_coordinates() const { return coordinates_; }
  /// Arrays of the last evaluation: markers, constraint blocks, wrenches of force elements.
  Data<T> const& data() const { return data_; }
  /// Functions of the model, and the model as their first argument.
  std::pair<ModelOperations<T> const&, void const*> entries() const { return {entries_, model_}; }
  /// Full coordinates and velocities, and time, of the last evaluation.
  At<T> at() const { return {q_, v_, t_}; }

  /// Number nq of coordinates of a time step.
  Index coordinates() const { return coordinates_ ? coordinates_.reduced->coordinates : layout_.coordinates; }
  /// Number nv of velocities of a time step, including first-order states, which come last.
  Index velocities() const { return coordinates_ ? coordinates_.reduced->velocities : layout_.velocities; }
  /// Number of constraint equations Φ of a time step.
  Index rows() const { return coordinates_ ? coordinates_.reduced->rows : layout_.rows; }
  Index size() const { return velocities() + rows(); }  ///< number of unknowns of a time step, nv + rows
  /// Indices of the nonholonomic equations. Their Φ is zero by definition; their Φ̇ and γ are computed.
  Sequence<Index> const& nonholonomic_equations() const {
    return coordinates_ ? coordinates_.reduced->nonholonomic_equations : layout_.nonholonomic_equations;
  }

  /// Load factor of gravity and loads; it is 1 except inside `equilibrium`.
  double load_factor = 1.0;

  /// Sets the state: coordinates q (nq), velocities v (nv), time t [s]. Computes all markers and constraint functions.
  /// \throws InvalidInput if the model has changed since the construction of the system.
  void evaluate(Vector const& q, Vector const& v, double t);

  /// Sets the number of threads that share the loops over elements, markers and joints, including the calling thread.
  /// Results are bitwise identical for any number. \throws InvalidInput for fewer than one thread.
  void use_threads(int threads);

  /// r = M a − f + Gᵀλ (nv).
  void residual(Vector const& a, Vector const& lambda, Vector& r);
  /// Writes the wrenches and state rates of the force elements to `data()`. `residual` also updates them.
  void push_forces() { entries_.push_forces(model_, t_, data_); }
  /// `phi` = Φ (rows), the constraint violation; zero for nonholonomic equations.
  void violation(Vector& phi);
  /// `rate` = Φ̇ = G v + Φ_t (rows).
  void violation_rate(Vector& rate);
  /// `gamma` = γ (rows), the acceleration bias in Φ̈ = G v̇ + γ.
  void acceleration_bias(Vector& gamma);
  /// out = G b (rows) for b (nv).
  void rows_times(Vector const& b, Vector& out);
  /// out = Gᵀ b (nv) for b (rows).
  void rows_transposed_times(Vector const& b, Vector& out);

  /// Writes the blocks of [cm M + cd D + ck K, Gᵀ; G, 0] into `receiver`, in the unknowns of the linear system, which
  /// may be more than those of a time step.
  template <BlockReceiver S>
  void tangent(TangentCoefficients const& c, SecondOrder second, Vector const& lambda, S&& receiver) {
    with_sink(receiver, [&](BlockSink& sink) {
      write_equations([&](BlockSink& full) { write_tangent(c, second, lambda, full); }, sink);
    });
  }
  /// Writes the blocks of [M, Gᵀ; G, 0] into `receiver`, in the unknowns of the linear system.
  template <BlockReceiver S>
  void masses(S&& receiver) {
    with_sink(receiver, [&](BlockSink& sink) {
      write_equations(
          [&](BlockSink& full) {
            entries_.masses(model_, at(), data_, full);
            write_rows(data_, layout_.velocities, full);
          },
          sink);
    });
  }
  /// Writes the blocks of cd D + ck K into `receiver` for one part of the tangent: each compliant joint, or all force
  /// elements with second-order terms. For force elements, the second-order terms of constraints with multipliers
  /// `lambda` are added if `lambda` is not null.
  template <BlockReceiver S>
  void tangent_of(TangentPart part, TangentCoefficients c, S&& receiver, Vector const* lambda = nullptr) {
    with_sink(receiver, [&](BlockSink& sink) {
      if (part == TangentPart::compliant_joints)
        return require_entry(entries_.compliant_tangents, "tangents")(model_, c, data_, sink);
      clear_loads();
      c.full = true;
      if (lambda) require_entry(entries_.joint_stiffness, "second-order terms")(model_, at(), *lambda, c, data_, sink);
      require_entry(entries_.force_tangents, "tangents")(model_, t_, load_factor, c, data_, sink);
      require_entry(entries_.load_stiffness, "second-order terms")(model_, at(), c, data_, sink);
    });
  }

  /// out = q ⊞ delta.
  void plus(Vector const& q, Vector const& delta, Vector& out) const;
  /// out = rate of delta, if the configuration q ⊞ delta moves with the velocities v and q is constant.
  void local_rate(Vector const& delta, Vector const& v, Vector& out) const;

  /// Name of the body or force element with velocity i, or of the body or joint with constraint equation i − nv.
  std::string name_of(Index i) const;

  template <class U>
  friend VecXOf<U> const& residual_at_rest(BasicSystem<U>& system);
  template <class U>
  friend VecXOf<U> const& residual_of_bodies(BasicSystem<U>& system, VecXOf<U> const& a, VecXOf<U> const& lambda);

 private:
  ReducedPosition const* reduced_places() const { return coordinates_ ? coordinates_.reduced->places.data() : nullptr; }

  template <class S, class F>
  static void with_sink(S& receiver, F&& f) {
    if constexpr (std::same_as<std::remove_cvref_t<S>, BlockSink>) {
      f(receiver);
    } else {
      BlockSink sink(receiver);
      f(sink);
    }
  }
  void write_equations(BlockWriter const& write, BlockSink& sink) {
    if (coordinates_)
      coordinates_.entries->write(coordinates_.self.get(), write, sink);
    else
      write(sink);
  }

  void full_residual(Vector const& a, Vector const& lambda, Vector& r);
  void write_tangent(TangentCoefficients c, SecondOrder second, Vector const& given, BlockSink& sink);
  Vector const& full_multipliers(Vector const& lambda) {
    expand_rows(lambda, full_lambda_);
    coordinates_.entries->recover_multipliers(coordinates_.self.get(), data_, full_lambda_);
    return full_lambda_;
  }
  void clear_loads() {
    for (Wrench<double>& w : data_.loads) w = {};
  }

  /// Output for constraint equations: `reduced` itself, or full equations from which `add_constraint_rows` copies.
  Vector& full_constraints(Vector& reduced) { return coordinates_ ? full_rows_ : reduced; }
  void add_constraint_rows(Vector& reduced) const {
    if (!coordinates_) return;
    Sequence<Index> const& stay = coordinates_.reduced->remaining_equations;
    for (std::size_t i = 0; i < stay.size(); ++i) reduced[Index(i)] = full_rows_[stay[i]];
  }
  void expand_rows(Vector const& reduced, Vector& full) const { coordinates_.reduced->expand_rows(reduced, full); }

  void const* model_;
  ModelOperations<T> entries_;
  ModelLayout layout_;
  CoordinatesOf<T> coordinates_;
  std::unique_ptr<Workers> workers_;
  Data<T> data_;
  Vector q_, v_;  // full vectors
  double t_ = 0.0;
  Vector full_a_, full_r_, full_rows_, full_lambda_, still_;  // workspace of a system with reduced coordinates
};

}  // namespace polybody
