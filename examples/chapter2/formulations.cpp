#include "../chapter2_formulations.hpp"

#include <algorithm>
#include <ctime>
#include <iostream>

namespace chapter2 {

using namespace combinations;

namespace {

// The table, and the function that creates the mechanism of each row.
struct Mechanisms {
  CombinationTable table;
  std::vector<MakeMechanism> make = {};

  explicit Mechanisms(Mechanism mechanism) : table{names_of(integrators), {}} {
    for (BodyOnPolicy const& one : bodies_on_policies(mechanism)) {
      table.rows.push_back(one);
      make.push_back(one.make);
    }
  }
};

std::vector<std::string> const own_cases{"run", "compare", "combinations"};
std::vector<std::string> const all_bodies{"rigid",     "lrvf",        "ancf",      "ancf-engineering",    "ffr",
                                          "ffr-modal", "rigid-space", "ancf-beam", "ancf-beam-continuum", "lrvf-space",
                                          "se3",       "se3-space"};

struct OneRun {
  Vec3 tip = Vec3::Zero();  // at the end [m]
  double energy = 0.0;      // at the end [J]
  double cpu = 0.0;         // of the steps [s]
  RunReport report = {};
  std::string failure = {};  // message; empty if the run is complete
};

// Runs to the end, or `most` steps.
OneRun run_one(MakeMechanism const& make, std::size_t by, Setup const& setup, FormulationMesh const& mesh,
               RunOptions const& options, long most = std::numeric_limits<long>::max()) {
  OneRun out;
  try {
    AnyMechanism const made = make(setup, mesh);
    State x = made.model.reference_state();
    with_integrator(integrators, by, [&](auto const& integrator) {
      auto run = simulate(made.model, x, integrator, options);
      std::clock_t const begin = std::clock();
      for (long k = 0; k < most && !run.done(); ++k) run.advance();
      out.cpu = double(std::clock() - begin) / CLOCKS_PER_SEC;
      out.tip = made.tip(run.now());
      out.energy = run.now().energy().total();
      out.report = run.report();
    });
    if (!out.tip.allFinite() || !std::isfinite(out.energy)) out.failure = "The position or the energy is not finite.";
  } catch (Error const& e) {
    out.failure = e.what();
  }
  return out;
}

bool run_chosen(FormulationOptions const& o, Problem const& problem, Mechanisms const& all) {
  std::vector<Choice> const chosen = choices(all.table, o, {"lrvf"});
  std::cout << problem.title() << ", 0 to " << number(problem.end_time) << " s, step " << number(o.step)
            << " s. Tip and energy at the end:\n\n";
  std::vector<Cells> rows{{"body", "policy", "integrator", "elements", "modes", "tip x [m]", "tip y [m]", "energy [J]",
                           "CPU [s]", "steps", "iterations"}};
  std::string failures;
  for (Choice const& choice : chosen) {
    combinations::BodyOnPolicy const& row = all.table.rows[choice.row];
    FormulationMesh const mesh = row.mesh_of(o.elements, o.modes.back());
    OneRun const r = run_one(all.make[choice.row], choice.integrator, problem.setup, mesh,
                             {.end_time = problem.end_time, .step = o.step});
    std::string const name = name_of(all.table, choice);
    for (std::string const& warning : r.report.warnings) std::cerr << name << ": " << warning << '\n';
    if (!r.failure.empty()) {
      failures += name + ": " + r.failure + '\n';
      continue;
    }
    rows.push_back({row.body.name, row.policy, all.table.integrators[choice.integrator],
                    row.body.mesh == MeshKind::none ? "-" : std::to_string(o.elements),
                    mesh.modes ? std::to_string(*mesh.modes) : "-", number(r.tip[0], 6), number(r.tip[1], 6),
                    number(r.energy, 6), number(r.cpu, 3), std::to_string(r.report.steps),
                    std::to_string(r.report.iterations)});
  }
  print(rows, 3);
  std::cerr << failures;
  return failures.empty();
}

bool run_combinations(Problem const& problem, Mechanisms const& all) {
  return run_ten_steps(all.table, [&](Choice const& choice) {
    OneRun const r = run_one(all.make[choice.row], choice.integrator, problem.setup,
                             all.table.rows[choice.row].mesh_of(2, 1), {.end_time = 1.0, .step = 1e-3}, 10);
    return Steps{r.report.steps, r.failure};
  });
}

// Returns false if every run of the comparison fails.
bool compare_chosen(FormulationOptions const& o, Problem const& problem, Mechanisms const& all) {
  CombinationStudy study(o);
  for (Choice const& choice : choices(all.table, o, {"lrvf", "ancf", "ancf-engineering"}))
    with_integrator(integrators, choice.integrator, [&](auto const& integrator) {
      study.add(all.table.rows[choice.row], short_name(all.table, choice, o), integrator,
                [problem, make = all.make[choice.row]](FormulationMesh const& mesh) {
                  return scenario_of(problem, make, mesh);
                });
    });
  std::cout << problem.title() << ", 0 to " << number(problem.end_time) << " s.\n";
  return print_report(study.run());
}

}  // namespace

FormulationOptions::FormulationOptions() {
  meshes = {5, 10, 20, 40, 80, 160, 320};
  modes = {1, 2, 4, 8};
  steps = {1e-2, 5e-3, 2.5e-3, 1.25e-3, 6.25e-4};
}

void add_formulation_options(CommandLine& line, FormulationOptions& o, std::vector<std::string> cases) {
  cases.insert(cases.begin(), "all");
  cases.insert(cases.end(), own_cases.begin(), own_cases.end());
  line.one_of("--case", &o.which, cases,
              "what to run. run: one run of each chosen combination; compare: comparison at equal error; equal-mesh: "
              "comparison with equal meshes and steps; combinations: ten steps of each combination; all: all cases but "
              "run, compare, split and combinations");
  std::string const of_cases = "; for 'run' and 'compare' a list, such as ";
  add_selection(
      line, o, all_bodies, names_of(integrators),
      {.body = "body of the figures (default: lrvf)" + of_cases + "lrvf,ancf",
       .policy = "enforcement of the joint's constraint equations (default: constraint)" + of_cases + "penalty,bushing",
       .integrator = "integrator (default: generalised-alpha)" + of_cases + "hht,radau",
       .modes = " of ffr-modal, ascending; 'run' uses the last one"});
  line.one_of("--stiffness", &o.stiffness, {high.name, medium.name, low.name},
              "for 'run', 'compare' and 'combinations': stiffness by Table 2.1 of the thesis");
  line.positive("--elements", &o.elements, "elements along the beam");
  line.positive("--step", &o.step, "time step; the first step of adams [s]");
}

Stiffness const& FormulationOptions::chosen_stiffness() const {
  return stiffness == high.name ? high : stiffness == medium.name ? medium : low;
}

bool FormulationOptions::is_of_formulations() const { return list || is_among(which, own_cases); }

std::string FormulationOptions::body_of_figures(std::vector<std::string> const& allowed) const {
  if (!policies.empty() || !integrators.empty())
    throw InvalidInput{"--policy and --integrator belong to the cases 'run' and 'compare', not to \"",
                       ErrorObject{which}, "\"."};
  if (bodies.empty()) return allowed.front();
  if (bodies.size() == 1 && is_among(bodies.front(), allowed)) return bodies.front();
  std::string names;
  for (std::string const& name : allowed) names += (names.empty() ? "" : ", ") + name;
  throw InvalidInput{"The case \"", ErrorObject{which}, "\" accepts one body of --body: ", names,
                     ". The cases 'run' and 'compare' accept a list of all bodies."};
}

void add_to(EqualErrorStudy& study, Problem const& problem, BodyOnPolicy const& row, std::size_t k,
            std::string const& name, StudyEntry const& entry) {
  with_integrator(integrators, k, [&](auto const& integrator) {
    add_combination(
        study, row.body.mesh, name, integrator,
        [problem, make = row.make](FormulationMesh const& mesh) { return scenario_of(problem, make, mesh); },
        row.mesh_of(16, 1), entry);
  });
}

bool run_formulations(FormulationOptions const& o, Problem const& problem) {
  Mechanisms const all(problem.mechanism);
  if (o.list) {
    print_list(all.table);
    return true;
  }
  if (o.which == "run") return run_chosen(o, problem, all);
  if (o.which == "combinations") return run_combinations(problem, all);
  return compare_chosen(o, problem, all);
}

}  // namespace chapter2
