#pragma once
/// \file
/// Base classes of bodies whose coordinates form a vector space: `AddingCoordinates`, and `NodeChain` for chains of
/// nodes. `HasDiscreteForce` is the concept of their discrete-gradient force.

#include <polybody/bodies/shared/body.hpp>

namespace polybody {

/// Coordinates that add: q ⊞ δ = q + δ, and δ˙ is the vector of generalised velocities.
struct AddingCoordinates {
  template <StateScalar T>
  void plus(std::span<T const> q, std::span<T const> delta, std::span<T> out) const {
    for (std::size_t i = 0; i < q.size(); ++i) out[i] = q[i] + delta[i];
  }
  template <StateScalar T>
  void local_rate(std::span<T const>, std::span<T const> v, std::span<T> out) const {
    for (std::size_t i = 0; i < v.size(); ++i) out[i] = v[i];
  }
};

/// Chain of n elements between n + 1 nodes, each with `columns` coordinates, stored one node after another.
template <int columns>
class NodeChain : public AddingCoordinates {
 public:
  static constexpr int node_columns = columns;  ///< number of coordinates of a node
  static constexpr int element_columns = 2 * columns;
  static constexpr int point_columns = element_columns;
  static constexpr int element_stride = columns;

  Index coordinates() const { return (n_ + 1) * columns; }
  Index velocities() const { return coordinates(); }
  Index elements() const { return n_; }
  Index first_column(Index e) const { return e * columns; }
  /// First column of the element that contains the point p.
  template <class P>
    requires requires(P p) { p.element; }
  Index first_column(P const& p) const {
    return first_column(p.element);
  }
  /// Number of the node in whose section the point p is; −1 between nodes. Only for nodes (x, y, θ) (`HasFrameNodes`).
  template <class P>
  static Index node_of(P const& p)
    requires(columns == 3)
  {
    return p.xi < 1e-12 ? p.element : p.xi > 1.0 - 1e-12 ? p.element + 1 : -1;
  }
  /// Vector from the node of p to p, in the axes of its section [m].
  template <class P>
  static Vec3 node_arm(P const& p)
    requires(columns == 3)
  {
    return {0.0, p.y, 0.0};
  }
  /// Copy of the point p for a chain that consists only of the element of p.
  template <class P>
    requires requires(P p) { p.element; }
  P local(P p) const {
    p.element = 0;
    return p;
  }

 protected:
  explicit NodeChain(Index n) : n_(n) {}  ///< chain of n elements
  Index n_;                               ///< number of elements
};

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
