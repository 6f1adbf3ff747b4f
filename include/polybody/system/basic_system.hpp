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
#include <polybody/system/coordinates.hpp>
#include <polybody/system/layout.hpp>
#include <polybody/system/projected_stiffness.hpp>

namespace polybody {

// Assembly of right-hand sides, and products with the constraint Jacobian G, as loops over constraint blocks and
// applied wrenches. The loops do not depend on the type of the model.

namespace detail {

/// Calls f(block) for all blocks with constraint equations of the model, except blocks that the evaluation omits.
template <StateScalar T, class F>
void for_each_row_block(Data<T> const& data, F&& f) {
  for (ConstraintBlock<T> const& block : data.rows)
    if (block.row >= 0 && !data.leaves_out(block)) f(block);
}

/// r += Jᵀ mapᵀ λ of both ends of a block, with the Jacobian J of the end's marker. J is omitted for an end without a
/// marker. \tparam m number of constraint equations; 0 stands for block.rows
template <int m, StateScalar T>
void add_ends(ConstraintBlock<T> const& block, T const* lambda, Data<T> const& data, T* r) {
  if constexpr (m > 0)
    if (block.opposite) {
      T w[6];
      wrench_of<m>(block.a.map, lambda, w);
      add_pulled(data.markers[std::size_t(block.a.marker)], w, 1.0, r);
      return add_pulled(data.markers[std::size_t(block.b.marker)], w, -1.0, r);
    }
  for (ConstraintSide<T> const* const end : {&block.a, &block.b}) {
    if (end->marker < 0) {
      int const rows = m > 0 ? m : block.rows;
      for (Index c = 0; c < end->columns; ++c)
        for (int k = 0; k < rows; ++k) r[end->first + c] += end->map[rows * c + k] * lambda[k];
    } else if constexpr (m > 0) {
      MarkerKinematics<T> const& p = data.markers[std::size_t(end->marker)];
      if (p.shape == JacobianShape::ground) continue;
      T w[6];
      wrench_of<m>(end->map, lambda, w);
      add_pulled(p, w, 1.0, r);
    }
  }
}
/// Overload for m = block.rows.
template <StateScalar T>
void add_ends(ConstraintBlock<T> const& block, T const* lambda, Data<T> const& data, T* r) {
  with_constant(block.rows, [&](auto m) { add_ends<m>(block, lambda, data, r); });
}

/// out (rows) += map · x for one end of a block. x is the twist of the end's marker in the evaluated state. For an end
/// without a marker, x contains the velocities in v that the map multiplies.
template <StateScalar T>
void add_rate(ConstraintSide<T> const& end, int rows, Data<T> const& data, VecXOf<T> const& v, T* out) {
  T twist[6];
  T const* x = v.data() + end.first;
  if (end.marker >= 0) {
    read_twist(data.markers[std::size_t(end.marker)].frame, twist);
    x = twist;
  }
  add_mapped<0>(end.map, end.columns, x, rows, out);
}
/// out (rows) += map · x for one end of a block. x is the twist J b of the end's marker for any vector b (nv). For an
/// end without a marker, x contains the entries of b that the map multiplies.
template <StateScalar T>
void add_product(ConstraintSide<T> const& end, int rows, Data<T> const& data, VecXOf<T> const& b, T* out) {
  Vec<T, 6> twist;
  T const* x = b.data() + end.first;
  if (end.marker >= 0) {
    MarkerKinematics<T> const& p = data.markers[std::size_t(end.marker)];
    if (p.shape == JacobianShape::ground) return;
    twist = p.push(b.data() + p.first);
    x = twist.data();
  }
  add_mapped<0>(end.map, end.columns, x, rows, out);
}

}  // namespace detail

/// r += Gᵀλ of all constraint equations and of compliant joints. For a compliant joint, its policy computes λ(g, ġ).
template <StateScalar T>
void add_row_forces(Data<T> const& data, VecXOf<T> const& lambda, VecXOf<T>& r) {
  for (ConstraintBlock<T> const& block : data.rows) {
    if (data.leaves_out(block)) continue;
    T const* const l = block.multiplier(lambda);
    detail::add_ends(block, l, data, r.data());
  }
}

/// r −= Jᵀw of all force elements. The wrenches of loads are multiplied by `load_factor`.
template <StateScalar T>
void add_actions(Data<T> const& data, ModelLayout const& layout, double load_factor, VecXOf<T>& r) {
  for (AppliedWrench<T> const& action : data.actions) {
    double const scale = layout.forces[std::size_t(action.source)].is_load ? load_factor : 1.0;
    detail::add_pulled(data.markers[std::size_t(action.marker)], action.w, -scale, r.data());
  }
}

/// `phi` = Φ (rows), the constraint violation; zero for nonholonomic equations.
template <StateScalar T>
void violation(Data<T> const& data, VecXOf<T>& phi) {
  detail::for_each_row_block(data, [&](ConstraintBlock<T> const& block) {
    for (int i = 0; i < block.rows; ++i) phi[block.row + i] = block.g[i];
  });
}

/// `rate` = Φ̇ = G v + Φ_t (rows).
template <StateScalar T>
void violation_rate(Data<T> const& data, VecXOf<T> const& v, VecXOf<T>& rate) {
  detail::for_each_row_block(data, [&](ConstraintBlock<T> const& block) {
    T* const out = rate.data() + block.row;
    for (int i = 0; i < block.rows; ++i) out[i] = block.rate ? block.rate[i] : T(0.0);
    detail::add_rate(block.a, block.rows, data, v, out);
    detail::add_rate(block.b, block.rows, data, v, out);
  });
}

/// gamma (rows) += map · bias of both ends of each block: the contribution of the bias accelerations of the markers to
/// γ.
template <StateScalar T>
void add_biases(Data<T> const& data, VecXOf<T>& gamma) {
  detail::for_each_row_block(data, [&](ConstraintBlock<T> const& block) {
    for (ConstraintSide<T> const* const end : {&block.a, &block.b})
      if (end->marker >= 0)
        detail::add_mapped<0>(end->map, 6, data.markers[std::size_t(end->marker)].bias.data(), block.rows,
                              gamma.data() + block.row);
  });
}

/// out = G b (rows) for b (nv).
template <StateScalar T>
void rows_times(Data<T> const& data, VecXOf<T> const& b, VecXOf<T>& out) {
  for (Index i = 0; i < out.size(); ++i) out[i] = T(0.0);
  detail::for_each_row_block(data, [&](ConstraintBlock<T> const& block) {
    detail::add_product(block.a, block.rows, data, b, out.data() + block.row);
    detail::add_product(block.b, block.rows, data, b, out.data() + block.row);
  });
}

/// out = Gᵀ b (nv) for b (rows).
template <StateScalar T>
void rows_transposed_times(Data<T> const& data, VecXOf<T> const& b, VecXOf<T>& out) {
  for (Index i = 0; i < out.size(); ++i) out[i] = T(0.0);
  detail::for_each_row_block(
      data, [&](ConstraintBlock<T> const& block) { detail::add_ends(block, b.data() + block.row, data, out.data()); });
}

/// Writes the blocks of Gᵀ and G into `sink`. \param first first row of G in the matrix
template <class = void>
void write_rows(Data<double>& data, Index first, BlockSink& sink) {
  detail::for_each_row_block(data, [&](ConstraintBlock<double> const& block) {
    Index const row = first + block.row;
    for (ConstraintSide<double> const* const end : {&block.a, &block.b}) {
      if (end->marker >= 0) {
        with_constant(block.rows, [&](auto m) {
          if constexpr (m > 0)
            detail::add_pulled_rows<m>(data.markers[std::size_t(end->marker)], end->map, row, data.scratch, sink);
        });
      } else if (end->columns > 0) {
        sink.add(end->first, row, BlockView(end->map, end->columns, block.rows, block.rows, 1));
        sink.add(row, end->first, BlockView(end->map, block.rows, end->columns, 1, block.rows));
      }
    }
  });
}

/// Capabilities as a constructor argument: `System(model, with<Capabilities::tangent>)`.
template <Capabilities groups>
struct With {};
/// Object of type `With` for the capabilities `groups`.
template <Capabilities groups>
inline constexpr With<groups> with{};

/// Parts of the tangent that `tangent_of` evaluates separately.
enum class TangentPart { compliant_joints, force_elements };

/// Equations of motion of a model, with their workspace. `evaluate` sets the state to which all other functions refer.
template <StateScalar T>
class BasicSystem {
 public:
  using Vector = VecXOf<T>;  ///< vector with one T per coordinate, velocity or constraint equation

