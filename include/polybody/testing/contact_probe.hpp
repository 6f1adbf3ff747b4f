#pragma once
/// \file
/// Functions that return the contact point of a contact geometry for two frames, and whether the shapes overlap.
///
/// Requires GoogleTest.

#include <gtest/gtest.h>

#include <polybody/forces/contact.hpp>

namespace polybody::laws {

using Touching = std::array<Frame<double>, 2>;  ///< frames of the two shapes of a contact geometry

/// Returns the contact point of `geometry`. The test fails unless there is exactly one.
template <StateScalar T, class G>
ContactPoint<T> point_of(G const& geometry, Frame<T> const& a, Frame<T> const& b) {
  ContactPoint<T> found;
  int count = 0;
  geometry.template for_each_point<T>(a, b, [&](ContactPoint<T> const& p) {
    found = p;
    ++count;
  });
  EXPECT_EQ(count, 1);
  return found;
}
/// True if the shapes of `geometry` overlap for the frames f.
template <class G>
bool touch(G const& geometry, Touching const& f) {
  int count = 0;
  geometry.template for_each_point<double>(f[0], f[1], [&](ContactPoint<double> const&) { ++count; });
  return count > 0;
}

}  // namespace polybody::laws
