#pragma once
/// \file
/// Check that each equation depends only on the parameter that names it, if parameters are perturbed together.
///
/// Not in polybody.hpp: few programs need derivatives of whole runs.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <polybody/gradients/parameter.hpp>

namespace polybody::detail {

/// Difference points (`FourPoints`) of the four models of a group, for one member.
using MemberOrder = std::array<std::uint8_t, 4>;

/// Orders of the four difference points, one for each member. No order equals another one or its mirror image.
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
/// Order of member r in a set of models. Sets differ in `of_orders`, a power of the number of orders n: member r has
/// the order number r/`of_orders` modulo n.
constexpr MemberOrder const& order_of_member(std::size_t r, std::size_t of_orders) {
  return member_orders[r / of_orders % member_orders.size()];
}

/// Changes of equations that may be due to round-off.
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

/// Values of an equation at the four difference points of its own parameter.
using ValuesAtPlaces = std::array<double, 4>;

/// Check that each equation depends only on the parameter that names it, for a group of parameters (members) that are
/// perturbed together in four models. The owner of an equation is the member whose `affects` names its object. An
/// equation without an owner must not change; any other equation must change with its owner only. Each member has
/// another order of the difference points, so the contribution of a second member is not linear in the difference
/// points of the owner. Curvature of an equation has the same effect, so a deviation does not prove a dependence.
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

  /// True if the change of equation i indicates a second parameter, by more than `rounding`.
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

}  // namespace polybody::detail
