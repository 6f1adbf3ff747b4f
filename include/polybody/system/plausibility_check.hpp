#pragma once
/// \file
/// Checks of every step of a run: constraint violations, unexplained energy, prescribed values that contradict their
/// rates, and contacts that a step jumps over. Newton's method stops relative to the size of the accelerations. It
/// therefore also converges in the steps of a diverging motion.

#include <algorithm>
#include <cmath>
#include <limits>

#include <polybody/math/sequence.hpp>
#include <polybody/math/vectors.hpp>
#include <polybody/system/law_watch.hpp>
#include <polybody/system/system.hpp>
#include <polybody/system/work_account.hpp>

namespace polybody {

/// Limits of a run. An infinite limit disables its check.
struct PlausibilityLimits {
  double violation = 0.1;  ///< limit of |Φ| per constraint equation, relative to max(1, extent of the markers in m) [1]
  double energy = 1.0;     ///< limit of the unexplained gain since a start, relative to S (`PlausibilityCheck`) [1]
  double warning = 0.05;   ///< unexplained energy that causes a warning, relative to `Unexplained::scale` [1]
};

/// Energy change of a run that no work explains. Symbols: see `PlausibilityCheck`.
struct Unexplained {
  double energy = 0.0;  ///< gained energy, negative for a loss [J]
  double doubt = 0.0;   ///< estimated error of the work, large if a force jumps [J]
  double worst = 0.0;   ///< largest estimated error of the work in one step [J]
  double scale = 0.0;   ///< largest T₀ + max(0, V₀ − V) + 2 W so far, plus 10⁻³ V₀⁺ and round-off [J]
  bool known = false;   ///< true if an energy balance was evaluated
  long halved = 0;      ///< number of steps that were halved because of their energy gain
  double peak = 0.0;    ///< largest gain, less its error, at a balance during the run [J]
};

/// Check of the limits of a run, with a balance of the energy E = T + V since the last start. A step is refused if
///   E − E₀ − W > limit · S,   S = T₀ + max(V₀⁺, V₀ − V) + 2 W,   limit = `PlausibilityLimits::energy`.
/// The limit is ten times as large in the first four steps after a start. V₀⁺ is the energy stored at the start,
/// without gravity. W is the work input of drives, and of forces and compliant joints without a potential
/// (`WorkAccount`). S contains 2 W because the quadratures find only half of the work of a force that starts within a
/// step. The balance is evaluated each time Σ v² (all velocities) has grown by a tenth. Only a gain is refused, so
/// dissipation is not counted. At the end of a run and before each restart, `settle` evaluates the balance, with signed
/// work unless a counted element can store energy. `settle` counts losses if no part of the model dissipates energy.
/// Models with a potential that depends on time have no energy balance.
///
/// A run that can halve steps also evaluates the balance if Σ v² differs from its extrapolation by 2 % of the largest
/// Σ v². It halves a step that gains more than ½ limit · S, or more than a tenth of this value if E − E₀ minus signed
/// work then exceeds ½ limit · S. Smaller gains are often part of a reversible oscillation, whose energy a new start
/// would remove. The unit of Σ v² is mixed, so a jump of slow, heavy bodies can be missed; the other balances find it.
class PlausibilityCheck {
 private:
  static constexpr double never = std::numeric_limits<double>::infinity();
  /// Quadratic course of Σ v² through the ends of the last three steps, by Newton's divided differences.
  struct Trend {
    double last = 0.0, slope = 0.0, bend = 0.0;  ///< Σ v² at the last end, its divided differences; mixed units
    double h = 0.0;                              ///< length of the last step [s]
    double peak = 0.0;                           ///< largest Σ v² since the start, mixed units
    /// True if Σ v² = `squares` after a step of length `next` differs from its extrapolation by 2 % of its peak.
    bool breaks(double squares, double next) const {
      return std::abs(squares - last - next * (slope + (next + h) * bend)) > 0.02 * std::max(squares, peak);
    }
    void add(double squares, double next) {
      double const change = (squares - last) / next;
      bend = (change - slope) / (next + h);
      slope = change;
      last = squares;
      h = next;
      peak = std::max(peak, squares);
    }
  };
  struct Account {
    double open = never;    ///< limit of |Φ| in the unit of the constraint equation: [m], or a cosine
    double energy = never;  ///< limit of the unexplained energy relative to S [1]
    double judged = never;  ///< Σ v² that triggers the next balance, mixed units
    double fastest = 0.0;   ///< Σ v² at the last balance, mixed units
    double scale = 0.0;     ///< largest S since the start [J]
    double moved = 0.0;     ///< largest T₀ + max(0, V₀ − V) + 2 W since the start [J]
    Trend trend;            ///< course of Σ v²
    double gained = 0.0;    ///< unexplained energy at the last balance [J]
    double doubt = 0.0;     ///< estimated error of the work at the last balance [J]
    double most = 0.0;      ///< largest unexplained gain, less its error, at a balance since the start [J]
    Energy start;           ///< E₀
    double began = 0.0;     ///< time of the start [s]
    Unexplained settled;    ///< balances that ended before `began`: sums of energy and doubt, maxima of the rest
  };

