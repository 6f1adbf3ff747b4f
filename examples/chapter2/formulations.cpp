#include "../chapter2_formulations.hpp"

#include <algorithm>
#include <ctime>
#include <iostream>

namespace chapter2 {

namespace {

std::vector<BodyOnPolicy> table_of(Mechanism mechanism) {
  std::vector<BodyOnPolicy> table;
  for (auto const of_body : {rigid_bodies, lrvf_beams, green_cables, engineering_cables, floating_frames,
                             spatial_rigid_bodies, elastic_line_beams, continuum_beams, spatial_lrvf_beams})
    for (BodyOnPolicy& one : of_body(mechanism)) table.push_back(std::move(one));
  return table;
}

std::vector<std::string> const own_cases{"run", "compare", "combinations"};
std::vector<std::string> const all_policies{"constraint", "penalty", "bushing", "ancf-linear", "joint-coordinates"};
std::vector<std::string> const all_bodies{"rigid",     "lrvf",        "ancf",      "ancf-engineering",    "ffr",
                                          "ffr-modal", "rigid-space", "ancf-beam", "ancf-beam-continuum", "lrvf-space"};
std::vector<std::string> const all_integrators =
    std::apply([](auto const&... i) { return std::vector<std::string>{i.name...}; }, integrators);

// Calls f with integrator number k.
template <class F>
void with_integrator(std::size_t k, F const& f) {
  std::size_t at = 0;
  std::apply([&](auto const&... i) { ((at++ == k ? f(i.integrator) : void()), ...); }, integrators);
}

// Prints cells in aligned columns: the first `left` of them to the left, the others to the right.
using Cells = std::vector<std::string>;
void print(std::vector<Cells> const& rows, std::size_t left) {
  std::vector<std::size_t> width(rows.front().size(), 0);
  for (Cells const& row : rows)
    for (std::size_t j = 0; j < row.size(); ++j) width[j] = std::max(width[j], row[j].size());
  for (Cells const& row : rows) {
    std::string line;
    for (std::size_t j = 0; j < row.size(); ++j) {
      std::string const space(width[j] - row[j].size(), ' ');
      line += "  " + (j < left ? row[j] + space : space + row[j]);
    }
    std::cout << line.substr(0, line.find_last_not_of(' ') + 1) << '\n';
  }
}

void print_list(Problem const& problem) {
  std::cout << "Combinations of --body, --policy and --integrator. +: exists; letter: the reason below.\n\n";
  std::vector<Cells> rows{{"body", "policy"}};
  rows[0].insert(rows[0].end(), all_integrators.begin(), all_integrators.end());
  std::vector<std::string> reasons;
  std::size_t exist = 0, refused = 0;
  for (BodyOnPolicy const& one : table_of(problem.mechanism)) {
    Cells row{one.body.name, one.policy};
    for (auto const& [why, add] : one.by) {
      auto const known = std::find(reasons.begin(), reasons.end(), why);
      row.push_back(why.empty() ? "+" : std::string(1, char('a' + (known - reasons.begin()))));
      if (!why.empty() && known == reasons.end()) reasons.push_back(why);
      ++(why.empty() ? exist : refused);
    }
    rows.push_back(std::move(row));
  }
  print(rows, 2);
  std::cout << '\n';
  for (std::size_t i = 0; i < reasons.size(); ++i) std::cout << char('a' + i) << ": " << reasons[i] << '\n';
  std::cout << exist << " combinations exist, " << refused << " do not.\n";
}

// A body on a policy, with one of its integrators.
struct Choice {
  BodyOnPolicy of;
  std::size_t integrator;

