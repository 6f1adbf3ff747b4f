#pragma once
/// \file
/// Derivatives of the equations of motion r and the constraint equations Φ of a step with respect to parameters, at
/// fixed unknowns, by differences of perturbed models. Parameters that affect no common equation are perturbed together
/// in the same models. Columns of a sparse Jacobian can be differenced together in the same way [Curtis, Powell & Reid
/// 1974].

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include <polybody/gradients/affected_equations.hpp>
#include <polybody/gradients/parameter.hpp>
#include <polybody/gradients/perturbed_model.hpp>
#include <polybody/gradients/requirements.hpp>

namespace polybody::detail {

// Check of parameters that are perturbed together, in one group of models. Each parameter is a member of the group. An
// equation may depend on a member only if the `affects` of this member names the object of the equation.

/// Indices of the difference points (`FourPoints`) of one member, for each of the four models of its group.
using MemberOrder = std::array<std::uint8_t, 4>;

/// Orders of the four difference points, for up to twelve members. No order equals another one, or another one with the
/// signs of all points reversed.
inline constexpr std::array<MemberOrder, 12> member_orders{{{0, 1, 2, 3},
                                                            {0, 1, 3, 2},
                                                            {0, 2, 1, 3},
                                                            {0, 2, 3, 1},
                                                            {0, 3, 1, 2},
                                                            {0, 3, 2, 1},
                                                            {2, 0, 1, 3},
                                                            {2, 0, 3, 1},
                                                            {2, 1, 0, 3},
                                                            {2, 1, 3, 0},
                                                            {2, 3, 0, 1},
                                                            {2, 3, 1, 0}}};
/// Order of member r in one of the sets of models of its group. The order has the number r/`of_orders` modulo n, with
/// the number n of all orders. `of_orders` is 1, n, n², … for the successive sets.
constexpr MemberOrder const& order_of_member(std::size_t r, std::size_t of_orders) {
  return member_orders[r / of_orders % member_orders.size()];
}

/// Largest changes of equations that may be due to round-off.
struct RoundingOfEquations {
  double balance = -1.0, rows = 0.0;  ///< of equations of motion (negative if unknown), and of constraint equations
};
/// Magnitude of the terms that cancel in the constraint equations at x, a state or an evaluation point.
template <class X>
double size_of_rows(X const& x) {
  double const size = std::max({1.0, largest_size(x.q), largest_size(x.v), largest_size(x.a)});
  if constexpr (requires { x.terms; }) return size * std::max({1.0, x.terms.rate, x.terms.position});
  return size;
}

/// Values of an equation at the four difference points of the member that owns the equation.
using ValuesAtPlaces = std::array<double, 4>;

/// Check of a group of parameters (members) that are perturbed together in four models. The owner of an equation is the
/// member whose `affects` names the object of the equation. An equation without an owner must not change; any other
/// equation must change with its owner only. The four models use the difference points of each member in a different
/// order. So if a second member also changes an equation, its values are not linear in the difference points of the
/// owner. Curvature of an equation has the same effect, so a deviation does not prove a dependence.
class SharedEquations {
 public:
  static constexpr std::size_t nobody = std::size_t(-1);  ///< owner of an equation that has no owner

  /// Makes `size` equations without owners.
  explicit SharedEquations(std::size_t size) : owner_(size, nobody), doubts_(size) {}

  std::size_t size() const { return owner_.size(); }            ///< number of equations
  std::size_t owner(std::size_t i) const { return owner_[i]; }  ///< index of the member that owns equation i
  bool is_complete() const { return is_complete_; }             ///< true if one member owns all equations
  bool are_free(std::vector<Index> const& equations) const {    ///< true if none of the `equations` has an owner
    return std::all_of(equations.begin(), equations.end(), [&](Index i) { return owner_[std::size_t(i)] == nobody; });
  }
  /// Adds a member, which owns `equations`.
  void add(std::vector<Index> const& equations) {
    for (Index const i : equations) owner_[std::size_t(i)] = members_;
    ++members_;
    is_complete_ = equations.size() == owner_.size();
  }
  /// Begins another evaluation. Returns its number.
  std::size_t begin() { return evaluations_++; }

