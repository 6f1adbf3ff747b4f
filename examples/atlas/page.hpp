#pragma once
// Page of a problem, summary of all problems, and their check.
#include <filesystem>

#include "external.hpp"
#include "problem.hpp"
#include "tables.hpp"

namespace atlas {

// A problem with its results and those of other programs.
struct Done {
  Problem problem;
  EqualErrorReport report;
  OtherPrograms others;
};

// Tables of a page. The check treats the table "Cheapest settings" apart.
std::vector<Table> tables_of(Done const& done);
// The table that a quick run computes again.
Table coarse_table(Done const& done);

// Writes the part of the page docs/atlas/<problem>.md between the markers. A page that does not exist begins with the
// title and the text of the problem.
void write_page(Done const& done, std::filesystem::path const& folder);
// Differences between the page and the report, one sentence each; of a quick run: in the table of the coarsest
// settings.
std::vector<std::string> check_page(Done const& done, std::filesystem::path const& folder, bool quick);

// Rows of the summary: problem, and the three fastest formulations at each wanted error.
void write_summary(std::vector<Done> const& all, std::filesystem::path const& folder);
// Differences between the summary and the reports: formulations that do not reach the error of their column.
std::vector<std::string> check_summary(std::vector<Done> const& all, std::filesystem::path const& folder);

}  // namespace atlas
