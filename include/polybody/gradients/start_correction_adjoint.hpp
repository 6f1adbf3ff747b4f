#pragma once
/// \file
/// Adjoint of the start correction of a step of the generalised-α family (`AlphaMethod::start_step`). The correction
/// changes velocities and algorithmic accelerations. Its derivatives are computed by differences.
///
/// Not in polybody.hpp: few programs need derivatives of whole runs.

#include <polybody/gradients/perturbed_models.hpp>
#include <polybody/gradients/run_costate.hpp>

namespace polybody::detail {

/// Start correction of velocities and algorithmic accelerations for a step of length h from x, with its adjoint.
/// \tparam V a PerturbedModel
template <class V>
class StartCorrectionAdjoint {
 public:
  /// \param spare model of the run itself; must outlive this object; \param corrects true if the step has a start
  /// correction
  StartCorrectionAdjoint(V& spare, State const& x, double h, bool corrects)
      : spare_(&spare), x_(&x), h_(h), corrects_(corrects), decided_(V::decided(x, h, corrects)) {}

  /// Step length whose start correction is included in x [s]; zero after a start.
  double shifted() const { return (*x_).history[(*x_).history.size() - 1]; }

  /// Replaces velocities and algorithmic accelerations of a state y of model v by their changes due to the start
  /// correction.
  void add(V& v, State& y, double length) const { v.set_out_change(y, length, decided_); }

  /// Converts, in place, the adjoint variables `bar` of the corrected velocities and algorithmic accelerations to
  /// adjoint variables of x. Returns the derivative of J with respect to the step length. \param by_time true to
  /// include the time of x; false at a breakpoint
  double pull(RunCostate& bar, bool by_time) const {
    VecX const v = bar.at.v, own = bar.at.own;
    auto const result = [&](State& y, double length) {
      add(*spare_, y, length);
      return v.dot(y.v) + own.dot(y.history.head(own.size()));
    };
    State const& x = *x_;
    Index const nv = v.size(), nq = x.q.size(), all = x.history.size();
    double const e = 4e-3 * h_;
    if (corrects_) {
      double const of_a = x.a.template lpNorm<Eigen::Infinity>(),
                   of_v = std::max(x.v.template lpNorm<Eigen::Infinity>(), h_ * of_a);
      add_derivatives_by({&State::q, 0, nq, x.q.template lpNorm<Eigen::Infinity>()}, x, h_, result, bar.at.q);
      add_derivatives_by({&State::v, 0, nv, of_v}, x, h_, result, bar.at.v);
      add_derivatives_by({&State::a, 0, nv, of_a}, x, h_, result, bar.at.a);
      add_derivatives_by({&State::history, nv, 2 * nv, of_a}, x, h_, result, bar.history);
      if (by_time) bar.t += slope_along(x, h_, e, [](State& y, double&, double by) { y.t += by; }, result);
    }
    for (Index i = all - 3; i < all; ++i)
      if (x.history[i] > 0.0)
        bar.history[i] += slope_along(x, h_, e, [i](State& y, double&, double by) { y.history[i] += by; }, result);
    return slope_along(x, h_, e, [](State&, double& length, double by) { length += by; }, result);
  }

 private:
  V* spare_;
  State const* x_;
  double h_;
  bool corrects_;
  std::optional<bool> decided_;
};

}  // namespace polybody::detail
