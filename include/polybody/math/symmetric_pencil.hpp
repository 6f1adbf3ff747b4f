#pragma once
/// \file
/// Lowest eigenvalues and eigenvectors of K x = λ M x with symmetric K and M, computed with a shift.
///
/// Solvers that form M^-½ K M^-½ have errors of ε λₙ in every λ, with the round-off unit ε and the largest eigenvalue
/// λₙ. In a thin rod λₙ belongs to shear waves of single elements and can exceed the lowest λ by a factor of more than
/// 1/ε.
///
/// With a shift τ and K + τM = L Lᵀ the eigenvalues
///   μ = 1/(λ + τ)  of  L⁻¹ M L⁻ᵀ
/// have errors of ε μ₁ with the largest eigenvalue μ₁. The error of λ is therefore ε (λ + τ)²/(λ₁ + τ) [Parlett 1998,
/// §15.3; Ericsson & Ruhe 1980]. Motions without inertia have μ = 0. The errors of the shifted and the unshifted solver
/// are equal at λ + τ = √(λₙ (λ₁ + τ)). The shifted solver computes the eigenvalues below this limit, the unshifted
/// solver those above.
///
/// The round-off of L adds errors of ε K_ii to the stiffness xᵀKx of every eigenvector x. Rayleigh quotients of the
/// eigenvectors, summed in long double, remove these errors to second order.

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <polybody/math/types.hpp>

namespace polybody {

/// Eigenvalues and eigenvectors of K x = λ M x, computed with a shift τ.
struct ShiftedPencil {
  bool found = false;  ///< true if a shift was found
  double shift = 0.0;  ///< τ, unit of λ
  VecX values = {};    ///< λ in ascending order; infinite for motions without inertia, which are last
  MatX vectors = {};   ///< (n×n) eigenvectors with xᵀMx = 1; zero for motions without inertia
};

/// Solves K x = λ M x with K + τM = L Lᵀ. The squared pivots L_ii² are at least 1e-8 of the diagonal entries of K + τM.
/// The errors of L then remain below those of the entries of K. The shift τ is the first of 0, t, 64 t, 64² t … that
/// yields such pivots; t is 1e-12 of the smallest nonzero |K_ii|/M_ii. `found` is false if 16 shifts fail, or
/// if no i has M_ii > 0 and K_ii ≠ 0.
/// \param k K (n×n) symmetric \param m M (n×n) symmetric, positive semidefinite
template <class = void>  // compiled where it is used
ShiftedPencil by_shift(MatX const& k, MatX const& m) {
  ShiftedPencil out;
  double unit = std::numeric_limits<double>::infinity();
  for (Index i = 0; i < k.rows(); ++i)
    if (m(i, i) > 0.0 && k(i, i) != 0.0) unit = std::min(unit, std::abs(k(i, i)) / m(i, i));
  if (!(unit > 0.0 && std::isfinite(unit))) return out;
  Eigen::LLT<MatX> factor;
  for (int attempt = 0; attempt < 16 && !out.found; ++attempt) {
    out.shift = attempt == 0 ? 0.0 : 1e-12 * unit * std::pow(64.0, attempt - 1);
    MatX const shifted = k + out.shift * m;
    factor.compute(shifted);
    out.found = factor.info() == Eigen::Success &&
                (factor.matrixLLT().diagonal().array().square() >= 1e-8 * shifted.diagonal().array()).all();
  }
  if (!out.found) return out;
  MatX a = factor.matrixL().solve(m);
  a = factor.matrixL().solve(MatX(a.transpose()));
  Eigen::SelfAdjointEigenSolver<MatX> const solved(0.5 * (a + a.transpose()));
  VecX const mu = solved.eigenvalues().reverse();
  double const least = 1e-15 * mu[0];
  out.values.resize(mu.size());
  VecX scale(mu.size());
  for (Index i = 0; i < mu.size(); ++i) {
    bool const inert = mu[i] > least;
    out.values[i] = inert ? 1.0 / mu[i] - out.shift : std::numeric_limits<double>::infinity();
    scale[i] = inert ? 1.0 / std::sqrt(mu[i]) : 0.0;
  }
  out.vectors = factor.matrixU().solve(solved.eigenvectors().rowwise().reverse()) * scale.asDiagonal();
  return out;
}

/// Rayleigh quotient xᵀKx/xᵀMx, summed in long double. \param k K (n×n) \param m M (n×n) \param x (n)
template <class = void>  // compiled where it is used
double rayleigh_quotient(MatX const& k, MatX const& m, MatX::ConstColXpr const& x) {
  long double stiffness = 0.0L, mass = 0.0L;
  for (Index j = 0; j < x.size(); ++j) {
    long double kx = 0.0L, mx = 0.0L;
    for (Index i = 0; i < x.size(); ++i) {
      kx += static_cast<long double>(k(i, j)) * x[i];
      mx += static_cast<long double>(m(i, j)) * x[i];
    }
    stiffness += kx * x[j];
    mass += mx * x[j];
  }
  return double(stiffness / mass);
}

/// Replaces the lowest given eigenvalues and eigenvectors by those of `by_shift`. Nothing changes if the error ε λₙ of
/// the given eigenvalues is below 1e-9 of each of the `count` lowest |λ|. ε is the round-off unit and λₙ the largest λ.
/// \param k K (n×n) symmetric \param m M (n×n) symmetric, positive semidefinite \param count number of required
/// eigenvalues
/// \param values (r) all λ, ascending \param vectors X (n×r), XᵀMX = 1
/// \return false if no shift makes K + τM positive definite
template <class = void>  // compiled where it is used
bool renew_low_end(MatX const& k, MatX const& m, Index count, VecX& values, MatX& vectors) {
  Index const n = values.size();
  double const last = values[n - 1], smallest = values.head(std::min(count, n)).cwiseAbs().minCoeff();
  if (!(std::numeric_limits<double>::epsilon() * last > 1e-9 * smallest)) return true;
  ShiftedPencil const low = by_shift(k, m);
  if (!low.found) return false;
  double const first = low.values[0] + low.shift, border = std::sqrt(std::max(last, first)) * std::sqrt(first);
  Index renewed = 1;
  while (renewed < n && low.values[renewed] + low.shift <= border) ++renewed;
  if (renewed < std::min(count, n)) {
    // other eigenvalues: problem in the complement of the replaced vectors; K is diag(λ) in the coordinates w, x = X w
    MatX const mx = m * vectors, w = mx.transpose() * low.vectors.leftCols(renewed);
    Eigen::HouseholderQR<MatX> const qr(w);
    MatX const q = qr.householderQ(), rest = q.rightCols(n - renewed);
    Eigen::SelfAdjointEigenSolver<MatX> const high(rest.transpose() * values.asDiagonal() * rest);
    values.tail(n - renewed) = high.eigenvalues();
    vectors.rightCols(n - renewed) = MatX(vectors * (rest * high.eigenvectors()));
  }
  std::vector<std::pair<double, Index>> order;  // Rayleigh quotients of a double eigenvalue may be unsorted
  for (Index i = 0; i < renewed; ++i)
    order.emplace_back(i < count ? rayleigh_quotient<>(k, m, low.vectors.col(i)) : low.values[i], i);
  std::sort(order.begin(), order.begin() + std::min(count, renewed));
  for (Index i = 0; i < renewed; ++i) {
    values[i] = order[std::size_t(i)].first;
    vectors.col(i) = low.vectors.col(order[std::size_t(i)].second);
  }
  return true;
}

}  // namespace polybody
