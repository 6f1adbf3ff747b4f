#pragma once
/// \file
/// Adams predictor–corrector method of variable order and step: `AdamsBashforthMoulton`, with the past points that it
/// stores in a state: `AdamsHistory`.
/// Theory: Eqs. 6.28 to 6.30.

#include <array>

#include <polybody/integrators/error_tolerance.hpp>
#include <polybody/integrators/stabilisation.hpp>
#include <polybody/math/element_functions.hpp>
#include <polybody/system/state.hpp>
#include <polybody/system/system.hpp>

namespace polybody {

/// Divided differences D_j = f[t₀, t₋₁, …, t₋ⱼ] of y˙ = f(t, y) over the last points, for y of n entries. They are
/// stored in the history of a state, so a copy of the state includes them:
///   [D₀ … D₁₂ | lengths of the last 12 steps, the last one first | known points | order | 1 while the order rises].
class AdamsHistory {
 public:
  static constexpr int highest = 12;  ///< highest order

  /// Resets `memory` to order 1 and a single point, the present one, with y˙ = f.
  static void reset(VecX& memory, VecX const& f) {
    memory.resize((highest + 1) * f.size() + highest + 3);
    std::fill_n(memory.data(), memory.size() - 3, 0.0);
    std::copy_n(f.data(), f.size(), memory.data());
    std::fill_n(memory.data() + memory.size() - 3, 3, 1.0);
  }

  /// Access to the history in the `memory` of a state for y of n entries. `reset` must have been called for `memory`.
  /// \throws InvalidInput if `memory` has another size.
  AdamsHistory(VecX& memory, Index n) : memory_(memory), n_(n) {
    if (memory.size() != (highest + 1) * n + highest + 3)
      throw InvalidInput("state.no_history",
                         {"The state has no integrator history. Call method.start(system, x, h, w) before step()."});
  }

  /// D_j (n entries), j ≤ 12.
  double* difference(int j) const { return memory_.data() + j * n_; }
  /// Number of known points including the present one, 1 to 13, stored as a floating-point number.
  double& known() const { return memory_[memory_.size() - 3]; }
  /// Order k of the next step.
  double& order() const { return memory_[memory_.size() - 2]; }
  /// 1 while the order rises after a start, otherwise 0.
  double& rising() const { return memory_[memory_.size() - 1]; }

  /// t₀ − t₋ⱼ [s] for j < `known`, otherwise 0.
  std::array<double, highest + 2> ages() const {
    std::array<double, highest + 2> age{};
    for (int j = 1; j < int(known()); ++j) age[std::size_t(j)] = age[std::size_t(j - 1)] + length(j - 1);
    return age;
  }

  /// Advances by a step h to a point with y˙ = f: D′₀ = f, D′ⱼ₊₁ = (D′ⱼ − Dⱼ)/(h + t₀ − t₋ⱼ).
  void push(double h, VecX const& f) {
    auto const age = ages();
    int const points = int(known());
    for (Index c = 0; c < n_; ++c) {
      double carry = f[c];
      for (int j = 0; j <= std::min(points, highest); ++j) {
        double& d = difference(j)[c];
        double const next = j < points ? (carry - d) / (h + age[std::size_t(j)]) : 0.0;
        d = carry;
        carry = next;
      }
    }
    for (int j = highest - 1; j > 0; --j) length(j) = length(j - 1);
    length(0) = h;
    known() = std::min(points, highest) + 1;
  }

  /// Weights c_j = ∫₀ʰ Π_{i<j} (τ + t₀ − t₋ᵢ) dτ for j ≤ 13, with t₀ − t₋ᵢ from `age` [s]. The seven-point Gauss rule
  /// is exact for degree 13, and all its terms are positive.
  static std::array<double, highest + 2> weights(double h, std::array<double, highest + 2> const& age) {
    std::array<double, highest + 2> c{};
    for (GaussPoint const& p : gauss<7>) {
      double term = p.weight * h;
      for (std::size_t j = 0; j < c.size(); ++j) {
        c[j] += term;
        term *= p.xi * h + age[j];
      }
    }
    return c;
  }

 private:
  double& length(int j) const { return memory_[(highest + 1) * n_ + j]; }

