#pragma once
/// \file
/// Stages of a Radau step (integrators/radau.hpp) in any scalar type, for the derivatives of the step.
///
/// Not in polybody.hpp: few programs need derivatives of whole runs.

#include <polybody/gradients/evaluation_point.hpp>
#include <polybody/integrators/radau.hpp>

namespace polybody::detail {

/// Largest absolute value of the entries of a vector and, for dual numbers, of each of their derivatives.
template <StateScalar T>
struct LargestParts {
  double value = 0.0;
  void add(T const& x) { value = std::max(value, std::abs(value_of(x))); }
  bool within(double share, LargestParts const& of) const { return value <= share * of.value; }
};
template <int N>
struct LargestParts<Dual<N>> {
  Eigen::Array<double, N + 1, 1> parts = Eigen::Array<double, N + 1, 1>::Zero();
  void add(Dual<N> const& x) {
    parts[0] = std::max(parts[0], std::abs(x.v));
    for (int l = 0; l < N; ++l) parts[l + 1] = std::max(parts[l + 1], std::abs(x.d[l]));
  }
  bool within(double share, LargestParts const& of) const { return (parts <= share * of.parts).all(); }
};

/// Unknowns v̇_i and λ_i of the three stages, and the quantities that depend on them.
template <StateScalar T>
struct RadauStages {
  VecXOf<T> q0, v0;                                     // at the start of the step
  VecXOf<T> next;                                       // workspace; finally v̇ at the end of the step
  std::array<VecXOf<T>, 3> v, vd, lambda, delta, rate;  // v_i, v̇_i, λ_i, δ_i and δ˙_i of the stages
  EvaluationPoint<T> at;                                // a stage; finally the end of the step

  void resize(BasicSystem<T> const& s) {
    q0 = at.q = VecXOf<T>::Constant(s.coordinates(), T(0.0));
    v0 = next = VecXOf<T>::Constant(s.velocities(), T(0.0));
    for (auto* const of : {&v, &vd, &delta, &rate}) of->fill(v0);
    lambda.fill(VecXOf<T>::Constant(s.rows(), T(0.0)));
  }

  /// Computes v_i = v₀ + h Σ a_ij v̇_j and δ_i = h Σ a_ij δ˙(δ_j, v_j). The fixed-point iteration for δ_i ends when the
  /// changes are at round-off. \param h step length, of type T if it varies [s]
  template <class H>
  void find(BasicSystem<T> const& s, H const& h) {
    for (std::size_t i = 0; i < 3; ++i) {
      v[i] = v0;
      add_weighted(vd, i, h, v[i]);
    }
    bool moves = true;
    for (int pass = 0; moves && pass < most_passes; ++pass) {
      LargestParts<T> change, size;
      for (std::size_t j = 0; j < 3; ++j) s.local_rate(delta[j], v[j], rate[j]);
      for (std::size_t i = 0; i < 3; ++i) {
        next.setConstant(T(0.0));
        add_weighted(rate, i, h, next);
        for (Index k = 0; k < next.size(); ++k) {
          change.add(next[k] - delta[i][k]);
          size.add(next[k]);
        }
        delta[i].swap(next);
      }
      moves = !change.within(4e-16, size);
    }
  }

  /// Sets the evaluation point to stage i of the step.
  void put(BasicSystem<T> const& s, std::size_t i, StepTaken const& step) {
    at.also.resize(0);
    at.terms = {};
    s.plus(q0, delta[i], at.q);
    at.v = v[i];
    at.t = step.before.t + RadauTableau::c[i] * step.h;
    at.a = vd[i];
    at.lambda = lambda[i];
  }

 private:
  static constexpr int most_passes = 30;

  /// sum += h Σ a_ij of_j.
  template <class H>
  static void add_weighted(std::array<VecXOf<T>, 3> const& of, std::size_t i, H const& h, VecXOf<T>& sum) {
    for (std::size_t j = 0; j < 3; ++j) {
      H const weight = h * RadauTableau::a[i][j];
      for (Index k = 0; k < sum.size(); ++k) sum[k] += of[j][k] * weight;
    }
  }
};

}  // namespace polybody::detail
