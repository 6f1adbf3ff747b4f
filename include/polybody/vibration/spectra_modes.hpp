#pragma once
/// \file
/// Lowest modes of large structures by the Lanczos iteration of Spectra. Requires the headers of Spectra (Debian:
/// libspectra-dev).
/// Theory: Eq. 11.13.

#include <Spectra/MatOp/SparseSymMatProd.h>
#include <Spectra/SymGEigsShiftSolver.h>

#include <polybody/bodies/ffr/ffr_basis.hpp>

namespace polybody {

/// Eigenvalue solver that can replace DenseModes in fixed_interface_modes, free_interface_modes and craig_bampton. It
/// uses the implicitly restarted Lanczos iteration on K⁻¹M, in the inner product of M [Ericsson & Ruhe 1980; Sorensen
/// 1992]. The iteration may miss modes of a repeated frequency. With σ just below the last ω², the number of computed
/// modes with ω² < σ is therefore compared with the number of negative pivots of K − σM (Sylvester's law). If modes are
/// missing or do not converge, the iteration is repeated with twice as many vectors, in at most six attempts.
struct SpectraModes {
  Index restarts = 1000;     ///< largest number of restarts in one attempt
  double tolerance = 1e-12;  ///< relative error of ω²

  /// Computes the `count` lowest modes of the symmetric matrices K and M (n×n); K must be positive definite. The
  /// results are bitwise identical in every run. If `count` is at least half of all modes, DenseModes computes them.
  /// \throws InvalidInput if K is not positive definite; Error if modes do not converge or are missing after six
  /// attempts.
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
    throw Error("modes.not_converged", {ErrorObject{"SpectraModes"}, ": only ", ErrorValue{converged}, " of ", count,
                                        " modes converged in ", restarts,
                                        " restarts, or modes of a repeated frequency are missing. Allow more restarts "
                                        "or a larger tolerance, or use DenseModes."});
  }

 private:
  /// Operator y = K⁻¹ x in the form that Spectra requires.
  struct Inverse {
    using Scalar = double;
    SparseFactor factor;
    Index size;

    explicit Inverse(Structure::Sparse const& k) : size(k.rows()) {
      factor_positive(
          factor, k,
          "SpectraModes needs a positive definite stiffness; fix the structure, or use free_interface_modes.");
    }
    Index rows() const { return size; }
    Index cols() const { return size; }
    void set_shift(double) {}  // the shift is always zero
    void perform_op(double const* x, double* y) const {
      Eigen::Map<VecX>(y, size) = factor.solve(Eigen::Map<VecX const>(x, size));
    }
  };

  /// True if no frequency below the last one is missing.
  static bool complete(VecX const& squared, Structure::Sparse const& k, Structure::Sparse const& m) {
    double const sigma = squared[squared.size() - 1] * (1.0 - 1e-6);
    SparseFactor const factor(k - sigma * m);
    return factor.info() == Eigen::Success &&
           (factor.vectorD().array() < 0.0).count() <= (squared.array() < sigma).count();
  }
};

}  // namespace polybody
