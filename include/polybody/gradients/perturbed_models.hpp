#pragma once
/// \file
/// Derivatives with respect to parameters, by differences between perturbed models. If times depend on parameters,
/// differences along the motion are added.

#include <memory>
#include <optional>
#include <span>

#include <polybody/gradients/equation_derivatives.hpp>
#include <polybody/gradients/requirements.hpp>
#include <polybody/gradients/time_map.hpp>

namespace polybody::detail {

// Model of a run, and four perturbed models for each parameter.

/// Model for the values of the parameters, and models at the four difference points of each parameter. \tparam V
/// PerturbedModel or PerturbedStageModel
template <class V>
class NearbyModels {
 public:
  /// \param who name of the calling function in messages
  template <class Make, class Method>
  [[gnu::cold]] NearbyModels(Make const& make, std::vector<Parameter> const& parameters, Method const& method,
                             char const* who)
      : parameters_(parameters), itself_(shared_scenario<V>(make, values_of(parameters)), method) {
    for (std::size_t j = 0; j < parameters.size(); ++j)
      for (double const place : FourPoints::places) {
        std::vector<double> p = values_of(parameters);
        p[j] += place * parameters[j].distance();
        perturbed_.push_back(std::make_shared<V>(shared_scenario<V>(make, p), method));
        require_alike(itself_, *perturbed_.back(), parameters[j], who);
      }
    find_times(who);
  }

  V& itself() { return itself_; }                                  ///< model for the values of the parameters
  TimeMap const& times(std::size_t j) const { return times_[j]; }  ///< times of the runs with perturbed parameter j
  /// Model at difference point k of parameter j.
  V& perturbed(std::size_t j, std::size_t k) { return *perturbed_[points * j + k]; }
  /// Model at difference point k of parameter j, with shared ownership.
  std::shared_ptr<V> shared(std::size_t j, std::size_t k) const { return perturbed_[points * j + k]; }
  Parameter const& parameter(std::size_t j) const { return parameters_[j]; }  ///< parameter number j

  /// Length of a step from the time `from` in the run with point k of parameter j [s]. Its end corresponds to t + h,
  /// the end of a step from t in the unperturbed run.
  double length(std::size_t j, std::size_t k, double t, double h, double from) const {
    double const end = times_[j](k, t + h);
    if (from == t && end == t + h) return h;
    double length = end - from;
    while (from + length > end) length = std::nextafter(length, 0.0);
    return length;
  }

 private:
  static constexpr std::size_t points = FourPoints::places.size();

  [[gnu::cold]] void find_times(char const* who) {
    std::vector<double> const here = itself_.breakpoints();
    double const start = itself_.scenario.start.t;
    for (std::size_t j = 0; j < parameters_.size(); ++j) {
      std::vector<TimeMap::Moving> times;
      auto const add_time = [&](double t, auto const& of) {
        if (!std::isfinite(t)) return;
        TimeMap::Moving m{t, {}};
        for (std::size_t k = 0; k < points; ++k) m.there[k] = of(*perturbed_[points * j + k]);
        times.push_back(m);
      };
      add_time(start, [](V const& v) { return v.scenario.start.t; });
      for (std::size_t i = 0; i < here.size(); ++i) add_time(here[i], [i](V const& v) { return v.breakpoints()[i]; });
      times_.emplace_back(std::move(times), parameters_[j], 1e-9 * itself_.length(), who);
    }
  }

  std::vector<Parameter> parameters_;
  V itself_;
  std::vector<std::shared_ptr<V>> perturbed_;  // four for each parameter
  std::vector<TimeMap> times_;
};

/// Derivatives of functions of scenarios by differences. If the time of a state depends on parameter j, the change of
/// the state with j has two parts. The first part is the change at fixed time. The perturbed models are evaluated in
/// states with this change, so that stiff elements are not excited. The second part is the change along the motion
/// during the change of time. This time can exceed a step, so the second part is differenced with the unperturbed model
/// over at most ±0.8 % of a step. \tparam V PerturbedModel or PerturbedStageModel
template <class V>
class PerturbedModels {
 public:
  static constexpr std::size_t along_motion = std::size_t(-1);  ///< parameter number for changes along the motion

