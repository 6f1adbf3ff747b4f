#pragma once
/// \file
/// Derivatives of a whole run with respect to numbers of its model, by direct differentiation of its steps:
///
///     auto const make = [](std::span<double const> p) { … return Scenario<M>{model, start, options, outputs}; };
///     Sensitivities const s = sensitivities(make, {{"length [m]", 1.0}}, GeneralizedAlpha{});
///     s.slopes.back()(0, 0);   // of the first output by the first parameter at the end of the run
///
/// They are those of the discrete run: of the numbers that its steps give, not of the motion that these approximate. A
/// model is made for nearby values, and only its equations at given unknowns are differenced (FourPoints: relative
/// errors of 1e-12), never a run. Steps are differentiated exactly (`AlphaStepSlope`). A start, and a step of another
/// length than the last one, is a map from state to state that is differenced as a whole.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <memory>
#include <span>

#include <polybody/gradients/parameter.hpp>
#include <polybody/gradients/variant.hpp>

namespace polybody {

/// Outputs of a run and their derivatives.
struct Sensitivities {
  std::vector<std::string> parameters, outputs;  ///< names, with units
  std::vector<double> times;                     ///< (n) the start and every step's end [s]
  std::vector<VecX> values;                      ///< (n) of the outputs
  std::vector<MatX> slopes;                      ///< (n) outputs × parameters
  double left = 0.0;                             ///< the largest relative change by a last correction of a step
  RunReport run;                                 ///< of the steps themselves
};

/// A user's factory: a scenario of a model for the values of the parameters, in their order.
template <class F>
concept MakesScenarios = requires(F const make, std::span<double const> p) {
  { make(p).model };
  { make(p).start } -> std::convertible_to<State>;
  { make(p).outputs };
};

namespace detail {

/// A run and its derivatives, step by step.
template <class Make, class I>
class DirectDifferentiation {
  using S = std::remove_cvref_t<decltype(std::declval<Make const&>()(std::declval<std::span<double const>>()))>;
  using V = Variant<S, I>;

 public:
  [[gnu::cold]] DirectDifferentiation(Make const& make, std::vector<Parameter> const& parameters,
                                      AlphaMethod const& method)
      : parameters_(parameters),
        whole_(make(values(parameters)), method),
        slope_(whole_.scenario.model, whole_.system, method) {
    require_plain(whole_.scenario);
    for (std::size_t j = 0; j < parameters.size(); ++j)
      for (double const place : FourPoints::places) {
        std::vector<double> p = values(parameters);
        p[j] += place * parameters[j].distance();
        beside_.push_back(std::make_unique<V>(make(p), method));
        require_alike(parameters[j], *beside_.back());
      }
  }

  Sensitivities run() {
    RunOptions const& options = whole_.scenario.options;
    x_ = whole_.scenario.start;
    options.check(x_.t);
    require_assembled(whole_.system, x_, options.assembly_tolerance);
    StepPlan plan(x_.t, options.until, options.step, whole_.system.layout().corners);
    StepRow row;
    begin(std::min<double>(options.step, options.until - x_.t));
    note();
    while (x_.t < options.until) {
      auto const next = plan.next(x_.t, options.step);
      if (next.jumps) refuse_corner(next.target);
      double const from = x_.t;
      advance(next.h);
      x_.t = next.lands ? next.target : row.after(from, next.h);
      note();
    }
    for (std::size_t j = 0; j < parameters_.size(); ++j)
      if (!touched_[j])
        out_.run.add_warning("Nothing in the run depends on the parameter \"" + parameters_[j].name + "\".");
    return std::move(out_);
  }

 private:
  static std::vector<double> values(std::vector<Parameter> const& parameters) {
    std::vector<double> p;
    for (Parameter const& one : parameters) p.push_back(one.value);
    return p;
  }
  static void require_plain(S const& scenario) {
    RunOptions const& o = scenario.options;
    if (!o.events.empty() || !o.corners.empty() || o.halvings > 0 || o.minimum_norm)
      throw InvalidInput(
          "sensitivities: a run with events, corners, halved steps or multipliers of least norm is not differentiated. "
          "Leave them out of the options.");
  }
  [[noreturn, gnu::cold]] static void refuse_corner(double t) {
    throw InvalidInput{"sensitivities: a drive or load has a corner at t = ", t,
                       " s, where a run begins anew. Give smooth laws, or end the run before."};
  }
  void require_alike(Parameter const& p, V const& other) const {
    auto const sizes = [](V const& v) {
      return std::array{v.system.coordinates(), v.system.speeds(), v.system.rows(), Index(v.scenario.outputs.size())};
    };
    if (sizes(other) != sizes(whole_))
      throw InvalidInput{"sensitivities: with another \"", p.name,
                         "\" the factory makes a model of other sizes. Let parameters change numbers, not what is "
                         "there."};
  }

  /// Σ of what f gives of the four variants beside parameter j, weighted to a derivative.
  template <class F>
  State slope(std::size_t j, F&& f) {
    State sum;
    for (std::size_t k = 0; k < FourPoints::places.size(); ++k) {
      State const x = f(*beside_[4 * j + k], FourPoints::places[k] * parameters_[j].distance());
      if (k == 0) sum = zeros_like(x);
      if (x.memory.tail(StepHistory::lengths) != x_.memory.tail(StepHistory::lengths))
        throw InvalidInput{"sensitivities: at t = ", x_.t, " s the start of a run with another \"", parameters_[j].name,
                           "\" is corrected otherwise. Set start_correction to false."};
      add(sum, x, FourPoints::weights[k] / parameters_[j].distance());
    }
    sum.memory.tail(StepHistory::lengths) = x_.memory.tail(StepHistory::lengths);
    return sum;
  }

