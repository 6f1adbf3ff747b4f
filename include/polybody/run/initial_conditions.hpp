#pragma once
/// \file
/// Consistent initial conditions: assembly of positions, projection of velocities, accelerations and multipliers.
/// Theory: Eqs. 6.27, 11.3.

#include <limits>

#include <polybody/integrators/unknown_kinds.hpp>
#include <polybody/math/vectors.hpp>
#include <polybody/run/redundant_constraints.hpp>
#include <polybody/run/state_checks.hpp>
#include <polybody/system/make_operations.hpp>

namespace polybody {

namespace detail {
/// Index of the equation with the largest violation; 0 if there is none.
template <class = void>
Index most_open(VecX const& phi) {
  Index worst = 0;
  for (Index i = 1; i < phi.size(); ++i)
    if (std::abs(phi[i]) > std::abs(phi[worst])) worst = i;
  return worst;
}
}  // namespace detail

namespace detail {

/// Constraint violations in a state. If the extent of an assembly of bodies is below one metre, violations of lengths
/// are divided by this extent. The extent is the largest distance of bodies and joint markers along a world axis.
template <class = void>  // compiled only if used
struct RelativeViolation {
  VecX absolute;  ///< Φ (rows) [m], [rad]
  VecX phi;       ///< Φ (rows), each divided by its `extent`
  VecX extent;    ///< (rows) extent of the assembly [m]; 1 for an absolute violation
  Index worst;    ///< row with the largest |phi|; 0 if there is none

  /// Evaluates `system` at x.
  RelativeViolation(System& system, State const& x)
      : absolute(VecX::Zero(system.rows())), phi(absolute), extent(VecX::Constant(system.rows(), 1.0)), worst(0) {
    system.evaluate(x.q, x.v, x.t);
    system.violation(absolute);
    phi = absolute;
    if (largest_size(phi) > 0.0 && !system.step_coordinates()) relate(system, x);
    worst = most_open(phi);
  }
  double size() const { return phi.size() == 0 ? 0.0 : std::abs(phi[worst]); }  ///< largest |phi|

 private:
  struct Box {
    Vec3 least = Vec3::Constant(std::numeric_limits<double>::infinity()), most = -least;
    void stretch(Index axis, double at) {
      least[axis] = std::min(least[axis], at);
      most[axis] = std::max(most[axis], at);
    }
    double extent() const {
      double out = 0.0;
      for (Index i = 0; i < 3; ++i) out = std::max(out, most[i] - least[i]);
      return out;
    }
    double farthest() const { return std::max(largest_size(least), largest_size(most)); }
  };