  /// Equations of the model. The model must outlive the system. If the model changes afterwards, evaluations throw.
  template <class M, Capabilities wanted = Capabilities::questions>
    requires requires { sizeof(OperationsOf<M, T, wanted>); }
  explicit BasicSystem(M const& model, With<wanted> = {}, CoordinatesOf<T> coordinates = {})
      : BasicSystem(std::make_shared<OperationsOf<M, T, wanted>>(model), layout_of(model),
                    OperationsOf<M, T, wanted>::make_data(model), std::move(coordinates)) {}
  template <class M, Capabilities wanted = Capabilities::questions>
    requires requires { sizeof(OperationsOf<M, T, wanted>); }
  explicit BasicSystem(M const&& model, With<wanted> = {}, CoordinatesOf<T> = {}) = delete;  ///< refuses a temporary
  /// Equations from any implementation of `ModelOperations`, for example equations of a user (`system_of`).
  [[gnu::cold]] BasicSystem(std::shared_ptr<ModelOperations<T> const> operations, ModelLayout layout, Data<T> data,
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
  ModelOperations<T> const& operations() const { return *operations_; }  ///< functions of the model
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

  /// Load factor of gravity and loads. It is 1 except during analyses of statics and buckling.
  double load_factor = 1.0;

  /// Sets the state: coordinates q (nq), velocities v (nv), time t [s]. Computes all markers and constraint functions.
  /// \throws InvalidInput if the model has changed since the construction of the system.
  void evaluate(Vector const& q, Vector const& v, double t);

  /// Sets the number of threads that share the loops over elements, markers and joints, including the calling thread.
  /// Results are bitwise identical for any number. \throws InvalidInput for fewer than one thread or more than 4096.
  void use_threads(int threads);

  /// r = M a − f + Gᵀλ (nv).
  void residual(Vector const& a, Vector const& lambda, Vector& r);
  /// Writes the wrenches and state rates of the force elements to `data()`, for the multipliers λ (rows) of the full
  /// model. `residual` also updates them. The tangent belongs to the last λ.
  void push_forces(Vector const& lambda) {
    for (std::size_t i = 0; i < data_.multipliers.size(); ++i) data_.multipliers[i] = lambda[Index(i)];
    operations_->push_forces(t_, data_);
  }
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
            operations_->masses(at(), data_, full);
            write_rows(data_, layout_.velocities, full);
          },
          sink);
    });
  }
  /// Writes the blocks of cd D + ck K into `receiver` for one part of the tangent: that of all compliant joints, or
  /// that of all force elements including their second-order terms. For force elements, the second-order terms of
  /// constraints with multipliers `lambda` are added if `lambda` is not null.
  template <BlockReceiver S>
  void tangent_of(TangentPart part, TangentCoefficients c, S&& receiver, Vector const* lambda = nullptr) {
    with_sink(receiver, [&](BlockSink& sink) {
      if (part == TangentPart::compliant_joints) return operations_->compliant_tangents(c, data_, sink);
      clear_loads();
      c.full = true;
      if (lambda) operations_->joint_stiffness(at(), *lambda, c, data_, sink);
      operations_->force_tangents(t_, load_factor, c, data_, sink);
      operations_->load_stiffness(at(), c, data_, sink);
    });
  }

  /// out = q ⊞ delta.
  void plus(Vector const& q, Vector const& delta, Vector& out) const;
  /// out = time derivative of delta at constant q, while the configuration q ⊞ delta moves with the velocities v.
  void local_rate(Vector const& delta, Vector const& v, Vector& out) const;

  /// Name of the owner of unknown i. It is the body or force element of velocity i, or the body or joint of constraint
  /// equation i − nv.
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
      coordinates_->write(write, sink);
    else
      write(sink);
  }

  void full_residual(Vector const& a, Vector const& lambda, Vector& r);
  void write_tangent(TangentCoefficients c, SecondOrder second, Vector const& given, BlockSink& sink);
  Vector const& full_multipliers(Vector const& lambda) {
    expand_rows(lambda, full_lambda_);
    coordinates_->recover_multipliers(data_, full_lambda_);
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

  std::shared_ptr<ModelOperations<T> const> operations_;
  ModelLayout layout_;
  CoordinatesOf<T> coordinates_;
  std::unique_ptr<Workers> workers_;
  Data<T> data_;
  Vector q_, v_;  // full vectors
  double t_ = 0.0;
  Vector full_a_, full_r_, full_rows_, full_lambda_, still_;  // workspace of a system with reduced coordinates
};

}  // namespace polybody