  /// \param who name of the calling function in messages
  template <class Make, class Method>
  [[gnu::cold]] PerturbedModels(Make const& make, std::vector<Parameter> const& parameters, Method const& method,
                                char const* who)
      : n_(make, parameters, method, who) {
    std::vector<Parameter> still;
    number_.assign(parameters.size(), moving);
    for (std::size_t j = 0; j < parameters.size(); ++j)
      if (!n_.times(j).moves()) {
        number_[j] = still.size();
        still_.push_back(j);
        still.push_back(parameters[j]);
      }
    auto const make_still = [&](std::span<double const> p) {
      std::vector<double> all = values_of(parameters);
      for (std::size_t i = 0; i < p.size(); ++i) all[still_[i]] = p[i];
      return make(all);
    };
    derivatives_.emplace(make_still, still, n_.itself(), [this](std::size_t i, std::size_t k) {
      bool const itself = i == EquationDerivatives<V>::nobody;
      return itself ? std::shared_ptr<V>(std::shared_ptr<V>(), &n_.itself()) : n_.shared(still_[i], k);
    });
  }
  PerturbedModels(PerturbedModels const&) = delete;
  PerturbedModels& operator=(PerturbedModels const&) = delete;

  V& itself() { return n_.itself(); }                                        ///< model for the values of the parameters
  V& perturbed(std::size_t j, std::size_t k) { return n_.perturbed(j, k); }  ///< model at point k of parameter j
  std::size_t groups() const { return derivatives_->groups(); }  ///< groups of parameters that are differenced together
  /// True if the start time, the end time or the step length depends on a parameter. \param chooses true if the
  /// integrator chooses the step length
  bool has_moving_times(bool chooses) {
    RunOptions const& here = itself().scenario.options;
    for (std::size_t j = 0; j < number_.size(); ++j) {
      auto const& near = perturbed(j, 1).scenario;
      bool const same_steps = chooses || length_of_steps(near.options) == length_of_steps(here);
      if (near.options.end_time != here.end_time || near.start.t != itself().scenario.start.t || !same_steps)
        return true;
    }
    return false;
  }
  TimeMap const& times(std::size_t j) const { return n_.times(j); }  ///< times of the runs with perturbed parameter j
  /// Size of parameter j, or the step length h for `along_motion`.
  double size(std::size_t j, double h) const { return j == along_motion ? h : n_.parameter(j).size(); }

  /// Derivative of a number f(model) with respect to parameter j; exactly zero if the number does not change.
  template <class F>
  double of_number(std::size_t j, F const& f) {
    double const here = f(n_.itself());
    double sum = 0.0;
    for (std::size_t k = 0; k < points; ++k) sum += weight(j, k) * (f(n_.perturbed(j, k)) - here);
    return sum;
  }

  /// Derivative, with respect to parameter j, of the state that f(model, state, length) makes from the initial state of
  /// a model. The length of the next step is h, with the derivative dh.
  template <class F>
  State of_start(std::size_t j, double h, double dh, F const& f) {
    State const x = n_.itself().first();
    State sum;
    for (std::size_t k = 0; k < points; ++k) {
      State y = n_.perturbed(j, k).first();
      double const length = n_.length(j, k, x.t, h, y.t);
      take(sum, f, {n_.perturbed(j, k), std::move(y), length}, weight(j, k));
    }
    double const longer = dh - (n_.times(j).slope(x.t + h) - n_.times(j).slope(x.t));
    if (std::abs(longer) * size(j, h) <= negligible * h) return sum;
    double const reach = reach_of(j, h, std::abs(longer));
    for (std::size_t k = 0; k < points; ++k)
      take(sum, f, {n_.itself(), x, h + FourPoints::places[k] * reach * longer}, FourPoints::weights[k] / reach);
    return sum;
  }

  /// Derivative, with respect to parameter j, of the state that f(model, state, length) makes from x and the step
  /// length h. The derivative of x is `tangent`, and that of h is dh.
  template <class F>
  State of_map(std::size_t j, State const& x, RunSensitivity const& tangent, std::array<double, 2> h_and_dh,
               F const& f) {
    auto const [h, dh] = h_and_dh;
    Parts const p = parts(j, x, tangent, h, dh);
    State const& with = p.reach > 0.0 ? p.with : tangent.dx;
    State sum;
    if (j != along_motion)
      for (std::size_t k = 0; k < points; ++k) {
        State y = detail::displaced(x, with, FourPoints::places[k] * n_.parameter(j).distance());
        y.t = n_.times(j)(k, x.t);
        double const length = n_.length(j, k, x.t, h, y.t);
        take(sum, f, {n_.perturbed(j, k), std::move(y), length}, weight(j, k));
      }
    if (p.reach == 0.0) return sum;
    for (std::size_t k = 0; k < points; ++k) {
      double const e = FourPoints::places[k] * p.reach;
      State y = detail::displaced(x, p.along, e);
      StepHistory::lengths_of(y) += e * tangent.lengths;
      y.t += e * p.dt;
      take(sum, f, {n_.itself(), std::move(y), h + e * p.dh}, FourPoints::weights[k] / p.reach);
    }
    return sum;
  }

