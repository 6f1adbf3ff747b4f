#pragma once
/// \file
/// What no step of a sound run leaves behind: rows that are open, and energy that no work explains. Newton's method
/// stops beside the size of the accelerations, so a motion that explodes converges, too.

#include <cmath>
#include <limits>

#include <polybody/math/sequence.hpp>
#include <polybody/math/vectors.hpp>
#include <polybody/system/system.hpp>

namespace polybody {

/// How far a step may go; an infinite limit switches its check off.
struct StepLimits {
  double violation = 0.1;  ///< |Φ| of a row, relative to the extent of the markers and to one
  double energy = 100.0;   ///< gained, relative to what explains it
};

/// The end of a step of length h, before it is accepted.
struct StepEnd {
  VecX const &q, &v, &lambda;  ///< q (nq), v (nv), λ (rows) there
  double t, h;                 ///< its time [s], its length [s]
};

/// The limits of a run, with the account of what may have changed its energy E = T + V since the last start:
///   E − E₀ ≤ limit · (T₀ + |V₀| + |change of the potential of gravity| + ∫|power of loads, drives and forces| dt).
/// Loads, drives, and forces without a potential are counted by the size of their power at the end of each step; where
/// a potential depends on time there is no such account, and no verdict. The account is not balanced to its last digit:
/// it tells an explosion from a motion. It is looked at whenever the speeds have grown by a factor √10, so a run that
/// does not grow pays for a sum of squares and for the power of its loads.
class StepBounds {
 private:
  static constexpr double never = std::numeric_limits<double>::infinity();
  struct Account {
    double open = never;    ///< the limit for |Φ|, in the unit of the row: [m], or a cosine
    double energy = never;  ///< the limit, a factor
    double judged = never;  ///< Σ v² beyond which the energy is looked at: a factor of that of the start
    double worked = 0.0;    ///< ∫|power| dt [J]
    Energy start;           ///< E₀
    double began = 0.0;     ///< at this time [s]
  };

 public:
  /// Begins anew at q, v, t. Without this call nothing is checked.
  template <class = void>  // compiled where it is used
  [[gnu::cold]] void begin(System& system, StepLimits const& limits, VecX const& q, VecX const& v, double t);

  /// \throws Diverged for a step that ends beyond a limit. `system` may have been evaluated near the end only: what
  /// looks wrong there is judged at the end itself. \param squares Σ v²
  template <class = void>
  void require(System& system, StepEnd const& end, double squares) {
    if (counts_work_) {
      double const work = end.h * power(system, end.lambda);
      if (std::isfinite(work)) account_.worked += work;  // a force that is NaN is refused where it acts
    }
    if (squares > account_.judged || any_open()) judge(system, end, squares);
  }

  /// Puts the account back as it was, unless what is tried is kept.
  class Trial {
   public:
    /// Remembers the account as it is.
    explicit Trial(StepBounds& bounds) : bounds_(bounds), before_(bounds.account_) {}
    Trial(Trial const&) = delete;
    ~Trial() {
      if (!kept_) bounds_.account_ = before_;
    }
    void keep() { kept_ = true; }  ///< the account of what was tried stays

   private:
    StepBounds& bounds_;
    Account before_;
    bool kept_ = false;
  };

 private:
  bool any_open() const {
    for (Gaps const& gaps : gaps_)
      for (int i = 0; i < gaps.rows; ++i)
        if (std::abs(gaps.g[i]) > account_.open) return true;
    return false;
  }
  template <class = void>
  double power(System const& system, VecX const& lambda) const;
  template <class = void>
  void judge(System& system, StepEnd const& end, double squares);
  template <class = void>
  [[noreturn, gnu::cold]] void refuse_open(System const& system, double t) const;
  template <class = void>
  void judge_energy(System& system, StepEnd const& end) const;

  /// The rows of a block, in the data of the system.
  struct Gaps {
    double const* g;
    int rows;
    Index first;
  };
  struct Drive {
    std::size_t block;
    Index row;  ///< in a step; −1 for a compliant joint
  };

