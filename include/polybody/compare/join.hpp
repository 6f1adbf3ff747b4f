#pragma once
/// \file
/// Comparisons of one case that were made apart, as one: each formulation may be compiled in a file of its own.

#include <polybody/compare/compare.hpp>

namespace polybody {

/// The runs of all `parts` in their order, each beside the first of them. Names that stand twice get a number.
/// \throws InvalidInput for outputs that are not the same for all.
template <class = void>  // compiled where it is used
Comparison join(std::vector<Comparison> const& parts) {
  Comparison all;
  for (Comparison const& part : parts)
    for (ComparedRun run : part.runs) {
      run.name = detail::name_beside(all.runs, run.name);
      detail::check_outputs(run, all.runs);
      run.difference.clear();
      all.runs.push_back(std::move(run));
    }
  detail::compare_with_first(all);
  return all;
}

}  // namespace polybody
