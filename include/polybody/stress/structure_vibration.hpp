#pragma once
/// \file
/// Vibration of a structure under the loads of a recorded rigid motion, and linear vibration problems M q̈ + D(t) q̇ +
/// K(t) q = f(t) as systems.
/// Theory: Eq. 11.19.

#include <polybody/bodies/ffr/ffr_basis.hpp>
#include <polybody/integrators/integrator.hpp>
#include <polybody/solvers/dense_lu.hpp>
#include <polybody/stress/structure_loads.hpp>
#include <polybody/system/user_system.hpp>

namespace polybody {

/// Load history: `load(t, f)` writes f(t) to `f` (n).
template <class L>
concept LoadHistory = requires(L const load, double t, VecX f) { load(t, f); };
/// Load with time-varying damping and stiffness (n×n): `add_matrices` adds their changes at time t to d and k.
template <class L>
concept TimeVaryingMatrices = requires(L const load, double t, MatX d, MatX k) { load.add_matrices(t, d, k); };

/// M q̈ + D q̇ + K q = f(t) as equations of `UserMechanics`.
template <LoadHistory Load>
struct LinearVibration {
  MatX mass_matrix, damping, stiffness;  ///< (n×n) M, constant parts of D and K
  Load load;                             ///< f(t)
  mutable MatX d = {}, k = {};           ///< workspace: D(t) and K(t) of the last evaluation

  /// Number n of coordinates.
  Index velocities() const { return mass_matrix.rows(); }
  /// Writes M (n×n) to m.
  void mass(VecX const&, MatX& m) const { m = mass_matrix; }
  /// Writes f(t) − D q̇ − K q at t [s] to `f` (n).
  void force(VecX const& q, VecX const& v, double t, VecX& f) const {
    load(t, f);
    update(t);
    f.noalias() -= d * v;
    f.noalias() -= k * q;
  }
  /// Writes ck K + cd D at t [s] to `out` (n×n).
  void tangent(VecX const&, VecX const&, double t, double ck, double cd, MatX& out) const {
    update(t);
    out = ck * k + cd * d;
  }

 private:
  void update(double t) const {
    d = damping;
    k = stiffness;
    if constexpr (TimeVaryingMatrices<Load>) load.add_matrices(t, d, k);
  }
};

/// Options for the vibration of a structure under the loads of a recorded rigid motion (structure_loads.hpp), in
/// nodal or modal coordinates e = Φ q relative to the body's frame:
///   M q̈ + D q̇ + K q = Φᵀ(Q_f − m_fr q̈_r − C_qfᵀ λ)   [Wallin 2016, §4.3.5].
/// Any integrator for a `System` solves this equation.
///
/// The frame moves with the rigid body, so the result depends on the points of attachment (`frame`). If joints guide
/// the body, the frame should be attached at these joints. For a free body the frame should follow the mean motion
/// (`free_interface_modes`, with `ReferenceConditions::none()`).
struct Vibration {
  ReferenceConditions frame = ReferenceConditions::clamped();  ///< attachment of the frame
  MatX shapes = {};  ///< Φ (N×n), computed with `frame`; empty: all nodal coordinates
  /// true: includes the terms linear in the deformation: 2 S̃₁ q̇ (Coriolis), S̃₂ q (centrifugal), and m_fr(q) of Ω˙
  /// [Wallin 2016, A.4]. Wallin 2016 neglects these terms. Geometric stiffening by axial forces is neglected in both
  /// cases.
  bool follows_deformation = false;
  double stiffness_damping = 0.0;  ///< τ [s]; a damping matrix τ K is added to that of the structure
  bool settled = true;  ///< true: starts at rest in the static deformation of the first loads; false: undeformed
  /// Steps of the integrator per interval between samples; with step size control, only for the first step. Loads are
  /// interpolated linearly.
  int substeps = 1;
};

namespace detail {

/// Weighted sum Σ_kl x_kl ∫ρ S_kᵀ S_l.
template <class Matrix>
Matrix weighted(Mat3 const& x, std::array<Matrix, 6> const& inertia) {
  Matrix sum = x(0, 0) * inertia[0];
  for (std::size_t p = 1; p < 3; ++p) sum += x(Index(p), Index(p)) * inertia[p];
  for (std::size_t p = 3; p < 6; ++p) {
    Matrix const back = inertia[p].transpose();
    Matrix both = x(symmetric_row[p], symmetric_column[p]) * inertia[p];
    both += x(symmetric_column[p], symmetric_row[p]) * back;
    sum += both;
  }
  return sum;
}

/// Loads on q, interpolated linearly between the samples. `products` adds the terms that depend on the deformation.
struct LoadLines {
  StructureLoads const* of;
  MatX loads;                    ///< (n×samples)
  std::array<MatX, 6> products;  ///< Φᵀ ∫ρ S_kᵀ S_l Φ; empty without `follows_deformation`

