#pragma once
#include <polybody/joints/policies/constraint.hpp>
#include <polybody/joints/policies/penalty.hpp>

namespace polybody {

/// A joint is a geometry (which motions it stops) and a policy (how it stops them).
template <JointGeometry G, Policy P>
struct Joint {
  using Geometry = G;
  using PolicyType = P;
  static constexpr int rows = G::rows;
  G geometry = {};
  P policy = {};
};

}  // namespace polybody
