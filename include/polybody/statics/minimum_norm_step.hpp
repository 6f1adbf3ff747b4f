#pragma once
/// \file
/// Minimum-norm solution of singular equations of statics.
/// Theory: Eq. 7.17.

#include <polybody/math/sequence.hpp>
#include <polybody/statics/static_tangent.hpp>

namespace polybody::detail {

// Null space of the matrix of the equations of statics: test for null vectors, orthogonalisation, inverse iteration.

/// Candidate z for a null vector of A, with A z (`product`) and |A| |z| (`size`).
struct NullColumn {
  VecX z, product, size;

  /// Returns true if A z is round-off, at most 1e-13 max |A| |z| + 1e-15 max |z|. The entries of the scaled A are not
  /// much greater than one.
  bool is_null() const { return largest_size(product) <= 1e-13 * largest_size(size) + 1e-15 * largest_size(z); }
};

/// Receiver of matrix blocks that computes A z and |A| |z| of all columns.
struct NullColumnSink {
  Sequence<NullColumn>& columns;

  void add(Index row, Index col, BlockView const& b) {
    for (NullColumn& c : columns)
      for (Index j = 0; j < b.cols; ++j) {
        double const z = c.z[col + j];
        if (z == 0.0) continue;
        for (Index i = 0; i < b.rows; ++i) {
          c.product[row + i] += b(i, j) * z;
          c.size[row + i] += std::abs(b(i, j) * z);
        }
      }
  }
};

template <LinearSolver Solver>
void multiply(StaticTangent<Solver>& tangent, VecX const& lambda, Sequence<NullColumn>& columns) {
  if (columns.empty()) return;
  for (NullColumn& c : columns) c.product = c.size = VecX::Zero(c.z.size());
  NullColumnSink sink{columns};
  tangent.write_scaled(lambda, sink);
}

/// Scalar product Σ aᵢ bᵢ over the first n entries.
inline double dot_of_first(Index n, VecX const& a, VecX const& b) {
  double sum = 0.0;
  for (Index i = 0; i < n; ++i) sum += a[i] * b[i];
  return sum;
}
inline void add_scaled(double factor, VecX const& z, VecX& to) {
  for (Index i = 0; i < z.size(); ++i) to[i] += factor * z[i];
}
/// Orthogonalises and normalises the last vector with respect to the previous ones, by their first n entries
/// (Gram–Schmidt, twice).
template <class = void>
void make_orthonormal(Sequence<VecX>& vectors, Index n) {
  VecX& last = vectors.back();
  for (int pass = 0; pass < 2; ++pass) {
    for (std::size_t k = 0; k + 1 < vectors.size(); ++k)
      add_scaled(-dot_of_first(n, vectors[k], last), vectors[k], last);
    double const length = std::sqrt(dot_of_first(n, last, last));
    for (Index i = 0; i < last.size(); ++i) last[i] /= length;
  }
}

/// Receiver of matrix blocks that computes the largest absolute entry of each row.
struct RowSizeSink {
  VecX& largest;

  void add(Index row, Index, BlockView const& b) {
    for (Index j = 0; j < b.cols; ++j)
      for (Index i = 0; i < b.rows; ++i) largest[row + i] = std::max(largest[row + i], std::abs(b(i, j)));
  }
};

/// Null space of the matrix A of the equations of statics (StaticTangent), by inverse iteration with a small shift:
///   y ← (A + σ D)⁻¹ D y,  σ = 1e-12,  D = diag(largest entry of the row; negative for constraint equations).
/// Each pass multiplies a vector of the null space by 1/σ, and an eigenvector with the eigenvalue μ relative to D by
/// 1/(σ + μ) [Golub & Van Loan 2013, §8.2]. If K is positive semidefinite, the shifted matrix is quasi-definite, and
/// its pivots are far above round-off. A vector is accepted if A z is round-off compared with |A| |z|.
template <LinearSolver Solver>
class NullSpace {
 public:
  static constexpr double shift = 1e-12;
  static constexpr int passes = 8;

  NullSpace(System& system, StaticTangent<Solver>& tangent)
      : tangent_(tangent), nv_(system.velocities()), scale_(VecX::Zero(system.size())), y_(scale_), one_(1) {}

  /// Computes `pins`, the unknowns that need a spring to remove the null space. Returns −1, or the index of the unknown
  /// without a pivot if the factorisation fails.
  Index find(VecX const& lambda, Sequence<Index>& pins) {
    RowSizeSink sizes{scale_};
    tangent_.write_scaled(lambda, sizes);
    for (Index i = 0; i < scale_.size(); ++i) scale_[i] = (scale_[i] > 0.0 ? scale_[i] : 1.0) * (i < nv_ ? 1.0 : -1.0);
    for (Index i = 0; i < scale_.size(); ++i) y_[i] = shift * scale_[i];
    tangent_.set_springs(y_, lambda);
    if (Index const bad = tangent_.factor(lambda); bad >= 0) return bad;
    vectors_.clear();
    while (Index(vectors_.size()) < scale_.size() && finds_one(lambda)) {
    }
    choose(pins);
    return -1;
  }