  bool counts_work_ = false;
  Account account_;
  Sequence<Gaps> gaps_;
  Sequence<std::size_t> actions_;    ///< of forces without a potential
  Sequence<std::size_t> compliant_;  ///< joints that do not store all that they take
  Sequence<Drive> drives_;
};

template <class>
void StepBounds::begin(System& system, StepLimits const& limits, VecX const& q, VecX const& v, double t) {
  system.evaluate(q, v, t);
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
  auto const& [entries, model] = system.entries();
  account_.energy = entries.energy ? limits.energy : never;
  if (entries.energy) account_.start = entries.energy(model, system.at(), data);
  account_.began = t;
  account_.judged = account_.energy < never ? 10.0 * squares(v) : never;
  account_.worked = 0.0;
  gaps_.clear();
  actions_.clear();
  drives_.clear();
  compliant_.clear();
  for (std::size_t i = 0; i < data.actions.size(); ++i)
    if (!layout.forces[std::size_t(data.actions[i].source)].stores) actions_.push_back(i);
  Coordinates const& narrow = system.step_coordinates();
  for (std::size_t i = 0; i < data.rows.size(); ++i) {
    RowBlock<double> const& block = data.rows[i];
    if (block.source == RowSource::compliant && !layout.joints[std::size_t(block.owner)].stores)
      compliant_.push_back(i);
    if (block.row >= 0 && !data.leaves_out(block)) gaps_.push_back({block.g, block.rows, block.row});
    if (!block.rate) continue;
    Index row = block.row;
    if (narrow && row >= 0) {
      auto const& stay = narrow.narrow->rows_that_stay;
      auto const at = std::find(stay.begin(), stay.end(), row);
      if (at == stay.end()) continue;
      row = at - stay.begin();
    }
    drives_.push_back({i, row});
  }
  counts_work_ = account_.energy < never && !(actions_.empty() && drives_.empty() && compliant_.empty());
}

/// Σ |power|: w · twist of forces, λ · Φ_t of drives, λ · ġ of compliant joints that do not store what they take.
template <class>
double StepBounds::power(System const& system, VecX const& lambda) const {
  Data<double> const& data = system.data();
  double sum = 0.0;
  for (std::size_t const i : actions_) {
    Action<double> const& action = data.actions[i];
    double twist[6], power = 0.0;
    detail::read_twist(data.markers[std::size_t(action.marker)].frame, twist);
    for (int k = 0; k < 6; ++k) power += action.w[k] * twist[k];
    sum += std::abs(power);
  }
  for (Drive const& drive : drives_) {
    RowBlock<double> const& block = data.rows[drive.block];
    double const* const l = drive.row < 0 ? block.answer : lambda.data() + drive.row;
    for (int k = 0; k < block.rows; ++k) sum += std::abs(l[k] * block.rate[k]);
  }
  for (std::size_t const i : compliant_) {
    RowBlock<double> const& block = data.rows[i];
    double rate[6] = {};
    detail::add_rate(block.a, block.rows, data, lambda, rate);
    detail::add_rate(block.b, block.rows, data, lambda, rate);
    for (int k = 0; k < block.rows; ++k) sum += std::abs(block.answer[k] * rate[k]);
  }
  return sum;
}

template <class>
void StepBounds::judge(System& system, StepEnd const& end, double squares) {
  system.evaluate(end.q, end.v, end.t);
  if (any_open()) refuse_open(system, end.t);
  if (!(squares > account_.judged)) return;
  judge_energy(system, end);
  account_.judged = 10.0 * squares;
}

template <class>
void StepBounds::refuse_open(System const& system, double t) const {
  Index row = 0;
  double largest = 0.0;
  for (Gaps const& gaps : gaps_)
    for (int i = 0; i < gaps.rows; ++i)
      if (std::abs(gaps.g[i]) > largest) {
        largest = std::abs(gaps.g[i]);
        row = gaps.first + i;
      }
  throw Diverged{"The step to t = ",
                 t,
                 " s leaves ",
                 system.layout().name_of(system.layout().speeds + row),
                 " open by ",
                 largest,
                 ": the integration diverges. Take a smaller step, or raise the run's limits.violation, by which ",
                 account_.open,
                 " is allowed."};
}

template <class>
void StepBounds::judge_energy(System& system, StepEnd const& end) const {
  auto const& [entries, model] = system.entries();
  Energy const now = entries.energy(model, system.at(), system.data());
  At<double> const& at = system.at();
  if (entries.energy(model, {at.q, at.v, account_.began}, system.data()).forces != now.forces) return;
  double const gained = now.total() - account_.start.total();
  double const explained = account_.start.kinetic + std::abs(account_.start.strain) + std::abs(account_.start.joints) +
                           std::abs(account_.start.forces) + std::abs(now.gravity - account_.start.gravity) +
                           account_.worked;
  if (gained <= account_.energy * explained) return;
  Index fastest = 0;
  for (Index i = 1; i < end.v.size(); ++i)
    if (std::abs(end.v[i]) > std::abs(end.v[fastest])) fastest = i;
  // A motion that is slow beside its coordinates is no explosion, but rounding.
  if (std::abs(end.v[fastest]) * end.h < 1e-3 * (1.0 + largest_size(end.q))) return;
  throw Diverged{"The step to t = ",
                 end.t,
                 " s has gained ",
                 gained,
                 " J since the last start, where gravity, loads, drives and the energy of the start explain ",
                 explained,
                 " J; ",
                 system.name_of(fastest),
                 " moves fastest. The integration diverges: take a smaller step or softer joints, or raise the run's "
                 "limits.energy."};
}

}  // namespace polybody
