#pragma once
#include <string>

#include <polybody/bodies/shared/body.hpp>
#include <polybody/joints/policies/policy.hpp>

namespace polybody {

/// One choice of each: how bodies are described, how joints are enforced, how time is integrated.
/// `compare` runs one case under several of them.
template <Body B, Policy P, class I>
struct Formulation {
  using BodyType = B;
  using PolicyType = P;
  using IntegratorType = I;

  std::string name;
  P policy = {};
  I integrator = {};
};

}  // namespace polybody
