#pragma once
/// \file
/// Points at which a time step solves linear equations (gradients/evaluation_point.hpp), and the derivatives of the
/// solutions. From K x = b with K = [M, Gᵀ; G, 0],
///   K δx = δb − δK x.
/// One pass of dual numbers through the equations at constant x evaluates the right-hand side. One function template
/// computes the step in doubles and in dual numbers. With doubles it solves the equations and factorises K at each
/// point. With dual numbers it passes through the same points in the same order.

#include <memory>
#include <span>
#include <vector>

#include <polybody/gradients/evaluation_point.hpp>
#include <polybody/integrators/forward_dynamics.hpp>

namespace polybody {

/// Evaluation points of a step in doubles, with factors of their matrices.
template <LinearSolver Solver = DefaultSolver>
class SolutionPoints {
 public:
  /// Point with its solution and the factors of K there.
  struct Found {
    EvaluationPoint<> place;                    ///< point with its solution
    TangentSolver<StepSolver<Solver>> factors;  ///< factors of the symmetric matrix K
  };

  /// \param system must outlive this object
  [[gnu::cold]] explicit SolutionPoints(System& system) : system_(&system) {
    rhs_ = solution_ = VecX::Zero(system.size());
  }

  /// System of the steps.
  System& system() { return *system_; }
  /// Discards all points.
  void forget() { used_ = 0; }
  /// Number of points.
  std::size_t size() const { return used_; }
  /// Point number i.
  Found& operator[](std::size_t i) { return *found_[i]; }

  /// Adds x as another point, and stores the solution in its a and λ. \throws SingularMatrix, NonFiniteValue.
  void solve(EvaluationPoint<>& x) {
    if (used_ == found_.size()) {
      found_.push_back(std::make_unique<Found>());
      found_.back()->factors.analyse(*system_, 1, [&](BlockSink& sink) { system_->masses(sink); });
    }
    Found& here = *found_[used_++];
    Index const nv = system_->velocities(), rows = system_->rows();
    x.a.setZero(nv);
    x.lambda.setZero(rows);
    equations_.evaluate(*system_, x);
    Index const bad = here.factors.factor([&](BlockSink& sink) { system_->masses(sink); });
    for (Index i = 0; i < nv; ++i) rhs_[i] = -equations_.balance[i];
    for (Index i = 0; i < rows; ++i) rhs_[nv + i] = -equations_.rows[i];
    if (bad >= 0) detail::throw_unsolvable(*system_, rhs_, name_of_equation(*system_, bad));
    here.factors.solve(rhs_, solution_);
    if (Index const i = first_not_finite(solution_); i >= 0)
      detail::throw_unsolvable(*system_, rhs_, system_->name_of(i));
    x.a = solution_.head(nv);
    x.lambda = solution_.tail(rows);
    here.place = x;
  }
  /// Largest absolute residual of the constraint equations for a = 0 at the last point.
  double largest_row() const { return largest_size(equations_.rows); }
  /// Indices of the redundant constraint equations at the last point.
  std::span<Index const> dropped() const { return found_[used_ - 1]->factors.dropped(); }

 private:
  System* system_;
  PointEquations<double> equations_;
  std::vector<std::unique_ptr<Found>> found_;  // reused in later steps
  std::size_t used_ = 0;
  VecX rhs_, solution_;
};

/// Evaluation points of a step with the derivatives of their solutions.
template <LinearSolver Solver = DefaultSolver>
class SolvedPoints {
 public:
  /// Largest number of directions in one pass through the equations: one for each derivative of a dual number.
  static constexpr int max_directions = 4;
  using D = Dual<max_directions>;  ///< value with its derivatives
  using Dots = VecXOf<Dual<4>>;    ///< vector of dual numbers

  /// The model must outlive this object.
  template <class M>
  [[gnu::cold]] SolvedPoints(M const& model, System& system)
      : found_(system), dual_(stepped_system<D>(model, with<Capabilities::motion>)) {
    rhs_ = solution_ = VecX::Zero(system.size());
  }

  /// System with the scalar type T.
  template <StateScalar T>
  BasicSystem<T>& system() {
    if constexpr (std::same_as<T, double>)
      return found_.system();
    else
      return dual_;
  }

  /// Discards all points.
  void forget() {
    found_.forget();
    passed_ = 0;
  }
  /// Returns to the first point.
  void again() { passed_ = 0; }

  /// Adds x as another point, and stores the solution in its a and λ. \throws SingularMatrix, NonFiniteValue.
  void solve(EvaluationPoint<>& x) { found_.solve(x); }
  /// Largest absolute residual of the constraint equations for a = 0 at the last point.
  double largest_row() const { return found_.largest_row(); }
  /// Indices of the redundant constraint equations at the last point.
  std::span<Index const> dropped() const { return found_.dropped(); }

  /// Sets a and λ of x to the solution of the next point, with its derivatives. q, v and `also` of x contain
  /// derivatives along `directions` directions.
  template <EquationDerivativeFunction F>
  void solve(EvaluationPoint<D>& x, std::size_t directions, F&& slope) {
    auto& here = found_[passed_++];
    Index const nv = here.place.a.size(), rows = here.place.lambda.size();
    x.a = here.place.a.template cast<D>();
    x.lambda = here.place.lambda.template cast<D>();
    dual_equations_.evaluate(dual_, x);
    for (std::size_t l = 0; l < directions; ++l) {
      EquationDerivative const by = slope(here.place, l);
      Index const k = Index(l);
      for (Index i = 0; i < nv; ++i) rhs_[i] = -(dual_equations_.balance[i].d[k] + by.balance[i]);
      for (Index i = 0; i < rows; ++i) rhs_[nv + i] = -(dual_equations_.rows[i].d[k] + by.rows[i]);
      here.factors.solve(rhs_, solution_);
      for (Index i = 0; i < nv; ++i) x.a[i].d[k] = solution_[i];
      for (Index i = 0; i < rows; ++i) x.lambda[i].d[k] = solution_[nv + i];
    }
  }

 private:
  SolutionPoints<Solver> found_;
  BasicSystem<D> dual_;
  PointEquations<D> dual_equations_;
  std::size_t passed_ = 0;
  VecX rhs_, solution_;
};

namespace detail {

/// Sets `to` to one vector of a state, `part`, with its derivatives along all directions.
template <int N>
void lift(VecX const& part, std::span<State* const> dx, VecX State::* of, VecXOf<Dual<N>>& to) {
  to.resize(part.size());
  for (Index i = 0; i < part.size(); ++i) {
    to[i] = Dual<N>(part[i]);
    for (std::size_t l = 0; l < dx.size(); ++l) to[i].d[Index(l)] = (dx[l]->*of)[i];
  }
}
/// Step length with its derivatives dh; without derivatives if dh is empty.
template <int N>
Dual<N> lift(double h, std::span<double const> dh) {
  Dual<N> out(h);
  for (std::size_t l = 0; l < dh.size(); ++l) out.d[Index(l)] = dh[l];
  return out;
}
/// Copies derivative l in `from` to the vector `of`, such as `&State::v`, of the state derivative dx[l], for each l.
template <int N>
void take_derivatives(VecXOf<Dual<N>> const& from, std::span<State* const> dx, VecX State::* of) {
  for (std::size_t l = 0; l < dx.size(); ++l) {
    VecX& to = dx[l]->*of;
    to.resize(from.size());
    for (Index i = 0; i < from.size(); ++i) to[i] = from[i].d[Index(l)];
  }
}

}  // namespace detail

}  // namespace polybody