  VecX& memory_;
  Index n_;
};

/// Adams predictor–corrector method with variable order k = 1 … 12 and variable step, in PECE mode [Shampine & Gordon
/// 1975; Hairer, Nørsett & Wanner 1993, §III.5]. With y = (q, v), the divided differences D_j of past values of y˙ and
/// weights c_j (both in `AdamsHistory`), and T_j = h + t₀ − t₋ⱼ, a step computes
///   p = y₀ + Σ_{j<k} c_j D_j,   D*₀ = y˙(p),  D*ⱼ₊₁ = (D*ⱼ − D_j)/T_j,   y₁ = p + c_k D*_k.
/// The error estimate of order j is |c_j − c_{j−1} T_{j−1}| ‖D*_j‖. The result y₁ has order k + 1. A step needs two
/// evaluations, and one more for each rejected trial. Coordinates on a manifold are integrated component by component,
/// with q˙ from `coordinate_rates`, and then normalised by ⊞ 0. The estimate covers all coordinates and velocities.
/// With `CoordinatePartitioning` it thus also limits the error of dependent ones, which the thesis (§3.3.1) does not
/// integrate.
template <class Stabilisation = UnconstrainedOnly>
struct AdamsBashforthMoulton {
  static constexpr char const* name = "AdamsBashforthMoulton";
  static constexpr int order = AdamsHistory::highest;  ///< highest order
  static constexpr bool accepts_constraints = Stabilisation::accepts_constraints;
  static constexpr bool adaptive_step = true;
  static constexpr Capabilities capabilities = Capabilities::coordinate_rates;

  double relative_tolerance = 1e-8;   ///< relative to the scale of each kind of unknown, as in `DormandPrince`
  double absolute_tolerance = 1e-10;  ///< added to the relative part, in the unit of the unknown
  double min_step = 1e-12;            ///< smallest permitted step [s]
  int max_order = order;              ///< highest permitted order, in [1, 12]
  Stabilisation stabilisation = {};   ///< constraint stabilisation

  /// \throws InvalidInput unless the tolerances and `min_step` are positive and finite, `max_order` is in [1, 12], and
  /// the options of `stabilisation` are valid.
  void check() const {
    require_positive(relative_tolerance, "AdamsBashforthMoulton: the relative tolerance");
    require_positive(absolute_tolerance, "AdamsBashforthMoulton: the absolute tolerance");
    require_positive(min_step, "AdamsBashforthMoulton: the smallest step");
    if (max_order < 1 || max_order > order)
      throw InvalidInput("integrator.option", {ErrorObject{"AdamsBashforthMoulton"},
                                               ": max_order must lie in [1, 12], but is ", ErrorValue{max_order}, "."});
    stabilisation.check();
  }

  /// Memory of a step, allocated once.
  template <class Solver>
  struct Workspace {
    VecX y, f, correction;                    ///< y = (q, v), y˙ and the correction c_k D*_k
    VecX raw, q, v, a, lambda, zero;          ///< in order: q of y before ⊞ 0; q, v, v̇, λ of the step; zeros (nv)
    VecXOf<Dual<1>> dual;                     ///< workspace of `coordinate_rates`
    VecX q_rate;                              ///< q˙ (nq)
    ForwardDynamics<Solver> forward;          ///< solver for the accelerations
    StepCheck check;                          ///< checks of the steps of a run
    detail::ErrorNorm norm;                   ///< norm of the error
    typename Stabilisation::Scratch scratch;  ///< memory of the stabilisation

    /// Allocates all members.
    explicit Workspace(System& s)
        : y(VecX::Zero(s.coordinates() + s.velocities())),
          f(y),
          correction(y),
          raw(VecX::Zero(s.coordinates())),
          q(raw),
          v(VecX::Zero(s.velocities())),
          a(v),
          lambda(VecX::Zero(s.rows())),
          zero(v),
          dual(VecXOf<Dual<1>>::Zero(2 * s.layout().coordinates + s.layout().velocities)),
          q_rate(q),
          forward(s),
          norm(s, false),
          scratch(s) {}

