#pragma once
#include <polybody/bodies/shared/node_chain.hpp>

namespace polybody {

/// Coefficients of the strains over a step that conserves energy: mean strain ε̄ + decay Δε, and strain rate ε̇ = rate
/// Δε.
struct DiscreteDerivative {
  double rate = 0.0;   ///< 1/h [1/s]
  double decay = 0.0;  ///< factor of C Δε·Δε, the energy that is dissipated; 0 conserves energy
};

/// Body of constant mass whose coordinates form a vector space, with its elastic and damping force over a step from q₀
/// to q₁: f·Δq = −ΔU minus the dissipated energy.
template <class B>
concept HasDiscreteForce =
    std::is_base_of_v<AddingCoordinates, B> && B::constant_mass &&
    requires(B const b, Index e, std::span<double const> q, DiscreteDerivative means,
             Vec<double, B::element_columns>& f, Mat<double, B::element_columns, B::element_columns>& k) {
      b.discrete_force(e, q, q, means, f);
      b.discrete_tangent(e, q, q, means, 1.0, k);
    };

}  // namespace polybody