  /// True if equation i changes by more than its owner, round-off (`rounding`) and the tolerance of the equation
  /// explain. False while the check of the equation is paused.
  bool is_doubtful(std::size_t i, ValuesAtPlaces const& f, double rounding) const {
    auto const [left, change] = unexplained(i, f);
    return left > rounding + doubts_[i].tolerance * change && evaluations_ >= doubts_[i].next;
  }
  /// Accepts a deviation of equation i as curvature: increases the tolerance of the equation, or after a kink pauses
  /// its check.
  [[gnu::cold]] void allow(std::size_t i, ValuesAtPlaces const& f) {
    Doubt& doubt = doubts_[i];
    if (auto const [left, change] = unexplained(i, f); left < 1e-2 * change) {
      doubt.tolerance = 4.0 * left / change;
    } else {
      doubt.pause = std::min<std::size_t>(2 * doubt.pause + 1, 63);
      doubt.next = evaluations_ + doubt.pause;
    }
  }

 private:
  struct Doubt {
    double tolerance = 1e-5;          // relative to the change by the owner: effect of curvature
    std::size_t next = 0, pause = 0;  // number of the evaluation with the next check; count of skipped checks
  };

  /// Change of equation i that its owner does not explain, and total change.
  std::array<double, 2> unexplained(std::size_t i, ValuesAtPlaces const& f) const {
    double const near = f[1] - f[0], far = f[3] - f[2];
    if (owner_[i] == nobody) return {std::abs(near) + std::abs(far), 0.0};
    if (members_ == 1) return {0.0, 0.0};
    return {std::abs(far - 2.0 * near), std::max(std::abs(near), std::abs(f[2] + f[3] - f[0] - f[1]))};
  }

  std::vector<std::size_t> owner_;
  std::vector<Doubt> doubts_;
  std::size_t members_ = 0, evaluations_ = 0;
  bool is_complete_ = false;
};

/// Derivatives ∂r/∂p and ∂Φ/∂p of the equations of a step with respect to all parameters, by differences. The
/// differences also reveal equations that a parameter changes although `Parameter::affects` does not name their objects
/// (`SharedEquations`). \tparam V PerturbedModel or PerturbedStageModel
template <class V>
class EquationDerivatives {
 public:
  /// Value of a parameter number that means: no parameter is perturbed.
  static constexpr std::size_t nobody = std::size_t(-1);
  /// Returns the model at difference point k of parameter j, or with j = `nobody` the unperturbed model.
  using Models = std::function<std::shared_ptr<V>(std::size_t j, std::size_t k)>;

  /// Forms groups of parameters that affect no common equation. \param make makes a scenario for values of the
  /// parameters \param alone returns the models in which one parameter is perturbed
  template <class Make>
  [[gnu::cold]] EquationDerivatives(Make const& make, std::vector<Parameter> const& parameters, V const& model,
                                    Models alone)
      : parameters_(parameters), places_(parameters.size()), models_(std::move(alone)) {
    Index const size = model.system.size();
    for (std::size_t j = 0; j < parameters.size(); ++j) {
      Place& place = places_[j];
      place.distance = parameters[j].distance();
      place.equations = affected_equations(model.system, parameters[j]);
      auto const is_free = [&](Group const& in) { return in.equations.are_free(place.equations); };
      place.group = std::size_t(std::find_if(groups_.begin(), groups_.end(), is_free) - groups_.begin());
      if (place.group == groups_.size()) groups_.emplace_back(std::size_t(size));
      groups_[place.group].equations.add(place.equations);
      groups_[place.group].members.push_back(j);
    }
    for (Group& group : groups_) {
      std::size_t const members = group.members.size();
      for (std::size_t of_orders = 1; of_orders == 1 || of_orders < members; of_orders *= member_orders.size()) {
        Set set;
        for (std::size_t m = 0; m < points; ++m) {
          std::vector<double> p = values_of(parameters);
          for (std::size_t r = 0; r < members; ++r)
            p[group.members[r]] +=
                FourPoints::places[order_of_member(r, of_orders)[m]] * places_[group.members[r]].distance;
          set.models[m] = members == 1 ? models_(group.members[0], m)
                                       : std::make_shared<V>(shared_scenario<V>(make, p), model.method);
        }
        for (std::size_t i = 0; i < group.equations.size(); ++i) {
          std::size_t const r = group.equations.owner(i);
          set.orders.push_back(order_of_member(r == SharedEquations::nobody ? 0 : r, of_orders));
        }
        group.sets.push_back(std::move(set));
      }
    }
  }