 public:
  /// Sets the limits and restarts the balance at `place`; `place.h` is the length of the next step. Nothing is checked
  /// before the first call.
  template <class = void>  // a template, to be compiled only if it is used
  [[gnu::cold]] void begin(System& system, PlausibilityLimits const& limits, StepResult const& place);

  /// Checks a step. `system` may be evaluated near the end of the step; it is evaluated at the end before a limit is
  /// reported. \param squares Σ v² \throws Diverged if the end violates a limit, InvalidInput if a prescribed value
  /// disagrees with its rate, NewtonConvergenceFailure if the step jumps over a contact or needs halving.
  template <class = void>
  void require(System& system, StepResult const& end, double squares) {
    if (work_.counts()) work_.add(system, end);
    double gained = account_.gained, doubt = account_.doubt;
    if (halvings >= 0 && account_.energy < never && account_.trend.breaks(squares, end.h))
      require_small_gain(system, end, gained, doubt);
    if (laws_.watches()) laws_.require(system.layout(), end.t, end.h);
    if (!contacts_.empty()) require_no_passage(system, end);
    account_.trend.add(squares, end.h);
    account_.gained = gained;
    account_.doubt = doubt;
    if (squares > account_.judged || any_open()) check_step(system, end, squares);
  }

  /// Evaluates the balance at the end of the run or before a call of `begin`. Returns the balance of the run so far.
  /// \throws Diverged if the end violates the energy limit.
  template <class = void>
  [[gnu::cold]] Unexplained settle(System& system, StepResult const& end);

  int halvings = -1;  ///< number of times that the run may halve this step for an energy gain; −1: no such check

  /// Scope of a trial step. Its destructor restores the check to its previous state unless `keep` was called.
  class Trial {
   public:
    /// Stores the present state of the check.
    explicit Trial(PlausibilityCheck& bounds) : bounds_(bounds), before_(bounds.account_) {
      bounds_.replaced_ = false;
      bounds_.work_.mark();
      bounds_.laws_.mark();
    }
    Trial(Trial const&) = delete;
    ~Trial() {
      if (kept_) return;
      bounds_.account_ = before_;
      if (bounds_.replaced_) bounds_.work_ = std::move(bounds_.earlier_);
      bounds_.work_.go_back();
      bounds_.laws_.go_back();
    }
    void keep() { kept_ = true; }  ///< accepts the trial step

   private:
    PlausibilityCheck& bounds_;
    Account before_;
    bool kept_ = false;
  };