    /// Copies y to q, normalised, and to v.
    void split(System const& system) {
      std::copy_n(y.data(), raw.size(), raw.data());
      std::copy_n(y.data() + raw.size(), v.size(), v.data());
      system.plus(raw, zero, q);
    }
    /// Evaluates y˙ at (q, v, t) and stores it in f.
    void rates(System& system, double t, ConstraintFeedback const& feedback) {
      forward.accelerations(system, {q, v, t}, a, lambda, feedback);
      polybody::coordinate_rates(system, q, v, dual, q_rate);
      std::copy_n(q_rate.data(), q.size(), f.data());
      std::copy_n(a.data(), a.size(), f.data() + q.size());
    }
  };
  template <class Solver>
  Workspace<Solver> workspace(System& system) const {
    return Workspace<Solver>(system);
  }

  template <class W>
  void start(System& system, State& x, double, W& w) const {
    check();
    stabilisation.start(w.scratch);
    w.q = x.q;
    w.v = x.v;
    w.rates(system, x.t, stabilisation.feedback());
    x.a = w.a;
    x.lambda = w.lambda;
    AdamsHistory::reset(x.history, w.f);
  }

  /// Integrates over h, or over a shorter step if the tolerance requires it. \throws MinimumStepReached if the
  /// tolerance requires a step below `min_step`.
  template <class W>
  StepReport step(System& system, State& x, double h, W& w) const {
    AdamsHistory history(x.history, w.y.size());
    ConstraintFeedback const feedback = stabilisation.feedback();
    auto const age = history.ages();
    int const known = int(history.known());
    int k = std::min(int(history.order()), max_order);
    bool rising = history.rising() != 0.0;
    StepReport report;
    Errors e;
    for (;;) {
      auto const c = AdamsHistory::weights(h, age);
      predict(history, c, k, x, w);
      w.split(system);
      w.rates(system, x.t + h, feedback);
      report.evaluations += 1;
      e = correct(system, history, Trial{c, age, h, k, known}, x, w);
      if (e.here <= 1.0) break;
      ++report.rejected;
      if (known > 1) rising = false;
      if (!std::isfinite(e.here) || report.rejected > 2) {
        k = 1;
        h *= std::isfinite(e.here) ? std::min(0.5, std::sqrt(0.5 / e.here)) : 0.1;
      } else {
        if (e.prefer_lower(k)) --k;
        h *= 0.5;
      }
      if (!(h >= min_step))
        throw MinimumStepReached(
            "step.minimum", {ErrorObject{"AdamsBashforthMoulton"}, ": the tolerance requires a step below ", min_step,
                             " s at t = ", ErrorTime{x.t},
                             " s. The model is stiff or discontinuous at this time. Use an implicit integrator, or "
                             "declare the time as a breakpoint."});
    }
    w.y += w.correction;
    w.split(system);
    stabilisation.apply(system, w.forward, w.scratch, w.q, w.v, x.t + h);
    w.rates(system, x.t + h, feedback);
    report.evaluations += 1;
    report.factorisations = report.evaluations;
    report.taken = h;
    report.order = k;
    report.choices = detail::choices_of(w.scratch);
    report.next = std::max(choose(e, h, k, known, rising), min_step);
    w.check.require_end(system, {w.q, w.v, w.lambda, x.t + h, h});
    history.push(h, w.f);
    history.order() = k;
    history.rising() = rising;
    x.q.swap(w.q);
    x.v.swap(w.v);
    x.a.swap(w.a);
    x.lambda.swap(w.lambda);
    x.t += h;
    return report;
  }

 private:
  /// Error estimates of orders k − 2, k − 1, k and k + 1. An estimate is zero for orders below 1. It is infinite for
  /// orders above 12, or if too few past points are known.
  struct Errors {
    double two_below = 0.0, below = 0.0, here = 0.0, above = 0.0;  ///< errors relative to the tolerance
    /// True if the estimates favour order k − 1 over order k [Shampine & Gordon 1975].
    bool prefer_lower(int k) const {
      return k > 2 ? std::max(two_below, below) <= here : k == 2 && below <= 0.5 * here;
    }
  };