  /// Number of groups; each group needs four evaluations of the equations.
  std::size_t groups() const { return groups_.size(); }

  /// Discards the stored differences. Call this function before another step.
  void forget() {
    for (Group& group : groups_) group.known = 0;
  }
  /// Computes the differences at x, a state or an evaluation point, for `dot`. \throws InvalidInput if
  /// a parameter changes an equation of objects outside its `affects`.
  template <class Place>
  void evaluate(Place const& x) {
    forget();
    for (Group& group : groups_) evaluate(group, x, 0);
  }
  /// Stores ∂r/∂p and ∂Φ/∂p of parameter j at x in `out`; its vectors must have the sizes (nv) and (rows). x is
  /// evaluation point `number` of a step; points are visited in ascending order. The first call at a point evaluates
  /// the differences of all parameters of a group. \throws InvalidInput if a parameter of the group changes an equation
  /// of objects outside its `affects`.
  template <class X>
  void get(std::size_t j, X const& x, std::size_t number, EquationDerivative& out) {
    Place const& place = places_[j];
    Group& group = groups_[place.group];
    if (number >= group.known) evaluate(group, x, number);
    VecX const& difference = group.differences[number];
    Index const velocities = out.balance.size();
    out.balance.setZero();
    out.rows.setZero();
    for (Index const i : place.equations)
      (i < velocities ? out.balance[i] : out.rows[i - velocities]) = difference[i] / place.distance;
  }
  /// Product μᵀ ∂(r, Φ)/∂p for parameter j. \param mu (nv + rows) μ of the equations of motion, then of the constraints
  double dot(std::size_t j, VecX const& mu) const {
    double sum = 0.0;
    VecX const& difference = groups_[places_[j].group].differences.front();
    for (Index const i : places_[j].equations) sum += mu[i] * difference[i];
    return sum / places_[j].distance;
  }
  /// Checks that parameter j changes, at x, only equations of objects in its `affects`, apart from round-off.
  /// \param other model with another value of parameter j. \throws InvalidInput otherwise.
  template <class X>
  void require_named(std::size_t j, V& model, V& other, X const& x) const {
    Parameter const& p = parameters_[j];
    if (p.affects.empty()) return;
    double const force = force_at(model, x);
    EquationDerivative const here = model.equations(x), there = other.equations(x);
    Index const velocities = here.balance.size();
    auto const change = [&](Index i) {
      return i < velocities ? std::abs(there.balance[i] - here.balance[i])
                            : std::abs(there.rows[i - velocities] - here.rows[i - velocities]);
    };
    double most[2] = {1e-11 * force, 1e-13};  // limits for balance and rows: round-off, or 1e-7 of expected changes
    std::vector<char> affected(std::size_t(model.system.size()), 0);
    for (Index const i : places_[j].equations) {
      affected[std::size_t(i)] = 1;
      most[i < velocities ? 0 : 1] = std::max(most[i < velocities ? 0 : 1], 1e-7 * change(i));
    }
    for (Index i = 0; i < model.system.size(); ++i)
      if (!affected[std::size_t(i)] && change(i) > most[i < velocities ? 0 : 1])
        refuse_unnamed(model.system, p, i, x.t);
  }

 private:
  static constexpr std::size_t points = FourPoints::places.size();

