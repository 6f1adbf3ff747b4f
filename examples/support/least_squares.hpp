#pragma once
// Least squares by the Levenberg–Marquardt method of MINPACK [Moré 1978], which is part of Eigen, and the covariance
// of the solution from the Gauss–Newton matrix.

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <cmath>
#include <functional>
#include <string>
#include <unsupported/Eigen/LevenbergMarquardt>
#include <vector>

// Residuals r(x) and their derivatives (values × numbers).
struct LeastSquares {
  std::function<Eigen::VectorXd(Eigen::VectorXd const&)> residuals;
  std::function<Eigen::MatrixXd(Eigen::VectorXd const&)> derivatives;
};

struct LeastSquaresFit {
  Eigen::VectorXd at{};           // variables x with the least sum of squares
  Eigen::VectorXd residuals{};    // residuals at this x
  Eigen::MatrixXd derivatives{};  // derivatives at this x
  std::vector<double> sums{};     // ½ Σ r² of the start and after each iteration
  int runs = 0, slope_runs = 0;   // number of evaluations of residuals and of derivatives
  bool converged = false;

  // s with s² = Σ r²/(values − numbers).
  double deviation() const { return std::sqrt(residuals.squaredNorm() / double(residuals.size() - at.size())); }
  // Covariance s² (JᵀJ)⁻¹ of the solution. It is correct if the residuals are noise only and r is nearly linear over
  // their range.
  Eigen::MatrixXd covariance() const {
    Eigen::MatrixXd const normal = derivatives.transpose() * derivatives,
                          one = Eigen::MatrixXd::Identity(at.size(), at.size());
    Eigen::VectorXd const scale = normal.diagonal().cwiseSqrt().cwiseInverse();  // numbers of different units
    Eigen::MatrixXd const scaled = scale.asDiagonal() * normal * scale.asDiagonal();
    return std::pow(deviation(), 2) * (scale.asDiagonal() * scaled.ldlt().solve(one) * scale.asDiagonal());
  }
};

// Functor for the method of Eigen.
struct CountedLeastSquares : Eigen::DenseFunctor<double> {
  LeastSquares const& of;
  LeastSquaresFit& fit;

  CountedLeastSquares(LeastSquares const& problem, LeastSquaresFit& counted, Eigen::Index numbers, Eigen::Index values)
      : DenseFunctor(int(numbers), int(values)), of(problem), fit(counted) {}
  int operator()(InputType const& x, ValueType& r) const {
    r = of.residuals(x);
    ++fit.runs;
    return 0;
  }
  int df(InputType const& x, JacobianType& j) const {
    j = of.derivatives(x);
    ++fit.slope_runs;
    return 0;
  }
};

// Minimises the sum of squares from `start`, whose entries must be of the order of one. The first steps are at most as
// long as `start`. The iteration ends if the relative change of the sum or of the variables is below `tolerance`, or
// after `most` iterations.
inline LeastSquaresFit least_squares(LeastSquares const& problem, Eigen::VectorXd const& start, double tolerance = 1e-6,
                                     int most = 30) {
  using Status = Eigen::LevenbergMarquardtSpace::Status;
  LeastSquaresFit fit;
  fit.at = start;
  fit.residuals = problem.residuals(start);
  ++fit.runs;
  CountedLeastSquares functor(problem, fit, start.size(), fit.residuals.size());
  Eigen::LevenbergMarquardt<CountedLeastSquares> method(functor);
  method.setFtol(tolerance);
  method.setXtol(tolerance);
  method.setFactor(1.0);
  method.setExternalScaling(true);
  method.diag() = Eigen::VectorXd::Ones(start.size());
  --fit.runs;  // minimizeInit repeats this evaluation and counts it
  Status status = method.minimizeInit(fit.at);
  fit.sums.push_back(0.5 * std::pow(method.fnorm(), 2));
  while (status != Status::ImproperInputParameters && int(fit.sums.size()) <= most) {
    status = method.minimizeOneStep(fit.at);
    fit.sums.push_back(0.5 * std::pow(method.fnorm(), 2));
    if (status != Status::Running) break;
  }
  fit.converged = status > Status::ImproperInputParameters && status < Status::TooManyFunctionEvaluation;
  fit.residuals = method.fvec();
  fit.derivatives = problem.derivatives(fit.at);
  ++fit.slope_runs;
  return fit;
}
