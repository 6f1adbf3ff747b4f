#pragma once
/// \file
/// A run that takes its derivatives along, step by step.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <polybody/gradients/sensitivities_report.hpp>
#include <polybody/gradients/variants_beside.hpp>

namespace polybody {

namespace detail {

/// A run and its derivatives, step by step, as `Simulation` takes the steps.
template <class Make, class I>
class DirectDifferentiation {
  using S = std::remove_cvref_t<decltype(std::declval<Make const&>()(std::declval<std::span<double const>>()))>;
  using Variants = VariantsBeside<S, I>;
  using V = Variant<S, I>;

 public:
  [[gnu::cold]] DirectDifferentiation(Make const& make, std::vector<Parameter> const& parameters,
                                      AlphaMethod const& method)
      : parameters_(parameters),
        whole_(make(values_of(parameters)), method),
        slope_(whole_.scenario.model, whole_.system, method),
        beside_(make, parameters, method) {
    require_plain(whole_.scenario);
  }

  Sensitivities run() {
    options().check(whole_.scenario.start.t);
    require_assembled_start(whole_);
    x_ = whole_.first();
    h_ = whole_.length();
    std::vector<double> const corners = whole_.corners();
    plan_ = StepPlan(x_.t, options().until, options().step, Sequence<double>(corners.begin(), corners.end()));
    x_.t = plan_.pass(x_.t);
    begin();
    beside_.require_touched(x_);
    note();
    while (!done()) {
      step();
      note();
    }
    beside_.require_touched(x_);
    warn_of_untouched(parameters_, touched_, out_.run);
    return std::move(out_);
  }

 private:
  /// A direction along which a step is differentiated: a parameter, what it does, and the slope of the step's length.
  struct Lane {
    std::size_t j;
    RunTangent* tangent;
    double dh;
  };

  static void require_plain(S const& scenario) {
    RunOptions const& o = scenario.options;
    if (o.halvings > 0 || o.minimum_norm)
      throw InvalidInput(
          "sensitivities: a run with halved steps or multipliers of least norm is not differentiated. Leave them out "
          "of the options.");
  }
  RunOptions const& options() const { return whole_.scenario.options; }
  bool done() const { return out_.run.stopped || x_.t >= options().until; }

  void begin() {
    touched_.assign(parameters_.size(), 0);
    for (Parameter const& p : parameters_) out_.parameters.push_back(p.name);
    for (auto const& o : whole_.scenario.outputs) out_.outputs.push_back(o.name);
    for (std::size_t j = 0; j < parameters_.size(); ++j) {
      tangents_.push_back({zeros_like(x_), beside_.of_number(j, [](V const& v) { return v.scenario.start.t; }), {}});
      step_slope_.push_back(beside_.of_number(j, [](V const& v) { return v.length(); }));
      until_slope_.push_back(beside_.of_number(j, [](V const& v) { return double(v.scenario.options.until); }));
    }
    if (!options().events.empty()) watch_.start(options().events, x_, seen());
    start([&](std::size_t j, double h, double dh, auto const& f) { return beside_.of_start(j, h, dh, f); }, {});
  }
  /// Makes x_ a start, after some events act on it, with all tangents. \param differenced (parameter, length of the
  /// next step, its slope, map) gives the derivative of the map
  template <class Differenced>
  void start(Differenced const& differenced, std::vector<std::size_t> const& acting) {
    StepPlan::Next const next = done() ? StepPlan::Next{x_.t, h_, false, false} : plan_.next(x_.t, h_);
    State fresh = x_;
    if (!acting.empty()) {
      fresh = whole_.shown(x_);
      watch_.act(options().events, fresh);
      fresh = stepped_state(whole_, std::move(fresh));
    }
    whole_.start(fresh, next.h);
    bool const corrected = fresh.memory[fresh.memory.size() - 2] > 0.0;
    auto const map = [&](V& v, State& y, double h) {
      if (!acting.empty()) y = after(v, acting, y);
      v.start(y, h, corrected);
    };
    for (std::size_t j = 0; j < parameters_.size(); ++j) {
      RunTangent& tangent = tangents_[j];
      tangent.dx = differenced(j, next.h, length_slope(j, next, tangent), map);
      tangent.lengths = tangent.dx.memory.tail(StepHistory::lengths);
      tangent.dx.memory.tail(StepHistory::lengths) = fresh.memory.tail(StepHistory::lengths);
    }
    x_ = std::move(fresh);
  }
  /// What acting events make of a state of a variant.
  static State after(V& v, std::vector<std::size_t> const& acting, State const& x) {
    State y = v.shown(x);
    for (std::size_t const i : acting) v.scenario.options.events[i].then(y);
    y.t = x.t;
    return stepped_state(v, std::move(y));
  }
  /// The slope of the length of the next step.
  double length_slope(std::size_t j, StepPlan::Next const& next, RunTangent const& from) const {
    if (!next.lands) return step_slope_[j];
    return (next.jumps ? beside_.times(j).slope(next.target) : until_slope_[j]) - from.dt;
  }

