#pragma once
/// \file
/// The lowest modes of large structures by Spectra's Lanczos iteration. Not in polybody.hpp: it needs Spectra's headers
/// (Debian: libspectra-dev).

#include <Spectra/MatOp/SparseSymMatProd.h>
#include <Spectra/SymGEigsShiftSolver.h>

#include <polybody/bodies/ffr/ffr_basis.hpp>

namespace polybody {

/// In place of DenseModes in held_modes, free_interface_modes and craig_bampton: implicitly restarted Lanczos on K⁻¹M,
/// in the inner product of M [Ericsson & Ruhe 1980; Sorensen 1992]. The iteration may miss modes of a repeated
/// frequency; so the modes below the last are counted by the negative pivots of K − σM (Sylvester), and the iteration
/// starts anew with twice the vectors until none is missing, six times at most.
struct SpectraModes {
  Index restarts = 1000;     ///< at most, for each number of vectors
  double tolerance = 1e-12;  ///< of ω², relative

  /// The `count` lowest modes of K and M (n×n) symmetric, K positive definite. The same numbers in every run. Half of
  /// all modes or more are left to DenseModes.
  /// \throws InvalidInput for a K that is not positive definite; Error when the iteration does not converge.
  template <class = void>  // compiled where it is used
  LowestModes operator()(Structure::Sparse const& k, Structure::Sparse const& m, Index count) const {
    Index const n = k.rows();
    if (2 * count >= n) return DenseModes{}(k, m, count);
    Inverse inverse(k);
    Spectra::SparseSymMatProd<double> mass(m);
    Index converged = 0, vectors = std::min(n, std::max(2 * count + 1, Index(20)));
    for (int attempt = 0; attempt < 6; ++attempt, vectors = std::min(n, 2 * vectors)) {
      Spectra::SymGEigsShiftSolver<Inverse, Spectra::SparseSymMatProd<double>, Spectra::GEigsMode::ShiftInvert> solver(
          inverse, mass, count, vectors, 0.0);
      solver.init();
      converged = solver.compute(Spectra::SortRule::LargestMagn, restarts, tolerance, Spectra::SortRule::SmallestAlge);
      if (solver.info() == Spectra::CompInfo::Successful) {
        LowestModes modes{solver.eigenvalues(), solver.eigenvectors()};
        if (complete(modes.squared_frequencies, k, m)) {
          for (Index i = 0; i < count; ++i)
            modes.shapes.col(i) /= std::sqrt(modes.shapes.col(i).dot(m * modes.shapes.col(i)));
          return modes;
        }
      }
    }
    throw Error{"SpectraModes: ",
                converged,
                " of ",
                count,
                " modes converged in ",
                restarts,
                " restarts, which leaves some out. Allow more restarts, a larger tolerance, or use DenseModes."};
  }

 private:
  /// y = K⁻¹ x, as Spectra wants it.
  struct Inverse {
    using Scalar = double;
    SparseFactor factor;
    Index size;

    explicit Inverse(Structure::Sparse const& k) : size(k.rows()) {
      factor_positive(
          factor, k,
          "SpectraModes needs a positive definite stiffness; hold the structure, or use free_interface_modes.");
    }
    Index rows() const { return size; }
    Index cols() const { return size; }
    void set_shift(double) {}  // always zero
    void perform_op(double const* x, double* y) const {
      Eigen::Map<VecX>(y, size) = factor.solve(Eigen::Map<VecX const>(x, size));
    }
  };

  /// No frequency below the last is missing.
  static bool complete(VecX const& squared, Structure::Sparse const& k, Structure::Sparse const& m) {
    double const sigma = squared[squared.size() - 1] * (1.0 - 1e-6);
    SparseFactor const factor(k - sigma * m);
    return factor.info() == Eigen::Success &&
           (factor.vectorD().array() < 0.0).count() <= (squared.array() < sigma).count();
  }
};

}  // namespace polybody
