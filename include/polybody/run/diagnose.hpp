#pragma once
/// \file
/// Diagnosis of a model at a state, before a run: constraint violations, redundant constraint equations, unconnected
/// bodies, and stable steps of explicit integrators.
/// Theory: Eqs. 7.11, 11.37.

#include <ostream>

#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/integrators/symplectic.hpp>
#include <polybody/run/observe.hpp>
#include <polybody/run/redundancy.hpp>
#include <polybody/run/summary.hpp>
#include <polybody/solvers/default_solver.hpp>

namespace polybody {

/// Diagnosis of a model at a state.
struct Diagnosis {
  Violation violation;                      ///< largest constraint violations
  std::string largest_violated_joint = {};  ///< joint "a" or body "b" with the largest |Φ|; empty without violation
  Redundancy redundancy;                    ///< redundant and contradictory constraint equations
  std::vector<std::string> unconnected_bodies = {};  ///< bodies without a path of joints to the ground
  double stiffest = 0.0;         ///< largest angular frequency of undamped small motions [rad/s]; 0 without elasticity
  std::string stiffest_at = {};  ///< body with the largest kinetic energy in this motion
  std::string unsolved = {};     ///< error message if accelerations cannot be computed; otherwise empty

  /// An explicit integrator and its largest stable step.
  struct StableStep {
    std::string integrator;  ///< name of the integrator
    double step;             ///< largest stable step without damping [s]
  };
  /// Steps for `SymplecticEuler`, `CentralDifference` and `RungeKutta4`. Empty without elasticity.
  std::vector<StableStep> stable_steps = {};
};

namespace detail {

/// Undamped small motion with the largest frequency, under the stiffness K = −∂f/∂q alone. The power iteration solves M
/// aₖ₊₁ + Gᵀμ = K aₖ, G aₖ₊₁ = 0. With the damping D = −∂f/∂v instead of K, the squared frequency is the largest decay
/// rate.
class StiffestMotion {
 public:
  using Matrix = Eigen::SparseMatrix<double>;

  /// Power iteration for the largest aᵀK a/aᵀM a. The estimate converges from below, with a relative error of at most
  /// 1e-3 if the relative distance of the two largest eigenvalues is at least 1e-3. `forward` must be factorised at the
  /// state at which `system` was evaluated.
  template <class = void>
  StiffestMotion(System& system, ForwardDynamics<DefaultSolver>& forward, TangentCoefficients of = {.stiffness = 1.0}) {
    Matrix const elastic = matrix_of(
        system, [&](auto& sink) { system.tangent(of, SecondOrder::omitted, VecX::Zero(system.rows()), sink); });
    VecX a(system.velocities()), mu = VecX::Zero(system.rows());
    for (Index i = 0; i < a.size(); ++i) a[i] = std::fmod(0.6180339887498949 * double(i + 1), 1.0) - 0.5;
    VecX pushed = elastic * a;
    for (int pass = 0; pass < 1000; ++pass) {
      double const size = pushed.norm();
      if (!(size > 0.0)) return;
      VecX const w = pushed / size;
      forward.response(system, w, a, mu);
      double const mass = a.dot(w);
      pushed = elastic * a;
      double const now = mass > 0.0 ? a.dot(pushed) / mass : 0.0;
      if (!(now > 0.0)) return;
      bool const settled = now <= squared_ * (1.0 + 1e-7);
      squared_ = std::max(squared_, now);
      motion_ = a;
      if (pass > 20 && settled) return;
    }
  }
  double frequency() const { return std::sqrt(squared_); }
  /// Name of the body with the largest kinetic energy in this motion.
  template <class = void>
  std::string body(System& system) const {
    Matrix const mass = matrix_of(system, [&](auto& sink) { system.masses(sink); });
    VecX const energies = motion_.cwiseProduct(mass * motion_);
    std::string name;
    double most = 0.0;
    for (BodyLayout const& b : system.layout().bodies)
      if (double const of_body = energies.segment(b.v0, b.velocities).sum(); of_body > most) {
        most = of_body;
        name = b.name;
      }
    return name;
  }

