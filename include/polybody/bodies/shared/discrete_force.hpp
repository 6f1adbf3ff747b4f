#pragma once
/// \file
/// Concept of bodies with a discrete-gradient force for energy-conserving steps.
#include <polybody/bodies/shared/node_chain.hpp>

namespace polybody {

/// Coefficients of the stress in a discrete-gradient step. With the mean ε̄ and the change Δε of a strain over the
/// step, the stress is computed from the strain ε̄ + decay Δε and the strain rate ε̇ = rate Δε.
struct DiscreteDerivative {
  double rate = 0.0;   ///< 1/h [1/s]
  double decay = 0.0;  ///< numerical dissipation [1]: a step dissipates decay C Δε², C: stiffness; 0 for none
};

/// Body of constant mass whose coordinates form a vector space. It computes a discrete-gradient force f over a step
/// from q₀ to q₁: f·Δq is −ΔU minus the dissipated energy.
template <class B>
concept HasDiscreteForce =
    std::is_base_of_v<AddingCoordinates, B> && B::constant_mass &&
    requires(B const b, Index e, std::span<double const> q, DiscreteDerivative means,
             Vec<double, B::element_columns>& f, Mat<double, B::element_columns, B::element_columns>& k) {
      b.discrete_force(e, q, q, means, f);
      b.discrete_tangent(e, q, q, means, 1.0, k);
    };

}  // namespace polybody
