#pragma once
/// \file
/// Maps between reduced velocities u and full velocities v = T u, for models with policies that eliminate unknowns. T
/// is the matrix of joint trees (`JointTree`) and of linear joints (`LinearElimination`). Steps use doubles;
/// derivatives of steps use the same maps with dual numbers or with a tape.

#include <polybody/elimination/joint_coordinates.hpp>
#include <polybody/elimination/reduction.hpp>
#include <polybody/elimination/tree_body.hpp>
#include <polybody/system/coordinates.hpp>

namespace polybody::detail {

// Multipliers of an eliminated joint from its reaction wrench.

/// Adds to λ (m entries) the correction δ that minimises ‖Gᵀδ + `residual`‖. \param map G of the carried body, m×6 by
/// columns, about the marker \param residual residual wrench [f; m] of the body about its centre of mass \param arm
/// vector from the centre of mass to the marker
template <class T>
void add_multipliers_that_hold(int m, T const* map, Vec<T, 6> residual, Vec<T, 3> const& arm, T* lambda) {
  for (int k = 0; k < 3; ++k)
    residual[3 + k] -= arm[(k + 1) % 3] * residual[(k + 2) % 3] - arm[(k + 2) % 3] * residual[(k + 1) % 3];
  auto gram = zeros<Mat<T, 6, 6>>();
  for (int k = m; k < 6; ++k) gram(k, k) = 1.0;
  T right[6] = {};
  for (int k = 0; k < m; ++k) {
    for (int l = 0; l < 6; ++l) right[k] -= map[m * l + k] * residual[l];
    for (int j = 0; j < m; ++j) {
      T sum = 0.0;
      for (int l = 0; l < 6; ++l) sum += map[m * l + k] * map[m * l + j];
      gram(k, j) = sum;
    }
  }
  invert_leading(gram, m);
  for (int k = 0; k < m; ++k) {
    T sum = 0.0;
    for (int j = 0; j < m; ++j) sum += gram(k, j) * right[j];
    lambda[k] += sum;
  }
}

/// Maps v = T u, v̇ = T u̇ + b and multiplication by Tᵀ, in the state of the last `expand`. \tparam Solution solution
/// method of the equations of joint coordinates; void if there are only linear joints \tparam T scalar
template <class Solution, StateScalar T = double>
class CoordinateMaps : public StepCoordinates<T> {
  using Vector = VecXOf<T>;

 public:
  /// \throws InvalidInput if joints with joint coordinates close a loop. \throws InconsistentInitialConditions if
  /// linear joints contradict each other.
  template <class M>
  explicit CoordinateMaps(M const& model)
      : reduction_(model),
        state_(reduction_.tree().state()),
        q_(model.reference_state().q.template cast<T>()),
        v_(Vector::Constant(model.velocities(), T(0.0))),
        a_(v_),
        last_r_(v_),
        reduced_(Vector::Constant(reduction_.velocities(), T(0.0))) {}

  /// Layout of reduced vectors, as far as the maps define it.
  ReducedLayout reduced_layout() const {
    ReducedLayout n{.coordinates = reduction_.coordinates(),
                    .velocities = reduction_.velocities(),
                    .rows = reduction_.rows(),
                    .nonholonomic_equations = reduction_.nonholonomic_equations(),
                    .places = reduction_.places(),
                    .remaining_equations = reduction_.remaining_equations(),
                    .keeps_mass_constant = !has_tree};
    for (Index i = 0; i < n.velocities; ++i) n.full_velocity.push_back(reduction_.full_velocity(i));
    if constexpr (has_tree)
      for_each_motion(reduction_.tree(), [&](JointMotion const& m, Index q, Index v) {
        if (m.kind != JointMotion::Kind::slide) n.turns.push_back({q, v, m.coordinates(), m.velocities()});
      });
    return n;
  }

  void expand(Vector const& q, Vector const& v, Vector& full_q, Vector& full_v) override {
    place(q, v);
    full_q = q_;
    full_v = v_;
  }
  void expand_rates(Vector const& u, bool bias, Vector& out) override {
    reduction_.expand_velocities(u, out);
    reduction_.linear().expand_rates(out);
    if constexpr (has_tree) reduction_.tree().expand_rates(state_, u, bias, out);
  }
  void reduce(Vector& r, Vector& out) override {
    last_r_ = r;
    reduction_.linear().reduce_forces(r);
    if constexpr (has_tree) reduction_.tree().reduce_forces(state_, r, out);
    reduction_.reduce_velocities(r, out);
  }
  void recover_multipliers(Data<T> const& data, Vector& lambda) override {
    reduction_.linear().multipliers(last_r_, lambda);
    if constexpr (has_tree) {
      a_ = last_r_;
      reduction_.tree().reduce_forces(state_, a_, reduced_);
      for (ConstraintBlock<T> const& block : data.rows)
        if (block.source == ConstraintSource::joint && reduction_.carried_by(block.row) >= 0) {
          std::size_t const i = std::size_t(reduction_.carried_by(block.row));
          ConstraintSide<T> const& end = reduction_.tree().bodies[i].backwards ? block.a : block.b;
          Vec<T, 3> const& at = data.markers[std::size_t(end.marker)].frame.r;
          add_multipliers_that_hold(block.rows, end.map, state_.residuals[i], difference<T>(at, state_.frames[i].r),
                                    lambda.data() + block.row);
        }
    }
  }
  void plus(Vector const& q, Vector const& delta, Vector& sum) const override {
    if constexpr (has_tree) polybody::plus(reduction_.tree(), q, delta, sum);
  }
  void local_rate(Vector const& delta, Vector const& v, Vector& rate) const override {
    if constexpr (has_tree) polybody::local_rate(reduction_.tree(), delta, v, rate);
  }

 protected:
  static constexpr bool has_tree = !std::is_void_v<Solution>;

  /// Computes q_, v_ and the state of the tree from reduced coordinates and velocities.
  void place(Vector const& q, Vector const& v) {
    reduction_.expand_coordinates(q, q_);
    reduction_.expand_velocities(v, v_);
    reduction_.linear().expand_coordinates(q_);
    reduction_.linear().expand_rates(v_);
    if constexpr (has_tree) reduction_.tree().expand_state(q, v, q_, v_, state_);
  }

  ReductionOf<T> reduction_;
  TreeStateOf<T> state_;
  Vector q_, v_, a_;  // full vectors
  Vector last_r_;     // full residual of the last `reduce`
  Vector reduced_;
};

}  // namespace polybody::detail
