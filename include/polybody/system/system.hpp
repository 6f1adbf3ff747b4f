#pragma once
/// \file
/// `System`, the interface between models and algorithms: the class (`basic_system.hpp`), its member functions
/// (`system.hpp`) and related free functions.

#include <polybody/math/sequence.hpp>
#include <polybody/system/basic_system.hpp>
#include <polybody/system/contact_coupling.hpp>

namespace polybody {

// Member functions of `BasicSystem`. Their definitions are outside the class so that a program that links
// `polybody::compiled` does not compile them again.

template <StateScalar T>
BasicSystem<T>::BasicSystem(std::shared_ptr<ModelOperations<T> const> operations, ModelLayout layout, Data<T> data,
                            CoordinatesOf<T> coordinates)
    : operations_(std::move(operations)),
      layout_(std::move(layout)),
      coordinates_(std::move(coordinates)),
      data_(std::move(data)) {
  if (layout_.velocities == 0)
    throw InvalidInput("model.no_body", {"The model has no moving body. Add a body with model.add(body) first."});
  q_.setConstant(layout_.coordinates, T(0.0));
  v_.setConstant(layout_.velocities, T(0.0));
  if (coordinates_) {
    full_a_ = full_r_ = v_;
    full_rows_.setConstant(layout_.rows, T(0.0));
    full_lambda_ = full_rows_;
    still_.setConstant(velocities(), T(0.0));
  }
}

template <StateScalar T>
BasicSystem<T>::BasicSystem(BasicSystem&&) noexcept = default;
template <StateScalar T>
BasicSystem<T>::~BasicSystem() = default;

template <StateScalar T>
void BasicSystem<T>::evaluate(Vector const& q, Vector const& v, double t) {
  layout_.watch.require_unchanged();
  t_ = t;
  data_.linear_rows = !coordinates_;
  if (coordinates_) {
    coordinates_->expand(q, v, q_, v_);
  } else {
    q_ = q;
    v_ = v;
  }
  for (std::size_t i = 0; i < data_.states.size(); ++i) data_.states[i] = v_[data_.first_state + Index(i)];
  operations_->evaluate_marker(at(), data_);
  operations_->evaluate_constraints(at(), data_);
}

template <StateScalar T>
void BasicSystem<T>::use_threads(int threads) {
  workers_ = std::make_unique<Workers>(threads);
  operations_->share_loops(data_, *workers_);
}

/// Residual M a − f + Gᵀλ of the full model in the last evaluated state, for the accelerations and multipliers of a
/// reduced step.
template <class T>
VecXOf<T> const& residual_of_bodies(BasicSystem<T>& s, VecXOf<T> const& a, VecXOf<T> const& lambda) {
  s.coordinates_->expand_rates(a, true, s.full_a_);
  s.expand_rows(lambda, s.full_lambda_);
  s.full_residual(s.full_a_, s.full_lambda_, s.full_r_);
  return s.full_r_;
}

template <StateScalar T>
void BasicSystem<T>::residual(Vector const& a, Vector const& lambda, Vector& r) {
  if (!coordinates_) return full_residual(a, lambda, r);
  residual_of_bodies(*this, a, lambda);
  coordinates_->reduce(full_r_, r);
}

template <StateScalar T>
void BasicSystem<T>::violation(Vector& phi) {
  polybody::violation(data_, full_constraints(phi));
  add_constraint_rows(phi);
}

template <StateScalar T>
void BasicSystem<T>::violation_rate(Vector& rate) {
  polybody::violation_rate(data_, v_, full_constraints(rate));
  add_constraint_rows(rate);
}

template <StateScalar T>
void BasicSystem<T>::acceleration_bias(Vector& gamma) {
  Vector& full = full_constraints(gamma);
  for (ConstraintBlock<T> const& block : data_.rows)
    if (block.source == ConstraintSource::linear)
      for (int i = 0; i < block.rows; ++i) full[block.row + i] = T(0.0);
  operations_->measure_gamma(at(), data_, full);
  add_biases(data_, full);
  if (coordinates_) {  // γ + G b
    coordinates_->expand_rates(still_, true, full_a_);
    full_lambda_ = full;
    polybody::rows_times(data_, full_a_, full);
    for (Index i = 0; i < full.size(); ++i) full[i] += full_lambda_[i];
  }
  add_constraint_rows(gamma);
}

template <StateScalar T>
void BasicSystem<T>::rows_times(Vector const& b, Vector& out) {
  if (coordinates_) {
    coordinates_->expand_rates(b, false, full_a_);
    polybody::rows_times(data_, full_a_, full_rows_);
    return add_constraint_rows(out);
  }
  polybody::rows_times(data_, b, out);
}

template <StateScalar T>
void BasicSystem<T>::rows_transposed_times(Vector const& b, Vector& out) {
  if (coordinates_) {
    expand_rows(b, full_lambda_);
    polybody::rows_transposed_times(data_, full_lambda_, full_r_);
    return coordinates_->reduce(full_r_, out);
  }
  polybody::rows_transposed_times(data_, b, out);
}

template <StateScalar T>
void BasicSystem<T>::plus(Vector const& q, Vector const& delta, Vector& out) const {
  if (coordinates_) coordinates_->plus(q, delta, out);
  operations_->plus(reduced_places(), q, delta, out);
}

template <StateScalar T>
void BasicSystem<T>::local_rate(Vector const& delta, Vector const& v, Vector& out) const {
  if (coordinates_) coordinates_->local_rate(delta, v, out);
  operations_->local_rate(reduced_places(), delta, v, out);
}

template <StateScalar T>
std::string BasicSystem<T>::name_of(Index i) const {
  if (!coordinates_) return layout_.name_of(i);
  ReducedLayout const& n = *coordinates_.reduced;
  return layout_.name_of(i < n.velocities ? n.full_velocity[std::size_t(i)]
                                          : layout_.velocities + n.remaining_equations[std::size_t(i - n.velocities)]);
}

template <StateScalar T>
void BasicSystem<T>::full_residual(Vector const& a, Vector const& lambda, Vector& r) {
  for (Index i = 0; i < r.size(); ++i) r[i] = T(0.0);
  operations_->element_forces(at(), a, load_factor, data_, r);
  add_row_forces(data_, lambda, r);
  push_forces(lambda);
  add_actions(data_, layout_, load_factor, r);
  for (std::size_t i = 0; i < data_.rates.size(); ++i) {
    Index const k = data_.first_state + Index(i);
    r[k] += a[k] - data_.rates[i];
  }
}

template <StateScalar T>
void BasicSystem<T>::write_tangent(TangentCoefficients c, SecondOrder second, Vector const& given, BlockSink& sink) {
  c.full = second == SecondOrder::included;
  Vector const& lambda = c.full && coordinates_ ? full_multipliers(given) : given;
  if (c.full) clear_loads();
  if (c.coupling) c.coupling->begin();
  operations_->element_tangents(at(), c, data_, sink);
  write_rows(data_, layout_.velocities, sink);
  operations_->compliant_tangents(c, data_, sink);
  if (c.full) operations_->joint_stiffness(at(), lambda, c, data_, sink);
  operations_->force_tangents(t_, load_factor, c, data_, sink);
  if (c.full) operations_->load_stiffness(at(), c, data_, sink);
}

/// Residual M v̇ − f + Gᵀλ of the full model in the last evaluated state, at v̇ = 0 and λ = 0.
template <class T>
VecXOf<T> const& residual_at_rest(BasicSystem<T>& s) {
  s.full_a_.setConstant(s.layout_.velocities, T(0.0));
  s.full_lambda_.setConstant(s.layout_.rows, T(0.0));
  s.full_r_.resize(s.layout_.velocities);
  s.full_residual(s.full_a_, s.full_lambda_, s.full_r_);
  return s.full_r_;
}

/// Equations of a model or of a user for integrators, solvers and analyses: `BasicSystem` with scalar double.
using System = BasicSystem<double>;

/// Computes the reduced state of a time step from the full state x. The result is exact if x satisfies the constraint
/// equations of the eliminated joints. If policies eliminate unknowns, the result has no integrator history.
template <class = void>
State reduce(System const& s, State const& x) {
  State out = x;
  if (Coordinates const& c = s.step_coordinates()) c->reduce_state(x, out);
  return out;
}
/// Number of multipliers that a step can store: those of its constraint equations, and estimates for eliminated joints
/// (`ReducedLayout::eliminated_equations`).
inline Index multipliers_of(System const& s) {
  return s.rows() + (s.step_coordinates() ? Index(s.step_coordinates().reduced->eliminated_equations.size()) : 0);
}
/// Converts the reduced state `stepped` to the full state x. Multipliers of eliminated joints are copied if `stepped`
/// contains them, and otherwise computed. `r` is workspace.
template <StateScalar T>
void expand(BasicSystem<T>& s, StateOf<T> const& stepped, StateOf<T>& x, VecXOf<T>& r) {
  CoordinatesOf<T> const& c = s.step_coordinates();
  if (!c) {
    x = stepped;
    return;
  }
  bool const keeps = stepped.lambda.size() == s.layout().rows;
  x.q.resize(s.layout().coordinates);
  x.v.resize(s.layout().velocities);
  x.a.resize(x.v.size());
  x.lambda.resize(s.layout().rows);
  if (keeps) {
    c->expand(stepped.q, stepped.v, x.q, x.v);
  } else {
    s.evaluate(stepped.q, stepped.v, stepped.t);
    x.q = s.at().q;
    x.v = s.at().v;
    r.resize(s.velocities());
    s.residual(stepped.a, stepped.lambda, r);
  }
  c->expand_rates(stepped.a, true, x.a);
  c.reduced->expand_rows(stepped.lambda, x.lambda);
  if (!keeps) c->recover_multipliers(s.data(), x.lambda);
  x.t = stepped.t;
  x.history = stepped.history;
}

/// Appends estimates of the multipliers of eliminated joints to the multipliers of the reduced state `stepped`. The
/// accelerations of this state must be known.
template <class = void>
[[gnu::cold]] void append_multipliers(System& s, State& stepped) {
  if (multipliers_of(s) == s.rows()) return;
  Coordinates const& c = s.step_coordinates();
  VecX full = VecX::Zero(s.layout().rows), r(s.velocities());
  s.evaluate(stepped.q, stepped.v, stepped.t);
  s.residual(stepped.a, stepped.lambda, r);
  c->recover_multipliers(s.data(), full);
  VecX all(multipliers_of(s));
  std::copy_n(stepped.lambda.data(), s.rows(), all.data());
  Index at = s.rows();
  for (Index const row : c.reduced->eliminated_equations) all[at++] = full[row];
  stepped.lambda.swap(all);
}

/// Writes q̇ for the generalised velocities v to `rate`. `workspace` has 2 nq + nv entries, with nq and nv of the full
/// model.
template <class = void>
void coordinate_rates(System const& s, VecX const& q, VecX const& v, VecXOf<Dual<1>>& workspace, VecX& rate) {
  Coordinates const& c = s.step_coordinates();
  if (c) c->coordinate_rates(q, v, rate);
  s.operations().coordinate_rates(c ? c.reduced->places.data() : nullptr, q, v, workspace, rate);
}

/// Name of the body to which coordinate i of a time step belongs.
template <class = void>
std::string name_of_coordinate(System const& s, Index i) {
  Coordinates const& c = s.step_coordinates();
  Sequence<BodyLayout> const& bodies = s.layout().bodies;
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    Index const first = c ? c.reduced->places[k].q : bodies[k].q0;
    Index const count = c ? c.reduced->places[k].coordinates : bodies[k].coordinates;
    if (i >= first && i < first + count) return sentence_of({"body \"", bodies[k].name, "\""});
  }
  return "unknown";
}

/// True if M does not depend on q.
inline bool has_constant_mass(System const& s) {
  return s.layout().constant_mass && (!s.step_coordinates() || s.step_coordinates().reduced->keeps_mass_constant);
}

}  // namespace polybody
