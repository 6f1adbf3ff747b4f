#pragma once
/// \file
/// Small vibrations about an equilibrium.
/// Theory: Eqs. 7.22 to 7.24, 11.12.

#include <algorithm>
#include <complex>
#include <limits>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <polybody/math/symmetric_pencil.hpp>
#include <polybody/run/state_checks.hpp>
#include <polybody/solvers/linear_solver.hpp>
#include <polybody/system/make_operations.hpp>
#include <polybody/system/system.hpp>

namespace polybody {

/// Linearised equations of motion about an equilibrium q₀, with q = q₀ ⊞ δ, as dense matrices [Géradin & Rixen 2015]:
///   M δ̈ + D δ̇ + K δ + Gᵀ μ = 0,  G δ = 0.
/// With the generalised forces f, D = −∂f/∂v. The stiffness K = −∂f/∂q + ∂(Gᵀλ)/∂q contains all second-order terms. A
/// basis N of the null space of G, δ = N z, eliminates the constraint equations. Redundant constraints are therefore
/// allowed.
///
/// A first-order state is represented as the rate of an additional coordinate on which no other quantity depends. Its
/// diagonal entry of M is one, and its column of K is zero. The last columns of N are unit vectors of these
/// coordinates. vibration/steady_rotation.hpp linearises about a steady rotation.
struct Linearisation {
  MatX M, D, K;      ///< mass, damping and stiffness (nv×nv)
  MatX G;            ///< constraint Jacobian (rows×nv)
  MatX N;            ///< null space of G (nv×free), orthonormal, G N = 0
  Index states = 0;  ///< number of first-order states, the last entries of δ̇
};

namespace detail {
/// Sink that adds blocks to a dense matrix.
struct DenseSink {
  MatX& sum;
  void add(Index row, Index col, BlockView const& b) {
    for (Index j = 0; j < b.cols; ++j)
      for (Index i = 0; i < b.rows; ++i) sum(row + i, col + j) += b(i, j);
  }
};

template <class = void>
MatX dense_tangent(System& system, TangentCoefficients const& c, VecX const& lambda) {
  MatX sum = MatX::Zero(system.size(), system.size());
  DenseSink sink{sum};
  system.tangent(c, SecondOrder::included, lambda, sink);
  return sum;
}

/// Orthonormal basis N of the null space of G, G N = 0. The last `states` columns are unit vectors of the first-order
/// states, which occur in no constraint equation.
template <class = void>  // compiled where it is used
MatX free_motions(MatX const& g, Index states = 0) {
  if (g.rows() == 0) return MatX::Identity(g.cols(), g.cols());
  Index const bodies = g.cols() - states;
  Eigen::ColPivHouseholderQR<MatX> qr(g.leftCols(bodies).transpose());
  qr.setThreshold(1e-10);
  MatX const q = qr.householderQ();
  Index const free = bodies - qr.rank();
  MatX n = MatX::Zero(g.cols(), free + states);
  n.topLeftCorner(bodies, free) = q.rightCols(free);
  n.bottomRightCorner(states, states).setIdentity();
  return n;
}

/// Least-squares solution of A x = b with minimum norm; pivots below `threshold` times the largest pivot count as zero.
template <class = void>
MatX smallest_solution(MatX const& a, MatX const& b, double threshold) {
  Eigen::CompleteOrthogonalDecomposition<MatX> solver(a.rows(), a.cols());
  solver.setThreshold(threshold);
  solver.compute(a);
  return solver.solve(b);
}

/// Checks that `count` is at least 1. \throws InvalidInput otherwise, with a message that begins with `who`.
inline void require_modes(Index count, std::string const& who) {
  if (count < 1)
    throw InvalidInput("modes.count",
                       {ErrorObject{who}, ": the number of modes must be at least 1, but is ", ErrorValue{count}, "."});
}

/// Stiffness K plus a spring on each motion y that has neither inertia nor stiffness: M y = 0 and K y = 0. The columns
/// of v are all motions without inertia. The springs do not change the solutions of K x = λ M x with yᵀx = 0.
template <class = void>
MatX with_springs_at_rest(MatX const& k, MatX const& v) {
  MatX out = k;
  if (v.cols() == 0) return out;
  Eigen::SelfAdjointEigenSolver<MatX> const own(v.transpose() * k * v);
  double const least = 1e-12 * k.norm();
  double spring = std::numeric_limits<double>::infinity();
  for (double const x : k.diagonal())
    if (std::abs(x) > 0.0) spring = std::min(spring, std::abs(x));
  for (Index i = 0; i < v.cols(); ++i)
    if (VecX const y = v * own.eigenvectors().col(i); std::abs(own.eigenvalues()[i]) <= least && std::isfinite(spring))
      out += spring * y * y.transpose();
  return out;
}

/// Projection Nᵀ A N of a matrix A onto the basis N.
template <class = void>
MatX of_free_motions(MatX const& n, MatX const& a) {
  MatX const an = a * n;
  return n.transpose() * an;
}
}  // namespace detail

/// Linearisation about a state x at rest. The multipliers of x contribute to the stiffness, for example in a hanging
/// pendulum. A model in steady rotation is linearised with its `SteadyRotation`. Other motions are refused, because
/// their matrices depend on time.
/// \throws InvalidInput if x moves.
template <class = void>
Linearisation linearise(System& system, State const& x) {
  require_usable(system, x);
  Index const states = system.layout().states;
  VecX const velocities = x.v.head(x.v.size() - states);
  if (velocities.size() && velocities.cwiseAbs().maxCoeff() > 1e-9)
    throw InvalidInput("modes.not_at_rest",
                       {ErrorObject{"modes"}, ": the state must be at rest, but the largest velocity is ",
                        ErrorValue{velocities.cwiseAbs().maxCoeff()},
                        ". Use a state from equilibrium(model, x). For a steady rotation "
                        "use linearise(model, x, SteadyRotation{...}) of vibration/steady_rotation.hpp."});
  system.evaluate(x.q, x.v, x.t);
  Index const nv = system.velocities(), rows = system.rows();
  Linearisation l;
  l.M = detail::dense_tangent(system, {.mass = 1.0}, x.lambda).topLeftCorner(nv, nv);
  l.D = detail::dense_tangent(system, {.damping = 1.0}, x.lambda).topLeftCorner(nv, nv);
  MatX const k = detail::dense_tangent(system, {.stiffness = 1.0}, x.lambda);
  l.K = k.topLeftCorner(nv, nv);
  l.G = k.bottomLeftCorner(rows, nv);
  l.N = detail::free_motions(l.G, states);
  l.states = states;
  return l;
}

/// Overload for a model.
template <class M>
Linearisation linearise(M const& model, State const& x) {
  System system(model, with<Capabilities::implicit_step>);
  return linearise(system, x);
}

/// Undamped modes in the order of frequency.
struct Modes {
  VecX frequency;  ///< (k) ω [rad/s], ascending; −√(−ω²) if ω² < 0, in an unstable state
  MatX shape;      ///< (nv×k) shapes δ, one entry per generalised velocity, shapeᵀ M shape = 1
};

/// Computes the `count` lowest modes of M δ̈ + K δ + Gᵀμ = 0 by a dense solver, for models of up to some hundred
/// generalised velocities. Motions without inertia have no frequency and are omitted. K is symmetrised and D is
/// neglected. Use `damped_modes` for follower loads, whose K is not symmetric, and for rotating models, whose D is
/// gyroscopic. Frequencies far below the highest frequency are computed accurately (math/symmetric_pencil.hpp). \throws
/// InvalidInput for a `count` below 1, and for a model with first-order states.
template <class = void>  // compiled where it is used
Modes modes(Linearisation const& l, Index count = 10) {
  detail::require_modes(count, "modes");
  if (l.states > 0)
    throw InvalidInput("modes.first_order_states",
                       {ErrorObject{"modes"},
                        ": the model has first-order states, so undamped modes do not exist. Use damped_modes."});
  MatX const full = detail::of_free_motions(l.N, l.K), k = 0.5 * (full + full.transpose()),
             m = detail::of_free_motions(l.N, l.M);
  if (m.rows() == 0) return {};
  // m = V diag(d) Vᵀ. Motions without inertia (2) follow those with inertia (1) statically: K₂₂ z₂ = −K₂₁ z₁
  Eigen::SelfAdjointEigenSolver<MatX> const inertia(m);
  VecX const& d = inertia.eigenvalues();
  Index const n = d.size();
  Index still = 0;
  while (still < n && d[still] <= 1e-13 * d[n - 1]) ++still;
  MatX const v1 = inertia.eigenvectors().rightCols(n - still), v2 = inertia.eigenvectors().leftCols(still);
  MatX basis = v1;
  if (still > 0) {
    MatX const k22 = v2.transpose() * k * v2, k21 = v2.transpose() * k * v1;
    if (k22.norm() > 1e-12 * k.norm()) basis -= v2 * detail::smallest_solution(k22, k21, 1e-12);
  }
  VecX const scale = d.tail(n - still).cwiseSqrt().cwiseInverse();
  MatX const scaled = basis * scale.asDiagonal();
  Eigen::SelfAdjointEigenSolver<MatX> const solved(scaled.transpose() * k * scaled);
  VecX squares = solved.eigenvalues();
  MatX shapes = scaled * solved.eigenvectors();
  if (!renew_low_end(detail::with_springs_at_rest(k, v2), m, count, squares, shapes)) {
    shapes = scale.asDiagonal() * solved.eigenvectors();
    renew_low_end<>(basis.transpose() * k * basis, d.tail(n - still).asDiagonal(), count, squares, shapes);
    shapes = MatX(basis * shapes);
  }
  Index const kept = std::min(count, n - still);
  Modes out;
  out.frequency = squares.head(kept).unaryExpr([](double w2) { return w2 < 0.0 ? -std::sqrt(-w2) : std::sqrt(w2); });
  out.shape = l.N * shapes.leftCols(kept);
  return out;
}
/// Computes the `count` lowest modes about x, an equilibrium at rest. \throws InvalidInput if x moves.
template <class S>
Modes modes(S const& model, State const& x, Index count = 10) {
  return modes(linearise(model, x), count);
}

/// Damped modes δ = Re(shape e^{s t}).
struct DampedModes {
  Eigen::VectorXcd eigenvalue;  ///< (k) s [1/s], ordered by |s|; one per conjugate pair, Im s ≥ 0
  Eigen::MatrixXcd shape;       ///< (nv×k) shapes; the entry of a first-order state is its value, not its integral
  /// Frequency |s| [rad/s] of mode i.
  double frequency(Index i) const { return std::abs(eigenvalue[i]); }
  /// Damping ratio −Re s/|s| of mode i.
  double damping_ratio(Index i) const { return -eigenvalue[i].real() / std::abs(eigenvalue[i]); }
};

/// Computes the `count` slowest modes of M δ̈ + D δ̇ + K δ + Gᵀμ = 0 by a dense solver. With δ = N z, the unit of
/// time 1/τ and y = (z, ż/τ) the state matrix is A = [0, 1; −M̂⁻¹K, −M̂⁻¹D̂], M̂ = τ² M, D̂ = τ D. The eigenvalues of
/// the shifted inverse about s = τ are computed, which does not require M⁻¹:
///   (A − 1)⁻¹ = [−Y, −Z; 1 − Y, −Z],  Y = Q⁻¹ (M̂ + D̂),  Z = Q⁻¹ M̂,  Q = M̂ + D̂ + K,  s = τ (1 + 1/μ).
/// Slow motions have the largest |μ| and are therefore accurate even if the model also has fast motions. τ is at most
/// 0.7 times the lowest nonzero frequency of M z̈ + K z = 0. Free motions of the model come first, with an |s| of the
/// order of the square root of the round-off.
///
/// Each first-order state adds one mode. The additional coordinates with these states as rates occur in no equation and
/// are removed from the matrix.
/// \throws InvalidInput if a motion that the constraint equations permit has no inertia, and for a `count` below 1.
template <class = void>  // compiled where it is used
DampedModes damped_modes(Linearisation const& l, Index count = 10) {
  detail::require_modes(count, "damped_modes");
  MatX m = detail::of_free_motions(l.N, l.M), d = detail::of_free_motions(l.N, l.D);
  MatX const k = detail::of_free_motions(l.N, l.K);
  Index const n = m.rows(), bodies = n - l.states;
  if (n == 0) return {};
  MatX const k_bodies = k.topLeftCorner(bodies, bodies), m_bodies = m.topLeftCorner(bodies, bodies);
  double slowest = 0.0;
  if (bodies > 0) {
    Eigen::LLT<MatX> const inertia(m_bodies);
    VecX const pivots = inertia.matrixLLT().diagonal();
    if (inertia.info() != Eigen::Success || pivots.minCoeff() <= 1e-7 * pivots.maxCoeff())
      throw InvalidInput(
          "modes.no_inertia",
          {ErrorObject{"damped_modes"},
           ": a motion that the joints permit has no inertia. Constrain this motion or give it inertia."});
    slowest = detail::smallest_solution(k_bodies, m_bodies, 1e-9).norm();  // at least 1/ω² of the lowest ω
  }
  double const tau = slowest > 0.0 ? 0.7 / std::sqrt(slowest) : 1.0;
  m *= tau * tau;
  d *= tau;
  MatX inverse(2 * n, 2 * n);
  inverse.topLeftCorner(n, n) = -m - d;
  inverse.topRightCorner(n, n) = -m;
  inverse.topRows(n) = MatX(m + d + k).partialPivLu().solve(inverse.topRows(n).eval());
  inverse.bottomRows(n) = inverse.topRows(n);
  inverse.bottomLeftCorner(n, n).diagonal().array() += 1.0;
  if (l.states > 0) {
    inverse.middleRows(bodies, n) = inverse.bottomRows(n).eval();
    inverse.middleCols(bodies, n) = inverse.rightCols(n).eval();
    inverse.conservativeResize(bodies + n, bodies + n);
  }
  Eigen::EigenSolver<MatX> const solved(inverse);
  Eigen::VectorXcd const s = tau * (1.0 + solved.eigenvalues().array().inverse());
  std::vector<Index> order;
  for (Index i = 0; i < s.size(); ++i)
    if (s[i].imag() >= 0.0) order.push_back(i);
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return std::abs(s[a]) < std::abs(s[b]); });
  order.resize(std::min(order.size(), std::size_t(count)));
  DampedModes out;
  out.eigenvalue.resize(Index(order.size()));
  out.shape.resize(l.N.rows(), Index(order.size()));
  Eigen::MatrixXcd const vectors = solved.eigenvectors();
  for (std::size_t i = 0; i < order.size(); ++i) {
    out.eigenvalue[Index(i)] = s[order[i]];
    Eigen::VectorXcd motion = vectors.col(order[i]).head(n);
    motion.tail(l.states) = tau * vectors.col(order[i]).tail(l.states);
    out.shape.col(Index(i)) = l.N * motion;
  }
  return out;
}
/// Computes the `count` slowest modes about x, a state at rest. \throws InvalidInput if x moves, or if a motion that
/// the constraint equations permit has no inertia.
template <class S>
DampedModes damped_modes(S const& model, State const& x, Index count = 10) {
  return damped_modes(linearise(model, x), count);
}

}  // namespace polybody
