#pragma once
/// \file
/// Work of forces, drives and compliant joints without a potential, step by step.
/// Theory: Eq. 11.8.

#include <algorithm>
#include <cmath>

#include <polybody/math/sequence.hpp>
#include <polybody/math/types.hpp>
#include <polybody/system/system.hpp>

namespace polybody::detail {

// Work of a force and a moment over a step, from their values at both ends.

/// Rotation vector (3) from axes `a0` to `a1` (3×3 by columns), in world axes [rad]. The number of full revolutions
/// agrees with `mean` (3), the rotation by the mean angular velocity [rad].
inline Vec3 turn_between(double const* a0, double const* a1, Vec3 const& mean) {
  Vec3 s = Vec3::Zero();
  double trace = 0.0;
  for (int c = 0; c < 3; ++c) {
    double const *const x = a0 + 3 * c, *const y = a1 + 3 * c;
    for (int i = 0; i < 3; ++i) {
      int const j = (i + 1) % 3, k = (i + 2) % 3;
      s[i] += 0.5 * (x[j] * y[k] - x[k] * y[j]);
      trace += x[i] * y[i];
    }
  }
  double const sine = s.norm(), angle = std::atan2(sine, 0.5 * (trace - 1.0));
  if (!(sine > 1e-9)) return angle < 1.0 && mean.norm() < 3.0 ? s : mean;
  constexpr double turn = 6.283185307179586;
  double const turns = std::round((mean.dot(s) / sine - angle) / turn);
  return s * ((angle + (std::isfinite(turns) ? turns : 0.0) * turn) / sine);
}

/// ½ (f₀ + f₁)·Δr + ½ (m₀ + m₁)·Δφ [J] of an applied wrench over a step of length h [s]. x and y contain r, A, [f; m]
/// and ω of its marker at the beginning and the end of the step.
inline double work_along_path(double const* x, double const* y, double h) {
  double work = 0.0;
  bool turns = false;
  for (int i = 0; i < 3; ++i) {
    work += 0.5 * (x[12 + i] + y[12 + i]) * (y[i] - x[i]);
    turns = turns || x[15 + i] != 0.0 || y[15 + i] != 0.0;
  }
  if (!turns) return work;
  Vec3 mean;
  for (int i = 0; i < 3; ++i) mean[i] = 0.5 * h * (x[18 + i] + y[18 + i]);
  Vec3 const turn = turn_between(x + 3, y + 3, mean);
  for (int i = 0; i < 3; ++i) work += 0.5 * (x[15 + i] + y[15 + i]) * turn[i];
  return work;
}

}  // namespace polybody::detail

namespace polybody {

/// End of a step of length h that is not yet accepted.
struct StepResult {
  VecX const &q, &v, &lambda;  ///< q (nq), v (nv), λ (rows) at the end
  double t, h;                 ///< time of the end [s], length of the step [s]
};

/// Signed work [J] of each element since the start of an account, by two quadratures over each step:
///   along the path, ½ (f₀ + f₁)·Δr: exact for a force that is linear in the position, at any step length;
///   over time, ½ h (P₀ + P₁): never positive for a damper, at any step length.
/// If the step does not resolve a spring or a damper, one of the two quadratures finds no work input. An energy gain
/// due to such an element therefore remains unexplained. Both quadratures have an error of O(h²). The error of the
/// quadrature along the path is estimated by comparison of two steps with one step of twice the length [Richardson
/// 1911]. The estimate is zero for a force that is linear in the position, and large for a force that jumps. Elements
/// with a potential are not counted, except the power that first-order states dissipate. `add` does not allocate
/// memory.
class WorkAccount {
 public:
  /// Restarts the account at `place`, the last evaluated state of `system`. `place.h` is not read.
  template <class = void>
  [[gnu::cold]] void begin(System const& system, StepResult const& place);
  /// Adds the work over a step. `system` must be evaluated at the end of the step.
  template <class = void>
  void add(System const& system, StepResult const& end);

  bool counts() const { return !elements_.empty(); }  ///< true if the account contains an element
  bool complete() const { return complete_; }         ///< true if no counted element can store energy

