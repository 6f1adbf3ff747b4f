#pragma once
// Combinations of body, policy and integrator of an example: their table, the options that select some of them, and
// their comparison at equal error. Nothing here depends on the types of bodies.
#include <functional>
#include <string>
#include <vector>

#include <polybody/compare/equal_error.hpp>
#include <polybody/run/any_model.hpp>

#include "command_line.hpp"
#include "refusals.hpp"

namespace combinations {

enum class MeshKind { none, elements, modes };

// Body formulation of one value of --body.
struct BodyName {
  std::string name;
  std::string model;  // physical model, for the comparison at equal error
  MeshKind mesh = MeshKind::elements;
};

// A body formulation with one policy of its joints.
struct BodyOnPolicy {
  BodyName body;
  std::string policy;
  bool usual = false;            // true: the policy of this body without --policy
  std::string_view family = {};  // of the body (bodies/shared/family.hpp)
  std::string enforcement = {};  // name of the policy's type
  std::vector<std::string> refusals =
      {};  // for each integrator: sentence of its refusal; empty if the combination exists

  FormulationMesh mesh_of(Index elements, Index modes) const;
};

// The family of body B, whose mesh is of this kind.
template <class B>
constexpr std::string_view family_of(MeshKind kind) {
  return kind == MeshKind::modes ? families::ffr_modal : formulation_family<B>;
}

struct CombinationTable {
  std::vector<std::string> integrators;  // names
  std::vector<BodyOnPolicy> rows;
};
// A row of a table with one of its integrators.
struct Choice {
  std::size_t row, integrator;
};
template <class... Is>
std::vector<std::string> names_of(std::tuple<NamedIntegrator<Is>...> const& integrators) {
  return std::apply([](auto const&... i) { return std::vector<std::string>{i.name...}; }, integrators);
}
// Calls f with integrator number k of a tuple.
template <class Tuple, class F>
void with_integrator(Tuple const& integrators, std::size_t k, F const& f) {
  std::size_t at = 0;
  std::apply([&](auto const&... i) { ((at++ == k ? f(i.integrator) : void()), ...); }, integrators);
}

// Options of the selection and of the comparison at equal error. Empty lists are the defaults of the program.
struct Selection {
  std::vector<std::string> bodies, policies, integrators;
  std::vector<Index> meshes, modes;
  std::vector<double> steps;                               // [s]
  std::vector<double> tolerances{1e-4, 1e-5, 1e-6, 1e-7};  // of integrators with step size control
  std::vector<double> errors{1e-1, 1e-2, 1e-3, 1e-4};      // relative to the span of the output
  bool list = false;