  /// Sets the state x for the following calls of `of_values`.
  void set_state(State const& x) { state_ = x; }
  /// Derivative of the vector f(model, state) at x with respect to parameter j. \param tangent derivative of x; \param
  /// h length of steps [s]
  template <class F>
  VecX of_values(std::size_t j, State const& x, RunSensitivity const& tangent, double h, F const& f) {
    Parts const p = parts(j, x, tangent, h, 0.0);
    State const& with = p.reach > 0.0 ? p.with : tangent.dx;
    VecX sum;
    auto const add_value = [&](VecX const& value, double by) {
      if (sum.size() == 0) sum.setZero(value.size());
      sum += by * value;
    };
    if (j != along_motion) {
      // If a coordinate changes by more than `largest_change`, model and state are differenced separately. The
      // distance for the state is then shorter.
      double const distance = n_.parameter(j).distance(), most = with.q.lpNorm<Eigen::Infinity>();
      bool const apart = most * distance > largest_change;
      for (std::size_t k = 0; k < points; ++k) {
        add_motion(state_, with, apart ? 0.0 : FourPoints::places[k] * distance, x);
        state_.t = n_.times(j)(k, x.t);
        add_value(f(n_.perturbed(j, k), state_), weight(j, k));
      }
      state_.t = x.t;
      for (std::size_t k = 0; apart && k < points; ++k) {
        add_motion(state_, with, FourPoints::places[k] * largest_change / most, x);
        add_value(f(n_.itself(), state_), FourPoints::weights[k] * most / largest_change);
      }
    }
    if (p.reach == 0.0) return sum;
    for (std::size_t k = 0; k < points; ++k) {
      double const e = FourPoints::places[k] * p.reach;
      add_motion(state_, p.along, e, x);
      state_.t = x.t + e * p.dt;
      add_value(f(n_.itself(), state_), FourPoints::weights[k] / p.reach);
    }
    return sum;
  }

  /// Begins another step: discards the stored derivatives of the equations.
  void begin_step() {
    derivatives_->forget();
    for (EquationDerivative& of : by_time_) of.scale = 0.0;
  }
  /// Evaluation point of a step: its end, or another point with equations to be solved.
  template <class X>
  struct PointInStep {
    X const& x;
    double h;            ///< length of the step [s]
    double dt;           ///< derivative of the time of x [s]
    std::size_t number;  ///< number of the point in the step, in ascending order
  };
  /// Stores in `sum` the derivatives of the equations r and Φ at a point with respect to parameter j. The unknowns are
  /// fixed; the time of the point changes with the parameter.
  template <class X>
  void of_equations(std::size_t j, PointInStep<X> const& at, EquationDerivative& sum) {
    auto const& [x, h, dt, number] = at;
    sum.balance.setZero(n_.itself().system.velocities());
    sum.rows.setZero(n_.itself().system.rows());
    sum.scale = size(j, h);
    double later = dt;
    if (j != along_motion && number_[j] != moving) {
      derivatives_->get(number_[j], x, number, sum);
    } else if (j != along_motion) {
      for (std::size_t k = 0; k < points; ++k)
        add(sum, n_.perturbed(j, k).equations(x, n_.times(j)(k, x.t)), weight(j, k));
      later -= n_.times(j).slope(x.t);
    }
    if (later == 0.0) return;
    if (number >= by_time_.size()) by_time_.resize(number + 1, {{}, {}, 0.0});
    EquationDerivative& by_time = by_time_[number];
    if (by_time.scale == 0.0) by_time = rate_of_equations(x, h);
    add(sum, by_time, later);
  }
  /// Subtracts μᵀ ∂(r, Φ)/∂p at x, an evaluation point of a step of length h, from the `derivatives` with respect to
  /// all parameters. \param mu (nv + rows) multipliers of the equations of motion, then of the constraint equations
  template <class X>
  void take_from(VecX& derivatives, X const& x, double h, VecX const& mu) {
    begin_step();
    derivatives_->evaluate(x);
    for (std::size_t i = 0; i < still_.size(); ++i) derivatives[Index(still_[i])] -= derivatives_->dot(i, mu);
    for (std::size_t j = 0; j < number_.size(); ++j)
      if (number_[j] == moving) derivatives[Index(j)] -= product(j, PointInStep<X>{x, h, 0.0, 0}, mu);
  }
  /// Product μᵀ ∂(r, Φ)/∂p of the derivatives that `of_equations` computes.
  template <class X>
  double product(std::size_t j, PointInStep<X> const& at, VecX const& mu) {
    of_equations(j, at, by_);
    Index const nv = by_.balance.size();
    return mu.head(nv).dot(by_.balance) + mu.tail(by_.rows.size()).dot(by_.rows);
  }
  /// \throws InvalidInput if a parameter changes, at x, an equation of objects outside its `affects`. Parameters that
  /// change the start time or a breakpoint are not checked.
  void require_named(State const& x) {
    for (std::size_t i = 0; i < still_.size(); ++i)
      derivatives_->require_named(i, n_.itself(), n_.perturbed(still_[i], 0), x);
  }