  /// True if a joint whose work is not counted has a prescribed rate Φ_t ≠ 0.
  bool misses_drives(Data<double> const& data) const {
    return std::any_of(at_rest_.begin(), at_rest_.end(), [&](Index i) {
      ConstraintBlock<double> const& block = data.rows[std::size_t(i)];
      return std::any_of(block.rate, block.rate + block.rows, [](double x) { return x != 0.0; });
    });
  }
  /// Σ max(0, W) over the elements, with the smaller W of the two quadratures [J].
  double put_in() const {
    double sum = 0.0;
    double const* const work = samples_[last_].work.data();
    for (std::size_t i = 0; i < 2 * sums_; i += 2) sum += std::max(0.0, std::min(work[i], work[i + 1]));
    return sum;
  }
  /// Sum of the signed work of all elements along the path [J].
  double net() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < 2 * sums_; i += 2) sum += samples_[last_].work[i];
    return sum;
  }

  double doubt() const { return samples_[last_].doubt; }  ///< estimated error of `net` [J]
  double worst() const { return samples_[last_].worst; }  ///< largest estimated error of one step [J]

  void drop_last() { last_ = samples_[last_].before; }  ///< discards the last step
  void mark() { marked_ = last_; }                      ///< begins a trial step
  void go_back() { last_ = marked_; }                   ///< discards the trial step

 private:
  enum class Kind : unsigned char { force, drive, compliant, states };
  struct Element {
    Kind kind;
    Index index, row;     ///< index of the wrench, block or force; index of its λ, −1 for a compliant joint
    std::size_t at, sum;  ///< index of its first number in a sample; index of its work
  };
  /// Wrenches, motions and powers of the elements at an instant, and their work up to this instant.
  struct Sample {
    double t = 0.0, doubt = 0.0, worst = 0.0;  ///< [s], [J], [J]
    std::size_t before = 0;  ///< index of the sample at the beginning of the step, or of this sample if there is none
    Sequence<double> numbers, work;
  };
  static constexpr std::size_t numbers_of_force = 23;  ///< r, A, [f; m], ω, work of the last step, power

  void add_element(Kind kind, Index index, Index row, std::size_t numbers, bool joins) {
    std::size_t const sum = joins && !elements_.empty() ? elements_.back().sum : sums_++;
    elements_.push_back({kind, index, row, size_, sum});
    size_ += numbers;
  }
  /// Sample at time t, the beginning of a step of length h; null if there is none.
  Sample const* start_of(double t, double h) const {
    for (std::size_t const k : {last_, marked_})
      if (std::abs(samples_[k].t - t) <= 1e-3 * h) return &samples_[k];
    return nullptr;
  }
  /// Index of the last number of an element.
  static std::size_t last_number(Element const& e, System const& system) {
    if (e.kind == Kind::force) return numbers_of_force - 1;
    return e.kind == Kind::drive || e.kind == Kind::states
               ? 0
               : std::size_t(2 * system.data().rows[std::size_t(e.index)].rows);
  }
  template <class = void>
  void read(System const& system, VecX const& lambda, double t, Sample& out) const;

  Sequence<Element> elements_;
  Sequence<Index> at_rest_;  // blocks without a prescribed motion and with Φ_t = 0 at the start: not counted
  std::size_t size_ = 0, sums_ = 0;
  Sample samples_[4];  // last step, step before it, start of the trial step, next step
  std::size_t last_ = 0, marked_ = 0;
  bool complete_ = true;
};

template <class>
void WorkAccount::begin(System const& system, StepResult const& place) {
  Data<double> const& data = system.data();
  ModelLayout const& layout = system.layout();
  elements_.clear();
  at_rest_.clear();
  size_ = sums_ = 0;
  complete_ = true;
  Index source = -1;
  for (std::size_t i = 0; i < data.actions.size(); ++i) {
    ForceLayout const& force = layout.forces[std::size_t(data.actions[i].source)];
    if (force.stores) continue;
    add_element(Kind::force, Index(i), 0, numbers_of_force, data.actions[i].source == source);
    source = data.actions[i].source;
    complete_ = complete_ && !force.stores_in_part;
  }
  for (std::size_t i = 0; i < layout.forces.size(); ++i)
    if (layout.forces[i].dissipation) add_element(Kind::states, Index(i), -1, 1, false);
  Coordinates const& reduced = system.step_coordinates();
  for (std::size_t i = 0; i < data.rows.size(); ++i) {
    ConstraintBlock<double> const& block = data.rows[i];
    if (block.source == ConstraintSource::compliant && !layout.joints[std::size_t(block.owner)].stores) {
      add_element(Kind::compliant, Index(i), -1, std::size_t(2 * block.rows + 1), false);
      complete_ = false;
    }
    if (!block.rate) continue;
    bool const driven = (block.source == ConstraintSource::joint || block.source == ConstraintSource::compliant) &&
                        layout.joints[std::size_t(block.owner)].law;
    if (!driven && std::all_of(block.rate, block.rate + block.rows, [](double x) { return x == 0.0; })) {
      at_rest_.push_back(Index(i));
      continue;
    }
    Index row = block.row;
    if (reduced && row >= 0) {
      auto const& stay = reduced.reduced->remaining_equations;
      auto const at = std::find(stay.begin(), stay.end(), row);
      if (at == stay.end()) continue;
      row = at - stay.begin();
    }
    add_element(Kind::drive, Index(i), row, 1, false);
  }
  for (Sample& sample : samples_) {
    sample.numbers.assign(size_, 0.0);
    sample.work.assign(2 * sums_, 0.0);
    sample.t = place.t;
    sample.doubt = sample.worst = 0.0;
    sample.before = std::size_t(&sample - samples_);
  }
  last_ = marked_ = 0;
  read(system, place.lambda, place.t, samples_[0]);
}

