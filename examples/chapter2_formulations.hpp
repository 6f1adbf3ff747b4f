#pragma once
// The arm and the cantilever of Chapter 2 under each combination of body, policy and integrator: the table of the
// combinations, single runs, and the comparison at equal error. This header does not depend on the types of the
// bodies. Each file of the folder chapter2 compiles one body.
#include <functional>
#include <string>
#include <vector>

#include "chapter2.hpp"
#include "support/combination_table.hpp"

namespace chapter2 {

enum class Mechanism { arm, cantilever };

// Settings of a mechanism, equal for all formulations.
struct Setup {
  Stiffness stiffness = medium;
  double density = 7850.0;  // [kg/m^3]
  double ramp = 4.5;        // duration of the arm's motion [s]
  double moment = 30e3;     // at the tip of the cantilever [N m]
};

// Mechanism with erased types.
struct AnyMechanism {
  AnyModel model;
  std::function<Vec3(State const&)> tip;  // position of the tip [m]
};

using combinations::BodyName;
using combinations::MeshKind;
using combinations::NamedIntegrator;
using MakeMechanism = std::function<AnyMechanism(Setup const&, FormulationMesh const&)>;

// A body formulation with one policy of the joint at its first end.
struct BodyOnPolicy : combinations::BodyOnPolicy {
  MakeMechanism make = {};
};

inline auto const integrators = std::tuple(
    NamedIntegrator<GeneralisedAlpha>{"generalised-alpha", {.rho_inf = 0.8}}, NamedIntegrator<HhtAlpha>{"hht", {}},
    NamedIntegrator<Newmark>{"newmark", {}}, NamedIntegrator<Radau>{"radau", {}},
    NamedIntegrator<EnergyMomentum>{"energy-momentum", {}}, NamedIntegrator<RungeKutta4<Projection>>{"runge-kutta", {}},
    NamedIntegrator<AdamsBashforthMoulton<Projection>>{"adams", {}});

// Body formulations of each file, with each policy of the joint.
std::vector<BodyOnPolicy> rigid_bodies(Mechanism);
std::vector<BodyOnPolicy> spatial_rigid_bodies(Mechanism);
std::vector<BodyOnPolicy> lrvf_beams(Mechanism);
std::vector<BodyOnPolicy> spatial_lrvf_beams(Mechanism);
std::vector<BodyOnPolicy> helicoidal_beams(Mechanism);
std::vector<BodyOnPolicy> spatial_helicoidal_beams(Mechanism);
std::vector<BodyOnPolicy> green_cables(Mechanism);
std::vector<BodyOnPolicy> engineering_cables(Mechanism);
std::vector<BodyOnPolicy> floating_frames(Mechanism);
std::vector<BodyOnPolicy> elastic_line_beams(Mechanism);
std::vector<BodyOnPolicy> continuum_beams(Mechanism);
// All of these bodies, with each policy.
std::vector<BodyOnPolicy> bodies_on_policies(Mechanism);

// Name of the case, and options of the cases 'run', 'compare' and 'combinations'. An empty list selects the defaults.
struct FormulationOptions : combinations::Selection {
  FormulationOptions();

  std::string which = "all";
  Index elements = 10;
  double step = 5e-3;     // [s]
  std::string stiffness;  // name of Table 2.1

  Stiffness const& chosen_stiffness() const;
  // True for --list and the cases of this file.
  bool is_of_formulations() const;
  // Body of the figures, one of `allowed`. Throws InvalidInput for other bodies, a policy or an integrator.
  std::string body_of_figures(std::vector<std::string> const& allowed) const;
};
// Adds these options, and --case with the names of the other cases before those of this file.
void add_formulation_options(CommandLine& line, FormulationOptions& o, std::vector<std::string> cases);

// A mechanism, its run and the output that 'compare' evaluates.
struct Problem {
  Mechanism mechanism;
  std::string motion;
  Setup setup;
  double end_time;                                          // [s]
  std::string output;                                       // with unit
  std::function<double(double, Vec3 const&)> output_value;  // of the time [s] and the position of the tip [m]

  std::string title() const { return "Stiffness \"" + setup.stiffness.name + "\", " + motion; }
};
// Scenario of the problem in one formulation.
Scenario<AnyModel> scenario_of(Problem const& problem, MakeMechanism const& make, FormulationMesh const& mesh);
// Adds the combination of a row with integrator number k to a study of the problem.
void add_to(EqualErrorStudy& study, Problem const& problem, BodyOnPolicy const& row, std::size_t k,
            std::string const& name, StudyEntry const& entry);
// Runs --list, or the case. Returns false if a run of 'run' or 'combinations', or each run of 'compare' failed. Throws
// InvalidInput for a combination that does not exist.
bool run_formulations(FormulationOptions const& o, Problem const& problem);

}  // namespace chapter2
