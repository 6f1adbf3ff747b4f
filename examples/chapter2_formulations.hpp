#pragma once
// The arm and the cantilever of Chapter 2 under each combination of body, policy and integrator: the table of the
// combinations, single runs, and the comparison at equal error. Nothing here depends on the types of the bodies, which
// the files of the folder chapter2 compile, one file for each body.
#include <functional>
#include <string>
#include <vector>

#include <polybody/compare/equal_error.hpp>

#include "chapter2.hpp"
#include "support/command_line.hpp"

namespace chapter2 {

enum class Mechanism { arm, cantilever };

// Settings of a mechanism, equal for all formulations.
struct Setup {
  Stiffness stiffness = medium;
  double density = 7850.0;  // [kg/m^3]
  double ramp = 4.5;        // duration of the arm's motion [s]
  double moment = 30e3;     // at the tip of the cantilever [N m]
};

// A mechanism with erased formulation.
struct AnyMechanism {
  AnyModel model;
  std::function<Vec3(State const&)> tip;  // position of the tip [m]
};

enum class MeshKind { none, elements, modes };

// Body formulation of one value of --body.
struct BodyName {
  std::string name;
  std::string model;  // physical model, for the comparison at equal error
  MeshKind mesh = MeshKind::elements;
};

struct Problem;
using MakeMechanism = std::function<AnyMechanism(Setup const&, FormulationMesh const&)>;

// A combination of body, policy and integrator.
struct Combination {
  // Sentence with which Model::connect or simulate refuses the combination; empty if the combination exists.
  std::string refusal = {};
  // Adds the problem under this combination to a study, with the name of the formulation, its mesh, and the meshes and
  // steps of the entry. The combination sets the model of the entry.
  std::function<void(EqualErrorStudy&, Problem const&, std::string const&, FormulationMesh const&, StudyEntry)> add =
      {};
};
// A body formulation with one policy of the joint at its first end.
struct BodyOnPolicy {
  BodyName body;
  std::string policy;
  MakeMechanism make = {};
  std::vector<Combination> by = {};  // for each of `integrators`
};

template <class I>
struct NamedIntegrator {
  char const* name;
  I integrator;
};
inline auto const integrators = std::tuple(
    NamedIntegrator<GeneralisedAlpha>{"generalised-alpha", {.rho_inf = 0.8}}, NamedIntegrator<HhtAlpha>{"hht", {}},
    NamedIntegrator<Newmark>{"newmark", {}}, NamedIntegrator<Radau>{"radau", {}},
    NamedIntegrator<EnergyMomentum>{"energy-momentum", {}}, NamedIntegrator<RungeKutta4<Projection>>{"runge-kutta", {}},
    NamedIntegrator<AdamsBashforthMoulton<Projection>>{"adams", {}});

// Bodies of each file, on each policy of the joint.
std::vector<BodyOnPolicy> rigid_bodies(Mechanism);
std::vector<BodyOnPolicy> spatial_rigid_bodies(Mechanism);
std::vector<BodyOnPolicy> lrvf_beams(Mechanism);
std::vector<BodyOnPolicy> spatial_lrvf_beams(Mechanism);
std::vector<BodyOnPolicy> green_cables(Mechanism);
std::vector<BodyOnPolicy> engineering_cables(Mechanism);
std::vector<BodyOnPolicy> floating_frames(Mechanism);
std::vector<BodyOnPolicy> elastic_line_beams(Mechanism);
std::vector<BodyOnPolicy> continuum_beams(Mechanism);

// The case and the options of the cases 'run', 'compare' and 'combinations'. Empty lists are the defaults of the case.
struct FormulationOptions {
  std::string which = "all";
  std::vector<std::string> bodies, policies, integrators;
  Index elements = 10;
  double step = 5e-3;  // [s]
  std::vector<Index> meshes{5, 10, 20, 40, 80, 160, 320}, modes{1, 2, 4, 8};
  std::vector<double> steps{1e-2, 5e-3, 2.5e-3, 1.25e-3, 6.25e-4};  // [s]
  std::vector<double> tolerances{1e-4, 1e-5, 1e-6, 1e-7};           // of adams
  std::vector<double> errors{1e-1, 1e-2, 1e-3, 1e-4};               // relative to the span of the output
  std::string stiffness;                                            // name of Table 2.1
  bool list = false;

  Stiffness const& chosen_stiffness() const;
  // True for --list and the cases of this file.
  bool is_of_formulations() const;
  // The body of the figures, which are drawn for `allowed` bodies only. Throws InvalidInput for other options.
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
// The problem with one formulation.
Scenario<AnyModel> scenario_of(Problem const& problem, MakeMechanism const& make, FormulationMesh const& mesh);
// Runs --list, or the case. Returns false if a run failed. Throws InvalidInput for a combination that does not exist.
bool run_formulations(FormulationOptions const& o, Problem const& problem);

}  // namespace chapter2