 private:
  /// Adds a further vector of the null space to `vectors_`. Returns false if there is none.
  bool finds_one(VecX const& lambda) {
    Index const n = scale_.size();
    vectors_.emplace_back(n);
    tangent_.fill_without_order(vectors_.size(), vectors_.back());
    for (int pass = 0; pass < passes; ++pass) {
      for (Index i = 0; i < n; ++i) y_[i] = scale_[i] * vectors_.back()[i];
      tangent_.solve_scaled(y_, vectors_.back());
      make_orthonormal(vectors_, n);
    }
    one_[0].z = vectors_.back();
    multiply(tangent_, lambda, one_);
    if (one_[0].is_null()) return true;
    vectors_.pop_back();
    return false;
  }

  /// Selects one unknown for each vector by elimination with complete pivoting. Of equal entries the last one is
  /// selected, so that the joint connected last counts as redundant.
  void choose(Sequence<Index>& pins) {
    pins.clear();
    for (std::size_t k = 0; k < vectors_.size(); ++k) {
      std::size_t best = k;
      Index at = 0;
      double most = 0.0;
      for (std::size_t j = k; j < vectors_.size(); ++j)
        for (Index i = 0; i < scale_.size(); ++i)
          if (std::abs(vectors_[j][i]) >= (1.0 - 1e-6) * most) {
            most = std::max(most, std::abs(vectors_[j][i]));
            best = j;
            at = i;
          }
      std::swap(vectors_[k], vectors_[best]);
      for (std::size_t j = k + 1; j < vectors_.size(); ++j)
        add_scaled(-vectors_[j][at] / vectors_[k][at], vectors_[k], vectors_[j]);
      pins.push_back(at);
    }
    std::sort(pins.begin(), pins.end());
  }

  StaticTangent<Solver>& tangent_;
  Index nv_;
  VecX scale_, y_;
  Sequence<VecX> vectors_;
  Sequence<NullColumn> one_;
};

}  // namespace polybody::detail

namespace polybody {

namespace detail {
/// Largest magnitude of the terms that cancel in an equilibrium: multipliers, forces of compliant joints and wrenches
/// of force elements.
template <class = void>
double largest_load(System const& system, VecX const& lambda) {
  double largest = largest_size(lambda);
  for (ConstraintBlock<double> const& block : system.data().rows)
    if (block.source == ConstraintSource::compliant)
      for (int i = 0; i < block.rows; ++i) largest = std::max(largest, std::abs(block.answer[i]));
  for (AppliedWrench<double> const& action : system.data().actions)
    for (double const w : action.w) largest = std::max(largest, std::abs(w));
  return largest;
}
}  // namespace detail

/// Minimum-norm solution y = (x, μ) of singular equations of statics A y = b. A is singular because of redundant
/// constraints, or of free motions, which have no stiffness. A unit spring is added to as many unknowns as the rank
/// deficiency of A [Farhat & Géradin 1998]. The columns of P are the unit vectors of these unknowns:
///   A′ = A + P Pᵀ,  Z = A′⁻¹ P,  y′ = A′⁻¹ b.
/// Then A Z = 0 and PᵀZ = 1, because every W with WᵀA = 0 has WᵀP = WᵀA′Z = WᵀP PᵀZ. Z therefore spans the null space
/// of A, motions and multipliers. The force in the springs is Pᵀy′ = (WᵀP)⁻¹Wᵀb. It is zero if A y = b has a solution,
/// and then y′ − Z c is a solution for every c. The multipliers of constraint equations with a spring are made zero, as
/// in a time step with redundant constraints. Of all solutions, the one with the least |x| is computed.
template <LinearSolver Solver>
class MinimumNormStep {
 public:
  /// Value of `StaticTangent::growth` above which the matrix may be singular.
  static constexpr double suspicious = 1e8;
  /// Largest force on a spring under balanced loads, relative to the largest load.
  static constexpr double balanced = 1e-9;

  /// `system` and `tangent` must outlive this object.
  MinimumNormStep(System& system, StaticTangent<Solver>& tangent)
      : system_(&system), tangent_(&tangent), nv_(system.velocities()), b_(VecX::Zero(system.size())) {}

