#pragma once
/// \file
/// Derivatives of a whole run with respect to parameters of its model, by forward differentiation of its steps:
///
///     auto const make = [](std::span<double const> p) { … return Scenario<M>{model, start, options, outputs}; };
///     SensitivityResult const s = sensitivities(make, {{"length [m]", 1.0}}, GeneralisedAlpha{});
///     s.derivatives.back()(0, 0);   // derivative of output 0 with respect to parameter 0 at the end of the run
///
/// The results are derivatives of the discrete run, that is of its computed values, not of the exact motion. The
/// factory makes models for nearby parameter values. Runs are not differenced. Differences, with relative errors of
/// 1e-12 (`FourPoints`), are taken of the equations at given unknowns, of outputs and event values, and of three maps
/// from state to state: a start, an event action, and the start correction after a change of the step length. Steps are
/// differentiated exactly (`AlphaLinearisedStep`), also with respect to their lengths, since breakpoints and events end
/// steps at times that depend on the parameters.
/// Theory: Eqs. 8.17 to 8.19.

#include <polybody/gradients/forward_sensitivities.hpp>
#include <polybody/gradients/perturbed_models.hpp>
#include <polybody/gradients/radau_derivatives.hpp>
#include <polybody/gradients/runge_kutta_derivatives.hpp>

namespace polybody::detail {

// Propagation of forward sensitivities over the steps of integrators of the generalised-α family.

/// Propagates the forward sensitivities of a run over its steps.
template <class S, class I>
class AlphaSensitivities {
 public:
  using V = PerturbedModel<S, I>;
  using Variants = PerturbedModels<V>;

  /// \param full model of the run; must outlive this object
  [[gnu::cold]] explicit AlphaSensitivities(V& full)
      : full_(&full), slope_(full.scenario.model, full.system, full.method) {}

  /// Replaces the sensitivities in `columns` before a step by sensitivities at its end. Returns the largest result of
  /// `AlphaLinearisedStep::advance`.
  double advance(SensitivityStep const& step, std::span<TangentColumn const> columns, Variants& perturbed) {
    auto const& [before, after, h, searched] = step;
    V& spare = perturbed.itself();
    bool const corrects = spare.method.start_step(spare.system, before, h, spare.work);
    State corrected;
    if (corrects) {
      corrected = before;
      corrected.v = spare.work.v0;
    }
    own_before_ = spare.work.a0;
    own_after_ = StepHistory::own_of(after);
    for (TangentColumn const& column : columns) start_step(before, h, column, corrects, perturbed);
    StepEnds const ends{corrects ? corrected : before, after, own_before_, own_after_, h};
    slope_.set(ends, searched ? nullptr : full_->factors(h));
    perturbed.begin_step();
    constexpr std::size_t most = std::size_t(AlphaLinearisedStep<>::max_directions);
    directions_.resize(std::min(columns.size(), most));
    double left = 0.0;
    for (std::size_t first = 0, count; first < columns.size(); first += count) {
      count = std::min(first == 0 ? most - 1 : most, columns.size() - first);
      for (std::size_t l = 0; l < count; ++l) {
        TangentColumn const& column = columns[first + l];
        column.tangent->dt += column.dh;
        perturbed.template of_equations<State>(column.j, {after, h, column.tangent->dt, 0}, directions_[l].by);
        directions_[l].dx = &column.tangent->dx;
        directions_[l].dh = column.dh;
      }
      left = std::max(left, slope_.advance(ends, std::span(directions_).first(count)));
    }
    for (TangentColumn const& column : columns) StepHistory::push_length(column.tangent->lengths, column.dh);
    return left;
  }

 private:
  /// Adds the derivative of the start correction, which changes velocities and algorithmic accelerations before a step
  /// from x.
  static void start_step(State const& x, double h, TangentColumn const& column, bool corrects, Variants& perturbed) {
    RunSensitivity& tangent = *column.tangent;
    double const shifted = StepHistory::shifted_of(x);
    if (!corrects && (shifted == 0.0 || column.dh == tangent.lengths[StepHistory::lengths - 1])) return;
    std::optional<bool> const decided = V::decided(x, h, corrects);
    State const change = perturbed.of_map(column.j, x, tangent, {h, column.dh},
                                          [&](V& v, State& y, double length) { v.set_out_change(y, length, decided); });
    tangent.dx.v += change.v;
    StepHistory::own_of(tangent.dx) += StepHistory::own_of(change);
  }

