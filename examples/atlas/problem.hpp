#pragma once
// A problem of the atlas: its formulations with their meshes and steps, its output and answers that are known.
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/run/probe.hpp>

#include "../support/combination_table.hpp"

namespace atlas {

using namespace polybody;

using combinations::MeshKind;

// A mechanism with erased formulation.
struct AnyCase {
  AnyModel model;
  std::function<double(State const&)> output;
  State start;
};
using MakeCase = std::function<AnyCase(FormulationMesh const&)>;

// The case of a model that begins in the state `start`, and whose output is y(model, state).
template <class M, class Y>
AnyCase any_case(M model, Y const& y, State const& start) {
  auto const shared = std::make_shared<M const>(std::move(model));
  return {AnyModel(shared, stepped_by<GeneralisedAlpha>), [shared, y](State const& x) { return y(*shared, x); }, start};
}
template <class M, class Y>
AnyCase any_case(M model, Y const& y) {
  State const start = model.reference_state();
  return any_case(std::move(model), y, start);
}
// The body B of a bar with the mesh, or a rigid body.
template <class B>
B body_of(Bar const& bar, FormulationMesh const& mesh) {
  return Formulation<B, Constraint, GeneralisedAlpha>{.mesh = mesh}.body(bar);
}

// Numbers of elements (or modes), ascending, and steps, descending [s].
struct Settings {
  std::vector<Index> meshes;
  std::vector<double> steps;
};

// Output and duration of a problem.
struct Question {
  std::string output;  // name with unit
  double end_time;     // [s]
  double rho_inf = 0.8;
  double quick_end = 0.0;  // end of a quick run, one of the sampled times of the full run [s]; 0: `end_time`

  double end(bool quick) const { return quick && quick_end > 0.0 ? quick_end : end_time; }
  // Number of intervals between the sampled times. Both runs have the same times.
  Index samples(bool quick) const { return Index(std::lround(400.0 * end(quick) / end_time)); }
};

// A formulation that does not apply to a problem.
struct Excluded {
  std::string formulation, reason;
};

// Collects the formulations of a problem for its study.
class Formulations {
 public:
  Formulations(EqualErrorStudy& study, Question question, bool quick)
      : study_(study), question_(std::move(question)), quick_(quick) {}

  // Adds the mechanism of body B. `elements` is the number of elements of a body whose modes vary.
  template <class B, MeshKind kind = MeshKind::elements, class P = Constraint>
  void add(std::string const& name, std::string const& model, Settings const& settings, MakeCase const& make,
           Index elements = 16) {
    combinations::ErasedFormulation<GeneralisedAlpha, kind, B, P> const formulation{
        name, {.rho_inf = question_.rho_inf}, {.elements = elements}};
    auto const make_case = [output = question_.output, end_time = question_.end(quick_), make](auto const& f) {
      AnyCase const made = make(f.mesh);
      return Scenario<AnyModel>{made.model,
                                made.start,
                                {.end_time = end_time, .step = 1.0, .max_step_halvings = 6},
                                {{output, [y = made.output](AnyModel const&, State const& x) { return y(x); }}}};
    };
    study_.add(make_case, formulation, entry(model, settings));
  }

  // Adds a combination of another program by `add_to(study, entry)`.
  template <class AddTo>
  void add(combinations::BodyOnPolicy const& of, std::string const& name, Settings const& settings,
           AddTo const& add_to) {
    add_to(study_, entry(of.body.model, settings));
    combinations_.push_back({name, of});
  }

  // Runs the study. Combinations of other programs have the names of their body and policy from the table.
  EqualErrorReport run() const {
    EqualErrorReport report = study_.run();
    for (StudiedFormulation& f : report.formulations)
      for (auto const& [name, of] : combinations_)
        if (f.name == name) f.family = of.family, f.policy = of.enforcement;
    return report;
  }

  // Meshes and steps for the study. The quick run has the first three of each.
  StudyEntry entry(std::string const& model, Settings settings) const {
    if (quick_) {
      settings.meshes.resize(std::min<std::size_t>(settings.meshes.size(), 3));
      settings.steps.resize(std::min<std::size_t>(settings.steps.size(), 3));
    }
    return {model, settings.meshes, settings.steps};
  }

 private:
  EqualErrorStudy& study_;
  Question question_;
  bool quick_;
  std::vector<std::pair<std::string, combinations::BodyOnPolicy>> combinations_ = {};
};

// Value of the output at the end of the run that an independent source gives for a physical model.
struct KnownAnswer {
  std::string model;
  double value;  // [unit of the output]
  std::string source;
};

struct Problem {
  std::string name;   // of the option --problem and of the page
  std::string title;  // of the page
  std::string text;   // mechanism, data and output: the first paragraph of a new page
  Question question;
  std::string model;  // physical model with which the summary compares the others
  std::function<void(Formulations&)> add = {};
  std::vector<KnownAnswer> known = {};
  std::vector<Excluded> excluded = {};
  bool has_contacts = false;  // true: contacts amplify round-off, and the page gives the effect of round-off
};

// The problems, one function per source file.
Problem robot_arm();
Problem cantilever();
Problem princeton_beam();
Problem curved_cantilever();
Problem rotating_cantilever();
Problem flying_rod();
Problem spinning_pendulum();
Problem slider_crank();
Problem four_bar();
Problem lateral_buckling();
Problem chain();
Problem vehicle_pins();
Problem vehicle_links();

}  // namespace atlas