  /// A step to the next place of the plan, or to an event before it.
  void step() {
    State& before = before_;
    before = x_;
    StepPlan::Next const next = plan_.next(x_.t, h_);
    bool const crumb = next.h < 0.01 * h_;
    StepReport const report = whole_.step(x_, next.h);
    x_.t = next.lands ? next.target : row_.after(before.t, next.h);
    State far;
    if (!options().events.empty()) far = x_;
    bool const met = !options().events.empty() && meet(before, next.h);
    double const end = x_.t, h = met ? StepHistory(x_).shifted() : next.h;
    x_.t = before.t + h;  // just before a corner
    lanes_.clear();
    for (std::size_t j = 0; j < parameters_.size(); ++j)
      lanes_.push_back({j, &tangents_[j], met ? 0.0 : length_slope(j, next, tangents_[j])});
    RunTangent by_length;
    if (met) {
      if (next.lands && end == next.target) refuse_event_at_corner();
      by_length = {zeros_like(before), 0.0, VecX::Zero(StepHistory::lengths)};
      by_length.dx.memory.tail(StepHistory::lengths) = before.memory.tail(StepHistory::lengths);
      lanes_.push_back({Variants::along_motion, &by_length, 1.0});
    }
    differentiate(before, h, met);
    if (met) move_to_event(by_length, before, far);
    x_.t = end;
    bool const at_corner = next.jumps && end == next.target;
    if (at_corner) x_.t = plan_.pass(end);
    if (at_corner) require_one_end();
    if (met || at_corner || crumb) restart(met);
    out_.run.add(report);
  }
  void restart(bool met) {
    State const x = x_;
    std::vector<std::size_t> acting;
    for (std::size_t i = 0; met && i < options().events.size(); ++i)
      if (watch_.met(i) && options().events[i].then) acting.push_back(i);
    start([&](std::size_t j, double h, double dh,
              auto const& f) { return beside_.of_map(j, x, tangents_[j], {h, dh}, f); },
          acting);
  }
  /// A corner at the end of the run ends it for nearby parameters too.
  void require_one_end() const {
    if (x_.t < options().until) return;
    for (std::size_t j = 0; j < parameters_.size(); ++j)
      if (std::abs(tangents_[j].dt - until_slope_[j]) * parameters_[j].size() > 1e-9 * h_)
        throw InvalidInput{"sensitivities: a corner at the end of the run, t = ", x_.t, " s, moves with \"",
                           parameters_[j].name,
                           "\", and the end does not: there is no derivative there. End the run a step before or "
                           "after."};
  }
  [[noreturn, gnu::cold]] void refuse_event_at_corner() const {
    throw InvalidInput{"sensitivities: at t = ", x_.t,
                       " s there is an event, and a corner or the end of the run: there is no derivative there. Move "
                       "one of them by a step."};
  }

  EventWatch::Seen seen() {
    return [this](State const& x) -> State const& { return whole_.shown(x); };
  }
  bool meet(State const& before, double h) {
    EventWatch::Step const again = [this](State& x, double part) { return whole_.step(x, part).taken; };
    return watch_.meet(options().events, {before, h, seen(), again}, x_, out_.run);
  }
  /// Adds to the derivatives at the end of a step of fixed length what the event's time does: the value stays zero.
  void move_to_event(RunTangent const& by_length, State const& before, State const& far) {
    std::vector<double> dh(parameters_.size());
    std::string const* first = nullptr;
    beside_.show(x_);
    for (std::size_t i = 0; i < options().events.size(); ++i) {
      if (!watch_.met(i)) continue;
      Event const& event = options().events[i];
      auto const value = [i](V& v, State const& x) {
        return VecX::Constant(1, v.scenario.options.events[i].value(v.shown(x))).eval();
      };
      double const rate = beside_.of_values(Variants::along_motion, x_, by_length, h_, value)[0],
                   most =
                       std::max(std::abs(event.value(whole_.shown(before))), std::abs(event.value(whole_.shown(far))));
      if (!(std::abs(rate) * (far.t - before.t) > 1e-6 * most)) refuse_touch(event);
      for (std::size_t j = 0; j < parameters_.size(); ++j) {
        double const own = -beside_.of_values(j, x_, tangents_[j], h_, value)[0] / rate;
        if (first && std::abs(own - dh[j]) > 1e-6 * (std::abs(own) + h_ / parameters_[j].size()))
          throw InvalidInput{"sensitivities: the events \"",
                             *first,
                             "\" and \"",
                             event.name,
                             "\" are met at once at t = ",
                             x_.t,
                             " s and part with \"",
                             parameters_[j].name,
                             "\": there is no derivative there. Look for one of them."};
        if (!first) dh[j] = own;
      }
      first = &event.name;
    }
    for (std::size_t j = 0; j < parameters_.size(); ++j) {
      add(tangents_[j].dx, by_length.dx, dh[j]);
      tangents_[j].dt += dh[j];
    }
  }
  [[noreturn, gnu::cold]] void refuse_touch(Event const& event) const {
    throw InvalidInput{"sensitivities: the event \"", event.name, "\" only touches zero at t = ", x_.t,
                       " s, so its time has no derivative. Look for a value that passes through zero at a rate."};
  }

