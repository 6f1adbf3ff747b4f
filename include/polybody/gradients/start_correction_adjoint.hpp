#pragma once
/// \file
/// The adjoint of the speeds, and of the method's own accelerations, that a step of the generalised-α family sets out
/// with (`AlphaMethod::start_step`), by differences of them.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <polybody/gradients/perturbed_models.hpp>
#include <polybody/gradients/run_costate.hpp>

namespace polybody::detail {

/// What is added to speeds and own accelerations where a step of h sets out from x. \tparam V a Variant
template <class V>
class StartCorrectionAdjoint {
 public:
  /// \param spare a variant of the run itself, which must outlive it; \param corrects the step adds something
  StartCorrectionAdjoint(V& spare, State const& x, double h, bool corrects)
      : spare_(&spare), x_(&x), h_(h), corrects_(corrects), decided_(V::decided(x, h, corrects)) {}

  /// The length for which x is shifted [s]; zero after a start.
  double shifted() const { return (*x_).history[(*x_).history.size() - 1]; }

  /// Speeds and own accelerations of a variant's y become what is added to them.
  void add(V& v, State& y, double length) const { v.set_out_change(y, length, decided_); }

  /// Takes the costate of speeds and own accelerations that a step sets out with, in `bar`, to that of x. Returns what
  /// J changes by with the length of the step. \param by_time the time of x is not that of a corner
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