  template <class = void>  // compiled where it is used
  std::pair<Index, double> between(double t) const {
    std::vector<double> const& times = of->times();
    Index const after =
        std::clamp<Index>(std::upper_bound(times.begin(), times.end(), t) - times.begin(), 1, Index(times.size()) - 1);
    double const t0 = times[std::size_t(after) - 1], t1 = times[std::size_t(after)];
    return {after, std::clamp((t - t0) / (t1 - t0), 0.0, 1.0)};
  }
  template <class = void>
  void operator()(double t, VecX& f) const {
    auto const [after, share] = between(t);
    f = (1.0 - share) * loads.col(after - 1) + share * loads.col(after);
  }
  template <class = void>
  void add_matrices(double t, MatX& damping, MatX& stiffness) const {
    if (products[0].size() == 0) return;
    auto const [after, share] = between(t);
    StructureLoads::Motion const &x = of->motion(std::size_t(after) - 1), &y = of->motion(std::size_t(after));
    damping += weighted<MatX>(2.0 * skew<double>((1.0 - share) * x.omega + share * y.omega), products);
    stiffness += weighted<MatX>((1.0 - share) * x.B + share * y.B, products);
  }
};

}  // namespace detail

/// Histories of nodal displacements, velocities and accelerations (N×samples). Displacements and velocities are empty
/// if the inertia forces do not depend on the deformation.
struct VibrationHistory {
  MatX deformed, rate;  ///< Φ q and Φ q̇; empty without `follows_deformation`
  MatX acceleration;    ///< Φ q̈

