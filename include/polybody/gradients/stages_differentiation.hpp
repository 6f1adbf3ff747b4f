#pragma once
/// \file
/// A run by a method of several stages that takes its derivatives along, step by step.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <memory>
#include <span>

#include <polybody/gradients/run_tangent.hpp>
#include <polybody/gradients/sensitivities_report.hpp>
#include <polybody/gradients/stages_variant.hpp>

namespace polybody::detail {

/// A run and its derivatives. Steps have the lengths that the method chooses for the values of the parameters, which
/// stay as they are.
template <class Make, class I>
class StagesDifferentiation {
  using S = std::remove_cvref_t<decltype(std::declval<Make const&>()(std::declval<std::span<double const>>()))>;
  using V = StagesVariant<S, I>;
  using Slopes = typename SlopesOfStages<I>::Type;

 public:
  [[gnu::cold]] StagesDifferentiation(Make const& make, std::vector<Parameter> const& parameters,
                                      MethodOf<I> const& method)
      : parameters_(parameters),
        whole_(make(values_of(parameters)), method),
        slopes_(whole_.scenario.model, whole_.system, whole_.method) {
    require_plain(whole_.scenario.options, "sensitivities");
    for (std::size_t j = 0; j < parameters.size(); ++j)
      for (double const place : FourPoints::places) {
        std::vector<double> p = values_of(parameters);
        p[j] += place * parameters[j].distance();
        beside_.push_back(std::make_unique<V>(make(p), method));
        require_alike(whole_, *beside_.back(), parameters[j], "sensitivities");
      }
  }

  Sensitivities run() {
    RunOptions const& options = whole_.scenario.options;
    x_ = whole_.scenario.start;
    options.check(x_.t);
    require_assembled_start(whole_);
    double const largest = options.largest_step.value_or(std::numeric_limits<double>::infinity());
    double h = std::min<double>(options.step, largest);
    StepPlan const plan(x_.t, options.until, options.step, whole_.system.layout().corners);
    begin(plan.next(x_.t, h).h);
    note();
    StepRow row;
    while (x_.t < options.until) {
      StepPlan::Next const next = plan.next(x_.t, h);
      if (next.jumps)
        throw InvalidInput{"sensitivities: a drive or load has a corner at t = ", next.target,
                           " s, and runs of this integrator are not differentiated beyond one. Give smooth laws, end "
                           "the run before, or take GeneralizedAlpha."};
      State const before = x_;
      StepReport const report = whole_.step(x_, next.h);
      bool const reached = next.lands && report.taken == next.h;
      x_.t = reached ? next.target : row.after(before.t, report.taken);
      if constexpr (requires { I::controls_step; })
        h = std::min(reached ? std::max(report.next, h) : report.next, largest);
      differentiate({before, x_, report.taken});
      out_.run.add(report);
      note();
    }
    warn_of_untouched(parameters_, touched_, out_.run);
    return std::move(out_);
  }

 private:
  /// Σ of what f gives of the four variants beside parameter j, weighted to a derivative.
  template <class F>
  auto slope_of(std::size_t j, F&& f) {
    auto const by = [&](std::size_t k) { return FourPoints::weights[k] / parameters_[j].distance(); };
    VecX sum = by(0) * f(*beside_[4 * j]);
    for (std::size_t k = 1; k < FourPoints::places.size(); ++k) sum += by(k) * f(*beside_[4 * j + k]);
    return sum;
  }

  void begin(double h) {
    x_ = whole_.started(h);
    for (std::size_t j = 0; j < parameters_.size(); ++j) {
      State dx = zeros_like(x_);
      for (std::size_t k = 0; k < FourPoints::places.size(); ++k)
        add(dx, beside_[4 * j + k]->started(h), FourPoints::weights[k] / parameters_[j].distance());
      dx_.push_back(std::move(dx));
    }
    touched_.assign(parameters_.size(), 0);
    for (Parameter const& p : parameters_) out_.parameters.push_back(p.name);
    for (auto const& o : whole_.scenario.outputs) out_.outputs.push_back(o.name);
  }

  void differentiate(StepTaken const& step) {
    slopes_.set(step);
    std::vector<State*> directions;
    for (std::size_t first = 0; first < parameters_.size(); first += directions.size()) {
      directions.clear();
      for (std::size_t j = first; j < parameters_.size() && directions.size() < std::size_t(Slopes::lanes); ++j)
        directions.push_back(&dx_[j]);
      auto const slope = [&](EquationPlace<> const& x, std::size_t l) {
        std::size_t const j = first + l;
        for (std::size_t k = 0; k < FourPoints::places.size(); ++k)
          beside_[4 * j + k]->at_place.evaluate(beside_[4 * j + k]->system, x);
        return EquationSlope{slope_of(j, [](V const& v) -> VecX const& { return v.at_place.balance; }),
                             slope_of(j, [](V const& v) -> VecX const& { return v.at_place.rows; }),
                             parameters_[j].size()};
      };
      double const left = slopes_.advance(step, directions, slope);
      out_.left = std::max(out_.left, require_converged(left, x_.t, "sensitivities"));
    }
  }

  /// Values and slopes of the outputs at x.
  void note() {
    MatX slopes = MatX::Zero(Index(out_.outputs.size()), Index(parameters_.size()));
    State shown = x_;
    for (std::size_t j = 0; j < parameters_.size(); ++j) {
      State const& dx = dx_[j];
      std::size_t k = 0;
      slopes.col(Index(j)) = slope_of(j, [&](V& v) {
        add_motion(shown, dx, FourPoints::places[k++] * parameters_[j].distance(), x_);
        return v.outputs(shown);
      });
      bool const moves = dx.q.squaredNorm() + dx.v.squaredNorm() + dx.a.squaredNorm() > 0.0;
      if (moves || !slopes.col(Index(j)).isZero(0.0)) touched_[j] = 1;
    }
    out_.times.push_back(x_.t);
    out_.values.push_back(whole_.outputs(x_));
    out_.slopes.push_back(std::move(slopes));
    out_.time_slopes.push_back(VecX::Zero(Index(parameters_.size())));
  }

  std::vector<Parameter> parameters_;
  V whole_;
  Slopes slopes_;
  std::vector<std::unique_ptr<V>> beside_;  // four for each parameter
  State x_;
  std::vector<State> dx_;  // of each parameter
  std::vector<char> touched_;
  Sensitivities out_;
};

}  // namespace polybody::detail