 private:
  static constexpr std::size_t points = FourPoints::places.size();
  static constexpr std::size_t moving = std::size_t(-1);
  static constexpr double negligible = 1e-13;  // neglected change of a time, relative to a step
  // Largest distance of differences along the motion, relative to a step. The outer points, at twice this distance,
  // remain before the next breakpoint: a step that does not end at the breakpoint ends at least 1 % of its length
  // before this breakpoint.
  static constexpr double largest_part = 4e-3;
  // Largest change of a coordinate in a difference of outputs [m, rad, 1]; a quaternion remains nearly of norm one.
  static constexpr double largest_change = 4e-3;

  struct Parts {
    State with, along;  // change at fixed time; change along the motion, empty if `reach` is 0
    double dt, dh;      // changes of time and step length along the motion
    double reach;       // distance of the differences along the motion; 0 if the whole change is at fixed time
  };
  struct Evaluation {
    V& variant;
    State x;
    double h;
  };

  double weight(std::size_t j, std::size_t k) const { return FourPoints::weights[k] / n_.parameter(j).distance(); }
  double reach_of(std::size_t j, double h, double longest) const {
    double const part = largest_part * h / longest;
    return j == along_motion ? part : std::min(part, n_.parameter(j).distance());
  }
  Parts parts(std::size_t j, State const& x, RunSensitivity const& tangent, double h, double dh) {
    if (j == along_motion) {
      double const longest = std::max({std::abs(tangent.dt), std::abs(dh), std::numeric_limits<double>::min()});
      return {{}, tangent.dx, tangent.dt, dh, reach_of(j, h, longest)};
    }
    double const s = n_.times(j).slope(x.t), dt = tangent.dt - s, longer = dh - (n_.times(j).slope(x.t + h) - s);
    double longest = std::max(std::abs(dt), std::abs(longer));
    if (tangent.lengths.size() > 0) longest = std::max(longest, tangent.lengths.cwiseAbs().maxCoeff());
    if (longest * size(j, h) <= negligible * h) return {{}, {}, dt, longer, 0.0};
    Parts out{tangent.dx, {}, dt, longer, 0.0};
    out.along = motion(x, dt, 1e-3 * h);
    add(out.with, out.along, -1.0);
    out.reach = reach_of(j, h, longest);
    return out;
  }
  /// Change of coordinates and velocities along the motion during the time dt. \param e distance of the differences [s]
  State motion(State const& x, double dt, double e) {
    State out = zeros_like(x);
    VecX ahead = x.q, back = x.q;
    VecX const there = e * x.v, here = -there;
    n_.itself().system.plus(x.q, there, ahead);
    n_.itself().system.plus(x.q, here, back);
    out.q = dt / (2.0 * e) * (ahead - back);
    out.v = dt * x.a;
    return out;
  }
  /// ∂r/∂t and ∂Φ/∂t at a point of a step, by backward differences of fourth order [Fornberg 1988] over 0.08 h before
  /// the point. These times lie within the step, because the first point of every method is later than 0.15 h.
  template <class Place>
  EquationDerivative rate_of_equations(Place const& x, double h) {
    constexpr std::array<double, 5> weights{25.0 / 12.0, -4.0, 3.0, -4.0 / 3.0, 0.25};
    double const e = 0.02 * h;
    EquationDerivative sum = zero_derivative();
    for (std::size_t i = 0; i < weights.size(); ++i)
      add(sum, n_.itself().equations(x, x.t - double(i) * e), weights[i] / e);
    return sum;
  }

  EquationDerivative zero_derivative() {
    System const& s = n_.itself().system;
    return {VecX::Zero(s.velocities()), VecX::Zero(s.rows())};
  }
  static void add(EquationDerivative& sum, EquationDerivative const& of, double by) {
    sum.balance += by * of.balance;
    sum.rows += by * of.rows;
  }
  static void add(State& sum, State const& of, double by) { detail::add(sum, of, by); }
  template <class F>
  static void take(State& sum, F const& f, Evaluation of, double by) {
    f(of.variant, of.x, of.h);
    if (sum.q.size() == 0) sum = zeros_like(of.x);
    add(sum, of.x, by);
  }

  NearbyModels<V> n_;
  std::vector<std::size_t> number_, still_;  // index of each parameter in `still_`; parameters without moving times
  std::optional<EquationDerivatives<V>> derivatives_;  // with respect to the parameters in `still_`
  std::vector<EquationDerivative> by_time_;  // time derivatives at each point of a step; scale 0: not yet computed
  State state_;
  EquationDerivative by_;
};

}  // namespace polybody::detail
