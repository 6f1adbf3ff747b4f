#pragma once
/// \file
/// Objective function of a run: J = Φ(x_N) + ∫ g(x) dt, with the trapezoidal rule over the steps.
///
///     return with_objective(Scenario<M>{model, start, options}, [tip](auto const& m, auto const& x) { … });
///
/// A function of a state of any scalar type (`auto const& x`) is differentiated with a tape. A function of a
/// `State const&` is differentiated by differences, with four evaluations for each entry of q, v, v̇ and λ.
/// Theory: Eq. 8.23.

#include <polybody/compare/compare.hpp>
#include <polybody/gradients/alpha_step_adjoint.hpp>
#include <polybody/gradients/parameter.hpp>
#include <polybody/gradients/run_sensitivity.hpp>
#include <polybody/run/marker_frames.hpp>

namespace polybody {

// Frames and positions of points of bodies in states of any scalar type, for objective functions that are
// differentiated with a tape. The calls are the same as for a State (run/marker_frames.hpp).

/// Frame of a material point in state x. \throws InvalidInput for a marker of another model.
template <class M, class T, class B>
  requires(!std::same_as<T, double>)
Frame<T> frame(M const& model, StateOf<T> const& x, Marker<B> const& marker) {
  model.require_own(marker, "frame");
  auto const& entry = std::get<detail::BodyPool<B>>(model.body_pools()).entries[std::size_t(marker.body)];
  MarkerKinematics<T> out;
  out.columns = point_columns(entry.body, marker.point);
  std::vector<T> jacobian(std::size_t(6 * out.columns));
  out.jacobian = jacobian.data();
  entry.body.template evaluate_marker<T>(
      marker.point, identity(), std::span<T const>(x.q.data() + entry.q0, std::size_t(entry.body.coordinates())),
      std::span<T const>(x.v.data() + entry.v0, std::size_t(entry.body.velocities())), out);
  return out.frame;
}
/// Position of a material point in state x [m]. \throws InvalidInput for a marker of another model.
template <class M, class T, class B>
  requires(!std::same_as<T, double>)
Vec<T, 3> position(M const& model, StateOf<T> const& x, Marker<B> const& marker) {
  return frame(model, x, marker).r;
}

/// Absent term of an objective function.
struct NoTerm {};

/// Scenario with the objective function of its run.
template <class M, class End, class Integrand = NoTerm>
struct ScenarioWithObjective : Scenario<M> {
  End end;                   ///< Φ(model, x) for the state at the end, or NoTerm
  Integrand integrand = {};  ///< g(model, x), or NoTerm
};

/// Adds the objective function J = Φ(x_N) + ∫ g(x) dt to a scenario; without an integrand J = Φ(x_N). \param end
/// Φ(model, state); \param integrand g(model, state)
template <class M, class End, class Integrand = NoTerm>
ScenarioWithObjective<M, End, Integrand> with_objective(Scenario<M> scenario, End end, Integrand integrand = {}) {
  return {std::move(scenario), std::move(end), std::move(integrand)};
}

namespace detail {

/// Value of f in the state x; zero for NoTerm. \throws NonFiniteValue if the value is not finite.
template <class F, class M>
double term(F const& f, M const& model, State const& x) {
  if constexpr (std::same_as<F, NoTerm>) {
    return 0.0;
  } else {
    double const value = value_of(f(model, x));
    if (!std::isfinite(value))
      throw NonFiniteValue("output.not_finite", {ErrorObject{"gradient"}, ": the objective", non_finite_suffix(value),
                                                 " at t = ", ErrorTime{x.t}, " s."});
    return value;
  }
}

/// Adds `weight` times the derivatives of f with respect to q, v, v̇ and λ of x to the adjoint variables `bar`.
template <class F, class M>
void add_derivatives(F const& f, M const& model, State const& x, double weight, Tape& recording, Costate& bar) {
  if constexpr (std::same_as<F, NoTerm>) {
    return;
  } else if constexpr (std::invocable<F const&, M const&, StateOf<ReverseVar> const&>) {
    Tape::On const on(recording);
    StateOf<ReverseVar> at;
    at.t = x.t;
    auto const each = [&](auto&& call) {
      call(at.q, x.q, bar.q);
      call(at.v, x.v, bar.v);
      call(at.a, x.a, bar.a);
      call(at.lambda, x.lambda, bar.lambda);
    };
    each([](VecXOf<ReverseVar>& to, VecX const& from, VecX&) {
      to.resize(from.size());
      for (Index i = 0; i < from.size(); ++i) to[i] = ReverseVar::variable(from[i]);
    });
    ReverseVar const value = f(model, std::as_const(at));
    recording.clear_derivatives(recording.size());
    recording.slope(value.number) += weight;
    recording.sweep(recording.size());
    each([&](VecXOf<ReverseVar> const& from, VecX const&, VecX& to) {
      for (Index i = 0; i < to.size(); ++i) to[i] += recording.slope(from[i].number);
    });
  } else {
    State near = x;
    auto const each = [&](VecX& numbers, VecX const& at, VecX& to) {
      double const size = at.size() > 0 && at.cwiseAbs().maxCoeff() > 0.0 ? at.cwiseAbs().maxCoeff() : 1.0;
      double const e = 1e-3 * size;
      for (Index i = 0; i < at.size(); ++i) {
        double slope = 0.0;
        for (std::size_t k = 0; k < FourPoints::places.size(); ++k) {
          numbers[i] = at[i] + FourPoints::places[k] * e;
          slope += FourPoints::weights[k] / e * term(f, model, near);
        }
        numbers[i] = at[i];
        to[i] += weight * slope;
      }
    };
    each(near.q, x.q, bar.q);
    each(near.v, x.v, bar.v);
    each(near.a, x.a, bar.a);
    each(near.lambda, x.lambda, bar.lambda);
  }
}

/// Derivatives of objective functions with respect to q, v, v̇ and λ of the reduced states of a run. \tparam M model
template <class M>
class ObjectiveDerivatives {
 public:
  [[gnu::cold]] explicit ObjectiveDerivatives(M const& model) : full_state_(model), recorded_(model) {}

