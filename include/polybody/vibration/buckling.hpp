#pragma once
/// \file
/// Buckling loads as eigenvalues of the linearised stiffness.
/// Theory: Eqs. 7.26, 7.27.

#include <polybody/vibration/modes.hpp>

namespace polybody {

/// Options of `buckling_modes`.
struct BucklingOptions {
  Index count = 1;  ///< number of modes
  /// Load factor at which the given state is in equilibrium: 0 for a state without loads, such as `reference_state()`,
  /// or 1 for a result of `equilibrium`.
  double load_factor = 0.0;
};

/// Buckling modes in the order of their load factors.
struct BucklingModes {
  VecX load_factor;  ///< (k) common factors of all loads and gravity at which the structure buckles, ascending
  MatX shape;        ///< (nv×k) shapes δ, one entry per generalised velocity, largest entry 1
};

namespace detail {

/// Stiffness K and constraint Jacobian G along the path of equilibria, linearised about a state at the load factor p₀.
/// The displacement δ and the multipliers λ on this path are
///   δ(p) = (p − p₀) u,  λ(p) = λ₀ + (p − p₀) μ,  [K, Gᵀ; G, 0] (u, μ) = (f′, 0),  with f′ = ∂f/∂p of the loads f.
class PrebucklingPath {
 public:
  /// \throws InvalidInput unless x is a stable equilibrium at the load factor p₀.
  PrebucklingPath(System& system, State const& x, double factor) : system_(system), x_(x), factor_(factor) {
    Index const nv = system.velocities();
    system_.evaluate(x.q, x.v, x.t);
    VecX r = VecX::Zero(nv), loaded = r;
    VecX const still = r;
    set_factor(factor + 1.0, [&] { system_.residual(still, x.lambda, loaded); });
    set_factor(factor, [&] { system_.residual(still, x.lambda, r); });
    loads_ = r - loaded;
    require_balance(r);
    MatX const k = tangent(x.q, x.lambda, factor);
    k_ = k.topLeftCorner(nv, nv);
    g_ = k.bottomLeftCorner(system.rows(), nv);
    n_ = free_motions(g_);
    a_ = symmetric(of_free_motions(n_, k_));
    factorise();
    u_ = n_ * stable_.solve(VecX(n_.transpose() * loads_));
    mu_ = system.rows() == 0 ? VecX() : VecX(smallest_solution(g_.transpose(), loads_ - k_ * u_, 1e-10));
  }

  MatX const& basis() const { return n_; }         ///< basis N (nv×free) of the null space of G
  MatX const& stiffness() const { return a_; }     ///< Nᵀ K N (free×free)
  VecX const& displacement() const { return u_; }  ///< u = δ′ (nv)

  /// Derivative of Nᵀ K N (free×free) with respect to the load factor, extrapolated from central differences with the
  /// steps h and h/2. The basis N remains in the null space of G: N′ = −G⁺ G′ N.
  MatX rate(double h) const { return (4.0 * difference(0.5 * h) - difference(h)) / 3.0; }

 private:
  template <class F>
  void set_factor(double factor, F&& f) {
    system_.load_factor = factor;
    f();
    system_.load_factor = 1.0;
  }
  MatX tangent(VecX const& q, VecX const& lambda, double factor) const {
    system_.evaluate(q, x_.v, x_.t);
    system_.load_factor = factor;
    MatX k = dense_tangent(system_, {.stiffness = 1.0}, lambda);
    system_.load_factor = 1.0;
    return k;
  }
  static MatX symmetric(MatX const& m) { return 0.5 * (m + m.transpose()); }
  void require_balance(VecX const& r) const {
    double const scale = largest_size(loads_);
    if (scale == 0.0)
      throw InvalidInput("buckling.no_load", {ErrorObject{"buckling_modes"},
                                              ": the model has no load. Apply a force in the direction of interest; "
                                              "the load factors of the modes multiply it."});
    if (largest_size(r) <= 1e-6 * scale) return;
    throw InvalidInput(
        "buckling.no_equilibrium",
        {ErrorObject{"buckling_modes"}, ": the state is not an equilibrium at load factor ", ErrorValue{factor_},
         ". Give the unloaded state with load_factor = 0, or a state of equilibrium(model, x) with "
         "load_factor = 1."});
  }
  void factorise() {
    stable_.compute(a_);
    if (stable_.info() == Eigen::Success &&
        (stable_.matrixLLT().diagonal().array().square() > 1e-13 * a_.diagonal().array().abs()).all())
      return;
    throw InvalidInput(
        "buckling.unstable",
        {ErrorObject{"buckling_modes"}, ": the structure is not stable at load factor ", ErrorValue{factor_},
         ": a motion has zero or negative stiffness. Fix free motions by joints or springs, or "
         "start from a smaller load factor."});
  }
  /// Central difference (B(h) − B(−h))/2h of B = Nᵀ K N at the load factors p₀ ± h.
  MatX difference(double h) const {
    Index const nv = system_.velocities(), rows = system_.rows();
    VecX q = x_.q;
    MatX change = MatX::Zero(nv + rows, nv + rows);
    for (double const side : {1.0, -1.0}) {
      system_.plus(x_.q, VecX(side * h * u_), q);
      VecX const lambda = rows == 0 ? x_.lambda : VecX(x_.lambda + side * h * mu_);
      change += (side / (2.0 * h)) * tangent(q, lambda, factor_ + side * h);
    }
    MatX out = n_.transpose() * MatX(change.topLeftCorner(nv, nv) * n_);
    if (rows > 0) {
      MatX const turned = -smallest_solution(g_, change.bottomLeftCorner(rows, nv) * n_, 1e-10);
      MatX const mixed = n_.transpose() * MatX(k_ * turned);
      out += mixed + mixed.transpose();
    }
    return out;
  }

