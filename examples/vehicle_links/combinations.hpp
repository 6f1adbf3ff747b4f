#pragma once
// Combinations of links, pins and integrators on the vehicle: their options, single runs, and their comparison at equal
// error.
#include "links.hpp"

namespace chapter3 {

// A combination of links, pins and an integrator.
struct Combination {
  LinksOnPins links;
  std::size_t integrator = 0;  // number in the table

  // Sentence of the refusal; empty if the combination exists.
  std::string const& refusal() const { return links.refusals[integrator]; }
};

// Adds the options of the selection, --elements, --tolerance and --output.
void add_combination_options(CommandLine& line, LinkSettings& o, combinations::SelectionHelp help);
// Completes the settings after the command line has been read. \param step value of --step [s]; 0: the default
void complete(LinkSettings& o, double step);

// Steps [s], tolerances and wanted errors of a study whose options do not give them.
struct StudyLists {
  std::vector<double> steps, tolerances, errors;
};
void complete(combinations::Selection& s, StudyLists const& usual);

// Every combination of the bodies, policies and integrators of `s`, also those that do not exist.
std::vector<Combination> candidates(combinations::Selection const& s);
// Selected combinations; without bodies those of the body `usual`. Throws InvalidInput for one that does not exist, and
// for one that cannot turn if the vehicle turns.
std::vector<Combination> selected(LinkSettings const& o, std::string const& usual);
// Links of one body on pins of this policy, or on the usual pins if `policy` is empty, with the integrator of the
// options. Throws InvalidInput if it does not exist, and if more than one integrator is selected.
Combination combination(LinkSettings const& o, std::string const& body, std::string const& policy = "");
// Throws InvalidInput if the vehicle of the settings turns and these links cannot.
void require_turning(LinkSettings const& o, LinksOnPins const& links);

std::string integrator_name(Combination const& c);
// True if the integrator controls its step.
bool has_step_control(Combination const& c);
// Settings with the steps of the combination, and with its sampling interval if they have none.
LinkSettings with_steps(LinkSettings o, Combination const& c);
// Runs the scenario that `make` returns by the integrator of the combination. Throws Error if the run fails.
Comparison run_scenario(LinkSettings const& o, Combination const& c, std::string const& name,
                        std::function<Scenario<AnyModel>()> const& make);

// Runs --list, or a comparison: "combinations" (at equal error) or "steps" (ten steps of each combination). Returns
// false if a run failed.
bool run_combinations(LinkSettings const& o, std::string const& comparison);
// True for --list and for these comparisons.
inline bool is_of_combinations(LinkSettings const& o, std::string const& comparison) {
  return o.selection.list || comparison == "combinations" || comparison == "steps";
}

}  // namespace chapter3
