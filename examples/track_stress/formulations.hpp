#pragma once
// Combinations of links and pins that the options select, and runs of several combinations.
#include <polybody/compare/compare.hpp>

#include "stress_runs.hpp"

namespace chapter4 {

// Functions that return the combinations of one kind of links, in the order of all_links.
inline constexpr std::vector<Combination> (*combinations_of[])() = {
    rigid_links, cable_links, modal_links, finite_element_links, rotation_links, beam_links, continuum_links};

// Combination of `of_links` with these `pins`, or with the usual pins if `pins` is empty. \throws InvalidInput if the
// combination is impossible.
inline Combination on_pins(std::vector<Combination> const& of_links, std::string const& pins = "") {
  auto const found = std::find_if(of_links.begin(), of_links.end(),
                                  [&](Combination const& c) { return pins.empty() ? c.usual : c.pins == pins; });
  if (!found->refusal.empty())
    throw InvalidInput{"A link \"", found->links, "\" cannot be on pins \"", found->pins, "\": ", found->refusal, "."};
  return *found;
}
inline Combination combination_asked(Options const& o) {
  auto const place = std::find(all_links.begin(), all_links.end(), o.links) - all_links.begin();
  return on_pins(combinations_of[place](), o.pins);
}

// Reason for which a combination cannot run with these options; empty if it can.
inline std::string refusal(Options const& o, Combination const& c) {
  if (!c.refusal.empty() || c.turns || o.turn.empty()) return c.refusal;
  return "at its pins, neighbouring links share a slope vector across the track, which is constant in world axes";
}
inline void require_driveable(Options const& o, Combination const& c) {
  if (!refusal(o, c).empty())
    throw InvalidInput(
        "Tracks of ANCF cables cannot turn: at their pins, neighbouring links share a slope vector across the track, "
        "which is constant in world axes. Use --links rigid, ffr, fe, lrvf, beam or continuum.");
}

// Runs several combinations and joins their results. A film of several combinations shows rigid links and cables only.
inline StressRuns run(Options const& o, std::vector<Combination> const& combinations) {
  warn_of_drive(o);
  StressRuns all;
  std::vector<Comparison> apart;
  for (Combination const& c : combinations) {
    require_driveable(o, c);
    Options mine = o;
    if (combinations.size() > 1 && c.links != all_links[0] && c.links != all_links[1]) mine.film = nullptr;
    StressRuns one = run_of(mine, c);
    for (ComparedRun const& r : one.comparison.runs)
      for (auto const& met : r.run.events) std::cerr << r.name << ": at " << met.time << " s " << met.name << ".\n";
    apart.push_back(std::move(one.comparison));
    all.outcomes.insert(all.outcomes.end(), one.outcomes.begin(), one.outcomes.end());
    all.links.insert(all.links.end(), one.links.begin(), one.links.end());
  }
  all.comparison = join(apart);
  return all;
}

}  // namespace chapter4
