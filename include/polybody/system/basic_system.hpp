#pragma once
/// \file
/// Waist 3: what an integrator or a solver sees of the mechanics,
///   M(q) v̇ = f(q, v, t) − Gᵀλ,   Φ(q, t) = 0,   q moves by ⊞.
/// First-order states, ż = h(q, v, z, t), are the last of the speeds: speeds whose mass is one and which move no
/// coordinate. What integrates v with its rates integrates z.
/// Models' types end here: one table of functions fills arrays, which are assembled into these equations. Where
/// policies eliminate unknowns, the equations are those of what is left,
///   Tᵀ(M(T u̇ + b) − f) + (G T)ᵀλ = 0,   v = T u,  v̇ = T u̇ + b.

#include <cmath>

#include <polybody/math/sequence.hpp>
#include <polybody/system/assembly.hpp>
#include <polybody/system/coordinates.hpp>

namespace polybody {

/// Names groups of entries in a constructor: `System(model, with<Capabilities::tangent>)`.
template <Capabilities groups>
struct With {};
/// The groups, as an argument.
template <Capabilities groups>
inline constexpr With<groups> with{};

/// \throws InvalidInput where an entry was not asked for; `group` names what is missing.
template <class F>
F require_entry(F entry, char const* group) {
  if (!entry)
    throw InvalidInput("system.missing_capability",
                       {"This system was made without ", ErrorObject{group},
                        ". Give them to its constructor: System(model, with<Capabilities::...>)."});
  return entry;
}

/// Parts of the tangent that may be asked for alone.
enum class TangentPart { compliant_joints, force_elements };

/// The equations of a model with their scratch. `evaluate` sets the state at which everything else is asked.
template <StateScalar T>
class BasicSystem {
 public:
  using Vector = VecXOf<T>;  ///< of the system's scalar: coordinates, speeds or rows

  /// The whole mechanism. The model must outlive the system and must not change after: evaluations refuse that.
  template <class M, Capabilities wanted = Capabilities::questions>
    requires requires { sizeof(OperationsOf<M, T, wanted>); }
  explicit BasicSystem(M const& model, With<wanted> = {}, CoordinatesOf<T> coordinates = {})
      : BasicSystem(&model, OperationsOf<M, T, wanted>::table, layout_of(model),
                    OperationsOf<M, T, wanted>::make_data(model), std::move(coordinates)) {}
  template <class M, Capabilities wanted = Capabilities::questions>
    requires requires { sizeof(OperationsOf<M, T, wanted>); }
  explicit BasicSystem(M const&& model, With<wanted> = {}, CoordinatesOf<T> = {}) = delete;  ///< a temporary model
  /// From entries of any origin, which are called with `model`.
  [[gnu::cold]] BasicSystem(void const* model, ModelOperations<T> const& entries, ModelLayout layout, Data<T> data,
                            CoordinatesOf<T> coordinates);
  BasicSystem(BasicSystem&&) noexcept;  ///< what refers to the one that is moved, such as a workspace, does not follow
  ~BasicSystem();

  /// Places and names in the whole model.
  ModelLayout const& layout() const { return layout_; }
  /// Functions between the unknowns of a time step and those of the whole model; they convert to false where there are
  /// none.
  CoordinatesOf<T> const& step_coordinates() const { return coordinates_; }
  /// Scratch of the last evaluation: markers, row blocks, wrenches of force elements.
  Data<T> const& data() const { return data_; }
  /// The model's entries, and what they take for the model.
  std::pair<ModelOperations<T> const&, void const*> entries() const { return {entries_, model_}; }
  /// Whole coordinates and speeds, and time, of the last evaluation.
  At<T> at() const { return {q_, v_, t_}; }

  /// nq of a time step.
  Index coordinates() const { return coordinates_ ? coordinates_.reduced->coordinates : layout_.coordinates; }
  /// nv of a time step: speeds, and first-order states behind them.
  Index velocities() const { return coordinates_ ? coordinates_.reduced->velocities : layout_.velocities; }
  Index rows() const { return coordinates_ ? coordinates_.reduced->rows : layout_.rows; }  ///< rows Φ of a time step
  Index size() const { return velocities() + rows(); }  ///< nv + rows: unknowns of its linear system
  /// Rows without a position: Φ is zero there, Φ̇ and γ are not.
  Sequence<Index> const& nonholonomic_equations() const {
    return coordinates_ ? coordinates_.reduced->nonholonomic_equations : layout_.nonholonomic_equations;
  }

  /// A factor of gravity and loads; one except inside `equilibrium`.
  double load_factor = 1.0;

  /// Sets the state: coordinates q (nq), speeds v (nv), time t [s]. Computes all markers and gaps there.
  /// \throws InvalidInput where the model has changed since the system was made.
  void evaluate(Vector const& q, Vector const& v, double t);

  /// From now on so many threads share the loops over elements, markers and joints, this one among them; the results
  /// are the same to the last bit. \throws InvalidInput for fewer than one.
  void use_threads(int threads);

  /// r = M a − f + Gᵀλ (nv).
  void residual(Vector const& a, Vector const& lambda, Vector& r);
  /// The wrenches of the force elements into `data().actions`, as `residual` does.
  void push_forces() { entries_.push_forces(model_, t_, data_); }
  /// Φ (rows); zero for velocity rows.
  void violation(Vector& phi);
  /// `rate` = Φ̇ = G v + Φ_t (rows).
  void violation_rate(Vector& rate);
  /// γ (rows): Φ̈ = G v̇ + γ.
  void acceleration_bias(Vector& gamma);
  /// out = G b (rows) for b by speeds.
  void rows_times(Vector const& b, Vector& out);
  /// out = Gᵀ b (speeds) for b by rows.
  void rows_transposed_times(Vector const& b, Vector& out);

  /// [cm M + cd D + ck K, Gᵀ; G, 0] (size × size), by the unknowns of the equations, into a receiver of blocks.
  template <BlockReceiver S>
  void tangent(TangentCoefficients const& c, SecondOrder second, Vector const& lambda, S&& receiver) {
    with_sink(receiver, [&](BlockSink& sink) {
      write_equations([&](BlockSink& full) { write_tangent(c, second, lambda, full); }, sink);
    });
  }
  /// [M, Gᵀ; G, 0], likewise.
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
  /// cd D + ck K of the compliant joints alone, joint by joint; or of the force elements, with second-order terms, and
  /// with those of the rows where their multipliers are given.
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
  /// The rate of delta in q ⊞ delta when the model moves with speeds v.
  void local_rate(Vector const& delta, Vector const& v, Vector& out) const;

  /// Name of the body that owns speed i, or of the joint that owns row i − nv.
  std::string name_of(Index i) const;

  template <class U>
  friend VecXOf<U> const& unbalance(BasicSystem<U>& system);
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

  /// Rows of a step are written as they are, or taken from whole ones afterwards.
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
  Vector q_, v_;  // whole
  double t_ = 0.0;
  Vector full_a_, full_r_, full_rows_, full_lambda_, still_;  // scratch of a system with coordinates of its own
};

}  // namespace polybody
