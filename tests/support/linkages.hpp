#pragma once
/// \file Mechanisms of the IFToMM benchmark with closed loops.

#include <numbers>
#include <vector>

#include "support/chain.hpp"

namespace polybody {

/// Joints of one type, or of two.
template <class J, class K>
using JointsOf = std::conditional_t<std::is_same_v<J, K>, Joints<J>, Joints<J, K>>;

/// N windows of uniform rods of 1 m and 1 kg; upright, θ˙ = 1 rad/s [IFToMM A02] (R2). \tparam Where as for `Chain`;
/// `Loop` is the same for the pins that close loops
template <class Where, class Loop = Where>
struct FourBars {
  using Body = typename Where::Body;
  Model<Bodies<Body>, JointsOf<typename Where::Hinge, typename Loop::Hinge>> model{Gravity{0, -9.81, 0}};
  std::vector<BodyHandle<Body>> upright, across;
  State x;

  /// \param each number of copies of every pin
  explicit FourBars(int n, typename Where::PolicyType const& policy = {}, int each = 1) {
    Link const link = bar_link();
    for (int i = 0; i <= n; ++i)
      upright.push_back(model.add(Where::body(link, Placement::planar(i, 0.5, 0.5 * std::numbers::pi))));
    for (int i = 0; i < n; ++i) across.push_back(model.add(Where::body(link, Placement::planar(i + 0.5, 1.0))));
    auto const pin = Where::hinge(policy);
    auto const last = [&] {
      if constexpr (std::is_same_v<Where, Loop>)
        return pin;
      else
        return Loop::hinge({});
    }();
    auto const connect = [&](auto const& joint, auto const& from, auto const& to) {
      for (int k = 0; k < each; ++k) model.connect(joint, from, to);
    };
    for (int i = 0; i <= n; ++i)
      connect(pin, model.ground().at({double(i), 0, 0}), Where::at(upright[std::size_t(i)], -0.5));
    for (int i = 0; i < n; ++i) {
      connect(pin, Where::at(upright[std::size_t(i)], 0.5), Where::at(across[std::size_t(i)], -0.5));
      connect(last, Where::at(across[std::size_t(i)], 0.5), Where::at(upright[std::size_t(i) + 1], 0.5));
    }
    x = model.reference_state();
    for (int i = 0; i <= n; ++i) model.set_velocity(x, upright[std::size_t(i)], {0, double(i), 0}, {0, 0, -1});
    for (auto const& link_across : across) model.set_velocity(x, link_across, {1, 0, 0}, {0, 0, 0});
  }
  Vec3 corner() const { return position(model, x, Where::at(upright[0], 0.5)); }
};

/// Position of the corner of n windows at t: reference solution of the IFToMM benchmark A02 (R2).
struct Corner {
  int n;
  double t, x, y;
};
inline constexpr Corner breakpoints[] = {
    {1, 1, -0.2607126751836504, -0.9654164391590732},  {1, 4, 0.1589555042571178, 0.9872857477277616},
    {1, 10, 0.4783850577609706, 0.8781501787912093},   {2, 1, -0.1950203019494351, -0.9807992056621738},
    {2, 4, 0.1176161023768086, 0.9930591384513251},    {2, 10, 0.3284581115408154, 0.944518538178601},
    {40, 1, -0.1153568806321099, -0.9933241113004502}, {40, 4, 0.0693420322279992, 0.9975929443247336},
    {40, 10, 0.1805122266867284, 0.9835727405823116}};

/// The Bricard mechanism [IFToMM A04] (R4): five rods of 1 m and 1 kg of width h, and six pins. A count of constraint
/// equations does not give its one degree of freedom. With h = 0 the rods are thin, and their mass matrix is singular
/// as well.
/// \tparam Closing the policy of the last pin
template <class Policy = Constraint, class B = Rigid<>, class Closing = Policy>
struct Bricard {
  using Pin = Joint<Revolute, Policy>;
  using LastPin = Joint<Revolute, Closing>;
  Model<Bodies<B>, JointsOf<Pin, LastPin>> model{Gravity{0, -9.81, 0}};
  std::vector<BodyHandle<B>> rods;
  State x;

  explicit Bricard(double h, Policy const& policy = {}) : Bricard(h, policy, policy) {}
  /// \param each number of copies of every pin
  Bricard(double h, Policy const& policy, Closing const& closing, int each = 1) {
    Vec3 const points[] = {{0, 0, 0}, {1, 0, 0}, {1, -1, 0}, {1, -1, 1}, {0, -1, 1}, {0, 0, 1}};
    Vec3 const axes[] = {Vec3::UnitY(), Vec3::UnitZ(), Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ(), Vec3::UnitX()};
    double const own = h * h / 6.0, across = (1.0 + h * h) / 12.0;
    for (int i = 0; i < 5; ++i) {
      Vec3 const d = points[i + 1] - points[i];
      Mat3 const along = d * d.transpose();
      rods.push_back(model.add(
          B(1.0, own * along + across * (Mat3::Identity() - along), Placement::at(0.5 * (points[i] + points[i + 1]))),
          "rod " + std::to_string(i + 1)));
    }
    auto const end = [&](int rod, int point) {
      return rods[std::size_t(rod)].at(Vec3(points[point] - 0.5 * (points[rod] + points[rod + 1])));
    };
    for (int k = 0; k < 6 * each; ++k) {
      int const i = k / each;
      Pin const pin{Revolute{.axis = axes[i]}, policy};
      std::string const name = "pin " + std::to_string(i) + (k % each == 0 ? "" : ", once more");
      if (i == 0)
        model.connect(pin, model.ground().at(points[0]), end(0, 0), name);
      else if (i == 5)
        model.connect(LastPin{Revolute{.axis = axes[i]}, closing}, end(4, 5), model.ground().at(points[5]), name);
      else
        model.connect(pin, end(i - 1, i), end(i, i), name);
    }
    x = model.reference_state();
  }
  Vec3 p3() const { return position(model, x, rods[2].at(Vec3(0, 0, 0.5))); }
};

}  // namespace polybody
