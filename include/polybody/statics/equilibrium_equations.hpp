#pragma once
/// \file
/// Equations of `equilibrium` for Newton's method along the load path (`EquilibriumPath`).
/// Theory: Eq. 7.14.

#include <polybody/integrators/unknown_kinds.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/solvers/newton.hpp>
#include <polybody/statics/equilibrium_options.hpp>
#include <polybody/statics/minimum_norm_step.hpp>
#include <polybody/system/state.hpp>
#include <polybody/system/system.hpp>

namespace polybody::detail {

// Rigid motions of the bodies in a null vector of the stiffness, and their description in messages.

/// Rigid part of the motion of one body under generalised velocities z of a model.
struct RigidPart {
  Vec3 velocity = Vec3::Zero();  ///< (3) velocity of the body-fixed point at the world's origin
  Vec3 turn = Vec3::Zero();      ///< (3) angular velocity, world axes
  double left = 0.0;             ///< |velocities that no rigid motion explains| / |velocities of the body|
};

/// Computes the rigid part of the motion of `body` by least squares. The generalised velocities of its six rigid
/// motions (three in the plane) are orthogonalised one after the other.
template <class = void>  // compiled where it is used
RigidPart rigid_part(System const& system, BodyLayout const& body, VecX const& z) {
  VecX all = VecX::Zero(system.layout().velocities), rest(body.velocities);
  Sequence<VecX> columns;
  Sequence<Vec6> motions;
  auto const dot = [](VecX const& a, VecX const& b) {
    double sum = 0.0;
    for (Index i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
  };
  for (Index i = 0; i < body.velocities; ++i) rest[i] = z[body.v0 + i];
  double const full = std::sqrt(dot(rest, rest));
  Vec6 found = zeros<Vec6>();
  for (int const k : {0, 1, 2, 3, 4, 5}) {
    if (body.planar && (k == 2 || k == 3 || k == 4)) continue;
    Vec6 motion = zeros<Vec6>();
    motion[k] = 1.0;
    system.operations().rigid_velocities(system.at().q, Vec3(motion[0], motion[1], motion[2]),
                                         Vec3(motion[3], motion[4], motion[5]), all);
    VecX column(body.velocities);
    for (Index i = 0; i < body.velocities; ++i) column[i] = all[body.v0 + i];
    double const before = std::sqrt(dot(column, column));
    for (std::size_t j = 0; j < columns.size(); ++j) {
      double const part = dot(columns[j], column);
      for (Index i = 0; i < column.size(); ++i) column[i] -= part * columns[j][i];
      for (int i = 0; i < 6; ++i) motion[i] -= part * motions[j][i];
    }
    double const length = std::sqrt(dot(column, column));
    if (!(length > 1e-9 * before)) continue;  // the spin of a straight cable has no velocities
    for (Index i = 0; i < column.size(); ++i) column[i] /= length;
    for (int i = 0; i < 6; ++i) motion[i] /= length;
    double const part = dot(column, rest);
    for (Index i = 0; i < column.size(); ++i) rest[i] -= part * column[i];
    for (int i = 0; i < 6; ++i) found[i] += part * motion[i];
    columns.push_back(std::move(column));
    motions.push_back(motion);
  }
  return {Vec3(found[0], found[1], found[2]), Vec3(found[3], found[4], found[5]),
          full > 0.0 ? std::sqrt(dot(rest, rest)) / full : 0.0};
}

/// Text "(0, 0, 1)" of a vector, rounded to six decimals.
template <class = void>
std::string in_brackets(Vec3 const& x) {
  std::string text;
  for (int i = 0; i < 3; ++i) text += (i > 0 ? ", " : "(") + number(std::round(1e6 * x[i]) / 1e6 + 0.0);
  return text + ')';
}

/// Text of a rigid motion: a translation along a direction, a rotation about an axis through a point, or both. `reach`,
/// 1 + max |q|, is the size of the model.
template <class = void>
std::string text_of(RigidPart const& part, double reach) {
  double const v = std::sqrt(squared_norm(part.velocity)), w = std::sqrt(squared_norm(part.turn));
  auto const direction = [](Vec3 x) {
    double length = std::sqrt(squared_norm(x)), largest = 0.0;
    for (int i = 0; i < 3; ++i)
      if (std::abs(x[i]) > (1.0 + 1e-6) * std::abs(largest)) largest = x[i];
    if (largest < 0.0) length = -length;
    for (int i = 0; i < 3; ++i) x[i] /= length;
    return x;
  };
  if (part.left > 1e-5 || !(v + w > 0.0)) return "changes its shape";
  if (w * reach <= 1e-6 * v) return sentence_of({"moves along ", in_brackets(direction(part.velocity))});
  Vec3 const axis = direction(part.turn), lever = part.turn.cross(part.velocity);
  Vec3 point;
  for (int i = 0; i < 3; ++i) point[i] = lever[i] / (w * w);
  std::string text = sentence_of({"turns about ", in_brackets(axis), " through ", in_brackets(point)});
  double along = 0.0;
  for (int i = 0; i < 3; ++i) along += axis[i] * part.velocity[i];
  if (std::abs(along) > 1e-6 * (v + w * reach)) text += " and moves along it";
  return text;
}

/// Text of the motion z of a model, with the name of the body of unknown i. Example: body "payload" turns about (0, 0,
/// 1) through (0, 0, -2).
template <class = void>
std::string name_of_motion(System const& system, VecX const& z, Index i) {
  std::string text = system.name_of(i);
  if (system.step_coordinates() || !system.operations().provides(Capabilities::rigid_velocities)) return text;
  double const reach = 1.0 + largest_size(system.at().q);
  int others = 0;
  double largest = 0.0;
  for (Index k = 0; k < system.velocities(); ++k) largest = std::max(largest, std::abs(z[k]));
  for (BodyLayout const& body : system.layout().bodies) {
    bool moves = false;
    for (Index k = body.v0; k < body.v0 + body.velocities; ++k) moves = moves || std::abs(z[k]) > 1e-6 * largest;
    if (i >= body.v0 && i < body.v0 + body.velocities)
      text += ' ' + text_of(rigid_part(system, body, z), reach);
    else if (moves)
      ++others;
  }
  if (others > 0) text += sentence_of({", and ", others, (others > 1 ? " other bodies" : " other body"), " with it"});
  return text;
}

/// Text with a remedy if neighbouring nodes of a body differ by a rotation above 2.5 rad; empty if there is no such
/// body. The interpolation between two nodes is unique only below half a turn.
template <class = void>
[[gnu::cold]] std::string remedy_of_elements(ModelLayout const& layout, VecX const& q) {
  UnknownPlaces const places = full_places(layout);
  for (BodyLayout const& body : layout.bodies) {
    Index last = -1;
    Index const entries = body.planar ? 1 : 4;
    for (Index i = body.q0; i + entries <= body.q0 + body.coordinates; ++i) {
      if (places.of_q[std::size_t(i)].kind != UnknownKind::rotation) continue;
      double along = 0.0;
      for (Index k = 0; last >= 0 && k < entries; ++k) along += q[last + k] * q[i + k];
      double const turn = body.planar ? std::abs(q[i] - q[std::max<Index>(last, body.q0)])
                                      : 2.0 * std::acos(std::min(1.0, std::abs(along)));
      if (last >= 0 && turn > 2.5)
        return sentence_of({". Neighbouring nodes of body \"", body.name, "\" differ by a rotation of ", turn,
                            " rad, but an element permits less than half a turn: use more elements"});
      last = i;
      i += entries - 1;
    }
  }
  return "";
}

/// Equations of `equilibrium` for Newton's method, at the fraction s of the path from the initial state to the
/// equilibrium.
template <class Solver>
struct EquilibriumPath {
  System& system;
  StaticTangent<Solver>& tangent;
  MinimumNormStep<Solver>& least;
  State& trial;
  double tolerance;
  bool takes_least = false;  ///< true: corrections are minimum-norm solutions by `least`
  /// True: a load step fails if the determinant of the tangent changes its sign between iterates. Beyond a limit point,
  /// Newton's method may otherwise converge to another branch.
  bool refuses_crossing = false;
  bool crosses = false;  ///< true: the determinant has changed its sign in this load step
  double sign = 0.0;     ///< sign of the determinant at the start of this load step; 0: not computed
  double least_rate = std::numeric_limits<double>::infinity();  ///< smallest max |Δq|/Δs of the load steps
  double far = 1e6 * (1.0 + trial.q.cwiseAbs().maxCoeff());     ///< largest allowed coordinate and correction
  Index nv = system.velocities(), rows = system.rows(), states = system.layout().states, bad = -1;
  double first = 0.0, share = 0.0;  ///< p₀, load factor at s = 0; s, fraction of the path
  VecX r0 = VecX::Zero(nv), phi0 = VecX::Zero(rows), r = r0, phi = phi0, y = VecX::Zero(nv + rows), dq = r, q = trial.q;
  VecX moved = r;  ///< sum of the corrections of this load step

  /// Starts the path at the present state.
  void begin() {
    system.evaluate(trial.q, trial.v, trial.t);
    system.load_factor = 0.0;
    system.residual(trial.a, trial.lambda, r0);
    system.load_factor = 1.0;
    system.residual(trial.a, trial.lambda, r);
    r -= r0;
    double const loads = r.squaredNorm();
    first = loads > 0.0 ? std::clamp(-r0.dot(r) / loads, 0.0, 1.0) : 0.0;
    r0 += first * r;
    system.violation(phi0);
  }
  void advance(double s) {
    sign = 0.0;
    crosses = false;
    moved.setZero();
    share = s;
    system.load_factor = first + s * (1.0 - first);
  }

  /// Updates `least_rate` with max |Δq|/Δs of a converged load step of length Δs = `part` that began at `before`.
  void measure_rate(State const& before, double part) {
    least_rate = std::min(least_rate, largest_size(trial.q - before.q) / part);
  }

  /// Checks the sign of the determinant halfway between `before` and the present state, because Newton's method may
  /// step over a range of negative stiffness.
  [[gnu::cold]] void look_half_way(State const& before) {
    if (crosses || sign == 0.0 || takes_least) return;
    VecX const half = 0.5 * moved, lambda = 0.5 * (before.lambda + trial.lambda);
    system.plus(before.q, half, q);
    system.evaluate(q, trial.v, trial.t);
    double const middle = tangent.sign_here(lambda);
    crosses = middle != 0.0 && middle != sign;
    system.evaluate(trial.q, trial.v, trial.t);
    tangent.sign_here(trial.lambda);
  }
  /// Returns the present load factor near a limit point, otherwise 0. Near a limit point the motion per load, K⁻¹
  /// ∂f/∂s, is more than 8 times the smallest max |Δq|/Δs of the load steps so far.
  [[gnu::cold]] double limit_point() {
    if (takes_least) return 0.0;
    double const factor = system.load_factor;
    system.evaluate(trial.q, trial.v, trial.t);
    VecX loads = r;
    system.load_factor = 0.0;
    system.residual(trial.a, trial.lambda, loads);
    system.load_factor = 1.0;
    system.residual(trial.a, trial.lambda, r);
    system.load_factor = factor;
    loads -= r;
    if (tangent.factor(trial.lambda) >= 0) return std::isfinite(least_rate) ? factor : 0.0;
    tangent.solve(loads, VecX::Zero(rows), y);
    double const rate = (1.0 - first) * largest_size(y.head(nv));
    return rate > 8.0 * least_rate ? factor : 0.0;
  }

  bool evaluate() {
    system.evaluate(trial.q, trial.v, trial.t);
    system.residual(trial.a, trial.lambda, r);
    system.violation(phi);
    r = (1.0 - share) * r0 - r;
    phi = (1.0 - share) * phi0 - phi;
    return r.allFinite() && phi.allFinite();
  }
  bool refactor() {
    bad = takes_least ? least.factor(trial.lambda) : tangent.factor(trial.lambda);
    if (bad >= 0 || takes_least) return bad < 0;
    double const now = tangent.sign_of_determinant();
    if (sign == 0.0) sign = now;
    crosses = crosses || now != sign;
    return true;
  }
  double solve() {
    if (takes_least)
      least.solve(r, phi, trial.lambda, y);
    else
      tangent.solve(r, phi, y);
    if (takes_least && least.excited() >= 0) return std::numeric_limits<double>::infinity();
    return correction();
  }
  /// Returns the relative size of the correction y and stores its coordinates in dq.
  double correction() {
    dq = y.head(nv);
    for (Index i = nv - states; i < nv; ++i) dq[i] /= 1.0 + std::abs(trial.v[i]);  // relative to the state
    Index largest = 0;
    double const step = dq.cwiseAbs().maxCoeff(&largest), size = trial.q.cwiseAbs().maxCoeff();
    if (!(step < far && size < far)) {  // only round-off resists this motion
      bad = largest;
      return std::numeric_limits<double>::infinity();
    }
    return step / (tolerance * (1.0 + size));
  }
  void apply() {
    system.plus(trial.q, dq, q);
    trial.q.swap(q);
    moved += dq;
    trial.v.tail(states) += y.segment(nv - states, states);
    trial.lambda += y.tail(rows);
  }

  /// Returns true if the tangent is singular at the present state; `least` then contains the springs that make it
  /// regular.
  bool is_singular() {
    if (!(tangent.growth() > MinimumNormStep<Solver>::suspicious)) return false;
    return finds_springs();
  }
  bool finds_springs() {
    system.evaluate(trial.q, trial.v, trial.t);
    return least.factor(trial.lambda) < 0 && !least.pins().empty();
  }
  /// \throws SingularMatrix naming the motion without stiffness that a load excites.
  void refuse_excited() const {
    if (!takes_least || least.excited() < 0) return;
    std::size_t const k = std::size_t(least.excited());
    Index const i = least.pins()[k];
    throw SingularMatrix(
        "equilibrium.singular",
        {"equilibrium: the stiffness is singular", place(), ", first at ", ErrorObject{system.name_of(i)},
         ". No stiffness resists this motion: ", name_of_motion(system, least.motion(k), i),
         ". The loads excite this motion. Fix every body, or pass a limit point with equilibrium_path. A slack rope or "
         "an open contact has no stiffness: replace it by a spring or a joint, or run until the motion is damped."});
  }
  /// \throws InconsistentInitialConditions naming a joint with redundant constraints that are violated.
  void require_closed() const {
    double const limit = 1e-8 * (1.0 + largest_size(trial.q));
    VecX open = phi;
    system.violation(open);
    for (Index const i : least.pins())
      if (i >= nv && !(std::abs(open[i - nv]) <= limit))
        throw InconsistentInitialConditions(
            "constraints.contradiction",
            {"equilibrium: ", ErrorObject{system.name_of(i)}, " is violated by ", ErrorValue{std::abs(open[i - nv])},
             " (m or rad), because its constraint equations contradict those of other joints. Remove one of these "
             "joints, make their dimensions and time functions agree, or give one a compliant policy such as "
             "Penalty."});
  }
  std::string place() const { return sentence_of({" at load factor ", system.load_factor}); }
  /// \throws SingularMatrix, NonFiniteValue, NewtonConvergenceFailure according to `result`.
  /// \param branching joints of `joints_of_branch_point` at the start; empty if there are none
  [[noreturn, gnu::cold]] void refuse(NewtonResult result, Index first_bad, std::string const& at,
                                      std::string const& branching) const {
    if (result == NewtonResult::singular) {
      std::string const row = system.name_of(std::max<Index>(first_bad, 0));
      if (!branching.empty())
        throw SingularMatrix(
            "equilibrium.singular",
            {"equilibrium: the stiffness is singular", at, ", first at ", ErrorObject{row},
             ". The initial state is a singular configuration: the constraint equations of ", branching,
             " are redundant there, but not nearby, and their forces are not determined. Replace one of these joints "
             "by a joint with fewer constraint equations, or fix the bodies in another way."});
      throw SingularMatrix("equilibrium.singular",
                           {"equilibrium: the stiffness is singular", at, ", first at ", ErrorObject{row},
                            ". Fix every body, or pass a limit point with equilibrium_path."});
    }
    if (result == NewtonResult::not_finite)
      throw NonFiniteValue("equilibrium.not_finite", {ErrorObject{"equilibrium"}, ": a force is not finite", at,
                                                      ". Check the forces and the initial state."});
    throw NewtonConvergenceFailure(
        "equilibrium.not_converged",
        {ErrorObject{"equilibrium"}, ": Newton's method did not converge", at,
         remedy_of_elements(system.layout(), trial.q), ". Use more load steps, or start closer to the solution."});
  }
  /// Adds the motions and constraints to which `least` has added springs to the report, by their names.
  void report_springs(EquilibriumReport& report) const {
    report.free_motions.clear();
    report.redundant.clear();
    auto const add_row = [&](Index i) {
      std::string name = system.name_of(i);
      if (std::find(report.redundant.begin(), report.redundant.end(), name) == report.redundant.end())
        report.redundant.push_back(std::move(name));
    };
    for (Index const i : tangent.dropped()) add_row(i);
    for (std::size_t k = 0; k < least.pins().size(); ++k)
      if (Index const i = least.pins()[k]; i < nv)
        report.free_motions.push_back(name_of_motion(system, least.motion(k), i));
      else
        add_row(i);
  }
};

/// Newton's method at the present fraction of the path; adds its iterations to the report.
template <class Solver>
NewtonResult correct(EquilibriumPath<Solver>& path, EquilibriumOptions const& options, EquilibriumReport& report) {
  ReusedFactorisation reused;
  NewtonReport const n = newton(path, {.max_iterations = options.max_iterations, .always_refactor = true}, reused);
  report.iterations += n.iterations;
  return n.result;
}

}  // namespace polybody::detail
