#pragma once
/// \file
/// Generalised minimal residual method with restarts, for unsymmetric equations with a preconditioner [Saad & Schultz
/// 1986].

#include <array>
#include <cmath>

#include <polybody/math/vectors.hpp>

namespace polybody {

/// Solver of (1 + E) z = b by the generalised minimal residual method with restarts. With z = D y and E = C D⁻¹, the
/// solution y = D⁻¹ z satisfies (D + C) y = b. All memory is allocated by `resize`.
class Gmres {
 public:
  /// Number of basis vectors of a cycle.
  static constexpr int cycle = 30;

  /// Allocates memory for `n` unknowns.
  void resize(Index n) {
    basis_.setZero(n, cycle + 1);
    z_.setZero(n);
    r_.setZero(n);
    w_.setZero(n);
  }
  /// Returns the solution z (n) of (1 + E) z = b with the relative residual `enough` [1], or the last iterate after
  /// `most` products. add_product(x, y) adds E x to y, both (n).
  template <class AddProduct>
  VecX const& solve(VecX const& b, double enough, int most, AddProduct&& add_product) {
    Index const n = b.size();
    for (Index i = 0; i < n; ++i) z_[i] = 0.0;
    r_ = b;
    double residual = norm(r_);
    double const limit = enough * residual;
    for (int done = 0; residual > limit && done < most;) {
      for (Index i = 0; i < n; ++i) basis_(i, 0) = r_[i] / residual;
      g_.fill(0.0);
      g_[0] = residual;
      int k = 0;
      while (k < cycle && done < most && residual > limit) {
        for (Index i = 0; i < n; ++i) r_[i] = basis_(i, k);
        w_ = r_;
        add_product(r_, w_);
        ++done;
        residual = extend(k++);
      }
      add_combination(k);
      if (residual <= limit || done >= most) break;
      w_ = z_;
      add_product(z_, w_);
      ++done;
      for (Index i = 0; i < n; ++i) r_[i] = b[i] - w_[i];
      residual = norm(r_);
    }
    return z_;
  }

 private:
  static double norm(VecX const& x) { return std::sqrt(squares(x)); }
  static double dot(double const* x, double const* y, Index n) {
    SimdSum sum;
    for_each_simd_block(n, [&](auto at) { sum.add(at(x) * at(y)); });
    return sum.total();
  }
  /// Adds part · x to y, both (n).
  static void add(double part, double const* x, double* y, Index n) {
    for_each_simd_block(n, [=](auto at) { at.set(y, at(y) + part * at(x)); });
  }
  /// Appends the normalised part of w_ that is orthogonal to the basis vectors 0 to k. Returns the norm of the residual
  /// with k + 1 vectors.
  double extend(int k) {
    Index const n = w_.size();
    auto& h = h_[std::size_t(k)];
    for (int j = 0; j <= k; ++j) {
      double const* const v = basis_.data() + n * j;
      h[std::size_t(j)] = dot(v, w_.data(), n);
      add(-h[std::size_t(j)], v, w_.data(), n);
    }
    double const rest = norm(w_);
    if (rest > 0.0)
      for (Index i = 0; i < n; ++i) basis_(i, k + 1) = w_[i] / rest;
    for (std::size_t j = 0; j < std::size_t(k); ++j) {
      double const upper = h[j], lower = h[j + 1];
      h[j] = cos_[j] * upper + sin_[j] * lower;
      h[j + 1] = cos_[j] * lower - sin_[j] * upper;
    }
    std::size_t const at = std::size_t(k);
    double const size = std::hypot(h[at], rest);
    cos_[at] = size > 0.0 ? h[at] / size : 1.0;
    sin_[at] = size > 0.0 ? rest / size : 0.0;
    h[at] = size;
    g_[at + 1] = -sin_[at] * g_[at];
    g_[at] *= cos_[at];
    return std::abs(g_[at + 1]);
  }
  /// Adds the combination of the first `count` basis vectors with the least residual to z_.
  void add_combination(int count) {
    Index const n = z_.size();
    for (int j = count - 1; j >= 0; --j) {
      double sum = g_[std::size_t(j)];
      for (int k = j + 1; k < count; ++k) sum -= h_[std::size_t(k)][std::size_t(j)] * g_[std::size_t(k)];
      double const diagonal = h_[std::size_t(j)][std::size_t(j)];
      double const part = g_[std::size_t(j)] = diagonal > 0.0 ? sum / diagonal : 0.0;
      add(part, basis_.data() + n * j, z_.data(), n);
    }
  }

  MatX basis_;  // (n, cycle + 1) orthonormal
  VecX z_, r_, w_;
  std::array<std::array<double, cycle + 1>, cycle> h_ = {};  // columns of the triangular matrix
  std::array<double, cycle> cos_ = {}, sin_ = {};            // Givens rotations
  std::array<double, cycle + 1> g_ = {};                     // rotated right-hand side
};

}  // namespace polybody