 private:
  bool any_open() const {
    for (Violations const& violations : violations_)
      for (int i = 0; i < violations.rows; ++i)
        if (std::abs(violations.g[i]) > account_.open) return true;
    return false;
  }
  /// Index of the largest velocity.
  static Index fastest_of(VecX const& v) {
    Index fastest = 0;
    for (Index i = 1; i < v.size(); ++i)
      if (std::abs(v[i]) > std::abs(v[fastest])) fastest = i;
    return fastest;
  }
  /// False for a slow motion, max |v| h < 10⁻³ (1 + max |q|). Its energy gain is round-off and not an instability.
  static bool moves(StepResult const& end) {
    return std::abs(end.v[fastest_of(end.v)]) * end.h >= 1e-3 * (1.0 + largest_size(end.q));
  }
  /// Energies and works since the last start.
  struct Balance {
    double gained = 0.0, put_in = 0.0, net = 0.0;      ///< E − E₀, W, signed work [J]
    double kinetic = 0.0, held = 0.0, released = 0.0;  ///< T₀, V₀⁺, max(0, V₀ − V) [J]
    double rounding = 0.0;                             ///< estimated round-off of the energies [J]
    bool known = false;                                ///< true if the model has an energy balance
    /// S [J].
    double scale() const { return kinetic + std::max(held, released) + 2.0 * put_in; }
  };
  /// Balance at the state of the last evaluation.
  template <class = void>
  Balance balance(System& system) const;
  /// Limit of the unexplained energy gain since a start [J].
  double energy_limit(StepResult const& end) const {
    // The error estimate of the work compares steps, so it is not reliable in the first steps after a start.
    double const few = end.t - account_.began < 4.5 * end.h ? 10.0 : 1.0;
    return few * account_.energy * account_.scale;
  }
  /// Refuses a step with too large a gain. \param gained,doubt unexplained energy and its estimated error [J]: on entry
  /// at the last balance, on return at this step \throws NewtonConvergenceFailure if a halving is possible
  template <class = void>
  void require_small_gain(System& system, StepResult const& end, double& gained, double& doubt);
  template <class = void>
  void check_step(System& system, StepResult const& end, double squares);
  template <class = void>
  [[noreturn, gnu::cold]] void refuse_open(System const& system, double t) const;
  /// Balance at the end of a step, at which `system` must be evaluated. \throws Diverged if the gain exceeds the limit.
  template <class = void>
  Unexplained check_energy(System& system, StepResult const& end);
  template <class = void>
  void require_no_passage(System const& system, StepResult const& end);

  /// Constraint violations of a block, in the data of the system.
  struct Violations {
    double const* g;
    int rows;
    Index first;
  };
  /// Contact of two markers, with their frames at the ends of the last and the present step.
  struct Passing {
    std::size_t force;
    Frame<double> last[2], now[2];
    double t = 0.0;  ///< time of `last` [s]
  };
  static void read_frames(System const& system, ForceLayout const& force, Frame<double> (&out)[2]) {
    for (std::size_t k = 0; k < 2; ++k) {
      Frame<double> const& f = system.data().markers[std::size_t(force.markers[k])].frame;
      out[k].r = f.r;
      out[k].A = f.A;
    }
  }