  void begin(double h) {
    whole_.start(x_, h);
    for (std::size_t j = 0; j < parameters_.size(); ++j)
      dx_.push_back(slope(j, [&](V& v, double) { return v.started(h); }));
    touched_.assign(parameters_.size(), 0);
    for (Parameter const& p : parameters_) out_.parameters.push_back(p.name);
    for (auto const& o : whole_.scenario.outputs) out_.outputs.push_back(o.name);
  }

  void advance(double h) {
    Index const nv = x_.v.size();
    State const unset = x_;
    if (whole_.set_out(x_, h))  // from other speeds than those of x
      for (std::size_t j = 0; j < parameters_.size(); ++j)
        dx_[j] = slope(j, [&](V& v, double e) {
          State x = out_.run.steps == 0 ? v.started(h) : beside(unset, dx_[j], e);
          (void)v.set_out(x, h);
          return x;
        });
    State const before = x_;
    out_.run.add(whole_.step(x_, h));
    VecX const own_before = before.memory.head(nv), own_after = x_.memory.head(nv);
    StepEnds const step{before, x_, own_before, own_after, h};
    slope_.set(step);
    std::vector<StepDirection> directions;
    for (std::size_t j = 0; j < parameters_.size(); ++j) {
      directions.push_back({equation_slope(j), &dx_[j]});
      if (directions.size() < std::size_t(AlphaStepSlope<>::lanes) && j + 1 < parameters_.size()) continue;
      out_.left = std::max(out_.left, slope_.advance(step, directions));
      directions.clear();
    }
  }
  EquationSlope equation_slope(std::size_t j) {
    EquationSlope sum{VecX::Zero(x_.v.size()), VecX::Zero(x_.lambda.size()), parameters_[j].size()};
    for (std::size_t k = 0; k < FourPoints::places.size(); ++k) {
      EquationSlope const of = beside_[4 * j + k]->equations(x_);
      double const by = FourPoints::weights[k] / parameters_[j].distance();
      sum.balance += by * of.balance;
      sum.rows += by * of.rows;
    }
    return sum;
  }

  /// Values and slopes of the outputs at x.
  void note() {
    MatX slopes = MatX::Zero(Index(out_.outputs.size()), Index(parameters_.size()));
    State shown = x_;
    for (std::size_t j = 0; j < parameters_.size(); ++j) {
      for (std::size_t k = 0; k < FourPoints::places.size(); ++k) {
        double const e = parameters_[j].distance();
        add_motion(shown, dx_[j], FourPoints::places[k] * e, x_);
        slopes.col(Index(j)) += FourPoints::weights[k] / e * beside_[4 * j + k]->outputs(shown);
      }
      bool const moves = dx_[j].q.squaredNorm() + dx_[j].v.squaredNorm() + dx_[j].a.squaredNorm() > 0.0;
      if (moves || !slopes.col(Index(j)).isZero(0.0)) touched_[j] = 1;
    }
    out_.times.push_back(x_.t);
    out_.values.push_back(whole_.outputs(x_));
    out_.slopes.push_back(std::move(slopes));
  }
  AlphaMethod const& method() const { return whole_.method; }

  std::vector<Parameter> parameters_;
  V whole_;
  AlphaStepSlope<> slope_;
  std::vector<std::unique_ptr<V>> beside_;  // four for each parameter
  State x_;
  std::vector<State> dx_;  // of each parameter
  std::vector<char> touched_;
  Sensitivities out_;
};

}  // namespace detail

/// Runs the scenario that `make` gives for the parameters' values and differentiates its outputs with respect to each.
/// Newton's corrections go on to 1e-12 or to what rounding leaves. \param integrator one of the generalised-α family,
/// without `stabilised`. \throws InvalidInput for parameters that cannot be meant, a factory whose models differ in
/// size, a scenario with events or corners; LinearSolverSingular at a singular position; and as `simulate`.
template <MakesScenarios Make, class I>
Sensitivities sensitivities(Make const& make, std::vector<Parameter> const& parameters, I const& integrator) {
  using M = decltype(make(std::span<double const>()).model);
  static_assert(!M::eliminates,
                "Steps in joint coordinates, and with dependent coordinates eliminated, are not differentiated. Give "
                "the joints Constraint, Penalty or Bushing.");
  static_assert(
      requires {
        { integrator.method() } -> std::convertible_to<AlphaMethod>;
      },
      "Runs are differentiated under the generalised-α family: GeneralizedAlpha, HhtAlpha, Newmark, "
      "Trapezoidal.");
  integrator.check();
  check(parameters);
  AlphaMethod method = integrator.method();
  if (method.stabilised)
    throw InvalidInput("sensitivities: a stabilised step is not differentiated. Set `stabilised` to false.");
  method.tolerance = std::min(method.tolerance, 1e-12);
  method.newton.budget = 0.0;
  return detail::DirectDifferentiation<Make, I>(make, parameters, method).run();
}

}  // namespace polybody
