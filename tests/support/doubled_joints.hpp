#pragma once
/// \file Comparison of a mechanism with the same mechanism with every joint twice.

#include <gtest/gtest.h>

#include <type_traits>
#include <vector>

#include <polybody/run/simulate.hpp>

namespace polybody {

/// Calls f(marker) for the marker with the index `published` in a model.
template <class M, class F>
void with_marker(M const& model, Index published, F const& f) {
  for (auto const& e : model.ground_markers())
    if (e.published == published) return f(model.ground().at(e.placement));
  std::apply(
      [&](auto const&... pools) {
        auto const among = [&]<class B>(detail::BodyPool<B> const& pool) {
          for (auto const& e : pool.markers)
            if (e.published == published) return f(Marker<B>{model.serial(), e.body, e.point});
        };
        (among(pools), ...);
      },
      model.body_pools());
}

/// Adds a second joint of the same type and at the same place for every joint of a mechanism with `model` and `x`.
template <class Mechanism>
void double_joints(Mechanism& mechanism) {
  auto& model = mechanism.model;
  std::apply(
      [&](auto const&... pools) {
        auto const twice = [&](auto const entries) {  // a copy, because the pool grows
          for (auto const& e : entries)
            with_marker(model, e.a, [&]<class A>(Marker<A> const& a) {
              with_marker(model, e.b, [&]<class B>(Marker<B> const& b) {
                if constexpr (!std::is_same_v<A, Ground> || !std::is_same_v<B, Ground>)
                  model.connect(e.joint, a, b, e.name + ", once more");
              });
            });
        };
        (twice(pools), ...);
      },
      model.joint_pools());
  State const before = mechanism.x;
  mechanism.x = model.reference_state();
  mechanism.x.q = before.q;
  mechanism.x.v = before.v;
}

/// Runs a mechanism with single joints and the same mechanism with doubled joints, and compares their motion and
/// multipliers. \param single, twice mechanisms with `model`, `x` \param off tolerance of the coordinates; that of the
/// velocities is 100 times as large
template <class M, class I>
void expect_same(M& single, M& twice, I const& integrator, RunOptions const& options, double off) {
  SCOPED_TRACE(I::name);
  auto one = simulate(single.model, single.x, integrator, options);
  auto two = simulate(twice.model, twice.x, integrator, options);
  VecX before_one = single.x.lambda, before_two = twice.x.lambda;
  double largest_one = largest_size(before_one), largest_two = largest_size(before_two), jump_one = 0, jump_two = 0;
  while (!one.done()) {
    one.advance();
    two.advance();
    ASSERT_LT(largest_size(VecX(single.x.q - twice.x.q)), off) << single.x.t;
    ASSERT_LT(largest_size(VecX(single.x.v - twice.x.v)), 100 * off) << single.x.t;
    largest_one = std::max(largest_one, largest_size(single.x.lambda));
    largest_two = std::max(largest_two, largest_size(twice.x.lambda));
    jump_one = std::max(jump_one, largest_size(VecX(single.x.lambda - before_one)));
    jump_two = std::max(jump_two, largest_size(VecX(twice.x.lambda - before_two)));
    before_one = single.x.lambda;
    before_two = twice.x.lambda;
  }
  EXPECT_FALSE(two.report().redundant.empty());
  EXPECT_LT(largest_two, 5 * largest_one);
  EXPECT_LT(jump_two, 5 * jump_one);
}
/// Doubles the joints of the mechanism that make() returns, and compares it with the single one: `expect_same`.
template <class Make, class I>
void expect_same_with_doubled_joints(Make const& make, I const& integrator, RunOptions const& options, double off) {
  auto single = make(), twice = make();
  double_joints(twice);
  expect_same(single, twice, integrator, options, off);
}

}  // namespace polybody