  Combination const& combination() const { return of.by[integrator]; }
  std::string name() const { return of.body.name + ", " + of.policy + ", " + all_integrators[integrator]; }
  FormulationMesh mesh(Index elements, Index modes) const {
    FormulationMesh mesh{.elements = elements};
    if (of.body.mesh == MeshKind::modes) mesh.modes = modes;
    return mesh;
  }
};
std::vector<Choice> all_choices(Mechanism mechanism) {
  std::vector<Choice> all;
  for (BodyOnPolicy const& one : table_of(mechanism))
    for (std::size_t k = 0; k < one.by.size(); ++k) all.push_back({one, k});
  return all;
}

bool is_among(std::string const& name, std::vector<std::string> const& chosen) {
  return std::find(chosen.begin(), chosen.end(), name) != chosen.end();
}

// Throws InvalidInput for a chosen combination that does not exist.
std::vector<Choice> choices(FormulationOptions o, Problem const& problem, std::vector<std::string> const& usual) {
  if (o.bodies.empty()) o.bodies = usual;
  if (o.policies.empty()) o.policies = {all_policies[0]};
  if (o.integrators.empty()) o.integrators = {all_integrators[0]};
  std::vector<Choice> chosen;
  for (Choice const& one : all_choices(problem.mechanism)) {
    if (!is_among(one.of.body.name, o.bodies) || !is_among(one.of.policy, o.policies) ||
        !is_among(all_integrators[one.integrator], o.integrators))
      continue;
    if (std::string const& why = one.combination().refusal; !why.empty())
      throw InvalidInput{"\"", ErrorObject{one.name()}, "\" does not exist. ", why};
    chosen.push_back(one);
  }
  return chosen;
}

struct OneRun {
  Vec3 tip = Vec3::Zero();  // at the end [m]
  double energy = 0.0;      // at the end [J]
  double cpu = 0.0;         // of the steps [s]
  RunReport report = {};
  std::string failure = {};  // message; empty if the run is complete
};

// Runs to the end, or `most` steps.
OneRun run_one(Choice const& choice, Setup const& setup, FormulationMesh const& mesh, RunOptions const& options,
               long most = std::numeric_limits<long>::max()) {
  OneRun out;
  try {
    AnyMechanism const made = choice.of.make(setup, mesh);
    State x = made.model.reference_state();
    with_integrator(choice.integrator, [&](auto const& integrator) {
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

bool run_chosen(FormulationOptions const& o, Problem const& problem) {
  std::vector<Choice> const chosen = choices(o, problem, {"lrvf"});
  std::cout << problem.title() << ", 0 to " << number(problem.end_time) << " s, step " << number(o.step)
            << " s. Tip and energy at the end:\n\n";
  std::vector<Cells> rows{{"body", "policy", "integrator", "elements", "modes", "tip x [m]", "tip y [m]", "energy [J]",
                           "CPU [s]", "steps", "iterations"}};
  std::string failures;
  for (Choice const& choice : chosen) {
    FormulationMesh const mesh = choice.mesh(o.elements, o.modes.back());
    OneRun const r = run_one(choice, problem.setup, mesh, {.end_time = problem.end_time, .step = o.step});
    for (std::string const& warning : r.report.warnings) std::cerr << choice.name() << ": " << warning << '\n';
    if (!r.failure.empty()) {
      failures += choice.name() + ": " + r.failure + '\n';
      continue;
    }
    rows.push_back({choice.of.body.name, choice.of.policy, all_integrators[choice.integrator],
                    choice.of.body.mesh == MeshKind::none ? "-" : std::to_string(o.elements),
                    mesh.modes ? std::to_string(*mesh.modes) : "-", number(r.tip[0], 6), number(r.tip[1], 6),
                    number(r.energy, 6), number(r.cpu, 3), std::to_string(r.report.steps),
                    std::to_string(r.report.iterations)});
  }
  print(rows, 3);
  std::cerr << failures;
  return failures.empty();
}

bool run_combinations(Problem const& problem) {
  int exist = 0, ran = 0;
  for (Choice const& choice : all_choices(problem.mechanism)) {
    if (!choice.combination().refusal.empty()) continue;
    ++exist;
    OneRun const r = run_one(choice, problem.setup, choice.mesh(2, 1), {.end_time = 1.0, .step = 1e-3}, 10);
    if (r.failure.empty() && r.report.steps == 10)
      ++ran;
    else
      std::cout << choice.name() << ": " << r.report.steps << " steps. " << r.failure << '\n';
  }
  std::cout << ran << " of " << exist << " combinations ran ten steps.\n";
  return ran == exist;
}

void compare_chosen(FormulationOptions const& o, Problem const& problem) {
  EqualErrorStudy study(
      {.elements = o.meshes, .modes = o.modes, .steps = o.steps, .tolerances = o.tolerances, .errors = o.errors});
  for (Choice const& choice : choices(o, problem, {"lrvf", "ancf", "ancf-engineering"})) {
    std::string name = choice.of.body.name;
    if (!o.policies.empty()) name += ", " + choice.of.policy;
    if (!o.integrators.empty()) name += ", " + all_integrators[choice.integrator];
    choice.combination().add(study, problem, name, choice.mesh(o.meshes.back(), o.modes.back()), {});
  }
  std::cout << problem.title() << ", 0 to " << number(problem.end_time) << " s.\n" << study.run();
}

}  // namespace

void add_formulation_options(CommandLine& line, FormulationOptions& o, std::vector<std::string> cases) {
  cases.insert(cases.begin(), "all");
  cases.insert(cases.end(), own_cases.begin(), own_cases.end());
  line.one_of("--case", &o.which, cases,
              "what to run. run: one run of each chosen combination; compare: comparison at equal error; equal-mesh: "
              "comparison with equal meshes and steps; combinations: ten steps of each combination; all: all cases but "
              "run, compare and combinations");
  std::string const of_cases = "; for 'run' and 'compare' a list, such as ";
  line.one_of("--body", &o.bodies, all_bodies, "body of the figures (default: lrvf)" + of_cases + "lrvf,ancf");
  line.one_of("--policy", &o.policies, all_policies,
              "enforcement of the joint's constraint equations (default: constraint)" + of_cases + "penalty,bushing");
  line.one_of("--integrator", &o.integrators, all_integrators,
              "integrator (default: generalised-alpha)" + of_cases + "hht,radau");
  line.flag("--list", &o.list, "print the table of the combinations of --body, --policy and --integrator");
  line.one_of("--stiffness", &o.stiffness, {high.name, medium.name, low.name},
              "for 'run', 'compare' and 'combinations': stiffness by Table 2.1 of the thesis");
  line.positive("--elements", &o.elements, "elements along the beam");
  line.positive("--step", &o.step, "time step; the first step of adams [s]");
  line.positive("--meshes", &o.meshes, "compare: numbers of elements, ascending");
  line.positive("--modes", &o.modes, "compare: numbers of modes of ffr-modal, ascending; 'run' uses the last one");
  line.positive("--steps", &o.steps, "compare: steps, descending [s]");
  line.positive("--tolerances", &o.tolerances, "compare: relative tolerances of adams, descending");
  line.positive("--error", &o.errors, "compare: wanted errors, relative to the span of the output");
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
  throw InvalidInput{"The case \"", ErrorObject{which}, "\" has one body, --body ", names,
                     ". The cases 'run' and 'compare' accept a list of all bodies."};
}

Scenario<AnyModel> scenario_of(Problem const& problem, MakeMechanism const& make, FormulationMesh const& mesh) {
  AnyMechanism const made = make(problem.setup, mesh);
  auto const value = [tip = made.tip, of = problem.output_value](AnyModel const&, State const& x) {
    return of(x.t, tip(x));
  };
  return {made.model,
          made.model.reference_state(),
          {.end_time = problem.end_time, .step = problem.end_time / 1000.0, .max_step_halvings = 6},
          {{problem.output, value}}};
}

bool run_formulations(FormulationOptions const& o, Problem const& problem) {
  if (o.list) {
    print_list(problem);
    return true;
  }
  if (o.which == "run") return run_chosen(o, problem);
  if (o.which == "combinations") return run_combinations(problem);
  compare_chosen(o, problem);
  return true;
}

}  // namespace chapter2
