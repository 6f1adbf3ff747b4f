#pragma once
/// \file
/// The equations of parameters that are differenced together, with a check that each changes with its owner only.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <polybody/gradients/parameter.hpp>

namespace polybody::detail {

/// The places of the four models of a group for one member.
using MemberOrder = std::array<std::uint8_t, 4>;

/// Orders of members. No order is another one or its mirror image.
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
/// The order of member r in the set of models that separates the members by the digits of r/`of_orders`.
constexpr MemberOrder const& order_of_member(std::size_t r, std::size_t of_orders) {
  return member_orders[r / of_orders % member_orders.size()];
}

/// Changes of equations that may be due to round-off.
struct RoundingOfEquations {
  double balance = -1.0, rows = 0.0;  ///< negative: not known
};
/// The size of the numbers that cancel in the rows at x, a state or a place of a step.
template <class X>
double size_of_rows(X const& x) {
  double const size = std::max({1.0, largest_size(x.q), largest_size(x.v), largest_size(x.a)});
  if constexpr (requires { x.terms; }) return size * std::max({1.0, x.terms.rate, x.terms.position});
  return size;
}

/// Values of an equation at the four places of its own parameter.
using ValuesAtPlaces = std::array<double, 4>;

/// The equations of a group of parameters. An equation without an owner must not change. An equation with an owner
/// must change with its owner only: the contribution of a second member, which has another order, is not linear in
/// the place of the owner. Curvature of an equation has the same effect, so a difference here does not prove a
/// dependence.
class SharedEquations {
 public:
  static constexpr std::size_t nobody = std::size_t(-1);  ///< in place of the rank of an owner

  /// As many equations, without owners.
  explicit SharedEquations(std::size_t size) : owner_(size, nobody), doubts_(size) {}

  std::size_t size() const { return owner_.size(); }            ///< how many equations there are
  std::size_t owner(std::size_t i) const { return owner_[i]; }  ///< the rank of the member that names equation i
  bool is_complete() const { return is_complete_; }             ///< one member owns all equations
  bool are_free(std::vector<Index> const& equations) const {    ///< no member owns one of them
    return std::all_of(equations.begin(), equations.end(), [&](Index i) { return owner_[std::size_t(i)] == nobody; });
  }
  /// Another member becomes the owner of `equations`.
  void add(std::vector<Index> const& equations) {
    for (Index const i : equations) owner_[std::size_t(i)] = members_;
    ++members_;
    is_complete_ = equations.size() == owner_.size();
  }
  /// Another evaluation begins. Returns its number.
  std::size_t begin() { return evaluations_++; }

  /// The values of equation i change as if a second parameter changed it, by more than `rounding`.
  bool is_doubtful(std::size_t i, ValuesAtPlaces const& f, double rounding) const {
    auto const [left, change] = unexplained(i, f);
    return left > rounding + doubts_[i].tolerance * change && evaluations_ >= doubts_[i].next;
  }
  /// A doubt has turned out to be curvature: the tolerance of the equation grows, or after a kink its check pauses.
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
    double tolerance = 1e-5;          // relative to the change by the owner: the effect of curvature
    std::size_t next = 0, pause = 0;  // number of the evaluation with the next check, and of evaluations without one
  };

  /// The part of the values that is not due to the owner, and their change.
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