  /// Computes the springs that the matrix requires in the state last evaluated, and Z. Returns −1, or the index of an
  /// unknown without a pivot if springs do not make the matrix regular.
  Index factor(VecX const& lambda) {
    excited_ = -1;
    set_springs(lambda);
    if (tangent_->factor(lambda) < 0 && columns_are_null(lambda) && !(tangent_->growth() > suspicious)) {
      make_basis();
      return -1;
    }
    detail::NullSpace<Solver> null_space(*system_, *tangent_);
    if (Index const bad = null_space.find(lambda, pins_); bad >= 0) return bad;
    set_springs(lambda);
    if (Index const bad = tangent_->factor(lambda); bad >= 0) return bad;
    if (!columns_are_null(lambda)) return pins_.back();
    make_basis();
    return -1;
  }

  /// Solves for `out` (size) = (x, μ) with forces f (velocities) and required changes φ of the constraint functions
  /// (constraint equations). If the loads excite a free motion, `excited` returns its spring.
  void solve(VecX const& f, VecX const& phi, VecX const& lambda, VecX& out) {
    double const unit = tangent_->unit();
    for (Index i = 0; i < nv_; ++i) b_[i] = f[i] / unit;
    for (Index i = nv_; i < b_.size(); ++i) b_[i] = phi[i - nv_];
    tangent_->solve_scaled(b_, out);
    find_excited(out, std::max(largest_size(f), detail::largest_load(*system_, lambda)));
    take_rows_off(out);
    for (VecX const& z : basis_) detail::add_scaled(-detail::dot_of_first(nv_, z, out), z, out);
    for (Index i = nv_; i < out.size(); ++i) out[i] *= unit;
  }

  /// Unknowns with a spring.
  Sequence<Index> const& pins() const { return pins_; }
  VecX const& motion(std::size_t k) const { return columns_[k].z; }  ///< column k of Z, for spring k (size)
  /// Index in `pins` of the spring whose free motion the loads excite most, beyond round-off; −1 if the loads are
  /// balanced.
  Index excited() const { return excited_; }
  /// Replaces λ by multipliers with the same constraint forces. The new multipliers are zero for constraint equations
  /// with a spring.
  void drop_multipliers(VecX& lambda) {
    for (Index i = 0; i < b_.size(); ++i) b_[i] = i < nv_ ? 0.0 : lambda[i - nv_];
    take_rows_off(b_);
    for (Index i = nv_; i < b_.size(); ++i) lambda[i - nv_] = b_[i];
  }

 private:
  void set_springs(VecX const& lambda) {
    for (Index i = 0; i < b_.size(); ++i) b_[i] = 0.0;
    for (Index const i : pins_) b_[i] = 1.0;
    tangent_->set_springs(b_, lambda);
  }

  /// Computes Z with the last factorisation. Returns true if A Z = 0 up to round-off.
  bool columns_are_null(VecX const& lambda) {
    columns_.resize(pins_.size());
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      for (Index i = 0; i < b_.size(); ++i) b_[i] = 0.0;
      b_[pins_[k]] = 1.0;
      columns_[k].z.resize(b_.size());
      tangent_->solve_scaled(b_, columns_[k].z);
    }
    detail::multiply(*tangent_, lambda, columns_);
    return std::all_of(columns_.begin(), columns_.end(), [](auto const& c) { return c.is_null(); });
  }

  /// Orthonormal basis of the motions in Z.
  void make_basis() {
    basis_.clear();
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      if (pins_[k] >= nv_) continue;
      basis_.push_back(columns_[k].z);
      detail::make_orthonormal(basis_, nv_);
    }
  }

  /// Computes `excited_`: the spring whose force exceeds its limit by the largest factor. The limit is the sum of two
  /// round-offs: of f, ε |K| (1 + |q|) for each entry, and of loads that cancel.
  void find_excited(VecX const& y, double load) {
    double const reach = 1.0 + largest_size(system_->at().q), unit = tangent_->unit();
    double worst = 1.0;
    excited_ = -1;
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      if (pins_[k] >= nv_) continue;
      double sum = 0.0, most = 0.0;
      for (Index i = 0; i < nv_; ++i) {
        sum += columns_[k].size[i];
        most = std::max(most, std::abs(columns_[k].z[i]));
      }
      double const borne = unit * std::abs(y[pins_[k]]), allowed = balanced * load * most + 1e-14 * unit * sum * reach;
      if (borne <= worst * allowed) continue;
      excited_ = Index(k);
      worst = borne / std::max(allowed, std::numeric_limits<double>::min());
    }
  }

  void take_rows_off(VecX& y) {
    for (std::size_t k = 0; k < columns_.size(); ++k)
      if (pins_[k] >= nv_) detail::add_scaled(-y[pins_[k]], columns_[k].z, y);
    for (Index const i : pins_)
      if (i >= nv_) y[i] = 0.0;
  }

  System* system_;
  StaticTangent<Solver>* tangent_;
  Index nv_, excited_ = -1;
  Sequence<Index> pins_;
  Sequence<detail::NullColumn> columns_;  ///< Z
  Sequence<VecX> basis_;
  VecX b_;
};

}  // namespace polybody