  struct Place {
    std::size_t group = 0;
    double distance = 1.0;
    std::vector<Index> equations;  // indices: equations of motion, then constraint equations
  };
  struct Set {
    std::array<std::shared_ptr<V>, 4> models;
    std::vector<MemberOrder> orders;  // of each equation: the order of its owner
  };
  struct Group {
    SharedEquations equations;
    std::vector<std::size_t> members;  // parameters of the group
    std::vector<Set> sets;             // sets of models; successive evaluations alternate between them
    std::array<VecX, 4> values;        // values of the equations, one vector for each model
    std::vector<VecX> differences;     // at each point, weighted sum of the values: derivative times distance
    std::size_t known = 0;             // number of differences that belong to this step

    explicit Group(std::size_t size) : equations(size) {}

    ValuesAtPlaces at_places(Set const& set, std::size_t i) const {
      ValuesAtPlaces f;
      for (std::size_t m = 0; m < points; ++m) f[set.orders[i][m]] = values[m][Index(i)];
      return f;
    }
  };

  template <class X>
  static double force_at(V& model, X const& x) {
    X still = x;
    still.a.setZero();
    still.lambda.setZero();
    return model.equations(still).balance.template lpNorm<Eigen::Infinity>();
  }
  template <class X>
  [[gnu::cold]] void note_rounding(X const& x) {
    rounding_ = {1e-11 * force_at(*models_(nobody, 0), x), 1e-12 * size_of_rows(x)};
  }

  template <class X>
  void evaluate(Group& group, X const& x, std::size_t number) {
    group.known = number + 1;
    if (group.differences.size() < group.known) group.differences.resize(group.known);
    VecX& difference = group.differences[number];
    Set const& set = group.sets[group.equations.begin() % group.sets.size()];
    if (group.equations.is_complete()) return sum_up(set, x, difference);
    Index velocities = 0;
    for (std::size_t m = 0; m < points; ++m) {
      EquationDerivative const& of = set.models[m]->equations(x);
      velocities = of.balance.size();
      group.values[m].resize(velocities + of.rows.size());
      group.values[m].head(velocities) = of.balance;
      group.values[m].tail(of.rows.size()) = of.rows;
    }
    if (rounding_.balance < 0.0) note_rounding(x);
    difference.resize(group.values[0].size());
    bool doubtful = false;
    for (Index i = 0; i < difference.size(); ++i) {
      ValuesAtPlaces const f = group.at_places(set, std::size_t(i));
      double sum = 0.0;
      for (std::size_t k = 0; k < points; ++k) sum += FourPoints::weights[k] * f[k];
      difference[i] = sum;
      doubtful |= group.equations.is_doubtful(std::size_t(i), f, i < velocities ? rounding_.balance : rounding_.rows);
    }
    if (doubtful) settle(group, set, x, velocities);
  }
  /// Computes the difference of a group with one parameter, which affects all equations.
  template <class X>
  static void sum_up(Set const& set, X const& x, VecX& difference) {
    for (std::size_t k = 0; k < points; ++k) {
      EquationDerivative const& of = set.models[k]->equations(x);
      if (k == 0) difference.setZero(of.balance.size() + of.rows.size());
      difference.head(of.balance.size()) += FourPoints::weights[k] * of.balance;
      difference.tail(of.rows.size()) += FourPoints::weights[k] * of.rows;
    }
  }
  /// Checks each member of the group with models in which only this member is perturbed. \throws InvalidInput if a
  /// member changes equations of objects outside its `affects`.
  template <class X>
  [[gnu::cold]] void settle(Group& group, Set const& set, X const& x, Index velocities) {
    std::shared_ptr<V> const itself = models_(nobody, 0);
    for (std::size_t const j : group.members)
      for (std::size_t k = 0; k < 2; ++k) require_named(j, *itself, *models_(j, k), x);
    note_rounding(x);
    for (std::size_t i = 0; i < group.equations.size(); ++i) {
      ValuesAtPlaces const f = group.at_places(set, i);
      double const rounding = Index(i) < velocities ? rounding_.balance : rounding_.rows;
      if (group.equations.is_doubtful(i, f, rounding)) group.equations.allow(i, f);
    }
  }

  std::vector<Parameter> parameters_;
  std::vector<Place> places_;
  std::vector<Group> groups_;
  Models models_;
  RoundingOfEquations rounding_;
};

}  // namespace polybody::detail
