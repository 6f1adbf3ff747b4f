#pragma once
/// \file
/// Union of separate comparisons of one case: each formulation may be compiled in its own file.

#include <polybody/compare/compare.hpp>

namespace polybody {

/// Joins the runs of all `parts` in their order, and compares each with the first complete run. A number is appended to
/// repeated names.
/// \throws InvalidInput if the names of the outputs differ between runs.
template <class = void>  // compiled where it is used
Comparison join(std::vector<Comparison> const& parts) {
  Comparison all;
  for (Comparison const& part : parts)
    for (ComparedRun run : part.runs) {
      run.name = detail::unique_name(all.runs, run.name);
      detail::check_outputs(run, all.runs);
      run.difference.clear();
      all.runs.push_back(std::move(run));
    }
  detail::compare_with_first(all);
  return all;
}

}  // namespace polybody