  /// The tangents before a step of h that led from `before` to x_ become those at its end. \param met an event: other
  /// steps were tried after it
  void differentiate(State& before, double h, bool met) {
    V& spare = beside_.itself();
    bool const corrects = spare.method.set_out(spare.system, before, h, spare.work);
    State corrected;
    if (corrects) {
      corrected = before;
      corrected.v = spare.work.v0;
    }
    own_before_ = spare.work.a0;
    own_after_ = x_.memory.head(x_.v.size());
    for (Lane const& lane : lanes_) set_out(before, h, lane, corrects);
    StepEnds const step{corrects ? corrected : before, x_, own_before_, own_after_, h};
    slope_.set(step, met ? nullptr : whole_.factors(h));
    beside_.set_end(x_);
    constexpr std::size_t most = std::size_t(AlphaStepSlope<>::lanes);
    directions_.resize(std::min(lanes_.size(), most));
    for (std::size_t first = 0, count; first < lanes_.size(); first += count) {
      count = std::min(first == 0 ? most - 1 : most, lanes_.size() - first);
      for (std::size_t l = 0; l < count; ++l) {
        Lane const& lane = lanes_[first + l];
        lane.tangent->dt += lane.dh;
        beside_.of_equations(lane.j, x_, h, lane.tangent->dt, directions_[l].by);
        directions_[l].dx = &lane.tangent->dx;
        directions_[l].dh = lane.dh;
      }
      double const left = slope_.advance(step, std::span(directions_).first(count));
      out_.left = std::max(out_.left, require_converged(left, x_.t, "sensitivities"));
    }
    for (Lane const& lane : lanes_) push_length(*lane.tangent, lane.dh);
  }
  /// The tangent of the speeds, and of the method's own accelerations, that a step from x sets out with.
  void set_out(State const& x, double h, Lane const& lane, bool corrects) {
    RunTangent& tangent = *lane.tangent;
    double const shifted = x.memory[x.memory.size() - 1];
    if (!corrects && (shifted == 0.0 || lane.dh == tangent.lengths[StepHistory::lengths - 1])) return;
    Index const nv = x.v.size();
    std::optional<bool> decided;
    if (std::abs(h - shifted) > 1e-9 * h) decided = corrects;
    State const change = beside_.of_map(lane.j, x, tangent, {h, lane.dh}, [&](V& v, State& y, double length) {
      (void)v.method.set_out(v.system, y, length, v.work, decided);
      y.v = v.work.v0 - y.v;
      y.memory.head(nv) = v.work.a0 - y.memory.head(nv);
    });
    tangent.dx.v += change.v;
    tangent.dx.memory.head(nv) += change.memory.head(nv);
  }
  /// As `StepHistory::push` does with a length.
  static void push_length(RunTangent& tangent, double dh) {
    constexpr Index last = StepHistory::lengths - 1;
    for (Index i = 0; i + 1 < last; ++i) tangent.lengths[i] = tangent.lengths[i + 1];
    tangent.lengths[last - 1] = tangent.lengths[last] = dh;
  }

  /// Values and slopes of the outputs at x.
  void note() {
    beside_.show(x_);
    MatX slopes = MatX::Zero(Index(out_.outputs.size()), Index(parameters_.size()));
    VecX of_time(Index(parameters_.size()));
    auto const outputs = [](V& v, State const& x) { return v.outputs(x); };
    for (std::size_t j = 0; j < parameters_.size(); ++j) {
      RunTangent const& tangent = tangents_[j];
      State const& dx = tangent.dx;
      of_time[Index(j)] = tangent.dt;
      slopes.col(Index(j)) = beside_.of_values(j, x_, tangent, h_, outputs);
      if (!touched_[j])
        touched_[j] = std::abs(tangent.dt) > 0.0 || !slopes.col(Index(j)).isZero(0.0) ||
                      dx.q.squaredNorm() + dx.v.squaredNorm() + dx.a.squaredNorm() > 0.0;
    }
    out_.times.push_back(x_.t);
    out_.values.push_back(whole_.outputs(x_));
    out_.slopes.push_back(std::move(slopes));
    out_.time_slopes.push_back(std::move(of_time));
  }

  std::vector<Parameter> parameters_;
  V whole_;
  AlphaStepSlope<> slope_;
  Variants beside_;
  State x_, before_;             // now, and before the step
  VecX own_before_, own_after_;  // the method's own accelerations there
  std::vector<Lane> lanes_;      // of the step
  std::vector<StepDirection> directions_;
  std::vector<RunTangent> tangents_;  // of each parameter
  std::vector<double> step_slope_, until_slope_;
  StepPlan plan_;
  StepRow row_;
  EventWatch watch_;
  double h_ = 0.0;
  std::vector<char> touched_;
  Sensitivities out_;
};

}  // namespace detail
}  // namespace polybody