  V* full_;
  AlphaLinearisedStep<> slope_;
  VecX own_before_, own_after_;  // algorithmic accelerations before and after the step
  std::vector<StepDirection> directions_;
};

// Propagation of forward sensitivities over the steps of Runge–Kutta methods.

/// Propagates forward sensitivities over a step.
template <class S, class I>
class StageSensitivities {
 public:
  using V = PerturbedStageModel<S, I>;
  using Variants = PerturbedModels<V>;

  /// \param full model of the run; must outlive this object
  [[gnu::cold]] explicit StageSensitivities(V& full) : derivatives_(full.scenario.model, full.system, full.method) {}

  /// Converts, in place, the sensitivities in `columns` before a step to sensitivities at its end. Returns the largest
  /// relative change in the last corrections.
  double advance(SensitivityStep const& step, std::span<TangentColumn const> columns, Variants& perturbed) {
    StepTaken const taken{step.before, step.after, step.h};
    derivatives_.set(taken);
    double left = 0.0;
    perturbed.begin_step();
    for (std::size_t first = 0; first < columns.size(); first += directions_.size()) {
      std::size_t const count = std::min(std::size_t(Slopes::max_directions), columns.size() - first);
      directions_.clear();
      dh_.clear();
      for (TangentColumn const& column : columns.subspan(first, count)) {
        directions_.push_back(&column.tangent->dx);
        dh_.push_back(column.dh);
      }
      std::size_t places = 0;
      auto const slope = [&](EvaluationPoint<> const& x, std::size_t l) -> EquationDerivative const& {
        if (l == 0) ++places;
        TangentColumn const& column = columns[first + l];
        double const dt = column.tangent->dt + (x.t - step.before.t) / step.h * column.dh;
        perturbed.template of_equations<EvaluationPoint<>>(column.j, {x, step.h, dt, places - 1}, by_);
        return by_;
      };
      left = std::max(left, derivatives_.advance(taken, directions_, slope, dh_));
    }
    for (TangentColumn const& column : columns) column.tangent->dt += column.dh;
    return left;
  }

 private:
  using Slopes = typename I::Derivatives::template LinearisedStep<I>;

  Slopes derivatives_;
  std::vector<State*> directions_;
  std::vector<double> dh_;
  EquationDerivative by_;
};

}  // namespace polybody::detail

namespace polybody {

/// User function that makes the scenario of a model from the values of the parameters, in their order.
template <class F>
concept ScenarioFactory = requires(F const make, std::span<double const> p) {
  { make(p).model };
  { make(p).start } -> std::convertible_to<State>;
  { make(p).outputs };
};

/// Runs the scenario that `make` returns for the values of the parameters, and differentiates its outputs with respect
/// to each parameter. Newton's method converges to 1e-12 or to round-off. \param integrator integrator of the
/// generalised-α family, without `stabilised`; RungeKutta4, DormandPrince or Radau. Step lengths of DormandPrince are
/// constants, unless an event, a breakpoint or the end of the run ends the step. \throws InvalidInput for invalid
/// parameters; for options with step halving or minimum-norm multipliers; if models of the factory differ in size; if
/// an event only touches zero or remains zero; if an event coincides with a breakpoint or the end of the run; if two
/// events, two breakpoints, or a breakpoint and the start or end of the run coincide and a parameter separates them; if
/// a parameter changes equations of an object outside its `affects`.
/// \throws SingularMatrix in a singular configuration; and the exceptions of `simulate`.
template <ScenarioFactory Make, class I>
SensitivityResult sensitivities(Make const& make, std::vector<Parameter> const& parameters, I const& integrator) {
  if constexpr (detail::AlphaFamilyIntegrator<I>) {
    AlphaMethod const method = detail::method_of_derivatives(parameters, integrator, "sensitivities");
    return detail::ForwardSensitivities<Make, I, detail::AlphaSensitivities>(make, parameters, method).run();
  } else {
    static_assert(detail::HasStageDerivatives<I>,
                  "sensitivities supports GeneralisedAlpha, HhtAlpha, Newmark, Trapezoidal, RungeKutta4, DormandPrince "
                  "and Radau.");
    MethodOf<I> const method = detail::method_of_stages(parameters, integrator);
    return detail::ForwardSensitivities<Make, I, detail::StageSensitivities>(make, parameters, method).run();
  }
}

}  // namespace polybody