/// Reads the numbers of the elements. The last number of an element is its power: w · twist of a force, λ · Φ_t of a
/// drive, −λ · ġ of a compliant joint, minus the dissipated power of states.
template <class>
void WorkAccount::read(System const& system, VecX const& lambda, double t, Sample& out) const {
  Data<double> const& data = system.data();
  out.t = t;
  for (Element const& e : elements_) {
    double* const to = out.numbers.data() + e.at;
    if (e.kind == Kind::states) {
      ForceLayout const& force = system.layout().forces[std::size_t(e.index)];
      to[0] = -force.dissipation(force, t, data);
      continue;
    }
    if (e.kind == Kind::force) {
      AppliedWrench<double> const& action = data.actions[std::size_t(e.index)];
      Frame<double> const& f = data.markers[std::size_t(action.marker)].frame;
      double power = 0.0;
      for (int i = 0; i < 3; ++i) {
        to[i] = f.r[i];
        to[18 + i] = f.w[i];
        power += action.w[i] * f.v[i] + action.w[3 + i] * f.w[i];
      }
      std::copy_n(f.A.data(), 9, to + 3);
      std::copy_n(action.w, 6, to + 12);
      to[22] = power;
      continue;
    }
    ConstraintBlock<double> const& block = data.rows[std::size_t(e.index)];
    double power = 0.0;
    if (e.kind == Kind::drive) {
      double const* const l = e.row < 0 ? block.answer : lambda.data() + e.row;
      for (int k = 0; k < block.rows; ++k) power += l[k] * block.rate[k];
      to[0] = power;
      continue;
    }
    double rate[6];
    for (int k = 0; k < block.rows; ++k) rate[k] = block.rate ? block.rate[k] : 0.0;
    detail::add_rate(block.a, block.rows, data, lambda, rate);
    detail::add_rate(block.b, block.rows, data, lambda, rate);
    for (int k = 0; k < block.rows; ++k) {
      to[k] = block.g[k];
      to[block.rows + k] = block.answer[k];
      power -= block.answer[k] * rate[k];
    }
    to[2 * block.rows] = power;
  }
}

template <class>
void WorkAccount::add(System const& system, StepResult const& end) {
  Sample const* const from = start_of(end.t - end.h, end.h);
  Sample const& before = from ? *from : samples_[last_];
  std::size_t const at = std::size_t(&before - samples_), older = before.before;
  std::size_t next = 0;
  while (next == marked_ || next == at || next == older) ++next;
  Sample& to = samples_[next];
  to.doubt = before.doubt;
  to.before = from ? at : next;
  std::copy_n(before.work.data(), before.work.size(), to.work.data());
  read(system, end.lambda, end.t, to);
  double const both = end.t - samples_[older].t;
  bool const compares = from && older != at && samples_[older].t < before.t;
  for (Element const& e : elements_) {
    double const *const x = before.numbers.data() + e.at, *const w = samples_[older].numbers.data() + e.at;
    double* const y = to.numbers.data() + e.at;
    std::size_t const last = last_number(e, system);
    double const over_time = from ? 0.5 * end.h * (x[last] + y[last]) : end.h * y[last];
    if (over_time == 0.0 && e.kind == Kind::drive) continue;
    double along_path = over_time, doubt = 0.0;
    if (e.kind == Kind::force && from) {
      y[21] = along_path = detail::work_along_path(x, y, end.h);
      if (compares) doubt = detail::work_along_path(w, y, both) - x[21] - y[21];
    } else if ((e.kind == Kind::drive || e.kind == Kind::states) && compares) {
      doubt = 0.5 * (both * (w[last] + y[last]) - (both - end.h) * (w[last] + x[last])) - over_time;
    } else if (e.kind == Kind::compliant && from) {
      along_path = 0.0;
      for (std::size_t k = 0, m = last / 2; k < m; ++k) along_path -= 0.5 * (x[m + k] + y[m + k]) * (y[k] - x[k]);
    }
    // Other code refuses a force that is not finite.
    if (!std::isfinite(over_time) || !std::isfinite(along_path)) continue;
    to.work[2 * e.sum] += along_path;
    to.work[2 * e.sum + 1] += over_time;
    if (std::isfinite(doubt)) to.doubt += 0.5 * std::abs(doubt);
  }
  to.worst = std::max(before.worst, to.doubt - before.doubt);
  last_ = next;
}

}  // namespace polybody
