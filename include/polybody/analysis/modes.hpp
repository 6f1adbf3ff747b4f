#pragma once
/// \file
/// Small vibrations about a state of rest: with q = q₀ ⊞ δ,
///   M δ̈ + D δ̇ + K δ + Gᵀ μ = 0,  G δ = 0,
/// K = −∂f/∂q + ∂(Gᵀλ)/∂q with every second-order term, D = −∂f/∂v [Shabana 2018, Ch. 4]. The rows are eliminated by a basis N of the null space
/// of G, δ = N z, so redundant rows do no harm.
///
/// Not in polybody.hpp: Eigen's eigenvalue solvers would cost every program seconds to compile.

#include <complex>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <polybody/solvers/linear_solver.hpp>
#include <polybody/system/system.hpp>

namespace polybody {

/// The matrices about a state, dense; and a basis of the motions that the rows leave free.
struct Linearisation {
  MatX M, D, K;  ///< (nv×nv)
  MatX G;        ///< (rows×nv)
  MatX N;        ///< (nv×free) orthonormal, G N = 0
};

namespace detail {
/// Adds up blocks in a dense matrix.
struct DenseSink {
  MatX& sum;
  void add(Index row, Index col, BlockView const& b) {
    for (Index j = 0; j < b.cols; ++j)
      for (Index i = 0; i < b.rows; ++i) sum(row + i, col + j) += b(i, j);
  }
};

template <class S>
MatX dense_tangent(System<S>& system, TangentCoefficients const& c, VecX const& lambda) {
  MatX sum = MatX::Zero(system.size(), system.size());
  DenseSink sink{sum};
  system.tangent(c, SecondOrder::included, lambda, sink);
  return sum;
}
}  // namespace detail

/// About state x; its multipliers count (a hanging pendulum swings by them). \throws InvalidInput when x moves.
template <class S>
Linearisation linearise(S const& model, State const& x) {
  if (x.v.size() && x.v.cwiseAbs().maxCoeff() > 1e-9)
    throw InvalidInput("modes: the state must be at rest; take one from equilibrium(model, x).");
  System<S> system(model);
  system.evaluate(x.q, x.v, x.t);
  Index const nv = system.speeds(), rows = system.rows();
  Linearisation l;
  l.M = detail::dense_tangent(system, {.mass = 1.0}, x.lambda).topLeftCorner(nv, nv);
  l.D = detail::dense_tangent(system, {.damping = 1.0}, x.lambda).topLeftCorner(nv, nv);
  MatX const k = detail::dense_tangent(system, {.stiffness = 1.0}, x.lambda);
  l.K = k.topLeftCorner(nv, nv);
  l.G = k.bottomLeftCorner(rows, nv);
  if (rows == 0) {
    l.N = MatX::Identity(nv, nv);
  } else {
    Eigen::ColPivHouseholderQR<MatX> qr(l.G.transpose());
    qr.setThreshold(1e-10);
    MatX const q = qr.householderQ();
    l.N = q.rightCols(nv - qr.rank());
  }
  return l;
}

/// Undamped modes, by frequency.
struct Modes {
  VecX frequency;  ///< (k) ω [rad/s], ascending; −√(−ω²) where the state is unstable
  MatX shape;      ///< (nv×k) δ by speeds, shapeᵀ M shape = 1
};

/// The `count` lowest modes of M δ̈ + K δ + Gᵀμ = 0 about x, a state of rest in equilibrium, by a dense solver: for models of up to some
/// hundred speeds. Motions without inertia have no frequency and are left out. K is symmetrised: follower loads, whose K is not, belong to
/// `damped_modes`. \throws InvalidInput when x moves.
template <class S>
Modes modes(S const& model, State const& x, Index count = 10) {
  Linearisation const l = linearise(model, x);
  MatX const k = l.N.transpose() * (0.5 * (l.K + l.K.transpose())) * l.N, m = l.N.transpose() * l.M * l.N;
  // motions with inertia first: m = V diag(d) Vᵀ; the others follow without delay, K₂₂ z₂ = −K₂₁ z₁
  Eigen::SelfAdjointEigenSolver<MatX> const inertia(m);
  VecX const& d = inertia.eigenvalues();
  Index const n = d.size();
  Index still = 0;
  while (still < n && d[still] <= 1e-13 * d[n - 1]) ++still;
  MatX const v1 = inertia.eigenvectors().rightCols(n - still), v2 = inertia.eigenvectors().leftCols(still);
  MatX basis = v1;
  if (still > 0) {
    MatX const k22 = v2.transpose() * k * v2, k21 = v2.transpose() * k * v1;
    if (k22.norm() > 1e-12 * k.norm()) basis -= v2 * k22.completeOrthogonalDecomposition().solve(k21);
  }
  VecX const scale = d.tail(n - still).cwiseSqrt().cwiseInverse();
  basis = basis * scale.asDiagonal();
  Eigen::SelfAdjointEigenSolver<MatX> const solved(basis.transpose() * k * basis);
  Index const kept = std::min(count, n - still);
  Modes out;
  out.frequency = solved.eigenvalues().head(kept).unaryExpr([](double w2) { return w2 < 0.0 ? -std::sqrt(-w2) : std::sqrt(w2); });
  out.shape = l.N * basis * solved.eigenvectors().leftCols(kept);
  return out;
}

/// Damped modes δ = Re(shape e^{s t}).
struct DampedModes {
  Eigen::VectorXcd eigenvalue;  ///< (k) s [1/s], by |s|; of conjugate pairs the one above the real axis
  Eigen::MatrixXcd shape;       ///< (nv×k)
  /// Frequency |s| [rad/s] and damping ratio −Re s/|s| of mode i.
  double frequency(Index i) const { return std::abs(eigenvalue[i]); }
  double damping_ratio(Index i) const { return -eigenvalue[i].real() / std::abs(eigenvalue[i]); }
};

/// The `count` slowest modes of M δ̈ + D δ̇ + K δ + Gᵀμ = 0 about x, from the dense state matrix [0, 1; −M⁻¹K, −M⁻¹D] of the free motions.
/// \throws InvalidInput when x moves, or when a free motion has no inertia.
template <class S>
DampedModes damped_modes(S const& model, State const& x, Index count = 10) {
  Linearisation const l = linearise(model, x);
  MatX const m = l.N.transpose() * l.M * l.N;
  Eigen::LLT<MatX> const inertia(m);
  Index const n = m.rows();
  if (inertia.info() != Eigen::Success || inertia.matrixLLT().diagonal().minCoeff() <= 1e-7 * inertia.matrixLLT().diagonal().maxCoeff())
    throw InvalidInput("damped_modes: a free motion of the model has no inertia; hold it or give it some.");
  MatX state = MatX::Zero(2 * n, 2 * n);
  state.topRightCorner(n, n).setIdentity();
  state.bottomLeftCorner(n, n) = -inertia.solve(l.N.transpose() * l.K * l.N);
  state.bottomRightCorner(n, n) = -inertia.solve(l.N.transpose() * l.D * l.N);
  Eigen::EigenSolver<MatX> const solved(state);
  std::vector<Index> order;
  for (Index i = 0; i < 2 * n; ++i)
    if (solved.eigenvalues()[i].imag() >= 0.0) order.push_back(i);
  std::sort(order.begin(), order.end(),
            [&](Index a, Index b) { return std::abs(solved.eigenvalues()[a]) < std::abs(solved.eigenvalues()[b]); });
  order.resize(std::min(order.size(), std::size_t(count)));
  DampedModes out;
  out.eigenvalue.resize(Index(order.size()));
  out.shape.resize(l.N.rows(), Index(order.size()));
  Eigen::MatrixXcd const vectors = solved.eigenvectors();
  for (std::size_t i = 0; i < order.size(); ++i) {
    out.eigenvalue[Index(i)] = solved.eigenvalues()[order[i]];
    out.shape.col(Index(i)) = l.N * vectors.col(order[i]).head(n);
  }
  return out;
}

}  // namespace polybody