  /// Trial step of length h at order k. `c` are the weights of the differences, `age` are the ages of the points [s],
  /// and `known` is the number of known points.
  struct Trial {
    std::array<double, order + 2> const &c, &age;
    double h;  ///< length of the step [s]
    int k, known;
  };

  template <class W>
  void predict(AdamsHistory const& history, std::array<double, order + 2> const& c, int k, State const& x, W& w) const {
    std::copy_n(x.q.data(), x.q.size(), w.y.data());
    std::copy_n(x.v.data(), x.v.size(), w.y.data() + x.q.size());
    for (int j = 0; j < k; ++j) {
      double const* const d = history.difference(j);
      for (Index i = 0; i < w.y.size(); ++i) w.y[i] += c[std::size_t(j)] * d[i];
    }
  }

  /// Stores c_k D*_k in w.correction and returns the error estimates. The square of an estimate is that of `ErrorNorm`
  /// for coordinates and velocities, plus the mean square over first-order states, each relative to its own tolerance.
  template <class W>
  Errors correct(System const& system, AdamsHistory const& history, Trial const& trial, State const& x, W& w) const {
    auto const& [c, age, h, k, known] = trial;
    std::array<double, 4> of_states{};
    Index const nq = x.q.size(), n = w.y.size(), states = system.layout().states, bodies = x.v.size() - states;
    detail::ErrorTolerance const tolerance{absolute_tolerance, relative_tolerance};
    w.norm.set_scales(system, tolerance, x, w.q, w.v);
    w.norm.clear();
    auto const add = [&](Index i, double in, std::array<double, 4>& sum) {
      double d = w.f[i];
      for (int j = 0; j <= std::min(k + 1, known); ++j) {  // d is D*_j
        if (j >= k - 2) sum[std::size_t(j - k + 2)] += in * d * d;
        if (j == k) w.correction[i] = c[std::size_t(k)] * d;
        if (j < known) d = (d - history.difference(j)[i]) / (h + age[std::size_t(j)]);
      }
    };
    for (Index i = 0; i < nq; ++i) {
      auto& group = w.norm.of_coordinate(i);
      add(i, group.in_q, group.sum);
    }
    for (Index i = 0; i < bodies; ++i) {
      auto& group = w.norm.of_velocity(i);
      add(nq + i, group.in_v, group.sum);
    }
    for (Index i = nq + bodies; i < n; ++i) {
      double const tolerated = tolerance.of_one(x.v[i - nq], w.v[i - nq]);
      add(i, 2.0 / (tolerated * tolerated * double(states)), of_states);
    }
    std::array<double, 4> sum = w.norm.largest_sums();
    for (std::size_t j = 0; j < 4; ++j) sum[j] += of_states[j];
    auto const error = [&](int j) {
      if (j < 1) return 0.0;
      if (j > known) return std::numeric_limits<double>::infinity();
      std::size_t const i = std::size_t(j);
      return std::abs(c[i] - c[i - 1] * (h + age[i - 1])) * std::sqrt(0.5 * sum[std::size_t(j - k + 2)]);
    };
    return {error(k - 2), error(k - 1), error(k), k < order ? error(k + 1) : std::numeric_limits<double>::infinity()};
  }
  /// Returns the next step, and stores the next order in k. While `rising` after a start, each step raises the order by
  /// one and doubles the step, until the order is `max_order` or the estimates favour a lower order. Later, the
  /// estimates select order k − 1, k or k + 1. The estimate of the selected order decides if the step is doubled, kept
  /// or reduced.
  double choose(Errors const& e, double h, int& k, int known, bool& rising) const {
    double error = e.here;
    bool const higher = k > 1 ? e.above < error && error < std::max(e.two_below, e.below) : e.above < 0.5 * error;
    if (e.prefer_lower(k)) {
      error = e.below;
      --k;
      rising = false;
    } else if (rising && k < max_order) {
      ++k;
      return 2.0 * h;
    } else if (k < max_order && known > k && higher) {
      error = e.above;
      ++k;
    }
    if (std::ldexp(error, k + 1) <= 0.5) return 2.0 * h;
    if (error <= 0.5) return h;
    return h * std::clamp(std::pow(0.5 / error, 1.0 / (k + 1)), 0.5, 0.9);
  }
};

}  // namespace polybody
