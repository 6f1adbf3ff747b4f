#pragma once
// Least squares by the method of Levenberg and Marquardt as MINPACK has it [Moré 1978], which Eigen brings, and what
// the Gauss-Newton matrix tells of the accuracy of the numbers found.

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
  std::function<Eigen::MatrixXd(Eigen::VectorXd const&)> slopes;
};

struct LeastSquaresFit {
  Eigen::VectorXd at{};          // where the sum is least
  Eigen::VectorXd residuals{};   // there
  Eigen::MatrixXd slopes{};      // there
  std::vector<double> sums{};    // ½ Σ r² of the start and after each iteration
  int runs = 0, slope_runs = 0;  // how often residuals and slopes were asked for
  bool converged = false;

  // s with s² = Σ r²/(values − numbers).
  double deviation() const { return std::sqrt(residuals.squaredNorm() / double(residuals.size() - at.size())); }
  // s² (JᵀJ)⁻¹ of the numbers: right for residuals that noise alone leaves, and where r is nearly linear over it.
  Eigen::MatrixXd covariance() const {
    Eigen::MatrixXd const normal = slopes.transpose() * slopes, one = Eigen::MatrixXd::Identity(at.size(), at.size());
    Eigen::VectorXd const scale = normal.diagonal().cwiseSqrt().cwiseInverse();  // numbers of different units
    Eigen::MatrixXd const scaled = scale.asDiagonal() * normal * scale.asDiagonal();
    return std::pow(deviation(), 2) * (scale.asDiagonal() * scaled.ldlt().solve(one) * scale.asDiagonal());
  }
};

// What Eigen's method asks for.
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
    j = of.slopes(x);
    ++fit.slope_runs;
    return 0;
  }
};

// From `start` on, whose numbers are of the size of one, by steps that are at first no longer than it; until neither
// the sum nor the numbers change by more than `tolerance`, relatively, or `most` iterations have been made.
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
  --fit.runs;  // the method begins with the same one
  Status status = method.minimizeInit(fit.at);
  fit.sums.push_back(0.5 * std::pow(method.fnorm(), 2));
  while (status != Status::ImproperInputParameters && int(fit.sums.size()) <= most) {
    status = method.minimizeOneStep(fit.at);
    fit.sums.push_back(0.5 * std::pow(method.fnorm(), 2));
    if (status != Status::Running) break;
  }
  fit.converged = status > Status::ImproperInputParameters && status < Status::TooManyFunctionEvaluation;
  fit.residuals = method.fvec();
  fit.slopes = problem.slopes(fit.at);
  ++fit.slope_runs;
  return fit;
}