  System& system_;
  State const& x_;
  double factor_;
  VecX loads_, u_, mu_;
  MatX k_, g_, n_, a_;
  Eigen::LLT<MatX> stable_;
};

}  // namespace detail

/// Buckling loads and modes of a structure in the state x, by linearised prebuckling [Bathe 1996, §6.8.2]: the
/// stiffness of the motions that the constraint equations permit is linear in the load factor p of all loads and of
/// gravity,
///   (K + (p − p₀) K_g) z = 0,   K_g = dK/dp along the tangent of the path of equilibria at x.
/// K_g is computed by central differences of the tangent with a step of 1 % of the first buckling load. It contains the
/// stress and the displacement before buckling to first order. All loads and gravity have the same factor, so no load
/// can remain constant. Only factors p > p₀ are computed. For loads in the opposite direction, reverse the forces of
/// the model. The result is empty if the structure does not buckle.
///
/// Limits: The result is exact if displacements before buckling are small and stiffness is linear in the load, as in
/// columns and frames with axial forces. Shallow arches have a limit point; there the first eigenvalue is an estimate,
/// usually too large. The estimate is closer if x is an equilibrium near the critical load and load_factor is 1.
/// `equilibrium_path` computes the path itself. Follower loads and dead moments in space are refused: their stiffness
/// is not symmetric, and flutter may occur at a smaller load. Dense matrices limit models to some hundred generalised
/// velocities. First-order states are refused.
/// \throws InvalidInput if x moves or is not a stable equilibrium at `options.load_factor`, if the model has no loads,
/// or if its stiffness is not symmetric. Afterwards the load factor of the system is 1.
template <class = void>  // compiled where it is used
BucklingModes buckling_modes(System& system, State const& x, BucklingOptions const& options = {}) {
  if (options.count < 1)
    throw InvalidInput("buckling.option",
                       {ErrorObject{"buckling_modes"}, ": the number of modes must be at least 1, but is ",
                        ErrorValue{options.count}, "."});
  if (!std::isfinite(options.load_factor))
    throw InvalidInput("buckling.option", {ErrorObject{"buckling_modes"}, ": the load factor must be finite, but is ",
                                           ErrorValue{options.load_factor}, "."});
  require_usable(system, x);
  if (largest_size(x.v) > 1e-9 || system.layout().states > 0)
    throw InvalidInput("buckling.state", {ErrorObject{"buckling_modes"},
                                          ": the state must be at rest, and the model must not have first-order "
                                          "states, but the largest velocity is ",
                                          ErrorValue{largest_size(x.v)}, ", and there are ", system.layout().states,
                                          " first-order states."});
  detail::PrebucklingPath const path(system, x, options.load_factor);
  MatX const& a = path.stiffness();
  Eigen::GeneralizedSelfAdjointEigenSolver<MatX> solver;
  double step = 1e-6 / std::max(largest_size(path.displacement()), 1e-300);
  for (int pass = 0; pass < 4; ++pass) {
    MatX const b = path.rate(step);
    if (pass > 0 && (b - b.transpose()).norm() > 1e-4 * b.norm())
      throw InvalidInput("buckling.not_symmetric",
                         {ErrorObject{"buckling_modes"},
                          ": the stiffness of the loads is not symmetric, for example because of follower forces or "
                          "moments in space. Compute equilibrium() and damped_modes() for increasing loads instead."});
    solver.compute(-0.5 * (b + b.transpose()), a,  // −K_g z = θ K z, p − p₀ = 1/θ
                   (pass == 0 ? Eigen::EigenvaluesOnly : Eigen::ComputeEigenvectors) | Eigen::Ax_lBx);
    double const largest = solver.eigenvalues().cwiseAbs().maxCoeff(), next = 0.01 / largest;
    if (!(largest > 0.0)) return {};
    bool const done = pass > 0 && std::abs(next - step) < 0.1 * step;
    step = next;
    if (done) break;
  }
  VecX const& theta = solver.eigenvalues();
  Index found = 0;
  while (found < std::min(options.count, theta.size()) &&
         theta[theta.size() - 1 - found] > 1e-9 * theta.cwiseAbs().maxCoeff())
    ++found;
  BucklingModes out{VecX::Zero(found), MatX::Zero(path.basis().rows(), found)};
  for (Index i = 0; i < found; ++i) {
    Index const column = theta.size() - 1 - i;
    out.load_factor[i] = options.load_factor + 1.0 / theta[column];
    VecX const shape = path.basis() * solver.eigenvectors().col(column);
    Index largest = 0;
    shape.cwiseAbs().maxCoeff(&largest);
    out.shape.col(i) = shape / shape[largest];
  }
  return out;
}
/// Overload for a model. \throws InvalidInput under the conditions of the overload for a System.
template <class M>
  requires(!std::same_as<M, System>)
BucklingModes buckling_modes(M const& model, State const& x, BucklingOptions const& options = {}) {
  System system(model, with<Capabilities::implicit_step>);
  return buckling_modes(system, x, options);
}

}  // namespace polybody