  bool is_empty() const { return bodies.empty() && policies.empty() && integrators.empty(); }
};
inline std::vector<std::string> const all_policies{"constraint", "penalty", "bushing", "ancf-linear",
                                                   "joint-coordinates"};
// Texts of the help for the program's defaults.
struct SelectionHelp {
  std::string body = {}, policy = {}, integrator = {}, modes = {}, steps = {}, tolerances = {}, errors = {};
};
// Adds the options --body, --policy, --integrator, --list, --meshes, --modes, --steps, --tolerances and --error.
inline void add_selection(CommandLine& line, Selection& s, std::vector<std::string> const& bodies,
                          std::vector<std::string> const& integrators, SelectionHelp const& help) {
  line.one_of("--body", &s.bodies, bodies, help.body);
  line.one_of("--policy", &s.policies, all_policies, help.policy);
  line.one_of("--integrator", &s.integrators, integrators, help.integrator);
  line.flag("--list", &s.list, "print the table of the combinations of --body, --policy and --integrator");
  std::string const at_equal_error = "for the comparison at equal error: ";
  line.positive("--meshes", &s.meshes, at_equal_error + "numbers of elements, ascending");
  line.positive("--modes", &s.modes, at_equal_error + "numbers of modes" + help.modes);
  line.positive("--steps", &s.steps, at_equal_error + "steps, descending [s]" + help.steps);
  line.positive(
      "--tolerances", &s.tolerances,
      at_equal_error + "relative tolerances of integrators with step size control, descending" + help.tolerances);
  line.positive("--error", &s.errors,
                at_equal_error + "wanted errors, relative to the span of the output" + help.errors);
}

bool is_among(std::string const& name, std::vector<std::string> const& chosen);
std::string name_of(CombinationTable const& table, Choice const& choice);
// Prints the table, the reasons of refusals, and the number of combinations.
void print_list(CombinationTable const& table);
// Selected combinations. Without bodies those of `usual`, without policies the usual one of each body, without
// integrators the first one. Throws InvalidInput for a selected combination that does not exist.
std::vector<Choice> choices(CombinationTable const& table, Selection s, std::vector<std::string> const& usual);
// All combinations that exist.
std::vector<Choice> existing(CombinationTable const& table);

// Prints cells in aligned columns: the first `left` of them to the left, the others to the right.
using Cells = std::vector<std::string>;
void print(std::vector<Cells> const& rows, std::size_t left);

// Result of a few steps of a combination.
struct Steps {
  long count = 0;
  std::string failure = {};  // message; empty if the steps are complete
};
// Takes ten steps of each combination that exists by `run`, and prints those that fail and the number of the others.
// Returns true if none failed.
bool run_ten_steps(CombinationTable const& table, std::function<Steps(Choice const&)> const& run);

using MakeScenario = std::function<Scenario<AnyModel>(FormulationMesh const&)>;

struct Erased {};
// A formulation of EqualErrorStudy for a mechanism that a function of the mesh creates. Body B and policy P select
// names and colours only.
template <class I, MeshKind kind, class B = Erased, class P = Erased>
struct ErasedFormulation {
  using BodyType = B;
  using PolicyType = P;
  using IntegratorType = I;
  static constexpr bool has_mesh = kind != MeshKind::none, has_modes = kind == MeshKind::modes;
  std::string name;
  I integrator;
  FormulationMesh mesh;
};

// Adds a combination to a study. `finest` gives the number of elements of a body whose modes vary.
template <MeshKind kind, class I>
void add_of_kind(EqualErrorStudy& study, std::string const& name, I const& integrator, MakeScenario const& make,
                 FormulationMesh const& finest, StudyEntry const& entry) {
  study.add([make](ErasedFormulation<I, kind> const& f) { return make(f.mesh); },
            ErasedFormulation<I, kind>{name, integrator, finest}, entry);
}
template <class I>
void add_combination(EqualErrorStudy& study, MeshKind kind, std::string const& name, I const& integrator,
                     MakeScenario const& make, FormulationMesh const& finest, StudyEntry const& entry) {
  if (kind == MeshKind::none) add_of_kind<MeshKind::none>(study, name, integrator, make, finest, entry);
  if (kind == MeshKind::elements) add_of_kind<MeshKind::elements>(study, name, integrator, make, finest, entry);
  if (kind == MeshKind::modes) add_of_kind<MeshKind::modes>(study, name, integrator, make, finest, entry);
}

// Comparison of combinations at equal error.
class CombinationStudy {
 public:
  CombinationStudy(Selection const& s, std::size_t output = 0);

  template <class I>
  void add(BodyOnPolicy const& of, std::string const& name, I const& integrator, MakeScenario const& make) {
    FormulationMesh const finest = of.mesh_of(selection_.meshes.back(), selection_.modes.back());
    add_combination(study_, of.body.mesh, name, integrator, make, finest, {.model = of.body.model});
    added_.push_back(of);
  }
  EqualErrorReport run() const;

 private:
  Selection selection_;
  EqualErrorStudy study_;
  std::vector<BodyOnPolicy> added_ = {};
};
// Prints the report of a study. Returns false, after a sentence, if every run of the study failed.
bool print_report(EqualErrorReport const& report);
// Name of a formulation in a comparison: its body, with policy and integrator if they were selected.
std::string short_name(CombinationTable const& table, Choice const& choice, Selection const& s);

}  // namespace combinations