  /// Inertia forces M Φ q̈ + 2 S̃₁ Φ q̇ + … (N×samples); K e equals the loads minus these forces.
  template <class = void>
  MatX inertia(StructureLoads const& loads) const {
    Structure const& s = loads.structure();
    MatX sum = s.mass_matrix() * acceleration;
    for (Index k = 0; k < deformed.cols(); ++k) {
      StructureLoads::Motion const& at = loads.motion(std::size_t(k));
      sum.col(k) += detail::weighted<Structure::Sparse>(at.B, s.inertia) * deformed.col(k) +
                    detail::weighted<Structure::Sparse>(2.0 * skew<double>(at.omega), s.inertia) * rate.col(k);
    }
    return sum;
  }
};

namespace detail {

/// \throws InvalidInput for shapes of another size, and shapes that move a coordinate that the frame fixes.
template <class = void>
void require_fitting_shapes(Structure const& s, Vibration const& how, std::string const& who) {
  if (how.shapes.rows() != s.size())
    throw InvalidInput("ffr.shape_size", {ErrorObject{who}, "the shapes have ", ErrorValue{how.shapes.rows()},
                                          " rows, but the structure has ", s.size(), " nodal coordinates."});
  std::vector<char> fixed(std::size_t(s.size()), 1);
  for (Index const i : how.frame.free_coordinates(s)) fixed[std::size_t(i)] = 0;
  for (Index i = 0; i < s.size(); ++i)
    if (fixed[std::size_t(i)] && !how.shapes.row(i).isZero(0.0))
      throw InvalidInput("stress.shapes", {ErrorObject{who}, "the shapes move node ", i / s.per_node,
                                           ", which the reference conditions fix. Set `Vibration::frame` to the "
                                           "conditions for which the shapes were computed."});
}

}  // namespace detail

/// Computes the vibration of a structure under `loads`, with the options `how`. \throws InvalidInput for shapes that do
/// not fit the structure, move a coordinate that the frame fixes or have no stiffness, for a negative damping time, and
/// for less than one substep. Exceptions of the integrator are passed on.
template <LinearSolver Solver = DenseLu, class I>
VibrationHistory vibration_of(StructureLoads const& loads, I const& integrator, Vibration how) {
  Structure const& s = loads.structure();
  std::string const who = sentence_of({"Stress of \"", loads.name(), "\": "});
  require_not_negative(how.stiffness_damping, who, "the damping time");
  if (how.substeps < 1)
    throw InvalidInput("stress.substeps", {ErrorObject{who}, "each interval needs at least one substep, but has ",
                                           ErrorValue{how.substeps}, "."});
  if (how.shapes.size() == 0) how.shapes = nodal_coordinates(s, how.frame);
  detail::require_fitting_shapes(s, how, who);
  MatX const& shapes = how.shapes;

  Index const samples = Index(loads.times().size()), n = shapes.cols();
  auto const carried = [&](Structure::Sparse const& m) {
    MatX const images = m * shapes;
    return MatX(shapes.transpose() * images);
  };
  LinearVibration<detail::LoadLines> problem{.mass_matrix = carried(s.mass_matrix()),
                                             .damping = carried(s.damping),
                                             .stiffness = carried(s.stiffness),
                                             .load = {&loads, shapes.transpose() * loads.nodal(), {}}};
  problem.damping += how.stiffness_damping * problem.stiffness;
  if (how.follows_deformation)
    for (std::size_t p = 0; p < 6; ++p) problem.load.products[p] = carried(s.inertia[p]);
  Eigen::LDLT<MatX> const factor(problem.stiffness);
  if (!(factor.vectorD().minCoeff() > 1e-13 * factor.vectorD().maxCoeff()))
    throw InvalidInput(
        "stress.shapes",
        {ErrorObject{who},
         "some of the shapes have no stiffness. Omit rigid motions of the structure, and linearly dependent shapes."});

  System system = system_of(problem, loads.name(), true);
  State x{VecX::Zero(n), VecX::Zero(n), VecX::Zero(n), VecX::Zero(0), loads.times().front(), {}};
  if (how.settled) x.q = factor.solve(problem.load.loads.col(0));
  MatX q(n, samples), v(n, samples), a(n, samples);
  auto const keep = [&](Index k) {
    q.col(k) = x.q;
    v.col(k) = x.v;
    a.col(k) = x.a;
  };
  auto const method = method_of(integrator);
  auto workspace = method.template workspace<Solver>(system);
  double next = (loads.times()[1] - loads.times()[0]) / how.substeps;
  method.start(system, x, next, workspace);
  keep(0);
  for (Index k = 1; k < samples; ++k) {
    double const from = x.t, target = loads.times()[std::size_t(k)], piece = (target - from) / how.substeps;
    if constexpr (!requires { I::adaptive_step; }) next = piece;
    while (target - x.t > 1e-9 * piece) {
      StepReport const report = method.step(system, x, std::min(next, target - x.t), workspace);
      if constexpr (requires { I::adaptive_step; }) next = std::min(report.next, target - from);
    }
    x.t = target;
    keep(k);
  }
  if (!how.follows_deformation) return {{}, {}, shapes * a};
  return {shapes * q, shapes * v, shapes * a};
}

}  // namespace polybody