  /// Adds `weight` times the derivatives of f(model, full state of x) with respect to q, v, v̇ and λ of x to `bar`.
  template <class F>
  void add(F const& f, M const& model, State const& x, double weight, Costate& bar) {
    if constexpr (std::same_as<F, NoTerm>) return;
    if constexpr (M::eliminates) {
      State const& full = full_state_(x);
      Costate of_full(full);
      add_derivatives(f, model, full, weight, recording_, of_full);
      pull(x, of_full, bar);
    } else {
      add_derivatives(f, model, x, weight, recording_, bar);
    }
  }

 private:
  /// Computes the adjoint variables of the reduced state x from the adjoint variables `of_full` of its full state, and
  /// adds them to `bar`.
  void pull(State const& x, Costate const& of_full, Costate& bar) {
    Tape::On const on(recording_);
    StateOf<ReverseVar> from;
    from.t = x.t;
    set_variables(x.q, from.q);
    set_variables(x.v, from.v);
    set_variables(x.a, from.a);
    set_variables(x.lambda, from.lambda);
    StateOf<ReverseVar> const& to = recorded_(from);
    recording_.clear_derivatives(recording_.size());
    add_to_derivatives(recording_, to.q, of_full.q);
    add_to_derivatives(recording_, to.v, of_full.v);
    add_to_derivatives(recording_, to.a, of_full.a);
    add_to_derivatives(recording_, to.lambda, of_full.lambda);
    recording_.sweep(recording_.size());
    add_derivatives_of(from.q, bar.q);
    add_derivatives_of(from.v, bar.v);
    add_derivatives_of(from.a, bar.a);
    add_derivatives_of(from.lambda, bar.lambda);
  }
  void add_derivatives_of(VecXOf<ReverseVar> const& from, VecX& to) {
    for (Index i = 0; i < from.size(); ++i) to[i] += recording_.slope(from[i].number);
  }

  FullStates<M> full_state_;
  FullStates<M, ReverseVar> recorded_;
  Tape recording_;
};

}  // namespace detail
}  // namespace polybody