  void relate(System const& system, State const& x) {
    ModelLayout const& layout = system.layout();
    Sequence<Index> const assembly = assemblies_of(layout);
    Sequence<Box> boxes(assembly.size());
    auto const owner = [&](Index marker) { return marker < 0 ? Index(-1) : layout.owners[std::size_t(marker)]; };
    auto const box_of = [&](JointLayout const& j) -> Box* {
      Index const body = std::max(owner(j.a), owner(j.b));
      return body < 0 ? nullptr : &boxes[std::size_t(assembly[std::size_t(body)])];
    };
    for (JointLayout const& j : layout.joints)
      for (Index const marker : {j.a, j.b})
        if (Box* const box = box_of(j); box && marker >= 0)
          for (Index i = 0; i < 3; ++i) box->stretch(i, system.data().markers[std::size_t(marker)].frame.r[i]);
    UnknownPlaces const places = full_places(layout);
    for (std::size_t i = 0; i < places.of_q.size(); ++i)
      if (UnknownPlace const& at = places.of_q[i]; at.axis >= 0)
        boxes[std::size_t(assembly[std::size_t(at.body)])].stretch(at.axis, x.q[Index(i)]);
    for (ConstraintBlock<double> const& block : system.data().rows) {
      if (block.row < 0 || block.source != ConstraintSource::joint) continue;
      Box const* const box = box_of(layout.joints[std::size_t(block.owner)]);
      if (!box) continue;
      // absolute: violations within round-off, and violations above 1 % of the extent, which they then affect
      double const of_box = box->extent(), rounding = 16.0 * std::numeric_limits<double>::epsilon() * box->farthest();
      for (int i = 0; i < block.rows; ++i) {
        double const open = std::abs(absolute[block.row + i]);
        if (!is_length(block, i) || !(of_box < 1.0) || 100.0 * open > of_box || open <= rounding) continue;
        extent[block.row + i] = of_box;
        phi[block.row + i] /= of_box;
      }
    }
  }
  /// True if row i of a joint depends on the position of a marker.
  static bool is_length(ConstraintBlock<double> const& block, int i) {
    for (ConstraintSide<double> const* const end : {&block.a, &block.b})
      for (int k = 0; k < 3 && end->marker >= 0 && end->columns == 6; ++k)
        if (std::abs(end->map[k * block.rows + i]) > 0.5e-3) return true;
    return false;
  }
};

}  // namespace detail

/// Requires constraint violations of at most `tolerance` [m], [rad]. If the extent of an assembly of bodies is below
/// one metre, the limit of lengths is `tolerance` times this extent. \throws InconsistentInitialConditions naming the
/// joint with the largest violation.
template <class = void>
[[gnu::cold]] void require_assembled(System& system, State const& x, double tolerance = 1e-8) {
  detail::RelativeViolation<> const open(system, x);
  if (open.size() <= tolerance) return;
  std::string const name = system.name_of(system.velocities() + open.worst);
  double const by = std::abs(open.absolute[open.worst]), extent = open.extent[open.worst];
  if (by > tolerance)
    throw InconsistentInitialConditions("initial_state.violation",
                                        {"The initial state violates ", ErrorObject{name}, " by ", ErrorValue{by},
                                         " (m or rad), but the limit is ", tolerance,
                                         ". Place the bodies so that the violation vanishes, or call "
                                         "assemble(model, x)."});
  throw InconsistentInitialConditions(
      "initial_state.violation",
      {"The initial state violates ", ErrorObject{name}, " by ", ErrorValue{by}, " m, but the limit is ",
       tolerance * extent, " m: the tolerance ", tolerance, " times the extent ", extent,
       " m of its assembly. Place the bodies so that the violation vanishes, or call assemble(model, x)."});
}

/// Factorises `forward` at x. \throws InconsistentInitialConditions if redundant equations contradict each other, so
/// that no configuration satisfies them; the message names their joints.
template <class Solver>
[[gnu::cold]] void require_closable(System& system, ForwardDynamics<Solver>& forward, State const& x) {
  if (!all_finite(x.q)) return;
  forward.hold(system, x.q, x.v, x.t);
  VecX phi = VecX::Zero(system.rows());
  system.violation(phi);
  require_consistent_constraints(system, forward, phi, detail::ContradictionLimits{}.position, "positions (m or rad)");
}

/// Corrects the coordinates until every joint is satisfied to `tolerance` [m], [rad], in at most `max_iterations`
/// Gauss–Newton iterations with minimal changes in the mass norm. If the extent of an assembly of bodies is below one
/// metre, violations of lengths are also at most max(tolerance, 1e-9) times this extent. Then projects the velocities.
/// \throws InconsistentInitialConditions naming the joint that cannot be satisfied, or the joints whose redundant
/// equations contradict each other; InvalidInput for a state of another model, or a quaternion whose norm is not one.
/// After an exception x is unchanged.
template <LinearSolver Solver = DefaultSolver>
void assemble(System& system, State& x, double tolerance = 1e-12, int max_iterations = 50) {
  require_positive(tolerance, "assemble: the tolerance");
  require_count(max_iterations, "assemble: max_iterations");
  require_fitting(system, x);
  require_places(system, x);
  ForwardDynamics<Solver> forward(system);
  State trial = x;
  double before = 0.0;
  for (int k = 0;; ++k) {
    bool const closed = detail::RelativeViolation<>(system, trial).size() <= std::max(tolerance, 1e-9);
    before = forward.project_positions_once(system, trial.q, trial.v, trial.t);
    if (before <= tolerance && (closed || k == max_iterations)) break;
    if (k == max_iterations || !std::isfinite(before)) {
      require_closable(system, forward, trial);
      require_assembled(system, trial, tolerance);
      throw InconsistentInitialConditions(
          "assemble.not_converged",
          {ErrorObject{"assemble"},
           ": no configuration that satisfies all joints was found from this state. "
           "Place the bodies closer to such a configuration, or check the lengths of the bodies."});
    }
  }
  forward.project_velocities(system, trial.q, trial.v, trial.t);
  require_consistent_redundancy(system, forward, trial);
  x = std::move(trial);
}

/// Corrects the coordinates of x until every joint of `model` is satisfied to `tolerance` [m], [rad], in at most
/// `max_iterations` iterations. Then projects the velocities. Exceptions as for the overload for `System`.
template <class M>
void assemble(M const& model, State& x, double tolerance = 1e-12, int max_iterations = 50) {
  System system(model, with<Capabilities::motion>);
  assemble(system, x, tolerance, max_iterations);
}

/// Makes state x consistent at its time, as the start of a run does: projects the velocities onto the constraint
/// equations, then computes the accelerations and multipliers. The coordinates do not change, and the multipliers of
/// redundant constraints are zero.
/// \throws InconsistentInitialConditions naming a joint whose violation exceeds `tolerance` [m], [rad] (`assemble`
/// removes this violation), or the joints with redundant equations that contradict each other; InvalidInput,
/// SingularMatrix, NonFiniteValue. After an exception x is unchanged.
template <LinearSolver Solver = DefaultSolver>
void make_consistent(System& system, State& x, double tolerance = 1e-8) {
  require_positive(tolerance, "make_consistent: the tolerance");
  require_usable(system, x);
  require_assembled(system, x, tolerance);
  ForwardDynamics<Solver> forward(system);
  State fresh = x;
  forward.project_velocities(system, fresh.q, fresh.v, fresh.t);
  require_consistent_redundancy(system, forward, fresh);
  forward.accelerations(system, {fresh.q, fresh.v, fresh.t}, fresh.a, fresh.lambda);
  x = std::move(fresh);
}
/// Makes state x of a model consistent to `tolerance` [m], [rad], like `make_consistent(system, x, tolerance)`.
template <class M>
  requires(!std::same_as<M, System>)
void make_consistent(M const& model, State& x, double tolerance = 1e-8) {
  System system(model, with<Capabilities::motion>);
  make_consistent(system, x, tolerance);
}

}  // namespace polybody