 private:
  struct Sink {
    Index velocities;
    std::vector<Eigen::Triplet<double>> entries = {};
    void add(Index row, Index col, BlockView const& b) {
      if (row >= velocities || col >= velocities) return;
      for (Index j = 0; j < b.cols; ++j)
        for (Index i = 0; i < b.rows; ++i) entries.emplace_back(int(row + i), int(col + j), b(i, j));
    }
  };
  template <class Write>
  static Matrix matrix_of(System& system, Write const& write) {
    Sink sink{system.velocities()};
    write(sink);
    Matrix out(system.velocities(), system.velocities());
    out.setFromTriplets(sink.entries.begin(), sink.entries.end());
    return out;
  }

  double squared_ = 0.0;
  VecX motion_;
};

template <HasStabilityLimit... Is>
void name_stable_steps(double omega, std::vector<Diagnosis::StableStep>& out) {
  (out.push_back({Is::name, Is::stable_step(omega, 0.0)}), ...);
}

}  // namespace detail

/// Diagnosis of a model at the coordinates, velocities and time of x. \throws InvalidInput for a state of another
/// model.
template <class = void>
Diagnosis diagnose(System& system, State const& x) {
  require_fitting(system, x);
  require_places(system, x);
  Diagnosis out{.violation = largest_violation(system, x), .redundancy = redundancy(system, x)};
  if (out.violation.position > 0.0) {
    VecX phi = VecX::Zero(system.rows());
    system.violation(phi);
    out.largest_violated_joint = system.name_of(system.velocities() + detail::most_open(phi));
  }
  ModelLayout const& layout = system.layout();
  detail::JointGraph const graph(layout);
  for (std::size_t k = graph.joined(); k < graph.order().size(); ++k)
    out.unconnected_bodies.push_back(layout.bodies[std::size_t(graph.order()[k].body)].name);
  try {
    ForwardDynamics<DefaultSolver> forward(system);
    forward.hold(system, x.q, x.v, x.t);
    detail::StiffestMotion const motion(system, forward);
    out.stiffest = motion.frequency();
    if (out.stiffest > 0.0) {
      out.stiffest_at = motion.body(system);
      detail::name_stable_steps<SymplecticEuler, CentralDifference<>, RungeKutta4<>>(out.stiffest, out.stable_steps);
    }
  } catch (Error const& failed) {
    out.unsolved = failed.what();
  }
  return out;
}
/// Diagnosis of a model at the coordinates, velocities and time of x. \throws InvalidInput for a state of another
/// model.
template <class M>
Diagnosis diagnose(M const& model, State const& x) {
  System system(model);
  return diagnose(system, x);
}

/// Writes the diagnosis as text, with one line for each finding.
template <class = void>
std::ostream& operator<<(std::ostream& out, Diagnosis const& c) {
  out << sentence_of({"constraint violation ", c.violation.position, " m or rad (positions), ", c.violation.velocity,
                      " m/s or rad/s (velocities)",
                      (c.violation.position > 0.0 ? ", the largest in " + c.largest_violated_joint : std::string()),
                      "\n"});
  out << sentence_of({c.redundancy.rows, " constraint equations of rank ", c.redundancy.rank, ", ",
                      c.redundancy.degrees_of_freedom,
                      c.redundancy.degrees_of_freedom == 1 ? " degree of freedom\n" : " degrees of freedom\n"});
  for (Redundancy::Share const& share : c.redundancy.repeated)
    out << share.name << ": "
        << detail::counted(share.rows, "redundant constraint equation\n", "redundant constraint equations\n");
  auto const contradict = [&](std::vector<std::string> const& groups, char const* in) {
    for (std::string const& group : groups) out << "contradict each other in " << in << ": " << group << '\n';
  };
  contradict(c.redundancy.in_positions, "positions");
  contradict(c.redundancy.in_velocities, "velocities");
  contradict(c.redundancy.in_accelerations, "accelerations");
  for (std::string const& body : c.unconnected_bodies) out << "not joined to the ground: " << body << '\n';
  if (!c.unsolved.empty()) out << c.unsolved << '\n';
  if (c.stiffest > 0.0)
    out << sentence_of({"stiffest motion ", c.stiffest, " rad/s, most in ", c.stiffest_at, "; largest stable steps:"});
  for (Diagnosis::StableStep const& s : c.stable_steps)
    out << (&s == &c.stable_steps.front() ? " " : ", ") << s.integrator << sentence_of({" ", s.step, " s"});
  if (c.stiffest > 0.0) out << ", implicit integrators any\n";
  return out;
}

}  // namespace polybody
