#pragma once
// Results of other programs beside those of a problem: errors, table and page.
#include <filesystem>

#include "external_results.hpp"
#include "problem.hpp"
#include "tables.hpp"

namespace atlas {

// A result of another program with its error, relative to the span of the output.
struct ExternalRun {
  ExternalResult result;
  double error;
};
// Results of other programs for one problem. `machine` is the machine of this run; results of other machines are not
// ranked.
struct OtherPrograms {
  std::vector<ExternalRun> runs = {};
  std::string machine = {};
};

// Results for this problem. The error of a history is its largest difference from the reference of its physical model.
// Throws InvalidInput if the study has no such reference, or if the history does not cover the run. `file` is the file
// of the results, whose folder contains the histories.
std::vector<ExternalRun> runs_of(std::vector<ExternalResult> const& results, Problem const& problem,
                                 EqualErrorReport const& report, std::filesystem::path const& file);

// Table with all results. A result of the same machine is ranked by the ratio of its time to that of the fastest run of
// the study with at most its error.
Table external_table(OtherPrograms const& others, EqualErrorReport const& report);

// Page with the work-precision curves of the study and of the same machine, and a separate chart of other machines.
void write_external_page(OtherPrograms const& others, Problem const& problem, EqualErrorReport const& report,
                         std::filesystem::path const& file);

}  // namespace atlas
