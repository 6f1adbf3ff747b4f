#pragma once
/// \file
/// The stages of a step of Radau (integrators/radau.hpp) in doubles and duals, for its derivative.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <polybody/gradients/evaluation_point.hpp>
#include <polybody/integrators/radau.hpp>

namespace polybody::detail {

/// Largest sizes of entries of a vector: of values and of each derivative.
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

/// v̇_i and λ_i of the three stages, with what follows from them.
template <StateScalar T>
struct RadauStages {
  VecXOf<T> q0, v0;  // the start
  VecXOf<T> next;    // a sum, and at last v̇ of the end
  std::array<VecXOf<T>, 3> v, vd, lambda, delta, rate;
  EvaluationPoint<T> at;  // a stage, and at last the end

  void resize(BasicSystem<T> const& s) {
    q0 = at.q = VecXOf<T>::Constant(s.coordinates(), T(0.0));
    v0 = next = VecXOf<T>::Constant(s.velocities(), T(0.0));
    for (auto* const of : {&v, &vd, &delta, &rate}) of->fill(v0);
    lambda.fill(VecXOf<T>::Constant(s.rows(), T(0.0)));
  }

  /// v_i = v₀ + h Σ a_ij v̇_j and δ_i = h Σ a_ij δ˙(δ_j, v_j), whose passes end when nothing changes but by rounding.
  /// \param h in T where the length of the step moves [s]
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

  /// Stage i of the step becomes the place where equations are asked.
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