  Account account_;
  Sequence<Violations> violations_;
  Sequence<Passing> contacts_;  ///< contacts that a step may jump over
  WorkAccount work_, earlier_;  ///< account since the last start; previous account, restored if a trial step fails
  bool replaced_ = false;       ///< true if `begin` was called since the start of the trial step
  LawWatch laws_;
  bool lossless_ = false;  ///< true if no part of the model dissipates
};

template <class>
void PlausibilityCheck::begin(System& system, PlausibilityLimits const& limits, StepResult const& place) {
  system.evaluate(place.q, place.v, place.t);
  Data<double> const& data = system.data();
  ModelLayout const& layout = system.layout();
  Vec3 least = Vec3::Zero(), most = least;
  for (std::size_t k = 0; k < data.markers.size(); ++k)
    for (int i = 0; i < 3; ++i) {
      double const r = data.markers[k].frame.r[i];
      least[i] = k == 0 ? r : std::min(least[i], r);
      most[i] = k == 0 ? r : std::max(most[i], r);
    }
  account_.open = limits.violation * std::max({1.0, most[0] - least[0], most[1] - least[1], most[2] - least[2]});
  bool const has_energy = system.operations().has_energy();
  account_.energy = has_energy ? limits.energy : never;
  if (has_energy) account_.start = system.operations().energy(system.at(), data);
  account_.began = place.t;
  account_.fastest = squares(place.v);
  account_.judged = account_.energy < never ? 1.1 * account_.fastest : never;
  account_.scale = account_.moved = account_.gained = account_.doubt = account_.most = 0.0;
  account_.trend = {.last = account_.fastest, .peak = account_.fastest};
  violations_.clear();
  contacts_.clear();
  if (!replaced_) earlier_ = std::move(work_);
  replaced_ = true;
  work_ = {};
  for (std::size_t i = 0; i < data.rows.size(); ++i) {
    ConstraintBlock<double> const& block = data.rows[i];
    if (block.row >= 0 && !data.leaves_out(block)) violations_.push_back({block.g, block.rows, block.row});
  }
  if (account_.energy < never) work_.begin(system, place);
  laws_.begin(layout, place.t, 1e-6 * place.h);
  lossless_ = work_.complete();
  for (BodyLayout const& body : layout.bodies) lossless_ = lossless_ && body.lossless;
  if (std::ranges::any_of(layout.bodies, &BodyLayout::changes)) account_.energy *= 100.0;  // changes without work
  for (JointLayout const& joint : layout.joints) lossless_ = lossless_ && (!joint.stores || joint.lossless);
  for (std::size_t i = 0; i < layout.forces.size(); ++i) {
    ForceLayout const& force = layout.forces[i];
    lossless_ = lossless_ && (!force.stores || force.lossless || force.dissipation);
    if (!force.passes) continue;
    contacts_.push_back({i, {}, {}, place.t});
    read_frames(system, force, contacts_.back().last);
  }
}

/// Refuses a step during which a contact closes and opens again.
template <class>
void PlausibilityCheck::require_no_passage(System const& system, StepResult const& end) {
  for (Passing& contact : contacts_) {
    ForceLayout const& force = system.layout().forces[contact.force];
    read_frames(system, force, contact.now);
    bool const follows = std::abs(end.t - end.h - contact.t) <= 1e-3 * end.h;
    if (!follows || !force.passes(force.force, contact.last, contact.now)) continue;
    if (work_.counts()) work_.drop_last();
    throw NewtonConvergenceFailure(
        "step.missed_contact",
        {"The step of ", end.h, " s to t = ", ErrorTime{end.t}, " s jumps over the contact \"", ErrorObject{force.name},
         "\": the bodies touch during the step, but not at its ends. Take a smaller step, or "
         "set max_step_halvings in the options of the run."});
  }
  for (Passing& contact : contacts_) {
    std::copy_n(contact.now, 2, contact.last);
    contact.t = end.t;
  }
}

template <class>
void PlausibilityCheck::check_step(System& system, StepResult const& end, double squares) {
  system.evaluate(end.q, end.v, end.t);
  if (any_open()) refuse_open(system, end.t);
  if (!(squares > account_.judged)) return;
  Unexplained const found = check_energy(system, end);
  if (end.t - account_.began > 4.5 * end.h) account_.most = std::max(account_.most, found.energy - found.doubt);
  account_.fastest = squares;
  account_.judged = 1.1 * squares;
}

template <class>
void PlausibilityCheck::refuse_open(System const& system, double t) const {
  Index row = 0;
  double largest = 0.0;
  for (Violations const& violations : violations_)
    for (int i = 0; i < violations.rows; ++i)
      if (std::abs(violations.g[i]) > largest) {
        largest = std::abs(violations.g[i]);
        row = violations.first + i;
      }
  throw Diverged("step.violation",
                 {"The step to t = ", ErrorTime{t}, " s violates the constraint equations of ",
                  ErrorObject{system.layout().name_of(system.layout().velocities + row)}, " by ", ErrorValue{largest},
                  ", but the limit is ", account_.open,
                  ". The integration diverges. Take a smaller step, or raise limits.violation of the run."});
}

template <class>
PlausibilityCheck::Balance PlausibilityCheck::balance(System& system) const {
  ModelOperations<double> const& model = system.operations();
  Energy const now = model.energy(system.at(), system.data()), &start = account_.start;
  At<double> const& at = system.at();
  if (work_.misses_drives(system.data())) return {};
  bool const forced = !system.layout().forces.empty();
  if (forced && model.energy({at.q, at.v, account_.began}, system.data()).forces != now.forces) return {};
  Balance b{.gained = now.total() - start.total(), .kinetic = start.kinetic, .known = true};
  b.held = std::max(0.0, start.strain) + std::max(0.0, start.joints) + std::max(0.0, start.forces);
  b.released = std::max(0.0, start.potential() - now.potential());
  b.rounding = 1e-9 * (std::abs(now.gravity) + std::abs(now.strain) + std::abs(now.joints));
  if (!work_.counts()) return b;
  b.put_in = work_.put_in();
  b.net = work_.net();
  return b;
}

template <class>
void PlausibilityCheck::require_small_gain(System& system, StepResult const& end, double& gained, double& doubt) {
  double const before = gained, doubt_before = doubt, scale_before = account_.scale;
  double limit = 0.0;
  auto const gains = [&] {
    Balance const b = balance(system);
    if (!b.known) return false;
    gained = b.gained - b.net;
    doubt = work_.counts() ? work_.doubt() : 0.0;
    account_.scale = std::max(scale_before, b.scale());
    limit = 0.5 * (work_.counts() ? energy_limit(end) : account_.energy * account_.scale);
    double const gain = gained - before - 4.0 * (doubt - doubt_before) - b.rounding;
    return gain > 0.1 * limit && std::max(gain, gained) > limit;
  };
  if (!gains() || halvings == 0) return;
  system.evaluate(end.q, end.v, end.t);
  if (!gains() || !moves(end)) return;
  account_.scale = scale_before;
  ++account_.settled.halved;
  if (work_.counts()) work_.drop_last();
  throw NewtonConvergenceFailure(
      "step.energy_jump",
      {"The step of ", end.h, " s to t = ", ErrorTime{end.t}, " s gains ", ErrorValue{gained - before},
       " J that no work explains, but the limit is ", limit, " J; ", ErrorObject{system.name_of(fastest_of(end.v))},
       " moves fastest. Take a smaller step, or a smaller rho_inf."});
}

template <class>
Unexplained PlausibilityCheck::check_energy(System& system, StepResult const& end) {
  Balance const b = balance(system);
  if (!b.known) return {};
  account_.scale = std::max(account_.scale, b.scale());
  account_.moved = std::max(account_.moved, b.kinetic + b.released + 2.0 * b.put_in);
  double const unexplained = b.gained - b.put_in;
  if (unexplained > energy_limit(end) && moves(end))
    throw Diverged(
        "step.energy_gain",
        {"The step to t = ", ErrorTime{end.t}, " s ends with ", ErrorValue{unexplained},
         " J more energy than the work since the last start explains; gravity, loads, drives and the energy at the "
         "last start supply at most ",
         account_.scale, " J; ", ErrorObject{system.name_of(fastest_of(end.v))},
         " moves fastest. The integration diverges. Take a smaller step or softer joints, or raise limits.energy of "
         "the run."});
  bool const counts = work_.counts();
  return {b.gained - (work_.complete() ? b.net : b.put_in), counts ? work_.doubt() : 0.0, counts ? work_.worst() : 0.0,
          account_.moved + b.rounding + 1e-3 * b.held, true};
}

template <class>
Unexplained PlausibilityCheck::settle(System& system, StepResult const& end) {
  Unexplained& sum = account_.settled;
  if (!(account_.energy < never)) return sum;
  system.evaluate(end.q, end.v, end.t);
  Unexplained const last = check_energy(system, end);
  double const fastest = std::sqrt(std::max(account_.fastest, squares(end.v)));
  if (!last.known || fastest * (end.t - account_.began) <= 1e-6 * (1.0 + largest_size(end.q))) return sum;
  sum.energy += lossless_ ? last.energy : std::max(0.0, last.energy);
  sum.doubt += last.doubt;
  sum.worst = std::max(sum.worst, last.worst);
  sum.peak = std::max(sum.peak, account_.most);
  sum.scale = std::max(sum.scale, last.scale);
  sum.known = true;
  return sum;
}

}  // namespace polybody
