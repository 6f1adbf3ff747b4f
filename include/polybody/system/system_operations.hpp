#pragma once
/// \file
/// Member functions of `BasicSystem`. Their definitions are outside the class so that a program that links
/// `polybody::compiled` does not compile them again.

#include <polybody/system/basic_system.hpp>

namespace polybody {

template <StateScalar T>
BasicSystem<T>::BasicSystem(void const* model, ModelOperations<T> const& entries, ModelLayout layout, Data<T> data,
                            CoordinatesOf<T> coordinates)
    : model_(model),
      entries_(entries),
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
    coordinates_.entries->expand(coordinates_.self.get(), q, v, q_, v_);
  } else {
    q_ = q;
    v_ = v;
  }
  for (std::size_t i = 0; i < data_.states.size(); ++i) data_.states[i] = v_[data_.first_state + Index(i)];
  entries_.evaluate_marker(model_, at(), data_);
  entries_.evaluate_constraints(model_, at(), data_);
}

template <StateScalar T>
void BasicSystem<T>::use_threads(int threads) {
  workers_ = std::make_unique<Workers>(threads);
  entries_.share_loops(model_, data_, *workers_);
}

/// Residual M a − f + Gᵀλ of the full model in the last evaluated state, for the accelerations and multipliers of a
/// reduced step.
template <class T>
VecXOf<T> const& residual_of_bodies(BasicSystem<T>& s, VecXOf<T> const& a, VecXOf<T> const& lambda) {
  s.coordinates_.entries->expand_rates(s.coordinates_.self.get(), a, true, s.full_a_);
  s.expand_rows(lambda, s.full_lambda_);
  s.full_residual(s.full_a_, s.full_lambda_, s.full_r_);
  return s.full_r_;
}

template <StateScalar T>
void BasicSystem<T>::residual(Vector const& a, Vector const& lambda, Vector& r) {
  if (!coordinates_) return full_residual(a, lambda, r);
  residual_of_bodies(*this, a, lambda);
  coordinates_.entries->reduce(coordinates_.self.get(), full_r_, r);
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
  entries_.measure_gamma(model_, at(), data_, full);
  add_biases(data_, full);
  if (coordinates_) {  // γ + G b
    coordinates_.entries->expand_rates(coordinates_.self.get(), still_, true, full_a_);
    full_lambda_ = full;
    polybody::rows_times(data_, full_a_, full);
    for (Index i = 0; i < full.size(); ++i) full[i] += full_lambda_[i];
  }
  add_constraint_rows(gamma);
}

template <StateScalar T>
void BasicSystem<T>::rows_times(Vector const& b, Vector& out) {
  if (coordinates_) {
    coordinates_.entries->expand_rates(coordinates_.self.get(), b, false, full_a_);
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
    return coordinates_.entries->reduce(coordinates_.self.get(), full_r_, out);
  }
  polybody::rows_transposed_times(data_, b, out);
}

template <StateScalar T>
void BasicSystem<T>::plus(Vector const& q, Vector const& delta, Vector& out) const {
  if (coordinates_) coordinates_.entries->plus(coordinates_.self.get(), q, delta, out);
  entries_.plus(model_, reduced_places(), q, delta, out);
}

template <StateScalar T>
void BasicSystem<T>::local_rate(Vector const& delta, Vector const& v, Vector& out) const {
  if (coordinates_) coordinates_.entries->local_rate(coordinates_.self.get(), delta, v, out);
  entries_.local_rate(model_, reduced_places(), delta, v, out);
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
  entries_.element_forces(model_, at(), a, load_factor, data_, r);
  add_row_forces(data_, lambda, r);
  push_forces();
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
  require_entry(entries_.element_tangents, "tangents")(model_, at(), c, data_, sink);
  write_rows(data_, layout_.velocities, sink);
  entries_.compliant_tangents(model_, c, data_, sink);
  if (c.full) require_entry(entries_.joint_stiffness, "second-order terms")(model_, at(), lambda, c, data_, sink);
  entries_.force_tangents(model_, t_, load_factor, c, data_, sink);
  if (c.full) entries_.load_stiffness(model_, at(), c, data_, sink);
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

}  // namespace polybody
