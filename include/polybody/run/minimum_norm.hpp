#pragma once
/// \file
/// Minimum-norm multipliers of redundant constraints.

#include <polybody/math/sequence.hpp>
#include <polybody/run/initial_conditions.hpp>
#include <polybody/run/redundant_rows.hpp>

namespace polybody {

/// Computes minimum-norm multipliers of redundant constraints: of all multipliers with the same forces Gᵀλ, those of
/// least norm. Multiplier i is weighted by the wrench [fᵢ; mᵢ] that a unit multiplier exerts on the joint's second
/// body:
///   min Σ λᵢ² (|fᵢ|² + |mᵢ|²/ℓ²),   [fᵢ; mᵢ] = row i of Gb.
/// ℓ is the root mean square distance of the joint points from their mean (1 m if all coincide), so that the result
/// does not depend on the units. Compliant joints of equal stiffness k would share the load in this way if their
/// rotational stiffness were k ℓ². Multipliers of a body's own equations have the weight 1.
/// Theory: Eq. 7.13.
template <class = void>  // compiled only if used
class MinimumNormOf {
 public:
  /// Allocates the vectors for this system.
  explicit MinimumNormOf(System const& s) : relation_(s), weight_(VecX::Ones(s.rows())) {}

  /// Replaces x.lambda by the minimum-norm multipliers. The cost is one factorisation, and one solution for each
  /// redundant row.
  template <class Solver>
  void apply(System& system, ForwardDynamics<Solver>& forward, State& x) {
    if (system.rows() == 0) return;
    forward.hold(system, x.q, x.v, x.t);
    if (forward.redundant_rows().empty()) return;
    weigh(system);
    std::size_t count = 0;
    for (Index const i : forward.redundant_rows()) {  // a basis of the null space of Gᵀ, orthonormal under the weights
      if (!relation_.find(system, forward, i)) continue;
      VecX& c = relation_.c;
      for (int pass = 0; pass < 2; ++pass)
        for (std::size_t k = 0; k < count; ++k) add(-product(basis_[k], c), basis_[k], c);
      double const length = std::sqrt(product(c, c));
      for (Index k = 0; k < c.size(); ++k) c[k] /= length;
      add(-product(c, x.lambda), c, x.lambda);
      if (count == basis_.size()) basis_.emplace_back();
      basis_[count++] = c;
    }
  }

 private:
  double product(VecX const& a, VecX const& b) {
    double sum = 0.0;
    for (Index i = 0; i < a.size(); ++i) sum += a[i] * (b[i] * weight_[i]);
    return sum;
  }

  static void add(double factor, VecX const& b, VecX& to) {
    for (Index i = 0; i < b.size(); ++i) to[i] += factor * b[i];
  }

  void weigh(System const& system) {
    Vec3 mean = Vec3::Zero();
    double joints = 0.0, spread = 0.0;
    auto const each = [&](auto&& f) {
      for (ConstraintBlock<double> const& block : system.data().rows)
        if (block.source == ConstraintSource::joint)
          f(block, system.data().markers[std::size_t(block.b.marker)].frame.r);
    };
    each([&](ConstraintBlock<double> const&, Vec3 const& place) {
      for (int i = 0; i < 3; ++i) mean[i] += place[i];
      joints += 1.0;
    });
    for (int i = 0; i < 3; ++i) mean[i] /= std::max(joints, 1.0);
    each([&](ConstraintBlock<double> const&, Vec3 const& place) {
      spread += squared_norm(difference(place, mean)) / joints;
    });
    double const arm2 = spread > 1e-20 * squared_norm(mean) ? spread : 1.0;
    each([&](ConstraintBlock<double> const& block, Vec3 const&) {
      for (int i = 0; i < block.rows; ++i) {
        double f2 = 0.0, m2 = 0.0;
        for (int j = 0; j < 3; ++j) {
          double const f = block.b.map[block.rows * j + i], m = block.b.map[block.rows * (3 + j) + i];
          f2 += f * f;
          m2 += m * m;
        }
        double const w = f2 + m2 / arm2;
        weight_[block.row + i] = w > 0.0 ? w : 1.0;
      }
    });
  }

  detail::ConstraintDependence<> relation_;
  VecX weight_;
  Sequence<VecX> basis_;
};

using MinimumNorm = MinimumNormOf<>;  ///< computes minimum-norm multipliers

/// Multipliers of least norm with the same forces Gᵀλ as those of x (`MinimumNorm`). \throws InvalidInput for a state
/// of another model.
template <LinearSolver Solver = DefaultSolver>
VecX minimum_norm_multipliers(System& system, State const& x) {
  require_fitting(system, x);
  require_places(system, x);
  ForwardDynamics<Solver> forward(system);
  State shared = x;
  if (system.rows() > 0) leave_out_redundant(system, forward, x);
  MinimumNormOf<>(system).apply(system, forward, shared);
  return shared.lambda;
}
/// Minimum-norm multipliers of state x of a model.
template <LinearSolver Solver = DefaultSolver, class M>
VecX minimum_norm_multipliers(M const& model, State const& x) {
  System system(model, with<Capabilities::motion>);
  return minimum_norm_multipliers<Solver>(system, x);
}

}  // namespace polybody
